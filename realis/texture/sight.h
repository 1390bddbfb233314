#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "realis/texture/texel_surface.h"
#include "realis/weight/stretch.h"
#include "render/capture/capture.h"

// Which texels a camera sees, and where in its picture.
namespace likeness::realis {

// The camera's map from the world to its picture: pixels, (0, 0) is the top left corner.
class Projection {
 public:
  // Throws files::UsageError for photographs with lens distortion.
  explicit Projection(const capture::Camera& camera);

  struct Place {
    double x = 0, y = 0, depth = 0;  // [pixel], [m] along the view; seen only where depth > 0
  };
  Place of(const glm::dvec3& point) const;
  // How the place moves with the point: by `step` [m] in the world, to first order [pixel].
  std::array<double, 2> moved(const glm::dvec3& point, const glm::dvec3& step) const;
  glm::dvec3 to_view(const glm::dvec3& point) const;  // unit, to the camera
  bool is_orthographic() const { return camera_.is_orthographic; }
  glm::dvec3 position() const { return position_; }
  // The ray of light that a pixel's middle sees, and the width of a pixel at a depth [m].
  ray::Ray ray(int x, int y) const;
  double pixel_width(double depth) const;
  // Where the picture of an orthographic camera starts, so that nothing of the scene is behind it.
  void step_back(double distance) { back_ = distance; }

 private:
  capture::Camera camera_;
  glm::dmat4 camera_from_world_;
  glm::dmat3 inverse_;  // of the intrinsics
  glm::dvec3 position_, axis_;
  double back_ = 0;
};

// A texel in a picture.
struct Seen {
  std::uint32_t texel;
  float x, y;                    // [pixel], of its middle
  std::array<float, 2> right,    // how many pixels one texel to the right is,
      down;                      // and one down
  float gradient, strength = 0;  // |d(texture) / d(clip space)|, of the texture's width; b g^a of the stretch weight
};

// Pixels that see the object and nothing else: neither the ends of the object nor a jump of its depth is beside them.
struct PictureSurface {
  std::vector<std::uint32_t> pixels;  // rising
  std::vector<glm::vec3> positions, normals;
};

struct CameraSight {
  std::vector<Seen> seen;  // rising in texel
  PictureSurface picture;
};

// A texel is seen if its front faces the camera, its middle is inside the picture, and no surface of the scene is between.
CameraSight sight_of(const world::World& world, scene::Index instance, const Unwrapped& unwrapped,
                     const TexelSurface& surface, const capture::Camera& camera);

// Fills in strengths: gradients over their median in all pictures (each texel counts as many pixels as it covers), so that a
// camera that is farther away than the others, or sees at a slant, is drawn out more.
void stretch_all(std::vector<CameraSight>& sights, const weight::StretchSettings& settings);

}  // namespace likeness::realis
