#pragma once

#include "vis/model/scene.h"
#include "vis/reference/samples.h"
#include "volume/brick_source.h"

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <vector>

/// The judge of everything the ray caster's shader draws: the formulas of vis/model/ray_setup.h and
/// volume/reconstruct.h, one sample at a time, on the CPU, without any shortcut (no skipping, no levels, no textures).
namespace tessera::vis::reference {

/// Linear light, premultiplied, before the background, rows top down: like Renderer::readLinear.
struct Image {
    glm::ivec2 size{0};
    std::vector<glm::dvec4> pixels;
};

struct Options {
    Flaws flaws; ///< none, except in tests
};

/// Renders the layers of a scene at full resolution. Lines (box, contours) are not drawn; layers of unknown channels
/// show nothing. Same input, same output on any number of threads. Throws Error when the source does.
Image render(const Scene& scene, const volume::BrickSource& source, glm::ivec2 size, const Options& options = {});

/// The same with rays, colours and accumulation in single precision: how much rounding alone may change a picture.
Image renderSingle(const Scene& scene, const volume::BrickSource& source, glm::ivec2 size, const Options& options = {});

/// How far two pictures of one size are apart, over all four components.
struct Difference {
    double rmse = 0, maximum = 0;
    double psnr = 0;        ///< dB for a peak of 1; infinite when equal
    std::size_t beyond = 0; ///< pixels with a component further apart than the threshold
    double rmseWithin = 0;  ///< of the other pixels
    glm::ivec2 worst{0};    ///< pixel of the maximum
};
Difference compare(const Image& a, const Image& b, double threshold);

} // namespace tessera::vis::reference
