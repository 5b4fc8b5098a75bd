#pragma once

#include "codec/archive/archive.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>

/// What came back of an archive beside what went in.
namespace tessera::codec::testing {

/// Same type, samples and mask, bit for bit, absent samples too.
inline void expectSame(const volume::Field& a, const volume::Field& b, bool absentToo) {
    ASSERT_EQ(a.type, b.type);
    ASSERT_EQ(a.lattice.size, b.lattice.size);
    EXPECT_EQ(a.offset, b.offset);
    EXPECT_EQ(a.scale, b.scale);
    const std::size_t bytes = volume::byteSize(a.type);
    for (std::size_t i = 0; i < a.count(); ++i) {
        ASSERT_EQ(a.present(i), b.present(i)) << "sample " << i;
        if (!absentToo && !a.present(i)) continue;
        ASSERT_EQ(std::memcmp(&a.samples[i * bytes], &b.samples[i * bytes], bytes), 0) << "sample " << i;
    }
}

/// Largest |difference| of an archive from its data, over present finite samples of all components and times.
inline double largestError(const Archive& archive, const volume::Dataset& made, int parameter) {
    double largest = 0;
    for (int c = 0; c < made.info.parameters[std::size_t(parameter)].components; ++c)
        for (int t = 0; t < int(made.info.times.size()); ++t) {
            const volume::Field stored = readField(archive, parameter, c, t), wanted = made.read(parameter, c, t);
            for (std::size_t i = 0; i < wanted.count(); ++i) {
                if (!wanted.present(i)) continue;
                EXPECT_TRUE(stored.present(i));
                if (!std::isfinite(wanted.value(i))) continue;
                largest = std::max(largest, std::abs(stored.value(i) - wanted.value(i)));
            }
        }
    return largest;
}

/// The same samples in every brick at every level, and the same said of them. `levels`: only so many, from the finest.
inline void expectSameArchives(const Archive& a, const Archive& b, int levels = 99) {
    volume::DatasetInfo info = a.info();
    EXPECT_EQ(info, b.info());
    ASSERT_EQ(a.grid(), b.grid());
    const glm::ivec3 count = a.grid().count();
    for (int channel = 0; channel < int(info.channels().size()); ++channel)
        for (int time = 0; time < int(info.times.size()); ++time)
            for (int level = 0; level < std::min(levels, a.grid().levels); ++level)
                for (int n = 0; n < count.x * count.y * count.z; ++n) {
                    const volume::BrickKey key{
                        channel, time, level, {n % count.x, n / count.x % count.y, n / (count.x * count.y)}};
                    const volume::BrickSamples left = a.read(key), right = b.read(key);
                    ASSERT_EQ(left.present, right.present);
                    for (std::size_t i = 0; i < left.values.size(); ++i)
                        if (left.isPresent(i)) {
                            ASSERT_EQ(left.values[i], right.values[i]);
                        }
                }
}

} // namespace tessera::codec::testing
