#include "vis/optics/ray_setup.h"
#include "vis/processor/presented.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <random>

/// Pictures of the processor as they are shown.
namespace tessera::vis {
namespace {

constexpr glm::ivec2 kShownSize(53, 31); // no multiple of a packet
constexpr packet::PixelBox kHeld{{5, 3}, {41, 29}}, kShown{{2, 1}, {52, 30}};

packet::PacketPicture randomPicture() {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> share(0, 1);
    packet::PacketPicture picture{.box = {}, .rgba = {}};
    picture.begin(kShownSize, kHeld, false);
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
        picture.rgba[i + 3] = i % 44 == 0 ? 0 : share(random);
        for (std::size_t c = 0; c < 3; ++c) // some are darker than the curve of sRGB begins, some are too bright
            picture.rgba[i + c] = picture.rgba[i + 3] * share(random) * (i % 52 == 0 ? 0.004f : 1.3f);
    }
    return picture;
}

BoxLines someLines() {
    return {{{1, 2, 50, 2.4f},
             {4, 1, 4.2f, 30},
             {5e9f, -1e9f, 6e9f, 1e9f},
             {-20, -30, 70, 45},
             {20, 10, 20, 10},
             {45, 28, 12, 6}},
            2};
}

/// Coverage of a pixel by lines [begin, end), one after the other.
double coveredBy(const BoxLines& lines, std::size_t begin, std::size_t end, glm::dvec2 pixel) {
    double covered = 0;
    for (std::size_t i = begin; i < end; ++i) {
        const glm::dvec4 line(lines.edges[i]);
        const glm::dvec2 from(line.x, line.y), along = glm::dvec2(line.z, line.w) - from;
        const double t = glm::clamp(glm::dot(pixel - from, along) / std::max(glm::dot(along, along), 1e-6), 0.0, 1.0);
        covered = std::max(covered, kBoxLineWidth / 2 + 0.5 - glm::length(pixel - from - t * along));
    }
    return std::min(covered, 1.0);
}

/// What vis/shaders/resolve.frag.glsl says of a pixel, 0..255.
glm::dvec4 shownPixel(const packet::PacketPicture& picture, const Scene& scene, const BoxLines& lines, glm::ivec2 at) {
    glm::dvec4 seen(0);
    const glm::ivec2 in = at - kHeld.begin;
    if (in.x >= 0 && in.y >= 0 && at.x < kHeld.end.x && at.y < kHeld.end.y)
        for (int c = 0; c < 4; ++c)
            seen[c] = double(picture.rgba[std::size_t(4 * (in.y * kHeld.extent().x + in.x) + c)]);
    const std::size_t all = lines.edges.size(), front = all - std::size_t(lines.front);
    const glm::dvec2 middle = glm::dvec2(at) + 0.5;
    const double behind = coveredBy(lines, 0, front, middle), before = coveredBy(lines, front, all, middle);
    const glm::dvec3 ground = linearFromSrgb(glm::dvec3(groundColor(scene))),
                     ink = linearFromSrgb(glm::dvec3(scene.boxColor));
    glm::dvec4 out;
    if (scene.showGround) {
        const glm::dvec3 color = glm::dvec3(seen) + (1 - seen.a) * glm::mix(ground, ink, behind);
        out = glm::dvec4(glm::mix(color, ink, before), 1);
    } else {
        out = seen + (1 - seen.a) * glm::dvec4(ink * behind, behind);
        out = glm::mix(out, glm::dvec4(ink, 1), before);
        out = glm::dvec4(glm::dvec3(out) / std::max(out.a, 1e-6), out.a);
    }
    for (int c = 0; c < 3; ++c) out[c] = srgbFromLinear(glm::clamp(out[c], 0.0, 1.0));
    return out * 255.0;
}

TEST(Presented, IsThePictureOverTheGroundWithTheBox) {
    const packet::PacketPicture picture = randomPicture();
    Scene scene;
    scene.background = {0.1f, 0.5f, 0.9f};
    scene.boxColor = {0.9f, 0.8f, 0.2f};
    EXPECT_TRUE(presentsPlainly(scene));
    for (const packet::InstructionSet set : packet::instructionSets())
        for (const bool ground : {true, false})
            for (const bool box : {true, false}) {
                scene.showGround = ground;
                const BoxLines lines = box ? someLines() : BoxLines{};
                const std::vector<std::uint8_t> out = presented(picture, kShown, scene, lines, set);
                ASSERT_EQ(out.size(), std::size_t(4 * kShown.extent().x * kShown.extent().y));
                std::size_t i = 0;
                for (int y = kShown.begin.y; y < kShown.end.y; ++y)
                    for (int x = kShown.begin.x; x < kShown.end.x; ++x, i += 4) {
                        const glm::dvec4 wanted = shownPixel(picture, scene, lines, {x, y});
                        for (int c = 0; c < 4; ++c)
                            ASSERT_NEAR(double(out[i + std::size_t(c)]), wanted[c], 0.502)
                                << x << " " << y << " " << c << " " << int(set);
                    }
            }
}

TEST(Presented, TonesAreMappedBeforeTheGround) {
    const packet::PacketPicture picture = randomPicture();
    Scene scene;
    scene.background = {0.1f, 0.5f, 0.9f};
    scene.tone.curve = ToneCurve::Reinhard;
    EXPECT_FALSE(presentsPlainly(scene));
    const std::vector<std::uint8_t> out = presented(picture, kShown, scene, {});
    std::size_t i = 0;
    for (int y = kShown.begin.y; y < kShown.end.y; ++y)
        for (int x = kShown.begin.x; x < kShown.end.x; ++x, i += 4) {
            packet::PacketPicture mapped = picture;
            const glm::ivec2 in = glm::ivec2(x, y) - kHeld.begin;
            if (in.x < 0 || in.y < 0 || x >= kHeld.end.x || y >= kHeld.end.y) continue;
            const std::size_t at = std::size_t(4 * (in.y * kHeld.extent().x + in.x));
            const double a = std::max(double(picture.rgba[at + 3]), 1e-6);
            const glm::dvec3 light(picture.rgba[at], picture.rgba[at + 1], picture.rgba[at + 2]);
            const glm::dvec3 tone = toneMap(light / a, scene.tone) * double(picture.rgba[at + 3]);
            for (int c = 0; c < 3; ++c) mapped.rgba[at + std::size_t(c)] = float(tone[c]);
            const glm::dvec4 wanted = shownPixel(mapped, scene, {}, {x, y});
            for (int c = 0; c < 4; ++c) ASSERT_NEAR(double(out[i + std::size_t(c)]), wanted[c], 0.502);
        }
}

} // namespace
} // namespace tessera::vis
