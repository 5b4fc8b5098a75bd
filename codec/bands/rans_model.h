#pragma once

#include "codec/bytes/decode_status.h"
#include "codec/bytes/entropy.h"
#include "codec/fitted/fitted_weights.h"

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

/// The probability model of the coefficient coder: a few tables shared by all bricks of a frame, and the table of each
/// context. (FORMAT.md "Models".)
namespace tessera::codec {

inline constexpr int kProbabilityBits = 12;
inline constexpr std::uint32_t kProbabilityOne = 1u << kProbabilityBits;
/// Number of context classes: half octaves of the magnitude of the neighbours.
inline constexpr int kClasses = 32;
/// Kinds of bands: 0 an undivided box, else the bits of the axes along which it holds the high half.
inline constexpr int kBandKinds = 8;
/// A token is a symbol below 32, a quarter octave followed by raw bits, or the escape followed by all 32 bits.
inline constexpr int kDirect = 32, kTokens = 141, kEscape = 140;

struct Token {
    std::uint32_t token = 0;
    int rawBits = 0; ///< number of low bits of the symbol that follow raw
};

constexpr Token tokenOf(std::uint32_t symbol) {
    if (symbol < kDirect) return {symbol, 0};
    const int octave = static_cast<int>(std::bit_width(symbol)) - 1;
    return {kDirect + 4u * static_cast<std::uint32_t>(octave - 5) + ((symbol >> (octave - 2)) & 3u), octave - 2};
}
constexpr int rawBitsOf(std::uint32_t token) {
    if (token < kDirect) return 0;
    return token == kEscape ? 32 : static_cast<int>((token - kDirect) / 4) + 3;
}
/// The symbol of a token without its raw bits.
constexpr std::uint32_t symbolBase(std::uint32_t token) {
    if (token < kDirect) return token;
    return token == kEscape ? 0 : (4u + (token - kDirect) % 4u) << rawBitsOf(token);
}

/// Definition of the contexts.
struct Contexts {
    int shift = 0; ///< magnitudes are divided by 2^shift
    bool byBand =
        false; ///< two more neighbours in the previous slice, and separate kinds of bands at the two finest levels
    bool operator==(const Contexts&) const = default;

    static constexpr int kLevelsByBand = 2;
    int kindsOf(int level) const { return byBand && level < kLevelsByBand ? kBandKinds : 1; }
    /// Index of the first context of a kind at a level; for `level` = number of levels: the number of contexts.
    std::size_t first(int level, int kind = 0) const {
        const int kinds = byBand ? level + (kBandKinds - 1) * (level < kLevelsByBand ? level : kLevelsByBand) : level;
        return static_cast<std::size_t>((kinds + (kindsOf(level) > 1 ? kind : 0)) * kClasses);
    }
};

/// Approximate counts of each token in each context, from which a model is made.
struct Histogram {
    Histogram(int levelCount, Contexts of) : levels(levelCount), contexts(of), counts(of.first(levelCount)) {}
    int levels = 0;
    Contexts contexts;
    std::vector<std::array<std::uint32_t, kTokens>> counts; ///< [contexts.first(level, kind) + class]
    /// Bits of the tokens and their raw bits with optimal tables, without the model itself.
    double bits() const;
    /// Adds the counts of another histogram with the same levels and contexts.
    void add(const Histogram& other);
};

using Frequencies = std::array<std::uint16_t, kTokens>; ///< sum is kProbabilityOne; that of the escape is above 0

struct Model {
    int levels = 0;
    Contexts contexts;
    std::vector<std::uint8_t> tableOf; ///< [contexts.first(level, kind) + class]
    std::vector<Frequencies> tables;
    FittedWeights fitted{}; ///< of samples that are coded as differences from predictions; empty: wavelets
    bool operator==(const Model&) const = default;
};

/// Makes a model with few tables: similar contexts share one unless a separate table saves more than it costs.
Model makeModel(const Histogram& histogram, int mostTables);
/// Bits of the histogram's tokens coded with a model, including raw bits.
double bitsWith(const Model& model, const Histogram& histogram);

Bytes serialise(const Model& model);
/// Parses a model for `levels` levels; the bytes must end with it. Empty input is the model for frames without tokens.
DecodeStatus parseModel(std::span<const std::byte> bytes, int levels, Model& model);

/// The decoding table of a model: entry [table << kProbabilityBits | slot] has the token in bits 0..7, its frequency in
/// 8..19 and the offset of the slot within it in 20..31.
std::vector<std::uint32_t> decodeTable(const Model& model);

} // namespace tessera::codec
