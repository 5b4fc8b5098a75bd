#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace tessera::codec {

/// Which details are given up, as in Donoho: De-noising by soft-thresholding (1995). Unlike an error bound a threshold
/// promises nothing about a sample: what is given up adds up over the levels.
enum class Threshold : std::uint8_t {
    Hard,    ///< those of magnitude `value` or less become 0
    Soft,    ///< the same, and all others shrink by `value`
    Quantile ///< the `value` part (0..1) of smallest magnitude become 0
};
inline constexpr std::string_view kThresholdNames[] = {"hard", "soft", "quantile"};

/// Thresholds details in place; `value` at least 0. A quantile takes as many as it says, of equal ones the first.
void applyThreshold(std::span<std::int32_t> details, Threshold kind, double value);

} // namespace tessera::codec
