#include "app/pane/glyph_legend.h"

#include "app/described/key_words.h"
#include "app/pane/plot.h"
#include "app/ui/fitted_text.h"
#include "app/ui/ticks.h"
#include "app/ui/widgets.h"
#include "vis/glyphs/glyph_parts.h"
#include "vis/glyphs/glyph_shapes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace tessera::app {

namespace {

constexpr float kPartLine = 1.2f, kGlyphPicture = 5.2f; // em

/// A position of a glyph as its picture shows it: x to the right, y upwards, z to the viewer.
glm::dvec3 legendView(glm::dvec3 at, bool flat) {
    constexpr double kTurn = 0.5, kLean = 0.4; // radians
    if (flat) return {at.x, at.y * std::cos(0.25) + at.z * std::sin(0.25), at.z * std::cos(0.25)};
    const double x = at.x * std::cos(kTurn) - at.y * std::sin(kTurn),
                 y = at.x * std::sin(kTurn) + at.y * std::cos(kTurn);
    return {x, at.z * std::cos(kLean) + y * std::sin(kLean), at.z * std::sin(kLean) - y * std::cos(kLean)};
}

/// Shares of the parts: of the values where there is one, else all at their most.
std::vector<double> sharesOf(const GlyphLegend& legend) {
    std::vector<double> shares(vis::glyphPartNames(legend.kind).size(), vis::kPartAtRest);
    const bool tensor = legend.kind == vis::GlyphKind::Ellipsoid;
    for (const GlyphLegend::Part& part : legend.parts) {
        const auto index = vis::findGlyphPart(legend.kind, part.part);
        if (!index || tensor || *index < vis::kCommonGlyphParts) continue;
        const double width = part.range.hi - part.range.lo;
        double& share = shares[*index];
        if (!legend.atCursor)
            share = 1;
        else if (!part.value)
            share = std::numeric_limits<double>::quiet_NaN();
        else
            share = width == 0 ? 1 : std::clamp((*part.value - part.range.lo) / width, 0.0, 1.0);
    }
    return shares;
}

std::string partRangeText(const GlyphLegend::Part& part) {
    const double resolution = std::abs(part.range.hi - part.range.lo) / 30;
    return formatNumber(part.range.lo, resolution) + " to " + formatQuantity(part.range.hi, part.unit, resolution);
}

} // namespace

std::string glyphKindTitle(vis::GlyphKind kind) {
    return labelOf(vis::kGlyphKindNames[static_cast<std::size_t>(kind)]) + " glyphs";
}

GlyphLegend glyphLegendOf(const vis::GlyphLayer& layer, const volume::DatasetInfo& info) {
    GlyphLegend legend{.kind = layer.kind, .parts = {}};
    for (std::size_t i = 0; i < vis::glyphPartNames(layer.kind).size(); ++i) {
        if (i == vis::kColorPart) continue; // has the legend of its transfer function
        const std::string_view name = vis::glyphPartNames(layer.kind)[i];
        const auto part = std::ranges::find(layer.parts, name, &vis::GlyphPart::part);
        if (part == layer.parts.end()) continue;
        const auto range = vis::glyphPartRange(*part, info);
        if (!range) continue;
        const volume::Channel channel = info.channel(*info.findChannel(part->channel));
        GlyphLegend::Part shown{.part = part->part, .channel = channel.name, .unit = channel.unit, .range = *range};
        if (const auto color = vis::glyphPartColor(layer.kind, i)) shown.color = {color->r, color->g, color->b};
        legend.parts.push_back(std::move(shown));
    }
    return legend;
}

void drawGlyphPicture(ImDrawList& draw, ImVec2 middle, float size, vis::GlyphKind kind,
                      const std::vector<double>& shares) {
    vis::GlyphShape shape;
    vis::makeGlyphShape(kind, shares, 20, shape);
    struct Facet {
        double depth;
        std::array<glm::dvec3, 3> at;
        int part;
    };
    std::vector<Facet> faces;
    const bool flat = vis::isFlatGlyph(kind);
    for (const glm::uvec3& triangle : shape.triangles) {
        Facet face{0, {}, shape.parts[triangle.z]};
        for (int i = 0; i < 3; ++i) {
            face.at[static_cast<std::size_t>(i)] = legendView(shape.positions[triangle[i]], flat);
            face.depth += face.at[static_cast<std::size_t>(i)].z;
        }
        faces.push_back(face);
    }
    std::ranges::stable_sort(faces, {}, &Facet::depth);
    const glm::dvec3 light = glm::normalize(glm::dvec3(-0.4, 0.6, 0.8));
    const ImDrawListFlags before = draw.Flags;
    draw.Flags &= ~ImDrawListFlags_AntiAliasedFill; // else seams are seen between the triangles
    for (const Facet& face : faces) {
        const glm::dvec3 normal = glm::cross(face.at[1] - face.at[0], face.at[2] - face.at[0]);
        if (!(glm::length(normal) > 0)) continue;
        const double lit = 0.55 + 0.45 * std::abs(glm::dot(glm::normalize(normal), light));
        const auto own = face.part < 0 ? std::nullopt : vis::glyphPartColor(kind, static_cast<std::size_t>(face.part));
        const glm::dvec3 color = glm::dvec3(own.value_or(glm::vec3(0.62f))) * lit;
        const auto pixel = [&](int i) {
            const glm::dvec3& at = face.at[static_cast<std::size_t>(i)];
            return ImVec2{middle.x + static_cast<float>(at.x) * size, middle.y - static_cast<float>(at.y) * size};
        };
        draw.AddTriangleFilled(pixel(0), pixel(1), pixel(2), toColor({color.r, color.g, color.b}));
    }
    draw.Flags = before;
}

float glyphLegendHeight(const GlyphLegend& legend) {
    const float lines = kPartLine * static_cast<float>(legend.parts.size());
    return em() * (kPartLine + std::max(lines, kGlyphPicture) + 0.3f);
}

float drawGlyphLegend(ImDrawList& draw, ImVec2 min, float width, const std::string& title, const GlyphLegend& legend) {
    const PlotColors colors = plotColors();
    addFittedText(draw, min, colors.text, title, width);
    const float height = glyphLegendHeight(legend), picture = std::min(em() * kGlyphPicture, width * 0.4f);
    const float top = min.y + em() * kPartLine;
    drawGlyphPicture(draw, {min.x + picture / 2, top + (height - em() * (kPartLine + 0.3f)) / 2}, picture, legend.kind,
                     sharesOf(legend));
    const float left = min.x + picture + em() * 0.4f, right = min.x + width;
    float y = top;
    for (const GlyphLegend::Part& part : legend.parts) {
        float x = left;
        if (part.color) {
            draw.AddRectFilled({x, y + em() * 0.2f}, {x + em() * 0.7f, y + em() * 0.9f}, toColor(*part.color));
            x += em();
        }
        const std::string name = part.color ? part.channel : part.part + ": " + part.channel;
        const double resolution = std::abs(part.range.hi - part.range.lo) / 300;
        std::string least = name + "  " + partRangeText(part), whole = least;
        if (legend.atCursor) {
            least = name + "  " + (part.value ? formatQuantity(*part.value, part.unit, resolution) : "absent");
            whole = least + " (" + partRangeText(part) + ")";
        }
        const std::string fitted = firstThatFits({whole, least}, right - x);
        const std::string shown = fitted.empty() ? fitText(least, right - x) : fitted;
        draw.AddText({x, y}, colors.text, shown.c_str());
        tellWhole({x, y}, {right, y + em()}, whole, shown);
        y += em() * kPartLine;
    }
    return height;
}

} // namespace tessera::app
