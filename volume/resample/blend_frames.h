#pragma once

#include "volume/field/field.h"
#include "volume/field/stored_range.h"
#include "volume/resample/resample.h"

#include <memory>
#include <span>
#include <vector>

/// Frames that share a grid, blended in time: inside of volume/resample/series.h.
namespace tessera::volume {

/// What a frame of a series counts for.
struct FrameWeight {
    int frame = 0;
    double weight = 0;
    double linear = 0; ///< where a frame lacks the sample: never negative
};

/// The filter along time: B-splines, which need coefficients of the whole series, are Catmull-Rom there.
ResampleOptions optionsInTime(ResampleOptions options);

/// Those of a series of `count` frames that are blended at `cells` of it. Not for the coefficients of B-splines.
std::vector<FrameWeight> frameWeights(double cells, int count, const ResampleOptions& options);

struct WeightedFrame {
    std::shared_ptr<const Field> field;
    FrameWeight weight;
};

/// Whether the sum may leave the range of what is summed.
bool overshoots(std::span<const FrameWeight> weights);

/// The weighted sum of frames, as float in the units of the first. One frame alone stays as it is. A sum that
/// overshoots is held within the present samples of the frames; of parts of frames `extents` says what the wholes have,
/// by frame.
Field blendFrames(std::span<const WeightedFrame> frames, std::span<const StoredExtent> extents = {});

} // namespace tessera::volume
