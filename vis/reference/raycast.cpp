#include "vis/reference/raycast.h"

#include "vis/model/ray_setup.h"
#include "volume/parallel.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <memory>

namespace tessera::vis::reference {

namespace {

constexpr double kFaceTolerance = 1e-5; ///< world units by which a slice on a face of the box may miss it

template <class Number> using Vec3 = glm::vec<3, Number>;
template <class Number> using Vec4 = glm::vec<4, Number>;

/// A layer with all that it needs to be drawn.
struct DrawnLayer {
    const Technique* technique = nullptr;
    const Samples* samples = nullptr;
    Range range;
    const TransferFunction* function = nullptr;
    Plane plane; ///< of a slice

    /// Place in the range of the transfer function, 0..1.
    double place(double value) const {
        const double width = range.hi - range.lo;
        if (width == 0) return value > range.lo ? 1 : value < range.lo ? 0 : 0.5;
        return std::clamp((value - range.lo) / width, 0.0, 1.0);
    }
    /// Colour (linear light) and opacity of a value.
    glm::dvec4 classify(double value) const {
        const glm::dvec4 srgb = evaluate(*function, range, value);
        return {linearFromSrgb(glm::dvec3(srgb)), srgb.a};
    }
};

/// A scene made ready for its rays.
struct Prepared {
    const Scene& scene;
    Options options;
    volume::Lattice lattice;
    WorldFrame frame;
    glm::dvec3 cell{1}, toLight{0};
    std::map<std::string, std::unique_ptr<Samples>> samples; ///< by channel name
    std::vector<DrawnLayer> layers;

    Prepared(const Scene& drawn, const volume::BrickSource& source, const Options& wanted)
        : scene(drawn), options(wanted), lattice(source.grid().lattice) {
        const volume::DatasetInfo& info = source.info();
        frame = worldFrame(info.bounds, scene.stretch);
        cell = worldCell(lattice, frame);
        toLight = lightDirection(scene.render, scene.camera);
        const int time = info.nearestTime(scene.time);
        const auto load = [&](const std::string& name) -> const Samples* {
            const std::optional<int> channel = info.findChannel(name);
            if (!channel) return nullptr;
            std::unique_ptr<Samples>& entry = samples[name];
            if (!entry) entry = std::make_unique<Samples>(source, *channel, time, scene.render.filter, options.flaws);
            return entry.get();
        };
        for (const Layer& layer : scene.layers) {
            const std::string& name =
                std::visit([](const auto& t) -> const std::string& { return t.channel; }, layer.technique);
            DrawnLayer one;
            one.technique = &layer.technique;
            one.samples = layer.visible ? load(name) : nullptr;
            if (one.samples == nullptr) continue;
            const volume::Channel channel = info.channels()[std::size_t(*info.findChannel(name))];
            one.function = &transferFor(scene, channel.name);
            one.range = effectiveRange(*one.function, info.channelRange(channel));
            if (const auto* slice = std::get_if<SliceLayer>(one.technique))
                one.plane = slicePlane(*slice, frame, scene.cursor);
            layers.push_back(std::move(one));
        }
        for (const Brush& brush : scene.selection.brushes)
            for (const BrushInterval& interval : brush.intervals)
                if (brush.enabled) load(interval.channel);
    }

    glm::dvec3 cells(glm::dvec3 world) const { return lattice.toCells(frame.toPhysical(world)); }
    /// Degree of interest of a world point.
    double interest(glm::dvec3 world) const {
        if (!scene.selection.active()) return 1;
        return degreeOfInterest(scene.selection, [&](const std::string& channel) {
            const auto found = samples.find(channel);
            const std::optional<double> value =
                found == samples.end() ? std::nullopt : found->second->value(cells(world));
            return value.value_or(std::numeric_limits<double>::quiet_NaN());
        });
    }
    /// Gradient of a channel, per cell of the sublattice and axis.
    glm::dvec3 gradient(const Samples& of, glm::dvec3 world) const {
        return volume::gradient([&](glm::dvec3 at) { return of.value(at); }, cells(world), gradientDelta(lattice.kind));
    }
    double opacityFactor(double doi) const { return glm::mix(double(scene.selection.contextOpacity), 1.0, doi); }
    glm::dvec3 saturated(glm::dvec3 color, double doi) const {
        return glm::mix(glm::dvec3(luminance(color)), color,
                        glm::mix(double(scene.selection.contextSaturation), 1.0, doi));
    }
};

/// One ray from front to back.
template <class Number> struct Caster {
    const Prepared& scene;
    Ray ray;
    RaySegment segment;
    RaySamples samples;
    Vec4<Number> out{0};
    Number step = 0;

    Vec3<Number> at(Number t) const { return Vec3<Number>(ray.origin) + t * Vec3<Number>(ray.direction); }
    bool opaque() const { return out.a >= Number(kOpaque); }

    void blend(glm::dvec3 color, double opacity) {
        const Number remaining = scene.options.flaws.additiveBlend ? Number(1) : 1 - out.a;
        const Number weight = remaining * Number(opacity);
        out += Vec4<Number>(Vec3<Number>(color) * weight, weight);
    }

    /// Slices met in (from, to], nearest first, equal ones in layer order.
    void drawSlices(Number from, Number to) {
        std::vector<std::pair<Number, const DrawnLayer*>> met;
        for (const DrawnLayer& layer : scene.layers) {
            if (!std::holds_alternative<SliceLayer>(*layer.technique)) continue;
            const double slope = glm::dot(layer.plane.normal, ray.direction);
            if (slope == 0) continue;
            const auto t = Number((layer.plane.offset - glm::dot(layer.plane.normal, ray.origin)) / slope);
            if (t > from && t <= to) met.emplace_back(t, &layer);
        }
        std::stable_sort(met.begin(), met.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
        for (const auto& [t, layer] : met) {
            const glm::dvec3 place = glm::clamp(glm::dvec3(at(t)), -scene.frame.halfSize, scene.frame.halfSize);
            const std::optional<double> value = layer->samples->value(scene.cells(place));
            if (!value) continue;
            const double doi = scene.interest(place);
            blend(scene.saturated(glm::dvec3(layer->classify(*value)), doi),
                  double(std::get<SliceLayer>(*layer->technique).opacity) * scene.opacityFactor(doi));
        }
    }

    glm::dvec3 shade(const DrawnLayer& layer, glm::dvec3 place, glm::dvec3 albedo, bool surface) const {
        if (layer.samples->categorical()) return albedo;
        const glm::dvec3 perCell = scene.gradient(*layer.samples, place);
        const glm::dvec3 edges = scene.lattice.spacing * scene.frame.scale; // of a sublattice cell, with sign
        double weight = 1;
        if (!surface) {
            const double change = glm::length(perCell / glm::abs(edges) * scene.cell);
            const double width = std::abs(layer.range.hi - layer.range.lo);
            weight = width > 0 ? std::min(1.0, change / width / kFlatGradient) : 1;
        }
        return phong(albedo, perCell / edges, weight, -ray.direction, scene.toLight, scene.scene.render);
    }

    void drawIso(const DrawnLayer& layer, std::optional<double> before, std::optional<double> now, Number t) {
        const auto& iso = std::get<IsoLayer>(*layer.technique);
        if (!before || !now || (*before >= iso.value) == (*now >= iso.value)) return;
        Number lo = t - step, hi = t;
        for (int i = 0; i < kBisections; ++i) {
            const Number middle = (lo + hi) / 2;
            const std::optional<double> value = layer.samples->value(scene.cells(glm::dvec3(at(middle))));
            // An absent place in between counts as below the value.
            const bool above = value && *value >= iso.value;
            (above == (*before >= iso.value) ? lo : hi) = middle;
        }
        const glm::dvec3 place(at((lo + hi) / 2));
        const double doi = scene.interest(place);
        const glm::dvec3 albedo = scene.saturated(linearFromSrgb(glm::dvec3(iso.color)), doi);
        blend(shade(layer, place, albedo, true), double(iso.opacity) * scene.opacityFactor(doi));
    }

    void drawSample(const DrawnLayer& layer, double value, glm::dvec3 place) {
        const auto& volume = std::get<VolumeLayer>(*layer.technique);
        const glm::dvec4 classified = layer.classify(value);
        const double doi = scene.interest(place);
        const double opacity =
            correctedOpacity(classified.a * scene.opacityFactor(doi), double(step), double(volume.density));
        if (opacity <= 0) return;
        glm::dvec3 color = scene.saturated(glm::dvec3(classified), doi);
        if (volume.shaded) color = shade(layer, place, color, false);
        blend(color, opacity);
    }

    /// What a maximum or x-ray layer has seen.
    struct Seen {
        double best = -1, bestValue = 0, bestInterest = 0;
        double factors = 0, weighted = 0;
        int count = 0;
    };

    void look(const DrawnLayer& layer, Seen& seen, double value, glm::dvec3 place) const {
        const double doi = scene.interest(place), factor = scene.opacityFactor(doi);
        const double score = layer.place(value) * factor;
        if (score > seen.best) seen.best = score, seen.bestValue = value, seen.bestInterest = doi;
        seen.factors += factor;
        seen.weighted += factor * value;
        ++seen.count;
    }

    void drawSeen(const DrawnLayer& layer, const Seen& seen) {
        const auto& volume = std::get<VolumeLayer>(*layer.technique);
        if (seen.count == 0 || !(seen.factors > 0)) return;
        const bool maximum = volume.style == VolumeStyle::Maximum;
        const double value = maximum ? seen.bestValue : seen.weighted / seen.factors;
        // The mean belongs to no place: brushes act on it through its weights alone.
        const double doi = maximum ? seen.bestInterest : 1;
        const double factor = maximum ? scene.opacityFactor(doi) : seen.factors / seen.count;
        const glm::dvec4 classified = layer.classify(value);
        blend(scene.saturated(glm::dvec3(classified), doi),
              std::min(1.0, double(volume.density) * classified.a) * factor);
    }

    void cast() {
        step = Number(samples.step);
        std::vector<std::optional<double>> before(scene.layers.size()), now(scene.layers.size());
        std::vector<Seen> seen(scene.layers.size());
        Number last = Number(samples.enter - kFaceTolerance);
        for (int k = 0; k < samples.count && !opaque(); ++k) {
            const Number t = Number(samples.at(k));
            const glm::dvec3 place(at(t)), cells = scene.cells(place);
            drawSlices(last, t);
            for (std::size_t i = 0; i < now.size(); ++i) now[i] = scene.layers[i].samples->value(cells);
            for (std::size_t i = 0; i < now.size(); ++i)
                if (k > 0 && std::holds_alternative<IsoLayer>(*scene.layers[i].technique))
                    drawIso(scene.layers[i], before[i], now[i], t);
            for (std::size_t i = 0; i < now.size(); ++i) {
                const auto* volume = std::get_if<VolumeLayer>(scene.layers[i].technique);
                if (volume == nullptr || !now[i]) continue;
                if (volume->style == VolumeStyle::Composite)
                    drawSample(scene.layers[i], *now[i], place);
                else
                    look(scene.layers[i], seen[i], *now[i], place);
            }
            std::swap(before, now);
            last = t;
        }
        if (!opaque()) drawSlices(last, Number(segment.exit + kFaceTolerance));
        for (std::size_t i = 0; i < seen.size(); ++i)
            if (seen[i].count > 0) drawSeen(scene.layers[i], seen[i]);
    }
};

template <class Number>
Image renderWith(const Scene& scene, const volume::BrickSource& source, glm::ivec2 size, const Options& options) {
    const Prepared prepared(scene, source, options);
    const bool perspective = scene.camera.projection == Projection::Perspective;
    Image image{size, std::vector<glm::dvec4>(std::size_t(size.x) * std::size_t(size.y))};
    parallelFor(std::size_t(size.y), [&](std::size_t y) {
        for (int x = 0; x < size.x; ++x) {
            const glm::dvec2 ndc((x + 0.5) / size.x * 2 - 1, 1 - (double(y) + 0.5) / size.y * 2);
            Caster<Number> caster{prepared, cameraRay(scene.camera, double(size.x) / size.y, ndc), {}, {}};
            const std::optional<RaySegment> segment = clipToBox(caster.ray, prepared.frame.halfSize, perspective);
            if (!segment) continue;
            caster.segment = *segment;
            caster.samples = raySamples(*segment, caster.ray.direction, prepared.cell, double(scene.render.stepVoxels));
            caster.cast();
            image.pixels[y * std::size_t(size.x) + std::size_t(x)] = glm::dvec4(caster.out);
        }
    });
    return image;
}

} // namespace

Image render(const Scene& scene, const volume::BrickSource& source, glm::ivec2 size, const Options& options) {
    return renderWith<double>(scene, source, size, options);
}

Image renderSingle(const Scene& scene, const volume::BrickSource& source, glm::ivec2 size, const Options& options) {
    return renderWith<float>(scene, source, size, options);
}

Difference compare(const Image& a, const Image& b, double threshold) {
    assert(a.size == b.size && a.pixels.size() == b.pixels.size());
    Difference difference;
    double squares = 0, within = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        double most = 0, own = 0;
        for (int c = 0; c < 4; ++c) {
            const double apart = std::abs(a.pixels[i][c] - b.pixels[i][c]);
            own += apart * apart;
            // NaN is as far apart as can be.
            most = std::isnan(apart) ? std::numeric_limits<double>::infinity() : std::max(most, apart);
        }
        squares += own;
        if (most > threshold)
            ++difference.beyond;
        else
            within += own;
        if (most > difference.maximum) {
            difference.maximum = most;
            difference.worst = {int(i) % a.size.x, int(i) / a.size.x};
        }
    }
    difference.rmse = std::sqrt(squares / double(std::max<std::size_t>(a.pixels.size() * 4, 1)));
    difference.rmseWithin =
        std::sqrt(within / double(std::max<std::size_t>((a.pixels.size() - difference.beyond) * 4, 1)));
    difference.psnr = -20 * std::log10(difference.rmse);
    return difference;
}

} // namespace tessera::vis::reference
