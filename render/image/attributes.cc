#include "render/image/attributes.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <half.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "render/files/files.h"
#include "render/image/exr_header.h"
#include "render/image/exr_part.h"
#include "render/image/exr_stream.h"
#include "render/image/read.h"

namespace likeness::image {

void write_exr(const std::filesystem::path& file, const Picture& picture, const Attributes& attributes,
               Storage storage) {
  MemoryFile memory;
  try {
    Imf::Header header(picture.width, picture.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const auto& [name, text] : attributes) header.insert(name, Imf::StringAttribute(text));
    const bool is_half = storage == Storage::kHalf;
    std::vector<Imath::half> halves;
    if (is_half) {
      const float largest = 65504;
      halves.reserve(picture.rgb.size());
      for (const float x : picture.rgb) halves.push_back(Imath::half(std::clamp(x, -largest, largest)));
    }
    Imf::FrameBuffer pixels;
    const char* const names[] = {"R", "G", "B"};
    const Imf::PixelType type = is_half ? Imf::HALF : Imf::FLOAT;
    const std::size_t size = is_half ? sizeof(Imath::half) : sizeof(float);
    const char* const base =
        is_half ? reinterpret_cast<const char*>(halves.data()) : reinterpret_cast<const char*>(picture.rgb.data());
    for (std::size_t c = 0; c < 3; ++c) {
      header.channels().insert(names[c], Imf::Channel(type));
      // The interface takes char* for reading too; an OutputFile does not write through it.
      pixels.insert(names[c], Imf::Slice(type, const_cast<char*>(base + c * size), 3 * size,
                                         3 * size * static_cast<std::size_t>(picture.width)));
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

std::optional<Attributes> attributes_of_whole_exr(const std::filesystem::path& file) {
  try {
    const std::string bytes = files::read_whole(file, kMostFileBytes);
    limit_exr_headers();
    check_exr_header(bytes, file.string());
    MemoryInput stream(bytes);
    Imf::MultiPartInputFile in(stream, 0, false);
    if (!in.partComplete(0)) return std::nullopt;
    Attributes out;
    const Imf::Header& header = in.header(0);
    for (auto at = header.begin(); at != header.end(); ++at)
      if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&at.attribute())) out[at.name()] = text->value();
    return out;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

}  // namespace likeness::image
