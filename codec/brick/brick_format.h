#pragma once

#include "codec/brick/numbers.h"
#include "codec/fitted/predict_row.h"
#include "codec/wavelet/lifting.h"
#include "codec/wavelet/subbands.h"
#include "volume/field/lattice.h"
#include "volume/field/scalar.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tessera::codec {

/// Parameters of a brick that a decoder must know in advance.
struct BrickFormat {
    volume::LatticeKind kind = volume::LatticeKind::CC;
    glm::ivec3 size{1}; ///< storage samples at full resolution; a BCC brick starts on an even slice
    int levels = 1;
    Wavelet wavelet = Wavelet::W22;
    volume::ScalarType type = volume::ScalarType::F32;
    NumberCoding numbers;
    bool keepsAbsent = false; ///< the stored numbers of absent samples are coded as well
    int codeBits = 32;        ///< every |code| is below 2^codeBits; narrow codes are faster
    bool bodyCentred =
        false;          ///< of BCC: the odd sublattice is predicted from the even one (codec/wavelet/body_centred.h)
    StepChoice steps{}; ///< for numbers of kind Stepped
    bool subsampled = false; ///< segment 0 begins with samples of level 0 (codec/brick/subsamples.h)
    bool mixed = false;      ///< the brick may be mixed (codec/bytes/mixed_symbols.h)

    bool operator==(const BrickFormat&) const = default;

    int sublattices() const { return kind == volume::LatticeKind::BCC ? 2 : 1; }
    /// Full-resolution samples of one sublattice of the brick.
    glm::ivec3 sublatticeSize(int sublattice) const;
    /// Whether the odd sublattice of a brick is predicted; `masked`: it has absent samples.
    bool predictsOdd(bool masked) const;
    /// Whether samples can be stored exactly in addition to their codes.
    bool canHaveExact() const;
    /// Whether coefficients are quantised.
    bool isStepped() const { return numbers.kind == NumberKind::Stepped; }
};

/// Whether the samples of a brick are coded as differences from fitted predictions if the model has such; `masked`: it
/// has absent samples.
bool canBeFitted(const BrickFormat& format, bool masked);
/// The codes that the samples of a brick can have.
CodeRange codeRange(const BrickFormat& format);

/// Code width in bits of a type whose numbers are the codes.
int codeBitsOf(volume::ScalarType type);

inline std::size_t countOf(glm::ivec3 size) {
    return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
}

/// Storage samples of the brick at a level.
glm::ivec3 samplesAt(const BrickFormat& format, int level);
/// Calls `visit(index at full resolution)` for every 2^level-th sample of each sublattice, in the storage order of the
/// level.
template <class Visit> void forLevel(const BrickFormat& format, int level, Visit&& visit) {
    const glm::ivec3 size = samplesAt(format, level);
    const int perTexel = format.sublattices(), stride = 1 << level;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y) {
            const int fineZ = (z / perTexel) * stride * perTexel + z % perTexel;
            const std::size_t row = (std::size_t(fineZ) * std::size_t(format.size.y) + std::size_t(y * stride)) *
                                    std::size_t(format.size.x);
            for (int x = 0; x < size.x; ++x) visit(row + std::size_t(x * stride));
        }
}
/// The mask at a level: every 2^level-th flag of each sublattice. Empty for an empty mask.
std::vector<std::uint8_t> maskAt(const BrickFormat& format, std::span<const std::uint8_t> present, int level);

/// Arithmetic of the lifting. Floats are only predicted, since an update would mix exponents and overshoot by powers of
/// two.
Arithmetic arithmeticOf(const BrickFormat& format);
Wavelet effectiveWavelet(const BrickFormat& format);

} // namespace tessera::codec
