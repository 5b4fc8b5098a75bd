#pragma once

#include "vis/packed/packet_volume.h"

#include <cstdint>
#include <functional>
#include <vector>

/// Which blocks of a volume can show something, for leaps over empty space and long runs through full space.
namespace tessera::vis::packet {

/// The number of blocks that look alike from each block on, for each octant of ray directions: those of a ray that goes
/// there are known further than those all around (L. Deakin, M. Knackstedt: Efficient ray casting of volumetric images
/// using distance maps for empty space skipping, Computational Visual Media 6, 2020).
struct SkipMap {
    static constexpr int kMost = 127; ///< blocks that are counted
    static constexpr int kFull = 128; ///< added where a block can show something

    glm::ivec3 count{1};            ///< of blocks of kFine^3 cells
    std::vector<std::uint8_t> full; ///< 1: a block can show something
    /// n, or kFull + n: the cube of n^3 blocks from this one on in the directions of the octant is as empty or as full.
    /// Block i of octant o (bit axis: forwards) at o * blocks() + i; with 3 bytes more, because they are read four at a
    /// time. Beyond the volume everything is alike.
    std::vector<std::uint8_t> alike;
    unsigned counted = 0; ///< octants whose counts are there, a bit each

    std::size_t blocks() const { return std::size_t(count.x) * std::size_t(count.y) * std::size_t(count.z); }
};

/// Without `alike`. `shows(lo, hi)`: whether a block whose samples lie in that interval can show something.
SkipMap fullBlocks(const PacketVolume& volume, const std::function<bool(float, float)>& shows);
/// Blocks that are full in either of two maps of the same blocks; a map without blocks gives the other.
SkipMap united(SkipMap a, const SkipMap& b);
/// Largest score, 0..1, of the samples of each block, rounded up, 255 = 1; it must lie at one of the bounds of a block.
/// With 3 bytes more, because they are read four at a time.
std::vector<std::uint8_t> scoreBounds(const PacketVolume& volume, const std::function<double(float)>& score);
/// Makes the neighbours of full blocks full, also those at their corners.
void widen(SkipMap& map);
/// Counts alike blocks in these octants (a bit each), where that is not done.
void countAlike(SkipMap& map, unsigned octants);

} // namespace tessera::vis::packet
