#include "vis/demand/picture_contrast.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tessera::vis {

void PictureContrast::add(glm::ivec2 size, const Tile& box, std::span<const float> rgba) {
    const glm::ivec2 extent = box.end - box.begin;
    std::vector<float> shown(rgba.size()); // nearly as it is shown: dark pixels differ as much as bright ones
    std::ranges::transform(rgba, shown.begin(), [](float value) { return std::sqrt(std::max(value, 0.0f)); });
    const auto difference = [&](int a, int b) {
        float most = 0;
        for (int part = 0; part < 4; ++part)
            most = std::max(most, std::abs(shown[std::size_t(4 * a + part)] - shown[std::size_t(4 * b + part)]));
        return most;
    };
    for (int y = 0; y < extent.y; ++y)
        for (int x = 0; x < extent.x; ++x) {
            const int at = y * extent.x + x;
            const glm::ivec2 cell = cellOf(box.begin + glm::ivec2(x, y), size);
            float& most = cells_[std::size_t(cell.y * kCells + cell.x)];
            if (x > 0) most = std::max(most, difference(at, at - 1));
            if (y > 0) most = std::max(most, difference(at, at - extent.x));
        }
}

double PictureContrast::of(const Tile& tile, glm::ivec2 size) const {
    if (tile.empty()) return 0;
    const glm::ivec2 first = cellOf(tile.begin, size), last = cellOf(tile.end - 1, size);
    double sum = 0;
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) sum += double(cells_[std::size_t(y * kCells + x)]);
    return sum / double((last.x - first.x + 1) * (last.y - first.y + 1));
}

} // namespace tessera::vis
