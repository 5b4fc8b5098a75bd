// Bricks of version 1 archives: byte planes through zstd. Read, never written.
#include "codec/brick/brick_codec_v1.h"

#include <algorithm>
#include <cassert>

namespace tessera::codec {

namespace {

/// Calls `visit(begin, count)` for each row of coefficients of a level: the corner of the coarsest one, or of the seven
/// others of a finer one those with high x, then high y, high x and y, high z, ...
template <class Visit> void forRows(glm::ivec3 full, glm::ivec3 part, glm::ivec3 low, bool coarsest, Visit&& visit) {
    for (int band = coarsest ? 0 : 1; band < (coarsest ? 1 : 8); ++band) {
        glm::ivec3 lo(0), hi = coarsest ? part : low;
        for (int axis = 0; axis < 3; ++axis)
            if ((band >> axis & 1) != 0) lo[axis] = low[axis], hi[axis] = part[axis];
        if (hi.x <= lo.x) continue;
        for (int z = lo.z; z < hi.z; ++z)
            for (int y = lo.y; y < hi.y; ++y)
                visit((std::size_t(z) * std::size_t(full.y) + std::size_t(y)) * std::size_t(full.x) + std::size_t(lo.x),
                      std::size_t(hi.x - lo.x));
    }
}

/// One sublattice while it is transformed: coefficients and flags of the box of some level.
struct Plane {
    glm::ivec3 size{0};
    std::vector<std::uint32_t> values;
    std::vector<std::uint8_t> present; ///< empty: all present
};

/// Slices of one sublattice of a storage array, in order.
template <class T>
void takeSlices(std::span<const T> storage, glm::ivec3 size, int sublattice, int step, std::vector<T>& out) {
    const std::size_t slice = std::size_t(size.x) * std::size_t(size.y);
    for (int z = sublattice; z < size.z; z += step) {
        const T* from = storage.data() + std::size_t(z) * slice;
        out.insert(out.end(), from, from + slice);
    }
}
void toBox(const Plane& plane, LevelBox<std::int32_t>& box) {
    box.reset(plane.size, false);
    const std::uint32_t* from = plane.values.data();
    for (int z = 0; z < plane.size.z; ++z)
        for (int y = 0; y < plane.size.y; ++y, from += plane.size.x)
            std::copy_n(from, plane.size.x, box.box().row(y, z));
}

} // namespace

DecodeStatus decodeBrickV1(const BrickFormat& format, std::span<const std::span<const std::byte>> segments, int level,
                           std::span<const std::uint8_t> present, DecodedBrick& out) {
    assert(level >= 0 && level < format.levels && int(segments.size()) == format.levels - level);
    assert(present.empty() || present.size() == countOf(format.size));
    const int step = format.sublattices(), steps = format.levels - 1 - level;
    const glm::ivec3 size = samplesAt(format, level);
    out.begin(format, level);
    out.present = maskAt(format, present, level);

    std::vector<Plane> planes(static_cast<std::size_t>(step));
    for (int s = 0; s < step; ++s) {
        Plane& plane = planes[std::size_t(s)];
        plane.size = levelSize(format.sublatticeSize(s), level);
        plane.values.resize(countOf(plane.size));
        if (out.present.empty()) continue;
        takeSlices(std::span<const std::uint8_t>(out.present), size, s, step, plane.present);
        deinterleave(plane.present, plane.size, steps);
    }

    std::vector<std::uint32_t> symbols;
    for (int i = 0; i <= steps; ++i) {
        const bool coarsest = i == 0;
        // The places of this level's coefficients, counted first.
        std::size_t count = 0;
        const auto visitPlaces = [&](auto&& visit) {
            for (Plane& plane : planes)
                forRows(plane.size, levelSize(plane.size, steps - i), levelSize(plane.size, steps - i + 1), coarsest,
                        [&](std::size_t begin, std::size_t length) { visit(plane, begin, length); });
        };
        visitPlaces([&](const Plane& plane, std::size_t begin, std::size_t length) {
            if (plane.present.empty())
                count += length;
            else
                for (std::size_t at = begin; at < begin + length; ++at) count += plane.present[at] != 0 ? 1 : 0;
        });
        std::span<const std::byte> in = segments[std::size_t(i)];
        symbols.resize(count);
        std::span<std::uint32_t> coded = symbols;
        if (coarsest && count > 0) {
            if (in.size() < 4) return DecodeStatus::Truncated;
            symbols[0] = readU32(in.data());
            in = in.subspan(4);
            coded = coded.subspan(1);
        }
        if (const DecodeStatus status = decodeStream(in, coded); status != DecodeStatus::Ok) return status;
        for (std::uint32_t& symbol : coded) symbol = unzigzag(symbol);
        if (coarsest)
            for (std::size_t k = 1; k < count; ++k) symbols[k] += symbols[k - 1];
        const std::uint32_t* next = symbols.data();
        visitPlaces([&](Plane& plane, std::size_t begin, std::size_t length) {
            if (plane.present.empty()) {
                std::copy(next, next + length, plane.values.begin() + std::ptrdiff_t(begin));
                next += length;
            } else {
                for (std::size_t at = begin; at < begin + length; ++at)
                    if (plane.present[at] != 0) plane.values[at] = *next++;
            }
        });

        if (i == format.levels - 1)
            if (const DecodeStatus status = decodeExtras(format, present, in, out); status != DecodeStatus::Ok)
                return status;
        if (!in.empty()) return DecodeStatus::Trailing;
    }

    for (int s = 0; s < step; ++s) {
        Plane& plane = planes[std::size_t(s)];
        inverse(plane.values, plane.present, plane.size, steps, effectiveWavelet(format), arithmeticOf(format));
        toBox(plane, out.boxes32.samples[std::size_t(s)]);
    }
    return DecodeStatus::Ok;
}

} // namespace tessera::codec
