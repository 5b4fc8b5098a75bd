#include "vis/shapes/flow_geometry.h"

#include "vis/shapes/flow_data.h"
#include "vis/shapes/line_gatherer.h"
#include "volume/flow/paths.h"
#include "volume/mesh/surface_mesh.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tessera::vis {

namespace {

using Width = std::function<double(glm::dvec3 place)>;

/// A direction in space as it is drawn at a place: by how much longer or shorter a length is on the sheet there.
glm::dvec3 drawnDirection(const volume::Lattice& lattice, glm::dvec3 place, glm::dvec3 direction) {
    return direction * (glm::abs(lattice.spacing) / lattice.lengthsAt(place));
}

double longestDrawn(const volume::BrickSource& source, glm::dvec3 stretch) {
    const glm::dvec3 drawn = source.info().bounds.size() * stretch;
    return std::max({drawn.x, drawn.y, drawn.z});
}

std::shared_ptr<Geometry> linesAlong(const volume::BrickSource& source, const FlowLayer& layer, const FlowData& data,
                                     const FlowSeeds& seeds, double moment, glm::dvec3 stretch, const Width& width,
                                     const Progress& progress) {
    LineGatherer gatherer(source);
    const auto lines =
        layer.seeds == volume::SeedShape::Even
            ? seeds.lines
            : volume::streamlines(data.field, seeds.places, streamlinesOf(source, data, layer), progress.part(0, 0.6));
    for (const auto& line : lines) {
        for (const glm::dvec3& place : line) gatherer.add(place, moment);
        gatherer.endLine();
    }
    LineSet drawn = gatherer.finish(layer.channel, data.level, progress.part(0.6, 1));
    const double radius = double(layer.radius) * longestDrawn(source, stretch);
    auto out = std::make_shared<Geometry>();
    Width onSheet;
    if (width)
        onSheet = [&, origin = drawn.origin](glm::dvec3 place) {
            return width(source.info().lattice.axes.toSpace(place + origin));
        };
    if (layer.kind == FlowKind::Tubes)
        out->mesh = tubes(drawn, radius, stretch, onSheet);
    else if (layer.kind == FlowKind::BentArrows)
        out->mesh = bentArrows(drawn, radius, layer.flat, stretch);
    else
        out->lines = std::move(drawn);
    return out;
}

/// What the glyphs of a layer have in common.
struct GlyphWork {
    const volume::BrickSource& source;
    const FlowLayer& layer;
    const FlowData& data;
    glm::dvec3 stretch;
    const Width& width;
    double greatest = 0; ///< vector of those drawn, which gets the wanted length

    volume::SurfaceMesh meshOf(const std::vector<Glyph>& glyphs) const {
        return layer.kind == FlowKind::Arrows ? arrows(glyphs, stretch) : cones(glyphs, stretch);
    }
    Glyph glyph(glm::dvec3 place, glm::dvec3 vector, float scalar) const {
        const volume::Lattice& lattice = source.info().lattice;
        const double share = (layer.scaled ? glm::length(vector) / greatest : 1) * (width ? width(place) : 1);
        const glm::dvec3 drawnWay = glm::normalize(drawnDirection(lattice, place, vector) * stretch);
        return {lattice.axes.toSheet(place) - volume::originFor(source.info().bounds),
                drawnWay * (share * double(layer.size) * longestDrawn(source, stretch)), scalar};
    }
};

/// Adds copies where the glyphs' particles were before in the flow of this time, fainter the earlier.
void addBlur(Geometry& geometry, const GlyphWork& work, const std::vector<glm::dvec3>& seeds,
             const std::vector<float>& scalars) {
    const glm::dvec3 size = work.source.info().bounds.size();
    const double whole = double(work.layer.size) * std::max({size.x, size.y, size.z}) / work.greatest;
    const volume::ChangingField same = [&](glm::dvec3 place, double) { return work.data.field(place); };
    volume::PathSettings settings;
    settings.lattice = work.data.lattice;
    geometry.tints.assign(geometry.mesh.positions.size(), glm::vec4(-1, 0, 0, 1));
    geometry.translucent = true;
    for (int copy = 1; copy <= work.layer.blur; ++copy) {
        const double share = double(copy) / work.layer.blur;
        std::vector<Glyph> glyphs;
        for (std::size_t i = 0; i < seeds.size(); ++i) {
            const auto place = volume::carried(same, seeds[i], 0, -whole * share, settings);
            const auto vector = place ? work.data.field(*place) : std::nullopt;
            if (vector && glm::length(*vector) > work.data.slowest)
                glyphs.push_back(work.glyph(*place, *vector, scalars[i]));
        }
        appendMesh(geometry.mesh, work.meshOf(glyphs));
        geometry.tints.resize(geometry.mesh.positions.size(), glm::vec4(-1, 0, 0, 0.5 * (1.1 - share)));
    }
}

std::shared_ptr<Geometry> glyphsAt(const volume::BrickSource& source, const FlowLayer& layer, const FlowData& data,
                                   const std::vector<glm::dvec3>& seeds, double moment, glm::dvec3 stretch,
                                   const Width& width, const Progress& progress) {
    const glm::dvec3 origin = volume::originFor(source.info().bounds);
    auto out = std::make_shared<Geometry>();
    std::vector<glm::vec3> places;
    for (const glm::dvec3& seed : seeds) places.emplace_back(seed - origin);
    const std::vector<float> scalars =
        valuesOver(source, layer.channel, data.level, places, std::vector<double>(places.size(), moment), progress);
    GlyphWork work{source, layer, data, stretch, width};
    for (const glm::dvec3& seed : seeds) work.greatest = std::max(work.greatest, glm::length(*data.field(seed)));
    std::vector<Glyph> glyphs; // no vector is zero: seeds lie where it flows
    for (std::size_t i = 0; i < seeds.size(); ++i)
        glyphs.push_back(work.glyph(seeds[i], *data.field(seeds[i]), scalars[i]));
    if (layer.kind != FlowKind::Hedgehogs) {
        out->mesh = work.meshOf(glyphs);
        if (layer.blur > 0 && !glyphs.empty()) addBlur(*out, work, seeds, scalars);
    }
    out->mesh.origin = out->lines.origin = origin;
    if (layer.kind == FlowKind::Hedgehogs)
        for (const Glyph& glyph : glyphs) {
            for (const glm::dvec3 end : {glyph.place, glyph.place + glyph.vector / stretch})
                out->lines.positions.emplace_back(end);
            out->lines.scalars.insert(out->lines.scalars.end(), 2, glyph.scalar);
            out->lines.ends.push_back(std::uint32_t(out->lines.positions.size()));
        }
    return out;
}

} // namespace

std::vector<glm::dvec3> flowSeeds(const volume::BrickSource& source, const FlowLayer& layer, int time,
                                  glm::dvec3 stretch, const Progress& progress, const DoiFunction* interest) {
    const double moment = source.info().times[std::size_t(time)];
    const std::optional<FlowData> data = readFlow(source, layer, moment, progress.part(0, 0.7));
    if (!data) return {};
    return seedsOf(source, *data, layer, moment, stretch, progress.part(0.7, 1), interest).places;
}

std::shared_ptr<const Geometry> makeFlow(const volume::BrickSource& source, const FlowLayer& layer, int time,
                                         glm::dvec3 stretch, const Progress& progress, const DoiFunction* interest) {
    const double moment = source.info().times[std::size_t(time)];
    if (followsParticles(layer.kind)) return makeParticles(source, layer, moment, stretch, progress, interest);
    const std::optional<FlowData> data = readFlow(source, layer, moment, progress.part(0, 0.3));
    if (!data) return nullptr;
    const FlowSeeds seeds = seedsOf(source, *data, layer, moment, stretch, progress.part(0.3, 0.4), interest);
    const Width width = widthsOf(source, *data, layer, moment, interest, progress.part(0.4, 0.5));
    auto out = followsFlow(layer.kind)
                   ? linesAlong(source, layer, *data, seeds, moment, stretch, width, progress.part(0.5, 1))
                   : glyphsAt(source, layer, *data, seeds.places, moment, stretch, width, progress.part(0.5, 1));
    out->notes = flowNotes(source.info(), layer, *data);
    return out;
}

} // namespace tessera::vis
