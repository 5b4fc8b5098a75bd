#include "app/views/hyperslice/hyper_axes.h"

#include "app/ui/time_text.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr double kLeastPart = 1e-4; ///< of an axis that can be shown

/// Where `from` rises, the value of `to` at `value`: linear between entries, the ends beyond them.
double mapped(const std::vector<double>& from, const std::vector<double>& to, double value) {
    if (from.size() < 2 || value <= from.front()) return to.front();
    if (value >= from.back()) return to.back();
    const auto next = std::ranges::upper_bound(from, value);
    const auto k = static_cast<std::size_t>(next - from.begin());
    return std::lerp(to[k - 1], to[k], (value - from[k - 1]) / (from[k] - from[k - 1]));
}

/// An axis with a place for each time; nothing where these neither only rise nor only fall.
std::optional<HyperAxis> axisOverTimes(const std::string& key, const std::string& title, const std::string& unit,
                                       std::vector<double> places, std::vector<double> times) {
    if (!std::ranges::all_of(places, [](double each) { return std::isfinite(each); })) return std::nullopt;
    if (places.front() > places.back()) {
        std::ranges::reverse(places);
        std::ranges::reverse(times);
    }
    if (std::ranges::adjacent_find(places, std::greater_equal()) != places.end()) return std::nullopt;
    HyperAxis axis{.key = key, .label = {}, .along = {}, .whole = {}, .shown = {}};
    axis.label.name = title;
    axis.label.unit = {unit, 1};
    axis.whole = axis.shown = {places.front(), places.back()};
    axis.along = {.dimension = kTimeDimension, .places = std::move(places), .times = std::move(times)};
    return axis;
}

} // namespace

double AxisPlaces::at(double place, const volume::AxisMaps& maps) const {
    return ofTime() ? mapped(places, times, place) : maps.toSpace(dimension, place / perUnit);
}

double AxisPlaces::placeOf(double coordinate, const volume::AxisMaps& maps) const {
    if (!ofTime()) return maps.toSheet(dimension, coordinate) * perUnit;
    if (times.front() < times.back()) return mapped(times, places, coordinate);
    return mapped({times.rbegin(), times.rend()}, {places.rbegin(), places.rend()}, coordinate);
}

std::vector<HyperAxis> possibleAxes(const Session& session, const volume::DatasetInfo& info) {
    std::vector<HyperAxis> axes;
    const AxisLabels labels = axisLabels(session, info);
    for (int axis = 0; axis < 3; ++axis) {
        if (!(info.bounds.hi[axis] > info.bounds.lo[axis])) continue;
        const AxisLabel& label = labels[static_cast<std::size_t>(axis)];
        HyperAxis& own = axes.emplace_back(
            HyperAxis{.key = std::string(1, "xyz"[axis]), .label = label, .along = {}, .whole = {}, .shown = {}});
        own.along = {.dimension = axis, .perUnit = label.unit.perUnit, .places = {}, .times = {}};
        own.whole = own.shown = {info.bounds.lo[axis] * label.unit.perUnit, info.bounds.hi[axis] * label.unit.perUnit};
    }
    if (info.times.size() < 2) return axes;
    if (auto time = axisOverTimes("time", timeWord(info), info.timeUnit, info.times, info.times))
        axes.push_back(std::move(*time));
    for (const volume::Quantity& quantity : info.quantities)
        if (quantity.values.size() == info.times.size())
            if (auto own = axisOverTimes(quantity.name, quantity.name, quantity.unit, quantity.values, info.times))
                axes.push_back(std::move(*own));
    return axes;
}

std::vector<HyperAxis> axesOfView(const HyperSliceView& view, const Session& session, const volume::DatasetInfo& info) {
    const std::vector<HyperAxis> all = possibleAxes(session, info);
    std::vector<HyperAxis> out;
    const auto add = [&](const std::string& key) {
        const auto found = std::ranges::find(all, key, &HyperAxis::key);
        if (found == all.end()) return;
        const bool taken = std::ranges::any_of(
            out, [&](const HyperAxis& own) { return own.along.dimension == found->along.dimension; });
        if (!taken) out.push_back(*found);
    };
    for (const std::string& key : view.axes) add(key);
    if (out.empty())
        for (const char* key : {"x", "y", "z", "time"}) add(key);
    for (HyperAxis& axis : out) {
        const auto zoom = view.zoom.find(axis.key);
        if (zoom == view.zoom.end()) continue;
        const AxisScale scale = axis.label.scale();
        const Range part{std::clamp(scale.place(zoom->second.lo), axis.whole.lo, axis.whole.hi),
                         std::clamp(scale.place(zoom->second.hi), axis.whole.lo, axis.whole.hi)};
        if (part.hi - part.lo >= kLeastPart / 2 * (axis.whole.hi - axis.whole.lo)) axis.shown = part;
    }
    return out;
}

double placeAtCursor(const HyperAxis& axis, const Session& session, const volume::DatasetInfo& info) {
    const AxisPlaces& along = axis.along;
    return along.placeOf(along.ofTime() ? session.time : session.cursor[along.dimension], info.lattice.axes);
}

void goToPlace(const HyperAxis& axis, double place, Session& session, const volume::DatasetInfo& info) {
    const int dimension = axis.along.dimension;
    const double to = axis.along.at(std::clamp(place, axis.whole.lo, axis.whole.hi), info.lattice.axes);
    if (axis.along.ofTime()) {
        session.time = to;
        session.animation.playing = false;
    } else {
        session.cursor[dimension] = std::clamp(to, info.bounds.lo[dimension], info.bounds.hi[dimension]);
    }
}

double snappedPlace(const HyperAxis& axis, double place, double near) {
    if (!axis.along.ofTime()) return place;
    const auto nearest =
        std::ranges::min_element(axis.along.places, {}, [&](double each) { return std::abs(each - place); });
    return std::abs(*nearest - place) < near ? *nearest : place;
}

void showPart(HyperSliceView& view, const HyperAxis& axis, Range part) {
    const double whole = axis.whole.hi - axis.whole.lo;
    part = {std::max(part.lo, axis.whole.lo), std::min(part.hi, axis.whole.hi)};
    if (part.hi - part.lo < kLeastPart * whole) return;
    if (part.hi - part.lo >= whole * 0.999) {
        view.zoom.erase(axis.key);
        return;
    }
    const AxisScale scale = axis.label.scale();
    view.zoom[axis.key] = {scale.number(part.lo), scale.number(part.hi)};
}

Range zoomedPart(const HyperAxis& axis, double about, double factor, double shift) {
    const double width = std::min((axis.shown.hi - axis.shown.lo) * factor, axis.whole.hi - axis.whole.lo);
    const double lo = std::clamp(about + (axis.shown.lo - about) * factor + shift, axis.whole.lo,
                                 std::max(axis.whole.lo, axis.whole.hi - width));
    return {lo, lo + width};
}

} // namespace tessera::app
