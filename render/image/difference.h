#pragma once

#include "render/image/picture.h"

// How far a render is from a photo, as displays show them. Both pictures have the same size, else
// std::invalid_argument.
namespace likeness::image {

// Peak signal-to-noise ratio [dB]: 10 log10(255^2 / mean squared difference) over all pixels and channels of the
// 8-bit sRGB values. Infinite for equal pictures.
double psnr(const DisplayPicture& photo, const DisplayPicture& render);

// Mean structural similarity [1], 1 for equal pictures. Wang, Bovik, Sheikh and Simoncelli, "Image quality
// assessment: from error visibility to structural similarity", IEEE TIP 13(4), 2004: 11 x 11 Gaussian window of
// sigma 1.5 and sum 1, K1 = 0.01, K2 = 0.03, L = 255, averaged over the windows that lie wholly inside, no
// downsampling. Computed on the luma Y' = 0.2126 R' + 0.7152 G' + 0.0722 B' of the sRGB values (the paper's code
// takes grey pictures). Both sides must be at least 11 pixels, else std::invalid_argument.
double ssim(const DisplayPicture& photo, const DisplayPicture& render);

}  // namespace likeness::image
