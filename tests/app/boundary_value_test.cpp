#include "app/data/boundary_value.h"
#include "volume/sources/memory_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>

/// Values for a first picture, from fields whose boundaries are known.
namespace tessera::app {
namespace {

/// One parameter of whole numbers or of computed ones on a grid or its body-centred lattice, by a formula of x, y, z.
std::shared_ptr<const volume::BrickSource> field(volume::ScalarType type, Range range, auto value, bool bcc = false) {
    volume::Dataset data;
    volume::DatasetInfo& info = data.info;
    info.lattice.size = {40, 12, 12};
    info.lattice.spacing = glm::dvec3(1);
    info.lattice.kind = bcc ? volume::LatticeKind::BCC : volume::LatticeKind::CC;
    info.bounds = {glm::dvec3(0), glm::dvec3(39, 11, bcc ? 5.5 : 11)};
    volume::Parameter& parameter = info.parameters.emplace_back();
    parameter.name = "f";
    parameter.type = type;
    parameter.ranges = {range};
    data.read = volume::FrameReader([lattice = info.lattice, type, value](int, int, int) {
        volume::Field made = volume::makeField(lattice, type);
        std::size_t i = 0;
        for (int z = 0; z < lattice.size.z; ++z)
            for (int y = 0; y < lattice.size.y; ++y)
                for (int x = 0; x < lattice.size.x; ++x, ++i)
                    if (type == volume::ScalarType::F32)
                        made.as<float>()[i] = float(value(x, y, z));
                    else
                        made.as<std::uint8_t>()[i] = static_cast<std::uint8_t>(value(x, y, z));
        return made;
    });
    return volume::makeMemorySource(std::move(data), {});
}

/// Along x air at 20, a slow rise to a soft body at 100, a steep rise through 150 to a hard one at 200, and air again.
int materials(int x, int, int) {
    constexpr std::array<int, 40> values{20,  20,  20,  20,  30,  40,  50,  60,  70,  80,  90,  100, 100, 100,
                                         100, 100, 115, 150, 185, 200, 200, 200, 200, 200, 200, 185, 150, 115,
                                         100, 100, 90,  80,  70,  60,  50,  40,  30,  20,  20,  20};
    return values[std::size_t(x)];
}

TEST(BoundaryValue, IsThatOfTheSteepestBoundary) {
    for (const bool bcc : {false, true}) {
        const auto scan = field(volume::ScalarType::U8, {20, 200}, materials, bcc);
        ASSERT_TRUE(boundaryValue(*scan, 0, 0)) << bcc;
        EXPECT_NEAR(*boundaryValue(*scan, 0, 0), 150, 1) << bcc;
        EXPECT_EQ(surfaceValue(*scan, 0, 0), boundaryValue(*scan, 0, 0));
    }
}

TEST(BoundaryValue, NothingOfTheBackgroundCounts) {
    // Strong noise at 0 to 60 at every face of the box, a body of 160 with a weaker boundary through 110 inside.
    const auto scan = field(volume::ScalarType::U8, {0, 200}, [](int x, int y, int z) {
        const int depth = std::min({x, y, z, 39 - x, 11 - y, 11 - z});
        return depth < 2 ? 60 * ((x + y + z) / 2 % 2) : depth == 2 ? 85 : depth == 3 ? 110 : depth == 4 ? 135 : 160;
    });
    ASSERT_TRUE(backgroundShare(*scan, 0, 0));
    ASSERT_TRUE(boundaryValue(*scan, 0, 0));
    EXPECT_GT(*backgroundShare(*scan, 0, 0), 60.0 / 200) << "all of the noise is background";
    EXPECT_LT(*backgroundShare(*scan, 0, 0), 0.5);
    EXPECT_GT(*boundaryValue(*scan, 0, 0), 200 * *backgroundShare(*scan, 0, 0));
}

/// A soft body at 100 that all faces of the box cut, with a hard slab at 200 across it, blurred by a cell.
double inner(int x, int, int) {
    const int depth = std::min(x - 16, 23 - x);
    return depth < -1 ? 100 : depth < 0 ? 125 : depth < 1 ? 175 : 200;
}

TEST(BoundaryValue, MaterialsAreFoundInAnyTypeOfNumber) {
    for (const auto type : {volume::ScalarType::U8, volume::ScalarType::F32})
        for (const bool bcc : {false, true}) {
            const auto scan = field(type, {0, 200}, inner, bcc);
            ASSERT_FALSE(backgroundShare(*scan, 0, 0)) << "what is around fills half of the range";
            const auto found = materialsOf(*scan, 0, 0);
            ASSERT_TRUE(found) << int(type) << bcc;
            EXPECT_NEAR(found->below, 0.5, 0.02);
            EXPECT_NEAR(found->boundary, 0.75, 0.14);
        }
}

TEST(BoundaryValue, SmoothFieldsAndHidingOnesAreNoMaterials) {
    const auto rising = [](int x, int, int) { return 5 * x; };
    EXPECT_FALSE(materialsOf(*field(volume::ScalarType::F32, {0, 200}, rising), 0, 0));
    const auto wave = [](int x, int y, int z) { return 100 + 90 * std::sin(0.2 * x) * std::cos(0.3 * (y + z)); };
    EXPECT_FALSE(materialsOf(*field(volume::ScalarType::F32, {0, 200}, wave), 0, 0));
    const auto inverse = [](int x, int y, int z) { return 200 - inner(x, y, z); };
    EXPECT_FALSE(materialsOf(*field(volume::ScalarType::F32, {0, 200}, inverse), 0, 0)) << "the greatest are around";
    const auto flat = [](int, int, int) { return 5; };
    EXPECT_FALSE(materialsOf(*field(volume::ScalarType::F32, {0, 200}, flat), 0, 0));
}

/// Fibres of 170 along x in air of 57, with dark rims of 25 and noise, as of X-rays with phase contrast.
int fibres(int x, int y, int z) {
    const double away = std::hypot(y % 6 - 2.5, z % 6 - 2.5);
    const int noise = (x * 7 + y * 13 + z * 29) % 11 - 5;
    return noise + (away < 1.2 ? 170 : away < 2.2 ? 25 : 57);
}

TEST(BoundaryValue, RimsDoNotHideFibres) {
    const auto scan = field(volume::ScalarType::U8, {0, 255}, fibres);
    ASSERT_FALSE(backgroundShare(*scan, 0, 0)) << "fibres reach the faces";
    const auto found = classesOf(*scan, 0, 0);
    ASSERT_TRUE(found);
    EXPECT_GT(found->below * 255, 62) << "all of the air is below";
    EXPECT_LT(found->boundary * 255, 165);
    EXPECT_GE(found->boundary, found->below);
    const auto even = [](int x, int, int) { return 6 * x; };
    EXPECT_FALSE(classesOf(*field(volume::ScalarType::U8, {0, 255}, even), 0, 0)) << "no valley, no classes";
}

TEST(BoundaryValue, ScansOfMaterialsAreToldFromSmoothObjects) {
    const auto made = [](int x, int y, int z) {
        const int depth = std::min({x, y, z, 39 - x, 11 - y, 11 - z});
        return depth < 2 ? 5 : x < 20 ? 120 : 200;
    };
    EXPECT_TRUE(hasMaterials(*field(volume::ScalarType::U8, {0, 255}, made), 0, 0, 0.1));
    const auto noisy = [&](int x, int y, int z) { return made(x, y, z) + (x * 7 + y * 13 + z * 29) % 41 - 5; };
    EXPECT_TRUE(hasMaterials(*field(volume::ScalarType::U8, {0, 255}, noisy), 0, 0, 0.2)) << "a peak above a valley";
    const auto smooth = [](int x, int y, int z) {
        return 255 * std::exp(-std::hypot((x - 19.5) / 3.5, y - 5.5, z - 5.5) / 2);
    };
    EXPECT_FALSE(hasMaterials(*field(volume::ScalarType::U8, {0, 255}, smooth), 0, 0, 0.1));
}

TEST(BoundaryValue, ComputedFieldsHaveTheMiddleOfTheirUsualValues) {
    // One value in a hundred is 1000; the others run from 0 to 38.
    const auto computed = field(volume::ScalarType::F32, {0, 1000},
                                [](int x, int y, int z) { return x == 39 && y < 6 && z < 6 ? 1000 : std::min(x, 38); });
    ASSERT_TRUE(middleValue(*computed, 0, 0));
    EXPECT_NEAR(*middleValue(*computed, 0, 0), 19, 4) << "bins of 4";
    EXPECT_EQ(surfaceValue(*computed, 0, 0), middleValue(*computed, 0, 0));
    const auto flat = field(volume::ScalarType::F32, {0, 1}, [](int, int, int) { return 0.5; });
    EXPECT_FALSE(surfaceValue(*flat, 0, 0));
    EXPECT_FALSE(boundaryValue(*flat, 0, 0));
}

} // namespace
} // namespace tessera::app
