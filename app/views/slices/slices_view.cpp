#include "app/pane/axes3d.h"
#include "app/pane/view_parts.h"
#include "app/queries/readout.h"
#include "app/tools/brush_list.h"
#include "app/tools/lens_outline.h"
#include "app/tools/profile_line.h"
#include "app/tools/space_handles.h"
#include "app/ui/ticks.h"
#include "app/ui/widgets.h"
#include "app/views/slices/contour_lines.h"
#include "app/views/slices/slice_figure.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tessera::app {

namespace {

struct SlicesCache : ViewCache {
    std::array<vis::ViewTargetPtr, 3> targets;
    int dragging = -1;
    int lens = -1; ///< being dragged instead of the cursor
    std::array<HandleDrag, 3> handles;
    std::array<ContourCache, 3> contours;
    Readout readout;
};

/// Size of the first of two columns or rows whose plots share `room` in proportion to the box, none too narrow to
/// read; each has `around` pixels of axes besides.
float split(double first, double second, float room, float around, double least) {
    const double share = first + second > 0 ? first / (first + second) : 0.5;
    const float plots = std::max(0.0f, room - 2 * around);
    return std::round(around + plots * static_cast<float>(std::clamp(share, least, 1 - least)));
}

/// Moves the cursor along an axis by one sample and keeps it inside.
void stepCursor(Session& session, const volume::DatasetInfo& info, int axis, float steps) {
    const double cell = info.lattice.spacing[axis] * (info.lattice.kind == volume::LatticeKind::BCC ? 0.5 : 1);
    session.cursor[axis] = std::clamp(session.cursor[axis] + cell * static_cast<double>(steps), info.bounds.lo[axis],
                                      info.bounds.hi[axis]);
}

/// The pinned lens whose middle is at a pixel of a slice, -1 if none; later ones lie over those before them.
int lensAt(const Session& session, const PlotFrame& frame, const SliceAxes& plane, glm::dvec2 perUnit, ImVec2 mouse) {
    for (int i = static_cast<int>(session.lenses.size()) - 1; i >= 0; --i) {
        const vis::Lens& lens = session.lenses[static_cast<std::size_t>(i)];
        const ImVec2 at = frame.pixel(lens.center[plane.right] * perUnit.x, lens.center[plane.up] * perUnit.y);
        if (lens.enabled && !lens.followsCursor && std::hypot(at.x - mouse.x, at.y - mouse.y) < em() * 0.7f) return i;
    }
    return -1;
}

/// Lenses with layers of their own show these layers' parameters in their section, others nothing.
void addInnerSlices(vis::Scene& scene, const Session& session, const vis::SliceLayer& like) {
    std::erase_if(scene.lenses, [&](const vis::Lens& lens) {
        return lens.effect != vis::LensEffect::Replace || lens.shape == vis::LensShape::Disc ||
               std::none_of(session.layers.begin(), session.layers.end(),
                            [&](const vis::Layer& layer) { return layer.visible && layer.lens == lens.name; });
    });
    for (const vis::Lens& lens : scene.lenses)
        for (const vis::Layer& layer : session.layers) {
            if (!layer.visible || layer.lens != lens.name) continue;
            vis::SliceLayer inner = like;
            inner.channel = std::visit([](const auto& own) { return own.channel; }, layer.technique);
            scene.layers.push_back({layer.name, true, inner, layer.lens, layer.transfer, layer.timeShift});
        }
}

/// The contour lines that the view draws instead of the renderer: those of another parameter and those with labels.
struct DrawnContours {
    std::optional<int> channel; ///< nothing: none
    ContourLevels levels;
};

void drawPlane(ViewContext& context, SlicesCache& cache, const std::string& pane, const SlicesView& view,
               const std::string& channel, const DrawnContours& lines, int index, ImVec2 min, ImVec2 max) {
    const SliceAxes& plane = kSlicePlanes[index];
    const volume::DatasetInfo& info = context.source->info();
    Session& session = context.session;
    const vis::WorldFrame world = vis::worldFrame(info.bounds, session.stretch);
    const PlotColors colors = plotColors();
    ImDrawList& draw = *ImGui::GetWindowDrawList();

    const glm::dvec3 size = info.bounds.size();
    const AxisLabels labels = axisLabels(session, info);
    const auto& [nameX, unitX] = labels[static_cast<std::size_t>(plane.right)];
    const auto& [nameY, unitY] = labels[static_cast<std::size_t>(plane.up)];
    const auto& [nameN, unitN] = labels[static_cast<std::size_t>(plane.normal)];
    const Range rangeX{info.bounds.lo[plane.right] * unitX.perUnit, info.bounds.hi[plane.right] * unitX.perUnit};
    const Range rangeY{info.bounds.lo[plane.up] * unitY.perUnit, info.bounds.hi[plane.up] * unitY.perUnit};

    // Slices below each other begin at the same pixel, whatever their numbers.
    const LengthUnit& unitZ = labels[2].unit;
    const Range rangeZ{info.bounds.lo.z * unitZ.perUnit, info.bounds.hi.z * unitZ.perUnit};
    const float left = std::max(axisRoom(AxisSide::Left, rangeY, false), axisRoom(AxisSide::Left, rangeZ, false));
    const float bottom = axisRoom(AxisSide::Bottom, rangeX, false);
    const ImVec2 lo{min.x + left, min.y + em() * 1.35f}, hi{max.x - em() * 0.8f, max.y - bottom};
    // The head line names the slice and its place, in the colour of the axis it is perpendicular to.
    const std::string place = std::string(nameN) + " = " +
                              formatQuantity(session.cursor[plane.normal] * unitN.perUnit, unitN.name,
                                             size[plane.normal] * unitN.perUnit / 1000);
    const Decoration& shown = context.decoration;
    if (shown.title)
        draw.AddText({std::round(hi.x - ImGui::CalcTextSize(place.c_str()).x), min.y}, axisColor(plane.normal),
                     place.c_str());
    if (hi.x - lo.x < em() * 2 || hi.y - lo.y < em() * 2) return;
    const double worldX = world.halfSize[plane.right], worldY = world.halfSize[plane.up];
    if (!(worldX > 0) || !(worldY > 0)) {
        const std::string text = std::string("no extent along ") + (worldX > 0 ? nameY : nameX);
        draw.AddText({lo.x, lo.y}, colors.faint, text.c_str());
        return;
    }
    const double scale = std::min((hi.x - lo.x) / worldX, (hi.y - lo.y) / worldY);
    const glm::ivec2 pixels(std::max(1.0, std::floor(worldX * scale)), std::max(1.0, std::floor(worldY * scale)));
    const ImVec2 corner{std::floor(lo.x), std::floor(lo.y)};
    const PlotFrame frame{corner,
                          {corner.x + static_cast<float>(pixels.x), corner.y + static_cast<float>(pixels.y)},
                          paddedRange(rangeX),
                          paddedRange(rangeY)};

    ImGui::SetCursorScreenPos(frame.min);
    ImGui::PushID(index);
    ImGui::InvisibleButton("plane", {frame.width(), frame.height()});
    if (ImGui::BeginPopupContextItem("menu")) {
        drawBrushMenu(context);
        ImGui::EndPopup();
    }
    ImGui::PopID();
    const ImGuiIO& io = ImGui::GetIO();
    HandleDrag& handles = cache.handles[static_cast<std::size_t>(index)];
    const glm::dvec2 perUnit(unitX.perUnit, unitY.perUnit);
    const bool onHandle = editHandles(handles, session, info, frame, plane.right, plane.up, perUnit,
                                      ImGui::IsItemHovered() && cache.dragging < 0);
    if (onHandle) context.interacting = true;
    if (ImGui::IsItemActivated() && !onHandle) {
        cache.dragging = index;
        cache.lens = lensAt(session, frame, plane, {unitX.perUnit, unitY.perUnit}, io.MousePos);
    }
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) cache.dragging = -1;
    if (cache.dragging == index && cache.lens >= 0 && cache.lens < static_cast<int>(session.lenses.size())) {
        const glm::dvec2 at = frame.data(io.MousePos);
        glm::dvec3& center = session.lenses[static_cast<std::size_t>(cache.lens)].center;
        center[plane.right] =
            std::clamp(at.x / unitX.perUnit, info.bounds.lo[plane.right], info.bounds.hi[plane.right]);
        center[plane.up] = std::clamp(at.y / unitY.perUnit, info.bounds.lo[plane.up], info.bounds.hi[plane.up]);
        context.interacting = true;
    } else if (cache.dragging == index) {
        const glm::dvec2 at = frame.data(io.MousePos);
        session.cursor[plane.right] =
            std::clamp(at.x / unitX.perUnit, info.bounds.lo[plane.right], info.bounds.hi[plane.right]);
        session.cursor[plane.up] = std::clamp(at.y / unitY.perUnit, info.bounds.lo[plane.up], info.bounds.hi[plane.up]);
        context.interacting = true;
    }
    if (ImGui::IsItemHovered()) {
        ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
        if (io.MouseWheel != 0) stepCursor(session, info, plane.normal, io.MouseWheel * (io.KeyShift ? 10.0f : 1.0f));
    }

    vis::Scene scene = sceneWithLimits(context);
    scene.paper.reset();
    scene.camera = vis::planeCamera(plane.right, plane.up, world);
    scene.showBox = false;
    vis::SliceLayer layer;
    layer.channel = channel;
    layer.orientation = static_cast<vis::SliceOrientation>(plane.normal);
    if (view.contourOf.empty() && !view.contourValues) layer.contours = view.contours;
    scene.layers = {vis::Layer{"slice", true, layer}};
    addInnerSlices(scene, session, layer);
    // Only the place along the normal matters: dragging within a slice leaves its picture as it is.
    for (int axis : {plane.right, plane.up}) scene.cursor[axis] = info.bounds.center()[axis];
    vis::ViewTargetPtr& target = cache.targets[static_cast<std::size_t>(index)];
    if (!target) target = context.renderer.makeTarget();
    vis::FrameRequest request;
    request.size = pixels;
    request.moving = !context.headless && (context.interacting || session.animation.playing);
    // Three pictures share a frame, and in motion leave half of it to those in space.
    request.budgetMs = scene.render.limits.frameTime / (request.moving ? 6.0 : 3.0);
    request.wait = context.headless;
    const vis::FrameStatus status = context.renderer.render(*target, scene, request);
    context.follow(status);
    addPicture(draw, status.texture, frame.min, frame.max);
    if (shown.box) draw.AddRect(frame.min, frame.max, colors.frame);
    if (shown.axes) {
        drawAxis(draw, frame, AxisSide::Bottom, nameX, unitX.name, min.x, std::min(max.x, frame.max.x + em() * 4),
                 {.inlineTitle = true});
        drawAxis(draw, frame, AxisSide::Left, nameY, unitY.name, min.y, max.y, {.inlineTitle = true, .room = left});
    }
    draw.PushClipRect(frame.min, frame.max, true);
    if (lines.channel)
        drawContours(context, cache.contours[static_cast<std::size_t>(index)],
                     "contours " + pane + std::to_string(index),
                     {*lines.channel, plane, session.cursor[plane.normal],
                      volume::timesAround(info.times, session.time), lines.levels.values},
                     lines.levels.step, view.contourValues, frame, perUnit);
    if (shown.outlines) {
        drawBrushSections(draw, frame, session.selection, plane.right, plane.up, plane.normal,
                          session.cursor[plane.normal], perUnit);
        drawLensSections(draw, frame, session, info, plane.right, plane.up, plane.normal, session.cursor[plane.normal],
                         perUnit);
        drawProfileLines(draw, frame, session, plane.right, plane.up, perUnit);
        drawHandles(draw, handles, frame, session, info, plane.right, plane.up, perUnit);
    }
    if (shown.cursor)
        drawCrosshair(draw, frame, session.cursor[plane.right] * unitX.perUnit,
                      session.cursor[plane.up] * unitY.perUnit);
    draw.PopClipRect();
}

/// Chooses the parameter of the lines, and whether they are labelled.
void chooseContours(const volume::DatasetInfo& info, SlicesView& view) {
    continueLine(em() * 8);
    ImGui::SetNextItemWidth(em() * 8);
    ImGui::SliderInt("##contours", &view.contours, 0, 50, view.contours == 0 ? "no contours" : "%d contours");
    if (ImGui::IsItemHovered())
        tooltip("Number of contour lines over the colour range; of another parameter, or with values, at most this "
                "many at round values");
    if (view.contours == 0) return;
    continueLine(em() * 8);
    ImGui::SetNextItemWidth(em() * 8);
    chooseChannel("##contourOf", &info, view.contourOf, "same parameter");
    if (ImGui::IsItemHovered()) tooltip("Parameter of the contour lines");
    continueLine(buttonWidth("values") + em());
    ImGui::Checkbox("values", &view.contourValues);
    if (ImGui::IsItemHovered()) tooltip("Draw the lines at round values, labelled with them");
}

/// The line below the legend that says what the contour lines are.
std::string contourNote(const volume::DatasetInfo& info, const SlicesView& view, const DrawnContours& lines) {
    if (view.contours == 0 || (view.contourOf.empty() && !view.contourValues)) return {};
    if (lines.channel) return contourTitle(info.channel(*lines.channel), lines.levels);
    return "no contour lines: " +
           (info.findChannel(view.contourOf) ? "labels have none" : "there is no " + view.contourOf);
}

} // namespace

void drawSlicesView(ViewContext& context, const std::string& pane, SlicesView& view) {
    if (!context.source) {
        drawHint("No data", "Shows three slices through the cross-hair.");
        return;
    }
    const volume::DatasetInfo& info = context.source->info();
    const auto channel = resolveChannel(info, context.session, view.channel);
    if (!channel) {
        drawHint("No parameters", "This data set has no parameter to show.");
        return;
    }
    SlicesCache& cache = cacheOf<SlicesCache>(context, pane);
    std::string name = info.channel(*channel).name;
    if (!context.figure) {
        ImGui::SetNextItemWidth(std::min(em() * 11, ImGui::GetContentRegionAvail().x * 0.4f));
        if (chooseChannel("##channel", &info, name)) view.channel = name;
        if (ImGui::IsItemHovered()) tooltip("Parameter that colours the slices");
        chooseContours(info, view);
        continueLine(buttonWidth("Export"));
        exportMenu(
            context, "slices",
            [source = context.numbers, session = context.session, view, channel = *channel](const Progress& progress) {
                return slicesSvg(*source, session, view, channel, progress);
            },
            nullptr);
    }
    DrawnContours lines;
    if (!view.contourOf.empty() || view.contourValues) lines.channel = contourChannel(info, view, *channel);
    if (lines.channel) lines.levels = contourLevels(context.session, info, *lines.channel, view.contours);
    if (const std::string text = stretchText(context.session.stretch); !text.empty()) {
        const float width = ImGui::CalcTextSize(text.c_str()).x;
        if (!context.figure) ImGui::SameLine();
        if (ImGui::GetContentRegionAvail().x > width + em()) {
            ImGui::SameLine(ImGui::GetContentRegionMax().x - width);
            ImGui::AlignTextToFramePadding();
            if (context.decoration.title)
                ImGui::TextDisabled("%s", text.c_str());
            else
                ImGui::Dummy({width, em()});
        } else {
            ImGui::NewLine();
        }
    }

    const ImVec2 min = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
    if (room.x < em() * 10 || room.y < em() * 8) return;
    const ImVec2 max{min.x + room.x, min.y + room.y};
    const glm::dvec3 half = vis::worldFrame(info.bounds, context.session.stretch).halfSize;
    const float columns = split(half.x, half.z, room.x, em() * 3.2f, 0.3);
    // The head lines of both columns need some room.
    const float x = min.x + std::clamp(columns, std::min(em() * 12.5f, room.x / 2), room.x - em() * 8),
                y = min.y + split(half.y, half.z, room.y, em() * 2.8f, 0.4);
    const float gap = em() * 0.3f;
    drawPlane(context, cache, pane, view, name, lines, 0, min, {x - gap, y - gap});
    drawPlane(context, cache, pane, view, name, lines, 1, {x + gap, min.y}, {max.x, y - gap});
    drawPlane(context, cache, pane, view, name, lines, 2, {min.x, y + gap}, {x - gap, max.y});

    ImGui::SetCursorScreenPos({x + gap * 2, y + gap});
    ImGui::BeginChild("readout", {max.x - x - gap * 2, max.y - y - gap}, false,
                      context.figure ? ImGuiWindowFlags_NoScrollbar : ImGuiWindowFlags_None);
    LegendEntry legend = legendOf(context.session, info, *channel);
    updateReadout(context, pane, cache.readout);
    if (const auto value = cache.readout.value(name); value && context.decoration.cursor) legend.marker = *value;
    // If the table does not fit below the legend, the values come first, as running text; in figures after the legend,
    // which is whole.
    const std::string note = contourNote(info, view, lines);
    const float legends = legendBarHeight() + (note.empty() ? 0 : ImGui::GetTextLineHeightWithSpacing());
    const bool readout = view.showReadout && context.decoration.cursor;
    const bool compact = readout && legends + readoutHeight(cache.readout) > ImGui::GetContentRegionAvail().y;
    if (compact && !context.figure) drawReadout(context, cache.readout, true);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = std::min(ImGui::GetContentRegionAvail().x, em() * 20);
    // What is left out keeps its place: the rest stays where it is.
    const bool legendShown = context.decoration.legend;
    ImGui::Dummy(
        {width, (legendShown ? drawLegendBar(*ImGui::GetWindowDrawList(), at, width, legend) : legendBarHeight()) +
                    em() * 0.3f});
    if (!note.empty() && legendShown) {
        ImGui::PushTextWrapPos(0);
        ImGui::TextUnformatted(note.c_str());
        ImGui::PopTextWrapPos();
    }
    if (readout && (!compact || context.figure)) drawReadout(context, cache.readout, compact);
    ImGui::EndChild();
}

} // namespace tessera::app
