#include "tests/reference/projection.h"

#include <algorithm>

namespace tessera::vis::reference {

void Projected::add(const Prepared& scene, const DrawnLayer& layer, std::optional<Reading> found, glm::dvec3 place,
                    double step) {
    const auto& volume = std::get<VolumeLayer>(*layer.technique);
    const double threshold = std::max(0.0, layer.unclamped(volume.threshold));
    if (!found) {
        sums_.add(volume.style, threshold, false, 0, 0, 0);
        return;
    }
    const Interest doi = scene.interest(place);
    const LensAction lens = scene.lensAction(layer, place, doi.doi);
    const double factor = scene.opacityFactor(layer, doi) * lens.opacity;
    const double along =
        volume.quantity == Quantity::Gradient ? scene.steepPlace(layer, place) : layer.unclamped(found->value);
    const double x = std::clamp(along, 0.0, 1.0);
    const double corrected = correctedOpacity(layer.classifyPlace(x).a * factor, step, double(volume.density));
    const double absorbed = (1 - sums_.absorbed) * corrected;
    if (sums_.add(volume.style, threshold, true, along, factor, corrected))
        bestWorld_ = place, bestInterest_ = doi, bestLens_ = lens;
    const bool sums = volume.style == RayStyle::Average || volume.style == RayStyle::XRay;
    if (const auto tint = sums && layer.colors ? layer.colors->value(scene.cells(place)) : std::nullopt) {
        const double weight = volume.style == RayStyle::XRay ? absorbed : factor;
        tint_ += weight * *tint;
        tintWeight_ += weight;
    }
}

glm::dvec3 Projected::colorOfSum(const DrawnLayer& layer, glm::dvec4 own) const {
    if (!layer.colors) return glm::dvec3(own);
    return Prepared::tint(layer, tintWeight_ > 0 ? std::optional(tint_ / tintWeight_) : std::nullopt);
}

std::optional<Projected::Shown> Projected::shown(const Prepared& scene, const DrawnLayer& layer) const {
    if (sums_.count == 0 || !(sums_.factors > 0)) return std::nullopt;
    const auto& volume = std::get<VolumeLayer>(*layer.technique);
    const auto opacity = [&](glm::dvec4 color) { return std::min(1.0, double(volume.density) * color.a); };
    if (volume.style == RayStyle::XRay)
        return Shown{colorOfSum(layer, layer.classifyPlace(sums_.absorbed)), sums_.absorbed};
    if (volume.style == RayStyle::Average) {
        // The mean has no position: brushes affect it only through its weights.
        const glm::dvec4 color = layer.classifyPlace(std::clamp(sums_.weighted / sums_.factors, 0.0, 1.0));
        return Shown{colorOfSum(layer, color), std::min(opacity(color) * sums_.factors / sums_.count, 1.0)};
    }
    const glm::dvec4 color = layer.classifyPlace(sums_.bestPlace);
    const double factor = scene.opacityFactor(layer, bestInterest_) * bestLens_.opacity;
    const glm::dvec3 tinted = scene.tinted(layer, glm::dvec3(color), bestWorld_);
    return Shown{scene.focused(layer, tinted, bestInterest_, bestLens_.saturation),
                 std::min(opacity(color) * factor, 1.0), bestInterest_.seen(layer)};
}

} // namespace tessera::vis::reference
