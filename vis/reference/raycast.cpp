#include "vis/reference/raycast.h"

#include "vis/reference/prepared.h"
#include "volume/parallel.h"

#include <algorithm>
#include <cmath>

namespace tessera::vis::reference {

namespace {

constexpr double kFaceTolerance = 1e-5; ///< world units by which a slice on a face of the box may miss it

template <class Number> using Vec3 = glm::vec<3, Number>;
template <class Number> using Vec4 = glm::vec<4, Number>;

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

} // namespace tessera::vis::reference
