#include "codec/unpack/corrections.h"

#include "codec/container/exactness.h"
#include "codec/pack/pack.h"
#include "codec/unpack/unpack.h"
#include "tests/codec/make_dataset.h"
#include "volume/field/part_masks.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace tessera::codec {
namespace {

using namespace testing;
using volume::Dataset;
using volume::Field;
using volume::ScalarType;

constexpr glm::ivec3 kSize{17, 14, 13};

/// A label volume with thin parts: plates of 1 to 3 samples at any angle, rods, single samples.
std::vector<std::uint8_t> randomLabels(std::mt19937& random) {
    std::vector<std::uint8_t> labels(std::size_t(kSize.x) * kSize.y * kSize.z, 0);
    const auto number = [&](double lo, double hi) { return std::uniform_real_distribution(lo, hi)(random); };
    const auto at = [&](int x, int y, int z) -> std::uint8_t& {
        return labels[(std::size_t(z) * kSize.y + y) * kSize.x + x];
    };
    const int plates = 1 + int(random() % 2), rods = int(random() % 3), singles = int(random() % 6);
    for (int p = 0; p < plates; ++p) {
        const glm::dvec3 normal =
            random() % 2 == 0 ? glm::dvec3(0, 0, 1) : glm::normalize(glm::dvec3(number(-1, 1), number(-1, 1), 1));
        const double place = number(3, 9), thick = 0.5 * (1 + int(random() % 3));
        for (int z = 0; z < kSize.z; ++z)
            for (int y = 0; y < kSize.y; ++y)
                for (int x = 0; x < kSize.x; ++x) {
                    const double d = glm::dot(normal, glm::dvec3(x, y, z)) - place;
                    if (std::abs(d) < thick)
                        at(x, y, z) = 1;
                    else if (d > 0 && at(x, y, z) != 1)
                        at(x, y, z) = 2;
                }
    }
    for (int r = 0; r < rods; ++r) {
        const int x = int(random() % 16), y = int(random() % 13);
        for (int z = 0; z < kSize.z; ++z) at(x, y, z) = 3;
    }
    for (int s = 0; s < singles; ++s) at(int(random() % 17), int(random() % 14), int(random() % 13)) = 2;
    return labels;
}

/// A number and a vector that jump between the parts of a random label, each absent in one of them, integers, and the
/// label.
Dataset randomCell(unsigned seed, int times) {
    std::mt19937 random(seed);
    const std::vector<std::uint8_t> labels = randomLabels(random);
    const bool gaps = random() % 2 == 0;
    Dataset made;
    made.info.name = "cell";
    made.info.lattice = {volume::LatticeKind::CC, kSize, {0.5, 1, 0.25}, {1, -2, 3}};
    made.info.bounds = {made.info.lattice.origin, made.info.lattice.position(kSize - 1)};
    made.info.times.clear();
    for (int t = 0; t < times; ++t) made.info.times.push_back(2 * t);
    volume::Parameter p, u, n, region;
    p.name = "p";
    p.unit = "Pa";
    p.parts = {"region", {{0}, {2}}};
    u.name = "U";
    u.components = 2;
    n.name = "n";
    n.type = ScalarType::U8;
    region.name = "region";
    region.type = ScalarType::U8;
    region.categorical = true;
    made.info.parameters = {p, u, n, region};
    made.read = [labels, gaps, lattice = made.info.lattice](int parameter, int component, int time) {
        constexpr ScalarType kTypes[] = {ScalarType::F32, ScalarType::F32, ScalarType::U8, ScalarType::U8};
        Field field = volume::makeField(lattice, kTypes[parameter]);
        volume::Mask mask(field.count(), 1);
        std::size_t i = 0;
        for (int z = 0; z < kSize.z; ++z)
            for (int y = 0; y < kSize.y; ++y)
                for (int x = 0; x < kSize.x; ++x, ++i) {
                    const int label = labels[i];
                    const double wave = std::sin(0.4 * x + 0.3 * time) + 0.1 * y - 0.2 * z;
                    if (parameter == 0) field.as<float>()[i] = float(101325 + 27000 * label + 300 * wave);
                    if (parameter == 1) field.as<float>()[i] = float(label == 1 ? 0 : wave + component);
                    if (parameter == 2) field.as<std::uint8_t>()[i] = std::uint8_t(120 + 60 * wave);
                    if (parameter == 3) field.as<std::uint8_t>()[i] = std::uint8_t(label);
                    if (gaps && ((parameter == 0 && label == 1) || (parameter == 1 && label == 3) ||
                                 (parameter == 2 && (x + y + z) % 11 == 0)))
                        mask[i] = 0;
                }
        field.mask = std::make_shared<const volume::Mask>(std::move(mask));
        return volume::withoutParts(field);
    };
    return made;
}

struct Found {
    double largest = 0;       ///< difference of a present sample
    std::size_t presence = 0; ///< samples present on one side only
};
Found compare(const Field& a, const Field& b) {
    Found found;
    for (std::size_t i = 0; i < a.count(); ++i) {
        if (a.present(i) != b.present(i)) ++found.presence;
        if (a.present(i) && b.present(i)) found.largest = std::max(found.largest, std::abs(a.value(i) - b.value(i)));
    }
    return found;
}

double extentOf(const Archive& archive, int p) {
    const Range& range = archive.info().parameters[std::size_t(p)].ranges.front();
    double extent = 0;
    for (int c = 0; c < archive.info().parameters[std::size_t(p)].components; ++c) {
        const Range& own = archive.info().parameters[std::size_t(p)].ranges[std::size_t(c)];
        extent = std::max(extent, own.hi - own.lo);
    }
    return range.hi >= range.lo ? extent : 0;
}

/// Labels, presence and bounds of an archive at every sample of what was packed, at every time.
void expectKept(const Dataset& made, const std::shared_ptr<const Archive>& archive, double maxError) {
    const Dataset back = gridDataset(archive, 0);
    ASSERT_EQ(back.info.times, made.info.times);
    ASSERT_EQ(back.info.lattice, made.info.lattice);
    for (int p = 0; p < int(made.info.parameters.size()); ++p)
        for (int c = 0; c < made.info.parameters[std::size_t(p)].components; ++c)
            for (int t = 0; t < int(made.info.times.size()); ++t) {
                SCOPED_TRACE(made.info.parameters[std::size_t(p)].name + " at " + std::to_string(t));
                const Found found = compare(made.read(p, c, t), back.read(p, c, t));
                ASSERT_EQ(found.presence, 0u);
                if (made.info.parameters[std::size_t(p)].categorical)
                    ASSERT_EQ(found.largest, 0);
                else if (maxError > 0)
                    ASSERT_LE(found.largest, maxError * extentOf(*archive, p));
                else if (archive->metadata().resampled.empty())
                    ASSERT_EQ(found.largest, 0);
                else
                    ASSERT_LE(found.largest, archive->metadata().resampled[std::size_t(p)]->largest);
            }
}

TEST(Corrections, KeepLabelsPresenceAndBoundsAtEverySampleOfTheSource) {
    const TemporaryFolder folder;
    for (unsigned seed = 0; seed < 200; ++seed) {
        SCOPED_TRACE(seed);
        PackOptions options;
        options.lattice = seed % 10 == 9 ? StoredLattice::D4 : StoredLattice::BCC;
        const double bounds[] = {0, 1e-2, 1e-3, 1e-4};
        options.maxError = bounds[seed / 2 % 4];
        Dataset made = randomCell(seed, options.lattice == StoredLattice::D4 ? 8 : 1 + int(seed % 3));
        pack(made, options, folder / "a.tsr");
        const auto archive = std::make_shared<const Archive>(folder / "a.tsr");
        ASSERT_FALSE(archive->metadata().corrections.empty());
        EXPECT_TRUE(isCorrected(*archive));
        ASSERT_NO_FATAL_FAILURE(expectKept(made, archive, options.maxError));
        if (seed < 12) {
            const VerifyReport report = verifyArchive(*archive);
            EXPECT_EQ(report.damaged, 0u);
        }
    }
}

TEST(Corrections, WithoutABoundKeepPressuresOnTheirSide) {
    const TemporaryFolder folder;
    PackOptions options;
    options.lattice = StoredLattice::BCC;
    Dataset made = randomCell(4, 1);
    pack(made, options, folder / "a.tsr");
    const auto archive = std::make_shared<const Archive>(folder / "a.tsr");
    const Field p = made.read(0, 0, 0), back = gridDataset(archive, 0).read(0, 0, 0), label = made.read(3, 0, 0);
    // Labels are 27 kPa apart, waves at most 1.5 kPa.
    double worst = 0;
    for (std::size_t i = 0; i < p.count(); ++i)
        if (p.present(i) && (label.value(i) == 0 || label.value(i) == 2))
            worst = std::max(worst, std::abs(p.value(i) - back.value(i)));
    EXPECT_LT(worst, 1500);
    EXPECT_EQ(worst <= archive->metadata().resampled[0]->largest, true);
}

TEST(Corrections, HoldOtherBoundsToo) {
    const TemporaryFolder folder;
    Dataset made = randomCell(7, 2);
    PackOptions absolute;
    absolute.lattice = StoredLattice::BCC;
    absolute.absError = 0.75;
    pack(made, absolute, folder / "a.tsr");
    auto archive = std::make_shared<const Archive>(folder / "a.tsr");
    for (int p = 0; p < 3; ++p)
        EXPECT_LE(compare(made.read(p, 0, 1), gridDataset(archive, 0).read(p, 0, 1)).largest, p == 2 ? 0 : 0.75);
    PackOptions mean;
    mean.lattice = StoredLattice::BCC;
    mean.psnr = 50;
    pack(made, mean, folder / "b.tsr");
    archive = std::make_shared<const Archive>(folder / "b.tsr");
    for (int p = 0; p < 3; ++p) {
        const Field source = made.read(p, 0, 0), back = gridDataset(archive, 0).read(p, 0, 0);
        double squares = 0, count = 0;
        for (std::size_t i = 0; i < source.count(); ++i)
            if (source.present(i)) squares += std::pow(source.value(i) - back.value(i), 2), count += 1;
        EXPECT_LE(std::sqrt(squares / count), extentOf(*archive, p) * std::pow(10, -50.0 / 20)) << p;
    }
}

TEST(Corrections, GoWithTimesAndParametersThatAreAppended) {
    const TemporaryFolder folder;
    const Dataset whole = randomCell(6, 5);
    PackOptions options;
    options.lattice = StoredLattice::BCC;
    options.maxError = 1e-3;
    Dataset first = volume::withTimes(whole, {0, 1, 2}), last = volume::withTimes(whole, {3, 4});
    pack(first, options, folder / "a.tsr");
    append(last, folder / "a.tsr");
    auto archive = std::make_shared<const Archive>(folder / "a.tsr");
    EXPECT_EQ(archive->metadata().corrections.size(), 2u);
    ASSERT_NO_FATAL_FAILURE(expectKept(whole, archive, 1e-3));

    Dataset some = whole, more = whole; // p, region; then U, n with the region again
    const auto only = [](Dataset& data, std::vector<int> kept) {
        std::vector<volume::Parameter> parameters;
        for (const int p : kept) parameters.push_back(data.info.parameters[std::size_t(p)]);
        data.info.parameters = parameters;
        data.read = [read = data.read, kept](int p, int c, int t) { return read(kept[std::size_t(p)], c, t); };
    };
    only(some, {1, 3});
    only(more, {0, 2, 3});
    pack(some, options, folder / "b.tsr");
    append(more, folder / "b.tsr");
    archive = std::make_shared<const Archive>(folder / "b.tsr");
    Dataset ordered = whole;
    only(ordered, {1, 3, 0, 2});
    EXPECT_TRUE(isCorrected(*archive));
    ASSERT_NO_FATAL_FAILURE(expectKept(ordered, archive, 1e-3));
}

TEST(Corrections, StayWhenAnArchiveIsPackedAgain) {
    const TemporaryFolder folder;
    Dataset made = randomCell(8, 1);
    PackOptions options;
    options.lattice = StoredLattice::BCC;
    options.maxError = 1e-3;
    pack(made, options, folder / "a.tsr");
    const auto archive = std::make_shared<const Archive>(folder / "a.tsr");
    Dataset stored = storedDataset(archive), grid = gridDataset(archive, 0);
    pack(stored, options, folder / "b.tsr", {}, packedBefore(archive));
    const auto again = std::make_shared<const Archive>(folder / "b.tsr");
    EXPECT_TRUE(isCorrected(*again));
    EXPECT_NEAR(again->metadata().maxError, 2e-3, 1e-4);
    ASSERT_NO_FATAL_FAILURE(expectKept(made, again, again->metadata().maxError * (1 + 1e-6)));
    PackOptions cc;
    pack(grid, cc, folder / "c.tsr", {}, packedBefore(archive));
    EXPECT_EQ(exactnessText(Archive(folder / "c.tsr").metadata()), "error within 0.001 of range");
}

TEST(Corrections, WithoutABoundSayTheErrorsOfWhatWasPackedToo) {
    const TemporaryFolder folder;
    Dataset made = randomCell(8, 1);
    PackOptions options;
    options.lattice = StoredLattice::BCC;
    options.maxError = 0.02;
    pack(made, options, folder / "a.tsr");
    const auto archive = std::make_shared<const Archive>(folder / "a.tsr");
    Dataset stored = storedDataset(archive);
    options.maxError = 0;
    pack(stored, options, folder / "b.tsr", {}, packedBefore(archive));
    const auto again = std::make_shared<const Archive>(folder / "b.tsr");
    ASSERT_FALSE(again->metadata().resampled.empty());
    ASSERT_NO_FATAL_FAILURE(expectKept(made, again, 0)); // within what it says, beside the source of both
    EXPECT_GT(again->metadata().resampled[0]->largest, 0.02 * extentOf(*again, 0));
}

TEST(Corrections, HoldBoundsThatDifferencesOfFloatsCannot) {
    const TemporaryFolder folder;
    Dataset made = randomCell(2, 1);
    PackOptions options;
    options.lattice = StoredLattice::BCC;
    options.absError = 1e-3; // of pressures of 1e5
    pack(made, options, folder / "a.tsr");
    const auto archive = std::make_shared<const Archive>(folder / "a.tsr");
    for (int p = 0; p < 3; ++p)
        EXPECT_LE(compare(made.read(p, 0, 0), gridDataset(archive, 0).read(p, 0, 0)).largest, 1e-3) << p;
}

TEST(Corrections, HoldForIntegersOfEveryType) {
    const TemporaryFolder folder;
    for (const ScalarType type : {ScalarType::U8, ScalarType::I16, ScalarType::U16, ScalarType::I32})
        for (const Texture texture : {Texture::Smooth, Texture::Noise, Texture::Nasty})
            for (const double bound : {0.4, 3.2, 100.0}) {
                SCOPED_TRACE(std::string(volume::name(type)) + " " + std::to_string(int(texture)));
                Dataset made = makeDataset({12, 11, 10}, {{"n", type, 1, texture, true, false}}, 1);
                PackOptions options;
                options.lattice = StoredLattice::BCC;
                options.absError = bound;
                pack(made, options, folder / "a.tsr");
                const auto archive = std::make_shared<const Archive>(folder / "a.tsr");
                const Found found = compare(made.read(0, 0, 0), gridDataset(archive, 0).read(0, 0, 0));
                EXPECT_EQ(found.presence, 0u);
                EXPECT_LE(found.largest, bound);
            }
}

TEST(Corrections, OfLinearFilteringInTimeAreRefused) {
    const TemporaryFolder folder;
    Dataset made = randomCell(3, 8);
    PackOptions options;
    options.lattice = StoredLattice::D4;
    options.maxError = 1e-2;
    pack(made, options, folder / "a.tsr");
    const auto archive = std::make_shared<const Archive>(folder / "a.tsr");
    EXPECT_THROW((void)gridDataset(archive, 0, volume::TimeFilter::Linear), Error);
    EXPECT_NO_THROW((void)gridDataset(archive, 1, volume::TimeFilter::Linear));
}

} // namespace
} // namespace tessera::codec
