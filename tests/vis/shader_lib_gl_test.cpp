#include "tests/vis/shader_probe.h"
#include "vis/model/ray_setup.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <vector>

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

TEST_F(ShaderLib, DirectionsAreQuantizedAlike) {
    const auto got =
        evaluate("#include \"lib/octahedral.glsl\"\n",
                 "vec4(quantizedDirection(a[i].xyz, 7), i == 0 ? length(quantizedDirection(vec3(0.0), 7)) : "
                 "0.0)");
    double worst = 0;
    for (int i = 0; i < kCases; ++i) {
        const glm::dvec3 v(a[i]), expected = vis::quantizedDirection(v, 7);
        EXPECT_LT(glm::length(glm::dvec3(got[i]) - expected), 2e-6) << i;
        worst = std::max(worst, glm::degrees(std::acos(std::min(1.0, glm::dot(expected, glm::normalize(v))))));
    }
    EXPECT_LT(worst, 1.5) << "degrees, of 7 bits";
    EXPECT_GT(worst, 0.1);
    EXPECT_EQ(got[0].w, 0);
}

TEST_F(ShaderLib, TablesAreLookedUpAlike) {
    // Two rows of the transfer table (of one layer) and two pages of the plane table.
    constexpr int kSize = 2048, kPlane = 256;
    std::vector<glm::vec4> table, planes;
    for (int row = 0; row < 2; ++row)
        for (int x = 0; x < kSize; ++x) table.emplace_back(x % 7, row, float(x) / kSize, x > 1000 ? 0.5 : 0);
    for (int y = 0; y < 2 * kPlane; ++y)
        for (int x = 0; x < kPlane; ++x) planes.emplace_back(0.5f * glm::vec3(x, y % kPlane, y / kPlane), 0.5f);
    const vis::Texture first = vis::makeTexture2D({kSize, 2}, GL_RGBA32F, GL_NEAREST, "table");
    const vis::Texture second = vis::makeTexture2D({kPlane, 2 * kPlane}, GL_RGBA32F, GL_LINEAR, "planes");
    glTextureSubImage2D(first.name(), 0, 0, 0, kSize, 2, GL_RGBA, GL_FLOAT, table.data());
    glTextureSubImage2D(second.name(), 0, 0, 0, kPlane, 2 * kPlane, GL_RGBA, GL_FLOAT, planes.data());
    vis::ProgramRecipe recipe;
    recipe.defines = {{"FIELDS", "1"}, {"LAYERS", "1"},       {"SLICES", "0"},
                      {"PLANES", "2"}, {"PLANE_SIZE", "256"}, {"TABLE_SIZE", "2048"}};
    const auto prepare = [&](const vis::Program& program) {
        program.set("transferTable", 1);
        program.set("planeTable", 2);
        glBindTextureUnit(1, first.name());
        glBindTextureUnit(2, second.name());
    };
    const std::string bindings = "#include \"lib/bindings.glsl\"\n";
    const auto row = evaluate(bindings, "transfer(0, 1.5 * a[i].x)", recipe, prepare);
    const auto opaque = evaluate(bindings, "vec4(opaqueAt(0, a[i].x) ? 1.0 : 0.0)", recipe, prepare);
    const auto plane = evaluate(bindings, "planeAt(1, 1.5 * a[i].xy)", recipe, prepare);
    for (int i = 0; i < kCases; ++i) {
        const double u = std::clamp(1.5 * double(a[i].x), 0.0, 1.0) * (kSize - 1), below = std::floor(u);
        const auto at = std::size_t(below), next = std::min(at + 1, std::size_t(kSize - 1));
        const glm::dvec4 expected = glm::mix(glm::dvec4(table[at]), glm::dvec4(table[next]), u - below);
        EXPECT_LT(glm::length(glm::dvec4(row[i]) - expected), 5e-3) << i; // 7 steps an entry: the place has 1e-7
        const glm::dvec2 place = glm::clamp(1.5 * glm::dvec2(a[i]), 0.0, 1.0) * double(kPlane - 1);
        EXPECT_NEAR(plane[i].x, place.x, 1e-2) << i;
        EXPECT_NEAR(plane[i].y, place.y, 1e-2) << i;
        EXPECT_NEAR(plane[i].z, 1, 1e-5) << "pages do not mix, " << i;
        EXPECT_EQ(plane[i].w, 0.5f);
        EXPECT_EQ(opaque[i].x, a[i].x * (kSize - 1) >= 1001 ? 1 : 0) << a[i].x * (kSize - 1);
    }
}

} // namespace
} // namespace tessera
