#pragma once

#include "volume/field/field.h"

#include <cstddef>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

/// Other coders, behind one face, for the benchmarks.
namespace tessera::bench {

using Bytes = std::vector<std::byte>;

/// Samples of some frames of one type and size, one frame behind the other, x fastest.
struct Samples {
    std::span<const std::byte> bytes;
    glm::ivec3 size{0}; ///< of a frame
    volume::ScalarType type = volume::ScalarType::U8;

    std::size_t sampleBytes() const { return volume::byteSize(type); }
    std::size_t frameBytes() const {
        return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z) * sampleBytes();
    }
    std::size_t frames() const { return bytes.size() / frameBytes(); }
};

struct PeerCodec {
    std::string name;
    /// Empty when it cannot code such samples.
    std::function<Bytes(const Samples&)> encode;
    /// Into as many bytes as were coded; false when it fails. `like` gives size and type.
    std::function<bool(std::span<const std::byte> coded, const Samples& like, std::span<std::byte> out)> decode;
    bool exact = true; ///< gives back every bit
};

/// Coders of bytes, and of arrays: those that were found when this was built.
std::vector<PeerCodec> byteCodecs();
/// Coders of arrays of numbers and of pictures.
std::vector<PeerCodec> arrayCodecs();
/// Of floats, off by at most `bound`; none where there is no such coder.
std::vector<PeerCodec> boundedCodecs(double bound);
/// Names of those that were not found.
std::vector<std::string> absentCodecs();

} // namespace tessera::bench
