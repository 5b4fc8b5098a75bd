#include "volume/analysis/extremes.h"

#include "tests/volume/cell_data.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <optional>

namespace tessera::volume {
namespace {

using test::cellData;
using test::cellSource;
using test::forAll;

TEST(Extremes, AgreeWithBruteForce) {
    const Lattice cc = test::ccLattice({19, 11, 9}, {0.5, 0.25, 2}, {1, -2, 3});
    for (const Lattice& lattice : {cc, bccFor(cc)}) {
        const Dataset data = cellData(lattice, test::boxOf(cc));
        const auto source = cellSource(data);
        const Field o2 = data.read(test::kO2, 0, 0), label = data.read(test::kRegion, 0, 0),
                    rho = data.read(test::kRho, 0, 0);
        for (const bool greatest : {true, false})
            for (const bool inRegion : {false, true})
                for (const bool brushed : {false, true}) {
                    ExtremeQuery query{.channel = 0, .greatest = greatest, .times = {0}};
                    if (inRegion) query.label = 1, query.region = 3;
                    if (brushed) {
                        query.doiChannels = {2};
                        query.doi = [](std::span<const float> values, glm::dvec3 at) {
                            return values[0] > 1.5f && at.y > -1 ? 0.5 : 0.49;
                        };
                    }
                    std::optional<double> best;
                    glm::dvec3 where(0);
                    forAll(lattice, [&](glm::ivec3 at, std::size_t i) {
                        if (!o2.present(i)) return;
                        if (inRegion && !(label.present(i) && label.value(i) == 3)) return;
                        if (brushed && !(float(rho.value(i)) > 1.5f && lattice.position(at).y > -1)) return;
                        const double v = double(float(o2.value(i)));
                        if (best && (greatest ? v <= *best : v >= *best)) return;
                        best = v;
                        where = lattice.position(at);
                    });
                    const auto found = findExtreme(*source, query);
                    ASSERT_TRUE(found && best);
                    EXPECT_EQ(found->value, *best);
                    EXPECT_LT(glm::distance(found->position, where), 1e-9);
                    EXPECT_EQ(found->time, 0);
                }
    }
}

TEST(Extremes, OfNothingThereIsNone) {
    const Lattice cc = test::ccLattice({9, 9, 9});
    const auto source = cellSource(cellData(cc, test::boxOf(cc)));
    EXPECT_FALSE(findExtreme(*source, {.channel = 0, .times = {0}, .label = 1, .region = 8}));
    ExtremeQuery none{.channel = 0, .times = {0}};
    none.doi = [](std::span<const float>, glm::dvec3) { return 0.0; };
    EXPECT_FALSE(findExtreme(*source, none));
    EXPECT_FALSE(findExtreme(*source, {.channel = 0, .times = {}}));
}

} // namespace
} // namespace tessera::volume
