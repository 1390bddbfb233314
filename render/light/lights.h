#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "render/light/environment.h"
#include "render/ray/tracer.h"
#include "render/sampling/distribution.h"
#include "render/scene/scene.h"

// All that shines in a scene: its lights, its emissive surfaces, its environment.
namespace likeness::light {

// A direction towards a light, as seen from a point.
struct Sample {
  glm::vec3 to_light{0, 0, 1};  // unit
  float distance = 0;           // ray::kFar: infinitely far
  // What f cos_i is multiplied by: radiance / pdf, or of a light without size intensity / distance^2 (over the
  // probability of the choice).
  glm::vec3 value{0, 0, 0};
  float pdf = 0;  // [1/sr], choice included; 0: nothing but this choice finds the light
  std::size_t light = 0;

  bool is_some() const { return value.r > 0 || value.g > 0 || value.b > 0; }
};

// A triangle that emits.
struct Emitter {
  scene::Index instance = scene::kNone;
  std::vector<glm::vec3> corners;  // three for each triangle, world
  std::vector<float> areas;        // [m^2]
  sampling::Distribution triangles;
  glm::vec3 radiance{0, 0, 0};  // of the material, before its texture
  glm::vec3 center{0, 0, 0};
  float reach = 0;  // radius of a sphere about it
  float area = 0;
  glm::mat3 normal_from_object{1};
  bool is_mirrored = false;  // by its instance, so that the order of corners says the other side
};

// Whether many directions lead to it: the others are points, or infinitely far.
bool has_area(const scene::Light& light);

class Lights {
 public:
  // Keeps pointers into the scene.
  explicit Lights(const scene::Scene& scene);

  // Lights of the scene first, then emitters, then the environment if directions are chosen by it.
  std::size_t count() const { return scene_->lights.size() + emitters_.size() + (samples_environment() ? 1 : 0); }
  bool is_empty() const { return count() == 0; }
  // Whether sample() reads its numbers at all: `choice` of several lights, `u` of one that has a size.
  bool reads_choice() const { return count() > 1; }
  bool reads_point() const { return reads_point_; }

  const std::optional<Environment>& environment() const { return environment_; }
  bool samples_environment() const { return environment_ && environment_->has_picture(); }
  std::size_t environment_index() const { return scene_->lights.size() + emitters_.size(); }

  // One light for a point with a normal (unit): more likely those that may send more. The probability of the choice is in
  // value and pdf. `choice` is used up.
  Sample sample(const glm::vec3& point, const glm::vec3& normal, float choice, const glm::vec2& u) const {
    return sample_(*this, point, normal, choice, u);
  }

  // A direction to light `index`, as if it were the only one.
  Sample sample_light(std::size_t index, const glm::vec3& point, const glm::vec2& u) const;

  // What a direction (unit) from a point meets of light `index`, as if it were the only one and nothing hid it: its
  // radiance, its distance, and the density with which sample_light() gives that direction. Nothing (value 0) of lights
  // without an area, those that are not visible, and surfaces that shine.
  Sample meet(std::size_t index, const glm::vec3& point, const glm::vec3& direction) const;

  // What a ray that met a light of the scene, with its geometric normal there, sees: 0 from the back of a one-sided one,
  // and from within a sphere.
  glm::vec3 radiance(std::size_t light, const glm::vec3& direction, float distance, const glm::vec3& normal) const;

  // The density with which sample() gives a direction that meets: a light of the scene, a triangle of an emissive
  // instance (with its geometric normal), the environment.
  float light_pdf(std::size_t light, const glm::vec3& point, const glm::vec3& normal, const glm::vec3& direction,
                  float distance) const;
  float emitter_pdf(scene::Index instance, scene::Index triangle, const glm::vec3& point, const glm::vec3& normal,
                    const glm::vec3& direction, float distance, const glm::vec3& surface_normal) const;
  float environment_pdf(const glm::vec3& point, const glm::vec3& normal, const glm::vec3& direction) const;

 private:
  // The ways of sample(), of which the scene needs one.
  static Sample nothing(const Lights&, const glm::vec3&, const glm::vec3&, float, const glm::vec2&);
  static Sample bare_point(const Lights&, const glm::vec3& point, const glm::vec3&, float, const glm::vec2&);
  static Sample the_one(const Lights&, const glm::vec3& point, const glm::vec3&, float, const glm::vec2& u);
  static Sample one_of_many(const Lights&, const glm::vec3& point, const glm::vec3& normal, float choice,
                            const glm::vec2& u);

  float weight(std::size_t index, const glm::vec3& point, const glm::vec3& normal) const;
  float probability(std::size_t index, const glm::vec3& point, const glm::vec3& normal) const;
  std::size_t choose(const glm::vec3& point, const glm::vec3& normal, float choice, float& probability) const;
  Sample sample_emitter(const Emitter& emitter, const glm::vec3& point, const glm::vec2& u) const;
  float attenuation(const scene::Light& light, float distance) const;

  const scene::Scene* scene_;
  std::vector<float> largest_candela_;  // of each profile
  std::vector<Emitter> emitters_;
  std::vector<std::size_t> emitter_of_;  // of each instance; npos: it does not emit
  std::optional<Environment> environment_;
  bool reads_point_ = false;
  decltype(&Lights::nothing) sample_ = &Lights::nothing;
};

}  // namespace likeness::light
