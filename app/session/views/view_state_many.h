#pragma once

#include "app/session/views/contour_settings.h"
#include "app/session/views/view_kind.h"
#include "app/session/views/view_state_plots.h"
#include "volume/base/data_units.h"
#include "volume/base/describe.h"

#include <glm/vec2.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// The saved state of views of many parameters and dimensions at once: parallel coordinates, clouds of three
/// parameters, slices through four dimensions, what is worth seeing, and pieces over time.
namespace tessera::app {

/// An axis for each parameter, side by side, with the density of all samples between neighbours.
struct ParallelCoordinatesView {
    static constexpr std::string_view kType = "parallelCoordinates";
    std::vector<std::string> channels; ///< from left to right; empty: every scalar and magnitude
    bool byCorrelation = false;        ///< in the order of their correlation instead
    std::vector<std::string> flipped, logarithmic;
    int bins = 128;
    bool logDensity = true;
    bool histograms = true;
    float softness = 0.05f;
    std::map<std::string, Range> zoom; ///< shown values by parameter; others: all
    std::vector<double> times;         ///< with a plot each; empty: the time shown
    bool operator==(const ParallelCoordinatesView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channels,
              FieldInfo{.key = "channels",
                        .doc = "Parameters with an axis, from left to right; empty: every scalar and magnitude",
                        .refersTo = "channel"});
        visit(self.byCorrelation,
              FieldInfo{"byCorrelation", "Order the axes so that neighbours are correlated as strongly as possible"});
        visit(self.flipped,
              FieldInfo{.key = "flipped", .doc = "Parameters whose axis points down", .refersTo = "channel"});
        visit(self.logarithmic,
              FieldInfo{.key = "logarithmic", .doc = "Parameters with a logarithmic axis", .refersTo = "channel"});
        visit(self.bins, FieldInfo{.key = "bins", .doc = "Bins along an axis", .range = Range{16, 512}});
        visit(self.logDensity, FieldInfo{"logDensity", "Logarithmic density"});
        visit(self.histograms, FieldInfo{"histograms", "Draw the histogram of each parameter on its axis"});
        visit(self.softness, FieldInfo{.key = "softness",
                                       .doc = "Soft edge of new brushes, as a share of their width",
                                       .range = Range{0, 1}});
        visit(self.zoom, FieldInfo{.key = "zoom", .doc = "Visible range of values, by parameter", .hidden = true});
        visit(self.times,
              FieldInfo{.key = "times", .doc = "Times with a plot each; empty: the time shown", .unit = kUnitOfTimes});
    }
};
DrawView<ParallelCoordinatesView> drawParallelCoordinatesView;

/// Samples as a turned cloud over three parameters.
struct Scatter3dView {
    static constexpr std::string_view kType = "scatter3d";
    std::vector<std::string> channels; ///< x, y and z; fewer: the first parameters that vary
    int bins = 64;
    bool logDensity = true;
    glm::dvec2 turn{-35, 25}; ///< degrees: about the upward axis, and up
    bool operator==(const Scatter3dView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channels, FieldInfo{.key = "channels",
                                       .doc = "Parameters along x, y and z; fewer: the first that vary",
                                       .refersTo = "channel"});
        visit(self.bins, FieldInfo{.key = "bins", .doc = "Bins along each axis", .range = Range{16, 128}});
        visit(self.logDensity, FieldInfo{"logDensity", "Logarithmic density"});
        visit(self.turn, FieldInfo{.key = "turn",
                                   .doc = "Turn of the cloud about the upward axis, and its tilt",
                                   .unit = "degrees",
                                   .range = Range{-180, 180}});
    }
};
DrawView<Scatter3dView> drawScatter3dView;

/// All 2D slices through the cross-hair in x, y, z and time (J. van Wijk and R. van Liere, HyperSlice, 1993).
struct HyperSliceView {
    static constexpr std::string_view kType = "hyperSlice";
    std::string channel;           ///< "" = the channel of the first layer
    std::vector<std::string> axes; ///< x, y, z, time, or quantities over time; empty: those with more than one place
    std::map<std::string, Range> zoom; ///< shown part of an axis, in its unit; others: all
    ContourSettings lines;
    bool operator==(const HyperSliceView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel, FieldInfo{.key = "channel", .doc = "Parameter shown", .refersTo = "channel"});
        visit(self.axes, FieldInfo{"axes", "Axes with a row and a column each: x, y, z, time, or quantities over time; "
                                           "empty: all of x, y, z and time that have more than one place"});
        visit(self.zoom, FieldInfo{.key = "zoom", .doc = "Visible part of an axis, by its name", .hidden = true});
        ContourSettings::describe(self.lines, visit);
    }
};
DrawView<HyperSliceView> drawHyperSliceView;

/// The brushes as a chain: each splits what the ones before it select, down to a plot of what is left (S. Feiner and
/// C. Beshers, Worlds within worlds, 1990).
struct HierarchyView {
    static constexpr std::string_view kType = "hierarchy";
    std::vector<std::string> next; ///< one or two parameters of the last plot; empty: the first that no brush names
    int bins = 96;
    bool logDensity = true;
    float softness = 0; ///< soft edge of new brushes, as a share of their width
    bool overTime = true;
    bool operator==(const HierarchyView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.next, FieldInfo{.key = "next",
                                   .doc = "One or two parameters of the last plot, in which the next brush is drawn; "
                                          "empty: the first that no brush names",
                                   .refersTo = "channel"});
        visit(self.bins, FieldInfo{.key = "bins", .doc = "Bins along each axis of a plot", .range = Range{16, 512}});
        visit(self.logDensity, FieldInfo{"logDensity", "Logarithmic density"});
        visit(self.softness, FieldInfo{.key = "softness",
                                       .doc = "Soft edge of new brushes, as a share of their width",
                                       .range = Range{0, 1}});
        visit(self.overTime, FieldInfo{"overTime", "Show the volume of every level over all times"});
    }
};
DrawView<HierarchyView> drawHierarchyView;

/// What the list of things worth seeing answers.
enum class WorthList { Views, WhatElse, When };
inline constexpr std::string_view kWorthListNames[] = {"views", "whatElse", "when"};

/// Dependences, changes, outliers and places worth a look, ranked, each with a number and a view that shows it.
struct WorthSeeingView {
    static constexpr std::string_view kType = "worthSeeing";
    std::vector<std::string> channels;
    WorthList list = WorthList::Views;
    bool selected = false;
    float falseDiscoveries = 0.05f;
    int most = 24;
    bool operator==(const WorthSeeingView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channels, kShownChannels);
        visit(self.list, FieldInfo{.key = "list",
                                   .doc = "Views worth opening; how parameters, places and times in the selection "
                                          "differ from the rest; or the times of greatest change",
                                   .names = kWorthListNames});
        visit(self.selected, FieldInfo{.key = "selected",
                                       .doc = "Look only at what is selected",
                                       .applies = self.list != WorthList::WhatElse});
        visit(self.falseDiscoveries,
              FieldInfo{.key = "falseDiscoveries",
                        .doc = "Share of the entries that may be there by chance (false discovery rate)",
                        .range = Range{0.001, 0.5}});
        visit(self.most, FieldInfo{.key = "most", .doc = "Entries at most", .range = Range{1, 200}});
    }
};
DrawView<WorthSeeingView> drawWorthSeeingView;

/// What makes the pieces of the graph.
enum class PiecesOf { Above, Below, Selected };
inline constexpr std::string_view kPiecesOfNames[] = {"above", "below", "selected"};

/// Connected pieces over time: how they are born, merge, split and die.
struct PiecesView {
    static constexpr std::string_view kType = "pieces";
    std::string channel; ///< "" = the channel of the first layer
    PiecesOf of = PiecesOf::Above;
    std::optional<double> value; ///< none: the middle of the parameter's range
    double leastVolume = 0;
    bool events = true;
    bool operator==(const PiecesView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel,
              FieldInfo{.key = "channel", .doc = "Parameter whose pieces are followed", .refersTo = "channel"});
        visit(self.of, FieldInfo{.key = "of",
                                 .doc = "Pieces of what is at least the value, at most, or selected by the brushes",
                                 .names = kPiecesOfNames});
        visit(self.value, FieldInfo{.key = "value",
                                    .doc = "Value that samples of pieces reach; none: the middle of the parameter's "
                                           "range",
                                    .applies = self.of != PiecesOf::Selected});
        visit(self.leastVolume,
              FieldInfo{.key = "leastVolume",
                        .doc = "Volume that a piece has when it is largest, in cubes of the unit of lengths; smaller "
                               "ones are left out",
                        .range = Range{0, 1e30}});
        visit(self.events, FieldInfo{"events", "Mark births, deaths, merges and splits"});
    }
};
DrawView<PiecesView> drawPiecesView;

} // namespace tessera::app
