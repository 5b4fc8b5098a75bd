#include "tests/vis/renderer_scenes.h"
#include "vis/demand/tile_order.h"
#include "vis/gl/driver.h"
#include "vis/view/view_target.h"

#include <algorithm>
#include <map>
#include <thread>

/// How a picture refines at rest: reduced, then the whole at half resolution, then full resolution.
namespace tessera::vis {
namespace {

class Refinement : public test::GlTest {
protected:
    static Scene scene(Engine engine) {
        Scene made = test::flatScene(0.1f);
        made.transfer["v"].opacity = {{0, 0}, {0.4f, 0}, {0.6f, 0.3f}, {1, 0.6f}};
        made.render.engine = engine;
        // Slow enough that no picture fits the shortest budget.
        made.render.stepVoxels = currentDriver().software || engine == Engine::Processor ? 0.1f : 0.005f;
        return made;
    }
    std::vector<std::uint8_t> pixels() {
        glm::ivec2 size;
        return renderer.readPixels(*target, size);
    }
    /// Frames of a budget that is far too small, until `done`.
    template <class Done> bool frames(const Scene& shown, Done&& done) {
        for (int i = 0; i < 4000; ++i) {
            const FrameStatus status = renderer.render(*target, shown, {.size = kSize, .budgetMs = 0.01});
            if (done(status)) return true;
            // A GPU is not waited for.
            if (!status.current || !currentDriver().software) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return false;
    }
    void open() {
        renderer.setSource(test::brickedSource(volume::LatticeKind::CC));
        target = renderer.makeTarget();
    }

    static constexpr glm::ivec2 kSize{301, 203};
    Renderer renderer{{.exactTextures = true}};
    ViewTargetPtr target;
};

/// Bound of the error of the first refinement: every pixel lies within the values that the final picture has around it,
/// two pixels far, and 8 of 255 beyond.
TEST_F(Refinement, HalfResolutionComesFirstAndIsNearTheFinalPictureEverywhere) {
    for (const Engine engine : {Engine::OpenGl, Engine::Processor}) {
        SCOPED_TRACE(int(engine));
        open();
        const Scene shown = scene(engine);
        ASSERT_TRUE(frames(shown, [&](const FrameStatus&) {
            EXPECT_TRUE(target->state.tilesDone() == 0 || target->state.half()) << "full tiles beside coarse ones";
            return target->state.half().has_value();
        }));
        EXPECT_EQ(target->state.half(), target->buffers.everything());
        const std::vector<std::uint8_t> early = pixels();
        const std::optional<Pick> soon = renderer.pick(*target, {150, 100});
        ASSERT_TRUE(frames(shown, [](const FrameStatus& status) { return status.complete; }));
        const std::vector<std::uint8_t> late = pixels();
        const std::optional<Pick> then = renderer.pick(*target, {150, 100});
        ASSERT_TRUE(soon && then);
        EXPECT_LT(glm::length(soon->position - then->position), 1);
        constexpr int kBeyond = 8, kFar = 2;
        int worst = 0;
        for (int y = 0; y < kSize.y; ++y)
            for (int x = 0; x < kSize.x; ++x)
                for (int c = 0; c < 3; ++c) {
                    int low = 255, high = 0;
                    for (int v = std::max(y - kFar, 0); v <= std::min(y + kFar, kSize.y - 1); ++v)
                        for (int u = std::max(x - kFar, 0); u <= std::min(x + kFar, kSize.x - 1); ++u) {
                            low = std::min(low, int(late[std::size_t((v * kSize.x + u) * 4 + c)]));
                            high = std::max(high, int(late[std::size_t((v * kSize.x + u) * 4 + c)]));
                        }
                    const int value = early[std::size_t((y * kSize.x + x) * 4 + c)];
                    worst = std::max({worst, low - value, value - high});
                }
        EXPECT_LE(worst, kBeyond) << int(engine);
        EXPECT_NE(early, late);
    }
}

/// What changes from frame to frame: first the whole, bit by bit, then again, each time from the middle outwards.
TEST_F(Refinement, EachPassGrowsFromTheMiddle) {
    open();
    const Scene shown = scene(Engine::OpenGl);
    std::vector<std::uint8_t> last;
    std::map<bool, std::vector<double>> away; // of the changes, by whether half resolution is complete
    ASSERT_TRUE(frames(shown, [&](const FrameStatus& status) {
        std::vector<std::uint8_t> now = pixels();
        const bool tiles = target->state.halfTilesDone() > 1 && target->state.tilesDone() != 1;
        if (!last.empty() && last != now && tiles) {
            Tile changed{kSize, {0, 0}};
            for (int y = 0; y < kSize.y; ++y)
                for (int x = 0; x < kSize.x; ++x)
                    if (!std::equal(&now[std::size_t(y * kSize.x + x) * 4], &now[std::size_t(y * kSize.x + x) * 4 + 4],
                                    &last[std::size_t(y * kSize.x + x) * 4])) {
                        changed.begin = glm::min(changed.begin, {x, y});
                        changed.end = glm::max(changed.end, {x + 1, y + 1});
                    }
            const glm::dvec2 middle = glm::dvec2(changed.begin + changed.end - kSize) / 2.0;
            away[target->state.half().has_value()].push_back(glm::length(middle));
        }
        last = std::move(now);
        return status.complete;
    }));
    for (const bool full : {false, true}) {
        const std::vector<double>& far = away[full];
        ASSERT_GE(far.size(), 3u) << full;
        // The boxes of changes are a little smaller than the tiles.
        for (std::size_t i = 1; i < far.size(); ++i) EXPECT_GT(far[i], far[i - 1] - 45) << full << " " << i;
        EXPECT_GT(far.back(), far.front()) << full;
    }
}

/// Mean difference of neighbouring pixels along rows within a box, of 255.
double contrastIn(const std::vector<std::uint8_t>& pixels, const Tile& box, int width) {
    double sum = 0;
    for (int y = box.begin.y; y < box.end.y; ++y)
        for (int x = box.begin.x + 1; x < box.end.x; ++x)
            for (int part = 0; part < 3; ++part) {
                const std::size_t at = std::size_t(y * width + x) * 4 + std::size_t(part);
                sum += std::abs(int(pixels[at]) - int(pixels[at - 4]));
            }
    return sum / std::max(box.area(), 1.0);
}

/// The processor draws first where the picture at half resolution lacks most: here at the left, not in the middle.
TEST_F(Refinement, TheProcessorBeginsWhereNeighboursDiffer) {
    const auto stripes = [](glm::dvec3 p) { return p.x < 6 ? 0.5 + 0.5 * std::sin(3 * p.x) : 0.6; };
    renderer.setSource(std::make_shared<FunctionSource>(volume::LatticeKind::CC, glm::ivec3(41, 27, 9), glm::dvec3(1),
                                                        std::vector<FunctionSource::Channel>{{"v", stripes}}));
    target = renderer.makeTarget();
    Scene shown = scene(Engine::Processor);
    shown.camera = test::frontCamera(1.1);
    std::vector<std::uint8_t> last;
    std::vector<Tile> boxes; // of what changes, once half resolution is complete
    ASSERT_TRUE(frames(shown, [&](const FrameStatus& status) {
        std::vector<std::uint8_t> now = pixels();
        if (target->state.half() && target->state.tilesDone() > 0 && !last.empty() && last != now) {
            Tile changed{kSize, {0, 0}};
            for (int y = 0; y < kSize.y; ++y)
                for (int x = 0; x < kSize.x; ++x)
                    if (!std::equal(&now[std::size_t(y * kSize.x + x) * 4], &now[std::size_t(y * kSize.x + x) * 4 + 4],
                                    &last[std::size_t(y * kSize.x + x) * 4]))
                        changed = united(changed, {{x, y}, {x + 1, y + 1}});
            boxes.push_back(changed);
        }
        last = std::move(now);
        return status.complete;
    }));
    ASSERT_GE(boxes.size(), 4u);
    const double first = contrastIn(last, boxes.front(), kSize.x), end = contrastIn(last, boxes.back(), kSize.x);
    EXPECT_GT(first, 3 * end + 1) << boxes.front().begin.x;
    EXPECT_LT(boxes.front().end.x, kSize.x / 2);
}

/// Further rays by the processor: bit by bit or in one go, in a part of the picture after a lens has moved, among
/// lines, they make the same picture, which is that of all rays.
TEST_F(Refinement, FurtherRaysOfTheProcessorAreCastWhereTheyAreNeeded) {
    for (const bool lines : {false, true}) {
        SCOPED_TRACE(lines);
        open();
        Scene shown = scene(Engine::Processor);
        shown.render.samples = 4;
        shown.render.stepVoxels = 0.5f;
        shown.layers.push_back({"within", true, IsoLayer{.channel = "v", .value = 0.7}});
        shown.layers[1].lens = "lens";
        shown.lenses = {{.name = "lens", .center = {12, 12, 18}, .size = glm::vec3(0.3f)}};
        if (lines) {
            auto geometry = std::make_shared<Geometry>();
            geometry->lines.positions = {{2, 3, 20}, {25, 20, 16}, {4, 22, 30}};
            geometry->lines.ends = {3};
            shown.geometry = {{.geometry = geometry, .style = {.lineWidth = 1.5f}}};
        }
        const auto complete = [](const FrameStatus& status) { return status.complete; };
        ASSERT_TRUE(frames(shown, complete));
        EXPECT_FALSE(target->packets.added.holds(kSize, target->buffers.everything())) << "kept without need";
        const std::vector<glm::vec4> slowly = renderer.readLinear(*target);
        const ViewTargetPtr other = renderer.makeTarget();
        EXPECT_TRUE(renderer.render(*other, shown, {.size = kSize, .wait = true}).complete);
        EXPECT_LT(test::maxDifference(slowly, renderer.readLinear(*other)), 1e-6);
        shown.lenses[0].center.x += 4;
        ASSERT_TRUE(frames(shown, complete));
        EXPECT_NE(target->state.stale(), target->buffers.everything()) << "all was drawn again";
        const std::vector<glm::vec4> part = renderer.readLinear(*target);
        EXPECT_TRUE(renderer.render(*other, shown, {.size = kSize, .wait = true}).complete);
        EXPECT_GT(test::maxDifference(slowly, part), 0.1);
        EXPECT_LT(test::maxDifference(part, renderer.readLinear(*other)), 0.02) << "a block may lie otherwise";
        if (lines) continue;
        packet::PacketRenderer packets;
        packets.setSource(test::brickedSource(volume::LatticeKind::CC));
        const packet::PacketPicture all = packets.render(shown, kSize);
        double sum = 0;
        for (int y = 0; y < kSize.y; ++y)
            for (int x = 0; x < kSize.x; ++x)
                for (int c = 0; c < 4; ++c) {
                    const glm::vec4& own = part[std::size_t((kSize.y - 1 - y) * kSize.x + x)];
                    const double off = double(own[c] - all.rgba[std::size_t((y * kSize.x + x) * 4 + c)]);
                    sum += off * off;
                }
        EXPECT_GT(-10 * std::log10(sum / (4.0 * kSize.x * kSize.y)), 60);
    }
}

/// While something moves only the reduced picture is drawn, and a quick picture needs no half resolution.
TEST_F(Refinement, NotInMotionAndNotWhereThePictureIsQuick) {
    open();
    const Scene shown = scene(Engine::OpenGl);
    for (int i = 0; i < 300; ++i) {
        const FrameStatus status = renderer.render(*target, shown, {.size = kSize, .moving = true, .budgetMs = 0.01});
        if (!status.current) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_TRUE(target->state.reduced());
    EXPECT_EQ(target->state.halfTilesDone(), 0);
    for (int i = 0; i < 300; ++i) renderer.render(*target, shown, {.size = kSize, .budgetMs = 10000});
    EXPECT_TRUE(target->state.converged());
    EXPECT_EQ(target->state.halfTilesDone(), 0);
}

/// What was known of a picture with several rays a pixel is no part of the next one, which has one.
TEST_F(Refinement, OneRayAfterSeveralThatWereInterrupted) {
    open();
    Scene shown = scene(Engine::Processor);
    shown.render.stepVoxels = 0.5f;
    shown.render.samples = 4;
    auto geometry = std::make_shared<Geometry>(); // lines that further rays have to be cast along
    geometry->lines.positions = {{2, 3, 20}, {25, 20, 16}, {4, 22, 30}};
    geometry->lines.ends = {3};
    shown.geometry = {{.geometry = geometry, .style = {.lineWidth = 0.7f}}};
    ASSERT_TRUE(frames(shown, [&](const FrameStatus& status) {
        EXPECT_FALSE(status.complete);
        const int perPass = int(tilesFromMiddle(target->state.stale(), target->pace().tileEdge()).size());
        return target->state.full() && target->state.tilesDone() > 3 * perPass;
    }));
    shown.render.samples = 1;
    shown.camera.target.x += 0.1f;
    ASSERT_TRUE(frames(shown, [](const FrameStatus& status) { return status.complete; }));
    const ViewTargetPtr other = renderer.makeTarget();
    EXPECT_TRUE(renderer.render(*other, shown, {.size = kSize, .wait = true}).complete);
    EXPECT_LT(test::maxDifference(renderer.readLinear(*target), renderer.readLinear(*other)), 1e-6);
}

} // namespace
} // namespace tessera::vis
