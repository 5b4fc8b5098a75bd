#pragma once

#include "vis/image/image_io.h"

/// Image difference metrics.
namespace tessera::vis {

/// Over the red, green and blue components of all pixels, in 8-bit sRGB; 0 to 255.
struct ImageDifference {
    double maximum = 0, rmse = 0;
    double psnr = 0; ///< dB, 20 log10(255 / rmse); infinite for equal pictures
    double ssim = 1; ///< of luma, mean over all windows
};

/// Maximum, root mean square, PSNR and structural similarity (Z. Wang, A. C. Bovik, H. R. Sheikh, E. P. Simoncelli:
/// Image quality assessment: from error visibility to structural similarity, 2004; Gaussian of 11 x 11 pixels, sigma
/// 1.5, K1 = 0.01, K2 = 0.03, at positions where the window lies inside; pictures smaller than that use one window over
/// all). Luma is 0.299 R + 0.587 G + 0.114 B. Throws Error for pictures of different or no size.
ImageDifference difference(const Image& picture, const Image& reference);

/// Largest difference of the three components per pixel, 0 to 255, rows as in the pictures. Throws as above.
std::vector<std::uint8_t> differenceMap(const Image& picture, const Image& reference);

} // namespace tessera::vis
