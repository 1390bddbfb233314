#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "render/capture/capture.h"

// Cameras as COLMAP writes them: cameras.txt and images.txt, or the same as .bin.
namespace likeness::olat_import {

struct PosedPicture {
  std::string file;        // as COLMAP names it
  capture::Camera camera;  // without an id
};

// Pictures in the order of the file; `meters` is the length of a unit of the reconstruction. SIMPLE_PINHOLE, PINHOLE,
// SIMPLE_RADIAL, RADIAL, OPENCV, FULL_OPENCV and OPENCV_FISHEYE. Throws files::InputError with the line or, in binary
// files, the byte: another model, a camera that is not there, numbers that are not finite.
std::vector<PosedPicture> read_colmap_text(std::string_view cameras, std::string_view images,
                                           const std::string& cameras_name, const std::string& images_name,
                                           double meters);
std::vector<PosedPicture> read_colmap_binary(std::string_view cameras, std::string_view images,
                                             const std::string& cameras_name, const std::string& images_name,
                                             double meters);

// The folder itself, or sparse/0, sparse or 0 in it; an empty path if none of them has a pair of files.
std::filesystem::path colmap_folder(const std::filesystem::path& folder);
std::vector<PosedPicture> read_colmap(const std::filesystem::path& folder, double meters);

}  // namespace likeness::olat_import
