#include "volume/synthetic/fuel_cell.h"
#include "volume/synthetic/models.h"
#include "volume/synthetic/planted.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace tessera::volume {
namespace {

using namespace planted;

const std::map<std::string, double> kSettings{{"nx", 11}, {"ny", 13}, {"nz", 101}, {"times", 16}, {"even", 1}};

/// The model with and without the events.
struct Pair {
    Dataset with = makeModel("planted", kSettings), without = makeModel("fuel-cell", kSettings);
};
const Pair& models() {
    static const Pair pair;
    return pair;
}

int parameterOf(const std::string& name) {
    const auto& all = models().with.info.parameters;
    return int(std::find_if(all.begin(), all.end(), [&](const Parameter& p) { return p.name == name; }) - all.begin());
}

/// Calls visit(position, value with, value without) for the present samples of a parameter.
template <class Visit> int each(const std::string& name, int time, Visit visit) {
    const Field with = models().with.read(parameterOf(name), 0, time),
                without = models().without.read(parameterOf(name), 0, time);
    int count = 0;
    const glm::ivec3 size = with.lattice.size;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const std::size_t i = with.lattice.index({x, y, z});
                EXPECT_EQ(with.present(i), without.present(i));
                if (!with.present(i)) continue;
                visit(with.lattice.position({x, y, z}), with.value(i), without.value(i));
                ++count;
            }
    return count;
}

TEST(Planted, ABoxEndsAtEachOfItsFaces) {
    const Box box{{0, 10, -5}, {1, 12, -4}};
    EXPECT_TRUE(inside(box, {0.5, 11, -4.5}));
    EXPECT_TRUE(inside(box, {0, 12, -5})) << "corners belong to it";
    for (const glm::dvec3 out : {glm::dvec3(-0.1, 11, -4.5),
                                 {1.1, 11, -4.5},
                                 {0.5, 9.9, -4.5},
                                 {0.5, 12.1, -4.5},
                                 {0.5, 11, -5.1},
                                 {0.5, 11, -3.9}})
        EXPECT_FALSE(inside(box, out)) << out.x << " " << out.y << " " << out.z;
}

TEST(Planted, RangesAreThoseOfTheSamples) {
    const DatasetInfo& info = models().with.info;
    for (std::size_t p = 0; p < info.parameters.size(); ++p) {
        if (info.parameters[p].components > 1 || info.parameters[p].categorical) continue;
        double least = 1e30, most = -1e30;
        for (int time = 0; time < int(info.times.size()); ++time)
            each(info.parameters[p].name, time,
                 [&](glm::dvec3, double with, double) { least = std::min(least, with), most = std::max(most, with); });
        EXPECT_EQ(info.parameters[p].ranges.at(0).lo, least) << info.parameters[p].name;
        EXPECT_EQ(info.parameters[p].ranges.at(0).hi, most) << info.parameters[p].name;
    }
}

TEST(Planted, ProgressEndsWithTheRanges) {
    std::vector<double> fractions;
    Progress progress;
    progress.report = [&](double fraction, const std::string& what) {
        if (fraction < 0.9) fractions.clear();
        if (!what.empty()) fractions.push_back(fraction);
    };
    makePlanted({{"nx", 3}, {"ny", 5}, {"nz", 4}, {"times", 2}}, progress);
    ASSERT_GT(fractions.size(), 4u);
    for (std::size_t i = 1; i < fractions.size(); ++i) {
        EXPECT_GE(fractions[i], fractions[i - 1]) << i;
        EXPECT_LE(fractions[i], 1 + 1e-12) << i;
    }
    EXPECT_LT(fractions[1], 0.95) << "there is more than one to come";
}

TEST(Planted, TheRestIsTheFuelCell) {
    EXPECT_EQ(models().with.info.times, models().without.info.times);
    for (const char* name : {"U", "region"})
        EXPECT_EQ(models().with.read(parameterOf(name), 0, 3).samples,
                  models().without.read(parameterOf(name), 0, 3).samples);
}

TEST(Planted, WaterAndLittleOxygenIsTheFloodedBoxAlone) {
    // The task: much water and little oxygen. The starved corner has little oxygen too, but water as before.
    int flooded = 0, both = 0, starved = 0;
    each("H2O", 10, [&](glm::dvec3 at, double with, double without) {
        if (inside(kFlooded, at)) {
            EXPECT_FLOAT_EQ(float(with), float(kFloodedWater));
            ++flooded;
        } else {
            EXPECT_EQ(with, without);
        }
        both += with > 20;
    });
    EXPECT_GT(flooded, 100);
    EXPECT_EQ(both, flooded);
    double most = 0, least = 1e9;
    each("O2", 10, [&](glm::dvec3 at, double with, double without) {
        const double wanted = inside(kFlooded, at)   ? without * kFloodedOxygen
                              : inside(kStarved, at) ? kStarvedOxygen
                                                     : without;
        EXPECT_NEAR(with, wanted, 1e-6);
        if (inside(kStarved, at)) ++starved, most = std::max(most, with);
        if (!inside(kStarved, at) && !inside(kFlooded, at)) least = std::min(least, with);
    });
    EXPECT_GT(starved, 20);
    EXPECT_LT(most, least) << "no other place has as little oxygen as the starved corner";
}

TEST(Planted, TheHottestSampleIsTheHotSpot) {
    glm::dvec3 hottest{0};
    double most = 0, before = 0;
    each("T", 15, [&](glm::dvec3 at, double with, double without) {
        if (with > most) most = with, hottest = at;
        before = std::max(before, without);
    });
    const glm::dvec3 cell = models().with.info.lattice.spacing;
    for (int axis = 0; axis < 3; ++axis) EXPECT_LE(std::abs(hottest[axis] - kHotSpot[axis]), cell[axis]);
    EXPECT_GT(most, before + 8);
}

TEST(Planted, ThePulseBeginsAtItsOnsetAndMovesWithTheHydrogen) {
    const std::vector<double>& times = models().with.info.times;
    int onset = -1;
    std::vector<double> centers;
    for (int time = 0; time < int(times.size()); ++time) {
        double sum = 0, moment = 0;
        each("H2", time, [&](glm::dvec3 at, double with, double without) {
            sum += with - without;
            moment += (with - without) * at.z;
        });
        if (sum < 1) continue;
        if (onset < 0) onset = time;
        centers.push_back(moment / sum);
    }
    ASSERT_GE(onset, 0);
    EXPECT_NEAR(times[std::size_t(onset)], kPulseOnset, 1e-9);
    ASSERT_GE(centers.size(), 3u);
    const double interval = times[1] - times[0];
    EXPECT_NEAR((centers[2] - centers[1]) / interval, -kPulseSpeed, 0.05 * kPulseSpeed);
}

TEST(Planted, TheSlabStandsInAnotherUnit) {
    int within = 0;
    each("p", 0, [&](glm::dvec3 at, double with, double without) {
        const bool slab = at.z >= kSlabBegin && at.z <= kSlabEnd;
        EXPECT_NEAR(with, without * (slab ? kSlabFactor : 1), 1e-2);
        within += slab;
        EXPECT_EQ(slab, with < 1000);
    });
    EXPECT_GT(within, 0);
    const Range range = models().with.info.parameters[std::size_t(parameterOf("p"))].ranges[0];
    EXPECT_LT(range.lo, 110);
    EXPECT_GT(range.hi, 101000);
}

} // namespace
} // namespace tessera::volume
