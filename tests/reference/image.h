#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <vector>

namespace tessera::vis::reference {

/// Linear light, premultiplied, before the background, rows top down: like Renderer::readLinear.
struct Image {
    glm::ivec2 size{0};
    std::vector<glm::dvec4> pixels;
    std::vector<double> interest = {}; ///< degree of interest per pixel, 0 if it shows nothing; or empty
};

/// Differences of two pictures of the same size, over all four components.
struct Difference {
    double rmse = 0, maximum = 0;
    double psnr = 0;        ///< dB for a peak of 1; infinite when equal
    std::size_t beyond = 0; ///< number of pixels with a component that differs by more than the threshold
    double rmseWithin = 0;  ///< of the other pixels
    glm::ivec2 worst{0};    ///< pixel of the maximum
};
Difference compare(const Image& a, const Image& b, double threshold);

/// Applies context blur (vis/formulas/context_blur.h); `radius` in pixels. The picture must have degrees of interest.
Image outOfFocus(const Image& image, double radius);

} // namespace tessera::vis::reference
