#include "vis/technique/ray_plan.h"

#include "vis/gl/texels.h"
#include "vis/technique/brush_uniforms.h"
#include "volume/reconstruct.h"

#include <algorithm>
#include <cmath>

namespace tessera::vis {

namespace {

int fieldOf(RayPlan& plan, const volume::DatasetInfo& info, int channel) {
    for (std::size_t i = 0; i < plan.fields.size(); ++i)
        if (plan.fields[i].channel == channel) return int(i);
    BoundField field;
    field.channel = channel;
    const volume::Channel known = info.channels()[std::size_t(channel)];
    field.categorical = info.parameters[std::size_t(known.parameter)].categorical;
    plan.fields.push_back(field);
    return int(plan.fields.size()) - 1;
}

/// `member` of the i-th use as an expression of i that folds to a constant once a loop is unrolled.
template <class Use, class Member> std::string choice(const std::vector<Use>& uses, Member member) {
    std::string chain = "0";
    for (std::size_t i = uses.size(); i-- > 0;)
        chain = "((i)==" + std::to_string(i) + "?" + std::to_string(int(member(uses[i]))) + ":" + chain + ")";
    return chain;
}

/// The channel a layer shows.
const std::string& channelOf(const Layer& layer) {
    return std::visit([](const auto& technique) -> const std::string& { return technique.channel; }, layer.technique);
}

/// The transfer function of a layer's channel, whatever word the layer names it by, and the range it runs over.
struct ChannelTransfer {
    const TransferFunction& function;
    Range range;
};
ChannelTransfer transferOf(const Scene& scene, const volume::DatasetInfo& info, int channel) {
    const volume::Channel known = info.channels()[std::size_t(channel)];
    const TransferFunction& function = transferFor(scene, known.name);
    return {function, effectiveRange(function, info.channelRange(known))};
}

/// x = texel * first + second is the place of a texel value in a channel's transfer function: the middle of it where
/// the range has no width.
glm::dvec2 transferMap(const BoundField& field, const Scene& scene, const volume::DatasetInfo& info) {
    const Range range = transferOf(scene, info, field.channel).range;
    const double width = range.hi - range.lo;
    if (width == 0) return {0, 0.5};
    return {field.encoding.scale / width, (field.encoding.offset - range.lo) / width};
}

double toTexel(const BoundField& field, double value) {
    return (value - field.encoding.offset) / field.encoding.scale;
}

/// The block grid that all ray layers' channels have in common; null where they have none.
const BlockRanges* commonBlocks(const RayPlan& plan) {
    const BlockRanges* first = nullptr;
    for (const RayLayer& layer : plan.layers) {
        const BlockRanges* blocks = plan.fields[std::size_t(layer.field)].blocks;
        if (!blocks || blocks->min.empty()) return nullptr;
        if (!first) first = blocks;
        if (blocks->level != first->level || blocks->edge != first->edge || blocks->count != first->count)
            return nullptr;
    }
    return first;
}

} // namespace

RayPlan planRays(const Scene& scene, const volume::DatasetInfo& info) {
    RayPlan plan;
    for (std::size_t i = 0; i < scene.layers.size(); ++i) {
        const Layer& layer = scene.layers[i];
        const std::optional<int> channel = info.findChannel(channelOf(layer));
        if (!layer.visible || !channel) continue;
        const int field = fieldOf(plan, info, *channel);
        if (const auto* volume = std::get_if<VolumeLayer>(&layer.technique))
            plan.layers.push_back({int(i), RayStyle(int(volume->style)), field,
                                   volume->shaded && volume->style == VolumeStyle::Composite});
        else if (std::holds_alternative<IsoLayer>(layer.technique))
            plan.layers.push_back({int(i), RayStyle::Iso, field, true});
        else
            plan.slices.push_back({int(i), field});
    }
    if (plan.empty() || !scene.selection.active()) return plan;
    for (const Brush& brush : scene.selection.brushes)
        for (const BrushInterval& interval : brush.intervals) {
            const std::optional<int> channel = info.findChannel(interval.channel);
            if (!brush.enabled || !channel) continue;
            const int field = fieldOf(plan, info, *channel);
            if (std::find(plan.brushFields.begin(), plan.brushFields.end(), field) == plan.brushFields.end())
                plan.brushFields.push_back(field);
        }
    // An enabled brush without a known channel still decides: sample something.
    if (plan.brushFields.empty()) plan.brushFields.push_back(0);
    return plan;
}

ProgramRecipe rayRecipe(const RayPlan& plan, const Scene& scene, const volume::BrickGrid& grid, bool skip) {
    const bool bcc = grid.lattice.kind == volume::LatticeKind::BCC;
    const auto uses = [&](RayStyle style) {
        return std::any_of(plan.layers.begin(), plan.layers.end(),
                           [&](const RayLayer& layer) { return layer.style == style; });
    };
    ProgramRecipe recipe;
    recipe.vertex = "screen.vert.glsl";
    recipe.fragment = "raycast.frag.glsl";
    const bool bricked =
        std::any_of(plan.fields.begin(), plan.fields.end(), [](const BoundField& f) { return f.atlas; });
    recipe.slots["fetch"] = bricked ? "slots/fetch_bricked.glsl" : "slots/fetch_dense.glsl";
    recipe.slots["skip"] = skip ? "slots/skip_distance.glsl" : "slots/skip_none.glsl";
    recipe.slots["reconstruct"] = !bcc                                         ? "slots/recon_cc_linear.glsl"
                                  : scene.render.filter == Filter::Tetrahedral ? "slots/recon_bcc_tetrahedral.glsl"
                                                                               : "slots/recon_bcc_average.glsl";
    const auto define = [&](const char* name, const std::string& value) { recipe.defines.emplace_back(name, value); };
    define("FIELDS", std::to_string(plan.fields.size()));
    define("FIELD_COVERAGE(i)", choice(plan.fields, [](const BoundField& field) { return field.encoding.coverage; }));
    if (bricked) {
        define("FIELD_BRICKS(i)", choice(plan.fields, [](const BoundField& field) {
                   return !field.atlas ? 0 : field.everyBrick ? 2 : 1;
               }));
        define("BRICK_TEXELS", std::to_string(grid.brickSize));
    }
    define("FIELD_NEAREST(i)", choice(plan.fields, [](const BoundField& field) { return field.categorical; }));
    define("LAYERS", std::to_string(plan.layers.size()));
    define("LAYER_STYLE(i)", choice(plan.layers, [](const RayLayer& layer) { return int(layer.style); }));
    define("LAYER_FIELD(i)", choice(plan.layers, [](const RayLayer& layer) { return layer.field; }));
    define("LAYER_SHADED(i)", choice(plan.layers, [](const RayLayer& layer) { return layer.shaded; }));
    define("SLICES", std::to_string(plan.slices.size()));
    define("SLICE_FIELD(i)", choice(plan.slices, [](const SliceUse& slice) { return slice.field; }));
    define("BRUSH_FIELDS", std::to_string(plan.brushFields.size()));
    define("BRUSH_FIELD(i)", choice(plan.brushFields, [](int field) { return field; }));
    define("HAS_ISO", uses(RayStyle::Iso) ? "1" : "0");
    define("HAS_COMPOSITE", uses(RayStyle::Composite) ? "1" : "0");
    define("HAS_PROJECTION", uses(RayStyle::Maximum) || uses(RayStyle::XRay) ? "1" : "0");
    define("FLAT",
           std::none_of(plan.layers.begin(), plan.layers.end(), [](const RayLayer& layer) { return layer.shaded; })
               ? "1"
               : "0");
    define("TABLE_SIZE", std::to_string(kTableSize));
    define("HALO", std::to_string(kHalo));
    define("PRESENT_COVERAGE", std::to_string(volume::kPresentCoverage));
    define("REFERENCE_LENGTHS", std::to_string(1 / kReferenceLength));
    return recipe;
}

std::vector<glm::vec4> transferTables(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info) {
    std::vector<glm::vec4> table;
    const auto add = [&](int field) {
        const auto [function, range] = transferOf(scene, info, plan.fields[std::size_t(field)].channel);
        for (int i = 0; i < kTableSize; ++i) {
            const double value = glm::mix(range.lo, range.hi, double(i) / (kTableSize - 1));
            const glm::dvec4 at = evaluate(function, range, value);
            table.emplace_back(glm::vec3(linearFromSrgb(glm::dvec3(at))), float(at.a));
        }
    };
    for (const RayLayer& layer : plan.layers) add(layer.field);
    for (const SliceUse& slice : plan.slices) add(slice.field);
    for (std::size_t row = 0; row < plan.layers.size(); ++row)
        for (int i = 0; i < kTableSize; ++i) {
            const std::size_t at = row * kTableSize + std::size_t(i);
            table.emplace_back(glm::vec3(0), std::max(table[at].a, table[at + (i + 1 < kTableSize)].a));
        }
    return table;
}

namespace {

void setCamera(const Program& program, const Scene& scene, double aspect) {
    const Ray middle = cameraRay(scene.camera, aspect, {0, 0});
    const Ray right = cameraRay(scene.camera, aspect, {1, 0}), up = cameraRay(scene.camera, aspect, {0, 1});
    // Directions scaled to reach the same plane are linear in the picture.
    const auto onPlane = [&](glm::dvec3 d) { return d / glm::dot(d, middle.direction) - middle.direction; };
    program.set("rayOrigin", glm::vec3(middle.origin));
    program.set("rayOriginX", glm::vec3(right.origin - middle.origin));
    program.set("rayOriginY", glm::vec3(up.origin - middle.origin));
    program.set("rayDirection", glm::vec3(middle.direction));
    program.set("rayDirectionX", glm::vec3(onPlane(right.direction)));
    program.set("rayDirectionY", glm::vec3(onPlane(up.direction)));
    program.set("rayBegin", scene.camera.projection == Projection::Perspective ? 0.0f : -1e6f);
}

void setLayers(const Program& program, const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info,
               const WorldFrame& frame) {
    std::vector<glm::vec4> maps, slices, planes;
    std::vector<glm::vec3> colors;
    for (const RayLayer& use : plan.layers) {
        const Layer& layer = scene.layers[std::size_t(use.layer)];
        const BoundField& field = plan.fields[std::size_t(use.field)];
        if (const auto* iso = std::get_if<IsoLayer>(&layer.technique)) {
            maps.emplace_back(1, 0, toTexel(field, iso->value), iso->opacity);
            colors.emplace_back(linearFromSrgb(glm::dvec3(iso->color)));
        } else {
            const auto& volume = std::get<VolumeLayer>(layer.technique);
            maps.emplace_back(transferMap(field, scene, info), volume.density, 1);
            colors.emplace_back(1);
        }
    }
    for (const SliceUse& use : plan.slices) {
        const auto& slice = std::get<SliceLayer>(scene.layers[std::size_t(use.layer)].technique);
        const Plane plane = slicePlane(slice, frame, scene.cursor);
        planes.emplace_back(plane.normal, plane.offset);
        slices.emplace_back(transferMap(plan.fields[std::size_t(use.field)], scene, info), slice.contours,
                            slice.opacity);
    }
    program.set("layerMap", maps);
    program.set("layerColor", colors);
    program.set("slicePlane", planes);
    program.set("sliceMap", slices);
}

void setFields(const Program& program, const RayPlan& plan, const volume::BrickGrid& grid) {
    std::vector<glm::vec3> scales, offsets, odds;
    std::vector<glm::vec3> inverses;
    std::vector<int> levels, units, pages, atlases;
    const RayUnits first = rayUnits(plan);
    for (const BoundField& field : plan.fields) {
        // Texel i of level l covers the sample at cell i * 2^l + phase; its centre is at i + halo + 1/2 in the texture.
        const double step = double(1 << field.level);
        const glm::dvec3 size(field.textureSize);
        scales.emplace_back(1.0 / step / size);
        offsets.emplace_back((kHalo + 0.5 - grid.levelPhase(field.level) / step) / size);
        odds.emplace_back(-0.5 / step / size);
        levels.push_back(field.level);
        inverses.emplace_back(1.0f / glm::vec3(field.atlasSize));
        const int i = int(units.size());
        units.push_back(i);
        pages.push_back(first.pages + i);
        atlases.push_back(first.atlases + i);
    }
    program.set("fieldTexture", units);
    program.set("fieldScale", scales);
    program.set("fieldOffset", offsets);
    program.set("fieldOdd", odds);
    program.set("fieldLevel", levels);
    program.set("pageTable", pages);
    program.set("atlas", atlases);
    program.set("atlasInverse", inverses);
    program.set("transferTable", first.table);
    program.set("blockDistance", first.blocks);
}

} // namespace

RayUnits rayUnits(const RayPlan& plan) {
    const int n = int(plan.fields.size());
    const bool bricked =
        std::any_of(plan.fields.begin(), plan.fields.end(), [](const BoundField& f) { return f.atlas; });
    RayUnits units;
    units.pages = n;
    units.atlases = 2 * n;
    units.table = bricked ? 3 * n : n;
    units.blocks = units.table + 1;
    return units;
}

void setRayUniforms(const Program& program, const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info,
                    const volume::BrickGrid& grid, double aspect, double stepFactor) {
    const WorldFrame frame = worldFrame(info.bounds, scene.stretch);
    const glm::dvec3 cellsPerWorld = 1.0 / (frame.scale * grid.lattice.spacing);
    const RenderParams& render = scene.render;
    setCamera(program, scene, aspect);
    setFields(program, plan, grid);
    setLayers(program, plan, scene, info, frame);
    setBrushUniforms(program, plan, scene, info);
    // A data set of one layer has no thickness: enough of it to meet a slice.
    program.set("halfSize", glm::vec3(glm::max(frame.halfSize, glm::dvec3(1e-5))));
    program.set("worldCell", glm::vec3(worldCell(grid.lattice, frame)));
    program.set("stepVoxels", float(render.stepVoxels * stepFactor));
    program.set("cellsPerWorld", glm::vec3(cellsPerWorld));
    program.set("cellsOffset", glm::vec3((-frame.offset / frame.scale - grid.lattice.origin) / grid.lattice.spacing));
    program.set("gradientDelta", float(gradientDelta(grid.lattice.kind)));
    program.set("axisCount", 3);
    program.set("bisections", kBisections);
    program.set("toLight", glm::vec3(lightDirection(render, scene.camera)));
    program.set("light", glm::vec4(render.ambient, render.diffuse, render.specular, render.shininess));
    if (const BlockRanges* blocks = commonBlocks(plan)) {
        const double edge = double(1 << blocks->level) * blocks->edge;
        program.set("blockScale", glm::vec3(float(1 / edge)));
        program.set("blockOffset", glm::vec3(float(-grid.levelPhase(blocks->level) / edge)));
    }
}

namespace {

/// Whether some texel value between lo and hi gets opacity from a transfer function; asks a running maximum free table.
bool anyOpacity(const std::vector<float>& opacity, glm::dvec2 map, float lo, float hi) {
    const auto place = [&](double texel) { return std::clamp(texel * map.x + map.y, 0.0, 1.0) * (kTableSize - 1); };
    double a = place(lo), b = place(hi);
    if (a > b) std::swap(a, b);
    for (auto i = std::size_t(std::floor(a)); i <= std::size_t(std::ceil(b)); ++i)
        if (opacity[i] > 0) return true;
    return false;
}

/// Chebyshev distance of every block to the nearest one whose distance is 0, in place.
void spread(std::vector<std::uint8_t>& distance, glm::ivec3 count) {
    const std::size_t strides[] = {1, std::size_t(count.x), std::size_t(count.x) * std::size_t(count.y)};
    // Two chamfer sweeps over all 26 neighbours give the exact Chebyshev distance.
    const auto relax = [&](int x, int y, int z, bool forward) {
        const std::size_t at = std::size_t(x) + strides[1] * std::size_t(y) + strides[2] * std::size_t(z);
        int best = distance[at];
        for (int dz = -1; dz <= 1 && best > 0; ++dz)
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    const int order = dz * 9 + dy * 3 + dx;
                    if (forward ? order >= 0 : order <= 0) continue;
                    const int nx = x + dx, ny = y + dy, nz = z + dz;
                    if (nx < 0 || ny < 0 || nz < 0 || nx >= count.x || ny >= count.y || nz >= count.z) continue;
                    best = std::min(
                        best,
                        1 + distance[std::size_t(nx) + strides[1] * std::size_t(ny) + strides[2] * std::size_t(nz)]);
                }
        distance[at] = std::uint8_t(std::min(best, 255));
    };
    for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x) relax(x, y, z, true);
    for (int z = count.z - 1; z >= 0; --z)
        for (int y = count.y - 1; y >= 0; --y)
            for (int x = count.x - 1; x >= 0; --x) relax(x, y, z, false);
}

} // namespace

std::optional<BlockDistances> blockDistances(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info) {
    const BlockRanges* grid = commonBlocks(plan);
    if (!grid) return std::nullopt;
    BlockDistances out;
    out.count = grid->count;
    const std::size_t total = grid->min.size();
    out.distance.assign(total, 255);
    for (const RayLayer& use : plan.layers) {
        const BoundField& field = plan.fields[std::size_t(use.field)];
        const Layer& layer = scene.layers[std::size_t(use.layer)];
        const BlockRanges& blocks = *field.blocks;
        std::vector<float> opacity;
        glm::dvec2 map{0};
        double value = 0;
        if (use.style == RayStyle::Iso) {
            value = toTexel(field, std::get<IsoLayer>(layer.technique).value);
        } else {
            map = transferMap(field, scene, info);
            const TransferFunction function = transferOf(scene, info, field.channel).function;
            for (int i = 0; i < kTableSize; ++i)
                opacity.push_back(float(evaluate(function, {0, 1}, double(i) / (kTableSize - 1)).a));
        }
        for (std::size_t i = 0; i < total; ++i) {
            if (!(blocks.min[i] <= blocks.max[i])) continue;
            // Rounding of the texture and of its interpolation.
            const float slack = 1e-4f, lo = blocks.min[i] - slack, hi = blocks.max[i] + slack;
            bool shows = true;
            if (use.style == RayStyle::Iso) shows = lo <= value && value <= hi;
            if (use.style == RayStyle::Composite) shows = anyOpacity(opacity, map, lo, hi);
            if (shows) out.distance[i] = 0;
        }
    }
    std::size_t occupied = 0;
    out.begin = out.count;
    for (std::size_t i = 0; i < total; ++i)
        if (out.distance[i] == 0) {
            ++occupied;
            const glm::ivec3 at(int(i % std::size_t(out.count.x)),
                                int(i / std::size_t(out.count.x) % std::size_t(out.count.y)),
                                int(i / std::size_t(out.count.x) / std::size_t(out.count.y)));
            out.begin = glm::min(out.begin, at);
            out.end = glm::max(out.end, at + 1);
        }
    out.occupied = total ? double(occupied) / double(total) : 1;
    spread(out.distance, out.count);
    return out;
}

} // namespace tessera::vis
