#include "vis/glyphs/make_glyphs.h"

#include "vis/glyphs/glyph_parts.h"
#include "vis/glyphs/glyph_shapes.h"
#include "vis/optics/ray_setup.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace tessera::vis {

namespace {

constexpr double kOfNoInterest = 0.35; ///< size of a glyph of no interest, of those of full interest
constexpr double kLeastOpacity = 0.1;

/// Sides of what is round: fewer where many glyphs are small.
int sidesFor(std::size_t glyphs) {
    return glyphs <= 500 ? 20 : glyphs <= 3000 ? 12 : glyphs <= 10000 ? 6 : 5;
}

/// Axes of a glyph as drawn, as columns: flat kinds lie across z with y upwards, others stand along z.
glm::dmat3 frameOf(bool flat, glm::dvec3 normal, glm::dvec3 direction) {
    const glm::dvec3 upright = std::abs(normal.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, -1);
    glm::dvec3 z = normal, up = upright;
    if (glm::dot(direction, direction) > 0) {
        if (flat)
            up = direction;
        else
            z = direction;
    }
    if (flat && glm::dot(direction, direction) > 0) { // y along the direction, faced as far as it allows
        const glm::dvec3 other = std::abs(glm::dot(up, z)) < 0.99 ? z : upright;
        const glm::dvec3 x = glm::normalize(glm::cross(up, other));
        return {x, up, glm::cross(x, up)};
    }
    if (std::abs(glm::dot(up, z)) > 0.99) up = glm::dvec3(1, 0, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(up, z));
    return {x, glm::cross(z, x), z};
}

glm::dmat3 tilted(const glm::dmat3& frame, double share) {
    const double angle = share * glm::half_pi<double>(), c = std::cos(angle), s = std::sin(angle);
    return {frame[0], frame[1] * c + frame[2] * s, frame[2] * c - frame[1] * s};
}

/// Colours of the parts of a kind, linear light; red -1: that of the glyph.
std::vector<glm::vec3> partTints(GlyphKind kind) {
    std::vector<glm::vec3> out;
    for (std::size_t i = 0; i < glyphPartNames(kind).size(); ++i) {
        const auto color = glyphPartColor(kind, i);
        out.push_back(color ? glm::vec3(linearFromSrgb(glm::dvec3(*color))) : glm::vec3(-1));
    }
    return out;
}

/// How a glyph is placed and coloured.
struct GlyphPose {
    glm::dvec3 place; ///< of the sheet, less the origin of the mesh
    glm::dmat3 frame;
    double size = 1, opacity = 1;
    float color = 0;
};

/// Adds a shape to a geometry.
void append(Geometry& to, const GlyphShape& shape, const GlyphPose& pose, glm::dvec3 stretch,
            const std::vector<glm::vec3>& tints) {
    volume::SurfaceMesh& mesh = to.mesh;
    const auto first = std::uint32_t(mesh.positions.size());
    for (std::size_t i = 0; i < shape.positions.size(); ++i) {
        const glm::dvec3 normal = shape.normals[i];
        mesh.positions.emplace_back(pose.place + pose.frame * (shape.positions[i] * pose.size) / stretch);
        // Normals transform with the inverse transpose.
        mesh.normals.emplace_back(glm::dot(normal, normal) > 0 ? glm::normalize(pose.frame * normal * stretch)
                                                               : glm::dvec3(0));
        mesh.scalars.push_back(pose.color);
        if (tints.empty()) continue;
        const int part = shape.parts[i];
        to.tints.emplace_back(part < 0 ? glm::vec3(-1) : tints[std::size_t(part)], float(pose.opacity));
    }
    for (const glm::uvec3& triangle : shape.triangles) mesh.triangles.push_back(triangle + first);
}

void append(Geometry& to, const Geometry& piece) {
    const auto first = std::uint32_t(to.mesh.positions.size());
    const auto add = [](auto& all, const auto& some) { all.insert(all.end(), some.begin(), some.end()); };
    add(to.mesh.positions, piece.mesh.positions);
    add(to.mesh.normals, piece.mesh.normals);
    add(to.mesh.scalars, piece.mesh.scalars);
    add(to.tints, piece.tints);
    for (const glm::uvec3& triangle : piece.mesh.triangles) to.mesh.triangles.push_back(triangle + first);
}

/// The length of the longest tensor of the layer's ranges.
double longestTensor(const GlyphLayer& layer, const volume::DatasetInfo& info) {
    double square = 0;
    for (std::size_t i = kCommonGlyphParts; i < glyphPartNames(layer.kind).size(); ++i)
        for (const GlyphPart& part : layer.parts) {
            if (part.part != glyphPartNames(layer.kind)[i]) continue;
            if (const auto range = glyphPartRange(part, info)) {
                const double most = std::max(std::abs(range->lo), std::abs(range->hi));
                square += most * most * (i >= kCommonGlyphParts + 3 ? 2 : 1); // off the diagonal twice
            }
            break;
        }
    return std::sqrt(square);
}

} // namespace

std::vector<double> glyphShares(const GlyphLayer& layer, std::span<const double> values,
                                const volume::DatasetInfo& info) {
    std::vector<double> shares(glyphPartNames(layer.kind).size(), kPartAtRest);
    const double longest = layer.kind == GlyphKind::Ellipsoid ? longestTensor(layer, info) : 0;
    for (std::size_t i = layer.parts.size(); i-- > 0;) { // the first of equal ones counts
        const GlyphPart& part = layer.parts[i];
        const auto index = findGlyphPart(layer.kind, part.part);
        const auto range = glyphPartRange(part, info);
        if (!index || !range) continue;
        double& share = shares[*index];
        if (layer.kind == GlyphKind::Ellipsoid && *index >= kCommonGlyphParts)
            share = longest > 0 ? values[i] / longest : values[i];
        else if (std::isnan(values[i]) || range->hi == range->lo)
            share = std::isnan(values[i]) ? values[i] : 1;
        else
            share = std::clamp((values[i] - range->lo) / (range->hi - range->lo), 0.0, 1.0);
    }
    return shares;
}

std::shared_ptr<const Geometry> makeGlyphs(const volume::BrickSource& source, const GlyphLayer& layer,
                                           const GlyphMoment& moment, const Progress& progress) {
    constexpr std::size_t kAtOnce = 256;
    const volume::DatasetInfo& info = source.info();
    const GlyphSamples samples = sampleGlyphs(source, layer, moment, progress.part(0, 0.8));
    const std::size_t count = samples.stands.size();
    const glm::dvec3 origin = volume::originFor(info.bounds);
    const int sides = sidesFor(count);
    const bool flat = isFlatGlyph(layer.kind), tensors = layer.kind == GlyphKind::Ellipsoid; // in the axes of the data
    const bool fades = std::ranges::any_of(
        layer.parts, [&](const GlyphPart& part) { return part.part == "opacity" && glyphPartRange(part, info); });
    std::vector<glm::vec3> tints = partTints(layer.kind);
    if (!fades && std::ranges::all_of(tints, [](glm::vec3 tint) { return tint.r < 0; })) tints.clear();
    std::vector<Geometry> pieces((count + kAtOnce - 1) / kAtOnce);
    parallelFor(pieces.size(), [&](std::size_t piece) {
        GlyphShape shape;
        std::vector<double> values(layer.parts.size());
        for (std::size_t i = piece * kAtOnce; i < std::min((piece + 1) * kAtOnce, count); ++i) {
            const glm::dvec3 direction = samples.directions.empty() ? glm::dvec3(0) : samples.directions[i];
            if (!samples.directions.empty() && direction == glm::dvec3(0)) continue; // it would point somewhere
            for (std::size_t p = 0; p < values.size(); ++p) values[p] = samples.values[p][i];
            const std::vector<double> shares = glyphShares(layer, values, info);
            makeGlyphShape(layer.kind, shares, sides, shape);
            const auto common = [&](CommonGlyphPart part, double rest, double least) {
                return shares[part] == kPartAtRest ? rest : least + (1 - least) * shares[part];
            };
            const double interest = samples.interest.empty() ? 1 : samples.interest[i];
            const GlyphStand& stand = samples.stands[i];
            const glm::dvec3 normal = stand.normal == glm::dvec3(0) ? samples.facing : stand.normal;
            const GlyphPose pose{.place = stand.place - origin,
                                 .frame = tensors ? glm::dmat3(1)
                                                  : tilted(frameOf(flat, normal, direction), common(kTiltPart, 0, 0)),
                                 .size = samples.size * common(kSizePart, 1, kLeastPart) *
                                         (kOfNoInterest + (1 - kOfNoInterest) * interest),
                                 .opacity = common(kOpacityPart, 1, kLeastOpacity),
                                 .color = samples.colors[i]};
            append(pieces[piece], shape, pose, moment.stretch, tints);
        }
    });
    auto out = std::make_shared<Geometry>();
    for (const Geometry& piece : pieces) append(*out, piece);
    out->mesh.origin = out->lines.origin = origin;
    out->translucent = fades;
    progress.advance(1);
    return out;
}

} // namespace tessera::vis
