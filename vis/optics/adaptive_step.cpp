#include "vis/optics/adaptive_step.h"

#include "vis/optics/ray_setup.h"
#include "vis/scene/drawn_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::vis {

namespace {

constexpr int kNodes = 2048;
constexpr double kThickestMedium = 0.999; ///< opacity; a denser medium ends a ray at once anyway

/// Whether a bound on longer steps is known for a layer.
bool adapts(const DrawnLayer& layer, const Scene& scene) {
    if (layer.look && layer.look->any()) return false;
    if (!layer.volume) return true;
    return layer.volume->style == RayStyle::Composite && !layer.colors && !layer.gradient && !layer.byRegions &&
           layer.classification != Classification::PreIntegrated &&
           (layer.brushes == BrushEffect::None || !scene.selection.active());
}

} // namespace

CurveMedium::CurveMedium(const TransferFunction& function, Range range, double density, bool shaded) : shaded_(shaded) {
    std::vector<Bounds>& nodes = levels_.emplace_back();
    for (int i = 0; i < kNodes; ++i) {
        const glm::dvec4 at = evaluate(function, range, glm::mix(range.lo, range.hi, double(i) / (kNodes - 1)));
        const double t = -std::log(1 - std::min(at.a, kThickestMedium)) * density / kReferenceLength;
        const glm::vec4 medium(linearFromSrgb(glm::dvec3(at)) * t, t);
        nodes.push_back({medium.x, medium.y, medium.z, medium.w, medium.x, medium.y, medium.z, medium.w});
    }
    for (int width = 1; 2 * width <= kNodes; width *= 2) {
        const std::vector<Bounds>& half = levels_.back();
        std::vector<Bounds> whole;
        for (std::size_t i = 0; i + std::size_t(width) < half.size(); ++i)
            whole.push_back(both(half[i], half[i + std::size_t(width)]));
        levels_.push_back(std::move(whole));
    }
}

CurveMedium::Bounds CurveMedium::both(const Bounds& a, const Bounds& b) {
    Bounds out;
    for (std::size_t i = 0; i < 8; ++i) out[i] = i < 4 ? std::min(a[i], b[i]) : std::max(a[i], b[i]);
    return out;
}

BlockMedium CurveMedium::between(double a, double b, bool absent) const {
    const auto node = [](double place) { return std::clamp(place, 0.0, 1.0) * (kNodes - 1); };
    const std::size_t first(std::size_t(std::floor(node(std::min(a, b))))),
        last(std::size_t(std::ceil(node(std::max(a, b)))));
    std::size_t level = 0;
    while ((std::size_t(2) << level) <= last - first + 1) ++level;
    const Bounds bounds = both(levels_[level][first], levels_[level][last + 1 - (std::size_t(1) << level)]);
    BlockMedium out;
    out.greatest = double(bounds[7]);
    for (std::size_t i = 0; i < 4; ++i)
        out.spread = std::max(out.spread, double(bounds[i + 4]) - (absent ? 0 : double(bounds[i])));
    if (shaded_) out.spread += out.greatest * std::min(1.0, std::sqrt(3.0) * std::abs(b - a) / kFlatGradient);
    return out;
}

double longestStep(std::span<const BlockMedium> layers, double accepted) {
    double spread = 0, thickness = 0, pairs = 0;
    for (const BlockMedium& layer : layers) {
        spread += layer.spread;
        pairs += thickness * layer.greatest;
        thickness += layer.greatest;
    }
    if (pairs > 0) return (std::sqrt(spread * spread + 4 * pairs * accepted) - spread) / (2 * pairs);
    return spread > 0 ? accepted / spread : std::numeric_limits<double>::infinity();
}

int stepCode(double step, double unit) {
    if (!(step > unit)) return 0;
    return int(std::min(8 * std::log2(step / unit), double(kMostSteps)));
}

double stepOfCode(int code, double unit) {
    return unit * std::exp2(code / 8.0);
}

double stepUnit(glm::dvec3 worldCell) {
    return std::min({worldCell.x, worldCell.y, worldCell.z}) / 16;
}

bool stepsAdapt(const Scene& scene, const volume::DatasetInfo& info) {
    const auto cutsHole = [](const Clip& clip) { return clip.enabled && clip.keep == ClipKeep::Outside; };
    return scene.render.adaptiveStep > 0 && !scene.lighting.shadows.any() &&
           std::ranges::none_of(scene.lenses, &Lens::enabled) && std::ranges::none_of(scene.clips, cutsHole) &&
           std::ranges::all_of(drawnScene(scene, info).layers,
                               [&](const DrawnLayer& layer) { return adapts(layer, scene); });
}

} // namespace tessera::vis
