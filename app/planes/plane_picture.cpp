#include "app/planes/plane_picture.h"

#include "app/pane/axes3d.h"
#include "app/pane/shown_plane.h"
#include "app/pane/view_parts.h"
#include "app/ui/ticks.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::app {

namespace {

constexpr double kSameOffset = 1e-9; ///< of the box: closer planes are one
constexpr double kTiltMargin = 0.02; ///< around the part in the box of a tilted plane
constexpr double kAlong = 1 - 1e-8;  ///< cosine to an axis from which on a direction has its name
constexpr double kLeastSpan = 1e-3;  ///< of the box, where the plane touches a corner only
constexpr int kTableCells = 96;      ///< along the longer edge

/// What values span, with a margin and never less than `least`.
Range spanOf(const std::vector<double>& values, double least) {
    const auto [lo, hi] = std::minmax_element(values.begin(), values.end());
    const double margin = std::max(kTiltMargin * (*hi - *lo), (least - (*hi - *lo)) / 2);
    return {*lo - margin, *hi + margin};
}

/// Of a direction along an axis its own name and numbers, else the other one; without numbers where it runs across
/// several axes of which one is uneven, since then there are none.
AxisLabel planeLabel(glm::dvec3 direction, const char* other, const volume::DatasetInfo& info, Range span) {
    const glm::dvec3 size = glm::abs(direction);
    AxisLabel label{.name = other, .unit = suitableLength(info.lengthUnit, span.hi - span.lo)};
    for (int axis = 0; axis < 3; ++axis) {
        if (size[axis] > kAlong) {
            label.name = directionText(direction);
            label.map = info.lattice.axes.of[static_cast<std::size_t>(axis)];
            label.reversed = direction[axis] < 0;
            label.blank = false;
            break;
        }
        if (size[axis] > 1 - kAlong && info.lattice.axes[axis]) label.blank = true;
    }
    return label;
}

/// As many samples along both edges as suit their lengths; lengths and times have no proportion.
glm::ivec2 tableCells(const volume::DatasetInfo& info, glm::dvec2 edges) {
    const double longer = std::max(edges.x, edges.y);
    if (!(longer > 0) || info.timeAxis()) return glm::ivec2(kTableCells);
    return glm::max(glm::ivec2(glm::round(edges / longer * static_cast<double>(kTableCells))), glm::ivec2(2));
}

/// Of places of the sheet.
std::vector<glm::dvec3> inSpace(std::vector<glm::dvec3> places, const volume::AxisMaps& maps) {
    for (glm::dvec3& place : places) place = maps.toSpace(place);
    return places;
}

void show(PlanePicture& picture, const Session& session, const volume::DatasetInfo& info, const PlaneContent& shows) {
    const volume::Channel own = info.channel(shows.channel);
    picture.positions = axisLabels(session, info);
    picture.cells = tableCells(info, {picture.x.hi - picture.x.lo, picture.y.hi - picture.y.lo});
    picture.shows = shows;
    picture.time = volume::timesAround(info.times, session.time);
    picture.function = transferOf(session, own.name);
    picture.range = vis::effectiveRange(picture.function, info.channelRange(own));
    picture.lined = contourChannel(info, shows.lines, shows.channel);
    if (picture.lined) picture.levels = contourLevels(session, info, *picture.lined, shows.lines.count);
    if (!shows.plain) picture.sections = planeSections(session, info, picture.plane);
    if (!shows.plain || shows.crossed) picture.cursor = picture.along(session.cursor);
}

} // namespace

PlanePicture axisPlane(const Session& session, const volume::DatasetInfo& info, const SliceAxes& axes, double position,
                       const PlaneContent& shows) {
    const auto& [right, up, normal] = axes;
    const AxisLabels labels = axisLabels(session, info);
    const AxisLabel& across = labels[static_cast<std::size_t>(normal)];
    const LengthUnit& unit = across.unit;
    PlanePicture picture;
    picture.maps = info.lattice.axes;
    picture.plane = planeAcross(right, up, normal, picture.maps.toSheet(normal, position));
    picture.axes = axes;
    picture.x = {info.bounds.lo[right], info.bounds.hi[right]};
    picture.y = {info.bounds.lo[up], info.bounds.hi[up]};
    const glm::dvec3 half = vis::worldFrame(info, session.stretch).halfSize;
    picture.size = 2.0 * glm::dvec2(half[right], half[up]);
    picture.corners = inSpace(planeSection(picture.plane.plane(), info.bounds), picture.maps);
    picture.right = labels[static_cast<std::size_t>(right)];
    picture.up = labels[static_cast<std::size_t>(up)];
    const double digits = tellingLength(info, normal, picture.maps.toSpace(picture.plane.at), 0.01) * unit.perUnit;
    picture.place = across.name + " = " + formatQuantity(position * unit.perUnit, unit.name, digits);
    if (const std::string follows = followsText(info, normal, position); !follows.empty())
        picture.place += ", " + follows;
    show(picture, session, info, shows);
    return picture;
}

PlanePicture tiltedPlane(const Session& session, const volume::DatasetInfo& info, glm::dvec3 normal,
                         const PlaneContent& shows) {
    const double size = glm::length(info.bounds.size()), same = kSameOffset * std::max(size, 1e-300);
    const FlatAxes axes = flatAxes(normal, vis::worldFrame(info, session.stretch));
    const glm::dvec3 way = unitNormal(normal);
    PlanePicture picture;
    picture.maps = info.lattice.axes;
    const double offset = std::round(glm::dot(way, picture.maps.toSheet(session.cursor)) / same) * same;
    picture.plane = {way * offset, axes.right, axes.up};
    picture.corners = inSpace(planeSection(picture.plane.plane(), info.bounds), picture.maps);
    std::vector<double> across, upwards;
    for (const glm::dvec3& corner : picture.corners.empty() ? std::vector{session.cursor} : picture.corners) {
        across.push_back(picture.along(corner).x);
        upwards.push_back(picture.along(corner).y);
    }
    picture.x = spanOf(across, kLeastSpan * size);
    picture.y = spanOf(upwards, kLeastSpan * size);
    picture.size = glm::dvec2(picture.x.hi - picture.x.lo, picture.y.hi - picture.y.lo) * axes.scale;
    picture.right = planeLabel(axes.right, "u", info, picture.x);
    picture.up = planeLabel(axes.up, "v", info, picture.y);
    const LengthUnit unit = suitableLength(info.lengthUnit, size);
    const AxisLabel normalTo = planeLabel(way, "", info, {0, size});
    picture.place = "across " + directionText(way);
    if (!normalTo.blank)
        picture.place +=
            " at " + formatQuantity(AxisScale{normalTo.map, 1, normalTo.reversed}.number(offset) * unit.perUnit,
                                    unit.name, size * unit.perUnit / 1000);
    show(picture, session, info, shows);
    return picture;
}

PlanePicture atTime(PlanePicture picture, const volume::DatasetInfo& info, double time) {
    picture.ownTime = time;
    picture.time = volume::timesAround(info.times, time);
    return picture;
}

std::array<std::string, 2> axisTexts(const PlanePicture& picture) {
    const auto text = [&](const AxisLabel& label, const char* other, glm::dvec3 direction) {
        return !picture.axes && label.name == other ? label.name + " = " + directionText(direction) : label.name;
    };
    return {text(picture.right, "u", picture.plane.right), text(picture.up, "v", picture.plane.up)};
}

std::string axesText(const PlanePicture& picture) {
    const auto [right, up] = axisTexts(picture);
    const bool named = right != picture.right.name, both = named && up != picture.up.name;
    return both ? right + ", " + up : named ? right : up != picture.up.name ? up : "";
}

std::string unevenText(const PlanePicture& picture) {
    volume::AxisMaps along = picture.maps;
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(picture.plane.right[axis]) < 1 - kAlong && std::abs(picture.plane.up[axis]) < 1 - kAlong)
            along.of[static_cast<std::size_t>(axis)] = nullptr;
    return stretchText(glm::dvec3(1), along);
}

ContourQuery contourQuery(const PlanePicture& picture) {
    return {picture.lined.value_or(0), picture.plane, picture.x, picture.y, picture.time,
            picture.levels.values,     picture.maps};
}

std::string planeNote(const volume::DatasetInfo& info, const PlanePicture& picture) {
    const ContourSettings& lines = picture.shows.lines;
    std::string note;
    if (lines.count > 0 && lines.drawn())
        note = picture.lined
                   ? contourTitle(info.channel(*picture.lined), picture.levels)
                   : "no contour lines: " +
                         (info.findChannel(lines.channel) ? "labels have none" : "there is no " + lines.channel);
    const std::string& vector = picture.shows.strokes.vector;
    if (vector.empty()) return note;
    const bool known = std::ranges::any_of(info.parameters, [&](const volume::Parameter& parameter) {
        return parameter.components == 3 && parameter.name == vector;
    });
    const std::string own = known ? "strokes along " + vector : "no strokes: there is no vector " + vector;
    return note.empty() ? own : note + "; " + own;
}

glm::dvec3 nearestPlace(const PlanePicture& picture, const volume::Box& box, glm::dvec2 along) {
    if (picture.axes)
        return picture.placeAt(
            {std::clamp(along.x, picture.x.lo, picture.x.hi), std::clamp(along.y, picture.y.lo, picture.y.hi)});
    return picture.maps.toSpace(nearestInPlane(picture.plane.plane(), box, picture.plane.placeAt(along)));
}

void stepAcross(Session& session, const volume::DatasetInfo& info, const PlanePicture& picture, double samples) {
    glm::dvec3 way = picture.plane.plane().normal;
    if (picture.axes) way = glm::abs(way); // towards larger coordinates
    const double cell = info.lattice.kind == volume::LatticeKind::BCC ? 0.5 : 1;
    const glm::dvec3 from = picture.maps.toSheet(session.cursor);
    const glm::dvec3 to = from + way * (samples * cell / glm::length(way / info.lattice.spacing));
    session.cursor = picture.maps.toSpace(picture.axes ? glm::clamp(to, info.bounds.lo, info.bounds.hi)
                                                       : nearestInPlane({way, to}, info.bounds, to));
}

} // namespace tessera::app
