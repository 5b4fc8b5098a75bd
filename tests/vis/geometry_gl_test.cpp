#include "tests/vis/function_source.h"
#include "tests/vis/gl_fixture.h"
#include "vis/view/geometry_pass.h"
#include "volume/mesh/isosurface.h"

#include <cmath>
#include <numeric>

namespace tessera::vis {
namespace {

using test::renderAll;

class GeometryPassTest : public test::GlTest {
protected:
    static constexpr glm::ivec2 kSize{96, 96};
    RendererOptions exact{.exactTextures = true};
    Renderer renderer{exact};

    void show(FunctionSource::Function function, volume::LatticeKind kind = volume::LatticeKind::CC) {
        source = std::make_shared<FunctionSource>(
            kind, glm::ivec3(33), glm::dvec3(0.5),
            std::vector<FunctionSource::Channel>{{"f", std::move(function), {0, 1}, false}});
        renderer.setSource(source);
    }
    static Scene unlit() {
        Scene scene;
        scene.camera = test::frontCamera(1.2);
        scene.showBox = false;
        scene.render.samples = 1;
        scene.lighting.ambient = 1;
        scene.lighting.diffuse = scene.lighting.specular = 0;
        return scene;
    }
    std::vector<glm::vec4> picture(const Scene& scene) {
        const ViewTargetPtr target = renderer.makeTarget();
        renderAll(renderer, *target, scene, kSize);
        return renderer.readLinear(*target);
    }
    static glm::vec4 at(const std::vector<glm::vec4>& pixels, int x, int y) {
        return pixels[std::size_t(y) * std::size_t(kSize.x) + std::size_t(x)];
    }
    std::shared_ptr<const FunctionSource> source;
};

/// The rectangle through four corners that follow each other around it; scalars x / 16.
std::shared_ptr<const Geometry> rectangle(std::array<glm::vec3, 4> corners) {
    auto geometry = std::make_shared<Geometry>();
    for (const glm::vec3& corner : corners) {
        geometry->mesh.positions.push_back(corner);
        geometry->mesh.scalars.push_back(corner.x / 16);
    }
    geometry->mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return geometry;
}

std::shared_ptr<const Geometry> atDepth(float z) {
    return rectangle({glm::vec3(0, 0, z), {16, 0, z}, {16, 16, z}, {0, 16, z}});
}

TransferFunction haze() {
    TransferFunction function;
    function.opacity = {{0, 0.02f}, {1, 0.05f}};
    return function;
}

// A rectangle in the place of a slice, coloured by the same values, is that slice: alone, inside a volume, translucent.
TEST_F(GeometryPassTest, LooksLikeASliceInItsPlace) {
    show([](glm::dvec3 p) { return p.x / 16; });
    for (const Projection projection : {Projection::Orthographic, Projection::Perspective})
        for (const bool inVolume : {false, true})
            for (const float opacity : {1.0f, 0.4f}) {
                Scene scene = unlit();
                scene.camera.projection = projection;
                scene.transfer["f"] = haze();
                if (inVolume)
                    scene.layers.push_back({"", true, VolumeLayer{.channel = "f", .shaded = false, .density = 3}});
                Scene withSlice = scene, withMesh = scene;
                withSlice.layers.push_back(
                    {"", true, SliceLayer{.channel = "f", .atCursor = false, .position = 0.4, .opacity = opacity}});
                withMesh.geometry.push_back(
                    {.geometry = atDepth(0.4f * 16), .style = {.opacity = opacity}, .channel = "f"});
                const std::vector<glm::vec4> slice = picture(withSlice), mesh = picture(withMesh);
                std::size_t differ = 0, seen = 0;
                for (std::size_t i = 0; i < slice.size(); ++i) {
                    const glm::vec4 apart = glm::abs(slice[i] - mesh[i]);
                    differ += std::max({apart.x, apart.y, apart.z, apart.w}) > 2e-3f;
                    seen += slice[i].a > 0.9f * opacity;
                }
                EXPECT_GT(seen, 3000u);
                EXPECT_LT(differ, 200u) << int(projection) << inVolume
                                        << opacity; // along the border, where the data are filtered
            }
}

TEST_F(GeometryPassTest, StrokesMakeColorsLighterAndDarker) {
    show([](glm::dvec3) { return 0.5; });
    Scene scene = unlit();
    auto stroked = std::make_shared<Geometry>(*atDepth(6));
    stroked->strokes = {-0.6f, 0.4f, 0.4f, -0.6f}; // along x
    const auto pictureOf = [&](std::shared_ptr<const Geometry> geometry, float strength) {
        scene.geometry = {{.geometry = std::move(geometry), .style = {.color = glm::vec3(0.5f), .strokes = strength}}};
        return picture(scene);
    };
    const std::vector<glm::vec4> plain = pictureOf(atDepth(6), 0.5f), none = pictureOf(stroked, 0),
                                 strokes = pictureOf(stroked, 0.5f);
    EXPECT_EQ(plain, none);
    const int middle = kSize.y / 2;
    std::vector<double> factors;
    for (int x = 0; x < kSize.x; ++x)
        if (at(plain, x, middle).a > 0.99f) factors.push_back(at(strokes, x, middle).r / at(plain, x, middle).r);
    ASSERT_GT(factors.size(), 30u);
    EXPECT_NEAR(factors.front(), 1 - 0.3, 0.02);
    EXPECT_NEAR(factors.back(), 1 + 0.2, 0.02);
    EXPECT_NEAR(factors[factors.size() / 2], 0.95, 0.02) << "smooth between vertices";
}

// Two translucent rectangles that cross: on each side the one in front is composited first.
TEST_F(GeometryPassTest, OrdersTranslucentSurfacesByDepth) {
    show([](glm::dvec3) { return 0.5; });
    Scene scene = unlit();
    const glm::vec3 red(1, 0, 0), blue(0, 0, 1);
    scene.geometry = {{.geometry = rectangle({glm::vec3(0, 0, 2), {16, 0, 14}, {16, 16, 14}, {0, 16, 2}}),
                       .style = {.color = red, .opacity = 0.5f}},
                      {.geometry = rectangle({glm::vec3(0, 0, 14), {16, 0, 2}, {16, 16, 2}, {0, 16, 14}}),
                       .style = {.color = blue, .opacity = 0.5f}}};
    const std::vector<glm::vec4> pixels = picture(scene);
    const glm::vec4 left = at(pixels, 25, 48), right = at(pixels, 70, 48); // the camera looks against z
    EXPECT_LT(glm::length(left - glm::vec4(0.25, 0, 0.5, 0.75)), 1e-4f);
    EXPECT_LT(glm::length(right - glm::vec4(0.5, 0, 0.25, 0.75)), 1e-4f);
    // Layer order plays no part.
    std::swap(scene.geometry[0], scene.geometry[1]);
    EXPECT_LT(test::maxDifference(pixels, picture(scene)), 1e-5);
}

// A volume before and behind an opaque surface: what lies in front is seen over it, the rest is hidden.
TEST_F(GeometryPassTest, HidesTheVolumeBehindIt) {
    show([](glm::dvec3) { return 0.5; });
    Scene scene = unlit();
    TransferFunction function;
    function.opacity = {{0, 0.03f}, {1, 0.03f}};
    scene.transfer["f"] = function;
    scene.layers.push_back({"", true, VolumeLayer{.channel = "f", .shaded = false, .density = 1}});
    const float volumeAlpha = at(picture(scene), 48, 48).a;
    scene.geometry.push_back({.geometry = atDepth(8), .style = {.color = {0, 0, 0}}}); // black, in the middle
    const glm::vec4 both = at(picture(scene), 48, 48);
    EXPECT_NEAR(both.a, 1, 1e-5);
    // Light that reaches the eye comes from the front half alone.
    Scene bright = scene;
    bright.geometry[0].style.color = {1, 1, 1};
    const glm::vec4 white = at(picture(bright), 48, 48);
    EXPECT_NEAR(white.r - both.r, std::sqrt(1 - volumeAlpha), 0.01);
}

TEST_F(GeometryPassTest, PolygonsShowTheSurfaceTheRaysMeet) {
    for (const auto kind : {volume::LatticeKind::CC, volume::LatticeKind::BCC}) {
        show([](glm::dvec3 p) { return 1 - glm::length(p - glm::dvec3(8.3, 7.9, 8.1)) / 10; }, kind);
        Scene scene;
        scene.camera = test::frontCamera(1.2);
        scene.camera.projection = Projection::Perspective;
        scene.showBox = false;
        Scene rays = scene;
        IsoLayer iso{.channel = "f", .value = 0.45};
        rays.layers.push_back({"", true, iso});
        iso.method = SurfaceMethod::Polygons; // the layer draws nothing by itself
        scene.layers.push_back({"", true, iso});
        auto geometry = std::make_shared<Geometry>();
        geometry->mesh = volume::extractIsosurface(*source, 0, 0, iso.value, 0);
        scene.geometry.push_back({.geometry = geometry, .style = {.color = iso.color}});
        const std::vector<glm::vec4> a = picture(rays), b = picture(scene);
        std::size_t differ = 0, seen = 0;
        double squares = 0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            if (a[i].a > 0.5f && b[i].a > 0.5f) {
                ++seen;
                squares += double(glm::dot(a[i] - b[i], a[i] - b[i]));
            } else {
                differ += a[i].a > 0.5f || b[i].a > 0.5f;
            }
        }
        EXPECT_GT(seen, 1500u);
        EXPECT_LT(std::sqrt(squares / double(seen)), 0.012);
        EXPECT_LT(differ, seen / 40); // at the silhouette
    }
}

TEST_F(GeometryPassTest, DrawsLinesAsWideAsWanted) {
    show([](glm::dvec3) { return 0.5; });
    Scene scene = unlit();
    auto geometry = std::make_shared<Geometry>();
    geometry->lines.positions = {{2, 4, 8}, {8, 4, 8}, {14, 4, 8}, {2, 12, 8}, {14, 12, 8}};
    geometry->lines.ends = {3, 5}; // no segment from the first line to the second
    scene.geometry.push_back({.geometry = geometry, .style = {.color = {1, 1, 1}, .lineWidth = 4}});
    const auto covered = [&](const Scene& shown) {
        std::size_t count = 0;
        for (const glm::vec4& pixel : picture(shown)) count += pixel.a > 0.5f;
        return double(count);
    };
    const double length = 12.0 / 16 * 96 / 1.2; // pixels
    EXPECT_NEAR(covered(scene), 2 * length * 4, 0.06 * 2 * length * 4);
    // A surface before them hides them.
    scene.geometry.push_back({.geometry = atDepth(12), .style = {.color = {0, 0, 0}}});
    for (const glm::vec4& pixel : picture(scene)) EXPECT_LT(pixel.r, 0.01f);
}

// Meshes and lines lie where their origin says.
TEST_F(GeometryPassTest, PlacesAreCountedFromTheOrigin) {
    show([](glm::dvec3) { return 0.5; });
    const auto drawn = [&](glm::dvec3 origin) {
        Scene scene = unlit();
        auto geometry = std::make_shared<Geometry>();
        geometry->mesh.origin = origin;
        geometry->lines.origin = -origin;
        for (const glm::dvec3 p : {glm::dvec3(2, 3, 8), {9, 3, 8}, {5, 9, 6}})
            geometry->mesh.positions.emplace_back(p - geometry->mesh.origin);
        geometry->mesh.triangles = {{0, 1, 2}};
        for (const glm::dvec3 p : {glm::dvec3(2, 12, 8), {14, 13, 8}})
            geometry->lines.positions.emplace_back(p - geometry->lines.origin);
        geometry->lines.ends = {2};
        scene.geometry.push_back({.geometry = geometry, .style = {.color = {1, 1, 1}, .lineWidth = 4}});
        return picture(scene);
    };
    const auto plain = drawn(glm::dvec3(0)), moved = drawn({64, -32, 16});
    double sum = 0, difference = 0;
    for (std::size_t i = 0; i < plain.size(); ++i) {
        sum += double(plain[i].a);
        difference += std::abs(double(plain[i].a) - double(moved[i].a));
    }
    EXPECT_GT(sum, 500);
    EXPECT_LT(difference, 0.005 * sum);
}

// Each combination of settings has a program, of which OpenGL on the processor takes megabytes.
TEST_F(GeometryPassTest, KeepsOnlySomePrograms) {
    show([](glm::dvec3) { return 0.5; });
    const volume::DatasetInfo info = source->info();
    const auto programsAfter = [&](GeometryPass& pass) {
        GeometryBuffer buffer;
        buffer.resize(kSize, kPeels);
        GrainTexture grain;
        for (int clips = 0; clips < 4; ++clips) {
            Scene scene = unlit();
            scene.geometry.push_back({.geometry = atDepth(8)});
            for (int c = 0; c < clips; ++c) scene.clips.push_back({.kind = ClipKind(c)});
            const GeometryJob job{.scene = scene,
                                  .info = info,
                                  .lenses = {},
                                  .size = kSize,
                                  .tile = {{0, 0}, kSize},
                                  .pictureSize = kSize,
                                  .most = kPeels};
            pass.draw(buffer, job, grain);
        }
        return pass.programs();
    };
    GeometryPass few(currentDriver(), {2, std::chrono::milliseconds(0)}), fresh(currentDriver(), {2}),
        many(currentDriver());
    EXPECT_EQ(programsAfter(few), 2u);
    EXPECT_EQ(programsAfter(fresh), 4u) << "what was used just now may be needed again";
    EXPECT_EQ(programsAfter(many), 4u);
}

TEST_F(GeometryPassTest, GivesThePlaceUnderAPixel) {
    show([](glm::dvec3) { return 0.5; });
    Scene scene = unlit();
    scene.geometry.push_back({.geometry = atDepth(5)});
    const ViewTargetPtr target = renderer.makeTarget();
    renderAll(renderer, *target, scene, kSize);
    const std::optional<Pick> pick = renderer.pick(*target, {48, 48});
    ASSERT_TRUE(pick);
    EXPECT_NEAR(pick->position.z, 5, 0.05);
}

} // namespace
} // namespace tessera::vis
