#include "codec/brick/brick_format.h"

#include "codec/wavelet/lift_box.h"

#include <algorithm>

namespace tessera::codec {

using volume::LatticeKind;
using volume::ScalarType;

glm::ivec3 BrickFormat::sublatticeSize(int sublattice) const {
    if (kind == LatticeKind::CC) return size;
    return {size.x, size.y, (size.z + 1 - sublattice) / 2};
}

bool BrickFormat::predictsOdd(bool masked) const {
    return bodyCentred && kind == LatticeKind::BCC && !masked && levels > 1 && size.z > 1 &&
           numbers.kind != NumberKind::Float;
}

bool BrickFormat::canHaveExact() const {
    return type == ScalarType::F32 && numbers.kind != NumberKind::Integer && numbers.kind != NumberKind::Float;
}

bool canBeFitted(const BrickFormat& format, bool masked) {
    return !masked && format.levels > 1 && format.numbers.kind != NumberKind::Float && !format.isStepped() &&
           (format.kind == LatticeKind::CC || format.bodyCentred);
}

CodeRange codeRange(const BrickFormat& format) {
    constexpr int kWidest = 30;
    const std::int32_t most = (1 << std::min(format.codeBits, kWidest)) - 1;
    const bool isUnsigned = format.type == ScalarType::U8 || format.type == ScalarType::U16;
    return {isUnsigned ? 0 : -most, most};
}

int codeBitsOf(ScalarType type) {
    return type == ScalarType::U8 ? 8 : type == ScalarType::I16 || type == ScalarType::U16 ? 16 : 32;
}

Arithmetic arithmeticOf(const BrickFormat& format) {
    if (format.numbers.kind == NumberKind::Float) return Arithmetic::Float;
    return format.codeBits > kBitsOfInt32 ? Arithmetic::Wide : Arithmetic::Narrow;
}

Wavelet effectiveWavelet(const BrickFormat& format) {
    if (format.numbers.kind != NumberKind::Float) return format.wavelet;
    return levelPhase(format.wavelet) == 0 && format.wavelet != Wavelet::N1 ? Wavelet::N2 : Wavelet::N1;
}

glm::ivec3 samplesAt(const BrickFormat& format, int level) {
    glm::ivec3 size = levelSize(format.size, level);
    if (format.kind == LatticeKind::BCC)
        size.z = levelSize(format.sublatticeSize(0), level).z + levelSize(format.sublatticeSize(1), level).z;
    return size;
}

std::vector<std::uint8_t> maskAt(const BrickFormat& format, std::span<const std::uint8_t> present, int level) {
    if (present.empty()) return {};
    std::vector<std::uint8_t> out;
    out.reserve(countOf(samplesAt(format, level)));
    forLevel(format, level, [&](std::size_t at) { out.push_back(present[at]); });
    return out;
}

} // namespace tessera::codec
