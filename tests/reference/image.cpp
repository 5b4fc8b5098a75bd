#include "tests/reference/image.h"

#include "vis/formulas/context_blur.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace tessera::vis::reference {

Difference compare(const Image& a, const Image& b, double threshold) {
    assert(a.size == b.size && a.pixels.size() == b.pixels.size());
    Difference difference;
    double squares = 0, within = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        double most = 0, own = 0;
        for (int c = 0; c < 4; ++c) {
            const double apart = std::abs(a.pixels[i][c] - b.pixels[i][c]);
            own += apart * apart;
            // NaN counts as an infinite difference.
            most = std::isnan(apart) ? std::numeric_limits<double>::infinity() : std::max(most, apart);
        }
        squares += own;
        if (most > threshold)
            ++difference.beyond;
        else
            within += own;
        if (most > difference.maximum) {
            difference.maximum = most;
            difference.worst = {int(i) % a.size.x, int(i) / a.size.x};
        }
    }
    difference.rmse = std::sqrt(squares / double(std::max<std::size_t>(a.pixels.size() * 4, 1)));
    difference.rmseWithin =
        std::sqrt(within / double(std::max<std::size_t>((a.pixels.size() - difference.beyond) * 4, 1)));
    difference.psnr = -20 * std::log10(difference.rmse);
    return difference;
}

Image outOfFocus(const Image& image, double radius) {
    assert(image.interest.size() == image.pixels.size());
    const auto index = [&](int x, int y) {
        return std::size_t(std::clamp(y, 0, image.size.y - 1)) * std::size_t(image.size.x) +
               std::size_t(std::clamp(x, 0, image.size.x - 1));
    };
    // Linear between pixel centres.
    const auto colorAt = [&](glm::dvec2 at) {
        const glm::dvec2 low = glm::floor(at - 0.5), f = at - 0.5 - low;
        const int x = int(low.x), y = int(low.y);
        return glm::mix(glm::mix(image.pixels[index(x, y)], image.pixels[index(x + 1, y)], f.x),
                        glm::mix(image.pixels[index(x, y + 1)], image.pixels[index(x + 1, y + 1)], f.x), f.y);
    };
    Image out = image;
    for (int y = 0; y < image.size.y; ++y)
        for (int x = 0; x < image.size.x; ++x) {
            const glm::dvec4 own = image.pixels[index(x, y)];
            glm::dvec4 sum = own;
            double weight = 1;
            for (int tap = 0; tap < kBlurTaps; ++tap) {
                // The shader's y runs up.
                const glm::dvec2 offset = blurTap<double>(tap) * radius * glm::dvec2(1, -1);
                const glm::dvec2 at = glm::clamp(glm::dvec2(x, y) + 0.5 + offset, glm::dvec2(0),
                                                 glm::dvec2(image.size) - glm::dvec2(1e-9));
                const double share =
                    blurShare<double>(image.interest[index(int(at.x), int(at.y))], glm::length(offset), radius);
                sum += share * colorAt(at);
                weight += share;
            }
            out.pixels[index(x, y)] = glm::mix(sum / weight, own, image.interest[index(x, y)]);
        }
    return out;
}

} // namespace tessera::vis::reference
