#include "vis/image/light_picture.h"

#include "vis/image/image_io.h"
#include "vis/optics/ray_setup.h"
#include "volume/base/error.h"

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>
#include <random>
#include <string>

namespace tessera::vis {
namespace {

using FileBytes = std::vector<std::uint8_t>;

FileBytes bytesOf(const std::string& text) {
    return {text.begin(), text.end()};
}

FileBytes radianceHead(int width, int height, const std::string& more = {}) {
    return bytesOf("#?RADIANCE\n# made by a test\nFORMAT=32-bit_rle_rgbe\n" + more + "\n-Y " + std::to_string(height) +
                   " +X " + std::to_string(width) + "\n");
}

FileBytes operator+(FileBytes a, const FileBytes& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

LightPicture decoded(const FileBytes& bytes) {
    return decodeLightPicture(bytes, "around.hdr");
}

TEST(LightPicture, RadianceFlatRunsAndOldRuns) {
    // 128 is one half of 2^(129 - 128) = 2; mantissas stand for the middle of their step.
    const auto value = [](int mantissa, int exponent) { return (mantissa + 0.5) * std::ldexp(1.0, exponent - 136); };
    const LightPicture flat = decoded(radianceHead(2, 1) + FileBytes{128, 64, 32, 129, 0, 0, 0, 0});
    ASSERT_EQ(flat.size, glm::ivec2(2, 1));
    EXPECT_FLOAT_EQ(flat.rgb[0].r, float(value(128, 129)));
    EXPECT_FLOAT_EQ(flat.rgb[0].g, float(value(64, 129)));
    EXPECT_FLOAT_EQ(flat.rgb[0].b, float(value(32, 129)));
    EXPECT_EQ(flat.rgb[1], glm::vec3(0));

    // Ten pixels: red in one run, green one by one, blue and exponent in runs of 4 and 6.
    FileBytes row{2, 2, 0, 10, 128 + 10, 200, 10, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
    for (const std::uint8_t part : {std::uint8_t(7), std::uint8_t(128)})
        row = row + FileBytes{128 + 4, part, 128 + 6, part};
    const LightPicture runs = decoded(radianceHead(10, 2) + row + row);
    for (int i = 0; i < 20; ++i) {
        EXPECT_FLOAT_EQ(runs.rgb[std::size_t(i)].r, float(value(200, 128)));
        EXPECT_FLOAT_EQ(runs.rgb[std::size_t(i)].g, float(value(i % 10 + 1, 128)));
        EXPECT_FLOAT_EQ(runs.rgb[std::size_t(i)].b, float(value(7, 128)));
    }

    // A pixel, repeated 3 + 256 times.
    const LightPicture old =
        decoded(radianceHead(260, 1, "EXPOSURE= 2\n") + FileBytes{90, 80, 70, 128, 1, 1, 1, 3, 1, 1, 1, 1});
    EXPECT_FLOAT_EQ(old.rgb.back().g, float(value(80, 128) / 2));
}

TEST(LightPicture, DamagedFilesAreErrors) {
    FileBytes row{2, 2, 0, 10};
    for (int part = 0; part < 4; ++part) row = row + FileBytes{128 + 7, 130, 3, 1, 2, 3};
    const FileBytes whole = radianceHead(10, 3) + row + row + row;
    ASSERT_NO_THROW(decoded(whole));
    for (std::size_t size = 0; size < whole.size(); ++size)
        EXPECT_THROW(decoded(FileBytes(whole.begin(), whole.begin() + std::ptrdiff_t(size))), Error) << size;
    std::mt19937 random(5);
    for (int i = 0; i < 20000; ++i) { // whatever comes of it, no harm is done
        FileBytes flipped = whole;
        for (int n = 0; n < 1 + i % 3; ++n) flipped[random() % flipped.size()] ^= std::uint8_t(1u << random() % 8);
        try {
            decoded(flipped);
        } catch (const Error&) {
        }
    }
    for (const char* text : {"", "#?", "P6 1 1 255", "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n....",
                             "#?RADIANCE\n\n+Y 1 +X 1\n....", "#?RADIANCE\n\n-Y 0 +X 1\n....",
                             "#?RADIANCE\n\n-Y 99999 +X 99999\n....", "#?RADIANCE\nEXPOSURE=0\n\n-Y 1 +X 1\n....",
                             "#?RADIANCE\n\n-Y 1 +X 1 \n....", "#?RADIANCE\n\n-Y 4000 +X 8000\n...."})
        EXPECT_THROW(decoded(bytesOf(text)), Error) << text;
    EXPECT_THROW(readSurroundings("/nonexistent.hdr"), Error);
}

/// A picture of light that is known in every direction; `way` says where a pixel looks, or nowhere.
using Way = std::function<std::optional<glm::dvec3>(glm::dvec2 at)>;
glm::dvec3 lightFrom(glm::dvec3 d) {
    return 0.5 + 0.3 * d + 0.15 * glm::dvec3(d.y * d.z, d.z * d.x, d.x * d.y);
}
LightPicture painted(glm::ivec2 size, const Way& way) {
    LightPicture picture;
    picture.size = size;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const auto d = way((glm::dvec2(x, y) + 0.5) / glm::dvec2(size));
            picture.rgb.emplace_back(d ? lightFrom(glm::normalize(*d)) : glm::dvec3(1e4));
        }
    return picture;
}

std::optional<glm::dvec3> allAroundWay(glm::dvec2 at) {
    const double turn = (at.x - 0.5) * glm::two_pi<double>(), down = at.y * glm::pi<double>();
    return glm::dvec3(std::sin(turn) * std::sin(down), std::cos(down), -std::cos(turn) * std::sin(down));
}
/// What one sees from inside a cube: turned to the left, ahead (-z), to the right and back; head up and down.
std::optional<glm::dvec3> onCross(glm::dvec2 at, bool upright) {
    const glm::dvec2 place = at * (upright ? glm::dvec2(3, 4) : glm::dvec2(4, 3));
    const glm::ivec2 square(place);
    const double u = 2 * (place.x - square.x) - 1, v = 1 - 2 * (place.y - square.y);
    if (square == glm::ivec2(1, 1)) return glm::dvec3(u, v, -1);
    if (square == glm::ivec2(0, 1)) return glm::dvec3(-1, v, -u);
    if (square == glm::ivec2(2, 1)) return glm::dvec3(1, v, u);
    if (square == glm::ivec2(1, 0)) return glm::dvec3(u, 1, v);
    if (square == glm::ivec2(1, 2)) return glm::dvec3(u, -1, -v);
    if (!upright && square == glm::ivec2(3, 1)) return glm::dvec3(-u, v, 1);
    if (upright && square == glm::ivec2(1, 3)) return glm::dvec3(u, -v, 1); // bent on below the bottom
    return std::nullopt;
}

TEST(LightPicture, EveryLayoutGivesTheSameSurroundings) {
    const LightPicture pictures[] = {painted({512, 256}, allAroundWay),
                                     painted({512, 384}, [](glm::dvec2 at) { return onCross(at, false); }),
                                     painted({384, 512}, [](glm::dvec2 at) { return onCross(at, true); })};
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (const LightPicture& picture : pictures) {
        const CubeMap map = surroundingsOf(picture, "around");
        double worst = 0;
        for (int i = 0; i < 2000; ++i) {
            const glm::dvec3 d = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
            worst = std::max(worst, glm::length(map.at(d) - lightFrom(d)));
        }
        EXPECT_LT(worst, 0.02) << picture.size.x << " x " << picture.size.y;
    }
    EXPECT_THROW(surroundingsOf(painted({100, 100}, allAroundWay), "square"), Error);
    EXPECT_THROW(surroundingsOf({}, "empty"), Error);
}

TEST(LightPicture, PngIsDecodedToLinearLight) {
    Image image{{2, 1}, {255, 0, 128, 255, 10, 20, 30, 255}};
    const LightPicture picture = decodeLightPicture(encodePng(image), "a.png");
    EXPECT_NEAR(picture.rgb[0].r, 1, 1e-6);
    EXPECT_EQ(picture.rgb[0].g, 0);
    EXPECT_NEAR(picture.rgb[0].b, linearFromSrgb(128 / 255.0), 1e-6);
}

TEST(LightPicture, PngsAreNoLargerThanOtherPictures) {
    Image image{{8200, 4100}, {}};
    image.rgba.assign(std::size_t(image.size.x) * std::size_t(image.size.y) * 4, 255);
    try {
        decodeLightPicture(encodePng(image), "large.png");
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("2^25 pixels"), std::string::npos) << error.what();
    }
}

// Noise of pixels averages out over the pixels that a texel of the surroundings covers, since each is sampled.
TEST(LightPicture, EveryPixelCounts) {
    LightPicture picture{{1024, 512}, {}};
    picture.rgb.resize(1024 * 512);
    std::mt19937 random(11);
    std::uniform_real_distribution<float> unit(0, 1);
    for (glm::vec3& pixel : picture.rgb) pixel = glm::vec3(unit(random));
    const CubeMap map = surroundingsOf(picture, "noise");
    double sum = 0, squares = 0;
    for (const glm::dvec3& texel : map.texels) sum += texel.x, squares += texel.x * texel.x;
    const double mean = sum / double(map.texels.size()), variance = squares / double(map.texels.size()) - mean * mean;
    EXPECT_NEAR(mean, 0.5, 0.01);
    // A pixel's variance is 1/12. At the poles of the picture, pixels are narrow and some are left out.
    const double pixels = 1024.0 * 512 / double(map.texels.size());
    EXPECT_LT(variance, 2.0 / 12 / pixels);
}

/// Even light from all around makes a white surface exactly as bright; one bright half lights the side that faces it.
TEST(LightPicture, LightsAsTheFormulasSay) {
    Lighting lighting;
    lighting.environment.kind = Environment::Picture;
    LightPicture picture{{64, 32}, std::vector<glm::vec3>(64 * 32, glm::vec3(0.75f, 0.5f, 0.25f))};
    const CubeMap even = surroundingsOf(picture, "even");
    const LightMaps maps = environmentMaps(lighting, &even);
    for (const CubeMap* map : {&maps.diffuse, &maps.specular})
        for (const glm::dvec3& texel : map->texels) EXPECT_LT(glm::length(texel - glm::dvec3(0.75, 0.5, 0.25)), 1e-6);
    for (std::size_t i = 0; i < picture.rgb.size(); ++i)
        picture.rgb[i] = glm::vec3(i % 64 >= 32 ? 1.0f : 0.0f); // towards +x
    const CubeMap half = surroundingsOf(picture, "half");
    const LightMaps lit = environmentMaps(lighting, &half);
    EXPECT_NEAR(lit.diffuse.at({1, 0, 0}).x, 1, 0.02);
    EXPECT_NEAR(lit.diffuse.at({-1, 0, 0}).x, 0, 0.02);
    EXPECT_NEAR(lit.diffuse.at({0, 1, 0}).x, 0.5, 0.02);
    EXPECT_EQ(environmentMaps(lighting).diffuse.texels[0], glm::dvec3(0)) << "no picture, no light";
}

} // namespace
} // namespace tessera::vis
