#include "tests/volume/worth_fields.h"
#include "volume/sources/memory_source.h"
#include "volume/synthetic/models.h"
#include "volume/synthetic/planted.h"

#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>

/// Lists of what is worth seeing: the planted events lead them, and fields without structure have none.
namespace tessera::volume {
namespace {

using test::queryOf, test::smoothNoise;

std::string nameOf(const BrickSource& source, int channel) {
    return channel < 0 ? "" : source.info().channel(channel).name;
}

std::shared_ptr<const BrickSource> planted() {
    static const auto source = makeMemorySource(makeModel("planted", {}), {});
    return source;
}

bool meets(const Box& a, const Box& b) {
    for (int axis = 0; axis < 3; ++axis)
        if (a.lo[axis] > b.hi[axis] || a.hi[axis] < b.lo[axis]) return false;
    return true;
}

TEST(WorthSeeing, PlantedEventsLeadTheList) {
    const WorthFindings list = findWorthSeeing(*planted(), queryOf(*planted()));
    ASSERT_GE(list.found.size(), 5u);
    EXPECT_EQ(list.pictures.size(), list.found.size());
    bool slab = false, spot = false, flooded = false, starved = false;
    for (std::size_t i = 0; i < 5; ++i) {
        const Finding& each = list.found[i];
        const std::string name = nameOf(*planted(), each.x);
        EXPECT_TRUE(each.kind == FindingKind::Outliers || each.kind == FindingKind::Jump) << i << ' ' << name;
        EXPECT_LE(each.q, 0.05);
        if (name == "p") slab = each.box.lo.z > planted::kSlabBegin - 1e-3 && each.box.hi.z < planted::kSlabEnd + 1e-3;
        if (name == "T") {
            spot = true;
            EXPECT_NEAR(each.place.x, planted::kHotSpot.x, 0.21e-3);
            EXPECT_NEAR(each.place.y, planted::kHotSpot.y, 0.11e-3);
            EXPECT_NEAR(each.place.z, planted::kHotSpot.z, 0.41e-3);
        }
        if (name == "H2O") flooded = meets(each.box, planted::kFlooded) && std::abs(each.number - 22) < 1e-3;
        if (name == "O2" && each.number < 0.03) starved = meets(each.box, planted::kStarved);
    }
    EXPECT_TRUE(slab && spot && flooded && starved);
}

TEST(WorthSeeing, ThePulseBeginsWhenAndWhereItWasPlanted) {
    const WorthFindings list = findWorthSeeing(*planted(), queryOf(*planted(), WorthSearch::When));
    ASSERT_FALSE(list.found.empty());
    const Finding& first = list.found.front();
    const std::vector<double>& times = planted()->info().times;
    EXPECT_EQ(nameOf(*planted(), first.x), "H2");
    EXPECT_LT(times[std::size_t(first.first)], planted::kPulseOnset);
    EXPECT_NEAR(times[std::size_t(first.first) + 1], planted::kPulseOnset, 0.0301);
    EXPECT_NEAR(first.place.z, planted::kPulseStart, 1.5e-3);
    ASSERT_GE(list.found.size(), 2u);
    for (std::size_t i = 1; i < list.found.size(); ++i) // the load step, of all others
        EXPECT_NEAR(times[std::size_t(list.found[i].first) + 1], 0.18, 0.031) << nameOf(*planted(), list.found[i].x);
}

TEST(WorthSeeing, OxygenAndWaterOfTheCellHangTogetherInItsCathode) {
    const auto source = makeMemorySource(makeModel("fuel-cell", {}), {});
    const WorthFindings list = findWorthSeeing(*source, queryOf(*source));
    bool found = false;
    for (const Finding& each : list.found)
        if (each.kind == FindingKind::Dependence && nameOf(*source, each.x) == "O2" && nameOf(*source, each.y) == "H2O")
            found = each.region.has_value() && each.number < -0.98 && each.effective < 0.01 * each.samples;
    EXPECT_TRUE(found);
}

/// Of this many data sets of independent fields the share with any finding is what the rate allows, with the slack of
/// so few.
void expectFewFindings(double sigma, int seeds, int most) {
    int views = 0, box = 0, values = 0;
    for (int seed = 0; seed < seeds; ++seed) {
        std::vector<Field> fields;
        for (int p = 0; p < 4; ++p) fields.push_back(smoothNoise({18, 16, 20}, sigma, unsigned(seed * 100 + p + 1)));
        const auto source = makeMemorySource(test::datasetOf(std::move(fields)), {.brickSize = 16});
        views += findWorthSeeing(*source, queryOf(*source)).found.empty() ? 0 : 1;
        WorthQuery query = queryOf(*source, WorthSearch::WhatElse);
        query.doi = [](std::span<const float>, glm::dvec3 at) { return at.x > 4 && at.x < 11 && at.z < 8 ? 1.0 : 0.0; };
        box += findWorthSeeing(*source, query).found.empty() ? 0 : 1;
        query.doiChannels = {0};
        query.doi = [](std::span<const float> at, glm::dvec3) { return at[0] > 1 ? 1.0 : 0.0; };
        values += findWorthSeeing(*source, query).found.empty() ? 0 : 1;
    }
    std::printf("sigma %.0f: of %d data sets %d, %d and %d have findings\n", sigma, seeds, views, box, values);
    EXPECT_LE(views, most);
    EXPECT_LE(box, most);
    EXPECT_LE(values, most);
}

TEST(WorthSeeing, NoiseHasNoFindings) {
    expectFewFindings(0, 12, 1);
}

TEST(WorthSeeing, SmoothIndependentFieldsHaveFewFindings) {
    // More than 3 of 24 have a chance of 0.01 % at a rate of 1 %, of 3 % at one of 5 %.
    expectFewFindings(2, 24, 3);
    expectFewFindings(4, 24, 3);
}

TEST(WorthSeeing, NothingHappensInIndependentTimes) {
    int found = 0;
    for (int seed = 0; seed < 10; ++seed) {
        std::vector<Field> fields;
        for (int i = 0; i < 12; ++i) fields.push_back(smoothNoise({14, 12, 10}, 2, unsigned(seed * 50 + i + 1)));
        const auto source = makeMemorySource(test::datasetOf(std::move(fields), 6), {.brickSize = 16});
        found += findWorthSeeing(*source, queryOf(*source, WorthSearch::When)).found.empty() ? 0 : 1;
    }
    EXPECT_LE(found, 2);
}

TEST(WorthSeeing, AStepInTimeIsFound) {
    std::vector<Field> fields;
    for (int t = 0; t < 6; ++t) {
        fields.push_back(smoothNoise({14, 12, 10}, 0, unsigned(t + 1)));
        for (float& value : fields.back().as<float>()) value = 0.05f * value + (t >= 4 ? 3.0f : 0.0f);
    }
    const auto source = makeMemorySource(test::datasetOf(std::move(fields), 6), {.brickSize = 16});
    const WorthFindings list = findWorthSeeing(*source, queryOf(*source, WorthSearch::When));
    ASSERT_EQ(list.found.size(), 1u);
    EXPECT_EQ(list.found[0].time, 4);
    EXPECT_EQ(list.found[0].first, 3);
    EXPECT_EQ(list.found[0].last, 4);
    EXPECT_NEAR(list.found[0].number, 3, 0.2) << "mean of the block that changes most";
}

TEST(WorthSeeing, WhatHasNothingToCompareSaysSo) {
    std::vector<Field> fields{smoothNoise({10, 10, 10}, 1, 1)};
    const auto one = makeMemorySource(test::datasetOf(std::move(fields)), {});
    EXPECT_TRUE(findWorthSeeing(*one, queryOf(*one)).found.empty()) << "one parameter";
    EXPECT_EQ(findWorthSeeing(*one, queryOf(*one)).missing, "");
    EXPECT_NE(findWorthSeeing(*one, queryOf(*one, WorthSearch::When)).missing, "") << "one time";
    EXPECT_EQ(findWorthSeeing(*one, queryOf(*one, WorthSearch::WhatElse)).missing, "nothing is selected");
    const auto constant = [](glm::dvec3) { return 353.15; };
    std::vector<Field> alike;
    for (int i = 0; i < 6; ++i) alike.push_back(test::sampled<float>(test::ccLattice({12, 12, 12}), constant));
    const auto still = makeMemorySource(test::datasetOf(std::move(alike), 3), {});
    EXPECT_TRUE(findWorthSeeing(*still, queryOf(*still)).found.empty());
    EXPECT_TRUE(findWorthSeeing(*still, queryOf(*still, WorthSearch::When)).found.empty());
}

TEST(WorthSeeing, AbsentSamplesTakeNoPart) {
    // Outliers that are absent are none; those present are found, in the corner where they are.
    for (const bool absent : {true, false}) {
        Field field = smoothNoise({16, 16, 16}, 0, 3);
        for (int i = 0; i < 8; ++i) field.as<float>()[field.lattice.index({i % 2, i / 2 % 2, i / 4})] = 60;
        if (absent) test::removeWhere(field, [](glm::dvec3 at) { return at.x < 1.5 && at.y < 1.5 && at.z < 1.5; });
        std::vector<Field> fields{field};
        const auto source = makeMemorySource(test::datasetOf(std::move(fields)), {});
        const WorthFindings list = findWorthSeeing(*source, queryOf(*source));
        EXPECT_EQ(list.found.size(), absent ? 0u : 1u);
        if (!absent && !list.found.empty()) {
            EXPECT_EQ(list.found[0].samples, 8);
            EXPECT_EQ(list.found[0].box, (Box{{0, 0, 0}, {1, 1, 1}}));
            EXPECT_EQ(list.found[0].values.lo, 60);
        }
    }
}

TEST(WorthSeeing, ARelationOfOneRegionSaysWhere) {
    Field a = smoothNoise({24, 16, 16}, 0, 1), b = smoothNoise({24, 16, 16}, 0, 2);
    Field label = test::sampled<std::uint8_t>(a.lattice, [](glm::dvec3 at) { return at.x < 8 ? 1 : 2; });
    for (std::size_t i = 0; i < a.count(); ++i)
        if (label.as<std::uint8_t>()[i] == 1) b.as<float>()[i] = 0.1f * b.as<float>()[i] - a.as<float>()[i];
    std::vector<Field> fields{a, b, label};
    Dataset data = test::datasetOf(std::move(fields));
    data.info.parameters[2].categorical = true;
    const auto source = makeMemorySource(std::move(data), {.brickSize = 8});
    const WorthFindings list = findWorthSeeing(*source, queryOf(*source));
    ASSERT_EQ(list.found.size(), 1u);
    EXPECT_EQ(list.found[0].kind, FindingKind::Contrast);
    EXPECT_EQ(list.found[0].region, 1);
    EXPECT_LT(list.found[0].number, -0.98);
    EXPECT_NEAR(list.found[0].other, 0, 0.1);
    EXPECT_NEAR(list.found[0].effective, list.found[0].samples, 0.3 * list.found[0].samples) << "noise: all count";
}

TEST(WorthSeeing, BccSamplesHaveTheFindingsOfTheGridTheyComeFrom) {
    std::vector<Field> fields{smoothNoise({20, 20, 20}, 1, 1)};
    Field square = fields[0];
    for (float& value : square.as<float>()) value = value * value;
    fields.push_back(square);
    const Dataset data = test::datasetOf(std::move(fields));
    std::vector<Finding> found;
    for (const LatticeKind lattice : {LatticeKind::CC, LatticeKind::BCC}) {
        const auto source = makeMemorySource(data, {.lattice = lattice});
        const WorthFindings list = findWorthSeeing(*source, queryOf(*source));
        ASSERT_EQ(list.found.size(), 1u);
        EXPECT_EQ(list.found[0].kind, FindingKind::Nonlinear) << "y = x^2";
        EXPECT_LT(std::abs(list.found[0].other), 0.3) << "r";
        EXPECT_GT(list.found[0].number, 0.45) << "distance correlation";
        const double read = double(readWorthSamples(*source, {.channels = {0}}).count());
        EXPECT_EQ(list.samples, read) << "of the even sublattice alone";
        found.push_back(list.found[0]);
    }
    EXPECT_NEAR(found[0].number, found[1].number, 0.12);
}

TEST(WorthSeeing, AMagnitudeHasTheFindingsOfItsNumbers) {
    const Field a = smoothNoise({20, 20, 20}, 1, 1);
    Field size = a, none = a;
    for (float& value : size.as<float>()) value = std::abs(value);
    for (float& value : none.as<float>()) value = 0;
    std::vector<Field> fields{a, size};
    const auto scalar = makeMemorySource(test::datasetOf(fields), {});
    Dataset data = test::datasetOf(std::move(fields));
    data.info.parameters[1].components = 3;
    data.info.parameters[1].ranges.assign(4, Range{-6, 6});
    data.read = [a, none](int parameter, int component, int) { return parameter == 0 || component == 1 ? a : none; };
    const auto vector = makeMemorySource(std::move(data), {});
    const WorthFindings of = findWorthSeeing(*scalar, queryOf(*scalar)),
                        same = findWorthSeeing(*vector, queryOf(*vector));
    ASSERT_FALSE(of.found.empty());
    EXPECT_EQ(of.found[0].kind, FindingKind::Nonlinear) << "y = |x|";
    ASSERT_EQ(of.found.size(), same.found.size());
    EXPECT_EQ(nameOf(*vector, same.found[0].y), "|p1|");
    for (std::size_t i = 0; i < of.found.size(); ++i) {
        EXPECT_EQ(of.found[i].kind, same.found[i].kind);
        EXPECT_NEAR(of.found[i].number, same.found[i].number, 1e-3);
    }
}

TEST(WorthSeeing, ASelectionTellsWhatElseIsDifferentInIt) {
    std::vector<Field> fields;
    for (unsigned p = 0; p < 3; ++p) fields.push_back(smoothNoise({20, 20, 20}, 0, p + 1));
    for (std::size_t i = 0; i < fields[0].count(); ++i)
        fields[1].as<float>()[i] += fields[0].as<float>()[i] > 1 ? 0.7f : 0.0f;
    const auto source = makeMemorySource(test::datasetOf(std::move(fields)), {});
    WorthQuery query = queryOf(*source, WorthSearch::WhatElse);
    query.doiChannels = {0};
    query.doi = [](std::span<const float> at, glm::dvec3) { return at[0] > 1 ? 1.0 : 0.0; };
    const WorthFindings list = findWorthSeeing(*source, query);
    ASSERT_EQ(list.found.size(), 1u) << "not the parameter that is brushed, nor the third";
    EXPECT_EQ(list.found[0].x, 1);
    EXPECT_NEAR(list.found[0].number - list.found[0].other, 0.7, 0.1);
}

} // namespace
} // namespace tessera::volume
