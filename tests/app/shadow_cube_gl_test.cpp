#include "app/views/shadow_cube/wall_projection.h"
#include "tests/vis/function_source.h"
#include "vis/gl/headless.h"
#include "vis/optics/ray_setup.h"
#include "vis/passes/renderer.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>

/// What the faces of the shadow cube show and read, on a small grid whose sums are known.
namespace tessera::app {
namespace {

constexpr int kEdge = 9;

double value(glm::dvec3 p) {
    return 2 + std::sin(1.3 * p.x) + 0.5 * std::cos(p.y * 0.9) + 0.7 * std::sin(p.z * p.x * 0.2);
}

class ShadowCube : public testing::Test {
protected:
    ShadowCube() {
        source = std::make_shared<vis::FunctionSource>(volume::LatticeKind::CC, glm::ivec3(kEdge), glm::dvec3(1),
                                                       std::vector<vis::FunctionSource::Channel>{{"v", value, {-1, 5}}},
                                                       8, glm::dvec3(0));
        info().bounds = {glm::dvec3(0), glm::dvec3(kEdge - 1)};
        session.transfer["v"].colormap = "gray";
        session.cursor = {3, 2.5, 4};
    }
    volume::DatasetInfo& info() { return const_cast<volume::DatasetInfo&>(source->info()); }
    /// The trapezoidal mean of a grid column, as linear interpolation has it.
    static double column(int axis, int right, int up) {
        double sum = 0;
        for (int k = 0; k < kEdge; ++k) {
            glm::dvec3 p(0);
            p[axis] = k, p[(axis + 1) % 3] = right, p[(axis + 2) % 3] = up;
            sum += value(p) * (k == 0 || k == kEdge - 1 ? 0.5 : 1);
        }
        return sum / (kEdge - 1);
    }
    void expectMeans(const Wall& wall, const std::function<double(double)>& place);
    std::shared_ptr<vis::FunctionSource> source;
    Session session;
};

/// Draws every face with a mean over the grid, and compares its grey with `place`, of a mean in its function.
void ShadowCube::expectMeans(const Wall& wall, const std::function<double(double)>& place) {
    const vis::HeadlessContext context;
    vis::RendererOptions options;
    options.exactTextures = true;
    vis::Renderer renderer(options);
    renderer.setSource(source);
    const vis::WorldFrame world = vis::worldFrame(info(), glm::dvec3(1));
    for (const CubeFace& face : kCubeFaces) {
        vis::Scene scene = wallScene(sceneOf(session), "v", wall, face, world, glm::vec3(0));
        scene.render.filter = vis::Filter::Average;
        const vis::ViewTargetPtr target = renderer.makeTarget();
        vis::FrameRequest request;
        request.size = glm::ivec2(kEdge - 1); // a pixel's middle lies between four columns
        request.wait = true;
        renderer.render(*target, scene, request);
        const std::vector<glm::vec4> picture = renderer.readLinear(*target);
        for (int y = 0; y < kEdge - 1; ++y)
            for (int x = 0; x < kEdge - 1; ++x) {
                const int up = kEdge - 2 - y;
                const double expected = (column(face.axis, x, up) + column(face.axis, x + 1, up) +
                                         column(face.axis, x, up + 1) + column(face.axis, x + 1, up + 1)) /
                                        4;
                const glm::vec4 pixel = picture[std::size_t(y * (kEdge - 1) + x)];
                EXPECT_NEAR(pixel.a, 1, 1e-5);
                // The maps are grey, from 0 to 1.
                EXPECT_NEAR(vis::srgbFromLinear(double(pixel.g)), place(expected), 0.01 / 6)
                    << face.axis << ' ' << x << ' ' << y;
            }
    }
}

TEST_F(ShadowCube, MeanOfAFaceIsTheSumOverTheGrid) {
    expectMeans({.kind = WallKind::Mean}, [](double mean) { return (mean + 1) / 6; });
}

TEST_F(ShadowCube, AFaceHasTheColoursOfItsOwnFunction) {
    vis::TransferFunction& own = session.transfer["means"];
    own.colormap = "gray";
    own.reversed = true;
    own.autoRange = false;
    own.range = {1.5, 3.5}; // means vary less than values
    expectMeans({.kind = WallKind::Mean, .transfer = "means"},
                [](double mean) { return 1 - std::clamp((mean - 1.5) / 2, 0.0, 1.0); });
    expectMeans({.kind = WallKind::Mean}, [](double mean) { return (mean + 1) / 6; }); // others keep the parameter's
}

TEST_F(ShadowCube, FacesReadWhatTheyShow) {
    for (const CubeFace& face : kCubeFaces)
        for (int i = 1; i < kEdge - 1; i += 3) {
            glm::dvec3 at(0);
            at[face.right()] = i, at[face.up()] = 2;
            const auto read = [&](WallKind kind) {
                return readWall(*source, session, 0, {.kind = kind}, face, at, 0).value_or(-99);
            };
            EXPECT_NEAR(read(WallKind::Mean), column(face.axis, i, 2), 1e-5);
            glm::dvec3 p = at;
            p[face.axis] = session.cursor[face.axis];
            const double below = std::floor(p[face.axis]), part = p[face.axis] - below;
            glm::dvec3 a = p, b = p;
            a[face.axis] = below, b[face.axis] = below + 1;
            EXPECT_NEAR(read(WallKind::Slice), glm::mix(value(a), value(b), part), 1e-5);
            double most = -99;
            for (int k = 0; k + 1 < kEdge; ++k) { // a quarter of a cell from either sample is the nearest place read
                a[face.axis] = k, b[face.axis] = k + 1;
                most = std::max({most, glm::mix(value(a), value(b), 0.25), glm::mix(value(a), value(b), 0.75)});
            }
            EXPECT_NEAR(read(WallKind::Maximum), most, 1e-5);
        }
    session.transfer["v"].opacity = {{0, 0.003f}, {1, 0.003f}};
    const vis::WorldFrame world = vis::worldFrame(info(), glm::dvec3(1));
    const double absorbed =
        readWall(*source, session, 0, {.kind = WallKind::XRay}, kCubeFaces[0], {4, 4, 4}, 0).value_or(-1);
    EXPECT_NEAR(absorbed, vis::correctedOpacity(double(0.003f), 2 * world.halfSize.x, 1), 1e-9);
    session.transfer["thick"].opacity = {{0, 0.008f}, {1, 0.008f}};
    const Wall own{.kind = WallKind::XRay, .transfer = "thick"};
    EXPECT_NEAR(readWall(*source, session, 0, own, kCubeFaces[0], {4, 4, 4}, 0).value_or(-1),
                vis::correctedOpacity(double(0.008f), 2 * world.halfSize.x, 1), 1e-9);
}

TEST_F(ShadowCube, BrushSelectsThePrismBehindTheFace) {
    const CubeFace face = kCubeFaces[2]; // stands on y: z to the right, x up
    const vis::BoxRegion box = prism(face, {1, -3, 6}, {4, 99, 2}, info().bounds);
    EXPECT_EQ(face.right(), 2);
    vis::Brush brush;
    brush.region = box;
    session.selection.brushes = {brush};
    const vis::DoiFunction interest(session.selection);
    for (int x = 0; x < kEdge; ++x)
        for (int y = 0; y < kEdge; ++y)
            for (int z = 0; z < kEdge; ++z) {
                const bool edge = x == 1 || x == 4 || z == 2 || z == 6;
                if (!edge) {
                    EXPECT_EQ(interest({}, {x, y, z}), x > 1 && x < 4 && z > 2 && z < 6 ? 1 : 0) << x << y << z;
                }
            }
    EXPECT_EQ(readWall(*source, session, 0, {.kind = WallKind::Shadow}, face, {3, 0, 4}, 0), 1);
    EXPECT_EQ(readWall(*source, session, 0, {.kind = WallKind::Shadow}, face, {7, 0, 4}, 0), 0);
}

TEST_F(ShadowCube, OnlyFacesBehindTheObjectAreSeen) {
    vis::Camera camera;
    const glm::dvec3 half(0.6, 0.7, 0.8);
    for (const vis::Projection projection : {vis::Projection::Perspective, vis::Projection::Orthographic})
        for (int i = 0; i < 50; ++i) {
            camera.projection = projection;
            vis::orbit(camera, {0, 0}, {0.37f, 0.21f});
            const vis::Ray middle = vis::cameraRay(camera, 1, {0, 0});
            int seen = 0;
            for (const CubeFace& face : kCubeFaces) {
                if (!facesViewer(face, half, camera)) continue;
                ++seen;
                // Beyond the middle of the cube for the viewer.
                const glm::dvec3 there = face.at(0, 0, half);
                EXPECT_GT(glm::dot(there - middle.origin, middle.direction) + 0.8,
                          glm::dot(-middle.origin, middle.direction));
            }
            EXPECT_GE(seen, projection == vis::Projection::Orthographic ? 1 : 3);
            const auto hit = hitFace(middle, half, camera);
            ASSERT_TRUE(hit) << "the middle ray leaves the cube through a face that is seen";
            EXPECT_TRUE(facesViewer(kCubeFaces[hit->face], half, camera));
            EXPECT_GT(glm::dot(kCubeFaces[hit->face].at(hit->s, hit->t, half), middle.direction), 0);
        }
}

} // namespace
} // namespace tessera::app
