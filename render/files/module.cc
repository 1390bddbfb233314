#include "render/files/module.h"

#include <dlfcn.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

namespace likeness::files {
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

struct Loaded {
  void* handle;
  std::filesystem::path file;
};

Loaded load(const Module& module) {
  std::string tried;
  for (const std::filesystem::path& folder : module_folders()) {
    const std::filesystem::path file = folder / module.file;
    std::error_code error;
    if (!std::filesystem::exists(file, error) || (folder != named_folder() && !has_owner_of_program(file))) {
      tried += (tried.empty() ? "" : ", ") + folder.string();
      continue;
    }
    void* const handle = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (!handle) {
      const char* const cause = dlerror();
      throw std::runtime_error(file.string() + ": the module for " + module.purpose + " cannot be loaded: " +
                               (cause ? cause : "no cause given") + "; is " + module.library + " installed?");
    }
    return {handle, file};
  }
  throw std::runtime_error(std::string(module.file) + ", the module for " + module.purpose + ", is not in any of: " +
                           tried + "; install Likeness as a whole, or set LIKENESS_MODULES to the folder that has it");
}

}  // namespace

void* module_function(const Module& module, const char* name) {
  static std::mutex mutex;
  static std::map<std::string, Loaded> all;
  const std::lock_guard lock(mutex);
  auto at = all.find(module.file);
  if (at == all.end()) at = all.emplace(module.file, load(module)).first;
  void* const symbol = dlsym(at->second.handle, name);
  if (!symbol)
    throw std::runtime_error(at->second.file.string() + ": has no function " + name +
                             "; it belongs to another version of Likeness: install both from one build");
  return symbol;
}

}  // namespace likeness::files
