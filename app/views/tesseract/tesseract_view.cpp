#include "app/pane/axes3d.h"
#include "app/pane/axis_label.h"
#include "app/pane/corner_legends.h"
#include "app/pane/view_parts.h"
#include "app/ui/keys.h"
#include "app/ui/number_field.h"
#include "app/ui/parameter_widget.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "app/ui/widgets.h"
#include "app/views/tesseract/tesseract_query.h"
#include "app/views/tesseract/tesseract_turn.h"
#include "app/views/tesseract/tesseract_wire.h"
#include "vis/passes/point_cloud.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::app {

namespace {

constexpr std::size_t kMovingPoints = 30000; ///< drawn while something moves

enum class Drag { None, Turn, Turn4, Roll };

struct TesseractCache : ViewCache {
    AsyncSamples answers;
    vis::PointCloud cloud;
    std::shared_ptr<const volume::Samples4> samples; ///< of the cloud
    std::vector<vis::CloudPoint> points;             ///< of the cloud
    ImVec2 pressed{0, 0};                            ///< where a button went down
    bool clicked = false;                            ///< it came up again near there
    std::optional<vis::CloudStyle> style;
    std::optional<vis::CloudView> drawn;
    vis::TextureName texture = 0;
    Drag drag = Drag::None;
    double tour = 0; ///< degrees so far: not saved, the angles of the session are those it starts from
};

/// The channel along the fourth axis, nothing for time.
std::optional<int> fourthChannel(const volume::DatasetInfo& info, const TesseractView& view) {
    return view.fourth.empty() ? std::nullopt : info.findChannel(view.fourth);
}

/// Half the edges within the unit ball.
glm::dvec4 halfOf(const TesseractView& view, const volume::Box& bounds, glm::dvec3 stretch) {
    glm::dvec4 half(0.5);
    if (!view.cube) {
        const glm::dvec3 world = vis::worldFrame(bounds, stretch).halfSize;
        const double longest = std::max({world.x, world.y, world.z, 1e-12});
        half = glm::dvec4(world / longest, 1);
    }
    return half / std::max(glm::length(half), 1e-12);
}

void reset(TesseractView& view, TesseractCache& cache) {
    const TesseractView start;
    view.turn = start.turn;
    view.turn4 = start.turn4;
    view.zoom = start.zoom;
    view.tour = false;
    cache.tour = 0;
}

/// The name of an axis as it stands on the sliders.
std::array<std::string, 4> axisNames(const TesseractView& view) {
    return {"x", "y", "z", view.fourth.empty() ? "t" : view.fourth};
}

void drawToolbar(ViewContext& context, TesseractCache& cache, TesseractView& view, const std::string& shown) {
    const volume::DatasetInfo& info = context.source->info();
    std::string channel = shown;
    ToolRow tools(context);
    const float list = std::min(em() * 7, tools.room() * 0.3f);
    if (tools.next(list)) {
        ImGui::SetNextItemWidth(list);
        if (chooseChannel("##channel", &info, channel)) view.channel = channel;
        if (ImGui::IsItemHovered()) tooltip("Parameter whose transfer function the points are drawn with");
    }
    if (tools.next(list)) {
        ImGui::SetNextItemWidth(list);
        chooseChannel("##fourth", &info, view.fourth, "time");
        if (ImGui::IsItemHovered()) tooltip("Along the fourth axis: time, or a parameter at the time shown");
    }
    const auto button = [&](const char* id, Icon icon, const char* help, bool lit = false) {
        return tools.next(iconButtonWidth(context, icon)) && iconButton(context, id, icon, help, true, lit);
    };
    if (button("tour", view.tour ? icons::kPause : icons::kPlay, "Tour: keep turning in two planes at once", view.tour))
        view.tour = !view.tour;
    if (button("reset", {icon::kHome, "reset"}, "Reset the rotation (R)")) reset(view, cache);
    if (button("options", {icon::kGear, "..."}, "Settings: eye distance, splats, lattice")) ImGui::OpenPopup("options");
    if (ImGui::BeginPopup("options")) {
        ImGui::Dummy({em() * 20, 0});
        drawDescribed(view, WidgetContext{.info = &info});
        ImGui::EndPopup();
    }
    drawNote(tools, "when and where values occur: what moves leans along " + axisNames(view)[3]);
}

float slidersHeight(float width) {
    const int rows = width < em() * 20 ? 3 : 2;
    return static_cast<float>(rows) * ImGui::GetFrameHeightWithSpacing();
}

/// The angles as they are: a tour moves the sliders too, and goes on from where one of them is put.
void drawSliders(TesseractView& view, TesseractCache& cache, const glm::dmat4& rotation, float width) {
    TesseractView shown = view;
    if (cache.tour != 0) setAngles(shown, vis::anglesOf(rotation));
    bool moved = false;
    const std::array<std::string, 4> axes = axisNames(view);
    static constexpr int kAxes[6][2] = {{0, 1}, {0, 2}, {1, 2}, {0, 3}, {1, 3}, {2, 3}};
    const int columns = width < em() * 20 ? 2 : 3;
    const float space = ImGui::GetStyle().ItemSpacing.x;
    const float each = std::floor((width - space * static_cast<float>(columns - 1)) / static_cast<float>(columns));
    for (int i = 0; i < 6; ++i) {
        float& angle = i < 3 ? shown.turn[i] : shown.turn4[i - 3];
        const std::string name = axes[std::size_t(kAxes[i][0])] + axes[std::size_t(kAxes[i][1])];
        if (i % columns != 0) ImGui::SameLine();
        ImGui::SetNextItemWidth(each);
        ImGui::PushID(i);
        // A drag leaves traces of a degree, which would be written "-0".
        const char* number = std::abs(angle) < 0.5f ? "0" : "%.0f";
        moved |= slider("##angle", angle, -180, 180, (name + "  " + number + "\xc2\xb0").c_str());
        ImGui::PopID();
        if (ImGui::IsItemHovered())
            tooltip(("Rotation in the plane of " + axes[std::size_t(kAxes[i][0])] + " and " +
                     axes[std::size_t(kAxes[i][1])] + "; Ctrl+click to type")
                        .c_str());
    }
    if (!moved) return;
    view = shown;
    cache.tour = 0;
}

/// Mouse and keys over the picture, which is the last item. Returns true while something moves.
bool handleInput(TesseractCache& cache, TesseractView& view, ImVec2 size) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool hovered = ImGui::IsItemHovered();
    bool moving = false;
    cache.clicked = false;
    if (hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) cache.pressed = io.MousePos;
    if (hovered && cache.drag == Drag::None) {
        if (ImGui::IsMouseClicked(ImGuiMouseButton_Left))
            cache.drag = io.KeyShift ? Drag::Turn4 : io.KeyCtrl ? Drag::Roll : Drag::Turn;
        else if (ImGui::IsMouseClicked(ImGuiMouseButton_Right))
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
        using enum vis::Plane4;
        if (right != 0 || down != 0) {
            if (cache.drag == Drag::Turn)
                turn(view, XZ, -right, YZ, down);
            else if (cache.drag == Drag::Turn4)
                turn(view, XW, -right, YW, down);
            else
                turn(view, XY, -right, ZW, down);
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
    if ((hovered || ImGui::IsWindowFocused()) && !typing() && pressed({.key = 'R'})) reset(view, cache);
    return moving;
}

/// Brings the cloud's points up to date. Returns false while there are none.
bool updateCloud(ViewContext& context, const std::string& pane, TesseractCache& cache, const TesseractView& view,
                 int channel) {
    const Session& session = context.session;
    const volume::DatasetInfo& info = context.source->info();
    const std::vector<volume::Channel> channels = info.channels();
    const std::optional<int> fourth = fourthChannel(info, view);
    volume::SamplesQuery query;
    query.budget = static_cast<std::size_t>(view.points);
    const auto position = [&](int wanted) {
        const auto found = std::find(query.channels.begin(), query.channels.end(), wanted);
        if (found == query.channels.end()) query.channels.push_back(wanted);
        return static_cast<int>(std::find(query.channels.begin(), query.channels.end(), wanted) -
                                query.channels.begin());
    };
    position(channel);
    vis::CloudStyle style;
    if (fourth) style.fourthChannel = position(*fourth);
    const vis::DoiFunction interest(session.selection);
    for (const std::string& name : interest.channels()) {
        const auto found = info.findChannel(name);
        style.doiChannels.push_back(found ? position(*found) : -1);
    }
    std::optional<volume::TimePair> now;
    if (fourth) now = volume::timesAround(info.times, session.time);
    for (int t = 0; !fourth && t < static_cast<int>(info.times.size()); ++t) query.times.push_back(t);

    const volume::Channel& shown = channels[static_cast<std::size_t>(channel)];
    style.bounds = info.bounds;
    style.axes = info.lattice.axes;
    style.half = halfOf(view, info.bounds, session.stretch);
    style.fourth = fourth ? info.channelRange(channels[static_cast<std::size_t>(*fourth)])
                          : Range{info.times.front(), info.times.back()};
    style.transfer = transferOf(session, shown.name);
    style.range = vis::effectiveRange(style.transfer, info.channelRange(shown));
    if (view.colorBy == TesseractColor::Fourth) style.fourthColors = fourthColors();
    style.selection = session.selection;
    style.density = static_cast<double>(view.density);

    const auto samples = cache.answers.get(context, "tesseract " + pane, {query, now});
    if (!samples) return false;
    const bool fits = samples->channels == static_cast<int>(query.channels.size());
    if (!fits) return cache.style.has_value(); // samples of other parameters: keep drawing the former cloud
    if (samples != cache.samples || !cache.style || *cache.style != style) {
        cache.points = vis::makeCloud(*samples, style);
        cache.cloud.upload(context.renderer.textures(), cache.points);
        cache.samples = samples;
        cache.style = style;
        cache.drawn.reset();
    }
    return true;
}

/// The value, place and time of the point under the mouse; a click takes the linked cursor there, and the time along.
void drawReading(ViewContext& context, const TesseractView& view, const TesseractCache& cache,
                 const TesseractFrame& frame, int channel) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    if (cache.points.empty() || cache.drag != Drag::None) return;
    const double half = 0.5 * std::min(frame.max.x - frame.min.x, frame.max.y - frame.min.y);
    const glm::dvec2 at((mouse.x - 0.5 * (frame.min.x + frame.max.x)) / half,
                        (0.5 * (frame.min.y + frame.max.y) - mouse.y) / half);
    const auto found = vis::nearestPoint(cache.points, frame.rotation, frame.projection, at, em() * 0.6 / half);
    if (!found) return;
    const vis::CloudPoint& point = cache.points[*found];
    const volume::Samples4& samples = *cache.samples;
    const std::size_t sample = point.sample;
    const volume::DatasetInfo& info = context.source->info();
    const glm::dvec3 place(samples.positions[sample]);
    const double time = static_cast<double>(samples.times[sample]);
    const volume::Channel known = info.channel(channel);
    const Range range = info.channelRange(known);
    const double value = static_cast<double>(samples.values[sample * static_cast<std::size_t>(samples.channels)]);
    const LengthUnit unit = suitableLength(info.lengthUnit, glm::length(info.bounds.size()));
    std::string text = known.name + " = " + formatQuantity(value, known.unit, (range.hi - range.lo) / 2000);
    for (int axis = 0; axis < 3; ++axis)
        text += (axis == 0 ? "\n" : ", ") +
                formatNumber(place[axis] * unit.perUnit, tellingLength(info, axis, place, 1.0 / 500) * unit.perUnit);
    text += " " + prettyUnit(unit.name);
    if (info.times.size() > 1) text += "\n" + timeText(info, time);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const vis::Projected4 seen =
        frame.project(glm::dvec4(point.position)); // where the ring goes: the splat itself may be small
    const ImVec2 pixel = frame.pixel(seen.at);
    draw.AddCircle(pixel, em() * 0.45f, plotColors().backdrop, 20, 3);
    draw.AddCircle(pixel, em() * 0.45f, plotColors().cursor, 20, 1.5f);
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const ImVec2 corner{std::min(mouse.x + em(), frame.max.x - size.x - em() * 0.5f),
                        std::min(mouse.y + em(), frame.max.y - size.y - em() * 0.5f)};
    draw.AddRectFilled({corner.x - 4, corner.y - 2}, {corner.x + size.x + 4, corner.y + size.y + 2},
                       plotColors().backdrop, 3);
    draw.AddText(corner, plotColors().text, text.c_str());
    if (!cache.clicked) return;
    context.session.cursor = glm::clamp(place, info.bounds.lo, info.bounds.hi);
    if (view.fourth.empty()) context.session.time = time;
}

void drawTexts(ViewContext& context, const TesseractView& view, const TesseractFrame& frame, ImVec2 max, int channel,
               std::vector<std::pair<ImVec2, ImVec2>> taken) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const Session& session = context.session;
    const volume::DatasetInfo& info = context.source->info();
    const PlotColors colors = plotColors();
    std::string title = nearText(frame);
    if (const std::string uneven = stretchText(glm::dvec3(1), info.lattice.axes); !uneven.empty())
        title += "; " + uneven;
    if (context.decoration.title) // above the legends: at the left it would lie over the body
        addFittedWithBackdrop(draw, {max.x - em() * 0.5f, frame.min.y + em() * 0.4f}, {1, 0}, colors.faint, title,
                              max.x - frame.min.x - em());
    if (!view.showLegend || !context.decoration.legend)
        return context.decoration.axes ? drawAxisNames4(draw, frame, std::move(taken)) : void();
    const std::optional<int> fourth = fourthChannel(info, view);
    std::vector<LegendEntry> entries;
    LegendEntry along;
    if (fourth) {
        along = legendOf(session, info, *fourth);
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
    drawToolbar(context, cache, view, info.channel(*channel).name);
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const float below = view.showControls && context.takesInput() && room.y > em() * 14 && room.x > em() * 12
                            ? slidersHeight(room.x) + ImGui::GetStyle().ItemSpacing.y
                            : 0;
    const ImVec2 min = ImGui::GetCursorScreenPos(), size{std::floor(room.x), std::floor(room.y - below)};
    if (size.x < em() * 6 || size.y < em() * 6) return drawHint("Not enough room", "Enlarge the pane.");
    const ImVec2 max{min.x + size.x, min.y + size.y};
    // In a wide pane the legends have room beside the body.
    const float beside = view.showLegend ? std::clamp(size.x - size.y * 0.95f, 0.0f, em() * 16) : 0;
    mouseArea("picture", size,
              ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle |
                  ImGuiButtonFlags_MouseButtonRight);
    const bool hovered = ImGui::IsItemHovered();
    bool moving = handleInput(cache, view, size);
    if (cache.drag != Drag::None) context.interacting = true;
    if (view.tour && !context.headless) {
        cache.tour += static_cast<double>(view.tourSpeed * std::min(ImGui::GetIO().DeltaTime, 0.1f));
        context.answers.busy = moving = true;
    }
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const bool there = updateCloud(context, pane, cache, view, *channel);

    TesseractFrame frame;
    frame.min = min;
    frame.max = {max.x - std::floor(beside), max.y};
    // Two planes that share no axis: the double rotation of four dimensions.
    frame.rotation = vis::planeRotation(vis::Plane4::XZ, glm::radians(cache.tour * 0.6)) *
                     vis::planeRotation(vis::Plane4::YW, glm::radians(cache.tour)) * vis::rotationOf(anglesOf(view));
    frame.projection = {static_cast<double>(view.eye), 3, static_cast<double>(view.zoom)};
    frame.half = halfOf(view, info.bounds, context.session.stretch);
    frame.axes = axisNames(view);
    numberEnds(frame, info, fourthChannel(info, view));
    frame.fourth = fourthColors();

    const ImVec4 ground = ImGui::ColorConvertU32ToFloat4(palette().plot);
    vis::CloudView cloud;
    cloud.rotation = frame.rotation;
    cloud.projection = frame.projection;
    cloud.size = {frame.max.x - frame.min.x, size.y};
    cloud.radiusPixels = view.radius * std::min(size.x, size.y) / 600;
    cloud.background = {ground.x, ground.y, ground.z};
    const bool quick = (moving || context.interacting || context.session.animation.playing) && !context.headless;
    if (quick) cloud.share = std::min(1.0, double(kMovingPoints) / std::max(1.0, double(cache.cloud.count())));
    if (cache.drawn != cloud) {
        cache.texture = cache.cloud.draw(cloud);
        cache.drawn = cloud;
    }
    if (quick && cloud.share < 1) context.answers.busy = true; // draw all points once it is at rest

    draw.PushClipRect(min, max, true);
    draw.AddRectFilled(min, max, context.whiteGround ? IM_COL32_WHITE : palette().plot);
    addPicture(draw, cache.texture, frame.min, frame.max);
    drawLattice4(draw, frame, view.lattice);
    if (view.showWire && context.decoration.box) drawWire(draw, frame);
    std::vector<std::pair<ImVec2, ImVec2>> taken; // by texts
    if (view.showNow && context.decoration.cursor && !fourthChannel(info, view) && info.times.size() > 1) {
        const double first = info.times.front(), now = context.session.time - first;
        const double share = std::clamp(now / (info.times.back() - first), 0.0, 1.0);
        taken.push_back(drawNowCell(draw, frame, share, timeText(info, context.session.time)));
    }
    drawTexts(context, view, frame, max, *channel, std::move(taken));
    if (!there) { // over the picture, which is empty until then
        const std::string failure = cache.answers.failure();
        addTextWithBackdrop(draw, {(min.x + max.x) / 2, (min.y + max.y) / 2}, {0.5f, 0.5f}, plotColors().text,
                            failure.empty() ? "Reading the samples of all times..." : failure.c_str());
    }
    if (hovered) drawReading(context, view, cache, frame, *channel);
    draw.PopClipRect();
    if (below > 0) drawSliders(view, cache, frame.rotation, room.x);
}

} // namespace tessera::app
