#pragma once

#include "vis/scene/scene.h"
#include "volume/bricks/brick_source.h"
#include "volume/field/time_pair.h"
#include "volume/system/unfilled.h"

#include <cstdint>
#include <glm/vec3.hpp>
#include <stop_token>
#include <vector>

/// The samples of one channel at one time, laid out for packets of rays.
namespace tessera::vis::packet {

inline constexpr int kMargin = 2;       ///< samples of each sublattice beyond the lattice, for gradients
inline constexpr int kBrick = 16;       ///< cells along the edge of a brick
inline constexpr int kRow = kBrick + 2; ///< samples along its edge: the next brick's first ones belong to it, too
inline constexpr int kSlice = kRow * (kRow - 1); ///< pairs of a slice of a brick
inline constexpr int kFine = 4;                  ///< cells along the edge of the smallest block with known bounds
inline constexpr int kQuantum = 32767;

/// Samples (filtered where the scene asks for it) in bricks of 16^3 cells, x fastest in a brick and over the bricks; a
/// trilinear sample and a gradient read only one brick. Each sample is followed by its neighbour along y: so two reads
/// of two pairs give all eight samples around a position. A brick has kRow pairs along x, kRow - 1 along y, kRow along
/// z, and one more may be read behind the last. On BCC the odd sublattice of a brick follows the even one. Positions
/// are cells of a sublattice plus kMargin. An absent sample is 0.
struct PacketVolume {
    bool bcc = false;
    bool exact = false;  ///< `floats` hold the samples, else `shorts`
    bool labels = false; ///< never interpolated; samples are whole numbers
    bool cubic = false;  ///< samples are coefficients of cubic B-splines: Filter::Cubic
    glm::ivec3 cells{1}; ///< of a sublattice, with margins: a position lies in [0, cells)
    glm::ivec3 bricks{1};
    volume::UnfilledVector<std::int16_t> shorts; ///< 0 .. kQuantum
    volume::UnfilledVector<float> floats;
    /// kQuantum or 0, at the same places; empty: all samples are present. Between two stored times also the weight of
    /// the one at which a sample is present; the sample has that weight, too.
    volume::UnfilledVector<std::int16_t> present;
    double offset = 0, scale = 1; ///< physical value = offset + scale * sample
    /// Bounds of the samples that interpolation, linear or cubic, in a block of kFine^3 cells can read, and whether one
    /// is absent. lo > hi: all are.
    glm::ivec3 blocks{1};
    std::vector<float> lo, hi;
    std::vector<std::uint8_t> absent; ///< empty: none
    /// Of a parameter with several parts (volume/field/parts.h), each with the samples of the others absent and in the
    /// same scale; then this one has bounds, but no samples.
    std::vector<PacketVolume> parts;

    int brickPairs() const { return kSlice * kRow; } ///< of one sublattice
    /// Pairs from one brick to the next.
    int stride() const { return brickPairs() * (bcc ? 2 : 1); }
    /// Index of a sample, which is the first of its pair; `sample` with margin, 0 .. cells - 1.
    std::size_t at(glm::ivec3 sample, int sublattice) const;
    std::size_t bytes() const;
};

/// What of a channel is read.
struct PacketChannel {
    int channel = 0;
    volume::TimePair time = {};
    Filter filter = Filter::AverageQuasi;
    bool exact = false; ///< 32-bit floats, else 15 bits over the range of the data
    bool mixed = false; ///< between two stored times both are mixed even where values there are to be computed
    bool operator==(const PacketChannel&) const = default;

    /// The same at one of the stored times around.
    PacketChannel at(int stored) const { return {channel, {stored, stored, 0}, filter, exact}; }
};

/// Whether packets can find their way in a lattice: positions have 15 bits of whole cells, and pairs are counted in 31.
bool fitsPackets(const volume::Lattice& lattice);

/// Sets the bounds of blocks from those of the parts.
void joinParts(PacketVolume& volume);

/// Samples at a stored time, or computed for a time between two (volume::sourceAt). Throws Error when the source does,
/// Cancelled once a stop is requested.
PacketVolume readPacketVolume(const volume::BrickSource& source, const PacketChannel& what, std::stop_token stop = {});

} // namespace tessera::vis::packet
