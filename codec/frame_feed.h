#pragma once

#include "volume/dataset.h"
#include "volume/progress.h"
#include "volume/resample.h"

#include <future>
#include <optional>
#include <vector>

namespace tessera::codec {

/// One parameter at one time, as it is to be stored.
struct FeedStep {
    int parameter = 0;
    std::size_t time = 0;
    std::vector<volume::Field> fields; ///< of each component
    std::vector<Range> ranges;         ///< of what was read, components, then magnitude; empty where they were known
    std::uint64_t sourceSamples = 0, sourceBytes = 0;
    double loadSeconds = 0, resampleSeconds = 0;
};

/// Widens ranges by those of one more time; empty ranges begin with them.
void widenRanges(std::vector<Range>& ranges, const std::vector<Range>& more);

/// Reads a data set time by time, in each parameter by parameter, and resamples it: while one step is coded, the next
/// one is read.
class FrameFeed {
public:
    /// What is done to fields on the way: nothing, or resampling to BCC.
    struct Resampling {
        bool toBcc = false;
        volume::ResampleOptions options;
    };
    /// `ahead`: read the next step while the last one is in use, for memory of two. A stop is noticed at the next
    /// step.
    FrameFeed(volume::Dataset& dataset, const Resampling& resampling, bool ahead, std::stop_token stop);
    ~FrameFeed();
    FrameFeed(const FrameFeed&) = delete;
    FrameFeed& operator=(const FrameFeed&) = delete;

    /// The next step; called times x parameters times. Throws what reading throws: Error, Cancelled.
    FeedStep next();

private:
    FeedStep read(std::size_t number);

    volume::Dataset& dataset_;
    volume::DatasetInfo info_; ///< as it was at first
    Resampling resampling_;
    bool ahead_;
    std::stop_token stop_;
    std::size_t steps_, taken_ = 0;
    std::future<FeedStep> coming_;
};

} // namespace tessera::codec
