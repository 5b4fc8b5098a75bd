#pragma once

#include <glm/common.hpp>
#include <glm/vec2.hpp>

namespace tessera::vis {

/// Pixels [begin, end) of a picture.
struct Tile {
    glm::ivec2 begin{0}, end{0};

    bool empty() const { return begin.x >= end.x || begin.y >= end.y; }
    double area() const { return empty() ? 0 : double(end.x - begin.x) * (end.y - begin.y); }
    bool holds(glm::ivec2 p) const { return p.x >= begin.x && p.y >= begin.y && p.x < end.x && p.y < end.y; }
    bool operator==(const Tile&) const = default;
};

inline Tile intersection(const Tile& a, const Tile& b) {
    return {glm::max(a.begin, b.begin), glm::min(a.end, b.end)};
}

/// The smallest tile that contains both.
inline Tile united(const Tile& a, const Tile& b) {
    if (a.empty()) return b;
    if (b.empty()) return a;
    return {glm::min(a.begin, b.begin), glm::max(a.end, b.end)};
}

} // namespace tessera::vis
