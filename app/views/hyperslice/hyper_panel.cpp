#include "app/views/hyperslice/hyper_panel.h"

#include "app/pane/view_parts.h"
#include "app/planes/contour_data.h"
#include "app/tools/plane_sections.h"
#include "app/ui/widgets.h"
#include "app/values/plot.h"
#include "app/views/hyperslice/hyper_page.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace tessera::app {

namespace {

constexpr int kFewPanelCells = 16, kMostPanelCells = 256, kCellStep = 8; ///< of a picture, along an edge
constexpr int kCoarser = 3;          ///< cells of the first answer are so much larger
constexpr float kSnapToTime = 0.35f; ///< em: a stored time so near is meant
constexpr ImU32 kLineInk = IM_COL32(12, 12, 12, 245), kLineHalo = IM_COL32(255, 255, 255, 110),
                kLineTextHalo = IM_COL32(255, 255, 255, 150);

/// As many cells as pixels, in steps so that a pane that is being resized keeps its answers.
int cellsFor(float pixels) {
    const int steps = static_cast<int>(std::ceil(pixels / kCellStep));
    return std::clamp(steps * kCellStep, kFewPanelCells, kMostPanelCells);
}

std::shared_ptr<const HyperValues> panelAnswer(ViewContext& context, HyperPanelState& state,
                                               const std::shared_ptr<const volume::BrickSource>& source,
                                               const HyperContent& content, const HyperPanel& panel) {
    const HyperQuery query =
        panelQuery(panel.across, panel.up, content.channels,
                   {cellsFor(panel.frame.width()), cellsFor(panel.frame.height())}, context.session, source->info());
    return state.answers.get(
        context, source, {.key = panel.key, .title = "HyperSlice", .quiet = true, .duringEdits = true, .firstLevel = 1},
        query,
        [](const auto& data, HyperQuery asked, int level, const Progress& progress) {
            if (level > 0) asked.cells = glm::max(asked.cells / kCoarser, 1);
            return readPanel(*data, asked, progress);
        },
        [](const HyperQuery& a, const HyperQuery& b) { return a.axes == b.axes && a.channels == b.channels; });
}

/// The picture over the part that it was read for: after a zoom the next one is still being read.
void drawPanelCells(ViewContext& context, HyperPanelState& state, const volume::DatasetInfo& info,
                    const HyperContent& content, const PlotFrame& frame,
                    const std::shared_ptr<const HyperValues>& values) {
    const volume::Channel own = info.channel(content.channel);
    const vis::TransferFunction& function = transferOf(context.session, own.name);
    const HyperPanelState::Look look{function, vis::effectiveRange(function, info.channelRange(own)),
                                     context.session.selection, brushSpace(context.session, info)};
    if (state.pictured != values || !(state.look == look)) {
        state.pictured = values;
        state.look = look;
        state.picture.upload(context.renderer.textures(), values->query.cells,
                             panelImage(info, context.session, content, *values));
    }
    const auto& [x, y] = values->query.shown;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddImage(textureId(state.picture.name()), frame.pixel(x.lo, y.hi), frame.pixel(x.hi, y.lo));
}

/// Lays out the lines and their values on the page, once.
void layOutLines(HyperPanelState& state, const volume::DatasetInfo& info, const HyperContent& content, bool named,
                 const PlotFrame& frame, const std::shared_ptr<const HyperValues>& values) {
    const std::array<double, 9> page{frame.min.x, frame.min.y, frame.max.x, frame.max.y,         frame.x.lo,
                                     frame.x.hi,  frame.y.lo,  frame.y.hi,  named ? em() : -em()};
    if (state.lined == values && state.page == page && state.levels == content.levels.values) return;
    state.lined = values;
    state.page = page;
    state.levels = content.levels.values;
    std::vector<PageLine> lines;
    for (const volume::ContourLine& line : panelLines(info, content, *values)) {
        PageLine& own = lines.emplace_back(PageLine{contourText(line.level, content.levels.step), {}});
        for (const glm::dvec2& point : line.points) {
            const ImVec2 at = frame.pixel(point.x, point.y);
            own.points.emplace_back(at.x, at.y);
        }
    }
    state.labels.clear();
    if (named)
        state.labels = placeLabels(
            lines, {{frame.min.x, frame.min.y},
                    {frame.max.x, frame.max.y},
                    static_cast<double>(em()),
                    [](const std::string& text) { return static_cast<double>(ImGui::CalcTextSize(text.c_str()).x); }});
    state.pieces.clear();
    for (const std::vector<glm::dvec2>& piece : linesAround(lines, state.labels)) {
        std::vector<ImVec2>& own = state.pieces.emplace_back();
        for (const glm::dvec2& point : piece)
            own.emplace_back(static_cast<float>(point.x), static_cast<float>(point.y));
    }
}

void drawPanelLines(ImDrawList& draw, const HyperPanelState& state) {
    const float width = std::max(1.2f, em() * 0.09f);
    for (const auto& [color, thick] : {std::pair{kLineHalo, width * 2.6f}, std::pair{kLineInk, width}})
        for (const std::vector<ImVec2>& piece : state.pieces)
            draw.AddPolyline(piece.data(), static_cast<int>(piece.size()), color, 0, thick);
    for (const LineLabel& label : state.labels) {
        const ImVec2 at{static_cast<float>(label.at.x), static_cast<float>(label.at.y)};
        const auto angle = static_cast<float>(label.angle);
        for (const float x : {-1.0f, 0.0f, 1.0f})
            for (const float y : {-1.0f, 0.0f, 1.0f})
                if (x != 0 || y != 0)
                    addTextTurned(draw, {at.x + x, at.y + y}, angle, kLineTextHalo, label.text.c_str());
        addTextTurned(draw, at, angle, kLineInk, label.text.c_str());
    }
}

/// Lenses and brushes where they cross a panel that is a plane of space.
void drawPanelOutlines(const ViewContext& context, const volume::DatasetInfo& info, const HyperPanel& panel) {
    const AxisPlaces &across = panel.across.along, &up = panel.up.along;
    const std::vector<PlaneSection> sections = panelSections(context.session, info, across, up);
    if (sections.empty()) return;
    const PlaneFrame frame{panel.frame,
                           planeOfPanel(context.session, info, across, up),
                           {across.perUnit, up.perUnit},
                           vis::worldFrame(info, context.session.stretch),
                           info.bounds};
    drawPlaneSections(*ImGui::GetWindowDrawList(), frame, sections);
}

/// The place under the mouse, in an axis' data; a stored time where that is near.
double placeUnder(const HyperAxis& axis, double place, double perPixel) {
    return snappedPlace(axis, std::clamp(place, axis.shown.lo, axis.shown.hi),
                        perPixel * static_cast<double>(em() * kSnapToTime));
}

void zoomAxis(HyperSliceView& view, const HyperAxis& axis, double about, double factor, double shift) {
    showPart(view, axis, zoomedPart(axis, about, factor, shift));
}

/// The wheel zooms about the mouse, the middle button pans, its double click shows all.
void zoomAxes(HyperSliceView& view, const HyperAxis& across, const HyperAxis* up, const PlotFrame& frame) {
    const ImGuiIO& io = ImGui::GetIO();
    const auto both = [&](glm::dvec2 about, double factor, glm::dvec2 shift) {
        zoomAxis(view, across, about.x, factor, shift.x);
        if (up) zoomAxis(view, *up, about.y, factor, shift.y);
    };
    if (io.MouseWheel != 0) both(frame.data(io.MousePos), std::pow(0.85, static_cast<double>(io.MouseWheel)), {0, 0});
    if (ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 0) && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0))
        both({0, 0}, 1,
             {-static_cast<double>(io.MouseDelta.x) * frame.perPixelX(),
              static_cast<double>(io.MouseDelta.y) * frame.perPixelY()});
    if (!ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Middle)) return;
    view.zoom.erase(across.key);
    if (up) view.zoom.erase(up->key);
}

/// The box of a drag within the panel.
std::pair<ImVec2, ImVec2> dragBox(const HyperDrag& drag, const PlotFrame& frame, bool profile) {
    const auto inside = [&](ImVec2 at) {
        return ImVec2{std::clamp(at.x, frame.min.x, frame.max.x), std::clamp(at.y, frame.min.y, frame.max.y)};
    };
    const ImVec2 a = inside(drag.from), b = inside(ImGui::GetIO().MousePos);
    ImVec2 lo{std::min(a.x, b.x), std::min(a.y, b.y)}, hi{std::max(a.x, b.x), std::max(a.y, b.y)};
    if (profile) lo.y = frame.min.y, hi.y = frame.max.y;
    return {lo, hi};
}

void showBox(HyperSliceView& view, const HyperDrag& drag, const HyperAxis& across, const HyperAxis* up,
             const PlotFrame& frame) {
    const auto [lo, hi] = dragBox(drag, frame, !up);
    const float least = em() * 0.4f; // a click is no box
    if (hi.x - lo.x < least || hi.y - lo.y < least) return;
    const glm::dvec2 from = frame.data({lo.x, hi.y}), to = frame.data({hi.x, lo.y});
    showPart(view, across, {from.x, to.x});
    if (up) showPart(view, *up, {from.y, to.y});
}

} // namespace

void drawHyperPanel(ViewContext& context, HyperPanelState& state,
                    const std::shared_ptr<const volume::BrickSource>& source, const HyperContent& content,
                    bool lineValues, const HyperPanel& panel) {
    const volume::DatasetInfo& info = source->info();
    const PlotFrame& frame = panel.frame;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const auto values = panelAnswer(context, state, source, content, panel);
    draw.PushClipRect(frame.min, frame.max, true);
    if (values) {
        drawPanelCells(context, state, info, content, frame, values);
        if (content.lined) {
            layOutLines(state, info, content, lineValues, frame, values);
            drawPanelLines(draw, state);
        }
    } else if (!state.answers.failure().empty()) {
        addTextWithBackdrop(draw, {frame.min.x + em() * 0.3f, frame.min.y}, {0, 0}, plotColors().faint, "no values");
        tellWhole(frame.min, frame.max, state.answers.failure(), "");
    }
    if (context.decoration.outlines) drawPanelOutlines(context, info, panel);
    if (context.decoration.cursor)
        drawCrosshair(draw, frame, placeAtCursor(panel.across, context.session, info),
                      placeAtCursor(panel.up, context.session, info), true);
    draw.PopClipRect();
    if (context.decoration.box) draw.AddRect(frame.min, frame.max, plotColors().frame);
}

void drawHyperProfile(ViewContext& context, HyperProfileState& state,
                      const std::shared_ptr<const volume::BrickSource>& source, int channel, const HyperAxis& axis,
                      const PlotFrame& frame, const std::string& key) {
    const volume::DatasetInfo& info = source->info();
    const ProfileAlongQuery query =
        profileAlongQuery(axis, channel, 2 * cellsFor(frame.width()) + 1, context.session, info);
    const auto profile = state.answers.get(
        context, source, {.key = key, .title = "HyperSlice", .quiet = true, .duringEdits = true}, query,
        [](const auto& data, const ProfileAlongQuery& asked, int, const Progress& progress) {
            return readProfileAlong(*data, asked, progress);
        },
        [](const ProfileAlongQuery& a, const ProfileAlongQuery& b) {
            return a.along == b.along && a.channel == b.channel;
        });
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.PushClipRect(frame.min, frame.max, true);
    const glm::vec3 ink = plotInk(0, darkTheme());
    const ImU32 color = ImGui::ColorConvertFloat4ToU32({ink.x, ink.y, ink.z, 1});
    std::vector<ImVec2> run;
    const auto flush = [&] {
        if (run.size() > 1)
            draw.AddPolyline(run.data(), static_cast<int>(run.size()), color, 0, std::max(1.2f, em() * 0.12f));
        if (run.size() == 1) draw.AddCircleFilled(run.front(), em() * 0.15f, color);
        run.clear();
    };
    if (profile)
        for (const glm::dvec2& point : profile->points)
            std::isfinite(point.y) ? run.push_back(frame.pixel(point.x, point.y)) : flush();
    flush();
    if (context.decoration.cursor) drawCrosshair(draw, frame, placeAtCursor(axis, context.session, info), std::nan(""));
    draw.PopClipRect();
    draw.AddRect(frame.min, frame.max, plotColors().frame);
}

void useHyperMouse(ViewContext& context, HyperSliceView& view, HyperDrag& drag, int index, const HyperAxis& across,
                   const HyperAxis* up, const PlotFrame& frame, const std::function<void()>& menu) {
    const ImGuiIO& io = ImGui::GetIO();
    ImGui::SetCursorScreenPos(frame.min);
    ImGui::PushID(index);
    mouseArea("panel", {frame.width(), frame.height()});
    const bool hovered = ImGui::IsItemHovered(), pressed = ImGui::IsItemActivated();
    if (menu && ImGui::BeginPopupContextItem("menu")) {
        menu();
        ImGui::EndPopup();
    }
    ImGui::PopID();
    if (pressed) drag = {index, io.KeyShift, io.MousePos};
    if (hovered && drag.panel < 0) {
        zoomAxes(view, across, up, frame);
        ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    }
    if (drag.panel != index) return;
    if (ImGui::IsKeyPressed(ImGuiKey_Escape)) drag = {};
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
        if (drag.box) showBox(view, drag, across, up, frame);
        drag = {};
    }
    if (drag.panel < 0) return;
    context.interacting = true;
    if (drag.box) {
        const auto [lo, hi] = dragBox(drag, frame, !up);
        ImDrawList& front = *ImGui::GetForegroundDrawList();
        front.AddRectFilled(lo, hi, plotColors().brushFill);
        front.AddRect(lo, hi, plotColors().brush);
        return;
    }
    const volume::DatasetInfo& info = context.source->info();
    const glm::dvec2 at = frame.data(io.MousePos);
    goToPlace(across, placeUnder(across, at.x, frame.perPixelX()), context.session, info);
    if (up) goToPlace(*up, placeUnder(*up, at.y, frame.perPixelY()), context.session, info);
}

} // namespace tessera::app
