#include "volume/sources/time_axis.h"

#include "volume/base/error.h"
#include "volume/sources/memory_source.h"

#include <gtest/gtest.h>

namespace tessera::volume {
namespace {

/// A scalar 100 x + 10 z + t, absent at x = 0 from t = 3 on, at times 1, 2, 3 and 5; y is 2 thick, z 4.
std::shared_ptr<const BrickSource> moving(LatticeKind kind) {
    Dataset data;
    data.info.lattice.size = {5, 3, 9};
    data.info.lattice.spacing = {1, 1, 0.5};
    data.info.bounds = {glm::dvec3(0), glm::dvec3(4, 2, 4)};
    data.info.times = {1, 2, 3, 5};
    data.info.parameters.resize(1);
    data.info.parameters[0].name = "a";
    data.info.parameters[0].ranges = {{1, 445}};
    data.read = [lattice = data.info.lattice, times = data.info.times](int, int, int time) {
        Field field = makeField(lattice, ScalarType::F32);
        auto mask = std::make_shared<Mask>(field.count(), std::uint8_t(1));
        for (int z = 0; z < lattice.size.z; ++z)
            for (int y = 0; y < lattice.size.y; ++y)
                for (int x = 0; x < lattice.size.x; ++x) {
                    const std::size_t i = lattice.index({x, y, z});
                    const glm::dvec3 at = lattice.position({x, y, z});
                    field.as<float>()[i] = float(100 * at.x + 10 * at.z + times[std::size_t(time)]);
                    (*mask)[i] = x == 0 && time >= 2 ? 0 : 1;
                }
        field.mask = mask;
        return field;
    };
    return makeMemorySource(std::move(data), {.lattice = kind});
}

TEST(TimeAxis, APlaneAtAllTimesKeepsItsValuesAndItsShape) {
    const Dataset made = withTimeAlong(moving(LatticeKind::CC), {SpaceAxis::Z, 0.25}); // z = 1
    EXPECT_EQ(made.info.lattice.size, glm::ivec3(5, 3, 4));
    EXPECT_EQ(made.info.bounds.size(), glm::dvec3(4, 2, 4)) << "as before";
    EXPECT_EQ(made.info.times.size(), 1u);
    EXPECT_DOUBLE_EQ(timePerLength(made.info, {SpaceAxis::Z, 0.25}), 1) << "4 of time over 4 of length";
    EXPECT_DOUBLE_EQ(made.info.bounds.lo.z, 1) << "time 1";

    const Field values = made.read(0, 0, 0), clock = made.read(1, 0, 0);
    const double steps[] = {1, 1 + 4.0 / 3, 1 + 8.0 / 3, 5}; // even steps between the first and the last
    for (int k = 0; k < 4; ++k)
        for (int x = 0; x < 5; ++x) {
            const std::size_t i = made.info.lattice.index({x, 1, k});
            EXPECT_NEAR(clock.value(i), steps[k], 1e-6);
            if (x > 0) {
                ASSERT_TRUE(values.present(i));
                EXPECT_NEAR(values.value(i), 100 * x + 10 + steps[k], 1e-4);
            } else {
                EXPECT_EQ(values.present(i), k < 2) << k;
            }
        }
}

TEST(TimeAxis, AnyAxisAndLattice) {
    const auto source = moving(LatticeKind::BCC);
    for (const SpaceAxis axis : {SpaceAxis::X, SpaceAxis::Y, SpaceAxis::Z}) {
        const Dataset made = withTimeAlong(source, {axis, 0.5});
        const int a = int(axis);
        EXPECT_EQ(made.info.lattice.kind, LatticeKind::CC);
        EXPECT_EQ(made.info.lattice.size[a], 4);
        EXPECT_EQ(made.info.bounds.size(), source->info().bounds.size());
        const Field values = made.read(0, 0, 0);
        glm::ivec3 middle = made.info.lattice.size / 2;
        middle[a] = 0;
        glm::dvec3 at = made.info.lattice.position(middle);
        at[a] = source->info().bounds.center()[a];
        EXPECT_NEAR(values.value(made.info.lattice.index(middle)), 100 * at.x + 10 * at.z + 1, 3)
            << "resampled to BCC and back";
    }
}

TEST(TimeAxis, NeedsTimesAndAnExtent) {
    const auto source = moving(LatticeKind::CC);
    EXPECT_THROW(withTimeAlong(makeMemorySource(withTimeAlong(source, {}), {.lattice = LatticeKind::CC}), {}), Error);
    Dataset flat;
    flat.info.lattice.size = {4, 4, 1};
    flat.info.bounds = {glm::dvec3(0), glm::dvec3(3, 3, 0)};
    flat.info.times = {0, 1};
    flat.info.parameters.resize(1);
    flat.read = [lattice = flat.info.lattice](int, int, int) { return makeField(lattice, ScalarType::F32); };
    EXPECT_THROW(withTimeAlong(makeMemorySource(std::move(flat), {.lattice = LatticeKind::CC}), {}), Error);
}

} // namespace
} // namespace tessera::volume
