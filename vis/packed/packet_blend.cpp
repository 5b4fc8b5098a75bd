#include "vis/packed/packet_blend.h"

#include "volume/base/parallel.h"

#include <algorithm>
#include <limits>

namespace tessera::vis::packet {

namespace {

constexpr std::size_t kInOneGo = std::size_t(1) << 16; ///< samples that one core blends in one go

/// Smallest and largest value that samples of a volume can have.
struct Held {
    double lo, hi;
};
Held heldBy(const PacketVolume& volume) {
    const double width = volume.scale * (volume.exact ? 1 : kQuantum);
    return volume.exact ? Held{volume.offset - width / 2, volume.offset + width / 2}
                        : Held{volume.offset, volume.offset + width};
}

/// A sample of the blend is `earlier` times that of the earlier volume and `later` times that of the later one, plus
/// the offsets, each as far as the sample is present there.
struct Shares {
    double earlier, later, earlierOffset, laterOffset;
};

class Blender {
public:
    /// `alone`: not one of several parts, which have the same scale.
    Blender(const PacketVolume& earlier, const PacketVolume& later, double weight, bool alone)
        : a_(earlier), b_(later), weight_(weight), whole_(earlier.present.empty() && later.present.empty()) {
        out_.bcc = a_.bcc;
        out_.exact = a_.exact;
        out_.cubic = a_.cubic;
        out_.cells = a_.cells;
        out_.bricks = a_.bricks;
        out_.blocks = a_.blocks;
        const Held one = heldBy(a_), other = heldBy(b_);
        Held both{std::min(one.lo, other.lo), std::max(one.hi, other.hi)};
        if (whole_ && alone)
            both = {(1 - weight) * one.lo + weight * other.lo, (1 - weight) * one.hi + weight * other.hi};
        const double width = both.hi - both.lo;
        out_.offset = out_.exact ? (both.lo + both.hi) / 2 : both.lo;
        out_.scale = width > 0 ? (out_.exact ? width : width / kQuantum) : 1;
        shares_ = {(1 - weight) * a_.scale / out_.scale, weight * b_.scale / out_.scale,
                   (1 - weight) * (a_.offset - out_.offset) / out_.scale,
                   weight * (b_.offset - out_.offset) / out_.scale};
    }

    const PacketVolume& shape() const { return out_; } ///< without samples
    PacketVolume make() {
        if (out_.exact)
            blend(a_.floats, b_.floats, out_.floats);
        else
            blend(a_.shorts, b_.shorts, out_.shorts);
        blendBounds();
        return std::move(out_);
    }

private:
    template <class Samples> void blend(const Samples& from, const Samples& to, Samples& out) {
        out.resize(from.size());
        if (!whole_) out_.present.resize(from.size());
        parallelFor((from.size() + kInOneGo - 1) / kInOneGo, [&](std::size_t part) {
            const std::size_t begin = part * kInOneGo, end = std::min(begin + kInOneGo, from.size());
            if (whole_)
                blendWhole(from.data(), to.data(), out.data(), begin, end);
            else
                blendMasked(from.data(), to.data(), out.data(), begin, end);
        });
    }
    static void store(float value, float& to) { to = value; }
    static void store(float value, std::int16_t& to) {
        to = std::int16_t(std::min(std::max(value, 0.0f), float(kQuantum)) + 0.5f);
    }

    template <class T> void blendWhole(const T* a, const T* b, T* out, std::size_t begin, std::size_t end) const {
        const auto x = float(shares_.earlier), y = float(shares_.later),
                   more = float(shares_.earlierOffset + shares_.laterOffset);
        for (std::size_t i = begin; i < end; ++i) store(float(a[i]) * x + float(b[i]) * y + more, out[i]);
    }
    template <class T> void blendMasked(const T* a, const T* b, T* out, std::size_t begin, std::size_t end) {
        const auto x = float(shares_.earlier), y = float(shares_.later), moreX = float(shares_.earlierOffset),
                   moreY = float(shares_.laterOffset), wx = float(1 - weight_), wy = float(weight_);
        const auto here = [](const PacketVolume& of, std::size_t i) {
            return of.present.empty() ? 1.0f : float(of.present[i]) * (1.0f / kQuantum);
        };
        for (std::size_t i = begin; i < end; ++i) {
            const float p = here(a_, i), q = here(b_, i);
            store(float(a[i]) * x + p * moreX + float(b[i]) * y + q * moreY, out[i]);
            store((p * wx + q * wy) * float(kQuantum), out_.present[i]);
        }
    }

    void blendBounds() {
        const auto physical = [](const PacketVolume& of, float sample) {
            return of.offset + of.scale * double(sample);
        };
        const auto sample = [&](double value) { return float((value - out_.offset) / out_.scale); };
        out_.lo.resize(a_.lo.size());
        out_.hi.resize(a_.lo.size());
        for (std::size_t i = 0; i < a_.lo.size(); ++i) {
            Held bounds{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
            for (const PacketVolume* of : {&a_, &b_}) {
                if (!(of->lo[i] <= of->hi[i])) continue;
                bounds.lo = std::min(bounds.lo, physical(*of, of->lo[i]));
                bounds.hi = std::max(bounds.hi, physical(*of, of->hi[i]));
            }
            if (whole_)
                bounds = {(1 - weight_) * physical(a_, a_.lo[i]) + weight_ * physical(b_, b_.lo[i]),
                          (1 - weight_) * physical(a_, a_.hi[i]) + weight_ * physical(b_, b_.hi[i])};
            out_.lo[i] = bounds.lo <= bounds.hi ? sample(bounds.lo) : float(bounds.lo);
            out_.hi[i] = bounds.lo <= bounds.hi ? sample(bounds.hi) : float(bounds.hi);
        }
        if (whole_) return;
        out_.absent.resize(out_.lo.size());
        for (const PacketVolume* of : {&a_, &b_})
            for (std::size_t i = 0; i < of->absent.size(); ++i)
                out_.absent[i] = std::uint8_t(out_.absent[i] | of->absent[i]);
    }

    const PacketVolume &a_, &b_;
    double weight_;
    bool whole_; ///< no sample is absent
    PacketVolume out_;
    Shares shares_{};
};

} // namespace

PacketVolume blendedVolume(const PacketVolume& earlier, const PacketVolume& later, double weight) {
    if (earlier.parts.empty()) return Blender(earlier, later, weight, true).make();
    PacketVolume out = Blender(earlier, later, weight, false).shape();
    for (std::size_t i = 0; i < earlier.parts.size(); ++i)
        out.parts.push_back(Blender(earlier.parts[i], later.parts[i], weight, false).make());
    joinParts(out);
    return out;
}

} // namespace tessera::vis::packet
