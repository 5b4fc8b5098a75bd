#include "tests/vis/shader_probe.h"
#include "vis/gl/driver.h"
#include "vis/optics/look_shading.h"
#include "vis/optics/ray_setup.h"
#include "vis/raycast/look_uniforms.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

/// lib/shading/look.glsl, lib/shading/grain.glsl and lib/shading/paper.glsl against their C++ twins.
namespace tessera {
namespace {

class LookLib : public test::ShaderProbe {
protected:
    /// The sample of case i: the same in both languages.
    static constexpr const char* kHead =
        "#include \"lib/shading/look.glsl\"\n"
        "LookSample at(vec4 a, vec4 b) { return LookSample(a.x, abs(a.y), abs(a.z), abs(a.w) * 1.2, 40.0 * abs(b.x), "
        "abs(b.y), 0.005, 1.0, 0.0, 10.0 * abs(b.x), vec3(0.0), vec3(0.0), vec3(0.0)); }\n";
    vis::LookSample sample(int i) const {
        vis::LookSample out;
        const double facing = std::abs(a[i].y);
        out.at.normal = {std::sqrt(1 - facing * facing), 0, facing};
        out.at.toViewer = {0, 0, 1};
        // n.l = a.x on the side that is seen.
        out.toLight = glm::dvec3(out.at.normal) * double(a[i].x);
        out.weight = std::abs(a[i].z);
        out.steepness = std::abs(a[i].w) * 1.2;
        out.curvature = 40 * std::abs(b[i].x);
        out.depth = std::abs(b[i].y);
        out.pixel = 0.005;
        out.cut = 10 * std::abs(b[i].x);
        const glm::dvec4 grain = glm::abs(glm::dvec4(b[i].z, b[i].w, b[i].x, b[i].y));
        out.grain = {grain.x, grain.y, grain.z, grain.w};
        return out;
    }
};

TEST_F(LookLib, EnhancementsAgree) {
    const auto got = evaluate(kHead, "vec4(boundaryFactor(vec3(0.2, 2.0, 1.5), at(a[i], b[i])), "
                                     "silhouetteFactor(vec3(0.1, 3.0, 2.5), at(a[i], b[i])), "
                                     "outline(abs(a[i].y), 40.0 * abs(b[i].x), 0.01), lightStep(a[i].x, 4))");
    for (int i = 0; i < kCases; ++i) {
        vis::Look boundary, silhouette;
        boundary.boundary = vis::BoundaryEnhancement{.retained = 0.2f, .strength = 2, .exponent = 1.5f};
        silhouette.silhouette = vis::SilhouetteEnhancement{.retained = 0.1f, .strength = 3, .exponent = 2.5f};
        EXPECT_NEAR(got[i].x * 0.1, vis::lookOpacity(boundary, 0.1, sample(i)), 2e-6) << i;
        EXPECT_NEAR(got[i].y * 0.1, vis::lookOpacity(silhouette, 0.1, sample(i)), 2e-6) << i;
        EXPECT_NEAR(got[i].z, vis::outline<double>(std::abs(a[i].y), 40 * std::abs(b[i].x), 0.01), 2e-5) << i;
        EXPECT_EQ(got[i].w, float(vis::lightStep(double(a[i].x), 4))) << i;
    }
}

TEST_F(LookLib, WiresAgree) {
    const auto got =
        evaluate(kHead, "vec4(wireCoverage(a[i].xyz, normalize(b[i].xyz + 0.01), vec3(0.0, 0.0, 1.0), 0.1, "
                        "2.0, 0.004), 0.0, 0.0, 0.0)");
    int differ = 0, lines = 0;
    for (int i = 0; i < kCases; ++i) {
        const glm::dvec3 normal = glm::normalize(glm::dvec3(b[i]) + 0.01);
        const double wanted = vis::wireCoverage(glm::dvec3(a[i]), normal, {0, 0, 1}, 0.1, 2, 0.004);
        differ += std::abs(got[i].x - wanted) > 2e-3; // far along the view a coordinate runs through a line in no time
        lines += wanted > 0.5;
    }
    EXPECT_LE(differ, 2);
    EXPECT_GT(lines, 2);
}

/// And the line along a cut is as wide as asked for, at any tilt of the surface.
TEST_F(LookLib, CutsAgree) {
    const glm::dvec3 half(0.9, 0.7, 0.8);
    const auto got = evaluate(kHead, "vec4(cutDistance(a[i].xyz, normalize(b[i].xyz + 0.01), normalize(c[i].xyz + "
                                     "vec3(0.0, 0.0, 2.0)), vec3(0.9, 0.7, 0.8), 0.004), cutLine(3.0 * abs(a[i].x), "
                                     "2.0), 0.0, 0.0)");
    int near = 0;
    for (int i = 0; i < kCases; ++i) {
        const glm::dvec3 place(a[i]), normal = glm::normalize(glm::dvec3(b[i]) + 0.01);
        const glm::dvec3 viewer = glm::normalize(glm::dvec3(c[i]) + glm::dvec3(0, 0, 2));
        const double wanted = vis::cutDistance(place, normal, viewer, half, 0.004);
        EXPECT_NEAR(got[i].x, wanted, 0.01 + 1e-4 * wanted) << i;
        EXPECT_NEAR(got[i].y, vis::cutLine<double>(3 * std::abs(double(a[i].x)), 2), 1e-5);
        near += wanted < 100;
    }
    EXPECT_GT(near, 5);
    for (const double tilt :
         {-1.1, -0.3, 0.4, 1.2}) { // a plane that x = 0.9 cuts, seen along z, 7 pixels beside the cut
        const glm::dvec3 normal(std::sin(tilt), 0, std::cos(tilt));
        EXPECT_NEAR(vis::cutDistance(glm::dvec3(0.9 - 7 * 0.004, 0, 0), normal, {0, 0, 1}, half, 0.004), 7, 1e-9);
    }
    EXPECT_GE(vis::cutDistance(glm::dvec3(0, 0, 0.8), {0, 0, 1}, {0, 0, 1}, half, 0.004), 100) << "parallel to a face";
}

TEST_F(LookLib, InkAgrees) {
    for (const bool light : {false, true})
        for (const vis::Mark mark : {vis::Mark::Strokes, vis::Mark::Dots}) {
            vis::CharcoalDrawing charcoal{.mark = mark,
                                          .pressure = 0.93f,
                                          .bare = 0.1f,
                                          .steepness = 0.4f,
                                          .outline = 2.2f,
                                          .closure = 0.5f,
                                          .tooth = 0.8f,
                                          .crossing = 0.4f,
                                          .smudge = 0.3f};
            const auto got = evaluate(
                kHead, std::string("vec4(charcoalInk(charcoalDensity(abs(c[i].rgb), at(a[i], b[i]), vec4(0.9, 0.4, ") +
                           (light ? "1.0" : "0.0") + ", 0.1), vec3(2.2, 0.9, 0.5), 0.93), abs(b[i].zwxy), vec4(" +
                           std::to_string(vis::grainSoftness(charcoal)) + ", 0.7, 0.3, 0.93), vec2(0.4, 0.4), " +
                           (mark == vis::Mark::Dots ? "true" : "false") + "), 0.0, 0.0, 0.0)");
            double least = 1, most = 0;
            for (int i = 0; i < kCases; ++i) {
                const double ink = vis::charcoalInk(charcoal, glm::abs(glm::dvec3(c[i])), sample(i), light);
                EXPECT_NEAR(got[i].x, ink, 5e-5) << i;
                least = std::min(least, ink), most = std::max(most, ink);
                EXPECT_GE(ink, 0);
                EXPECT_LE(ink, 1);
            }
            EXPECT_LT(least, 0.2);
            EXPECT_GT(most, 0.8);
        }
}

/// Tone shading equals Gooch's ramp as a tint of the own colour.
TEST_F(LookLib, ToneIsItsFormula) {
    const auto got = evaluate("#include \"lib/shading/look.glsl\"\n",
                              "vec4(toned(abs(c[i].rgb), a[i].x, vec3(0.9, 0.6, 0.2), vec3(0.1, 0.2, 0.5), 0.4), 1.0)");
    for (int i = 0; i < kCases; ++i)
        for (int k = 0; k < 3; ++k) {
            const double warm[] = {0.9, 0.6, 0.2}, cool[] = {0.1, 0.2, 0.5}, l = a[i].x;
            const double expected =
                ((1 + l) / 2 * warm[k] + (1 - (1 + l) / 2) * cool[k]) * (0.6 + 0.4 * std::abs(double(c[i][k])));
            EXPECT_NEAR(got[i][k], expected, 2e-6) << i;
        }
}

/// Hue in degrees: the angle about the gray axis.
double hueOf(glm::dvec3 color) {
    return glm::degrees(std::atan2(std::sqrt(3.0) * (color.g - color.b), 2 * color.r - color.g - color.b));
}

/// In the light a material looks like itself, in the shade darker and cooler, and materials stay apart.
TEST(Tone, KeepsTheHueAndCoolsInTheShade) {
    vis::Look look = *vis::Look::preset("tone");
    const auto shown = [&](glm::dvec3 albedo, double light) {
        vis::LookSample at;
        at.at = {{0, 0, 1}, {0, 0, 1}, 1};
        at.toLight = glm::dvec3(std::sqrt(1 - light * light), 0, light);
        at.weight = 1;
        return vis::lookColor(look, albedo, albedo, at, glm::dvec3(1));
    };
    const glm::dvec3 skin(0.6, 0.32, 0.22), bone(0.75, 0.68, 0.55), leaf(0.12, 0.3, 0.06), steel(0.5, 0.55, 0.62);
    for (const glm::dvec3 albedo : {skin, leaf, glm::dvec3(0.5, 0.1, 0.1), glm::dvec3(0.1, 0.15, 0.6)}) {
        const double apart = std::abs(std::remainder(hueOf(shown(albedo, 1)) - hueOf(albedo), 360));
        EXPECT_LT(apart, 12) << "hue in the light";
        const double inShade = std::abs(std::remainder(hueOf(shown(albedo, -0.3)) - hueOf(albedo), 360));
        EXPECT_LT(inShade, 40) << "hue in the shade";
    }
    for (const glm::dvec3 albedo : {skin, bone, leaf, steel}) {
        const glm::dvec3 light = shown(albedo, 1), edge = shown(albedo, 0), shade = shown(albedo, -1);
        EXPECT_GT(edge.b / edge.r, 1.15 * light.b / light.r) << "cooler";
        EXPECT_GT(shade.b / shade.r, 1.5 * light.b / light.r);
        EXPECT_LT(vis::luminance(edge), 0.8 * vis::luminance(light)) << "and darker";
        EXPECT_GT(vis::luminance(shade), 0.15 * vis::luminance(light)) << "never black";
    }
}

TEST_F(LookLib, GrainAgrees) {
    vis::GrainTexture texture;
    const GLuint name = texture.get();
    const auto prepare = [&](const vis::Program& program) {
        program.set("tile", 1);
        program.set("grainPlaneCount", 3);
        glBindTextureUnit(1, name);
    };
    const std::string head =
        "#include \"lib/shading/grain.glsl\"\n#include \"lib/shading/paper.glsl\"\nuniform sampler2D tile;\n"
        "vec3 unit(vec4 v) { return normalize(v.xyz); }\n"
        "vec3 way(int i, vec4 n, vec4 c) { return strokeDirection(unit(n), c.yzw, 0.8, 0.3); }\n";
    vis::ProgramRecipe reads;
    vis::addDriver(reads, vis::currentDriver());
    const auto got = evaluate(
        head,
        "vec4(grainAt(tile, 0.5 * a[i].xyz, unit(b[i]), 0.004 + 0.003 * c[i].x, true), paperShade(tile, 300.0 * "
        "c[i].xy, "
        "0.8), strokesAt(tile, 0.5 * a[i].xyz, unit(b[i]), way(i, b[i], c[i]), 0.004 + 0.003 * c[i].x, 137.0, true))",
        reads, prepare);
    const auto ways = evaluate(head, "vec4(way(i, b[i], c[i]), 0.0)");
    const auto tile = vis::grainTile();
    double least = 1, most = 0;
    for (int i = 0; i < kCases; ++i) {
        const glm::dvec3 normal = glm::normalize(glm::dvec3(b[i])), place = 0.5 * glm::dvec3(a[i]);
        const double size = 0.004 + 0.003 * double(c[i].x);
        const glm::dvec2 expected = vis::grainAt(*tile, place, normal, size);
        EXPECT_NEAR(got[i].x, expected.x, 1e-3) << i;
        EXPECT_NEAR(got[i].y, expected.y, 2e-3) << i;
        EXPECT_NEAR(got[i].z, vis::paperShade(*tile, 300.0 * glm::dvec2(c[i]), 0.8), 1e-4) << i;
        const glm::dvec3 along = vis::strokeDirection(normal, glm::dvec3(c[i].y, c[i].z, c[i].w), 0.8, 0.3);
        EXPECT_LT(glm::length(glm::dvec3(ways[i]) - along), 1e-5) << i;
        EXPECT_NEAR(got[i].w, vis::strokesAt(*tile, place, normal, along, size, 137), 1e-3) << i;
        EXPECT_NEAR(glm::dot(along, normal), 0, 1e-9);
        least = std::min(least, expected.x), most = std::max(most, expected.x);
    }
    EXPECT_LT(least, 0.2);
    EXPECT_GT(most, 0.8);
}

/// No size of grain pops in: half a billionth before and behind a power of two it is the same.
TEST(Grain, ScalesAreFadedAndTonesAreSpread) {
    const auto tile = vis::grainTile();
    glm::dvec2 sum(0), squares(0);
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 place(std::sin(i * 1.7), std::cos(i * 2.3), std::sin(i * 0.9));
        const glm::dvec3 normal = glm::normalize(glm::dvec3(std::cos(i * 0.3), std::sin(i * 0.7), 0.5));
        const glm::dvec3 along = vis::strokeDirection(normal, glm::dvec3(0), 1, 0.1 * i);
        const auto at = [&](double size) {
            return glm::dvec2(vis::grainAt(*tile, place, normal, size).x,
                              vis::strokesAt(*tile, place, normal, along, size, 0));
        };
        const glm::dvec2 before = at(0.0078125 * (1 - 1e-9)), behind = at(0.0078125 * (1 + 1e-9));
        EXPECT_LT(glm::length(before - behind), 1e-6);
        const glm::dvec2 now = at(0.006 + 0.004 * (i % 10) / 10);
        sum += now;
        squares += now * now;
    }
    for (int k = 0; k < 2; ++k) {
        const double mean = sum[k] / 1000, deviation = std::sqrt(squares[k] / 1000 - mean * mean);
        EXPECT_NEAR(mean, 0.5, 0.05);
        EXPECT_NEAR(deviation, std::sqrt(1.0 / 12), 0.07) << "mixing planes and scales keeps the contrast";
    }
}

} // namespace
} // namespace tessera
