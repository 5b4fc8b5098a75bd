#include "tests/reference/some_strokes.h"
#include "tests/vis/renderer_scenes.h"
#include "vis/image/image_metrics.h"
#include "vis/passes/point_cloud.h"
#include "volume/base/error.h"

#include <numbers>

/// Pictures that the processor draws without OpenGL, beside the same ones by OpenGL.
namespace tessera::vis {
namespace {

constexpr glm::ivec2 kAlikeSize{120, 90};

class WithoutOpenGl : public test::GlTest {
protected:
    /// The presented picture of a scene.
    Image drawn(const Scene& scene, bool openGl) {
        Renderer renderer({.openGl = openGl});
        renderer.setSource(data);
        const ViewTargetPtr target = renderer.makeTarget();
        const FrameStatus status = renderer.render(*target, scene, {.size = kAlikeSize, .wait = true});
        EXPECT_TRUE(status.complete);
        EXPECT_NE(status.texture, 0u);
        EXPECT_TRUE(renderer.takeMessages().empty());
        Image out;
        out.rgba = renderer.readPixels(*target, out.size);
        return out;
    }
    /// The likeness of both pictures in dB; components of the opacity count as colours do.
    double likeness(const Scene& scene) {
        Image ours = drawn(scene, false), theirs = drawn(scene, true);
        EXPECT_EQ(ours.size, kAlikeSize);
        const std::size_t opacities = ours.rgba.size();
        for (Image* image : {&ours, &theirs}) { // opacities as a second picture below the first
            image->size.y *= 2;
            image->rgba.resize(opacities * 2);
            for (std::size_t i = 0; i < opacities; i += 4)
                for (std::size_t c = 0; c < 4; ++c) image->rgba[opacities + i + c] = image->rgba[i + 3];
        }
        return difference(ours, theirs).psnr;
    }
    std::shared_ptr<const volume::BrickSource> data = test::brickedSource(volume::LatticeKind::CC);
};

/// A sphere of triangles and a spiral around it, in the middle of the data.
std::shared_ptr<const Geometry> ballAndSpiral(bool normals) {
    constexpr int kRound = 24, kUp = 12;
    auto geometry = std::make_shared<Geometry>();
    const glm::dvec3 middle(14, 12, 18);
    for (int j = 0; j <= kUp; ++j)
        for (int i = 0; i <= kRound; ++i) {
            const double along = 2 * std::numbers::pi * i / kRound, up = std::numbers::pi * j / kUp;
            const glm::dvec3 way(std::sin(up) * std::cos(along), std::cos(up), std::sin(up) * std::sin(along));
            geometry->mesh.positions.emplace_back(middle + way * 9.0);
            if (normals) geometry->mesh.normals.emplace_back(way);
            geometry->mesh.scalars.push_back(i % 5 == 0 ? std::numeric_limits<float>::quiet_NaN() : float(j) / kUp);
        }
    for (std::uint32_t j = 0; j < kUp; ++j)
        for (std::uint32_t i = 0; i < kRound; ++i) {
            const std::uint32_t a = j * (kRound + 1) + i, b = a + kRound + 1;
            geometry->mesh.triangles.push_back({a, b, a + 1});
            geometry->mesh.triangles.push_back({a + 1, b, b + 1});
        }
    for (int i = 0; i < 60; ++i) {
        const double along = i * 0.25;
        geometry->lines.positions.emplace_back(middle.x + 12 * std::cos(along), 2 + i * 0.33,
                                               middle.z + 12 * std::sin(along));
        geometry->lines.scalars.push_back(float(i) / 60);
    }
    geometry->lines.ends = {25, 60};
    return geometry;
}

std::shared_ptr<const Geometry> strokedBall() {
    auto geometry = std::make_shared<Geometry>(*ballAndSpiral(true));
    for (std::size_t i = 0; i < geometry->mesh.positions.size(); ++i)
        geometry->strokes.push_back(std::sin(0.7f * float(i)));
    return geometry;
}

/// Two triangles, the edge between which crosses the middles of pixels seen from the front.
std::shared_ptr<const Geometry> sheet() {
    auto geometry = std::make_shared<Geometry>();
    geometry->mesh.positions = {{4, 2, 20}, {24, 2, 20}, {24, 22, 20}, {4, 22, 20}};
    geometry->mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return geometry;
}

struct AlikeScene {
    const char* name;
    std::function<void(Scene&)> apply;
};

const AlikeScene kAlikeScenes[] = {
    {"a volume, a surface and a slice", [](Scene&) {}},
    {"the box", [](Scene& s) { s.showBox = true; }},
    {"no ground", [](Scene& s) { s.showBox = true, s.showGround = false; }},
    {"paper", [](Scene& s) { s.paper = Paper{.tooth = 1}; }},
    {"filmic tones", [](Scene& s) { s.tone = {.curve = ToneCurve::Filmic, .exposure = 1}; }},
    {"shadows of depth", [](Scene& s) { s.depthMask = {.strength = 2, .width = 0.1f, .lighten = true}; }},
    {"shadows of depth without ground",
     [](Scene& s) { s.depthMask.strength = 3, s.showGround = false, s.tone.curve = ToneCurve::Reinhard; }},
    {"strokes",
     [](Scene& s) {
         s.layers = {{"", true, SliceLayer{.channel = "v", .orientation = SliceOrientation::X}}};
         s.strokes = {{0, reference::someStrokes({0, 1, 0}, {0, 0, 1})}};
     }},
    {"parallel rays", [](Scene& s) { s.camera.projection = Projection::Orthographic, s.showBox = true; }},
    {"four rays per pixel", [](Scene& s) { s.render.samples = 4; }},
    {"depth of field", [](Scene& s) { s.camera.aperture = 0.05f; }},
    {"shadows", [](Scene& s) { s.lighting.shadows.strength = 0.8f, s.lighting.shadows.occlusion = 0.5f; }},
    {"a sky",
     [](Scene& s) { s.lighting.model = LightModel::Physical, s.lighting.environment.kind = Environment::Sky; }},
    {"a mesh and lines",
     [](Scene& s) { s.geometry = {{.geometry = ballAndSpiral(true), .style = {.lineWidth = 3}, .channel = "v"}}; }},
    {"a mesh with strokes and lines",
     [](Scene& s) {
         s.geometry = {{.geometry = strokedBall(), .style = {.lineWidth = 3, .strokes = 0.8f}, .channel = "v"},
                       {.geometry = strokedBall(),
                        .style = {.opacity = 0.4f, .strokes = 0.5f, .look = *Look::preset("cartoon")}}};
     }},
    {"halos of a mesh and lines",
     [](Scene& s) {
         s.geometry =
             withHalos({{.geometry = ballAndSpiral(true), .style = {.lineWidth = 3, .halo = 5}, .channel = "v"}},
                       {0.9f, 0.2f, 0.1f});
         s.layers.resize(1);
     }},
    {"a mesh without normals in a volume",
     [](Scene& s) {
         s.geometry = {{.geometry = ballAndSpiral(false), .style = {.color = {0.2f, 0.7f, 0.4f}, .opacity = 0.5f}}};
         s.layers.resize(1);
     }},
    {"a mesh in charcoal, clipped",
     [](Scene& s) {
         s.geometry = {{.geometry = ballAndSpiral(true), .style = {.look = *Look::preset("charcoal")}}};
         s.layers.clear();
         s.clips = {{.center = {0.5f, 0.5f, 0.6f}, .axis = {0, 0, 1}}};
     }},
    {"a mesh around the eye",
     [](Scene& s) {
         s.geometry = {{.geometry = ballAndSpiral(true), .style = {.opacity = 0.7f}, .channel = "v"}};
         s.camera.distance = 0.15f;
     }},
    {"a mesh by two rays per pixel",
     [](Scene& s) {
         s.geometry = {{.geometry = ballAndSpiral(true), .style = {.lineWidth = 3}}};
         s.render.samples = 2;
     }},
    {"a sheet of two triangles",
     [](Scene& s) {
         s.camera = test::frontCamera();
         s.camera.target = {0, 0, 0};
         s.geometry = {{.geometry = sheet(), .style = {.opacity = 0.5f}}};
         s.layers.clear();
     }},
    {"a net of wires in a lens, brushed",
     [](Scene& s) {
         s.geometry = {{.geometry = ballAndSpiral(true),
                        .style = {.color = {0.9f, 0.6f, 0.2f}, .look = *Look::preset("wire")},
                        .lens = "lens",
                        .brushes = BrushEffect::ContextOnly}};
         s.lenses = {{.name = "lens", .center = {14, 12, 18}, .size = glm::vec3(0.2f)}};
     }},
};

TEST_F(WithoutOpenGl, ScenesLookAsWithIt) {
    const Image plain = drawn(test::richScene(), false);
    for (const AlikeScene& shown : kAlikeScenes) {
        Scene scene = test::richScene();
        shown.apply(scene);
        EXPECT_GE(likeness(scene), 50) << shown.name;
        if (&shown != kAlikeScenes) {
            EXPECT_NE(drawn(scene, false).rgba, plain.rgba) << shown.name;
        }
    }
}

TEST_F(WithoutOpenGl, PicksAndReadsTheSame) {
    std::vector<std::vector<glm::vec4>> linear;
    std::vector<glm::dvec3> picked;
    for (const bool openGl : {true, false}) {
        Renderer renderer({.openGl = openGl});
        renderer.setSource(data);
        EXPECT_EQ(renderer.source(), data.get());
        const ViewTargetPtr target = renderer.makeTarget();
        const FrameStatus status = renderer.render(*target, test::richScene(), {.size = kAlikeSize, .wait = true});
        EXPECT_EQ(status.engine.byProcessor, !openGl);
        linear.push_back(renderer.readLinear(*target));
        const std::optional<Pick> pick = renderer.pick(*target, {70, 30});
        ASSERT_TRUE(pick);
        picked.push_back(pick->position);
        EXPECT_FALSE(renderer.pick(*target, {0, 0}));
        EXPECT_FALSE(renderer.pick(*target, {kAlikeSize.x, 30}));
    }
    EXPECT_LT(glm::length(picked[0] - picked[1]), 0.1);
    double sum = 0;
    for (std::size_t i = 0; i < linear[0].size(); ++i)
        sum += double(glm::dot(linear[0][i] - linear[1][i], linear[0][i] - linear[1][i]));
    EXPECT_LT(std::sqrt(sum / double(linear[0].size() * 4)), 2e-3);
}

/// Nothing is left out silently.
TEST_F(WithoutOpenGl, WhatOnlyOpenGlDrawsIsRefused) {
    Renderer renderer({.openGl = false});
    renderer.setSource(data);
    const ViewTargetPtr target = renderer.makeTarget();
    Scene scene = test::richScene();
    scene.render.proxy = Proxy::Slices;
    try {
        renderer.render(*target, scene, {.size = kAlikeSize, .wait = true});
        ADD_FAILURE() << "drawn";
    } catch (const MachineError& error) {
        EXPECT_STREQ(error.what(), "without OpenGL proxy geometry cannot be drawn");
    }
    // The next scene is drawn, and one without data shows its ground.
    EXPECT_TRUE(renderer.render(*target, test::richScene(), {.size = kAlikeSize, .wait = true}).complete);
    const std::unique_ptr<Renderer> other = renderer.another();
    EXPECT_EQ(other->textures(), TexturesIn::Memory);
    const ViewTargetPtr empty = other->makeTarget();
    scene.background = {1, 0, 0};
    other->render(*empty, scene, {.size = kAlikeSize, .wait = true});
    glm::ivec2 size;
    const std::vector<std::uint8_t> pixels = other->readPixels(*empty, size);
    EXPECT_EQ(std::vector<std::uint8_t>(pixels.begin(), pixels.begin() + 4),
              (std::vector<std::uint8_t>{255, 0, 0, 255}));
}

TEST_F(WithoutOpenGl, CloudsOfPointsLookAsWithIt) {
    std::vector<CloudPoint> points;
    for (int i = 0; i < 400; ++i) {
        const double a = i * 0.37, b = i * 0.011;
        points.push_back(
            {.position =
                 glm::vec4(std::cos(a), std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(b * 3)) * 0.5f,
             .color = {0.9f, 0.002f * float(i), 0.2f, 0.6f}});
    }
    CloudView view;
    view.rotation = planeRotation(0, 3, 0.4) * planeRotation(1, 2, 0.7);
    view.size = {150, 110};
    view.background = {0.1f, 0.2f, 0.3f};
    for (const double share : {1.0, 0.3})
        for (const float radius : {0.3f, 6.0f}) {
            view.share = share;
            view.radiusPixels = radius;
            PointCloud cloud;
            cloud.upload(TexturesIn::OpenGl, points);
            Image theirs{view.size, std::vector<std::uint8_t>(150 * 110 * 4)};
            glGetTextureImage(GLuint(cloud.draw(view)), 0, GL_RGBA, GL_UNSIGNED_BYTE, GLsizei(theirs.rgba.size()),
                              theirs.rgba.data());
            PointCloud own;
            own.upload(TexturesIn::Memory, points);
            EXPECT_EQ(own.count(), points.size());
            const auto& texture = *reinterpret_cast<const MemoryTexture*>(own.draw(view));
            EXPECT_GE(difference({texture.size, texture.rgba}, theirs).psnr, 50) << share << " " << radius;
        }
}

} // namespace
} // namespace tessera::vis
