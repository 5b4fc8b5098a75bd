#pragma once

#include "volume/field/dataset.h"

#include <glm/vec3.hpp>
#include <map>
#include <string>

/// A pulse of a tracer that moves through a pipe and, where the pipe branches, parts into two that move at different
/// speeds: test data for pictures of space and time, in which every answer is known.
namespace tessera::volume {

/// Lengths in m, times in s. The pipe runs along +x in the middle of the box to the branching, then to both sides in
/// the plane of x and y.
struct Branching {
    static constexpr glm::dvec3 kBox{0.2, 0.12, 0.06}; ///< from the origin
    static constexpr double kBranchAt = 0.08;          ///< x of the branching
    static constexpr double kSlope = 0.4;              ///< dy / dx of the upper arm; the lower one goes down as steeply
    static constexpr double kRadius = 0.016;           ///< of the pipe
    static constexpr double kSigma = 0.009;            ///< of the pulse
    static constexpr double kPeak = 8;                 ///< mol/m3, before the branching; half in each arm
    static constexpr double kSpeed = 0.1;              ///< m/s along the pipe, and in the upper arm
    static constexpr double kSlowSpeed = 0.055;        ///< in the lower arm
    static constexpr double kDuration = 2.2;           ///< s, from the inlet to when the faster one has left

    /// Whether p lies in the pipe.
    static bool inside(glm::dvec3 p);
    /// The concentration of the tracer at p, mol/m3: of each arm a Gaussian of the distance along the pipe from the
    /// middle of its pulse.
    static double tracer(glm::dvec3 p, double time);
    /// How long after the inlet the middle of a pulse passes a place along an arm at distance `along` from the inlet.
    static double arrival(double along, bool slow);
};

struct BranchingSettings {
    int nx = 72, ny = 44, nz = 22;
    int times = 56;
    bool operator==(const BranchingSettings&) const = default;

    static void describe(auto& self, auto&& visit) {
        const Range edge{8, 2048};
        visit(self.nx, FieldInfo{.key = "nx", .doc = "Samples along x", .range = edge});
        visit(self.ny, FieldInfo{.key = "ny", .doc = "Samples along y", .range = edge});
        visit(self.nz, FieldInfo{.key = "nz", .doc = "Samples along z", .range = edge});
        visit(self.times,
              FieldInfo{.key = "times", .doc = "Number of times, from 0 to 2.2 s", .range = Range{2, 100000}});
    }
};

/// The pipe on a CC grid over its box, samples outside it absent; parameters "T", which rises along the pipe and with
/// the tracer, and "tracer". Throws Error on bad settings.
Dataset makeBranching(const std::map<std::string, double>& settings);

} // namespace tessera::volume
