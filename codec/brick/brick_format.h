#pragma once

#include "codec/brick/numbers.h"
#include "codec/wavelet/lifting.h"
#include "volume/field/lattice.h"
#include "volume/field/scalar.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tessera::codec {

/// What a decoder must know before it reads the bytes of a brick.
struct BrickFormat {
    volume::LatticeKind kind = volume::LatticeKind::CC;
    glm::ivec3 size{1}; ///< storage samples of the brick at full resolution; a BCC brick starts on an even slice
    int levels = 1;
    Wavelet wavelet = Wavelet::W22;
    volume::ScalarType type = volume::ScalarType::F32;
    NumberCoding numbers;
    bool keepsAbsent = false; ///< the stored numbers of absent samples are coded as well
    int codeBits = 32;        ///< every |code| is below 2^codeBits; narrow ones are faster
    bool bodyCentred = false; ///< of BCC: the odd grid is predicted from the even one (codec/wavelet/body_centred.h)

    bool operator==(const BrickFormat&) const = default;

    int sublattices() const { return kind == volume::LatticeKind::BCC ? 2 : 1; }
    /// Full-resolution samples of one sublattice of the brick.
    glm::ivec3 sublatticeSize(int sublattice) const;
    /// Whether a brick (`masked` if it has absent samples) predicts its odd sublattice.
    bool predictsOdd(bool masked) const;
    /// True if samples can be stored exactly, in addition to their codes.
    bool canHaveExact() const;
};

/// Width of the codes of a type whose numbers are the codes, in bits.
int codeBitsOf(volume::ScalarType type);

inline std::size_t countOf(glm::ivec3 size) {
    return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
}

/// Storage samples of the brick at a level.
glm::ivec3 samplesAt(const BrickFormat& format, int level);
/// The mask at a level: every 2^level-th flag of each sublattice. Empty in, empty out.
std::vector<std::uint8_t> maskAt(const BrickFormat& format, std::span<const std::uint8_t> present, int level);

/// Arithmetic and wavelet of the lifting: floats are only predicted, since an update would mix exponents and overshoot
/// by powers of two.
Arithmetic arithmeticOf(const BrickFormat& format);
Wavelet effectiveWavelet(const BrickFormat& format);

} // namespace tessera::codec
