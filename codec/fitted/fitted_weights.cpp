#include "codec/fitted/fitted_weights.h"

#include "codec/bytes/bits.h"
#include "codec/bytes/entropy.h"

namespace tessera::codec {

namespace {

constexpr int kWidthBits = 5; // of the number of bits of a class's weights

/// The weights of all taps of a class, then what is added.
std::vector<std::int32_t> classOf(const PassWeights& pass, std::size_t c) {
    std::vector<std::int32_t> all;
    std::size_t at = c;
    for (; at + kActivityClasses < pass.size(); at += kActivityClasses) {
        all.push_back(evenOf(pass[at]));
        all.push_back(oddOf(pass[at]));
    }
    all.push_back(pass[at]);
    return all;
}

} // namespace

PassWeights plainWeights(Pass pass) {
    constexpr std::int32_t kHalf = 1 << (kWeightBits - 1);
    PassWeights weights((std::size_t(tapsOf(pass).count) / 2 + 1) * kActivityClasses);
    std::fill_n(weights.begin(), kActivityClasses, pairOf(kHalf, kHalf));
    return weights;
}

void setClass(std::span<const std::int32_t> all, std::size_t c, PassWeights& pass) {
    for (std::size_t i = 0; i + 1 < all.size(); i += 2) pass[i / 2 * kActivityClasses + c] = pairOf(all[i], all[i + 1]);
    pass[pass.size() - kActivityClasses + c] = all.back();
}

void write(const FittedWeights& weights, BitWriter& out) {
    for (std::size_t i = 0; i < weights.passes.size(); ++i) {
        const PassWeights& pass = weights.passes[i];
        out.put(pass.empty() ? 0 : 1, 1);
        if (pass.empty()) continue;
        std::vector<std::int32_t> last = classOf(plainWeights(static_cast<Pass>(i % kPasses)), 0);
        for (std::size_t c = 0; c < kActivityClasses; ++c) {
            const std::vector<std::int32_t> own = classOf(pass, c);
            std::vector<std::uint32_t> changes;
            std::uint32_t all = 0;
            for (std::size_t t = 0; t < own.size(); ++t) {
                changes.push_back(zigzag(static_cast<std::uint32_t>(own[t] - last[t])));
                all |= changes.back();
            }
            const int width = std::bit_width(all);
            out.put(static_cast<std::uint32_t>(width), kWidthBits);
            for (const std::uint32_t change : changes) out.put(change, width);
            last = own;
        }
    }
}

bool read(BitReader& in, FittedWeights& weights) {
    constexpr std::int32_t kMost = 32767;
    constexpr int kMostWidth = 17;
    for (std::size_t i = 0; i < weights.passes.size(); ++i) {
        PassWeights& pass = weights.passes[i];
        pass.clear();
        if (in.get(1) == 0) continue;
        pass = plainWeights(static_cast<Pass>(i % kPasses));
        std::vector<std::int32_t> last = classOf(pass, 0);
        for (std::size_t c = 0; c < kActivityClasses; ++c) {
            const auto width = static_cast<int>(in.get(kWidthBits));
            if (width > kMostWidth) return false;
            for (std::int32_t& one : last) {
                const auto change = static_cast<std::int32_t>(unzigzag(in.get(width)));
                if (in.failed) return false;
                one += change;
                if (one > kMost || one < -kMost) return false;
            }
            setClass(last, c, pass);
        }
    }
    return !in.failed;
}

} // namespace tessera::codec
