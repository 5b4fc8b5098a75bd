#include "vis/passes/tiles.h"

#include "vis/demand/tile_order.h"
#include "vis/passes/present.h"
#include "vis/processor/presented.h"
#include "vis/raycast/ray_uniforms.h"

#include <algorithm>
#include <cmath>

namespace tessera::vis {

namespace {

/// A picture whose pixels take longer than this many budgets is drawn at half resolution first.
constexpr double kQuick = 3;

/// Offset of a reduced picture in its buffer, chosen so that the corner between four of the driver's tiles
/// (Driver::sharedTile) lies in the middle of the drawn area: then more CPU cores share the work.
glm::ivec2 placeInTiles(const Tile& drawn, glm::ivec2 picture, glm::ivec2 buffer, int edge) {
    if (edge == 0) return glm::ivec2(0);
    glm::ivec2 first = (edge - (drawn.begin + drawn.end) / 2 % edge) % edge;
    for (int axis = 0; axis < 2; ++axis)
        if (first[axis] + picture[axis] > buffer[axis]) first[axis] = 0;
    return first;
}

/// The pixels of a reduced picture that show a tile of the full picture, plus a border for interpolation when enlarged.
Tile reducedTile(const Tile& tile, glm::ivec2 reduced, glm::ivec2 whole) {
    const glm::dvec2 scale = glm::dvec2(reduced) / glm::dvec2(whole);
    return intersection({glm::ivec2(glm::floor(glm::dvec2(tile.begin) * scale)) - 1,
                         glm::ivec2(glm::ceil(glm::dvec2(tile.end) * scale)) + 1},
                        {{0, 0}, reduced});
}

/// Step lengths scale with the cells of the finest level wanted: there is no detail between coarser samples.
void setUniforms(const RayPrograms& programs, const ViewTarget& target, const RenderCall& call, double stepFactor) {
    if (programs.packets) return;
    const double factor = stepFactor * target.demand.cell();
    const auto set = [&](const Program* program, const RayPlan& plan, const Scene& scene) {
        if (program) setRayUniforms(*program, plan, scene, call.info(), call.grid(), target.buffers.size, factor);
    };
    set(programs.program, call.plan, call.scene);
    set(programs.beyond, programs.beyondPlan, programs.beyondScene);
}

/// Draws the stale area at half resolution, tile by tile within the budget; it is presented as it comes, and takes a
/// quarter of the time of the pass at full resolution.
void drawHalf(RendererState& shared, ViewTarget& target, const RenderCall& call, const RayPrograms& programs,
              Clock::time_point start) {
    PictureState& state = target.state;
    RayBuffer& half = target.buffers.half;
    if (state.halfTilesDone() == 0) {
        target.pace().beginPass(false, call.request.budgetMs);
        target.packets.contrast.clear();
    }
    const std::vector<Tile> tiles = tilesFromMiddle(state.stale(), 2 * target.pace().tileEdge());
    const Tile all = reducedTile(state.stale(), half.used, target.buffers.size);
    setUniforms(programs, target, call, 1);
    const int drawnBefore = state.halfTilesDone();
    double area = 0;
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        const Tile small = reducedTile(tiles[i], half.used, target.buffers.size);
        area += small.area();
        if (int(i) < state.halfTilesDone()) continue;
        const double left = call.request.budgetMs - millisecondsSince(start);
        if (!target.pace().fits(small.area(), left) && int(i) > drawnBefore) return;
        rasteriseGeometry(shared, target, call, half, all);
        if (programs.packets) programs.packets->picture.begin(half.used, {}, false); // a tile may show nothing
        const RayTile what{.size = half.used,
                           .tile = small,
                           .parts = programs.packets ? nullptr : target.tables.covered(call, half.used),
                           .stepFactor = programs.packets ? 1 : target.demand.cell()};
        target.pace().timeTile([&] { castRays(shared, programs, call, half, what); }, small.area(), true);
        if (programs.packets) {
            const packet::PacketPicture& drawn = programs.packets->picture;
            target.packets.contrast.add(drawn.size, {drawn.box.begin, drawn.box.end}, drawn.rgba);
        }
        present(shared, target, call.scene, half, tiles[i]);
        glBindTextureUnit(0, call.plan.fields[0].texture);
        state.drewHalfTile();
    }
    state.drewHalf();
    target.pace().finishPass(area, target.buffers.everything().area());
}

/// Casts the rays of a tile of a pass into the full buffer.
void castTile(RendererState& shared, ViewTarget& target, const RenderCall& call, const RayPrograms& programs,
              const Tile& tile, int pass) {
    const glm::ivec2 size = target.buffers.size;
    rasteriseGeometry(shared, target, call, target.buffers.full, target.state.stale(), pass);
    const RayTile what{.size = size,
                       .tile = tile,
                       .parts = programs.packets ? nullptr : target.tables.covered(call, size),
                       .stepFactor = programs.packets ? 1 : target.demand.cell(),
                       .pass = pass};
    const auto draw = [&] {
        if (pass == 0)
            castRays(shared, programs, call, target.buffers.full, what);
        else
            accumulate(shared, target, call, programs, what);
    };
    target.pace().timeTile(draw, tile.area(), pass == 0);
}

/// Casts the rays of a pass after the first by packets, where a tile needs them; their picture is then what is known of
/// the tile. False if that is nothing new.
bool addRays(RendererState& shared, ViewTarget& target, const RenderCall& call, const RayPrograms& programs,
             const Tile& tile, int pass) {
    const glm::ivec2 size = target.buffers.size;
    RayBuffer& full = target.buffers.full;
    AddedRays& added = target.packets.added;
    const bool predicts = added.choose(tile);
    const std::vector<packet::PixelBox> boxes = added.blocks(tile);
    if (!boxes.empty()) {
        rasteriseGeometry(shared, target, call, full, target.state.stale(), pass);
        const auto draw = [&] { castBoxes(programs, call, full, {.size = size, .tile = tile, .pass = pass}, boxes); };
        target.pace().timeTile(draw, tile.area(), false);
        added.take(target.packets.picture, tile, pass);
    } else if (!predicts) {
        return false;
    }
    added.show(tile, target.packets.picture);
    storePackets(target.packets.picture, full);
    return true;
}

/// Casts the rays of a pass of a tile; false if its picture has not changed.
bool castPass(RendererState& shared, ViewTarget& target, const RenderCall& call, const RayPrograms& programs,
              const Tile& tile, int pass) {
    if (programs.packets && pass > 0) return addRays(shared, target, call, programs, tile, pass);
    if (programs.packets) programs.packets->picture.begin(target.buffers.size, {}, false); // it may show nothing
    castTile(shared, target, call, programs, tile, pass);
    if (programs.packets && raysPerPixel(call.scene) > 1) target.packets.added.takeFirst(target.packets.picture, tile);
    return true;
}

/// Draws one tile of a pass, with depth of field from the pass's place on the lens, and presents it.
void drawTile(RendererState& shared, ViewTarget& target, const RenderCall& call, const RayPrograms& programs,
              const Tile& tile, int pass) {
    bool changed = true;
    if (pass > 0 && call.scene.camera.aperture > 0) {
        Scene seen = call.scene;
        seen.camera = lensCamera(seen.camera, pass, raysPerPixel(seen));
        const RenderCall own{seen, call.request, call.source, call.plan};
        const RayPrograms all{.packets = programs.packets,
                              .geometry = programs.geometry,
                              .program = programs.program,
                              .beyondPlan = {},
                              .beyondScene = {}};
        setUniforms(all, target, own, 1);
        changed = castPass(shared, target, own, all, tile, pass);
    } else {
        changed = castPass(shared, target, call, programs, tile, pass);
    }
    target.state.drewTile();
    if (!changed) return;
    if (programs.packets && presentsPlainly(call.scene))
        presentPackets(shared, target, call.scene, tile);
    else
        present(shared, target, call.scene, target.buffers.full, tile);
    glBindTextureUnit(0, call.plan.fields[0].texture);
}

/// Whether packets, after all passes, have chosen pixels for further rays, whose passes follow.
bool morePasses(ViewTarget& target, int perPass) {
    if (!target.packets.added.chooseMore()) return false;
    target.state.repeatAfter(perPass);
    return true;
}

/// Draws the stale area tile by tile within the budget: a first pass, then passes with jittered rays for the
/// supersampled frame. After a picture at half resolution by the processor its contrast gives the order.
void drawTiles(RendererState& shared, ViewTarget& target, const RenderCall& call, const RayPrograms& programs,
               Clock::time_point start, bool lit) {
    const FrameRequest& request = call.request;
    PictureState& state = target.state;
    AddedRays& added = target.packets.added;
    const bool adds = programs.packets && raysPerPixel(call.scene) > 1;
    if (adds && state.tilesDone() > 0 && !added.holds(target.buffers.size, state.stale()))
        target.redraw(state.stale()); // something else has cast the first rays
    if (state.tilesDone() == 0) {
        target.pace().beginPass(request.wait, request.budgetMs);
        added = {}; // of a picture that was not refined
        if (adds) added.begin(call.scene, target.buffers.size, state.stale());
    }
    const std::vector<Tile> tiles =
        programs.packets && state.half()
            ? tilesByContrast(state.stale(), target.pace().tileEdge(), target.buffers.size, target.packets.contrast)
            : tilesFromMiddle(state.stale(), target.pace().tileEdge());
    setUniforms(programs, target, call, 1);
    const int perPass = int(tiles.size()), wanted = perPass * raysPerPixel(call.scene);
    for (bool first = true; state.tilesDone() < wanted || (adds && morePasses(target, perPass)); first = false) {
        const Tile& tile = tiles[std::size_t(state.tilesDone() % perPass)];
        const double left = request.budgetMs - millisecondsSince(start);
        if (!request.wait && !first && !target.pace().fits(tile.area(), left)) break;
        drawTile(shared, target, call, programs, tile, state.tilesDone() / perPass);
        if (state.tilesDone() != perPass) continue;
        state.drewPass();
        target.pace().finishPass(state.stale().area(), target.buffers.everything().area());
        if (request.moving) break;
    }
    // Context blur and shadows of depth cross the borders of tiles, so they need the whole picture.
    if ((blursContext(call.scene) || call.scene.depthMask.any()) && state.tilesDone() >= perPass) {
        present(shared, target, call.scene, target.buffers.full, target.buffers.everything());
        glBindTextureUnit(0, call.plan.fields[0].texture);
    }
    if (state.tilesDone() < wanted || !lit) return;
    state.setDone(PictureState::Done::Converged);
    added = {};
}

} // namespace

void sayLimits(RendererState& shared, const RenderCall& call, const std::string& ofEngine) {
    const Scene& scene = call.scene;
    const auto enabled = [](const auto& all) {
        return std::count_if(all.begin(), all.end(), [](const auto& each) { return each.enabled; });
    };
    std::string now;
    if (!scene.lighting.inMaps && enabled(scene.lighting.lights) > kMaxLights)
        now = "the first " + std::to_string(kMaxLights) + " lights are used; with lights in maps any number can be";
    if (enabled(scene.clips) > kMaxClips)
        now += (now.empty() ? "" : "; ") + ("the first " + std::to_string(kMaxClips)) + " clips are used";
    if (enabled(scene.lenses) > kMaxLenses)
        now += (now.empty() ? "" : "; ") + ("the first " + std::to_string(kMaxLenses)) + " lenses are used";
    if (!ofEngine.empty()) now += (now.empty() ? "" : "; ") + ofEngine;
    if (now != shared.limits && !now.empty()) shared.tools.messages.push_back(now);
    shared.limits = now;
}

void drawReduced(RendererState& shared, ViewTarget& target, const RenderCall& call, const RayPrograms& programs,
                 Pace::Reduction how) {
    PictureBuffers& buffers = target.buffers;
    const Tile changed = target.state.changed();
    RayBuffer& reduced = buffers.reduced;
    reduced.used = glm::max(glm::ivec2(glm::vec2(buffers.size) / float(how.shrink)), glm::ivec2(1));
    const Tile tile = reducedTile(changed, reduced.used, buffers.size);
    reduced.first = placeInTiles(tile, reduced.used, buffers.size, shared.tools.driver.sharedTile);
    setUniforms(programs, target, call, how.stepFactor);
    const auto rasterise = [&] { rasteriseGeometry(shared, target, call, reduced, tile); };
    if (call.plan.peels > 0) target.pace().timeGeometry(rasterise);
    const RayTile what{.size = reduced.used,
                       .tile = tile,
                       .parts = programs.packets ? nullptr : target.tables.covered(call, reduced.used),
                       .stepFactor = how.stepFactor * (programs.packets ? 1 : target.demand.cell())};
    target.pace().timeReduced([&] { castRays(shared, programs, call, reduced, what); }, how.stepFactor, tile.area());
    present(shared, target, call.scene, reduced, changed);
    target.state.drewReduced();
    target.hidden.drewReduced();
    glBindTextureUnit(0, call.plan.fields[0].texture);
}

void drawWithin(RendererState& shared, ViewTarget& target, const RenderCall& call, const RayPrograms& programs,
                Clock::time_point start, bool lit) {
    const FrameRequest& request = call.request;
    const PictureState& state = target.state;
    const double left = request.budgetMs - millisecondsSince(start);
    const bool fast = target.pace().known() && target.pace().expected(state.stale().area()) < std::max(left, 1.0);
    if (!request.wait && !fast && (request.moving || !(state.reduced() || state.full()))) {
        drawReduced(shared, target, call, programs,
                    target.pace().reduction(state.changed().area(), left, call.plan.peels > 0));
        if (request.moving) return;
    }
    if (!request.wait && !target.pace().known()) return; // with timer queries the first time comes with a later frame
    const bool slow = !fast && target.pace().expected(state.stale().area()) > kQuick * request.budgetMs;
    if (!request.wait && !state.full() && !state.half() && state.tilesDone() == 0 &&
        (slow || state.halfTilesDone() > 0))
        return drawHalf(shared, target, call, programs, start);
    drawTiles(shared, target, call, programs, start, lit);
}

} // namespace tessera::vis
