#include "vis/packet/packet_table.h"

#include "vis/optics/preintegration.h"
#include "vis/optics/ray_setup.h"
#include "vis/packed/packet_volume.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace tessera::vis::packet {

namespace {

/// Whether a region may have opacity at some place [lo, hi], whatever the gradient.
bool anyRegion(const TransferFunction& function, double lo, double hi) {
    return std::ranges::any_of(function.regions, [&](const TransferRegion& region) {
        const double x = region.centre.x, y = region.centre.y, wide = 0.5 * double(region.size.x),
                     high = 0.5 * double(region.size.y);
        return region.opacity > 0 && hi >= x - wide && lo <= x + wide && y + high >= 0 && y - high <= 1;
    });
}

} // namespace

Table makeTable(const TransferFunction& function, Range range, std::optional<Range> domain, bool byRegions) {
    const Range over = domain.value_or(range);
    const auto valueAt = [&](double entry) { return glm::mix(over.lo, over.hi, entry / (kTableEntries - 1)); };
    const auto placeAt = [&](double entry) {
        return std::clamp((valueAt(entry) - range.lo) / (range.hi - range.lo), 0.0, 1.0);
    };
    std::vector<glm::dvec4> colors;
    for (int i = 0; i < kTableEntries; ++i) {
        const glm::dvec4 srgb = evaluate(function, range, valueAt(i));
        if (byRegions)
            colors.emplace_back(glm::dvec3(srgb), anyRegion(function, placeAt(i - 1), placeAt(i + 1)) ? 1 : 0);
        else
            colors.emplace_back(linearFromSrgb(glm::dvec3(srgb)), srgb.a);
    }
    double most = 0;
    for (const glm::dvec4& color : colors) most = std::max(most, color.a);
    Table table;
    table.opacityScale = most > 0 ? float(most) : 1;
    const auto quantum = [&](std::size_t entry, int component) {
        const double own = colors[std::min(entry, colors.size() - 1)][component];
        const double part = component == 3 ? own / double(table.opacityScale) : own;
        return std::uint32_t(std::lround(std::clamp(part, 0.0, 1.0) * kQuantum));
    };
    for (std::size_t i = 0; i < colors.size(); ++i) {
        for (int c = 0; c < 4; ++c) table.entries.push_back(std::int32_t(quantum(i, c) | quantum(i + 1, c) << 16));
        table.opacity.push_back(float(quantum(i, 3)));
    }
    return table;
}

std::vector<std::uint32_t> packedTable(const TransferFunction& function, Range range) {
    std::vector<std::uint32_t> out;
    const auto quantum = [](double part) { return std::uint32_t(std::clamp(part, 0.0, 1.0) * kQuantum + 0.5); };
    for (int i = 0; i < kPackedEntries; ++i) {
        const glm::dvec4 srgb =
            evaluate(function, range, glm::mix(range.lo, range.hi, double(i) / (kPackedEntries - 1)));
        const glm::dvec3 color = linearFromSrgb(glm::dvec3(srgb));
        const double extinction = std::max(0.0, -std::log2(1 - srgb.a)); // not -0
        const std::int64_t bits = std::int64_t(std::bit_cast<std::uint32_t>(float(std::min(extinction, 1e6)))) -
                                  (std::int64_t(kExtinctionLeast) << 23);
        const std::int64_t half = std::int64_t(1) << (kExtinctionShift - 1);
        const auto shortened =
            std::uint32_t(std::clamp((bits + half) >> kExtinctionShift, std::int64_t(0), std::int64_t(kQuantum)));
        out.push_back(quantum(color.x) | quantum(color.y) << 16);
        out.push_back(quantum(color.z) | shortened << 16);
    }
    return out;
}

SegmentSums segmentSums(const TransferFunction& function, Range range) {
    const IntegralFunctions functions = integralFunctions(function, range);
    constexpr int kLast = kSegmentPlaces - 1;
    std::vector<glm::dvec4> integrals(kSegmentPlaces + 2);
    for (int i = 0; i <= kLast; ++i) integrals[std::size_t(i) + 1] = integralAt(functions, double(i) / kLast);
    integrals[0] = integrals[2] - functions.density.front() * (2.0 / kLast);
    integrals[kLast + 2] = integrals[kLast] + functions.density.back() * (2.0 / kLast);
    double most = 0; // t * colour is at most t
    for (const glm::dvec4& integral : integrals) most = std::max(most, std::abs(integral.w));
    constexpr double kUnits = 2147483000;
    const double perUnit = most > 0 ? kUnits / most : 0;
    SegmentSums out;
    out.extinction = float(most / kUnits * kLast * std::numbers::log2e);
    for (const glm::dvec4& integral : integrals)
        for (int c = 0; c < 4; ++c) out.sums.push_back(std::int32_t(std::lround(integral[c] * perUnit)));
    return out;
}

void markShown(const Table& table, LayerView& layer) {
    const int last = int(table.opacity.size()) - 1;
    for (int bin = 0; bin < kShowBins; ++bin) {
        const int first = bin * last / (kShowBins - 1) - 1, beyond = (bin + 1) * last / (kShowBins - 1) + 2;
        for (int i = std::max(first, 0); i <= std::min(beyond, last); ++i)
            if (table.opacity[std::size_t(i)] > 0) layer.shows[bin / 32] |= 1u << (bin % 32);
    }
}

} // namespace tessera::vis::packet
