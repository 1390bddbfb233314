#pragma once

#include <glm/vec3.hpp>

#include "brdf/scalar.h"

namespace likeness::brdf {

// Three components of any scalar. glm::vec cannot hold a Jet (its members share a union), so the
// evaluators carry their own triple; a glm::vec3 or glm::dvec3 converts where a direction is expected.
template <Scalar S>
struct Vec3 {
  S x, y, z;

  Vec3() : x(0.0), y(0.0), z(0.0) {}
  Vec3(const S& x_, const S& y_, const S& z_) : x(x_), y(y_), z(z_) {}
  template <class T>
  explicit Vec3(const Vec3<T>& v) : x(S(v.x)), y(S(v.y)), z(S(v.z)) {}
  template <class T, glm::qualifier Q>
    requires std::same_as<T, S>
  Vec3(const glm::vec<3, T, Q>& v) : x(v.x), y(v.y), z(v.z) {}  // NOLINT(google-explicit-constructor)
};

template <Scalar S>
Vec3<S> operator+(const Vec3<S>& a, const Vec3<S>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <Scalar S>
Vec3<S> operator-(const Vec3<S>& a, const Vec3<S>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <Scalar S>
Vec3<S> operator*(const Vec3<S>& a, const S& s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <Scalar S>
S dot(const Vec3<S>& a, const Vec3<S>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// Linear red, green and blue: a reflectance [1], a tint [1] or a BRDF value [1/sr].
template <Scalar S>
struct Rgb {
  S r, g, b;

  Rgb() : r(0.0), g(0.0), b(0.0) {}
  explicit Rgb(const S& grey) : r(grey), g(grey), b(grey) {}
  Rgb(const S& r_, const S& g_, const S& b_) : r(r_), g(g_), b(b_) {}
};

template <Scalar S>
Rgb<S> operator+(const Rgb<S>& a, const Rgb<S>& b) {
  return {a.r + b.r, a.g + b.g, a.b + b.b};
}
template <Scalar S>
Rgb<S> operator*(const Rgb<S>& a, const Rgb<S>& b) {
  return {a.r * b.r, a.g * b.g, a.b * b.b};
}
template <Scalar S, Scalar T>
Rgb<S> operator*(const Rgb<S>& a, const T& s) {
  return {a.r * s, a.g * s, a.b * s};
}
// The mean of the channels: one number for what has to be chosen once for all three.
template <Scalar S>
S mean(const Rgb<S>& a) {
  return (a.r + a.g + a.b) * constant<S>(1.0 / 3.0);
}

}  // namespace likeness::brdf
