#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "render/files/files.h"
#include "render/scene/loading.h"

// Small valid files of each kind that a scene names, and an Access that has them in memory.
namespace likeness::scene::test {

template <class T>
void put(std::string& bytes, T value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof raw);
}

// The two chunks in their container.
inline std::string glb(std::string text, std::string binary) {
  while (text.size() % 4) text += ' ';
  while (binary.size() % 4) binary += '\0';
  std::string out = "glTF";
  put(out, std::uint32_t{2});
  put(out, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + binary.size()));
  put(out, static_cast<std::uint32_t>(text.size()));
  out += "JSON" + text;
  put(out, static_cast<std::uint32_t>(binary.size()));
  out += std::string("BIN\0", 4) + binary;
  return out;
}

// A square of 4 vertices and 2 triangles in the plane z = 0: indices, positions, normals, uvs.
inline std::string square_bytes() {
  std::string out;
  for (const int i : {0, 1, 2, 0, 2, 3}) put(out, static_cast<std::uint16_t>(i));
  for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 1.f, 0.f}) put(out, x);
  for (int i = 0; i < 4; ++i)
    for (const float x : {0.f, 0.f, 1.f}) put(out, x);
  for (const float x : {0.f, 1.f, 1.f, 1.f, 1.f, 0.f, 0.f, 0.f}) put(out, x);
  return out;
}

// The JSON of that square under two nodes, with a material, a picture, a camera and a light. `from` is replaced by `to`.
inline std::string square_json(std::string_view from = "", std::string_view to = "") {
  std::string out = R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 2, 3]}],
"nodes": [{"name": "root", "translation": [0, 1, 0], "children": [1]}, {"name": "leaf", "mesh": 0, "scale": [2, 2, 2]},
{"name": "eye", "camera": 0, "translation": [0, 0, 5]},
{"name": "lamp", "extensions": {"KHR_lights_punctual": {"light": 0}}, "rotation": [1, 0, 0, 0]}],
"extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "intensity": 683, "spot": {"outerConeAngle": 0.5}}]}},
"cameras": [{"type": "perspective", "perspective": {"yfov": 0.9, "aspectRatio": 2, "znear": 0.1}}],
"meshes": [{"name": "square", "primitives": [{"attributes": {"POSITION": 1, "NORMAL": 2, "TEXCOORD_0": 3},
"indices": 0, "material": 0}]}],
"materials": [{"name": "paint", "doubleSided": true, "alphaMode": "MASK", "alphaCutoff": 0.25,
"emissiveFactor": [1, 0.5, 0], "normalTexture": {"index": 0, "scale": 0.5},
"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 0.75], "metallicFactor": 0.5, "roughnessFactor": 0.8,
"baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 0}}}],
"textures": [{"source": 0, "sampler": 0}], "samplers": [{"wrapS": 33071, "wrapT": 33071}],
"images": [{"uri": "paint.png"}],
"accessors": [{"bufferView": 0, "componentType": 5123, "count": 6, "type": "SCALAR"},
{"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"},
{"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC3"},
{"bufferView": 3, "componentType": 5126, "count": 4, "type": "VEC2"}],
"bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 12}, {"buffer": 0, "byteOffset": 12, "byteLength": 48},
{"buffer": 0, "byteOffset": 60, "byteLength": 48}, {"buffer": 0, "byteOffset": 108, "byteLength": 32}],
"buffers": [{"byteLength": 140}]})";
  if (!from.empty()) {
    const std::size_t at = out.find(from);
    if (at == std::string::npos) throw std::logic_error("not in the text: " + std::string(from));
    out.replace(at, from.size(), to);
  }
  return out;
}
inline std::string small_glb(std::string_view from = "", std::string_view to = "") {
  return glb(square_json(from, to), square_bytes());
}

inline std::string small_obj() {
  return "# a square and a triangle\nmtllib paint.mtl\no square\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
         "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\nusemtl red\nf 1/1/1 2/2/1 3/3/1 4/4/1\n"
         "o corner\nv 0 0 2\nusemtl blue\nf -5//1 -4//1 -1//1\n";
}
inline std::string small_mtl() {
  return "newmtl red\nKd 0.8 0.1 0.1\nPr 0.3\nnewmtl blue\nKd 0 0 1\nNs 98\nmap_Kd -s 2 2 2 -clamp on paint.png\n";
}
inline std::string small_ply() {
  return "ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\nproperty float x\nproperty float y\n"
         "property float z\nproperty float s\nproperty float t\nelement face 1\n"
         "property list uchar int vertex_indices\nend_header\n0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n4 0 1 2 3\n";
}
inline std::string small_binary_ply() {
  std::string out =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty double x\nproperty float y\n"
      "property float z\nproperty uchar red\nelement face 1\nproperty list uchar uint vertex_index\n"
      "property float weight\nend_header\n";
  for (const auto& [x, y] : {std::pair{0.0, 0.f}, {1.0, 0.f}, {0.0, 1.f}}) {
    put(out, x);
    put(out, y);
    put(out, 0.f);
    put(out, std::uint8_t{200});
  }
  put(out, std::uint8_t{3});
  for (const std::uint32_t i : {0u, 1u, 2u}) put(out, i);
  put(out, 0.5f);
  return out;
}
inline std::string small_ies(std::string_view horizontal = "0 45 90", std::string_view tilt = "TILT=NONE\n") {
  const std::size_t planes = 1 + static_cast<std::size_t>(std::count(horizontal.begin(), horizontal.end(), ' '));
  std::string out = "IESNA:LM-63-2002\r\n[TEST] small\r\n" + std::string(tilt) + "1 1000 2.0 3 " +
                    std::to_string(planes) + " 1 2 0.1 0.1 0\r\n0.5 1 40\r\n0 45 90\r\n" + std::string(horizontal) +
                    "\r\n";
  for (std::size_t i = 0; i < planes; ++i) out += std::to_string(100 + 10 * i) + " 50, 0\r\n";
  return out;
}

// A picture of 2 x 2 texels, by its name: grey, alpha (RGBA), light (floats, one NaN, one infinite, one negative), RGB.
inline image::Texels small_texels(const std::string& name) {
  image::Texels out;
  out.width = out.height = 2;
  if (name.find("grey") != name.npos) out.channels = 1;
  else if (name.find("paint") != name.npos) out.channels = 4;
  else out.channels = 3;
  const std::size_t count = out.count() * static_cast<std::size_t>(out.channels);
  if (name.find("light") != name.npos) {
    out.floats.assign(count, 0.5f);
    out.floats[0] = std::numeric_limits<float>::quiet_NaN();
    out.floats[1] = std::numeric_limits<float>::infinity();
    out.floats[2] = -1;
  } else {
    for (std::size_t i = 0; i < count; ++i) out.bytes.push_back(static_cast<std::uint8_t>(20 * i));
  }
  return out;
}

using Files = std::map<std::string, std::string>;
inline Files small_files() {
  return {{"square.glb", small_glb()},
          {"square.obj", small_obj()},
          {"paint.mtl", small_mtl()},
          {"square.ply", small_ply()},
          {"lamp.ies", small_ies()},
          {"gold.material.json", R"({"format": "likeness material", "version": 1, "model": "ggx",
                                     "parameters": {"f0": [1, 0.7, 0.3], "roughness": 0.25}})"}};
}

inline Access access_of(const Files& files) {
  return {[&files](const std::filesystem::path& file, std::size_t limit) {
            const auto at = files.find(file.filename().string());
            if (at == files.end())
              throw files::InputError(file.string() + ": cannot be read; expected a readable file");
            if (at->second.size() > limit) throw files::InputError(file.string() + ": too large");
            return at->second;
          },
          [](const std::filesystem::path& file) { return small_texels(file.filename().string()); },
          [](std::string_view, const std::string& name) { return small_texels(name); }};
}

// A scene that uses every section.
inline std::string small_scene() {
  return R"({"format": "likeness scene", "version": 1, "name": "small", "comment": {"anything": [1, 2]},
"cameras": [{"name": "front", "position": [0, 0, 5], "target": [0, 0, 0], "f_number": 2.8, "focal_mm": 50}],
"meshes": {"glb": {"file": "square.glb", "flip_v": true}, "obj": {"file": "square.obj", "normals": "smooth"},
           "ply": {"file": "square.ply"}, "ball": {"shape": "sphere"}, "box": {"shape": "box", "size": [1, 2, 3]}},
"materials": {"gold": {"file": "gold.material.json", "parameters": {"roughness": {"file": "grey.png", "scale": 0.5}}},
              "skin": {"parameters": {"base_color": {"file": "rgb.png"}, "roughness": 0.4},
                       "normal_map": {"file": "rgb.png"}, "opacity": {"file": "paint.png", "channel": "a"},
                       "emission": [1, 2, 3], "emission_unit": "cd/m2", "emission_map": {"file": "light.exr"}}},
"instances": [{"mesh": "glb"}, {"mesh": "obj", "materials": {"red": "gold"}, "translate": [1, 0, 0]},
              {"mesh": "ply", "material": "skin", "rotate_deg": [0, 90, 0]}, {"mesh": "ball", "scale": 0.5},
              {"mesh": "box", "material": "gold", "matrix": [[1, 0, 0, 2], [0, 1, 0, 0], [0, 0, 1, 0]]}],
"lights": [{"type": "point", "profile": "lamp.ies", "unit": "lm", "strength": 800},
           {"type": "spot", "target": [0, 0, -1], "unit": "cd"}, {"type": "directional", "unit": "lx"},
           {"type": "rectangle", "size": [1, 2], "unit": "W"}, {"type": "disk", "two_sided": true, "range": 10},
           {"type": "sphere", "radius": 0.1, "movable": true, "visible": false}],
"environment": {"file": "light.hdr", "scale": 2, "turn_deg": 90},
"view": {"ev": 1, "name": "gt"}})";
}

}  // namespace likeness::scene::test
