#include "tests/vis/gl_fixture.h"
#include "vis/optics/ray_setup.h"
#include "vis/shapes/flow_geometry.h"
#include "volume/sources/memory_source.h"

#include <cmath>

namespace tessera::vis {
namespace {

class FlowLayerTest : public test::GlTest {
protected:
    static constexpr glm::ivec2 kSize{96, 96};
    static constexpr int kSamples = 17;

    /// U = (1, 0, 0) and f = x / 16 in a cube of edge 16; nothing where x > wall.
    static std::shared_ptr<const volume::BrickSource> wind(float wall = 100) {
        volume::Dataset data;
        data.info.lattice.size = glm::ivec3(kSamples);
        data.info.bounds = {glm::dvec3(0), glm::dvec3(kSamples - 1)};
        data.info.parameters.resize(2);
        data.info.parameters[0].name = "U";
        data.info.parameters[0].components = 3;
        data.info.parameters[0].ranges = {{1, 1}, {0, 0}, {0, 0}, {1, 1}};
        data.info.parameters[1].name = "f";
        data.info.parameters[1].ranges = {{0, 1}};
        data.read = [lattice = data.info.lattice, wall](int parameter, int component, int) {
            volume::Field field = volume::makeField(lattice, volume::ScalarType::F32);
            auto mask = std::make_shared<volume::Mask>(field.count(), std::uint8_t(1));
            for (std::size_t i = 0; i < field.count(); ++i) {
                const float x = float(i % kSamples);
                field.as<float>()[i] = parameter == 1 ? x / 16 : component == 0 ? 1.0f : 0.0f;
                (*mask)[i] = x <= wall;
            }
            field.mask = mask;
            return field;
        };
        return volume::makeMemorySource(std::move(data), {});
    }
    std::vector<glm::vec4> picture(const std::shared_ptr<const volume::BrickSource>& source, const FlowLayer& layer) {
        Renderer renderer;
        renderer.setSource(source);
        Scene scene;
        scene.camera = test::frontCamera(1.2);
        scene.showBox = false;
        scene.lighting.ambient = 1;
        scene.lighting.diffuse = scene.lighting.specular = 0;
        scene.layers.push_back({"", true, layer}); // draws nothing by itself
        scene.geometry.push_back(
            {.geometry = makeFlow(*source, layer, 0, scene.stretch), .style = layer.style, .channel = layer.channel});
        const ViewTargetPtr target = renderer.makeTarget();
        test::renderAll(renderer, *target, scene, kSize);
        return renderer.readLinear(*target);
    }
    /// The pixel over a place, x and y in 0..1 through the data.
    static glm::vec4 over(const std::vector<glm::vec4>& pixels, double x, double y) {
        const auto at = [](double share) { return int(((share - 0.5) / 1.2 + 0.5) * 96); };
        return pixels[std::size_t(at(y)) * 96 + std::size_t(at(x))];
    }
    static FlowLayer oneLine(FlowKind kind) {
        FlowLayer layer{.vector = "U", .channel = "f"};
        layer.kind = kind;
        layer.seeds = volume::SeedShape::Line;
        layer.from = layer.to = glm::vec3(0.5f);
        layer.count = 1;
        layer.radius = 0.05f;
        layer.style.lineWidth = 9;
        layer.size = 0.4f;
        return layer;
    }
};

TEST_F(FlowLayerTest, DrawsEveryKindInTheColoursOfItsParameter) {
    const auto source = wind();
    const auto expectColor = [](glm::vec4 pixel, double value) {
        const glm::dvec3 wanted = linearFromSrgb(glm::dvec3(evaluate(TransferFunction{}, {0, 1}, value)));
        EXPECT_LT(glm::length(glm::dvec3(pixel) - wanted), 0.03) << value;
    };
    for (const FlowKind kind : {FlowKind::Streamlines, FlowKind::Tubes}) {
        const auto pixels = picture(source, oneLine(kind));
        for (const double x : {0.1, 0.3, 0.5, 0.7, 0.9}) expectColor(over(pixels, x, 0.5), x);
        EXPECT_EQ(over(pixels, 0.5, 0.7).a, 0);
    }
    for (const FlowKind kind : {FlowKind::Hedgehogs, FlowKind::Arrows, FlowKind::Cones}) {
        const auto pixels = picture(source, oneLine(kind));
        expectColor(over(pixels, 0.55, 0.5), 0.5); // of the place where it begins
        EXPECT_EQ(over(pixels, 0.2, 0.5).a, 0);
        EXPECT_EQ(over(pixels, 0.95, 0.5).a, 0);
    }
}

TEST_F(FlowLayerTest, EndsAtAWall) {
    const auto pixels = picture(wind(10), oneLine(FlowKind::Tubes));
    EXPECT_GT(over(pixels, 0.62, 0.5).a, 0.9f);
    EXPECT_EQ(over(pixels, 0.68, 0.5).a, 0);
}

TEST_F(FlowLayerTest, SeedsFollowTheWeight) {
    FlowLayer layer{.vector = "U", .channel = "f"};
    layer.kind = FlowKind::Hedgehogs;
    layer.count = 500;
    layer.weight = "f";
    const auto geometry = makeFlow(*wind(), layer, 0, glm::dvec3(1));
    ASSERT_EQ(geometry->lines.ends.size(), 500u);
    double mean = 0;
    for (std::size_t i = 0; i < 1000; i += 2) mean += double(geometry->lines.positions[i].x) / 16 / 500;
    EXPECT_NEAR(mean, 2.0 / 3, 0.03);
}

TEST_F(FlowLayerTest, NothingWithoutTheVector) {
    EXPECT_EQ(makeFlow(*wind(), {.vector = "f", .channel = "f"}, 0, glm::dvec3(1)), nullptr);
}

/// Beginnings at random lie where the degree of interest is high, as dense as it is; those of a line leave out the
/// rest.
TEST_F(FlowLayerTest, SeedsLieWhereIsBrushed) {
    const auto source = wind();
    FlowLayer layer{.vector = "U", .channel = "f"};
    layer.count = 4000;
    layer.seedBrushed = true;
    Selection selection;
    selection.brushes = {rangeBrush({{"f", 0.75, 1, 0.5}})}; // interest rises along x from 0 at 4 to 1 at 12
    const DoiFunction interest(selection);
    const std::vector<glm::dvec3> seeds = flowSeeds(*source, layer, 0, glm::dvec3(1), {}, &interest);
    ASSERT_EQ(seeds.size(), 4000u);
    int high = 0, rising = 0, low = 0;
    for (const glm::dvec3& seed : seeds) {
        high += seed.x >= 12;
        rising += seed.x >= 4 && seed.x < 12;
        low += seed.x < 4;
    }
    EXPECT_EQ(low, 0);
    EXPECT_NEAR(double(high) / rising, 1, 0.1) << "4 of full interest, 8 of half";
    // Without brushes, and with a layer that does not ask for it, they lie everywhere.
    for (const bool follows : {true, false}) {
        layer.seedBrushed = follows;
        const DoiFunction everything{Selection{}};
        int below = 0;
        for (const glm::dvec3& seed :
             flowSeeds(*source, layer, 0, glm::dvec3(1), {}, follows ? &everything : &interest))
            below += seed.x < 4;
        EXPECT_NEAR(below, 1000, 120);
    }
    layer.seedBrushed = true;
    layer.seeds = volume::SeedShape::Line;
    layer.count = 17;
    for (const glm::dvec3& seed : flowSeeds(*source, layer, 0, glm::dvec3(1), {}, &interest)) EXPECT_GT(seed.x, 4);
}

TEST_F(FlowLayerTest, TubesAndGlyphsAreThinnerWhereNothingIsBrushed) {
    const auto source = wind();
    Selection selection;
    selection.brushes = {rangeBrush({{"f", 0.75, 1, 0.5}})}; // interest rises along x from 0 at 4 to 1 at 12
    const DoiFunction interest(selection);
    FlowLayer layer{.vector = "U", .channel = "f", .kind = FlowKind::Hedgehogs};
    layer.count = 200;
    layer.scaled = false;
    layer.contextWidth = 0.25f;
    const auto shorter = makeFlow(*source, layer, 0, glm::dvec3(1), {}, &interest);
    ASSERT_EQ(shorter->lines.ends.size(), 200u);
    double longest = 0, shortest = 1e9;
    for (std::size_t i = 0; i < 400; i += 2) {
        const double x = double(shorter->lines.positions[i].x) + shorter->lines.origin.x;
        const double length = double(glm::distance(shorter->lines.positions[i], shorter->lines.positions[i + 1]));
        longest = std::max(longest, length), shortest = std::min(shortest, length);
        const double doi = std::clamp((x - 4) / 8, 0.0, 1.0);
        EXPECT_NEAR(length, double(layer.size) * 16 * (0.25 + 0.75 * doi), 0.03) << x;
    }
    EXPECT_GT(longest, 3 * shortest);
    layer.kind = FlowKind::Tubes;
    const auto tubes = makeFlow(*source, layer, 0, glm::dvec3(1), {}, &interest);
    layer.contextWidth = 1;
    const auto even = makeFlow(*source, layer, 0, glm::dvec3(1), {}, &interest);
    EXPECT_NE(tubes->mesh.positions, even->mesh.positions);
    EXPECT_EQ(even->mesh.positions, makeFlow(*source, layer, 0, glm::dvec3(1))->mesh.positions);
}

} // namespace
} // namespace tessera::vis
