#pragma once

#include "codec/brick/frame_samples.h"
#include "codec/container/pack_options.h"
#include "volume/field/dataset.h"

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

/// Rounding of a frame according to the packing options.
namespace tessera::codec {

/// The rounding of a frame.
struct FrameBound {
    double error = 0;      ///< largest absolute error of a sample in stored numbers; 0: exact
    std::int64_t step = 1; ///< for integers: they become multiples of it, unless coefficients are quantised
    double rms = 0;        ///< largest root of the mean square error that is allowed; 0: no such bound
    double mostError = std::numeric_limits<double>::infinity(); ///< with `rms`: the bound stated for all samples
};

/// What a bound of a component is relative to: its parameter, as the options say with the range of that component
/// alone.
volume::Parameter boundedBy(const PackOptions& options, const volume::Parameter& parameter, std::size_t component);

/// The strictest of the requested bounds. A PSNR is converted by trial on the frame to the coarsest rounding that
/// reaches it; for integers to the largest step, odd or even.
FrameBound boundFor(const PackOptions& options, const volume::Parameter& parameter, const FrameSamples& samples);

/// Histogram of the integers of a frame's present samples, and what rounding them to multiples of a step changes.
class NumberCounts {
public:
    explicit NumberCounts(const FrameSamples& samples);
    /// Root of the mean square of the changes; remembered.
    double rms(std::int64_t step);
    double least() const { return counts_.empty() ? 0 : counts_.front().first; }
    double most() const { return counts_.empty() ? 0 : counts_.back().first; }

private:
    std::vector<std::pair<double, double>> counts_; ///< number and count, ascending
    double samples_ = 0;
    std::map<std::int64_t, double> rms_;
};

/// The same for several options; `counts`: of these samples, made when they are needed.
FrameBound boundFor(const PackOptions& options, const volume::Parameter& parameter, const FrameSamples& samples,
                    std::optional<NumberCounts>& counts);

} // namespace tessera::codec
