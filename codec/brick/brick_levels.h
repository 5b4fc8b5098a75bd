#pragma once

#include "codec/brick/brick_codec.h"
#include "codec/wavelet/level_box.h"

/// A brick taken apart into levels: for each sublattice and level a box whose low corner the next coarser level gives.
namespace tessera::codec {

/// [level * sublattices + sublattice]; the last level holds the coarsest samples, the others details; boxes behind them
/// are working memory.
template <class Word> using BrickLevels = std::vector<LevelBox<Word>>;

/// True when words of 16 bits do for a brick.
bool fitsInt16(const BrickFormat& format, bool masked);

/// Takes codes in storage order apart, down to `levels` levels in all. What `out` was before is used as memory. Of a
/// brick that predicts its odd grid that is at level 0 what the prediction leaves, undivided, and at the others
/// nothing.
template <class Word>
void splitBrick(const BrickFormat& format, std::span<const std::uint32_t> codes, std::span<const std::uint8_t> present,
                int levels, BrickLevels<Word>& out);
/// The same of integers that are all present, which are their own codes.
template <class Word>
void splitIntegers(const BrickFormat& format, std::span<const std::byte> samples, int levels, BrickLevels<Word>& out);

/// The samples of a level from those of the coarser one and the details in `fine`, which are used up.
template <class Word>
void joinLevel(const BrickFormat& format, const LevelBox<Word>& coarse, LevelBox<Word>& fine, LevelBox<Word>& samples);

/// The flags of one level in the places of its samples (the coarsest) or of its coefficients.
template <class Word>
void placeFlags(const BrickFormat& format, std::span<const std::uint8_t> present, int level, int sublattice, bool split,
                LevelBox<Word>& out);

/// The boxes of a level.
template <class Word>
std::span<LevelBox<Word>> boxesAt(BrickLevels<Word>& levels, const BrickFormat& format, int level) {
    const std::size_t step = std::size_t(format.sublattices());
    return std::span(levels).subspan(std::size_t(level) * step, step);
}

/// The seven bands of details of each box, or the boxes themselves where undivided or of the coarsest level.
template <class Word> std::vector<Band<Word>> bandsOf(std::span<LevelBox<Word>> boxes, bool coarsest);

/// How the coefficients of a segment are coded: as bands, or none is other than 0; the other modes are those of streams
/// and of whole bricks.
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
