#pragma once

namespace tessera::volume {

/// Share of the weight that present samples must carry: one half, less a margin, so that places half-way between a
/// present and an absent sample, which rays meet often, are present whatever the rounding.
inline constexpr double kPresentCoverage = 0.5 - 1.0 / 512;

} // namespace tessera::volume
