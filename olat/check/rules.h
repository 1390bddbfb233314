#pragma once

#include <array>
#include <cstddef>
#include <string_view>

// What `likeness olat check` looks for. The only list: --help, docs/olat_check.md and the tests are made from it.
namespace likeness::olat_check {

enum class Severity : unsigned char {
  kError,   // a comparison with it means nothing
  kWarning  // a comparison with it means less, or it may be meant
};
inline constexpr std::array<std::string_view, 2> kSeverities{"error", "warning"};

// What a rule has to have; without it the report says that the rule was not checked.
enum class Needs : unsigned char { kLists, kPhotos, kPhotosAndNormals, kReference, kRenders };
inline constexpr std::array<std::string_view, 5> kNeeds{
    "the four files", "photos", "photos, normals and directions of lights",
    "photos, and renders or else normals and directions of lights", "photos and renders"};

enum class Rule : unsigned char {
  kMissingFrame,
  kDuplicateFrame,
  kSameFile,
  kLightWithoutPlace,
  kUnusedLight,
  kExposureGain,
  kUnreadable,
  kSize,
  kSha256,
  kExposureAttributes,
  kNotFinite,
  kEmptyMask,
  kClipped,
  kBlackLevel,
  kNoiseFloor,
  kWhiteBalance,
  kTransferCurve,
  kMirrored,
  kLightOrder,
  kMissingRender,
  kRenderOfOther,
  kRenderNotFinite,
  kStaleRender,
  kShift,
  kLightGain,
};

struct RuleRow {
  std::string_view id;
  Severity severity;
  Needs needs;
  double allowed;  // what is above it is found
  std::string_view unit;
  std::string_view text;    // what it finds
  std::string_view reason;  // of the number
  std::string_view way_out;
};

// In the order of Rule.
inline constexpr std::array kRules{
    RuleRow{"missing_frame", Severity::kError, Needs::kLists, 0, "photos",
            "A camera has no photo under a light of the capture", "a pair that is not there is in no average",
            "import the photo, or take the light out of lights.json"},
    RuleRow{"duplicate_frame", Severity::kError, Needs::kLists, 1, "photos",
            "Two photos claim the same camera and light", "only the first is compared",
            "remove one row of frames.json"},
    RuleRow{"same_file", Severity::kError, Needs::kLists, 1, "rows", "Two rows of frames.json name the same file",
            "one of the two is another light", "give each row its own file"},
    RuleRow{"light_without_place", Severity::kError, Needs::kLists, 0, "lights",
            "A light that photos use has neither direction nor position", "nothing can be rendered under it",
            "likeness olat calibrate --chrome, or write it into lights.json"},
    RuleRow{"unused_light", Severity::kWarning, Needs::kLists, 0, "lights", "A light has no photo at all",
            "it may be the one that a misnamed photo belongs to", "import its photos, or take it out of lights.json"},
    RuleRow{"exposure_gain", Severity::kWarning, Needs::kLists, 0.05, "stop",
            "Exposures of a camera differ, and the gains of the frames do not make up for it",
            "a twentieth of a stop is what shutters and apertures keep",
            "set gain in frames.json to (first exposure) / (this exposure)"},
    RuleRow{"unreadable", Severity::kError, Needs::kPhotos, 0, "files", "A photo, mask or layer is absent or damaged",
            "it cannot be compared", "restore the file, or correct its path"},
    RuleRow{"size", Severity::kError, Needs::kPhotos, 0, "pixels",
            "A photo or a render has another size than its camera", "pixels of other places would be compared",
            "correct width and height in cameras.json, or crop the picture"},
    RuleRow{"sha256", Severity::kError, Needs::kPhotos, 0, "files",
            "A photo is not the one that was imported: its SHA-256 differs", "exact",
            "import it again, or restore the original"},
    RuleRow{"exposure_attributes", Severity::kError, Needs::kPhotos, 0.05, "stop",
            "exposure_s, iso or f_number of a row are not those that its EXR states", "headers round to a few per cent",
            "correct the row of frames.json"},
    RuleRow{"not_finite", Severity::kError, Needs::kPhotos, 0, "pixels",
            "A photo holds NaN or infinity inside the mask", "no camera makes one",
            "look at what wrote the file; the pixels are left out of every number"},
    RuleRow{"empty_mask", Severity::kError, Needs::kPhotos, 0, "masks", "The mask of a camera has no pixel inside",
            "nothing would be compared", "give another mask in cameras.json: white inside"},
    RuleRow{"clipped", Severity::kWarning, Needs::kPhotos, 0.005, "1",
            "More than this share of the subject is clipped in a photo",
            "clipped pixels are left out; half a percent is a highlight, more is skin",
            "expose less, or bracket; check clip in frames.json"},
    RuleRow{"black_level", Severity::kWarning, Needs::kPhotos, 0.01, "1",
            "The darkest part of every photo of a camera is not black, as a share of its brightest percent",
            "a hundredth is 6.6 stops below white, where shadows begin",
            "set black in frames.json, or subtract a photo with the lights off"},
    RuleRow{"noise_floor", Severity::kWarning, Needs::kPhotos, 1, "stop",
            "The noise floor in cameras.json is not the noise of the photos",
            "twice or half: errors in stops bend at another light", "likeness olat calibrate --noise"},
    RuleRow{"white_balance", Severity::kWarning, Needs::kPhotos, 0.15, "stop",
            "Red or blue against green, of a light, is off the median of the camera's lights",
            "0.15 stop is a Delta E of about 3 on grey; the subject's own colors move 0.1",
            "likeness olat calibrate --gain channel"},
    RuleRow{"transfer_curve", Severity::kError, Needs::kReference, 0.3, "exponent",
            "Photos go with a power of the light: not decoded (0.45), or decoded twice (2.2)",
            "highlights and interreflection bend honest photos by up to 0.2",
            "set transfer in frames.json to srgb, or to linear"},
    RuleRow{"mirrored", Severity::kError, Needs::kPhotosAndNormals, 0.1, "correlation",
            "Photos look as if an axis of the lights' directions (or of the normals) had the other sign",
            "right lights lose against no mirrored ones; mirrored ones lose by 0.5",
            "change the sign of that axis in lights.json, or of the normals"},
    RuleRow{"light_order", Severity::kError, Needs::kReference, 0.05, "correlation",
            "Photos under a light look like renders (or cosines) of another",
            "noise and highlights change which light fits best by less than 0.02",
            "exchange the lights in frames.json"},
    RuleRow{"missing_render", Severity::kWarning, Needs::kRenders, 0, "renders", "A pair has a photo and no render",
            "a pair that is not there is in no average", "likeness olat render"},
    RuleRow{"render_of_other", Severity::kError, Needs::kRenders, 0, "renders",
            "The header of a render names another camera, light or variant than its path", "exact",
            "likeness olat render, or put the file where it belongs"},
    RuleRow{"render_not_finite", Severity::kError, Needs::kRenders, 0, "pixels", "A render holds NaN or infinity",
            "no renderer should write one", "render it again; the pixels are left out of every number"},
    RuleRow{"stale_render", Severity::kWarning, Needs::kRenders, 0, "renders",
            "A render is older than a change of cameras.json or lights.json, which is what is newer than capture.json",
            "it may show other lights or cameras", "likeness olat render"},
    RuleRow{"shift", Severity::kWarning, Needs::kRenders, 0.25, "pixel", "Photos of a camera lie beside its renders",
            "a quarter of a pixel moves an edge of 4 stops by one stop",
            "calibrate the camera again, or likeness olat calibrate --undistort"},
    RuleRow{"light_gain", Severity::kWarning, Needs::kRenders, 0.1, "stop",
            "A light is brighter or darker in the photos than the median light, against the renders",
            "a tenth of a stop can just be seen side by side", "likeness olat calibrate --gain light"},
};
constexpr const RuleRow& row_of(Rule rule) { return kRules[static_cast<std::size_t>(rule)]; }

}  // namespace likeness::olat_check
