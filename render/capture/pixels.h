#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "render/capture/capture.h"
#include "render/image/picture.h"
#include "render/image/texels.h"

// The light that a photo holds: from the numbers of a file to linear light in the unit of the capture's unit light.
namespace likeness::capture {

// Why a pixel of a photo is not to be trusted, as bits.
enum Flaw : std::uint8_t {
  kClipped = 1,    // a channel at or above Frame::clip
  kBlack = 2,      // all channels at or below black
  kNotFinite = 4,  // the file held NaN or infinity: the pixel is 0
  kMasked = 8      // outside the camera's mask
};

struct Photo {
  image::Picture light;             // linear Rec. 709; may be negative (noise about black)
  std::vector<std::uint8_t> flaws;  // of each pixel, bits of Flaw
};

// decode(file) -> (x - black) / (white - black) -> transfer curve undone -> matrix to Rec. 709 -> gain -> flat field
// -> / Light::intensity. Frames without a light of their own are not divided. Throws files::InputError: the file is absent,
// damaged, or of another size than its camera. The flat field is that of the camera's layer; the ambient frame, if there
// is one, is not subtracted here. Pictures are as distorted as their files.
Photo read_photo(const Capture& capture, std::size_t frame);

// What all photos of a camera are read with, for who reads many of them.
struct CameraLayers {
  std::vector<std::uint8_t> mask;  // as read_mask has it
  image::Texels flat_field;        // without texels: there is none
};
CameraLayers read_camera_layers(const Capture& capture, std::size_t camera);
Photo read_photo(const Capture& capture, std::size_t frame, const CameraLayers& layers);

// A render: linear Rec. 709 as its file holds it (of a light of intensity 1, 1, 1).
image::Picture read_render(const Capture& capture, const Variant& variant, std::size_t camera, std::size_t light);

// decode(file) and nothing else: the numbers of the file, integers divided by their largest, three channels (grey is
// repeated). What read_photo begins with, for tools that look at the encoding itself.
image::Picture read_encoded(const std::filesystem::path& file);

// 1 inside, 0 outside; all 1 for a camera without a mask. From the mask's green channel, at least half of its range.
std::vector<std::uint8_t> read_mask(const Capture& capture, std::size_t camera);

// Unit vectors in the world, (0, 0, 0) where there is none. From EXR and PFM as they are, from 8 and 16 bit files 2 x - 1.
image::Picture read_normals(const Capture& capture, std::size_t camera);

// Linear light of one decoded value in [0, 1]; odd about 0, so that noise below black keeps its sign.
float linear_of(Transfer transfer, float value);
float encoded_of(Transfer transfer, float light);

}  // namespace likeness::capture
