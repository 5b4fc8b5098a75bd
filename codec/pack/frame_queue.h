#pragma once

#include "codec/brick/frame_samples.h"
#include "volume/base/progress.h"
#include "volume/field/dataset.h"
#include "volume/resample/resample_slices.h"

#include <future>
#include <optional>
#include <vector>

namespace tessera::codec {

/// One parameter at one time, ready to be stored.
struct QueuedFrames {
    int parameter = 0;
    std::size_t time = 0;
    std::vector<FrameSamples> frames;  ///< per component
    std::optional<FrameSamples> parts; ///< of 8 bits: numbers of the parts of their samples, if asked for
    std::vector<Range> ranges;         ///< of the samples read: components, then magnitude; empty if known before
    std::uint64_t sourceSamples = 0, sourceBytes = 0;
    double loadSeconds = 0, resampleSeconds = 0;
};

/// Extends ranges by those of another time; empty ranges are replaced.
void widenRanges(std::vector<Range>& ranges, const std::vector<Range>& more);

/// Options of reading and resampling.
struct FrameQueueOptions {
    bool toBcc = false; ///< resample frames to the lattice of the grid
    volume::ResampleOptions resample;
    volume::BrickGrid grid;
    volume::SliceMemory slices; ///< slices read at a time from frames larger than memory; step 0: frames are read whole
    int slabLayers = 0;         ///< brick layers of such frames in memory at a time
    bool ahead = false;         ///< read the next step while the current one is processed; needs memory for both
    bool parts = false;         ///< also give parts
    bool rangesOnly = false;    ///< compute ranges only, without frames
    SlabTeam* team = nullptr;   ///< processes that share the work, frame by frame
};

/// Reads and resamples a data set time by time, and within each time parameter by parameter, one step ahead of the
/// caller.
class FrameQueue {
public:
    /// A stop request takes effect at the next step or slab.
    FrameQueue(const volume::Dataset& dataset, FrameQueueOptions options, std::stop_token stop);
    ~FrameQueue();
    FrameQueue(const FrameQueue&) = delete;
    FrameQueue& operator=(const FrameQueue&) = delete;

    /// Returns the next step; to be called times x parameters times. Throws what reading throws: Error, Cancelled.
    QueuedFrames next();

private:
    QueuedFrames read(std::size_t number) const;
    /// Reads the components of a step: into memory if they fit; otherwise scans them for the properties of the whole
    /// frame that later stages need. Sets the ranges of the step.
    std::vector<volume::SlicedFrame> source(QueuedFrames& step, const volume::Parameter& parameter) const;

    volume::Dataset dataset_; ///< the original one, with parts if frames are resampled
    FrameQueueOptions options_;
    std::stop_token stop_;
    std::size_t steps_, taken_ = 0;
    std::future<QueuedFrames> coming_;
};

} // namespace tessera::codec
