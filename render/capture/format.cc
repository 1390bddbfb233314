#include "render/capture/format.h"

#include <array>

#include "render/capture/capture.h"

namespace likeness::capture {
namespace {

using json::Form;
using json::Key;
using json::Section;
using Words = std::string_view;

constexpr std::array<Words, 1> kUnits{"m"};
constexpr std::array<Words, 1> kAxes{"opencv"};
constexpr std::array<Words, 1> kWorkingSpaces{"lin_rec709_scene"};
constexpr std::array<Words, 4> kMatches{"none", "capture", "light", "channel"};

using One = std::array<const Section*, 1>;
constexpr One kPipelineOnly{&kPipelineSection}, kFlipOnly{&kFlipSection}, kVariantOnly{&kVariantSection},
    kCameraOnly{&kCameraSection}, kLayersOnly{&kLayersSection}, kLightOnly{&kLightSection}, kFrameOnly{&kFrameSection},
    kPatternOnly{&kPatternSection}, kEncodingOnly{&kEncodingSection};

// clang-format off
constexpr Key kType{.name = "type", .form = Form::kText, .required = true, .text = "what the file is"};
constexpr Key kVersion{.name = "version", .form = Form::kWhole, .range = {kFormatVersion, kFormatVersion}, .required = true, .text = "of the format"};
constexpr Key kVersionOfCameras{.name = "version", .form = Form::kWhole, .range = {kFormatVersion, kCamerasVersion}, .required = true, .text = "of the format"};

constexpr std::array kPipelineKeys{
    Key{.name = "match_gain", .form = Form::kChoice, .initial = "none", .choices = kMatches, .text = "what a render is multiplied by before it is compared: nothing, or one fitted gain for the capture, each light, or each light and channel"},
    Key{.name = "ev", .form = Form::kNumber, .initial = "0", .range = {-64, 64}, .unit = "stop", .text = "exposure of both pictures on the screen"},
    Key{.name = "view", .form = Form::kText, .initial = "gt", .text = "how linear light becomes a picture, see docs/render.md"},
};
constexpr std::array kFlipKeys{
    Key{.name = "first_ev", .form = Form::kNumber, .initial = "-4", .range = {-64, 64}, .unit = "stop", .text = "darkest exposure that HDR-FLIP takes, for the whole capture"},
    Key{.name = "last_ev", .form = Form::kNumber, .initial = "3", .range = {-64, 64}, .unit = "stop", .text = "brightest"},
};
constexpr std::array kVariantKeys{
    Key{.name = "id", .form = Form::kText, .required = true, .text = "names the renders of one scene and one renderer"},
    Key{.name = "pattern", .form = Form::kFile, .initial = "renders/{variant}/{camera}/{light}.exr", .text = "of a pair's file, with ids in the places of {camera}, {light} and {variant}; without {light}: a picture that no light changes; below the capture's folder"},
};
constexpr std::array kLayersKeys{
    Key{.name = kLayers[0], .form = Form::kFile, .text = "1 inside, 0 outside: the green channel, from half of its range"},
    Key{.name = kLayers[1], .form = Form::kFile, .text = "unit normals in the world's axes: EXR and PFM as they are, others 2 x - 1"},
    Key{.name = kLayers[2], .form = Form::kFile, .unit = "m", .text = "of the surface, in the world"},
    Key{.name = kLayers[3], .form = Form::kFile, .text = "texture coordinates of the surface"},
    Key{.name = kLayers[4], .form = Form::kFile, .text = "reflectance, linear Rec. 709"},
    Key{.name = kLayers[5], .form = Form::kFile, .text = "what linear pixels are divided by: 1 changes nothing"},
};
constexpr std::array kCameraKeys{
    Key{.name = "id", .form = Form::kText, .required = true, .text = "its name in frames.json and in paths"},
    Key{.name = "label", .form = Form::kText, .text = "for people"},
    Key{.name = "width", .form = Form::kWhole, .range = {1, 65536}, .unit = "pixel", .required = true, .text = "of every picture of the camera"},
    Key{.name = "height", .form = Form::kWhole, .range = {1, 65536}, .unit = "pixel", .required = true, .text = "of every picture of the camera"},
    Key{.name = "orthographic", .form = Form::kFlag, .initial = "false", .text = "rays are parallel: focal_px is then pixels a metre"},
    Key{.name = "focal_px", .form = Form::kPair, .range = {0, 1e9}, .above = true, .unit = "pixel", .required = true, .text = "fx and fy of K"},
    Key{.name = "center_px", .form = Form::kPair, .unit = "pixel", .text = "cx and cy of K, from the top left corner of the picture; default: its middle"},
    Key{.name = "skew", .form = Form::kNumber, .initial = "0", .unit = "pixel", .text = "K's entry between x and y"},
    Key{.name = "lens", .form = Form::kChoice, .initial = kLenses[0], .choices = kLenses, .text = "what distortion means; needs version 2 if it is a fisheye"},
    Key{.name = "distortion", .form = Form::kNumbers, .text = "of OpenCV: k1 k2 p1 p2 k3 k4 k5 k6, or of a fisheye k1 k2 k3 k4 (fewer: the rest is 0; k4 k5 k6 of the first need version 2)"},
    Key{.name = "undistorted", .form = Form::kFlag, .initial = "true", .text = "whether the files are free of that distortion"},
    Key{.name = "world_from_camera", .form = Form::kMatrix, .required = true, .text = "camera to world, row by row; the camera looks along z with x to the right and y down"},
    Key{.name = "rec709_from_camera", .form = Form::kNumbers, .text = "nine numbers, row by row: linear colors of frames with camera primaries are multiplied by it; default: unchanged"},
    Key{.name = "noise_floor", .form = Form::kVector, .range = {0, 1e9}, .text = "linear standard deviation of a dark pixel, each channel; 0: not measured"},
    Key{.name = "layers", .form = Form::kObject, .sections = kLayersOnly, .text = "files that belong to the view and to no light"},
};
constexpr std::array kLightKeys{
    Key{.name = "id", .form = Form::kText, .required = true, .text = "its name in frames.json and in paths"},
    Key{.name = "label", .form = Form::kText, .text = "for people"},
    Key{.name = "direction", .form = Form::kVector, .text = "of a distant light: from the subject to it; any length but 0"},
    Key{.name = "position", .form = Form::kVector, .unit = "m", .text = "of a near light, which falls off with the square of the distance; without either, the place is not known"},
    Key{.name = "intensity", .form = Form::kColor, .initial = "1", .range = {0, 1e9}, .above = true, .text = "what linear photos are divided by; relative, 1 is the capture's unit light"},
    Key{.name = "calibrated_by", .form = Form::kText, .text = "how place and intensity are known"},
};
constexpr std::array kEncodingKeys{
    Key{.name = "transfer", .form = Form::kChoice, .initial = "linear", .choices = kTransfers, .text = "the curve that is undone"},
    Key{.name = "primaries", .form = Form::kChoice, .initial = "rec709", .choices = kPrimaries, .text = "of the linear colors; camera: see rec709_from_camera"},
    Key{.name = "black", .form = Form::kNumber, .initial = "0", .text = "decoded value that stands for no light; integers are divided by their largest first"},
    Key{.name = "white", .form = Form::kNumber, .initial = "1", .text = "decoded value that stands for 1; above black"},
    Key{.name = "clip", .form = Form::kNumber, .initial = "1", .range = {0, 1e9}, .above = true, .text = "the sensor is full at and above it, after black and white and before the curve"},
    Key{.name = "never_clips", .form = Form::kFlag, .initial = "false", .text = "in place of clip"},
    Key{.name = "gain", .form = Form::kNumber, .initial = "1", .range = {0, 1e9}, .above = true, .text = "linear pixels are multiplied by it, for exposures that differ"},
    Key{.name = "exposure_s", .form = Form::kNumber, .range = {0, 1e9}, .above = true, .unit = "s", .text = "for people and checks; no pixel is changed by it"},
    Key{.name = "iso", .form = Form::kNumber, .range = {0, 1e9}, .above = true, .text = "likewise"},
    Key{.name = "f_number", .form = Form::kNumber, .range = {0, 1e9}, .above = true, .text = "likewise"},
};
constexpr std::array kPlaceKeys{
    Key{.name = "camera", .form = Form::kText, .required = true, .text = "id"},
    Key{.name = "light", .form = Form::kText, .text = "id; needed for one_light"},
    Key{.name = "kind", .form = Form::kChoice, .initial = kFrameKinds[0], .choices = kFrameKinds, .text = "what shone: one light, all of them, none (what is subtracted), a pattern; `crossed`: one light through crossed polarizers"},
    Key{.name = "file", .form = Form::kFile, .required = true, .text = "relative to the capture's folder and not above it, or absolute"},
    Key{.name = "sha256", .form = Form::kText, .text = "of the file, 64 hexadecimal digits"},
};
constexpr std::array kPatternOwnKeys{
    Key{.name = "file", .form = Form::kFile, .required = true, .text = "with ids in the places of {camera} and {light}, for example photos/{camera}/{light}.exr"},
    Key{.name = "cameras", .form = Form::kTexts, .text = "ids; default: all"},
    Key{.name = "lights", .form = Form::kTexts, .text = "ids; default: all"},
};
constexpr std::array kCaptureKeys{
    kType,
    kVersion,
    Key{.name = "name", .form = Form::kText, .text = "for people"},
    Key{.name = "units", .form = Form::kChoice, .initial = "m", .choices = kUnits, .text = "of lengths"},
    Key{.name = "axes", .form = Form::kChoice, .initial = "opencv", .choices = kAxes, .text = "of cameras: x right, y down, z forward"},
    Key{.name = "up", .form = Form::kVector, .initial = "0 1 0", .text = "what is upwards in the world; any length but 0"},
    Key{.name = "working_space", .form = Form::kChoice, .initial = "lin_rec709_scene", .choices = kWorkingSpaces, .text = "of linear light once it is read"},
    Key{.name = "variants", .form = Form::kList, .sections = kVariantOnly, .text = "sets of renders"},
    Key{.name = "pipeline", .form = Form::kObject, .sections = kPipelineOnly, .text = "how both pictures get onto the screen"},
    Key{.name = "flip", .form = Form::kObject, .sections = kFlipOnly, .text = "exposures of HDR-FLIP"},
    Key{.name = "license", .form = Form::kText, .text = "of the photos"},
    Key{.name = "citation", .form = Form::kText, .text = "whom to name"},
    Key{.name = "source", .form = Form::kText, .text = "where the capture comes from, and what was assumed"},
};
constexpr std::array kCamerasKeys{
    kType,
    kVersionOfCameras,
    Key{.name = "cameras", .form = Form::kList, .required = true, .sections = kCameraOnly, .text = "in the order of the tool's keys"},
};
constexpr std::array kLightsKeys{
    kType,
    kVersion,
    Key{.name = "lights", .form = Form::kList, .required = true, .sections = kLightOnly, .text = "in the order of the tool's keys"},
};
constexpr std::array kFramesKeys{
    kType,
    kVersion,
    Key{.name = "defaults", .form = Form::kObject, .sections = kEncodingOnly, .text = "what every row has unless it says otherwise"},
    Key{.name = "patterns", .form = Form::kList, .sections = kPatternOnly, .text = "a row for each pair of a camera and a light"},
    Key{.name = "frames", .form = Form::kList, .sections = kFrameOnly, .text = "one row a file; it takes the place of a pattern's row for the same pair"},
};
// clang-format on

template <std::size_t A, std::size_t B>
constexpr std::array<Key, A + B> joined(const std::array<Key, A>& a, const std::array<Key, B>& b) {
  std::array<Key, A + B> out{};
  for (std::size_t i = 0; i < A; ++i) out[i] = a[i];
  for (std::size_t i = 0; i < B; ++i) out[A + i] = b[i];
  return out;
}
constexpr std::array kFrameKeys = joined(kPlaceKeys, kEncodingKeys);
constexpr std::array kPatternKeys = joined(kPatternOwnKeys, kEncodingKeys);

}  // namespace

const Section kCaptureSection{"capture", "The capture as a whole: capture.json.", kCaptureKeys};
const Section kPipelineSection{"pipeline", "From linear light to the screen, the same for photo and render.",
                               kPipelineKeys};
const Section kFlipSection{"flip", "The exposures over which HDR-FLIP looks for errors.", kFlipKeys};
const Section kVariantSection{"variant", "Renders of the same cameras and lights.", kVariantKeys};
const Section kCamerasSection{"cameras", "Who looked: cameras.json.", kCamerasKeys};
const Section kCameraSection{"camera", "One view.", kCameraKeys};
const Section kLayersSection{"layers", "Pictures that belong to a view and to no light.", kLayersKeys};
const Section kLightsSection{"lights", "What shone: lights.json.", kLightsKeys};
const Section kLightSection{"light", "One light.", kLightKeys};
const Section kFramesSection{"frames", "Which file shows what: frames.json.", kFramesKeys};
const Section kFrameSection{"frame", "One file.", kFrameKeys};
const Section kPatternSection{"pattern", "Files that are named after their pairs.", kPatternKeys};
const Section kEncodingSection{"encoding", "What the numbers of a file mean.", kEncodingKeys};

}  // namespace likeness::capture
