#pragma once

#include <cstdint>
#include <string_view>

namespace tessera::volume {

/// What a mean over a plane is weighted by (volume/flow/sections.h).
enum class SectionWeight : std::uint8_t { Area, Volume, MassFlow };
inline constexpr std::string_view kSectionWeightNames[] = {"area", "volume", "massflow"};

} // namespace tessera::volume
