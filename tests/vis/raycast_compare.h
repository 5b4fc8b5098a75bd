#pragma once

#include "tests/reference/raycast.h"
#include "tests/vis/wavy_data.h"
#include "vis/gl/headless.h"
#include "vis/image/image_io.h"
#include "vis/image/light_picture.h"
#include "vis/optics/ray_setup.h"
#include "vis/passes/renderer.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <memory>
#include <string>

/// Pictures of the shader beside those of the reference ray caster, small enough to draw many.
///
/// Tolerance with 32-bit textures (Mesa's software GL reaches RMSE 1e-6 and two outliers): RMSE <= kRmse over the
/// pixels that are within kOutlier of the reference, and at most kOutliers pixels of the picture that are not. Outliers
/// are pixels where a yes or no (present or absent, above or below an iso-value, one sample more or less, the nearest
/// label) falls the other way in single precision. Tolerance with 16-bit textures and a 16-bit float target: PSNR >=
/// kPsnr16 for a peak of 1 (reached: 75 dB).
namespace tessera::vis {

using reference::Flaws;
using volume::LatticeKind;
using Linear = reference::Image;

inline constexpr glm::ivec2 kSize{72, 56};
inline constexpr double kRmse = 2e-6, kOutlier = 1e-4;
inline constexpr std::size_t kOutliers = 8; // of 4032 pixels
inline constexpr double kPsnr16 = 64;

/// Two scalars, a label and (where masked) absent samples outside a ball and in a slab.
inline std::shared_ptr<FunctionSource> source(LatticeKind kind, bool masked) {
    const auto label = [](glm::dvec3 p) -> std::optional<double> {
        return std::floor(p.z / 6.3) + (p.x > 7.3 ? 1 : 0);
    };
    return wavySource(kind, {wavyA(masked), wavyB(masked), {"label", label, {0, 5}, true}});
}

inline Scene baseScene(bool perspective) {
    Scene scene = wavyScene(perspective);
    scene.transfer["label"].colormap = "labels";
    scene.transfer["label"].opacity = {{0, 0.02f}, {1, 0.02f}};
    scene.cursor = {9.3, 7.7, 12.2};
    return scene;
}

inline RendererOptions optionsFor(bool exact, bool bricked) {
    RendererOptions options;
    options.exactTextures = exact;
    if (bricked) options.denseTexels = 0;
    return options;
}

/// The complete picture of a scene; messages are failures.
inline Linear drawWhole(Renderer& renderer, ViewTarget& target, const Scene& scene) {
    FrameRequest request;
    request.size = kSize;
    request.wait = true;
    EXPECT_TRUE(renderer.render(target, scene, request).complete);
    Linear image;
    image.size = kSize;
    for (const glm::vec4& pixel : renderer.readLinear(target)) image.pixels.emplace_back(pixel);
    EXPECT_EQ(image.pixels.size(), std::size_t(kSize.x * kSize.y));
    for (const std::string& message : renderer.takeMessages()) ADD_FAILURE() << message;
    return image;
}

/// One renderer for a data set and its pictures.
struct Drawing {
    std::shared_ptr<FunctionSource> data;
    Renderer renderer;

    Drawing(LatticeKind kind, bool masked, bool exact, bool bricked = false)
        : data(source(kind, masked)), renderer(optionsFor(exact, bricked)) {
        renderer.setSource(data);
    }
    Linear draw(const Scene& scene) { return drawWhole(renderer, *renderer.makeTarget(), scene); }
    Linear truth(const Scene& scene, const Flaws& flaws = {}) const {
        reference::Options options{.flaws = flaws};
        if (scene.lighting.environment.kind == Environment::Picture)
            options.surroundings =
                std::make_shared<const CubeMap>(readSurroundings(scene.lighting.environment.picture));
        return reference::render(scene, *data, kSize, options);
    }
};

/// Writes the picture as PNG, colours over black and encoded.
inline void save(const std::string& name, const Linear& image) {
    vis::Image out{image.size, {}};
    for (const glm::dvec4& pixel : image.pixels) {
        for (int c = 0; c < 3; ++c)
            out.rgba.push_back(std::uint8_t(255 * std::clamp(srgbFromLinear(std::max(pixel[c], 0.0)), 0.0, 1.0) + 0.5));
        out.rgba.push_back(255);
    }
    writePng(name, out);
}

/// Saves what was got, what was wanted and ten times their difference, and says where.
inline std::string evidence(const std::string& name, const Linear& got, const Linear& wanted) {
    const std::filesystem::path folder = std::filesystem::path(TESSERA_BINARY_DIR) / "test-pictures";
    std::filesystem::create_directories(folder);
    Linear difference = got;
    for (std::size_t i = 0; i < got.pixels.size(); ++i)
        difference.pixels[i] = glm::abs(got.pixels[i] - wanted.pixels[i]) * 10.0;
    std::string stem = (folder / name).string();
    save(stem + " got.png", got);
    save(stem + " wanted.png", wanted);
    save(stem + " difference.png", difference);
    return "see " + stem + " *.png";
}

inline std::string words(const reference::Difference& d) {
    return "RMSE within " + std::to_string(d.rmseWithin * 1e6) + "e-6, " + std::to_string(d.beyond) +
           " outliers, maximum " + std::to_string(d.maximum) + " at " + std::to_string(d.worst.x) + "," +
           std::to_string(d.worst.y) + ", PSNR " + std::to_string(d.psnr) + " dB";
}

inline bool agrees(const reference::Difference& difference) {
    return difference.rmseWithin <= kRmse && difference.beyond <= kOutliers;
}

struct Case {
    LatticeKind kind;
    bool masked;
    std::string name() const {
        return std::string(volume::kLatticeNames[std::size_t(kind)]) + (masked ? "_masked" : "_whole");
    }
};

} // namespace tessera::vis
