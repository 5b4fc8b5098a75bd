#pragma once

#include "volume/bricks/brick_source.h"
#include "volume/field/space_axis.h"

#include <memory>
#include <optional>

/// Data whose time runs along an axis of space: what moves becomes a shape that is seen at once.
namespace tessera::volume {

struct TimeAxis {
    SpaceAxis axis = SpaceAxis::Z;
    double place = 0.5;
    bool operator==(const TimeAxis&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.axis, FieldInfo{.key = "axis", .doc = "Axis along which time is shown", .names = kSpaceAxisNames});
        visit(self.place, FieldInfo{.key = "place",
                                    .doc = "Position of the plane along that axis, as a share of its length",
                                    .range = Range{0, 1}});
    }
};

/// The plane of a data set at axis.place, at all times, as a data set of one time in which time takes the place of that
/// axis. It keeps the extent of the axis: a time t lies at t / timePerLength(), so that what was cubic stays so.
/// Uneven axes that stay keep their samples; along even ones these lie at the distances of the source (BCC: those of
/// the CC grid it stands for), and along time at as many even steps as there are times; between times values are mixed.
/// A further parameter "time" is the time itself. Frames are made when they are loaded and read the plane at every
/// time. Throws Error when the source has one time or no extent along the axis.
Dataset withTimeAlong(std::shared_ptr<const BrickSource> source, const TimeAxis& axis);

/// Of data made so: times per length along the axis, in units of both.
double timePerLength(const DatasetInfo& info, const TimeAxis& axis);

} // namespace tessera::volume
