#include "volume/sources/source_difference.h"

#include "tests/volume/fields.h"
#include "volume/sources/memory_source.h"

#include <cmath>
#include <gtest/gtest.h>

namespace tessera::volume {
namespace {

std::shared_ptr<const BrickSource> sourceOf(int brickSize, LatticeKind kind, float changed, bool holed) {
    Field field = test::sampled<float>(test::ccLattice({21, 17, 19}), [](glm::dvec3 p) { return p.x + 2 * p.y - p.z; });
    field.as<float>()[field.lattice.index({3, 4, 5})] += changed;
    field.as<float>()[field.lattice.index({20, 16, 18})] -= 2 * changed;
    if (holed) test::removeWhere(field, [](glm::dvec3 p) { return p == glm::dvec3(1, 1, 1); });
    std::vector<Field> fields;
    fields.push_back(field);
    MemorySourceOptions options;
    options.lattice = kind;
    options.brickSize = brickSize;
    return makeMemorySource(test::datasetOf(std::move(fields)), options);
}

TEST(SourceDifference, CountsTheSamplesThatDiffer) {
    const auto plain = sourceOf(8, LatticeKind::CC, 0, false);
    for (const int brickSize : {8, 16}) { // read by bricks, and as a whole
        const auto same = sourceDifference({*plain}, {*sourceOf(brickSize, LatticeKind::CC, 0, false)});
        ASSERT_TRUE(same);
        EXPECT_EQ(*same, (SourceDifference{21 * 17 * 19, 0, 0, 0}));
        const auto other = sourceDifference({*plain}, {*sourceOf(brickSize, LatticeKind::CC, 0.5f, false)});
        EXPECT_EQ(other->differing, 2u);
        EXPECT_EQ(other->largest, 1);
        EXPECT_NEAR(other->rms, std::sqrt((0.25 + 1) / (21 * 17 * 19)), 1e-12);
        const auto holed = sourceDifference({*plain}, {*sourceOf(brickSize, LatticeKind::CC, 0, true)});
        EXPECT_EQ(holed->differing, 1u) << "present in one alone";
        EXPECT_EQ(holed->samples, std::size_t(21 * 17 * 19 - 1));
        EXPECT_EQ(holed->largest, 0);
    }
    EXPECT_FALSE(sourceDifference({*plain}, {*sourceOf(8, LatticeKind::BCC, 0, false)})) << "other lattices";
}

// Integers that 32-bit floats do not hold.
TEST(SourceDifference, CountsUnitsOfLargeIntegers) {
    const auto integers = [](int more) {
        Field field = makeField(test::ccLattice({9, 8, 7}), ScalarType::I32);
        for (std::size_t i = 0; i < field.count(); ++i) field.as<std::int32_t>()[i] = 2000000000 + int(i % 5);
        field.as<std::int32_t>()[17] += more;
        std::vector<Field> fields;
        fields.push_back(std::move(field));
        return makeMemorySource(test::datasetOf(std::move(fields)), {.brickSize = 8});
    };
    const auto same = sourceDifference({*integers(0)}, {*integers(0)}),
               one = sourceDifference({*integers(0)}, {*integers(1)});
    EXPECT_EQ(same->differing, 0u);
    EXPECT_EQ(one->differing, 1u);
    EXPECT_EQ(one->largest, 1);
}

} // namespace
} // namespace tessera::volume
