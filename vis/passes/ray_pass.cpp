#include "vis/passes/renderer_impl.h"

#include "vis/demand/box_lines.h"
#include "vis/demand/lens_pixels.h"
#include "vis/optics/jitter.h"
#include "vis/optics/proxy.h"
#include "vis/raycast/block_steps.h"
#include "vis/raycast/lens_uniforms.h"
#include "vis/raycast/ray_field.h"
#include "vis/raycast/ray_tables.h"
#include "vis/raycast/ray_uniforms.h"
#include "volume/base/error.h"

#include <algorithm>
#include <array>

namespace tessera::vis {

namespace {

constexpr double kSkipOccupancy = 0.7;    ///< above, leaping costs more than it saves
constexpr double kWorthSteps = 0.6;       ///< share of the samples left above which longer steps do
constexpr std::uint8_t kStepTexels = 128; ///< in the texture of block distances: from here on codes of steps

/// What the shader sees: distances, at most kStepTexels - 1 where there are steps, or kStepTexels and a step's code.
std::vector<std::uint8_t> blockTexels(const BlockDistances& blocks, const std::vector<std::uint8_t>& steps) {
    std::vector<std::uint8_t> texels = blocks.distance;
    for (std::size_t i = 0; i < steps.size(); ++i)
        if (texels[i] > 0)
            texels[i] = std::min(texels[i], std::uint8_t(kStepTexels - 1));
        else if (steps[i] > 0)
            texels[i] = std::uint8_t(kStepTexels + steps[i]);
    return texels;
}

/// Whether two scenes whose layers and functions are the same have the same longer steps.
bool sameSteps(const Scene& a, const Scene& b, const volume::DatasetInfo& info) {
    const bool adapts = stepsAdapt(a, info);
    if (adapts != stepsAdapt(b, info)) return false;
    return !adapts || (a.render.adaptiveStep == b.render.adaptiveStep && a.render.stepVoxels == b.render.stepVoxels);
}

/// Whether layers come and go with their lenses, and brushes are confined, alike; where lenses lie is the camera's.
bool sameLenses(const Scene& a, const Scene& b) {
    const auto acts = [](const Lens& x, const Lens& y) {
        return x.name == y.name && x.enabled == y.enabled && x.effect == y.effect;
    };
    return std::ranges::equal(a.lenses, b.lenses, acts);
}

} // namespace

/// About the share of all samples that is taken where empty blocks are leapt over and steps are longer.
double Renderer::Impl::workLeft(const BlockDistances& blocks, const std::vector<std::uint8_t>& steps,
                                const Scene& scene) const {
    std::array<double, kMostSteps + 1> left;
    for (int code = 0; code <= kMostSteps; ++code)
        left[std::size_t(code)] = samplesLeft(code, scene, source->info(), source->grid().lattice, kBlockTexels);
    double sum = 0;
    for (std::size_t i = 0; i < steps.size(); ++i) sum += blocks.distance[i] == 0 ? left[steps[i]] : 0;
    return steps.empty() ? 1 : sum / double(steps.size());
}

/// The program variant that a bound plan wants.
ProgramRecipe Renderer::Impl::variant(const ViewTarget& target, const Scene& scene, const RayPlan& plan) const {
    ProgramRecipe made = rayRecipe(plan, scene, source->grid(), target.skip && !lensesBend(scene));
    if (options.countSamples) made.defines.emplace_back("COUNT_SAMPLES", "1");
    if (target.adaptive && made.slots["skip"] == "slots/skip_distance.glsl") made.defines.emplace_back("ADAPTIVE", "1");
    if (findsHidden(scene)) made.defines.emplace_back("REACH", "1");
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
        sameSteps(*target.tablesFor, scene, source->info()) && target.tablesKeys == target.shown &&
        target.tablesFor->selection == scene.selection && target.tablesFor->stretch == scene.stretch &&
        sameLenses(*target.tablesFor, scene))
        return recipe();
    target.tablesFor = scene;
    target.tablesRevision = residency.revision();
    target.tablesKeys = target.shown;

    const std::optional<BlockDistances> blocks = blockDistances(plan, scene, source->info());
    std::vector<std::uint8_t> steps = blockSteps(plan, scene, source->info(), source->grid().lattice);
    const double work = blocks && !steps.empty() ? workLeft(*blocks, steps, scene) : 1;
    target.adaptive = blocks && work < kWorthSteps * blocks->occupied;
    target.skip = target.adaptive || (blocks && blocks->occupied < kSkipOccupancy);
    if (!target.adaptive) steps.clear();
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
        const std::vector<std::uint8_t> texels = blockTexels(*blocks, steps);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        glTextureSubImage3D(target.blocks.name(), 0, 0, 0, 0, blocks->count.x, blocks->count.y, blocks->count.z,
                            GL_RED_INTEGER, GL_UNSIGNED_BYTE, texels.data());
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
    const float nothing[] = {0, 0, 0, 0}, nowhere[] = {-1e9f, 0, 0, 0}, unseen[] = {0, 0, 0, 0};
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, buffer.framebuffer.name());
    glViewport(buffer.first.x, buffer.first.y, size.x, size.y);
    glEnable(GL_SCISSOR_TEST);
    const auto within = [&](glm::ivec2 from, glm::ivec2 to) {
        glScissor(buffer.first.x + from.x, buffer.first.y + from.y, to.x - from.x, to.y - from.y);
    };
    within(tile.begin, tile.end);
    glClearNamedFramebufferfv(buffer.framebuffer.name(), GL_COLOR, 0, nothing);
    glClearNamedFramebufferfv(buffer.framebuffer.name(), GL_COLOR, 1, nowhere);
    glClearNamedFramebufferfv(buffer.framebuffer.name(), GL_COLOR, 2, unseen);
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
    rays(rayPrograms, scene, target.reduced, target.size, tile, parts, target.cell, pass);
    average->set("source", 0);
    average->set("sourceReach", 1);
    glBindTextureUnit(0, target.reduced.color.name());
    glBindTextureUnit(1, target.reduced.reach.name());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.full.framebuffer.name());
    glScissor(tile.begin.x, tile.begin.y, tile.end.x - tile.begin.x, tile.end.y - tile.begin.y);
    glUseProgram(average->name());
    glBindVertexArray(vertices.name()); // of a tile beside the box no ray was drawn
    glEnablei(GL_BLEND, 0);
    glBlendColor(0, 0, 0, 1 / float(pass + 1));
    glBlendFunc(GL_CONSTANT_ALPHA, GL_ONE_MINUS_CONSTANT_ALPHA);
    glColorMaski(1, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glEnablei(GL_BLEND, 2); // the farthest of all passes
    glBlendEquationi(2, GL_MAX);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBlendEquationi(2, GL_FUNC_ADD);
    glDisablei(GL_BLEND, 2);
    glDisablei(GL_BLEND, 0);
    glColorMaski(1, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

} // namespace tessera::vis
