#include "app/data/boundary_value.h"
#include "app/data/first_view.h"
#include "app/session/session.h"
#include "volume/sources/memory_source.h"

#include <cmath>
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

TEST(FirstView, SurroundingsOfScansAreClear) {
    const auto source = bodies();
    const Session session = shown(*source, {"air", "rest"});
    const auto& opacity = session.transfer.at("air").opacity;
    ASSERT_EQ(opacity.size(), 3u);
    // 10 of 0..200 is the value around it; up to a quarter of the way from there to the body's 200 nothing is seen.
    EXPECT_EQ(opacity[0], glm::vec2(0));
    EXPECT_EQ(opacity[1].y, 0);
    EXPECT_GT(opacity[1].x, 10.0f / 200);
    EXPECT_NEAR(opacity[1].x, 0.25f + 0.75f * float(*backgroundShare(*source, 0, 0)), 0.01f);
    EXPECT_EQ(opacity[2], glm::vec2(1, 0.8f));
    // The surroundings of the other one are its greatest values, which are not made clear.
    EXPECT_EQ(vis::curveAt(session.transfer.at("rest").opacity, 1), double(0.8f));
    EXPECT_EQ(shown(*source, {"rest", "air"}).transfer, session.transfer) << "every volume, in any order";
}

/// One computed parameter "f" with a unit on the same cube, values by formula.
std::shared_ptr<const volume::BrickSource> computed(const std::string& unit, Range range, auto value) {
    volume::Dataset data;
    volume::DatasetInfo& info = data.info;
    info.lattice.size = glm::ivec3(kSide);
    info.lattice.spacing = glm::dvec3(1);
    info.bounds = {glm::dvec3(0), glm::dvec3(kSide - 1)};
    volume::Parameter& parameter = info.parameters.emplace_back();
    parameter.name = "f";
    parameter.unit = unit;
    parameter.ranges = {range};
    data.read = volume::FrameReader([lattice = info.lattice, value](int, int, int) {
        volume::Field field = volume::makeField(lattice, volume::ScalarType::F32);
        std::size_t i = 0;
        for (int z = 0; z < kSide; ++z)
            for (int y = 0; y < kSide; ++y)
                for (int x = 0; x < kSide; ++x, ++i) field.as<float>()[i] = float(value(x, y, z));
        return field;
    });
    return volume::makeMemorySource(std::move(data), {});
}

TEST(FirstView, AComputedFieldShowsWhatIsRareInWhatIsCommon) {
    // 40 nearly everywhere, up to 94 on one side: seen as a block by a straight curve.
    const auto source = computed("", {1, 94}, [](int x, int, int z) { return z == 0 ? 50 + 4 * x : z == 1 ? 1 : 40; });
    const Session session = shown(*source, {"f"});
    const auto& function = session.transfer.at("f");
    const double common = vis::curveAt(function.opacity, (40.0 - 1) / 93);
    EXPECT_GT(common, 0) << "nothing vanishes";
    EXPECT_GT(std::pow(1 - common, 1 / vis::kReferenceLength), 0.2) << "nor hides what is behind it";
    EXPECT_GT(vis::curveAt(function.opacity, 1), 15 * common);
    EXPECT_EQ(function.colormap, defaultSession(source->info(), {}).transfer.at("f").colormap);
}

TEST(FirstView, OneValueEverywhereIsTranslucent) {
    const auto opacity = shown(*computed("", {7, 7}, [](int, int, int) { return 7; }), {"f"}).transfer.at("f").opacity;
    EXPECT_GT(vis::curveAt(opacity, 0.5), 0);
    EXPECT_LT(vis::curveAt(opacity, 0.5), 0.05);
}

TEST(FirstView, WhatIsMadeOfMaterialsShowsTheUpperOne) {
    // 40 beside 90, as numbers with fractions: a float scan of which the box shows a part.
    const auto value = [](int x, int, int) { return x < 6 ? 40.25 : x < 7 ? 65.5 : 90.75; };
    const auto source = computed("", {1, 94}, value);
    const auto opacity = shown(*source, {"f"}).transfer.at("f").opacity;
    ASSERT_EQ(opacity.size(), 3u);
    EXPECT_EQ(vis::curveAt(opacity, (40.25 - 1) / 93), 0);
    EXPECT_GT(vis::curveAt(opacity, (90.75 - 1) / 93), 0.5);
}

TEST(FirstView, ValuesOfBothSignsHaveDivergingColoursAboutZero) {
    const auto value = [](int x, int, int) { return x - 4; }; // -4 to 7
    const auto function = shown(*computed("m", {-4, 7}, value), {"f"}).transfer.at("f");
    EXPECT_EQ(function.colormap, vis::divergingFunction().colormap);
    EXPECT_TRUE(function.aboutZero);
    EXPECT_LT(vis::curveAt(function.opacity, 0.5), 0.5 * vis::curveAt(function.opacity, 0.25));
    EXPECT_LT(vis::curveAt(function.opacity, 0.5), 0.5 * vis::curveAt(function.opacity, 1));
    // The sign of a temperature in degrees has no meaning.
    EXPECT_FALSE(shown(*computed("degC", {-4, 7}, value), {"f"}).transfer.at("f").aboutZero);
}

TEST(FirstView, AnOpacityThatSomebodyMadeStays) {
    const auto source = bodies();
    Session session = defaultSession(source->info(), {});
    session.layers = {{"air", true, vis::VolumeLayer{.channel = "air"}}};
    session.transfer["air"].opacity = {{0, 1}, {1, 1}};
    const auto before = session.transfer;
    aimFirstView(session, *source, 1.5);
    EXPECT_EQ(session.transfer, before);
    // Colours alone say nothing of opacity, and stay.
    const auto field = computed("m", {-4, 7}, [](int x, int, int) { return x - 4; });
    session = defaultSession(field->info(), {});
    session.transfer["f"].colormap = "magma";
    aimFirstView(session, *field, 1.5);
    EXPECT_EQ(session.transfer["f"].colormap, "magma");
    EXPECT_NE(session.transfer["f"].opacity, defaultSession(field->info(), {}).transfer["f"].opacity);
}

/// Two parameters at two times on the cube: "all" everywhere, "some" where `present` says so.
std::shared_ptr<const volume::BrickSource> partly(bool (*present)(int x, int y, int z)) {
    volume::Dataset data;
    volume::DatasetInfo& info = data.info;
    info.lattice.size = glm::ivec3(kSide);
    info.lattice.spacing = glm::dvec3(1);
    info.bounds = {glm::dvec3(0), glm::dvec3(kSide - 1)};
    info.times = {0, 1};
    for (const char* name : {"all", "some"}) {
        volume::Parameter& parameter = info.parameters.emplace_back();
        parameter.name = name;
        parameter.ranges = {{0, 1}};
    }
    data.read = [lattice = info.lattice, present](int parameter, int, int) {
        volume::Field field = volume::makeField(lattice, volume::ScalarType::F32);
        auto mask = std::make_shared<volume::Mask>(field.count(), std::uint8_t(1));
        std::size_t i = 0;
        for (int z = 0; z < kSide; ++z)
            for (int y = 0; y < kSide; ++y)
                for (int x = 0; x < kSide; ++x, ++i) {
                    field.as<float>()[i] = float(x) / kSide;
                    if (parameter == 1 && !present(x, y, z)) (*mask)[i] = 0;
                }
        field.mask = mask;
        return field;
    };
    return volume::makeMemorySource(std::move(data), {});
}

TEST(FirstView, TheCursorIsWhereTheFirstLayerHasAValue) {
    const auto aimed = [](const volume::BrickSource& source, glm::dvec3 from) {
        Session session = defaultSession(source.info(), {});
        session.layers = {{"some", true, vis::VolumeLayer{.channel = "some"}}};
        session.cursor = from;
        aimFirstView(session, source, 1.5);
        return session.cursor;
    };
    // A tube, whose middle is empty: the cursor is in its wall, half way up.
    const auto tube = partly([](int x, int y, int z) { return z > 6 && std::hypot(x - 5.5, y - 5.5) > 3; });
    const glm::dvec3 inWall = aimed(*tube, glm::dvec3(5.5));
    EXPECT_EQ(inWall.z, 9);
    EXPECT_GT(std::hypot(inWall.x - 5.5, inWall.y - 5.5), 3);
    EXPECT_LT(std::hypot(inWall.x - 5.5, inWall.y - 5.5), 4);
    const glm::dvec3 there(1, 1, 9);
    EXPECT_EQ(aimed(*tube, there), there) << "it stays where there is a value";
    // Close to a sample by itself nothing can be interpolated.
    const auto lonely = partly([](int x, int y, int z) { return (x == 3 && y == 3 && z == 3) || z > 8; });
    EXPECT_GE(aimed(*lonely, glm::dvec3(3.45)).z, 9);
}

/// A field that is 0 at its first time, and then rises from 0 to 1 along x, or stays.
std::shared_ptr<const volume::BrickSource> rising(bool rises) {
    volume::Dataset data;
    volume::DatasetInfo& info = data.info;
    info.lattice.size = glm::ivec3(kSide);
    info.lattice.spacing = glm::dvec3(1);
    info.bounds = {glm::dvec3(0), glm::dvec3(kSide - 1)};
    info.times = {0, 1, 2};
    volume::Parameter& parameter = info.parameters.emplace_back();
    parameter.name = "T";
    parameter.type = volume::ScalarType::F32;
    parameter.ranges = {{0, 1}};
    data.read = [lattice = info.lattice, rises](int, int, int time) {
        volume::Field field = volume::makeField(lattice, volume::ScalarType::F32);
        for (std::size_t i = 0; i < field.count(); ++i)
            field.as<float>()[i] = rises && time == 2 ? float(i % kSide) / float(kSide - 1) : 0.0f;
        return field;
    };
    return volume::makeMemorySource(std::move(data), {});
}

/// Of three parameters "same" has one value everywhere, but another at each time; "few" and "many" vary at the last
/// one.
std::shared_ptr<const volume::BrickSource> laterOn(bool vectors = false) {
    volume::Dataset data;
    volume::DatasetInfo& info = data.info;
    info.lattice.size = glm::ivec3(kSide);
    info.lattice.spacing = glm::dvec3(1);
    info.bounds = {glm::dvec3(0), glm::dvec3(kSide - 1)};
    info.times = {0, 1, 2};
    for (const char* name : {"same", "few", "many"}) {
        volume::Parameter& parameter = info.parameters.emplace_back();
        parameter.name = name;
        parameter.type = volume::ScalarType::F32;
        parameter.components = vectors ? 3 : 1;
        parameter.ranges.assign(vectors ? 4 : 1, {0, 2});
    }
    data.read = [lattice = info.lattice](int parameter, int, int time) {
        volume::Field field = volume::makeField(lattice, volume::ScalarType::F32);
        for (std::size_t i = 0; i < field.count(); ++i)
            field.as<float>()[i] = parameter == 0 ? float(time) : time < 2 ? 0.0f : float(i % kSide) * 2 / (kSide - 1);
        return field;
    };
    return volume::makeMemorySource(std::move(data), {});
}

TEST(FirstView, DataOpenWithWhatVariesWhereItVaries) {
    const auto source = laterOn();
    Session session = defaultSession(source->info(), {});
    ASSERT_EQ(vis::shownChannel(session.layers.at(0).technique), "same");
    std::vector<std::string> messages;
    showWhatVaries(session, *source, messages);
    for (const vis::Layer& layer : session.layers) {
        EXPECT_EQ(vis::shownChannel(layer.technique), "few");
        EXPECT_TRUE(layer.name.starts_with("few")) << layer.name;
    }
    EXPECT_EQ(session.time, 2);
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_NE(messages[0].find("few varies more at "), std::string::npos) << messages[0];
    // Data that would have to be waited for open as they are.
    session = defaultSession(source->info(), {});
    session.data.files.resize(1);
    session.data.files[0].absolutePath = "https://host/a.tsr";
    showWhatVaries(session, *source, messages);
    EXPECT_EQ(vis::shownChannel(session.layers.at(0).technique), "same");
    EXPECT_EQ(session.time, 0);
}

TEST(FirstView, AVectorAloneOpensWithItsFlowInAFaintVolume) {
    const auto source = laterOn(true);
    Session session = defaultSession(source->info(), {});
    ASSERT_EQ(session.layers.size(), 3u);
    EXPECT_EQ(vis::shownChannel(session.layers[0].technique), "|same|");
    const auto& flow = std::get<vis::FlowLayer>(session.layers[1].technique);
    EXPECT_TRUE(session.layers[1].visible);
    EXPECT_EQ(flow.vector, "same");
    EXPECT_EQ(flow.weight, "|same|") << "seeds lie where it flows";
    aimFirstView(session, *source, 1);
    EXPECT_LE(std::get<vis::VolumeLayer>(session.layers[0].technique).density, 0.1f);
    // A curve that somebody made is meant as it is.
    session = defaultSession(source->info(), {});
    session.transfer.at("|same|").opacity = {{0, 0.1f}, {1, 0.1f}};
    aimFirstView(session, *source, 1);
    EXPECT_EQ(std::get<vis::VolumeLayer>(session.layers[0].technique).density, 1);
}

TEST(FirstView, ALayoutThatShowsNothingAtTheFirstTimeShowsTheLast) {
    for (const bool rises : {true, false})
        for (const bool opaque : {true, false}) {
            const auto source = rising(rises);
            Session session = defaultSession(source->info(), {});
            session.layers = {{"T", true, vis::VolumeLayer{.channel = "T"}}};
            session.transfer["T"].opacity = {{0.0f, opaque ? 0.5f : 0.0f}, {0.5f, 0.0f}, {1.0f, 0.8f}};
            std::vector<std::string> messages;
            showLastIfEmpty(session, *source, messages);
            EXPECT_EQ(session.time, rises && !opaque ? 2 : 0) << rises << opaque;
            EXPECT_EQ(messages.size(), rises && !opaque ? 1u : 0u);
        }
}

// Smoke that has been released until the first time is nowhere yet.
TEST(FirstView, ALayoutOfParticlesShowsTheLastTime) {
    using enum vis::FlowKind;
    const auto source = laterOn(true);
    const double first = source->info().times.front(), last = source->info().times.back();
    ASSERT_LT(first, last);
    const auto timeFor = [&](vis::FlowKind kind, bool together, double asked, bool visible = true,
                             const std::string& vector = "same") {
        Session session = defaultSession(source->info(), {});
        session.time = asked;
        vis::FlowLayer flow{.vector = vector, .channel = "|same|"};
        flow.kind = kind;
        flow.together = together;
        session.layers = {{"flow", visible, flow}};
        std::vector<std::string> messages;
        showLastIfEmpty(session, *source, messages);
        EXPECT_EQ(messages.size(), session.time == asked ? 0u : 1u);
        return session.time;
    };
    for (const vis::FlowKind kind : {Streaklines, Timelines, Speedlines}) {
        EXPECT_EQ(timeFor(kind, false, first), last) << int(kind);
        EXPECT_EQ(timeFor(kind, false, 0.5 * (first + last)), 0.5 * (first + last)) << "of the layout";
        EXPECT_EQ(timeFor(kind, false, first, false), first) << "hidden";
        EXPECT_EQ(timeFor(kind, false, first, true, ""), first) << "nothing moves particles";
    }
    EXPECT_EQ(timeFor(Timelines, true, first), first) << "drawn where they are later";
    for (const vis::FlowKind kind : {Tubes, Pathlines}) EXPECT_EQ(timeFor(kind, false, first), first) << int(kind);
}

TEST(FirstView, ALayerThatIsNewOrShowsAnotherParameterSuitsIt) {
    const auto source = bodies();
    const int air = *source->info().findChannel("air");
    Session session = defaultSession(source->info(), {});
    const Session before = session;
    vis::Layer volume{"", true, vis::VolumeLayer{.channel = "air"}};
    vis::Layer surface{"", true, vis::IsoLayer{.channel = "air", .value = 100}};
    aimLayer(session, *source, volume);
    aimLayer(session, *source, surface);
    EXPECT_NE(session.transfer.at("air"), before.transfer.at("air"));
    EXPECT_EQ(session.transfer.at("rest"), before.transfer.at("rest"));
    EXPECT_EQ(std::get<vis::IsoLayer>(surface.technique).value, float(*surfaceValue(*source, air, 0)));
    EXPECT_NE(std::get<vis::IsoLayer>(surface.technique).value, 100);
    // A curve that somebody made stays, as does everything where the data would have to be waited for.
    session = before;
    session.transfer.at("air").opacity = {{0.0f, 0.5f}, {1.0f, 0.5f}};
    const auto made = session.transfer;
    aimLayer(session, *source, volume);
    EXPECT_EQ(session.transfer, made);
    session = before;
    session.data.files.resize(1);
    session.data.files[0].absolutePath = "https://host/a.tsr";
    std::get<vis::IsoLayer>(surface.technique).value = 150;
    aimLayer(session, *source, volume);
    aimLayer(session, *source, surface);
    EXPECT_EQ(session.transfer, before.transfer);
    EXPECT_EQ(std::get<vis::IsoLayer>(surface.technique).value, 150);
    std::get<vis::IsoLayer>(surface.technique).value = 1500;
    aimLayer(session, *source, surface);
    EXPECT_EQ(std::get<vis::IsoLayer>(surface.technique).value, 100) << "outside of the range there is no surface";
}

} // namespace
} // namespace tessera::app
