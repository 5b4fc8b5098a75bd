#include "app/views/tesseract/tesseract_brush.h"

#include "app/pane/controls.h"
#include "app/pane/view_context.h"
#include "app/views/data/derived_list.h"
#include "app/views/tesseract/tesseract_turn.h"
#include "volume/base/number_text.h"
#include "volume/derived/derived_names.h"

#include <algorithm>
#include <cmath>
#include <string_view>
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

/// Whether a formula takes x, y, z or t as that coordinate, not as a parameter of the same name.
bool meansCoordinate(const volume::FormulaNames& names, std::string_view name) {
    bool coordinate = false;
    for (std::size_t i = 0; i < names.names.size(); ++i) // of equal names the later one is used
        if (names.names[i] == name) coordinate = names.channel[i] < 0;
    return coordinate;
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

std::array<std::string, 2> turnedFormulas(const volume::DatasetInfo& info, const TesseractFrame& frame) {
    constexpr const char* kPlaces[] = {"x", "y", "z", "t"};
    constexpr double kLeastPart = 1e-9;
    const volume::FormulaNames names(info);
    std::array<std::string, 2> formulas;
    for (int row = 0; row < 2; ++row) {
        std::string text;
        double constant = 0;
        for (int axis = 0; axis < frame.count; ++axis) {
            const TesseractAxis& own = frame.axes[std::size_t(axis)];
            const double part = frame.rotation.at(row, axis) * frame.half[std::size_t(axis)];
            const double extent = own.range.hi - own.range.lo;
            if (std::abs(part) < kLeastPart || !(extent > 0)) continue;
            if (!own.even || (!own.channel && !meansCoordinate(names, kPlaces[axis]))) return {};
            const std::string name = own.channel ? "`" + info.channel(*own.channel).name + "`" : kPlaces[axis];
            text += exactText(2 * part / extent) + " * " + name + " + ";
            constant -= part * (own.range.lo + own.range.hi) / extent;
        }
        if (text.empty()) return {};
        formulas[std::size_t(row)] = text + exactText(constant);
    }
    return formulas;
}

std::array<std::string, 2> turnedChannels(const Session& session, const volume::DatasetInfo& info,
                                          const TesseractFrame& frame) {
    std::array<std::string, 2> channels;
    const std::array<std::string, 2> formulas = turnedFormulas(info, frame);
    for (std::size_t row = 0; row < 2; ++row)
        for (const volume::DerivedParameter& own : session.data.derived) {
            const auto* recipe = std::get_if<volume::ExpressionRecipe>(&own.recipe);
            if (recipe && !formulas[row].empty() && recipe->formula == formulas[row]) channels[row] = own.name;
        }
    return channels;
}

void brushAtThisTurn(Session& session, const volume::DatasetInfo& info, TesseractView& view,
                     const TesseractFrame& frame) {
    view.parallel = true;
    view.tour = false;
    const std::array<std::string, 2> formulas = turnedFormulas(info, frame);
    constexpr const char* kNames[] = {"turned right", "turned up"};
    for (std::size_t row = 0; row < 2; ++row) {
        if (formulas[row].empty()) return;
        std::string name = kNames[row];
        const auto taken = [&] {
            return info.findChannel(name) ||
                   std::ranges::find(session.data.derived, name, &volume::DerivedParameter::name) !=
                       session.data.derived.end();
        };
        for (int number = 2; taken(); ++number) name = kNames[row] + std::string(" ") + std::to_string(number);
        addDerived(session, {.name = name, .unit = "", .recipe = volume::ExpressionRecipe{formulas[row]}});
    }
}

PlotFrame turnedPlot(const TesseractFrame& frame) {
    const auto pixel = [&](double at) { return frame.pixel(vis::project(frame.projection, 1, {at, at, 0, 0}).at); };
    const ImVec2 a = pixel(-1), b = pixel(1);
    return {{a.x, b.y}, {b.x, a.y}, {-1, 1}, {-1, 1}};
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
    std::optional<std::array<int, 2>> faced; ///< none: of the coordinates of the picture
    PlotChannels plot;                       ///< empty where parameters are missing
    PlotFrame frame{};
};
/// At a turn for which the session has the coordinates of the picture.
std::optional<BrushPlace> turnedPlace(const ViewContext& context, const TesseractFrame& frame) {
    if (!frame.projection.parallel) return std::nullopt;
    const volume::DatasetInfo& info = context.source->info();
    const std::array<std::string, 2> channels = turnedChannels(context.session, info, frame);
    if (channels[0].empty() || channels[1].empty()) return std::nullopt;
    BrushPlace out{std::nullopt, {channels[0], channels[1]}, turnedPlot(frame)};
    if (!info.findChannel(channels[0]) || !info.findChannel(channels[1])) out.plot = {};
    return out;
}
std::optional<BrushPlace> brushPlace(const ViewContext& context, const TesseractFrame& frame) {
    std::optional<std::array<int, 2>> faced;
    if (!brushRefusal(frame, faced).empty()) return turnedPlace(context, frame);
    const volume::DatasetInfo& info = context.source->info();
    BrushPlace out{*faced,
                   {brushedChannel(context.session, info, frame.axes, (*faced)[0]),
                    brushedChannel(context.session, info, frame.axes, (*faced)[1])},
                   facedPlot(frame, *faced)};
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
        if (!place->faced) return row("Brushes at this turn can be drawn once its coordinates are computed.", {});
        const std::string of = "Brushes of " + brushTitle(frame, *place->faced);
        const bool lacks = std::ranges::any_of(*place->faced, [&](int axis) {
            return !frame.axes[std::size_t(axis)].channel && placeChannel(context.session, axis).empty();
        });
        if (!lacks)
            row(of + " can be drawn once position or time are computed as parameters.", {});
        else if (row(of + " need position or time as parameters.", "Add them"))
            addBrushedChannels(context.session, info, frame.axes, *place->faced);
        return false;
    }
    std::optional<std::array<int, 2>> faced;
    const std::string refusal = brushRefusal(frame, faced);
    const auto turned = turnForBrush(frame);
    const auto nearest = turned ? vis::facedAxes(*turned) : std::nullopt;
    if (row(refusal, nearest ? "Turn to " + brushTitle(frame, *nearest) : std::string())) {
        turnToBrush(context.session, info, view, frame);
        return true;
    }
    if (turnedFormulas(info, frame)[0].empty()) return false;
    if (nearest) ImGui::SameLine();
    const bool pressed = ImGui::Button("Brush at this turn");
    if (ImGui::IsItemHovered())
        tooltip("Adds the two coordinates of the picture, in parallel projection, as parameters that brushes are of");
    if (pressed) brushAtThisTurn(context.session, info, view, frame);
    return pressed;
}

bool editTesseractBrush(ViewContext& context, BrushDrag& drag, const TesseractView& view, const TesseractFrame& frame) {
    if (view.hand == TesseractHand::Turn || view.stereo.kind == vis::StereoKind::SideBySide) return false;
    const auto place = brushPlace(context, frame);
    if (!place || place->plot.x.empty()) return false;
    editBrushes(drag, context.session.selection, place->frame, place->plot,
                {view.hand == TesseractHand::Box ? BrushTool::Rectangle : BrushTool::Lasso, 0});
    clearAfterQuestion(drag, context);
    if (drag.active) context.interacting = true;
    return true;
}

void drawTesseractBrushes(const ViewContext& context, const TesseractFrame& frame) {
    const auto place = brushPlace(context, frame);
    if (!place || place->plot.x.empty()) return;
    drawBrushes(*ImGui::GetWindowDrawList(), context.session.selection, place->frame, place->plot);
}

} // namespace tessera::app
