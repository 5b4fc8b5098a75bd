#include "codec/wavelet/subbands.h"

#include "codec/wavelet/lifting.h"

#include <algorithm>

namespace tessera::codec {

namespace {

/// A range of positions along one axis.
struct Stretch {
    int begin, size, halvings;
    bool high;
};

/// The low half of an axis of `size` samples, split again while it is long enough: its lengths.
std::vector<int> lengthsOf(int size, int least) {
    std::vector<int> lengths{size};
    while (lengths.back() >= std::max(least, 2)) lengths.push_back((lengths.back() + 1) / 2);
    return lengths;
}

std::vector<Stretch> lowStretches(int size, int halvings, int least) {
    const std::vector<int> lengths = lengthsOf(size, least);
    const int steps = int(lengths.size()) - 1;
    std::vector<Stretch> all{{0, lengths.back(), halvings + steps, false}};
    for (int step = steps; step > 0; --step) {
        const int low = lengths[std::size_t(step)];
        all.push_back({low, lengths[std::size_t(step - 1)] - low, halvings + step, true});
    }
    return all;
}

/// Calls `visit(first corner, size, kind)` for the seven details of a box.
void forDetails(glm::ivec3 size, auto&& visit) {
    const glm::ivec3 low = levelSize(size, 1);
    for (int kind = 1; kind < 8; ++kind) {
        glm::ivec3 begin(0), part = low;
        for (int axis = 0; axis < 3; ++axis)
            if ((kind >> axis & 1) != 0) begin[axis] = low[axis], part[axis] = size[axis] - low[axis];
        if (part.x > 0 && part.y > 0 && part.z > 0) visit(begin, part, kind);
    }
}

} // namespace

std::uint64_t Subband::gain() const {
    // L2 norms of the synthesis functions after 0 to 8 and 1 to 8 halvings.
    constexpr std::array<std::uint64_t, 9> kLow{256, 328, 459, 648, 917, 1296, 1833, 2592, 3666};
    constexpr std::array<std::uint64_t, 9> kHigh{256, 207, 248, 343, 484, 685, 968, 1369, 1936};
    std::uint64_t product = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<std::size_t>(std::min(halvings[axis], 8));
        product *= (high >> axis & 1) != 0 ? kHigh[at] : kLow[at];
    }
    return product;
}

std::vector<Subband> subbandsOf(glm::ivec3 size, int level, bool undivided, DetailSplit split) {
    if (size.x < 1 || size.y < 1 || size.z < 1) return {};
    if (undivided) return {{glm::ivec3(0), size, glm::ivec3(level), 0}};
    std::vector<Subband> bands;
    forDetails(size, [&](glm::ivec3 begin, glm::ivec3 part, int kind) {
        std::array<std::vector<Stretch>, 3> along;
        for (int axis = 0; axis < 3; ++axis) {
            const bool high = (kind >> axis & 1) != 0, again = !high && (split.axes >> axis & 1) != 0;
            along[std::size_t(axis)] = again ? lowStretches(part[axis], level + 1, split.least)
                                             : std::vector<Stretch>{{begin[axis], part[axis], level + 1, high}};
        }
        for (const Stretch& z : along[2])
            for (const Stretch& y : along[1])
                for (const Stretch& x : along[0]) {
                    if (x.size < 1 || y.size < 1 || z.size < 1) continue;
                    bands.push_back({{x.begin, y.begin, z.begin},
                                     {x.size, y.size, z.size},
                                     {x.halvings, y.halvings, z.halvings},
                                     (x.high ? 1 : 0) | (y.high ? 2 : 0) | (z.high ? 4 : 0)});
                }
    });
    return bands;
}

void splitDetails(LevelBox<std::int32_t>& box, Wavelet wavelet, bool wide, DetailSplit split, bool isForward) {
    if (split.axes == 0) return;
    const Box<std::int32_t> values = box.box();
    const Box<std::uint8_t> flags = box.flags();
    const std::ptrdiff_t row = values.pitch, slice = row * values.size.y;
    forDetails(values.size, [&](glm::ivec3 begin, glm::ivec3 part, int kind) {
        const std::ptrdiff_t at = begin.z * slice + begin.y * row + begin.x;
        auto* const words = reinterpret_cast<std::uint32_t*>(values.values + at);
        const auto lift = [&](int axis, int length) {
            glm::ivec3 size = part;
            size[axis] = length;
            liftAlong(axis, isForward, words, flags.values ? flags.values + at : nullptr, size, row, slice, wavelet,
                      wide ? Arithmetic::Wide : Arithmetic::Narrow);
        };
        for (int i = 0; i < 3; ++i) {
            const int axis = isForward ? i : 2 - i;
            if ((kind >> axis & 1) != 0 || (split.axes >> axis & 1) == 0) continue;
            std::vector<int> lengths = lengthsOf(part[axis], split.least);
            lengths.pop_back();
            if (!isForward) std::reverse(lengths.begin(), lengths.end());
            for (const int length : lengths) lift(axis, length);
        }
    });
}

} // namespace tessera::codec
