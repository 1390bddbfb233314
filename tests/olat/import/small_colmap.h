#pragma once

#include <cstdint>
#include <string>

// A reconstruction of two cameras and two pictures, as text and as bytes.
namespace likeness::olat_import::test {

inline std::string small_cameras() {
  return "# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n1 PINHOLE 640 480 500 510 320 240\n\n2 SIMPLE_RADIAL 64 48 400 "
         "32 24 0.1\n";
}
// A quarter turn about y, (w, x, y, z) = (sqrt 1/2, 0, sqrt 1/2, 0), and none.
inline std::string small_images() {
  return "# two lines an image\n7 0.7071067811865476 0 0.7071067811865476 0 1 2 3 1 a view/1.png\n1 2 -1 3 4 5\n"
         "8 1 0 0 0 0 0 0 2 b.png\n\n";
}

template <class T>
void put(std::string& out, T value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}
inline std::string small_binary_cameras() {
  std::string out;
  put<std::uint64_t>(out, 2);
  put<std::int32_t>(out, 1), put<std::int32_t>(out, 1);
  put<std::uint64_t>(out, 640), put<std::uint64_t>(out, 480);
  for (const double x : {500.0, 510.0, 320.0, 240.0}) put(out, x);
  put<std::int32_t>(out, 2), put<std::int32_t>(out, 2);
  put<std::uint64_t>(out, 64), put<std::uint64_t>(out, 48);
  for (const double x : {400.0, 32.0, 24.0, 0.1}) put(out, x);
  return out;
}
inline std::string small_binary_images() {
  std::string out;
  const double half = 0.7071067811865476;
  put<std::uint64_t>(out, 2);
  put<std::int32_t>(out, 7);
  for (const double x : {half, 0.0, half, 0.0, 1.0, 2.0, 3.0}) put(out, x);
  put<std::int32_t>(out, 1);
  out += std::string("a view/1.png") + '\0';
  put<std::uint64_t>(out, 1);
  put(out, 1.5), put(out, 2.5), put<std::int64_t>(out, -1);
  put<std::int32_t>(out, 8);
  for (const double x : {1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}) put(out, x);
  put<std::int32_t>(out, 2);
  out += std::string("b.png") + '\0';
  put<std::uint64_t>(out, 0);
  return out;
}

}  // namespace likeness::olat_import::test
