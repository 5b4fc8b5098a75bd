#pragma once

#include "bench/pictures/bench_frames.h"
#include "tests/reference/raycast.h"

#include <cstdint>
#include <optional>
#include <span>

/// Benchmarks VTK's volume mappers: runs the program tessera-vtk-peer beside this one with the same samples, camera,
/// transfer function, step and light. It needs an X display; without one it runs under Xvfb.
namespace tessera::app {

/// True if the program exists, and a display or xvfb-run is available.
bool vtkPeerAtHand();

struct PeerResult {
    double milliseconds = 0;       ///< median of the timed pictures
    double changed = 0;            ///< of the first picture after the samples have changed
    vis::reference::Image picture; ///< linear, like the reference
};
struct PeerResults {
    std::optional<PeerResult> gpu, cpu; ///< empty: the mapper cannot draw this, or failed
};

struct PeerSizes {
    int timed = 512, compared = 64, frames = 5;
    BenchClock clock = BenchClock::Processor;
};

/// Whether VTK has the layer's ray style, classification and light.
bool peerDraws(const vis::Scene& scene);

/// Draws the one layer of `scene` from unsigned bytes (x fastest) with range 0..255.
PeerResults runVtkPeer(std::span<const std::uint8_t> bytes, glm::ivec3 size, const vis::Scene& scene, PeerSizes sizes);

} // namespace tessera::app
