#pragma once

#include "codec/fitted/padded_box.h"
#include "codec/fitted/taps.h"

#include <algorithm>
#include <array>
#include <glm/vec3.hpp>

/// Where the samples lie that a row is predicted from.
namespace tessera::codec {

template <class Word> using TapPlaces = std::array<const Word*, kMostTaps>;

/// Where the taps of a row's first sample are: `first` words behind the places.
template <class Word> struct TapRows {
    const Word* const* places = nullptr;
    std::ptrdiff_t first = 0;

    const Word* at(std::size_t tap) const { return places[tap] + first; }
};

/// The rows that a pass predicts, and the boxes they lie in.
///
/// Taps beyond the ends of the known samples are clamped to the nearest known row or slice. In place of rows of the
/// pass before the first, the known row stands that is before the predicted one (for AlongX and Odd: at its own place).
template <class Word> class PassRows {
public:
    /// `known` and `own` are the boxes of even and odd columns of a level with samples `size`, `own` also being `known`
    /// for AlongZ and AlongY; for Odd those of the even and the odd sublattice. Their rows and slices are equally far
    /// apart.
    PassRows(Pass pass, glm::ivec3 size, const PaddedBox<Word>& known, const PaddedBox<Word>& own)
        : pass_(pass), known_(known), own_(own) {
        const glm::ivec3 of = own.size();
        first_ = {pass == Pass::AlongZ ? 1 : 0, pass == Pass::AlongY ? 1 : 0};
        step_ = {pass == Pass::AlongZ ? 2 : 1, pass == Pass::AlongZ || pass == Pass::AlongY ? 2 : 1};
        count_ = {of.x,
                  pass == Pass::AlongZ   ? (size.y + 1) / 2
                  : pass == Pass::AlongY ? size.y / 2
                                         : of.y,
                  pass == Pass::AlongZ ? size.z / 2 : of.z};
        last_ = {known.size().z - 1, known.size().y - 1};
        if (pass == Pass::AlongZ) last_.z -= last_.z % 2;
        if (step_.y == 2) last_.y -= last_.y % 2;
    }

    Pass pass() const { return pass_; }
    /// Samples along a row, rows of a slice, slices.
    glm::ivec3 count() const { return count_; }
    /// Place of a row in its box.
    int zOf(int z) const { return first_.z + z * step_.z; }
    int yOf(int y) const { return first_.y + y * step_.y; }

    /// The taps of row y of slice z of the pass, until the next call. All rows of a slice that are far enough from its
    /// ends share their places.
    TapRows<Word> taps(int z, int y) {
        constexpr int kAcross = 3; // rows that taps are away at most
        const int at = yOf(y);
        const bool inner = at >= kAcross && at + kAcross < std::min(last_.y + 1, own_.size().y);
        if (!inner) {
            place(z, y, places_);
            return {places_.data(), 0};
        }
        if (innerZ_ != z) place(z, y, inner_), innerZ_ = z, innerY_ = at;
        return {inner_.data(), (at - innerY_) * own_.pitch()};
    }

private:
    struct ZY {
        int z = 0, y = 0;
    };

    void place(int z, int y, TapPlaces<Word>& places) const {
        const int atZ = zOf(z), atY = yOf(y), lastOwn = yOf(count_.y - 1);
        const TapSet& set = tapsOf(pass_);
        for (std::size_t i = 0; i < std::size_t(set.count); ++i) {
            const Tap& tap = set.taps[i];
            const int tapZ = atZ + tap.z, tapY = atY + tap.y;
            const Word* row = nullptr;
            if (!tap.own)
                row = known_.row(std::clamp(tapZ, 0, last_.z), std::clamp(tapY, 0, last_.y));
            else if (tapZ < first_.z || tapY < first_.y)
                row = known_.row(atZ - (pass_ == Pass::AlongZ ? 1 : 0), atY - (pass_ == Pass::AlongY ? 1 : 0));
            else
                row = own_.row(tapZ, std::min(tapY, lastOwn));
            places[i] = row + tap.x;
        }
    }

    Pass pass_;
    const PaddedBox<Word>&known_, &own_;
    ZY first_, step_, last_; ///< last known slice and row
    glm::ivec3 count_{0};
    TapPlaces<Word> places_{}, inner_{};
    int innerZ_ = -1, innerY_ = 0;
};

} // namespace tessera::codec
