#pragma once

#include <cstdint>
#include <string_view>

namespace tessera::volume {

enum class SpaceAxis : std::uint8_t { X, Y, Z };
inline constexpr std::string_view kSpaceAxisNames[] = {"x", "y", "z"};

} // namespace tessera::volume
