#pragma once

#include "volume/describe.h"
#include "volume/space_axis.h"

#include <glm/vec3.hpp>
#include <map>
#include <string>
#include <vector>

/// The saved state of plots, tables and the matrix of slices: many parameters at once.
namespace tessera::app {

inline constexpr FieldInfo kShownChannels{
    .key = "channels", .unit = "", .doc = "Parameters shown; none: every scalar and magnitude", .refersTo = "channel"};

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
                                      .refersTo = "optionalChannel"});
        visit(self.outliers, FieldInfo{.key = "outliers", .unit = "", .doc = "Mark places where few samples lie"});
        visit(self.zoom, FieldInfo{.key = "zoom", .unit = "", .doc = "Values shown, by parameter", .hidden = true});
        visit(self.enlarged, FieldInfo{.key = "enlarged",
                                       .unit = "",
                                       .doc = "Parameters of the plot that is shown large",
                                       .refersTo = "channel",
                                       .hidden = true});
    }
};

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

/// Parameters (rows) on parallel planes (columns).
struct SliceMatrixView {
    static constexpr std::string_view kType = "sliceMatrix";
    std::vector<std::string> channels;
    volume::SpaceAxis axis = volume::SpaceAxis::Z;
    int planes = 4;
    bool operator==(const SliceMatrixView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channels, kShownChannels);
        visit(
            self.axis,
            FieldInfo{.key = "axis", .unit = "", .doc = "Axis the planes stand on", .names = volume::kSpaceAxisNames});
        visit(self.planes,
              FieldInfo{.key = "planes", .unit = "", .doc = "Planes, evenly spread", .range = Range{1, 12}});
    }
};

} // namespace tessera::app
