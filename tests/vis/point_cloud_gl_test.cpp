#include "vis/passes/point_cloud.h"

#include "tests/vis/gl_fixture.h"
#include "vis/optics/ray_setup.h"

#include <algorithm>
#include <cmath>
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

} // namespace
} // namespace tessera::vis
