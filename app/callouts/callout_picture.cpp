#include "app/callouts/callout_picture.h"

#include "app/callouts/callout_plots.h"
#include "app/callouts/callout_slice.h"
#include "app/pane/axes3d.h"
#include "app/pane/scale_bar.h"
#include "app/pane/view_parts.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "app/ui/widgets.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tessera::app {

namespace {

/// Room of the colour bar at the lower end of a box, 0 where that is too low.
float barRoom(const PictureBox& inner) {
    const float height = legendBarHeight() + em() * 0.5f;
    return inner.size.y > height * 3.2f && inner.size.x > em() * 7 ? height : 0;
}

PictureBox withoutBar(const PictureBox& inner) {
    return {inner.min, {inner.size.x, inner.size.y - barRoom(inner)}};
}

void drawBarBelow(const PictureBox& inner, LegendEntry entry) {
    const float room = barRoom(inner);
    if (!(room > 0)) return;
    const float width = std::min(inner.size.x - em() * 2.4f, em() * 20);
    drawLegendBar(*ImGui::GetWindowDrawList(),
                  {inner.min.x + (inner.size.x - width) / 2, inner.max().y - room + em() * 0.2f}, width, entry);
}

/// The first bar of the layers that a scene has of its own.
std::optional<LegendEntry> ownBar(const ViewContext& context, const Callout& callout) {
    if (!callout.layers) return std::nullopt;
    for (LegendEntry& entry : sceneLegends(context.session, context.source->info()))
        if (!entry.swatch && !entry.glyph && entry.names.empty()) return std::move(entry);
    return std::nullopt;
}

/// What the visible layers show, as in legends: "T [K]", "T surface 354 K"; those of a lens alone, or of all if it is
/// "".
std::string contentText(const ViewContext& context, const std::string& lens) {
    const volume::DatasetInfo& info = context.source->info();
    std::string text;
    for (const vis::Layer& layer : context.session.layers) {
        if (!layer.visible || (!lens.empty() && layer.lens != lens)) continue;
        const auto channel = info.findChannel(vis::shownChannel(layer.technique));
        const bool volume = std::holds_alternative<vis::VolumeLayer>(layer.technique);
        text += (text.empty() ? "" : ", ") +
                (volume && channel ? titleWithUnit(info.channel(*channel).name, info.channel(*channel).unit)
                                   : layerTitle(layer, info));
    }
    return text;
}

glm::vec2 ndcOf(const PictureBox& box, ImVec2 at) {
    return {2 * (at.x - box.min.x) / box.size.x - 1, 1 - 2 * (at.y - box.min.y) / box.size.y};
}

bool turnScene(ViewContext& context, const CalloutPart& shown) {
    Callout& callout = shown.callout;
    mouseArea("scene", shown.inner.size);
    const ImGuiIO& io = ImGui::GetIO();
    const bool hovered = ImGui::IsItemHovered();
    bool changed = false;
    if (ImGui::IsItemActive() && !ImGui::IsItemActivated()) {
        context.interacting = true;
        const glm::vec2 from = ndcOf(shown.inner, shown.state.last), to = ndcOf(shown.inner, io.MousePos);
        vis::Camera& view = context.session.camera;
        vis::Camera own = calloutCamera(view, callout, shown.place, shown.inner.aspect());
        vis::orbit(own, from, to);
        if (io.KeyCtrl)
            view.orientation = glm::normalize(glm::conjugate(glm::normalize(callout.turn)) * own.orientation);
        else if (from != to)
            callout.turn = glm::normalize(own.orientation * glm::conjugate(glm::normalize(view.orientation)));
        changed = true;
    }
    shown.state.last = io.MousePos;
    if (hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) callout.turn = glm::quat(1, 0, 0, 0);
    if (hovered && io.MouseWheel != 0) {
        callout.zoom = std::clamp(callout.zoom * std::pow(1.15f, io.MouseWheel), 0.2f, 10.0f);
        changed = true;
    }
    if (hovered) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    return changed;
}

bool useSlice(ViewContext& context, const CalloutPart& shown) {
    const auto slice = calloutSlice(context, shown.callout, shown.place, withoutBar(shown.inner));
    if (!slice) return false;
    const glm::dvec3 before = context.session.cursor;
    useMouse(context, shown.state.plane, slice->picture, slice->frame);
    const ImGuiIO& io = ImGui::GetIO();
    if (ImGui::IsItemHovered() && io.MouseWheel != 0 && shown.place.normal)
        stepAcross(context.session, context.source->info(), slice->picture,
                   double(io.MouseWheel * (io.KeyShift ? 10.0f : 1.0f)));
    return shown.state.plane.dragging || context.session.cursor != before;
}

/// A scale bar in the lower left corner of a picture that is large enough. `height`: of what the camera sees, pixels.
void drawLength(const ViewContext& context, const PictureBox& box, const vis::Camera& camera, float height) {
    const volume::DatasetInfo& info = context.source->info();
    const Session& session = context.session;
    if (!context.decoration.scaleBar || box.size.x < em() * 8 || info.timeAxis()) return;
    const ScaleBar bar = scaleBar(camera, vis::worldFrame(info, session.stretch), session.stretch, info.lengthUnit,
                                  height, std::min(em() * 6, box.size.x * 0.45f));
    const float width = std::max(bar.pixels, ImGui::CalcTextSize(bar.text.c_str()).x);
    if (bar.pixels >= em() && width < box.size.x - em())
        drawScaleBar(*ImGui::GetWindowDrawList(), {box.min.x + em() * 0.5f, box.max().y - em() * 0.4f}, bar);
}

void drawScene(ViewContext& context, const CalloutPart& shown, const vis::Scene& view, bool moving) {
    const volume::DatasetInfo& info = context.source->info();
    const vis::WorldFrame world = vis::worldFrame(info, context.session.stretch);
    const auto bar = ownBar(context, shown.callout);
    const PictureBox box = bar ? withoutBar(shown.inner) : shown.inner;
    const bool own = shown.callout.layers || shown.callout.time;
    const vis::Scene scene = calloutScene(own ? shown.state.scene.get(context, shown.key, moving) : view, shown.callout,
                                          shown.place, world, box.aspect());
    vis::FrameRequest request;
    request.size = {std::max(1.0f, box.size.x), std::max(1.0f, box.size.y)};
    request.moving = moving;
    request.wait = context.headless;
    request.budgetMs = double(scene.render.limits.frameTime) * shown.share;
    if (!shown.state.target) shown.state.target = context.renderer.makeTarget();
    const vis::FrameStatus status = context.renderer.render(*shown.state.target, scene, request);
    context.answers.follow(status);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    addPicture(draw, status.texture, box.min, box.max());
    if (bar) drawBarBelow(shown.inner, *bar);
    const glm::dvec3 cursor = world.toWorld(context.session.cursor);
    if (context.decoration.cursor &&
        (shown.place.normal || glm::distance(cursor, shown.place.center) <= shown.place.radius()))
        if (const auto at = spaceFrame(box.min, box.max(), scene.camera, info, context.session.stretch)
                                .pixel(context.session.cursor))
            draw.AddCircle(*at, em() * 0.35f, plotColors().cursor, 0, std::max(1.0f, em() * 0.1f));
    drawLength(context, box, scene.camera, box.size.y);
}

/// As the picture of a slice is seen.
vis::Camera sliceCamera(const PlanePicture& picture, const vis::WorldFrame& world) {
    if (picture.axes) return vis::planeCamera(picture.axes->right, picture.axes->up, world);
    const auto& [at, right, up] = picture.plane;
    const FlatAxes axes{right, up, {glm::length(right * world.scale), glm::length(up * world.scale)}};
    const glm::dvec2 middle{(picture.x.lo + picture.x.hi) / 2, (picture.y.lo + picture.y.hi) / 2};
    return flatCamera(axes, picture.plane.placeAt(middle), picture.y.hi - picture.y.lo, world);
}

void drawSlice(ViewContext& context, const CalloutPart& shown) {
    const auto slice = calloutSlice(context, shown.callout, shown.place, withoutBar(shown.inner));
    if (!slice) return;
    drawPicture(context, shown.state.plane, slice->picture, slice->frame, shown.share, shown.key);
    drawOver(context, shown.state.plane, slice->picture, slice->frame, shown.key);
    const PlotFrame& plot = slice->frame.plot;
    drawLength(context, {plot.min, {plot.width(), plot.height()}}, sliceCamera(slice->picture, slice->frame.world),
               plot.height());
    drawBarBelow(shown.inner, legendOf(context.session, context.source->info(), slice->picture.shows.channel));
}

} // namespace

std::string calloutTitle(const ViewContext& context, const Callout& callout, const CalloutPlace& place, float width) {
    const Session& session = context.session;
    const volume::DatasetInfo& info = context.source->info();
    std::string what, where = place.name, when;
    if (callout.kind == CalloutKind::Scene) {
        if (callout.layers || callout.of == CalloutOf::Lens)
            what = contentText(context, callout.layers ? std::string() : callout.placeholder);
    } else if (callout.kind != CalloutKind::Numbers) {
        if (const auto channel = resolveChannel(info, session, callout.channel))
            what = titleWithUnit(info.channel(*channel).name, info.channel(*channel).unit);
    }
    if (place.axis) {
        const int axis = static_cast<int>(*place.axis);
        const LengthUnit unit = axisLabels(session, info)[std::size_t(axis)].unit;
        where = place.name + " = " +
                formatQuantity(session.cursor[axis] * unit.perUnit, unit.name,
                               tellingLength(info, axis, session.cursor, 0.01) * unit.perUnit);
    }
    if (info.times.size() > 1 && !info.timeAxis()) when = timeValueText(info, session.time);
    if (!callout.name.empty()) what = callout.name, where.clear();
    const auto joined = [](std::initializer_list<std::string> parts) {
        std::string text;
        for (const std::string& part : parts)
            if (!part.empty()) text += (text.empty() ? "" : ", ") + part;
        return text;
    };
    const std::string shortest = what.empty() ? where : what;
    if (callout.time) // it differs from that of the view
        return firstThatFits({joined({what, where, when}), joined({what, when}), joined({shortest, when})}, width);
    return firstThatFits({joined({what, where, when}), joined({what, where}), shortest}, width);
}

bool useCallout(ViewContext& context, const CalloutPart& shown) {
    if (shown.inner.size.x < 4 || shown.inner.size.y < 4) return false;
    ImGui::SetCursorScreenPos(shown.inner.min);
    const ShownCallout own(context.session, shown.callout);
    if (shown.callout.kind == CalloutKind::Scene) return turnScene(context, shown);
    return shown.callout.kind == CalloutKind::Slice && useSlice(context, shown);
}

void drawCallout(ViewContext& context, const CalloutPart& shown, const vis::Scene& view, bool moving) {
    if (shown.inner.size.x < 4 || shown.inner.size.y < 4) return;
    const ShownCallout own(context.session, shown.callout);
    switch (shown.callout.kind) {
    case CalloutKind::Scene:
        return drawScene(context, shown, view, moving);
    case CalloutKind::Slice:
        return drawSlice(context, shown);
    case CalloutKind::Histogram:
        return drawCalloutHistogram(context, shown);
    case CalloutKind::Profile:
        return drawCalloutProfile(context, shown);
    case CalloutKind::Numbers:
        return drawCalloutNumbers(context, shown);
    }
}

} // namespace tessera::app
