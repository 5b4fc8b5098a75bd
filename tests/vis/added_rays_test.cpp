#include "tests/vis/wavy_data.h"
#include "vis/demand/added_rays.h"
#include "vis/image/image_metrics.h"
#include "vis/optics/jitter.h"
#include "vis/processor/presented.h"
#include "vis/processor/processor_picture.h"

#include <functional>
#include <gtest/gtest.h>
#include <utility>

/// Pictures whose pixels have further rays only where these are needed, beside those with all rays everywhere.
namespace tessera::vis {
namespace {

constexpr glm::ivec2 kPicture{203, 157}; // no multiple of a block
constexpr double kSame = 50;             // dB
constexpr int kRays = 4;

Scene layeredScene(std::vector<Layer> layers) {
    Scene scene = wavyScene(true);
    scene.layers = std::move(layers);
    scene.render.samples = kRays;
    return scene;
}
Layer layered(Technique technique) {
    return {"", true, std::move(technique)};
}

struct Style {
    const char* name;
    Scene scene;
};

std::vector<Style> styles() {
    const VolumeLayer volume{.channel = "a", .density = 3}, across{.channel = "b"};
    const auto with = [](VolumeLayer layer, auto member, auto value) {
        layer.*member = value;
        return layered(layer);
    };
    const auto drawn = [](const char* look) {
        return layered(IsoLayer{.channel = "a", .value = 317, .look = *Look::preset(look)});
    };
    std::vector<Style> out{
        {"translucent", layeredScene({with(volume, &VolumeLayer::shaded, false)})},
        {"shaded", layeredScene({layered(volume)})},
        {"opaque", layeredScene({with(volume, &VolumeLayer::density, 10.0f)})},
        {"pre-integrated", layeredScene({with(volume, &VolumeLayer::classification, Classification::PreIntegrated)})},
        {"iso-surface", layeredScene({layered(IsoLayer{.channel = "a", .value = 317})})},
        {"surfaces one in the other", layeredScene({layered(IsoLayer{.channel = "a", .value = 317, .opacity = 0.4f}),
                                                    layered(IsoLayer{.channel = "b", .value = 0.7, .opacity = 0.6f})})},
        {"a slice with contour lines",
         layeredScene({layered(SliceLayer{.channel = "a", .atCursor = false, .position = 0.45, .contours = 9})})},
        {"charcoal", layeredScene({drawn("charcoal")})},
        {"hatching", layeredScene({drawn("hatching")})},
        {"cartoon", layeredScene({drawn("cartoon")})},
        {"wire", layeredScene({drawn("wire")})},
    };
    for (const RayStyle style : {RayStyle::Maximum, RayStyle::Minimum, RayStyle::Average, RayStyle::XRay})
        out.push_back({"projection", layeredScene({with(across, &VolumeLayer::style, style)})});
    Scene bands = out[0].scene; // thin shells of one value
    bands.transfer["a"].opacity = {{0, 0}, {0.5f, 0}, {0.505f, 1}, {0.51f, 0}, {0.7f, 0}, {0.703f, 1}, {0.706f, 0}};
    bands.render.stepVoxels = 0.05f;
    out.push_back({"thin shells", bands});
    Scene lenses = out[1].scene;
    lenses.layers.push_back(layered(VolumeLayer{.channel = "b", .shaded = false, .density = 0.5f}));
    lenses.layers[1].lens = "window";
    lenses.lenses = {{.name = "window", .center = {8, 7, 10}, .size = glm::vec3(0.2f), .rim = 0.3f},
                     {.name = "glass",
                      .effect = LensEffect::Magnify,
                      .center = {12, 9, 14},
                      .size = glm::vec3(0.25f),
                      .magnification = 2}};
    out.push_back({"lenses", lenses});
    Scene white = out[2].scene;
    white.background = {1, 1, 1};
    white.tone = {.curve = ToneCurve::Filmic, .exposure = 2};
    white.lighting.shadows.strength = 0.7f;
    out.push_back({"shadows and tones on white", white});
    Scene alone = out[1].scene;
    alone.showGround = false;
    out.push_back({"no ground", alone});
    Scene jittered = out[0].scene;
    jittered.render.jitter = true;
    out.push_back({"jittered", jittered});
    return out;
}

std::shared_ptr<packet::PacketVolumes> data(volume::LatticeKind kind, bool masked) {
    return std::make_shared<packet::PacketVolumes>(wavySource(kind, {wavyA(masked), wavyB(masked)}));
}

Image shownOf(const packet::PacketPicture& picture, const Scene& scene) {
    Image out{picture.size, presented(picture, {{0, 0}, picture.size}, scene, {})};
    if (scene.showGround) return out;
    for (std::size_t i = 0; i < out.rgba.size(); i += 4) // opacities count as colours do
        for (std::size_t c = 0; c < 3; ++c)
            out.rgba[i + c] = std::uint8_t(out.rgba[i + c] * out.rgba[i + 3] / 255 / 2 + out.rgba[i + 3] / 2);
    return out;
}

struct Likeness {
    double ours = 0, first = 0; ///< dB beside all rays: with those that are needed, with the first alone
};
Likeness likeness(const std::shared_ptr<packet::PacketVolumes>& volumes, Scene scene) {
    packet::PacketRenderer renderer;
    renderer.setVolumes(volumes);
    const packet::PacketPicture all = renderer.render(scene, kPicture);
    ProcessorPicture ours;
    ours.draw(scene, kPicture, {volumes}, [](const std::string& text) { ADD_FAILURE() << text; });
    const Image wanted = shownOf(all, scene);
    Likeness out;
    out.ours = difference(shownOf(ours.linear(), scene), wanted).psnr;
    scene.render.samples = 1;
    out.first = difference(shownOf(renderer.render(scene, kPicture), scene), wanted).psnr;
    return out;
}

TEST(AddedRays, EveryStyleLooksAsWithAllRays) {
    for (const bool masked : {false, true}) {
        const auto volumes = data(masked ? volume::LatticeKind::BCC : volume::LatticeKind::CC, masked);
        for (const Style& style : styles()) {
            const Likeness found = likeness(volumes, style.scene);
            EXPECT_GE(found.ours, kSame) << style.name << " " << masked;
            EXPECT_LT(found.first, kSame + 1) << style.name << " " << masked << ": further rays say nothing";
        }
    }
}

/// Of light that depends on a place in a picture, in pixels: the picture of all rays, and of those that are needed.
struct Sampled {
    std::vector<double> all, ours;
    double share = 0; ///< of pixels with all rays
};
Sampled sampled(const std::function<double(glm::dvec2)>& light, glm::ivec2 size, int tile) {
    Scene scene;
    scene.render.samples = kRays;
    const auto ray = [&](glm::ivec2 pixel, int pass) { return light(glm::dvec2(pixel) + 0.5 + pixelJitter(pass)); };
    const auto cast = [&](const packet::PixelBox& box, int pass, packet::PacketPicture& to) {
        for (int y = box.begin.y; y < box.end.y; ++y)
            for (int x = box.begin.x; x < box.end.x; ++x)
                for (int part = 0; part < 4; ++part) {
                    const glm::ivec2 in = glm::ivec2(x, y) - to.box.begin;
                    to.rgba[std::size_t(4 * (in.y * to.box.extent().x + in.x) + part)] =
                        part == 3 ? 1 : float(ray({x, y}, pass));
                }
    };
    std::vector<Tile> tiles;
    for (int y = 0; y < size.y; y += tile)
        for (int x = 0; x < size.x; x += tile)
            tiles.push_back(intersection({{x, y}, glm::ivec2(x, y) + tile}, {{0, 0}, size}));
    AddedRays added;
    added.begin(scene, size, {{0, 0}, size});
    packet::PacketPicture picture{.box = {}, .rgba = {}};
    for (const Tile& each : tiles) {
        picture.begin(size, {each.begin, each.end}, false);
        cast(picture.box, 0, picture);
        added.takeFirst(picture, each);
    }
    do {
        for (int pass = 1; pass < kRays; ++pass)
            for (const Tile& each : tiles) {
                added.choose(each);
                picture.begin(size, {each.begin, each.end}, false);
                for (const packet::PixelBox& box : added.blocks(each)) cast(box, pass, picture);
                added.take(picture, each, pass);
            }
    } while (added.chooseMore());
    Sampled out;
    added.show({{0, 0}, size}, picture);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            double sum = 0;
            for (int pass = 0; pass < kRays; ++pass) sum += ray({x, y}, pass);
            out.all.push_back(sum / kRays);
            out.ours.push_back(double(picture.rgba[std::size_t(4 * (y * size.x + x))]));
        }
    out.share = added.share();
    return out;
}
double farthest(const Sampled& of) {
    double most = 0;
    for (std::size_t i = 0; i < of.all.size(); ++i) most = std::max(most, std::abs(of.all[i] - of.ours[i]));
    return most;
}

/// Light along a line through a place, `slope` pixels up for each to the right, or along y if `upright`.
std::function<double(glm::dvec2)> lineOf(glm::dvec2 through, double slope, double width, bool upright) {
    return [=](glm::dvec2 p) {
        const glm::dvec2 off = p - through;
        const double away = upright ? off.x - slope * off.y : off.y - slope * off.x;
        return std::abs(away) < 0.5 * width * std::sqrt(1 + slope * slope) ? 0.9 : 0.1;
    };
}

/// Thin lines, some of which no first ray meets for many pixels or at all, are not missed anywhere; the rest of the
/// picture has few further rays.
TEST(AddedRays, ThinLinesAreFollowed) {
    constexpr glm::ivec2 kLines{230, 170};
    for (const double width : {1.0, 0.6, 0.35}) // wider than the gaps between the rays of pixels side by side
        for (const double slope : {0.0, 0.013, -0.04, 0.3, 0.9})
            for (const bool upright : {false, true}) {
                const Sampled found = sampled(lineOf({97.9, 83.15}, slope, width, upright), kLines, 32);
                EXPECT_LT(farthest(found), 1e-6) << width << " " << slope << " " << upright;
                EXPECT_LT(found.share, 0.15) << width << " " << slope << " " << upright;
            }
}

/// A pixel is predicted from its neighbours where the light is smooth: the mean of all its rays, not the first.
TEST(AddedRays, SmoothLightIsPredicted) {
    constexpr glm::ivec2 kSmooth{130, 90};
    const auto slope = [](glm::dvec2 p) { return 0.1 + 0.006 * p.x + 0.0003 * p.y; };
    const Sampled even = sampled(slope, kSmooth, 64);
    EXPECT_LT(farthest(even), 1e-5);
    EXPECT_NEAR(even.share, 1 / 17.0, 0.01);
    const auto hills = [](glm::dvec2 p) { return 0.5 + 0.4 * std::sin(0.11 * p.x) * std::cos(0.13 * p.y); };
    const Sampled round = sampled(hills, kSmooth, 128);
    EXPECT_LT(farthest(round), 1e-3);
    EXPECT_LT(round.share, 0.1);
    const auto grains = [](glm::dvec2 p) { return 0.5 + 0.1 * std::sin(40 * p.x) * std::sin(57 * p.y); };
    EXPECT_LT(farthest(sampled(grains, kSmooth, 32)), 1e-6);
}

/// Where most blocks of a group show grain, all of it have all rays; else those that show grain.
TEST(AddedRays, GroupsOfGrainHaveAllRays) {
    constexpr glm::ivec2 kGrain{192, 96};
    const auto stripes = [](int begin, int end) { // rows of each group
        return [=](glm::dvec2 p) {
            const double row = std::fmod(p.y, AddedRays::kGroup);
            return 0.5 + (row >= begin && row < end ? 0.2 * std::sin(40 * p.x) * std::sin(57 * p.y) : 0);
        };
    };
    const Sampled most = sampled(stripes(4, 22), kGrain, AddedRays::kGroup); // which touch three quarters of the blocks
    EXPECT_EQ(most.share, 1);
    EXPECT_LT(farthest(most), 1e-6);
    const Sampled half = sampled(stripes(9, 15), kGrain, AddedRays::kGroup);
    EXPECT_GT(half.share, 0.25);
    EXPECT_LT(half.share, 0.6);
    EXPECT_LT(farthest(half), 1e-6);
    const auto left = [&](glm::dvec2 p) { return p.x < 70 ? stripes(4, 22)(p) : 0.5; };
    const Sampled beside = sampled(left, kGrain, AddedRays::kGroup);
    EXPECT_GT(beside.share, 1.0 / 3);
    EXPECT_LT(beside.share, 0.5) << "groups without grain";
    EXPECT_EQ(beside.ours, sampled(left, kGrain, 3 * AddedRays::kGroup).ours) << "whatever the tiles";
}

/// Where nothing is drawn but strokes and grain, all rays are cast, without choosing.
TEST(AddedRays, StrokesHaveAllRays) {
    const auto shareOf = [](const std::vector<Layer>& layers) {
        Scene scene;
        scene.layers = layers;
        const Tile area{{0, 0}, {70, 50}};
        AddedRays added;
        added.begin(scene, {70, 50}, area);
        packet::PacketPicture picture{.box = {}, .rgba = {}};
        picture.begin({70, 50}, {}, false);
        added.takeFirst(picture, area);
        added.choose(area);
        return std::pair(added.share(), added.blocks(area).size());
    };
    Layer drawn = layered(IsoLayer{.channel = "a", .value = 317, .look = *Look::preset("charcoal")});
    const Layer plain = layered(IsoLayer{.channel = "a", .value = 317});
    EXPECT_EQ(shareOf({drawn}), std::pair(1.0, std::size_t(6))) << "whole groups";
    EXPECT_LT(shareOf({drawn, plain}).first, 0.1) << "the surface may be smooth";
    drawn.visible = false;
    EXPECT_LT(shareOf({drawn}).first, 0.1);
    drawn = layered(VolumeLayer{.channel = "a", .style = RayStyle::Maximum, .look = *Look::preset("charcoal")});
    EXPECT_LT(shareOf({drawn}).first, 0.1) << "a projection has no look";
}

/// What lies out of focus has all rays: the first of a pixel say nothing of those from elsewhere on the lens.
TEST(AddedRays, DepthOfFieldHasAllRays) {
    Scene scene;
    scene.camera.aperture = 0.1f;
    const Tile area{{3, 5}, {40, 31}};
    AddedRays added;
    added.begin(scene, {64, 48}, area);
    packet::PacketPicture picture{.box = {}, .rgba = {}};
    picture.begin({64, 48}, {}, false);
    added.takeFirst(picture, area);
    EXPECT_TRUE(added.choose(area));
    EXPECT_FALSE(added.choose(area)) << "once";
    EXPECT_EQ(added.share(), 1);
    double pixels = 0;
    for (const packet::PixelBox& box : added.blocks(area)) pixels += Tile{box.begin, box.end}.area();
    EXPECT_EQ(pixels, area.area());
    EXPECT_FALSE(added.chooseMore());
    EXPECT_TRUE(added.blocks(area).empty());
}

} // namespace
} // namespace tessera::vis
