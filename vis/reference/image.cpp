#include "vis/reference/image.h"

#include <algorithm>
#include <cassert>
#include <cmath>
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
            // NaN is as far apart as can be.
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

} // namespace tessera::vis::reference
