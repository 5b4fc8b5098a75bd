#pragma once

#include "tests/vis/parts_scene.h"
#include "tests/vis/raycast_compare.h"

/// Pictures of data in parts, beside those of the reference.
namespace tessera::vis {

inline TransferFunction fog() {
    TransferFunction function;
    function.autoRange = false;
    function.range = {0.8, 2.2};
    function.opacity = {{0, 0.02f}, {0.3f, 0.1f}, {1, 0.05f}};
    return function;
}

/// A renderer and a data set.
struct Drawn {
    std::shared_ptr<const volume::BrickSource> data;
    Renderer renderer;

    explicit Drawn(std::shared_ptr<const volume::BrickSource> source, bool bricked = false, bool exact = true)
        : data(std::move(source)), renderer(optionsFor(exact, bricked)) {
        renderer.setSource(data);
    }
    Linear draw(const Scene& scene) { return drawWhole(renderer, *renderer.makeTarget(), scene); }
    Linear truth(const Scene& scene) const { return reference::render(scene, *data, kSize, {}); }
    void check(const std::string& name, const Scene& scene, double rmse = 1.5 * kRmse) {
        check(name, scene, truth(scene), rmse);
    }
    /// `wanted` is the truth, which takes longest.
    void check(const std::string& name, const Scene& scene, const Linear& wanted, double rmse) {
        const Linear got = draw(scene);
        const reference::Difference difference = reference::compare(got, wanted, kOutlier);
        EXPECT_GT(greatest(wanted), 0.2) << name << " shows next to nothing";
        EXPECT_TRUE(difference.rmseWithin <= rmse && difference.beyond <= kOutliers)
            << name << ": " << words(difference) << " " << evidence("parts " + name, got, wanted);
        EXPECT_GE(difference.psnr, 70) << name;
    }
    /// The greatest opacity of any pixel.
    static double greatest(const Linear& image) {
        double most = 0;
        for (const glm::dvec4& pixel : image.pixels) most = std::max(most, pixel.a);
        return most;
    }
};

} // namespace tessera::vis
