#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tessera::vis {

/// Rows of a picture in the opposite order; each has `width` parts.
template <class Part> std::vector<Part> turnedRows(const std::vector<Part>& rows, std::size_t width) {
    std::vector<Part> out(rows.size());
    for (std::size_t at = 0; at < rows.size(); at += width)
        std::copy_n(rows.begin() + std::ptrdiff_t(at), width, out.end() - std::ptrdiff_t(at + width));
    return out;
}

} // namespace tessera::vis
