#include "tests/vis/drawn_ball.h"
#include "vis/optics/surface_light.h"
#include "volume/reconstruct/gradient.h"

#include <glm/gtc/quaternion.hpp>
#include <random>

/// Drawings: what is known of their ink, of their strokes, and of how they change as the object turns.
namespace tessera::vis {
namespace {

/// On any ground and any surface some of an outline is far from the ground, and some far from the surface.
TEST(LooksOfABall, OutlinesShowOnAnyGround) {
    for (const float ground : {0.0f, 0.11f, 0.5f, 1.0f})
        for (const float surface : {0.02f, 0.5f, 1.0f}) {
            Ball ball;
            IsoLayer& layer = ball.surface();
            layer.color = glm::vec3(surface);
            layer.look.cartoon = Cartoon{.shadow = 1, .outline = 6};
            ball.scene.background = glm::vec3(ground);
            float fromGround = 0, fromSurface = 0;
            const std::vector<glm::vec4> picture = ball.draw(kPicture);
            for (int x = 0; x < kPicture.x; ++x) {
                const glm::vec4 pixel = picture[std::size_t(kPicture.y / 2 * kPicture.x + x)];
                const double away = std::abs(ball.place(x, kPicture.y / 2, kPicture).x);
                if (pixel.a < 0.99f || away < 0.85) continue;
                const auto shown = float(srgbFromLinear(double(pixel.g)));
                fromGround = std::max(fromGround, std::abs(shown - ground));
                fromSurface = std::max(fromSurface, std::abs(shown - surface));
            }
            EXPECT_GT(fromGround, 0.35f) << ground << ' ' << surface;
            EXPECT_GT(fromSurface, 0.35f) << ground << ' ' << surface;
        }
}

/// Each drawing leaves marks that contrast with its paper, light or dark.
TEST(LooksOfABall, DrawingsShowOnAnyPaper) {
    for (const std::string_view name : {"charcoal", "pencil", "chalk", "illustration"})
        for (const float ground : {0.05f, 1.0f}) {
            Ball ball;
            IsoLayer& layer = ball.surface();
            layer.look = *Look::preset(name);
            ball.scene.paper = Paper{.color = glm::vec3(ground), .tooth = 0};
            ball.scene.lighting.lights = {{.azimuth = -50, .elevation = 40}};
            int marks = 0;
            for (const glm::vec4& pixel : ball.draw(kPicture))
                marks += pixel.a > 0.5f && std::abs(float(srgbFromLinear(double(pixel.g))) - ground) > 0.4f;
            EXPECT_GT(marks, 150) << name << " on " << ground;
        }
}

/// The ball with noise of a tenth of the change between two cells.
double noisyBall(glm::dvec3 p) {
    const glm::ivec3 at(glm::round(p));
    std::minstd_rand random(std::uint32_t(1 + at.x + 50 * (at.y + 50 * at.z)));
    random.discard(3);
    return glm::length(p - 20.0) / 40 + (double(random()) / double(std::minstd_rand::max()) - 0.5) * 0.02;
}

/// Number of neighbouring pixels inside the ball of different tones.
int bordersOf(const std::vector<glm::vec4>& picture, const Ball& ball) {
    int borders = 0;
    for (int y = 0; y < kPicture.y; ++y)
        for (int x = 1; x < kPicture.x; ++x) {
            if (glm::length(ball.place(x, y, kPicture)) > 0.85) continue;
            const std::size_t at = std::size_t(y * kPicture.x + x);
            borders += std::abs(picture[at].g - picture[at - 1].g) > 0.02f;
        }
    return borders;
}

/// Bands of light follow the ball instead of its noise, once normals are smoothed.
TEST(Drawings, BandsDoNotFollowNoise) {
    const auto borders = [](Ball&& ball, float smooth) {
        IsoLayer& layer = ball.surface();
        layer.look.cartoon = Cartoon{.steps = 4, .outline = 0};
        layer.look.smooth = smooth;
        ball.scene.lighting.lights = {{.azimuth = 50, .elevation = 20}};
        return bordersOf(ball.draw(kPicture), ball);
    };
    const int even = borders(Ball(), 0), noisy = borders(Ball(noisyBall), 0), smooth = borders(Ball(noisyBall), 2.5f);
    EXPECT_GT(noisy, 2 * even);
    EXPECT_LT(smooth - even, 0.35 * (noisy - even));
}

/// The normals of a thin wall stay those of the wall, although smoothing reaches through it.
TEST(Drawings, ThinWallsKeepTheirNormals) {
    const auto wall = [](glm::dvec3 p) { return std::abs(glm::length(p - 20.0) - 16) / 40; };
    const auto drawn = [&](float smooth) {
        Ball ball(wall);
        IsoLayer& layer = ball.surface();
        layer.value = 0.05; // two cells to either side
        layer.look.cartoon = Cartoon{.steps = 12, .outline = 0};
        layer.look.smooth = smooth;
        ball.scene.lighting.lights = {{.azimuth = 50, .elevation = 20}};
        return ball.draw(kPicture);
    };
    const std::vector<glm::vec4> narrow = drawn(0), wide = drawn(3);
    double apart = 0;
    for (std::size_t i = 0; i < narrow.size(); ++i) apart += double(std::abs(narrow[i].g - wide[i].g));
    EXPECT_LT(apart / double(narrow.size()), 0.03);
}

/// Ripples as narrow as the width of smoothing would be drawn by the normals of their neighbours.
TEST(Drawings, FeaturesNarrowerThanTheWidthKeepTheirNormals) {
    for (const double wavelength : {5.0, 6.0, 40.0}) {
        const auto value = [=](glm::dvec3 p) { return std::optional(std::sin(6.2831853 * p.x / wavelength) + p.z); };
        const double steep = 6.2831853 / wavelength;
        for (const double x : {0.0, 0.25}) {
            const double phase = 6.2831853 * x;
            const glm::dvec3 narrow(steep * std::cos(phase), 0, 1);
            const glm::dvec3 smooth = volume::smoothGradient(value, {x * wavelength, 3, 2}, 3, narrow);
            EXPECT_GT(glm::dot(glm::normalize(smooth), glm::normalize(narrow)), 0.75) << wavelength << ' ' << x;
        }
    }
    const auto ripples = [](glm::dvec3 p) { return std::optional(std::sin(6.2831853 * p.x / 3)); };
    EXPECT_NEAR(volume::smoothGradient(ripples, glm::dvec3(0), 3, {2.094, 0, 0}).x, 2.094, 1e-3);
}

/// Mean darkness of a drawing on white where the light and the normal enclose angles between two cosines.
double darkness(const Look& look, double from, double to) {
    Ball ball;
    ball.surface().look = look;
    ball.scene.paper = Paper{.color = glm::vec3(1), .tooth = 0};
    ball.scene.lighting.lights = {{.azimuth = -40, .elevation = 30}};
    const glm::dvec3 light = lightDirection(ball.scene.lighting.lights[0], ball.scene.camera);
    constexpr glm::ivec2 kLarge{360, 360};
    const std::vector<glm::vec4> picture = ball.draw(kLarge);
    double sum = 0;
    int count = 0;
    for (int y = 0; y < kLarge.y; ++y)
        for (int x = 0; x < kLarge.x; ++x) {
            const glm::dvec2 p = ball.place(x, y, kLarge);
            if (glm::length(p) > 0.9) continue;
            const double towards = glm::dot(glm::dvec3(p, std::sqrt(1 - glm::dot(p, p))), light);
            if (towards < from || towards > to) continue;
            sum += 1 - srgbFromLinear(std::clamp(double(picture[std::size_t(y * kLarge.x + x)].g), 0.0, 1.0));
            ++count;
        }
    EXPECT_GT(count, 500);
    return sum / count;
}

/// Where light falls the paper stays bare, and marks thicken towards the shade.
TEST(Drawings, LeaveThePaperBareInTheLight) {
    for (const std::string_view name :
         {"charcoal", "sanguine", "softpencil", "pencil", "hardpencil", "hatching", "stipple"}) {
        const Look look = *Look::preset(name);
        const double light = darkness(look, 0.85, 1), middle = darkness(look, 0.3, 0.5), shade = darkness(look, -1, 0);
        EXPECT_LT(light, 0.01) << name;
        EXPECT_GT(middle, 3 * light) << name;
        EXPECT_GT(shade, 1.5 * middle) << name;
        EXPECT_GT(shade, name == "hardpencil" ? 0.25 : 0.35) << name << " is dark enough to print";
    }
    const auto shadeOf = [](std::string_view name) { return darkness(*Look::preset(name), -1, 0.1); };
    const double soft = shadeOf("softpencil"), medium = shadeOf("pencil"), hard = shadeOf("hardpencil");
    EXPECT_GT(soft, 1.1 * medium);
    EXPECT_GT(medium, 1.1 * hard);
}

/// Strokes run round a rod, whichever way it lies; without curvature to follow they do not.
TEST(Drawings, StrokesFollowTheCurvature) {
    const auto across = [](bool upright, float follow) { // change along x over change along y
        Ball ball([=](glm::dvec3 p) { return std::hypot((upright ? p.x : p.y) - 20, p.z - 20) / 40; });
        IsoLayer& layer = ball.surface();
        layer.look = *Look::preset("hatching");
        layer.look.charcoal->follow = follow;
        layer.look.charcoal->crossing = 1;
        layer.look.charcoal->outline = 0;
        layer.look.charcoal->grain = 4;
        ball.scene.lighting.ambient = 0.3f; // the same middle tone everywhere
        ball.scene.lighting.diffuse = ball.scene.lighting.specular = 0;
        constexpr glm::ivec2 kLarge{360, 360};
        const std::vector<glm::vec4> picture = ball.draw(kLarge);
        double x2 = 0, y2 = 0;
        for (int y = 120; y < 240; ++y)
            for (int x = 120; x < 240; ++x) {
                const auto at = [&](int i, int j) { return double(picture[std::size_t(j * kLarge.x + i)].g); };
                x2 += std::pow(at(x + 1, y) - at(x - 1, y), 2);
                y2 += std::pow(at(x, y + 1) - at(x, y - 1), 2);
            }
        return x2 / y2;
    };
    EXPECT_LT(across(true, 1), 0.5) << "level strokes round an upright rod";
    EXPECT_GT(across(false, 1), 2) << "upright strokes round a level rod";
    for (const bool upright : {true, false})
        EXPECT_NEAR(std::log(across(upright, 0)), 0, 0.35) << "along the diagonal, however it lies";
}

/// How a picture of the ball changes, in linear light, while the ball turns by a degree under the light.
struct Change {
    double seen = 0;     ///< mean change at the same places of the surface
    double standing = 0; ///< what it were if the picture stood still and the surface turned behind it
};

/// A drawing as many times larger, averaged over its pixels, is that of the look with so many samples a pixel.
constexpr int kTimes = 4;

Change changeOnTheBall(Ball& ball) {
    constexpr glm::ivec2 kLarge{480, 480};
    const std::vector<glm::vec4> before = ball.draw(kLarge);
    const glm::dquat turn = glm::angleAxis(glm::radians(1.0), glm::dvec3(0, 1, 0));
    ball.scene.camera.orientation = glm::quat(turn);
    const std::vector<glm::vec4> after = ball.draw(kLarge);
    ball.scene.camera.orientation = {1, 0, 0, 0};
    const double radius = 1 / (ball.place(1, 0, kLarge).x - ball.place(0, 0, kLarge).x); // pixels
    // A pixel of the averaged picture with its middle at a place.
    const auto at = [&](const std::vector<glm::vec4>& picture, glm::dvec3 place) {
        const glm::dvec2 middle = glm::dvec2(place.x, -place.y) * radius + glm::dvec2(kLarge) / 2.0 - 0.5;
        const glm::dvec2 first = middle - (kTimes - 1) / 2.0, base = glm::floor(first), part = first - base;
        double sum = 0;
        for (int y = 0; y <= kTimes; ++y)
            for (int x = 0; x <= kTimes; ++x) {
                const double share = (x == 0        ? 1 - part.x
                                      : x == kTimes ? part.x
                                                    : 1) *
                                     (y == 0        ? 1 - part.y
                                      : y == kTimes ? part.y
                                                    : 1);
                const glm::vec4& color = picture[std::size_t((int(base.y) + y) * kLarge.x + int(base.x) + x)];
                sum += share * std::clamp(double(color.g), 0.0, 1.0);
            }
        return sum / (kTimes * kTimes);
    };
    Change mean;
    int count = 0;
    for (double y = -0.8; y <= 0.8; y += 0.012)
        for (double x = -0.8; x <= 0.8; x += 0.012) {
            if (x * x + y * y > 0.7) continue;
            const glm::dvec3 place(x, y, std::sqrt(1 - x * x - y * y)), moved = turn * place;
            const double was = at(before, place);
            mean.seen += std::abs(at(after, moved) - was);
            mean.standing += std::abs(at(before, moved) - was);
            ++count;
        }
    mean.seen /= count, mean.standing /= count;
    return mean;
}

Look enlarged(Look look) {
    if (look.charcoal) look.charcoal->grain *= kTimes, look.charcoal->outline *= kTimes;
    if (look.cartoon) look.cartoon->outline *= kTimes;
    if (look.wire) look.wire->width *= kTimes;
    return look;
}

/// Under a turn of a degree a place of the surface changes in no style more than 1.5 times what it changes in plain
/// shading: neither the tones that marks stand for, nor the marks, in proportion to how much the picture has of them.
/// Marks that stood still in the picture would.
TEST(Drawings, DoNotSwim) {
    Ball ball(noisyBall);
    IsoLayer& layer = ball.surface();
    ball.scene.lighting.lights = {{.azimuth = -50, .elevation = 40}};
    ball.scene.clips = {{.axis = {0, 0, -1}}}; // through the front of glass one would see the back turn the other way
    const Change plain = changeOnTheBall(ball);
    EXPECT_GT(plain.seen, 1e-3) << "the light moves over the ball";
    for (const std::string_view name : Look::kPresetNames) {
        layer.look = enlarged(*Look::preset(name));
        const Change drawn = changeOnTheBall(ball);
        const double contrast = std::max(1.0, drawn.standing / plain.standing), allowed = 1.5 * plain.seen * contrast;
        EXPECT_LE(drawn.seen, allowed) << name;
        RecordProperty(std::string(name), std::to_string(drawn.seen / plain.seen / contrast));
        if (!layer.look.charcoal) continue;
        EXPECT_GT(drawn.standing, 1.5 * allowed) << name << ": marks that stood still would be found";
        layer.look.charcoal->smudge = 1;
        EXPECT_LE(changeOnTheBall(ball).seen, 1.5 * plain.seen) << name << " without marks";
    }
}

} // namespace
} // namespace tessera::vis
