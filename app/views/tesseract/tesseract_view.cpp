#include "app/pane/axes3d.h"
#include "app/pane/axis_label.h"
#include "app/pane/corner_legends.h"
#include "app/pane/view_parts.h"
#include "app/ui/keys.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "app/ui/widgets.h"
#include "app/views/tesseract/tesseract_brush.h"
#include "app/views/tesseract/tesseract_cloud.h"
#include "app/views/tesseract/tesseract_controls.h"
#include "app/views/tesseract/tesseract_turn.h"
#include "vis/passes/stereo_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::app {

namespace {

constexpr std::size_t kMovingPoints = 30000; ///< drawn while something moves

enum class Drag { None, Turn, Turn4, Roll };

struct TesseractCache : ViewCache {
    TesseractCloud cloud;
    vis::StereoPicture anaglyph;
    ImVec2 pressed{0, 0}; ///< where a button went down
    bool clicked = false; ///< it came up again near there
    Drag drag = Drag::None;
    BrushDrag brush;
    double tour = 0; ///< degrees so far: not saved, the angles of the session are those it starts from
};

/// Mouse and keys over the picture, which is the last item; `brushes`: the left button is theirs. Returns true while
/// something moves.
bool handleInput(TesseractCache& cache, TesseractView& view, ImVec2 size, int axes, bool brushes) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool hovered = ImGui::IsItemHovered();
    bool moving = false;
    cache.clicked = false;
    if (hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) cache.pressed = io.MousePos;
    if (hovered && cache.drag == Drag::None) {
        if (ImGui::IsMouseClicked(ImGuiMouseButton_Left) && !brushes)
            cache.drag = io.KeyShift ? Drag::Turn4 : io.KeyCtrl ? Drag::Roll : Drag::Turn;
        else if (ImGui::IsMouseClicked(ImGuiMouseButton_Right) && !brushes)
            cache.drag = Drag::Turn4;
        else if (ImGui::IsMouseClicked(ImGuiMouseButton_Middle))
            cache.drag = Drag::Roll;
    }
    if (hovered && io.MouseWheel != 0) {
        view.zoom = std::clamp(view.zoom * std::pow(1.15f, io.MouseWheel), 0.2f, 10.0f);
        moving = true;
    }
    if (cache.drag != Drag::None) {
        // Half a turn across the smaller side of the picture.
        const double perPixel = 3.14159265358979 / std::max(1.0, double(std::min(size.x, size.y)));
        const double right = io.MouseDelta.x * perPixel, down = io.MouseDelta.y * perPixel;
        const auto turnIn = [&](int a, int b, int c, int d) { // planes of the picture
            turn(view, axes, vis::planeRotation(a, b, -right) * vis::planeRotation(c, d, down));
        };
        if (right != 0 || down != 0) {
            if (cache.drag == Drag::Turn)
                turnIn(0, 2, 1, 2);
            else if (cache.drag == Drag::Turn4)
                turnIn(0, 3, 1, 3);
            else
                turnIn(0, 1, 2, 3);
            moving = true;
        }
        if (!ImGui::IsMouseDown(ImGuiMouseButton_Left) && !ImGui::IsMouseDown(ImGuiMouseButton_Right) &&
            !ImGui::IsMouseDown(ImGuiMouseButton_Middle)) {
            cache.clicked =
                cache.drag == Drag::Turn && hovered &&
                std::hypot(io.MousePos.x - cache.pressed.x, io.MousePos.y - cache.pressed.y) < io.MouseDragThreshold;
            cache.drag = Drag::None;
        }
    }
    if ((hovered || ImGui::IsWindowFocused()) && !typing() && pressed({.key = 'R'})) {
        resetTurn(view, cache.tour);
    }
    return moving;
}

/// Two lines in the upper right corner, above the legends: at the left they would lie over the body.
class TesseractTitle {
public:
    TesseractTitle(const TesseractFrame& frame, ImVec2 max, std::array<std::string, 2> lines)
        : lines_(std::move(lines)), right_(max.x - em() * 0.5f), top_(frame.min.y + em() * 0.4f),
          width_(max.x - frame.min.x - em()) {}

    void draw(ImDrawList& draw) const {
        for (std::size_t i = 0; i < lines_.size(); ++i)
            addFittedWithBackdrop(draw, {right_, topOf(i)}, {1, 0}, plotColors().faint, lines_[i], width_);
    }
    Rectangles corners() const {
        Rectangles out;
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            const ImVec2 size = ImGui::CalcTextSize(lines_[i].c_str());
            out.push_back({{right_ - std::min(size.x, width_), topOf(i)}, {right_, topOf(i) + size.y}});
        }
        return out;
    }

private:
    float topOf(std::size_t line) const { return top_ + em() * 1.5f * float(line); }

    std::array<std::string, 2> lines_;
    float right_, top_, width_;
};

/// `drawn`: which samples are.
TesseractTitle titleOf(const ViewContext& context, const TesseractFrame& frame, ImVec2 max, const std::string& drawn) {
    std::string near = nearText(frame);
    const std::string uneven = stretchText(glm::dvec3(1), context.source->info().lattice.axes);
    if (!uneven.empty()) near += "; " + uneven;
    return {frame, max, {near, drawn}};
}

void drawTexts(ViewContext& context, const TesseractView& view, const TesseractFrame& frame, ImVec2 max, int channel,
               Rectangles taken) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const Session& session = context.session;
    const volume::DatasetInfo& info = context.source->info();
    if (!view.showLegend || !context.decoration.legend)
        return context.decoration.axes ? drawAxisNames4(draw, frame, std::move(taken)) : void();
    const TesseractAxis& fourth = frame.axes[3];
    std::vector<LegendEntry> entries;
    LegendEntry along;
    if (fourth.channel) {
        along = legendOf(session, info, *fourth.channel);
        along.range = along.data;
    } else {
        along.title = timeWord(info);
        along.unit = info.timeUnit;
        along.range = along.data = {info.times.front(), info.times.back()};
        along.marker = session.time;
    }
    along.function = fourthColors();
    entries.push_back(along);
    if (view.colorBy == TesseractColor::Value) entries.push_back(legendOf(session, info, channel));
    // The edges reach everywhere as it turns: the legends stay where they are.
    const LegendRoom room{frame.min, max};
    const LegendArea area = drawLegends(
        draw, entries, room, placeLegends(entries, room, {[](ImVec2, ImVec2) { return 0.0; }}, figureLegends(context)));
    taken.emplace_back(area.min, area.max);
    if (context.decoration.axes) drawAxisNames4(draw, frame, std::move(taken));
}

/// Lines over the points, whose texts keep clear of `taken`; returns these corners and their own.
Rectangles drawLines(ViewContext& context, const TesseractView& view, const TesseractFrame& frame, Rectangles taken) {
    const volume::DatasetInfo& info = context.source->info();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    drawLattice4(draw, frame, view.lattice);
    if (view.showWire && context.decoration.box) drawWire(draw, frame);
    if (context.decoration.cursor) drawCursorRing(context, frame);
    if (view.showNow && context.decoration.cursor && !frame.axes[3].channel && info.times.size() > 1) {
        const double first = info.times.front(), now = context.session.time - first;
        const double share = std::clamp(now / (info.times.back() - first), 0.0, 1.0);
        taken.push_back(drawNowCell(draw, frame, share, timeText(info, context.session.time), taken));
    }
    return taken;
}

/// The picture of a frame in a pane from `min` to `max`.
class TesseractPicture {
public:
    TesseractPicture(ViewContext& context, TesseractCache& cache, TesseractView& view, const TesseractFrame& frame,
                     ImVec2 max, int channel, bool moving)
        : context_(context), cache_(cache), view_(view), frame_(frame), max_(max), channel_(channel) {
        const ImVec4 ground = ImGui::ColorConvertU32ToFloat4(palette().plot);
        cloud_.rotation = frame.rotation;
        if (view.light.on && glm::length(view.light.direction) > 0)
            cloud_.light = {glm::normalize(glm::dvec4(view.light.direction)), double(view.light.ambient)};
        cloud_.background = {ground.x, ground.y, ground.z};
        quick_ = (moving || context.interacting || context.session.animation.playing) && !context.headless;
        const auto count = double(cache.cloud.points.size());
        if (quick_) cloud_.share = std::min(1.0, double(kMovingPoints) / std::max(1.0, count));
        if (quick_ && cloud_.share < 1) context.answers.busy = true; // draw all points once it is at rest
    }

    std::size_t drawn() const { return std::size_t(std::ceil(double(cache_.cloud.points.size()) * cloud_.share)); }

    void draw() {
        using enum vis::StereoKind;
        switch (view_.stereo.kind) {
        case Off:
            addPicture(list(), picture(frame_, 0), frame_.min, frame_.max);
            return drawOver(frame_, max_);
        case Anaglyph: {
            const auto left = picture(eyeFrame(vis::Eye::Left), 0), right = picture(eyeFrame(vis::Eye::Right), 1);
            const vis::TextureName both =
                cache_.anaglyph.combine(context_.renderer.textures(), left, right, cloud_.size);
            addPicture(list(), both, frame_.min, frame_.max);
            return drawOver(frame_, max_); // lines and texts lie in the plane of the screen
        }
        case SideBySide:
            break;
        }
        for (const vis::Eye eye : {vis::Eye::Left, vis::Eye::Right}) {
            TesseractFrame own = eyeFrame(eye);
            const float middle = std::floor((frame_.min.x + max_.x) / 2);
            const bool atLeft = (eye == vis::Eye::Left) != view_.stereo.crossed;
            own.min.x = atLeft ? frame_.min.x : middle;
            own.max.x = atLeft ? middle : max_.x;
            list().PushClipRect(own.min, own.max, true);
            addPicture(list(), picture(own, eye == vis::Eye::Left ? 0 : 1), own.min, own.max);
            drawOver(own, own.max);
            list().PopClipRect();
        }
    }

private:
    static ImDrawList& list() { return *ImGui::GetWindowDrawList(); }

    TesseractFrame eyeFrame(vis::Eye eye) const {
        TesseractFrame own = frame_;
        own.projection.aside = view_.stereo.aside(eye);
        own.projection.convergence = double(view_.stereo.convergence);
        return own;
    }

    vis::TextureName picture(const TesseractFrame& frame, int eye) {
        const ImVec2 size{frame.max.x - frame.min.x, frame.max.y - frame.min.y};
        cloud_.projection = frame.projection;
        cloud_.size = {size.x, size.y};
        cloud_.radiusPixels = view_.radius * std::min(size.x, max_.y - frame.min.y) / 600;
        return cache_.cloud.picture(cloud_, eye);
    }

    void drawOver(const TesseractFrame& frame, ImVec2 max) {
        const volume::DatasetInfo& info = context_.source->info();
        const bool more = !cache_.cloud.answers.exact() && cache_.cloud.answers.failure().empty();
        const TesseractTitle title = titleOf(context_, frame, max, cloudText(cache_.cloud, info, view_, drawn(), more));
        const bool titled = context_.decoration.title;
        auto taken = drawLines(context_, view_, frame, titled ? title.corners() : Rectangles());
        if (titled) title.draw(list());
        drawTexts(context_, view_, frame, max, channel_, std::move(taken));
    }

    ViewContext& context_;
    TesseractCache& cache_;
    TesseractView& view_;
    const TesseractFrame& frame_;
    ImVec2 max_;
    int channel_;
    vis::CloudView cloud_;
    bool quick_ = false;
};

TesseractFrame frameOf(const ViewContext& context, const TesseractCache& cache, const TesseractView& view) {
    const volume::DatasetInfo& info = context.source->info();
    TesseractFrame frame;
    frame.axes = tesseractAxes(info, view);
    frame.count = static_cast<int>(frame.axes.size());
    frame.rotation = vis::rotationOf(anglesOf(view, frame.count));
    if (cache.tour != 0) // two planes that share no axis: the double rotation of four dimensions
        frame.rotation = vis::planeRotation(0, 2, glm::radians(cache.tour * 0.6)) *
                         vis::planeRotation(1, 3, glm::radians(cache.tour)) * frame.rotation;
    frame.projection = {static_cast<double>(view.eye), 3, static_cast<double>(view.zoom), view.parallel};
    frame.half = halfEdges(view, info.bounds, context.session.stretch, frame.axes.size());
    frame.fourth = fourthColors();
    return frame;
}

} // namespace

void drawTesseractView(ViewContext& context, const std::string& pane, TesseractView& view) {
    if (!context.source) {
        drawHint("No data", "Shows all times at once, in four dimensions.");
        return;
    }
    const volume::DatasetInfo& info = context.source->info();
    const std::optional<int> channel = resolveChannel(info, context.session, view.channel);
    if (!channel) return drawHint("No parameters", "This data set has no parameter to show.");
    TesseractCache& cache = cacheOf<TesseractCache>(context, pane);
    drawTesseractTools(context, view, tesseractAxes(info, view), cache.tour, info.channel(*channel).name);
    if (drawBrushRow(context, view, frameOf(context, cache, view))) cache.tour = 0;
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const bool controls = view.showControls && context.takesInput();
    const float below = controls ? turnSlidersHeight(room, static_cast<int>(tesseractAxes(info, view).size())) : 0;
    const ImVec2 min = ImGui::GetCursorScreenPos(), size{std::floor(room.x), std::floor(room.y - below)};
    if (size.x < em() * 6 || size.y < em() * 6) return drawHint("Not enough room", "Enlarge the pane.");
    const ImVec2 max{min.x + size.x, min.y + size.y};
    // In a wide pane the legends have room beside the body.
    const bool pair = view.stereo.kind == vis::StereoKind::SideBySide;
    const float beside = view.showLegend && !pair ? std::clamp(size.x - size.y * 0.95f, 0.0f, em() * 16) : 0;
    mouseArea("picture", size,
              ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle |
                  ImGuiButtonFlags_MouseButtonRight);
    const bool hovered = ImGui::IsItemHovered();
    TesseractFrame frame = frameOf(context, cache, view);
    frame.min = min;
    frame.max = {max.x - std::floor(beside), max.y};
    const bool brushes = editTesseractBrush(context, cache.brush, view, frame);
    bool moving = handleInput(cache, view, size, frame.count, brushes);
    if (cache.drag != Drag::None) context.interacting = true;
    if (view.tour && !context.headless) {
        cache.tour += static_cast<double>(view.tourSpeed * std::min(ImGui::GetIO().DeltaTime, 0.1f));
        context.answers.busy = moving = true;
    }
    if (moving) { // what the hand did is seen at once
        TesseractFrame now = frameOf(context, cache, view);
        now.min = frame.min, now.max = frame.max;
        frame = now;
    }
    const bool there = cache.cloud.update(context, pane, view, frame.axes, *channel);

    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.PushClipRect(min, max, true);
    draw.AddRectFilled(min, max, context.whiteGround ? IM_COL32_WHITE : palette().plot);
    TesseractPicture(context, cache, view, frame, max, *channel, moving).draw();
    if (!pair) drawTesseractBrushes(context, frame);
    if (!there) { // over the picture, which is empty until then
        const std::string failure = cache.cloud.answers.failure();
        addTextWithBackdrop(draw, {(min.x + max.x) / 2, (min.y + max.y) / 2}, {0.5f, 0.5f}, plotColors().text,
                            failure.empty() ? "Reading the samples of all times..." : failure.c_str());
    }
    if (hovered && !pair && cache.drag == Drag::None && !cache.brush.active) {
        const auto sample = drawReading(context, cache.cloud, frame, *channel);
        if (sample && cache.clicked) {
            const volume::Samples4& samples = *cache.cloud.samples;
            context.session.cursor = glm::clamp(glm::dvec3(samples.positions[*sample]), info.bounds.lo, info.bounds.hi);
            if (!frame.axes[3].channel) context.session.time = static_cast<double>(samples.times[*sample]);
        }
    }
    draw.PopClipRect();
    if (below > 0) drawTurnSliders(view, frame.axes, cache.tour, frame.rotation, room.x);
}

} // namespace tessera::app
