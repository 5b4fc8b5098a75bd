#pragma once

#include "app/session/session.h"

#include "volume/bricks/brick_source.h"

#include <span>
#include <vector>

/// What a channel looks like as a body in the picture, from a coarse level of its samples.
namespace tessera::app {

struct ValueBody {
    std::vector<double> count; ///< volume as drawn by value; the bins divide a range evenly
    double length = 0;         ///< mean length of the rays through the samples, in world units; 0: there are none
};

/// The samples of some times together, as a session draws them: with its stretch, by cells or to scale, along its view.
/// Values beyond the range count at its ends; samples below the share `from` of it are left out. Throws Error when a
/// brick is damaged.
ValueBody bodyOf(const Session& session, const volume::BrickSource& source, int channel,
                 std::span<const std::size_t> times, Range range, double from = 0);

/// Number of bins that as many values would fill evenly: the exponential of their entropy. 0 without values.
double binsFilled(std::span<const double> count);

} // namespace tessera::app
