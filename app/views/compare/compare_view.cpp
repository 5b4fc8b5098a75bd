#include "app/views/compare/compare_view.h"

#include "app/edits/compare_files.h"
#include "app/pane/axes3d.h"
#include "app/pane/view_parts.h"
#include "app/tools/brush_list.h"
#include "app/tools/camera_controller.h"
#include "app/ui/keys.h"
#include "app/ui/ticks.h"
#include "app/ui/widgets.h"
#include "app/views/compare/compare_areas.h"
#include "app/views/compare/compare_layout.h"
#include "app/views/compare/compare_menu.h"
#include "app/views/compare/compare_offers.h"
#include "app/views/compare/compare_panes.h"
#include "app/views/compare/compare_questions.h"
#include "app/views/compare/compare_table.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tessera::app {

namespace {

struct CompareCache : ViewCache {
    int renderers() const override { return pictures.renderers(); }
    ComparePictures pictures;
    std::vector<CameraController> hands;
    CompareMenuState menu;
    std::vector<CompareRow> rows;
    QuestionClock questions;
    bool swiping = false;
    double blinkStart = 0;
    std::size_t blinkShown = 0;
};

struct Frame {
    ViewContext& context;
    CompareView& view;
    CompareCache& cache;
    std::vector<CompareVariant> variants;
    std::size_t reference = 0, other = 0;
};

std::string nameOf(const Frame& frame, std::size_t index) {
    return variantName(frame.context.session, frame.variants[index]);
}

/// Of the data as a variant is drawn, which may have axes of its own; those of the session until they are open.
const volume::DatasetInfo& infoOf(const Frame& frame, std::size_t index) {
    const auto& cells = frame.cache.pictures.cells();
    const auto source = index < cells.size() && cells[index] ? cells[index]->source(frame.context) : nullptr;
    return (source ? source : frame.context.source)->info();
}

/// What is drawn over the picture of a variant: caption, and if the picture is there cursor and brushes.
void drawOver(const Frame& frame, const PictureBox& box, std::size_t index, bool there, bool left = true) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const Session& session = frame.context.session;
    const volume::DatasetInfo& info = infoOf(frame, index);
    const SpaceFrame space = spaceFrame(box.min, box.max(), session.camera, info, session.stretch);
    const Decoration& shown = frame.context.decoration;
    if (there && shown.cursor) drawCursor3d(draw, space, session.cursor);
    if (there && shown.outlines) drawSpaceBrushes(draw, space, session.selection);
    if (!shown.title) return;
    const PlotColors colors = plotColors();
    const float pad = em() * 0.5f;
    const std::string uneven = stretchText(glm::dvec3(1), info.lattice.axes);
    const bool noted = !uneven.empty() && left, low = box.size.y < em() * 4;
    addFittedWithBackdrop(draw, {left ? box.min.x + pad : box.max().x - pad, box.min.y + em() * 0.4f},
                          {left ? 0.0f : 1.0f, 0}, colors.text,
                          nameOf(frame, index) + (noted && low ? ", " + uneven : ""),
                          box.size.x * (left ? 1.0f : 0.5f) - 2 * pad);
    if (noted && !low)
        addTextWithBackdrop(draw, {box.min.x + pad, box.max().y - pad}, {0, 1}, colors.faint, uneven.c_str());
    // In a low picture it would cover what is compared; the table says it as well.
    if (left && index == frame.reference && box.size.y > em() * 7)
        addTextWithBackdrop(draw, {box.min.x + pad, box.min.y + em() * 1.7f}, {0, 0}, colors.faint, "reference");
}

/// The button under a picture, with the camera's mouse and the variant's menu; true while something moves.
bool picture(const Frame& frame, std::size_t index, const PictureBox& box, bool blocked) {
    CompareCache& cache = frame.cache;
    ImGui::SetCursorScreenPos(box.min);
    ImGui::PushID(static_cast<int>(index));
    mouseArea("picture", box.size,
              ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle |
                  ImGuiButtonFlags_MouseButtonRight);
    const vis::WorldFrame world = vis::worldFrame(infoOf(frame, index), frame.context.session.stretch);
    CameraController& hand = cache.hands[index];
    hand.blocked = blocked;
    vis::ViewTarget* target = nullptr;
    const auto& cells = cache.pictures.cells();
    // Only the window's own renderer can be asked what lies there.
    if (index < cells.size() && cells[index] && !cells[index]->data) target = cells[index]->target.get();
    const bool moving = handleMouse(frame.context, hand, target, box, world, "variant");
    if (hand.dragging()) frame.context.interacting = true;
    drawVariantMenu(frame.context, "variant", frame.view, frame.variants, index,
                    index < cells.size() ? cells[index].get() : nullptr, cache.menu);
    ImGui::PopID();
    return moving;
}

/// A cell's picture, or why there is none or nothing in it.
void drawCell(const Frame& frame, std::size_t index, const PictureBox& box) {
    const CompareCell& cell = *frame.cache.pictures.cells()[index];
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    if (cell.drawn) addPicture(draw, cell.status.texture, box.min, box.max());
    std::string text = cell.failure.empty() ? "Opening the data" : cell.failure;
    if (cell.drawn) text = equalText(cell.session, cell.source(frame.context)->info());
    if (text.empty()) return;
    addFittedWithBackdrop(draw, {box.min.x + box.size.x / 2, box.min.y + box.size.y / 2}, {0.5f, 0.5f},
                          plotColors().faint, text, box.size.x - em());
}

bool isDrawn(const Frame& frame, std::size_t index) {
    return frame.cache.pictures.cells()[index]->drawn;
}

void drawGrid(const Frame& frame, const std::vector<PictureBox>& boxes, bool differences) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    if (differences)
        frame.cache.pictures.showDifferences(frame.context.renderer.textures(), double(frame.view.differenceTop),
                                             frame.reference);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const PictureBox& box = boxes[i];
        const CompareCell& cell = *frame.cache.pictures.cells()[i];
        draw.PushClipRect(box.min, box.max(), true);
        const bool shown = differences && i != frame.reference && cell.finished() && cell.showsDifference();
        if (shown)
            draw.AddImage(textureId(cell.differencePicture.name()), box.min, box.max());
        else
            drawCell(frame, i, box);
        drawOver(frame, box, i, shown || cell.drawn);
        draw.PopClipRect();
    }
}

/// What is shown, then RMS and largest difference of the samples as far as they are known.
std::vector<std::string> valuesText(const CompareCell& cell) {
    std::vector<std::string> lines{"minus reference, on the planes through the cross-hair"};
    if (cell.samples && cell.samples->samples > 0 && cell.samples->largest == 0)
        lines.push_back("all samples drawn are equal");
    else if (cell.samples && cell.samples->samples > 0)
        lines.push_back("all samples drawn: RMS " + formatQuantity(cell.samples->rms, cell.values.unit()) +
                        ", maximum " + formatQuantity(cell.samples->largest, cell.values.unit()));
    return lines;
}

/// The reference as it is, the others as the differences of their values.
void drawValues(const Frame& frame, const std::string& pane, const std::vector<PictureBox>& boxes, bool moving) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    ComparePictures& pictures = frame.cache.pictures;
    const double top = pictures.findValues(frame.context, pane, frame.reference);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const PictureBox& box = boxes[i];
        CompareCell& cell = *pictures.cells()[i];
        draw.PushClipRect(box.min, box.max(), true);
        const auto note = [&](const std::string& text, int line) {
            const float y = box.min.y + em() * (1.7f + 1.3f * static_cast<float>(line));
            addFittedWithBackdrop(draw, {box.min.x + em() * 0.5f, y}, {0, 0}, plotColors().faint, text,
                                  box.size.x - em());
        };
        const glm::ivec2 size(static_cast<int>(box.size.x), static_cast<int>(box.size.y));
        const bool shown = i != frame.reference && cell.failure.empty() &&
                           cell.values.draw(frame.context, cell.session, top, size, moving);
        if (shown)
            addPicture(draw, cell.values.texture(), box.min, box.max());
        else
            drawCell(frame, i, box);
        drawOver(frame, box, i, shown || cell.drawn);
        if (shown && frame.context.decoration.title)
            for (int line = 0; const std::string& text : valuesText(cell)) note(text, line++);
        else if (!shown && i != frame.reference && cell.failure.empty())
            note(cell.values.failure().empty() ? "Computing the difference" : cell.values.failure(), 0);
        draw.PopClipRect();
    }
}

/// The variants that the mode shows.
std::vector<std::size_t> shownIndices(const Frame& frame) {
    const CompareMode mode = modeOf(frame.view);
    if (mode == CompareMode::Swipe) return {frame.reference, frame.other};
    if (mode == CompareMode::Blink)
        return {frame.context.headless ? frame.reference : frame.cache.blinkShown % frame.variants.size()};
    std::vector<std::size_t> all(frame.variants.size());
    std::iota(all.begin(), all.end(), std::size_t(0));
    return all;
}

/// The legends of these variants, or in place of theirs those of differences, as far as they are known.
CompareLegends legendsOf(const Frame& frame, const std::vector<std::size_t>& shown) {
    const CompareMode mode = modeOf(frame.view);
    ComparePictures& pictures = frame.cache.pictures;
    if (!frame.view.shows.empty()) return paneLegends(frame.context, frame.view.shows, pictures.cells(), shown);
    CompareLegends legends = variantLegends(frame.context, pictures.cells(), shown);
    if (mode != CompareMode::Difference) return legends;
    const bool values = frame.view.differenceOf == DifferenceOf::Values;
    const double top =
        values ? pictures.largestValue(frame.reference) : pictures.differenceTop(double(frame.view.differenceTop));
    for (std::size_t i = 0; i < legends.size(); ++i) {
        const CompareCell& cell = *pictures.cells()[i];
        if (i == frame.reference || !cell.failure.empty()) continue;
        LegendEntry entry;
        entry.title = "difference (of 255)";
        entry.range = {0, top};
        entry.function.colormap = "inferno";
        if (values) {
            entry.title = cell.values.name().empty() ? "difference" : cell.values.name() + " minus reference";
            entry.unit = cell.values.unit();
            entry.function = vis::divergingFunction();
            entry.range = {-top, top};
        }
        entry.data = entry.range;
        legends[i] = {entry};
    }
    return legends;
}

/// Drags the line; true while the mouse is at it.
bool swipeLine(const Frame& frame, const PictureBox& box) {
    const ImGuiIO& io = ImGui::GetIO();
    const float x = box.min.x + box.size.x * frame.view.swipe;
    const bool near = box.contains(io.MousePos) && std::abs(io.MousePos.x - x) < em() * 0.6f;
    CompareCache& cache = frame.cache;
    if (near && ImGui::IsMouseClicked(ImGuiMouseButton_Left) && ImGui::IsWindowHovered()) cache.swiping = true;
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) cache.swiping = false;
    if (cache.swiping) {
        frame.view.swipe = std::clamp((io.MousePos.x - box.min.x) / box.size.x, 0.0f, 1.0f);
        frame.context.interacting = true;
    }
    if (near || cache.swiping) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    return near || cache.swiping;
}

void drawSwipe(const Frame& frame, const PictureBox& box) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float x = std::round(box.min.x + box.size.x * frame.view.swipe);
    draw.PushClipRect(box.min, {x, box.max().y}, true);
    drawCell(frame, frame.reference, box);
    drawOver(frame, box, frame.reference, isDrawn(frame, frame.reference));
    draw.PopClipRect();
    draw.PushClipRect({x, box.min.y}, box.max(), true);
    drawCell(frame, frame.other, box);
    drawOver(frame, box, frame.other, isDrawn(frame, frame.other), false);
    draw.PopClipRect();
    const PlotColors colors = plotColors();
    draw.AddLine({x, box.min.y}, {x, box.max().y}, colors.backdrop, 4);
    draw.AddLine({x, box.min.y}, {x, box.max().y}, colors.cursor, 2);
    const ImVec2 middle{x, box.min.y + box.size.y / 2};
    draw.AddCircleFilled(middle, em() * 0.55f, colors.cursor, 24);
    for (const float side : {-1.0f, 1.0f})
        draw.AddTriangleFilled({middle.x + side * em() * 0.38f, middle.y},
                               {middle.x + side * em() * 0.12f, middle.y - side * em() * 0.22f},
                               {middle.x + side * em() * 0.12f, middle.y + side * em() * 0.22f}, colors.backdrop);
}

/// The variant whose turn it is; a figure shows the reference.
std::size_t turn(const Frame& frame) {
    CompareCache& cache = frame.cache;
    if (frame.context.headless) return cache.blinkShown = frame.reference;
    const double now = ImGui::GetTime();
    const bool next = now - cache.blinkStart >= double(frame.view.blinkSeconds) ||
                      (ImGui::IsWindowFocused(ImGuiFocusedFlags_ChildWindows) && pressed({.key = 'B'}));
    if (next) {
        cache.blinkStart = now;
        ++cache.blinkShown;
    }
    frame.context.answers.busy = true;
    return cache.blinkShown %= frame.variants.size();
}

void drawBlink(const Frame& frame, const PictureBox& box) {
    const std::size_t shown = turn(frame);
    drawCell(frame, shown, box);
    drawOver(frame, box, shown, isDrawn(frame, shown));
}

/// The 3D scene of every variant, in `boxes` or, in turn or beside a line, in the only one.
void drawScenes(const Frame& frame, const std::string& pane, const std::vector<PictureBox>& boxes) {
    ViewContext& context = frame.context;
    CompareCache& cache = frame.cache;
    const CompareMode mode = modeOf(frame.view);
    bool moving = false;
    if (mode == CompareMode::Grid || mode == CompareMode::Difference) {
        for (std::size_t i = 0; i < boxes.size(); ++i) moving = picture(frame, i, boxes[i], false) || moving;
    } else {
        const bool blocked = mode == CompareMode::Swipe && swipeLine(frame, boxes[0]);
        const std::size_t which = mode == CompareMode::Swipe ? frame.other : cache.blinkShown % frame.variants.size();
        moving = picture(frame, which, boxes[0], blocked);
    }
    moving = moving || context.interacting || context.session.animation.playing;
    const ImVec2 size = boxes[0].size;
    cache.pictures.draw(context, pane, frame.reference, {size.x, size.y}, moving);
    if (mode == CompareMode::Difference && frame.view.differenceOf == DifferenceOf::Values)
        drawValues(frame, pane, boxes, moving);
    else if (mode == CompareMode::Grid || mode == CompareMode::Difference)
        drawGrid(frame, boxes, mode == CompareMode::Difference);
    else if (mode == CompareMode::Swipe)
        drawSwipe(frame, boxes[0]);
    else
        drawBlink(frame, boxes[0]);
}

/// A view with its caption, a click on which opens the menu of the variant.
void drawCaptionedPane(const Frame& frame, const std::string& pane, std::size_t index, const PictureBox& box) {
    CompareCell& cell = *frame.cache.pictures.cells()[index];
    const float head = ImGui::GetTextLineHeightWithSpacing();
    ImGui::PushID(static_cast<int>(index));
    std::string caption = nameOf(frame, index);
    if (index == frame.reference) caption += " (reference)";
    if (frame.context.decoration.title)
        ImGui::GetWindowDrawList()->AddText({box.min.x + em() * 0.5f, box.min.y}, plotColors().text,
                                            fitText(caption, box.size.x - em()).c_str());
    if (frame.context.takesInput()) {
        ImGui::SetCursorScreenPos(box.min);
        if (mouseArea("caption", {box.size.x, head})) ImGui::OpenPopup("variant");
        if (ImGui::IsItemHovered()) tooltip("Click to change this variant");
        drawVariantMenu(frame.context, "variant", frame.view, frame.variants, index, &cell, frame.cache.menu);
    }
    const PictureBox inner{{box.min.x, box.min.y + head}, {box.size.x, box.size.y - head}};
    if (cell.failure.empty() && cell.source(frame.context))
        drawComparedPane(frame.context, pane, frame.view.shows, index, cell, inner);
    else
        drawCell(frame, index, inner);
    ImGui::PopID();
}

/// The view of another pane for every variant, in `boxes` or, in turn, in the only one.
void drawPanes(const Frame& frame, const std::string& pane, const std::vector<PictureBox>& boxes) {
    frame.cache.pictures.open(frame.context, pane, frame.reference);
    if (modeOf(frame.view) == CompareMode::Blink) return drawCaptionedPane(frame, pane, turn(frame), boxes[0]);
    for (std::size_t i = 0; i < boxes.size(); ++i) drawCaptionedPane(frame, pane, i, boxes[i]);
}

} // namespace

std::vector<CompareRow> drawnComparison(const ViewCache* cache) {
    const auto* compare = dynamic_cast<const CompareCache*>(cache);
    return compare ? compare->rows : std::vector<CompareRow>{};
}

void drawCompareView(ViewContext& context, const std::string& pane, CompareView& view) {
    if (!context.source) {
        drawHint("No data", "Shows the 3D scene or another view side by side with different settings.");
        return;
    }
    CompareCache& cache = cacheOf<CompareCache>(context, pane);
    const std::vector<CompareVariant> variants = shownVariants(view, context.session, context.source->info());
    {
        ToolRow tools(context);
        drawCompareToolbar(context, tools, view, variants);
        exportMenu(context, tools,
                   {.name = "comparison", .table = [rows = cache.rows](const Progress&) { return compareTable(rows); }},
                   false);
    }
    Frame frame{context, view, cache, variants};
    const std::size_t count = frame.variants.size();
    frame.reference = std::min(static_cast<std::size_t>(std::max(view.reference, 0)), count - 1);
    frame.other = std::min(static_cast<std::size_t>(std::max(view.other, 0)), count - 1);
    cache.hands.resize(count);

    const ImVec2 room = ImGui::GetContentRegionAvail(), at = ImGui::GetCursorScreenPos();
    const bool bare = context.decoration == Decoration::preset("none");
    const CompareAreas areas = compareAreas(view, count, room, !context.takesInput(), bare);
    const ImVec2 area = areas.pictures;
    if (area.x < 24 || area.y < 24) return;
    const CompareMode mode = modeOf(view);
    const bool grid = mode == CompareMode::Grid || mode == CompareMode::Difference;
    cache.pictures.prepare(context, frame.variants);
    const std::vector<std::size_t> shown = shownIndices(frame);
    const CompareLegends legends = context.decoration.legend ? legendsOf(frame, shown) : CompareLegends{};
    CompareLayout layout = compareLayout(legends, grid ? static_cast<int>(count) : 1, at, area);
    const ImVec2 size = layout.pictures[0].size;
    if (size.x < 8 || size.y < 8) return;
    if (view.shows.empty())
        drawScenes(frame, pane, layout.pictures);
    else
        drawPanes(frame, pane, layout.pictures);
    for (std::size_t i = 0; layout.legends.size() > 1 && i < layout.legends.size(); ++i)
        if (cache.pictures.cells()[shown[i]]->isOpening()) layout.legends[i].clear(); // presumed, to keep their room
    drawCompareLegends(*ImGui::GetWindowDrawList(), layout);
    // What was found while drawing, such as the range of other data, is in the next frame's legends.
    if (context.decoration.legend && legendsOf(frame, shown) != legends) context.answers.busy = true;
    cache.rows = cache.pictures.rows(context, frame.reference);
    if (areas.table > 0) {
        ImGui::SetCursorScreenPos({at.x, at.y + area.y});
        drawCompareTable(view, cache.rows, !context.takesInput());
    }
    if (!context.takesInput()) return;
    ImGui::SetCursorScreenPos({at.x, at.y + area.y + areas.table});
    std::vector<std::string> names;
    for (std::size_t i = 0; i < count; ++i) names.push_back(nameOf(frame, i));
    drawQuestions(context, view, cache.questions, names);
}

} // namespace tessera::app
