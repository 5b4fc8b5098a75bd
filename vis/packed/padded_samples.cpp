#include "vis/packed/padded_samples.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/bricks/parts_bricks.h"
#include "volume/reconstruct/reconstruct.h"

#include <algorithm>
#include <glm/vec2.hpp>
#include <mutex>

namespace tessera::vis::packet {

namespace {

/// The array that readPadded() fills.
class Padding {
public:
    Padding(const volume::Lattice& lattice, const PaddedRead& what)
        : lattice_(lattice), slices_(lattice.kind == volume::LatticeKind::BCC ? 2 : 1),
          first_(what.first * glm::ivec3(1, 1, slices_)) {
        samples_.size = what.count * glm::ivec3(1, 1, slices_);
        const std::size_t total =
            std::size_t(samples_.size.x) * std::size_t(samples_.size.y) * std::size_t(samples_.size.z);
        samples_.values.resize(total);
    }

    /// `begin`: storage index of the brick's first sample in the lattice.
    void insert(glm::ivec3 begin, const volume::BrickSamples& brick) {
        const bool whole = std::ranges::find(brick.present, std::uint8_t(0)) == brick.present.end();
        if (!whole) std::call_once(masked_, [&] { samples_.present.resize(samples_.values.size(), 1); });
        const glm::ivec3 to = begin - first_;
        for (int z = 0; z < brick.size.z; ++z)
            for (int y = 0; y < brick.size.y; ++y) {
                const std::size_t out = row(to.y + y, to.z + z) + std::size_t(to.x);
                const std::size_t in =
                    (std::size_t(z) * std::size_t(brick.size.y) + std::size_t(y)) * std::size_t(brick.size.x);
                std::copy_n(brick.values.data() + in, brick.size.x, samples_.values.data() + out);
                for (std::size_t x = 0; x < std::size_t(brick.size.x) && !whole; ++x) {
                    if (brick.isPresent(in + x)) continue;
                    samples_.values[out + x] = 0;
                    samples_.present[out + x] = 0;
                }
            }
    }

    /// Once all bricks are inserted.
    PaddedSamples padded() {
        pad(samples_.values);
        if (!samples_.present.empty()) pad(samples_.present);
        return std::move(samples_);
    }

private:
    std::size_t row(int y, int z) const {
        return (std::size_t(z) * std::size_t(samples_.size.y) + std::size_t(y)) * std::size_t(samples_.size.x);
    }
    /// The row that a row repeats, itself if it lies in the lattice.
    glm::ivec2 nearest(int y, int z) const {
        const glm::ivec3 at(0, first_.y + y, first_.z + z);
        const glm::ivec3 inside = volume::clampToLattice(lattice_.kind, lattice_.size, at) - first_;
        return {inside.y, inside.z};
    }
    /// Fills the places where the lattice has no sample with the nearest one: along rows, then whole rows.
    template <class Values> void pad(Values& values) const {
        const int begin = -first_.x, end = begin + lattice_.size.x;
        const auto eachRow = [&](const auto& visit) {
            parallelFor(std::size_t(samples_.size.z), [&](std::size_t slice) {
                const int z = int(slice);
                for (int y = 0; y < samples_.size.y; ++y)
                    visit(values.data() + row(y, z), glm::ivec2(y, z), nearest(y, z));
            });
        };
        eachRow([&](auto* to, glm::ivec2 at, glm::ivec2 from) {
            if (from != at) return;
            std::fill(to, to + begin, to[begin]);
            std::fill(to + end, to + samples_.size.x, to[end - 1]);
        });
        eachRow([&](auto* to, glm::ivec2 at, glm::ivec2 from) {
            if (from != at) std::copy_n(values.data() + row(from.x, from.y), samples_.size.x, to);
        });
    }

    const volume::Lattice& lattice_;
    int slices_;
    glm::ivec3 first_; ///< storage index of the first sample
    PaddedSamples samples_;
    std::once_flag masked_; ///< samples_.present has room for all
};

} // namespace

void Extent::add(const Extent& other) {
    *this = {std::min(lo, other.lo), std::max(hi, other.hi)};
}

Extent extentOf(const float* values, const std::uint8_t* present, std::size_t count) {
    constexpr std::size_t kTogether = 16; // so that the compiler uses vectors
    Extent out;
    float lo[kTogether], hi[kTogether];
    std::ranges::fill(lo, Extent{}.lo);
    std::ranges::fill(hi, Extent{}.hi);
    const std::size_t whole = present == nullptr ? count / kTogether * kTogether : 0;
    for (std::size_t s = 0; s < whole; s += kTogether)
        for (std::size_t i = 0; i < kTogether; ++i) {
            lo[i] = std::min(lo[i], values[s + i]);
            hi[i] = std::max(hi[i], values[s + i]);
        }
    for (std::size_t s = whole; s < count; ++s)
        if (present == nullptr || present[s] != 0) out.add({values[s], values[s]});
    for (std::size_t i = 0; i < kTogether; ++i) out.add({lo[i], hi[i]});
    return out;
}

PaddedSamples readPadded(const volume::BrickSource& source, const PaddedRead& what, std::stop_token stop) {
    const volume::BrickGrid& grid = source.grid();
    Padding padding(grid.lattice, what);
    parallelFor(grid.brickCount(), [&](std::size_t i) {
        if (stop.stop_requested()) throw Cancelled();
        const auto read = [&](int channel) { return source.read({channel, what.time, 0, grid.indexOf(i)}); };
        volume::BrickSamples brick = read(what.channel);
        if (what.only)
            brick = volume::onlyPart(std::move(brick), read(what.only->label), what.only->parts, what.only->part);
        padding.insert(grid.begin(grid.indexOf(i)), brick);
    });
    return padding.padded();
}

} // namespace tessera::vis::packet
