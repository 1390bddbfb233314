#include <dlfcn.h>
#include <sys/stat.h>

#include <array>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "render/files/files.h"
#include "render/image/io_module.h"
#include "render/image/write.h"

namespace likeness::image {
namespace {

// Whether a module that was found near the program, not named by the user, is one that the program's own owner (or
// root) put there: above the program's folder may lie one that anybody can write to.
bool has_owner_of_program(const std::filesystem::path& file) {
  struct stat program{}, module{};
  return stat("/proc/self/exe", &program) == 0 && stat(file.c_str(), &module) == 0 &&
         (module.st_uid == program.st_uid || module.st_uid == 0);
}

std::filesystem::path named_folder() {
  const char* const named = std::getenv("LIKENESS_MODULES");
  return named ? named : "";
}

std::vector<std::filesystem::path> module_folders() {
  std::vector<std::filesystem::path> folders;
  if (!named_folder().empty()) folders.push_back(named_folder());
  std::error_code error;
  std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  for (int level = 0; level < 4 && folder.has_relative_path(); ++level, folder = folder.parent_path())
    folders.push_back(folder / "lib" / "likeness");
  return folders;
}

likeness_encode_png_function load() {
  std::string tried;
  for (const std::filesystem::path& folder : module_folders()) {
    const std::filesystem::path file = folder / kIoModuleFile;
    std::error_code error;
    if (!std::filesystem::exists(file, error) || (folder != named_folder() && !has_owner_of_program(file))) {
      tried += (tried.empty() ? "" : ", ") + folder.string();
      continue;
    }
    void* const module = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (!module) {
      const char* const cause = dlerror();
      throw std::runtime_error(file.string() + ": the module that writes PNG cannot be loaded: " +
                               (cause ? cause : "no cause given") + "; is OpenImageIO installed?");
    }
    void* const symbol = dlsym(module, kEncodePngName);
    if (!symbol)
      throw std::runtime_error(file.string() + ": has no function " + kEncodePngName +
                               "; it belongs to another version of Likeness: install both from one build");
    return reinterpret_cast<likeness_encode_png_function>(symbol);
  }
  throw std::runtime_error(std::string(kIoModuleFile) + ", which writes PNG, is not in any of: " + tried +
                           "; install Likeness as a whole, or set LIKENESS_MODULES to the folder that has it");
}

}  // namespace

std::string png_bytes(const DisplayPicture& picture) {
  static const likeness_encode_png_function kEncode = load();
  std::string bytes;
  std::array<char, 512> error{};
  const auto sink = [](void* state, const void* data, size_t size) {
    static_cast<std::string*>(state)->assign(static_cast<const char*>(data), size);
  };
  if (kEncode(picture.rgb.data(), picture.width, picture.height, sink, &bytes, error.data(), error.size()) != 0)
    throw std::runtime_error("PNG of " + std::to_string(picture.width) + " x " + std::to_string(picture.height) +
                             " pixels: " + error.data());
  return bytes;
}

void write_png(const std::filesystem::path& file, const DisplayPicture& picture) {
  files::write_whole(file, png_bytes(picture));
}

}  // namespace likeness::image
