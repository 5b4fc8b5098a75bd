#pragma once

#include "codec/wavelet/wavelet.h"

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

/// Integer wavelets by lifting, in place, aware of absent samples.
///
/// Calderbank, Daubechies, Sweldens, Yeo: Wavelet transforms that map integers to integers (1998); the filters are the
/// (N, N~) family of Cohen, Daubechies, Feauveau in the lifting form of Uytterhoeven, Roose, Bultheel (1997): predict
/// each odd sample from the even ones (N vanishing moments), then update the even ones so that moments are kept (N~).
///
/// One rule covers borders and masks: a tap outside the line is a tap on an absent sample, and
///  - of the innermost pair the counterpart stands in for the absent one (symmetric extension); none: the sum is 0;
///  - an incomplete pair further out takes the values of the pair inside it (symmetric filters) or counts nothing;
///  - an update only uses details that were predicted from all their even neighbours: what a one-sided prediction
///  leaves
///    is slope, not detail, and would bend the coarse level at every border of a brick;
///  - absent samples themselves are moved along, never changed and never read.
/// So nothing bleeds over the border of a region, at any level, and the decoder, which knows the mask first, undoes
/// all.
namespace tessera::codec {

/// How sums are formed; part of the format, as encoder and decoder must agree.
enum class Arithmetic : std::uint8_t {
    Narrow, ///< as Wide, for samples of 16 bits and less, where no sum leaves 32 bits
    Wide,   ///< sums in 64 bits, results modulo 2^32
    Float,  ///< samples are codes of floats (codeOfFloat): samples are predicted in float, details as Wide
};

/// Fine cells by which a coarse sample lies beyond the fine sample it comes from: 1/2 for means of two, else 0.
double levelPhase(Wavelet wavelet);

/// Samples of one sublattice at a level: ceil(n / 2^level) per axis.
glm::ivec3 levelSize(glm::ivec3 size, int level);

/// Non-standard decomposition: `steps` times along x, y and z of what is left, coarse samples moving to the low corner.
/// `values` and `present` (empty: all present) have size.x * size.y * size.z elements, x fastest, and are reordered
/// together. Any size, any values; exactly undone by `inverse` with the same arguments.
/// With Float arithmetic the wavelet must have N~ = 0.
void forward(std::span<std::uint32_t> values, std::span<std::uint8_t> present, glm::ivec3 size, int steps,
             Wavelet wavelet, Arithmetic arithmetic);
void inverse(std::span<std::uint32_t> values, std::span<std::uint8_t> present, glm::ivec3 size, int steps,
             Wavelet wavelet, Arithmetic arithmetic);
/// Only the reordering of `forward`, for masks.
void deinterleave(std::span<std::uint8_t> present, glm::ivec3 size, int steps);

/// A float as a signed integer of the same order (+0 is 0, -0 is -1, NaNs lie beyond the infinities), and back, bit for
/// bit.
std::uint32_t codeOfFloat(float value);
float floatOfCode(std::uint32_t code);

} // namespace tessera::codec
