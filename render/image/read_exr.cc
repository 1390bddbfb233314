#include "render/image/read_exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "render/files/files.h"
#include "render/image/exr_stream.h"

namespace likeness::image {
namespace {

using files::in_quotes;
using files::InputError;

struct Extent {
  std::int64_t left, top, width, height;
};

Extent extent_of(const Imath::Box2i& box) {
  return {box.min.x, box.min.y, std::int64_t{box.max.x} - box.min.x + 1, std::int64_t{box.max.y} - box.min.y + 1};
}

// Channels of one part that make a picture: their full names in the order of Texels, "" for one that is missing.
struct Choice {
  int part = 0;
  std::vector<std::string> names;
};

// The layer of each channel ("" for none), with the short names of its channels: "left.diffuse.R" is R of left.diffuse.
std::map<std::string, std::set<std::string>> layers_of(const Imf::ChannelList& channels) {
  std::map<std::string, std::set<std::string>> layers;
  for (auto c = channels.begin(); c != channels.end(); ++c) {
    const std::string_view full = c.name();
    const std::size_t dot = full.rfind('.');
    layers[std::string(dot == full.npos ? "" : full.substr(0, dot))].insert(
        std::string(dot == full.npos ? full : full.substr(dot + 1)));
  }
  return layers;
}

// What of these channels is a picture, by their short names; empty if nothing is.
std::vector<std::string> picture_channels(const std::set<std::string>& found) {
  const auto has = [&](const char* name) { return found.contains(name); };
  std::vector<std::string> out;
  if (has("R") || has("G") || has("B")) {
    if (has("R") && !has("G") && !has("B")) out = {"R"};
    else out = {has("R") ? "R" : "", has("G") ? "G" : "", has("B") ? "B" : ""};
    if (has("A")) out.emplace_back("A");
  } else if (has("X") && has("Y") && has("Z")) {
    out = {"X", "Y", "Z"};
  } else if (has("Y")) {
    out = {"Y"};
    if (has("A")) out.emplace_back("A");
  } else if (found.size() == 1) {
    out = {*found.begin()};
  }
  return out;
}

class Reader {
 public:
  Reader(std::string_view bytes, const std::string& name, const ReadOptions& options)
      : name_(name), options_(options), stream_(bytes), file_(stream_, 0, false) {}

  Texels read() {
    const Choice choice = chosen();
    const Imf::Header& header = file_.header(choice.part);
    check(header, choice);
    const Extent shown = extent_of(header.displayWindow());
    Texels out;
    out.width = static_cast<int>(shown.width);
    out.height = static_cast<int>(shown.height);
    out.channels = static_cast<int>(choice.names.size());
    Imf::InputPart part(file_, choice.part);
    out.floats.resize(out.count() * choice.names.size());
    fill(part, choice, shown, out);
    return out;
  }

 private:
  [[noreturn]] void refuse(const std::string& text) const { throw InputError(name_ + ": " + text); }

  Choice chosen() const {
    struct Candidate {
      std::string layer;
      Choice choice;
    };
    std::vector<Candidate> candidates;
    std::set<std::string> others;
    for (int p = 0; p < file_.parts(); ++p) {
      const Imf::Header& header = file_.header(p);
      if (header.hasType() && Imf::isDeepData(header.type())) {
        others.insert("a deep picture");
        continue;
      }
      for (const auto& [layer, channels] : layers_of(header.channels())) {
        const std::vector<std::string> names = picture_channels(channels);
        const bool is_named_part = layer.empty() && file_.parts() > 1 && header.hasName();
        if (names.empty()) {
          for (const std::string& c : channels) others.insert(in_quotes(layer.empty() ? c : layer + "." + c));
          continue;
        }
        Candidate candidate{layer, {p, {}}};
        for (const std::string& n : names)
          candidate.choice.names.push_back(n.empty() || layer.empty() ? n : layer + "." + n);
        if (!options_.layer.empty() && (layer == options_.layer || (is_named_part && header.name() == options_.layer)))
          return candidate.choice;
        if (options_.layer.empty() && layer.empty()) return candidate.choice;
        if (is_named_part) candidate.layer = header.name();
        candidates.push_back(std::move(candidate));
      }
    }
    if (options_.layer.empty() && candidates.size() == 1) return candidates[0].choice;
    std::string list;
    for (std::size_t i = 0; i < std::min<std::size_t>(candidates.size(), 8); ++i)
      list += (i == 0 ? "" : ", ") + in_quotes(candidates[i].layer);
    if (candidates.size() > 8) list += ", ...";
    if (!options_.layer.empty())
      refuse("EXR has no layer " + in_quotes(options_.layer) +
             (list.empty() ? "; it has none with R, G, B or Y" : "; it has " + list));
    if (!candidates.empty())
      refuse("EXR has no channels R, G, B or Y without a layer; choose one of its layers " + list);
    refuse("EXR has no channels R, G, B or Y" + (others.empty() ? std::string() : "; it has " + *others.begin()) +
           (others.size() > 1 ? " and " + std::to_string(others.size() - 1) + " more" : ""));
  }

  void check(const Imf::Header& header, const Choice& choice) const {
    const Extent shown = extent_of(header.displayWindow()), data = extent_of(header.dataWindow());
    for (const Extent& e : {shown, data})
      if (e.width < 1 || e.height < 1 || e.width > kLongestSide || e.height > kLongestSide ||
          static_cast<std::uint64_t>(e.width * e.height) > options_.most_texels)
        refuse("EXR of " + std::to_string(e.width) + " x " + std::to_string(e.height) + " pixels; at most " +
               std::to_string(options_.most_texels) + " pixels and " + std::to_string(kLongestSide) +
               " a side are allowed");
    for (const std::string& n : choice.names) {
      if (n.empty()) continue;
      const Imf::Channel& c = header.channels()[n.c_str()];
      if (c.xSampling != 1 || c.ySampling != 1)
        refuse("EXR channel " + in_quotes(n) + " is stored at every " + std::to_string(c.xSampling) + " x " +
               std::to_string(c.ySampling) + " pixels; only full resolution is read");
    }
    // A luminance/chroma picture: Y alone would be read as grey, which it is not.
    if (choice.names[0] == "Y" && (header.channels().findChannel("RY") || header.channels().findChannel("BY")))
      refuse("EXR stores luminance and chroma (Y, RY, BY); convert it to R, G, B");
    // OpenEXR keeps one block of lines of every channel in memory, and one row of tiles.
    std::uint64_t line = 0;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
      line += static_cast<std::uint64_t>(data.width) * (c.channel().type == Imf::HALF ? 2 : 4);
    std::uint64_t lines = 256;  // of the largest block, DWAB
    if (header.hasTileDescription()) {
      const Imf::TileDescription& tile = header.tileDescription();
      lines = std::max<std::uint64_t>(lines, tile.ySize);
      line = std::max(line, line / static_cast<std::uint64_t>(data.width) * tile.xSize);
    }
    constexpr std::uint64_t kMostBlockBytes = std::uint64_t{1} << 31;
    if (line * std::min<std::uint64_t>(lines, kLongestSide) > std::max(kMostBlockBytes, 16 * options_.most_texels))
      refuse("EXR needs " + std::to_string(line * lines / 1000000) + " MB for one block of lines; at most " +
             std::to_string(kMostBlockBytes / 1000000) + " MB are allowed");
  }

  // Reads the data window in blocks of lines, and copies what of it lies in the display window.
  void fill(Imf::InputPart& part, const Choice& choice, const Extent& shown, Texels& out) const {
    const Extent data = extent_of(part.header().dataWindow());
    const std::size_t channels = choice.names.size();
    const std::int64_t left = std::max(data.left, shown.left);
    const std::int64_t right = std::min(data.left + data.width, shown.left + shown.width);
    const std::int64_t top = std::max(data.top, shown.top);
    const std::int64_t bottom = std::min(data.top + data.height, shown.top + shown.height);
    if (left >= right || top >= bottom) return;
    constexpr std::int64_t kLines = 256;  // a multiple of every compression's block of lines
    // Blocks of lines are counted from the top of the data window.
    const std::int64_t first_block = (top - data.top) / kLines;
    const std::size_t row = static_cast<std::size_t>(data.width) * channels;
    std::vector<float> lines(row * static_cast<std::size_t>(std::min(kLines, data.height)));
    for (std::int64_t block = first_block; data.top + block * kLines < bottom; ++block) {
      const std::int64_t from = std::max(top, data.top + block * kLines);
      const std::int64_t to = std::min(bottom, data.top + (block + 1) * kLines);
      Imf::FrameBuffer pixels;
      for (std::size_t c = 0; c < channels; ++c) {
        if (choice.names[c].empty()) continue;
        // Imf::Slice::Make finds the address that (0, 0) would have.
        pixels.insert(choice.names[c],
                      Imf::Slice::Make(Imf::FLOAT, lines.data() + c,
                                       Imath::V2i(static_cast<int>(data.left), static_cast<int>(from)), data.width,
                                       to - from, channels * sizeof(float), row * sizeof(float)));
      }
      part.setFrameBuffer(pixels);
      part.readPixels(static_cast<int>(from), static_cast<int>(to - 1));
      for (std::int64_t y = from; y < to; ++y)
        std::memcpy(
            out.floats.data() + static_cast<std::size_t>((y - shown.top) * shown.width + left - shown.left) * channels,
            lines.data() + static_cast<std::size_t>(y - from) * row +
                static_cast<std::size_t>(left - data.left) * channels,
            static_cast<std::size_t>(right - left) * channels * sizeof(float));
    }
  }

  std::string name_;
  ReadOptions options_;
  MemoryInput stream_;
  Imf::MultiPartInputFile file_;
};

}  // namespace

bool is_exr(std::string_view bytes) { return bytes.starts_with(std::string_view("\x76\x2f\x31\x01", 4)); }

Texels decode_exr(std::string_view bytes, const std::string& name, const ReadOptions& options) {
  // OpenEXR allocates its table of lines or tiles by the header's size before anybody can look at that. The limits
  // are of the process.
  static const bool kLimited = [] {
    Imf::Header::setMaxImageSize(kLongestSide, kLongestSide);
    Imf::Header::setMaxTileSize(kLongestSide, kLongestSide);
    return true;
  }();
  (void)kLimited;
  try {
    return Reader(bytes, name, options).read();
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& e) {
    std::string cause = e.what();
    std::ranges::replace(cause, '\n', ' ');
    throw InputError(name + ": EXR cannot be read (" + cause.substr(0, 300) + ")");
  }
}

}  // namespace likeness::image
