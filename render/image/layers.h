#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

// A picture of many layers in one EXR: what a renderer found besides the light (normals, depth, the light of each
// lobe), each under its name.
namespace likeness::image {

enum class Storage { kFloat, kHalf };  // of a layer in the file

// Channels interleaved, row by row from the top left. The layer without a name is the picture itself: R, G, B. In the
// file a channel is named layer.channel ("normal.X"), which Nuke and Blender read as a channel of that layer.
struct Layer {
  std::string name{};
  std::vector<std::string> channels{};
  std::vector<float> data{};
  // Half: 11 significant bits. What is larger than 65504 becomes 65504 of its sign; infinity and NaN stay.
  Storage storage = Storage::kFloat;
};

struct Layers {
  int width = 0, height = 0;
  std::vector<Layer> layers;
  std::string metadata;  // JSON, or any text; the string attribute "likeness" of the file

  const Layer* find(std::string_view name) const;  // null if there is none
};

// One part of scan lines, ZIP compressed, lossless but for halves. The file is whole or absent (files::write_whole).
// Throws std::invalid_argument for layers that make no file (of another size, without channels, with names that are
// empty, longer than 200 characters, hold a dot in the channel or come twice), and std::runtime_error for what cannot
// be written.
void write_layers(const std::filesystem::path& file, const Layers& layers);

// The first part of an EXR, also one of another program; the display window, which is 0 where the data window leaves it
// bare. Layers come in the order of the alphabet, that without a name first; channels as R G B A, else in the order of
// the alphabet (Y before Z); storage is half if every channel of the layer is. Throws files::InputError, as
// read_texels does, and for more than `most_values` numbers in all.
inline constexpr std::size_t kMostLayerValues = std::size_t{1} << 32;  // 16 GB
Layers read_layers(const std::filesystem::path& file, std::size_t most_values = kMostLayerValues);
Layers decode_layers(std::string_view bytes, const std::string& name, std::size_t most_values = kMostLayerValues);

}  // namespace likeness::image
