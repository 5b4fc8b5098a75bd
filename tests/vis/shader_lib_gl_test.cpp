#include "tests/vis/shader_probe.h"
#include "vis/model/ray_setup.h"

#include <cmath>

/// Functions of vis/shaders/lib against their C++ twins.
namespace tessera {
namespace {

using ShaderLib = test::ShaderProbe;

TEST_F(ShaderLib, ColorsAreEncodedAlike) {
    const auto got =
        evaluate("#include \"lib/color.glsl\"\n", "vec4(srgbFromLinear(abs(a[i].rgb)), luminance(b[i].rgb))");
    for (int i = 0; i < kCases; ++i) {
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[i][k], vis::srgbFromLinear(std::abs(a[i][k])), 2e-6);
        EXPECT_NEAR(got[i].w, vis::luminance(glm::dvec3(b[i])), 1e-6);
    }
}

TEST_F(ShaderLib, OpacityIsCorrectedAlike) {
    const auto got = evaluate("#include \"lib/ray.glsl\"\n", "vec4(correctedOpacity(abs(a[i].x), 2.0 * abs(b[i].x)))");
    for (int i = 0; i < kCases; ++i)
        EXPECT_NEAR(got[i].x,
                    vis::correctedOpacity(std::abs(a[i].x), 2 * std::abs(double(b[i].x)) * vis::kReferenceLength, 1),
                    2e-6);
}

TEST_F(ShaderLib, RaysMeetTheBoxAlike) {
    const auto got = evaluate("#include \"lib/ray.glsl\"\n",
                              "vec4(clipToBox(a[i].xyz, normalize(b[i].xyz), abs(c[i].xyz) + 0.1), 0.0, 0.0)");
    int hits = 0;
    for (int i = 0; i < kCases; ++i) {
        const vis::Ray ray{glm::dvec3(a[i]), glm::normalize(glm::dvec3(b[i]))};
        const auto segment = vis::clipToBox(ray, glm::abs(glm::dvec3(c[i])) + 0.1, false);
        EXPECT_EQ(segment.has_value(), got[i].x < got[i].y) << i;
        if (!segment) continue;
        ++hits;
        EXPECT_NEAR(got[i].x, segment->enter, 1e-5 * (1 + std::abs(segment->enter)));
        EXPECT_NEAR(got[i].y, segment->exit, 1e-5 * (1 + std::abs(segment->exit)));
    }
    EXPECT_GT(hits, 10);
    EXPECT_LT(hits, kCases);
}

TEST_F(ShaderLib, PhongShadesAlike) {
    const vis::RenderParams params;
    const auto got =
        evaluate("#include \"lib/phong.glsl\"\n",
                 "vec4(phong(abs(a[i].rgb), i == 0 ? vec3(0.0) : b[i].xyz, abs(a[i].w), normalize(c[i].xyz), "
                 "normalize(c[i].zwy), vec4(0.25, 0.65, 0.25, 30.0)), 1.0)");
    for (int i = 0; i < kCases; ++i) {
        const glm::dvec3 gradient = i == 0 ? glm::dvec3(0) : glm::dvec3(b[i]);
        const glm::dvec3 expected =
            vis::phong(glm::abs(glm::dvec3(a[i])), gradient, std::abs(a[i].w), glm::normalize(glm::dvec3(c[i])),
                       glm::normalize(glm::dvec3(c[i].z, c[i].w, c[i].y)), params);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[i][k], expected[k], 2e-5) << i;
    }
}

} // namespace
} // namespace tessera
