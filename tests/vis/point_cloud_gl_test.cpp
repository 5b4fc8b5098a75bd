#include "vis/passes/point_cloud.h"

#include "tests/vis/gl_fixture.h"
#include "vis/gl/handles.h"
#include "vis/optics/ray_setup.h"
#include "vis/passes/stereo_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

namespace tessera::vis {
namespace {

class PointCloudTest : public test::GlTest {
protected:
    static constexpr glm::ivec2 kSize{200, 120};

    std::vector<glm::vec4> picture(std::span<const CloudPoint> points, CloudView view) {
        view.size = kSize;
        cloud.upload(TexturesIn::OpenGl, points);
        const auto texture = GLuint(cloud.draw(view));
        std::vector<std::uint8_t> bytes(std::size_t(kSize.x * kSize.y * 4));
        glGetTextureImage(texture, 0, GL_RGBA, GL_UNSIGNED_BYTE, GLsizei(bytes.size()), bytes.data());
        std::vector<glm::vec4> out;
        for (std::size_t i = 0; i < bytes.size(); i += 4)
            out.emplace_back(glm::vec4(bytes[i], bytes[i + 1], bytes[i + 2], bytes[i + 3]) / 255.0f);
        return out;
    }
    /// Middle of what is not background, in pixels from the lower left.
    static glm::dvec2 centroid(const std::vector<glm::vec4>& pixels) {
        glm::dvec2 sum(0);
        double weight = 0;
        for (int y = 0; y < kSize.y; ++y)
            for (int x = 0; x < kSize.x; ++x) {
                const double own = double(pixels[std::size_t(y * kSize.x + x)].r);
                sum += own * glm::dvec2(x + 0.5, y + 0.5);
                weight += own;
            }
        return sum / weight;
    }
    PointCloud cloud;
};

TEST_F(PointCloudTest, SplatsLieWhereTheProjectionSays) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> angle(-180, 180), place(-0.5, 0.5);
    for (int trial = 0; trial < 20; ++trial) {
        CloudView view;
        view.rotation = rotationOf({angle(random), angle(random), angle(random), angle(random), angle(random), 40});
        view.projection.eye = trial % 2 == 0 ? 1.2 : 3;
        view.radiusPixels = 4;
        const CloudPoint point{glm::vec4(place(random), place(random), place(random), place(random)), glm::vec4(1)};
        const Projected4 at =
            project(view.projection, 1, firstFour(view.rotation * pointOf(glm::dvec4(point.position))));
        const glm::dvec2 wanted = glm::dvec2(kSize) * 0.5 + at.at * 0.5 * double(kSize.y);
        const glm::dvec2 found = centroid(picture({&point, 1}, view));
        EXPECT_LT(glm::length(found - wanted), 0.35) << trial;
    }
}

TEST_F(PointCloudTest, TheOrderOfThePointsDoesNotMatter) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> place(-0.5f, 0.5f), shade(0, 1);
    std::vector<CloudPoint> points(3000);
    for (CloudPoint& point : points) {
        point.position = {place(random), place(random), place(random), place(random)};
        point.color = {shade(random), shade(random), shade(random), 0.3f};
    }
    CloudView view;
    view.rotation = rotationOf({10, 20, 30, 40, 50, 60});
    const auto first = picture(points, view);
    std::shuffle(points.begin(), points.end(), random);
    // Half floats add up in another order.
    EXPECT_LT(test::maxDifference(first, picture(points, view)), 0.03);
}

TEST_F(PointCloudTest, NearSplatsCountForMoreAndTheBackgroundShowsThrough) {
    CloudView view;
    view.radiusPixels = 8;
    view.background = {0, 0, 1};
    const std::size_t middle = std::size_t(kSize.y / 2 * kSize.x + kSize.x / 2);
    const CloudPoint near{{0, 0, 0.5f, 0}, {1, 0, 0, 0.6f}}, far{{0, 0, -0.5f, 0}, {0, 1, 0, 0.6f}};
    const CloudPoint both[] = {near, far};
    const glm::vec4 seen = picture(both, view)[middle];
    EXPECT_GT(seen.r, seen.g);
    // 1 - (1 - a)^2 of the background is covered, in linear light.
    EXPECT_NEAR(seen.b, srgbFromLinear(0.4 * 0.4), 0.03);
    EXPECT_EQ(picture({}, view)[middle], glm::vec4(0, 0, 1, 1));
    EXPECT_EQ(picture(both, view)[0], glm::vec4(0, 0, 1, 1));
}

TEST_F(PointCloudTest, APartOfThePointsKeepsTheDensity) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> place(-0.5f, 0.5f);
    std::vector<CloudPoint> points(60000);
    for (CloudPoint& point : points) {
        point.position = {place(random), place(random), place(random), place(random)};
        point.color = glm::vec4(1, 1, 1, 0.02f);
    }
    const auto mean = [](const std::vector<glm::vec4>& pixels) {
        double sum = 0;
        for (const glm::vec4& pixel : pixels) sum += linearFromSrgb(double(pixel.r));
        return sum / double(pixels.size());
    };
    CloudView view;
    const double all = mean(picture(points, view));
    view.share = 0.25;
    EXPECT_NEAR(mean(picture(points, view)), all, 0.05 * all);
    EXPECT_GT(all, 0.05);
}

TEST_F(PointCloudTest, TheProcessorDrawsTheSame) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> place(-0.35f, 0.35f), shade(0, 1);
    std::vector<CloudPoint> points(400);
    for (CloudPoint& point : points) {
        point.position = {place(random), place(random), place(random), place(random)};
        point.further = {place(random), place(random), 0, 0};
        point.normal = glm::normalize(point.position);
        point.color = {shade(random), shade(random), shade(random), 0.5f};
    }
    CloudView view;
    view.size = kSize;
    view.radiusPixels = 5;
    view.rotation = rotationOf({10, 20, 30, 40, 50, 60, 20, -30, 40, 10, 5, 15, -25, 35, 45});
    const auto draw = [&](const char* what) {
        const std::vector<glm::vec4> ours = picture(points, view);
        const MemoryTexture theirs = drawnCloud(points, view);
        double sum = 0;
        for (std::size_t i = 0; i < ours.size(); ++i)
            for (int c = 0; c < 3; ++c)
                sum += std::abs(double(ours[i][c]) - theirs.rgba[4 * i + std::size_t(c)] / 255.0);
        EXPECT_LT(sum / double(3 * ours.size()), 0.004) << what;
        return ours;
    };
    const auto plain = draw("five and six axes");
    view.light = {.towards = glm::normalize(glm::dvec4(1, 1, 1, 1)), .ambient = 0.2};
    const auto lit = draw("light");
    view.projection.aside = 0.1;
    view.projection.convergence = 1.2;
    const auto aside = draw("one eye of two");
    view.projection.parallel = true;
    const auto parallel = draw("parallel");
    EXPECT_GT(test::maxDifference(plain, lit), 0.1);
    EXPECT_GT(test::maxDifference(lit, aside), 0.1);
    EXPECT_GT(test::maxDifference(aside, parallel), 0.1);
}

TEST_F(PointCloudTest, AnaglyphsAreTheSameWithAndWithoutOpenGl) {
    std::mt19937 random(5);
    std::uniform_int_distribution<int> level(0, 255);
    constexpr glm::ivec2 size(7, 5);
    std::array<MemoryTexture, 2> eyes;
    for (MemoryTexture& eye : eyes) {
        eye.size = size;
        for (int i = 0; i < size.x * size.y * 4; ++i)
            eye.rgba.push_back(i % 4 == 3 ? std::uint8_t(255) : std::uint8_t(level(random)));
    }
    StereoPicture memory, gl;
    const auto* wanted = reinterpret_cast<const MemoryTexture*>(
        memory.combine(TexturesIn::Memory, eyes[0].name(), eyes[1].name(), size));
    std::array<Texture, 2> textures;
    for (std::size_t i = 0; i < 2; ++i) {
        textures[i] = makeTexture2D(size, GL_RGBA8, GL_NEAREST, "eye");
        glTextureSubImage2D(textures[i].name(), 0, 0, 0, size.x, size.y, GL_RGBA, GL_UNSIGNED_BYTE,
                            eyes[i].rgba.data());
    }
    const auto combined = GLuint(gl.combine(TexturesIn::OpenGl, textures[0].name(), textures[1].name(), size));
    std::vector<std::uint8_t> got(eyes[0].rgba.size());
    glGetTextureImage(combined, 0, GL_RGBA, GL_UNSIGNED_BYTE, GLsizei(got.size()), got.data());
    for (std::size_t i = 0; i < got.size(); ++i) EXPECT_NEAR(got[i], wanted->rgba[i], 1) << i;
}

} // namespace
} // namespace tessera::vis
