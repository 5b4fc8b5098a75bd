#include "volume/import/data_jumps.h"

#include "tests/volume/regions.h"
#include "volume/base/error.h"
#include "volume/field/part_masks.h"
#include "volume/import/import.h"
#include "volume/resample/resample.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <random>
#include <unistd.h>

namespace tessera::volume {
namespace {

using test::ccLattice;
using test::sampled;

std::vector<std::uint8_t> regionsOf(const Field& field) {
    return regionsOfJumps(std::span(&field, 1));
}

int mostOf(const std::vector<std::uint8_t>& regions) {
    return *std::ranges::max_element(regions);
}

/// The data of tests/volume/regions.h without their label, and the rule.
template <class Value> Dataset withoutLabel(const Lattice& lattice, const Value& value, int times = 1) {
    Dataset data = test::twoRegions(lattice, value, {.speed = 1}, times);
    data.info.parameters.resize(1);
    data.info.parameters[0].parts = {};
    std::vector<std::string> notes;
    data = withJumps(std::move(data), {parsePartsRule("v=jumps")}, notes);
    EXPECT_EQ(notes, (std::vector<std::string>{"v: 2 parts by jumps of the data: 1 | 2"}));
    return data;
}

TEST(DataJumps, OfTwoRegionsNothingIsMixedWithoutALabel) {
    const Lattice cc = ccLattice({17, 15, 16}, {1, 1.1, 0.9});
    const test::TwoRegions regions{.speed = 1};
    const auto regionAt = [&](glm::dvec3 p, int time) { return regions.at(p, time); };
    for (const bool linear : {false, true}) {
        const Dataset data = linear ? withoutLabel(cc, test::linearIn, 3) : withoutLabel(cc, test::constantIn, 3);
        const DatasetInfo& info = data.info;
        ASSERT_EQ(info.parameters.size(), 2u);
        EXPECT_EQ(info.parameters[0].parts, (Parts{"v jumps", {{1}, {2}}}));
        EXPECT_TRUE(info.parameters[1].categorical);
        const Dataset parted = withParts(data);
        for (int time = 0; time < 3; ++time) {
            const Field labels = data.read(1, 0, time);
            const Field truth = sampled<std::uint8_t>(cc, [&](glm::dvec3 p) { return regionAt(p, time); });
            for (std::size_t i = 0; i < cc.count(); ++i)
                ASSERT_EQ(labels.value(i), truth.value(i) == 1 ? 1 : 2) << time;
            const Field bcc = toBcc(parted.read(0, 0, time), false), owner = toBcc(truth, true);
            for (std::size_t i = 0; i < bcc.count(); ++i) {
                const int own = int(owner.value(i));
                if (!linear) {
                    ASSERT_FLOAT_EQ(float(bcc.value(i)), float(test::constantIn(own, {})));
                } else {
                    ASSERT_TRUE(own == 1 ? bcc.value(i) < 12 : bcc.value(i) > 45) << bcc.value(i);
                }
            }
        }
    }
}

TEST(DataJumps, ABallAndLayersAreRegions) {
    const Lattice cc = ccLattice({19, 18, 17});
    const auto ball = [](glm::dvec3 p) { return glm::length(p - glm::dvec3(9.2, 8.7, 8.1)) < 6.5; };
    const Field field = sampled<float>(cc, [&](glm::dvec3 p) { return ball(p) ? 40 + 0.2 * p.x : 3 - 0.1 * p.z; });
    const std::vector<std::uint8_t> found = regionsOf(field);
    const Field truth = sampled<std::uint8_t>(cc, [&](glm::dvec3 p) { return ball(p) ? 2 : 1; });
    for (std::size_t i = 0; i < cc.count(); ++i) ASSERT_EQ(found[i], truth.value(i));

    // Of three layers the first and the last meet nowhere.
    const auto layer = [](glm::dvec3 p) { return p.y < 6 ? 1 : p.y < 11 ? 2 : 3; };
    const std::vector<std::uint8_t> layers =
        regionsOf(sampled<float>(cc, [&](glm::dvec3 p) { return 10.0 * layer(p) + 0.3 * p.y; }));
    const Field numbers = sampled<std::uint8_t>(cc, [&](glm::dvec3 p) { return layer(p) == 2 ? 2 : 1; });
    for (std::size_t i = 0; i < cc.count(); ++i) ASSERT_EQ(layers[i], numbers.value(i));
}

TEST(DataJumps, AcrossAbsentSamplesAJumpIsOne) {
    const Lattice cc = ccLattice({8, 20, 8});
    const auto regions = [&](double above) {
        Field field = sampled<float>(cc, [&](glm::dvec3 p) { return 0.1 * p.y + (p.y > 10 ? above : 0); });
        test::removeWhere(field, [](glm::dvec3 p) { return p.y > 8 && p.y < 12; });
        return regionsOf(field);
    };
    const std::vector<std::uint8_t> jumps = regions(5);
    EXPECT_EQ(jumps[cc.index({3, 8, 3})], 1);
    EXPECT_EQ(jumps[cc.index({3, 10, 3})], 0);
    EXPECT_EQ(jumps[cc.index({3, 12, 3})], 2);
    EXPECT_EQ(mostOf(regions(0)), 1) << "it goes on beyond the gap";
}

TEST(DataJumps, SlopesNoiseAndSpecksAreNoRegions) {
    const Lattice cc = ccLattice({20, 16, 14});
    const auto most = [&](const auto& value) { return mostOf(regionsOf(sampled<float>(cc, value))); };
    for (const double width : {0.75, 1.0, 2.0, 5.0})
        for (const double place : {9.0, 9.3, 9.5})
            EXPECT_EQ(most([&](glm::dvec3 p) { return std::tanh((p.x + 0.3 * p.y - place) / width); }), 1) << width;
    EXPECT_EQ(most([](glm::dvec3 p) { return std::clamp(p.x - 9.5, -1.5, 1.5); }), 1) << "a slope of three cells";
    EXPECT_EQ(most([](glm::dvec3 p) { return p.x < 9.5 ? 2 * p.x : 19 + 0.1 * (p.x - 9.5); }), 1) << "a bend";
    EXPECT_EQ(most([](glm::dvec3) { return 4; }), 1);
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0, 1);
    EXPECT_EQ(most([&](glm::dvec3) { return noise(random); }), 1);
    EXPECT_EQ(most([](glm::dvec3 p) { return p == glm::dvec3(7, 7, 7) ? 50 : 0.1 * p.x; }), 1) << "one bad sample";
}

TEST(DataJumps, AJumpIsThatBeyondTheSlopeOnBothSides) {
    // Seen where it is more than three steps of the slope and a hundredth of the range.
    const auto most = [](double jump) {
        return mostOf(regionsOf(
            sampled<float>(ccLattice({6, 20, 6}), [&](glm::dvec3 p) { return p.y + (p.y > 9.5 ? jump : 0); })));
    };
    EXPECT_EQ(most(3), 1);
    EXPECT_EQ(most(3.5), 2);
    EXPECT_EQ(most(-3), 1);
    EXPECT_EQ(most(-3.5), 2);
}

TEST(DataJumps, ProgressRunsOverParametersAndTimes) {
    Dataset data = test::twoRegions(ccLattice({9, 8, 7}), test::constantIn, {.speed = 1}, 4);
    data.info.parameters.resize(1);
    data.info.parameters[0].parts = {};
    std::vector<double> fractions;
    std::vector<std::string> notes;
    Progress progress;
    progress.report = [&](double fraction, const std::string&) { fractions.push_back(fraction); };
    withJumps(std::move(data), {parsePartsRule("v=jumps")}, notes, progress);
    EXPECT_EQ(fractions, (std::vector<double>{0, 0.25, 0.5, 0.75}));
}

TEST(DataJumps, AnyComponentOfAVectorCounts) {
    const Lattice cc = ccLattice({12, 12, 12});
    const std::vector<Field> vector{sampled<float>(cc, [](glm::dvec3 p) { return p.x; }),
                                    sampled<float>(cc, [](glm::dvec3 p) { return p.z < 5 ? 1 : 7; }),
                                    sampled<float>(cc, [](glm::dvec3) { return 2; })};
    const std::vector<std::uint8_t> found = regionsOfJumps(vector);
    EXPECT_EQ(found[cc.index({4, 4, 4})], 1);
    EXPECT_EQ(found[cc.index({4, 4, 5})], 2);
}

TEST(DataJumps, RulesAreReadFromFilesAndRefused) {
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("tessera_data_jumps_" + std::to_string(getpid()) + ".raw");
    std::vector<float> values;
    for (int i = 0; i < 12 * 10 * 9; ++i) values.push_back(i / 12 % 10 < 5 ? 1 : 2);
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(values.data()), std::streamsize(values.size() * sizeof(float)));
    ImportOptions options;
    options.raw = "dims=12x10x9,type=float32";
    const std::string name = previewFiles({path.string()}, options).info.parameters.at(0).name;
    options.parts = {name + "=jumps"};
    const ImportPreview preview = previewFiles({path.string()}, options);
    EXPECT_EQ(preview.info.parameters.at(0).parts.count(), 2u);
    EXPECT_EQ(partsText(preview.info.parameters[0]), "2 parts by jumps of the data: 1 | 2");
    const Dataset data = openFiles({path.string()}, options);
    ASSERT_TRUE(data.read.inParts());
    const Field whole = data.read(1, 0, 0), part = data.read(1, 0, 0, {3, 2});
    EXPECT_EQ(part.samples, slicesOf(whole, 3, 2).samples);
    EXPECT_EQ(whole.value(0), 1);
    EXPECT_EQ(whole.value(12 * 5), 2);
    options.parameters = {name};
    EXPECT_EQ(previewFiles({path.string()}, options).info.parameters.size(), 2u) << "with the label of its parts";
    options.parameters.clear();
    options.parts = {"other=jumps"};
    EXPECT_THROW(previewFiles({path.string()}, options), Error);
    options.parts = {name + "=jumps", name + "=joined"};
    EXPECT_EQ(previewFiles({path.string()}, options).info.parameters.size(), 1u) << "the last rule counts";
    std::filesystem::remove(path);
}

} // namespace
} // namespace tessera::volume
