#include "render/image/read_exr.h"

#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "render/files/files.h"
#include "render/image/exr_header.h"
#include "render/image/exr_part.h"
#include "render/image/exr_stream.h"

namespace likeness::image {
namespace {

using files::in_quotes;
using files::InputError;

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
      : name_(name), options_(options), stream_(bytes), file_(stream_, exr_threads(), false) {}

  Texels read() {
    const Choice choice = chosen();
    const Imf::Header& header = file_.header(choice.part);
    check_exr_windows(header, name_, options_.most_texels);
    for (const std::string& n : choice.names)
      if (!n.empty()) check_exr_sampling(header, n, name_);
    // A luminance/chroma picture: Y alone would be read as grey, which it is not.
    if (choice.names[0] == "Y" && (header.channels().findChannel("RY") || header.channels().findChannel("BY")))
      refuse("EXR stores luminance and chroma (Y, RY, BY); convert it to R, G, B");
    Texels out;
    out.width = header.displayWindow().max.x - header.displayWindow().min.x + 1;
    out.height = header.displayWindow().max.y - header.displayWindow().min.y + 1;
    out.channels = static_cast<int>(choice.names.size());
    Imf::InputPart part(file_, choice.part);
    out.floats.resize(out.count() * choice.names.size());
    std::vector<ChannelTarget> targets;
    for (std::size_t c = 0; c < choice.names.size(); ++c)
      if (!choice.names[c].empty()) targets.push_back({choice.names[c], out.floats.data() + c, choice.names.size()});
    read_channels(part, targets);
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

  std::string name_;
  ReadOptions options_;
  MemoryInput stream_;
  Imf::MultiPartInputFile file_;
};

}  // namespace

bool is_exr(std::string_view bytes) { return bytes.starts_with(std::string_view("\x76\x2f\x31\x01", 4)); }

Texels decode_exr(std::string_view bytes, const std::string& name, const ReadOptions& options) {
  limit_exr_headers();
  check_exr_header(bytes, name);
  Texels out;
  with_exr_errors(name, [&] { out = Reader(bytes, name, options).read(); });
  return out;
}

}  // namespace likeness::image
