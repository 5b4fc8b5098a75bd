#include "volume/sources/originals.h"

#include "volume/base/error.h"
#include "volume/sources/memory_source.h"

#include <cmath>
#include <gtest/gtest.h>

namespace tessera::volume {
namespace {

/// A scalar f(x, y, z) = x + 100 y + 10000 z in storage indices, plus `offset`, and a vector of it.
std::shared_ptr<const BrickSource> counted(LatticeKind kind, float offset, double times = 1) {
    Dataset data;
    data.info.lattice.size = {21, 18, 19};
    data.info.bounds = {glm::dvec3(0), glm::dvec3(20, 17, 18)};
    data.info.times.assign(std::size_t(times), 0);
    for (std::size_t i = 0; i < data.info.times.size(); ++i) data.info.times[i] = double(i);
    data.info.parameters.resize(2);
    data.info.parameters[0].name = "a";
    data.info.parameters[1].name = "v";
    data.info.parameters[1].components = 3;
    data.read = [lattice = data.info.lattice, offset](int, int component, int) {
        Field field = makeField(lattice, ScalarType::F32);
        for (std::size_t i = 0; i < field.count(); ++i)
            field.as<float>()[i] = std::sin(0.1f * float(i)) + float(component) + offset;
        return field;
    };
    return makeMemorySource(std::move(data), {.lattice = kind, .brickSize = 16});
}

/// A source whose levels are every 2^l-th sample.
class Thin final : public BrickSource {
public:
    explicit Thin(std::shared_ptr<const BrickSource> fine) : fine_(std::move(fine)), grid_(fine_->grid()) {
        grid_.phase = 0;
        grid_.levels = 4;
    }
    const DatasetInfo& info() const override { return fine_->info(); }
    const BrickGrid& grid() const override { return grid_; }
    BrickStats stats(const BrickKey& key) const override { return fine_->stats(key); }
    BrickSamples read(const BrickKey& key) const override {
        const BrickSamples whole = fine_->read({key.channel, key.time, 0, key.index});
        BrickSamples out{.size = grid_.brickSamples(key.index, key.level), .values = {}, .present = {}};
        const int pair = grid_.lattice.kind == LatticeKind::BCC ? 2 : 1;
        for (int z = 0; z < out.size.z; ++z)
            for (int y = 0; y < out.size.y; ++y)
                for (int x = 0; x < out.size.x; ++x) {
                    const int scale = 1 << key.level, slice = z / pair * scale * pair + z % pair;
                    out.values.push_back(
                        whole.values[std::size_t((slice * whole.size.y + y * scale) * whole.size.x + x * scale)]);
                }
        return out;
    }

private:
    std::shared_ptr<const BrickSource> fine_;
    BrickGrid grid_;
};

TEST(Originals, DifferByWhatWasDoneAtEveryLevel) {
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
        const auto changed = std::make_shared<Thin>(counted(kind, 0.5f));
        const auto both = withOriginals(changed, counted(kind, 0));
        const auto a = both->info().findChannel("a"), before = both->info().findChannel("a as computed"),
                   v = both->info().findChannel("v.z"), vBefore = both->info().findChannel("v as computed.z");
        ASSERT_TRUE(a && before && v && vBefore);
        const glm::ivec3 last = both->grid().count() - 1;
        for (int level = 0; level < 4; ++level)
            for (const auto& [now, then] : {std::pair{*a, *before}, std::pair{*v, *vBefore}}) {
                const BrickSamples x = both->read({now, 0, level, last}), y = both->read({then, 0, level, last});
                ASSERT_EQ(x.size, y.size);
                ASSERT_EQ(x.values.size(), y.values.size());
                for (std::size_t i = 0; i < x.values.size(); ++i) ASSERT_NEAR(x.values[i] - y.values[i], 0.5f, 1e-6);
            }
        EXPECT_NEAR(both->stats({*a, 0, 0, {}}).max - both->stats({*before, 0, 0, {}}).max, 0.5f, 1e-6);
    }
}

TEST(Originals, MeansOfMeans) {
    const auto both = withOriginals(counted(LatticeKind::CC, 0.5f), counted(LatticeKind::CC, 0));
    const int before = both->info().findChannel("a as computed").value();
    const BrickSamples x = both->read({0, 0, 1, {}}), y = both->read({before, 0, 1, {}});
    ASSERT_EQ(x.values.size(), y.values.size());
    for (std::size_t i = 0; i < x.values.size(); ++i) ASSERT_NEAR(x.values[i] - y.values[i], 0.5f, 1e-6);
}

TEST(Originals, NeedTheSamePlacesAndTimes) {
    EXPECT_THROW(withOriginals(counted(LatticeKind::CC, 0), counted(LatticeKind::BCC, 0)), Error);
    EXPECT_THROW(withOriginals(counted(LatticeKind::CC, 0), counted(LatticeKind::CC, 0, 2)), Error);
}

} // namespace
} // namespace tessera::volume
