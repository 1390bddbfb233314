#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "render/sampling/sobol.h"
#include "render/surface/surfaces.h"

namespace likeness::surface {
namespace {

// One instance, and the point that a ray meets.
struct Bench {
  scene::Scene scene;
  Bench() {
    scene.meshes.resize(1);
    scene.materials.resize(1);
    scene.instances = {{"", 0, 0, glm::mat4(1)}};
  }
  // The square [-1, 1]^2 at z = 0, facing +z; u to the right, v down.
  void square() {
    scene::Mesh& mesh = scene.meshes[0];
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  }
  void map(const glm::vec3& normal) {
    scene.images = {{"", {1, 1, 3, {}, {0.5f * normal.x + 0.5f, 0.5f * normal.y + 0.5f, 0.5f * normal.z + 0.5f}}}};
    scene.materials[0].normal_map = scene::Texture{0};
  }
  template <Detail kDetail = Detail::kTextures, class F>
  void look(const glm::vec3& from, const glm::vec3& way, F&& f) const {
    const auto prepared = prepare_materials(scene);
    const ray::Tracer tracer(scene, {});
    const Surfaces surfaces(scene, tracer, prepared);
    const ray::Ray ray{from, 0, glm::normalize(way), ray::kFar};
    const ray::Hit hit = tracer.closest(ray);
    ASSERT_TRUE(hit.is_some());
    Point p;
    surfaces.at<kDetail>(ray, hit, p);
    f(p, surfaces);
  }
};
void expect_near(const glm::vec3& a, const glm::vec3& b, float tolerance = 1e-5f) {
  EXPECT_LT(glm::distance(a, b), tolerance)
      << a.x << " " << a.y << " " << a.z << " for " << b.x << " " << b.y << " " << b.z;
}

TEST(Surfaces, KnowWhereAPointIsAndWhichWayItFaces) {
  Bench s;
  s.square();
  for (const float side : {1.0f, -1.0f})
    s.look<Detail::kNone>({0.5f, 0.25f, 2 * side}, {0, 0, -side}, [&](const Point& p, const Surfaces&) {
      expect_near(p.position, {0.5f, 0.25f, 0});
      expect_near(p.normal, {0, 0, side});
      expect_near(p.shading_normal, {0, 0, side});
      EXPECT_EQ(p.is_back, side < 0);
      EXPECT_FALSE(p.is_black());
      EXPECT_NEAR(p.uv.x, 0.75f, 1e-6f);
      EXPECT_NEAR(p.uv.y, 0.375f, 1e-6f);
      expect_near(p.to_view, {0, 0, 1});
    });
  s.scene.materials[0].two_sided = false;
  s.look({0, 0, -2}, {0, 0, 1}, [](const Point& p, const Surfaces&) { EXPECT_TRUE(p.is_black()); });
  s.look({0, 0, 2}, {0, 0, -1}, [](const Point& p, const Surfaces&) { EXPECT_FALSE(p.is_black()); });
}

TEST(Surfaces, FaceAsTheirNormalsDoAndMirroredOnesToo) {
  Bench s;
  s.square();
  s.scene.materials[0].two_sided = false;
  const auto is_back = [&](float side) {
    bool out = false;
    s.look({0.2f, 0.1f, 3 * side}, {0, 0, -side}, [&](const Point& p, const Surfaces&) {
      out = p.is_back;
      expect_near(p.normal, {0, 0, side});
    });
    return out;
  };
  EXPECT_FALSE(is_back(1));
  EXPECT_TRUE(is_back(-1));
  s.scene.meshes[0].normals.assign(4, {0, 0, -1});  // against the order of corners
  EXPECT_TRUE(is_back(1));
  EXPECT_FALSE(is_back(-1));
  s.scene.meshes[0].normals.clear();
  s.scene.instances[0].world_from_object = glm::scale(glm::mat4(1), {-1, 1, 1});
  EXPECT_FALSE(is_back(1));  // the mirror image of a front is a front
  s.scene.meshes[0].normals.assign(4, {0, 0, 1});
  EXPECT_FALSE(is_back(1));
}

TEST(Surfaces, NormalsAreStraightUnderStretchedInstances) {
  Bench s;
  s.square();
  const glm::vec3 n = glm::normalize(glm::vec3(0.5f, 0, 1));
  s.scene.meshes[0].normals.assign(4, n);
  const glm::mat4 place = glm::rotate(glm::scale(glm::mat4(1), {3, 1, 0.5f}), 0.4f, glm::vec3(0, 1, 0));
  s.scene.instances[0].world_from_object = place;
  // A normal is square to every direction that is square to it before.
  const glm::vec3 along = glm::normalize(glm::cross(n, glm::vec3(0, 1, 0)));
  s.look(glm::vec3(0, 0, 5), {0, 0, -1}, [&](const Point& p, const Surfaces&) {
    EXPECT_NEAR(glm::dot(p.shading_normal, glm::normalize(glm::mat3(place) * along)), 0, 1e-5);
    EXPECT_NEAR(p.shading_normal.y, 0, 1e-5);
    EXPECT_GT(p.shading_normal.z, 0);
  });
}

TEST(Surfaces, ShadingNormalsFaceTheViewer) {
  Bench s;
  s.square();
  for (const glm::vec3& n :
       {glm::vec3(0.999f, 0, 0.04f), glm::vec3(1, 0, 1e-3f), glm::vec3(-1, 0, 0.2f), glm::vec3(0, 1, 0.1f)}) {
    s.scene.meshes[0].normals.assign(4, glm::normalize(n));
    for (const glm::vec3& view : {glm::vec3(1, 0, 0.01f), glm::vec3(-1, 0, 0.05f), glm::vec3(0.3f, -1, 0.2f),
                                  glm::vec3(-1, 0, -0.1f), glm::vec3(0, 0, 1)})
      s.look(2.0f * view, -view, [&](const Point& p, const Surfaces&) {
        EXPECT_GT(glm::dot(p.shading_normal, glm::normalize(view)), 5e-4f);
        EXPECT_NEAR(glm::length(p.shading_normal), 1, 1e-5);
        EXPECT_GT(p.to_view.z, 5e-4f);
        EXPECT_GT(glm::dot(p.normal, view), 0);
        expect_near(p.frame.world(p.to_view), glm::normalize(view));
      });
  }
}

TEST(Surfaces, SpheresHaveLongitudeAndLatitude) {
  Bench s;
  s.scene.meshes[0].is_sphere = true;
  s.scene.instances[0].world_from_object = glm::scale(glm::translate(glm::mat4(1), {1, 2, 3}), glm::vec3(2));
  const auto uv = [&](const glm::vec3& n) {
    glm::vec2 out;
    s.look(glm::vec3(1, 2, 3) + 5.0f * n, -n, [&](const Point& p, const Surfaces&) {
      out = p.uv;
      expect_near(p.position, glm::vec3(1, 2, 3) + 2.0f * n);
      expect_near(p.normal, n);
      EXPECT_FALSE(p.is_back);
    });
    return out;
  };
  EXPECT_NEAR(uv({0, 0, 1}).x, 0.5, 1e-5);
  EXPECT_NEAR(uv({1, 0, 0}).x, 0.75, 1e-5);  // to the right, seen from +z
  EXPECT_NEAR(uv({-1, 0, 0}).x, 0.25, 1e-5);
  EXPECT_NEAR(uv({0, 1, 0}).y, 0, 1e-3);
  EXPECT_NEAR(uv({0, -1, 0}).y, 1, 1e-3);
  EXPECT_NEAR(uv({0, 0, 1}).y, 0.5, 1e-5);
  s.scene.instances[0].world_from_object =
      glm::rotate(s.scene.instances[0].world_from_object, 1.5707963f, glm::vec3(0, 1, 0));
  EXPECT_NEAR(uv({1, 0, 0}).x, 0.5, 1e-4);                                     // its front has turned to +x
  s.look(glm::vec3(1, 2, 3), {0, 0, 1}, [](const Point& p, const Surfaces&) {  // from within
    expect_near(p.normal, {0, 0, -1});
    EXPECT_TRUE(p.is_back);
  });
}

// The mapped normal of the same place is the same surface from both sides: what is bent to one side in front is bent to
// it behind. On flat squares with and without tangents, spheres, and mirror images of each.
TEST(NormalMaps, BendTheSameWayInFrontAndBehind) {
  const glm::vec3 bent = glm::normalize(glm::vec3(0.3f, 0.2f, 1));
  for (const int kind : {0, 1, 2})  // with tangents, without, a sphere
    for (const bool is_mirrored : {false, true}) {
      SCOPED_TRACE(std::to_string(kind) + (is_mirrored ? " mirrored" : ""));
      Bench s;
      if (kind == 2) s.scene.meshes[0].is_sphere = true;
      else s.square();
      if (kind == 0) s.scene.meshes[0].tangents.assign(4, {1, 0, 0, 1}), s.scene.meshes[0].normals.assign(4, {0, 0, 1});
      s.map(bent);
      if (is_mirrored) s.scene.instances[0].world_from_object = glm::scale(glm::mat4(1), {-1, 1, 1});
      const glm::vec3 expected = is_mirrored ? glm::vec3(-bent.x, bent.y, bent.z) : bent;
      const auto seen = [&](float from, float way) {
        glm::vec3 n;
        s.look({0, 0, from}, {0, 0, way}, [&](const Point& p, const Surfaces&) { n = p.shading_normal; });
        return n;
      };
      const glm::vec3 front = seen(3, -1), back = kind == 2 ? seen(0, 1) : seen(-3, 1);
      if (kind != 1) {
        expect_near(front, expected);
      }
      expect_near(back, -front);
    }
}

TEST(NormalMaps, TakeTheirStrengthAndTheSideOfTheTangents) {
  Bench s;
  s.square();
  s.scene.meshes[0].normals.assign(4, {0, 0, 1});
  s.scene.meshes[0].tangents.assign(4, {0, 1, 0, -1});
  s.map(glm::normalize(glm::vec3(0.3f, 0.2f, 1)));
  s.scene.materials[0].normal_strength = 2;
  s.look({0, 0, 3}, {0, 0, -1}, [](const Point& p, const Surfaces&) {
    // x along +y; y along -(z cross y) = +x.
    expect_near(p.shading_normal, glm::normalize(glm::vec3(0.4f, 0.6f, 1)));
  });
  // Not read without textures.
  s.look<Detail::kNone>({0, 0, 3}, {0, 0, -1},
                        [](const Point& p, const Surfaces&) { expect_near(p.shading_normal, {0, 0, 1}); });
}

TEST(NormalMaps, OfDualNormalsAreInTheFrameOfTheSurface) {
  Bench s;
  s.square();
  s.scene.meshes[0].normals.assign(4, {0, 0, 1});
  s.scene.meshes[0].tangents.assign(4, {1, 0, 0, 1});
  s.map(glm::normalize(glm::vec3(0.3f, 0.2f, 1)));
  s.scene.images.push_back({"", {1, 1, 3, {}, {0.5f, 0.5f, 1}}});
  s.scene.materials[0].diffuse_normal_map = scene::Texture{1};
  for (const float side : {1.0f, -1.0f})
    s.look({0, 0, 3 * side}, {0, 0, -side}, [&](const Point& p, const Surfaces&) {
      expect_near(p.frame.world(p.bound.specular_normal), side * glm::normalize(glm::vec3(0.3f, 0.2f, 1)));
      expect_near(p.frame.world(p.bound.diffuse_normal), {0, 0, side});
      expect_near(p.shading_normal, {0, 0, side});
    });
}

TEST(Emission, IsThatOfTheMaterialTimesItsMap) {
  Bench s;
  s.square();
  s.scene.materials[0].emission = {2, 4, 8};
  s.look({0, 0, 3}, {0, 0, -1},
         [](const Point& p, const Surfaces& surfaces) { EXPECT_EQ(surfaces.emission(p), glm::vec3(2, 4, 8)); });
  s.scene.images = {{"", {1, 1, 3, {}, {0.5f, -1, 2}}}};
  s.scene.materials[0].emission_map = scene::Texture{0};
  s.look({0, 0, 3}, {0, 0, -1},
         [](const Point& p, const Surfaces& surfaces) { EXPECT_EQ(surfaces.emission(p), glm::vec3(1, 0, 16)); });
  s.scene.materials[0].two_sided = false;
  s.look({0, 0, -3}, {0, 0, 1},
         [](const Point& p, const Surfaces& surfaces) { EXPECT_EQ(surfaces.emission(p), glm::vec3(0)); });
}

TEST(Point, NothingIsLitFromBehindItsTriangle) {
  Bench s;
  s.square();
  s.scene.meshes[0].normals.assign(4, glm::normalize(glm::vec3(1, 0, 1)));
  s.look({0, 0, 3}, {0, 0, -1}, [](const Point& p, const Surfaces&) {
    const glm::vec3 below = glm::normalize(glm::vec3(1, 0, -0.2f));  // above the shading normal's horizon
    EXPECT_GT(glm::dot(below, p.shading_normal), 0);
    EXPECT_EQ(p.eval(below).f_cos, glm::vec3(0));
    EXPECT_EQ(p.lobes(below).diffuse, glm::vec3(0));
    for (std::uint32_t i = 0; i < 2000; ++i) {
      sampling::Samples r(i, 0, 1);
      const Direction d = p.sample(r.next().x, r.next());
      if (d.pdf > 0) {
        ASSERT_GT(glm::dot(d.to_light, p.normal), 0);
        ASSERT_GT(glm::dot(d.to_light, p.shading_normal), 0);
      }
    }
  });
}

}  // namespace
}  // namespace likeness::surface
