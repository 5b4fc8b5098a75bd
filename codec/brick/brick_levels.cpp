#include "codec/brick/brick_levels.h"

#include "codec/wavelet/body_centred.h"

#include <algorithm>
#include <concepts>
#include <type_traits>

namespace tessera::codec {

namespace {

bool liftsFast(const BrickFormat& format, bool masked) {
    return !masked && arithmeticOf(format) != Arithmetic::Float && liftsBoxes(format.wavelet);
}

template <class Word> void copyCorner(const Box<const Word>& from, const Box<Word>& to, glm::ivec3 size) {
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y) std::copy_n(from.row(y, z), size.x, to.row(y, z));
}

/// A box without padding, for the transforms that support masks and floats.
struct Dense {
    std::vector<std::uint32_t> values;
    std::vector<std::uint8_t> present;
};

template <class Word> Dense gatherDense(LevelBox<Word>& from) {
    Dense dense;
    const glm::ivec3 size = from.size();
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y) {
            const Word* row = from.box().row(y, z);
            for (int x = 0; x < size.x; ++x)
                dense.values.push_back(static_cast<std::uint32_t>(static_cast<std::int32_t>(row[x])));
            if (!from.masked()) continue;
            const std::uint8_t* flags = from.flags().row(y, z);
            dense.present.insert(dense.present.end(), flags, flags + size.x);
        }
    return dense;
}

template <class Word> void spreadDense(const Dense& dense, LevelBox<Word>& to) {
    const glm::ivec3 size = to.size();
    std::size_t at = 0;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y, at += std::size_t(size.x)) {
            Word* row = to.box().row(y, z);
            for (std::size_t x = 0; x < std::size_t(size.x); ++x)
                row[x] = static_cast<Word>(static_cast<std::int32_t>(dense.values[at + x]));
            if (to.masked()) std::copy_n(dense.present.begin() + std::ptrdiff_t(at), size.x, to.flags().row(y, z));
        }
}

} // namespace

bool fitsInt16(const BrickFormat& format, bool masked) {
    return format.codeBits <= kBitsOfInt16 && !format.isStepped() && liftsFast(format, masked);
}

namespace {

/// Extracts slice z of one sublattice of samples in storage order.
template <class Word, class Number>
void takeSlice(const BrickFormat& format, const Number* numbers, int sublattice, int z, const Box<Word>& out, int to) {
    const glm::ivec3 size = out.size;
    for (int y = 0; y < size.y; ++y) {
        const std::size_t from =
            (std::size_t(z * format.sublattices() + sublattice) * std::size_t(size.y) + std::size_t(y)) *
            std::size_t(size.x);
        Word* row = out.row(y, to);
        for (std::size_t x = 0; x < std::size_t(size.x); ++x)
            row[x] = static_cast<Word>(static_cast<std::int32_t>(numbers[from + x]));
    }
}

/// Extracts one sublattice, with its flags.
template <class Word, class Number>
void takeSublattice(const BrickFormat& format, const Number* numbers, std::span<const std::uint8_t> present,
                    int sublattice, LevelBox<Word>& out) {
    const glm::ivec3 size = out.size();
    for (int z = 0; z < size.z; ++z) {
        takeSlice(format, numbers, sublattice, z, out.box(), z);
        if (out.masked()) takeSlice(format, present.data(), sublattice, z, out.flags(), z);
    }
}

template <class Word, class Number>
void split(const BrickFormat& format, const Number* numbers, std::span<const std::uint8_t> present, int levels,
           BrickLevels<Word>& out) {
    const bool masked = !present.empty();
    const int step = format.sublattices();
    const bool wide = format.codeBits > kBitsOfInt32;
    const bool predicted = levels > 1 && format.predictsOdd(masked);
    out.resize(std::size_t((levels + 1) * step));
    for (int s = 0; s < step; ++s) {
        // The box after those of the levels holds the input of the next transform step.
        const auto box = [&](int level) -> LevelBox<Word>& { return out[std::size_t(level * step + s)]; };
        if (predicted && s == 1) break; // transformed together with the other sublattice
        LevelBox<Word>& whole = levels > 1 ? box(levels) : box(0);
        const glm::ivec3 size = format.sublatticeSize(s);
        const bool bySlices = levels > 1 && !predicted && liftsFast(format, masked) && countOf(size) > 0;
        whole.reset(bySlices ? glm::ivec3(size.x, size.y, 1) : size, masked);
        if (!bySlices) takeSublattice(format, numbers, present, s, whole);
        if (predicted) {
            LevelBox<Word>& odd = out[1];
            odd.reset(format.sublatticeSize(1), false);
            odd.setUndivided();
            takeSublattice(format, numbers, present, 1, odd);
            subtractPrediction<Word>(std::as_const(whole).box(), odd.box(), format.codeBits > kBitsOfPrediction);
            for (int level = 1; level < levels; ++level) out[std::size_t(level * step + 1)].reset(glm::ivec3(0), false);
        }
        for (int level = 0; level + 1 < levels; ++level) {
            LevelBox<Word>&samples = box(levels), &details = box(level);
            details.reset(bySlices && level == 0 ? size : samples.size(), masked);
            if (bySlices && level == 0) { // a slice stays in the cache
                const auto sliceOf = [&](int z) -> const Word* {
                    takeSlice(format, numbers, s, z, samples.box(), 0);
                    return samples.box().values;
                };
                splitSlices<Word>(sliceOf, details.box(), format.wavelet, wide);
            } else if (countOf(samples.size()) == 0) {
                // the odd sublattice of a single slice
            } else if (liftsFast(format, masked)) {
                splitBox<Word>(std::as_const(samples).box(), details.box(), format.wavelet, wide);
            } else {
                Dense dense = gatherDense(samples);
                forward(dense.values, dense.present, samples.size(), 1, effectiveWavelet(format), arithmeticOf(format));
                spreadDense(dense, details);
            }
            LevelBox<Word>& low = level + 2 < levels ? box(levels) : box(levels - 1);
            low.reset(levelSize(details.size(), 1), masked);
            copyCorner<Word>(std::as_const(details).box(), low.box(), low.size());
            for (int z = 0; masked && z < low.size().z; ++z)
                for (int y = 0; y < low.size().y; ++y)
                    std::copy_n(details.flags().row(y, z), low.size().x, low.flags().row(y, z));
        }
    }
}

} // namespace

template <class Word>
void splitBrick(const BrickFormat& format, std::span<const std::uint32_t> codes, std::span<const std::uint8_t> present,
                int levels, BrickLevels<Word>& out) {
    split<Word>(format, codes.data(), present, levels, out);
}

template <class Word>
void splitIntegers(const BrickFormat& format, std::span<const std::byte> samples, int levels, BrickLevels<Word>& out) {
    volume::dispatch(format.type, [&]<class T>(T) {
        if constexpr (!std::same_as<T, float>)
            split<Word>(format, reinterpret_cast<const T*>(samples.data()), {}, levels, out);
    });
}

template <class Word>
void joinLevel(const BrickFormat& format, const LevelBox<Word>& coarse, LevelBox<Word>& fine, LevelBox<Word>& samples) {
    if (countOf(fine.size()) == 0) {
        samples.reset(fine.size(), fine.masked());
        return;
    }
    copyCorner<Word>(coarse.box(), fine.box(), coarse.size());
    if (liftsFast(format, fine.masked())) {
        samples.reset(fine.size(), false);
        joinBox<Word>(fine.box(), samples.box(), format.wavelet, format.codeBits > kBitsOfInt32);
        return;
    }
    Dense dense = gatherDense(fine);
    inverse(dense.values, dense.present, fine.size(), 1, effectiveWavelet(format), arithmeticOf(format));
    spreadDense(dense, fine);
    std::swap(fine, samples);
}

template <class Word>
void placeFlags(const BrickFormat& format, std::span<const std::uint8_t> present, int level, int sublattice, bool split,
                LevelBox<Word>& out) {
    const glm::ivec3 size = out.size();
    const int step = format.sublattices();
    std::vector<std::uint8_t> dense;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const int fineZ = (z << level) * step + sublattice;
                dense.push_back(present[(std::size_t(fineZ) * std::size_t(format.size.y) + std::size_t(y << level)) *
                                            std::size_t(format.size.x) +
                                        std::size_t(x << level)]);
            }
    if (split) deinterleave(dense, size, 1);
    std::size_t at = 0;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y, at += std::size_t(size.x))
            std::copy_n(dense.begin() + std::ptrdiff_t(at), size.x, out.flags().row(y, z));
}

template <class Word> std::vector<Band<Word>> bandsOf(std::span<LevelBox<Word>> boxes, bool coarsest) {
    std::vector<Band<Word>> bands;
    for (LevelBox<Word>& level : boxes) {
        const Box<Word> box = level.box();
        const Box<std::uint8_t> flags = level.flags();
        const glm::ivec3 low = levelSize(box.size, 1);
        const bool whole = coarsest || level.undivided();
        for (int band = whole ? 0 : 1; band < (whole ? 1 : 8); ++band) {
            glm::ivec3 begin(0), size = whole ? box.size : low;
            for (int axis = 0; axis < 3; ++axis)
                if ((band >> axis & 1) != 0) begin[axis] = low[axis], size[axis] = box.size[axis] - low[axis];
            if (size.x < 1 || size.y < 1 || size.z < 1) continue;
            Band<Word> one;
            one.values = box.row(begin.y, begin.z) + begin.x;
            one.present = level.masked() ? flags.row(begin.y, begin.z) + begin.x : nullptr;
            one.size = size;
            one.rowPitch = box.pitch;
            one.slicePitch = std::ptrdiff_t(box.pitch) * box.size.y;
            one.kind = band;
            bands.push_back(one);
        }
    }
    return bands;
}

// Word is a type, around which no parentheses may stand.
#define TESSERA_LEVELS(Word)                                                                                           \
    template void splitBrick(const BrickFormat&, std::span<const std::uint32_t>, std::span<const std::uint8_t>, int,   \
                             BrickLevels<Word>&);                                                                      \
    template void splitIntegers(const BrickFormat&, std::span<const std::byte>, int, BrickLevels<Word>&);              \
    template void joinLevel(const BrickFormat&, const LevelBox<Word>&, LevelBox<Word>&, LevelBox<Word>&);              \
    template void placeFlags(const BrickFormat&, std::span<const std::uint8_t>, int, int, bool, LevelBox<Word>&);      \
    template std::vector<Band<Word>> bandsOf(std::span<LevelBox<Word>>, bool); // NOLINT(bugprone-macro-parentheses)
TESSERA_LEVELS(std::int16_t)
TESSERA_LEVELS(std::int32_t)
#undef TESSERA_LEVELS

} // namespace tessera::codec
