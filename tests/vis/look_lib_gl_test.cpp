#include "tests/vis/shader_probe.h"
#include "vis/optics/look_shading.h"
#include "vis/raycast/look_uniforms.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

/// lib/look.glsl, lib/grain.glsl and lib/paper.glsl against their C++ twins.
namespace tessera {
namespace {

class LookLib : public test::ShaderProbe {
protected:
    /// The sample of case i: the same in both languages.
    static constexpr const char* kHead =
        "#include \"lib/look.glsl\"\n"
        "LookSample at(vec4 a, vec4 b) { return LookSample(a.x, abs(a.y), abs(a.z), abs(a.w) * 1.2, 40.0 * abs(b.x), "
        "abs(b.y), 0.005, 1.0, 0.0, abs(b.zw)); }\n";
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
        out.grain = glm::abs(glm::dvec2(b[i].z, b[i].w));
        return out;
    }
};

TEST_F(LookLib, EnhancementsAgree) {
    const auto got = evaluate(kHead, "vec4(boundaryFactor(vec3(0.2, 2.0, 1.5), at(a[i], b[i])), "
                                     "silhouetteFactor(vec3(0.1, 3.0, 2.5), at(a[i], b[i])), "
                                     "outline(abs(a[i].y), 40.0 * abs(b[i].x), 0.01), lightStep(a[i].x, 4.0))");
    for (int i = 0; i < kCases; ++i) {
        vis::Look boundary, silhouette;
        boundary.boundary = vis::BoundaryEnhancement{.retained = 0.2f, .strength = 2, .exponent = 1.5f};
        silhouette.silhouette = vis::SilhouetteEnhancement{.retained = 0.1f, .strength = 3, .exponent = 2.5f};
        EXPECT_NEAR(got[i].x * 0.1, vis::lookOpacity(boundary, 0.1, sample(i)), 2e-6) << i;
        EXPECT_NEAR(got[i].y * 0.1, vis::lookOpacity(silhouette, 0.1, sample(i)), 2e-6) << i;
        EXPECT_NEAR(got[i].z, vis::outline(std::abs(a[i].y), 40 * std::abs(b[i].x), 0.01), 2e-5) << i;
        EXPECT_EQ(got[i].w, float(vis::lightStep(a[i].x, 4))) << i;
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

TEST_F(LookLib, InkAgrees) {
    for (const vis::Stick stick : {vis::Stick::Charcoal, vis::Stick::Chalk}) {
        vis::CharcoalDrawing charcoal;
        charcoal.stick = stick;
        charcoal.steepness = 0.4f;
        charcoal.smudge = 0.3f;
        const std::string chalk = stick == vis::Stick::Chalk ? "1.0" : "0.0";
        const auto got = evaluate(
            kHead,
            "vec4(charcoalInk(abs(c[i].rgb), at(a[i], b[i]), vec3(0.9, 0.4, " + chalk +
                "), vec3(2.2, 0.9, 0.5), vec4(" + std::to_string(vis::grainSoftness(charcoal)) +
                ", 0.7, 0.3, 0.93)), toned(abs(c[i].rgb), a[i].x, vec3(0.9, 0.6, 0.2), vec3(0.1, 0.2, 0.5), 0.4))");
        double least = 1, most = 0;
        for (int i = 0; i < kCases; ++i) {
            const double ink = vis::charcoalInk(charcoal, glm::abs(glm::dvec3(c[i])), sample(i));
            EXPECT_NEAR(got[i].x, ink, 5e-5) << i;
            least = std::min(least, ink), most = std::max(most, ink);
            EXPECT_GE(ink, 0);
            EXPECT_LE(ink, 1);
        }
        EXPECT_LT(least, 0.2);
        EXPECT_GT(most, 0.8);
    }
}

/// Tone shading equals Gooch's formula with the own colour added where light falls.
TEST_F(LookLib, ToneIsItsFormula) {
    const auto got = evaluate("#include \"lib/look.glsl\"\n",
                              "vec4(toned(abs(c[i].rgb), a[i].x, vec3(0.9, 0.6, 0.2), vec3(0.1, 0.2, 0.5), 0.4), 1.0)");
    for (int i = 0; i < kCases; ++i)
        for (int k = 0; k < 3; ++k) {
            const double warm[] = {0.9, 0.6, 0.2}, cool[] = {0.1, 0.2, 0.5}, l = a[i].x;
            const double expected = (1 + l) / 2 * warm[k] + (1 - (1 + l) / 2) * cool[k] +
                                    0.4 * std::max(l, 0.0) * std::abs(double(c[i][k]));
            EXPECT_NEAR(got[i][k], expected, 2e-6) << i;
        }
}

TEST_F(LookLib, GrainAgrees) {
    vis::GrainTexture texture;
    const GLuint name = texture.get();
    const auto prepare = [&](const vis::Program& program) {
        program.set("tile", 1);
        glBindTextureUnit(1, name);
    };
    const std::string head = "#include \"lib/grain.glsl\"\n#include \"lib/paper.glsl\"\nuniform sampler2D tile;\n";
    const auto got = evaluate(head,
                              "vec4(grainAt(tile, 0.5 * a[i].xyz, normalize(b[i].xyz), 0.004 + 0.003 * c[i].x, "
                              "vec2(cos(0.5), sin(0.5))), paperShade(tile, 300.0 * c[i].xy, 0.8), 0.0)",
                              {}, prepare);
    const auto tile = vis::grainTile();
    double least = 1, most = 0;
    for (int i = 0; i < kCases; ++i) {
        const glm::dvec2 expected = vis::grainAt(*tile, 0.5 * glm::dvec3(a[i]), glm::normalize(glm::dvec3(b[i])),
                                                 0.004 + 0.003 * double(c[i].x), glm::degrees(0.5));
        EXPECT_NEAR(got[i].x, expected.x, 1e-3) << i;
        EXPECT_NEAR(got[i].y, expected.y, 1e-3) << i;
        EXPECT_NEAR(got[i].z, vis::paperShade(*tile, 300.0 * glm::dvec2(c[i]), 0.8), 1e-4) << i;
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
        const glm::dvec2 before = vis::grainAt(*tile, place, normal, 0.0078125 * (1 - 1e-9), 0),
                         behind = vis::grainAt(*tile, place, normal, 0.0078125 * (1 + 1e-9), 0);
        EXPECT_NEAR(before.x, behind.x, 1e-6);
        const glm::dvec2 now = vis::grainAt(*tile, place, normal, 0.006 + 0.004 * (i % 10) / 10, 0);
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
