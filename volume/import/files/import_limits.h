#pragma once

#include <cstddef>

/// What a header may claim at most, whatever the format: more is a damaged file.
namespace tessera::volume {

inline constexpr int kMostSamplesPerAxis = 1 << 20;
inline constexpr std::size_t kMostTimes = 1'000'000;

} // namespace tessera::volume
