#include "tests/vis/lens_scene.h"
#include "vis/demand/changed_pixels.h"

#include <functional>
#include <thread>

/// What a dragged lens leaves as it is need not be drawn anew.
namespace tessera::vis {
namespace {

constexpr glm::dvec3 kStep{-3.5, 2.5, 3};

/// With a line through the data.
Scene draggedScene(bool perspective) {
    Scene scene = lensScene(perspective);
    auto line = std::make_shared<Geometry>();
    line->lines.positions = {{0, 0, 0}, {18, 16, 24}};
    line->lines.ends = {2};
    scene.geometry = {{.geometry = line, .style = {.lineWidth = 6}}};
    return scene;
}

struct Move {
    const char* name;
    std::function<void(Scene&)> apply;
};
const Move kMoves[] = {
    {"sphere", [](Scene& s) { s.lenses[0].center += kStep; }},
    {"grown", [](Scene& s) { s.lenses[0].size *= 1.6f; }},
    {"disc", [](Scene& s) { s.lenses[1].center -= kStep; }},
    {"both",
     [](Scene& s) {
         s.lenses[0].center -= kStep;
         s.lenses[1].center -= kStep;
     }},
};

class ChangedPixels : public testing::TestWithParam<bool> {
protected:
    HeadlessContext context;
    Drawing drawing{LatticeKind::BCC, true, true};
    ViewTargetPtr target = drawing.renderer.makeTarget();

    std::vector<glm::vec4> draw(const Scene& scene) {
        FrameRequest request;
        request.size = kSize;
        request.wait = true;
        EXPECT_TRUE(drawing.renderer.render(*target, scene, request).complete);
        return drawing.renderer.readLinear(*target);
    }
    /// The presented picture, bytes.
    std::vector<std::uint8_t> presented() {
        glm::ivec2 size;
        return drawing.renderer.readPixels(*target, size);
    }
    std::optional<Tile> changed(const Scene& before, const Scene& after) const {
        return changedPixels(before, after, worldFrame(drawing.data->info(), before.stretch), kSize);
    }
};

INSTANTIATE_TEST_SUITE_P(Cameras, ChangedPixels, testing::Bool(),
                         [](const auto& each) { return each.param ? "perspective" : "parallel"; });

TEST_P(ChangedPixels, HoldEveryDifferenceOfMovedLenses) {
    const Scene before = draggedScene(GetParam());
    const Linear was = drawing.draw(before);
    for (const Move& move : kMoves) {
        Scene after = before;
        move.apply(after);
        const std::optional<Tile> tile = changed(before, after);
        ASSERT_TRUE(tile) << move.name;
        EXPECT_LT(tile->area(), 0.6 * kSize.x * kSize.y) << move.name;
        const Linear is = drawing.draw(after);
        int inside = 0;
        for (int y = 0; y < kSize.y; ++y)
            for (int x = 0; x < kSize.x; ++x) {
                const std::size_t i = std::size_t(kSize.y - 1 - y) * std::size_t(kSize.x) + std::size_t(x);
                if (tile->holds({x, y}))
                    inside += was.pixels[i] != is.pixels[i];
                else
                    ASSERT_EQ(was.pixels[i], is.pixels[i]) << move.name << " at " << x << "," << y;
            }
        EXPECT_GT(inside, 100) << move.name;
    }
}

TEST_P(ChangedPixels, AreAllOfThemWhereALensReachesFurther) {
    const Scene before = draggedScene(GetParam());
    const auto everywhere = [&](const std::function<void(Scene&)>& always, const std::function<void(Scene&)>& change) {
        Scene was = before;
        always(was);
        Scene is = was;
        is.lenses[0].center += kStep;
        EXPECT_TRUE(changed(before, [&] {
            Scene moved = before;
            moved.lenses[0].center += kStep;
            return moved;
        }()));
        change(is);
        EXPECT_FALSE(changed(was, is));
    };
    const auto none = [](Scene&) {};
    everywhere(none, [](Scene& s) { s.lenses[0].strength = 0.5f; });
    everywhere(none, [](Scene& s) { s.lenses.pop_back(); });
    everywhere(none, [](Scene& s) { s.camera.distance += 0.1f; });
    everywhere(none, [](Scene& s) { s.transfer["a"].colormap = "magma"; });
    everywhere([](Scene& s) { s.lighting.shadows.strength = 0.5f; }, none);
    everywhere([](Scene& s) { s.selection.brushes = {{.region = LensRegion{"inner"}}}; }, none);
    everywhere([](Scene& s) { s.lenses[0].effect = LensEffect::Focus; }, none);
    everywhere(
        [](Scene& s) {
            s.layers.push_back({"", true, SliceLayer{.channel = "a", .atCursor = true}});
        },
        [](Scene& s) { s.cursor += 1.0; });
}

TEST_P(ChangedPixels, AloneAreDrawnAndMakeTheSamePicture) {
    const Scene before = draggedScene(GetParam());
    for (const int samples : {1, 3})
        for (const Move& move : kMoves) {
            Scene scene = before;
            scene.render.samples = samples;
            draw(scene);
            move.apply(scene);
            const std::vector<glm::vec4> moved = draw(scene);
            const std::vector<std::uint8_t> shown = presented();
            target = drawing.renderer.makeTarget();
            EXPECT_EQ(moved, draw(scene)) << move.name;
            EXPECT_EQ(shown, presented()) << move.name;
        }
}

TEST_P(ChangedPixels, AreCoarseWhileALensIsDraggedTheOthersStay) {
    const Scene before = draggedScene(GetParam());
    draw(before);
    const std::vector<std::uint8_t> was = presented();
    std::vector<std::pair<glm::ivec2, glm::dvec3>> picks;
    for (int y = 0; y < kSize.y; y += 2)
        for (int x = 0; x < kSize.x; x += 2)
            if (const std::optional<Pick> picked = drawing.renderer.pick(*target, {x, y}))
                picks.push_back({{x, y}, picked->position});
    Scene scene = before;
    Tile dragged;
    FrameRequest moving;
    moving.size = kSize;
    moving.moving = true;
    moving.budgetMs = 1e-3;
    for (int step = 0; step < 3; ++step) {
        Scene next = scene;
        next.lenses[0].center += kStep * 0.8;
        dragged = united(dragged, changed(scene, next).value());
        scene = next;
        FrameStatus status;
        do status = drawing.renderer.render(*target, scene, moving);
        while (status.compiling); // what enlarges coarse pictures
        if (status.complete && !currentDriver().software) GTEST_SKIP() << "this driver draws it at once";
        EXPECT_FALSE(status.complete);
    }
    const std::vector<std::uint8_t> now = presented();
    int inside = 0;
    for (int y = 0; y < kSize.y; ++y)
        for (int x = 0; x < kSize.x; ++x) {
            const std::size_t i = 4 * (std::size_t(kSize.y - 1 - y) * std::size_t(kSize.x) + std::size_t(x));
            const bool same = std::equal(&was[i], &was[i] + 4, &now[i]);
            if (dragged.holds({x, y}))
                inside += !same;
            else
                ASSERT_TRUE(same) << x << "," << y;
        }
    EXPECT_GT(inside, 100);
    // Beside it one still picks what the fine picture shows; where the lens was a moment ago nothing for now.
    int beside = 0, lost = 0;
    for (const auto& [pixel, place] : picks) {
        const std::optional<Pick> picked = drawing.renderer.pick(*target, pixel);
        if (dragged.holds({pixel.x, kSize.y - 1 - pixel.y})) {
            lost += !picked;
            continue;
        }
        ++beside;
        ASSERT_TRUE(picked);
        EXPECT_LT(glm::length(picked->position - place), 1e-9);
    }
    EXPECT_GT(beside, 20);
    EXPECT_GT(lost, 0);
    // At rest it becomes the picture of the last scene, as drawn at once.
    FrameRequest rest;
    rest.size = kSize;
    rest.budgetMs = 50;
    for (int frame = 0; frame < 20000 && !drawing.renderer.render(*target, scene, rest).complete; ++frame)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const std::vector<glm::vec4> refined = drawing.renderer.readLinear(*target);
    target = drawing.renderer.makeTarget();
    EXPECT_EQ(refined, draw(scene));
}

} // namespace
} // namespace tessera::vis
