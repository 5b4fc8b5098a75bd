#include "vis/renderer_impl.h"

#include "vis/model/context_blur.h"
#include "vis/model/grain.h"
#include "vis/model/jitter.h"
#include "vis/model/proxy.h"
#include "vis/technique/box_lines.h"
#include "vis/technique/lens_pixels.h"
#include "vis/technique/lens_uniforms.h"
#include "vis/technique/look_uniforms.h"
#include "vis/technique/ray_field.h"
#include "vis/technique/ray_tables.h"
#include "vis/technique/ray_uniforms.h"
#include "volume/error.h"

#include <algorithm>
#include <cmath>

namespace tessera::vis {

namespace {

constexpr double kSkipOccupancy = 0.7; ///< above, leaping costs more than it saves
constexpr int kSeenUnit = 44;          ///< beyond those of any plan

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

/// The program variant that a bound plan wants.
ProgramRecipe Renderer::Impl::variant(const ViewTarget& target, const Scene& scene, const RayPlan& plan) const {
    ProgramRecipe made = rayRecipe(plan, scene, source->grid(), target.skip && !lensesBend(scene));
    if (options.countSamples) made.defines.emplace_back("COUNT_SAMPLES", "1");
    return made;
}

/// Tables of a bound plan and its program variant.
ProgramRecipe Renderer::Impl::prepare(ViewTarget& target, const Scene& scene, RayPlan& plan) {
    const auto recipe = [&] {
        for (std::size_t i = 0; i < plan.layers.size(); ++i) plan.layers[i].opaque = target.opaque[i];
        return variant(target, scene, plan);
    };
    // Tables depend on these alone; a camera that moves keeps them.
    if (target.tablesFor && target.tablesRevision == residency.revision() && target.tablesFor->layers == scene.layers &&
        target.tablesFor->transfer == scene.transfer && target.tablesFor->render.filter == scene.render.filter &&
        target.tablesKeys == target.shown && target.tablesFor->selection == scene.selection &&
        target.tablesFor->stretch == scene.stretch)
        return recipe();
    target.tablesFor = scene;
    target.tablesRevision = residency.revision();
    target.tablesKeys = target.shown;

    const std::optional<BlockDistances> blocks = blockDistances(plan, scene, source->info());
    target.skip = blocks && blocks->occupied < kSkipOccupancy;
    target.occupied.reset();
    target.coveredFor.reset();
    if (blocks)
        target.occupied = occupiedBoxes(*blocks, *commonBlocks(plan), source->grid(),
                                        worldFrame(source->info().bounds, scene.stretch));
    const std::vector<glm::vec4> table = transferTables(plan, scene, source->info());
    target.opaque = opaqueIntervals(plan, table);
    const int rows = int(table.size()) / kTableSize;
    if (rows > 0 && rows != target.tableRows) {
        target.table = makeTexture1DArray(kTableSize, rows, GL_RGBA32F, GL_LINEAR, "transfer tables");
        target.tableRows = rows;
    }
    if (rows > 0) glTextureSubImage2D(target.table.name(), 0, 0, 0, kTableSize, rows, GL_RGBA, GL_FLOAT, table.data());
    if (plan.pages > 0) {
        const std::vector<glm::vec4> planes = planeTables(plan, scene, source->info());
        const glm::ivec2 size(kPlaneSize, kPlaneSize * plan.pages);
        if (plan.pages != target.planePages) target.planes = makeTexture2D(size, GL_RGBA32F, GL_LINEAR, "plane tables");
        target.planePages = plan.pages;
        glTextureSubImage2D(target.planes.name(), 0, 0, 0, size.x, size.y, GL_RGBA, GL_FLOAT, planes.data());
    }
    if (target.skip) {
        if (target.blockCount != blocks->count || !target.blocks)
            target.blocks = makeTexture3D(blocks->count, GL_R8UI, GL_NEAREST, "block distances");
        target.blockCount = blocks->count;
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        glTextureSubImage3D(target.blocks.name(), 0, 0, 0, 0, blocks->count.x, blocks->count.y, blocks->count.z,
                            GL_RED_INTEGER, GL_UNSIGNED_BYTE, blocks->distance.data());
        glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    }
    return recipe();
}

/// Rasterises the geometry for a tile of a picture of this size, unless that is what the target has; of a reduced one
/// the two nearest surfaces.
void Renderer::Impl::geometry(ViewTarget& target, const Scene& scene, const RayPlan& plan, glm::ivec2 size,
                              const Tile& tile, int pass) {
    const int peels = peelsOf(scene);
    if (peels == 0) return;
    const int most = size == target.size ? peels : std::min(peels, 2);
    if (target.geometrySize != size || target.geometryPass != pass ||
        united(target.geometryTile, tile) != target.geometryTile) {
        target.geometry.resize(target.size, peels);
        const glm::ivec2 first = size == target.size ? glm::ivec2(0) : target.reduced.first;
        geometryPass.draw(target.geometry, scene, source->info(), size, first, tile, target.size, most,
                          rayUnits(plan).light, grain, pixelJitter(pass));
        target.geometrySize = size;
        target.geometryTile = tile;
        target.geometryPass = pass;
    }
    glBindTextureUnit(GLuint(RayUnits::kGeometry), target.geometry.color.name());
    glBindTextureUnit(GLuint(RayUnits::kGeometry) + 1, target.geometry.distance.name());
}

/// Blends the proxy surfaces front to back into the part of the buffer that is cleared and in the scissor.
void Renderer::Impl::proxies(const Program& program, const Scene& scene, const RayBuffer& buffer, double stepFactor) {
    const WorldFrame frame = worldFrame(source->info().bounds, scene.stretch);
    const ProxySurfaces surfaces = proxySurfaces(scene, source->grid().lattice, frame, stepFactor);
    program.set("proxyShells", surfaces.shells ? 1 : 0);
    program.set("proxyNormal", glm::vec3(surfaces.normal));
    program.set("proxyFirst", float(surfaces.first));
    program.set("proxySpacing", float(surfaces.spacing));
    const float unknown[] = {1e9f, 0, 0, 0};
    glClearNamedFramebufferfv(buffer.framebuffer.name(), GL_COLOR, 1, unknown);
    glUseProgram(program.name());
    glEnable(GL_BLEND);
    glBlendFunci(0, GL_ONE_MINUS_DST_ALPHA, GL_ONE);
    glBlendEquationi(1, GL_MIN); // the nearest noticeable surface
    glDrawArraysInstanced(GL_TRIANGLES, 0, 3, surfaces.count);
    glBlendEquation(GL_FUNC_ADD);
    glDisable(GL_BLEND);
}

/// The part of a picture that rays can see anything in; null: all of it.
const std::vector<Tile>* Renderer::Impl::covered(ViewTarget& target, const Scene& scene, const RayPlan& plan,
                                                 glm::ivec2 size) {
    if (!target.occupied || plan.layers.empty() || !plan.slices.empty() || plan.peels > 0 || lensesBend(scene) ||
        drawnByProxy(scene))
        return nullptr;
    if (target.coveredFor != scene.camera || target.coveredSize != size) {
        target.covered = coveredPixels(scene.camera, *target.occupied, size);
        target.coveredFor = scene.camera;
        target.coveredSize = size;
    }
    return &target.covered;
}

/// Draws a tile with the rays of a pass; of it what lies in one of `parts`.
void Renderer::Impl::rays(const RayPrograms& rayPrograms, const Scene& scene, const RayBuffer& buffer, glm::ivec2 size,
                          const Tile& tile, const std::vector<Tile>* parts, double stepFactor, int pass) {
    const float nothing[] = {0, 0, 0, 0}, nowhere[] = {-1e9f, 0, 0, 0};
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, buffer.framebuffer.name());
    glViewport(buffer.first.x, buffer.first.y, size.x, size.y);
    glEnable(GL_SCISSOR_TEST);
    const auto within = [&](glm::ivec2 from, glm::ivec2 to) {
        glScissor(buffer.first.x + from.x, buffer.first.y + from.y, to.x - from.x, to.y - from.y);
    };
    within(tile.begin, tile.end);
    glClearNamedFramebufferfv(buffer.framebuffer.name(), GL_COLOR, 0, nothing);
    glClearNamedFramebufferfv(buffer.framebuffer.name(), GL_COLOR, 1, nowhere);
    // Only where the box is.
    const glm::ivec4 box = boxPixels(scene.camera, worldFrame(source->info().bounds, scene.stretch).halfSize, size);
    const glm::ivec2 begin = glm::max(tile.begin, glm::ivec2(box)), end = glm::min(tile.end, glm::ivec2(box.z, box.w));
    if (begin.x >= end.x || begin.y >= end.y) return;
    within(begin, end);
    const std::vector<Tile> whole{{begin, end}};
    glBindVertexArray(vertices.name());
    const auto prepare = [&](const Program& program) {
        program.set("ndcScale", 2.0f / glm::vec2(size));
        program.set("ndcOffset",
                    glm::vec2((pixelJitter(pass) - glm::dvec2(buffer.first)) * 2.0 / glm::dvec2(size) - 1.0));
        program.set("passNumber", pass);
        glUseProgram(program.name());
    };
    prepare(*rayPrograms.program);
    if (drawnByProxy(scene)) return proxies(*rayPrograms.program, scene, buffer, stepFactor);
    const auto draw = [&](std::span<const Tile> where) {
        for (const Tile& part : parts ? *parts : whole)
            for (const Tile& each : where) {
                const Tile drawn = intersection(whole.front(), intersection(part, each));
                if (drawn.empty()) continue;
                within(drawn.begin, drawn.end);
                glDrawArrays(GL_TRIANGLES, 0, 3);
            }
    };
    const std::optional<std::vector<Tile>> lensed =
        rayPrograms.beyond ? lensTiles(scene, worldFrame(source->info().bounds, scene.stretch), size) : std::nullopt;
    if (!lensed) return draw(whole);
    draw(*lensed);
    prepare(*rayPrograms.beyond);
    draw(remainder(whole.front(), *lensed));
}

/// Draws pass n > 0 of a supersampled still, beside, and makes it one n + 1-th of the picture. (Not by blending the
/// rays themselves: software GL would compile their program anew. What a pixel picks stays that of its middle.)
void Renderer::Impl::accumulate(const RayPrograms& rayPrograms, ViewTarget& target, const Scene& scene,
                                const Tile& tile, const std::vector<Tile>* parts, int pass) {
    const Program* average = programs.find({"screen.vert.glsl", "accumulate.frag.glsl", {}, {}});
    if (!average) throw Error("the program that averages passes does not compile");
    target.reducedValid = false;
    target.reduced.first = {0, 0};
    rays(rayPrograms, scene, target.reduced, target.size, tile, parts, 1, pass);
    average->set("source", 0);
    glBindTextureUnit(0, target.reduced.color.name());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.full.framebuffer.name());
    glScissor(tile.begin.x, tile.begin.y, tile.end.x - tile.begin.x, tile.end.y - tile.begin.y);
    glUseProgram(average->name());
    glEnablei(GL_BLEND, 0);
    glBlendColor(0, 0, 0, 1 / float(pass + 1));
    glBlendFunc(GL_CONSTANT_ALPHA, GL_ONE_MINUS_CONSTANT_ALPHA);
    glColorMaski(1, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDisablei(GL_BLEND, 0);
    glColorMaski(1, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void Renderer::Impl::present(ViewTarget& target, const Scene& scene, bool reduced, const Tile& tile) {
    const bool blurs = blursContext(scene), toned = scene.tone.curve != ToneCurve::None;
    const std::optional<Paper> paper = paperOf(scene);
    const bool rough = paper && paper->tooth > 0;
    BoxLines lines;
    if (scene.showBox && source)
        lines = boxLines(scene.camera, worldFrame(source->info().bounds, scene.stretch).halfSize, target.size);
    const auto flag = [](bool on) { return std::string(on ? "1" : "0"); };
    const Program* found = programs.find({"screen.vert.glsl",
                                          "resolve.frag.glsl",
                                          {},
                                          {{"BLUR", flag(blurs)},
                                           {"LINES", flag(!lines.edges.empty())},
                                           {"TONE", flag(toned)},
                                           {"PAPER", flag(rough)},
                                           {"GROUND", flag(scene.showGround)}}});
    if (!found) throw Error("the program that presents pictures does not compile");
    const Program& resolve = *found;
    const RayBuffer& from = reduced ? target.reduced : target.full;
    const glm::vec2 used(reduced ? target.reducedSize : target.size), whole(from.size), first(from.first);
    resolve.set("source", 0);
    resolve.set("sourceScale", used / glm::vec2(target.size) / whole);
    resolve.set("sourceFirst", first / whole);
    resolve.set("sourceLimit", (first + used - 0.5f) / whole);
    resolve.set("background", glm::vec3(linearFromSrgb(glm::dvec3(groundColor(scene)))));
    if (rough) {
        resolve.set("paper", glm::vec2(paper->tooth, kGrainTexels / double(paper->grain)));
        resolve.set("grainTile", RayUnits::kPaper);
        glBindTextureUnit(GLuint(RayUnits::kPaper), grain.get());
    }
    resolve.set("boxColor", glm::vec3(linearFromSrgb(glm::dvec3(scene.boxColor))));
    resolve.set("lineWidth", 1.3f);
    resolve.set("toneCurve", int(scene.tone.curve));
    resolve.set("seen", kSeenUnit);
    resolve.set("blurRadius", scene.selection.contextBlur * float(target.size.y));
    resolve.set("blurTaps", kBlurTaps);
    if (blurs) glBindTextureUnit(GLuint(kSeenUnit), from.pick.name());
    resolve.set("tone", glm::vec2(std::exp2(scene.tone.exposure), scene.tone.white));
    resolve.set("edgeCount", int(lines.edges.size()));
    resolve.set("frontCount", lines.front);
    resolve.set("edges", lines.edges);
    glBindTextureUnit(0, from.color.name());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.outputFramebuffer.name());
    glViewport(0, 0, target.size.x, target.size.y);
    glEnable(GL_SCISSOR_TEST);
    glScissor(tile.begin.x, tile.begin.y, tile.end.x - tile.begin.x, tile.end.y - tile.begin.y);
    glUseProgram(resolve.name());
    glBindVertexArray(vertices.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    target.shows = true;
}

/// Says once when lights or clips are left out.
void Renderer::Impl::sayLimits(const Scene& scene) {
    const auto enabled = [](const auto& all) {
        return std::count_if(all.begin(), all.end(), [](const auto& each) { return each.enabled; });
    };
    std::string now;
    if (!scene.lighting.inMaps && enabled(scene.lighting.lights) > kMaxLights)
        now = "the first " + std::to_string(kMaxLights) + " lights are used; light through maps takes any number";
    if (enabled(scene.clips) > kMaxClips)
        now += (now.empty() ? "" : "; ") + ("the first " + std::to_string(kMaxClips)) + " clips are used";
    if (enabled(scene.lenses) > kMaxLenses)
        now += (now.empty() ? "" : "; ") + ("the first " + std::to_string(kMaxLenses)) + " lenses are used";
    if (now != limits && !now.empty()) messages.push_back(now);
    limits = now;
}

/// Brings cube maps and light volume up to date and binds them; false while a light volume is still being made.
bool Renderer::Impl::bindLight(ViewTarget& target, const Scene& scene, const FrameRequest& request,
                               const RayPlan& plan) {
    sayLimits(scene);
    bool surrounded = true;
    const GLuint first = GLuint(rayUnits(plan).light);
    if (usesMaps(scene.lighting)) {
        const std::uint64_t former = target.lightMaps.version();
        surrounded = target.lightMaps.update(scene.lighting, scene.camera, request.wait,
                                             [&](const std::string& message) { messages.push_back(message); });
        if (target.mapsPending && target.lightMaps.version() != former) target.redraw(target.everything());
        target.mapsPending = !surrounded;
        glBindTextureUnit(first, target.lightMaps.diffuse());
        glBindTextureUnit(first + 1, target.lightMaps.specular());
        glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    }
    if (!scene.lighting.shadows.any()) return surrounded;
    if (plan.layers.empty() && (plan.peels == 0 || !scene.lighting.shadows.meshes)) { // slices alone cast no shadow
        glBindTextureUnit(first + 2, noShadow.name());
        glBindTextureUnit(first + 3, noLight.name());
        return surrounded;
    }
    ProgramRecipe recipe = rayRecipe(plan, scene, source->grid(), false);
    recipe.vertex = "screen.vert.glsl";
    recipe.fragment = "light_matter.frag.glsl";
    const ProgramAnswer answer = request.wait ? ProgramAnswer{programs.find(recipe), ProgramStage::Ready}
                                              : programs.request(recipe, request.budgetMs / 4);
    glBindTextureUnit(first + 2, target.light.version() > 0 ? target.light.visible() : noShadow.name());
    glBindTextureUnit(first + 3, target.light.scattered() != 0 ? target.light.scattered() : noLight.name());
    if (!answer.program) return request.wait || answer.stage == ProgramStage::Failed;
    const auto setUniforms = [&](const Program& program) {
        setRayUniforms(program, plan, scene, source->info(), source->grid(), target.size, 1);
    };
    target.light.update(scene, source->info(), {residency.revision(), target.lastTime.value_or(0)}, *answer.program,
                        setUniforms, vertices.name(), request.budgetMs / 3, request.wait);
    if (target.lightVersion != target.light.version()) {
        target.lightVersion = target.light.version();
        target.redraw(target.everything());
    }
    glBindTextureUnit(first + 2, target.light.version() > 0 ? target.light.visible() : noShadow.name());
    glBindTextureUnit(first + 3, target.light.scattered() != 0 ? target.light.scattered() : noLight.name());
    return surrounded && target.light.ready();
}

/// The background alone: nothing is loaded, or the program does not compile.
void Renderer::Impl::nothing(ViewTarget& target, const Scene& scene) {
    const float empty[] = {0, 0, 0, 0}, nowhere[] = {-1e9f, 0, 0, 0};
    glDisable(GL_SCISSOR_TEST);
    glClearNamedFramebufferfv(target.full.framebuffer.name(), GL_COLOR, 0, empty);
    glClearNamedFramebufferfv(target.full.framebuffer.name(), GL_COLOR, 1, nowhere);
    present(target, scene, false, target.everything());
    target.fullValid = target.stillDone = true;
}

/// Draws as much of the bound plan as the budget allows.
void Renderer::Impl::refine(ViewTarget& target, const Scene& scene, const FrameRequest& request, RayPlan& plan,
                            Clock::time_point start) {
    if (target.fullValid ? target.stillDone || request.moving : target.reducedValid && request.moving) return;
    const ProgramRecipe recipe = prepare(target, scene, plan);
    const ProgramAnswer answer = request.wait ? ProgramAnswer{programs.find(recipe), ProgramStage::Ready}
                                              : programs.request(recipe, request.budgetMs / 4);
    // A variant that is being compiled, or does not compile, leaves the former picture as it is.
    if (!answer.program) {
        if (!target.shows || request.wait) nothing(target, scene);
        target.fullValid = target.stillDone = answer.stage == ProgramStage::Failed || request.wait;
        return;
    }
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
    const bool lit = bindLight(target, scene, request, plan);

    // Brings a program to where it can draw; false while that is on its way.
    const auto ready = [&](const ProgramAnswer& program, const ProgramRecipe& made, const RayPlan& drawn,
                           const Scene& shown) {
        if (!program.program) return false;
        const bool linked = program.stage == ProgramStage::Linked;
        if (!linked && !programs.firstUse(*program.program)) return true;
        setRayUniforms(*program.program, drawn, shown, info, source->grid(), target.size, 1);
        if (linked) {
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
    if (!ready(answer, recipe, plan, scene)) return;
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
    const auto setUniforms = [&](double stepFactor) {
        setRayUniforms(*rayPrograms.program, plan, scene, info, source->grid(), target.size, stepFactor);
        if (rayPrograms.beyond)
            setRayUniforms(*rayPrograms.beyond, beyond, lensless, info, source->grid(), target.size, stepFactor);
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
             covered(target, scene, plan, target.reducedSize), stepFactor);
        glFinish();
        const double cost = millisecondsSince(begin) * stepFactor / std::max(1.0, tile.area());
        target.msPerPixel = target.msPerPixel > 0 ? 0.5 * (target.msPerPixel + cost) : cost;
        target.reducedValid = true;
        present(target, scene, true, target.changed);
        target.changed = {};
        glBindTextureUnit(0, plan.fields[0].texture);
    };
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
            rays(rayPrograms, scene, target.full, target.size, tile, covered(target, scene, plan, target.size));
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
