#pragma once

#include "codec/wavelet/wavelet.h"
#include "volume/base/cpu.h"

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

/// Integer wavelets by lifting, in place, aware of absent samples.
///
/// Calderbank, Daubechies, Sweldens, Yeo: Wavelet transforms that map integers to integers (1998); the filters are the
/// (N, N~) family of Cohen, Daubechies, Feauveau in the lifting form of Uytterhoeven, Roose, Bultheel (1997): predict
/// each odd sample from the even ones (N vanishing moments), then update the even ones to preserve moments (N~).
///
/// One set of rules covers borders and masks: a tap outside the line is treated as absent, and
///  - if one tap of the innermost pair is absent, the other is used for both (symmetric extension); if both are, the
///    sum is 0;
///  - an incomplete pair further out takes the values of the pair inside it (symmetric filters) or is omitted;
///  - an update only uses details predicted from all their even neighbours: the residual of a one-sided prediction
///    contains slope, not only detail, and would distort the coarse level at every border of a brick;
///  - absent samples are moved along, but never changed and never read.
/// So values never leak across the border of a region, at any level, and a decoder that knows the mask can invert every
/// step.
namespace tessera::codec {

/// Arithmetic of the sums; part of the format, since encoder and decoder must agree.
enum class Arithmetic : std::uint8_t {
    Narrow, ///< as Wide, for samples of at most 16 bits, where no sum exceeds 32 bits
    Wide,   ///< sums in 64 bits, results modulo 2^32
    Float,  ///< samples are codes of floats (codeOfFloat): samples are predicted in float, details as Wide
};

/// Offset of a coarse sample from the fine sample it corresponds to, in fine cells: 1/2 for means of two, else 0.
double levelPhase(Wavelet wavelet);

/// Samples of one sublattice at a level: ceil(n / 2^level) per axis.
glm::ivec3 levelSize(glm::ivec3 size, int level);

/// Non-standard decomposition: `steps` times along x, y and z of the remaining low corner, where coarse samples go.
/// `values` and `present` (empty: all present) have size.x * size.y * size.z elements, x fastest, and are reordered
/// together. Works for any size and any values; exactly inverted by `inverse` with the same arguments. With Float
/// arithmetic the wavelet must have N~ = 0. The result does not depend on `cpu`.
void forward(std::span<std::uint32_t> values, std::span<std::uint8_t> present, glm::ivec3 size, int steps,
             Wavelet wavelet, Arithmetic arithmetic, Cpu cpu = bestCpu());
void inverse(std::span<std::uint32_t> values, std::span<std::uint8_t> present, glm::ivec3 size, int steps,
             Wavelet wavelet, Arithmetic arithmetic, Cpu cpu = bestCpu());
/// One step along one axis of a box of `size` in rows `row` words apart and slices `slice` words apart, in place: even
/// samples to the low half, or back. `present` has the same layout, or is null: all present. Not with Float arithmetic.
void liftAlong(int axis, bool isForward, std::uint32_t* values, std::uint8_t* present, glm::ivec3 size,
               std::ptrdiff_t row, std::ptrdiff_t slice, Wavelet wavelet, Arithmetic arithmetic, Cpu cpu = bestCpu());
/// The reordering of `forward` alone, for masks.
void deinterleave(std::span<std::uint8_t> present, glm::ivec3 size, int steps);

/// Maps a float bit for bit to a signed integer of the same order (+0 is 0, -0 is -1, NaNs are beyond the infinities),
/// and back.
std::uint32_t codeOfFloat(float value);
float floatOfCode(std::uint32_t code);

} // namespace tessera::codec
