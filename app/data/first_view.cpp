#include "app/data/first_view.h"

#include "app/data/boundary_value.h"
#include "app/data/coarse_samples.h"
#include "app/edits/region_surface.h"
#include "codec/archive/archive.h"
#include "codec/remote/address.h"
#include "vis/transfer/tail_opacity.h"
#include "volume/base/error.h"
#include "volume/reconstruct/probe.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

constexpr int kViewBins = 256;
/// Where the opacity of materials begins, between the lower one (0) and the strongest boundary (1).
constexpr double kBelowBoundary = 0.4;
/// Share of the grid's samples (absent ones included) that should be visible at first: fewer are hard to find in the
/// box, more hide what is behind them.
constexpr double kLeastSeen = 0.02, kMostSeen = 0.2;

/// Histogram of a coarse level over `range`, and its number of samples including absent ones.
struct Occurrence {
    std::vector<std::uint64_t> count = std::vector<std::uint64_t>(kViewBins, 0);
    std::uint64_t places = 0;
};

Occurrence occurrenceOf(const volume::BrickSource& source, int channel, int time, Range range) {
    Occurrence out;
    const int level = source.grid().levelWithin(kQuickSamples);
    const auto all = [](glm::ivec3, glm::ivec3) { return true; };
    forSamples(source, channel, time, level, all, [&](glm::ivec3, float value) {
        const double share = (value - range.lo) / (range.hi - range.lo);
        ++out.count[static_cast<std::size_t>(std::clamp(share * kViewBins, 0.0, kViewBins - 1.0))];
    });
    const glm::i64vec3 size(source.grid().levelSamples(level));
    out.places = static_cast<std::uint64_t>(size.x * size.y * size.z);
    return out;
}

/// Whether values are substantially on both sides of 0, and 0 is meaningful, which it is not for temperatures.
bool signMatters(Range range, const std::string& unit) {
    const double least = std::min(-range.lo, range.hi);
    return least > 0.1 * std::max(-range.lo, range.hi) && unit != "degC" && unit != "\u00b0C" && unit != "C";
}

/// The initial opacity curve of a computed field; unchanged if there are no values.
void showTails(vis::TransferFunction& function, const volume::BrickSource& source, int channel, int time) {
    const volume::DatasetInfo& info = source.info();
    const volume::Channel what = info.channels()[static_cast<std::size_t>(channel)];
    const bool sign = signMatters(info.channelRange(what), what.unit);
    if (sign && function.autoRange) {
        function.colormap = vis::divergingFunction().colormap;
        function.aboutZero = true;
    }
    const Range range = vis::effectiveRange(function, info.channelRange(what));
    if (!(range.hi > range.lo)) return;
    const Occurrence occurrence = occurrenceOf(source, channel, time, range);
    if (sign) {
        function.opacity = vis::signedTailOpacity(occurrence.count, kMostSeen);
        return;
    }
    const double seen = vis::seenShare(occurrence.count, occurrence.places, function.opacity);
    if (seen >= kLeastSeen && seen <= kMostSeen) return;
    function.opacity = vis::tailOpacity(occurrence.count, kMostSeen);
    vis::seeAtLeast(function.opacity, occurrence.count, occurrence.places, kLeastSeen);
}

/// Chooses the opacity curve of a channel from its values, unless its function was changed.
void chooseCurve(Session& session, const volume::BrickSource& source, int channel, const std::string& name, int time) {
    const volume::DatasetInfo& info = source.info();
    const auto transfer = session.transfer.find(name);
    if (transfer == session.transfer.end() || transfer->second != defaultSession(info, {}).transfer[name]) return;
    const volume::Channel what = info.channels()[static_cast<std::size_t>(channel)];
    const volume::Parameter& parameter = info.parameters[static_cast<std::size_t>(what.parameter)];
    if (parameter.categorical) return;
    const Range range = info.channelRange(what);
    std::optional<Materials> materials;
    if (const auto share = backgroundShare(source, channel, time)) {
        const auto boundary = boundaryValue(source, channel, time);
        materials = {*share, boundary ? (*boundary - range.lo) / (range.hi - range.lo) : *share};
    } else {
        materials = materialsOf(source, channel, time);
    }
    if (materials) {
        const double above = std::max(materials->boundary - materials->below, 0.0);
        const float x = static_cast<float>(materials->below + kBelowBoundary * above);
        transfer->second.opacity = {{0.0f, 0.0f}, {x, 0.0f}, {1.0f, 0.8f}};
    } else if (parameter.type == volume::ScalarType::F32) {
        showTails(transfer->second, source, channel, time);
    }
}

void aimAtSamples(Session& session, const volume::BrickSource& source, int channel, const std::string& name, int time) {
    const volume::ProbeValue here = volume::probeChannel(source, channel, session.cursor, time);
    if (!here.interpolated) session.cursor = middleOfSamples(source, channel, time).value_or(session.cursor);
    chooseCurve(session, source, channel, name, time);
}

} // namespace

void aimFunction(Session& session, const volume::BrickSource& source, const std::string& name) {
    const volume::DatasetInfo& info = source.info();
    const auto channel = info.findChannel(name);
    if (!channel) return;
    try {
        chooseCurve(session, source, *channel, name, info.nearestTime(session.time));
    } catch (const Error&) { // a damaged brick: what the rest says is shown all the same
    }
}

void showLastIfEmpty(Session& session, const volume::BrickSource& source, std::vector<std::string>& messages) {
    const volume::DatasetInfo& info = source.info();
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
        const Occurrence occurrence = occurrenceOf(source, *channel, info.nearestTime(time), range);
        return vis::seenShare(occurrence.count, occurrence.places, function.opacity);
    };
    try {
        const double now = seen(session.time), last = info.times.back();
        if (now >= kLeastSeen || !(seen(last) > now)) return;
        session.time = last;
        messages.push_back(name + " would hardly be seen at the first time; the last one is shown");
    } catch (const Error&) { // a damaged brick: the first time is shown
    }
}

namespace {

/// Whether a coarse level of the data can be read while the user waits.
bool isQuick(const Session& session, const volume::BrickSource& source) {
    constexpr std::size_t kMost = std::size_t(1) << 22; // samples
    const auto& files = session.data.files;
    if (!files.empty() && codec::isRemote(files.front().absolutePath)) return false;
    return source.grid().lattice.count() <= kMost || dynamic_cast<const codec::Archive*>(&source);
}

} // namespace

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
    const std::string name = vis::shownChannel(session.layers.front().technique);
    const auto channel = info.findChannel(name);
    if (!channel) return;
    const int time = info.nearestTime(session.time);
    try {
        aimAtSamples(session, source, *channel, name, time);
    } catch (const Error&) { // a damaged brick: what the rest says is shown all the same
    }
}

} // namespace tessera::app
