#include "volume/field/parts.h"

#include <algorithm>

namespace tessera::volume {

std::size_t Parts::partOf(int value) const {
    const auto found = std::ranges::find_if(
        regions, [value](const std::vector<int>& values) { return std::ranges::find(values, value) != values.end(); });
    return found == regions.end() ? 0 : static_cast<std::size_t>(found - regions.begin());
}

} // namespace tessera::volume
