#include "vis/technique/ray_tables.h"

#include "vis/model/preintegration.h"
#include "vis/model/selection_bounds.h"
#include "vis/technique/ray_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace tessera::vis {

namespace {

constexpr double kLabelRoom = 0.25;
constexpr float kTexelSlack = 1e-4f; ///< rounding of the textures and of their interpolation

/// Page of a function of regions.
void addRegions(std::vector<glm::vec4>& table, const TransferFunction& function, Range range) {
    for (int y = 0; y < kPlaneSize; ++y)
        for (int x = 0; x < kPlaneSize; ++x) {
            const double value = glm::mix(range.lo, range.hi, double(x) / (kPlaneSize - 1));
            const double gradient = double(function.gradientTop) * y / (kPlaneSize - 1);
            const glm::dvec4 at = evaluate(function, range, value, gradient);
            table.emplace_back(glm::vec3(linearFromSrgb(glm::dvec3(at)) * at.a), float(at.a));
        }
}

/// Greatest opacity of a function of regions at each of the kTableSize places, over all gradients and what the page's
/// interpolation can make of them.
std::vector<float> mostOpaque(const TransferFunction& function) {
    std::vector<float> columns(kPlaneSize, 0), out;
    for (int x = 0; x < kPlaneSize; ++x)
        for (int y = 0; y < kPlaneSize; ++y)
            columns[std::size_t(x)] =
                std::max(columns[std::size_t(x)], float(evaluate(function, {0, 1}, double(x) / (kPlaneSize - 1),
                                                                 double(function.gradientTop) * y / (kPlaneSize - 1))
                                                            .a));
    for (int i = 0; i < kTableSize; ++i) {
        const double at = double(i) / (kTableSize - 1) * (kPlaneSize - 1);
        out.push_back(std::max(columns[std::size_t(std::floor(at))], columns[std::size_t(std::ceil(at))]));
    }
    return out;
}

} // namespace

std::vector<glm::vec4> planeTables(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info) {
    std::vector<glm::vec4> table;
    for (const RayLayer& layer : plan.layers) {
        if (layer.page < 0) continue;
        const auto [function, range] = transferOf(scene, info, plan.fields[std::size_t(layer.field)]);
        if (layer.lookup == RayLookup::Plane) {
            addRegions(table, function, range);
        } else {
            const std::vector<glm::vec4> page = preintegrationTable(integralFunctions(function, range), kPlaneSize);
            table.insert(table.end(), page.begin(), page.end());
        }
    }
    return table;
}

std::vector<glm::vec4> transferTables(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info) {
    std::vector<glm::vec4> table;
    const auto add = [&](int field) {
        const auto [function, range] = transferOf(scene, info, plan.fields[std::size_t(field)]);
        for (int i = 0; i < kTableSize; ++i) {
            const double value = glm::mix(range.lo, range.hi, double(i) / (kTableSize - 1));
            const glm::dvec4 at = evaluate(function, range, value);
            table.emplace_back(glm::vec3(linearFromSrgb(glm::dvec3(at))), float(at.a));
        }
    };
    for (const RayLayer& layer : plan.layers) add(layer.field);
    for (const SliceUse& slice : plan.slices) add(slice.field);
    for (std::size_t row = 0; row < plan.layers.size(); ++row) {
        const RayLayer& layer = plan.layers[row];
        std::vector<float> regions;
        if (layer.lookup == RayLookup::Plane)
            regions = mostOpaque(transferOf(scene, info, plan.fields[std::size_t(layer.field)]).function);
        for (int i = 0; i < kTableSize; ++i) {
            const std::size_t at = row * kTableSize + std::size_t(i), next = at + (i + 1 < kTableSize);
            const float own = regions.empty() ? table[at].a : regions[at - row * kTableSize];
            const float other = regions.empty() ? table[next].a : regions[next - row * kTableSize];
            table.emplace_back(glm::vec3(0), std::max(own, other));
        }
    }
    return table;
}

std::vector<std::optional<glm::vec2>> opaqueIntervals(const RayPlan& plan, const std::vector<glm::vec4>& tables) {
    constexpr float kAny = std::numeric_limits<float>::max();
    std::vector<std::optional<glm::vec2>> out;
    for (std::size_t layer = 0; layer < plan.layers.size(); ++layer) {
        const glm::vec4* row = &tables[(plan.layers.size() + plan.slices.size() + layer) * kTableSize];
        const auto opaque = [](const glm::vec4& entry) { return entry.a > 0; };
        const glm::vec4* begin = std::find_if(row, row + kTableSize, opaque);
        const glm::vec4* end = std::find_if_not(begin, row + kTableSize, opaque);
        if (std::any_of(end, row + kTableSize, opaque)) {
            out.emplace_back();
            continue;
        }
        // Entry i tells of what lies between i and i + 1.
        const auto place = [&](const glm::vec4* entry) { return float(entry - row) / (kTableSize - 1); };
        out.emplace_back(glm::vec2(begin == row ? -kAny : place(begin), end == row + kTableSize ? kAny : place(end)));
    }
    return out;
}

namespace {

/// Whether some texel value between lo and hi gets opacity from a transfer function; asks a running maximum free table.
bool anyOpacity(const std::vector<float>& opacity, glm::dvec2 map, float lo, float hi) {
    const auto place = [&](double texel) { return std::clamp(texel * map.x + map.y, 0.0, 1.0) * (kTableSize - 1); };
    double a = place(lo), b = place(hi);
    if (a > b) std::swap(a, b);
    for (auto i = std::size_t(std::floor(a)); i <= std::size_t(std::ceil(b)); ++i)
        if (opacity[i] > 0) return true;
    return false;
}

/// Chebyshev distance of every block to the nearest one whose distance is 0, in place.
void spread(std::vector<std::uint8_t>& distance, glm::ivec3 count) {
    const std::size_t strides[] = {1, std::size_t(count.x), std::size_t(count.x) * std::size_t(count.y)};
    // Two chamfer sweeps over all 26 neighbours give the exact Chebyshev distance.
    const auto relax = [&](int x, int y, int z, bool forward) {
        const std::size_t at = std::size_t(x) + strides[1] * std::size_t(y) + strides[2] * std::size_t(z);
        int best = distance[at];
        for (int dz = -1; dz <= 1 && best > 0; ++dz)
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    const int order = dz * 9 + dy * 3 + dx;
                    if (forward ? order >= 0 : order <= 0) continue;
                    const int nx = x + dx, ny = y + dy, nz = z + dz;
                    if (nx < 0 || ny < 0 || nz < 0 || nx >= count.x || ny >= count.y || nz >= count.z) continue;
                    best = std::min(
                        best,
                        1 + distance[std::size_t(nx) + strides[1] * std::size_t(ny) + strides[2] * std::size_t(nz)]);
                }
        distance[at] = std::uint8_t(std::min(best, 255));
    };
    for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x) relax(x, y, z, true);
    for (int z = count.z - 1; z >= 0; --z)
        for (int y = count.y - 1; y >= 0; --y)
            for (int x = count.x - 1; x >= 0; --x) relax(x, y, z, false);
}

/// Whether a layer shows nothing of what is out of focus.
bool hidesContext(const RayLayer& layer, const Selection& selection) {
    return layer.brushes == BrushEffect::FocusOnly ||
           (layer.brushes == BrushEffect::Fade && selection.contextOpacity <= 0);
}

/// 1 for each block where every sample is out of focus; empty: nothing can be said, or no layer asks.
std::vector<std::uint8_t> outOfFocus(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info,
                                     const BlockRanges& grid) {
    const auto asks = [&](const RayLayer& layer) { return hidesContext(layer, scene.selection); };
    if (!scene.selection.active() || std::ranges::none_of(plan.layers, asks)) return {};
    // Outside of these nothing is brushed.
    if (std::ranges::any_of(scene.lenses, [](const Lens& lens) { return lens.effect == LensEffect::Focus; })) return {};
    const std::vector<volume::Channel> channels = info.channels();
    std::vector<const BoundField*> fields;
    for (const int index : plan.brushFields) {
        const BoundField& field = plan.fields[std::size_t(index)];
        if (field.blocks && field.blocks->count == grid.count) fields.push_back(&field);
    }
    std::vector<std::uint8_t> out(grid.min.size());
    std::map<std::string, Range> ranges;
    for (std::size_t i = 0; i < out.size(); ++i) {
        for (const BoundField* field : fields) {
            const double room = field->categorical ? kLabelRoom : 0; // as in brush_uniforms.cpp
            const TexelEncoding& encoding = field->encoding;
            ranges[channels[std::size_t(field->channel)].name] = {
                encoding.offset + encoding.scale * double(field->blocks->min[i] - kTexelSlack) - room,
                encoding.offset + encoding.scale * double(field->blocks->max[i] + kTexelSlack) + room};
        }
        out[i] = interestBounds(scene.selection, ranges).hi == 0 ? 1 : 0;
    }
    return out;
}

} // namespace

std::optional<BlockDistances> blockDistances(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info) {
    const BlockRanges* grid = commonBlocks(plan);
    if (!grid) return std::nullopt;
    BlockDistances out;
    out.count = grid->count;
    const std::size_t total = grid->min.size();
    out.distance.assign(total, 255);
    const std::vector<std::uint8_t> hidden = outOfFocus(plan, scene, info, *grid);
    for (const RayLayer& use : plan.layers) {
        const BoundField& field = plan.fields[std::size_t(use.field)];
        const Layer& layer = scene.layers[std::size_t(use.layer)];
        const BlockRanges& blocks = *field.blocks;
        std::vector<float> opacity;
        glm::dvec2 map{0};
        double value = 0;
        if (use.style == RayStyle::Iso) {
            value = toTexel(field, std::get<IsoLayer>(layer.technique).value);
        } else {
            map = transferMap(field, scene, info);
            const TransferFunction& function = transferOf(scene, info, field).function;
            if (use.lookup == RayLookup::Plane) opacity = mostOpaque(function);
            for (int i = 0; use.lookup != RayLookup::Plane && i < kTableSize; ++i)
                opacity.push_back(float(evaluate(function, {0, 1}, double(i) / (kTableSize - 1)).a));
        }
        for (std::size_t i = 0; i < total; ++i) {
            if (!(blocks.min[i] <= blocks.max[i])) continue;
            const float lo = blocks.min[i] - kTexelSlack, hi = blocks.max[i] + kTexelSlack;
            bool shows = true;
            if (use.style == RayStyle::Iso) shows = lo <= value && value <= hi;
            // The gradient reaches beyond the block.
            if (use.style == RayStyle::Composite && !use.gradient) shows = anyOpacity(opacity, map, lo, hi);
            // Projections count what is out of focus.
            if (use.style == RayStyle::Composite || use.style == RayStyle::Iso)
                shows = shows && (hidden.empty() || hidden[i] == 0 || !hidesContext(use, scene.selection));
            if (shows) out.distance[i] = 0;
        }
    }
    std::size_t occupied = 0;
    out.begin = out.count;
    for (std::size_t i = 0; i < total; ++i)
        if (out.distance[i] == 0) {
            ++occupied;
            const glm::ivec3 at(int(i % std::size_t(out.count.x)),
                                int(i / std::size_t(out.count.x) % std::size_t(out.count.y)),
                                int(i / std::size_t(out.count.x) / std::size_t(out.count.y)));
            out.begin = glm::min(out.begin, at);
            out.end = glm::max(out.end, at + 1);
        }
    out.occupied = total ? double(occupied) / double(total) : 1;
    spread(out.distance, out.count);
    return out;
}

} // namespace tessera::vis
