#include "vis/image/image_metrics.h"
#include "volume/base/error.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace tessera::vis {
namespace {

Image noise(glm::ivec2 size, unsigned seed) {
    std::mt19937 random(seed);
    Image image{size, {}};
    for (int i = 0; i < size.x * size.y * 4; ++i) image.rgba.push_back(std::uint8_t(random() % 256));
    return image;
}

Image filled(glm::ivec2 size, std::uint8_t value) {
    return {size, std::vector<std::uint8_t>(std::size_t(size.x) * std::size_t(size.y) * 4, value)};
}

/// The definition, window by window, with weights in two dimensions and variances about the mean.
double plainSsim(const Image& a, const Image& b) {
    const auto luma = [](const Image& image, int x, int y) {
        const std::size_t at = 4 * (std::size_t(y) * std::size_t(image.size.x) + std::size_t(x));
        return 0.299 * image.rgba[at] + 0.587 * image.rgba[at + 1] + 0.114 * image.rgba[at + 2];
    };
    double total = 0;
    for (int dy = -5; dy <= 5; ++dy)
        for (int dx = -5; dx <= 5; ++dx) total += std::exp(-(dx * dx + dy * dy) / 4.5);
    double sum = 0;
    int places = 0;
    for (int y = 5; y < a.size.y - 5; ++y)
        for (int x = 5; x < a.size.x - 5; ++x) {
            const auto over = [&](auto&& of) {
                double mean = 0;
                for (int dy = -5; dy <= 5; ++dy)
                    for (int dx = -5; dx <= 5; ++dx)
                        mean += std::exp(-(dx * dx + dy * dy) / 4.5) / total * of(x + dx, y + dy);
                return mean;
            };
            const double ma = over([&](int u, int v) { return luma(a, u, v); });
            const double mb = over([&](int u, int v) { return luma(b, u, v); });
            const double va = over([&](int u, int v) { return std::pow(luma(a, u, v) - ma, 2); });
            const double vb = over([&](int u, int v) { return std::pow(luma(b, u, v) - mb, 2); });
            const double cov = over([&](int u, int v) { return (luma(a, u, v) - ma) * (luma(b, u, v) - mb); });
            sum += (2 * ma * mb + 6.5025) * (2 * cov + 58.5225) / ((ma * ma + mb * mb + 6.5025) * (va + vb + 58.5225));
            ++places;
        }
    return sum / places;
}

TEST(ImageMetrics, EqualPicturesDoNotDiffer) {
    const Image image = noise({23, 17}, 1);
    const ImageDifference none = difference(image, image);
    EXPECT_EQ(none.maximum, 0);
    EXPECT_EQ(none.rmse, 0);
    EXPECT_TRUE(std::isinf(none.psnr));
    EXPECT_NEAR(none.ssim, 1, 1e-12);
}

TEST(ImageMetrics, KnownErrorHasKnownNumbers) {
    Image a = filled({20, 20}, 100), b = a;
    for (std::size_t i = 0; i < b.rgba.size(); i += 4) b.rgba[i] = 106; // red alone: mean square 36 / 3
    ImageDifference of = difference(b, a);
    EXPECT_EQ(of.maximum, 6);
    EXPECT_NEAR(of.rmse, std::sqrt(12.0), 1e-12);
    EXPECT_NEAR(of.psnr, 10 * std::log10(255.0 * 255 / 12), 1e-9);
    // Without structure only the means count.
    const double ma = 100, mb = 100 + 0.299 * 6;
    EXPECT_NEAR(of.ssim, (2 * ma * mb + 6.5025) / (ma * ma + mb * mb + 6.5025), 1e-9);
    for (std::size_t i = 3; i < b.rgba.size(); i += 4) b.rgba[i] = 0; // opacity is not seen
    EXPECT_EQ(difference(b, a).rmse, of.rmse);
    EXPECT_EQ(differenceMap(b, a), std::vector<std::uint8_t>(400, 6));
}

TEST(ImageMetrics, AgreesWithTheDefinition) {
    for (unsigned seed : {1u, 2u, 3u}) {
        const glm::ivec2 size(19 + int(seed), 24 - int(seed));
        const Image a = noise(size, seed);
        Image b = a;
        std::mt19937 random(seed + 10);
        for (std::uint8_t& value : b.rgba)
            value = std::uint8_t(std::clamp(int(value) + int(random() % 60) - 30, 0, 255));
        EXPECT_NEAR(difference(b, a).ssim, plainSsim(b, a), 1e-9);
        double squares = 0, most = 0;
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                for (int c = 0; c < 3; ++c) {
                    const std::size_t at = std::size_t(4 * (y * size.x + x) + c);
                    squares += std::pow(a.rgba[at] - b.rgba[at], 2);
                    most = std::max(most, double(std::abs(a.rgba[at] - b.rgba[at])));
                }
        EXPECT_NEAR(difference(b, a).rmse, std::sqrt(squares / (3 * size.x * size.y)), 1e-9);
        EXPECT_EQ(difference(b, a).maximum, most);
    }
    EXPECT_LT(difference(noise({40, 40}, 5), noise({40, 40}, 6)).ssim, 0.1);
}

TEST(ImageMetrics, SmallPicturesAreOneWindowAndSizesMustAgree) {
    EXPECT_NEAR(difference(noise({3, 2}, 1), noise({3, 2}, 1)).ssim, 1, 1e-12);
    try {
        difference(noise({3, 2}, 1), noise({4, 5}, 1));
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("same size; they have 3x2 and 4x5"), std::string::npos)
            << error.what();
    }
    EXPECT_THROW(difference(Image{}, Image{}), Error);
}

} // namespace
} // namespace tessera::vis
