#pragma once

#include "codec/wavelet/lift_box.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tessera::codec {

/// A box of words whose rows go on at both ends, where pad() repeats the first and the last word.
template <class Word> class PaddedBox {
public:
    /// Boxes reset with equal `widest`, at least size.x, and size.y have rows equally far apart.
    void reset(glm::ivec3 size, int widest) {
        size_ = size;
        pitch_ = kBefore + (widest + kLanes - 1) / kLanes * kLanes + kBehind;
        const std::size_t words =
            std::size_t(pitch_) * std::size_t(std::max(size.y, 0)) * std::size_t(std::max(size.z, 0));
        if (values_.size() < words) values_.resize(words);
    }
    glm::ivec3 size() const { return size_; }
    std::ptrdiff_t pitch() const { return pitch_; }
    std::ptrdiff_t slice() const { return std::ptrdiff_t(pitch_) * size_.y; }
    Word* row(int z, int y) { return values_.data() + z * slice() + y * pitch() + kBefore; }
    const Word* row(int z, int y) const { return values_.data() + z * slice() + y * pitch() + kBefore; }
    void pad(int z, int y) {
        constexpr int kAlongRow = 2; // of taps along a row
        Word* const first = row(z, y);
        std::fill_n(first - kAlongRow, kAlongRow, first[0]);
        std::fill_n(first + size_.x, kAlongRow, first[size_.x - 1]);
    }

private:
    static constexpr int kLanes = 32, kBefore = kLanes, kBehind = kLanes;
    glm::ivec3 size_{0};
    int pitch_ = 0;
    std::vector<Word> values_;
};

} // namespace tessera::codec
