#include "vis/packed/packet_volume.h"

#include "volume/base/parallel.h"
#include "volume/bricks/parts_bricks.h"
#include "volume/reconstruct/reconstruct.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace tessera::vis::packet {

namespace {

struct Extent {
    float lo = std::numeric_limits<float>::infinity(), hi = -lo;
    void add(const Extent& other) { *this = {std::min(lo, other.lo), std::max(hi, other.hi)}; }
};

/// Of the present samples.
Extent extentOf(const volume::BrickSamples& brick) {
    constexpr std::size_t kTogether = 16; // so that the compiler uses vectors
    Extent out;
    float lo[kTogether], hi[kTogether];
    std::ranges::fill(lo, Extent{}.lo);
    std::ranges::fill(hi, Extent{}.hi);
    const std::size_t whole = brick.present.empty() ? brick.values.size() / kTogether * kTogether : 0;
    for (std::size_t s = 0; s < whole; s += kTogether)
        for (std::size_t i = 0; i < kTogether; ++i) {
            lo[i] = std::min(lo[i], brick.values[s + i]);
            hi[i] = std::max(hi[i], brick.values[s + i]);
        }
    for (std::size_t s = whole; s < brick.values.size(); ++s)
        if (brick.isPresent(s)) out.add({brick.values[s], brick.values[s]});
    for (std::size_t i = 0; i < kTogether; ++i) out.add({lo[i], hi[i]});
    return out;
}

/// All samples of a channel as the source has them.
struct Gathered {
    volume::Lattice lattice;
    std::vector<float> values;
    std::vector<std::uint8_t> present; ///< empty: all
    Extent range;

    std::size_t at(glm::ivec3 sample) const {
        return lattice.index(volume::clampToLattice(lattice.kind, lattice.size, sample));
    }
};

void insertBrick(Gathered& out, glm::ivec3 begin, const volume::BrickSamples& brick) {
    for (int z = 0; z < brick.size.z; ++z)
        for (int y = 0; y < brick.size.y; ++y) {
            const std::size_t to = out.lattice.index(begin + glm::ivec3(0, y, z));
            const std::size_t from =
                (std::size_t(z) * std::size_t(brick.size.y) + std::size_t(y)) * std::size_t(brick.size.x);
            if (brick.present.empty()) {
                std::copy_n(brick.values.begin() + std::ptrdiff_t(from), brick.size.x,
                            out.values.begin() + std::ptrdiff_t(to));
                continue;
            }
            for (std::size_t x = 0; x < std::size_t(brick.size.x); ++x) {
                const bool there = brick.isPresent(from + x);
                out.values[to + x] = there ? brick.values[from + x] : 0;
                if (!out.present.empty()) out.present[to + x] = there;
            }
        }
}

/// One part of a parameter.
struct OnePart {
    int label; ///< channel
    const volume::Parts& parts;
    std::size_t part;
};

/// All samples, or those of one part.
Gathered gatherAll(const volume::BrickSource& source, const PacketChannel& what, const std::optional<OnePart>& only) {
    const volume::BrickGrid& grid = source.grid();
    Gathered out;
    out.lattice = grid.lattice;
    out.values.resize(grid.lattice.count());
    std::vector<Extent> own(grid.brickCount());
    std::vector<std::uint8_t> absent(own.size());
    const auto read = [&](int channel, std::size_t i) {
        return source.read({channel, what.time.earlier, 0, grid.indexOf(i)});
    };
    out.present.resize(out.values.size(), 1);
    parallelFor(own.size(), [&](std::size_t i) {
        volume::BrickSamples brick = read(what.channel, i);
        if (only) brick = volume::onlyPart(std::move(brick), read(only->label, i), only->parts, only->part);
        insertBrick(out, grid.begin(grid.indexOf(i)), brick);
        own[i] = extentOf(brick);
        absent[i] = std::ranges::find(brick.present, std::uint8_t(0)) != brick.present.end();
    });
    for (const Extent& each : own) out.range.add(each);
    if (std::ranges::none_of(absent, [](std::uint8_t some) { return some != 0; })) out.present = {};
    if (!(out.range.lo <= out.range.hi)) out.range = {0, 0};
    return out;
}

/// The samples of a brick with `halo` more of each sublattice on every side.
volume::BrickSamples neighbourhood(const Gathered& all, glm::ivec3 firstTexel, int halo) {
    const int slices = all.lattice.kind == volume::LatticeKind::BCC ? 2 : 1;
    volume::BrickSamples out;
    const int edge = kRow + 2 * halo;
    out.size = {edge, edge, edge * slices};
    const std::size_t count = std::size_t(edge) * std::size_t(edge) * std::size_t(edge * slices);
    out.values.resize(count);
    if (!all.present.empty()) out.present.resize(count);
    const glm::ivec3 first = (firstTexel - halo) * glm::ivec3(1, 1, slices);
    const int last = all.lattice.size.x - 1;
    std::vector<int> column(std::size_t(edge), 0);
    for (int x = 0; x < edge; ++x) column[std::size_t(x)] = std::clamp(first.x + x, 0, last);
    std::size_t to = 0;
    for (int z = 0; z < out.size.z; ++z)
        for (int y = 0; y < edge; ++y) {
            const std::size_t row = all.at({0, first.y + y, first.z + z});
            for (const int x : column) {
                out.values[to] = all.values[row + std::size_t(x)];
                if (!all.present.empty()) out.present[to] = all.present[row + std::size_t(x)];
                ++to;
            }
        }
    return out;
}

/// Writes one brick, and the bounds of its blocks.
class BrickWriter {
public:
    BrickWriter(PacketVolume& out, glm::ivec3 brick, const volume::BrickSamples& from)
        : out_(out), brick_(brick), from_(from), slices_(out.bcc ? 2 : 1) {}

    void samples() {
        const std::size_t base =
            ((std::size_t(brick_.z) * std::size_t(out_.bricks.y) + std::size_t(brick_.y)) * std::size_t(out_.bricks.x) +
             std::size_t(brick_.x)) *
            std::size_t(out_.stride()) * 2;
        if (out_.exact)
            pairs(out_.floats.data() + base, [&](std::size_t i) {
                return from_.isPresent(i) ? float((double(from_.values[i]) - out_.offset) / out_.scale) : 0.0f;
            });
        else
            pairs(out_.shorts.data() + base, [&, perUnit = 1 / out_.scale](std::size_t i) {
                const double value = from_.isPresent(i) ? (double(from_.values[i]) - out_.offset) * perUnit : 0;
                return std::int16_t(std::clamp(value, 0.0, double(kQuantum)) + 0.5);
            });
        if (!out_.present.empty())
            pairs(out_.present.data() + base,
                  [&](std::size_t i) { return std::int16_t(from_.isPresent(i) ? kQuantum : 0); });
    }

    void bounds() {
        const int perBrick = kBrick / kFine;
        for (int i = 0; i < perBrick * perBrick * perBrick; ++i) {
            const glm::ivec3 inside(i % perBrick, i / perBrick % perBrick, i / perBrick / perBrick);
            const glm::ivec3 block = brick_ * perBrick + inside;
            const std::size_t to = (std::size_t(block.z) * std::size_t(out_.blocks.y) + std::size_t(block.y)) *
                                       std::size_t(out_.blocks.x) +
                                   std::size_t(block.x);
            block_(inside * kFine, to);
        }
    }

private:
    /// `value(i)`: what is stored of sample i.
    template <class T, class Value> void pairs(T* to, const Value& value) const {
        std::vector<T> own(from_.values.size());
        for (std::size_t i = 0; i < own.size(); ++i) own[i] = value(i);
        for (int s = 0; s < slices_; ++s)
            for (int z = 0; z < kRow; ++z) {
                const T* first = own.data() + std::size_t(z * slices_ + s) * kRow * kRow;
                for (int i = 0; i < kSlice; ++i) {
                    *to++ = first[i];
                    *to++ = first[i + kRow];
                }
            }
    }

    /// The odd sublattice lies half a cell further: its cells around the block begin one earlier, which may lie in the
    /// brick before. Its first samples stand for them here; `spreadOdd` joins the neighbours' bounds.
    void block_(glm::ivec3 begin, std::size_t to) {
        float lo = std::numeric_limits<float>::infinity(), hi = -lo;
        bool absent = false;
        for (int z = begin.z * slices_; z < (begin.z + kFine + 1) * slices_; ++z)
            for (int y = begin.y; y <= begin.y + kFine; ++y)
                for (int x = begin.x; x <= begin.x + kFine; ++x) {
                    const std::size_t i = (std::size_t(z) * kRow + std::size_t(y)) * kRow + std::size_t(x);
                    if (!from_.isPresent(i)) {
                        absent = true;
                        continue;
                    }
                    lo = std::min(lo, from_.values[i]);
                    hi = std::max(hi, from_.values[i]);
                }
        out_.lo[to] = lo <= hi ? float((double(lo) - out_.offset) / out_.scale) : lo;
        out_.hi[to] = lo <= hi ? float((double(hi) - out_.offset) / out_.scale) : hi;
        if (!out_.absent.empty()) out_.absent[to] = absent;
    }

    PacketVolume& out_;
    glm::ivec3 brick_;
    const volume::BrickSamples& from_;
    int slices_;
};

/// Calls `visit(block, neighbour)` for each of the 27 blocks around each block, within the volume.
template <class Visit> void eachNeighbour(glm::ivec3 count, int before, int after, const Visit& visit) {
    const auto index = [&](glm::ivec3 at) {
        return (std::size_t(at.z) * std::size_t(count.y) + std::size_t(at.y)) * std::size_t(count.x) +
               std::size_t(at.x);
    };
    for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x)
                for (int dz = std::max(z - before, 0); dz <= std::min(z + after, count.z - 1); ++dz)
                    for (int dy = std::max(y - before, 0); dy <= std::min(y + after, count.y - 1); ++dy)
                        for (int dx = std::max(x - before, 0); dx <= std::min(x + after, count.x - 1); ++dx)
                            visit(index({x, y, z}), index({dx, dy, dz}));
}

/// Bounds of BCC blocks take those before them in (the odd sublattice reads half a cell earlier).
void spreadOdd(PacketVolume& volume) {
    const std::vector<float> lo = volume.lo, hi = volume.hi;
    eachNeighbour(volume.blocks, 1, 0, [&](std::size_t block, std::size_t other) {
        volume.lo[block] = std::min(volume.lo[block], lo[other]);
        volume.hi[block] = std::max(volume.hi[block], hi[other]);
    });
}

/// A block with an absent sample in a neighbour counts as having one: gradients read there, and so do the few samples
/// that are taken before blocks are looked up again.
void spreadAbsent(PacketVolume& volume) {
    const std::vector<std::uint8_t> own = volume.absent;
    eachNeighbour(volume.blocks, 2, 2, [&](std::size_t block, std::size_t other) {
        volume.absent[block] = std::uint8_t(volume.absent[block] | own[other]);
    });
}

/// Of the present samples of all bricks. Filtered ones leave the range of the data, by up to 2/3 of its width but
/// seldom by much, and 15 bits are few: so they are filtered twice.
template <class Samples> Extent rangeOf(std::size_t bricks, const Samples& samplesOf) {
    std::vector<Extent> own(bricks);
    parallelFor(bricks, [&](std::size_t i) { own[i] = extentOf(samplesOf(i)); });
    Extent out;
    for (const Extent& each : own) out.add(each);
    return out.lo <= out.hi ? out : Extent{0, 0};
}

void setScale(PacketVolume& out, const Extent& range) {
    const double width = double(range.hi) - double(range.lo);
    out.offset = out.exact ? (double(range.lo) + double(range.hi)) / 2 : double(range.lo);
    out.scale = width > 0 ? (out.exact ? width : width / kQuantum) : 1;
}

} // namespace

std::size_t PacketVolume::at(glm::ivec3 sample, int sublattice) const {
    const glm::ivec3 brick = glm::min(sample / kBrick, bricks - 1), in = sample - brick * kBrick;
    const std::size_t number =
        (std::size_t(brick.z) * std::size_t(bricks.y) + std::size_t(brick.y)) * std::size_t(bricks.x) +
        std::size_t(brick.x);
    return (number * std::size_t(stride()) +
            std::size_t(sublattice * brickPairs() + in.z * kSlice + in.y * kRow + in.x)) *
           2;
}

std::size_t PacketVolume::bytes() const {
    std::size_t out =
        shorts.size() * 2 + floats.size() * 4 + present.size() * 2 + (lo.size() + hi.size()) * 4 + absent.size();
    for (const PacketVolume& part : parts) out += part.bytes();
    return out;
}

namespace {

/// Lays the samples of a channel out.
class VolumeMaker {
public:
    VolumeMaker(const volume::BrickSource& source, const PacketChannel& what)
        : geometry_(volume::levelGeometry(source.grid(), 0)) {
        const volume::DatasetInfo& info = source.info();
        shape_.labels = info.parameters[std::size_t(info.channel(what.channel).parameter)].categorical;
        filtered_ = what.filter == Filter::AverageQuasi && !shape_.labels;
        const volume::Lattice& lattice = source.grid().lattice;
        shape_.bcc = lattice.kind == volume::LatticeKind::BCC;
        shape_.exact = what.exact;
        shape_.cells = lattice.texels() + (2 * kMargin - 1);
        shape_.bricks = (shape_.cells + kBrick - 1) / kBrick;
        shape_.blocks = shape_.bricks * (kBrick / kFine);
        bricks_ = std::size_t(shape_.bricks.x) * std::size_t(shape_.bricks.y) * std::size_t(shape_.bricks.z);
    }

    /// Without samples.
    const PacketVolume& shape() const { return shape_; }
    /// Of what is stored.
    Extent range(const Gathered& all) const {
        if (!filtered_ || shape_.exact) return all.range;
        return rangeOf(bricks_, [&](std::size_t i) { return samplesOf(all, i); });
    }
    void setRange(const Extent& range) {
        setScale(shape_, range);
        if (!shape_.labels || (!shape_.exact && range.hi - range.lo > float(kQuantum))) return;
        shape_.offset = std::floor(double(range.lo));
        shape_.scale = 1;
    }
    PacketVolume write(const Gathered& all) const {
        PacketVolume out = shape_;
        const std::size_t samples = (bricks_ * std::size_t(out.stride()) + 1) * 2, blocks = bricks_ * 64;
        if (out.exact)
            out.floats.resize(samples);
        else
            out.shorts.resize(samples);
        if (!all.present.empty()) {
            out.present.resize(samples);
            out.absent.resize(blocks);
        }
        out.lo.resize(blocks);
        out.hi.resize(blocks);
        parallelFor(bricks_, [&](std::size_t i) {
            const volume::BrickSamples near = samplesOf(all, i);
            BrickWriter writer(out, placeOf(i), near);
            writer.samples();
            writer.bounds();
        });
        if (out.bcc) spreadOdd(out);
        if (!out.absent.empty()) spreadAbsent(out);
        return out;
    }

private:
    glm::ivec3 placeOf(std::size_t i) const {
        return {int(i % std::size_t(shape_.bricks.x)),
                int(i / std::size_t(shape_.bricks.x) % std::size_t(shape_.bricks.y)),
                int(i / std::size_t(shape_.bricks.x) / std::size_t(shape_.bricks.y))};
    }
    volume::BrickSamples samplesOf(const Gathered& all, std::size_t i) const {
        const volume::BrickSamples near = neighbourhood(all, placeOf(i) * kBrick - kMargin, filtered_ ? 1 : 0);
        return filtered_ ? volume::prefilter(near, geometry_) : near;
    }

    volume::LevelGeometry geometry_;
    bool filtered_ = false;
    PacketVolume shape_;
    std::size_t bricks_ = 0;
};

bool somePresent(const Gathered& all) {
    return all.present.empty() || std::ranges::find(all.present, std::uint8_t(1)) != all.present.end();
}

} // namespace

void joinParts(PacketVolume& volume) {
    for (const PacketVolume& part : volume.parts) {
        volume.lo.resize(part.lo.size(), std::numeric_limits<float>::infinity());
        volume.hi.resize(part.hi.size(), -std::numeric_limits<float>::infinity());
        for (std::size_t i = 0; i < part.lo.size(); ++i) {
            volume.lo[i] = std::min(volume.lo[i], part.lo[i]);
            volume.hi[i] = std::max(volume.hi[i], part.hi[i]);
        }
    }
}

PacketVolume readPacketVolume(const volume::BrickSource& source, const PacketChannel& what) {
    const volume::DatasetInfo& info = source.info();
    const volume::Parameter& parameter = info.parameters[std::size_t(info.channel(what.channel).parameter)];
    VolumeMaker maker(source, what);
    const std::optional<int> label = volume::labelChannel(info, parameter);
    if (!label) {
        const Gathered all = gatherAll(source, what, std::nullopt);
        maker.setRange(maker.range(all));
        return maker.write(all);
    }
    std::vector<Gathered> parts;
    Extent range;
    for (std::size_t part = 0; part < parameter.parts.count(); ++part) {
        parts.push_back(gatherAll(source, what, OnePart{*label, parameter.parts, part}));
        if (somePresent(parts.back())) range.add(maker.range(parts.back()));
    }
    maker.setRange(range.lo <= range.hi ? range : Extent{0, 0});
    PacketVolume out = maker.shape();
    for (const Gathered& part : parts) out.parts.push_back(maker.write(part));
    joinParts(out);
    return out;
}

} // namespace tessera::vis::packet
