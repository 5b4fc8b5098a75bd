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

/// Something like a CT of a head: air, skin, bone with a few holes, tissue with two cavities, all noisy; edge^3.
BenchVolume phantomVolume(int edge);
/// Marschner and Lobb's signal (Vis 1994, section 5; fM = 6, alpha = 1/4); edge^3.
BenchVolume marschnerLobbVolume(int edge);
/// Walls along a gyroid of uneven thickness, noisy: like the porous layers of a full fuel-cell model.
BenchVolume foamVolume(glm::ivec3 size);
/// Of $TESSERA_DATA/volumes the CT and simulation volumes of one parameter with at least 90 samples along an edge;
/// sixteen-bit and float samples of the first time scaled to bytes. Empty, and said on stderr, where there are none.
std::vector<BenchVolume> realVolumes();

/// The volume as a data set of one parameter "v", range 0..255, cubic cells. Refers to `volume`.
volume::Dataset benchDataset(const BenchVolume& volume);

} // namespace tessera::app
