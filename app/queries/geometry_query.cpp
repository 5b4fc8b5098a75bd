#include "app/queries/geometry_query.h"

#include "app/pane/view_parts.h"
#include "vis/glyphs/glyph_parts.h"
#include "vis/glyphs/make_glyphs.h"
#include "vis/lic/surface_strokes.h"
#include "vis/optics/ray_setup.h"
#include "vis/shapes/flow_geometry.h"
#include "volume/bricks/brick_cache.h"
#include "volume/bricks/source_at_time.h"
#include "volume/flow/flow_channels.h"
#include "volume/mesh/isosurface.h"
#include "volume/mesh/region_surface.h"
#include "volume/sources/sheet_source.h"

#include <cmath>
#include <limits>
#include <optional>

namespace tessera::app {

namespace {

constexpr std::size_t kMovingTriangles = 400'000; ///< more are slow on software GL
constexpr double kCoarseSamples = 5e5;            ///< of the first level: extracted within a few milliseconds
constexpr std::size_t kStrokeVertices = 600'000;  ///< of a surface with strokes at rest
constexpr std::size_t kStrokeBricks = std::size_t(128) << 20; ///< bytes of decoded bricks

/// Colour of a surface of strokes alone, as that of slices (vis/formulas/colors.h).
const glm::vec3 kStrokesGround(float(vis::srgbFromLinear(vis::kStrokeGrey)));

using SharedGeometry = std::shared_ptr<const vis::Geometry>;
using SharedSource = std::shared_ptr<const volume::BrickSource>;

/// Nothing where the data has no such parameter.
std::optional<SurfaceQuery> surfaceQuery(const vis::IsoLayer& layer, const volume::DatasetInfo& info,
                                         const volume::TimePair& time) {
    const std::optional<int> channel = info.findChannel(layer.channel);
    if (!channel) return std::nullopt;
    SurfaceQuery query{*channel, -1, time, layer.value};
    if (!layer.colorBy.empty()) query.colorBy = info.findChannel(layer.colorBy).value_or(-1);
    query.spaceTime = layer.method == vis::SurfaceMethod::SpaceTime && !info.plane && info.times.size() > 1 &&
                      !volume::parameterOf(info, *channel).categorical;
    return query;
}

/// The same of data that may be a plane in space and time, whose surfaces are cut from those of the data it is of.
std::optional<SurfaceQuery> surfaceQuery(const vis::IsoLayer& layer, const volume::DatasetInfo& info,
                                         const volume::TimePair& time, const SharedSource& space) {
    std::optional<SurfaceQuery> query = surfaceQuery(layer, info, time);
    if (!query) return query;
    if (layer.method != vis::SurfaceMethod::SpaceTime || !info.plane || !space) return query;
    const std::optional<int> channel = space->info().findChannel(layer.channel);
    if (!channel || volume::parameterOf(space->info(), *channel).categorical) return query;
    query->spaceTime = true;
    query->space = space;
    query->spaceChannel = *channel;
    return query;
}

/// As above, with strokes.
std::optional<SurfaceQuery> drawnSurfaceQuery(const vis::IsoLayer& layer, const Session& session,
                                              const volume::DatasetInfo& info, const volume::TimePair& time,
                                              const SharedSource& space) {
    std::optional<SurfaceQuery> query = surfaceQuery(layer, info, time, space);
    if (!query || layer.strokes.vector.empty() || info.timeAxis()) return query; // lengths and times have no direction
    query->strokes = layer.strokes;
    query->strokes.strength = 1; // how they are drawn
    query->strokes.grey = false;
    query->stretch = session.stretch;
    return query;
}

FlowQuery flowQuery(const vis::FlowLayer& layer, const Session& session, const volume::DatasetInfo& info,
                    const volume::TimePair& time) {
    FlowQuery query{layer, time, session.stretch};
    // Paths cover all times; the time shown only decides which particles start.
    if (layer.kind == vis::FlowKind::Pathlines) query.time = {query.time.nearest(), query.time.nearest(), 0};
    query.layer.style = {}; // does not change the geometry
    if ((layer.seedBrushed || layer.contextWidth < 1) && session.selection.active()) {
        query.brushes.brushes = session.selection.brushes;
        query.lenses = brushSpace(session, info);
    }
    if (!session.selection.active()) query.layer.contextWidth = 1; // there is no context
    return query;
}

GlyphQuery glyphQuery(const vis::GlyphLayer& glyphs, vis::BrushEffect effect, const Session& session,
                      const volume::DatasetInfo& info, const volume::TimePair& time) {
    GlyphQuery query{glyphs, time, session.stretch};
    query.layer.style = {}; // does not change the geometry
    if (glyphs.place == vis::GlyphPlace::Cursor) query.cursor = session.cursor;
    if ((glyphs.seedBrushed || effect != vis::BrushEffect::None) && session.selection.active()) {
        query.brushes.brushes = session.selection.brushes;
        query.lenses = brushSpace(session, info);
    }
    return query;
}

/// Nothing for layers that are drawn otherwise.
std::optional<GeometryQuery> queryOf(const vis::Layer& layer, const Session& session, const volume::DatasetInfo& info,
                                     const SharedSource& space) {
    const vis::Technique& technique = layer.technique;
    const volume::TimePair time = volume::timesAround(info.times, session.time + layer.timeShift);
    if (const auto* flow = std::get_if<vis::FlowLayer>(&technique)) {
        if (info.timeAxis()) return std::nullopt; // vectors have no direction between lengths and times
        return flowQuery(*flow, session, info, time);
    }
    if (const auto* glyphs = std::get_if<vis::GlyphLayer>(&technique))
        return glyphQuery(*glyphs, layer.brushes, session, info, time);
    const auto* iso = std::get_if<vis::IsoLayer>(&technique);
    if (!iso || !iso->meshed()) return std::nullopt;
    return drawnSurfaceQuery(*iso, session, info, time, space);
}

/// The level of detail that a surface in space and time is made of where that of `level` is wanted.
int levelInTime(const SurfaceQuery& query, const volume::BrickSource& source, int level) {
    const volume::BrickSource& from = query.space ? *query.space : source;
    const int times = query.space ? int(from.info().times.size()) : 2;
    return std::min(std::max(level, volume::levelOfSpaceTime(from.grid(), times)), from.grid().levels - 1);
}

/// Where a surface is made: on the sheet of the axes, where it is drawn, or in space.
enum class Surroundings { Sheet, Space };

volume::SurfaceMesh meshOf(const SurfaceQuery& query, const SharedSource& source, Surroundings in,
                           volume::SpaceTimeSurfaces& inTime, int level, const Progress& progress) {
    const volume::AxisMaps axes = in == Surroundings::Sheet ? source->info().lattice.axes : volume::AxisMaps{};
    if (query.space)
        return inTime.inPlane(query.space, query.spaceChannel, query.value, *source->info().plane, axes,
                              levelInTime(query, *source, level), progress);
    if (query.spaceTime)
        return inTime.atTime(source, query.channel, query.value, query.time, axes, levelInTime(query, *source, level),
                             progress);
    const volume::SourceAtTime shown =
        volume::sourceAt(in == Surroundings::Sheet ? volume::sheetSource(source) : source, query.time);
    return volume::parameterOf(source->info(), query.channel).categorical
               ? volume::extractRegionSurface(*shown.source, query.channel, shown.time, int(std::lround(query.value)),
                                              level, progress)
               : volume::extractIsosurface(*shown.source, query.channel, shown.time, query.value, level, progress);
}

/// The surface at a level of detail, with the values of its colouring parameter at the vertices.
std::shared_ptr<vis::Geometry> make(const SurfaceQuery& query, const SharedSource& source, Surroundings in,
                                    volume::SpaceTimeSurfaces& inTime, int level, const Progress& progress) {
    auto geometry = std::make_shared<vis::Geometry>();
    const double share = query.colorBy < 0 ? 1 : 0.6;
    geometry->mesh = meshOf(query, source, in, inTime, level, progress.part(0, share));
    if (const int finest = query.spaceTime ? levelInTime(query, *source, 0) : 0; finest > 0)
        geometry->notes.push_back(vis::coarserText("surface in space and time", finest));
    if (query.colorBy < 0) return geometry;
    const volume::SourceAtTime shown =
        volume::sourceAt(in == Surroundings::Sheet ? volume::sheetSource(source) : source, query.time);
    volume::sampleAtVertices(geometry->mesh, *shown.source, query.colorBy, shown.time, level, progress.part(share, 1));
    return geometry;
}

/// The same as it is drawn. `level`: set to the finest where that surface in space and time is there already.
SharedGeometry makeDrawn(const SurfaceQuery& query, const SharedSource& source, volume::SpaceTimeSurfaces& inTime,
                         int& level, const Progress& progress) {
    const bool strokes = !query.strokes.vector.empty();
    if (query.spaceTime && !query.space && !strokes &&
        inTime.keeps(source, query.channel, query.value, query.time, levelInTime(query, *source, 0)))
        level = 0;
    // Where strokes are what takes long they alone are coarse at first.
    const bool small = source->grid().levelWithin(kCoarseSamples) == 0;
    auto geometry = make(query, source, Surroundings::Sheet, inTime, strokes && small ? 0 : level,
                         progress.part(0, strokes ? 0.3 : 1));
    if (strokes) {
        const volume::SourceAtTime shown = volume::sourceAt(source, query.time);
        const volume::BrickCache cache(shown.source, kStrokeBricks);
        vis::addStrokes(*geometry, cache, shown.time, query.strokes, query.stretch,
                        level > 0 ? kMovingTriangles / 4 : kStrokeVertices, progress.part(0.3, 1));
    }
    return geometry;
}

/// Null where there is nothing to show.
SharedGeometry makeDrawn(const FlowQuery& query, const SharedSource& source, volume::SpaceTimeSurfaces&, int&,
                         const Progress& progress) {
    const vis::DoiFunction interest(query.brushes, query.lenses);
    if (vis::followsParticles(query.layer.kind))
        return vis::makeParticles(*source, query.layer, volume::timeAt(source->info().times, query.time), query.stretch,
                                  progress, &interest);
    const volume::SourceAtTime shown = volume::sourceAt(source, query.time);
    return vis::makeFlow(*shown.source, query.layer, shown.time, query.stretch, progress, &interest);
}

SharedGeometry makeDrawn(const GlyphQuery& query, const SharedSource& source, volume::SpaceTimeSurfaces&, int&,
                         const Progress& progress) {
    const volume::SourceAtTime shown = volume::sourceAt(source, query.time);
    const vis::DoiFunction interest(query.brushes, query.lenses);
    const vis::GlyphMoment moment{shown.time, query.stretch, query.cursor,
                                  query.brushes.brushes.empty() ? nullptr : &interest};
    return vis::makeGlyphs(*shown.source, query.layer, moment, progress);
}

/// How the answer to a query is drawn: as the layer says now, coloured by what it was made for.
vis::GeometryLayer drawnAs(const vis::Layer& layer, const GeometryQuery& made) {
    vis::GeometryLayer drawn;
    drawn.lens = layer.lens;
    drawn.transfer = layer.transfer;
    drawn.brushes = layer.brushes;
    if (const auto* iso = std::get_if<vis::IsoLayer>(&layer.technique)) {
        const auto* surface = std::get_if<SurfaceQuery>(&made);
        const bool grey = iso->strokes.grey && surface && !surface->strokes.vector.empty();
        drawn.style = {.color = grey ? kStrokesGround : iso->color,
                       .opacity = iso->opacity,
                       .strokes = iso->strokes.strength,
                       .cutByBox = true,
                       .look = iso->look};
        if (surface && surface->colorBy >= 0 && !grey) drawn.channel = iso->colorBy;
    }
    if (const auto* flow = std::get_if<vis::FlowLayer>(&layer.technique)) {
        drawn.style = flow->style;
        if (const auto* lines = std::get_if<FlowQuery>(&made)) drawn.channel = lines->layer.channel;
    }
    if (const auto* glyphs = std::get_if<vis::GlyphLayer>(&layer.technique)) {
        drawn.style = glyphs->style;
        if (const auto* figures = std::get_if<GlyphQuery>(&made)) drawn.channel = glyphColorChannel(figures->layer);
    }
    return drawn;
}

AsyncOptions optionsFor(const vis::Layer& layer, const std::string& place, const volume::BrickSource& source) {
    const bool glyphs = std::holds_alternative<vis::GlyphLayer>(layer.technique);
    AsyncOptions options{
        .key = place, .title = (glyphs ? "Glyphs of " : "Flow of ") + shownChannel(layer.technique), .quiet = true};
    options.duringEdits = true;
    if (!std::holds_alternative<vis::IsoLayer>(layer.technique)) return options;
    options.title = "Surface of " + shownChannel(layer.technique);
    options.firstLevel = source.grid().levelWithin(kCoarseSamples);
    const bool strokes = !std::get<vis::IsoLayer>(layer.technique).strokes.vector.empty();
    if (strokes && options.firstLevel == 0 && source.grid().levels > 1) options.firstLevel = 1;
    options.quiet = options.firstLevel == 0;
    return options;
}

} // namespace

std::shared_ptr<const vis::Geometry> extractLayer(const std::shared_ptr<const volume::BrickSource>& source,
                                                  const vis::IsoLayer& layer, const volume::TimePair& time, int level,
                                                  const Progress& progress,
                                                  const std::shared_ptr<const volume::BrickSource>& space) {
    const std::optional<SurfaceQuery> query = surfaceQuery(layer, source->info(), time, space);
    volume::SpaceTimeSurfaces inTime;
    return query ? make(*query, source, Surroundings::Space, inTime, level, progress) : nullptr;
}

AsyncGeometry::Query::Keep AsyncGeometry::keep() {
    // About 1 GB with the copies on the GPU: a vertex with its two triangles has 100 bytes.
    constexpr std::size_t kVertices = 10'000'000;
    return {.answers = std::numeric_limits<std::size_t>::max(),
            .size = kVertices,
            .sizeOf =
                [](const SharedGeometry& geometry) {
                    constexpr std::size_t kLeast = 10'000; // so that small ones are not kept without end
                    return kLeast + (geometry ? geometry->mesh.positions.size() + geometry->lines.positions.size() : 0);
                },
            .coarse = true};
}

std::vector<vis::GeometryLayer> AsyncGeometry::get(ViewContext& context, const std::string& pane, bool moving) {
    std::vector<vis::GeometryLayer> out;
    for (std::size_t i = 0; i < context.session.layers.size(); ++i) {
        const vis::Layer& layer = context.session.layers[i];
        if (!layer.visible) continue;
        const auto query = queryOf(layer, context.session, context.source->info(), context.origin.spaceOfPlane);
        if (!query) continue;
        auto made = query_.answer(
            context, context.source, optionsFor(layer, pane + ":geometry" + std::to_string(i), *context.source), *query,
            [inTime = inTime_](const SharedSource& source, const GeometryQuery& asked, int& level,
                               const Progress& progress) {
                return std::visit([&](const auto& of) { return makeDrawn(of, source, *inTime, level, progress); },
                                  asked);
            },
            [](const GeometryQuery& former, const GeometryQuery& asked) { return former.index() == asked.index(); });
        if (!made || !made->result || (!query_.failure().empty() && !(made->query == *query))) continue;
        if (moving && made->result->mesh.triangles.size() > kMovingTriangles)
            if (const auto coarse = query_.coarsest(made->query)) made = coarse;
        vis::GeometryLayer& drawn = out.emplace_back(drawnAs(layer, made->query));
        drawn.geometry = made->result;
    }
    return out;
}

} // namespace tessera::app
