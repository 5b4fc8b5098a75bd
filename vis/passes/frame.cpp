#include "vis/passes/renderer_impl.h"

#include "vis/demand/lens_pixels.h"
#include "vis/optics/context_blur.h"
#include "vis/optics/proxy.h"
#include "vis/raycast/look_uniforms.h"
#include "vis/raycast/ray_uniforms.h"

#include <algorithm>
#include <cmath>

namespace tessera::vis {

namespace {

constexpr double kProbeShrink = 3;

std::vector<Tile> tilesOf(const Tile& whole, int edge) {
    std::vector<Tile> tiles;
    for (int y = whole.begin.y; y < whole.end.y; y += edge)
        for (int x = whole.begin.x; x < whole.end.x; x += edge)
            tiles.push_back(intersection({{x, y}, glm::ivec2(x, y) + edge}, whole));
    const auto away = [&](const Tile& tile) { // from the middle, where one looks
        const glm::ivec2 d = tile.begin + tile.end - whole.begin - whole.end;
        return d.x * d.x + d.y * d.y;
    };
    std::ranges::stable_sort(tiles, {}, away);
    return tiles;
}

/// Where a reduced picture begins in a buffer so that the corner of four tiles of software GL, which are what its
/// processors share, lies in the middle of what is drawn of it.
glm::ivec2 sharedByProcessors(const Tile& drawn, glm::ivec2 picture, glm::ivec2 buffer) {
    constexpr int kEdge = 64;
    glm::ivec2 first = (kEdge - (drawn.begin + drawn.end) / 2 % kEdge) % kEdge;
    for (int axis = 0; axis < 2; ++axis)
        if (first[axis] + picture[axis] > buffer[axis]) first[axis] = 0;
    return first;
}

} // namespace

/// Draws as much of the bound plan as the budget allows.
void Renderer::Impl::refine(ViewTarget& target, const Scene& scene, const FrameRequest& request, RayPlan& plan,
                            Clock::time_point start) {
    const bool probing = target.share < 1;
    const bool done = target.fullValid ? target.stillDone || request.moving : target.reducedValid && request.moving;
    if (done && !probing) return;
    const ProgramRecipe recipe = prepare(target, scene, plan);
    target.compiling = true;
    const ProgramAnswer answer = request.wait ? ProgramAnswer{programs.find(recipe), ProgramStage::Ready}
                                              : programs.request(recipe, request.budgetMs / 4);
    // A variant that is being compiled, or does not compile, leaves the former picture as it is.
    const auto later = [&] {
        if (!target.shows) blank(target, scene);
        target.fullValid = target.stillDone = false;
    };
    if (!answer.program) {
        target.compiling = answer.stage != ProgramStage::Failed && !request.wait;
        if (target.compiling) return later();
        if (!target.shows || request.wait) nothing(target, scene);
        target.fullValid = target.stillDone = true;
        return;
    }
    const bool presents = request.wait || presentable(target, scene);
    const RayUnits units = rayUnits(plan);
    for (std::size_t i = 0; i < plan.fields.size(); ++i) {
        const BoundField& field = plan.fields[i];
        glBindTextureUnit(GLuint(i), field.texture);
        if (!field.atlas) continue;
        glBindTextureUnit(GLuint(units.pages) + GLuint(i), field.pages);
        glBindTextureUnit(GLuint(units.atlases) + GLuint(i), field.atlas);
    }
    glBindTextureUnit(GLuint(units.table), target.table.name());
    glBindTextureUnit(GLuint(units.blocks), target.blocks.name());
    glBindTextureUnit(GLuint(units.planes), target.planes.name());
    const volume::DatasetInfo& info = source->info();
    if (std::any_of(plan.layers.begin(), plan.layers.end(), [](const RayLayer& l) { return l.look & kCharcoalBit; }))
        glBindTextureUnit(GLuint(units.grain), grain.get());
    glBindTextureUnit(GLuint(units.lassos), brushes.update(brushTests(plan, scene, info)));
    const bool lit = probing || bindLight(target, scene, request, plan);

    // Brings a program to where it can draw; false while that is on its way.
    const auto ready = [&](const ProgramAnswer& program, const ProgramRecipe& made, const RayPlan& drawn,
                           const Scene& shown) {
        if (!program.program) return false;
        const bool linked = program.stage == ProgramStage::Linked;
        if (!linked && !programs.firstUse(*program.program)) return true;
        setRayUniforms(*program.program, drawn, shown, info, source->grid(), target.size, 1);
        if (linked) {
            geometry(target, scene, plan, target.size, target.everything());
            programs.warmUp(made, target.full.framebuffer);
            return false;
        }
        // Software GL compiles at the first draw: do that before any clock runs.
        geometry(target, scene, plan, target.size, target.everything());
        target.reduced.first = {0, 0};
        rays({program.program}, scene, target.reduced, target.size, {target.size / 2, target.size / 2 + 1}, nullptr);
        glFinish();
        target.reducedValid = false;
        return true;
    };
    if (!ready(answer, recipe, plan, scene) || !presents) return later();
    target.compiling = false;
    RayPrograms rayPrograms{answer.program};
    RayPlan beyond = beyondLenses(plan);
    Scene lensless;
    if (!beyond.empty() && !drawnByProxy(scene) &&
        !lensTiles(scene, worldFrame(info.bounds, scene.stretch), target.size).value_or(std::vector<Tile>()).empty()) {
        lensless = scene;
        lensless.lenses.clear();
        const ProgramRecipe other = variant(target, lensless, beyond);
        const ProgramAnswer found =
            request.wait ? ProgramAnswer{programs.find(other), ProgramStage::Ready} : programs.request(other, 0);
        if (ready(found, other, beyond, lensless)) rayPrograms.beyond = found.program;
    }
    // Between the samples of coarser levels there is nothing to see: steps are as long as their cells.
    const auto setUniforms = [&](double stepFactor) {
        const double factor = stepFactor * target.cell;
        setRayUniforms(*rayPrograms.program, plan, scene, info, source->grid(), target.size, factor);
        if (rayPrograms.beyond)
            setRayUniforms(*rayPrograms.beyond, beyond, lensless, info, source->grid(), target.size, factor);
    };

    const auto drawReduced = [&](double shrink, double stepFactor) {
        target.reducedSize = glm::max(glm::ivec2(glm::vec2(target.size) / float(shrink)), glm::ivec2(1));
        target.reducedTile = target.changed;
        // And what is blended with it when it is enlarged.
        const glm::dvec2 scale = glm::dvec2(target.reducedSize) / glm::dvec2(target.size);
        const Tile tile = intersection({glm::ivec2(glm::floor(glm::dvec2(target.changed.begin) * scale)) - 1,
                                        glm::ivec2(glm::ceil(glm::dvec2(target.changed.end) * scale)) + 1},
                                       {{0, 0}, target.reducedSize});
        target.reduced.first = sharedByProcessors(tile, target.reducedSize, target.size);
        setUniforms(stepFactor);
        const Clock::time_point before = Clock::now();
        geometry(target, scene, plan, target.reducedSize, tile);
        if (plan.peels > 0) glFinish();
        target.geometryMs = millisecondsSince(before);
        const Clock::time_point begin = Clock::now();
        rays(rayPrograms, scene, target.reduced, target.reducedSize, tile,
             covered(target, scene, plan, target.reducedSize), stepFactor * target.cell);
        glFinish();
        const double cost = millisecondsSince(begin) * stepFactor / std::max(1.0, tile.area());
        target.msPerPixel = target.msPerPixel > 0 ? 0.5 * (target.msPerPixel + cost) : cost;
        target.reducedValid = target.reducedDrawn = true;
        present(target, scene, true, target.changed);
        target.changed = {};
        glBindTextureUnit(0, plan.fields[0].texture);
    };
    if (probing) return drawReduced(kProbeShrink, 1);
    const auto left = [&] { return request.budgetMs - millisecondsSince(start); };
    const double expected = target.msPerPixel * target.changed.area();
    const bool fast = target.msPerPixel > 0 && target.msPerPixel * target.stale.area() < std::max(left(), 1.0);
    if (!request.wait && !fast && (request.moving || !(target.reducedValid || target.fullValid))) {
        double shrink = 6, stepFactor = 2;
        if (target.msPerPixel > 0)
            // Not smaller than that: two processors would share one tile of software GL.
            for (const auto& [smaller, longer] : {std::pair{1.0, 1.0},
                                                  {1.5, 1.5},
                                                  {2.0, 2.0},
                                                  {3.0, 2.0},
                                                  {4.0, 2.0},
                                                  {6.0, 2.0},
                                                  {8.0, 3.0},
                                                  {8.0, 5.0}}) {
                shrink = smaller;
                stepFactor = longer;
                if (target.geometryMs + expected / (shrink * shrink * stepFactor) < left()) break;
            }
        drawReduced(shrink, stepFactor);
        if (request.moving) return;
    }

    // Tiles as large as a third of the budget allows; the same grid until the picture is done.
    if (target.tilesDone == 0) {
        target.passMilliseconds = 0;
        // Never the whole: what a coarse picture cost says little of the fine one.
        target.tileEdge = request.wait ? 1024 : 128;
        const double perTile = request.wait ? 1e9 : std::max(request.budgetMs / 3, 2.0);
        while (target.tileEdge > 32 && target.msPerPixel * target.tileEdge * target.tileEdge > perTile)
            target.tileEdge /= 2;
    }
    const std::vector<Tile> tiles = tilesOf(target.stale, target.tileEdge);
    setUniforms(1);
    bool first = true;
    // The whole picture once, then again with rays elsewhere in the pixels for a supersampled still.
    const int perPass = int(tiles.size()), wanted = perPass * std::max(scene.render.samples, 1);
    while (target.tilesDone < wanted && (request.wait || first || left() > 0)) {
        const Tile& tile = tiles[std::size_t(target.tilesDone % perPass)];
        const int pass = target.tilesDone / perPass;
        geometry(target, scene, plan, target.size, target.stale, pass);
        const Clock::time_point begin = Clock::now();
        if (pass == 0)
            rays(rayPrograms, scene, target.full, target.size, tile, covered(target, scene, plan, target.size),
                 target.cell);
        else
            accumulate(rayPrograms, target, scene, tile, covered(target, scene, plan, target.size), pass);
        glFinish();
        if (pass == 0) target.passMilliseconds += millisecondsSince(begin);
        present(target, scene, false, tile);
        glBindTextureUnit(0, plan.fields[0].texture);
        ++target.tilesDone;
        first = false;
        if (target.tilesDone == perPass) {
            target.fullValid = true;
            target.changed = {};
            target.msPerPixel = target.passMilliseconds / std::max(1.0, target.stale.area());
            // As if all had been drawn.
            target.passMilliseconds *= target.everything().area() / std::max(1.0, target.stale.area());
            if (request.moving) break;
        }
    }
    // What is out of focus spreads over the borders of tiles.
    if (blursContext(scene) && target.tilesDone >= perPass) {
        present(target, scene, false, target.everything());
        glBindTextureUnit(0, plan.fields[0].texture);
    }
    target.stillDone = target.tilesDone >= wanted && lit;
}

} // namespace tessera::vis
