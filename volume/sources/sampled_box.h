#pragma once

#include "volume/system/unfilled.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

/// Samples in boxes of a lattice: inside of volume/sources/centred_samples.h.
namespace tessera::volume {

/// A box [begin, end) of indices.
struct IndexBox {
    glm::ivec3 begin{0}, end{0};
    glm::ivec3 size() const { return end - begin; }
    std::size_t count() const { return std::size_t(size().x) * std::size_t(size().y) * std::size_t(size().z); }
    /// Place of an index of the box in memory, x fastest.
    std::size_t place(glm::ivec3 at) const {
        const glm::ivec3 in = at - begin, all = size();
        return (std::size_t(in.z) * std::size_t(all.y) + std::size_t(in.y)) * std::size_t(all.x) + std::size_t(in.x);
    }
};

/// Samples in a box, x fastest: of a regular grid, or of one sublattice in texels.
struct SampledBox {
    IndexBox box;
    UnfilledVector<float> values;
    std::vector<std::uint8_t> numbers; ///< of parts (volume/field/part_masks.h), 0 absent; empty: all have `number`
    std::uint8_t number = 1;
    std::uint8_t numberAt(std::size_t place) const { return numbers.empty() ? number : numbers[place]; }
};

/// Calls visit(index, place) for every index of a box, x fastest.
template <class Visit> void forEachIndex(const IndexBox& box, const Visit& visit) {
    std::size_t place = 0;
    for (int z = box.begin.z; z < box.end.z; ++z)
        for (int y = box.begin.y; y < box.end.y; ++y)
            for (int x = box.begin.x; x < box.end.x; ++x, ++place) visit(glm::ivec3(x, y, z), place);
}

/// A box like another, with numbers where that has some; values are 0 unless all are to be present.
inline SampledBox boxLike(const IndexBox& box, const SampledBox& other) {
    SampledBox out{box, UnfilledVector<float>(box.count()), {}, other.number};
    if (!other.numbers.empty()) out.numbers.resize(out.values.size());
    if (!other.numbers.empty() || other.number == 0) std::ranges::fill(out.values, 0.0f);
    return out;
}

/// One number for all where it is the same.
inline void simplify(SampledBox& box) {
    if (box.numbers.empty()) return;
    const std::uint8_t first = box.numbers.front();
    if (!std::ranges::all_of(box.numbers, [&](std::uint8_t number) { return number == first; })) return;
    box.number = first;
    box.numbers.clear();
}

/// Absent samples, and such as are not finite, get number and value 0.
inline void clean(SampledBox& box) {
    if (!std::ranges::all_of(box.values, [](float value) { return std::isfinite(value); })) {
        if (box.numbers.empty()) box.numbers.assign(box.values.size(), box.number);
        for (std::size_t i = 0; i < box.values.size(); ++i)
            if (!std::isfinite(box.values[i])) box.numbers[i] = 0;
    }
    simplify(box);
    if (box.numbers.empty() && box.number != 0) return;
    for (std::size_t i = 0; i < box.values.size(); ++i)
        if (box.numberAt(i) == 0) box.values[i] = 0;
}

} // namespace tessera::volume
