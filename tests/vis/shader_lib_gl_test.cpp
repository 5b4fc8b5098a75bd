#include "tests/vis/shader_probe.h"
#include "vis/formulas/colors.h"
#include "vis/gl/driver.h"
#include "vis/optics/jitter.h"
#include "vis/optics/ray_setup.h"
#include "vis/optics/surface_light.h"
#include "vis/raycast/ray_tables.h"
#include "vis/scene/clipping.h"
#include "vis/scene/tone.h"

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
        evaluate("#include \"lib/layers/color.glsl\"\n", "vec4(srgbFromLinear(abs(a[i].rgb)), luminance(b[i].rgb))");
    for (int i = 0; i < kCases; ++i) {
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[i][k], vis::srgbFromLinear(double(std::abs(a[i][k]))), 2e-6);
        EXPECT_NEAR(got[i].w, vis::luminance(glm::dvec3(b[i])), 1e-6);
    }
}

TEST_F(ShaderLib, OpacityIsCorrectedAlike) {
    const auto got =
        evaluate("#include \"lib/sampling/ray.glsl\"\n", "vec4(correctedOpacity(abs(a[i].x), 2.0 * abs(b[i].x)))");
    for (int i = 0; i < kCases; ++i)
        EXPECT_NEAR(got[i].x,
                    vis::correctedOpacity(std::abs(a[i].x), 2 * std::abs(double(b[i].x)) * vis::kReferenceLength, 1),
                    2e-6);
}

TEST_F(ShaderLib, RaysMeetTheBoxAlike) {
    const auto got = evaluate("#include \"lib/sampling/ray.glsl\"\n",
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

TEST_F(ShaderLib, BodiesCutRaysAlike) {
    for (int kind = 0; kind < 4; ++kind) {
        const auto got = evaluate("#include \"lib/sampling/clip.glsl\"\n",
                                  "vec4(clipInside(" + std::to_string(kind) +
                                      ", a[i].xyz, normalize(b[i].xyz), abs(c[i].xyz) + 0.1, 2.0 * b[i].wxy, "
                                      "normalize(c[i].wzy)), 0.0, 0.0)");
        int hits = 0;
        for (int i = 0; i < kCases; ++i) {
            const vis::PlacedClip clip{vis::ClipKind(kind), false, glm::dvec3(a[i]), glm::normalize(glm::dvec3(b[i])),
                                       glm::abs(glm::dvec3(c[i])) + 0.1};
            const vis::Ray ray{2.0 * glm::dvec3(b[i].w, b[i].x, b[i].y),
                               glm::normalize(glm::dvec3(c[i].w, c[i].z, c[i].y))};
            const vis::RaySegment expected = clip.inside(ray);
            EXPECT_EQ(expected.enter < expected.exit, got[i].x < got[i].y) << kind << ' ' << i;
            if (expected.enter >= expected.exit) continue;
            ++hits;
            EXPECT_NEAR(got[i].x, expected.enter, 2e-4 * (1 + std::abs(expected.enter)));
            EXPECT_NEAR(got[i].y, expected.exit, 2e-4 * (1 + std::abs(expected.exit)));
            // What is inside by the interval is inside by the point's test.
            if (expected.enter > -1e5 && expected.exit < 1e5) {
                EXPECT_TRUE(clip.contains(ray.origin + ray.direction * (0.5 * (expected.enter + expected.exit))));
                EXPECT_FALSE(clip.contains(ray.origin + ray.direction * (expected.exit + 1e-6)));
            }
        }
        EXPECT_GT(hits, 5) << kind;
    }
}

TEST_F(ShaderLib, StartsAreShiftedAlikeAndSpread) {
    const auto got = evaluate("#include \"lib/sampling/jitter.glsl\"\n",
                              "vec4(startJitter(uvec2(i % 8, i / 8), 0u), startJitter(uvec2(i * 977, 5), 3u), 0, 0)");
    double sum = 0, worst = 1;
    for (int i = 0; i < kCases; ++i) {
        EXPECT_EQ(got[i].x, float(vis::startJitter(std::uint32_t(i % 8), std::uint32_t(i / 8), 0)));
        EXPECT_EQ(got[i].y, float(vis::startJitter(std::uint32_t(i * 977), 5, 3)));
        EXPECT_LE(std::abs(got[i].x), 0.5);
        sum += double(got[i].x);
        if (i % 8 > 0) worst = std::min(worst, std::abs(double(got[i].x) - double(got[i - 1].x)));
    }
    EXPECT_NEAR(sum / kCases, 0, 0.05);
    EXPECT_GT(worst, 0.15) << "neighbours start alike";
}

TEST_F(ShaderLib, ContoursAreDrawnAlike) {
    const auto got = evaluate("#include \"formulas/colors.glsl\"\n",
                              "vec4(withContours(abs(a[i].rgb), 6.0 * b[i].x, 0.4 * c[i].x, 4), 1.0)");
    int drawn = 0;
    for (int i = 0; i < kCases; ++i) {
        const glm::dvec3 color = glm::abs(glm::dvec3(a[i]));
        const glm::dvec3 wanted = vis::withContours<double>(color, 6 * double(b[i].x), 0.4 * double(c[i].x), 4);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[i][k], wanted[k], 1e-4) << i;
        drawn += glm::length(wanted - color) > 0.1;
    }
    EXPECT_GT(drawn, 3);
    EXPECT_LT(drawn, kCases - 3);
}

TEST_F(ShaderLib, TonesAreMappedAlike) {
    for (int curve = 0; curve < 3; ++curve) {
        const vis::Tone tone{vis::ToneCurve(curve), 1.5f, 3};
        const auto got =
            evaluate("#include \"lib/shading/tone.glsl\"\n",
                     "vec4(toneMap(3.0 * abs(a[i].rgb), " + std::to_string(curve) + ", exp2(1.5), 3.0), 1.0)");
        for (int i = 0; i < kCases; ++i) {
            const glm::dvec3 expected = vis::toneMap(3.0 * glm::abs(glm::dvec3(a[i])), tone);
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[i][k], expected[k], 1e-5);
        }
    }
    const vis::Tone reinhard{vis::ToneCurve::Reinhard, 0, 4};
    EXPECT_NEAR(vis::toneMap(glm::dvec3(4), reinhard).x, 1, 1e-12);
    for (double light = 0; light < 4; light += 0.1)
        EXPECT_LT(vis::toneMap(glm::dvec3(light), reinhard).x, vis::toneMap(glm::dvec3(light + 0.1), reinhard).x);
}

/// The same place for both languages: gradient b, viewer c.xyz, light c.zwy, surface of default parameters.
TEST_F(ShaderLib, SurfacesAreLitAlike) {
    for (const vis::LightModel model : {vis::LightModel::Phong, vis::LightModel::Physical})
        for (const float metalness : {0.0f, 0.6f}) {
            vis::Lighting surface;
            surface.model = model;
            surface.metalness = metalness;
            const bool phong = model == vis::LightModel::Phong;
            const std::string values = phong              ? "vec4(0.25, 0.65, 0.25, 30.0)"
                                       : metalness > 0.0f ? "vec4(0.25, 0.4, 0.6, 0.04)"
                                                          : "vec4(0.25, 0.4, 0.0, 0.04)";
            const auto got =
                evaluate("#include \"lib/shading/lighting.glsl\"\n"
                         "vec3 lit(Facing at, vec3 albedo, vec3 toLight) { const vec4 surface = " +
                             values + "; vec3 d, s; " +
                             (phong ? "return phongLight(at, albedo, toLight, surface); }\n"
                                    : "physicalEvenLight(at, albedo, surface, d, s); "
                                      "return physicalLight(at, albedo, d, toLight, surface); }\n"),
                         "vec4(lit(facing(b[i].xyz, normalize(c[i].xyz)), abs(a[i].rgb), normalize(c[i].zwy)), "
                         "facing(b[i].xyz, normalize(c[i].xyz)).front)");
            for (int i = 0; i < kCases; ++i) {
                const vis::Facing at = vis::facing(glm::dvec3(b[i]), glm::normalize(glm::dvec3(c[i])));
                const glm::dvec3 toLight = glm::normalize(glm::dvec3(c[i].z, c[i].w, c[i].y));
                const glm::dvec3 albedo = glm::abs(glm::dvec3(a[i]));
                const glm::dvec3 expected =
                    phong ? vis::phongLight(at, albedo, toLight, surface)
                          : vis::physicalLight(at, albedo, vis::evenLight(at, albedo, surface), toLight, surface);
                for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[i][k], expected[k], 2e-5) << i;
                EXPECT_NEAR(got[i].w, at.front, 2e-5);
            }
        }
}

TEST_F(ShaderLib, EvenLightIsReflectedAlike) {
    vis::Lighting surface;
    surface.model = vis::LightModel::Physical;
    surface.metalness = 0.3f;
    const auto got = evaluate("#include \"lib/shading/lighting.glsl\"\n"
                              "vec3 both(vec3 albedo, vec3 g, vec3 v) { vec3 d, s; physicalEvenLight(facing(g, v), "
                              "albedo, vec4(0.25, 0.4, 0.3, 0.04), d, s); return d + 2.0 * s; }\n",
                              "vec4(both(abs(a[i].rgb), b[i].xyz, normalize(c[i].xyz)), 0.0)");
    for (int i = 0; i < kCases; ++i) {
        const vis::Facing at = vis::facing(glm::dvec3(b[i]), glm::normalize(glm::dvec3(c[i])));
        const vis::Reflected expected = vis::evenLight(at, glm::abs(glm::dvec3(a[i])), surface);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[i][k], expected.diffuse[k] + 2 * expected.specular[k], 2e-5) << i;
    }
}

TEST_F(ShaderLib, DirectionsAreQuantizedAlike) {
    const auto got =
        evaluate("#include \"lib/sampling/octahedral.glsl\"\n",
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
    const vis::Texture first = vis::makeTexture1DArray(kSize, 2, GL_RGBA32F, GL_LINEAR, "table");
    const vis::Texture second = vis::makeTexture2D({kPlane, 2 * kPlane}, GL_RGBA32F, GL_LINEAR, "planes");
    glTextureSubImage2D(first.name(), 0, 0, 0, kSize, 2, GL_RGBA, GL_FLOAT, table.data());
    glTextureSubImage2D(second.name(), 0, 0, 0, kPlane, 2 * kPlane, GL_RGBA, GL_FLOAT, planes.data());
    vis::ProgramRecipe recipe;
    recipe.defines = {{"FIELDS", "1"},       {"LAYERS", "1"},        {"SLICES", "0"},     {"PLANES", "2"},
                      {"PLANE_SIZE", "256"}, {"TABLE_SIZE", "2048"}, {"TABLE_ROWS", "1"}, {"TABLE_ROW(i)", "(i)"}};
    recipe.defines.emplace_back("LAYER_INTERVAL(i)", "0");
    vis::addDriver(recipe, vis::currentDriver());
    const auto prepare = [&](const vis::Program& program) {
        program.set("transferTable", 1);
        program.set("planeTable", 2);
        glBindTextureUnit(1, first.name());
        glBindTextureUnit(2, second.name());
    };
    const std::string bindings = "#include \"lib/bindings/bindings.glsl\"\n#include \"lib/bindings/tables.glsl\"\n";
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
    // What the same entries say as an interval.
    recipe.defines.back().second = "1";
    const auto within = evaluate(bindings, "vec4(opaqueAt(0, a[i].x) ? 1.0 : 0.0)", recipe, [&](const auto& program) {
        prepare(program);
        vis::RayPlan plan;
        plan.layers.resize(1);
        plan.rows = 1;
        program.set("layerOpaque", std::vector<glm::vec2>{*vis::opaqueIntervals(plan, table).front()});
    });
    for (int i = 0; i < kCases; ++i) EXPECT_EQ(within[i].x, opaque[i].x) << a[i].x;
}

} // namespace
} // namespace tessera
