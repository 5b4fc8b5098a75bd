#pragma once

#include <cstdint>
#include <string_view>

namespace tessera::codec {

/// Integer wavelets of the (N, N~) family (codec/wavelet/lifting.h).
enum class Wavelet : std::uint8_t { N1, N2, W11, W13, W15, W22, W24, W26, N4, W42, W44, W46 };
/// "N,N~"; with N~ = 0 there is no update, so coarse samples are samples of the field.
inline constexpr std::string_view kWaveletNames[] = {"1,0", "2,0", "1,1", "1,3", "1,5", "2,2",
                                                     "2,4", "2,6", "4,0", "4,2", "4,4", "4,6"};

} // namespace tessera::codec
