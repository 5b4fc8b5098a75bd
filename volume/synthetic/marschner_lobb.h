#pragma once

#include "volume/field/dataset.h"

#include <glm/vec3.hpp>
#include <map>
#include <string>

/// S. Marschner, R. Lobb, An evaluation of reconstruction filters for volume rendering, Vis 1994, section 5: a signal
/// whose spectrum ends below the Nyquist frequency of 41^3 samples for fM = 6, almost all of it near that limit.
namespace tessera::volume {

struct MarschnerLobb {
    double alpha = 0.25; ///< share of the rings
    double fM = 6;       ///< frequency of the rings

    /// rho(x, y, z) = (1 - sin(pi z / 2) + alpha (1 + rho_r(sqrt(x^2 + y^2)))) / (2 (1 + alpha)) with
    /// rho_r(r) = cos(2 pi fM cos(pi r / 2) + 2 pi phase), for -1 <= x, y, z <= 1: values 0..1. The paper's signal has
    /// phase 0; as the phase grows the rings travel, and return after 1.
    double operator()(glm::dvec3 p, double phase = 0) const;
    /// Its gradient (0 along x and y on the axis, where it has none).
    glm::dvec3 gradient(glm::dvec3 p, double phase = 0) const;
};

struct MarschnerLobbSettings {
    int nx = 41, ny = 41, nz = 41;
    int times = 1;
    double alpha = 0.25;
    double fM = 6;
    int bits = 32;
    bool operator==(const MarschnerLobbSettings&) const = default;

    static void describe(auto& self, auto&& visit) {
        const Range edge{2, 8192};
        visit(self.nx, FieldInfo{.key = "nx", .doc = "Samples along x", .range = edge});
        visit(self.ny, FieldInfo{.key = "ny", .doc = "Samples along y", .range = edge});
        visit(self.nz, FieldInfo{.key = "nz", .doc = "Samples along z", .range = edge});
        visit(self.times,
              FieldInfo{.key = "times",
                        .doc = "Number of times, from 0 to 1 s, in which the phase of the rings goes round once",
                        .range = Range{1, 100000}});
        visit(self.alpha, FieldInfo{.key = "alpha", .doc = "Amplitude of the rings", .range = Range{0, 100}});
        visit(self.fM, FieldInfo{.key = "fM", .doc = "Frequency of the rings", .range = Range{0, 1000}});
        visit(self.bits, FieldInfo{.key = "bits",
                                   .doc = "Bits of a sample; 8 or 16: unsigned integers with a scale, 32: float",
                                   .range = Range{8, 32}});
    }
};

/// The signal on a CC grid over [-1, 1]^3 m, one parameter "rho", range 0..1. Throws Error on bad settings.
Dataset makeMarschnerLobb(const std::map<std::string, double>& settings);

} // namespace tessera::volume
