#include "vis/view/view_tables.h"

#include "vis/raycast/block_steps.h"
#include "vis/raycast/lens_uniforms.h"
#include "vis/raycast/ray_field.h"
#include "vis/raycast/ray_tables.h"
#include "vis/shapes/proxy.h"

#include <algorithm>
#include <array>

namespace tessera::vis {

namespace {

constexpr double kSkipOccupancy =
    0.7; ///< share of occupied blocks above which empty-space skipping costs more than it saves
constexpr double kWorthSteps = 0.6;       ///< the same for adaptive steps: share of the samples that remain
constexpr std::uint8_t kStepTexels = 128; ///< texels of the block distance texture from this value on are step codes

/// The block distance texture: distances, at most kStepTexels - 1 if there are steps, or kStepTexels + step code.
std::vector<std::uint8_t> blockTexels(const BlockDistances& blocks, const std::vector<std::uint8_t>& steps) {
    std::vector<std::uint8_t> texels = blocks.distance;
    for (std::size_t i = 0; i < steps.size(); ++i)
        if (texels[i] > 0)
            texels[i] = std::min(texels[i], std::uint8_t(kStepTexels - 1));
        else if (steps[i] > 0)
            texels[i] = std::uint8_t(kStepTexels + steps[i]);
    return texels;
}

/// Approximate share of samples that remain with empty-space skipping and adaptive steps.
double workLeft(const BlockDistances& blocks, const std::vector<std::uint8_t>& steps, const Scene& scene,
                const volume::DatasetInfo& info, const volume::Lattice& lattice) {
    std::array<double, kMostSteps + 1> left;
    for (int code = 0; code <= kMostSteps; ++code)
        left[std::size_t(code)] = samplesLeft(code, scene, info, lattice, kBlockTexels);
    double sum = 0;
    for (std::size_t i = 0; i < steps.size(); ++i) sum += blocks.distance[i] == 0 ? left[steps[i]] : 0;
    return steps.empty() ? 1 : sum / double(steps.size());
}

} // namespace

Scene tablesScene(const Scene& scene, const volume::DatasetInfo& info) {
    static const RenderParams kUnused;
    Scene used = scene;
    used.camera = {};
    used.cursor = glm::dvec3(0);
    for (Lens& lens : used.lenses) lens.enabled = activeAt(lens, scene.time);
    used.time = 0; // covered by the frames in the key
    used.geometry.clear();
    used.strokes.clear();
    used.clips.clear();
    used.lighting = {};
    used.tone = {};
    used.depthMask = {};
    used.background = used.boxColor = glm::vec3(0);
    used.paper.reset();
    used.showGround = used.showBox = false;
    // Layers depend on the presence of their lenses, and brushes may be confined to some; the positions of lenses do
    // not count.
    for (Lens& lens : used.lenses) lens = {.name = lens.name, .enabled = lens.enabled, .effect = lens.effect};
    used.render.limits = kUnused.limits;
    used.render.detail = kUnused.detail;
    used.render.importance = kUnused.importance;
    used.render.gradient = kUnused.gradient;
    used.render.normalBits = kUnused.normalBits;
    used.render.proxy = kUnused.proxy;
    used.render.jitter = kUnused.jitter;
    used.render.samples = kUnused.samples;
    used.render.cullHidden = kUnused.cullHidden;
    if (stepsAdapt(scene, info)) return used;
    used.render.adaptiveStep = 0;
    used.render.stepVoxels = kUnused.stepVoxels;
    return used;
}

const TablesContent& ViewTables::update(const RenderCall& call, std::uint64_t resident,
                                        const std::vector<ChannelKey>& frames) {
    const TablesContent& content = content_.get(TablesKey{tablesScene(call.scene, call.info()), resident, frames},
                                                [&](const TablesKey& key) { return make(key, call); });
    for (std::size_t i = 0; i < call.plan.layers.size(); ++i) call.plan.layers[i].opaque = content.opaque[i];
    return content;
}

TablesContent ViewTables::make(const TablesKey& key, const RenderCall& call) {
    const RayPlan& plan = call.plan;
    const volume::DatasetInfo& info = call.info();
    TablesContent made;
    const std::optional<BlockDistances> blocks = blockDistances(plan, key.scene, info);
    std::vector<std::uint8_t> steps = blockSteps(plan, key.scene, info, call.grid().lattice);
    const double work = blocks && !steps.empty() ? workLeft(*blocks, steps, key.scene, info, call.grid().lattice) : 1;
    // Of long data there may be more blocks in a row than a texture holds: then no rays leap.
    const bool fits =
        blocks && std::max({blocks->count.x, blocks->count.y, blocks->count.z}) <= longestEdge(GL_TEXTURE_3D);
    made.adaptive = fits && work < kWorthSteps * blocks->occupied;
    made.skip = made.adaptive || (fits && blocks->occupied < kSkipOccupancy);
    if (!made.adaptive) steps.clear();
    covered_.clear();
    if (blocks)
        made.occupied = occupiedBoxes(*blocks, *commonBlocks(plan), call.grid(), worldFrame(info, key.scene.stretch));
    const std::vector<glm::vec4> table = transferTables(plan, key.scene, info);
    made.opaque = opaqueIntervals(plan, table);
    uploadTransfer(table);
    uploadPlanes(plan, key.scene, info);
    if (made.skip) uploadBlocks(*blocks, steps);
    return made;
}

void ViewTables::uploadTransfer(const std::vector<glm::vec4>& table) {
    const int rows = int(table.size()) / kTableSize;
    if (rows == 0) return;
    if (rows != tableRows_) table_ = makeTexture1DArray(kTableSize, rows, GL_RGBA32F, GL_LINEAR, "transfer tables");
    tableRows_ = rows;
    glTextureSubImage2D(table_.name(), 0, 0, 0, kTableSize, rows, GL_RGBA, GL_FLOAT, table.data());
}

void ViewTables::uploadPlanes(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info) {
    if (plan.pages == 0) return;
    const std::vector<glm::vec4> planes = planeTables(plan, scene, info);
    const glm::ivec2 size(kPlaneSize, kPlaneSize * plan.pages);
    if (plan.pages != planePages_) planes_ = makeTexture2D(size, GL_RGBA32F, GL_LINEAR, "plane tables");
    planePages_ = plan.pages;
    glTextureSubImage2D(planes_.name(), 0, 0, 0, size.x, size.y, GL_RGBA, GL_FLOAT, planes.data());
}

void ViewTables::uploadBlocks(const BlockDistances& blocks, const std::vector<std::uint8_t>& steps) {
    if (blockCount_ != blocks.count || !blocks_)
        blocks_ = makeTexture3D(blocks.count, GL_R8UI, GL_NEAREST, "block distances");
    blockCount_ = blocks.count;
    const std::vector<std::uint8_t> texels = blockTexels(blocks, steps);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage3D(blocks_.name(), 0, 0, 0, 0, blocks.count.x, blocks.count.y, blocks.count.z, GL_RED_INTEGER,
                        GL_UNSIGNED_BYTE, texels.data());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

void ViewTables::bind(const RayUnits& units) const {
    glBindTextureUnit(GLuint(units.table), table_.name());
    glBindTextureUnit(GLuint(units.blocks), blocks_.name());
    glBindTextureUnit(GLuint(units.planes), planes_.name());
}

const std::vector<Tile>* ViewTables::covered(const RenderCall& call, glm::ivec2 size) {
    const RayPlan& plan = call.plan;
    const std::optional<std::vector<OccupiedBox>>& occupied = content_.value().occupied;
    if (!occupied || plan.layers.empty() || !plan.slices.empty() || plan.peels > 0 || lensesBend(call.scene) ||
        drawnByProxy(call.scene))
        return nullptr;
    return &covered_.get(CoveredKey{call.scene.camera, size},
                         [&](const CoveredKey& key) { return coveredPixels(key.camera, *occupied, key.size); });
}

} // namespace tessera::vis
