#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>

#include <exception>
#include <stdexcept>
#include <string>

#include "render/files/files.h"
#include "render/image/exr_stream.h"
#include "render/image/write.h"

namespace likeness::image {
void write_exr(const std::filesystem::path& file, const Picture& picture) {
  MemoryFile memory;
  try {
    Imf::Header header(picture.width, picture.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer pixels;
    const std::size_t across = 3 * sizeof(float), down = across * static_cast<std::size_t>(picture.width);
    const char* const names[] = {"R", "G", "B"};
    for (std::size_t c = 0; c < 3; ++c) {
      header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
      // The interface takes char* for reading too; an OutputFile does not write through it.
      char* const base = const_cast<char*>(reinterpret_cast<const char*>(picture.rgb.data() + c));
      pixels.insert(names[c], Imf::Slice(Imf::FLOAT, base, across, down));
    }
    Imf::OutputFile out(memory, header, 0);
    out.setFrameBuffer(pixels);
    out.writePixels(picture.height);
  } catch (const std::exception& e) {
    throw std::runtime_error(file.string() + ": EXR of " + std::to_string(picture.width) + " x " +
                             std::to_string(picture.height) + " pixels: " + e.what());
  }
  files::write_whole(file, memory.content());
}

}  // namespace likeness::image
