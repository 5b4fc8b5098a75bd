#include "vis/packed/packet_volume.h"

#include "vis/packed/laid_rows.h"
#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/bricks/parts_bricks.h"
#include "volume/bricks/source_at_time.h"
#include "volume/reconstruct/cubic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace tessera::vis::packet {

namespace {

constexpr int kWindows = kBrick / kFine;

/// Extremes within windows along one axis: of `from`, `outer` times `length` times `inner` values, windows of kFine + 1
/// texels of `slices` values that begin every kFine texels; `to` gets `outer` times kWindows times `inner`.
template <class T, class Op>
void inWindows(const T* from, int outer, int length, int slices, std::size_t inner, const Op& op, T* to) {
    for (int o = 0; o < outer; ++o)
        for (int window = 0; window < kWindows; ++window, to += inner) {
            const T* each = from + std::size_t(o * length + window * kFine * slices) * inner;
            std::copy_n(each, inner, to);
            for (int n = 1; n < (kFine + 1) * slices; ++n) {
                each += inner;
                for (std::size_t i = 0; i < inner; ++i) to[i] = op(to[i], each[i]);
            }
        }
}

/// The same in cubes, of a brick with `slices` of each texel.
template <class T> using Blocks = std::array<T, std::size_t(kWindows) * kWindows * kWindows>;
template <class T, class Op> Blocks<T> inBlocks(const T* from, int slices, const Op& op) {
    constexpr std::size_t kPlane = std::size_t(kRow) * kRow;
    std::array<T, kWindows * kPlane> slabs;
    std::array<T, std::size_t(kWindows) * kWindows * kRow> bars;
    Blocks<T> out;
    inWindows(from, 1, kRow * slices, slices, kPlane, op, slabs.data());
    inWindows(slabs.data(), kWindows, kRow, 1, kRow, op, bars.data());
    inWindows(bars.data(), kWindows * kWindows, kRow, 1, 1, op, out.data());
    return out;
}

constexpr auto kLesser = [](auto a, auto b) { return std::min(a, b); };
constexpr auto kGreater = [](auto a, auto b) { return std::max(a, b); };

/// Writes one brick, and the bounds of its blocks.
class BrickWriter {
public:
    /// `rows`: of texels from -kMargin on.
    BrickWriter(PacketVolume& out, glm::ivec3 brick, const LaidRows& rows)
        : out_(out), brick_(brick), slices_(out.bcc ? 2 : 1) {
        constexpr std::size_t kPlane = std::size_t(kRow) * kRow;
        const glm::ivec3 first = brick * kBrick * glm::ivec3(1, 1, slices_);
        values_.resize(kPlane * std::size_t(kRow * slices_));
        if (rows.masked()) present_.resize(values_.size());
        for (int z = 0; z < kRow * slices_; ++z)
            rows.read(first + glm::ivec3(0, 0, z), kRow, kRow, &values_[std::size_t(z) * kPlane],
                      present_.empty() ? nullptr : &present_[std::size_t(z) * kPlane]);
    }

    void samples() const {
        const std::size_t base = number(brick_, out_.bricks) * std::size_t(out_.stride()) * 2;
        if (out_.exact)
            pairs<float>(out_.floats.data() + base,
                         [&](float value) { return float((double(value) - out_.offset) / out_.scale); });
        else if (isPlain())
            pairs<std::int16_t>(out_.shorts.data() + base,
                                [offset = float(out_.offset), perUnit = float(1 / out_.scale)](float value) {
                                    const float scaled = (value - offset) * perUnit;
                                    return std::int16_t(std::min(std::max(0.0f, scaled), float(kQuantum)) + 0.5f);
                                });
        else
            pairs<std::int16_t>(out_.shorts.data() + base,
                                [offset = out_.offset, perUnit = 1 / out_.scale](float value) {
                                    const double scaled = (double(value) - offset) * perUnit;
                                    return std::int16_t(std::min(std::max(0.0, scaled), double(kQuantum)) + 0.5);
                                });
        if (present_.empty()) return;
        volume::UnfilledVector<std::int16_t> flags(present_.size());
        std::ranges::transform(present_, flags.begin(), [](bool there) { return std::int16_t(there ? kQuantum : 0); });
        interleave(flags.data(), out_.present.data() + base);
    }

    /// The odd sublattice lies half a cell further: its cells around a block begin one earlier, which may lie in the
    /// brick before. Its first samples stand for them here; `spreadOdd` joins the neighbours' bounds.
    void bounds() const {
        Blocks<float> lo, hi;
        Blocks<std::uint8_t> whole{};
        if (present_.empty()) {
            lo = inBlocks(values_.data(), slices_, kLesser);
            hi = inBlocks(values_.data(), slices_, kGreater);
        } else {
            lo = inBlocks(bounded(Extent{}.lo).data(), slices_, kLesser);
            hi = inBlocks(bounded(Extent{}.hi).data(), slices_, kGreater);
            whole = inBlocks(present_.data(), slices_, kLesser);
        }
        const auto scaled = [&](float value) { return float((double(value) - out_.offset) / out_.scale); };
        for (std::size_t i = 0; i < lo.size(); ++i) {
            const int n = int(i);
            const glm::ivec3 inside(n % kWindows, n / kWindows % kWindows, n / kWindows / kWindows);
            const std::size_t to = number(brick_ * kWindows + inside, out_.blocks);
            out_.lo[to] = lo[i] <= hi[i] ? scaled(lo[i]) : Extent{}.lo;
            out_.hi[to] = lo[i] <= hi[i] ? scaled(hi[i]) : Extent{}.hi;
            if (!present_.empty()) out_.absent[to] = whole[i] == 0;
        }
    }

private:
    static std::size_t number(glm::ivec3 at, glm::ivec3 count) {
        return (std::size_t(at.z) * std::size_t(count.y) + std::size_t(at.y)) * std::size_t(count.x) +
               std::size_t(at.x);
    }
    /// Whether floats are precise enough for shorts.
    bool isPlain() const { return out_.scale > 1e-30 && out_.scale < 1e30; }
    /// The values, with `instead` where they are absent.
    volume::UnfilledVector<float> bounded(float instead) const {
        volume::UnfilledVector<float> out = values_;
        for (std::size_t i = 0; i < present_.size(); ++i)
            if (present_[i] == 0) out[i] = instead;
        return out;
    }
    /// `store(value)`: what is stored of a present sample.
    template <class T, class Store> void pairs(T* to, const Store& store) const {
        volume::UnfilledVector<T> own(values_.size());
        std::ranges::transform(values_, own.begin(), store);
        for (std::size_t i = 0; i < present_.size(); ++i)
            if (present_[i] == 0) own[i] = 0;
        interleave(own.data(), to);
    }
    template <class T> void interleave(const T* own, T* to) const {
        for (int s = 0; s < slices_; ++s)
            for (int z = 0; z < kRow; ++z, to += 2 * kSlice) {
                const T* first = own + std::size_t(z * slices_ + s) * kRow * kRow;
                for (int i = 0; i < kSlice; ++i) {
                    to[2 * i] = first[i];
                    to[2 * i + 1] = first[i + kRow];
                }
            }
    }

    PacketVolume& out_;
    glm::ivec3 brick_;
    int slices_;
    volume::UnfilledVector<float> values_;
    volume::UnfilledVector<std::uint8_t> present_; ///< empty: all
};

/// Every block's value joined with those up to `before` and `after` blocks away along each axis.
template <class T, class Op>
void spread(std::vector<T>& values, glm::ivec3 count, int before, int after, const Op& op) {
    int step = 1;
    for (int axis = 0; axis < 3; step *= count[axis++]) {
        const std::vector<T> own = values;
        for (std::size_t i = 0; i < own.size(); ++i) {
            const int at = int(i / std::size_t(step)) % count[axis];
            for (int n = std::max(-before, -at); n <= std::min(after, count[axis] - 1 - at); ++n)
                values[i] = op(values[i], own[std::size_t(std::ptrdiff_t(i) + n * step)]);
        }
    }
}

/// Bounds of BCC blocks take those before them in (the odd sublattice reads half a cell earlier).
void spreadOdd(PacketVolume& volume) {
    spread(volume.lo, volume.blocks, 1, 0, kLesser);
    spread(volume.hi, volume.blocks, 1, 0, kGreater);
}

/// A cubic kernel reads a sample more on every side.
void spreadCubic(PacketVolume& volume) {
    spread(volume.lo, volume.blocks, 1, 1, kLesser);
    spread(volume.hi, volume.blocks, 1, 1, kGreater);
}

/// A block with an absent sample in a neighbour counts as having one: gradients read there, and so do the few samples
/// that are taken before blocks are looked up again.
void spreadAbsent(PacketVolume& volume) {
    spread(volume.absent, volume.blocks, 2, 2, kGreater);
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

bool fitsPackets(const volume::Lattice& lattice) {
    constexpr int kLongest = 32767 - 2 * kMargin;
    constexpr double kMostPairs = 2147483647;
    const glm::ivec3 texels = lattice.texels();
    if (std::max({texels.x, texels.y, texels.z}) > kLongest) return false;
    const glm::dvec3 bricks((texels + (2 * kMargin - 1 + kBrick - 1)) / kBrick);
    const double sublattices = lattice.kind == volume::LatticeKind::BCC ? 2 : 1;
    return bricks.x * bricks.y * bricks.z * sublattices * kSlice * kRow < kMostPairs;
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
    VolumeMaker(const volume::BrickSource& source, const PacketChannel& what, std::stop_token stop)
        : source_(source), what_(what), stop_(std::move(stop)), geometry_(volume::levelGeometry(source.grid(), 0)) {
        const volume::DatasetInfo& info = source.info();
        shape_.labels = info.parameters[std::size_t(info.channel(what.channel).parameter)].categorical;
        prefilter_ = shape_.labels ? volume::Prefilter::None : prefilterOf(what.filter);
        shape_.cubic = prefilter_ == volume::Prefilter::Cubic;
        const volume::Lattice& lattice = source.grid().lattice;
        shape_.bcc = lattice.kind == volume::LatticeKind::BCC;
        shape_.exact = what.exact;
        shape_.cells = lattice.texels() + (2 * kMargin - 1);
        shape_.bricks = (shape_.cells + kBrick - 1) / kBrick;
        shape_.blocks = shape_.bricks * (kBrick / kFine);
    }

    /// Without samples.
    const PacketVolume& shape() const { return shape_; }
    /// Samples before they are written, texels from -kMargin on, and the range that their scale comes from.
    struct Read {
        PaddedSamples samples;
        Extent range;
    };
    /// Filtered samples leave the range of the data, by up to 2/3 of its width but seldom by much, and 15 bits are few:
    /// so shorts have the range of the filtered ones.
    Read read(const std::optional<OnePart>& only) const {
        const int halo = volume::prefilterReach(prefilter_, geometry_);
        Read out{readPadded(source_,
                            {.channel = what_.channel,
                             .time = what_.time.earlier,
                             .only = only,
                             .first = glm::ivec3(-kMargin - halo),
                             .count = shape_.bricks * kBrick + (kRow - kBrick + 2 * halo)},
                            stop_),
                 {}};
        const bool before = shape_.exact || prefilter_ == volume::Prefilter::None;
        if (before) out.range = extentOf(out.samples);
        if (prefilter_ == volume::Prefilter::Cubic) out.samples = coefficients(std::move(out.samples));
        if (!before) out.range = extentOf(out.samples);
        return out;
    }
    void setRange(const Extent& range) {
        const Extent some = range.lo <= range.hi ? range : Extent{0, 0};
        setScale(shape_, some);
        if (!shape_.labels || (!shape_.exact && some.hi - some.lo > float(kQuantum))) return;
        shape_.offset = std::floor(double(some.lo));
        shape_.scale = 1;
    }
    PacketVolume write(const PaddedSamples& all) const {
        PacketVolume out = shape_;
        const LaidRows rows(all, kind(), prefilter_ == volume::Prefilter::Linear);
        const std::size_t bricks =
            std::size_t(shape_.bricks.x) * std::size_t(shape_.bricks.y) * std::size_t(shape_.bricks.z);
        const std::size_t samples = (bricks * std::size_t(out.stride()) + 1) * 2, blocks = bricks * 64;
        const auto make = [samples](auto& numbers) {
            numbers.resize(samples);
            std::fill(numbers.end() - 2, numbers.end(), 0); // behind the last brick
        };
        if (out.exact)
            make(out.floats);
        else
            make(out.shorts);
        if (rows.masked()) {
            make(out.present);
            out.absent.resize(blocks);
        }
        out.lo.resize(blocks);
        out.hi.resize(blocks);
        parallelFor(bricks, [&](std::size_t i) {
            if (stop_.stop_requested()) throw Cancelled();
            const BrickWriter writer(out, placeOf(i), rows);
            writer.samples();
            writer.bounds();
        });
        if (out.cubic)
            spreadCubic(out);
        else if (out.bcc)
            spreadOdd(out);
        if (!out.absent.empty()) spreadAbsent(out);
        return out;
    }

private:
    /// As they are laid out: what the linear prefilter reads beyond the last cell does not count.
    Extent extentOf(const PaddedSamples& samples) const {
        if (prefilter_ == volume::Prefilter::Linear && !shape_.exact)
            return LaidRows(samples, kind(), true).extent((shape_.cells + 1) * glm::ivec3(1, 1, slices()));
        return LaidRows(samples, kind(), false).extent(samples.size);
    }
    PaddedSamples coefficients(PaddedSamples samples) const {
        const volume::BrickSamples made =
            volume::cubicCoefficients({.size = samples.size,
                                       .values = {samples.values.begin(), samples.values.end()},
                                       .present = std::move(samples.present)},
                                      geometry_);
        return {made.size, {made.values.begin(), made.values.end()}, made.present};
    }
    volume::LatticeKind kind() const { return source_.grid().lattice.kind; }
    int slices() const { return shape_.bcc ? 2 : 1; } ///< of a texel
    glm::ivec3 placeOf(std::size_t i) const {
        return {int(i % std::size_t(shape_.bricks.x)),
                int(i / std::size_t(shape_.bricks.x) % std::size_t(shape_.bricks.y)),
                int(i / std::size_t(shape_.bricks.x) / std::size_t(shape_.bricks.y))};
    }

    const volume::BrickSource& source_;
    const PacketChannel& what_;
    std::stop_token stop_;
    volume::LevelGeometry geometry_;
    volume::Prefilter prefilter_ = volume::Prefilter::None;
    PacketVolume shape_;
};

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

PacketVolume readPacketVolume(const volume::BrickSource& source, const PacketChannel& what, std::stop_token stop) {
    if (what.time.between()) {
        const std::shared_ptr<const volume::BrickSource> borrowed(std::shared_ptr<const volume::BrickSource>(),
                                                                  &source);
        const volume::SourceAtTime now = volume::sourceAt(borrowed, what.time);
        return readPacketVolume(*now.source, what.at(now.time), std::move(stop));
    }
    const volume::DatasetInfo& info = source.info();
    const volume::Parameter& parameter = info.parameters[std::size_t(info.channel(what.channel).parameter)];
    VolumeMaker maker(source, what, std::move(stop));
    const std::optional<int> label = volume::labelChannel(info, parameter);
    if (!label) {
        const VolumeMaker::Read all = maker.read(std::nullopt);
        maker.setRange(all.range);
        return maker.write(all.samples);
    }
    std::vector<VolumeMaker::Read> parts;
    Extent range;
    for (std::size_t part = 0; part < parameter.parts.count(); ++part) {
        parts.push_back(maker.read(OnePart{*label, parameter.parts, part}));
        range.add(parts.back().range);
    }
    maker.setRange(range);
    PacketVolume out = maker.shape();
    for (const VolumeMaker::Read& part : parts) out.parts.push_back(maker.write(part.samples));
    joinParts(out);
    return out;
}

} // namespace tessera::vis::packet
