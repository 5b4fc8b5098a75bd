#pragma once

#include <cstddef>

/// Limits on what headers may announce, for any format: more means a damaged file.
namespace tessera::volume {

inline constexpr int kMostSamplesPerAxis = 1 << 20;
inline constexpr std::size_t kMostTimes = 1'000'000;

} // namespace tessera::volume
