#include "tests/reference/prepared.h"

#include "vis/optics/surface_light.h"
#include "vis/shapes/mesh_medium.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::vis::reference {

double DrawnLayer::unclamped(double value) const {
    const double width = range.hi - range.lo;
    return width != 0 ? (value - range.lo) / width : 0.5;
}

double DrawnLayer::place(double value) const {
    const double width = range.hi - range.lo;
    if (width == 0) return value > range.lo ? 1 : value < range.lo ? 0 : 0.5;
    return std::clamp((value - range.lo) / width, 0.0, 1.0);
}

glm::dvec4 DrawnLayer::classify(double value) const {
    const glm::dvec4 srgb = evaluate(*function, range, value);
    return {linearFromSrgb(glm::dvec3(srgb)), srgb.a};
}

glm::dvec4 DrawnLayer::classifyPlace(double at) const {
    return classify(glm::mix(range.lo, range.hi, at));
}

Prepared::Prepared(const Scene& drawn, const volume::BrickSource& source, glm::ivec2 size, const Options& wanted)
    : scene(drawn), options(wanted), lattice(source.grid().lattice), interestOf({}) {
    const volume::DatasetInfo& info = source.info();
    frame = worldFrame(info, scene.stretch);
    cell = worldCell(lattice, frame);
    clips = placeClips(scene.clips, frame);
    lenses = placeLenses(scene, frame);
    interestOf = DoiFunction(scene.selection, {lenses, frame});
    look = lookView(scene, frame.halfSize, cell, size);
    middle = cameraRay(scene.camera, 1, {0, 0}).direction;
    light = illuminate(scene.lighting, scene.camera, options.surroundings.get());
    const auto load = [&](const std::string& name, bool raw = false, double shift = 0) -> const Samples* {
        const std::optional<int> channel = info.findChannel(name);
        if (!channel) return nullptr;
        const double own = scene.time + shift;
        std::unique_ptr<Samples>& entry = samples[{name, own, raw}];
        const Filter filter =
            raw && prefilterOf(scene.render.filter) != volume::Prefilter::None ? Filter::Average : scene.render.filter;
        if (!entry)
            entry = std::make_unique<Samples>(source, *channel, volume::timesAround(info.times, own), filter,
                                              options.flaws);
        return entry.get();
    };
    for (const Layer& layer : scene.layers) {
        const std::string& name =
            std::visit([](const auto& t) -> const std::string& { return t.channel; }, layer.technique);
        DrawnLayer one;
        one.technique = &layer.technique;
        one.lens = findLens(lenses, layer.lens);
        one.brushes = layer.brushes;
        const bool seen = layer.visible && !std::holds_alternative<FlowLayer>(layer.technique) &&
                          !std::holds_alternative<GlyphLayer>(layer.technique) && (layer.lens.empty() || one.lens >= 0);
        one.samples = seen ? load(name, false, layer.timeShift) : nullptr;
        if (one.samples == nullptr) continue;
        if (layer.lens.empty()) one.lens = -1;
        const volume::Channel channel = info.channel(*info.findChannel(name));
        const auto functionOf = [&](const volume::Channel& of, bool own) -> const TransferFunction& {
            return transferFor(scene, own && !layer.transfer.empty() ? layer.transfer : of.name);
        };
        const std::string& colorBy = colorByOf(layer.technique);
        const bool surface = std::holds_alternative<IsoLayer>(layer.technique);
        one.colors = colorBy.empty() ? nullptr : load(colorBy, false, layer.timeShift);
        if (one.colors) {
            const volume::Channel other = info.channel(*info.findChannel(colorBy));
            one.colorFunction = &functionOf(other, surface);
            one.colorRange = effectiveRange(*one.colorFunction, info.channelRange(other));
        }
        one.function = &functionOf(channel, !surface || !one.colors);
        one.range = effectiveRange(*one.function, info.channelRange(channel));
        const auto* volume = std::get_if<VolumeLayer>(one.technique);
        if (volume != nullptr && volume->style == RayStyle::Composite && volume->quantity == Quantity::Value &&
            !one.samples->categorical() && one.function->kind == TransferKind::Curve)
            one.classification = volume->classification;
        if (one.classification == Classification::Pre) one.samples = load(name, true, layer.timeShift);
        if (one.classification == Classification::PreIntegrated)
            one.integrals = integralFunctions(*one.function, one.range);
        if (const auto* slice = std::get_if<SliceLayer>(one.technique))
            one.plane = slicePlane(*slice, frame, scene.cursor);
        one.strokes = strokesOf(scene, int(&layer - scene.layers.data()));
        layers.push_back(std::move(one));
    }
    for (const std::string& channel : interestOf.channels()) brushed.push_back(load(channel));
    if (stepsAdapt(scene, info)) findSteps();
    if (!scene.lighting.shadows.any()) return;
    const LightGrid grid = lightGrid(frame, scene.lighting.shadows);
    const std::vector<PlacedLight> lights = placeLights(scene.lighting, scene.camera);
    Medium<double> all = medium(grid);
    const Medium<double> meshes = meshMedium<double>(grid, meshCasters(scene, info));
    for (std::size_t i = 0; i < all.size(); ++i) all[i] += meshes[i];
    light.volume =
        std::make_shared<const LightVolume<double>>(spreadLight<double>(grid, all, lights, scene.lighting.shadows));
}

/// Computes the step codes of all blocks.
void Prepared::findSteps() {
    std::vector<std::optional<CurveMedium>> curves;
    for (const DrawnLayer& layer : layers) {
        const auto* volume = std::get_if<VolumeLayer>(layer.technique);
        auto& curve = curves.emplace_back();
        if (volume)
            curve.emplace(*layer.function, layer.range, double(volume->density),
                          volume->shaded && !layer.samples->categorical());
    }
    const glm::ivec3 texels = lattice.texels();
    blocks = (texels + kStepBlock - 1) / kStepBlock;
    steps.resize(std::size_t(blocks.x) * std::size_t(blocks.y) * std::size_t(blocks.z));
    parallelFor(steps.size(), [&](std::size_t i) {
        const glm::ivec3 block(int(i % std::size_t(blocks.x)), int(i / std::size_t(blocks.x) % std::size_t(blocks.y)),
                               int(i / std::size_t(blocks.x) / std::size_t(blocks.y)));
        std::vector<BlockMedium> medium;
        for (std::size_t n = 0; n < layers.size(); ++n) {
            const DrawnLayer& layer = layers[n];
            const Range bounds = layer.samples->bounds(block * kStepBlock - 1, (block + 1) * kStepBlock + 1);
            const auto* iso = std::get_if<IsoLayer>(layer.technique);
            if (!(bounds.lo <= bounds.hi)) continue;
            if (iso && bounds.lo <= iso->value && iso->value <= bounds.hi) return;
            if (curves[n])
                medium.push_back(curves[n]->between(layer.unclamped(bounds.lo), layer.unclamped(bounds.hi),
                                                    layer.samples->someAbsent()));
        }
        steps[i] = std::uint8_t(stepCode(longestStep(medium, double(scene.render.adaptiveStep)), stepUnit(cell)));
    });
}

double Prepared::stepAt(glm::ivec3 block) const {
    block = glm::clamp(block, glm::ivec3(0), blocks - 1);
    const int code =
        steps[(std::size_t(block.z) * std::size_t(blocks.y) + std::size_t(block.y)) * std::size_t(blocks.x) +
              std::size_t(block.x)];
    return code > 0 ? stepOfCode(code, stepUnit(cell)) : 0;
}

namespace {

/// The layers of a scene as mediumAt() wants them.
struct MediumScene {
    const Prepared& scene;

    int layers() const { return int(scene.layers.size()); }
    const DrawnLayer& of(int i) const { return scene.layers[std::size_t(i)]; }
    MediumLayer layer(int i) const {
        if (const auto* iso = std::get_if<IsoLayer>(of(i).technique)) return {MediumKind::Surface, 1, iso->value};
        const auto* volume = std::get_if<VolumeLayer>(of(i).technique);
        if (!volume || volume->style != RayStyle::Composite) return {};
        return {MediumKind::Volume, double(volume->density), 0};
    }
    bool kept(glm::dvec3 world) const { return vis::kept(scene.clips, world); }
    struct Point {
        double value = 0;
        bool present = false;
        double part = 0;
    };
    Point read(int i, glm::dvec3 world) const {
        const std::optional<Reading> found = of(i).samples->read(scene.cells(world));
        return found ? Point{found->value, true, double(found->part)} : Point{};
    }
    glm::dvec4 after(const DrawnLayer& layer, glm::dvec3 color, double opacity, glm::dvec3 world) const {
        const Interest doi = scene.interest(world);
        const LensAction lens = scene.lensAction(layer, world, doi.doi);
        return {scene.focused(layer, scene.tinted(layer, color, world), doi, lens.saturation),
                opacity * scene.opacityFactor(layer, doi) * lens.opacity};
    }
    glm::dvec4 at(int i, const Point& found, glm::dvec3 world) const {
        if (!found.present) return glm::dvec4(0);
        const glm::dvec4 color = scene.colorAt(of(i), found.value, world);
        return after(of(i), glm::dvec3(color), color.a, world);
    }
    glm::dvec4 surface(int i, glm::dvec3 world) const {
        const auto& iso = std::get<IsoLayer>(*of(i).technique);
        return after(of(i), linearFromSrgb(glm::dvec3(iso.color)), double(iso.opacity), world);
    }
};

} // namespace

Medium<double> Prepared::medium(const LightGrid& grid) const {
    Medium<double> out(grid.count());
    parallelFor(std::size_t(grid.size.z), [&](std::size_t z) {
        for (int y = 0; y < grid.size.y; ++y)
            for (int x = 0; x < grid.size.x; ++x)
                out[grid.index({x, y, int(z)})] =
                    mediumAt<double>(MediumScene{*this}, grid, grid.center({x, y, int(z)}));
    });
    return out;
}

Interest Prepared::interest(glm::dvec3 world) const {
    if (!scene.selection.active()) return {};
    std::vector<double> values;
    for (const Samples* of : brushed)
        values.push_back(
            (of ? of->value(cells(world)) : std::nullopt).value_or(std::numeric_limits<double>::quiet_NaN()));
    const DoiFunction::Holder holder = interestOf.holder(values, physical(world));
    return {confine(lenses, interestOf(values, physical(world)), world), linearFromSrgb(glm::dvec3(holder.color)),
            holder.interest};
}

glm::dvec3 Prepared::focused(const DrawnLayer& layer, glm::dvec3 color, const Interest& doi, double saturation) const {
    const Selection& selection = scene.selection;
    const ContextLook context{double(selection.contextSaturation), double(selection.contextLightness)};
    color = focusedColor<double>(layer.brushes, context, color, luminance(color), doi.doi, saturation);
    const double held = layer.brushes == BrushEffect::None ? 0 : doi.held * doi.doi;
    return glm::mix(color, doi.color, held * double(selection.brushColor));
}

glm::dvec3 Prepared::tint(const DrawnLayer& layer, std::optional<double> value) {
    const auto* iso = std::get_if<IsoLayer>(layer.technique);
    const glm::dvec3 srgb = value ? glm::dvec3(evaluate(*layer.colorFunction, layer.colorRange, *value))
                                  : glm::dvec3(iso ? iso->color : kNoValueColor);
    return linearFromSrgb(srgb);
}

glm::dvec4 Prepared::colorAt(const DrawnLayer& layer, double value, glm::dvec3 world) const {
    if (std::get<VolumeLayer>(*layer.technique).quantity == Quantity::Gradient)
        return layer.classifyPlace(std::min(1.0, steepPlace(layer, world)));
    if (layer.function->kind == TransferKind::Curve) return layer.classify(value);
    const glm::dvec4 srgb = evaluate(*layer.function, layer.range, value, steepness(layer, world));
    return {linearFromSrgb(glm::dvec3(srgb)), srgb.a};
}

double Prepared::steepness(const DrawnLayer& layer, glm::dvec3 world) const {
    const double width = std::abs(layer.range.hi - layer.range.lo);
    if (layer.samples->categorical() || !(width > 0)) return 0;
    const glm::dvec3 edges = lattice.spacing * frame.scale; // of a sublattice cell
    return glm::length(gradient(*layer.samples, world) / edges * cell) / width;
}

} // namespace tessera::vis::reference
