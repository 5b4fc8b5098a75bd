#pragma once

#include "codec/bytes/uncleared.h"
#include "codec/wavelet/lift_box.h"

#include <algorithm>
#include <vector>

namespace tessera::codec {

/// A box with its storage, and a mask in the same layout. Elements without a sample (padding and absent ones) are
/// undefined.
template <class Word> class LevelBox {
public:
    LevelBox() = default;
    LevelBox(glm::ivec3 size, bool masked) { reset(size, masked); }
    /// Resizes the box; memory is reused.
    void reset(glm::ivec3 size, bool masked) {
        const std::size_t words = std::size_t(pitchFor(size.x)) * std::size_t(size.y) * std::size_t(size.z);
        size_ = size;
        if (values_.size() < words) values_.resize(words);
        present_.resize(masked ? words : 0);
        undivided_ = false;
    }
    /// Resizes the box and fills it with one value; all samples are present.
    void fill(glm::ivec3 size, Word value) {
        reset(size, false);
        std::fill_n(values_.begin(), std::ptrdiff_t(pitchFor(size.x)) * size.y * size.z, value);
    }
    /// Sets all words to 0.
    void clear() { std::fill_n(values_.begin(), std::ptrdiff_t(pitchFor(size_.x)) * size_.y * size_.z, Word(0)); }
    Box<Word> box() { return {values_.data(), size_, pitchFor(size_.x)}; }
    Box<const Word> box() const { return {values_.data(), size_, pitchFor(size_.x)}; }
    Box<std::uint8_t> flags() { return {masked() ? present_.data() : nullptr, size_, pitchFor(size_.x)}; }
    bool masked() const { return !present_.empty(); }
    /// Whether the box is a single band instead of seven subbands and a low corner for the coarser level.
    bool undivided() const { return undivided_; }
    void setUndivided() { undivided_ = true; }
    glm::ivec3 size() const { return size_; }

private:
    glm::ivec3 size_{0};
    Uncleared<Word> values_;
    std::vector<std::uint8_t> present_;
    bool undivided_ = false;
};

} // namespace tessera::codec
