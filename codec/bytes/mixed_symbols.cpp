#include "codec/bytes/mixed_symbols.h"

#include "codec/bytes/range_coder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <vector>

namespace tessera::codec {

namespace {

constexpr std::uint32_t kHashFactor = 0x9E3779B1;
constexpr int kContexts = 6, kInputs = kContexts + 2; // the others: the match, and a constant
constexpr int kKinds = 4, kActivities = 8;
constexpr int kFurthest = 3071; ///< of logits, in units of 1/256
constexpr int kConstantInput = 256;
constexpr std::int32_t kFirstWeight = 19200, kMostWeight = 1 << 23; ///< 65536 is 1
constexpr std::size_t kMatched = 4;                                 ///< symbols that begin a match

/// 65536 / (1 + exp(-x)) for x = 0, 1/2, 1, ...
constexpr std::array<std::int32_t, 25> kLogistic{32768, 40793, 47911, 53581, 57724, 60565, 62428, 63615, 64357,
                                                 64816, 65097, 65269, 65374, 65438, 65476, 65500, 65514, 65523,
                                                 65528, 65531, 65533, 65534, 65535, 65535, 65535};

/// The probability of a logit, in units of 1/65536.
constexpr std::int32_t probabilityOf(std::int32_t logit) {
    constexpr std::int32_t kStep = 128;
    const std::int32_t size = logit < 0 ? -logit : logit;
    const auto at = std::size_t(size / kStep);
    const std::int32_t part = size % kStep;
    const std::int32_t value = (kLogistic[at] * (kStep - part) + kLogistic[at + 1] * part + kStep / 2) / kStep;
    return logit < 0 ? 65536 - value : value;
}

/// The logits of probabilities in units of 1/4096.
std::array<std::int16_t, 4096> makeLogits() {
    std::array<std::int16_t, 4096> logits{};
    std::int32_t logit = -kFurthest;
    for (std::int32_t i = 0; i < 4096; ++i) {
        while (logit < kFurthest && probabilityOf(logit + 1) <= 16 * i + 8) ++logit;
        logits[std::size_t(i)] = static_cast<std::int16_t>(logit);
    }
    return logits;
}

/// The mean of the bits seen so far, in units of 1/65536; of many, an exponential average.
struct Mean {
    static constexpr int kMany = 127;
    static constexpr std::array<std::uint32_t, kMany + 1> kShares = [] {
        std::array<std::uint32_t, kMany + 1> shares{};
        for (std::uint32_t n = 0; n <= kMany; ++n) shares[n] = 131072 / (2 * n + 3);
        return shares;
    }();
    std::uint16_t one = 32768, seen = 0;

    void learn(std::uint32_t bit) {
        const std::uint32_t share = kShares[seen];
        one = static_cast<std::uint16_t>(bit != 0 ? one + ((65535u - one) * share >> 16) : one - (one * share >> 16));
        if (seen < kMany) ++seen;
    }
};

std::uint32_t hash(std::uint32_t a, std::uint32_t b) {
    std::uint32_t h = a * kHashFactor;
    h = ((h ^ h >> 15) + b) * kHashFactor;
    return h ^ h >> 15;
}

/// Codes symbols with a RangeEncoder, or reads them with a RangeDecoder.
template <class Coder> class Mixing {
public:
    Mixing(Coder& coder, const MixedShape& shape, int colours, std::span<std::uint8_t> symbols)
        : coder_(coder), shape_(shape), top_(colours - 1), symbols_(symbols), pitch_(shape.size.x + kBefore),
          slice_(std::ptrdiff_t(pitch_) * (shape.size.y + kBefore)), bits_(bitsFor(shape.count())),
          means_(std::size_t(1) << bits_), last_(std::size_t(1) << (bits_ - 2)) {
        const std::size_t padded = std::size_t(slice_) * std::size_t(shape.size.z + kBefore * shape.sublattices);
        around_.resize(padded + std::size_t(kBefore));
        misses_.resize(around_.size());
        for (auto& weights : weights_) weights.fill(kFirstWeight), weights.back() = 0;
    }

    DecodeStatus code() {
        const glm::ivec3 size = shape_.size;
        std::size_t i = 0;
        for (int z = 0; z < size.z; ++z)
            for (int y = 0; y < size.y; ++y) {
                const std::ptrdiff_t row =
                    (z + kBefore * shape_.sublattices) * slice_ + std::ptrdiff_t(y + kBefore) * pitch_ + kBefore;
                for (int x = 0; x < size.x; ++x, ++i) {
                    look(row + x);
                    const int symbol = codeSymbol(symbols_[i]);
                    if (symbol < 0 || symbol > top_) return DecodeStatus::BadData;
                    symbols_[i] = around_[std::size_t(row + x)] = static_cast<std::uint8_t>(symbol);
                    misses_[std::size_t(row + x)] = static_cast<std::uint8_t>(std::abs(symbol - guess_));
                    match(i);
                }
                if (!coder_.goesOn()) return DecodeStatus::Truncated;
            }
        return DecodeStatus::Ok;
    }

private:
    static constexpr int kBefore = 2; ///< zeros before a row, rows before a slice and slices before the brick

    static int bitsFor(std::size_t count) { return std::clamp(int(std::bit_width(count)) + 2, 10, 20); }

    /// Determines guess and contexts from the samples before `at`.
    void look(std::ptrdiff_t at) {
        const std::ptrdiff_t below = slice_ * shape_.sublattices;
        const auto sample = [&](std::ptrdiff_t before) { return int(around_[std::size_t(at - before)]); };
        const auto missed = [&](std::ptrdiff_t before) { return std::uint32_t(misses_[std::size_t(at - before)]); };
        const auto word = [](int a, int b, int c, int d) {
            return static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b) << 8 |
                   static_cast<std::uint32_t>(c) << 16 | static_cast<std::uint32_t>(d) << 24;
        };
        const int w = sample(1), n = sample(pitch_), p = sample(below);
        const int ne = sample(pitch_ - 1), ps = sample(below - pitch_);
        const int xy = w + n - sample(pitch_ + 1), xz = w + p - sample(below + 1), yz = n + p - sample(below + pitch_);
        const int all = xy + xz + yz - w - n - p + sample(below + pitch_ + 1);
        const auto held = [&](int value) { return std::clamp(value, 0, top_); };
        guess_ = held(all);
        const int a = held(xy), b = held(xz), c = held(yz);
        const auto activity = static_cast<unsigned>(std::abs(w - n) + std::abs(w - p) + std::abs(n - p) +
                                                    std::abs(ne - n) + std::abs(ps - p));
        const auto strength = static_cast<int>(std::bit_width(activity));
        activity_ = std::min(strength, kActivities - 1);
        const auto misses = static_cast<int>(std::bit_width(missed(1) + missed(pitch_) + missed(below)));
        contexts_ = {hash(0, word(strength, misses, 0, 0)),
                     hash(1, word(guess_, w, sample(2), 0)),
                     hash(2, word(guess_, a, b, c)),
                     hash(3, word(guess_, (a + b + c) / 3, strength, 0)),
                     hash(4 + (static_cast<std::uint32_t>(ps) << 8), word(guess_, w, p, ne)),
                     hash(5 + (static_cast<std::uint32_t>(xy - all) << 8), static_cast<std::uint32_t>(xz - all))};
    }

    int codeSymbol(int symbol) {
        const int miss = symbol - guess_, expected = follows_ ? int(symbols_[matched_]) - guess_ : 0;
        agrees_ = follows_;
        if (bit(0, 0, miss != 0, expected != 0) == 0) return guess_;
        const std::uint32_t negative = guess_ == 0      ? 0
                                       : guess_ == top_ ? 1
                                                        : bit(1, 1, miss < 0 ? 1 : 0, expected < 0 ? 1 : 0);
        const auto room = static_cast<unsigned>(negative != 0 ? guess_ : top_ - guess_);
        const auto size = static_cast<unsigned>(std::abs(miss)), foreseen = static_cast<unsigned>(std::abs(expected));
        unsigned low = 0;
        while (room >> (low + 1) != 0 &&
               bit(2, 2 + 2 * low + negative, size >> (low + 1) != 0, foreseen >> (low + 1) != 0) != 0)
            ++low;
        unsigned got = 1;
        for (unsigned i = low; i-- > 0;)
            got = 2 * got + bit(3, 32 + 2 * (got + 256 * low) + negative, size >> i & 1u, foreseen >> i & 1u);
        return negative != 0 ? guess_ - int(got) : guess_ + int(got);
    }

    /// Codes a bit at a place in the tree of differences; `expected`: the bit if the match goes on.
    std::uint32_t bit(unsigned kind, unsigned place, std::uint32_t value, std::uint32_t expected) {
        static const std::array<std::int16_t, 4096> kLogits = makeLogits();
        const auto logit = [](const Mean& mean) { return std::int32_t(kLogits[mean.one >> 4]); };
        std::array<std::int32_t, kInputs> inputs;
        std::array<Mean*, kContexts> means;
        for (std::size_t k = 0; k < kContexts; ++k) {
            means[k] = &means_[(contexts_[k] + place) * kHashFactor >> (32 - bits_)];
            inputs[k] = logit(*means[k]);
        }
        const bool asked = agrees_;
        Mean& right = right_[kind][std::size_t(std::min(int(std::bit_width(length_)), kLongest))];
        inputs[kContexts] = !asked ? 0 : expected != 0 ? logit(right) : -logit(right);
        inputs[kContexts + 1] = kConstantInput;
        auto& weights = weights_[kind * kActivities + std::size_t(activity_)];
        std::int64_t sum = 0;
        for (std::size_t k = 0; k < kInputs; ++k) sum += std::int64_t(weights[k]) * inputs[k];
        const std::int32_t one =
            probabilityOf(static_cast<std::int32_t>(std::clamp<std::int64_t>(sum >> 16, -kFurthest, kFurthest)));
        const std::uint32_t got = coder_.bitOf(static_cast<std::uint32_t>(one), value);
        const std::int32_t error = (got != 0 ? 65536 : 0) - one;
        for (std::size_t k = 0; k < kInputs; ++k)
            weights[k] = std::clamp(weights[k] + ((inputs[k] * error + 8192) >> 14), -kMostWeight, kMostWeight);
        for (Mean* const mean : means) mean->learn(got);
        if (asked) right.learn(got == expected ? 1 : 0);
        agrees_ = asked && got == expected;
        return got;
    }

    /// Goes on with the match after symbol `i`, or looks for one.
    void match(std::size_t i) {
        if (follows_ && symbols_[matched_] == symbols_[i]) {
            ++matched_, ++length_;
        } else {
            follows_ = false, length_ = 0;
        }
        if (i + 1 < kMatched) return;
        std::uint32_t before = 0;
        for (std::size_t k = 0; k < kMatched; ++k) before = before << 8 | symbols_[i - k];
        std::uint32_t& last = last_[before * kHashFactor >> (34 - bits_)];
        if (!follows_ && last != 0) {
            matched_ = last;
            while (length_ < kCompared && length_ < matched_ &&
                   symbols_[matched_ - 1 - length_] == symbols_[i - length_])
                ++length_;
            follows_ = length_ >= kMatched;
            if (!follows_) length_ = 0;
        }
        last = static_cast<std::uint32_t>(i + 1);
    }

    static constexpr int kLongest = 15;          ///< log2 of the longest match told apart
    static constexpr std::size_t kCompared = 32; ///< symbols before a match that are compared, at most
    Coder& coder_;
    const MixedShape& shape_;
    const int top_;
    std::span<std::uint8_t> symbols_;
    const std::ptrdiff_t pitch_, slice_;
    const int bits_;
    std::vector<Mean> means_;
    std::vector<std::uint32_t> last_;           ///< symbol after the last four with a hash; 0: none
    std::vector<std::uint8_t> around_, misses_; ///< symbols and errors of guesses, with zeros in front
    std::array<std::array<std::int32_t, kInputs>, kKinds * kActivities> weights_;
    std::array<std::array<Mean, kLongest + 1>, kKinds> right_; ///< how often matches of a length were right
    std::array<std::uint32_t, kContexts> contexts_{};
    int guess_ = 0, activity_ = 0;
    bool follows_ = false, agrees_ = false; ///< there is a match; it agrees with the bits of this symbol so far
    std::size_t matched_ = 0, length_ = 0;
};

} // namespace

Bytes encodeMixed(const MixedShape& shape, int colours, std::span<const std::uint8_t> symbols) {
    std::vector<std::uint8_t> own(symbols.begin(), symbols.end());
    RangeEncoder coder;
    (void)Mixing(coder, shape, colours, std::span(own)).code();
    return coder.finish();
}

DecodeStatus decodeMixed(const MixedShape& shape, int colours, std::span<const std::byte> in,
                         std::span<std::uint8_t> symbols) {
    RangeDecoder coder(in);
    const DecodeStatus status = Mixing(coder, shape, colours, symbols).code();
    return status == DecodeStatus::Ok ? coder.end() : status;
}

} // namespace tessera::codec
