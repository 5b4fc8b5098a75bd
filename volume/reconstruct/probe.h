#pragma once

#include "volume/bricks/brick_source.h"
#include "volume/field/time_pair.h"

#include <optional>
#include <span>
#include <vector>

namespace tessera::volume {

/// Values of a data set at one point, in physical units.
struct ProbeValue {
    /// Interpolated value: trilinear (CC) or linear box spline (BCC), which never exceed the range of the samples; for
    /// labels the nearest sample. Empty where the nearest sample is absent, or less than half of the weight is present.
    /// For parameters with parts (volume/field/parts.h) only the part of the nearest sample is used, extrapolated
    /// linearly beyond its border, within the channel's range.
    std::optional<double> interpolated;
    std::optional<double> nearest; ///< the nearest sample; empty where that is absent
};

/// Values of every channel (DatasetInfo::channels(), in order) at a physical position, at full resolution; all empty
/// outside DatasetInfo::bounds. Reads one to eight bricks per channel: put a BrickCache before an archive. Throws
/// Error.
std::vector<ProbeValue> probe(const BrickSource& source, glm::dvec3 position, int time);

/// One channel at many positions, in order: bricks are read once for all of them. Throws Error.
std::vector<ProbeValue> probeAlong(const BrickSource& source, int channel, std::span<const glm::dvec3> positions,
                                   int time);

/// The same between two stored times: interpolated values are mixed, those of absent samples left out by their weight;
/// labels and nearest samples are of the nearer time. Values of channels that are computed from others
/// (isComputedBetween) are those of samples computed at that time.
std::vector<ProbeValue> probe(const BrickSource& source, glm::dvec3 position, const TimePair& time);
std::vector<ProbeValue> probeAlong(const BrickSource& source, int channel, std::span<const glm::dvec3> positions,
                                   const TimePair& time);

/// Each position at a time of its own; between stored times values of every channel are mixed.
std::vector<ProbeValue> probeAlong(const BrickSource& source, int channel, std::span<const glm::dvec3> positions,
                                   std::span<const TimePair> times);

/// Positions at `count` even distances along a polyline, both ends included.
std::vector<glm::dvec3> alongPolyline(std::span<const glm::dvec3> corners, int count);

/// The same for one channel.
ProbeValue probeChannel(const BrickSource& source, int channel, glm::dvec3 position, int time);

} // namespace tessera::volume
