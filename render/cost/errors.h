#pragma once

#include <cstdint>
#include <vector>

#include "render/image/flip.h"
#include "render/image/picture.h"
#include "render/view/view.h"
#include "render/world/world.h"

// How far a picture is from the reference.
namespace likeness::scene_cost {

struct Errors {
  double relmse = 0;                       // of linear light at the scene's exposure, over all pixels
  double flip = 0;                         // mean, of what the screen shows
  double stops_median = 0, stops_p95 = 0;  // where there is a surface; NaN if there is none
};

// 1 where the ray through the middle of a pixel meets a surface of the scene, 0 on the background.
std::vector<std::uint8_t> mask_of(const world::World& world, std::size_t camera);

// Compares pictures with one reference.
class Judge {
 public:
  // `view` shows both; its exposure is that of the scene.
  Judge(image::Picture reference, std::vector<std::uint8_t> mask, const scene::View& view);

  struct Verdict {
    Errors errors;
    image::DisplayPicture shown;
    image::ErrorMap map;
  };
  Verdict judge(const image::Picture& picture) const;

  const image::Picture& reference() const { return reference_; }
  const image::DisplayPicture& shown() const { return shown_; }
  double share_of_surfaces() const;

 private:
  image::Picture reference_;
  std::vector<std::uint8_t> mask_;
  view::Shower shower_;
  image::DisplayPicture shown_;
  double epsilon_;  // of relMSE, in the unit of the pictures
};

// No wider than `most`: means of square blocks of pixels.
image::DisplayPicture reduced(const image::DisplayPicture& picture, int most);

}  // namespace likeness::scene_cost
