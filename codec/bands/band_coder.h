#pragma once

#include "codec/bands/band_tokens.h"
#include "codec/bytes/decode_status.h"
#include "codec/bytes/entropy.h"

/// Coding of subbands of integer coefficients: interleaved rANS with contexts from the magnitudes in the previous row
/// and slice, never from the left neighbour, so that sixteen lanes along x decode in parallel.
///
/// Duda: Asymmetric numeral systems (2013); Giesen: Interleaved entropy coders (2014). Quantising the neighbours'
/// magnitude to half octaves as the context is from Wu and Memon: CALIC (1997). (FORMAT.md "Bands".)
namespace tessera::codec {

/// A model prepared for encoding; shared by all bricks of a frame.
class BandEncoder {
public:
    explicit BandEncoder(Model model);
    const Model& model() const { return model_; }
    /// Appends the coded coefficients of bands; no bytes if all are 0. Any value can be coded. The bytes do not depend
    /// on `cpu`.
    void encode(const TokenRun& run, int level, Bytes& out, Cpu cpu = bestCpu()) const;

    struct Entry {
        std::uint64_t reciprocal = 0;
        std::uint32_t frequency = 0, start = 0;
    };

private:
    Model model_;
    std::vector<Entry> entries_;        ///< at [table << 8 | token]
    std::vector<std::uint32_t> packed_; ///< the same as frequency | start << 16, then one for lanes without a token
};

/// A model prepared for decoding; shared by all bricks of a frame. Thread-safe.
class BandDecoder {
public:
    explicit BandDecoder(Model model);
    const Model& model() const { return model_; }
    /// Decodes the bands; `in` must end with them. Values that do not fit into a Word are truncated. `predictor`: of
    /// predicted bands, or null.
    template <class Word>
    DecodeStatus decode(std::span<const std::byte> in, std::span<const Band<Word>> bands, int level,
                        Cpu cpu = bestCpu(), RowPredictor<Word>* predictor = nullptr) const;

private:
    Model model_;
    std::vector<std::uint32_t> table_;
};

} // namespace tessera::codec
