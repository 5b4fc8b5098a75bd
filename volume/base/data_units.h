#pragma once

#include <string_view>

/// The units of described settings that are places, lengths or times in the data: whatever unit the data state, or
/// none. Widgets show that one.
namespace tessera {

inline constexpr std::string_view kUnitOfLengths = "length", kUnitOfTimes = "time";

} // namespace tessera
