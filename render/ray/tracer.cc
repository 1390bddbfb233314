#include "render/ray/tracer.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include <embree3/rtcore.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "render/ray/offset.h"

namespace likeness::ray {
namespace {

constexpr auto kSurfaces = static_cast<unsigned>(Seen::kSurfaces), kLights = static_cast<unsigned>(Seen::kLights);

struct Device {
  RTCDevice handle = rtcNewDevice(nullptr);
  Device() {
    if (handle == nullptr) throw std::runtime_error("Embree cannot start on this machine");
  }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  ~Device() { rtcReleaseDevice(handle); }
};

glm::vec3 transformed(const glm::mat4& m, const glm::vec3& p) { return glm::vec3(m * glm::vec4(p, 1)); }

// The radius of the unit sphere under m, or 0 if it becomes something else.
float radius_under(const glm::mat4& m) {
  const glm::vec3 x(m[0]), y(m[1]), z(m[2]);
  const float a = glm::dot(x, x), b = glm::dot(y, y), c = glm::dot(z, z), off = 1e-5f * a;
  const bool is_similar = std::abs(a - b) < off && std::abs(a - c) < off && std::abs(glm::dot(x, y)) < off &&
                          std::abs(glm::dot(x, z)) < off && std::abs(glm::dot(y, z)) < off;
  return is_similar ? std::sqrt(a) : 0.0f;
}

// How large a place each number takes in a buffer of Embree.
float* new_points(RTCGeometry geometry, RTCFormat format, std::size_t floats, std::size_t count) {
  return static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, format, floats * sizeof(float), count));
}

struct FilterContext {
  CutOuts cut_outs;
  scene::Index instance;
};

void filter(const RTCFilterFunctionNArguments* a) {
  const auto& context = *static_cast<const FilterContext*>(a->geometryUserPtr);
  for (unsigned i = 0; i < a->N; ++i) {
    if (a->valid[i] == 0) continue;
    const RTCHit hit = rtcGetHitFromHitN(a->hit, a->N, i);
    if (!context.cut_outs.is_solid(context.cut_outs.context, context.instance, hit.primID, hit.u, hit.v))
      a->valid[i] = 0;
  }
}

// Whether Embree may be given a ray. It ends the process, by an assertion, at what is no number or beyond 1.8e18. Always
// inlined: packets ask it for each lane.
[[gnu::always_inline]] inline bool is_sound(const Ray& ray) {
  const glm::vec3 sum = glm::abs(ray.origin) + glm::abs(ray.direction);
  return ray.near <= ray.far && sum.x + sum.y + sum.z <= 1e18f;
}

template <class Packet>
void put(Packet& packet, unsigned lane, const Ray& ray, unsigned mask) {
  packet.org_x[lane] = ray.origin.x, packet.org_y[lane] = ray.origin.y, packet.org_z[lane] = ray.origin.z;
  packet.dir_x[lane] = ray.direction.x, packet.dir_y[lane] = ray.direction.y, packet.dir_z[lane] = ray.direction.z;
  packet.tnear[lane] = ray.near, packet.tfar[lane] = ray.far;
  packet.time[lane] = 0, packet.mask[lane] = mask, packet.id[lane] = lane, packet.flags[lane] = 0;
}

RTCRay ray_of(const Ray& ray, unsigned mask) {
  return {ray.origin.x,
          ray.origin.y,
          ray.origin.z,
          ray.near,
          ray.direction.x,
          ray.direction.y,
          ray.direction.z,
          0,
          ray.far,
          mask,
          0,
          0};
}

constexpr RTCIntersectContext context_for(bool is_coherent) {
  RTCIntersectContext context{};
  context.flags = is_coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  for (unsigned& id : context.instID) id = RTC_INVALID_GEOMETRY_ID;
  return context;
}

void closest_packet(RTCScene scene, const int* valid, RTCRayHit8& packet) {
  RTCIntersectContext context = context_for(true);
  rtcIntersect8(valid, scene, &context, &packet);
}
void closest_packet(RTCScene scene, const int* valid, RTCRayHit16& packet) {
  RTCIntersectContext context = context_for(true);
  rtcIntersect16(valid, scene, &context, &packet);
}
void occluded_packet(RTCScene scene, const int* valid, RTCRay8& packet) {
  RTCIntersectContext context = context_for(true);
  rtcOccluded8(valid, scene, &context, &packet);
}
void occluded_packet(RTCScene scene, const int* valid, RTCRay16& packet) {
  RTCIntersectContext context = context_for(true);
  rtcOccluded16(valid, scene, &context, &packet);
}

template <class Packet, unsigned kSize>
void closest_in_packets(RTCScene scene, std::span<const Ray> rays, std::span<Hit> hits) {
  for (std::size_t first = 0; first < rays.size(); first += kSize) {
    alignas(64) int valid[kSize];
    alignas(64) Packet packet;
    const auto count = static_cast<unsigned>(std::min<std::size_t>(kSize, rays.size() - first));
    bool any = false;
    for (unsigned i = 0; i < kSize; ++i) {
      const Ray& ray = rays[first + (i < count ? i : 0)];
      valid[i] = i < count && is_sound(ray) ? -1 : 0;
      any |= valid[i] != 0;
      put(packet.ray, i, ray, kSurfaces | kLights);
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    if (any) closest_packet(scene, valid, packet);
    for (unsigned i = 0; i < count; ++i) {
      const bool is_hit = valid[i] != 0 && packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
      hits[first + i] = is_hit ? Hit{packet.ray.tfar[i],   packet.hit.u[i],
                                     packet.hit.v[i],      packet.hit.geomID[i],
                                     packet.hit.primID[i], {packet.hit.Ng_x[i], packet.hit.Ng_y[i], packet.hit.Ng_z[i]}}
                               : Hit{};
    }
  }
}

template <class Packet, unsigned kSize>
void occluded_in_packets(RTCScene scene, std::span<const Ray> rays, std::span<std::uint8_t> is_occluded) {
  for (std::size_t first = 0; first < rays.size(); first += kSize) {
    alignas(64) int valid[kSize];
    alignas(64) Packet packet;
    const auto count = static_cast<unsigned>(std::min<std::size_t>(kSize, rays.size() - first));
    bool any = false;
    for (unsigned i = 0; i < kSize; ++i) {
      const Ray& ray = rays[first + (i < count ? i : 0)];
      valid[i] = i < count && is_sound(ray) ? -1 : 0;
      any |= valid[i] != 0;
      put(packet, i, ray, kSurfaces);
    }
    if (any) occluded_packet(scene, valid, packet);
    for (unsigned i = 0; i < count; ++i) is_occluded[first + i] = valid[i] != 0 && packet.tfar[i] < 0 ? 1 : 0;
  }
}

}  // namespace

struct Tracer::State {
  Device device;
  RTCScene scene = nullptr;
  std::vector<FilterContext> filters;  // one for each instance: its address is given to Embree
  std::vector<const float*> vertices;  // of each instance
  bool has_wide_packets = false;
  std::size_t triangles = 0;
  std::ptrdiff_t bytes = 0;

  ~State() {
    if (scene != nullptr) rtcReleaseScene(scene);
  }

  static bool count_memory(void* self, ssize_t bytes, bool) {
    __atomic_fetch_add(&static_cast<State*>(self)->bytes, bytes, __ATOMIC_RELAXED);
    return true;
  }

  void check() const {
    const RTCError error = rtcGetDeviceError(device.handle);
    if (error == RTC_ERROR_NONE) return;
    throw std::runtime_error(error == RTC_ERROR_OUT_OF_MEMORY
                                 ? "no memory is left for the tree of the scene's triangles"
                                 : "Embree failed, code " + std::to_string(error));
  }

  void attach(RTCGeometry geometry, std::size_t id, unsigned mask) {
    rtcSetGeometryMask(geometry, mask);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, static_cast<unsigned>(id));
    rtcReleaseGeometry(geometry);
    check();
  }

  RTCGeometry sphere(const glm::vec3& center, float radius) const {
    RTCGeometry geometry = rtcNewGeometry(device.handle, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    float* point = new_points(geometry, RTC_FORMAT_FLOAT4, 4, 1);
    point[0] = center.x, point[1] = center.y, point[2] = center.z, point[3] = radius;
    return geometry;
  }
  RTCGeometry disk(const scene::DiskLight& light) const {
    RTCGeometry geometry = rtcNewGeometry(device.handle, RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT);
    float* point = new_points(geometry, RTC_FORMAT_FLOAT4, 4, 1);
    const glm::vec3 center = light.two_sided ? light.center : beside(light.center, light.normal);
    point[0] = center.x, point[1] = center.y, point[2] = center.z, point[3] = light.radius;
    auto* normal = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_NORMAL, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 1));
    normal[0] = light.normal.x, normal[1] = light.normal.y, normal[2] = light.normal.z;
    return geometry;
  }
  RTCGeometry triangles_of(std::span<const glm::vec3> positions, std::span<const std::array<scene::Index, 3>> corners,
                           const glm::mat4& world_from_object, std::size_t instance) {
    RTCGeometry geometry = rtcNewGeometry(device.handle, RTC_GEOMETRY_TYPE_TRIANGLE);
    float* at = new_points(geometry, RTC_FORMAT_FLOAT3, 3, positions.size());
    vertices[instance] = at;
    for (const glm::vec3& p : positions) {
      const glm::vec3 world = transformed(world_from_object, p);
      *at++ = world.x, *at++ = world.y, *at++ = world.z;
    }
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, corners.data(), 0,
                               3 * sizeof(scene::Index), corners.size());
    triangles += corners.size();
    return geometry;
  }
  // A light of one side is put a little before where it is, so that it is met before a wall that it is flush with.
  RTCGeometry rectangle(const scene::RectangleLight& light) {
    const glm::vec3 cross = glm::cross(light.half_u, light.half_v);
    const float area = glm::length(cross);
    const glm::vec3 normal = light.two_sided || !(area > 0) ? glm::vec3(0) : cross / area;
    RTCGeometry geometry = rtcNewGeometry(device.handle, RTC_GEOMETRY_TYPE_QUAD);
    float* at = new_points(geometry, RTC_FORMAT_FLOAT3, 3, 4);
    for (const auto& [u, v] : {std::pair{-1.f, -1.f}, {1.f, -1.f}, {1.f, 1.f}, {-1.f, 1.f}}) {
      const glm::vec3 p = beside(light.center + u * light.half_u + v * light.half_v, normal);
      *at++ = p.x, *at++ = p.y, *at++ = p.z;
    }
    auto* corner = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 4 * sizeof(unsigned), 1));
    for (unsigned i = 0; i < 4; ++i) corner[i] = i;
    return geometry;
  }
};

Tracer::Tracer(const scene::Scene& scene, const TracerOptions& options) : state_(std::make_unique<State>()) {
  State& s = *state_;
  rtcSetDeviceMemoryMonitorFunction(s.device.handle, &State::count_memory, &s);
  s.has_wide_packets = rtcGetDeviceProperty(s.device.handle, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
  s.scene = rtcNewScene(s.device.handle);
  rtcSetSceneBuildQuality(s.scene, RTC_BUILD_QUALITY_HIGH);
  rtcSetSceneFlags(s.scene, options.is_watertight ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);

  s.filters.resize(scene.instances.size());
  s.vertices.resize(scene.instances.size(), nullptr);
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const scene::Instance& instance = scene.instances[i];
    const scene::Mesh& mesh = scene.meshes[instance.mesh];
    const float radius = mesh.is_sphere ? radius_under(instance.world_from_object) : 0.0f;
    if (!mesh.is_sphere && mesh.triangles.empty()) continue;
    if (mesh.is_sphere && radius == 0)
      throw std::runtime_error("instance \"" + instance.name + "\": a sphere that is stretched or sheared");
    RTCGeometry geometry = mesh.is_sphere
                               ? s.sphere(glm::vec3(instance.world_from_object[3]), radius)
                               : s.triangles_of(mesh.positions, mesh.triangles, instance.world_from_object, i);
    if (options.has_cut_outs && scene.materials[instance.material].opacity) {
      s.filters[i] = {options.cut_outs, static_cast<scene::Index>(i)};
      rtcSetGeometryUserData(geometry, &s.filters[i]);
      rtcSetGeometryIntersectFilterFunction(geometry, &filter);
      rtcSetGeometryOccludedFilterFunction(geometry, &filter);
    }
    s.attach(geometry, i, kSurfaces);
  }
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    if (!scene.lights[i].is_visible) continue;
    const std::size_t id = scene.instances.size() + i;
    const scene::LightShape& shape = scene.lights[i].shape;
    if (const auto* rectangle = std::get_if<scene::RectangleLight>(&shape))
      s.attach(s.rectangle(*rectangle), id, kLights);
    if (const auto* disk = std::get_if<scene::DiskLight>(&shape)) s.attach(s.disk(*disk), id, kLights);
    if (const auto* sphere = std::get_if<scene::SphereLight>(&shape))
      s.attach(s.sphere(sphere->center, sphere->radius), id, kLights);
  }
  rtcCommitScene(s.scene);
  s.check();
}

Tracer::~Tracer() = default;

Hit Tracer::closest(const Ray& ray, Seen seen) const {
  if (!is_sound(ray)) return {};
  RTCIntersectContext context = context_for(false);
  RTCRayHit query{};
  query.ray = ray_of(ray, static_cast<unsigned>(seen));
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(state_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return {query.ray.tfar,   query.hit.u,      query.hit.v,
          query.hit.geomID, query.hit.primID, {query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z}};
}

bool Tracer::occluded(const Ray& ray) const {
  if (!is_sound(ray)) return false;
  RTCIntersectContext context = context_for(false);
  RTCRay query = ray_of(ray, kSurfaces);
  rtcOccluded1(state_->scene, &context, &query);
  return query.tfar < 0;
}

void Tracer::closest(std::span<const Ray> rays, std::span<Hit> hits) const {
  if (state_->has_wide_packets) closest_in_packets<RTCRayHit16, 16>(state_->scene, rays, hits);
  else closest_in_packets<RTCRayHit8, 8>(state_->scene, rays, hits);
}

void Tracer::occluded(std::span<const Ray> rays, std::span<std::uint8_t> is_occluded) const {
  if (state_->has_wide_packets) occluded_in_packets<RTCRay16, 16>(state_->scene, rays, is_occluded);
  else occluded_in_packets<RTCRay8, 8>(state_->scene, rays, is_occluded);
}

const float* Tracer::vertices(scene::Index instance) const { return state_->vertices[instance]; }
std::size_t Tracer::triangles() const { return state_->triangles; }
std::size_t Tracer::bytes() const { return static_cast<std::size_t>(std::max<std::ptrdiff_t>(state_->bytes, 0)); }

}  // namespace likeness::ray
