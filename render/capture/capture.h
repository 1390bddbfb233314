#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

// A capture as plain values: who looked (cameras), what shone (lights), which file shows which (frames). Photographs of one
// subject, one light at a time (OLAT), in the layout of docs/capture.md. Nothing here opens a picture.
//
// World       right-handed, metres; `up` says which axis points up (scenes have y up).
// Cameras     OpenCV's axes: x right, y down, z forward. Pixel (0, 0) is the top left corner of the picture.
// Ids         are text, unique in their list; a frame names its camera and its light by id. Indices are positions in the
//             lists of this capture and are written nowhere.
namespace likeness::capture {

// How a lens bends the picture: what Camera::distortion holds, as OpenCV has it. x and y are those of a point of the camera,
// divided by z.
enum class Lens : unsigned char {
  kBrownConrady,  // k1 k2 p1 p2 k3 k4 k5 k6: (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6), and p1, p2 aside
  kFisheye  // k1 k2 k3 k4: theta (1 + k1 theta^2 + ... + k4 theta^8) is the distance from the middle
};
inline constexpr std::array<std::string_view, 2> kLenses{"brown_conrady", "fisheye"};
inline constexpr std::array<std::size_t, 2> kLensTerms{8, 4};

struct Camera {
  std::string id, label;
  int width = 0, height = 0;     // [pixel]
  bool is_orthographic = false;  // focal lengths are then pixels a metre
  glm::dmat3 intrinsics{1};      // K, acts on column vectors: u = fx x / z + cx, v = fy y / z + cy [pixel]
  Lens lens = Lens::kBrownConrady;
  std::array<double, 8> distortion{};  // of the lens; what the files hold unless is_undistorted
  bool is_undistorted = true;
  glm::dmat4 world_from_camera{1};
  glm::dmat3 rec709_from_camera{1};  // what linear colors of frames with Primaries::kCamera are multiplied by
};

// A light that is so far away that it shines from one direction.
struct DistantLight {
  glm::dvec3 to_light{0, 0, 1};  // unit, from the subject
};
// A light at a place, which falls off with the square of the distance.
struct NearLight {
  glm::dvec3 position{0, 0, 1};  // [m]
};
struct Light {
  std::string id, label;
  std::variant<std::monostate, DistantLight, NearLight> place;  // monostate: not known
  // What linear pixels of a photo are divided by. Relative: 1, 1, 1 is the capture's unit light.
  glm::dvec3 intensity{1, 1, 1};
  std::string calibrated_by;  // how place and intensity are known: a file, a command, a person
};

// What a photo was taken in.
enum class FrameKind : unsigned char {
  kOneLight,  // of Frame::light
  kFull,      // all lights
  kAmbient,   // none: what is subtracted
  kGradient,  // a pattern; Frame::light names it
  // Of Frame::light, through a polarizer that is crossed with the light's: without what shines at the surface. The frame of one
  // light is then the one through parallel polarizers, and both show the same of what comes from inside.
  kCrossed
};
inline constexpr std::array<std::string_view, 5> kFrameKinds{"one_light", "full", "ambient", "gradient", "crossed"};
constexpr bool is_of_one_light(FrameKind kind) { return kind == FrameKind::kOneLight || kind == FrameKind::kCrossed; }

// What the numbers of a file mean. Never guessed: an importer is told, or asks.
enum class Transfer : unsigned char {
  kLinear,  // in proportion to light
  kSrgb,    // IEC 61966-2-1
  kRec709,  // ITU-R BT.709 camera curve
  kGamma22  // a power of 2.2
};
inline constexpr std::array<std::string_view, 4> kTransfers{"linear", "srgb", "rec709", "gamma22"};

enum class Primaries : unsigned char { kRec709, kAcesCg, kCamera };
inline constexpr std::array<std::string_view, 3> kPrimaries{"rec709", "acescg", "camera"};

struct Frame {
  std::size_t camera = 0;  // in Capture::cameras
  std::size_t light = 0;   // in Capture::lights, if is_of_one_light(kind)
  FrameKind kind = FrameKind::kOneLight;
  std::filesystem::path file;  // relative to the capture's root, or absolute
  Transfer transfer = Transfer::kLinear;
  Primaries primaries = Primaries::kRec709;
  double black = 0, white = 1;  // values of the decoded file that stand for no light and for 1
  double clip = 1;              // at and above it [after black and white] the sensor was full; infinity: never
  double gain = 1;              // linear pixels are multiplied by it (for exposures that differ)
  std::optional<double> exposure_s{}, iso{}, f_number{};
  std::string sha256{};  // of the file; empty: not taken
};

// Layers that belong to a camera's picture and to no light.
enum class Layer : unsigned char { kMask, kNormal, kPosition, kUv, kAlbedo, kFlatField };
inline constexpr std::array<std::string_view, 6> kLayers{"mask", "normal", "position", "uv", "albedo", "flat_field"};
struct LayerFile {
  std::size_t camera = 0;
  Layer layer = Layer::kMask;
  std::filesystem::path file;
};

// Renders of the same cameras and lights by one scene and one renderer.
struct Variant {
  std::string id;
  // Of the file of a pair, relative to the root, with {camera} and {light} for their ids.
  std::string pattern;
};

// How linear light of both pictures gets onto the screen: the same for both, always.
struct Pipeline {
  std::string match_gain =
      "none";               // none | capture | light | channel: what a render is multiplied by before it is compared
  double ev = 0;            // [stop]
  std::string view = "gt";  // of render/view
};

struct Capture {
  std::filesystem::path root;  // the folder of capture.json
  std::string name;
  glm::dvec3 up{0, 1, 0};
  std::vector<Camera> cameras;
  std::vector<Light> lights;
  std::vector<Frame> frames;
  std::vector<LayerFile> layers;
  std::vector<Variant> variants;
  Pipeline pipeline;
  // Of each camera, linear [the photo's unit], or empty: not measured. 0 of a camera: not measured there.
  std::vector<glm::dvec3> noise_floor;
  double flip_first_ev = -4, flip_last_ev = 3;  // exposures that HDR-FLIP takes, the same for the whole capture
  std::string license, citation, source;
};

inline constexpr std::size_t kAbsent = ~std::size_t{0};

// Whether a text can be an id.
bool is_id(std::string_view text);

// Position of an id in its list, or kAbsent.
std::size_t camera_of(const Capture& capture, std::string_view id);
std::size_t light_of(const Capture& capture, std::string_view id);
std::size_t variant_of(const Capture& capture, std::string_view id);
// The first variant of which a render is there (looks at the names of files); else the first; kAbsent if there is none.
std::size_t rendered_variant_of(const Capture& capture);

// The frame of a camera under one light, in O(1) after O(frames) once; kAbsent where there is none. If there are several,
// the first.
class FrameTable {
 public:
  explicit FrameTable(const Capture& capture);
  std::size_t frame(std::size_t camera, std::size_t light) const;
  std::size_t crossed(std::size_t camera, std::size_t light) const;  // of FrameKind::kCrossed

 private:
  std::size_t lights_;
  std::vector<std::size_t> frames_, crossed_;
};

// A pattern with {camera}, {light} and {variant} replaced; other braces stay.
std::string filled(std::string_view pattern, std::string_view camera, std::string_view light,
                   std::string_view variant = {});

// The file of a render, or of a layer, below the root or absolute; a layer that the camera does not have: an empty path.
std::filesystem::path render_file(const Capture& capture, const Variant& variant, std::size_t camera,
                                  std::size_t light);
std::filesystem::path photo_file(const Capture& capture, const Frame& frame);
std::filesystem::path layer_file(const Capture& capture, std::size_t camera, Layer layer);

}  // namespace likeness::capture
