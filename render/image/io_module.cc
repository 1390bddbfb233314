// The module likeness_image_io.so: the only code that OpenImageIO is linked to.
#include "render/image/io_module.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

namespace {

int fail(const std::string& cause, char* error, size_t error_size) {
  std::snprintf(error, error_size, "%s", cause.c_str());
  return 1;
}

// Bytes as a file that lies in memory only, for readers that open a name.
class MemoryFile {
 public:
  MemoryFile(const void* bytes, size_t size) : descriptor_(memfd_create("picture", MFD_CLOEXEC)) {
    const char* at = static_cast<const char*>(bytes);
    while (descriptor_ >= 0 && size > 0) {
      const ssize_t count = write(descriptor_, at, size);
      if (count <= 0) {
        close(descriptor_);
        descriptor_ = -1;
      } else {
        at += count;
        size -= static_cast<size_t>(count);
      }
    }
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() {
    if (descriptor_ >= 0) close(descriptor_);
  }

  bool is_open() const { return descriptor_ >= 0; }
  std::string name() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

// Of camera raw: linear light with Rec. 709 primaries, 1 where the sensor is full; black, white, the camera's matrix and
// the white balance as shot are the file's. Nothing is brightened to taste.
void ask_for_linear(OIIO::ImageSpec& asked) {
  asked.attribute("raw:ColorSpace", "Linear");
  asked.attribute("raw:auto_bright", 0);
  asked.attribute("raw:use_camera_wb", 1);
  asked.attribute("raw:adjust_maximum_thr", 0.0f);
  asked.attribute("raw:HighlightMode", 0);
  asked.attribute("raw:Demosaic", "AHD");
}

constexpr std::string_view kMosaic = "mosaic";

}  // namespace

extern "C" __attribute__((visibility("default"))) int likeness_decode_1(const char* format, const void* bytes,
                                                                        size_t size, likeness_pixels_place place,
                                                                        void* state, char* error, size_t error_size) {
  try {
    const bool is_mosaic = kMosaic == format;
    if (is_mosaic) format = "raw";
    const std::unique_ptr<OIIO::ImageInput> in = OIIO::ImageInput::create(format);
    if (!in) return fail(OIIO::geterror(), error, error_size);
    OIIO::Filesystem::IOMemReader memory(const_cast<void*>(bytes), size);  // it only reads
    std::optional<MemoryFile> file;
    std::string name = std::string("picture.") + format;
    if (!in->supports("ioproxy") || !in->set_ioproxy(&memory)) {
      file.emplace(bytes, size);
      if (!file->is_open()) return fail("there is no memory for it", error, error_size);
      name = file->name();
    }
    OIIO::ImageSpec asked, spec;
    asked.attribute("oiio:UnassociatedAlpha", 1);  // else it multiplies alpha into the colors
    ask_for_linear(asked);
    if (is_mosaic) {
      asked.attribute("raw:Demosaic", "none");
      asked.attribute("raw:user_flip", 0);  // as it lies on the sensor
    }
    if (!in->open(name, spec, asked)) return fail(in->geterror(), error, error_size);
    if (spec.depth > 1) return fail("it is a volume", error, error_size);
    const bool is_float = spec.format != OIIO::TypeDesc::UINT8 && spec.format != OIIO::TypeDesc::INT8;
    void* const pixels = place(state, spec.width, spec.height, spec.nchannels, is_float ? 1 : 0, error, error_size);
    if (!pixels) return 1;
    if (!in->read_image(0, 0, 0, spec.nchannels, is_float ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8, pixels))
      return fail(in->geterror(), error, error_size);
    return 0;
  } catch (const std::exception& e) {
    return fail(e.what(), error, error_size);
  }
}
