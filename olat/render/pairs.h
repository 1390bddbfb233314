#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "render/capture/capture.h"
#include "render/image/attributes.h"
#include "render/image/picture.h"

// The pictures of a variant, made one after the other and kept as soon as they are whole: work that was interrupted goes on
// where it stopped, and work that is done is not done again.
namespace likeness::olat_render {

struct Pair {
  std::size_t camera = 0, light = 0;
};

// All pairs that have a photograph, or, if `without_photographs`, all; of the camera and the light with these ids only,
// unless they are empty. Camera by camera. Throws files::UsageError with the nearest id.
std::vector<Pair> pairs_of(const capture::Capture& capture, const std::string& camera, const std::string& light,
                           bool without_photographs);

// What stands in the header of a render.
inline constexpr const char* kCameraAttribute = "olat:camera";
inline constexpr const char* kLightAttribute = "olat:light";
inline constexpr const char* kVariantAttribute = "olat:variant";
inline constexpr const char* kKindAttribute = "olat:kind";      // "render"
inline constexpr const char* kDigestAttribute = "olat:digest";  // SHA-256 of all that decided the picture

image::Attributes attributes_of(const capture::Capture& capture, const capture::Variant& variant, const Pair& pair,
                                const std::string& digest);

struct Done {
  std::size_t made = 0, kept = 0;
  bool is_interrupted = false;
};

// For each pair whose file is absent, not whole, or of another digest: render(pair) and write. Tells its progress;
// stops between two pictures, or within one by files::Interrupted, when the user asks for it.
Done make_pairs(const capture::Capture& capture, const capture::Variant& variant, const std::vector<Pair>& pairs,
                const std::function<std::string(const Pair&)>& digest_of,
                const std::function<image::Picture(const Pair&, const std::function<bool(double)>& goes_on)>& render);

}  // namespace likeness::olat_render
