#include "render/image/layers.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "render/files/files.h"
#include "render/image/exr_header.h"
#include "render/image/exr_part.h"
#include "render/image/exr_stream.h"
#include "render/image/read.h"

namespace likeness::image {
namespace {

using files::in_quotes;
using files::InputError;

constexpr const char* kMetadata = "likeness";
constexpr std::size_t kLongestName = 200;  // the format allows 255 for layer, dot and channel

std::string full_name(const Layer& layer, const std::string& channel) {
  return layer.name.empty() ? channel : layer.name + "." + channel;
}

void check(const Layers& layers) {
  const auto refuse = [](const std::string& text) { throw std::invalid_argument("layers: " + text); };
  if (layers.width < 1 || layers.height < 1)
    refuse("the picture is " + std::to_string(layers.width) + " x " + std::to_string(layers.height) +
           "; both sides must be at least 1");
  if (layers.layers.empty()) refuse("there is none; at least one is needed");
  const std::size_t pixels = static_cast<std::size_t>(layers.width) * static_cast<std::size_t>(layers.height);
  std::set<std::string> names;
  for (const Layer& layer : layers.layers) {
    if (layer.channels.empty()) refuse("layer " + in_quotes(layer.name) + " has no channels");
    if (layer.data.size() != pixels * layer.channels.size())
      refuse("layer " + in_quotes(layer.name) + " has " + std::to_string(layer.data.size()) + " values; expected " +
             std::to_string(pixels * layer.channels.size()));
    for (const std::string& channel : layer.channels) {
      if (channel.empty() || channel.find('.') != channel.npos || layer.name.size() + channel.size() > kLongestName ||
          (layer.name + channel).find('\0') != std::string::npos)
        refuse("channel " + in_quotes(channel) + " of layer " + in_quotes(layer.name) +
               " is no name; names have 1 to 200 characters, and channels no dot");
      if (!names.insert(full_name(layer, channel)).second)
        refuse("channel " + in_quotes(full_name(layer, channel)) + " comes twice");
    }
  }
}

Imath::half half_of(float value) {
  const float largest = 65504;
  return std::isinf(value) ? Imath::half(value)
                           : Imath::half(value > largest    ? largest
                                         : value < -largest ? -largest
                                                            : value);
}

int rank(const std::string& channel) {
  static const std::string kOrder = "RGBA";
  const std::size_t at = channel.size() == 1 ? kOrder.find(channel) : kOrder.npos;
  return at == kOrder.npos ? static_cast<int>(kOrder.size()) : static_cast<int>(at);
}

}  // namespace

const Layer* Layers::find(std::string_view name) const {
  const auto at = std::ranges::find_if(layers, [&](const Layer& l) { return l.name == name; });
  return at == layers.end() ? nullptr : &*at;
}

void write_layers(const std::filesystem::path& file, const Layers& layers) {
  check(layers);
  const auto width = static_cast<std::size_t>(layers.width);
  MemoryFile memory;
  try {
    Imf::Header header(layers.width, layers.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    if (!layers.metadata.empty()) header.insert(kMetadata, Imf::StringAttribute(layers.metadata));
    std::size_t half_channels = 0;
    for (const Layer& layer : layers.layers) {
      const bool is_half = layer.storage == Storage::kHalf;
      if (is_half) half_channels += layer.channels.size();
      for (const std::string& channel : layer.channels)
        header.channels().insert(full_name(layer, channel), Imf::Channel(is_half ? Imf::HALF : Imf::FLOAT));
    }
    Imf::OutputFile out(memory, header, exr_threads());
    // A file takes the type of its channel only: halves are made for a block of lines at a time.
    const int kLines = 256;
    const std::size_t plane = width * static_cast<std::size_t>(std::min(kLines, layers.height));
    std::vector<Imath::half> halves(half_channels * plane);
    for (int from = 0; from < layers.height; from += kLines) {
      const int lines = std::min(kLines, layers.height - from);
      const std::size_t start = static_cast<std::size_t>(from) * width, count = static_cast<std::size_t>(lines) * width;
      Imf::FrameBuffer pixels;
      Imath::half* half_plane = halves.data();
      for (const Layer& layer : layers.layers) {
        const std::size_t channels = layer.channels.size();
        for (std::size_t c = 0; c < channels; ++c) {
          const std::string name = full_name(layer, layer.channels[c]);
          const float* const values = layer.data.data() + start * channels + c;
          const Imath::V2i origin(0, from);
          if (layer.storage == Storage::kHalf) {
            for (std::size_t i = 0; i < count; ++i) half_plane[i] = half_of(values[i * channels]);
            pixels.insert(name, Imf::Slice::Make(Imf::HALF, half_plane, origin, layers.width, lines));
            half_plane += plane;
          } else {
            pixels.insert(name, Imf::Slice::Make(Imf::FLOAT, values, origin, layers.width, lines,
                                                 channels * sizeof(float), width * channels * sizeof(float)));
          }
        }
      }
      out.setFrameBuffer(pixels);
      out.writePixels(lines);
    }
  } catch (const std::exception& e) {
    throw std::runtime_error(file.string() + ": EXR of " + std::to_string(layers.width) + " x " +
                             std::to_string(layers.height) + " pixels: " + e.what());
  }
  files::write_whole(file, memory.content());
}

Layers decode_layers(std::string_view bytes, const std::string& name, std::size_t most_values) {
  limit_exr_headers();
  check_exr_header(bytes, name);
  Layers out;
  with_exr_errors(name, [&] {
    MemoryInput stream(bytes);
    Imf::MultiPartInputFile file(stream, exr_threads(), false);
    const Imf::Header& header = file.header(0);
    if (header.hasType() && Imf::isDeepData(header.type()))
      throw InputError(name + ": EXR is deep; expected a flat one");
    check_exr_windows(header, name, std::min(most_values, kMostTexels));
    struct Found {
      std::vector<std::string> channels;
      bool is_half = true;
    };
    std::map<std::string, Found> found;
    std::size_t channels = 0;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c, ++channels) {
      check_exr_sampling(header, c.name(), name);
      const std::string full = c.name();
      const std::size_t dot = full.rfind('.');
      Found& layer = found[dot == full.npos ? "" : full.substr(0, dot)];
      layer.channels.push_back(dot == full.npos ? full : full.substr(dot + 1));
      layer.is_half = layer.is_half && c.channel().type == Imf::HALF;
    }
    out.width = header.displayWindow().max.x - header.displayWindow().min.x + 1;
    out.height = header.displayWindow().max.y - header.displayWindow().min.y + 1;
    const std::size_t pixels = static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height);
    if (channels == 0 || pixels > most_values / channels)
      throw InputError(name + ": EXR of " + std::to_string(out.width) + " x " + std::to_string(out.height) +
                       " pixels with " + std::to_string(channels) + " channels; 1 to " + std::to_string(most_values) +
                       " values are allowed");
    if (const auto* text = header.findTypedAttribute<Imf::StringAttribute>(kMetadata)) out.metadata = text->value();
    Imf::InputPart part(file, 0);
    std::vector<ChannelTarget> targets;
    for (auto& [layer_name, layer] : found) {
      std::ranges::stable_sort(layer.channels, {}, rank);
      Layer& to = out.layers.emplace_back();
      to.name = layer_name;
      to.channels = layer.channels;
      to.storage = layer.is_half ? Storage::kHalf : Storage::kFloat;
      to.data.resize(pixels * to.channels.size());
      for (std::size_t c = 0; c < to.channels.size(); ++c)
        targets.push_back({full_name(to, to.channels[c]), to.data.data() + c, to.channels.size()});
    }
    read_channels(part, targets);
  });
  return out;
}

Layers read_layers(const std::filesystem::path& file, std::size_t most_values) {
  return decode_layers(files::read_whole(file, kMostFileBytes), file.string(), most_values);
}

}  // namespace likeness::image
