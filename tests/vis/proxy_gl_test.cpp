#include "tests/reference/raycast.h"
#include "tests/vis/function_source.h"
#include "tests/vis/gl_fixture.h"
#include "vis/shapes/proxy.h"

#include <cmath>

namespace tessera::vis {
namespace {

class ProxyTest : public test::GlTest {
protected:
    static constexpr glm::ivec2 kSize{40, 40};
    Renderer renderer{RendererOptions{.exactTextures = true}};

    static std::shared_ptr<FunctionSource> waves(volume::LatticeKind kind) {
        return std::make_shared<FunctionSource>(
            kind, glm::ivec3(28, 25, 31), glm::dvec3(0.4, 0.5, 0.45),
            std::vector<FunctionSource::Channel>{{"f",
                                                  [](glm::dvec3 p) -> std::optional<double> {
                                                      if (p.x < 3 && p.y < 3) return std::nullopt; // absent in a corner
                                                      return 0.5 +
                                                             0.5 * std::sin(p.x) * std::cos(0.8 * p.y + 0.3 * p.z);
                                                  },
                                                  {0, 1},
                                                  false}});
    }
    static Scene scene(Projection projection, Proxy proxy) {
        Scene out;
        out.camera.projection = projection;
        out.camera.distance = 1.9f;
        out.showBox = false;
        out.render.samples = 1;
        out.render.proxy = proxy;
        out.render.stepVoxels = 0.25f;
        TransferFunction function;
        function.opacity = {{0.0f, 0.0f}, {0.3f, 0.0f}, {0.9f, 0.25f}, {1.0f, 0.25f}};
        out.transfer["f"] = function;
        out.layers.push_back({"", true, VolumeLayer{.channel = "f", .shaded = true, .density = 2}});
        return out;
    }
    reference::Image picture(const Scene& shown) {
        const ViewTargetPtr target = renderer.makeTarget();
        test::renderAll(renderer, *target, shown, kSize);
        reference::Image out{kSize, {}};
        for (const glm::vec4& pixel : renderer.readLinear(*target)) out.pixels.emplace_back(pixel);
        return out;
    }
};

// The reference at a fine step is the limit that rays and every proxy approach.
TEST_F(ProxyTest, ApproachesTheReference) {
    for (const auto kind : {volume::LatticeKind::CC, volume::LatticeKind::BCC}) {
        const auto source = waves(kind);
        renderer.setSource(source);
        for (const Projection projection : {Projection::Perspective, Projection::Orthographic}) {
            Scene fine = scene(projection, Proxy::Rays);
            fine.render.stepVoxels = 0.1f;
            const reference::Image truth = reference::render(fine, *source, kSize);
            for (const Proxy proxy : {Proxy::Rays, Proxy::Slices, Proxy::Shells, Proxy::Stacks}) {
                const reference::Difference apart = reference::compare(picture(scene(projection, proxy)), truth, 0.02);
                // Stacks sample once or twice per cell, the others four times.
                EXPECT_GT(apart.psnr, proxy == Proxy::Stacks ? 30 : 40)
                    << kProxyNames[std::size_t(proxy)] << ' ' << int(kind) << ' ' << int(projection) << " worst at "
                    << apart.worst.x << ' ' << apart.worst.y;
            }
        }
    }
}

// Without the correction for the distance between surfaces a finer stack would be more opaque.
TEST_F(ProxyTest, OpacityDoesNotDependOnTheDistanceOfSurfaces) {
    const auto source = std::make_shared<FunctionSource>(
        volume::LatticeKind::CC, glm::ivec3(17), glm::dvec3(1),
        std::vector<FunctionSource::Channel>{{"f", [](glm::dvec3) { return 0.7; }, {0, 1}, false}});
    renderer.setSource(source);
    for (const Proxy proxy : {Proxy::Slices, Proxy::Shells})
        for (const float step : {1.0f, 0.25f}) {
            Scene shown = scene(Projection::Perspective, proxy);
            shown.camera = test::frontCamera(1.2);
            shown.camera.projection = Projection::Perspective;
            shown.render.stepVoxels = step;
            shown.transfer["f"].opacity = {{0.0f, 0.01f}, {1.0f, 0.01f}};
            std::get<VolumeLayer>(shown.layers[0].technique) = {.channel = "f", .shaded = false, .density = 1};
            const double wanted = 1 - std::pow(1 - 0.01, 1 / kReferenceLength);
            const reference::Image found = picture(shown);
            EXPECT_NEAR(found.pixels[20 * 40 + 20].a, wanted, 1e-4) << step;
        }
}

TEST(ProxySurfacesTest, MeetTheWholeBoxFrontToBack) {
    const volume::Lattice lattice{volume::LatticeKind::CC, {9, 9, 17}, glm::dvec3(1), glm::dvec3(0)};
    const WorldFrame frame = worldFrame({{0, 0, 0}, {8, 8, 16}}, glm::dvec3(1));
    Scene scene;
    scene.camera = test::frontCamera(1.2);
    scene.render.proxy = Proxy::Stacks;
    const ProxySurfaces stack = proxySurfaces(scene, lattice, frame, 1);
    EXPECT_EQ(stack.normal, glm::dvec3(0, 0, -1)); // away from an eye that looks against z
    EXPECT_EQ(stack.count, 17);                    // every slice of samples
    EXPECT_NEAR(stack.first, -0.5, 1e-9);
    EXPECT_NEAR(stack.spacing, 1.0 / 16, 1e-9);
    volume::Lattice bcc = lattice;
    bcc.kind = volume::LatticeKind::BCC;
    const ProxySurfaces halves = proxySurfaces(scene, bcc, frame, 1);
    EXPECT_EQ(halves.count, 33); // slices of both sublattices
    EXPECT_NEAR(halves.spacing, 1.0 / 32, 1e-9);
    scene.render.proxy = Proxy::Shells;
    EXPECT_FALSE(proxySurfaces(scene, lattice, frame, 1).shells); // the eye of parallel rays is far away
    scene.camera.projection = Projection::Perspective;
    const ProxySurfaces shells = proxySurfaces(scene, lattice, frame, 1);
    EXPECT_TRUE(shells.shells);
    EXPECT_NEAR(shells.first, scene.camera.distance - 0.5 + 0.5 * shells.spacing, 1e-6);
    // From any side, slices begin at the nearest corner and end at the furthest one.
    scene.render.proxy = Proxy::Slices;
    scene.camera.projection = Projection::Orthographic;
    for (int octant = 0; octant < 8; ++octant) {
        const glm::vec3 way(octant & 1 ? 0.5f : -0.5f, octant & 2 ? 0.3f : -0.3f, octant & 4 ? 0.8f : -0.8f);
        scene.camera.orientation = glm::conjugate(glm::quatLookAt(glm::normalize(way), glm::vec3(0, 1, 0)));
        const ProxySurfaces slices = proxySurfaces(scene, lattice, frame, 1);
        const glm::dvec3 normal = glm::normalize(glm::dvec3(way));
        EXPECT_LT(glm::length(slices.normal - normal), 1e-6) << octant;
        const double reach = glm::dot(glm::abs(normal), frame.halfSize);
        EXPECT_NEAR(slices.first, -reach + 0.5 * slices.spacing, 1e-6) << octant;
        EXPECT_NEAR(slices.first + (slices.count - 1) * slices.spacing, reach, 1.01 * slices.spacing) << octant;
    }
    // Anything but composite volumes needs rays.
    EXPECT_TRUE(drawnByProxy(scene));
    scene.layers.push_back({"", true, IsoLayer{.channel = "f"}});
    EXPECT_FALSE(drawnByProxy(scene));
    scene.layers[0].visible = false;
    EXPECT_TRUE(drawnByProxy(scene));
}

} // namespace
} // namespace tessera::vis
