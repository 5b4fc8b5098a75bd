#include "vis/raycast/ray_uniforms.h"

#include "vis/raycast/brush_uniforms.h"
#include "vis/raycast/clip_uniforms.h"
#include "vis/raycast/lens_uniforms.h"
#include "vis/raycast/light_uniforms.h"
#include "vis/raycast/look_uniforms.h"
#include "vis/raycast/ray_field.h"
#include "vis/raycast/stroke_uniforms.h"

#include <algorithm>
#include <cmath>

namespace tessera::vis {

namespace {

void setCamera(const Program& program, const Scene& scene, double aspect) {
    const Ray middle = cameraRay(scene.camera, aspect, {0, 0});
    const Ray right = cameraRay(scene.camera, aspect, {1, 0}), up = cameraRay(scene.camera, aspect, {0, 1});
    // Ray directions scaled to reach the same plane are linear in the picture.
    const glm::dvec3 forward = forwardOf(scene.camera), ahead = middle.direction / glm::dot(middle.direction, forward);
    const auto onPlane = [&](glm::dvec3 d) { return d / glm::dot(d, forward) - ahead; };
    program.set("rayOrigin", glm::vec3(middle.origin));
    program.set("rayOriginX", glm::vec3(right.origin - middle.origin));
    program.set("rayOriginY", glm::vec3(up.origin - middle.origin));
    program.set("rayDirection", glm::vec3(ahead));
    program.set("rayDirectionX", glm::vec3(onPlane(right.direction)));
    program.set("rayDirectionY", glm::vec3(onPlane(up.direction)));
    program.set("rayBegin", scene.camera.projection == Projection::Perspective ? 0.0f : -1e6f);
}

void setLayers(const Program& program, const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info,
               const WorldFrame& frame) {
    std::vector<glm::vec4> maps, slices, planes;
    std::vector<glm::vec3> colors;
    std::vector<glm::vec2> more, colorMaps;
    for (const RayLayer& use : plan.layers) {
        const Layer& layer = scene.layers[std::size_t(use.layer)];
        const BoundField& field = plan.fields[std::size_t(use.field)];
        if (const auto* iso = std::get_if<IsoLayer>(&layer.technique)) {
            maps.emplace_back(1, 0, toTexel(field, iso->value), iso->opacity);
            colors.emplace_back(linearFromSrgb(glm::dvec3(iso->color)));
            const double top = double(drawnChannel(scene, info, field).function->gradientTop);
            more.emplace_back(std::abs(transferMap(field, scene, info).x) / top, 0);
        } else {
            const auto& volume = std::get<VolumeLayer>(layer.technique);
            const glm::dvec2 map = transferMap(field, scene, info);
            const double top = double(drawnChannel(scene, info, field).function->gradientTop);
            maps.emplace_back(map, volume.density, 1);
            colors.emplace_back(linearFromSrgb(glm::dvec3(kNoValueColor)));
            // A threshold below the range excludes nothing.
            more.emplace_back(std::abs(map.x) / top, std::max(toTexel(field, volume.threshold) * map.x + map.y, 0.0));
        }
        colorMaps.emplace_back(use.color >= 0 ? transferMap(plan.fields[std::size_t(use.color)], scene, info)
                                              : glm::dvec2(0));
    }
    for (const SliceUse& use : plan.slices) {
        const auto& slice = std::get<SliceLayer>(scene.layers[std::size_t(use.layer)].technique);
        const Plane plane = slicePlane(slice, frame, scene.cursor);
        planes.emplace_back(plane.normal, plane.offset);
        slices.emplace_back(transferMap(plan.fields[std::size_t(use.field)], scene, info), slice.contours,
                            slice.opacity);
    }
    std::vector<glm::vec2> opaque;
    for (const RayLayer& use : plan.layers) opaque.push_back(use.opaque.value_or(glm::vec2(0)));
    program.set("layerOpaque", opaque);
    program.set("layerMap", maps);
    program.set("layerColor", colors);
    program.set("layerMore", more);
    program.set("layerColorMap", colorMaps);
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
    std::vector<glm::vec3> frames;
    for (int i = 0; i < plan.later; ++i) {
        const BoundField& earlier = plan.fields[std::size_t(i)];
        const TexelEncoding &from = plan.fields[std::size_t(i + plan.later)].encoding, &to = earlier.encoding;
        frames.emplace_back(from.scale / to.scale, (from.offset - to.offset) / to.scale, earlier.laterWeight);
    }
    if (!frames.empty()) program.set("laterFrame", frames);
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
    program.set("levelPhase", float(grid.phase));
    program.set("lassoTables", first.lassos);
    program.set("geometryColor", RayUnits::kGeometry);
    program.set("geometryDistance", RayUnits::kGeometry + 1);
    program.set("planeTable", first.planes);
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
    units.lassos = units.blocks + 1;
    units.planes = units.blocks + 2;
    units.light = units.planes + 1;
    units.grain = units.light + 4;
    return units;
}

void setRayUniforms(const Program& program, const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info,
                    const volume::BrickGrid& grid, glm::ivec2 size, double stepFactor) {
    const WorldFrame frame = worldFrame(info, scene.stretch);
    const glm::dvec3 cellsPerWorld = 1.0 / (frame.scale * grid.lattice.spacing);
    const RenderParams& render = scene.render;
    setCamera(program, scene, double(size.x) / size.y);
    setFields(program, plan, grid);
    setLayers(program, plan, scene, info, frame);
    setStrokeUniforms(program, plan, scene, RayUnits::kStrokes);
    setBrushUniforms(program, plan, scene.selection);
    // A data set of a single slice has no thickness; give it enough for rays to intersect a slice.
    program.set("halfSize", glm::vec3(glm::max(frame.halfSize, glm::dvec3(1e-5))));
    program.set("worldCell", glm::vec3(worldCell(grid.lattice, frame)));
    program.set("stepVoxels", float(render.stepVoxels * stepFactor));
    program.set("cellsPerWorld", glm::vec3(cellsPerWorld));
    program.set("cellsOffset", glm::vec3((-frame.offset / frame.scale - grid.lattice.origin) / grid.lattice.spacing));
    const volume::GradientStencil stencil = volume::gradientStencil(grid.lattice.kind, render.gradient);
    const double cell = volume::smoothReach(grid.lattice.kind, 1); // as in worldCell()
    program.set("gradientReach", float(stencil.reach));
    program.set("gradientScale", float(cell / (stencil.reach * stencil.squares)));
    program.set("gradientDirections", stencil.count);
    program.set("diagonals", 4);
    program.set("bisections", kBisections);
    program.set("cubicCorners", 8);
    program.set("latticeCorners", grid.lattice.kind == volume::LatticeKind::BCC ? 16 : 8);
    setLightUniforms(program, scene, frame, rayUnits(plan).light);
    setClipUniforms(program, scene, frame);
    setLensUniforms(program, plan.lenses);
    setLookUniforms(program, looksOf(plan, scene), scene, frame, grid.lattice, size, rayUnits(plan).grain);
    program.set("stepUnit", float(stepUnit(worldCell(grid.lattice, frame))));
    if (const BlockRanges* blocks = commonBlocks(plan)) {
        const double edge = double(1 << blocks->level) * blocks->edge;
        program.set("blockScale", glm::vec3(float(1 / edge)));
        program.set("blockOffset", glm::vec3(float(-grid.levelPhase(blocks->level) / edge)));
    }
}

} // namespace tessera::vis
