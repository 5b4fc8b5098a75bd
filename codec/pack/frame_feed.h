#pragma once

#include "codec/brick/frame_samples.h"
#include "codec/container/resample_error.h"
#include "volume/base/progress.h"
#include "volume/field/dataset.h"
#include "volume/resample/resample_slices.h"

#include <future>
#include <optional>
#include <vector>

namespace tessera::codec {

/// One parameter at one time, as it is to be stored.
struct FeedStep {
    int parameter = 0;
    std::size_t time = 0;
    std::vector<FrameSamples> frames; ///< of each component
    ResampleError resampled;          ///< of all components, where it was measured
    std::vector<Range> ranges;        ///< of what was read, components, then magnitude; empty where they were known
    std::uint64_t sourceSamples = 0, sourceBytes = 0;
    double loadSeconds = 0, resampleSeconds = 0;
};

/// Widens ranges by those of one more time; empty ranges begin with them.
void widenRanges(std::vector<Range>& ranges, const std::vector<Range>& more);

/// Options of reading and resampling.
struct FeedOptions {
    bool toBcc = false; ///< frames are resampled to the lattice of the grid
    volume::ResampleOptions resample;
    volume::BrickGrid grid;
    volume::SliceMemory slices; ///< of frames larger than memory, which are never read whole; of others no step
    int slabLayers = 0;         ///< of bricks of these in memory at a time
    bool ahead = false;         ///< the next step is read while the last one is in use, for memory of two
    bool rangesOnly = false;    ///< no frames are made
    bool measures = false;      ///< what resampling costs
};

/// Reads and resamples a data set time by time, and within each time parameter by parameter, one step ahead of the
/// caller.
class FrameFeed {
public:
    /// A stop request takes effect at the next step or slab.
    FrameFeed(const volume::Dataset& dataset, FeedOptions options, std::stop_token stop);
    ~FrameFeed();
    FrameFeed(const FrameFeed&) = delete;
    FrameFeed& operator=(const FrameFeed&) = delete;

    /// The next step; called times x parameters times. Throws what reading throws: Error, Cancelled.
    FeedStep next();

private:
    FeedStep read(std::size_t number) const;
    /// The components of a step as they are read: frames that fit are in memory then; of others what has to be known of
    /// them as a whole has been looked up. Sets the ranges of the step.
    std::vector<volume::SlicedFrame> source(FeedStep& step, const volume::Parameter& parameter) const;

    volume::Dataset dataset_; ///< as it was at first, with parts where frames are resampled
    FeedOptions options_;
    std::stop_token stop_;
    std::size_t steps_, taken_ = 0;
    std::future<FeedStep> coming_;
};

} // namespace tessera::codec
