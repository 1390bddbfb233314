#include "render/command/scene_digest.h"

#include <optional>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "render/files/files.h"

namespace likeness::render_command {
namespace {

// Values after each other, without padding: what they are is known to whoever reads the same members in the same order.
class Bytes {
 public:
  template <class T>
    requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void put(const T& value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <glm::length_t N, class T>
  void put(const glm::vec<N, T>& v) {
    for (glm::length_t k = 0; k < N; ++k) put(v[k]);
  }
  void put(const glm::mat4& m) {
    for (int k = 0; k < 4; ++k) put(m[k]);
  }
  // Elements without padding, hashed where they lie: there may be gigabytes of them.
  template <class T>
  void put_all(const std::vector<T>& values) {
    put(values.size());
    bytes_ += files::sha256({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
  }
  void put(const scene::Texture& t) {
    put(t.image), put(t.transfer), put(t.wrap), put(t.channel), put(t.uv_scale), put(t.uv_offset);
    put(t.scale), put(t.offset);
  }
  template <class T>
  void put(const std::optional<T>& value) {
    put(value.has_value());
    if (value) put(*value);
  }
  std::string hash() const { return files::sha256(bytes_); }

 private:
  std::string bytes_;
};

void put(Bytes& out, const brdf::AnyBrdf& brdf) {
  out.put(brdf.index());
  std::visit(
      [&]<class M>(const M& model) {
        std::apply(
            [&](auto... members) {
              const auto value = [&]<class V>(const V& v) {
                if constexpr (std::is_arithmetic_v<V>) out.put(v);
                else out.put(v.r), out.put(v.g), out.put(v.b);
              };
              (value(model.*members), ...);
            },
            M::members());
      },
      brdf);
}

void put(Bytes& out, const scene::Material& m) {
  put(out, m.brdf);
  out.put(m.bindings.size());
  for (const auto& binding : m.bindings) out.put(binding.parameter), out.put(binding.texture);
  out.put(m.normal_map), out.put(m.normal_strength), out.put(m.diffuse_normal_map), out.put(m.opacity);
  out.put(m.opacity_cutoff), out.put(m.emission), out.put(m.emission_map), out.put(m.two_sided);
  if (!m.residual) return;  // others keep the digests that they had
  const scene::Material::BakedResidual& r = *m.residual;
  out.put(r.bake), out.put(r.strength), out.put(r.jitter), out.put(r.fade.has_value());
  if (r.fade)
    for (const brdf::Interval& between : {r.fade->base_color, r.fade->roughness, r.fade->normal})
      out.put(between.low), out.put(between.high);
}

void put(Bytes& out, const baked::Residual& bake) {
  out.put(bake.width), out.put(bake.height), out.put(bake.floor), out.put(bake.groups);
  for (std::size_t k = 0; k < bake.lobe_count; ++k) {
    const auto& lobe = bake.lobes.lobes[k];
    out.put(lobe.x), out.put(lobe.y), out.put(lobe.z), out.put(lobe.reach);
    for (const float scale : lobe.scale) out.put(scale);
  }
  out.put_all(bake.luminance), out.put_all(bake.rgb);
  if (bake.has_mixes()) {
    out.put_all(bake.mixed), out.put_all(bake.mixes.values), out.put(bake.mixes.decoded[1]);
    for (const auto& channel : bake.mixes.scale)
      for (std::size_t j = 0; j < bake.mixes.count; ++j) out.put(channel[j]);
  }
  if (!bake.surface) return;
  out.put_all(bake.surface->normals.rgb), out.put_all(bake.surface->base_colors.rgb);
  out.put(bake.surface->material.roughness);
  if (bake.surface->spread > 0 || bake.surface->least > 0) out.put(bake.surface->spread), out.put(bake.surface->least);
}

void put(Bytes& out, const scene::Light& light) {
  out.put(light.shape.index());
  struct Shapes {
    Bytes& out;
    void operator()(const scene::PointLight& l) { out.put(l.position), out.put(l.intensity); }
    void operator()(const scene::SpotLight& l) {
      out.put(l.position), out.put(l.direction), out.put(l.intensity), out.put(l.inner), out.put(l.outer);
    }
    void operator()(const scene::DirectionalLight& l) { out.put(l.direction), out.put(l.irradiance); }
    void operator()(const scene::RectangleLight& l) {
      out.put(l.center), out.put(l.half_u), out.put(l.half_v), out.put(l.radiance), out.put(l.two_sided);
    }
    void operator()(const scene::DiskLight& l) {
      out.put(l.center), out.put(l.normal), out.put(l.radius), out.put(l.radiance), out.put(l.two_sided);
    }
    void operator()(const scene::SphereLight& l) { out.put(l.center), out.put(l.radius), out.put(l.radiance); }
  };
  std::visit(Shapes{out}, light.shape);
  out.put(light.is_visible), out.put(light.range), out.put(light.profile);
  out.put(light.profile_axis), out.put(light.profile_zero);
}

void put(Bytes& out, const scene::Camera& c) {
  out.put(c.world_from_camera), out.put(c.width), out.put(c.height), out.put(c.focal_x), out.put(c.focal_y);
  out.put(c.center_x), out.put(c.center_y), out.put(c.lens_radius), out.put(c.focus_distance);
  if (c.is_orthographic) out.put(true);  // pinholes keep the digests that they had
}

}  // namespace

std::string digest_of(const scene::Scene& scene, std::size_t camera) {
  Bytes out;
  put(out, scene.cameras[camera]);
  for (const scene::Image& image : scene.images) {
    out.put(image.texels.width), out.put(image.texels.height), out.put(image.texels.channels);
    out.put_all(image.texels.bytes), out.put_all(image.texels.floats);
  }
  for (const baked::Residual& bake : scene.bakes) put(out, bake);
  for (const scene::Mesh& mesh : scene.meshes) {
    out.put(mesh.is_sphere), out.put_all(mesh.positions), out.put_all(mesh.normals), out.put_all(mesh.uvs);
    out.put_all(mesh.tangents), out.put_all(mesh.triangles);
  }
  for (const scene::Material& material : scene.materials) put(out, material);
  for (const scene::Instance& instance : scene.instances)
    out.put(instance.mesh), out.put(instance.material), out.put(instance.world_from_object);
  for (const scene::Profile& profile : scene.profiles) {
    out.put(profile.type), out.put_all(profile.vertical_deg), out.put_all(profile.horizontal_deg);
    out.put_all(profile.candela);
  }
  for (const scene::Light& light : scene.lights) put(out, light);
  if (scene.environment)
    out.put(scene.environment->image), out.put(scene.environment->scale), out.put(scene.environment->turn);
  // How many there are of each, so that the end of one list is not the beginning of the next.
  for (const std::size_t count : {scene.images.size(), scene.meshes.size(), scene.materials.size(),
                                  scene.instances.size(), scene.profiles.size(), scene.lights.size()})
    out.put(count);
  return out.hash();
}

}  // namespace likeness::render_command
