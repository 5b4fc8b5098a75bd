#include "vis/packet/packet_scene.h"

#include "vis/optics/ray_setup.h"
#include "vis/packed/packed_box.h"
#include "vis/packet/packet_table.h"
#include "vis/transfer/block_distance.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tessera::vis::packet {

namespace {

constexpr double kSlack = 2; ///< of bounds, in 16-bit samples, for rounding

} // namespace

VolumeView viewOf(const PacketVolume& volume) {
    VolumeView view;
    view.shorts = volume.exact ? nullptr : volume.shorts.data();
    view.floats = volume.exact ? volume.floats.data() : nullptr;
    view.present = volume.present.empty() ? nullptr : volume.present.data();
    view.bcc = volume.bcc;
    view.labels = volume.labels;
    view.cubic = volume.cubic;
    view.cells = volume.cells;
    view.oddOffset = volume.brickPairs();
    view.partCount = int(volume.parts.size());
    const int brick = volume.stride(), row = brick * volume.bricks.x, slice = row * volume.bricks.y;
    view.perBrick = {brick - kBrick, row - kBrick * kRow, slice - kBrick * kSlice};
    return view;
}

namespace {

/// A table of a transfer function, and where the samples of a volume lie in it: place = sample * x + y.
struct Tabled {
    Table table;
    glm::vec2 places;
    glm::vec2 toRange{1, 0}; ///< LayerView::toRange
};

/// `alone`: each sample is classified by itself, as in composite layers and slices. Then a range without width
/// separates values below and above, and labels lie on entries; else all places are those of the range.
Tabled tabled(const DrawnChannel& drawn, const PacketVolume& volume, bool alone, bool regions = false) {
    const TransferFunction& function = *drawn.function;
    const Range range = drawn.range;
    const double width = range.hi - range.lo;
    if (width == 0) {
        constexpr double kSteep = 1e12;
        if (!alone) return {makeTable(function, range), glm::vec2(0, 0.5f)};
        return {makeTable(function, {0, 1}, {}, regions),
                glm::vec2(volume.scale * kSteep, 0.5 + (volume.offset - range.lo) * kSteep)};
    }
    Range domain = range;
    const double first = std::floor(range.lo), labels = std::ceil(range.hi) - first;
    if (alone && volume.labels && labels > 0 && labels < kTableEntries)
        domain = {first, first + (kTableEntries - 1) / std::floor((kTableEntries - 1) / labels)};
    const double over = domain.hi - domain.lo;
    return {makeTable(function, range, domain, regions),
            glm::vec2(volume.scale / over, (volume.offset - domain.lo) / over),
            glm::vec2(over / width, (domain.lo - range.lo) / width)};
}

} // namespace

namespace {

StrokesView strokesOfSlice(const Scene& scene, int layer, const Strokes& strokes) {
    const StrokePicture* const picture = strokesOf(scene, layer);
    if (!picture) return {};
    const StrokeMap map = strokeMap(*picture);
    return {&picture->texels.data()->x, picture->size,    glm::vec4(map.across),
            glm::vec4(map.up),          strokes.strength, strokes.grey};
}

} // namespace

/// The samples of a layer, where they lie in its transfer function, its brushes and lens; not yet its table.
LayerView PacketScene::viewOfLayer(const DrawnLayer& layer, glm::vec2 places, std::size_t index) const {
    LayerView out;
    out.volume = &views_[index];
    out.brushes = layer.brushes;
    out.lens = layer.lens;
    out.placeScale = places.x;
    out.placeOffset = places.y;
    return out;
}

/// Keeps a table.
const std::int32_t* PacketScene::keep(std::vector<std::int32_t> entries) {
    tables_.push_back(std::move(entries));
    return tables_.back().data();
}

IntegralView PacketScene::integralsOf(const TransferFunction& function, Range range) {
    SegmentSums made = segmentSums(function, range);
    return {keep(std::move(made.sums)) + 4, made.extinction};
}

/// `index` of a volume: that of the colouring channel.
ColorView PacketScene::colorsOf(const DrawnLayer& drawn, std::size_t index) {
    Tabled own = tabled(*drawn.colors, *volumes_[index], true);
    return {.volume = &views_[index],
            .placeScale = own.places.x,
            .placeOffset = own.places.y,
            .table = keep(std::move(own.table.entries)),
            .absent = glm::vec3(linearFromSrgb(glm::dvec3(drawn.surface ? drawn.surface->color : kNoValueColor)))};
}

/// `index` of a volume: that of the slice.
void PacketScene::addSlice(const DrawnLayer& drawn, std::size_t index) {
    const Range range = drawn.shown.range;
    Tabled own = tabled(drawn.shown, *volumes_[index], true);
    SliceView out;
    out.look = viewOfLayer(drawn, own.places, index);
    out.look.table = keep(std::move(own.table.entries));
    const double width = range.hi - range.lo;
    out.levelScale = width != 0 ? float(volumes_[index]->scale / width) : 0;
    out.levelOffset = width != 0 ? float((volumes_[index]->offset - range.lo) / width) : 0;
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
        slices_[i].strokes = strokesOfSlice(scene, sliceLayers_[i], slice.strokes);
    }
}

/// `index` of a volume: that of the layer.
void PacketScene::addLayer(const DrawnLayer& drawn, std::size_t index) {
    const PacketVolume& volume = *volumes_[index];
    const TransferFunction& function = *drawn.shown.function;
    const Range range = drawn.shown.range;
    const double width = range.hi - range.lo;
    const VolumeLayer* const own = drawn.volume;
    const bool alone = own && own->style == RayStyle::Composite && !drawn.gradient, regions = drawn.byRegions;
    const auto [table, places, toRange] = tabled(drawn.shown, volume, alone, regions);
    LayerView out = viewOfLayer(drawn, places, index);
    out.opacityScale = table.opacityScale;
    out.table = keep(table.entries);
    const bool segments = drawn.classification == Classification::PreIntegrated;
    packed_.push_back(packedTable(function, alone && width == 0 ? Range{0, 1} : range));
    out.packed = packed_.back().data();
    markShown(table, out);
    if (regions) out.regions = regions_.emplace_back(function.regions);
    out.byRegions = regions;
    out.toRange = toRange;
    out.classification = drawn.classification;
    if (segments) out.integrals = integralsOf(function, range);
    const double perRange = width != 0 && !volume.labels ? std::abs(volume.scale / width) : 0;
    out.gradient = drawn.gradient;
    out.gradientScale = float(perRange / double(function.gradientTop));
    out.surfaceScale = width != 0 || volume.labels ? float(perRange / kFlatGradient) : 1e20f;
    if (drawn.colors) out.colors = colorsOf(drawn, index + 1);
    if (drawn.look && drawn.look->any()) {
        out.look = &looks_.emplace_back(*drawn.look);
        const auto kind = volume.bcc ? volume::LatticeKind::BCC : volume::LatticeKind::CC;
        out.smooth = float(volume::smoothReach(kind, double(drawn.look->smooth)));
    }
    const glm::dvec2 map(out.placeScale, out.placeOffset);
    const double slack = volume.exact ? kSlack / 2 / kQuantum : kSlack;
    std::function<bool(float, float)> shows = [](float, float) { return true; };
    const OpacityRanges opaque(table.opacity, map);
    if (const IsoLayer* const iso = drawn.surface) {
        out.style = RayStyle::Iso;
        out.isoValue = float((iso->value - volume.offset) / volume.scale);
        out.isoOpacity = iso->opacity;
        out.isoColor = glm::vec3(linearFromSrgb(glm::dvec3(iso->color)));
        shows = [&](float lo, float hi) {
            return double(lo) - slack <= double(out.isoValue) && double(out.isoValue) <= double(hi) + slack;
        };
    } else {
        out.style = own->style;
        out.shaded = drawn.shaded;
        out.density = own->density;
        out.threshold = float(width != 0 ? std::max(0.0, (own->threshold - range.lo) / width) : 0.5);
        if (!drawn.gradient && (own->style == RayStyle::Composite || own->style == RayStyle::XRay))
            shows = [&](float lo, float hi) {
                return opaque.any(float(double(lo) - slack), float(double(hi) + slack));
            };
    }
    layers_.push_back(out);
    SkipMap full = fullBlocks(volume, shows);
    if (segments) widen(full); // half a step around samples counts
    skip_ = united(std::move(skip_), full);
}

/// Brushes in samples of the volumes that follow those of the layers.
void PacketScene::addBrushes(const Scene& scene, const volume::DatasetInfo& info, const std::vector<int>& channels) {
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
    const DrawnScene drawn = drawnScene(scene, info);
    for (const SharedVolume& volume : volumes_) {
        views_.push_back(viewOf(*volume));
        std::vector<VolumeView> parts;
        for (const PacketVolume& part : volume->parts) parts.push_back(viewOf(part));
        partViews_.push_back(std::move(parts));
        views_.back().parts = partViews_.back().data();
    }
    lenses_ = drawn.lenses;
    addBrushes(scene, info, drawn.brushed);
    std::vector<const PacketVolume*> sampled; // along rays
    std::size_t next = 0;                     // volume
    for (const DrawnLayer& layer : drawn.layers) {
        if (layer.slice) {
            addSlice(layer, next);
        } else {
            addLayer(layer, next);
            sampled.push_back(volumes_[next].get());
        }
        next += layer.colors ? 2 : 1;
    }
    if (layers_.size() == 1 && (layers_[0].style == RayStyle::Maximum || layers_[0].style == RayStyle::Minimum))
        bound_ = scoreBounds(*sampled[0], [&](float sample) {
            const LayerView& layer = layers_[0];
            const double at = double(sample) * double(layer.placeScale) + double(layer.placeOffset);
            const double place = std::clamp(at, 0.0, 1.0);
            return layer.style == RayStyle::Minimum ? 1 - place : place;
        });
    for (; next < volumes_.size(); ++next) sampled.push_back(volumes_[next].get());
    for (const PacketVolume* const volume : sampled) {
        if (volume->absent.empty()) continue;
        absent_.resize(volume->absent.size());
        for (std::size_t i = 0; i < absent_.size(); ++i) absent_[i] = std::uint8_t(absent_[i] | volume->absent[i]);
    }
    if (!absent_.empty()) absent_.resize(absent_.size() + 3);
}

namespace {

/// FocusView::magnifies of a lens; `cell`: longest edge of a cell, since gradients read beside rays.
float magnifiedReach(const PlacedLens& lens, double cell) {
    if (!(lens.magnification > 1)) return 0;
    if (lens.shape == LensShape::Disc) return 1e6f; // at any depth
    double longest = 0, sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double own = glm::length(lens.fromUnit[axis]);
        longest = std::max(longest, own);
        sum += own * own;
    }
    return float((lens.shape == LensShape::Sphere ? longest : std::sqrt(sum)) + 2 * cell);
}

/// The octants that rays go into, a bit each; a little beyond the picture, because rays are moved within their pixels.
unsigned octantsOf(const CastJob& job) {
    const glm::dvec3 spread = 1.1 * (glm::abs(job.directionX) + glm::abs(job.directionY));
    const glm::dvec3 cells = glm::sign(job.box.cellsPerWorld);
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
                         glm::ivec2 size, double stepFactor, const PackedLight& around) {
    const WorldFrame frame = worldFrame(info, scene.stretch);
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
    job.box = packedBox(frame, lattice);
    job.cell = worldCell(lattice, frame);
    job.stepVoxels = float(double(scene.render.stepVoxels) * stepFactor);
    clips_ = placeClips(scene.clips, frame);
    job.clips = clips_;
    job.layers = layers_;
    placeSlices(scene, frame);
    job.slices = slices_;
    lenses_ = placeLenses(scene, frame);
    job.focus = focus_;
    job.focus.lenses = lenses_;
    for (std::size_t i = 0; i < lenses_.size(); ++i)
        job.focus.magnifies[i] = magnifiedReach(lenses_[i], std::max({job.cell.x, job.cell.y, job.cell.z}));
    job.focus.any = !brushes_.empty() || !lenses_.empty();
    job.stencil = volume::gradientStencil(lattice.kind, scene.render.gradient);
    lighting_ = scene.lighting;
    lights_ = ownLights(scene.lighting, scene.camera);
    job.light.surface = &lighting_;
    job.light.lights = lights_;
    job.light.maps = around.diffuse.edge > 0;
    job.light.fromWorld = around.fromWorld;
    if (!around.visible.empty()) job.light.setVolume(around.grid, !around.scattered.empty());
    job.around = &around;
    job.middle = middle.direction;
    if (!looks_.empty()) job.look = lookView(scene, frame.halfSize, job.cell, size);
    job.jitterStarts = scene.render.jitter;
    if (empty()) return job;
    job.bcc = volumes_[0]->bcc;
    job.exact = volumes_[0]->exact;
    if (layers_.empty()) return job;
    countAlike(skip_, octantsOf(job));
    job.skip.alike = skip_.alike.data();
    job.skip.count = skip_.count;
    job.skip.absent = absent_.empty() ? nullptr : absent_.data();
    if (!bound_.empty()) job.skip.bound = bound_.data();
    return job;
}

} // namespace tessera::vis::packet
