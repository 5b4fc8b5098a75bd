#include "volume/import/files/upright.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <glm/geometric.hpp>
#include <numbers>

namespace tessera::volume {

namespace {

constexpr const char* kOblique = "the file's axes are"; // how the note begins
constexpr double kStraight = 1e-4;                      // of a direction's length: what decimals in a header lose

/// Directions of length 1, and lengths; those that are none are along their own axis.
void splitSteps(const glm::dmat3& steps, glm::dmat3& directions, glm::dvec3& lengths) {
    for (int a = 0; a < 3; ++a) {
        const double length = glm::length(steps[a]);
        const bool usable = std::isfinite(length) && length > 0;
        lengths[a] = usable ? length : 1;
        directions[a] = usable ? steps[a] / length : glm::dvec3(a == 0, a == 1, a == 2);
    }
}

/// The order of the axes for which the directions are nearest to the axes of space.
std::array<int, 3> nearestOrder(const glm::dmat3& directions) {
    std::array<int, 3> order{0, 1, 2}, best = order;
    double most = -1;
    do {
        double sum = 0;
        for (int axis = 0; axis < 3; ++axis) sum += std::abs(directions[order[std::size_t(axis)]][axis]);
        if (sum > most + 1e-9) {
            most = sum;
            best = order;
        }
    } while (std::next_permutation(order.begin(), order.end()));
    return best;
}

std::string obliqueNote(const UprightGrid& grid, const glm::dmat3& directions) {
    double most = 0, skew = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3 own = directions[grid.from[std::size_t(axis)]];
        most = std::max(most, std::acos(std::min(1.0, std::abs(own[axis]))));
        skew = std::max(skew, std::abs(glm::dot(own, directions[grid.from[std::size_t((axis + 1) % 3)]])));
    }
    char text[260];
    std::snprintf(text, sizeof text,
                  "%s %s: up to %.4g degrees off x, y and z; they are shown straight, so that places "
                  "and directions are right only along them",
                  kOblique, skew > kStraight ? "oblique to each other" : "turned", most * 180 / std::numbers::pi);
    return text;
}

} // namespace

std::size_t UprightGrid::stored(int x, int y, int z) const {
    const int at[3] = {x, y, z};
    std::size_t index[3] = {}, size[3] = {};
    for (int axis = 0; axis < 3; ++axis) {
        const auto own = std::size_t(from[std::size_t(axis)]);
        size[own] = std::size_t(lattice.size[axis]);
        index[own] = std::size_t(turned[std::size_t(axis)] ? lattice.size[axis] - 1 - at[axis] : at[axis]);
    }
    return (index[2] * size[1] + index[1]) * size[0] + index[0];
}

UprightGrid upright(const StoredGrid& grid) {
    glm::dmat3 directions(1);
    glm::dvec3 lengths(1);
    splitSteps(grid.steps, directions, lengths);
    UprightGrid out;
    out.from = nearestOrder(directions);
    glm::dvec3 origin = grid.origin;
    bool straight = true;
    for (int axis = 0; axis < 3; ++axis) {
        const int own = out.from[std::size_t(axis)];
        const double along = directions[own][axis];
        if (std::abs(along) > 1 - kStraight * kStraight) {
            directions[own] = glm::dvec3(0);
            directions[own][axis] = std::copysign(1.0, along);
        } else {
            straight = false;
        }
        out.turned[std::size_t(axis)] = directions[own][axis] < 0;
        out.lattice.size[axis] = grid.size[own];
        out.lattice.spacing[axis] = lengths[own];
        if (out.turned[std::size_t(axis)]) origin += directions[own] * (lengths[own] * (grid.size[own] - 1));
    }
    for (int axis = 0; axis < 3; ++axis) out.lattice.origin[axis] = std::isfinite(origin[axis]) ? origin[axis] : 0;
    if (!straight) out.note = obliqueNote(out, directions);
    return out;
}

bool isStraightened(const std::vector<std::string>& notes) {
    return std::ranges::any_of(notes, [](const std::string& note) { return note.starts_with(kOblique); });
}

std::vector<std::byte> inUprightOrder(std::span<const std::byte> samples, std::size_t bytes, const UprightGrid& grid) {
    std::vector<std::byte> out(samples.size());
    const glm::ivec3 size = grid.lattice.size;
    // Per axis of the lattice: how far apart its samples are stored.
    const auto start = std::ptrdiff_t(grid.stored(0, 0, 0));
    const std::ptrdiff_t alongX = size.x > 1 ? std::ptrdiff_t(grid.stored(1, 0, 0)) - start : 0;
    std::byte* to = out.data();
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y) {
            std::ptrdiff_t from = std::ptrdiff_t(grid.stored(0, y, z));
            for (int x = 0; x < size.x; ++x, from += alongX, to += bytes)
                std::memcpy(to, samples.data() + std::size_t(from) * bytes, bytes);
        }
    return out;
}

} // namespace tessera::volume
