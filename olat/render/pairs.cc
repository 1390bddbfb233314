#include "olat/render/pairs.h"

#include <algorithm>
#include <string_view>

#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/files/progress.h"

namespace likeness::olat_render {
namespace {

template <class T>
void must_be_in(const std::vector<T>& list, const std::string& id, const std::string& option) {
  if (id.empty()) return;
  std::vector<std::string_view> ids;
  for (const T& one : list) {
    if (one.id == id) return;
    ids.push_back(one.id);
  }
  const std::string near = files::nearest_name(id, ids.data(), ids.size());
  throw files::UsageError(option + " " + files::in_quotes(id) + " is not in the capture" +
                          (near.empty() ? "" : "; did you mean " + near + "?"));
}

}  // namespace

std::vector<Pair> pairs_of(const capture::Capture& capture, const std::string& camera, const std::string& light,
                           bool without_photographs) {
  must_be_in(capture.cameras, camera, "--camera");
  must_be_in(capture.lights, light, "--light");
  const capture::FrameTable frames(capture);
  std::vector<Pair> out;
  for (std::size_t c = 0; c < capture.cameras.size(); ++c)
    for (std::size_t l = 0; l < capture.lights.size(); ++l) {
      const bool is_asked =
          (camera.empty() || capture.cameras[c].id == camera) && (light.empty() || capture.lights[l].id == light);
      if (is_asked && (without_photographs || frames.frame(c, l) != capture::kAbsent)) out.push_back({c, l});
    }
  return out;
}

image::Attributes attributes_of(const capture::Capture& capture, const capture::Variant& variant, const Pair& pair,
                                const std::string& digest) {
  return {{kCameraAttribute, capture.cameras[pair.camera].id},
          {kLightAttribute, capture.lights[pair.light].id},
          {kVariantAttribute, variant.id},
          {kKindAttribute, "render"},
          {kDigestAttribute, digest},
          {"colorInteropID", "lin_rec709_scene"}};
}

Done make_pairs(const capture::Capture& capture, const capture::Variant& variant, const std::vector<Pair>& pairs,
                const std::function<std::string(const Pair&)>& digest_of,
                const std::function<image::Picture(const Pair&, const std::function<bool(double)>& goes_on)>& render) {
  Done out;
  std::vector<Pair> left;
  for (const Pair& pair : pairs) {
    if (files::interrupted()) {
      out.is_interrupted = true;
      return out;
    }
    const auto found = image::attributes_of_whole_exr(render_file(capture, variant, pair.camera, pair.light));
    const image::Attributes wanted = attributes_of(capture, variant, pair, digest_of(pair));
    // Reading adds attributes of its own ("type").
    if (found && std::includes(found->begin(), found->end(), wanted.begin(), wanted.end())) ++out.kept;
    else left.push_back(pair);
  }
  files::Progress line;
  for (std::size_t i = 0; i < left.size(); ++i) {
    const Pair& pair = left[i];
    const auto goes_on = [&](double share) {
      line.tell("picture " + std::to_string(i + 1) + " of " + std::to_string(left.size()),
                (static_cast<double>(i) + share) / static_cast<double>(left.size()));
      return !files::interrupted();
    };
    try {
      if (!goes_on(0)) throw files::Interrupted();
      const image::Picture picture = render(pair, goes_on);
      image::write_exr(render_file(capture, variant, pair.camera, pair.light), picture,
                       attributes_of(capture, variant, pair, digest_of(pair)));
      ++out.made;
    } catch (const files::Interrupted&) {
      out.is_interrupted = true;
      return out;
    }
  }
  return out;
}

}  // namespace likeness::olat_render
