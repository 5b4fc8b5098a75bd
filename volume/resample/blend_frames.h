#pragma once

#include "volume/field/field.h"
#include "volume/field/stored_range.h"
#include "volume/resample/resample_options.h"

#include <memory>
#include <span>
#include <vector>

/// Weighted sums of frames on the same grid, for interpolation in time: internal to volume/resample/series.h.
namespace tessera::volume {

/// A frame of a series and its weight.
struct FrameWeight {
    int frame = 0;
    double weight = 0;
    double linear = 0;   ///< where a frame lacks the sample: never negative
    bool beyond = false; ///< the frames are continued beyond the first or the last one
};

/// The filter along time: the one of space, except that B-splines, which need coefficients of the whole series, are
/// replaced by Catmull-Rom.
ResampleOptions optionsInTime(ResampleOptions options);

/// Frames and weights to interpolate a series of `count` frames at position `cells`. Not for B-spline coefficients.
std::vector<FrameWeight> frameWeights(double cells, int count, const ResampleOptions& options);

/// The same, but before the first frame and after the last one, where frameWeights() repeats it, by the straight line
/// through the two frames at that end; labels are repeated there, too.
std::vector<FrameWeight> weightsBeyond(double cells, int count, const ResampleOptions& options);

struct WeightedFrame {
    std::shared_ptr<const Field> field;
    FrameWeight weight;
};

/// Whether the weighted sum can exceed the range of its inputs and must not (a weight is negative, between frames).
bool overshoots(std::span<const FrameWeight> weights);

/// The weighted sum of frames, as float in the units of the first. A single frame is returned unchanged. A sum that can
/// overshoot is clamped to the range of the present samples of the frames; if the frames are parts of larger ones,
/// `extents` gives the ranges of the whole frames.
Field blendFrames(std::span<const WeightedFrame> frames, std::span<const StoredExtent> extents = {});

} // namespace tessera::volume
