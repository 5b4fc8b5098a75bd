#pragma once

#include "volume/base/describe.h"
#include "volume/base/vectors.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <numbers>
#include <span>
#include <string>
#include <vector>

namespace tessera::vis {

/// A control point of a user-defined colour map.
struct ColorStop {
    float position = 0; ///< 0..1 along the range
    glm::vec3 color{1}; ///< sRGB
    bool operator==(const ColorStop&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.position,
              FieldInfo{.key = "position", .doc = "Position along the colour map", .range = Range{0, 1}});
        visit(self.color, FieldInfo{.key = "color", .doc = "Colour at the position (sRGB)", .range = Range{0, 1}});
    }
};

enum class RegionShape { Rectangle, Triangle, Gaussian };
inline constexpr std::string_view kRegionShapeNames[] = {"rectangle", "triangle", "gaussian"};

/// A region of a 2D transfer function over value (x, 0..1 along the range) and gradient magnitude (y, 0..1 up to
/// gradientTop): the box of `size` around `centre`, the triangle standing on its tip inside it (after the widgets of G.
/// Kindlmann and J. Kniss), or a Gaussian that ends at the inscribed ellipse (three standard deviations).
struct TransferRegion {
    RegionShape shape = RegionShape::Rectangle;
    glm::vec2 centre{0.5f, 0.5f}, size{0.3f, 0.6f};
    float soft = 0.5f;    ///< fraction of the half width over which the opacity fades; not for Gaussians
    float opacity = 0.5f; ///< of a layer `kReferenceLength` thick
    bool ownColor = true; ///< otherwise the colour map's
    glm::vec3 color{0.95f, 0.75f, 0.35f};
    bool operator==(const TransferRegion&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.shape, FieldInfo{.key = "shape", .doc = "Shape of the region", .names = kRegionShapeNames});
        visit(self.centre, FieldInfo{.key = "centre",
                                     .doc = "Centre: value and gradient magnitude, both 0 to 1",
                                     .range = Range{-1, 2}});
        visit(self.size, FieldInfo{.key = "size", .doc = "Width and height", .range = Range{0.001, 4}});
        visit(self.soft, FieldInfo{.key = "soft",
                                   .doc = "Share of the half width over which the opacity falls to 0",
                                   .range = Range{0, 1}});
        visit(self.opacity, FieldInfo{.key = "opacity", .doc = "Greatest opacity", .range = Range{0, 1}});
        visit(self.ownColor, FieldInfo{"ownColor", "Use the colour of the region instead of the colour map"});
        visit(self.color, FieldInfo{.key = "color", .doc = "Colour of the region (sRGB)", .range = Range{0, 1}});
    }
};

/// Kind of a composite layer's opacity: 1D curve or 2D regions.
enum class TransferKind { Curve, Regions };
inline constexpr std::string_view kTransferKindNames[] = {"curve", "regions"};

/// Maps values of one channel to colour and opacity; shared by all views that show the channel.
struct TransferFunction {
    std::string colormap = "viridis";
    bool reversed = false;
    bool autoRange = true;  ///< follow the parameter's range over all times
    bool aboutZero = false; ///< make the range symmetric about 0
    Range range{0, 1};      ///< physical values at the ends of the colour map; used if !autoRange
    /// Opacity curve: x in 0..1 along the range, y the opacity of a layer `kReferenceLength` thick. Sorted by x, at
    /// least 2.
    std::vector<glm::vec2> opacity{{0.0f, 0.0f}, {1.0f, 0.8f}};
    std::vector<ColorStop> colors; ///< sorted by position; a user-defined colour map, used instead of `colormap`
    TransferKind kind = TransferKind::Curve;
    std::vector<TransferRegion> regions;
    float gradientTop = 0.1f; ///< gradient magnitude at the top of the plane, in ranges per cell
    /// Emphasis b(x) of boundaries: x in 0..1 for -1..1 cells from the centre of a boundary, y the opacity. Sorted by
    /// x.
    std::vector<glm::vec2> emphasis{{0.25f, 0.0f}, {0.5f, 0.6f}, {0.75f, 0.0f}};

    bool operator==(const TransferFunction&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.colormap, FieldInfo{.key = "colormap", .doc = "Colour map", .refersTo = "colormap"});
        visit(self.reversed, FieldInfo{"reversed", "Reverse the colour map"});
        visit(self.autoRange, FieldInfo{"autoRange", "Use the range of the parameter over all times"});
        visit(self.aboutZero, FieldInfo{.key = "aboutZero",
                                        .doc = "Make the automatic range symmetric around 0",
                                        .applies = self.autoRange});
        visit(self.range, FieldInfo{"range", "Values at the ends of the colour map"});
        visit(self.opacity,
              FieldInfo{.key = "opacity", .doc = "Opacity curve: (position 0..1, opacity 0..1)", .hidden = true});
        visit(self.colors, FieldInfo{.key = "colors",
                                     .doc = "User-defined colours along the range, instead of the colour map",
                                     .hidden = true});
        visit(self.kind,
              FieldInfo{.key = "kind",
                        .doc = "Source of opacity: the curve over values, or regions of value and gradient magnitude",
                        .names = kTransferKindNames});
        visit(self.regions, FieldInfo{.key = "regions",
                                      .doc = "Regions of value and gradient magnitude that have opacity",
                                      .hidden = true});
        visit(self.gradientTop, FieldInfo{.key = "gradientTop",
                                          .doc = "Gradient magnitude at the top of the plane of regions and, where the "
                                                 "gradient is shown, at the end of the colour map",
                                          .unit = "ranges/cell",
                                          .range = Range{1e-4, 2},
                                          .logScale = true});
        visit(self.emphasis, FieldInfo{.key = "emphasis",
                                       .doc = "Opacity by distance from a boundary: (position 0..1 for -2..2 standard "
                                              "deviations of its blur, opacity 0..1)",
                                       .hidden = true});
    }
};

/// World length (longest stretched edge = 1) over which an opacity of the curve applies; shorter steps get
/// 1 - (1 - a)^(step / kReferenceLength).
inline constexpr double kReferenceLength = 1.0 / 128;

struct ColormapInfo {
    std::string_view name, kind; ///< kind: "sequential", "diverging", "cyclic", "categorical", "other"
};
/// All colour maps, perceptually uniform ones first.
std::span<const ColormapInfo> colormaps();

/// Colour (sRGB, 0..1) of a map at x in 0..1, interpolated linearly between its control colours (categorical maps as
/// equal steps); unknown names give viridis.
glm::dvec3 colormapColor(std::string_view name, double x);

/// The effective range: the channel's own, made symmetric about 0 if wanted, or the stated one.
Range effectiveRange(const TransferFunction& function, Range channelRange);

/// For signed values: diverging colours centred at 0, which is transparent.
TransferFunction divergingFunction();

/// Colour and opacity of a physical value; the single definition used by legends, tables, plots and the reference. A
/// categorical map colours a value by its nearest integer, regardless of the range: label n has colour n modulo their
/// number.
glm::dvec4 evaluate(const TransferFunction& function, Range range, double value);

/// Colour and opacity of a composite layer for a value and gradient magnitude (in ranges per cell): evaluate() for
/// curves; otherwise all regions together: opacity 1 - prod(1 - a), colour the mean weighted by opacity.
glm::dvec4 evaluate(const TransferFunction& function, Range range, double value, double gradient);

/// Opacity of a single region at a position, 0..1 each. A template over the number (volume/base/numbers.h).
template <class N> N regionOpacity(const TransferRegion& region, N value, N gradient) {
    // -1..1 inside the box around the region
    const N x = (value - N(region.centre.x)) / N(0.5 * double(region.size.x));
    const N y = (gradient - N(region.centre.y)) / N(0.5 * double(region.size.y));
    const N wide = magnitude(x), high = magnitude(y), sharp(1 / std::max(double(region.soft), 1e-6));
    N own(0);
    switch (region.shape) {
    case RegionShape::Rectangle:
        own = smaller(N(1), (N(1) - larger(wide, high)) * sharp);
        break;
    case RegionShape::Triangle: {
        const N half = N(0.5) * (y + N(1)); // half the triangle's width at this height, as a fraction
        const auto some = half > N(0);
        own = choose(some, clamped((N(1) - wide / choose(some, half, N(1))) * sharp, N(0), N(1)), N(0));
        break;
    }
    case RegionShape::Gaussian: {
        const double edge = std::exp(-4.5); // value at three standard deviations
        const N bell = powerOfTwo((x * x + y * y) * N(-4.5 * std::numbers::log2e));
        own = clamped((bell - N(edge)) * N(1 / (1 - edge)), N(0), N(1));
        break;
    }
    }
    const double opacity = std::clamp(double(region.opacity), 0.0, 1.0);
    return choose((wide <= N(1)) & (high <= N(1)), own * N(opacity), N(0));
}
inline double regionOpacity(const TransferRegion& region, glm::dvec2 place) {
    return regionOpacity<double>(region, place.x, place.y);
}

/// Colour and opacity of all regions together at a position, 0..1 each; `curve`: the colour of regions without their
/// own, and of places outside of all.
template <class N>
glm::vec<4, N> colorOfRegions(std::span<const TransferRegion> regions, const glm::vec<3, N>& curve, N value,
                              N gradient) {
    N through(1), weights(0);
    glm::vec<3, N> colors(N(0), N(0), N(0));
    for (const TransferRegion& region : regions) {
        const N opacity = regionOpacity(region, value, gradient);
        through = through * (N(1) - opacity);
        weights += opacity;
        colors = colors + (region.ownColor ? spreadOut<N>(region.color) : curve) * opacity;
    }
    const auto some = weights > N(0);
    const glm::vec<3, N> mean = choose(some, colors * (N(1) / choose(some, weights, N(1))), curve);
    return {mean.x, mean.y, mean.z, choose(some, N(1) - through, N(0))};
}

/// Piecewise-linear curve through points sorted by x; constant beyond its ends, at a jump the later value; 0 without
/// points.
double curveAt(std::span<const glm::vec2> curve, double x);

/// evaluate() at the centres of `size` equal parts of the range, for a colour bar. RGBA, sRGB colour, not
/// premultiplied. The range matters for categorical maps only.
std::vector<glm::vec4> makeTable(const TransferFunction& function, int size, Range range = {0, 1});

} // namespace tessera::vis
