#pragma once

#include "codec/bands/band.h"
#include "codec/brick/brick_format.h"
#include "codec/wavelet/level_box.h"

/// The levels of a transformed brick: for each sublattice and level a box, whose low corner is replaced by the next
/// coarser level.
namespace tessera::codec {

/// Index [level * sublattices + sublattice]. The last level has the coarsest samples, the others have details; further
/// boxes are working memory.
template <class Word> using BrickLevels = std::vector<LevelBox<Word>>;

/// Whether 16-bit words suffice for a brick.
bool fitsInt16(const BrickFormat& format, bool masked);

/// Transforms codes in storage order into `levels` levels. The memory of `out` is reused. If the brick predicts its odd
/// sublattice, that sublattice has the prediction residuals at level 0, not divided into subbands, and nothing at the
/// other levels.
template <class Word>
void splitBrick(const BrickFormat& format, std::span<const std::uint32_t> codes, std::span<const std::uint8_t> present,
                int levels, BrickLevels<Word>& out);
/// The same for integers without absent samples, which are their own codes.
template <class Word>
void splitIntegers(const BrickFormat& format, std::span<const std::byte> samples, int levels, BrickLevels<Word>& out);

/// Computes the samples of a level from those of the coarser level and the details in `fine`, which is overwritten.
template <class Word>
void joinLevel(const BrickFormat& format, const LevelBox<Word>& coarse, LevelBox<Word>& fine, LevelBox<Word>& samples);

/// The mask of one level, in the layout of its samples (coarsest level) or of its coefficients.
template <class Word>
void placeFlags(const BrickFormat& format, std::span<const std::uint8_t> present, int level, int sublattice, bool split,
                LevelBox<Word>& out);

/// The boxes of one level.
template <class Word>
std::span<LevelBox<Word>> boxesAt(BrickLevels<Word>& levels, const BrickFormat& format, int level) {
    const std::size_t step = std::size_t(format.sublattices());
    return std::span(levels).subspan(std::size_t(level) * step, step);
}

/// The seven detail subbands of each box; one band if it is undivided or of the coarsest level.
template <class Word> std::vector<Band<Word>> bandsOf(std::span<LevelBox<Word>> boxes, bool coarsest);

/// Mode byte of a segment: coded as bands, or all coefficients are 0; the other modes are those of streams and whole
/// bricks.
inline constexpr std::byte kBands{4}, kNothing{0};

/// Calls `visit(word)` for the present coefficients, band by band.
template <class Word, class Visit> void forCoefficients(std::span<const Band<Word>> bands, Visit&& visit) {
    for (const Band<Word>& band : bands)
        for (int z = 0; z < band.size.z; ++z)
            for (int y = 0; y < band.size.y; ++y) {
                const std::ptrdiff_t at = z * band.slicePitch + y * band.rowPitch;
                for (int x = 0; x < band.size.x; ++x)
                    if (!band.present || band.present[at + x] != 0) visit(band.values[at + x]);
            }
}

} // namespace tessera::codec
