#pragma once

#include "codec/brick_codec.h"
#include "codec/lift_box.h"

#include <memory>

/// A brick taken apart into levels: for each sublattice and level a box whose low corner the next coarser level gives.
namespace tessera::codec {

/// A box with its storage, and the flags of its samples in the same places.
template <class Word> class LevelBox {
public:
    LevelBox() = default;
    /// What no sample will be written to is zero: between the rows, and where absent.
    LevelBox(glm::ivec3 size, bool masked) : size_(size) {
        const std::size_t words = std::size_t(pitchFor(size.x)) * std::size_t(size.y) * std::size_t(size.z);
        const bool gaps = masked || pitchFor(size.x) != size.x;
        values_ = gaps ? std::make_unique<Word[]>(words) : std::make_unique_for_overwrite<Word[]>(words);
        present_.resize(masked ? words : 0);
    }
    Box<Word> box() { return {values_.get(), size_, pitchFor(size_.x)}; }
    Box<const Word> box() const { return {values_.get(), size_, pitchFor(size_.x)}; }
    Box<std::uint8_t> flags() { return {masked() ? present_.data() : nullptr, size_, pitchFor(size_.x)}; }
    bool masked() const { return !present_.empty(); }
    glm::ivec3 size() const { return size_; }

private:
    glm::ivec3 size_{0};
    std::unique_ptr<Word[]> values_;
    std::vector<std::uint8_t> present_;
};

/// [level * sublattices + sublattice]; the last level holds the coarsest samples, the others details.
template <class Word> using BrickLevels = std::vector<LevelBox<Word>>;

/// True when words of 16 bits do for a brick.
bool fitsInt16(const BrickFormat& format, bool masked);

/// One sublattice of the samples in storage order, or back.
template <class Word>
void takeSublattice(const BrickFormat& format, std::span<const std::uint32_t> codes,
                    std::span<const std::uint8_t> present, int sublattice, LevelBox<Word>& out);
template <class Word>
void putSublattice(const BrickFormat& format, const LevelBox<Word>& from, int sublattice,
                   std::span<std::uint32_t> codes);

/// Takes codes in storage order apart, down to `levels` levels in all.
template <class Word>
BrickLevels<Word> splitBrick(const BrickFormat& format, std::span<const std::uint32_t> codes,
                             std::span<const std::uint8_t> present, int levels);

/// Replaces the details in `fine` and the samples in `coarse` by the samples of the finer level.
template <class Word> void joinLevel(const BrickFormat& format, const LevelBox<Word>& coarse, LevelBox<Word>& fine);

/// The flags of one level in the places of its samples (the coarsest) or of its coefficients.
template <class Word>
void placeFlags(const BrickFormat& format, std::span<const std::uint8_t> present, int level, int sublattice, bool split,
                LevelBox<Word>& out);

/// The seven bands of details of each box, or the boxes themselves of the coarsest level.
template <class Word> std::vector<Band<Word>> bandsOf(std::span<LevelBox<Word>> boxes, bool coarsest);

} // namespace tessera::codec
