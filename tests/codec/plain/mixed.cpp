#include "tests/codec/plain/mixed.h"

#include "tests/codec/plain/bits.h"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace tessera::codec::plain {

namespace {

constexpr std::uint32_t kM = 0x9E3779B1;

struct Mean {
    std::uint64_t p = 32768, n = 0;
    void learn(bool bit) {
        const std::uint64_t share = 131072 / (2 * n + 3);
        if (bit)
            p += (65535 - p) * share / 65536;
        else
            p -= p * share / 65536;
        n = std::min<std::uint64_t>(n + 1, 127);
    }
};

std::uint32_t bitsOf(std::uint64_t value) {
    std::uint32_t bits = 0;
    while (value >> bits != 0) ++bits;
    return bits;
}

std::uint32_t hashOf(std::uint32_t u, std::uint32_t v) {
    std::uint32_t h = u * kM;
    h = ((h ^ h / 32768) + v) * kM;
    return h ^ h / 32768;
}

std::int64_t down(std::int64_t value, std::int64_t by) { // floor(value / by)
    return value >= 0 ? value / by : -((-value + by - 1) / by);
}

std::int64_t chanceOf(std::int64_t x) {
    constexpr int kT[] = {32768, 40793, 47911, 53581, 57724, 60565, 62428, 63615, 64357, 64816, 65097, 65269, 65374,
                          65438, 65476, 65500, 65514, 65523, 65528, 65531, 65533, 65534, 65535, 65535, 65535};
    if (x < 0) return 65536 - chanceOf(-x);
    const std::int64_t i = x / 128, f = x % 128;
    return (kT[i] * (128 - f) + kT[i + 1] * f + 64) / 128;
}

class Mixed {
public:
    Mixed(const Octets& bytes, const Size& size, bool bcc, int colours)
        : bits_(bytes), size_(size), step_(bcc ? 2 : 1), top_(colours - 1) {
        const std::uint64_t samples = std::uint64_t(size[0]) * std::uint64_t(size[1]) * std::uint64_t(size[2]);
        tableBits_ = std::clamp(bitsOf(samples) + 2, 10u, 20u);
        means_.resize(std::size_t(1) << tableBits_);
        table_.resize(std::size_t(1) << (tableBits_ - 2));
        for (auto& kind : weights_)
            for (auto& weights : kind) weights = {19200, 19200, 19200, 19200, 19200, 19200, 19200, 0};
        int x = -3071;
        for (int q = 0; q < 4096; ++q) {
            while (x < 3071 && chanceOf(x + 1) <= 16 * q + 8) ++x;
            logits_.push_back(x);
        }
    }

    std::vector<std::uint32_t> read() {
        places({0, 0, 0}, size_, [&](const Size& p) {
            look(p);
            const int index = next();
            need(index >= 0 && index <= top_, "index");
            all_.push_back(std::uint32_t(index));
            missed_.push_back(std::abs(index - g_));
            seek();
        });
        bits_.finish();
        return all_;
    }

private:
    /// Of the samples or their errors; 0 outside.
    template <class Numbers> int at(const Numbers& of, int x, int y, int z) const {
        if (x < 0 || y < 0 || z < 0 || x >= size_[0] || y >= size_[1]) return 0;
        return int(
            of[(std::size_t(z) * std::size_t(size_[1]) + std::size_t(y)) * std::size_t(size_[0]) + std::size_t(x)]);
    }

    void look(const Size& p) {
        const auto I = [&](int x, int y, int z) { return at(all_, p[0] + x, p[1] + y, p[2] + z * step_); };
        const auto E = [&](int x, int y, int z) { return at(missed_, p[0] + x, p[1] + y, p[2] + z * step_); };
        const int W = I(-1, 0, 0), N = I(0, -1, 0), P = I(0, 0, -1);
        const int a = W + N - I(-1, -1, 0), b = W + P - I(-1, 0, -1), c = N + P - I(0, -1, -1);
        const int d = a + b + c - W - N - P + I(-1, -1, -1);
        const auto held = [&](int value) { return std::uint32_t(std::clamp(value, 0, top_)); };
        const std::uint32_t g = held(d), w = std::uint32_t(W);
        g_ = int(g);
        const int activity =
            std::abs(W - N) + std::abs(W - P) + std::abs(N - P) + std::abs(I(1, -1, 0) - N) + std::abs(I(0, 1, -1) - P);
        const std::uint32_t strength = bitsOf(std::uint64_t(activity)),
                            missed = bitsOf(std::uint64_t(E(-1, 0, 0) + E(0, -1, 0) + E(0, 0, -1)));
        activity_ = std::min(strength, 7u);
        const std::uint32_t B8 = 256, B16 = 65536, B24 = 16777216;
        contexts_ = {hashOf(0, strength + B8 * missed),
                     hashOf(1, g + B8 * w + B16 * std::uint32_t(I(-2, 0, 0))),
                     hashOf(2, g + B8 * held(a) + B16 * held(b) + B24 * held(c)),
                     hashOf(3, g + B8 * ((held(a) + held(b) + held(c)) / 3) + B16 * strength),
                     hashOf(4 + B8 * std::uint32_t(I(0, 1, -1)),
                            g + B8 * w + B16 * std::uint32_t(P) + B24 * std::uint32_t(I(1, -1, 0))),
                     hashOf(5 + B8 * std::uint32_t(a - d), std::uint32_t(b - d))};
    }

    int next() {
        agrees_ = matches_;
        const int expected = matches_ ? int(all_[m_]) - g_ : 0, size = std::abs(expected);
        if (!bit(0, 0, expected != 0)) return g_;
        const bool negative = g_ == 0 ? false : g_ == top_ ? true : bit(1, 1, expected < 0);
        const std::uint32_t sign = negative ? 1 : 0;
        std::uint32_t low = 0, got = 1;
        while ((2 << low) <= (negative ? g_ : top_ - g_) && bit(2, 2 + 2 * low + sign, size >= 2 << low)) ++low;
        for (std::uint32_t left = low; left > 0; --left)
            got = 2 * got + (bit(3, 32 + 2 * (got + 256 * low) + sign, (size >> (left - 1)) % 2 != 0) ? 1 : 0);
        return negative ? g_ - int(got) : g_ + int(got);
    }

    bool bit(std::size_t kind, std::uint32_t place, bool foreseen) {
        std::array<std::int64_t, 8> x{};
        std::array<std::size_t, 6> numbers{};
        for (std::size_t k = 0; k < 6; ++k) {
            numbers[k] = ((contexts_[k] + place) * kM) >> (32 - tableBits_);
            x[k] = logits_[means_[numbers[k]].p / 16];
        }
        Mean& ofMatch = ofMatch_[kind][std::min(bitsOf(length_), 15u)];
        const bool asked = agrees_;
        if (asked) x[6] = foreseen ? logits_[ofMatch.p / 16] : -logits_[ofMatch.p / 16];
        x[7] = 256;
        auto& weights = weights_[kind][activity_];
        std::int64_t sum = 0;
        for (std::size_t k = 0; k < 8; ++k) sum += weights[k] * x[k];
        const std::int64_t p = chanceOf(std::clamp<std::int64_t>(down(sum, 65536), -3071, 3071));
        const bool one = bits_.bitOf(std::uint64_t(p));
        for (std::size_t k = 0; k < 8; ++k)
            weights[k] = std::clamp<std::int64_t>(weights[k] + down(x[k] * ((one ? 65536 : 0) - p) + 8192, 16384),
                                                  -8388608, 8388608);
        for (const std::size_t number : numbers) means_[number].learn(one);
        if (asked) ofMatch.learn(one == foreseen);
        agrees_ = asked && one == foreseen;
        return one;
    }

    void seek() {
        const std::size_t i = all_.size() - 1;
        if (matches_ && all_[m_] == all_[i])
            ++m_, ++length_;
        else
            matches_ = false, length_ = 0;
        if (i < 3) return;
        const std::uint32_t lastFour = all_[i] << 24 | all_[i - 1] << 16 | all_[i - 2] << 8 | all_[i - 3];
        std::size_t& entry = table_[(lastFour * kM) >> (34 - tableBits_)];
        if (!matches_ && entry != 0) {
            m_ = entry;
            while (length_ < 32 && length_ < m_ && all_[m_ - 1 - length_] == all_[i - length_]) ++length_;
            matches_ = length_ >= 4;
            if (!matches_) length_ = 0;
        }
        entry = i + 1;
    }

    Bits bits_;
    const Size size_;
    const int step_, top_;
    std::uint32_t tableBits_ = 0, activity_ = 0;
    std::vector<Mean> means_;
    std::vector<std::size_t> table_;
    std::vector<int> logits_, missed_;
    std::vector<std::uint32_t> all_;
    std::array<std::array<std::array<std::int64_t, 8>, 8>, 4> weights_{};
    std::array<std::array<Mean, 16>, 4> ofMatch_{};
    std::array<std::uint32_t, 6> contexts_{};
    int g_ = 0;
    bool matches_ = false, agrees_ = false;
    std::size_t m_ = 0, length_ = 0;
};

} // namespace

std::vector<std::uint32_t> readMixed(const Octets& bytes, const Size& size, bool bcc, int colours) {
    return Mixed(bytes, size, bcc, colours).read();
}

} // namespace tessera::codec::plain
