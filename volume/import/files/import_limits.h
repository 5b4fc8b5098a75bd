#pragma once

#include <cstddef>

/// Limits on what headers may announce, for any format: more means a damaged file.
namespace tessera::volume {

inline constexpr int kMostSamplesPerAxis = 1 << 20;
inline constexpr std::size_t kMostTimes = 1'000'000;
inline constexpr std::size_t kMostArrays = 10'000;   ///< of one file, each with samples
inline constexpr std::size_t kMostQuantities = 4096; ///< over time, as many as an archive holds

} // namespace tessera::volume
