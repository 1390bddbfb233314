// The module likeness_image_io.so: the only code that OpenImageIO is linked to.
#include "render/image/io_module.h"

#include <cstdio>
#include <exception>
#include <memory>
#include <string>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

namespace {

int fail(const std::string& cause, char* error, size_t error_size) {
  std::snprintf(error, error_size, "%s", cause.c_str());
  return 1;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) int likeness_decode_1(const char* format, const void* bytes,
                                                                        size_t size, likeness_pixels_place place,
                                                                        void* state, char* error, size_t error_size) {
  try {
    const std::unique_ptr<OIIO::ImageInput> in = OIIO::ImageInput::create(format);
    if (!in) return fail(OIIO::geterror(), error, error_size);
    OIIO::Filesystem::IOMemReader memory(const_cast<void*>(bytes), size);  // it only reads
    if (!in->supports("ioproxy") || !in->set_ioproxy(&memory))
      return fail("this OpenImageIO reads it from files only", error, error_size);
    OIIO::ImageSpec asked, spec;
    asked.attribute("oiio:UnassociatedAlpha", 1);  // else it multiplies alpha into the colors
    if (!in->open(std::string("picture.") + format, spec, asked)) return fail(in->geterror(), error, error_size);
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
