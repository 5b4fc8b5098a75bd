#include "tests/reference/samples.h"
#include "tests/vis/parts_scene.h"
#include "vis/raycast/ray_plan.h"
#include "volume/reconstruct/part_choice.h"

#include <gtest/gtest.h>
#include <random>

namespace tessera::vis {
namespace {

using volume::LatticeKind;

TEST(Parts, APlaceBelongsToThePartThatCoversItMost) {
    const auto chosen = [](std::vector<double> coverages) {
        volume::PartChoice choice;
        for (std::size_t i = 0; i < coverages.size(); ++i) choice.add(int(i), coverages[i]);
        return choice;
    };
    EXPECT_EQ(chosen({0.2, 0.7}).part, 1);
    EXPECT_EQ(chosen({0.5, 0.5}).part, 0) << "the lower one of equal ones";
    EXPECT_EQ(chosen({0.5 - 1e-6, 0.5 + 1e-6}).part, 0) << "whatever the rounding";
    EXPECT_EQ(chosen({0.1, 0.3, 0.2}).part, 1);
    EXPECT_NEAR(chosen({0.1, 0.3, 0.2}).total, 0.6, 1e-15);
    EXPECT_NEAR(chosen({0.1, 0.3, 0.2}).coverage, 0.3, 1e-15);
}

/// At random places of every lattice and filter, at and between times: a value that the region there holds.
TEST(Parts, TheReferenceReadsWhatOneRegionHolds) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> anywhere(0, 1);
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC})
        for (const Filter filter : {Filter::AverageQuasi, Filter::Average, Filter::Tetrahedral})
            for (const double weight : {0.0, 0.3}) {
                const RegionSeries source(kind, Regions::Sloped, true);
                const volume::TimePair time{0, 1, weight};
                const reference::Samples parts(source, 1, time, filter, {}),
                    mixed(source, 1, time, filter, {.mixedParts = true});
                int between = 0, lower = 0, upper = 0;
                for (int i = 0; i < 4000; ++i) {
                    const glm::dvec3 place(18 * anywhere(random), 16 * anywhere(random), 24 * anywhere(random));
                    const glm::dvec3 cells = source.grid().lattice.toCells(place);
                    const auto read = parts.read(cells);
                    ASSERT_TRUE(read.has_value());
                    // The linear functions reach 0.9..1.15 and 1.87..2.1; a filter may overshoot a little.
                    const bool low =
                        read->value > 0.85 && read->value<1.2, high = read->value> 1.8 && read->value < 2.15;
                    EXPECT_TRUE(read->part == 0 ? low : high) << read->value << " of part " << read->part;
                    lower += low;
                    upper += high;
                    const double other = *mixed.value(cells);
                    between += other > 1.3 && other < 1.7;
                }
                EXPECT_GT(between, 30) << "the data test nothing";
                EXPECT_GT(lower, 500);
                EXPECT_GT(upper, 500);
            }
}

TEST(Parts, EachHasAFieldOfItsOwnWhileThereIsRoom) {
    const auto source = regionSource(LatticeKind::BCC, Regions::Sloped, true);
    Scene scene = regionScene();
    scene.layers = {{"", true, VolumeLayer{.channel = "gas"}},
                    {"", true, SliceLayer{.channel = "smooth"}},
                    {"", true, IsoLayer{.channel = "heat"}}};
    const RayPlan plan = planRays(scene, source->info());
    ASSERT_EQ(plan.fields.size(), 5u);
    EXPECT_EQ(plan.channels, 3);
    EXPECT_EQ(plan.fields[0].parts, 2);
    EXPECT_EQ(plan.fields[0].more, 3);
    EXPECT_EQ(plan.fields[1].parts, 1);
    EXPECT_EQ(plan.fields[1].part, -1);
    EXPECT_EQ(plan.fields[2].more, 4);
    EXPECT_EQ(plan.fields[4].part, 1);
    EXPECT_EQ(plan.fields[4].channel, plan.fields[2].channel);
    EXPECT_TRUE(plan.limit.empty());

    const RayPlan tight = planRays(scene, source->info(), 4);
    EXPECT_EQ(tight.fields.size(), 4u);
    EXPECT_TRUE(tight.fields[2].nearest);
    EXPECT_EQ(tight.layers.size(), 1u) << "a surface between nearest samples would lie where none is";
    EXPECT_NE(tight.limit.find("heat"), std::string::npos) << tight.limit;
    const auto has = [&](const RayPlan& of, const char* value) {
        const ProgramRecipe recipe = rayRecipe(of, scene, source->grid(), false);
        return std::ranges::find(recipe.defines, std::pair<std::string, std::string>("PARTS", value)) !=
               recipe.defines.end();
    };
    EXPECT_TRUE(has(plan, "1"));
    scene.layers.resize(2);
    scene.layers.erase(scene.layers.begin());
    EXPECT_TRUE(has(planRays(scene, source->info()), "0")) << "channels of one part keep their program";
}

} // namespace
} // namespace tessera::vis
