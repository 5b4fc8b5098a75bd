#pragma once

#include "volume/base/describe.h"
#include "volume/field/dataset.h"

#include <glm/vec3.hpp>
#include <map>
#include <string>
#include <vector>

/// Bubbles that rise in a column of liquid: test data for what becomes of pieces. They are balls on straight paths, so
/// that their volumes, and the times at which they meet, part, appear, vanish and leave, are known.
namespace tessera::volume {

namespace bubbles {

inline constexpr glm::dvec3 kColumn{0.04, 0.04, 0.08}; ///< m, from 0
inline constexpr double kDuration = 1.5;               ///< s
inline constexpr double kBorder = 2e-3;                ///< m, over which the share of gas goes from 0 to 1

inline constexpr double kMerge = 0.5;               ///< s: two touch, and are one from then on
inline constexpr double kSplit = 0.8;               ///< s: one has become two
inline constexpr double kLeave = 0.6;               ///< s: one has left through the top
inline constexpr double kBirth = 0.4, kDeath = 1.2; ///< s: one grows from nothing, and vanishes

struct Ball {
    glm::dvec3 centre{0};
    double radius = 0;
};
/// Those that are there at a time: first the two that merge, then the two that are one at first, then, while they are
/// there, the one that leaves and the one that comes and goes.
std::vector<Ball> at(double time);
/// How far a place is inside of the nearest bubble's surface, m; negative outside.
double depth(const std::vector<Ball>& balls, glm::dvec3 place);

} // namespace bubbles

struct BubblesSettings {
    int nx = 36, ny = 36, nz = 72, times = 31;
    bool operator==(const BubblesSettings&) const = default;

    static void describe(auto& self, auto&& visit) {
        const Range edge{8, 1024};
        visit(self.nx, FieldInfo{.key = "nx", .doc = "Samples along x", .range = edge});
        visit(self.ny, FieldInfo{.key = "ny", .doc = "Samples along y", .range = edge});
        visit(self.nz, FieldInfo{.key = "nz", .doc = "Samples along z", .range = edge});
        visit(self.times, FieldInfo{.key = "times", .doc = "Times", .range = Range{1, 1000}});
    }
};

/// The column on a CC grid: "gas", the share of gas, 0.5 on the surface of the bubbles, and the temperature "T" in K,
/// which falls upwards and is 5 K higher in gas. Throws Error on bad settings.
Dataset makeBubbles(const std::map<std::string, double>& settings);

} // namespace tessera::volume
