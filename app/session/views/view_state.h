#pragma once

#include "app/session/views/view_kind.h"
#include "app/session/views/view_state_compare.h"
#include "app/session/views/view_state_many.h"
#include "app/session/views/view_state_plots.h"
#include "app/session/views/view_state_scenes.h"

#include <array>
#include <string>
#include <tuple>
#include <variant>

/// The kinds of view: the saved state of each, a plain described struct, and the one table of all of them. To add a
/// kind: its struct, its row here, and the file in app/views that draws it.
namespace tessera::app {

struct TransferView {
    static constexpr std::string_view kType = "transfer";
    std::string channel; ///< or the name of a layer's own function; "" = that of the layer selected
    bool logHistogram = true;
    bool visibility = false;
    bool boundaries = false; ///< of a function that is a curve
    bool library = false;    ///< shows the library in place of an editor
    bool operator==(const TransferView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel,
              FieldInfo{.key = "channel",
                        .doc = "Parameter whose transfer function is edited; empty: that of the layer selected",
                        .refersTo = "channel"});
        visit(self.logHistogram, FieldInfo{"logHistogram", "Logarithmic counts"});
        visit(self.visibility, FieldInfo{"visibility", "Show which values contribute how much to the visible picture"});
        visit(self.boundaries, FieldInfo{"boundaries", "Compute the curve from boundaries, with an editable emphasis"});
        visit(self.library, FieldInfo{"library", "Show the library of transfer functions instead of an editor"});
    }
};
DrawView<TransferView> drawTransferView;

/// What the pane of the layers is used for, one at a time: a tab each.
enum class SceneTask { Layers, Brushes, Lenses, Clips, Light, Picture };
inline constexpr std::string_view kSceneTaskNames[] = {"layers", "brushes", "lenses", "clips", "light", "picture"};

struct LayersView {
    static constexpr std::string_view kType = "layers";
    int selected = 0; ///< layer whose parameters are shown
    SceneTask task = SceneTask::Layers;
    int next = -1; ///< entry of the task's list that the pane goes to and unfolds when it is drawn; -1: none
    bool operator==(const LayersView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.selected, FieldInfo{.key = "selected",
                                       .doc = "Layer whose settings are shown, counted from 0",
                                       .range = Range{0, 1000},
                                       .hidden = true});
        visit(self.task,
              FieldInfo{.key = "task",
                        .doc = "What is in front: the layers, the brushes, the lenses, the clips, the light, "
                               "or the rest of the picture",
                        .names = kSceneTaskNames,
                        .hidden = true});
        visit(self.next, FieldInfo{.key = "next",
                                   .doc = "Entry of the list in front to unfold once it is drawn, counted from 0; "
                                          "-1 = none",
                                   .range = Range{-1, 1000},
                                   .hidden = true});
    }
};
DrawView<LayersView> drawLayersView;

struct TimelineView {
    static constexpr std::string_view kType = "timeline";
    bool always = false; ///< also where there is one time
    bool operator==(const TimelineView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.always, FieldInfo{"always", "Show it also for data with one time, without keyframes"});
    }
};
DrawView<TimelineView> drawTimelineView;

/// What is in the data set, and the selection with its statistics.
struct DataView {
    static constexpr std::string_view kType = "data";
    bool operator==(const DataView&) const = default;
    static void describe(auto&, auto&&) {}
};
DrawView<DataView> drawDataView;

struct HistoryView {
    static constexpr std::string_view kType = "history";
    bool operator==(const HistoryView&) const = default;
    static void describe(auto&, auto&&) {}
};
DrawView<HistoryView> drawHistoryView;

struct LogView {
    static constexpr std::string_view kType = "log";
    bool operator==(const LogView&) const = default;
    static void describe(auto&, auto&&) {}
};
DrawView<LogView> drawLogView;

/// Every kind of view, a row for each: its struct, the function that draws it, and what else is known of it. Menus,
/// panes, documentation and tests read this table.
inline constexpr std::tuple kViewKinds{
    ViewKind<VolumeView, drawVolumeView>{{.title = "Volume",
                                          .help = "The data in space",
                                          .words = "3d rendering scene picture render",
                                          .inSpace = true,
                                          .camera = true,
                                          .padded = false,
                                          .leastWidth = 200,
                                          .leastHeight = 170}},
    ViewKind<SlicesView, drawSlicesView>{{.title = "Slices",
                                          .help = "Three orthogonal slices, with the values at the cross-hair",
                                          .words = "planes cuts sections 2d contour contours isolines",
                                          .figure = true,
                                          .csv = true,
                                          .leastWidth = 220,
                                          .leastHeight = 170}},
    ViewKind<ScatterMatrixView, drawScatterMatrixView>{
        {.title = "Scatterplots",
         .help = "Scatterplots of every pair of parameters; drag to select",
         .words = "brush selection correlation pairs",
         .figure = true,
         .csv = true,
         .leastWidth = 220,
         .leastHeight = 170}},
    ViewKind<TransferView, drawTransferView>{{.title = "Transfer function",
                                              .help = "Colours and opacity of a parameter",
                                              .words = "colormap colour color map opacity legend",
                                              .leastWidth = 210,
                                              .leastHeight = 150}},
    ViewKind<LayersView, drawLayersView>{
        {.title = "Layers",
         .help = "What the 3D views show: layers, brushes, lenses, clips, light, camera, paper, quality",
         .words = "settings lens clipping objects flow isosurface contour scene properties",
         .leastWidth = 210,
         .leastHeight = 150}},
    ViewKind<TimelineView, drawTimelineView>{{.title = "Timeline",
                                              .help = "Play through the times",
                                              .words = "animation movie video keyframes",
                                              .plays = true,
                                              .leastWidth = 220,
                                              .leastHeight = 112}},
    ViewKind<DataView, drawDataView>{{.title = "Data",
                                      .help = "Contents of the data set and of the selection",
                                      .words = "parameters variables info derived formula unit",
                                      .leastWidth = 210,
                                      .leastHeight = 150}},
    ViewKind<HistoryView, drawHistoryView>{
        {.title = "History", .help = "All edits; click to undo or redo", .words = "undo redo steps"}},
    ViewKind<LogView, drawLogView>{
        {.title = "Messages", .help = "Messages of the program", .words = "log errors warnings output"}},
    ViewKind<StatisticsView, drawStatisticsView>{
        {.title = "Statistics",
         .help = "Statistics of every parameter in the selection and in the rest",
         .words = "mean average minimum maximum numbers table",
         .figure = true,
         .csv = true,
         .leastWidth = 210,
         .leastHeight = 130},
        {.title = "Region table",
         .help = "Statistics of every parameter in every region, and balances of inflow and outflow",
         .words = "labels parts flow balance",
         .prepare = [](StatisticsView& view) { view.byRegion = true; }}},
    ViewKind<HistogramView, drawHistogramView>{{.title = "Histogram",
                                                .help = "One parameter's histogram; drag to select",
                                                .words = "distribution frequency brush",
                                                .figure = true,
                                                .csv = true,
                                                .leastWidth = 200,
                                                .leastHeight = 130}},
    ViewKind<ProbesView, drawProbesView>{{.title = "Probes",
                                          .help = "Values at places and times that you keep",
                                          .words = "points list table values cross-hair bookmarks",
                                          .figure = true,
                                          .csv = true,
                                          .leastWidth = 210,
                                          .leastHeight = 130}},
    ViewKind<ProfileView, drawProfileView>{{.title = "Line profile",
                                            .help = "Parameters along a line",
                                            .words = "plot graph chart probe cut",
                                            .figure = true,
                                            .csv = true,
                                            .leastWidth = 200,
                                            .leastHeight = 130},
                                           {.title = "Section averages",
                                            .help = "Means over planes across an axis, with one curve for each region",
                                            .words = "mean plot sections flow",
                                            .prepare = [](ProfileView& view) { view.over = ProfileOver::Sections; }}},
    ViewKind<CurvesView, drawCurvesView>{{.title = "Curves",
                                          .help = "Quantities and statistics over time, or against each other",
                                          .words = "plot graph chart time series polarisation",
                                          .figure = true,
                                          .csv = true,
                                          .leastWidth = 200,
                                          .leastHeight = 130}},
    ViewKind<SliceMatrixView, drawSliceMatrixView>{{.title = "Slice matrix",
                                                    .help = "Parameters on parallel planes",
                                                    .words = "small multiples sections contour",
                                                    .figure = true,
                                                    .csv = true,
                                                    .leastWidth = 220,
                                                    .leastHeight = 150}},
    ViewKind<ObliqueView, drawObliqueView>{
        {.title = "Oblique slice",
         .help = "A plane tilted in any way, seen flat; handles in the volume view move and tilt it",
         .words = "plane cut section 2d arbitrary angle tilted mpr reformat contour",
         .figure = true,
         .csv = true,
         .leastWidth = 220,
         .leastHeight = 170}},
    ViewKind<ShadowCubeView, drawShadowCubeView>{{.title = "Shadow cube",
                                                  .help = "Projections on the faces of a cube around the scene",
                                                  .words = "projection walls shadows",
                                                  .inSpace = true,
                                                  .leastWidth = 220,
                                                  .leastHeight = 180}},
    ViewKind<TesseractView, drawTesseractView>{{.title = "Tesseract",
                                                .help = "All times at once in four dimensions, turned in six planes",
                                                .words = "4d hypercube rotation",
                                                .inSpace = true,
                                                .leastWidth = 220,
                                                .leastHeight = 180}},
    ViewKind<ParallelCoordinatesView, drawParallelCoordinatesView>{
        {.title = "Parallel coordinates",
         .help = "An axis for each parameter, and the density of all samples between them; drag to select",
         .words = "brush selection correlation axes density many parameters",
         .figure = true,
         .csv = true,
         .leastWidth = 260,
         .leastHeight = 150}},
    ViewKind<Scatter3dView, drawScatter3dView>{
        {.title = "Scatterplot in 3D",
         .help = "Samples as a turned cloud over three parameters; drag to turn it, draw around samples to select",
         .words = "cloud density three parameters lasso brush",
         .csv = true,
         .inSpace = true,
         .leastWidth = 220,
         .leastHeight = 180}},
    ViewKind<HyperSliceView, drawHyperSliceView>{
        {.title = "HyperSlice",
         .help = "All slices through the cross-hair in space and time, with profiles on the diagonal; drag to move it",
         .words = "slices 4d time planes matrix profiles",
         .figure = true,
         .csv = true,
         .leastWidth = 240,
         .leastHeight = 200}},
    ViewKind<HierarchyView, drawHierarchyView>{
        {.title = "Hierarchy",
         .help = "The brushes as a chain: what each leaves of the ones before it, as plots, as areas and over time",
         .words = "worlds within worlds tree mosaic brushes levels drill condition filter share",
         .figure = true,
         .csv = true,
         .leastWidth = 260,
         .leastHeight = 200}},
    ViewKind<WorthSeeingView, drawWorthSeeingView>{
        {.title = "Worth seeing",
         .help = "What stands out in the data: dependences, changes, outliers; a click opens the view that shows it",
         .words = "find search ranked list interesting correlation events explore what when",
         .figure = true,
         .csv = true,
         .leastWidth = 220,
         .leastHeight = 150}},
    ViewKind<PiecesView, drawPiecesView>{
        {.title = "Pieces",
         .help = "Connected pieces over time: how they are born, merge, split and die; a click selects one",
         .words = "components blobs tracking graph births deaths merges splits bubbles drops 4d events",
         .figure = true,
         .csv = true,
         .leastWidth = 240,
         .leastHeight = 150}},
    ViewKind<CompareView, drawCompareView>{{.title = "Side by side",
                                            .help = "Compare the 3D scene with different settings",
                                            .words = "variants differences small multiples",
                                            .csv = true,
                                            .inSpace = true,
                                            .camera = true,
                                            .leastWidth = 260,
                                            .leastHeight = 200}},
};

namespace detail {
template <class... Kinds> std::variant<typename Kinds::State...> stateOf(const std::tuple<Kinds...>&);
} // namespace detail

/// The saved state of a view of any kind; the alternatives are in the order of kViewKinds.
using ViewState = decltype(detail::stateOf(kViewKinds));

/// Calls visit(kind) for each row of kViewKinds, in order.
constexpr void forEachViewKind(auto&& visit) {
    std::apply([&](const auto&... kinds) { (visit(kinds), ...); }, kViewKinds);
}

/// What is known of the kind of a view.
inline const ViewTraits& traitsOf(const ViewState& view) {
    static constexpr auto kTraits =
        std::apply([](const auto&... kinds) { return std::array{kinds.traits...}; }, kViewKinds);
    return kTraits[view.index()];
}

} // namespace tessera::app
