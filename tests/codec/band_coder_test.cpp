#include "codec/bands/band_coder.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>

namespace tessera::codec {
namespace {

template <class Word> struct MadeBands {
    std::vector<std::vector<Word>> values;
    std::vector<std::vector<std::uint8_t>> present;
    std::vector<Band<Word>> bands;

    std::vector<Band<const Word>> constant() const {
        std::vector<Band<const Word>> out;
        for (const Band<Word>& b : bands)
            out.push_back({b.values, b.present, b.size, b.rowPitch, b.slicePitch, b.kind});
        return out;
    }
};

/// Bands of odd sizes within wider arrays; coefficients from all zero to the whole range of the word.
template <class Word> MadeBands<Word> randomBands(std::mt19937& random, bool masked) {
    constexpr int kWidths[] = {1, 2, 3, 7, 15, 16, 17, 31, 32, 33, 64};
    MadeBands<Word> made;
    const std::size_t count = 1 + random() % 7;
    const auto spread = static_cast<unsigned>(random() % 20);
    for (std::size_t b = 0; b < count; ++b) {
        Band<Word> band;
        band.size = {kWidths[random() % std::size(kWidths)], 1 + int(random() % 20), 1 + int(random() % 12)};
        band.rowPitch = band.size.x + int(random() % 5);
        band.slicePitch = band.rowPitch * band.size.y + int(random() % 5);
        band.kind = int(random() % kBandKinds);
        std::vector<Word>& values = made.values.emplace_back(std::size_t(band.slicePitch * band.size.z));
        std::vector<std::uint8_t>& present = made.present.emplace_back(masked ? values.size() : 0);
        for (Word& value : values) {
            value = static_cast<Word>(std::normal_distribution(0.0, double(spread))(random));
            if (spread == 19 || random() % 500 == 0) value = static_cast<Word>(random());
            if (spread == 0) value = 0;
        }
        for (std::uint8_t& flag : present) flag = random() % 3 != 0 ? 1 : 0;
        made.bands.push_back(band);
    }
    for (std::size_t b = 0; b < count; ++b) {
        made.bands[b].values = made.values[b].data();
        made.bands[b].present = masked ? made.present[b].data() : nullptr;
    }
    return made;
}

template <class Word> void roundTrips(unsigned seed) {
    std::mt19937 random(seed);
    for (int trial = 0; trial < 300; ++trial) {
        const MadeBands<Word> made = randomBands<Word>(random, trial % 3 == 0);
        const auto source = made.constant();
        const Contexts contexts{trial % 5 == 0 ? 6 : 0, trial % 2 == 0};
        const int level = trial / 2 % 3;
        Histogram histogram(3, contexts);
        // With tables of other data, too, everything can be coded.
        const MadeBands<Word> other = randomBands<Word>(random, false);
        countTokens(tokensOf<Word>(trial % 4 == 0 ? other.constant() : source, contexts), level, histogram);
        const BandEncoder encoder(makeModel(histogram, 8));
        Bytes coded;
        const TokenRun run = tokensOf<Word>(source, contexts, Cpu::Portable);
        encoder.encode(run, level, coded, Cpu::Portable);
        if (bestCpu() == Cpu::Avx512) {
            const TokenRun other512 = tokensOf<Word>(source, contexts, Cpu::Avx512);
            ASSERT_EQ(other512.tokens, run.tokens) << trial;
            ASSERT_EQ(other512.zero, run.zero);
            Bytes same;
            encoder.encode(other512, level, same, Cpu::Avx512);
            ASSERT_EQ(same, coded) << trial;
        }
        const BandDecoder decoder(encoder.model());
        for (const Cpu cpu : {Cpu::Portable, Cpu::Avx2, Cpu::Avx512}) {
            if (cpu > bestCpu()) continue;
            std::vector<std::vector<Word>> decoded;
            std::vector<Band<Word>> bands = made.bands;
            for (std::size_t b = 0; b < bands.size(); ++b) decoded.emplace_back(made.values[b].size(), Word(77));
            for (std::size_t b = 0; b < bands.size(); ++b) bands[b].values = decoded[b].data();
            ASSERT_EQ(decoder.decode<Word>(coded, bands, level, cpu), DecodeStatus::Ok) << trial;
            for (std::size_t b = 0; b < bands.size(); ++b)
                for (std::ptrdiff_t i = 0; i < std::ptrdiff_t(decoded[b].size()); ++i) {
                    const Band<Word>& band = bands[b];
                    const std::ptrdiff_t inSlice = i % band.slicePitch, x = inSlice % band.rowPitch;
                    const bool inside = x < band.size.x && inSlice / band.rowPitch < band.size.y;
                    const Word found = decoded[b][std::size_t(i)];
                    const bool absent = band.present && band.present[i] == 0;
                    const Word wanted = !inside ? Word(77) : absent ? Word(0) : made.values[b][std::size_t(i)];
                    ASSERT_EQ(found, wanted) << "trial " << trial << " band " << b << " at " << i;
                }
        }
    }
}

TEST(BandCoder, GivesBackEveryCoefficient16) {
    roundTrips<std::int16_t>(1);
}
TEST(BandCoder, GivesBackEveryCoefficient32) {
    roundTrips<std::int32_t>(2);
}

TEST(BandCoder, ComesNearTheEntropyOfItsContexts) {
    std::mt19937 random(3);
    std::vector<std::int16_t> values(64 * 64 * 64);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<std::int16_t>(std::normal_distribution(0.0, 1.0 + double(i / 4096 % 16))(random));
    const Band<const std::int16_t> band{values.data(), nullptr, {64, 64, 64}, 64, 4096, 5};
    const Contexts contexts{0, true};
    Histogram histogram(1, contexts);
    const TokenRun run = tokensOf<std::int16_t>(std::span(&band, 1), contexts);
    countTokens(run, 0, histogram);
    const Model model = makeModel(histogram, 24);
    Bytes coded;
    BandEncoder(model).encode(run, 0, coded);
    EXPECT_LT(8.0 * double(coded.size()), bitsWith(model, histogram) * 1.001 + 64 * 32);
    EXPECT_LT(bitsWith(model, histogram), histogram.bits() * 1.01);
}

TEST(BandCoder, TellsBandsApart) {
    // Coefficients of two kinds of bands, the same neighbours, other values: one bit each by band, half a bit more
    // without.
    std::mt19937 random(7);
    std::vector<std::int16_t> ones(32 * 32 * 32), twos(ones.size());
    for (std::size_t i = 0; i < ones.size(); ++i) {
        ones[i] = random() % 2 == 0 ? 1 : -1;
        twos[i] = random() % 2 == 0 ? 1 : 0;
    }
    std::vector<Band<const std::int16_t>> bands{{ones.data(), nullptr, {32, 32, 32}, 32, 1024, 1},
                                                {twos.data(), nullptr, {32, 32, 32}, 32, 1024, 2}};
    const auto bitsOf = [&](bool byBand) {
        Histogram histogram(1, {8, byBand}); // so that all neighbours look like nothing
        countTokens(tokensOf<std::int16_t>(bands, histogram.contexts), 0, histogram);
        return bitsWith(makeModel(histogram, 8), histogram) / double(2 * ones.size());
    };
    EXPECT_NEAR(bitsOf(true), 1, 0.01);
    EXPECT_NEAR(bitsOf(false), 1.5, 0.01);
}

TEST(RansModel, FewSamplesShareTheTablesOfAllBands) {
    // The same statistics in all bands: nothing is gained by tables of their own.
    Histogram histogram(4, {0, true});
    for (std::size_t c = 0; c < histogram.counts.size(); ++c)
        for (std::size_t t = 0; t < 30; ++t) histogram.counts[c][t] = std::uint32_t(1000 / (t + 1 + c % kClasses));
    const Model model = makeModel(histogram, 24);
    for (int kind = 1; kind < kBandKinds; ++kind)
        for (std::size_t c = 0; c < kClasses; ++c)
            EXPECT_EQ(model.tableOf[model.contexts.first(0, kind) + c], model.tableOf[model.contexts.first(0) + c]);
}

TEST(BandCoder, RefusesTruncatedAndLongerBytesAndSurvivesAnyFlip) {
    std::mt19937 random(4);
    for (int trial = 0; trial < 25; ++trial) {
        MadeBands<std::int32_t> made = randomBands<std::int32_t>(random, trial % 2 == 0);
        const Contexts contexts{0, trial % 3 == 0};
        Histogram histogram(1, contexts);
        const TokenRun run = tokensOf<std::int32_t>(made.constant(), contexts);
        countTokens(run, 0, histogram);
        const BandEncoder encoder(makeModel(histogram, 8));
        Bytes coded;
        encoder.encode(run, 0, coded);
        const BandDecoder decoder(encoder.model());
        for (const Cpu cpu : {Cpu::Portable, Cpu::Avx2, Cpu::Avx512}) {
            if (cpu > bestCpu() || coded.empty()) continue;
            for (std::size_t length = 1; length <= coded.size() + 1; length += 1 + coded.size() / 97) {
                if (length == coded.size()) continue;
                // Of exactly that length, so that the sanitizer sees one byte too many.
                Bytes changed(coded.begin(), coded.begin() + std::ptrdiff_t(std::min(length, coded.size())));
                changed.resize(length);
                ASSERT_NE(decoder.decode<std::int32_t>(changed, made.bands, 0, cpu), DecodeStatus::Ok) << length;
            }
            for (std::size_t i = 0; i < coded.size(); i += 1 + coded.size() / 97) {
                coded[i] ^= static_cast<std::byte>(1 << (i % 8));
                (void)decoder.decode<std::int32_t>(coded, made.bands, 0, cpu);
                coded[i] ^= static_cast<std::byte>(1 << (i % 8));
            }
        }
    }
}

/// The code of one row of coefficients.
struct CodedRow {
    Model model;
    Bytes bytes;
    std::vector<std::int32_t> values;

    explicit CodedRow(std::vector<std::int32_t> row) : values(std::move(row)) {
        const Band<const std::int32_t> band{values.data(),      nullptr, {int(values.size()), 1, 1}, int(values.size()),
                                            int(values.size()), 0};
        const Contexts contexts{0, false};
        Histogram histogram(1, contexts);
        const TokenRun run = tokensOf<std::int32_t>(std::span(&band, 1), contexts);
        countTokens(run, 0, histogram);
        model = makeModel(histogram, 8);
        BandEncoder(model).encode(run, 0, bytes);
    }
    DecodeStatus decode(std::span<const std::byte> in, Cpu cpu) const {
        std::vector<std::int32_t> out(values.size());
        Band<std::int32_t> band{out.data(),         nullptr, {int(values.size()), 1, 1}, int(values.size()),
                                int(values.size()), 0};
        return BandDecoder(model).decode<std::int32_t>(in, std::span(&band, 1), 0, cpu);
    }
};

// Whatever is missing, even if what is left would do for a shorter row.
TEST(BandCoder, CallsWhatEndsEarlyTruncated) {
    for (const Cpu cpu : {Cpu::Portable, Cpu::Avx2, Cpu::Avx512}) {
        if (cpu > bestCpu()) continue;
        // A byte fewer of raw bits: of numbers with few of them, and of those with more than 25.
        for (const std::int32_t large : {100, 300'000'000}) {
            const CodedRow row({0, large, -1, 0, 0, large});
            ASSERT_EQ(row.decode(row.bytes, cpu), DecodeStatus::Ok);
            Bytes cut = row.bytes;
            ASSERT_LT(std::to_integer<int>(cut[0]), 128); // bytes of raw bits, which come first
            ASSERT_GT(std::to_integer<int>(cut[0]), 0);
            cut[0] = static_cast<std::byte>(std::to_integer<int>(cut[0]) - 1);
            cut.erase(cut.begin() + 1);
            EXPECT_EQ(row.decode(cut, cpu), DecodeStatus::Truncated) << large;
        }
        // A word fewer of tokens.
        std::mt19937 random(6);
        std::vector<std::int32_t> values(400);
        for (std::int32_t& value : values) value = int(random() % 9) - 4;
        const CodedRow row(std::move(values));
        const std::span<const std::byte> all(row.bytes);
        EXPECT_EQ(row.decode(all, cpu), DecodeStatus::Ok);
        EXPECT_EQ(row.decode(all.first(all.size() - 2), cpu), DecodeStatus::Truncated);
    }
}

TEST(RansModel, RareTokensTakeTheLeastOfTheTable) {
    Histogram histogram(1, {0, false});
    histogram.counts[0][0] = 10'000'000;
    for (std::size_t t = 1; t <= 20; ++t) histogram.counts[0][t] = 1;
    const Model model = makeModel(histogram, 1);
    ASSERT_EQ(model.tables.size(), 1u);
    for (std::size_t t = 1; t <= 20; ++t) EXPECT_EQ(model.tables[0][t], 1) << t;
    EXPECT_EQ(model.tables[0][kEscape], 1);
    EXPECT_EQ(model.tables[0][0], kProbabilityOne - 21);
}

TEST(RansModel, ContextsThatAreAlikeShareATableWhereverTheyAre) {
    // Small and large tokens take turns by context: two tables serve all, as well as a table each.
    Histogram histogram(3, {0, false});
    for (std::size_t c = 0; c < histogram.counts.size(); ++c)
        for (std::size_t t = 0; t < 8; ++t) histogram.counts[c][t + (c % 2) * 20] = std::uint32_t(5000 >> t);
    const Model model = makeModel(histogram, 2);
    ASSERT_EQ(model.tables.size(), 2u);
    for (std::size_t c = 2; c < histogram.counts.size(); ++c) EXPECT_EQ(model.tableOf[c], model.tableOf[c - 2]) << c;
    EXPECT_LT(bitsWith(model, histogram), histogram.bits() * 1.01);
}

TEST(RansModel, TokensCoverEverySymbol) {
    std::mt19937 random(5);
    for (int trial = 0; trial < 5000; ++trial) {
        const auto symbol = trial < 300 ? std::uint32_t(trial) : std::uint32_t(random()) >> (random() % 32);
        const Token token = tokenOf(symbol);
        ASSERT_LT(token.token, std::uint32_t(kEscape));
        ASSERT_EQ(rawBitsOf(token.token), token.rawBits);
        const std::uint32_t low = token.rawBits == 0 ? 0 : symbol & ((1u << token.rawBits) - 1);
        ASSERT_EQ(symbolBase(token.token) | low, symbol);
    }
    EXPECT_EQ(tokenOf(0xffffffffu).token, std::uint32_t(kEscape - 1));
}

TEST(RansModel, ComesBackAndRefusesDamage) {
    std::mt19937 random(6);
    for (int trial = 0; trial < 200; ++trial) {
        const int levels = 1 + int(random() % 6);
        Histogram histogram(levels, {int(random() % 32), trial % 2 == 0});
        const unsigned most = trial % 3 == 0 ? 30 : 100000;
        for (auto& context : histogram.counts)
            for (std::size_t t = 0; t < std::size_t(1 + random() % kTokens); ++t)
                context[t] = random() % 4 == 0 ? std::uint32_t(random() % most) : 0;
        const Model model = makeModel(histogram, 1 + int(random() % 20));
        ASSERT_EQ(model.tableOf.size(), histogram.counts.size());
        for (const Frequencies& table : model.tables) {
            std::uint32_t sum = 0;
            for (const std::uint16_t frequency : table) sum += frequency;
            ASSERT_EQ(sum, kProbabilityOne);
            ASSERT_GT(table[kEscape], 0);
        }
        Bytes bytes = serialise(model);
        Model parsed;
        ASSERT_EQ(parseModel(bytes, levels, parsed), DecodeStatus::Ok);
        ASSERT_EQ(parsed, model);
        bytes.push_back({});
        ASSERT_EQ(parseModel(bytes, levels, parsed), DecodeStatus::Trailing);
        for (std::size_t length = 1; length + 1 < bytes.size(); ++length)
            ASSERT_NE(parseModel(std::span(bytes).first(length), levels, parsed), DecodeStatus::Ok);
        for (int flip = 0; flip < 50; ++flip) {
            Bytes changed = bytes;
            changed[random() % changed.size()] ^= static_cast<std::byte>(1u << (random() % 8));
            if (parseModel(changed, levels, parsed) == DecodeStatus::Ok) (void)decodeTable(parsed);
        }
    }
}

} // namespace
} // namespace tessera::codec
