#include "tests/vis/gl_fixture.h"
#include "vis/glyphs/glyph_parts.h"
#include "vis/glyphs/glyph_shapes.h"
#include "vis/glyphs/make_glyphs.h"
#include "vis/image/image_metrics.h"
#include "vis/optics/ray_setup.h"
#include "volume/reconstruct/probe.h"
#include "volume/sources/memory_source.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace tessera::vis {
namespace {

constexpr int kEdge = 17;
constexpr glm::ivec2 kPictureSize{120, 120};

/// a = x / 16, b = y / 16 but absent where x > 10, U = (0, 1, 0), in a cube of edge 16.
std::shared_ptr<const volume::BrickSource> slopes() {
    volume::Dataset data;
    data.info.lattice.size = glm::ivec3(kEdge);
    data.info.bounds = {glm::dvec3(0), glm::dvec3(kEdge - 1)};
    data.info.parameters.resize(3);
    data.info.parameters[0].name = "a";
    data.info.parameters[1].name = "b";
    data.info.parameters[2].name = "U";
    data.info.parameters[0].ranges = data.info.parameters[1].ranges = {{0, 1}};
    data.info.parameters[2].components = 3;
    data.info.parameters[2].ranges = {{0, 0}, {0, 1}, {0, 0}, {0, 1}};
    data.read = [lattice = data.info.lattice](int parameter, int component, int) {
        volume::Field field = volume::makeField(lattice, volume::ScalarType::F32);
        auto mask = std::make_shared<volume::Mask>(field.count(), std::uint8_t(1));
        for (std::size_t i = 0; i < field.count(); ++i) {
            const auto x = float(i % kEdge), y = float(i / kEdge % kEdge);
            field.as<float>()[i] = parameter == 0 ? x / 16 : parameter == 1 ? y / 16 : component == 1 ? 1.0f : 0.0f;
            (*mask)[i] = parameter != 1 || x <= 10;
        }
        field.mask = mask;
        return field;
    };
    return volume::makeMemorySource(std::move(data), {});
}

GlyphLayer twoSpokes() {
    GlyphLayer layer{.channel = "a"};
    layer.parts = {{"spoke 1", "a", {0, 0}}, {"spoke 2", "b", {0, 0}}};
    layer.from = {0, 0, 0.5};
    layer.to = {1, 1, 0.5};
    return layer;
}

TEST(GlyphSamplesTest, ValuesAreThoseOfTheDataAtThePlaces) {
    const auto source = slopes();
    for (const bool even : {true, false}) {
        GlyphLayer layer = twoSpokes();
        layer.even = even;
        const GlyphSamples samples = sampleGlyphs(*source, layer, {});
        ASSERT_GT(samples.stands.size(), 100u);
        int absent = 0;
        for (std::size_t i = 0; i < samples.stands.size(); ++i) {
            const glm::dvec3 at = samples.stands[i].place;
            EXPECT_NEAR(samples.values[0][i], at.x / 16, 1e-6);
            const auto b = volume::probeChannel(*source, 1, at, 0).interpolated;
            absent += !b;
            if (b)
                EXPECT_NEAR(samples.values[1][i], at.y / 16, 1e-6);
            else
                EXPECT_TRUE(std::isnan(samples.values[1][i]));
        }
        EXPECT_GT(absent, 20);
        const auto lost = glyphShares(layer, std::vector<double>{0.25, std::nan("")}, source->info());
        EXPECT_EQ(lost[kCommonGlyphParts], 0.25);
        EXPECT_TRUE(std::isnan(lost[kCommonGlyphParts + 1]));
        EXPECT_EQ(lost[kCommonGlyphParts + 2], kPartAtRest);
    }
}

TEST(GlyphSamplesTest, NothingStandsWhereNoPartHasAValue) {
    GlyphLayer layer = twoSpokes();
    layer.parts.erase(layer.parts.begin());
    layer.size = 0.02f; // there is room for all
    const GlyphSamples samples = sampleGlyphs(*slopes(), layer, {});
    EXPECT_EQ(samples.stands.size(), 300u) << "as many as are wanted, where there is something";
    for (const GlyphStand& stand : samples.stands) EXPECT_LT(stand.place.x, 11);
}

TEST(GlyphSamplesTest, RangesOfPartsAreThoseOfTheParameterOrTheirOwn) {
    GlyphLayer layer = twoSpokes();
    const volume::DatasetInfo info = slopes()->info();
    layer.parts[0].range = {0.5, 0.25}; // more where the value is less
    EXPECT_EQ(glyphShares(layer, std::vector<double>{0.3, 0.3}, info)[kCommonGlyphParts], 0.8);
    EXPECT_EQ(glyphShares(layer, std::vector<double>{0.9, 0.3}, info)[kCommonGlyphParts], 0);
    EXPECT_EQ(glyphShares(layer, std::vector<double>{0.9, 0.3}, info)[kCommonGlyphParts + 1], 0.3);
}

TEST(GlyphSamplesTest, TheyStandOnASurfaceAndPointAlongAVector) {
    GlyphLayer layer{.channel = "a", .kind = GlyphKind::Arrow, .direction = "U"};
    layer.place = GlyphPlace::Surface;
    layer.surface = "a";
    layer.surfaceValue = 0.3;
    const GlyphSamples samples = sampleGlyphs(*slopes(), layer, {});
    ASSERT_GT(samples.stands.size(), 100u);
    for (std::size_t i = 0; i < samples.stands.size(); ++i) {
        EXPECT_NEAR(samples.stands[i].place.x, 0.3 * 16, 1e-3);
        EXPECT_NEAR(std::abs(samples.stands[i].normal.x), 1, 1e-6);
        EXPECT_NEAR(samples.directions[i].y, 1, 1e-9);
    }
    const auto geometry = makeGlyphs(*slopes(), layer, {});
    const auto& points = geometry->mesh.positions;
    const auto [low, high] = std::ranges::minmax(points, {}, &glm::vec3::y);
    EXPECT_GT(high.y - low.y, 10);
}

TEST(GlyphSamplesTest, AreLargerWhereTheInterestIsHigher) {
    Selection selection;
    selection.brushes = {rangeBrush({{"a", 0.5, 1, 0}})};
    const DoiFunction interest(selection);
    GlyphLayer layer = twoSpokes();
    layer.kind = GlyphKind::Superquadric;
    layer.parts.clear();
    layer.even = true;
    const GlyphSamples samples = sampleGlyphs(*slopes(), layer, {.interest = &interest});
    const auto geometry = makeGlyphs(*slopes(), layer, {.interest = &interest});
    const std::size_t each = geometry->mesh.positions.size() / samples.stands.size();
    for (std::size_t i = 0; i < samples.stands.size(); ++i) {
        double reach = 0;
        for (std::size_t v = i * each; v < (i + 1) * each; ++v)
            reach = std::max(reach, glm::distance(glm::dvec3(geometry->mesh.positions[v]), samples.stands[i].place));
        const double whole = 0.05 * 16 * 0.5 / std::sqrt(3.0);
        EXPECT_NEAR(reach, whole * (samples.stands[i].place.x >= 8 ? 1 : 0.35), 1e-4);
    }
    layer.seedBrushed = true;
    layer.even = false;
    for (const GlyphStand& stand : sampleGlyphs(*slopes(), layer, {.interest = &interest}).stands)
        EXPECT_GE(stand.place.x, 8);
}

TEST(GlyphSamplesTest, OneAtTheCursorFollowsIt) {
    GlyphLayer layer = twoSpokes();
    layer.place = GlyphPlace::Cursor;
    const GlyphSamples samples = sampleGlyphs(*slopes(), layer, {.cursor = {4, 8, 12}});
    ASSERT_EQ(samples.stands.size(), 1u);
    EXPECT_NEAR(samples.values[0][0], 0.25, 1e-6);
    EXPECT_NEAR(samples.values[1][0], 0.5, 1e-6);
    layer.weight = "a"; // which is least there, and not asked for a place of its own
    EXPECT_EQ(sampleGlyphs(*slopes(), layer, {.cursor = {0, 8, 12}}).stands.size(), 1u);
}

TEST(GlyphSamplesTest, TheSurfaceOfALabelIsThatOfOneRegion) {
    volume::Dataset data;
    data.info.lattice.size = glm::ivec3(kEdge);
    data.info.bounds = {glm::dvec3(0), glm::dvec3(kEdge - 1)};
    data.info.parameters.resize(1);
    data.info.parameters[0].name = "region";
    data.info.parameters[0].categorical = true;
    data.info.parameters[0].type = volume::ScalarType::U8;
    data.info.parameters[0].ranges = {{1, 5}};
    data.read = [lattice = data.info.lattice](int, int, int) {
        volume::Field field = volume::makeField(lattice, volume::ScalarType::U8);
        for (std::size_t i = 0; i < field.count(); ++i) // 1, then 5, then 3 along x
            field.as<std::uint8_t>()[i] = i % kEdge < 5 ? 1 : i % kEdge < 10 ? 5 : 3;
        return field;
    };
    const auto source = volume::makeMemorySource(std::move(data), {});
    GlyphLayer layer{.channel = "region"};
    layer.place = GlyphPlace::Surface;
    layer.surface = "region";
    layer.surfaceValue = 3;
    const GlyphSamples samples = sampleGlyphs(*source, layer, {});
    ASSERT_GT(samples.stands.size(), 50u);
    for (const GlyphStand& stand : samples.stands) EXPECT_GT(stand.place.x, 9) << "no border of 1 and 5";
}

class GlyphPicturesTest : public test::GlTest {
protected:
    std::vector<glm::vec4> linear(const GlyphLayer& layer, bool openGl, bool lit = false) {
        Renderer renderer({.openGl = openGl});
        renderer.setSource(data);
        Scene scene;
        scene.camera = test::frontCamera(1.2);
        scene.showBox = false;
        if (!lit) {
            scene.lighting.ambient = 1;
            scene.lighting.diffuse = scene.lighting.specular = 0;
        }
        scene.layers.push_back({"", true, layer}); // draws nothing by itself
        scene.geometry.push_back({.geometry = makeGlyphs(*data, layer, {}), .style = layer.style, .channel = "a"});
        const ViewTargetPtr target = renderer.makeTarget();
        test::renderAll(renderer, *target, scene, kPictureSize);
        return renderer.readLinear(*target);
    }
    /// The pixel over a place of the data.
    static glm::vec4 over(const std::vector<glm::vec4>& pixels, double x, double y) {
        const auto at = [](double place) { return std::size_t(((place / 16 - 0.5) / 1.2 + 0.5) * kPictureSize.x); };
        return pixels[at(16 - y) * std::size_t(kPictureSize.x) + at(x)]; // rows come from the top
    }
    std::shared_ptr<const volume::BrickSource> data = slopes();
};

/// A single star whose spokes have the colours of their parts, and a gap where a value is absent.
TEST_F(GlyphPicturesTest, PartsHaveTheirColoursAndLengths) {
    GlyphLayer layer = twoSpokes();
    layer.parts = {{"spoke 1", "a", {0, 0}}, {"spoke 2", "b", {0, 0}}, {"spoke 3", "a", {0, 0.5}}};
    layer.size = 0.9f;
    layer.count = 1;
    layer.even = true;
    for (const bool openGl : {true, false}) {
        const auto pixels = linear(layer, openGl);
        const auto expectColor = [&](double x, double y, std::size_t spoke) {
            const glm::dvec3 wanted =
                linearFromSrgb(glm::dvec3(*glyphPartColor(GlyphKind::Star, kCommonGlyphParts + spoke)));
            EXPECT_LT(glm::length(glm::dvec3(over(pixels, x, y)) - wanted), 0.03) << spoke << " " << openGl;
        };
        const double half = 0.45 * 16;            // radius of the star
        const double up = half * partLength(0.5); // of the first spoke, at (8, 8): a = 0.5
        expectColor(8, 8 + up * 0.9, 0);
        EXPECT_EQ(over(pixels, 8, 8 + up + 0.3).a, 0);
        const double third = std::numbers::pi * 2 / 3;
        expectColor(8 + half * 0.5 * std::sin(third), 8 + half * 0.5 * std::cos(third), 1);
        expectColor(8 - half * 0.9 * std::sin(third), 8 + half * 0.9 * std::cos(third), 2);
    }
    layer.from.x = layer.to.x = 13.0f / 16; // b is absent
    layer.from.y = layer.to.y = 0.5f;
    const auto pixels = linear(layer, true);
    EXPECT_GT(over(pixels, 13, 10).a, 0.9f);
    const double third = std::numbers::pi * 2 / 3, half = 0.45 * 16;
    for (const double share : {0.12, 0.3})
        EXPECT_EQ(over(pixels, 13 + half * share * std::sin(third), 8 + half * share * std::cos(third)).a, 0);
}

TEST_F(GlyphPicturesTest, BothEnginesDrawEveryKindAlike) {
    for (std::size_t kind = 0; kind < std::size(kGlyphKindNames); ++kind) {
        GlyphLayer layer = twoSpokes();
        layer.kind = GlyphKind(kind);
        const auto names = glyphPartNames(layer.kind);
        layer.parts = {{std::string(names[kCommonGlyphParts]), "a", {0, 0}},
                       {std::string(names[kCommonGlyphParts + 1]), "a", {1, 0}},
                       {"opacity", "a", {0, 0}},
                       {"tilt", "a", {0, 0}}};
        layer.count = 25;
        layer.size = 0.2f;
        layer.even = true;
        const auto ours = linear(layer, false, true), theirs = linear(layer, true, true);
        double sum = 0, covered = 0;
        int apart = 0;
        for (std::size_t i = 0; i < ours.size(); ++i) {
            const glm::vec4 difference = ours[i] - theirs[i];
            sum += double(glm::dot(difference, difference));
            covered += double(theirs[i].a > 0.05f);
            apart += glm::length(difference) > 0.05f;
        }
        EXPECT_GT(covered, 200) << kGlyphKindNames[kind];
        EXPECT_LT(std::sqrt(sum / double(ours.size() * 4)), 0.01) << kGlyphKindNames[kind];
        EXPECT_LT(apart, 60) << kGlyphKindNames[kind] << ": pixels at edges";
    }
}

} // namespace
} // namespace tessera::vis
