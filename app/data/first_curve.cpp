#include "app/data/first_curve.h"

#include "app/data/boundary_value.h"
#include "app/data/value_body.h"
#include "app/edits/multiples.h"
#include "codec/archive/archive.h"
#include "codec/remote/address.h"
#include "vis/transfer/body_opacity.h"
#include "volume/base/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace tessera::app {

namespace {

/// Where the opacity of materials begins, between the lower one (0) and the strongest boundary (1).
constexpr double kBelowBoundary = 0.25;

bool isRemoteData(const Session& session) {
    const auto& files = session.data.files;
    return !files.empty() && codec::isRemote(files.front().absolutePath);
}

bool isSmall(const volume::BrickSource& source, std::size_t most) {
    return source.grid().lattice.count() <= most || dynamic_cast<const codec::Archive*>(&source);
}

/// Whether values are substantially on both sides of 0, and 0 is meaningful, which it is not for temperatures.
bool signMatters(Range range, const std::string& unit) {
    const double least = std::min(-range.lo, range.hi);
    return least > 0.1 * std::max(-range.lo, range.hi) && unit != "degC" && unit != "\u00b0C" && unit != "C";
}

/// The curve without what it shows below a position.
std::vector<glm::vec2> clearBelow(const std::vector<glm::vec2>& curve, double x) {
    constexpr float kRise = 0.02f;
    const float from = float(x), to = std::min(from + kRise, 1.0f);
    std::vector<glm::vec2> out{{0.0f, 0.0f}, {from, 0.0f}};
    if (to < 1) out.emplace_back(to, float(vis::curveAt(curve, double(to))));
    for (const glm::vec2 point : curve)
        if (point.x > to) out.push_back(point);
    return out;
}

/// The curve of a body; unchanged if there are no values. `from`: the share of the range below which nothing is shown.
void showAsBody(vis::TransferFunction& function, bool ownColors, const Session& session,
                const volume::BrickSource& source, int channel, double from) {
    const volume::DatasetInfo& info = source.info();
    const volume::Channel what = info.channel(channel);
    const bool sign = from == 0 && signMatters(info.channelRange(what), what.unit);
    if (sign && function.autoRange && !ownColors) {
        function.colormap = vis::divergingFunction().colormap;
        function.aboutZero = true;
    }
    Range range = vis::effectiveRange(function, info.channelRange(what));
    if (!(range.hi > range.lo)) range = {range.lo - 1, range.lo + 1}; // one value: as translucent as others
    const ValueBody body = bodyOf(session, source, channel, timesToLookAt(session, source), range, from);
    if (!(body.length > 0)) return;
    const vis::Emphasis emphasis = sign ? vis::Emphasis::Magnitude : vis::Emphasis::High;
    function.opacity = vis::bodyOpacity(body.count, body.length, emphasis);
    if (from > 0) function.opacity = clearBelow(function.opacity, from);
}

/// Share of the volume whose values are above a share of the range.
double shareAbove(const Session& session, const volume::BrickSource& source, int channel, int time, double share) {
    const Range range = source.info().channelRange(source.info().channel(channel));
    const std::vector<double> count = bodyOf(session, source, channel, std::array{std::size_t(time)}, range).count;
    const auto first = count.begin() + long(share * double(count.size()));
    const double all = std::accumulate(count.begin(), count.end(), 0.0);
    return all > 0 ? std::accumulate(first, count.end(), 0.0) / all : 0;
}

/// What a scan, or a field that looks like one, is made of; nothing for what varies smoothly. `background`: of a scan.
std::optional<Materials> materialsShown(const Session& session, const volume::BrickSource& source, int channel,
                                        int time, std::optional<double> background) {
    const volume::Channel what = source.info().channel(channel);
    const Range range = source.info().channelRange(what);
    if (background) {
        const auto boundary = boundaryValue(source, channel, time);
        if (!boundary || !hasMaterials(source, channel, time, *background)) return std::nullopt;
        return Materials{*background, (*boundary - range.lo) / (range.hi - range.lo)};
    }
    const bool whole = source.info().parameters[std::size_t(what.parameter)].type != volume::ScalarType::F32;
    const auto materials = materialsOf(source, channel, time);
    if (whole) return materials ? materials : classesOf(source, channel, time);
    // Of a computed field the upper one is no object in surroundings where it takes most of the space.
    return materials && shareAbove(session, source, channel, time, materials->boundary) < 0.5 ? materials
                                                                                              : std::nullopt;
}

/// The curve of what is made of materials: all above the lower one.
void showAbove(vis::TransferFunction& function, const Materials& materials) {
    const double above = std::max(materials.boundary - materials.below, 0.0);
    function.opacity = {{0.0f, 0.0f}, {float(materials.below + kBelowBoundary * above), 0.0f}, {1.0f, 0.8f}};
}

} // namespace

bool isQuick(const Session& session, const volume::BrickSource& source) {
    return !isRemoteData(session) && isSmall(source, std::size_t(1) << 22);
}

std::vector<std::size_t> timesToLookAt(const Session& session, const volume::BrickSource& source) {
    const std::size_t shown = std::size_t(source.info().nearestTime(session.time));
    if (isRemoteData(session) || !isSmall(source, std::size_t(1) << 20)) return {shown};
    std::vector<std::size_t> times = spreadTimes(source.info().times.size(), 3);
    if (std::ranges::find(times, shown) == times.end()) times.push_back(shown);
    return times;
}

bool aimFunction(Session& session, const volume::BrickSource& source, const std::string& name) {
    const volume::DatasetInfo& info = source.info();
    const auto found = info.findChannel(name);
    const auto transfer = session.transfer.find(name);
    if (!found || transfer == session.transfer.end()) return false;
    const volume::Parameter& parameter = info.parameters[std::size_t(info.channel(*found).parameter)];
    if (parameter.categorical) return false;
    vis::TransferFunction untouched = defaultSession(info, {}).transfer[name];
    const bool ownColors = transfer->second.colormap != untouched.colormap || !transfer->second.colors.empty();
    untouched.colormap = transfer->second.colormap;
    untouched.reversed = transfer->second.reversed;
    untouched.colors = transfer->second.colors;
    if (transfer->second != untouched) return false;
    try {
        const int time = info.nearestTime(session.time);
        const auto background = backgroundShare(source, *found, time);
        if (const auto materials = materialsShown(session, source, *found, time, background))
            showAbove(transfer->second, *materials);
        else
            showAsBody(transfer->second, ownColors, session, source, *found, background.value_or(0));
        return true;
    } catch (const Error&) { // a damaged brick: what the rest says is shown all the same
        return false;
    }
}

} // namespace tessera::app
