#pragma once

#include "volume/field/dataset.h"
#include "volume/field/space_axis.h"

#include <optional>

/// Planes of data in space and time, in any direction, as data: what moves becomes a shape that is seen at once
/// (Röber 2002, section 4.1.3).
namespace tessera::volume {

/// The points with a x + b y + c z + d t + e = 0, in units of the data.
struct PlaneEquation {
    double a = 0, b = 0, c = 0, d = 1, e = 0;
    bool operator==(const PlaneEquation&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.a, FieldInfo{"a", "Factor of x, a length in the unit of the data"});
        visit(self.b, FieldInfo{"b", "Factor of y"});
        visit(self.c, FieldInfo{"c", "Factor of z"});
        visit(self.d, FieldInfo{"d", "Factor of t, a time in the unit of the data"});
        visit(self.e, FieldInfo{"e", "What is added: of a plane d t + e = 0, minus the time if d is 1"});
    }
};

/// A plane in space and time: an axis of space exchanged for time by an angle, around a place and a time; or any.
struct TimeAxis {
    SpaceAxis axis = SpaceAxis::Z;
    double place = 0.5;
    double degrees = 90;
    double time = 0.5;
    std::optional<PlaneEquation> equation = {};
    bool operator==(const TimeAxis&) const = default;
    static void describe(auto& self, auto&& visit) {
        const bool turned = !self.equation;
        visit(self.axis, FieldInfo{.key = "axis",
                                   .doc = "Axis of space that is exchanged for time",
                                   .names = kSpaceAxisNames,
                                   .applies = turned});
        visit(self.degrees,
              FieldInfo{.key = "degrees",
                        .doc = "How far it is exchanged: 0 shows the data at one time, 90 time along the axis at one "
                               "place, and between the plane moves along the axis; at 45 it passes all of the axis "
                               "in the time from the first to the last, less than 0 backwards",
                        .unit = "deg",
                        .range = Range{-90, 90},
                        .applies = turned});
        visit(self.place, FieldInfo{.key = "place",
                                    .doc = "Position of the plane along that axis, as a share of its length",
                                    .range = Range{0, 1},
                                    .applies = turned});
        visit(self.time, FieldInfo{.key = "time",
                                   .doc = "When the plane is at that position, as a share of the time from the first "
                                          "to the last",
                                   .range = Range{0, 1},
                                   .applies = turned});
        visit(self.equation,
              FieldInfo{"equation", "In place of axis and angle: the plane a x + b y + c z + d t + e = 0"});
    }
};

/// The plane that is meant, of data. It is solved for the axis whose share of the normal, times its extent, is largest,
/// of equal ones the last. Throws Error where the data have one time, the normal is 0, or the plane does not meet them.
SpaceTimePlane planeOf(const DatasetInfo& info, const TimeAxis& wanted);

/// The setting of a plane moved so that it holds a point (x, y, z, t), clamped to the data. `now`: as it is.
TimeAxis movedTo(const SpaceTimePlane& now, TimeAxis setting, glm::dvec4 point);

} // namespace tessera::volume
