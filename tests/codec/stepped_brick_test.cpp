#include "codec/brick/stepped_brick.h"

#include "codec/archive/archive.h"
#include "codec/archive/frame_steps.h"
#include "codec/pack/pack.h"
#include "tests/codec/make_dataset.h"

#include <cmath>
#include <cstring>
#include <gtest/gtest.h>

namespace tessera::codec {
namespace {

using namespace testing;
using volume::LatticeKind;
using volume::ScalarType;

struct SteppedInput {
    BrickFormat format;
    std::vector<std::uint32_t> codes;
    std::vector<std::uint8_t> present;
};

SteppedInput randomInput(std::mt19937& random) {
    constexpr int kSizes[] = {1, 2, 3, 8, 17, 30};
    constexpr std::uint32_t kQuanta[] = {1, 16, 300, 581, 5000, 1u << 28};
    const auto pick = [&](const auto& list) { return list[random() % std::size(list)]; };
    SteppedInput made;
    made.format.kind = random() % 2 == 0 ? LatticeKind::CC : LatticeKind::BCC;
    made.format.size = {pick(kSizes), pick(kSizes), pick(kSizes)};
    made.format.levels = 1 + int(random() % 5);
    made.format.wavelet = static_cast<Wavelet>(random() % std::size(kWaveletNames));
    made.format.numbers = {NumberKind::Stepped, 0, 1};
    made.format.codeBits = random() % 2 == 0 ? 16 : 28;
    made.format.bodyCentred = random() % 2 == 0;
    made.format.steps.split = {int(random() % 8), 2 + int(random() % 12)};
    made.format.steps.quantum = pick(kQuanta);
    const int amplitude = made.format.codeBits == 16 ? 8000 : 30000000;
    const bool noisy = random() % 3 == 0;
    for (std::size_t i = 0; i < countOf(made.format.size); ++i) {
        const double smooth = std::sin(0.02 * double(i)) + (noisy ? double(random() % 100) / 100 : 0.0);
        made.codes.push_back(static_cast<std::uint32_t>(static_cast<std::int32_t>(amplitude * smooth)));
    }
    if (random() % 2 == 0)
        for (std::size_t i = 0; i < made.codes.size(); ++i) made.present.push_back(random() % 5 != 0);
    return made;
}

/// What encodeBrick adds in front of the last segment, if nothing is stored exactly.
std::vector<Bytes> withoutExact(std::vector<Bytes> segments) {
    segments.back().insert(segments.back().begin(), 4, std::byte{0});
    return segments;
}

std::vector<std::span<const std::byte>> viewsOf(const std::vector<Bytes>& segments, std::size_t count) {
    return {segments.begin(), segments.begin() + std::ptrdiff_t(count)};
}

TEST(SteppedBrick, DecodesToWhatTheWriterSaysWithinTheReach) {
    std::mt19937 random(5);
    BrickLevels<std::int32_t> memory;
    for (int trial = 0; trial < 600; ++trial) {
        const SteppedInput made = randomInput(random);
        const SteppedBrick brick = encodeStepped(made.format, made.codes, made.present, {}, memory);
        const std::vector<Bytes> segments = withoutExact(brick.segments);
        DecodedBrick decoded;
        ASSERT_EQ(decodeStepped(made.format, viewsOf(segments, segments.size()), 0, made.present, {},
                                (decoded.begin(made.format, 0), decoded)),
                  DecodeStatus::Ok)
            << trial;
        const std::vector<std::uint32_t> codes = decoded.codes();
        for (std::size_t i = 0; i < codes.size(); ++i) {
            if (!made.present.empty() && made.present[i] == 0) continue;
            ASSERT_EQ(codes[i], brick.codes[i]) << trial;
            const std::int64_t apart =
                std::int64_t(static_cast<std::int32_t>(codes[i])) - static_cast<std::int32_t>(made.codes[i]);
            ASSERT_LE(std::abs(apart), kReach) << trial;
        }
    }
}

TEST(SteppedBrick, HasCoarseLevelsNearTheMeans) {
    SteppedInput made;
    made.format.size = {32, 32, 32};
    made.format.levels = 4;
    made.format.wavelet = Wavelet::W44;
    made.format.numbers = {NumberKind::Stepped, 0, 1};
    made.format.codeBits = 16;
    for (std::size_t i = 0; i < countOf(made.format.size); ++i)
        made.codes.push_back(static_cast<std::uint32_t>(i % 32 * 100));
    made.format.steps = usualSteps();
    BrickLevels<std::int32_t> memory;
    const std::vector<Bytes> segments = withoutExact(encodeStepped(made.format, made.codes, {}, {}, memory).segments);
    for (int level = 1; level < 4; ++level) {
        DecodedBrick decoded;
        decoded.begin(made.format, level);
        ASSERT_EQ(decodeStepped(made.format, viewsOf(segments, std::size_t(4 - level)), level, {}, {}, decoded),
                  DecodeStatus::Ok);
        const std::vector<std::uint32_t> codes = decoded.codes();
        ASSERT_EQ(codes.size(), countOf(levelSize(made.format.size, level)));
        const int width = 32 >> level;
        for (std::size_t i = 0; i < codes.size(); ++i)
            ASSERT_NEAR(static_cast<std::int32_t>(codes[i]), int(i) % width * (100 << level), 100 << level);
    }
}

TEST(SteppedBrick, RefusesWhatIsTooShortOrTooLong) {
    std::mt19937 random(6);
    BrickLevels<std::int32_t> memory;
    int refused = 0;
    for (int trial = 0; trial < 100; ++trial) {
        const SteppedInput made = randomInput(random);
        const std::vector<Bytes> whole =
            withoutExact(encodeStepped(made.format, made.codes, made.present, {}, memory).segments);
        const auto statusOf = [&](const std::vector<Bytes>& segments) {
            DecodedBrick decoded;
            decoded.begin(made.format, 0);
            return decodeStepped(made.format, viewsOf(segments, segments.size()), 0, made.present, {}, decoded);
        };
        ASSERT_EQ(statusOf(whole), DecodeStatus::Ok);
        for (std::size_t s = 0; s < whole.size(); ++s) {
            std::vector<Bytes> changed = whole;
            changed[s].resize(changed[s].size() + kMostLeftOut + 1);
            if (changed[s].size() > kMostLeftOut + 1 + (s + 1 == whole.size() ? 4u : 0u)) {
                EXPECT_EQ(statusOf(changed), DecodeStatus::Trailing) << trial;
            }
            if (whole[s].size() < 16) continue;
            changed = whole;
            changed[s].resize(8);
            refused += statusOf(changed) != DecodeStatus::Ok ? 1 : 0;
        }
    }
    EXPECT_GT(refused, 50);
}

TEST(SteppedBrick, StepsAreReadAsWrittenAndWhatIsNoneIsRefused) {
    const StepChoice steps{{5, 4}, 70000};
    const Bytes whole = serialise(steps);
    StepChoice read;
    ASSERT_EQ(parseSteps(whole, read), DecodeStatus::Ok);
    EXPECT_EQ(read, steps);
    for (std::size_t length = 0; length < whole.size(); ++length)
        EXPECT_NE(parseSteps(std::span(whole).first(length), read), DecodeStatus::Ok) << length;
    Bytes longer = whole;
    longer.push_back(std::byte{0});
    EXPECT_EQ(parseSteps(longer, read), DecodeStatus::Trailing);
    for (const StepChoice& bad :
         {StepChoice{{8, 4}, 16}, StepChoice{{7, 1}, 16}, StepChoice{{7, 4}, 0}, StepChoice{{7, 4}, (1u << 28) + 1}})
        EXPECT_EQ(parseSteps(serialise(bad), read), DecodeStatus::BadMode) << bad.split.axes << ' ' << bad.quantum;
}

TEST(SteppedBrick, DecodesDamagedBytesToSomethingOrRefusesThem) {
    std::mt19937 random(7);
    BrickLevels<std::int32_t> memory;
    int refused = 0, accepted = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const SteppedInput made = randomInput(random);
        std::vector<Bytes> segments =
            withoutExact(encodeStepped(made.format, made.codes, made.present, {}, memory).segments);
        for (Bytes& segment : segments) {
            for (std::uint32_t change = random() % 4; change > 0 && !segment.empty(); --change)
                segment[random() % segment.size()] = static_cast<std::byte>(random());
            if (random() % 4 == 0) segment.resize(random() % (segment.size() + 4));
        }
        for (int level = 0; level < made.format.levels; ++level) {
            DecodedBrick decoded;
            decoded.begin(made.format, level);
            const DecodeStatus status =
                decodeStepped(made.format, viewsOf(segments, std::size_t(made.format.levels - level)), level,
                              made.present, {}, decoded);
            ++(status == DecodeStatus::Ok ? accepted : refused);
            if (status == DecodeStatus::Ok) {
                ASSERT_EQ(decoded.codes().size(), countOf(decoded.size));
            }
        }
    }
    EXPECT_GT(refused, 50);
    EXPECT_GT(accepted, 50);
}

/// One parameter on a grid; `valueAt` in a box of size 1.
volume::Dataset smoothDataset(glm::ivec3 size, auto&& valueAt, bool masked) {
    volume::Dataset made = makeDataset(size, {{"a", ScalarType::F32, 1, Texture::Smooth, masked, false}}, 1);
    volume::Field field = made.read(0, 0, 0);
    std::size_t i = 0;
    Range range{1e30, -1e30};
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x, ++i) {
                const auto value = float(valueAt(glm::dvec3(x, y, z) / glm::dvec3(size)));
                field.as<float>()[i] = value;
                if (!field.present(i)) continue;
                range = {std::min(range.lo, double(value)), std::max(range.hi, double(value))};
            }
    made.info.parameters[0].ranges = {range};
    made.read = [field](int, int, int) { return field; };
    return made;
}

double wave(glm::dvec3 at) {
    return std::sin(7 * at.x + 2 * at.z) * std::cos(5 * at.y) + (at.x > 0.4 ? 1.0 : 0.0) * (2 - at.z);
}

struct Errors {
    double largest = 0, rms = 0;
};

Errors errorsOf(const volume::Field& stored, const volume::Field& source) {
    Errors errors;
    double count = 0;
    for (std::size_t i = 0; i < source.count(); ++i) {
        if (!source.present(i)) continue;
        const double apart = double(stored.as<float>()[i]) - double(source.as<float>()[i]);
        errors.largest = std::max(errors.largest, std::abs(apart));
        errors.rms += apart * apart;
        ++count;
    }
    errors.rms = std::sqrt(errors.rms / count);
    return errors;
}

TEST(SteppedArchive, KeepsTheBoundInFewBytesAndSaysThatReadersMustKnow) {
    const TemporaryFolder folder;
    for (const bool masked : {false, true}) {
        volume::Dataset made = smoothDataset({40, 36, 70}, wave, masked);
        const volume::Field source = made.read(0, 0, 0);
        for (const double bound : {1e-2, 1e-3, 1e-4}) {
            PackOptions options;
            options.lattice = StoredLattice::CC;
            options.maxError = bound;
            options.brickSize = 128;
            pack(made, options, folder / "a.tsr");
            const Archive archive(folder / "a.tsr");
            const double allowed = bound * extentOf(made.info.parameters[0]);
            EXPECT_LE(errorsOf(readField(archive, 0, 0, 0), source).largest, allowed);
            // With quantised samples a sample of this field takes 0.5, 1.1 and 2 bits without a mask.
            if (!masked) {
                const double bits = 8.0 * double(archive.fileBytes()) / double(source.count());
                EXPECT_LT(bits, bound > 5e-3 ? 0.2 : bound > 5e-4 ? 0.35 : 0.8) << bound;
            }
            EXPECT_EQ(readFile(folder / "a.tsr")[12] & 16, 16) << "features of the header";
            EXPECT_EQ(verifyArchive(archive).damaged, 0u);
        }
        PackOptions lossless;
        lossless.lattice = StoredLattice::CC;
        pack(made, lossless, folder / "a.tsr");
        EXPECT_EQ(readFile(folder / "a.tsr")[12] & 16, 0);
    }
}

TEST(SteppedArchive, KeepsABoundOfAboutTheDistanceOfFloats) {
    const TemporaryFolder folder;
    volume::Dataset made = smoothDataset(
        {30, 30, 30}, [](glm::dvec3 at) { return 100000 + wave(at); }, false);
    const volume::Field source = made.read(0, 0, 0);
    PackOptions options;
    options.lattice = StoredLattice::CC;
    options.absError = 0.01; // floats are 1/128 apart
    pack(made, options, folder / "a.tsr");
    const Archive archive(folder / "a.tsr");
    EXPECT_LE(errorsOf(readField(archive, 0, 0, 0), source).largest, 0.01);
    EXPECT_LT(8.0 * double(archive.fileBytes()) / double(source.count()), 2.5);
}

// Later times are coded as the one before while that is shorter, and otherwise chosen anew.
TEST(SteppedArchive, LaterTimesAreCodedAsWellAsAlone) {
    const TemporaryFolder folder;
    const glm::ivec3 size(40, 36, 50);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> noise(-1, 1);
    const auto ripple = [](glm::dvec3 at) { return wave(at) + 0.02 * std::sin(90 * at.x) * std::sin(80 * at.z); };
    const auto rough = [&](glm::dvec3) { return noise(random); };
    const std::vector<volume::Dataset> times = {smoothDataset(size, wave, false), smoothDataset(size, ripple, false),
                                                smoothDataset(size, rough, false), smoothDataset(size, wave, true)};
    PackOptions options;
    options.lattice = StoredLattice::CC;
    options.absError = 0.005;
    double alone = 0;
    for (volume::Dataset one : times) {
        pack(one, options, folder / "one.tsr");
        alone += double(Archive(folder / "one.tsr").fileBytes());
    }
    volume::Dataset series = times[0];
    series.info.times = {0, 1, 2, 3};
    series.info.parameters[0].ranges.clear();
    series.read = [&](int, int, int time) { return times[std::size_t(time)].read(0, 0, 0); };
    pack(series, options, folder / "series.tsr");
    const Archive archive(folder / "series.tsr");
    EXPECT_LT(double(archive.fileBytes()), 1.05 * alone);
    for (int time = 0; time < 4; ++time)
        EXPECT_LE(errorsOf(readField(archive, 0, 0, time), times[std::size_t(time)].read(0, 0, 0)).largest, 0.005);
}

// Steps are tried at times 0 and 16 and kept between them, whoever wrote the time before.
TEST(SteppedArchive, GrowsAsIfWrittenAtOnce) {
    const TemporaryFolder folder;
    constexpr int kTimes = 18;
    const auto seriesOf = [](int from, int to) {
        volume::Dataset made = smoothDataset({24, 20, 28}, wave, false);
        made.info.times.clear();
        for (int time = from; time < to; ++time) made.info.times.push_back(time);
        made.info.parameters[0].ranges.clear();
        made.read = [from](int, int, int time) {
            const double shift = 0.1 * (from + time), waves = 4.0 * (from + time);
            return smoothDataset(
                       {24, 20, 28},
                       [&](glm::dvec3 at) { return wave(at + shift) + 0.02 * std::sin(waves * (at.x + at.z)); }, false)
                .read(0, 0, 0);
        };
        return made;
    };
    PackOptions options;
    options.lattice = StoredLattice::CC;
    options.absError = 0.002;
    volume::Dataset all = seriesOf(0, kTimes);
    pack(all, options, folder / "whole.tsr");
    const Archive whole(folder / "whole.tsr");
    for (const int first : {1, 7, 16, 17}) {
        volume::Dataset begin = seriesOf(0, first), rest = seriesOf(first, kTimes);
        pack(begin, options, folder / "grown.tsr");
        append(rest, folder / "grown.tsr");
        const Archive grown(folder / "grown.tsr");
        for (int time = 0; time < kTimes; ++time)
            ASSERT_TRUE(readField(grown, 0, 0, time).samples == readField(whole, 0, 0, time).samples)
                << first << ' ' << time;
    }
}

} // namespace
} // namespace tessera::codec
