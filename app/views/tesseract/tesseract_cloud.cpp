#include "app/views/tesseract/tesseract_cloud.h"

#include "app/pane/axis_label.h"
#include "app/pane/view_parts.h"
#include "app/queries/readout.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "app/values/place_text.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tessera::app {

namespace {

/// Channels of a query, each once.
class QueriedChannels {
public:
    explicit QueriedChannels(std::vector<int>& channels) : channels_(channels) {}
    int position(int wanted) {
        const auto found = std::find(channels_.begin(), channels_.end(), wanted);
        const auto at = static_cast<int>(found - channels_.begin());
        if (found == channels_.end()) channels_.push_back(wanted);
        return at;
    }

private:
    std::vector<int>& channels_;
};

struct WantedCloud {
    TesseractQuery query;
    vis::CloudStyle style;
};

WantedCloud wantedCloud(const ViewContext& context, const TesseractView& view, const std::vector<TesseractAxis>& axes,
                        int channel) {
    const Session& session = context.session;
    const volume::DatasetInfo& info = context.source->info();
    const std::vector<volume::Channel> channels = info.channels();
    WantedCloud out;
    volume::SamplesQuery& query = out.query.samples;
    vis::CloudStyle& style = out.style;
    query.budget = static_cast<std::size_t>(view.points);
    query.lattice = view.samples;
    QueriedChannels wanted(query.channels);
    wanted.position(channel);
    const std::optional<int> fourth = axes[3].channel;
    if (fourth) style.fourthChannel = wanted.position(*fourth);
    for (std::size_t axis = 4; axis < axes.size(); ++axis)
        style.further.push_back({wanted.position(*axes[axis].channel), axes[axis].range});
    const vis::DoiFunction interest(session.selection);
    for (const std::string& name : interest.channels()) {
        const auto found = info.findChannel(name);
        style.doiChannels.push_back(found ? wanted.position(*found) : -1);
    }
    if (fourth)
        out.query.time = volume::timesAround(info.times, session.time);
    else
        for (int t = 0; t < static_cast<int>(info.times.size()); ++t) query.times.push_back(t);
    query.gradients = view.light.on;
    query.gradientOf = fourth.value_or(channel);

    const volume::Channel& shown = channels[static_cast<std::size_t>(channel)];
    style.bounds = info.bounds;
    style.axes = info.lattice.axes;
    style.half = halfEdges(view, info.bounds, session.stretch, axes.size());
    style.fourth = axes[3].range;
    style.transfer = transferOf(session, shown.name);
    style.range = vis::effectiveRange(style.transfer, info.channelRange(shown));
    if (view.colorBy == TesseractColor::Fourth) style.fourthColors = fourthColors();
    style.selection = session.selection;
    style.density = static_cast<double>(view.density);
    return out;
}

} // namespace

bool TesseractCloud::update(ViewContext& context, const std::string& pane, const TesseractView& view,
                            const std::vector<TesseractAxis>& axes, int channel) {
    const WantedCloud wanted = wantedCloud(context, view, axes, channel);
    const auto found = answers.get(context, "tesseract " + pane, wanted.query);
    current = found != nullptr;
    if (!found) return style.has_value(); // none of these parameters yet: the former ones stay
    const bool pair = view.stereo.on();
    if (found != samples || style != wanted.style || pair != both) {
        points = vis::makeCloud(*found, wanted.style);
        for (int eye = 0; eye < (pair ? 2 : 1); ++eye)
            clouds[std::size_t(eye)].upload(context.renderer.textures(), points);
        samples = found;
        style = wanted.style;
        both = pair;
        drawn = {};
    }
    return true;
}

vis::TextureName TesseractCloud::picture(const vis::CloudView& view, int eye) {
    const auto i = std::size_t(eye);
    if (drawn[i] != view) {
        textures[i] = clouds[i].draw(view);
        drawn[i] = view;
    }
    return textures[i];
}

std::string cloudText(const TesseractCloud& cloud, const volume::DatasetInfo& info, const TesseractView& view,
                      std::size_t count, bool moreComing) {
    if (!cloud.samples) return {};
    const volume::Samples4& samples = *cloud.samples;
    std::string text = formatCount(double(count)) + (count == 1 ? " point, " : " points of ");
    if (count != 1) text += formatCount(double(samples.count())) + " samples, ";
    text += formatShare(samples.share) + " of the lattice";
    const bool ofTimes = !cloud.style || cloud.style->fourthChannel < 0;
    if (ofTimes && samples.timesRead < int(info.times.size()))
        text += ", " + formatCount(samples.timesRead) + " of " + formatCount(double(info.times.size())) + " times";
    if (view.samples == volume::SampleLattice::D4) {
        const bool grid = info.lattice.kind == volume::LatticeKind::CC;
        text += !ofTimes ? "; of a D4* lattice those at this time"
                : grid   ? "; a D4* lattice: every other sample in space and time"
                         : "; a D4* lattice: one grid of two at each time";
    }
    return moreComing ? text + "; more are being read" : text;
}

void drawCursorRing(ViewContext& context, const TesseractFrame& frame) {
    const glm::dvec3 sheet = context.source->info().lattice.axes.toSheet(context.session.cursor);
    vis::PointN at{};
    for (std::size_t axis = 0; axis < frame.axes.size(); ++axis) {
        const TesseractAxis& own = frame.axes[axis];
        std::optional<double> value = context.session.time;
        if (axis < 3)
            value = sheet[int(axis)];
        else if (own.channel)
            value = sharedReadout(context).value(own.name);
        if (!value || std::isnan(*value)) return;
        const double extent = own.range.hi - own.range.lo;
        const double share = extent > 0 ? std::clamp((*value - own.range.lo) / extent, 0.0, 1.0) : 0.5;
        at[axis] = frame.half[axis] * (2 * share - 1);
    }
    const ImVec2 pixel = frame.pixel(frame.project(at).at);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddCircle(pixel, em() * 0.28f, plotColors().backdrop, 16, 3);
    draw.AddCircle(pixel, em() * 0.28f, plotColors().cursor, 16, 1.5f);
}

std::optional<std::size_t> drawReading(ViewContext& context, const TesseractCloud& cloud, const TesseractFrame& frame,
                                       int channel) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    if (cloud.points.empty() || !cloud.current) return std::nullopt;
    const double half = 0.5 * std::min(frame.max.x - frame.min.x, frame.max.y - frame.min.y);
    const glm::dvec2 at((mouse.x - 0.5 * (frame.min.x + frame.max.x)) / half,
                        (0.5 * (frame.min.y + frame.max.y) - mouse.y) / half);
    const auto found = vis::nearestPoint(cloud.points, frame.rotation, frame.projection, at, em() * 0.6 / half);
    if (!found) return std::nullopt;
    const vis::CloudPoint& point = cloud.points[*found];
    const volume::Samples4& samples = *cloud.samples;
    const volume::DatasetInfo& info = context.source->info();
    const glm::dvec3 place(samples.positions[point.sample]);
    const auto value = [&](int which) {
        return static_cast<double>(samples.values[point.sample * static_cast<std::size_t>(samples.channels) +
                                                  static_cast<std::size_t>(which)]);
    };
    const volume::Channel known = info.channel(channel);
    const Range range = info.channelRange(known);
    const LengthUnit unit = suitableLength(info.lengthUnit, glm::length(info.bounds.size()));
    std::string text = known.name + " = " + formatQuantity(value(0), known.unit, (range.hi - range.lo) / 2000);
    for (int axis = 0; axis < 3 && !info.plane; ++axis)
        text += (axis == 0 ? "\n" : ", ") +
                formatNumber(place[axis] * unit.perUnit, tellingLength(info, axis, place, 1.0 / 500) * unit.perUnit);
    text += info.plane ? "\n" + pointText(info, place, 1.0 / 500) : " " + prettyUnit(unit.name);
    if (info.times.size() > 1) text += "\n" + timeText(info, static_cast<double>(samples.times[point.sample]));
    const vis::CloudStyle& style = *cloud.style;
    for (std::size_t axis = 3; axis < frame.axes.size(); ++axis) {
        const int which = axis == 3 ? style.fourthChannel : style.further[axis - 4].channel;
        const TesseractAxis& own = frame.axes[axis];
        if (which > 0)
            text +=
                "\n" + own.name + " = " + formatQuantity(value(which), own.unit, (own.range.hi - own.range.lo) / 2000);
    }
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    // Where the ring goes: the splat itself may be small.
    const vis::PointN where = vis::pointOf(glm::dvec4(point.position), glm::dvec4(point.further));
    const ImVec2 pixel = frame.pixel(frame.project(where).at);
    draw.AddCircle(pixel, em() * 0.45f, plotColors().backdrop, 20, 3);
    draw.AddCircle(pixel, em() * 0.45f, plotColors().cursor, 20, 1.5f);
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const ImVec2 corner{std::min(mouse.x + em(), frame.max.x - size.x - em() * 0.5f),
                        std::min(mouse.y + em(), frame.max.y - size.y - em() * 0.5f)};
    draw.AddRectFilled({corner.x - 4, corner.y - 2}, {corner.x + size.x + 4, corner.y + size.y + 2},
                       plotColors().backdrop, 3);
    draw.AddText(corner, plotColors().text, text.c_str());
    return point.sample;
}

} // namespace tessera::app
