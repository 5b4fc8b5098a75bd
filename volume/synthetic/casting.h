#pragma once

#include "volume/field/dataset.h"

#include <glm/vec3.hpp>
#include <map>
#include <string>

/// A computed CT scan of an imaginary cast part: an engine block of light metal (two bores in a water jacket, a pipe, a
/// flange) with liners and bolts of steel. Three materials with sharp borders, and noise: test data for classification,
/// shading and edges.
namespace tessera::volume {

struct Casting {
    static constexpr double kAir = 12, kCast = 110, kSteel = 215;

    double edge = 0.02; ///< half the width over which a border is smeared, as by a detector

    /// The value at p (-1..1 along each axis) without noise: the materials weighted by their share.
    double operator()(glm::dvec3 p) const;
};

struct CastingSettings {
    int nx = 112, ny = 88, nz = 104;
    double noise = 4;
    bool operator==(const CastingSettings&) const = default;

    static void describe(auto& self, auto&& visit) {
        const Range edge{8, 4096};
        visit(self.nx, FieldInfo{.key = "nx", .doc = "Samples along x", .range = edge});
        visit(self.ny, FieldInfo{.key = "ny", .doc = "Samples along y", .range = edge});
        visit(self.nz, FieldInfo{.key = "nz", .doc = "Samples along z", .range = edge});
        visit(self.noise, FieldInfo{.key = "noise",
                                    .doc = "Largest noise in a sample, of 255; the same in each run",
                                    .range = Range{0, 50}});
    }
};

/// The scan on a CC grid of cubic cells of 1 mm, one parameter "density" of 8 bits, 0..255. Throws Error on bad
/// settings.
Dataset makeCasting(const std::map<std::string, double>& settings);

} // namespace tessera::volume
