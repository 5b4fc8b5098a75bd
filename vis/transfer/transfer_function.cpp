#include "vis/transfer/transfer_function.h"

#include "vis/transfer/colormap_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::vis {

namespace {

using namespace colormap_data;

struct Colormap {
    ColormapInfo info;
    std::span<const std::uint32_t> colors;
};

constexpr Colormap kMaps[] = {
    {{"viridis", "sequential"}, kViridis},
    {{"cividis", "sequential"}, kCividis},
    {{"inferno", "sequential"}, kInferno},
    {{"magma", "sequential"}, kMagma},
    {{"plasma", "sequential"}, kPlasma},
    {{"gray", "sequential"}, kGray},
    {{"blue-orange", "diverging"}, kBlueOrange},
    {{"blue-red", "diverging"}, kBlueRed},
    {{"twilight", "cyclic"}, kTwilight},
    {{"labels", "categorical"}, kLabels},
    {{"jet", "other"}, kJet},
};

constexpr auto kInfos = [] {
    std::array<ColormapInfo, std::size(kMaps)> infos;
    for (std::size_t i = 0; i < infos.size(); ++i) infos[i] = kMaps[i].info;
    return infos;
}();

const Colormap& find(std::string_view name) {
    const auto found =
        std::find_if(std::begin(kMaps), std::end(kMaps), [&](const Colormap& map) { return map.info.name == name; });
    return found == std::end(kMaps) ? kMaps[0] : *found;
}

glm::dvec3 unpack(std::uint32_t color) {
    return glm::dvec3((color >> 16) & 255, (color >> 8) & 255, color & 255) / 255.0;
}

/// Colour of a map at x in 0..1.
glm::dvec3 color(const Colormap& map, double x) {
    const auto last = static_cast<double>(map.colors.size() - 1);
    if (map.info.kind == "categorical")
        return unpack(map.colors[static_cast<std::size_t>(std::min(x * (last + 1), last))]);
    const double at = x * last;
    const double below = std::min(std::floor(at), last - 1);
    const auto i = static_cast<std::size_t>(below);
    return glm::mix(unpack(map.colors[i]), unpack(map.colors[i + 1]), at - below);
}

double clamp01(double x) {
    return x >= 0 ? std::min(x, 1.0) : 0.0; // NaN gives 0
}

/// Colour of a label: the map's colours in turn, so that it does not depend on the other labels.
glm::dvec3 labelColor(const Colormap& map, bool reversed, double label) {
    const auto count = static_cast<double>(map.colors.size());
    const double turn = std::isfinite(label) ? std::fmod(std::round(label), count) : 0;
    const auto i = static_cast<std::size_t>(turn < 0 ? turn + count : turn);
    return unpack(map.colors[reversed ? map.colors.size() - 1 - i : i]);
}

/// Colour of a list of stops at x; constant beyond its ends.
glm::dvec3 stopColor(const std::vector<ColorStop>& stops, double x) {
    const auto next = std::find_if(stops.begin(), stops.end(), [&](const ColorStop& s) { return s.position > x; });
    if (next == stops.begin()) return stops.front().color;
    if (next == stops.end()) return stops.back().color;
    const ColorStop &a = *(next - 1), &b = *next;
    return glm::mix(glm::dvec3(a.color), glm::dvec3(b.color), (x - a.position) / (double(b.position) - a.position));
}

/// evaluate() at position x in 0..1 of the range, where the value is `value`.
glm::dvec4 evaluateAt(const TransferFunction& function, const Colormap& map, double x, double value) {
    const double along = function.reversed ? 1 - x : x;
    const glm::dvec3 shown = !function.colors.empty()         ? stopColor(function.colors, along)
                             : map.info.kind == "categorical" ? labelColor(map, function.reversed, value)
                                                              : color(map, along);
    return {shown, clamp01(curveAt(function.opacity, x))};
}

/// Position of a value in a range, 0..1. A range without width still separates values below and above.
double placeIn(Range range, double value) {
    const double width = range.hi - range.lo;
    return clamp01(width != 0 ? (value - range.lo) / width : value > range.lo ? 1.0 : value < range.lo ? 0.0 : 0.5);
}

} // namespace

std::span<const ColormapInfo> colormaps() {
    return kInfos;
}

glm::dvec3 colormapColor(std::string_view name, double x) {
    return color(find(name), clamp01(x));
}

Range effectiveRange(const TransferFunction& function, Range channelRange) {
    if (!function.autoRange) return function.range;
    if (!function.aboutZero) return channelRange;
    const double most = std::max(std::abs(channelRange.lo), std::abs(channelRange.hi));
    return most > 0 ? Range{-most, most} : Range{-1, 1};
}

TransferFunction divergingFunction() {
    TransferFunction made;
    made.colormap = "blue-orange";
    made.aboutZero = true;
    made.opacity = {{0.0f, 0.8f}, {0.5f, 0.0f}, {1.0f, 0.8f}};
    return made;
}

glm::dvec4 evaluate(const TransferFunction& function, Range range, double value) {
    return evaluateAt(function, find(function.colormap), placeIn(range, value), value);
}

glm::dvec4 evaluate(const TransferFunction& function, Range range, double value, double gradient) {
    const glm::dvec4 curve = evaluate(function, range, value);
    if (function.kind == TransferKind::Curve) return curve;
    const glm::dvec2 place(placeIn(range, value), clamp01(gradient / double(function.gradientTop)));
    return colorOfRegions<double>(function.regions, glm::dvec3(curve), place.x, place.y);
}

double curveAt(std::span<const glm::vec2> curve, double x) {
    if (curve.empty()) return 0;
    const auto next = std::find_if(curve.begin(), curve.end(), [&](glm::vec2 point) { return point.x > x; });
    if (next == curve.begin()) return curve.front().y;
    if (next == curve.end()) return curve.back().y;
    const glm::dvec2 a(*(next - 1)), b(*next);
    return glm::mix(a.y, b.y, (x - a.x) / (b.x - a.x));
}

std::vector<glm::vec4> makeTable(const TransferFunction& function, int size, Range range) {
    const Colormap& map = find(function.colormap);
    std::vector<glm::vec4> table(static_cast<std::size_t>(std::max(size, 0)));
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double x = (static_cast<double>(i) + 0.5) / size;
        table[i] = evaluateAt(function, map, x, glm::mix(range.lo, range.hi, x));
    }
    return table;
}

} // namespace tessera::vis
