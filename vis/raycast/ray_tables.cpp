#include "vis/raycast/ray_tables.h"

#include "vis/optics/preintegration.h"
#include "vis/raycast/ray_field.h"
#include "vis/scene/selection_bounds.h"
#include "vis/transfer/block_distance.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace tessera::vis {

namespace {

constexpr int kFocusGroup = 2;       ///< blocks along the edge of a group that shares interest bounds
constexpr float kTexelSlack = 1e-4f; ///< tolerance for rounding of textures and their interpolation

/// Appends the page of a 2D transfer function.
void addRegions(std::vector<glm::vec4>& table, const TransferFunction& function, Range range) {
    for (int y = 0; y < kPlaneSize; ++y)
        for (int x = 0; x < kPlaneSize; ++x) {
            const double value = glm::mix(range.lo, range.hi, double(x) / (kPlaneSize - 1));
            const double gradient = double(function.gradientTop) * y / (kPlaneSize - 1);
            const glm::dvec4 at = evaluate(function, range, value, gradient);
            table.emplace_back(glm::vec3(linearFromSrgb(glm::dvec3(at)) * at.a), float(at.a));
        }
}

/// Largest opacity of a 2D transfer function at each of the kTableSize values over all gradient magnitudes, including
/// interpolation of the page.
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
        const DrawnChannel shown = drawnChannel(scene, info, plan.fields[std::size_t(layer.field)]);
        if (layer.lookup == RayLookup::Plane) {
            addRegions(table, *shown.function, shown.range);
        } else {
            const std::vector<glm::vec4> page =
                preintegrationTable(integralFunctions(*shown.function, shown.range), kPlaneSize);
            table.insert(table.end(), page.begin(), page.end());
        }
    }
    return table;
}

std::vector<glm::vec4> transferTables(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info) {
    std::vector<glm::vec4> table;
    const auto add = [&](int field) {
        const DrawnChannel shown = drawnChannel(scene, info, plan.fields[std::size_t(field)]);
        const Range range = shown.range;
        for (int i = 0; i < kTableSize; ++i) {
            const double value = glm::mix(range.lo, range.hi, double(i) / (kTableSize - 1));
            const glm::dvec4 at = evaluate(*shown.function, range, value);
            table.emplace_back(glm::vec3(linearFromSrgb(glm::dvec3(at))), float(at.a));
        }
    };
    for (const RayLayer& layer : plan.layers) add(layer.field);
    for (const SliceUse& slice : plan.slices) add(slice.field);
    for (const RayLayer& layer : plan.layers)
        if (layer.color >= 0) add(layer.color);
    for (std::size_t row = 0; row < plan.layers.size(); ++row) {
        const RayLayer& layer = plan.layers[row];
        std::vector<float> regions;
        if (layer.lookup == RayLookup::Plane)
            regions = mostOpaque(*drawnChannel(scene, info, plan.fields[std::size_t(layer.field)]).function);
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
        const glm::vec4* row = &tables[(std::size_t(plan.rows) + layer) * kTableSize];
        const auto opaque = [](const glm::vec4& entry) { return entry.a > 0; };
        const glm::vec4* begin = std::find_if(row, row + kTableSize, opaque);
        const glm::vec4* end = std::find_if_not(begin, row + kTableSize, opaque);
        if (std::any_of(end, row + kTableSize, opaque)) {
            out.emplace_back();
            continue;
        }
        // Entry i covers the interval from i to i + 1.
        const auto place = [&](const glm::vec4* entry) { return float(entry - row) / (kTableSize - 1); };
        out.emplace_back(glm::vec2(begin == row ? -kAny : place(begin), end == row + kTableSize ? kAny : place(end)));
    }
    return out;
}

namespace {

/// Whether a layer shows nothing of the context.
bool hidesContext(const RayLayer& layer, const Selection& selection) {
    return layer.brushes == BrushEffect::FocusOnly ||
           (layer.brushes == BrushEffect::Fade && selection.contextOpacity <= 0);
}

/// 1 for each block that lies entirely in the context; empty: unknown, or no layer needs it.
std::vector<std::uint8_t> outOfFocus(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info,
                                     const BlockRanges& grid) {
    const auto asks = [&](const RayLayer& layer) { return hidesContext(layer, scene.selection); };
    if (!scene.selection.active() || std::ranges::none_of(plan.layers, asks)) return {};
    // Outside such lenses nothing counts as context.
    if (std::ranges::any_of(scene.lenses, [](const Lens& lens) { return lens.effect == LensEffect::Focus; })) return {};
    const std::vector<volume::Channel> channels = info.channels();
    std::vector<const BoundField*> fields;
    for (const int index : plan.brushFields) {
        const BoundField& field = plan.fields[std::size_t(index)];
        if (field.blocks && field.blocks->count == grid.count) fields.push_back(&field);
    }
    // Computing bounds is slow, so groups of blocks share them.
    std::vector<std::uint8_t> out(grid.min.size());
    const int edge = grid.edge <= kBlockTexels ? kFocusGroup : 1;
    const glm::ivec3 groups = (grid.count + edge - 1) / edge;
    parallelFor(std::size_t(groups.x) * std::size_t(groups.y) * std::size_t(groups.z), [&](std::size_t group) {
        const glm::ivec3 begin = edge * glm::ivec3(int(group % std::size_t(groups.x)),
                                                   int(group / std::size_t(groups.x) % std::size_t(groups.y)),
                                                   int(group / std::size_t(groups.x) / std::size_t(groups.y)));
        const glm::ivec3 end = glm::min(begin + edge, grid.count);
        const auto each = [&](const auto& visit) {
            for (int z = begin.z; z < end.z; ++z)
                for (int y = begin.y; y < end.y; ++y)
                    for (int x = begin.x; x < end.x; ++x)
                        visit((std::size_t(z) * std::size_t(grid.count.y) + std::size_t(y)) *
                                  std::size_t(grid.count.x) +
                              std::size_t(x));
        };
        std::map<std::string, Range> ranges;
        for (const BoundField* field : fields) {
            float lo = std::numeric_limits<float>::infinity(), hi = -lo;
            each([&](std::size_t block) {
                lo = std::min(lo, field->blocks->min[block]);
                hi = std::max(hi, field->blocks->max[block]);
            });
            const double room = field->categorical ? kLabelRoom : 0;
            const TexelEncoding& encoding = field->encoding;
            ranges[channels[std::size_t(field->channel)].name] = {
                encoding.offset + encoding.scale * double(lo - kTexelSlack) - room,
                encoding.offset + encoding.scale * double(hi + kTexelSlack) + room};
        }
        const std::uint8_t hidden = interestBounds(scene.selection, ranges).hi == 0 ? 1 : 0;
        each([&](std::size_t block) { out[block] = hidden; });
    });
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
            const TransferFunction& function = *drawnChannel(scene, info, field).function;
            if (use.lookup == RayLookup::Plane) opacity = mostOpaque(function);
            for (int i = 0; use.lookup != RayLookup::Plane && i < kTableSize; ++i)
                opacity.push_back(float(evaluate(function, {0, 1}, double(i) / (kTableSize - 1)).a));
        }
        const OpacityRanges opaque(opacity, map);
        parallelRanges(
            total,
            [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                    if (!(blocks.min[i] <= blocks.max[i])) continue;
                    const float lo = blocks.min[i] - kTexelSlack, hi = blocks.max[i] + kTexelSlack;
                    bool shows = true;
                    if (use.style == RayStyle::Iso) shows = lo <= value && value <= hi;
                    // The gradient depends on samples outside the block.
                    if (use.style == RayStyle::Composite && !use.gradient) shows = opaque.any(lo, hi);
                    // Projections take context samples into account.
                    if (use.style == RayStyle::Composite || use.style == RayStyle::Iso)
                        shows = shows && (hidden.empty() || hidden[i] == 0 || !hidesContext(use, scene.selection));
                    if (shows) out.distance[i] = 0;
                }
            },
            4096);
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
    spreadDistance(out.distance, out.count);
    return out;
}

} // namespace tessera::vis
