#include "app/data/first_view.h"

#include "app/data/boundary_value.h"
#include "app/data/coarse_samples.h"
#include "app/data/first_curve.h"
#include "app/data/value_body.h"
#include "app/edits/multiples.h"
#include "app/edits/region_surface.h"
#include "app/ui/time_text.h"
#include "volume/base/error.h"
#include "volume/reconstruct/probe.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <span>

namespace tessera::app {

namespace {

/// The present sample nearest to the mean position of all present ones.
std::optional<glm::dvec3> middleOfSamples(const volume::BrickSource& source, int channel, int time) {
    const volume::BrickGrid& grid = source.grid();
    const bool bcc = grid.lattice.kind == volume::LatticeKind::BCC;
    const int level = grid.levelWithin(kQuickSamples);
    const auto place = [&](glm::ivec3 at) {
        const int z = bcc ? 2 * ((at.z / 2) << level) + at.z % 2 : at.z << level;
        return grid.lattice.position({at.x << level, at.y << level, z});
    };
    const auto all = [](glm::ivec3, glm::ivec3) { return true; };
    glm::dvec3 sum(0);
    double number = 0;
    forSamples(source, channel, time, level, all, [&](glm::ivec3 at, float) {
        sum += place(at);
        number += 1;
    });
    if (number == 0) return std::nullopt;
    const glm::dvec3 size = glm::max(source.info().bounds.size(), glm::dvec3(1e-300));
    glm::dvec3 best = sum / number;
    double nearest = std::numeric_limits<double>::infinity();
    forSamples(source, channel, time, level, all, [&](glm::ivec3 at, float) {
        const glm::dvec3 away = (place(at) - sum / number) / size;
        if (glm::dot(away, away) >= nearest) return;
        nearest = glm::dot(away, away);
        best = place(at);
    });
    return glm::clamp(best, source.info().bounds.lo, source.info().bounds.hi);
}

/// Share of the grid's samples (absent ones included) that should be visible: fewer are hard to find in the box.
constexpr double kLeastSeen = 0.02;
/// Opacity from which on a value counts as visible.
constexpr double kSeenOpacity = 0.1;

/// Share of the grid's samples whose opacity is at least kSeenOpacity.
double seenShare(const volume::BrickSource& source, int channel, int time, Range range,
                 std::span<const glm::vec2> opacity) {
    const int level = source.grid().levelWithin(kQuickSamples);
    const auto all = [](glm::ivec3, glm::ivec3) { return true; };
    double seen = 0;
    forSamples(source, channel, time, level, all, [&](glm::ivec3, float value) {
        seen += vis::curveAt(opacity, (double(value) - range.lo) / (range.hi - range.lo)) >= kSeenOpacity;
    });
    const glm::dvec3 size(source.grid().levelSamples(level));
    return seen / (size.x * size.y * size.z);
}

/// Parts of the range of a channel that hold values at a time, in 256; 0: it has one value everywhere, or none.
double variety(const Session& session, const volume::BrickSource& source, int channel, std::size_t time) {
    constexpr double kSame = 0.998; // of the volume
    const Range range = source.info().channelRange(source.info().channel(channel));
    const std::vector<double> count = bodyOf(session, source, channel, std::array{time}, range).count;
    const double all = std::accumulate(count.begin(), count.end(), 0.0);
    return all > 0 && *std::ranges::max_element(count) < kSame * all ? binsFilled(count) : 0;
}

/// The layers of one channel show another.
void showChannel(Session& session, const std::string& from, const std::string& to) {
    for (vis::Layer& layer : session.layers)
        std::visit(
            [&](auto& technique) {
                if (technique.channel != from) return;
                technique.channel = to;
                if (layer.name.starts_with(from)) layer.name.replace(0, from.size(), to);
            },
            layer.technique);
}

} // namespace

void showWhatVaries(Session& session, const volume::BrickSource& source, std::vector<std::string>& messages) {
    constexpr std::size_t kTimes = 5;
    constexpr double kMore = 1.25; // of what the first time shows
    const volume::DatasetInfo& info = source.info();
    if (session.layers.empty() || !isQuick(session, source)) return;
    const std::string first = vis::shownChannel(session.layers.front().technique);
    const auto varies = [&](int channel) {
        return std::ranges::any_of(timesToLookAt(session, source),
                                   [&](std::size_t time) { return variety(session, source, channel, time) > 0; });
    };
    try {
        auto shown = info.findChannel(first);
        if (!shown) return;
        if (!varies(*shown))
            for (const int other : scalarChannels(info))
                if (other != *shown && varies(other)) {
                    showChannel(session, first, info.channel(other).name);
                    shown = other;
                    break;
                }
        if (timesToLookAt(session, source).size() < 2) return;
        const std::size_t begin = std::size_t(info.nearestTime(session.time));
        const double now = variety(session, source, *shown, begin);
        std::size_t best = begin;
        double most = now * kMore;
        for (const std::size_t time : spreadTimes(info.times.size(), kTimes))
            if (const double here = variety(session, source, *shown, time); here > most) most = here, best = time;
        if (best == begin) return;
        session.time = info.times[best];
        messages.push_back(info.channel(*shown).name + " varies more at " + timeText(info, session.time) +
                           ", which is shown, than at the first time");
    } catch (const Error&) { // a damaged brick: what the rest says is shown all the same
    }
}

namespace {

/// Whether a layer is made of particles that were released before the time shown, and the data have what moves them.
bool looksBack(const vis::Layer& layer, const volume::DatasetInfo& info) {
    const auto* const flow = std::get_if<vis::FlowLayer>(&layer.technique);
    return layer.visible && flow && vis::followsParticles(flow->kind) && flow->kind != vis::FlowKind::Pathlines &&
           !(flow->kind == vis::FlowKind::Timelines && flow->together) &&
           std::ranges::find(info.parameters, flow->vector, &volume::Parameter::name) != info.parameters.end();
}

} // namespace

void showLastIfEmpty(Session& session, const volume::BrickSource& source, std::vector<std::string>& messages) {
    const volume::DatasetInfo& info = source.info();
    const auto particles =
        std::ranges::find_if(session.layers, [&](const vis::Layer& layer) { return looksBack(layer, info); });
    if (info.times.size() > 1 && session.time <= info.times.front() && particles != session.layers.end()) {
        session.time = info.times.back();
        messages.push_back(layerName(*particles) + ": its particles begin at the first time, so the last one is shown");
        return;
    }
    const auto first = std::ranges::find_if(session.layers, [](const vis::Layer& layer) {
        return layer.visible && layer.lens.empty() && std::holds_alternative<vis::VolumeLayer>(layer.technique);
    });
    if (info.times.size() < 2 || first == session.layers.end()) return;
    const std::string& name = std::get<vis::VolumeLayer>(first->technique).channel;
    const auto channel = info.findChannel(name);
    if (!channel || info.parameters[std::size_t(info.channel(*channel).parameter)].categorical) return;
    const std::string& key = first->transfer.empty() ? name : first->transfer;
    if (!session.transfer.contains(key)) return;
    const vis::TransferFunction& function = session.transfer.at(key);
    const Range range = vis::effectiveRange(function, info.channelRange(info.channel(*channel)));
    if (function.kind != vis::TransferKind::Curve || !(range.hi > range.lo)) return;
    const auto seen = [&](double time) {
        return seenShare(source, *channel, info.nearestTime(time), range, function.opacity);
    };
    try {
        const double now = seen(session.time), last = info.times.back();
        if (now >= kLeastSeen || !(seen(last) > now)) return;
        session.time = last;
        messages.push_back(name + " would hardly be seen at the first time; the last one is shown");
    } catch (const Error&) { // a damaged brick: the first time is shown
    }
}

void aimLayer(Session& session, const volume::BrickSource& source, vis::Layer& layer) {
    const volume::DatasetInfo& info = source.info();
    const std::string& name = vis::shownChannel(layer.technique);
    const auto channel = info.findChannel(name);
    if (!channel) return;
    const bool quick = isQuick(session, source);
    if (std::holds_alternative<vis::VolumeLayer>(layer.technique)) {
        if (quick && layer.transfer.empty()) aimFunction(session, source, name);
    } else if (auto* const iso = std::get_if<vis::IsoLayer>(&layer.technique);
               iso && info.parameters[std::size_t(info.channel(*channel).parameter)].categorical) {
        aimAtRegion(*iso, info.parameters[std::size_t(info.channel(*channel).parameter)]);
    } else if (iso) {
        const Range range = info.channelRange(info.channel(*channel));
        const bool outside = double(iso->value) < range.lo || double(iso->value) > range.hi;
        std::optional<double> value;
        if (outside) value = (range.lo + range.hi) / 2;
        try {
            if (quick)
                value =
                    surfaceValue(source, *channel, info.nearestTime(session.time)).value_or(value.value_or(iso->value));
        } catch (const Error&) { // a damaged brick
        }
        if (value) iso->value = *value;
    }
}

double firstAspect(const volume::DatasetInfo& info) {
    return info.times.size() > 1 ? 0.92 : 0.78;
}

void aimFirstView(Session& session, const volume::BrickSource& source, double aspect) {
    const volume::DatasetInfo& info = source.info();
    const vis::WorldFrame world = vis::worldFrame(info, session.stretch);
    if (session.camera.orientation == vis::Camera{}.orientation)
        session.camera.orientation = vis::firstOrientation(world);
    vis::fit(session.camera, world, aspect);
    if (session.layers.empty()) return;
    constexpr float kFaint = 0.1f; // density of a volume that shows flow and glyphs inside
    const bool flows = std::ranges::any_of(session.layers, [](const vis::Layer& layer) {
        return layer.visible && (std::holds_alternative<vis::FlowLayer>(layer.technique) ||
                                 std::holds_alternative<vis::GlyphLayer>(layer.technique));
    });
    for (vis::Layer& layer : session.layers)
        if (auto* volume = std::get_if<vis::VolumeLayer>(&layer.technique); volume && layer.transfer.empty())
            if (aimFunction(session, source, volume->channel) && flows)
                volume->density = std::min(volume->density, kFaint);
    const auto channel = info.findChannel(vis::shownChannel(session.layers.front().technique));
    if (!channel) return;
    const int time = info.nearestTime(session.time);
    try {
        const volume::ProbeValue here = volume::probeChannel(source, *channel, session.cursor, time);
        if (!here.interpolated) session.cursor = middleOfSamples(source, *channel, time).value_or(session.cursor);
    } catch (const Error&) { // a damaged brick: what the rest says is shown all the same
    }
}

} // namespace tessera::app
