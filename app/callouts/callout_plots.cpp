#include "app/callouts/callout_plots.h"

#include "app/pane/axes3d.h"
#include "app/pane/view_parts.h"
#include "app/ui/ticks.h"
#include "volume/reconstruct/probe.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::app {

namespace {

constexpr int kCalloutBins = 40, kLinePoints = 128;

void noteIn(const CalloutPart& shown, const std::string& text) {
    const PictureBox& box = shown.inner;
    addFittedWithBackdrop(*ImGui::GetWindowDrawList(), {box.min.x + box.size.x / 2, box.min.y + box.size.y / 2},
                          {0.5f, 0.5f}, plotColors().faint, text, box.size.x - em());
}

/// The answer to a question about the samples of a callout; null where there is none (yet), which it says.
std::shared_ptr<const StatisticsResult> statisticsOf(ViewContext& context, const CalloutPart& shown,
                                                     const std::vector<int>& channels, int bins) {
    const volume::DatasetInfo& info = context.numbers->info();
    const auto region = samplesOfPlace(shown.place, info, context.session.cursor);
    if (!region) {
        noteIn(shown, !shown.place.normal ? "No numbers of this lens"
                      : shown.place.axis  ? "No numbers of planes across an uneven axis"
                                          : "No numbers of tilted planes");
        return nullptr;
    }
    BrushedQuery query;
    query.channels = channels;
    for (const int channel : channels) query.ranges.push_back(paddedRange(info.channelRange(info.channel(channel))));
    query.time = volume::timesAround(info.times, context.session.time);
    query.bins = bins;
    vis::Brush brush{.name = "", .color = {}, .region = *region};
    if (shown.place.alone) brush.inverted = shown.place.alone->inverted;
    query.selection.brushes = {brush};
    query.lenses =
        vis::selectsLens(query.selection) ? lensSpace(context.session, info) : brushSpace(context.session, info);
    auto result = shown.state.statistics.get(context, shown.key, query);
    if (const std::string failure = shown.state.statistics.failure(); !result && !failure.empty())
        noteIn(shown, failure);
    else if (!result)
        noteIn(shown, "Counting...");
    return result;
}

/// The frame of a plot in a box, with axes where there is room. `up`: where the title of the upright axis is.
PlotFrame plotIn(const PictureBox& box, Range x, Range y, bool axes, TitlePlace up = TitlePlace::Nowhere) {
    const float left = axes ? axisRoom(AxisSide::Left, y, up) : em() * 0.4f;
    const float below = axes ? axisRoom(AxisSide::Bottom, x, TitlePlace::Elsewhere) : em() * 0.3f;
    return {{box.min.x + left, box.min.y + em() * 0.5f}, {box.max().x - em() * 0.8f, box.max().y - below}, x, y};
}

bool hasAxes(const PictureBox& box) {
    return box.size.x > em() * 8 && box.size.y > em() * 5;
}

std::optional<int> numbersChannel(const ViewContext& context, const Callout& callout) {
    return resolveChannel(context.numbers->info(), context.session, callout.channel);
}

} // namespace

std::optional<vis::Region> samplesOfPlace(const CalloutPlace& place, const volume::DatasetInfo& info,
                                          glm::dvec3 cursor) {
    if (!place.normal) return place.region;
    if (!place.axis) return std::nullopt;
    const int axis = static_cast<int>(*place.axis);
    const bool two = info.lattice.kind == volume::LatticeKind::BCC; // grids, half a cell apart along each axis
    const double spacing = std::abs(info.lattice.spacing[axis]) / (two ? 2 : 1);
    if (info.lattice.axes[axis] || !(spacing > 0)) return std::nullopt;
    const int layers = info.lattice.size[axis] * (two && axis != 2 ? 2 : 1);
    vis::BoxRegion layer{.center = info.bounds.center(), .radius = info.bounds.size()};
    const double first = info.lattice.origin[axis], last = double(std::max(layers - 1, 0));
    layer.center[axis] = first + std::clamp(std::round((cursor[axis] - first) / spacing), 0.0, last) * spacing;
    layer.radius[axis] = spacing / 4;
    return layer;
}

CalloutLine calloutLine(const Session& session, const volume::DatasetInfo& info, const vis::WorldFrame& world,
                        const Callout& callout, const CalloutPlace& place, int channel) {
    const int axis = static_cast<int>(callout.axis);
    CalloutLine line{.channel = channel, .time = volume::timesAround(info.times, session.time)};
    line.from = line.to = place.normal ? session.cursor : world.toPhysical(place.center);
    line.from[axis] = info.bounds.lo[axis];
    line.to[axis] = info.bounds.hi[axis];
    if (place.normal) return line;
    glm::dvec3 lo = place.center, hi = place.center;
    lo[axis] -= place.half[axis];
    hi[axis] += place.half[axis];
    const double a = world.toPhysical(lo)[axis], b = world.toPhysical(hi)[axis];
    line.from[axis] = std::max(line.from[axis], std::min(a, b));
    line.to[axis] = std::min(line.to[axis], std::max(a, b));
    return line;
}

void drawCalloutHistogram(ViewContext& context, const CalloutPart& shown) {
    const volume::DatasetInfo& info = context.numbers->info();
    const auto channel = numbersChannel(context, shown.callout);
    if (!channel) return;
    const auto result = statisticsOf(context, shown, {*channel}, kCalloutBins);
    if (!result || result->statistics.channels.empty()) return;
    const volume::ChannelStatistics& counted = result->statistics.channels.front();
    const double most = counted.histogram.focus.empty() ? 0 : std::ranges::max(counted.histogram.focus);
    if (!(most > 0)) return noteIn(shown, "No samples inside");
    std::vector<float> heights;
    for (const double count : counted.histogram.focus) heights.push_back(float(count / most * 0.95));
    const bool axes = hasAxes(shown.inner);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const PlotFrame frame = plotIn(shown.inner, counted.histogram.range, {0, most / 0.95}, axes, TitlePlace::Beside);
    if (frame.width() < 4 || frame.height() < 4) return;
    drawBars(draw, frame, heights, plotColors().bars);
    draw.AddRect(frame.min, frame.max, plotColors().frame);
    if (!axes) return;
    const volume::Channel own = info.channel(*channel);
    drawAxis(draw, frame, AxisSide::Bottom, own.name, own.unit, shown.inner.min.x, shown.inner.max().x,
             {.inlineTitle = true});
    drawAxis(draw, frame, AxisSide::Left, result->statistics.level > 0 ? "samples, estimated" : "samples", "",
             shown.inner.min.y, shown.inner.max().y);
}

void drawCalloutProfile(ViewContext& context, const CalloutPart& shown) {
    const volume::DatasetInfo& info = context.numbers->info();
    const auto channel = numbersChannel(context, shown.callout);
    if (!channel) return;
    const vis::WorldFrame world = vis::worldFrame(context.source->info(), context.session.stretch);
    const CalloutLine line = calloutLine(context.session, info, world, shown.callout, shown.place, *channel);
    const auto values = shown.state.profile.get(
        context, context.numbers, {.key = shown.key, .title = "profile of a callout", .quiet = true}, line,
        [](const std::shared_ptr<const volume::BrickSource>& source, const CalloutLine& asked, int& level,
           const Progress&) {
            level = 0;
            const std::vector<glm::dvec3> places =
                volume::alongPolyline(std::vector{asked.from, asked.to}, kLinePoints);
            std::vector<double> out;
            for (const volume::ProbeValue& value : volume::probeAlong(*source, asked.channel, places, asked.time))
                out.push_back(value.interpolated.value_or(std::numeric_limits<double>::quiet_NaN()));
            return out;
        },
        [](const CalloutLine&, const CalloutLine&) { return false; });
    if (!values) {
        const std::string failure = shown.state.profile.failure();
        return noteIn(shown, failure.empty() ? "Reading..." : failure);
    }
    const int axis = static_cast<int>(shown.callout.axis);
    const AxisLabel label = axisLabels(context.session, info)[std::size_t(axis)];
    const Range x = paddedRange({line.from[axis] * label.unit.perUnit, line.to[axis] * label.unit.perUnit});
    const Range y = paddedRange(info.channelRange(info.channel(*channel)));
    const bool axes = hasAxes(shown.inner);
    const PlotFrame frame = plotIn(shown.inner, x, y, axes);
    if (frame.width() < 4 || frame.height() < 4) return;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddRect(frame.min, frame.max, plotColors().frame);
    for (std::size_t i = 0; i + 1 < values->size(); ++i) {
        const double a = (*values)[i], b = (*values)[i + 1];
        if (std::isnan(a) || std::isnan(b)) continue;
        const double step = (x.hi - x.lo) / double(values->size() - 1);
        draw.AddLine(frame.pixel(x.lo + step * double(i), a), frame.pixel(x.lo + step * double(i + 1), b),
                     palette().accent, std::max(1.0f, em() * 0.12f));
    }
    if (!axes) return;
    drawAxis(draw, frame, AxisSide::Bottom, label.name, label.unit.name, shown.inner.min.x, shown.inner.max().x,
             {.inlineTitle = true});
    drawAxis(draw, frame, AxisSide::Left, "", "", shown.inner.min.y, shown.inner.max().y);
}

void drawCalloutNumbers(ViewContext& context, const CalloutPart& shown) {
    const volume::DatasetInfo& info = context.numbers->info();
    const std::vector<int> channels = chosenChannels(info, {}, 12);
    if (channels.empty()) return;
    const auto result = statisticsOf(context, shown, channels, 1);
    if (!result) return;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const PlotColors colors = plotColors();
    const PictureBox& box = shown.inner;
    const auto rangeOf = [&](std::size_t i) {
        const volume::Summary& inside = result->statistics.channels[i].inside;
        const Range range = info.channelRange(info.channel(channels[i]));
        const double digits = (range.hi - range.lo) / 1000;
        return inside.samples > 0 ? formatNumber(inside.min, digits) + " .. " + formatNumber(inside.max, digits) : "";
    };
    const float line = em() * 1.25f, left = box.min.x + em() * 0.5f, right = box.max().x - em() * 0.5f;
    const auto atRight = [&](float x, float y, ImU32 color, const std::string& text) {
        draw.AddText({std::round(x - ImGui::CalcTextSize(text.c_str()).x), y}, color, text.c_str());
    };
    const bool wide = box.size.x > em() * 17; // room for the range beside the mean
    float ranges = 0;
    for (std::size_t i = 0; wide && i < channels.size() && i < result->statistics.channels.size(); ++i)
        ranges = std::max(ranges, ImGui::CalcTextSize(rangeOf(i).c_str()).x);
    const float middle = wide ? right - ranges - em() : right;
    float y = box.min.y + em() * 0.2f;
    atRight(middle, y, colors.faint, result->statistics.level > 0 ? "mean, estimated" : "mean");
    if (wide) atRight(right, y, colors.faint, "range");
    for (std::size_t i = 0; i < channels.size() && i < result->statistics.channels.size(); ++i) {
        y += line;
        const bool last = y + 2 * line > box.max().y;
        if (last && i + 1 < channels.size()) {
            draw.AddText({left, y}, colors.faint, (std::to_string(channels.size() - i) + " more").c_str());
            return;
        }
        const volume::Channel own = info.channel(channels[i]);
        const volume::Summary& inside = result->statistics.channels[i].inside;
        const Range range = info.channelRange(own);
        const double digits = (range.hi - range.lo) / 1000;
        const std::string mean = inside.samples > 0 ? formatNumber(inside.mean, digits) : "-";
        atRight(middle, y, colors.text, mean);
        if (wide) atRight(right, y, colors.faint, rangeOf(i));
        addFittedText(draw, {left, y}, colors.text, titleWithUnit(own.name, own.unit),
                      middle - left - ImGui::CalcTextSize(mean.c_str()).x - em() * 0.5f);
    }
}

} // namespace tessera::app
