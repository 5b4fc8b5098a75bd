#include "vis/packet/packet_scene.h"

#include "vis/optics/ray_setup.h"
#include "vis/packet/packet_table.h"
#include "vis/transfer/block_distance.h"

#include <algorithm>
#include <cmath>

namespace tessera::vis::packet {

namespace {

constexpr double kSlack = 2; ///< of bounds, in 16-bit samples, for rounding

VolumeView viewOf(const PacketVolume& volume) {
    VolumeView view;
    view.shorts = volume.exact ? nullptr : volume.shorts.data();
    view.floats = volume.exact ? volume.floats.data() : nullptr;
    view.present = volume.present.empty() ? nullptr : volume.present.data();
    view.bcc = volume.bcc;
    view.cells = volume.cells;
    view.oddOffset = volume.brickPairs();
    const int brick = volume.stride(), row = brick * volume.bricks.x, slice = row * volume.bricks.y;
    view.perBrick = {brick - kBrick, row - kBrick * kRow, slice - kBrick * kSlice};
    return view;
}

} // namespace

/// The samples of a layer, where they lie in its transfer function, its brushes and lens; not yet its table.
LayerView PacketScene::viewOfLayer(const Layer& layer, Range range, std::size_t index) const {
    const PacketVolume& volume = *volumes_[index];
    const double width = range.hi - range.lo;
    LayerView out;
    out.volume = &views_[index];
    out.brushes = layer.brushes;
    if (!layer.lens.empty()) out.lens = findLens(lenses_, layer.lens);
    out.placeScale = width != 0 ? float(volume.scale / width) : 0;
    out.placeOffset = width != 0 ? float((volume.offset - range.lo) / width) : 0.5f;
    return out;
}

/// Gives a layer its table.
void PacketScene::setTable(LayerView& layer, const Table& table) {
    layer.opacityScale = table.opacityScale;
    tables_.push_back(table.entries);
    layer.table = tables_.back().data();
}

/// `index` of a volume: that of the slice.
void PacketScene::addSlice(const Scene& scene, const volume::DatasetInfo& info, const DrawnChannel& drawn,
                           std::size_t index) {
    const Layer& layer = scene.layers[std::size_t(drawn.layer)];
    const auto [function, range] = transferOfLayer(scene, info, layer, drawn.channel.channel);
    SliceView out;
    out.look = viewOfLayer(layer, range, index);
    setTable(out.look, makeTable(function, range));
    slices_.push_back(out);
    sliceLayers_.push_back(drawn.layer);
}

/// Where the slices of a scene lie, and what else of them needs no other tables.
void PacketScene::placeSlices(const Scene& scene, const WorldFrame& frame) {
    for (std::size_t i = 0; i < slices_.size(); ++i) {
        const auto& slice = std::get<SliceLayer>(scene.layers[std::size_t(sliceLayers_[i])].technique);
        slices_[i].plane = slicePlane(slice, frame, scene.cursor);
        slices_[i].contours = slice.contours;
        slices_[i].opacity = slice.opacity;
    }
}

/// `index` of a volume: that of the layer.
void PacketScene::addLayer(const Scene& scene, const volume::DatasetInfo& info, const DrawnChannel& drawn,
                           std::size_t index) {
    const Layer& layer = scene.layers[std::size_t(drawn.layer)];
    const PacketVolume& volume = *volumes_[index];
    const auto [function, range] = transferOfLayer(scene, info, layer, drawn.channel.channel);
    const double width = range.hi - range.lo;
    LayerView out = viewOfLayer(layer, range, index);
    const Table table = makeTable(function, range);
    setTable(out, table);
    packed_.push_back(packedTable(function, range));
    out.packed = packed_.back().data();
    markShown(table, out);
    const glm::dvec2 map(out.placeScale, out.placeOffset);
    const int edge = skip_.edge;
    const double slack = volume.exact ? kSlack / 2 / kQuantum : kSlack;
    std::function<bool(float, float)> shows = [](float, float) { return true; };
    const OpacityRanges opaque(table.opacity, map);
    if (const auto* iso = std::get_if<IsoLayer>(&layer.technique)) {
        out.style = RayStyle::Iso;
        out.isoValue = float((iso->value - volume.offset) / volume.scale);
        out.isoOpacity = iso->opacity;
        out.isoColor = glm::vec3(linearFromSrgb(glm::dvec3(iso->color)));
        shows = [&](float lo, float hi) {
            return double(lo) - slack <= double(out.isoValue) && double(out.isoValue) <= double(hi) + slack;
        };
    } else {
        const auto& own = std::get<VolumeLayer>(layer.technique);
        out.style = own.style;
        out.shaded = own.shaded;
        out.density = own.density;
        out.threshold = float(std::max(0.0, (own.threshold - range.lo) / width));
        if (own.style == RayStyle::Composite || own.style == RayStyle::XRay)
            shows = [&](float lo, float hi) {
                return opaque.any(float(double(lo) - slack), float(double(hi) + slack));
            };
    }
    layers_.push_back(out);
    skip_ = united(std::move(skip_), fullBlocks(volume, edge, shows));
}

namespace {

/// Largest score of each block of a maximum or minimum, rounded up.
std::vector<std::uint8_t> scoreBounds(const PacketVolume& volume, const LayerView& layer, const SkipMap& map) {
    std::vector<std::uint8_t> out(map.blocks() + 3); // they are read four at a time
    std::size_t i = 0;
    const int factor = map.edge / kFine;
    for (int z = 0; z < map.count.z; ++z)
        for (int y = 0; y < map.count.y; ++y)
            for (int x = 0; x < map.count.x; ++x, ++i) {
                double best = 0;
                const glm::ivec3 first = glm::ivec3(x, y, z) * factor, last = glm::min(first + factor, volume.blocks);
                for (int fz = first.z; fz < last.z; ++fz)
                    for (int fy = first.y; fy < last.y; ++fy)
                        for (int fx = first.x; fx < last.x; ++fx) {
                            const std::size_t block =
                                (std::size_t(fz) * std::size_t(volume.blocks.y) + std::size_t(fy)) *
                                    std::size_t(volume.blocks.x) +
                                std::size_t(fx);
                            if (!(volume.lo[block] <= volume.hi[block])) continue;
                            for (const float bound : {volume.lo[block], volume.hi[block]}) {
                                const double place = std::clamp(
                                    double(bound) * double(layer.placeScale) + double(layer.placeOffset), 0.0, 1.0);
                                best = std::max(best, layer.style == RayStyle::Minimum ? 1 - place : place);
                            }
                        }
                out[i] = std::uint8_t(std::min(255.0, std::ceil(best * 255 + 0.01)));
            }
    return out;
}

} // namespace

/// Brushes in samples of the volumes that follow those of the layers.
void PacketScene::addBrushes(const Scene& scene, const volume::DatasetInfo& info) {
    const std::vector<int> channels = brushedChannels(scene, info);
    const std::size_t first = volumes_.size() - channels.size();
    for (std::size_t i = first; i < volumes_.size(); ++i) fields_.push_back(&views_[i]);
    const BrushTests found = brushTests(scene.selection, info, channels, lenses_);
    for (const LassoRegion& lasso : found.lassos) lassos_.push_back(lassoTable(lasso));
    for (const BrushTest& test : found.tests) {
        BrushView out;
        out.kind = test.kind;
        out.flags = test.flags;
        out.x = test.x;
        out.y = test.y;
        out.soft = test.soft;
        out.correlation = test.correlation;
        out.color = glm::vec3(test.color);
        out.holds = test.color.a > 0;
        const auto volumeOf = [&](int field) -> const PacketVolume& { return *volumes_[first + std::size_t(field)]; };
        const bool space = test.kind == BrushTestKind::Sphere || test.kind == BrushTestKind::Box;
        if (space) {
            out.center = glm::vec3(glm::dvec3(test.place) + double(kMargin));
            out.inverseRadius = glm::vec3(test.inverseRadius);
        } else if (test.kind == BrushTestKind::Range && test.x >= 0) {
            const PacketVolume& volume = volumeOf(test.x);
            out.place = glm::vec4((glm::dvec2(test.place) - volume.offset) / volume.scale, 0, 0);
            out.soft = test.soft / volume.scale;
        } else if (test.kind != BrushTestKind::Lens && test.x >= 0) {
            const PacketVolume &a = volumeOf(test.x), &b = volumeOf(test.y);
            out.place = glm::dvec4((test.place.x - a.offset) / a.scale, (test.place.y - b.offset) / b.scale,
                                   a.scale / test.place.z, b.scale / test.place.w);
            if (test.kind == BrushTestKind::Lasso) out.lasso = lassos_[std::size_t(test.table)].doi.data();
        }
        brushes_.push_back(out);
    }
    focus_.brushes = brushes_;
    focus_.fields = fields_;
    focus_.start = found.start;
    focus_.contextOpacity = scene.selection.contextOpacity;
    focus_.brushColor = scene.selection.brushColor;
    focus_.context = {double(scene.selection.contextSaturation), double(scene.selection.contextLightness)};
}

PacketScene::PacketScene(const Scene& scene, const volume::DatasetInfo& info, std::vector<SharedVolume> volumes)
    : volumes_(std::move(volumes)) {
    const std::vector<DrawnChannel> drawn = drawnChannels(scene, info);
    for (const SharedVolume& volume : volumes_) views_.push_back(viewOf(*volume));
    lenses_ = placeLenses(scene, worldFrame(info.bounds, scene.stretch));
    addBrushes(scene, info);
    tables_.reserve(drawn.size());
    // Small blocks pay where rays soon end at surfaces.
    const auto techniqueOf = [&](const DrawnChannel& each) -> const Technique& {
        return scene.layers[std::size_t(each.layer)].technique;
    };
    const bool surfaces = std::ranges::all_of(drawn, [&](const DrawnChannel& each) {
        const auto* volume = std::get_if<VolumeLayer>(&techniqueOf(each));
        return !volume || (volume->style == RayStyle::Composite && volume->shaded);
    });
    skip_.edge = surfaces ? kFine : 2 * kFine;
    std::vector<const PacketVolume*> sampled; // along rays
    for (std::size_t i = 0; i < drawn.size(); ++i)
        if (std::holds_alternative<SliceLayer>(techniqueOf(drawn[i]))) {
            addSlice(scene, info, drawn[i], i);
        } else {
            addLayer(scene, info, drawn[i], i);
            sampled.push_back(volumes_[i].get());
        }
    if (layers_.size() == 1 && (layers_[0].style == RayStyle::Maximum || layers_[0].style == RayStyle::Minimum))
        bound_ = scoreBounds(*sampled[0], layers_[0], skip_);
    for (std::size_t i = drawn.size(); i < volumes_.size(); ++i) sampled.push_back(volumes_[i].get());
    for (const PacketVolume* const volume : sampled) {
        if (volume->absent.empty()) continue;
        absent_.resize(volume->absent.size());
        for (std::size_t i = 0; i < absent_.size(); ++i) absent_[i] = std::uint8_t(absent_[i] | volume->absent[i]);
    }
    if (!absent_.empty()) absent_.resize(absent_.size() + 3);
}

namespace {

/// The octants that rays go into, a bit each; a little beyond the picture, because rays are moved within their pixels.
unsigned octantsOf(const CastJob& job) {
    const glm::dvec3 spread = 1.1 * (glm::abs(job.directionX) + glm::abs(job.directionY));
    const glm::dvec3 cells = glm::sign(job.cellsPerWorld);
    unsigned out = 0;
    for (unsigned octant = 0; octant < 8; ++octant) {
        bool some = true;
        for (int axis = 0; axis < 3; ++axis) {
            const double way = (octant >> axis & 1) != 0 ? cells[axis] : -cells[axis];
            some = some && job.direction[axis] * way + spread[axis] >= 0;
        }
        out |= unsigned(some) << octant;
    }
    return out;
}

} // namespace

CastJob PacketScene::job(const Scene& scene, const volume::DatasetInfo& info, const volume::Lattice& lattice,
                         glm::ivec2 size, double stepFactor) {
    const WorldFrame frame = worldFrame(info.bounds, scene.stretch);
    CastJob job;
    job.size = size;
    const double aspect = double(size.x) / size.y;
    const Ray middle = cameraRay(scene.camera, aspect, {0, 0});
    const Ray right = cameraRay(scene.camera, aspect, {1, 0}), up = cameraRay(scene.camera, aspect, {0, 1});
    // Ray directions scaled to reach the same plane are linear in the picture.
    const glm::dvec3 forward = forwardOf(scene.camera), ahead = middle.direction / glm::dot(middle.direction, forward);
    const auto onPlane = [&](glm::dvec3 d) { return d / glm::dot(d, forward) - ahead; };
    job.origin = middle.origin;
    job.originX = right.origin - middle.origin;
    job.originY = up.origin - middle.origin;
    job.direction = ahead;
    job.directionX = onPlane(right.direction);
    job.directionY = onPlane(up.direction);
    job.begin = scene.camera.projection == Projection::Perspective ? 0.0f : -1e6f;
    // A data set of a single slice has no thickness; give it enough for rays to meet it.
    job.halfSize = glm::max(frame.halfSize, glm::dvec3(1e-5));
    job.cell = worldCell(lattice, frame);
    job.edges = lattice.spacing * frame.scale;
    job.cellsPerWorld = 1.0 / job.edges;
    job.cellsOffset = (-frame.offset / frame.scale - lattice.origin) / lattice.spacing + double(kMargin);
    job.stepVoxels = float(double(scene.render.stepVoxels) * stepFactor);
    clips_ = placeClips(scene.clips, frame);
    job.clips = clips_;
    job.layers = layers_;
    placeSlices(scene, frame);
    job.slices = slices_;
    lenses_ = placeLenses(scene, frame);
    job.focus = focus_;
    job.focus.lenses = lenses_;
    job.focus.any = !brushes_.empty() || !lenses_.empty();
    job.stencil = volume::gradientStencil(lattice.kind, scene.render.gradient);
    lighting_ = scene.lighting;
    lights_ = placeLights(scene.lighting, scene.camera);
    job.surface = &lighting_;
    job.lights = lights_;
    job.jitterStarts = scene.render.jitter;
    if (empty()) return job;
    job.bcc = volumes_[0]->bcc;
    job.exact = volumes_[0]->exact;
    if (layers_.empty()) return job;
    countAlike(skip_, octantsOf(job));
    job.skip.alike = skip_.alike.data();
    job.skip.count = skip_.count;
    job.skip.edge = skip_.edge;
    job.skip.absent = absent_.empty() ? nullptr : absent_.data();
    job.skip.fine = volumes_[0]->blocks;
    if (!bound_.empty()) job.skip.bound = bound_.data();
    return job;
}

} // namespace tessera::vis::packet
