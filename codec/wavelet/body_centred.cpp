#include "codec/wavelet/body_centred.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace tessera::codec {

namespace {

/// The four neighbours of position i + 1/2 along an axis of n samples.
std::array<int, 4> neighbours(int i, int n) {
    std::array<int, 4> at{};
    for (int k = 0; k < 4; ++k) at[std::size_t(k)] = std::clamp(i - 1 + k, 0, n - 1);
    return at;
}

/// Sixteen times the cubic interpolation at the centre of four samples.
template <class Sum> Sum middle(Sum a, Sum b, Sum c, Sum d) {
    return 9 * (b + c) - (a + d);
}

/// Calls `visit(row of odd samples, predictions, count)` for every row.
template <class Sum, class Word, class Visit>
void forPredictions(const Box<const Word>& even, const Box<Word>& odd, Visit&& visit) {
    const auto nx = std::size_t(even.size.x), width = nx + 3;
    const std::size_t rows = std::size_t(even.size.y);
    std::vector<Sum> slice(nx * rows), row(width), predicted(nx);
    for (int z = 0; z < odd.size.z; ++z) {
        const auto zs = neighbours(z, even.size.z);
        for (int y = 0; y < even.size.y; ++y) {
            const Word *a = even.row(y, zs[0]), *b = even.row(y, zs[1]), *c = even.row(y, zs[2]),
                       *d = even.row(y, zs[3]);
            Sum* const to = slice.data() + std::size_t(y) * nx;
            for (std::size_t x = 0; x < nx; ++x) to[x] = middle<Sum>(a[x], b[x], c[x], d[x]);
        }
        for (int y = 0; y < odd.size.y; ++y) {
            const auto ys = neighbours(y, even.size.y);
            const auto rowOf = [&](int k) { return slice.data() + std::size_t(ys[std::size_t(k)]) * nx; };
            const Sum *a = rowOf(0), *b = rowOf(1), *c = rowOf(2), *d = rowOf(3);
            // One padding sample before, two after.
            for (std::size_t x = 0; x < nx; ++x) row[x + 1] = middle<Sum>(a[x], b[x], c[x], d[x]);
            row[0] = row[1];
            row[nx + 1] = row[nx + 2] = row[nx];
            for (std::size_t x = 0; x < nx; ++x)
                predicted[x] = (middle<Sum>(row[x], row[x + 1], row[x + 2], row[x + 3]) + 2048) >> 12;
            visit(odd.row(y, z), predicted.data(), nx);
        }
    }
}

template <class Word, class Visit>
void withPredictions(const Box<const Word>& even, const Box<Word>& odd, bool wide, Visit&& visit) {
    if (even.size.x < 1 || even.size.y < 1 || odd.size.z < 1) return;
    if (wide)
        forPredictions<std::int64_t>(even, odd, visit);
    else
        forPredictions<std::int32_t>(even, odd, visit);
}

} // namespace

template <class Word> void subtractPrediction(const Box<const Word>& even, const Box<Word>& odd, bool wide) {
    withPredictions(even, odd, wide, [](Word* row, const auto* predicted, std::size_t count) {
        for (std::size_t x = 0; x < count; ++x)
            row[x] = static_cast<Word>(static_cast<std::uint32_t>(row[x]) - static_cast<std::uint32_t>(predicted[x]));
    });
}

template <class Word> void addPrediction(const Box<const Word>& even, const Box<Word>& odd, bool wide) {
    withPredictions(even, odd, wide, [](Word* row, const auto* predicted, std::size_t count) {
        for (std::size_t x = 0; x < count; ++x)
            row[x] = static_cast<Word>(static_cast<std::uint32_t>(row[x]) + static_cast<std::uint32_t>(predicted[x]));
    });
}

template <class Word> void interpolateOdd(const Box<const Word>& even, const Box<Word>& odd, int level) {
    const int bits = level + 1;
    const std::int64_t half = std::int64_t(1) << (3 * bits - 1);
    // Two adjacent samples along an axis; beyond the last one extrapolated linearly.
    struct Pair {
        int a, b;
        std::int64_t ofA, ofB;
    };
    const auto pairAt = [bits](int i, int n) {
        const std::int64_t near = (std::int64_t(1) << bits) - 1;
        if (i + 1 < n) return Pair{i, i + 1, near, 1};
        return i > 0 ? Pair{i, i - 1, near + 2, -1} : Pair{i, i, near, 1};
    };
    std::vector<Pair> along;
    for (int x = 0; x < odd.size.x; ++x) along.push_back(pairAt(x, even.size.x));
    for (int z = 0; z < odd.size.z; ++z)
        for (int y = 0; y < odd.size.y; ++y) {
            const Pair up = pairAt(y, even.size.y), above = pairAt(z, even.size.z);
            const Word *a = even.row(up.a, above.a), *b = even.row(up.b, above.a), *c = even.row(up.a, above.b),
                       *d = even.row(up.b, above.b);
            Word* const to = odd.row(y, z);
            for (int x = 0; x < odd.size.x; ++x) {
                const Pair right = along[std::size_t(x)];
                const auto blend = [&right](const Word* row) {
                    return right.ofA * std::int64_t(row[right.a]) + right.ofB * std::int64_t(row[right.b]);
                };
                const std::int64_t low = up.ofA * blend(a) + up.ofB * blend(b),
                                   high = up.ofA * blend(c) + up.ofB * blend(d);
                to[x] = static_cast<Word>((above.ofA * low + above.ofB * high + half) >> (3 * bits));
            }
        }
}

#define TESSERA_BODY_CENTRED(Word)                                                                                     \
    template void subtractPrediction(const Box<const Word>&, const Box<Word>&, bool);                                  \
    template void addPrediction(const Box<const Word>&, const Box<Word>&, bool);                                       \
    template void interpolateOdd(const Box<const Word>&, const Box<Word>&, int);
TESSERA_BODY_CENTRED(std::int16_t)
TESSERA_BODY_CENTRED(std::int32_t)
#undef TESSERA_BODY_CENTRED

} // namespace tessera::codec
