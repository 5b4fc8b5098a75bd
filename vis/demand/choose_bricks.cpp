#include "vis/demand/choose_bricks.h"

#include "vis/optics/light_volume.h"
#include "vis/raycast/ray_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace tessera::vis {

namespace {

std::size_t countOf(glm::ivec3 size) {
    return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
}

constexpr std::uint8_t kNotWanted = BrickDemand::kNotWanted;
constexpr double kInLens = 0.5; ///< bricks in a lens are as urgent as others at half the distance

/// An axis-aligned box in world space.
struct WorldBox {
    glm::dvec3 centre, half;
    double below(glm::dvec3 normal) const { // minimum of dot(normal, p)
        return glm::dot(normal, centre) - glm::dot(glm::abs(normal), half);
    }
};

/// The view frustum as planes, and the size of a pixel.
class Sight {
public:
    Sight(const Camera& camera, glm::ivec2 size) {
        const double aspect = double(size.x) / size.y;
        const std::array<Ray, 4> corners{cameraRay(camera, aspect, {-1, -1}), cameraRay(camera, aspect, {1, -1}),
                                         cameraRay(camera, aspect, {1, 1}), cameraRay(camera, aspect, {-1, 1})};
        const Ray middle = cameraRay(camera, aspect, {0, 0}), up = cameraRay(camera, aspect, {0, 1});
        perspective_ = camera.projection == Projection::Perspective;
        eye_ = middle.origin;
        forward_ = middle.direction;
        const glm::dvec3 inside = middle.origin + middle.direction;
        for (std::size_t i = 0; i < 4; ++i) {
            const Ray &a = corners[i], &b = corners[(i + 1) % 4];
            glm::dvec3 normal = glm::cross(a.direction, perspective_ ? b.direction : b.origin - a.origin);
            if (glm::dot(normal, inside - a.origin) < 0) normal = -normal;
            normals_[i] = glm::normalize(normal);
            offsets_[i] = glm::dot(normals_[i], a.origin);
        }
        const double half = perspective_ ? glm::length(up.direction / glm::dot(up.direction, forward_) - forward_)
                                         : glm::length(up.origin - middle.origin);
        pixel_ = 2 * half / size.y;
    }

    bool sees(const WorldBox& box) const {
        for (std::size_t i = 0; i < 4; ++i)
            if (-box.below(-normals_[i]) < offsets_[i]) return false;
        return !perspective_ || -box.below(-forward_) > glm::dot(forward_, eye_);
    }
    /// Depth of the nearest point of a box along the view; 0 when the eye is inside.
    double depth(const WorldBox& box) const { return std::max(0.0, box.below(forward_) - glm::dot(forward_, eye_)); }
    /// World size of a pixel at a depth.
    double pixel(double depth) const { return perspective_ ? pixel_ * std::max(depth, 1e-6) : pixel_; }
    /// Distance of a point from the view axis, in world units.
    double aside(glm::dvec3 point) const {
        const glm::dvec3 from = point - eye_;
        return glm::length(from - forward_ * glm::dot(from, forward_));
    }

private:
    bool perspective_ = true;
    glm::dvec3 eye_{0}, forward_{0, 0, -1};
    std::array<glm::dvec3, 4> normals_{};
    std::array<double, 4> offsets_{};
    double pixel_ = 0; ///< at depth 1, or everywhere
};

/// Marks bricks in which a layer that uses the field is visible.
void markShown(std::vector<std::uint8_t>& shown, const RayPlan& plan, int field, const Scene& scene,
               const volume::DatasetInfo& info) {
    RayPlan part = plan;
    std::erase_if(part.layers, [&](const RayLayer& layer) { return layer.field != field; });
    if (part.layers.empty()) return;
    const std::optional<BlockDistances> blocks = blockDistances(part, scene, info);
    for (std::size_t i = 0; i < shown.size(); ++i)
        if (!blocks || i >= blocks->distance.size() || blocks->distance[i] == 0) shown[i] = 1;
}

/// The coarsest level whose voxels, `pixels` large at full resolution, do not exceed `detail`.
std::uint8_t levelOf(double pixels, double detail, int levels) {
    int level = 0;
    while (level + 1 < levels && pixels * double(2 << level) <= detail) ++level;
    return std::uint8_t(level);
}

/// The level used for the light volume, independent of the picture: its voxels match the sample distance within a light
/// cell. Empty if the scene has no such light.
std::optional<std::uint8_t> lightLevel(const Scene& scene, const WorldFrame& frame, double voxel, int levels) {
    if (!scene.lighting.shadows.any()) return std::nullopt;
    const glm::dvec3 part = lightGrid(frame, scene.lighting.shadows).cell() / double(kMediumSamples);
    return levelOf(voxel, std::min({part.x, part.y, part.z}), levels);
}

/// Factor by which the voxels of unimportant bricks may be larger.
class Coarser {
public:
    Coarser(std::span<const float> importance, double levels) : importance_(importance), levels_(levels) {
        for (const float each : importance) most_ = std::max(most_, each);
    }
    double operator()(std::size_t brick) const {
        return most_ > 0 ? std::exp2(levels_ * (1 - double(importance_[brick]) / double(most_))) : 1;
    }

private:
    std::span<const float> importance_;
    double levels_;
    float most_ = 0;
};

/// Keeps only the most urgent `share` of the wanted bricks.
void keepMostUrgent(BrickDemand& demand, double share) {
    if (share >= 1) return;
    std::vector<float> priorities;
    for (std::size_t i = 0; i < demand.level.size(); ++i)
        if (demand.level[i] != kNotWanted) priorities.push_back(demand.priority[i]);
    const std::size_t left = std::size_t(share * double(priorities.size()));
    if (left > 0) std::nth_element(priorities.begin(), priorities.begin() + std::ptrdiff_t(left), priorities.end());
    for (std::size_t i = 0; i < demand.level.size(); ++i)
        if (left == 0 || demand.priority[i] >= priorities[left]) demand.level[i] = kNotWanted;
}

/// Whether a box may intersect a lens.
bool meets(const PlacedLens& lens, const WorldBox& box) {
    if (lens.shape == LensShape::Selection) return false; // it asks for no detail of its own
    // Largest extent of the box along each unit-shape coordinate.
    glm::dvec3 reach(0);
    for (int axis = 0; axis < 3; ++axis) reach += glm::abs(glm::dvec3(lens.toUnit[axis])) * box.half[axis];
    if (lens.shape != LensShape::Disc) return lens.radius(box.centre) - glm::length(reach) < 1;
    // A cone: |u_xy| < 1 + u_z.
    const glm::dvec3 u = lens.toUnit * (box.centre - lens.center);
    return glm::length(glm::dvec2(u)) - u.z < 1 + glm::length(glm::dvec2(reach)) + reach.z;
}

/// Per field and brick, 1 if something is visible, else 0.
using ShownBricks = std::vector<std::vector<std::uint8_t>>;

/// From the known ranges of the bricks' values. Does not cover slices and brushes.
ShownBricks shownByLayers(RayPlan plan, const Scene& scene, const volume::DatasetInfo& info,
                          const std::vector<const BlockRanges*>& ranges, std::size_t bricks) {
    ShownBricks shown(plan.fields.size(), std::vector<std::uint8_t>(bricks, 0));
    for (std::size_t f = 0; f < shown.size(); ++f) {
        plan.fields[f].blocks = ranges[f];
        if (ranges[f]) markShown(shown[f], plan, int(f), scene, info);
    }
    // A colour channel is needed wherever its layer is visible.
    if (std::ranges::none_of(plan.layers, [](const RayLayer& layer) { return layer.color >= 0; })) return shown;
    const ShownBricks shapes = shown;
    for (const RayLayer& layer : plan.layers)
        for (std::size_t i = 0; layer.color >= 0 && i < bricks; ++i)
            if (shapes[std::size_t(layer.field)][i]) shown[std::size_t(layer.color)][i] = 1;
    return shown;
}

/// Chooses the wanted level of each brick of a picture.
class Chooser {
public:
    Chooser(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info, const volume::BrickGrid& grid,
            const DemandSettings& settings)
        : plan_(plan), grid_(grid), settings_(settings), frame_(worldFrame(info, scene.stretch)),
          sight_(scene.camera, glm::max(settings.size, glm::ivec2(1))), cursor_(frame_.toWorld(scene.cursor)) {
        const glm::dvec3 voxels = worldCell(grid.lattice, frame_);
        voxel_ = std::max({voxels.x, voxels.y, voxels.z});
        light_ = lightLevel(scene, frame_, voxel_, grid.levels);
        for (const SliceUse& use : plan.slices)
            planes_.push_back(
                slicePlane(std::get<SliceLayer>(scene.layers[std::size_t(use.layer)].technique), frame_, scene.cursor));
    }

    /// A brick inside the view.
    struct Seen {
        double pixels = 0; ///< edge of a full-resolution voxel on screen
        double detail = 0;
        float priority = 0;
    };
    /// Returns nullopt if the box is outside the view.
    std::optional<Seen> look(const WorldBox& box) const {
        if (!sight_.sees(box)) return std::nullopt;
        const double depth = sight_.depth(box);
        Seen seen{voxel_ / sight_.pixel(depth), settings_.detail, 0};
        bool inLens = false;
        for (const PlacedLens& lens : plan_.lenses) {
            if (!meets(lens, box)) continue;
            inLens = true;
            if (lens.detail != 1) seen.detail = settings_.detail * lens.detail;
        }
        const double toCursor = glm::length(glm::max(glm::abs(cursor_ - box.centre) - box.half, 0.0));
        seen.priority = float((depth + 0.5 * sight_.aside(box.centre) + 0.25 * toCursor) * (inLens ? kInLens : 1));
        return seen;
    }
    /// The box of a brick, plus one cell on every side for the shifted sublattice and interpolation.
    WorldBox box(glm::ivec3 brick) const {
        const volume::Lattice& lattice = grid_.lattice;
        const glm::dvec3 lo = glm::dvec3(brick * grid_.brickSize) - 1.0, hi = lo + double(grid_.brickSize) + 2.0;
        const auto world = [&](glm::dvec3 cell) { return frame_.sheetToWorld(lattice.sheetOfCells(cell)); };
        return {0.5 * (world(lo) + world(hi)), 0.5 * glm::abs(frame_.scale * lattice.spacing) * (hi - lo)};
    }
    /// Marks brick i for slices that cross its box, and for fields of brushes if anything in it is visible.
    void addSlicesAndBrushes(ShownBricks& shown, std::size_t i, const WorldBox& box) const {
        for (std::size_t s = 0; s < planes_.size(); ++s) {
            const double offset = planes_[s].offset;
            if (box.below(planes_[s].normal) > offset || -box.below(-planes_[s].normal) < offset) continue;
            shown[std::size_t(plan_.slices[s].field)][i] = 1;
        }
        if (std::ranges::none_of(shown, [i](const std::vector<std::uint8_t>& field) { return field[i] != 0; })) return;
        for (const int brush : plan_.brushFields) shown[std::size_t(brush)][i] = 1;
    }
    /// The wanted level of a brick whose voxels may be larger by `coarser`; hidden: only needed for the light volume.
    std::uint8_t level(const Seen& seen, double coarser, bool hidden) const {
        const std::uint8_t level = levelOf(seen.pixels, seen.detail * coarser, grid_.levels);
        if (!hidden) return level;
        return light_ ? std::max(level, *light_) : kNotWanted;
    }

private:
    const RayPlan& plan_;
    const volume::BrickGrid& grid_;
    const DemandSettings& settings_;
    WorldFrame frame_;
    Sight sight_;
    glm::dvec3 cursor_;
    double voxel_ = 0;
    std::optional<std::uint8_t> light_;
    std::vector<Plane> planes_;
};

/// Fields with the same samples but different transfer functions get a common demand.
void joinSameSamples(std::vector<BrickDemand>& demands, const RayPlan& plan, const ShownBricks& shown) {
    for (std::size_t f = 0; f < demands.size(); ++f)
        for (std::size_t g = 0; g < demands.size(); ++g) {
            const BoundField &a = plan.fields[f], &b = plan.fields[g];
            if (f == g || a.channel != b.channel || a.raw != b.raw || a.timeShift != b.timeShift) continue;
            for (std::size_t k = 0; k < shown[g].size(); ++k)
                if (shown[g][k]) {
                    demands[f].level[k] = demands[g].level[k];
                    demands[f].priority[k] = demands[g].priority[k];
                    demands[f].hidden[k] = demands[g].hidden[k];
                }
        }
}

} // namespace

std::vector<std::shared_ptr<const BrickDemand>>
brickDemands(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info, const volume::BrickGrid& grid,
             const std::vector<const BlockRanges*>& ranges, const std::vector<std::span<const float>>& importance,
             const DemandSettings& settings, std::span<const std::uint8_t> hidden) {
    const glm::ivec3 count = grid.count();
    const std::size_t total = countOf(count), fields = plan.fields.size();
    ShownBricks shown = shownByLayers(plan, scene, info, ranges, total);
    const Chooser chooser(plan, scene, info, grid, settings);
    BrickDemand none;
    none.level.assign(total, kNotWanted);
    none.priority.assign(total, 0);
    none.hidden.assign(total, 0);
    std::vector<BrickDemand> demands(fields, none);
    std::vector<Coarser> coarser;
    for (std::size_t f = 0; f < fields; ++f) coarser.emplace_back(importance[f], settings.importance);
    for (std::size_t i = 0; i < total; ++i) {
        const std::size_t row = i / std::size_t(count.x);
        const WorldBox box = chooser.box(
            {int(i % std::size_t(count.x)), int(row % std::size_t(count.y)), int(row / std::size_t(count.y))});
        const std::optional<Chooser::Seen> seen = chooser.look(box);
        if (!seen) continue;
        chooser.addSlicesAndBrushes(shown, i, box);
        const bool behind = !hidden.empty() && hidden[i] != 0;
        for (std::size_t f = 0; f < fields; ++f) {
            if (!shown[f][i]) continue;
            demands[f].hidden[i] = behind;
            demands[f].level[i] = chooser.level(*seen, coarser[f](i), behind);
            demands[f].priority[i] = seen->priority;
        }
    }
    for (BrickDemand& demand : demands) keepMostUrgent(demand, settings.share);
    joinSameSamples(demands, plan, shown);
    std::vector<std::shared_ptr<const BrickDemand>> out;
    for (std::size_t f = 0; f < fields; ++f)
        out.push_back(ranges[f] ? std::make_shared<const BrickDemand>(std::move(demands[f])) : nullptr);
    return out;
}

} // namespace tessera::vis
