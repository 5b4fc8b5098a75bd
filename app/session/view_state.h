#pragma once

#include "volume/describe.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <string>
#include <variant>
#include <vector>

/// The saved state of each kind of view: plain described structs, one per kind. How a view draws itself is in
/// app/views.
namespace tessera::app {

struct VolumeView {
    static constexpr std::string_view kType = "volume";
    bool showBox = true, showAxes = true, showLegend = true, showCursor = true, showGizmo = true, showScaleBar = true,
         showLenses = true;
    bool operator==(const VolumeView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.showBox, FieldInfo{.key = "box", .unit = "", .doc = "Draw the box around the data"});
        visit(self.showAxes, FieldInfo{.key = "axes", .unit = "", .doc = "Draw axes with ticks and units"});
        visit(self.showLegend, FieldInfo{.key = "legend", .unit = "", .doc = "Draw colour legends"});
        visit(self.showCursor, FieldInfo{.key = "cursor", .unit = "", .doc = "Draw the linked cross-hair"});
        visit(self.showGizmo,
              FieldInfo{.key = "gizmo", .unit = "", .doc = "Draw the axis triad; a click on an end looks along it"});
        visit(self.showScaleBar, FieldInfo{.key = "scaleBar", .unit = "", .doc = "Draw a bar of a round length"});
        visit(self.showLenses,
              FieldInfo{.key = "lenses", .unit = "", .doc = "Draw outlines of lenses, and handles under the mouse"});
    }
};

struct SlicesView {
    static constexpr std::string_view kType = "slices";
    std::string channel; ///< "" = the channel of the first layer
    int contours = 0;
    bool showReadout = true;
    bool operator==(const SlicesView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel, FieldInfo{.key = "channel", .unit = "", .doc = "Parameter shown", .refersTo = "channel"});
        visit(self.contours,
              FieldInfo{
                  .key = "contours", .unit = "", .doc = "Number of contour lines, 0 = none", .range = Range{0, 50}});
        visit(self.showReadout, FieldInfo{.key = "readout", .unit = "", .doc = "List every parameter at the cursor"});
    }
};

/// What a drag in a plot makes.
enum class BrushTool { Rectangle, Ellipse, Lasso };
inline constexpr std::string_view kBrushToolNames[] = {"rectangle", "ellipse", "lasso"};

struct ScatterMatrixView {
    static constexpr std::string_view kType = "scatterMatrix";
    std::vector<std::string> channels; ///< empty = every scalar and vector magnitude
    int bins = 96;
    bool logDensity = true;
    BrushTool tool = BrushTool::Rectangle;
    float softness = 0.05f;            ///< soft edge of new brushes, as a share of their width
    std::string colorBy;               ///< bins are coloured by the mean of this; "" = by density and selection
    bool outliers = true;              ///< dots where few samples lie
    std::map<std::string, Range> zoom; ///< shown values by parameter; others: all
    std::vector<std::string> enlarged; ///< x and y of the plot that is shown large, equal for a histogram; empty = none
    bool operator==(const ScatterMatrixView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channels,
              FieldInfo{.key = "channels", .unit = "", .doc = "Parameters compared", .refersTo = "channel"});
        visit(self.bins,
              FieldInfo{.key = "bins", .unit = "", .doc = "Bins along each axis of a plot", .range = Range{16, 512}});
        visit(self.logDensity, FieldInfo{.key = "logDensity", .unit = "", .doc = "Show the logarithm of the density"});
        visit(self.tool, FieldInfo{.key = "tool", .unit = "", .doc = "Shape of new brushes", .names = kBrushToolNames});
        visit(self.softness, FieldInfo{.key = "softness",
                                       .unit = "",
                                       .doc = "Soft edge of new brushes, share of their width",
                                       .range = Range{0, 1}});
        visit(self.colorBy, FieldInfo{.key = "colorBy",
                                      .unit = "",
                                      .doc = "Parameter whose mean colours the plots; none: the density",
                                      .refersTo = "channel"});
        visit(self.outliers, FieldInfo{.key = "outliers", .unit = "", .doc = "Mark places where few samples lie"});
        visit(self.zoom, FieldInfo{.key = "zoom", .unit = "", .doc = "Values shown, by parameter", .hidden = true});
        visit(self.enlarged, FieldInfo{.key = "enlarged",
                                       .unit = "",
                                       .doc = "Parameters of the plot that is shown large",
                                       .refersTo = "channel",
                                       .hidden = true});
    }
};

struct TransferView {
    static constexpr std::string_view kType = "transfer";
    std::string channel; ///< "" = the channel of the first layer
    bool logHistogram = true;
    bool visibility = false;
    bool boundaries = false; ///< of a function that is a curve
    bool operator==(const TransferView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel, FieldInfo{.key = "channel",
                                      .unit = "",
                                      .doc = "Parameter whose transfer function is edited",
                                      .refersTo = "channel"});
        visit(self.logHistogram,
              FieldInfo{.key = "logHistogram", .unit = "", .doc = "Show the logarithm of the counts"});
        visit(self.visibility, FieldInfo{.key = "visibility",
                                         .unit = "",
                                         .doc = "Show how much of what one sees comes from which values"});
        visit(self.boundaries, FieldInfo{.key = "boundaries",
                                         .unit = "",
                                         .doc = "Make the curve from boundaries: their emphasis is edited"});
    }
};

struct LayersView {
    static constexpr std::string_view kType = "layers";
    int selected = 0; ///< layer whose parameters are shown
    bool operator==(const LayersView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.selected, FieldInfo{.key = "selected",
                                       .unit = "",
                                       .doc = "Layer whose parameters are shown, counted from 0",
                                       .range = Range{0, 1000},
                                       .hidden = true});
    }
};

struct TimelineView {
    static constexpr std::string_view kType = "timeline";
    bool operator==(const TimelineView&) const = default;
    static void describe(auto&, auto&&) {}
};

/// What is in the data set, and the selection with its statistics.
struct DataView {
    static constexpr std::string_view kType = "data";
    bool operator==(const DataView&) const = default;
    static void describe(auto&, auto&&) {}
};

struct HistoryView {
    static constexpr std::string_view kType = "history";
    bool operator==(const HistoryView&) const = default;
    static void describe(auto&, auto&&) {}
};

struct LogView {
    static constexpr std::string_view kType = "log";
    bool operator==(const LogView&) const = default;
    static void describe(auto&, auto&&) {}
};

inline constexpr FieldInfo kShownChannels{
    .key = "channels", .unit = "", .doc = "Parameters shown; none: every scalar and magnitude", .refersTo = "channel"};

/// Count, volume, mean, spread and correlation of every parameter inside and outside of the selection.
struct StatisticsView {
    static constexpr std::string_view kType = "statistics";
    std::vector<std::string> channels;
    std::string correlateWith; ///< "" = the first parameter
    bool operator==(const StatisticsView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channels, kShownChannels);
        visit(self.correlateWith, FieldInfo{.key = "correlateWith",
                                            .unit = "",
                                            .doc = "Parameter that the others are correlated with",
                                            .refersTo = "channel"});
    }
};

struct HistogramView {
    static constexpr std::string_view kType = "histogram";
    std::string channel; ///< "" = the channel of the first layer
    int bins = 192;
    bool logCounts = false;
    float softness = 0.05f; ///< soft edge of new brushes, as a share of their width
    bool operator==(const HistogramView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel, FieldInfo{.key = "channel", .unit = "", .doc = "Parameter shown", .refersTo = "channel"});
        visit(self.bins, FieldInfo{.key = "bins", .unit = "", .doc = "Bins", .range = Range{8, 1024}});
        visit(self.logCounts, FieldInfo{.key = "logCounts", .unit = "", .doc = "Show the logarithm of the counts"});
        visit(self.softness, FieldInfo{.key = "softness",
                                       .unit = "",
                                       .doc = "Soft edge of new brushes, share of their width",
                                       .range = Range{0, 1}});
    }
};

/// What a line profile runs over: a line in space, every time at the cursor, or both as a picture.
enum class ProfileOver { Line, Time, LineAndTime };
inline constexpr std::string_view kProfileOverNames[] = {"line", "time", "lineAndTime"};

/// Parameters along a polyline in space, over time, or both.
struct ProfileView {
    static constexpr std::string_view kType = "profile";
    std::vector<std::string> channels;
    ProfileOver over = ProfileOver::Line;
    std::vector<glm::dvec3> points; ///< corners; fewer than two: the longest axis through the cursor
    int samples = 256;
    bool operator==(const ProfileView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channels, kShownChannels);
        visit(self.over, FieldInfo{.key = "over",
                                   .unit = "",
                                   .doc = "Values along the line, at the cursor over time, or along the line at every "
                                          "time as colours",
                                   .names = kProfileOverNames});
        visit(self.points,
              FieldInfo{.key = "points", .unit = "m", .doc = "Corners of the line; none: along the longest axis"});
        visit(self.samples,
              FieldInfo{.key = "samples", .unit = "", .doc = "Places along the line", .range = Range{16, 4096}});
    }
};

enum class SliceAxis { X, Y, Z };
inline constexpr std::string_view kSliceAxisNames[] = {"x", "y", "z"};

/// Parameters (rows) on parallel planes (columns).
struct SliceMatrixView {
    static constexpr std::string_view kType = "sliceMatrix";
    std::vector<std::string> channels;
    SliceAxis axis = SliceAxis::Z;
    int planes = 4;
    bool operator==(const SliceMatrixView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channels, kShownChannels);
        visit(self.axis,
              FieldInfo{.key = "axis", .unit = "", .doc = "Axis the planes stand on", .names = kSliceAxisNames});
        visit(self.planes,
              FieldInfo{.key = "planes", .unit = "", .doc = "Planes, evenly spread", .range = Range{1, 12}});
    }
};

/// What a face of the cube shows of its parameter, along the axis that the face stands on.
enum class WallKind { Slice, Mean, Maximum, XRay, Shadow };
inline constexpr std::string_view kWallKindNames[] = {"slice", "mean", "maximum", "xray", "shadow"};

struct Wall {
    std::string channel = {}; ///< "" = the channel of the first layer
    WallKind kind = WallKind::Mean;
    bool operator==(const Wall&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel, FieldInfo{.key = "channel", .unit = "", .doc = "Parameter shown", .refersTo = "channel"});
        visit(self.kind, FieldInfo{.key = "kind",
                                   .unit = "",
                                   .doc = "At the cursor, mean or maximum along the axis, absorption by the transfer "
                                          "function, or the shadow that the selection casts",
                                   .names = kWallKindNames});
    }
};

/// The scene in a cube on whose inner faces, those turned to the viewer, parameters are projected.
struct ShadowCubeView {
    static constexpr std::string_view kType = "shadowCube";
    Wall left, right{.kind = WallKind::Slice}, bottom, top{.kind = WallKind::Slice}, back,
        front{.kind = WallKind::Slice}; ///< at the lower and upper end of x, y and z
    float gap = 0.22f;
    bool together = true;
    glm::quat orientation{1, 0, 0, 0};
    bool brushing = false;
    bool operator==(const ShadowCubeView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.left, FieldInfo{.key = "left", .unit = "", .doc = "Face at the lower end of x"});
        visit(self.right, FieldInfo{.key = "right", .unit = "", .doc = "Face at the upper end of x"});
        visit(self.bottom, FieldInfo{.key = "bottom", .unit = "", .doc = "Face at the lower end of y"});
        visit(self.top, FieldInfo{.key = "top", .unit = "", .doc = "Face at the upper end of y"});
        visit(self.back, FieldInfo{.key = "back", .unit = "", .doc = "Face at the lower end of z"});
        visit(self.front, FieldInfo{.key = "front", .unit = "", .doc = "Face at the upper end of z"});
        visit(self.gap, FieldInfo{.key = "gap",
                                  .unit = "",
                                  .doc = "From the data to the faces, longest edge = 1",
                                  .range = Range{0, 1}});
        visit(self.together, FieldInfo{.key = "together",
                                       .unit = "",
                                       .doc = "The cube turns with the object; else each is turned by itself"});
        visit(
            self.orientation,
            FieldInfo{.key = "orientation", .unit = "", .doc = "Of the cube while it turns by itself", .hidden = true});
        visit(self.brushing,
              FieldInfo{.key = "brushing", .unit = "", .doc = "Dragging on a face selects the prism behind it"});
    }
};

/// What colours the points of a tesseract.
enum class TesseractColor { Value, Fourth };
inline constexpr std::string_view kTesseractColorNames[] = {"value", "fourth"};

/// The field in four dimensions, turned in six planes: splatted samples in a wire tesseract.
struct TesseractView {
    static constexpr std::string_view kType = "tesseract";
    std::string channel; ///< "" = the channel of the first layer
    std::string fourth;  ///< parameter along the fourth axis at the session's time; "" = time itself
    TesseractColor colorBy = TesseractColor::Value;
    glm::vec3 turn{0, -32, 22}, turn4{0, 0, 0};
    float eye = 1.8f, zoom = 1;
    float radius = 3;
    float density = 1;
    int points = 150000;
    bool cube = true;
    bool showWire = true, showNow = true, showLegend = true, showControls = true;
    int lattice = 0;
    bool tour = false;
    float tourSpeed = 12;
    bool operator==(const TesseractView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel, FieldInfo{.key = "channel", .unit = "", .doc = "Parameter shown", .refersTo = "channel"});
        visit(self.fourth, FieldInfo{.key = "fourth",
                                     .unit = "",
                                     .doc = "Parameter along the fourth axis, at the time shown; none: time itself",
                                     .refersTo = "channel"});
        visit(self.colorBy, FieldInfo{.key = "colorBy",
                                      .unit = "",
                                      .doc = "Points coloured by their value or by the fourth axis",
                                      .names = kTesseractColorNames});
        const Range turn{-180, 180};
        visit(self.turn, FieldInfo{.key = "turn",
                                   .unit = "deg",
                                   .doc = "Rotation in the planes xy, xz, yz, in this order",
                                   .range = turn});
        visit(self.turn4, FieldInfo{.key = "turn4",
                                    .unit = "deg",
                                    .doc = "Rotation in the planes xw, yw, zw, after the others; w is the fourth axis",
                                    .range = turn});
        visit(self.eye, FieldInfo{.key = "eye",
                                  .unit = "radius",
                                  .doc = "Distance of the eye along the fourth axis, in radii of the tesseract",
                                  .range = Range{1.1, 20},
                                  .logScale = true});
        visit(self.zoom, FieldInfo{.key = "zoom",
                                   .unit = "",
                                   .doc = "Magnification; at 1 the tesseract fits at any angle",
                                   .range = Range{0.2, 10},
                                   .logScale = true});
        visit(self.radius,
              FieldInfo{.key = "radius", .unit = "pixel", .doc = "Radius of a splat", .range = Range{0.5, 20}});
        visit(self.density, FieldInfo{.key = "density",
                                      .unit = "",
                                      .doc = "Opacity of the points",
                                      .range = Range{0.01, 20},
                                      .logScale = true});
        visit(self.points, FieldInfo{.key = "points",
                                     .unit = "",
                                     .doc = "Samples drawn at most",
                                     .range = Range{1000, 2000000},
                                     .logScale = true});
        visit(self.cube,
              FieldInfo{.key = "cube", .unit = "", .doc = "All axes equally long; else the proportions as shown"});
        visit(self.showWire, FieldInfo{.key = "wire", .unit = "", .doc = "Draw the edges of the tesseract"});
        visit(self.showNow, FieldInfo{.key = "now", .unit = "", .doc = "Draw the cell of the time shown"});
        visit(self.showLegend, FieldInfo{.key = "legend", .unit = "", .doc = "Draw colour legends"});
        visit(self.showControls, FieldInfo{.key = "controls", .unit = "", .doc = "Show a slider for each plane"});
        visit(self.lattice, FieldInfo{.key = "lattice",
                                      .unit = "",
                                      .doc = "Cells of the lattice drawn along each axis, 0 = none",
                                      .range = Range{0, 8}});
        visit(self.tour, FieldInfo{.key = "tour", .unit = "", .doc = "Keep turning in two planes at once"});
        visit(self.tourSpeed,
              FieldInfo{.key = "tourSpeed", .unit = "deg/s", .doc = "Speed of the tour", .range = Range{1, 90}});
    }
};

/// How variants of the scene are put beside each other.
enum class CompareMode { Grid, Swipe, Blink, Difference };
inline constexpr std::string_view kCompareModeNames[] = {"grid", "swipe", "blink", "difference"};

/// The session with some settings changed.
struct CompareVariant {
    std::string name;                           ///< "" = made of the changes
    std::map<std::string, std::string> changes; ///< JSON pointer into the session -> JSON, or text
    bool operator==(const CompareVariant&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.name, FieldInfo{.key = "name", .unit = "", .doc = "Name over the picture; none: what differs"});
        visit(self.changes, FieldInfo{.key = "changes",
                                      .unit = "",
                                      .doc = "Settings that differ: a place in the session as in --set, and its value",
                                      .hidden = true});
    }
};

/// The 3D scene in several variants: cameras, time, cursor and brushes are those of the session.
/// A question to whoever compares, and the answer.
struct CompareQuestion {
    std::string text, answer;
    double seconds = 0; ///< from when it came on screen to the answer; 0 = not answered
    bool operator==(const CompareQuestion&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.text, FieldInfo{.key = "text", .unit = "", .doc = "What is asked"});
        visit(self.answer, FieldInfo{.key = "answer", .unit = "", .doc = "What was answered"});
        visit(self.seconds, FieldInfo{.key = "seconds", .unit = "s", .doc = "How long that took"});
    }
};

struct CompareView {
    static constexpr std::string_view kType = "compare";
    CompareMode mode = CompareMode::Grid;
    std::vector<CompareVariant> variants; ///< one without changes is the session as it is
    int reference = 0;                    ///< index of the variant that the others are measured against
    int other = 1;                        ///< index of the one swiped over the reference
    float swipe = 0.5f;                   ///< place of the line, share of the width
    float blinkSeconds = 0.8f;
    float differenceTop = 0; ///< difference of 8-bit colours shown brightest; 0 = the largest there is
    bool showTable = true;
    std::vector<CompareQuestion> questions;
    bool operator==(const CompareView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.mode, FieldInfo{.key = "mode",
                                   .unit = "",
                                   .doc = "Beside each other, either side of a line, in turns, or their difference "
                                          "from the reference",
                                   .names = kCompareModeNames});
        visit(self.variants, FieldInfo{.key = "variants",
                                       .unit = "",
                                       .doc = "What is compared: the session with settings changed",
                                       .hidden = true});
        visit(self.reference, FieldInfo{.key = "reference",
                                        .unit = "",
                                        .doc = "Variant that the others are measured against, counted from 0",
                                        .range = Range{0, 15},
                                        .hidden = true});
        visit(self.other, FieldInfo{.key = "other",
                                    .unit = "",
                                    .doc = "Variant swiped over the reference, counted from 0",
                                    .range = Range{0, 15},
                                    .hidden = true});
        visit(self.swipe,
              FieldInfo{.key = "swipe", .unit = "", .doc = "Place of the line between two", .range = Range{0, 1}});
        visit(self.blinkSeconds, FieldInfo{.key = "blinkSeconds",
                                           .unit = "s",
                                           .doc = "How long each is shown in turn",
                                           .range = Range{0.1, 10}});
        visit(self.differenceTop, FieldInfo{.key = "differenceTop",
                                            .unit = "of 255",
                                            .doc = "Difference of colours shown brightest; 0 = the largest that occurs",
                                            .range = Range{0, 255}});
        visit(self.showTable, FieldInfo{.key = "table", .unit = "", .doc = "List what differs, costs and errors"});
        visit(self.questions, FieldInfo{.key = "questions",
                                        .unit = "",
                                        .doc = "Questions to whoever compares, with their answers",
                                        .hidden = true});
    }
};

using ViewState = std::variant<VolumeView, SlicesView, ScatterMatrixView, TransferView, LayersView, TimelineView,
                               DataView, HistoryView, LogView, StatisticsView, HistogramView, ProfileView,
                               SliceMatrixView, ShadowCubeView, TesseractView, CompareView>;

} // namespace tessera::app
