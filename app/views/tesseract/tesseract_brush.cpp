#include "app/views/tesseract/tesseract_brush.h"

#include "app/pane/controls.h"
#include "app/pane/view_context.h"
#include "app/views/data/derived_list.h"
#include "app/views/tesseract/tesseract_turn.h"

#include <algorithm>
#include <variant>

namespace tessera::app {

namespace {

template <class Recipe> std::string derivedNamed(const Session& session) {
    for (const volume::DerivedParameter& own : session.data.derived)
        if (std::holds_alternative<Recipe>(own.recipe)) return own.name;
    return {};
}

/// The name that an axis without a parameter has as one, "" where the session has none.
std::string placeChannel(const Session& session, int axis) {
    if (axis == 3) return derivedNamed<volume::TimeRecipe>(session);
    const std::string position = derivedNamed<volume::PositionRecipe>(session);
    return position.empty() ? position : position + "." + "xyz"[axis];
}

template <class Recipe> std::size_t recipeKind() {
    for (std::size_t kind = 0; kind < volume::kDerivedKinds; ++kind)
        if (std::holds_alternative<Recipe>(volume::recipeOfKind(kind))) return kind;
    return 0;
}

/// The nearest turn in which brushes can be drawn; nothing where fewer than two axes are to scale.
std::optional<vis::RotationN> turnForBrush(const TesseractFrame& frame) {
    std::vector<int> even;
    for (int axis = 0; axis < frame.count; ++axis)
        if (frame.axes[std::size_t(axis)].even) even.push_back(axis);
    if (even.size() < 2) return std::nullopt;
    return vis::nearestFaced(frame.rotation, frame.count, even);
}

std::string brushTitle(const TesseractFrame& frame, std::array<int, 2> faced) {
    return frame.axes[std::size_t(faced[0])].name + " and " + frame.axes[std::size_t(faced[1])].name;
}

} // namespace

std::string brushRefusal(const TesseractFrame& frame, std::optional<std::array<int, 2>>& faced) {
    faced = vis::facedAxes(frame.rotation);
    if (!faced || !frame.projection.parallel)
        return "A box in the picture is one of the data only where two axes lie along the picture's, in parallel "
               "projection.";
    for (const int axis : *faced)
        if (!frame.axes[std::size_t(axis)].even)
            return "The axis " + frame.axes[std::size_t(axis)].name +
                   " is drawn by cells, which differ in width: brushes are drawn along axes that are to scale.";
    return {};
}

std::string brushedChannel(const Session& session, const volume::DatasetInfo& info,
                           const std::vector<TesseractAxis>& axes, int axis) {
    const std::optional<int>& own = axes[std::size_t(axis)].channel;
    const std::string name = own ? info.channel(*own).name : placeChannel(session, axis);
    return info.findChannel(name) ? name : std::string();
}

void addBrushedChannels(Session& session, const volume::DatasetInfo& info, const std::vector<TesseractAxis>& axes,
                        std::array<int, 2> faced) {
    for (const int axis : faced) {
        if (axes[std::size_t(axis)].channel) continue;
        addDerived(
            session,
            newDerived(info, axis == 3 ? recipeKind<volume::TimeRecipe>() : recipeKind<volume::PositionRecipe>(), {}));
    }
}

PlotFrame facedPlot(const TesseractFrame& frame, std::array<int, 2> faced) {
    vis::PointN lo = frame.half, hi = frame.half;
    for (double& each : lo) each = -each;
    const ImVec2 a = frame.pixel(frame.project(lo).at), b = frame.pixel(frame.project(hi).at);
    // The other axes are seen along, so that any corner of theirs is at the same place.
    return {{a.x, b.y}, {b.x, a.y}, frame.axes[std::size_t(faced[0])].range, frame.axes[std::size_t(faced[1])].range};
}

void turnToBrush(Session& session, const volume::DatasetInfo& info, TesseractView& view, const TesseractFrame& frame) {
    const auto faced = turnForBrush(frame);
    if (!faced) return;
    setAngles(view, vis::anglesOf(*faced, frame.count));
    view.parallel = true;
    view.tour = false;
    if (const auto two = vis::facedAxes(*faced)) addBrushedChannels(session, info, frame.axes, *two);
}

namespace {

/// What a brush would be of; nothing where none can be drawn.
struct BrushPlace {
    std::array<int, 2> faced{};
    PlotChannels plot; ///< empty where parameters are missing
};
std::optional<BrushPlace> brushPlace(const ViewContext& context, const TesseractFrame& frame) {
    std::optional<std::array<int, 2>> faced;
    if (!brushRefusal(frame, faced).empty()) return std::nullopt;
    const volume::DatasetInfo& info = context.source->info();
    BrushPlace out{*faced,
                   {brushedChannel(context.session, info, frame.axes, (*faced)[0]),
                    brushedChannel(context.session, info, frame.axes, (*faced)[1])}};
    if (out.plot.x.empty() || out.plot.y.empty()) out.plot = {};
    return out;
}

} // namespace

bool drawBrushRow(ViewContext& context, TesseractView& view, const TesseractFrame& frame) {
    if (view.hand == TesseractHand::Turn || !context.takesInput()) return false;
    const auto row = [&](const std::string& text, const std::string& button) {
        ImGui::TextWrapped("%s", text.c_str());
        return !button.empty() && ImGui::Button(button.c_str());
    };
    const volume::DatasetInfo& info = context.source->info();
    if (const auto place = brushPlace(context, frame)) {
        if (!place->plot.x.empty()) return false;
        const std::string of = "Brushes of " + brushTitle(frame, place->faced);
        const bool lacks = std::ranges::any_of(place->faced, [&](int axis) {
            return !frame.axes[std::size_t(axis)].channel && placeChannel(context.session, axis).empty();
        });
        if (!lacks)
            row(of + " can be drawn once position or time are computed as parameters.", {});
        else if (row(of + " need position or time as parameters.", "Add them"))
            addBrushedChannels(context.session, info, frame.axes, place->faced);
        return false;
    }
    std::optional<std::array<int, 2>> faced;
    const std::string refusal = brushRefusal(frame, faced);
    const auto turned = turnForBrush(frame);
    const auto nearest = turned ? vis::facedAxes(*turned) : std::nullopt;
    if (!row(refusal, nearest ? "Turn to " + brushTitle(frame, *nearest) : std::string())) return false;
    turnToBrush(context.session, info, view, frame);
    return true;
}

bool editTesseractBrush(ViewContext& context, BrushDrag& drag, const TesseractView& view, const TesseractFrame& frame) {
    if (view.hand == TesseractHand::Turn || view.stereo.kind == vis::StereoKind::SideBySide) return false;
    const auto place = brushPlace(context, frame);
    if (!place || place->plot.x.empty()) return false;
    editBrushes(drag, context.session.selection, facedPlot(frame, place->faced), place->plot,
                {view.hand == TesseractHand::Box ? BrushTool::Rectangle : BrushTool::Lasso, 0});
    clearAfterQuestion(drag, context);
    if (drag.active) context.interacting = true;
    return true;
}

void drawTesseractBrushes(const ViewContext& context, const TesseractFrame& frame) {
    const auto place = brushPlace(context, frame);
    if (!place || place->plot.x.empty()) return;
    drawBrushes(*ImGui::GetWindowDrawList(), context.session.selection, facedPlot(frame, place->faced), place->plot);
}

} // namespace tessera::app
