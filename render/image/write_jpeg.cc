#include <cstdio>  // jpeglib.h needs FILE before it

#include <jpeglib.h>

#include <csetjmp>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>

#include "render/image/write.h"

namespace likeness::image {
namespace {

// What libjpeg calls back. It is C: nothing is thrown through it, it jumps.
struct Sink {
  jpeg_error_mgr errors{};
  std::jmp_buf place{};
  char error[JMSG_LENGTH_MAX] = "";
  unsigned char* bytes = nullptr;  // of malloc
  unsigned long size = 0;
};
void on_error(j_common_ptr jpeg) {
  Sink* const sink = static_cast<Sink*>(jpeg->client_data);
  jpeg->err->format_message(jpeg, sink->error);
  std::longjmp(sink->place, 1);
}
void on_message(j_common_ptr) {}

// False, with the cause in `sink`, if libjpeg does not like it. Nothing here has a destructor that a jump would skip.
bool encode(const std::uint8_t* rgb, int width, int height, int quality, JpegColors colors, Sink& sink) {
  jpeg_compress_struct jpeg{};
  jpeg.err = jpeg_std_error(&sink.errors);
  jpeg.client_data = &sink;
  sink.errors.error_exit = on_error;
  sink.errors.output_message = on_message;
  if (setjmp(sink.place) != 0) {
    jpeg_destroy_compress(&jpeg);
    return false;
  }
  jpeg_create_compress(&jpeg);
  jpeg_mem_dest(&jpeg, &sink.bytes, &sink.size);
  jpeg.image_width = static_cast<JDIMENSION>(width);
  jpeg.image_height = static_cast<JDIMENSION>(height);
  jpeg.input_components = 3;
  jpeg.in_color_space = JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_set_colorspace(&jpeg, colors == JpegColors::kRgb ? JCS_RGB : JCS_YCbCr);
  for (int c = 0; c < jpeg.num_components; ++c)
    jpeg.comp_info[c].h_samp_factor = jpeg.comp_info[c].v_samp_factor = 1;  // no channel is thinned out
  jpeg_set_quality(&jpeg, quality, TRUE);
  jpeg.optimize_coding = TRUE;
  jpeg_start_compress(&jpeg, TRUE);
  while (jpeg.next_scanline < jpeg.image_height) {
    // libjpeg does not write to it, its type is older than const.
    JSAMPROW row =
        const_cast<JSAMPROW>(rgb + 3 * static_cast<std::size_t>(jpeg.next_scanline) * static_cast<std::size_t>(width));
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  return true;
}

}  // namespace

std::string jpeg_bytes(const DisplayPicture& picture, int quality, JpegColors colors) {
  Sink sink;
  const bool is_done = encode(picture.rgb.data(), picture.width, picture.height, quality, colors, sink);
  const std::unique_ptr<unsigned char, decltype(&std::free)> owner(sink.bytes, std::free);
  if (!is_done)
    throw std::runtime_error("JPEG of " + std::to_string(picture.width) + " x " + std::to_string(picture.height) +
                             " pixels: " + sink.error);
  return std::string(reinterpret_cast<const char*>(sink.bytes), sink.size);
}

}  // namespace likeness::image
