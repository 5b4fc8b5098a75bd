#pragma once

#include "app/session/views/contour_settings.h"
#include "app/session/views/section_settings.h"
#include "app/session/views/view_kind.h"
#include "vis/scene/strokes.h"
#include "volume/base/data_units.h"
#include "volume/base/describe.h"
#include "volume/field/space_axis.h"

#include <glm/vec3.hpp>
#include <map>
#include <string>
#include <vector>

/// The saved state of plots, tables and the matrix of slices: many parameters at once.
namespace tessera::app {

inline constexpr FieldInfo kShownChannels{
    .key = "channels", .doc = "Parameters shown; empty: every scalar and magnitude", .refersTo = "channel"};

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
        visit(self.channels, FieldInfo{.key = "channels", .doc = "Parameters compared", .refersTo = "channel"});
        visit(self.bins, FieldInfo{.key = "bins", .doc = "Bins along each axis of a plot", .range = Range{16, 512}});
        visit(self.logDensity, FieldInfo{"logDensity", "Logarithmic density"});
        visit(self.tool, FieldInfo{.key = "tool", .doc = "Shape of new brushes", .names = kBrushToolNames});
        visit(self.softness, FieldInfo{.key = "softness",
                                       .doc = "Soft edge of new brushes, as a share of their width",
                                       .range = Range{0, 1}});
        visit(self.colorBy, FieldInfo{.key = "colorBy",
                                      .doc = "Parameter whose mean colours the plots; empty: colour by density",
                                      .refersTo = "optionalChannel"});
        visit(self.outliers, FieldInfo{"outliers", "Mark places with few samples"});
        visit(self.zoom, FieldInfo{.key = "zoom", .doc = "Visible range of values, by parameter", .hidden = true});
        visit(self.enlarged,
              FieldInfo{
                  .key = "enlarged", .doc = "Parameters of the enlarged plot", .refersTo = "channel", .hidden = true});
    }
};
DrawView<ScatterMatrixView> drawScatterMatrixView;

/// Count, volume, mean, spread and correlation of every parameter in the selection and in the rest.
struct StatisticsView {
    static constexpr std::string_view kType = "statistics";
    std::vector<std::string> channels;
    std::string correlateWith; ///< "" = the first parameter
    bool byRegion = false;
    bool selected = false; ///< by region: of what is brushed alone
    std::string balance;   ///< by region: what of this parameter flows in and out; "" = statistics
    bool operator==(const StatisticsView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channels, kShownChannels);
        visit(self.correlateWith, FieldInfo{.key = "correlateWith",
                                            .doc = "Parameter with which the correlation of the others is shown",
                                            .refersTo = "channel"});
        visit(self.byRegion, FieldInfo{"byRegion", "Statistics of every region instead of the selection"});
        visit(self.selected, FieldInfo{"selected", "By region: count what is selected in every region alone"});
        visit(self.balance, FieldInfo{.key = "balance",
                                      .doc = "By region: inflow and outflow of this parameter instead of statistics",
                                      .refersTo = "optionalChannel"});
    }
};
DrawView<StatisticsView> drawStatisticsView;

/// The values at the places of Session::probes.
struct ProbesView {
    static constexpr std::string_view kType = "probes";
    std::vector<std::string> channels;
    bool operator==(const ProbesView&) const = default;
    static void describe(auto& self, auto&& visit) { visit(self.channels, kShownChannels); }
};
DrawView<ProbesView> drawProbesView;

struct HistogramView {
    static constexpr std::string_view kType = "histogram";
    std::string channel; ///< "" = the channel of the first layer
    int bins = 192;
    bool logCounts = false;
    float softness = 0.05f;    ///< soft edge of new brushes, as a share of their width
    std::vector<double> times; ///< with a line each; empty: the time shown
    bool operator==(const HistogramView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel, FieldInfo{.key = "channel", .doc = "Parameter shown", .refersTo = "channel"});
        visit(self.bins, FieldInfo{.key = "bins", .doc = "Bins", .range = Range{8, 1024}});
        visit(self.logCounts, FieldInfo{"logCounts", "Logarithmic counts"});
        visit(self.softness, FieldInfo{.key = "softness",
                                       .doc = "Soft edge of new brushes, as a share of their width",
                                       .range = Range{0, 1}});
        visit(self.times,
              FieldInfo{.key = "times", .doc = "Times with a line each; empty: the time shown", .unit = kUnitOfTimes});
    }
};
DrawView<HistogramView> drawHistogramView;

/// What a profile runs over: a line in space, every time at the cursor, both as a picture, or planes across an axis or
/// the line.
enum class ProfileOver { Line, Time, LineAndTime, Sections };
inline constexpr std::string_view kProfileOverNames[] = {"line", "time", "lineAndTime", "sections"};

/// Parameters along a polyline in space, over time, or both.
struct ProfileView {
    static constexpr std::string_view kType = "profile";
    std::vector<std::string> channels;
    ProfileOver over = ProfileOver::Line;
    std::vector<glm::dvec3> points; ///< corners; fewer than two: the longest axis through the cursor
    int samples = 256;
    SectionSettings sections;  ///< over planes
    std::vector<double> times; ///< with a curve each, along the line and over planes; empty: the time shown
    bool operator==(const ProfileView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channels, kShownChannels);
        visit(self.over, FieldInfo{.key = "over",
                                   .doc = "Values along the line, at the cross-hair over time, along the line at every "
                                          "time as colours, or averages over planes",
                                   .names = kProfileOverNames});
        visit(self.points, FieldInfo{.key = "points",
                                     .doc = "Corners of the line; empty: along the longest axis",
                                     .unit = kUnitOfLengths});
        visit(self.samples,
              FieldInfo{.key = "samples", .doc = "Number of points along the line", .range = Range{16, 4096}});
        visit(self.sections, FieldInfo{"sections", "Averages over planes"});
        visit(self.times, FieldInfo{.key = "times",
                                    .doc = "Times with a curve each along the line and over planes; empty: the time "
                                           "shown",
                                    .unit = kUnitOfTimes});
    }
};
DrawView<ProfileView> drawProfileView;

/// Quantities over time, statistics of parameters and formulas of both, against time or each other.
struct CurvesView {
    static constexpr std::string_view kType = "curves";
    std::string x; ///< formula, or "time"; "" = chosen to fit the curves
    std::vector<std::string>
        y; ///< formulas; empty: the polarisation curve if the data have one, else every quantity, else a mean
    std::string region;             ///< statistics are of this region of a label, by name or value; "" = everywhere
    std::vector<std::string> apart; ///< regions with a curve each, instead of that one
    bool brushed = false;           ///< and of what the brushes select
    bool together = true;           ///< curves of two units share a plot
    bool operator==(const CurvesView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.x,
              FieldInfo{"x", "Horizontal axis: time, a quantity over time, or a formula; empty: chosen by the curves"});
        visit(self.y, FieldInfo{"y", "Curves: quantities over time, mean(T), min(T), max(T), deviation(T), share(T), "
                                     "volume(T), integral(T), or formulas of them; empty: the polarisation curve, "
                                     "else every quantity, else a mean"});
        visit(self.region, FieldInfo{"region", "Region in which statistics are computed; empty: everywhere"});
        visit(self.apart,
              FieldInfo{"apart", "Regions with a curve of each statistic, by name or value; empty: that of `region`"});
        visit(self.brushed, FieldInfo{"brushed", "Compute statistics of the selection"});
        visit(self.together,
              FieldInfo{"together", "Draw curves of two units in one plot, with an axis on either side"});
    }
};
DrawView<CurvesView> drawCurvesView;

/// What the rows or the columns of a matrix of slices differ in.
enum class MatrixAxis { Parameters, Directions, Positions, Times };
inline constexpr std::string_view kMatrixAxisNames[] = {"parameters", "directions", "positions", "times"};

/// Slices in rows and columns, which differ in what the user chooses: parameters, the three directions (through the
/// cross-hair), parallel planes, times.
struct SliceMatrixView {
    static constexpr std::string_view kType = "sliceMatrix";
    MatrixAxis rows = MatrixAxis::Parameters, columns = MatrixAxis::Positions;
    std::vector<std::string> channels; ///< the first one where neither rows nor columns are parameters
    volume::SpaceAxis axis = volume::SpaceAxis::Z;
    int planes = 4;
    int times = 4;
    bool operator==(const SliceMatrixView&) const = default;
    /// Whether rows or columns differ in this.
    bool over(MatrixAxis what) const { return rows == what || columns == what; }
    static void describe(auto& self, auto&& visit) {
        visit(self.rows, FieldInfo{.key = "rows", .doc = "What rows differ in", .names = kMatrixAxisNames});
        visit(self.columns, FieldInfo{.key = "columns", .doc = "What columns differ in", .names = kMatrixAxisNames});
        visit(self.channels, kShownChannels);
        visit(self.axis, FieldInfo{.key = "axis",
                                   .doc = "Axis perpendicular to the planes",
                                   .names = volume::kSpaceAxisNames,
                                   .applies = !self.over(MatrixAxis::Directions)});
        visit(self.planes, FieldInfo{.key = "planes",
                                     .doc = "Number of planes, evenly spaced; without them: the plane through the "
                                            "cross-hair",
                                     .range = Range{1, 12},
                                     .applies = self.over(MatrixAxis::Positions)});
        visit(self.times, FieldInfo{.key = "times",
                                    .doc = "Number of times, evenly chosen among the stored ones",
                                    .range = Range{1, 24},
                                    .applies = self.over(MatrixAxis::Times)});
    }
};
DrawView<SliceMatrixView> drawSliceMatrixView;

/// A plane through the cross-hair, tilted in any way, seen flat.
struct ObliqueView {
    static constexpr std::string_view kType = "oblique";
    std::string channel;         ///< "" = the channel of the first layer
    glm::dvec3 normal{-1, 0, 1}; ///< in true proportions, of any length
    ContourSettings lines;
    vis::Strokes strokes = {};
    bool inSpace = true;
    bool showReadout = true;
    bool operator==(const ObliqueView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel, FieldInfo{.key = "channel", .doc = "Parameter shown", .refersTo = "channel"});
        visit(self.normal, FieldInfo{.key = "normal",
                                     .doc = "Normal of the plane through the cross-hair, in true proportions; the "
                                            "plane is seen from the side that it points to",
                                     .range = Range{-1, 1}});
        ContourSettings::describe(self.lines, visit);
        visit(self.strokes, vis::strokesField());
        visit(self.inSpace, FieldInfo{"inSpace", "Draw the slice in the volume views too"});
        visit(self.showReadout, FieldInfo{"readout", "List the value of every parameter at the cross-hair"});
    }
};
DrawView<ObliqueView> drawObliqueView;

} // namespace tessera::app
