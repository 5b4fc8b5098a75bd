#include "tests/reference/raycast.h"

#include "tests/reference/prepared.h"
#include "tests/reference/projection.h"
#include "vis/formulas/colors.h"
#include "vis/optics/jitter.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tessera::vis::reference {

namespace {

constexpr double kFaceTolerance = 1e-5; ///< tolerance in world units for a slice on a face of the box

template <class Number> using Vec3 = glm::vec<3, Number>;
template <class Number> using Vec4 = glm::vec<4, Number>;

/// Casts one ray, front to back.
template <class Number> struct Caster {
    const Prepared& scene;
    Ray ray;
    std::array<Ray, 2> beside; ///< of the other pixel of its pair, in its row and in its column
    RaySegment segment;
    RaySamples samples;
    std::vector<RaySegment> holes = {}; ///< in samples
    Vec4<Number> out{0};
    Number step = 0;
    double interest = 0; ///< of `out`, weighted by opacity

    Vec3<Number> at(Number t) const { return Vec3<Number>(ray.origin) + t * Vec3<Number>(ray.direction); }
    bool opaque() const { return out.a >= Number(kOpaque); }
    /// Position in samples of distance t: sample k lies at k.
    double inSamples(double t) const { return (t - samples.enter) / samples.step - samples.phase; }
    bool shows(double k) const {
        return std::none_of(holes.begin(), holes.end(),
                            [&](const RaySegment& hole) { return k > hole.enter && k < hole.exit; });
    }

    void blend(glm::dvec3 color, double opacity, double doi) {
        const Number remaining = scene.options.flaws.additiveBlend ? Number(1) : 1 - out.a;
        const Number weight = remaining * Number(opacity);
        out += Vec4<Number>(Vec3<Number>(color) * weight, weight);
        interest += double(weight) * doi;
    }

    /// A surface intersected by the ray.
    struct Event {
        Number t;
        glm::dvec3 color;
        double opacity, interest;
    };

    /// The colour of a slice, with strokes, where it has a value.
    glm::dvec3 strokedColor(const DrawnLayer& layer, const Reading& own, glm::dvec3 place) const {
        const glm::dvec3 color(layer.classify(own.value));
        if (layer.strokes == nullptr) return color;
        const Strokes& strokes = std::get<SliceLayer>(*layer.technique).strokes;
        return withStrokes<double>(strokes.grey ? glm::dvec3(kStrokeGrey) : color,
                                   sliceStrokes(*layer.strokes, place).x, double(strokes.strength));
    }

    /// Whether a slice of strokes alone has none at a place.
    bool lacksStrokes(const DrawnLayer& layer, glm::dvec3 place) const {
        return layer.strokes != nullptr && std::get<SliceLayer>(*layer.technique).strokes.grey &&
               sliceStrokes(*layer.strokes, place).y < 0.5;
    }

    /// The same with contour lines.
    glm::dvec3 sliceColor(const DrawnLayer& layer, const Reading& own, glm::dvec3 at) const {
        const double value = own.value;
        const glm::dvec3 color = strokedColor(layer, own, at);
        const int contours = std::get<SliceLayer>(*layer.technique).contours;
        if (contours <= 0) return color;
        const auto level = [&](double of) { return layer.unclamped(of) * (contours + 1); };
        double width = 0;
        for (const Ray& other : beside) {
            const double t = planeDistance(layer.plane, other.origin, other.direction);
            const glm::dvec3 place = other.origin + t * other.direction;
            const std::optional<Reading> next =
                layer.samples->read(scene.cells(glm::clamp(place, -scene.frame.halfSize, scene.frame.halfSize)));
            if (next && next->part == own.part) width += std::abs(level(next->value) - level(value));
        }
        return withContours<double>(color, level(value), width, contours);
    }

    /// Adds the slices intersected in (from, to].
    void findSlices(std::vector<Event>& events, Number from, Number to) const {
        for (const DrawnLayer& layer : scene.layers) {
            if (!std::holds_alternative<SliceLayer>(*layer.technique)) continue;
            if (!(std::abs(glm::dot(layer.plane.normal, ray.direction)) > kParallel)) continue;
            const auto t = Number(planeDistance(layer.plane, ray.origin, ray.direction));
            if (!(t > from && t <= to) || !shows(inSamples(double(t)))) continue;
            const glm::dvec3 place = glm::clamp(glm::dvec3(at(t)), -scene.frame.halfSize, scene.frame.halfSize);
            const std::optional<Reading> found = layer.samples->read(scene.cells(place));
            if (!found || lacksStrokes(layer, glm::dvec3(at(t)))) continue;
            const Interest doi = scene.interest(place);
            const LensAction lens = scene.lensAction(layer, glm::dvec3(at(t)), doi.doi);
            events.push_back({t,
                              scene.focused(layer, sliceColor(layer, *found, glm::dvec3(at(t))), doi, lens.saturation),
                              std::min(double(std::get<SliceLayer>(*layer.technique).opacity) *
                                           scene.opacityFactor(layer, doi) * lens.opacity,
                                       1.0),
                              doi.seen(layer)});
        }
    }

    /// Composites the events, nearest first, equal ones in the order found.
    void drawEvents(std::vector<Event>& events) {
        std::stable_sort(events.begin(), events.end(), [](const Event& a, const Event& b) { return a.t < b.t; });
        for (const Event& event : events) blend(event.color, event.opacity, event.interest);
        events.clear();
    }

    /// The gradient in world axes for shading from that per cell of the sublattice.
    glm::dvec3 worldGradient(glm::dvec3 perCell) const {
        const glm::dvec3 edges = scene.lattice.spacing * scene.frame.scale; // edges of a sublattice cell, with sign
        const glm::dvec3 gradient = perCell / edges;
        const int bits = scene.scene.render.normalBits;
        return bits > 0 ? quantizedDirection(gradient, bits) * glm::length(gradient) : gradient;
    }

    /// The gradient per cell that a look is shaded by. `narrow`: the unsmoothed one.
    glm::dvec3 lookGradient(const DrawnLayer& layer, const Look& look, glm::dvec3 place, int part,
                            glm::dvec3 narrow) const {
        if (!look.any() || !(look.smooth > 0)) return narrow;
        return scene.smoothGradient(*layer.samples, place, part, double(look.smooth), narrow);
    }

    /// Weight of the surface in a sample: 1 on iso-surfaces.
    double surfaceWeight(const DrawnLayer& layer, glm::dvec3 place) const {
        if (std::holds_alternative<IsoLayer>(*layer.technique)) return 1;
        if (layer.samples->categorical()) return 0;
        const bool flat = layer.range.hi == layer.range.lo;
        return flat ? 1 : std::min(1.0, scene.steepness(layer, place) / kFlatGradient);
    }

    LookSample lookSample(const DrawnLayer& layer, const Look& look, glm::dvec3 place, glm::dvec3 gradient, double t,
                          double doi) const {
        const int part = layer.samples->part(scene.cells(place));
        const LookPlaceOf<double> at{.world = place,
                                     .toViewer = -ray.direction,
                                     .along = t * glm::dot(ray.direction, scene.middle),
                                     .distance = t,
                                     .share = lookShare(look.part, doi),
                                     .steepness = scene.steepPlace(layer, place),
                                     .gradient = gradient,
                                     .weight = surfaceWeight(layer, place),
                                     .cut = std::holds_alternative<IsoLayer>(*layer.technique)};
        return lookSampleAt<double>(
            look, scene.look, at, [&](glm::dvec3 offset) { return scene.beside(*layer.samples, place, part, offset); });
    }

    /// Colour and opacity of a sample, after shading and looks.
    struct Drawn {
        glm::dvec3 color{0};
        double opacity = 0;
    };
    Drawn drawn(const DrawnLayer& layer, const Look& look, glm::dvec3 albedo, double opacity, bool shaded,
                glm::dvec3 place, double t, double doi) const {
        const int part = layer.samples->part(scene.cells(place));
        glm::dvec3 narrow(0), gradient(0); // per cell; in world axes
        if ((shaded || look.any()) && !layer.samples->categorical()) {
            narrow = scene.gradient(*layer.samples, place, part);
            gradient = worldGradient(lookGradient(layer, look, place, part, narrow));
        }
        const auto lit = [&](glm::dvec3 color) {
            return vis::shade(scene.light, color, shaded ? gradient : glm::dvec3(0),
                              shaded ? surfaceWeight(layer, place) : 0, place, -ray.direction);
        };
        if (!look.any()) return {lit(albedo), opacity};
        const LookSample sample = lookSample(layer, look, place, gradient, t, doi);
        if (std::holds_alternative<VolumeLayer>(*layer.technique)) opacity = solidOpacity(look, opacity, sample.share);
        const glm::dvec3 color = lit(lookAlbedo(look, albedo, sample.share));
        return {lookColor(look, albedo, color, sample, scene.look.ground), lookOpacity(look, opacity, sample)};
    }

    /// Adds the intersection with an iso-surface between the last sample and the one at t, if both belong to one part.
    void findIso(std::vector<Event>& events, const DrawnLayer& layer, std::optional<Reading> before,
                 std::optional<Reading> now, Number t) const {
        const auto& iso = std::get<IsoLayer>(*layer.technique);
        const bool above = before && before->value >= iso.value;
        if (!before || !now || before->part != now->part || above == (now->value >= iso.value)) return;
        Number lo = t - step, hi = t;
        for (int i = 0; i < kBisections; ++i) {
            const Number middle = (lo + hi) / 2; // where the part has no samples counts as below the value
            const double value = layer.samples->continued(now->part, scene.cells(glm::dvec3(at(middle))));
            ((value >= iso.value) == above ? lo : hi) = middle;
        }
        const glm::dvec3 place(at((lo + hi) / 2));
        if (layer.samples->part(scene.cells(place)) != now->part || !shows(inSamples(double(lo + hi) / 2))) return;
        const Interest doi = scene.interest(place);
        const LensAction lens = scene.lensAction(layer, place, doi.doi);
        const glm::dvec3 plain = scene.tinted(layer, linearFromSrgb(glm::dvec3(iso.color)), place);
        const glm::dvec3 albedo = scene.focused(layer, plain, doi, lens.saturation);
        const double opacity = std::min(double(iso.opacity) * scene.opacityFactor(layer, doi) * lens.opacity, 1.0);
        const Drawn at = drawn(layer, iso.look, albedo, opacity, true, place, double(lo + hi) / 2, doi.doi);
        events.push_back({(lo + hi) / 2, at.color, at.opacity, doi.seen(layer)});
    }

    /// Classified colour and opacity of a composite layer's sample, and the present fraction of its segment.
    struct Classified {
        glm::dvec4 color{0};
        double share = 0;
    };
    Classified classify(const DrawnLayer& layer, Number t) const {
        const glm::dvec3 place(at(t)), cells = scene.cells(place);
        if (layer.classification == Classification::PreIntegrated) {
            const auto readAt = [&](Number where) { return layer.samples->read(scene.cells(glm::dvec3(at(where)))); };
            const std::optional<Reading> front = readAt(t - step / 2), back = readAt(t + step / 2);
            if (!front && !back) return {};
            const double a = layer.place((front ? front : back)->value), b = layer.place((back ? back : front)->value);
            if (front && back && front->part != back->part)
                return {inHalves(preintegrated(*layer.integrals, a, a), preintegrated(*layer.integrals, b, b)), 1.0};
            return {preintegrated(*layer.integrals, a, b), front && back ? 1.0 : 0.5};
        }
        if (layer.classification == Classification::Pre) {
            const auto premultiplied = [&](double value) {
                const glm::dvec4 color = layer.classify(value);
                return glm::dvec4(glm::dvec3(color) * color.a, color.a);
            };
            const std::optional<glm::dvec4> color = layer.samples->blended(cells, premultiplied);
            if (!color || !(color->a > 0)) return {};
            return {glm::dvec4(glm::dvec3(*color) / color->a, color->a), 1};
        }
        const std::optional<double> value = layer.samples->value(cells);
        if (!value) return {};
        return {scene.colorAt(layer, *value, place), 1};
    }

    /// Number of samples from k on that a single sample in their middle represents; `event`: position of the next
    /// slice, in samples.
    int together(int k, double event) const {
        const glm::dvec3 here = scene.cells(glm::dvec3(at(Number(samples.at(k)))));
        const glm::dvec3 next = scene.cells(glm::dvec3(at(Number(samples.at(k + 1)))));
        const glm::dvec3 block = glm::floor(here / double(kStepBlock));
        double inside = 1e6; // samples to the exit from the block
        for (int axis = 0; axis < 3; ++axis) {
            const double advance = next[axis] - here[axis];
            const double wall = (block[axis] + (advance > 0 ? 1 : 0)) * kStepBlock;
            if (std::abs(advance) > 1e-9) inside = std::min(inside, (wall - here[axis]) / advance);
        }
        int most = std::max(1, int(std::floor(inside - 0.01)) + 1);
        most = std::min({most, samples.count - k, int(std::ceil(std::min(event, 1e6))) - k,
                         int(std::min(scene.stepAt(glm::ivec3(block)) / samples.step, 1e3))});
        return std::max(most, 1);
    }

    void drawSample(const DrawnLayer& layer, Number t, int k, int count) {
        const auto& volume = std::get<VolumeLayer>(*layer.technique);
        const Classified classified = classify(layer, t);
        const glm::dvec3 place(at(t));
        const Interest doi = scene.interest(place);
        const LensAction lens = scene.lensAction(layer, place, doi.doi);
        const double opacity = classified.color.a * scene.opacityFactor(layer, doi) * lens.opacity;
        const double thickness = double(volume.density) * classified.share * coverage(holes, k) * count;
        if (opacity <= 0 || thickness <= 0) return;
        const glm::dvec3 color = scene.tinted(layer, glm::dvec3(classified.color), place);
        const Drawn at = drawn(layer, volume.look, scene.focused(layer, color, doi, lens.saturation), opacity,
                               volume.shaded, place, double(t), doi.doi);
        blend(at.color, correctedOpacity(at.opacity, double(step), thickness), doi.seen(layer));
    }

    /// Sets up the sample positions; false if the ray misses the box.
    bool begin(bool perspective, glm::ivec2 pixel, int pass) {
        const std::optional<RaySegment> met = clipToBox(ray, scene.frame.halfSize, perspective);
        if (!met) return false;
        segment = *met;
        for (const PlacedClip& clip : scene.clips) {
            if (clip.hole) continue;
            const RaySegment own = clip.inside(ray);
            segment = {std::max(segment.enter, own.enter), std::min(segment.exit, own.exit)};
        }
        if (segment.enter >= segment.exit) return false;
        samples = raySamples(segment, ray.direction, scene.cell, double(scene.scene.render.stepVoxels));
        if (scene.scene.render.jitter)
            samples.phase += startJitter(std::uint32_t(pixel.x), std::uint32_t(pixel.y), std::uint32_t(pass));
        for (const PlacedClip& clip : scene.clips) {
            const RaySegment own = clip.inside(ray);
            if (clip.hole && own.enter < own.exit) holes.push_back({inSamples(own.enter), inSamples(own.exit)});
        }
        return true;
    }

    void cast() {
        step = Number(samples.step);
        const auto isVolume = [](const DrawnLayer& layer, bool composite) {
            const auto* volume = std::get_if<VolumeLayer>(layer.technique);
            return volume != nullptr && (volume->style == RayStyle::Composite) == composite;
        };
        std::vector<std::optional<Reading>> before(scene.layers.size()), now(scene.layers.size());
        std::vector<Projected> seen(scene.layers.size());
        std::vector<Event> events;
        Number last = Number(samples.enter - kFaceTolerance);
        std::vector<double> slices; // in samples
        if (!scene.steps.empty()) {
            findSlices(events, last, Number(segment.exit + kFaceTolerance));
            for (const Event& event : events) slices.push_back(inSamples(double(event.t)));
            events.clear();
        }
        int count = 1; // samples represented by one
        for (int k = 0; k < samples.count && !opaque(); k += count) {
            const Number t = Number(samples.at(k));
            if (count > 1)
                for (std::size_t i = 0; i < now.size(); ++i)
                    before[i] = scene.layers[i].samples->read(scene.cells(glm::dvec3(at(Number(samples.at(k - 1))))));
            count = 1;
            if (!scene.steps.empty()) {
                double event = 1e6; // the first that is not composited yet
                for (const double slice : slices)
                    if (slice > inSamples(double(last))) event = std::min(event, slice);
                count = together(k, event);
            }
            const Number middle = Number(samples.at(k) + 0.5 * (count - 1) * samples.step);
            const glm::dvec3 place(at(t));
            for (std::size_t i = 0; i < now.size(); ++i) now[i] = scene.layers[i].samples->read(scene.cells(place));
            findSlices(events, last, t);
            for (std::size_t i = 0; i < now.size(); ++i)
                if (k > 0 && std::holds_alternative<IsoLayer>(*scene.layers[i].technique))
                    findIso(events, scene.layers[i], before[i], now[i], t);
            drawEvents(events);
            for (std::size_t i = 0; i < now.size(); ++i) {
                if (isVolume(scene.layers[i], true)) drawSample(scene.layers[i], count > 1 ? middle : t, k, count);
                if (isVolume(scene.layers[i], false))
                    seen[i].add(scene, scene.layers[i], shows(k) ? now[i] : std::nullopt, place, double(step));
            }
            std::swap(before, now);
            last = t;
        }
        if (!opaque()) {
            findSlices(events, last, Number(segment.exit + kFaceTolerance));
            drawEvents(events);
        }
        for (std::size_t i = 0; i < seen.size(); ++i)
            if (const auto shown = seen[i].shown(scene, scene.layers[i]))
                blend(shown->color, shown->opacity, shown->interest);
    }
};

template <class Number>
Image renderWith(const Scene& scene, const volume::BrickSource& source, glm::ivec2 size, const Options& options) {
    const Prepared prepared(scene, source, size, options);
    const int passes = raysPerPixel(scene);
    const bool perspective = scene.camera.projection == Projection::Perspective;
    const std::size_t count = std::size_t(size.x) * std::size_t(size.y);
    Image image{size, std::vector<glm::dvec4>(count), std::vector<double>(count)};
    parallelFor(std::size_t(size.y), [&](std::size_t y) {
        for (int x = 0; x < size.x; ++x)
            for (int pass = 0; pass < passes; ++pass) {
                // The shader counts pixel rows from the bottom.
                const glm::ivec2 pixel(x, size.y - 1 - int(y));
                const Camera camera = lensCamera(scene.camera, pass, passes);
                const auto rayOf = [&](glm::ivec2 of) {
                    const glm::dvec2 ndc = (glm::dvec2(of) + 0.5 + pixelJitter(pass)) / glm::dvec2(size) * 2.0 - 1.0;
                    return cameraRay(camera, double(size.x) / size.y, ndc);
                };
                Caster<Number> caster{
                    prepared, rayOf(pixel), {rayOf({pixel.x ^ 1, pixel.y}), rayOf({pixel.x, pixel.y ^ 1})}, {}, {}};
                if (!caster.begin(perspective, pixel, pass)) continue;
                caster.cast();
                glm::dvec4& out = image.pixels[y * std::size_t(size.x) + std::size_t(x)];
                out += glm::dvec4(caster.out) / double(passes);
                if (pass == 0 && caster.out.a > 0)
                    image.interest[y * std::size_t(size.x) + std::size_t(x)] = caster.interest / double(caster.out.a);
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
