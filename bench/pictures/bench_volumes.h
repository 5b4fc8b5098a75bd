#pragma once

#include "volume/field/dataset.h"

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

/// Volumes of unsigned bytes that the benchmarks draw: made here, and real ones where they are at hand.
namespace tessera::app {

struct BenchVolume {
    std::string name;
    glm::ivec3 size{0};
    std::vector<std::uint8_t> bytes; ///< x fastest
};

/// A synthetic CT of a head: air, skin, bone with a few holes, tissue with two cavities, with noise; edge^3 samples.
BenchVolume phantomVolume(int edge);
/// Marschner and Lobb's signal (Vis 1994, section 5; fM = 6, alpha = 1/4); edge^3.
BenchVolume marschnerLobbVolume(int edge);
/// Walls along a gyroid of uneven thickness, noisy: like the porous layers of a full fuel-cell model.
BenchVolume foamVolume(glm::ivec3 size);
/// The CT and simulation volumes in $TESSERA_DATA/volumes with one parameter and at least 90 samples along an edge;
/// 16-bit and float samples of the first time are scaled to bytes. If there are none, prints so to stderr and returns
/// nothing.
std::vector<BenchVolume> realVolumes();

/// The volume as a data set of one parameter "v", range 0..255, cubic cells. Refers to `volume`.
volume::Dataset benchDataset(const BenchVolume& volume);

} // namespace tessera::app
