#include "render/mip/command.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "render/files/files.h"
#include "render/image/read.h"
#include "render/image/write.h"
#include "render/texture/normal_mips.h"

namespace likeness::mip {
namespace {

struct Request {
  std::string normals, roughness = "0.5", out = "mips";
  int channel = 0, levels = 32;
  bool exr = false, json = false;
};

scene::Image read(const std::string& file) { return {file, image::read_texels(file)}; }

// A number, or a picture.
texture::RoughnessBelow roughness_of(const Request& request, scene::Image& storage) {
  texture::RoughnessBelow below;
  char* end = nullptr;
  const double number = std::strtod(request.roughness.c_str(), &end);
  if (!request.roughness.empty() && *end == '\0') {
    if (!(number >= 0 && number <= 1))
      throw files::UsageError("--roughness " + request.roughness + " is outside [0, 1]; a number, or a picture");
    below.everywhere = static_cast<float>(number);
    return below;
  }
  storage = read(request.roughness);
  if (request.channel >= storage.texels.channels)
    throw files::UsageError("--channel " + std::to_string(request.channel) + ": " + request.roughness + " has " +
                            std::to_string(storage.texels.channels) + " (counted from 0)");
  below.image = &storage;
  below.texture.channel = request.channel;
  return below;
}

void write(const std::filesystem::path& stem, const image::Picture& picture, bool exr) {
  if (exr) return image::write_exr(stem.string() + ".exr", picture);
  image::DisplayPicture bytes(picture.width, picture.height);
  for (std::size_t i = 0; i < picture.rgb.size(); ++i)
    bytes.rgb[i] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(picture.rgb[i], 0.0f, 1.0f)));
  image::write_png(stem.string() + ".png", bytes);
}

float mean(const std::vector<float>& values) {
  double sum = 0;
  for (const float v : values) sum += static_cast<double>(v);
  return static_cast<float>(sum / static_cast<double>(values.size()));
}

int run(const Request& request) {
  const scene::Image normals = read(request.normals);
  if (normals.texels.channels < 3)
    throw files::InputError(request.normals + ": " + std::to_string(normals.texels.channels) +
                            " channels; a normal map has 3, x y z as 2 texel - 1");
  scene::Image storage;
  const auto below = roughness_of(request, storage);
  const auto levels = texture::normal_mips(normals, {}, below, request.levels);

  const std::filesystem::path folder = request.out;
  if (request.json) std::cout << "[";
  else std::printf("level      size  mean length  mean roughness\n");
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const texture::NormalMip& level = levels[k];
    image::Picture packed(level.width, level.height), rough(level.width, level.height);
    for (std::size_t i = 0; i < level.normals.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c) {
        packed.rgb[3 * i + c] = 0.5f * level.normals[i][static_cast<int>(c)] + 0.5f;
        rough.rgb[3 * i + c] = level.roughness[i];
      }
    write(folder / ("normal_" + std::to_string(k)), packed, request.exr);
    write(folder / ("roughness_" + std::to_string(k)), rough, request.exr);
    const std::string size = std::to_string(level.width) + "x" + std::to_string(level.height);
    if (request.json)
      std::cout << (k == 0 ? "\n" : ",\n") << "  {\"level\": " << k << ", \"width\": " << level.width
                << ", \"height\": " << level.height
                << ", \"mean_length\": " << files::number_text(static_cast<double>(mean(level.lengths)))
                << ", \"mean_roughness\": " << files::number_text(static_cast<double>(mean(level.roughness))) << "}";
    else
      std::printf("%5zu %9s  %11.6f  %14.4f\n", k, size.c_str(), static_cast<double>(mean(level.lengths)),
                  static_cast<double>(mean(level.roughness)));
  }
  if (request.json) std::cout << "\n]\n";
  else std::printf("written: %s/normal_*.%s and roughness_*\n", folder.c_str(), request.exr ? "exr" : "png");
  return 0;
}

}  // namespace

void add_mip(CLI::App& program, int& exit_code) {
  const auto request = std::make_shared<Request>();
  CLI::App* app = program.add_subcommand("mip", "Levels of a normal map, whose lost bumps become roughness");
  app->add_option("NORMALS", request->normals, "Normal map in the tangent frame: x y z as 2 texel - 1, linear")
      ->required();
  app->add_option("--roughness", request->roughness, "Roughness below it: a number, or a picture (linear)")
      ->capture_default_str();
  app->add_option("--channel", request->channel, "Of the roughness picture, counted from 0 (1 in glTF's)")
      ->check(CLI::Range(0, 3))
      ->capture_default_str();
  app->add_option("--levels", request->levels, "At most so many, the first included")
      ->check(CLI::Range(1, 32))
      ->capture_default_str();
  app->add_option("--out", request->out, "Folder for normal_0, roughness_0, normal_1, ...")->capture_default_str();
  app->add_flag("--exr", request->exr, "Write EXR (float) instead of PNG (8 bit)");
  app->add_flag("--json", request->json, "Print the levels as JSON");
  app->footer(
      "A plain mip map averages bumps away, and the surface shines from afar as if it had been polished. Here the "
      "length\n"
      "that normals lose when they are averaged becomes roughness, of the specular and of the diffuse alike.\n"
      "\n"
      "  likeness mip bumps.png --roughness 0.3 --out mips\n"
      "  likeness mip bumps.png --roughness orm.png --channel 1 --exr --out mips\n"
      "\n"
      "Exit codes: 0 done, 2 usage, 3 a picture cannot be used. Manual: docs/mip.md");
  app->callback([request, &exit_code] { exit_code = run(*request); });
}

}  // namespace likeness::mip
