#pragma once

#include "volume/bricks/brick_source.h"
#include "volume/sources/time_axis.h"

#include <memory>

namespace tessera::volume {

/// The points of a data set in a plane of space and time, as data of one time (DatasetInfo::plane). Of x, y and z the
/// one that the plane is solved for gives its place to time, with its extent: so what was cubic stays so. Uneven axes
/// that stay keep their samples; along even ones these lie at the distances of the source (BCC: those of the CC grid it
/// stands for). Along time they lie at its times, which make an uneven axis where they are not even. Values are linear
/// between samples and between times (volume/reconstruct/probe.h), labels those of the nearest sample at the nearest
/// time; what lies outside of the source is absent. A further parameter "time" is the time itself.
///
/// Bricks are made when they are read, and kept: a sample of a coarse level is one at the place of every 2^l-th sample,
/// read from that level of the source, so that a first picture of a plane needs little of the data. Statistics of
/// bricks are bounds. Throws Error as planeOf does.
std::shared_ptr<const BrickSource> makePlaneSource(std::shared_ptr<const BrickSource> source, const TimeAxis& wanted);

} // namespace tessera::volume
