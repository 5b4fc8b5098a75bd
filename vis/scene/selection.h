#pragma once

#include "vis/scene/lens.h"
#include "volume/base/data_units.h"
#include "volume/base/describe.h"

#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace tessera::vis {

/// Values of a channel between lo and hi, with a soft edge outside. NaN never matches.
struct BrushInterval {
    std::string channel;
    double lo = 0, hi = 1; ///< physical values between which the degree of interest is 1
    double soft = 0;       ///< physical width over which it falls linearly to 0 outside

    bool operator==(const BrushInterval&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel, FieldInfo{.key = "channel", .doc = "Parameter of the range", .refersTo = "channel"});
        visit(self.lo, FieldInfo{"lo", "Lower end"});
        visit(self.hi, FieldInfo{"hi", "Upper end"});
        visit(self.soft, FieldInfo{"soft", "Width of the soft edge"});
    }
};

inline constexpr FieldInfo kSoftShare{
    .key = "soft", .doc = "Width of the soft edge outside, as a share of the radius", .range = Range{0, 2}};
inline constexpr FieldInfo kBrushX{.key = "x", .doc = "Parameter along the first axis", .refersTo = "channel"};
inline constexpr FieldInfo kBrushY{.key = "y", .doc = "Parameter along the second axis", .refersTo = "channel"};

/// An interval in one channel, a rectangle in two, a box in more: the degree of interest is the minimum over the
/// intervals.
struct RangeRegion {
    static constexpr std::string_view kType = "range";
    std::vector<BrushInterval> intervals;
    bool operator==(const RangeRegion&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.intervals, FieldInfo{"intervals", "Ranges of parameters; all must hold"});
    }
};

/// An ellipse in two channels: with u, v the distances from the centre in radii and c the correlation, the inside is
/// (u^2 - 2 c u v + v^2) / (1 - c^2) <= 1, whose bounding rectangle is |u|, |v| <= 1.
struct EllipseRegion {
    static constexpr std::string_view kType = "ellipse";
    std::string x, y;
    glm::dvec2 center{0}, radius{1}; ///< physical values
    double correlation = 0;
    double soft = 0;
    bool operator==(const EllipseRegion&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.x, kBrushX);
        visit(self.y, kBrushY);
        visit(self.center, FieldInfo{"center", "Values at the centre"});
        visit(self.radius, FieldInfo{"radius", "Half widths along the two axes"});
        visit(self.correlation, FieldInfo{.key = "correlation",
                                          .doc = "Tilt: 0 = along the axes, towards 1 = along the rising diagonal",
                                          .range = Range{-0.99, 0.99}});
        visit(self.soft, kSoftShare);
    }
};

/// A closed polygon in two channels; even-odd rule. The degree of interest is defined by lassoTable().
struct LassoRegion {
    static constexpr std::string_view kType = "lasso";
    std::string x, y;
    std::vector<glm::dvec2> points; ///< physical values; fewer than three select nothing
    double soft = 0;                ///< width of the soft edge, as a fraction of the half size of the polygon's box
    bool operator==(const LassoRegion&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.x, kBrushX);
        visit(self.y, kBrushY);
        visit(self.points, FieldInfo{.key = "points", .doc = "Corners of the polygon", .hidden = true});
        visit(self.soft, kSoftShare);
    }
};

/// A ball in the picture; if the data are stretched its physical radii differ, so that it appears round. Where axes are
/// uneven the radii are lengths of the drawing: of the sheet around the centre.
struct SphereRegion {
    static constexpr std::string_view kType = "sphere";
    glm::dvec3 center{0}, radius{1}; ///< physical
    double soft = 0;
    bool operator==(const SphereRegion&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.center, FieldInfo{.key = "center", .doc = "Centre of the ball", .unit = kUnitOfLengths});
        visit(self.radius, FieldInfo{.key = "radius", .doc = "Radii along x, y, z", .unit = kUnitOfLengths});
        visit(self.soft, kSoftShare);
    }
};

struct BoxRegion {
    static constexpr std::string_view kType = "box";
    glm::dvec3 center{0}, radius{1}; ///< physical; half edges
    double soft = 0;
    bool operator==(const BoxRegion&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.center, FieldInfo{.key = "center", .doc = "Centre of the box", .unit = kUnitOfLengths});
        visit(self.radius,
              FieldInfo{.key = "radius", .doc = "Half edge lengths along x, y, z", .unit = kUnitOfLengths});
        visit(self.soft, kSoftShare);
    }
};

/// The inside of a lens, at its current position.
struct LensRegion {
    static constexpr std::string_view kType = "lens";
    std::string lens; ///< name; "": any lens used as a brush
    bool operator==(const LensRegion&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.lens, FieldInfo{.key = "lens",
                                   .doc = "Lens whose inside is selected; empty: every lens with `marks`",
                                   .refersTo = "lens"});
    }
};

using Region = std::variant<RangeRegion, EllipseRegion, LassoRegion, SphereRegion, BoxRegion, LensRegion>;

enum class BrushCombine { And, Or, Minus };
inline constexpr std::string_view kBrushCombineNames[] = {"and", "or", "minus"};

struct Brush {
    std::string name = "brush";
    glm::vec3 color{1.0f, 0.69f, 0.25f};
    bool enabled = true;
    bool inverted = false;
    BrushCombine combine = BrushCombine::And; ///< with the enabled brushes before it
    Region region;

    bool operator==(const Brush&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.name, FieldInfo{"name", "Name of the brush"});
        visit(self.color, FieldInfo{.key = "color", .doc = "Colour in the plots", .range = Range{0, 1}});
        visit(self.enabled, FieldInfo{"enabled", "Use this brush in the selection"});
        visit(self.inverted, FieldInfo{"inverted", "Select what lies outside"});
        visit(self.combine, FieldInfo{.key = "combine",
                                      .doc = "How it combines with the brushes before it: and, or, minus",
                                      .names = kBrushCombineNames});
        visit(self.region, FieldInfo{"region", "What the brush selects"});
    }
};

/// The selection shared by all views. The degree of interest (DOI) of a sample is 1 if no brush is enabled. Otherwise
/// the enabled brushes are combined in order: and = min, or = max, minus = min with 1 - d, starting with 1, or with 0
/// if the first brush is an "or". A sample that lacks a value that a brush asks for lies neither inside nor outside of
/// it: d is 0, also if the brush is inverted.
struct Selection {
    std::vector<Brush> brushes;
    std::string name;               ///< of what several brushes select together; "": made of their names
    float focusOpacity = 0.3f;      ///< least opacity of samples with DOI 1, of a layer `kReferenceLength` thick
    float contextOpacity = 0.04f;   ///< opacity factor of samples with DOI 0
    float contextSaturation = 0.1f; ///< colour saturation of samples with DOI 0
    float contextLightness = 1;     ///< lightness of samples with DOI 0: 0 black, 1 unchanged, 2 white
    float brushColor = 0;           ///< how much samples take the colour of the brush that holds them most
    float contextBlur = 0;          ///< blur radius at DOI 0, as a fraction of the picture's height

    bool operator==(const Selection&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.brushes,
              FieldInfo{.key = "brushes", .doc = "Brushes, in the order in which they are combined", .hidden = true});
        visit(self.name, FieldInfo{.key = "name",
                                   .doc = "Name of what several brushes select together; empty: made of their names",
                                   .hidden = true});
        visit(self.focusOpacity, FieldInfo{.key = "focusOpacity",
                                           .doc = "Least opacity of what is brushed, where the transfer function hides "
                                                  "it; 0: as the function says",
                                           .range = Range{0, 1}});
        visit(self.contextOpacity,
              FieldInfo{.key = "contextOpacity", .doc = "Opacity of what is not brushed", .range = Range{0, 1}});
        visit(self.contextSaturation, FieldInfo{.key = "contextSaturation",
                                                .doc = "Colour saturation of what is not brushed",
                                                .range = Range{0, 1}});
        visit(self.contextLightness, FieldInfo{.key = "contextLightness",
                                               .doc = "Lightness of what is not brushed: 0 black, 1 unchanged, 2 white",
                                               .range = Range{0, 2}});
        visit(self.brushColor, FieldInfo{.key = "brushColor",
                                         .doc = "How strongly brushed samples take the colour of their brush",
                                         .range = Range{0, 1}});
        visit(self.contextBlur,
              FieldInfo{.key = "contextBlur",
                        .doc = "Blur radius of what is not brushed, as a share of the picture's height",
                        .range = Range{0, 0.05}});
    }
    /// Whether a brush is enabled.
    bool active() const;
};

/// A brush from intervals, as made by dragging in a plot.
Brush rangeBrush(std::vector<BrushInterval> intervals, std::string name = "brush");

/// Channels that a region depends on, without duplicates; empty for regions in space.
std::vector<std::string> regionChannels(const Region& region);
/// Channels that the enabled brushes depend on, without duplicates.
std::vector<std::string> selectedChannels(const Selection& selection);
/// Whether an enabled brush is a region in space.
bool selectsSpace(const Selection& selection);
/// Whether an enabled brush is a lens.
bool selectsLens(const Selection& selection);

/// 1 inside [lo, hi], linear to 0 at the end of the soft edge.
double intervalDoi(const BrushInterval& interval, double value);
/// 1 up to radius 1, linear to 0 at 1 + soft.
double radialDoi(double radii, double soft);
/// Square of the normalised radius of (u, v) in an ellipse.
template <class N> N ellipseSquare(N u, N v, double correlation) {
    return (u * u - N(2 * correlation) * u * v + v * v) * N(1 / (1 - correlation * correlation));
}
/// Normalised radius of (u, v) in an ellipse.
double ellipseRadii(double u, double v, double correlation);

inline constexpr int kLassoTable = 128; ///< entries a side
/// The DOI of a lasso as a table: entry (i, j) is that of the point center + halfSize * extent * (2 (i, j) /
/// (kLassoTable - 1) - 1), with bilinear interpolation, 0 outside. It follows from the signed distance to the polygon,
/// in half sizes of its box.
struct LassoPlace {
    glm::dvec2 center{0}, halfSize{1}; ///< of the polygon's box
    double extent = 1;                 ///< of the table, in half sizes
};
LassoPlace lassoPlace(const LassoRegion& lasso);
struct LassoTable {
    LassoPlace place;
    std::vector<float> doi; ///< kLassoTable x kLassoTable, x fastest
    double at(double x, double y) const;
};
LassoTable lassoTable(const LassoRegion& lasso);

/// Half the box of a region on the sheet, and its middle there.
struct SheetBox {
    glm::dvec3 center{0}, radius{1};
};
SheetBox sheetBox(const SphereRegion& region, const volume::AxisMaps& axes);
SheetBox sheetBox(const BoxRegion& region, const volume::AxisMaps& axes);

/// A selection prepared for evaluation at many points. Lens brushes select nothing if `space` lacks the lens; regions
/// in space are by the axes of its frame, which must be those of the data.
class DoiFunction {
public:
    explicit DoiFunction(const Selection& selection, LensSpace space = {});
    /// The channels whose values are expected, in this order.
    const std::vector<std::string>& channels() const { return channels_; }
    /// Degree of interest of a point: values of channels() (NaN = absent) and its physical position. Thread-safe.
    double operator()(std::span<const double> values, glm::dvec3 position) const;
    /// The colour (sRGB) of the brush that holds a point most, the first among equals, and its degree of interest;
    /// "minus" and inverted brushes do not count. Same arguments.
    struct Holder {
        glm::vec3 color{0};
        double interest = 0;
    };
    Holder holder(std::span<const double> values, glm::dvec3 position) const;

private:
    struct Part {
        Brush brush;
        std::vector<int> channel; ///< indices into channels_: one per interval, or x and y
        LassoTable lasso;
        SheetBox box = {}; ///< of regions in space
    };
    double regionDoi(const Part& part, std::span<const double> values, glm::dvec3 position) const;
    std::vector<std::string> channels_;
    std::vector<Part> parts_;
    LensSpace space_;
};

/// Degree of interest of one point; `valueOf` returns its channel values (NaN = absent).
double degreeOfInterest(const Selection& selection, const std::function<double(const std::string& channel)>& valueOf,
                        glm::dvec3 position = glm::dvec3(0));

} // namespace tessera::vis
