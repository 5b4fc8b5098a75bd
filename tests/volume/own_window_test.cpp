#include "volume/resample/resample.h"
#include "volume/resample/slice_filter.h"

#include "tests/volume/fields.h"

#include <gtest/gtest.h>
#include <random>

namespace tessera::volume {
namespace {

using test::ccLattice;

/// Whether a sample is of the corner's part and joined to it by steps along the axes, each towards it, inside of the
/// window around a cell.
bool isJoined(const Lattice& lattice, const Mask& mask, glm::ivec3 cell, glm::ivec3 corner, glm::ivec3 at) {
    for (int axis = 0; axis < 3; ++axis)
        if (at[axis] < std::max(cell[axis] - OwnWindow::kReach, 0) ||
            at[axis] >= std::min(cell[axis] + OwnWindow::kReach + 2, lattice.size[axis]))
            return false;
    if (mask[lattice.index(at)] != mask[lattice.index(corner)]) return false;
    if (at == corner) return true;
    for (int axis = 0; axis < 3; ++axis) {
        if (at[axis] == corner[axis]) continue;
        glm::ivec3 nearer = at;
        nearer[axis] += at[axis] < corner[axis] ? 1 : -1;
        if (isJoined(lattice, mask, cell, corner, nearer)) return true;
    }
    return false;
}

TEST(OwnWindow, HasWhatStepsTowardsTheCornerReach) {
    std::mt19937 random(3);
    int joined = 0, apart = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const glm::ivec3 size(1 + int(random() % 12), 1 + int(random() % 12), 1 + int(random() % 12));
        const Lattice lattice = ccLattice(size);
        Mask mask(lattice.count());
        const unsigned common = 2 + unsigned(random() % 6); // of so many numbers one stands for half of the samples
        for (std::uint8_t& number : mask)
            number = random() % 3 != 0 ? std::uint8_t(1) : static_cast<std::uint8_t>(random() % common);
        const auto within = [&](int count) { return int(random() % unsigned(count)); };
        const glm::ivec3 cell(within(size.x), within(size.y), within(size.z));
        const glm::ivec3 corner = glm::min(cell + glm::ivec3(within(2), within(2), within(2)), size - 1);
        const OwnWindow window(lattice, mask, cell, corner);
        for (int z = -2; z < size.z + 2; ++z)
            for (int y = -2; y < size.y + 2; ++y)
                for (int x = -2; x < size.x + 2; ++x) {
                    const bool wanted = isJoined(lattice, mask, cell, corner, {x, y, z});
                    ASSERT_EQ(window.has({x, y, z}), wanted) << trial << ": " << x << " " << y << " " << z;
                    (wanted ? joined : apart) += 1;
                }
    }
    EXPECT_GT(joined, 1000);
    EXPECT_GT(apart, 1000);
}

TEST(ResampleOnto, OnePartIsResampledAsIfThereWereNone) {
    const Lattice target = ccLattice({9, 8, 7});
    Field source = makeField(bccFor(target), ScalarType::F32);
    std::mt19937 random(5);
    for (float& sample : source.as<float>()) sample = float(random() % 1000) / 7;
    const Field plain = resample(source, target, ResampleOptions{});
    source.mask = std::make_shared<const Mask>(source.count(), std::uint8_t(2));
    const Field onto = resampleOnto(source, target, std::make_shared<const Mask>(target.count(), std::uint8_t(2)));
    EXPECT_EQ(plain.samples, onto.samples);
}

} // namespace
} // namespace tessera::volume
