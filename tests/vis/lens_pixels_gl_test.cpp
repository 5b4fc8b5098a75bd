#include "tests/vis/lens_scene.h"
#include "vis/demand/lens_pixels.h"

#include <random>

/// Beyond its lenses a picture is drawn without them.
namespace tessera::vis {
namespace {

TEST(LensPixels, RemaindersFillWhatIsLeft) {
    std::mt19937 seeded(5);
    const auto any = [&](int most) { return int(seeded() % unsigned(most)); };
    for (int round = 0; round < 200; ++round) {
        const Tile whole{{any(5), any(5)}, {8 + any(12), 8 + any(12)}};
        std::vector<Tile> cut;
        for (int i = any(4); i > 0; --i) {
            const glm::ivec2 from(any(20), any(20));
            cut.push_back({from, from + glm::ivec2(any(9), any(9))}); // some are empty, some overlap
        }
        const std::vector<Tile> rest = remainder(whole, cut);
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 24; ++x) {
                const auto holds = [&](const Tile& tile) { return tile.holds({x, y}); };
                const bool left = holds(whole) && std::none_of(cut.begin(), cut.end(), holds);
                EXPECT_EQ(std::count_if(rest.begin(), rest.end(), holds), left ? 1 : 0) << x << "," << y;
            }
    }
}

class LensPixelsGl : public testing::TestWithParam<bool> {
protected:
    HeadlessContext context;
};
INSTANTIATE_TEST_SUITE_P(Cameras, LensPixelsGl, testing::Bool(),
                         [](const auto& each) { return each.param ? "perspective" : "parallel"; });

Scene lensedScene(bool perspective) {
    Scene scene = lensScene(perspective);
    scene.layers.push_back({"", true, SliceLayer{.channel = "b", .orientation = SliceOrientation::Y, .opacity = 0.5f}});
    return scene;
}

TEST_P(LensPixelsGl, BeyondALensItsLayersTakeNoSamples) {
    const Scene scene = lensedScene(GetParam());
    Scene plain = scene;
    plain.lenses.clear();
    std::erase_if(plain.layers, [](const Layer& layer) { return !layer.lens.empty(); });
    const auto data = source(LatticeKind::BCC, true);
    const std::vector<Tile> tiles =
        lensTiles(placeLenses(scene, worldFrame(data->info(), scene.stretch)), scene, kSize).value();
    std::vector<std::vector<glm::vec4>> counts, pictures;
    for (const bool counting : {true, false})
        for (const Scene* each : {&scene, static_cast<const Scene*>(&plain)}) {
            RendererOptions options = optionsFor(true, false);
            options.countSamples = counting;
            Renderer renderer(options);
            renderer.setSource(data);
            const ViewTargetPtr target = renderer.makeTarget();
            FrameRequest request;
            request.size = kSize;
            request.wait = true;
            EXPECT_TRUE(renderer.render(*target, *each, request).complete);
            (counting ? counts : pictures).push_back(renderer.readLinear(*target));
        }
    int beyond = 0, more = 0;
    for (int y = 0; y < kSize.y; ++y)
        for (int x = 0; x < kSize.x; ++x) {
            const std::size_t i = std::size_t(kSize.y - 1 - y) * std::size_t(kSize.x) + std::size_t(x);
            if (std::any_of(tiles.begin(), tiles.end(), [&](const Tile& tile) { return tile.holds({x, y}); })) {
                more += counts[0][i].r > counts[1][i].r;
                continue;
            }
            beyond += counts[1][i].r > 0;
            ASSERT_EQ(counts[0][i], counts[1][i]) << x << "," << y;
            ASSERT_EQ(pictures[0][i], pictures[1][i]) << x << "," << y;
        }
    EXPECT_GT(beyond, 500);
    EXPECT_GT(more, 100);
}

TEST(LensPixels, AreAnywhereWhereALensActsOutsideOfItself) {
    const Scene scene = lensedScene(true);
    const WorldFrame frame = worldFrame(source(LatticeKind::BCC, false)->info(), scene.stretch);
    const auto known = [&](const std::function<void(Scene&)>& change) {
        Scene changed = scene;
        change(changed);
        return lensTiles(placeLenses(changed, frame), changed, kSize).has_value();
    };
    EXPECT_TRUE(known([](Scene&) {}));
    EXPECT_FALSE(known([](Scene& s) { s.lenses[0].inverted = true; }));
    EXPECT_FALSE(known([](Scene& s) { s.lenses[0].effect = LensEffect::Only; }));
    EXPECT_FALSE(known([](Scene& s) { s.lenses[0].effect = LensEffect::Focus; }));
    EXPECT_FALSE(known([](Scene& s) { s.selection.brushes = {{.region = LensRegion{"inner"}}}; }));
    EXPECT_FALSE(known([](Scene& s) { s.lenses[0].size = glm::vec3(2); })); // the eye is in it
    EXPECT_TRUE(known([](Scene& s) { s.lenses.clear(); }));
}

} // namespace
} // namespace tessera::vis
