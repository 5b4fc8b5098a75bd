#include "vis/scene/selection.h"

#include "vis/scene/brush_effect.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace tessera::vis {

namespace {

void addOnce(std::vector<std::string>& names, const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

/// Signed distance from a point to a polygon (even-odd rule), negative inside.
double polygonDistance(std::span<const glm::dvec2> points, glm::dvec2 p) {
    double nearest = std::numeric_limits<double>::infinity();
    bool inside = false;
    for (std::size_t i = 0, j = points.size() - 1; i < points.size(); j = i++) {
        const glm::dvec2 a = points[j], edge = points[i] - a, to = p - a;
        const double length = glm::dot(edge, edge);
        const double along = length > 0 ? std::clamp(glm::dot(to, edge) / length, 0.0, 1.0) : 0;
        const glm::dvec2 away = to - edge * along;
        nearest = std::min(nearest, glm::dot(away, away));
        if ((points[i].y > p.y) != (a.y > p.y) && p.x < a.x + edge.x * (p.y - a.y) / edge.y) inside = !inside;
    }
    return std::sqrt(nearest) * (inside ? -1 : 1);
}

} // namespace

bool Selection::active() const {
    return std::any_of(brushes.begin(), brushes.end(), [](const Brush& brush) { return brush.enabled; });
}

Brush rangeBrush(std::vector<BrushInterval> intervals, std::string name) {
    Brush brush;
    brush.name = std::move(name);
    brush.region = RangeRegion{std::move(intervals)};
    return brush;
}

std::vector<std::string> regionChannels(const Region& region) {
    std::vector<std::string> names;
    if (const auto* range = std::get_if<RangeRegion>(&region))
        for (const BrushInterval& interval : range->intervals) addOnce(names, interval.channel);
    const auto both = [&](const auto& plane) {
        addOnce(names, plane.x);
        addOnce(names, plane.y);
    };
    if (const auto* ellipse = std::get_if<EllipseRegion>(&region)) both(*ellipse);
    if (const auto* lasso = std::get_if<LassoRegion>(&region)) both(*lasso);
    return names;
}

std::vector<std::string> selectedChannels(const Selection& selection) {
    std::vector<std::string> names;
    for (const Brush& brush : selection.brushes)
        if (brush.enabled)
            for (const std::string& name : regionChannels(brush.region)) addOnce(names, name);
    return names;
}

bool selectsSpace(const Selection& selection) {
    return std::any_of(selection.brushes.begin(), selection.brushes.end(), [](const Brush& brush) {
        return brush.enabled &&
               (std::holds_alternative<SphereRegion>(brush.region) || std::holds_alternative<BoxRegion>(brush.region) ||
                std::holds_alternative<LensRegion>(brush.region));
    });
}

bool selectsLens(const Selection& selection) {
    return std::any_of(selection.brushes.begin(), selection.brushes.end(), [](const Brush& brush) {
        return brush.enabled && std::holds_alternative<LensRegion>(brush.region);
    });
}

double intervalDoi(const BrushInterval& interval, double value) {
    if (std::isnan(value)) return 0;
    return softEdge(std::max({interval.lo - value, value - interval.hi, 0.0}), interval.soft);
}

double radialDoi(double radii, double soft) {
    return std::isnan(radii) ? 0 : softEdge(std::max(radii - 1, 0.0), soft);
}

double ellipseRadii(double u, double v, double correlation) {
    return std::sqrt(ellipseSquare(u, v, correlation));
}

LassoPlace lassoPlace(const LassoRegion& lasso) {
    LassoPlace place;
    if (lasso.points.size() < 3) return place;
    glm::dvec2 lo = lasso.points.front(), hi = lo;
    for (const glm::dvec2& point : lasso.points) {
        lo = glm::min(lo, point);
        hi = glm::max(hi, point);
    }
    place.center = (lo + hi) * 0.5;
    place.halfSize = glm::max((hi - lo) * 0.5, glm::abs(place.center) * 1e-9 + 1e-30);
    place.extent = 1 + std::max(0.0, lasso.soft) + 4.0 / kLassoTable;
    return place;
}

LassoTable lassoTable(const LassoRegion& lasso) {
    constexpr auto kSide = std::size_t(kLassoTable);
    LassoTable table{lassoPlace(lasso), std::vector<float>(kSide * kSide, 0.0f)};
    if (lasso.points.size() < 3) return table;
    std::vector<glm::dvec2> points;
    for (const glm::dvec2& point : lasso.points) points.push_back((point - table.place.center) / table.place.halfSize);
    // A hard edge becomes a ramp one entry wide, centred on the outline.
    const double entry = 2 * table.place.extent / (kLassoTable - 1);
    const bool soft = lasso.soft > entry;
    for (std::size_t j = 0; j < kSide; ++j)
        for (std::size_t i = 0; i < kSide; ++i) {
            const glm::dvec2 at = glm::dvec2(double(i), double(j)) * entry - table.place.extent;
            const double distance = polygonDistance(points, at);
            const double doi = soft ? 1 - distance / lasso.soft : 0.5 - distance / entry;
            table.doi[j * kSide + i] = float(std::clamp(doi, 0.0, 1.0));
        }
    return table;
}

double LassoTable::at(double x, double y) const {
    const glm::dvec2 at =
        ((glm::dvec2(x, y) - place.center) / place.halfSize / place.extent + 1.0) * (0.5 * (kLassoTable - 1));
    if (!(at.x >= 0 && at.y >= 0 && at.x <= kLassoTable - 1 && at.y <= kLassoTable - 1)) return 0;
    const auto i = std::min(std::size_t(at.x), std::size_t(kLassoTable - 2));
    const auto j = std::min(std::size_t(at.y), std::size_t(kLassoTable - 2));
    const double fx = at.x - double(i), fy = at.y - double(j);
    const float* entry = &doi[j * kLassoTable + i];
    return glm::mix(glm::mix(double(entry[0]), double(entry[1]), fx),
                    glm::mix(double(entry[kLassoTable]), double(entry[kLassoTable + 1]), fx), fy);
}

SheetBox sheetBox(const SphereRegion& region, const volume::AxisMaps& axes) {
    return {axes.toSheet(region.center), region.radius};
}

SheetBox sheetBox(const BoxRegion& region, const volume::AxisMaps& axes) {
    SheetBox box{region.center, region.radius};
    for (int axis = 0; axis < 3; ++axis) {
        if (!axes[axis]) continue;
        const double lo = axes.toSheet(axis, region.center[axis] - region.radius[axis]);
        const double hi = axes.toSheet(axis, region.center[axis] + region.radius[axis]);
        box.center[axis] = (lo + hi) / 2;
        box.radius[axis] = (hi - lo) / 2;
    }
    return box;
}

DoiFunction::DoiFunction(const Selection& selection, LensSpace space)
    : channels_(selectedChannels(selection)), space_(std::move(space)) {
    const auto place = [&](const std::string& name) {
        return int(std::find(channels_.begin(), channels_.end(), name) - channels_.begin());
    };
    for (const Brush& brush : selection.brushes) {
        if (!brush.enabled) continue;
        Part part{brush, {}, {}, {}};
        if (const auto* range = std::get_if<RangeRegion>(&brush.region))
            for (const BrushInterval& interval : range->intervals) part.channel.push_back(place(interval.channel));
        if (const auto* ellipse = std::get_if<EllipseRegion>(&brush.region))
            part.channel = {place(ellipse->x), place(ellipse->y)};
        if (const auto* lasso = std::get_if<LassoRegion>(&brush.region)) {
            part.channel = {place(lasso->x), place(lasso->y)};
            part.lasso = lassoTable(*lasso);
        }
        if (const auto* ball = std::get_if<SphereRegion>(&brush.region)) part.box = sheetBox(*ball, space_.frame.axes);
        if (const auto* box = std::get_if<BoxRegion>(&brush.region)) part.box = sheetBox(*box, space_.frame.axes);
        parts_.push_back(std::move(part));
    }
}

double DoiFunction::regionDoi(const Part& part, std::span<const double> values, glm::dvec3 position) const {
    const auto value = [&](std::size_t i) { return values[std::size_t(part.channel[i])]; };
    if (const auto* range = std::get_if<RangeRegion>(&part.brush.region)) {
        double doi = 1;
        for (std::size_t i = 0; i < range->intervals.size(); ++i)
            doi = std::min(doi, intervalDoi(range->intervals[i], value(i)));
        return doi;
    }
    if (const auto* ellipse = std::get_if<EllipseRegion>(&part.brush.region))
        return radialDoi(ellipseRadii((value(0) - ellipse->center.x) / ellipse->radius.x,
                                      (value(1) - ellipse->center.y) / ellipse->radius.y, ellipse->correlation),
                         ellipse->soft);
    if (std::holds_alternative<LassoRegion>(part.brush.region)) return part.lasso.at(value(0), value(1));
    const volume::AxisMaps& axes = space_.frame.axes;
    if (const auto* sphere = std::get_if<SphereRegion>(&part.brush.region)) {
        return radialDoi(glm::length((axes.toSheet(position) - part.box.center) / part.box.radius), sphere->soft);
    }
    if (const auto* lens = std::get_if<LensRegion>(&part.brush.region)) {
        double most = 0;
        for (const PlacedLens& one : space_.lenses)
            if (lens->lens.empty() ? one.marks : one.name == lens->lens)
                most = std::max(most, one.weight(space_.frame.toWorld(position)));
        return most;
    }
    const auto& box = std::get<BoxRegion>(part.brush.region);
    const glm::dvec3 away = glm::abs((axes.toSheet(position) - part.box.center) / part.box.radius);
    return radialDoi(std::max({away.x, away.y, away.z}), box.soft);
}

double DoiFunction::operator()(std::span<const double> values, glm::dvec3 position) const {
    if (parts_.empty()) return 1;
    double doi = parts_.front().brush.combine == BrushCombine::Or ? 0 : 1;
    for (const Part& part : parts_) {
        double own = regionDoi(part, values, position);
        const bool absent =
            std::ranges::any_of(part.channel, [&](int channel) { return std::isnan(values[std::size_t(channel)]); });
        if (part.brush.inverted && absent && part.brush.combine != BrushCombine::Minus)
            own = 0;
        else if (part.brush.inverted)
            own = 1 - own;
        switch (part.brush.combine) {
        case BrushCombine::And:
            doi = std::min(doi, own);
            break;
        case BrushCombine::Or:
            doi = std::max(doi, own);
            break;
        case BrushCombine::Minus:
            doi = std::min(doi, 1 - own);
            break;
        }
    }
    return doi;
}

DoiFunction::Holder DoiFunction::holder(std::span<const double> values, glm::dvec3 position) const {
    Holder most;
    for (const Part& part : parts_) {
        if (part.brush.inverted || part.brush.combine == BrushCombine::Minus) continue;
        const double own = regionDoi(part, values, position);
        if (own > most.interest) most = {part.brush.color, own};
    }
    return most;
}

double degreeOfInterest(const Selection& selection, const std::function<double(const std::string& channel)>& valueOf,
                        glm::dvec3 position) {
    const DoiFunction doi(selection);
    std::vector<double> values;
    for (const std::string& channel : doi.channels()) values.push_back(valueOf(channel));
    return doi(values, position);
}

} // namespace tessera::vis
