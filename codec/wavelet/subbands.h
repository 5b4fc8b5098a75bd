#pragma once

#include "codec/wavelet/level_box.h"

#include <array>
#include <cstdint>
#include <vector>

/// The subbands of a level whose details are transformed further along some axes.
///
/// A step of the transform leaves seven detail subbands, in which a field that varies little along an axis still does.
/// With all axes this is the standard decomposition, without any the non-standard one (Beylkin, Coifman, Rokhlin 1991).
/// (FORMAT.md "Stepped bricks".)
namespace tessera::codec {

struct DetailSplit {
    int axes = 0;  ///< bits of the axes along which low halves of details are split again ...
    int least = 6; ///< ... as long as they have so many samples; at least 2

    bool operator==(const DetailSplit&) const = default;
};

/// How coefficients are quantised.
struct StepChoice {
    DetailSplit split;
    std::uint32_t quantum = 0; ///< of coefficients whose waveforms have length 1, in 1/16 of a code

    bool operator==(const StepChoice&) const = default;
};

/// A part of the box of a level.
struct Subband {
    glm::ivec3 begin{0}, size{0};
    glm::ivec3 halvings{0}; ///< per axis: number of times that samples were split into halves, up to this subband
    int high = 0;           ///< bits of the axes along which it is a high half

    /// Product over the axes of the lengths of the waveforms of the wavelet (4,4), in units of 1/256 each.
    std::uint64_t gain() const;
};

/// The subbands of the box of a level, in coding order, without empty ones; one for an undivided box.
std::vector<Subband> subbandsOf(glm::ivec3 size, int level, bool undivided, DetailSplit split);

/// Transforms the seven detail subbands of a box further, or back. Flags move with their samples.
void splitDetails(LevelBox<std::int32_t>& box, Wavelet wavelet, bool wide, DetailSplit split, bool isForward);

} // namespace tessera::codec
