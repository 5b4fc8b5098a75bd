#include "codec/archive/archive.h"
#include "codec/archive/archive_state.h"
#include "codec/bands/fitted_bands.h"
#include "codec/bytes/bits.h"
#include "codec/pack/pack.h"
#include "tests/codec/make_dataset.h"
#include "tests/codec/plain_labels.h"
#include "tests/codec/sealed_file.h"

#include <cmath>
#include <cstring>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Samples that are predicted by weights fitted to them.
namespace tessera::codec {
namespace {

using namespace testing;
using volume::LatticeKind;
using volume::ScalarType;

constexpr Pass kAllPasses[] = {Pass::AlongZ, Pass::AlongY, Pass::AlongX, Pass::Odd};

/// A scan: two materials with a curved border, waves of four samples, and noise.
volume::Dataset scan(glm::ivec3 size, ScalarType type, int times = 1) {
    volume::Dataset made = makeDataset(size, {{"a", type, 1, Texture::Smooth, false, false}}, times);
    const volume::Lattice lattice = made.info.lattice;
    made.read = [lattice, type](int, int, int time) {
        volume::Field field = volume::makeField(lattice, type);
        std::mt19937 random(unsigned(time) + 5);
        std::normal_distribution<double> noise(0, 0.6);
        std::size_t i = 0;
        for (int z = 0; z < lattice.size.z; ++z)
            for (int y = 0; y < lattice.size.y; ++y)
                for (int x = 0; x < lattice.size.x; ++x, ++i) {
                    const double away = std::hypot(x - 20.0 - time, y - 18.0, z - 15.0 + 4 * std::sin(x * 0.2));
                    const double value =
                        std::clamp(60 + 100 / (1 + std::exp((away - 13) * 1.5)) +
                                       40 * std::sin(1.7 * x + 0.3) * std::sin(1.5 * y + 1.1 * z) + noise(random),
                                   0.0, 255.0);
                    volume::dispatch(type, [&]<class T>(T) {
                        // Floats with two decimals.
                        field.as<T>()[i] = std::is_same_v<T, float> ? static_cast<T>(std::rint(value * 100) / 100)
                                                                    : static_cast<T>(std::rint(value));
                    });
                }
        return field;
    };
    made.info.parameters[0].ranges = {{0, 255}};
    return made;
}

PackOptions thorough(StoredLattice lattice = StoredLattice::CC, int effort = 7) {
    PackOptions options;
    options.lattice = lattice;
    options.effort = effort;
    return options;
}

/// The model of the last frame.
KnownModel modelOf(const Archive& archive) {
    return stateOf(archive, false).lastModels.at(0);
}
bool isFitted(const Archive& archive) {
    return !modelOf(archive).model.fitted.empty();
}

void expectSameAsPlain(const std::string& path) {
    const Archive archive(path);
    const plain::Decoder decoder(readFile(path));
    const glm::ivec3 count = archive.grid().count();
    for (std::size_t time = 0; time < archive.info().times.size(); ++time)
        for (int level = 0; level < decoder.levels(); ++level)
            for (int number = 0; number < count.x * count.y * count.z; ++number) {
                const glm::ivec3 index{number % count.x, number / count.x % count.y, number / (count.x * count.y)};
                const volume::BrickKey key{0, int(time), level, index};
                const volume::BrickSamples expected = archive.read(key);
                const volume::BrickStats stats = archive.stats(key);
                const plain::Brick brick = decoder.brick(time, number, level);
                ASSERT_EQ(brick.values.size(), expected.values.size());
                for (std::size_t i = 0; i < brick.values.size(); ++i) {
                    const auto value = float(brick.values[i]);
                    const float held = level > 0 ? std::clamp(value, stats.min, stats.max) : value;
                    ASSERT_EQ(held, expected.values[i]) << "level " << level << " brick " << number << " sample " << i;
                }
            }
}

TEST(Fitted, ScansComeBackAndTakeFewerBytes) {
    const TemporaryFolder folder;
    for (const ScalarType type : {ScalarType::U8, ScalarType::I16, ScalarType::U16, ScalarType::F32}) {
        SCOPED_TRACE(int(type));
        volume::Dataset made = scan({41, 38, 33}, type);
        pack(made, thorough(StoredLattice::CC, 5), folder / "usual.tsr");
        pack(made, thorough(), folder / "fitted.tsr");
        const Archive usual(folder / "usual.tsr"), fitted(folder / "fitted.tsr");
        EXPECT_FALSE(isFitted(usual));
        ASSERT_TRUE(isFitted(fitted));
        EXPECT_EQ(readField(fitted, 0, 0, 0).samples, made.read(0, 0, 0).samples);
        EXPECT_LT(double(std::filesystem::file_size(folder / "fitted.tsr")),
                  0.97 * double(std::filesystem::file_size(folder / "usual.tsr")));
    }
}

TEST(Fitted, APlainReaderAgreesAtEveryLevel) {
    const TemporaryFolder folder;
    struct Case {
        glm::ivec3 size;
        ScalarType type;
        StoredLattice lattice;
        int brickSize;
    };
    for (const Case& one : {Case{{41, 38, 33}, ScalarType::U8, StoredLattice::CC, 16},
                            {{33, 34, 35}, ScalarType::U8, StoredLattice::BCC, 16},
                            {{40, 37, 30}, ScalarType::I16, StoredLattice::CC, 0},
                            {{40, 37, 30}, ScalarType::U16, StoredLattice::BCC, 0},
                            {{65, 33, 17}, ScalarType::F32, StoredLattice::CC, 16},
                            {{133, 140, 1}, ScalarType::U8, StoredLattice::CC, 32},
                            {{134, 2, 137}, ScalarType::U8, StoredLattice::CC, 32}}) {
        SCOPED_TRACE(one.size.x * 1000000 + one.size.y * 1000 + one.size.z);
        volume::Dataset made = scan(one.size, one.type);
        PackOptions options = thorough(one.lattice);
        options.brickSize = one.brickSize;
        pack(made, options, folder / "a.tsr");
        const Archive archive(folder / "a.tsr");
        ASSERT_TRUE(isFitted(archive));
        if (one.lattice == StoredLattice::CC) {
            EXPECT_EQ(readField(archive, 0, 0, 0).samples, made.read(0, 0, 0).samples);
        }
        expectSameAsPlain(folder / "a.tsr");
    }
}

TEST(Fitted, FloatsKeepTheirBound) {
    const TemporaryFolder folder;
    volume::Dataset made = scan({81, 78, 66}, ScalarType::U8);
    made.info.parameters[0].type = ScalarType::F32;
    const auto whole = made.read;
    made.read = [whole](int p, int c, int t) {
        volume::Field from = whole(p, c, t);
        volume::Field field = volume::makeField(from.lattice, ScalarType::F32);
        std::mt19937 random(8);
        for (std::size_t i = 0; i < field.count(); ++i)
            field.as<float>()[i] = float(from.value(i)) + float(random() % 1000) / 1000;
        return field;
    };
    std::uintmax_t usual = 0;
    for (const int effort : {5, 7}) {
        PackOptions options = thorough(StoredLattice::CC, effort);
        options.absError = 0.75;
        pack(made, options, folder / "a.tsr");
        const Archive archive(folder / "a.tsr");
        EXPECT_EQ(isFitted(archive), effort == 7);
        const volume::Field was = made.read(0, 0, 0), is = readField(archive, 0, 0, 0);
        double worst = 0;
        for (std::size_t i = 0; i < was.count(); ++i) worst = std::max(worst, std::abs(was.value(i) - is.value(i)));
        EXPECT_LE(worst, 0.75);
        EXPECT_GT(worst, 0.5);
        const std::uintmax_t bytes = std::filesystem::file_size(folder / "a.tsr");
        if (effort == 7) {
            EXPECT_LT(double(bytes), double(usual));
        }
        usual = bytes;
    }
    expectSameAsPlain(folder / "a.tsr");
}

TEST(Fitted, SlabsGiveTheArchiveThatAWholeFrameGives) {
    const TemporaryFolder folder;
    for (const StoredLattice lattice : {StoredLattice::CC, StoredLattice::BCC}) {
        volume::Dataset whole = scan({60, 50, 90}, ScalarType::U8), parts = whole;
        const auto frame = std::make_shared<const volume::Field>(whole.read(0, 0, 0));
        parts.read = [frame](int, int, int, volume::SliceRange slices) { return volume::slicesOf(*frame, slices); };
        PackOptions options = thorough(lattice);
        options.brickSize = 16;
        pack(whole, options, folder / "whole.tsr");
        EXPECT_TRUE(isFitted(Archive(folder / "whole.tsr")));
        const PackSummary summary = pack(parts, options, folder / "parts.tsr", {}, {}, 2);
        EXPECT_THAT(summary.notes, ::testing::Contains(::testing::HasSubstr("slabs")));
        EXPECT_TRUE(readFile(folder / "whole.tsr") == readFile(folder / "parts.tsr"));
    }
}

TEST(Fitted, TimesShareTheirWeights) {
    const TemporaryFolder folder;
    volume::Dataset made = scan({41, 38, 33}, ScalarType::U8, 3);
    pack(made, thorough(), folder / "a.tsr");
    const Archive archive(folder / "a.tsr");
    ASSERT_TRUE(isFitted(archive));
    EXPECT_EQ(modelOf(archive).number, 0);
    for (int t = 0; t < 3; ++t) {
        EXPECT_EQ(readField(archive, 0, 0, t).samples, made.read(0, 0, t).samples);
    }
    expectSameAsPlain(folder / "a.tsr");
}

TEST(Fitted, ATimeWithAbsentSamplesIsCodedAsUsual) {
    const TemporaryFolder folder;
    volume::Dataset made = scan({41, 38, 33}, ScalarType::U8, 3);
    made.read = [read = made.read](int p, int c, int time) {
        volume::Field field = read(p, c, time);
        volume::Mask mask(field.count(), 1);
        for (std::size_t i = 0; i < mask.size(); i += 11) mask[i] = 0;
        if (time == 1) field.mask = std::make_shared<const volume::Mask>(std::move(mask));
        return field;
    };
    pack(made, thorough(), folder / "a.tsr");
    const Archive archive(folder / "a.tsr");
    EXPECT_TRUE(isFitted(archive)) << "the last time";
    EXPECT_EQ(verifyArchive(archive).damaged, 0u);
    for (int t = 0; t < 3; ++t) {
        const volume::Field was = made.read(0, 0, t), is = readField(archive, 0, 0, t);
        for (std::size_t i = 0; i < was.count(); ++i) {
            ASSERT_EQ(was.present(i), is.present(i));
            if (was.present(i)) {
                ASSERT_EQ(was.value(i), is.value(i)) << "time " << t;
            }
        }
    }
}

TEST(Fitted, WhatCannotBePredictedIsCodedAsUsual) {
    const TemporaryFolder folder;
    const glm::ivec3 size{30, 29, 28};
    for (const MadeParameter& parameter : {MadeParameter{"absent", ScalarType::U8, 1, Texture::Smooth, true, false},
                                           {"wide", ScalarType::I32, 1, Texture::Nasty, false, false},
                                           {"float", ScalarType::F32, 1, Texture::Nasty, false, false},
                                           {"label", ScalarType::U8, 1, Texture::Noise, false, true}}) {
        SCOPED_TRACE(parameter.name);
        volume::Dataset made = makeDataset(size, {parameter}, 1);
        pack(made, thorough(), folder / "a.tsr");
        const Archive archive(folder / "a.tsr");
        EXPECT_FALSE(isFitted(archive));
        EXPECT_EQ(stateOf(archive, false).header.features & kFittedModels, 0u);
        EXPECT_EQ(readField(archive, 0, 0, 0).samples, made.read(0, 0, 0).samples);
    }
    // Nor if a wavelet is asked for.
    volume::Dataset made = scan(size, ScalarType::U8);
    PackOptions options = thorough();
    options.wavelet = WaveletChoice::W22;
    pack(made, options, folder / "a.tsr");
    EXPECT_FALSE(isFitted(Archive(folder / "a.tsr")));
}

TEST(Fitted, EffortChoosesFiltersAndBricks) {
    const TemporaryFolder folder;
    volume::Dataset made = scan({100, 90, 80}, ScalarType::U8);
    std::vector<std::uintmax_t> sizes;
    for (const int effort : {1, 5, 7, 9}) {
        pack(made, thorough(StoredLattice::CC, effort), folder / "a.tsr");
        const Archive archive(folder / "a.tsr");
        EXPECT_EQ(archive.grid().brickSize, effort == 9 ? 128 : 64);
        EXPECT_EQ(isFitted(archive), effort >= 7);
        if (effort == 1) {
            EXPECT_EQ(modelOf(archive).wavelet, Wavelet::W22);
        }
        EXPECT_EQ(readField(archive, 0, 0, 0).samples, made.read(0, 0, 0).samples);
        sizes.push_back(std::filesystem::file_size(folder / "a.tsr"));
    }
    EXPECT_THAT(sizes, ::testing::BeginEndDistanceIs(4));
    EXPECT_TRUE(std::ranges::is_sorted(sizes, std::greater<>())) << ::testing::PrintToString(sizes);
}

TEST(Fitted, AnArchiveThatDoesNotDeclareThemIsRefused) {
    const TemporaryFolder folder;
    volume::Dataset made = scan({30, 29, 28}, ScalarType::U8);
    pack(made, thorough(), folder / "a.tsr");
    Header header = stateOf(Archive(folder / "a.tsr"), false).header;
    ASSERT_NE(header.features & kFittedModels, 0u);
    header.features &= ~kFittedModels;
    const std::vector<char> packed = readFile(folder / "a.tsr");
    const auto* const data = reinterpret_cast<const std::byte*>(packed.data());
    const std::vector<char> bytes = sealed(header, Bytes(data, data + packed.size()));
    std::ofstream(folder / "b.tsr", std::ios::binary).write(bytes.data(), std::ptrdiff_t(bytes.size()));
    const Archive archive(folder / "b.tsr");
    try {
        (void)readField(archive, 0, 0, 0);
        FAIL() << "it was read";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), ::testing::HasSubstr("predictions that the archive does not declare"));
    }
}

TEST(Fitted, DamageIsReported) {
    // The segments of a brick with any byte changed or the end cut off: an error or other samples, never a crash.
    const BrickFormat format{LatticeKind::BCC, {17, 16, 30}, 3, Wavelet::N2, ScalarType::U8, {}, false, 8, true};
    std::vector<std::byte> samples(countOf(format.size));
    std::mt19937 random(2);
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = std::byte(100 + i % 17 + random() % 8);
    SplitMemory memory;
    WeightFit fit;
    addToFit(format, samples, 0, 1, memory, fit);
    const FittedWeights weights = fit.solved();
    Histogram histogram(format.levels, {});
    countBrick(prepareBrick(format, samples, {}, 0, {}, memory, {}, &weights), histogram);
    Model model = makeModel(histogram, 8);
    model.fitted = weights;
    Compressor compressor(3);
    const std::vector<Bytes> segments = encodeBrick(format, samples, {}, 0, compressor, BandEncoder(model));
    const BandDecoder decoder(model);
    const auto decode = [&](const std::vector<Bytes>& of, int level, DecodedBrick& out) {
        std::vector<std::span<const std::byte>> views(of.begin(), of.end() - level);
        return decodeBrick(format, views, level, {}, decoder, out);
    };
    DecodedBrick whole;
    ASSERT_EQ(decode(segments, 0, whole), DecodeStatus::Ok);
    const std::vector<std::uint32_t> codes = whole.codes();
    for (std::size_t i = 0; i < samples.size(); ++i) ASSERT_EQ(codes[i], std::uint32_t(samples[i]));
    for (std::size_t s = 0; s < segments.size(); ++s)
        for (std::size_t at = 0; at < segments[s].size(); at += 1 + segments[s].size() / 200) {
            std::vector<Bytes> cut = segments, changed = segments;
            cut[s].resize(at);
            changed[s][at] ^= std::byte(1 + at % 255);
            DecodedBrick out;
            EXPECT_NE(decode(cut, 0, out), DecodeStatus::Ok) << s << " " << at;
            (void)decode(changed, 0, out);
        }
    // Weights that a level needs are absent.
    Model without = model;
    without.fitted.at(1, Pass::AlongY).clear();
    DecodedBrick out;
    std::vector<std::span<const std::byte>> views(segments.begin(), segments.end());
    EXPECT_EQ(decodeBrick(format, views, 0, {}, BandDecoder(without), out), DecodeStatus::BadData);
}

TEST(FittedWeights, ComeBackAsWritten) {
    std::mt19937 random(1);
    FittedWeights weights;
    for (const Pass pass : {Pass::AlongZ, Pass::AlongX, Pass::Odd})
        for (const int level : {0, 2}) {
            PassWeights& own = weights.at(level, pass);
            own = plainWeights(pass);
            std::vector<std::int32_t> all(std::size_t(tapsOf(pass).count) + 1);
            for (std::size_t c = 0; c < kActivityClasses; ++c) {
                const std::uint32_t span = level == 0 ? 65535 : 30;
                for (std::int32_t& one : all) one = std::int32_t(random() % span) - std::int32_t(span / 2);
                if (c % 3 != 1) setClass(all, c, own);
            }
        }
    BitWriter out;
    write(weights, out);
    BitReader in(out.bytes);
    FittedWeights again;
    ASSERT_TRUE(read(in, again));
    EXPECT_EQ(again, weights);
    EXPECT_EQ(in.bytesRead(), out.bytes.size());
    for (std::size_t length = 0; length < out.bytes.size(); length += 7) {
        BitReader less(std::span(out.bytes).first(length));
        EXPECT_FALSE(read(less, again));
    }
    // A change that makes a weight too large.
    BitWriter large;
    large.put(1, 1);
    large.put(17, 5);
    large.put(65534 + 2, 17);
    large.bytes.resize(4000);
    BitReader tooLarge(large.bytes);
    EXPECT_FALSE(read(tooLarge, again));
}

template <class Word> class PredictedRows : public ::testing::Test {};
using Words = ::testing::Types<std::int16_t, std::int32_t>;
TYPED_TEST_SUITE(PredictedRows, Words);

/// The same in 64-bit sums, one sample at a time.
template <class Word>
std::int64_t predictedBy(Pass pass, const TapRows<Word>& taps, const PassWeights& weights, CodeRange range, int shift,
                         int x, std::uint32_t& activity) {
    const TapSet& set = tapsOf(pass);
    const auto tap = [&](int t) { return std::int64_t(taps.at(std::size_t(t))[x]); };
    const std::int64_t guess = std::int64_t(std::floor(double(tap(0) + tap(1)) / 2));
    activity = 0;
    for (int t = 0; t < set.near; ++t) activity += std::uint32_t(std::abs(tap(t) - guess));
    activity = std::min(activity >> shift, kMostActivity);
    const int half = int(std::floor(2 * std::log2(activity + 1.0)));
    // Between 2^e and 1.5 x 2^e, not 2^(e + 1/2): the next bit after the leading one.
    const int octave = int(std::floor(std::log2(activity + 1.0)));
    const bool upper = octave > 0 && activity + 1 >= 1.5 * std::exp2(octave);
    EXPECT_LE(std::abs(2 * octave + (upper ? 1 : 0) - half), 1);
    const std::size_t c = std::size_t(std::min(2 * octave + (upper ? 1 : 0), kActivityClasses - 1));
    std::int64_t sum = weights[std::size_t(set.count / 2) * kActivityClasses + c];
    for (int t = 0; t < set.count; ++t) {
        const std::int32_t pair = weights[std::size_t(t / 2) * kActivityClasses + c];
        sum += tap(t) * (t % 2 == 0 ? evenOf(pair) : oddOf(pair));
    }
    return std::clamp(std::int64_t(std::floor((double(sum) + 128) / 256)), std::int64_t(range.least),
                      std::int64_t(range.most));
}

TYPED_TEST(PredictedRows, AreTheSameOnEveryProcessor) {
    using Word = TypeParam;
    constexpr int kWidth = 71, kPadded = 96;
    const int bits = sizeof(Word) == 2 ? 8 : 16;
    std::mt19937 random(3);
    for (const Pass pass : kAllPasses)
        for (const bool isFlat : {false, true}) {
            const TapSet& set = tapsOf(pass);
            std::vector<std::vector<Word>> rows(std::size_t(set.count), std::vector<Word>(kPadded));
            for (auto& row : rows)
                for (Word& word : row) word = static_cast<Word>(isFlat ? 77 + random() % 3 : random() % (1u << bits));
            TapPlaces<Word> places{};
            for (std::size_t t = 0; t < rows.size(); ++t) places[t] = rows[t].data();
            PassWeights weights = plainWeights(pass);
            std::vector<std::int32_t> all(rows.size() + 1);
            for (std::size_t c = 0; c < kActivityClasses; ++c) {
                for (std::int32_t& one : all) one = std::int32_t(random() % 60) - 22;
                setClass(all, c, weights);
            }
            const CodeRange range{0, (1 << bits) - 1};
            const int shift = sizeof(Word) == 2 ? 0 : 3;
            const TapRows<Word> taps{places.data(), 0};
            for (const Cpu cpu : {Cpu::Portable, Cpu::Avx2, Cpu::Avx512}) {
                if (cpu > bestCpu()) continue;
                std::vector<Word> predicted(kPadded);
                std::vector<std::uint16_t> activity(kPadded);
                predictRow<Word>(pass, taps, weights, range, shift, kWidth, predicted.data(), activity.data(), cpu);
                for (int x = 0; x < kWidth; ++x) {
                    std::uint32_t wanted = 0;
                    ASSERT_EQ(std::int64_t(predicted[std::size_t(x)]),
                              predictedBy<Word>(pass, taps, weights, range, shift, x, wanted))
                        << int(pass) << " " << x;
                    ASSERT_EQ(activity[std::size_t(x)], wanted / 2);
                }
            }
        }
}

TEST(WeightFit, FindsTheRuleThatMadeTheSamples) {
    // A sample is 3/4 of one neighbour along x, 1/2 of the other, minus 1/4 of the row before.
    const glm::ivec3 size{63, 40, 30};
    LevelBox<std::int32_t> box(size, false);
    std::mt19937 random(4);
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) box.box().row(y, z)[x] = std::int32_t(4 * (random() % 200));
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 1; x < size.x; x += 2) {
                const auto at = [&](int dy, int dx) { return box.box().row(y + dy, z)[x + dx]; };
                const std::int32_t before = y > 0 ? at(-1, 0) : at(0, -1); // as predictions have it
                box.box().row(y, z)[x] = (3 * at(0, -1) + 2 * at(0, 1) - before) / 4;
            }
    FittedMemory<std::int32_t> memory;
    WeightFit fit;
    addToFit<std::int32_t>({0, std::as_const(box).box(), {}}, 0, 1, memory, fit);
    const FittedWeights weights = fit.solved();
    const TokenRun run =
        fittedTokens<std::int32_t>({0, std::as_const(box).box(), {}}, {}, weights, {-2000, 2000}, memory);
    ASSERT_FALSE(run.zero);
    const auto& differences = memory.differences[std::size_t(Pass::AlongX)];
    double far = 0, count = 0;
    for (int z = 1; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x / 2; ++x, count += 1) far += std::abs(differences.row(z, y)[x]) > 2 ? 1 : 0;
    EXPECT_LT(far / count, 0.02);
}

} // namespace
} // namespace tessera::codec
