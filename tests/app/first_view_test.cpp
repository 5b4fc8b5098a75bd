#include "app/data/first_view.h"
#include "app/session/session.h"
#include "volume/sources/memory_source.h"

#include <gtest/gtest.h>

/// What a data file is first shown as.
namespace tessera::app {
namespace {

constexpr int kSide = 12;

/// Two parameters of whole numbers on a cube of 12 samples a side: "air" is 10 around a body of 200, "rest" is 200
/// around a body of 10.
std::shared_ptr<const volume::BrickSource> bodies() {
    volume::Dataset data;
    volume::DatasetInfo& info = data.info;
    info.lattice.size = glm::ivec3(kSide);
    info.lattice.spacing = glm::dvec3(1);
    info.bounds = {glm::dvec3(0), glm::dvec3(kSide - 1)};
    for (const char* name : {"air", "rest"}) {
        volume::Parameter& parameter = info.parameters.emplace_back();
        parameter.name = name;
        parameter.type = volume::ScalarType::U8;
        parameter.ranges = {{0, 200}};
    }
    data.read = [lattice = info.lattice](int parameter, int, int) {
        volume::Field field = volume::makeField(lattice, volume::ScalarType::U8);
        std::size_t i = 0;
        for (int z = 0; z < kSide; ++z)
            for (int y = 0; y < kSide; ++y)
                for (int x = 0; x < kSide; ++x, ++i) {
                    const bool body = std::min({x, y, z}) > 2 && std::max({x, y, z}) < 9;
                    field.as<std::uint8_t>()[i] = body == (parameter == 0) ? 200 : 10;
                }
        return field;
    };
    return volume::makeMemorySource(std::move(data), {});
}

Session shown(const volume::BrickSource& source, const std::vector<std::string>& layers) {
    Session session = defaultSession(source.info(), {});
    session.layers.clear();
    for (const std::string& channel : layers)
        session.layers.push_back({channel, true, vis::VolumeLayer{.channel = channel}});
    aimFirstView(session, source, 1.5);
    return session;
}

TEST(FirstView, TheFirstLayersSurroundingsAreClear) {
    const auto source = bodies();
    const Session untouched = defaultSession(source->info(), {});
    const Session session = shown(*source, {"air", "rest"});
    const auto& opacity = session.transfer.at("air").opacity;
    ASSERT_EQ(opacity.size(), 3u);
    // 10 of 0..200 is the value around it; up to somewhat above that nothing is seen, and the body is.
    EXPECT_EQ(opacity[0], glm::vec2(0));
    EXPECT_EQ(opacity[1].y, 0);
    EXPECT_GT(opacity[1].x, 10.0f / 200);
    EXPECT_LT(opacity[1].x, 0.25f);
    EXPECT_EQ(opacity[2], glm::vec2(1, 0.8f));
    EXPECT_EQ(session.transfer.at("rest").opacity, untouched.transfer.at("rest").opacity);
    // The surroundings of the other one are its greatest values, which are not made clear.
    EXPECT_EQ(shown(*source, {"rest", "air"}).transfer, untouched.transfer);
}

TEST(FirstView, AnOpacityThatSomebodyMadeStays) {
    const auto source = bodies();
    Session session = defaultSession(source->info(), {});
    session.layers = {{"air", true, vis::VolumeLayer{.channel = "air"}}};
    session.transfer["air"].opacity = {{0, 1}, {1, 1}};
    const auto before = session.transfer;
    aimFirstView(session, *source, 1.5);
    EXPECT_EQ(session.transfer, before);
}

} // namespace
} // namespace tessera::app
