#include "vis/transfer/tail_opacity.h"

#include "vis/transfer/transfer_function.h"

#include <algorithm>
#include <numeric>

namespace tessera::vis {

namespace {

constexpr float kTailOpacity = 0.8f;
constexpr double kFlat = 0.35;     ///< of the length of all values: half of them over more than this are no bulk
constexpr double kLeftOut = 0.002; ///< fraction of outliers at either end that is ignored for the length of a tail

double sumOf(std::span<const std::uint64_t> count) {
    return double(std::accumulate(count.begin(), count.end(), std::uint64_t(0)));
}

struct Bins {
    std::size_t begin = 0, end = 0;
};

/// The shortest run of bins that holds half of all values; the first among equals.
Bins bulkOf(std::span<const std::uint64_t> count, double half) {
    Bins best{0, count.size()};
    double inside = 0;
    for (std::size_t begin = 0, end = 0; end < count.size();) {
        inside += double(count[end++]);
        for (; inside >= half && begin < end; inside -= double(count[begin++]))
            if (end - begin < best.end - best.begin) best = {begin, end};
    }
    return best;
}

/// Number of first (or, with reverse iterators, last) bins that hold at most `most` values in total.
std::size_t binsHolding(auto first, auto last, double most) {
    std::size_t bins = 0;
    double held = 0;
    for (; first != last && (held += double(*first)) <= most; ++first) ++bins;
    return bins;
}

} // namespace

double seenShare(std::span<const std::uint64_t> count, std::uint64_t places, std::span<const glm::vec2> opacity) {
    double seen = 0;
    for (std::size_t bin = 0; bin < count.size(); ++bin)
        if (curveAt(opacity, (double(bin) + 0.5) / double(count.size())) >= kSeenOpacity) seen += double(count[bin]);
    return places > 0 ? seen / double(places) : 0;
}

std::vector<glm::vec2> tailOpacity(std::span<const std::uint64_t> count, double share) {
    std::vector<glm::vec2> line{{0.0f, 0.0f}, {1.0f, kTailOpacity}};
    const double all = sumOf(count), bins = double(count.size());
    if (all == 0) return line;
    Bins bulk = bulkOf(count, all / 2);
    const std::size_t first = binsHolding(count.begin(), count.end(), kLeftOut * all);
    const std::size_t last = count.size() - binsHolding(count.rbegin(), count.rend(), kLeftOut * all);
    const double below = bulk.begin > first ? double(bulk.begin - first) : 0;
    const double above = last > bulk.end ? double(last - bulk.end) : 0;
    if (below + above == 0) return line;
    const bool flat = double(bulk.end - bulk.begin) > kFlat * double(last - first);
    if (flat) bulk.end = binsHolding(count.begin(), count.end(), all / 2);
    const bool low = below >= above / 2 && below > 0 && !flat, high = (above >= below / 2 && above > 0) || flat;
    const double each = share * all / (low && high ? 2 : 1);
    std::vector<glm::vec2> curve;
    if (low) {
        const std::size_t edge = std::clamp<std::size_t>(binsHolding(count.begin(), count.end(), each), 1, bulk.begin);
        curve = {{0.0f, kTailOpacity}, {float(double(edge) / bins), 0.0f}};
    } else {
        curve = {{0.0f, 0.0f}};
    }
    if (high) {
        const std::size_t held = binsHolding(count.rbegin(), count.rend(), each);
        const std::size_t edge = std::clamp(count.size() - held, bulk.end, count.size() - 1);
        curve.insert(curve.end(), {{float(double(edge) / bins), 0.0f}, {1.0f, kTailOpacity}});
    } else {
        curve.push_back({1.0f, 0.0f});
    }
    return curve;
}

void seeAtLeast(std::vector<glm::vec2>& curve, std::span<const std::uint64_t> count, std::uint64_t places,
                double least) {
    if (seenShare(count, places, curve) >= least || curve.size() < 2) return;
    constexpr float kSeen = float(kSeenOpacity) * 1.05f;
    const bool low = curve.front().y > 0, high = curve.back().y > 0;
    const double each = least * double(places) / (low && high ? 2 : 1), bins = double(count.size());
    // The number of bins at one end that together hold `each`.
    const auto from = [&](auto end, auto clear) {
        std::size_t held = 0;
        double sum = 0;
        while (end != clear && (sum += double(*end++)) < each) ++held;
        return std::min<double>(double(held) + 1, bins);
    };
    if (high) {
        const float edge = curve[curve.size() - 2].x, x = 1 - float(from(count.rbegin(), count.rend()) / bins);
        const float at = std::max(x, edge + float(1 / bins));
        if (at < 1 && kSeen > float(curveAt(curve, double(at)))) curve.insert(curve.end() - 1, {at, kSeen});
    }
    if (low) {
        const float edge = curve[1].x, x = float(from(count.begin(), count.end()) / bins);
        const float at = std::min(x, edge - float(1 / bins));
        if (at > 0 && kSeen > float(curveAt(curve, double(at)))) curve.insert(curve.begin() + 1, {at, kSeen});
    }
}

std::vector<glm::vec2> signedTailOpacity(std::span<const std::uint64_t> count, double share) {
    const std::size_t half = count.size() / 2;
    const double most = share * sumOf(count);
    double beyond = 0;
    std::size_t clear = half; // transparent bins on either side of 0
    while (clear > 0 &&
           (beyond += double(count[half - clear]) + double(count[count.size() - 1 - (half - clear)])) <= most)
        --clear;
    const float away = 0.5f * float(clear) / float(std::max<std::size_t>(half, 1));
    if (clear == half || clear == 0) return {{0.0f, kTailOpacity}, {0.5f, 0.0f}, {1.0f, kTailOpacity}};
    return {{0.0f, kTailOpacity}, {0.5f - away, 0.0f}, {0.5f + away, 0.0f}, {1.0f, kTailOpacity}};
}

} // namespace tessera::vis
