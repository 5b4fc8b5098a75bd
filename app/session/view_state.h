#pragma once

#include "app/session/view_state_compare.h"
#include "app/session/view_state_plots.h"
#include "app/session/view_state_scenes.h"

#include <string>
#include <variant>

/// The saved state of each kind of view: plain described structs, one per kind. How a view draws itself is in
/// app/views.
namespace tessera::app {

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

using ViewState = std::variant<VolumeView, SlicesView, ScatterMatrixView, TransferView, LayersView, TimelineView,
                               DataView, HistoryView, LogView, StatisticsView, HistogramView, ProfileView,
                               SliceMatrixView, ShadowCubeView, TesseractView, CompareView, CurvesView>;

} // namespace tessera::app
