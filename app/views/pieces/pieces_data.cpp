#include "app/views/pieces/pieces_data.h"

#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "app/values/place_text.h"
#include "app/values/selection_text.h"
#include "app/views/pieces/piece_lanes.h"
#include "volume/base/error.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tessera::app {

namespace {

using volume::Piece;
using volume::PieceEvent;
using volume::PieceEventKind;
using volume::PieceGraph;

constexpr double kCoarsePieces = 4e6; ///< samples of all times together, of a first answer

std::string pieceValue(const volume::DatasetInfo& info, int channel, double value) {
    if (std::isnan(value)) return "absent";
    const Range range = info.channelRange(info.channel(channel));
    return formatQuantity(value, info.channel(channel).unit, (range.hi - range.lo) / 1000);
}

/// "2 and 3", "1, 2 and 3": numbers of pieces.
std::string pieceNumbers(const PieceGraph& graph, const std::vector<int>& pieces) {
    std::string text;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const std::string last = i + 1 == pieces.size() ? " and " : ", ";
        text += (i == 0 ? "" : last) + std::to_string(graph.pieces[std::size_t(pieces[i])].track);
    }
    return text;
}

/// What happens to pieces, as their numbers.
std::string eventText(const PieceGraph& graph, const PieceEvent& event) {
    switch (event.kind) {
    case PieceEventKind::Birth:
        return "is born";
    case PieceEventKind::Death:
        return "is gone";
    case PieceEventKind::Enter:
        return "appears at the border";
    case PieceEventKind::Leave:
        return "has left at the border";
    case PieceEventKind::Merge:
        return pieceNumbers(graph, event.from) + " merge into " + pieceNumbers(graph, event.to);
    case PieceEventKind::Split:
        return pieceNumbers(graph, event.from) + " splits into " + pieceNumbers(graph, event.to);
    }
    return {};
}

bool concerns(const PieceGraph& graph, const PieceEvent& event, int track) {
    const auto isIt = [&](int piece) { return graph.pieces[std::size_t(piece)].track == track; };
    return std::ranges::any_of(event.from, isIt) || std::ranges::any_of(event.to, isIt);
}

/// The words of the events of each piece as files have them, for the piece to which they happen.
std::vector<std::string> eventsOf(const PieceGraph& graph) {
    std::vector<std::string> texts(graph.pieces.size());
    for (const PieceEvent& event : graph.events) {
        const bool first = event.kind == PieceEventKind::Birth || event.kind == PieceEventKind::Enter ||
                           event.kind == PieceEventKind::Merge;
        const std::vector<int>& of = first ? event.to : event.from;
        if (of.size() != 1) continue;
        std::string& text = texts[std::size_t(of.front())];
        text += (text.empty() ? "" : " ") + std::string(volume::kPieceEventNames[std::size_t(event.kind)]);
    }
    return texts;
}

/// Half of a step of time around a stored one: lines of pieces that are there once are as long.
double quarterStep(const std::vector<double>& times, int time) {
    if (times.size() < 2) return 0.5;
    const auto t = std::size_t(time);
    const double before = t > 0 ? times[t] - times[t - 1] : times[1] - times[0];
    const double after = t + 1 < times.size() ? times[t + 1] - times[t] : before;
    return std::min(before, after) / 4;
}

/// An end of a line between two pieces: where, and half its width there.
struct FlowEnd {
    glm::dvec2 at{0};
    double half = 0;
};

/// From one lane to another without a corner.
void addCurve(PlotFlow& flow, const FlowEnd& from, const FlowEnd& to) {
    constexpr int kParts = 16;
    for (int i = 0; i <= kParts; ++i) {
        const double s = double(i) / kParts, eased = s * s * (3 - 2 * s);
        flow.points.emplace_back(glm::mix(from.at.x, to.at.x, s), glm::mix(from.at.y, to.at.y, eased));
        flow.half.push_back(glm::mix(from.half, to.half, eased));
    }
}

/// Where a line to `other` leaves a piece, beside those to the others of `mates`, of which `other` is one: each takes
/// as much of the piece's width as its share of their volumes, in the order of their lanes.
FlowEnd endAt(const PieceGraph& graph, const std::vector<glm::dvec2>& places, std::size_t piece, double half,
              const std::vector<int>& mates, int other) {
    double above = 0, all = 0;
    for (const int mate : mates) {
        const double volume = graph.pieces[std::size_t(mate)].volume;
        const double y = places[std::size_t(mate)].y, own = places[std::size_t(other)].y;
        all += volume;
        if (y > own || (y == own && mate < other)) above += volume;
    }
    if (!(all > 0)) return {places[piece], half};
    const double share = graph.pieces[std::size_t(other)].volume / all;
    return {places[piece] + glm::dvec2(0, half * (1 - 2 * above / all - share)), half * share};
}

} // namespace

double piecesValue(const PiecesView& view, const volume::DatasetInfo& info, int channel) {
    const Range range = info.channelRange(info.channel(channel));
    return view.value.value_or(0.5 * (range.lo + range.hi));
}

PiecesQuestion piecesQuestion(const Session& session, const volume::DatasetInfo& info, const PiecesView& view,
                              int channel) {
    PiecesQuestion out;
    out.channel = channel;
    out.of = view.of;
    out.leastVolume = view.leastVolume;
    if (view.of != PiecesOf::Selected) {
        out.value = piecesValue(view, info, channel);
        return out;
    }
    out.brushes = brushedQuery(session, info, {}, {}, 1, false);
    out.brushes.time = {}; // of all times
    out.selection = selectionName(session);
    return out;
}

int firstPiecesLevel(const volume::BrickGrid& grid, std::size_t times) {
    const int coarse = grid.levelWithin(kCoarsePieces / double(std::max<std::size_t>(1, times)));
    return coarse > volume::piecesLevel(grid, times) ? coarse : 0;
}

volume::PieceGraph readPieces(const volume::BrickSource& source, const PiecesQuestion& question, int level,
                              const Progress& progress) {
    volume::PiecesQuery query;
    query.channel = question.channel;
    query.value = question.value;
    query.side = question.of == PiecesOf::Below ? volume::PieceSide::Below : volume::PieceSide::Above;
    query.leastVolume = question.leastVolume;
    query.level = level > 0 ? level : volume::piecesLevel(source.grid(), source.info().times.size());
    if (question.of == PiecesOf::Selected) {
        query.doiChannels = question.brushes.channels;
        query.doi = samplesQuery(question.brushes, source.info(), 0).doi;
    }
    return volume::findPieces(source, query, progress);
}

std::string piecesName(const volume::DatasetInfo& info, const PiecesQuestion& question) {
    if (question.of == PiecesOf::Selected) return question.selection;
    return info.channel(question.channel).name + (question.of == PiecesOf::Above ? " of at least " : " of at most ") +
           formatQuantity(question.value, info.channel(question.channel).unit);
}

std::string piecesNote(const volume::DatasetInfo& info, const PieceGraph& graph, const PiecesQuestion& question) {
    const auto counted = [](double count, const char* one, const char* many) {
        return formatCount(count) + (count == 1 ? one : many);
    };
    std::string text = counted(graph.tracks, " piece", " pieces") + " of " + piecesName(info, question) + ", " +
                       counted(double(graph.events.size()), " event", " events");
    if (graph.leftOutTracks > 0)
        text += "; " + formatCount(double(graph.leftOutTracks)) + " smaller than " +
                volumeText(info, question.leastVolume) + " left out";
    if (graph.level > 0) text += "; found at level " + std::to_string(graph.level) + " of detail";
    return text;
}

std::string pieceText(const volume::DatasetInfo& info, const PieceGraph& graph, const PiecesQuestion& question,
                      std::size_t index) {
    const Piece& piece = graph.pieces[index];
    std::string text = "piece " + std::to_string(piece.track) + " at " +
                       timeText(info, info.times[std::size_t(piece.time)]) + ": " + volumeText(info, piece.volume) +
                       ", " + formatCount(piece.samples) + (piece.samples == 1 ? " sample" : " samples") + "\nmean " +
                       info.channel(question.channel).name + " " + pieceValue(info, question.channel, piece.mean) +
                       ", centre at " + pointText(info, piece.centroid, 0.001);
    for (const PieceEvent& event : graph.events)
        if (concerns(graph, event, piece.track)) {
            const bool own = event.from.size() + event.to.size() == 1;
            text += "\n" + timeText(info, info.times[std::size_t(event.time)]) + ": " +
                    (own ? std::to_string(piece.track) + " " : "") + eventText(graph, event);
        }
    return text;
}

Table piecesTable(const volume::DatasetInfo& info, const PieceGraph& graph, const PiecesQuestion& question) {
    Table table;
    const std::vector<Piece>& rows = graph.pieces;
    const LengthUnit volumes = volumeUnit(info);
    const bool cubes = !info.timeAxis();
    const volume::Channel channel = info.channel(question.channel);
    std::vector<std::vector<int>> from(rows.size()), to(rows.size());
    for (const volume::PieceLink& link : graph.links) {
        from[std::size_t(link.to)].push_back(link.from);
        to[std::size_t(link.from)].push_back(link.to);
    }
    const auto tracks = [&](const std::vector<int>& pieces) {
        std::string text;
        for (const int piece : pieces)
            text += (text.empty() ? "" : " ") + std::to_string(rows[std::size_t(piece)].track);
        return text;
    };
    const auto at = [&](const Piece& piece) { return std::size_t(&piece - rows.data()); };
    const std::vector<std::string> events = eventsOf(graph);
    addColumn(table, rows, {.name = info.timeName, .head = timeWord(info), .unit = info.timeUnit},
              [&](const Piece& piece) { return info.times[std::size_t(piece.time)]; });
    addColumn(table, rows, {.name = "piece", .head = "Piece", .kind = NumberKind::Count},
              [](const Piece& piece) { return piece.track; });
    addColumn(table, rows, {.name = "event", .head = "Event"}, [&](const Piece& piece) { return events[at(piece)]; });
    addColumn(table, rows,
              {.name = "volume",
               .head = "Volume",
               .unit = volumes.name,
               .kind = cubes ? NumberKind::Volume : NumberKind::Plain},
              [&](const Piece& piece) { return piece.volume * volumes.perUnit; });
    addColumn(table, rows, {.name = "samples", .head = "Samples", .kind = NumberKind::Count},
              [](const Piece& piece) { return piece.samples; });
    addColumn(table, rows, {.name = "mean " + channel.name, .head = "Mean " + channel.name, .unit = channel.unit},
              [](const Piece& piece) { return piece.mean; });
    // An axis of a plane may be time; the others are in the unit of the source.
    const auto timed = [&](int axis) { return info.timeAxis() == axis; };
    const auto named = [&](int axis) { return timed(axis) ? timeWord(info) : std::string(1, "xyz"[axis]); };
    const auto along = [&](int axis) { return timed(axis) ? info.timeUnit : info.lengthUnit; };
    const auto perUnit = [&](int axis) { return timed(axis) ? info.plane->timePerLength : 1; };
    for (int axis = 0; axis < 3; ++axis)
        addColumn(table, rows, {.name = "centroid " + named(axis), .unit = along(axis)},
                  [&](const Piece& piece) { return piece.centroid[axis] * perUnit(axis); });
    for (int axis = 0; axis < 3; ++axis) {
        addColumn(table, rows, {.name = "least " + named(axis), .unit = along(axis), .shown = false},
                  [&](const Piece& piece) { return piece.extent.lo[axis] * perUnit(axis); });
        addColumn(table, rows, {.name = "greatest " + named(axis), .unit = along(axis), .shown = false},
                  [&](const Piece& piece) { return piece.extent.hi[axis] * perUnit(axis); });
    }
    addColumn(table, rows, {.name = "at the border", .kind = NumberKind::Flag, .shown = false},
              [](const Piece& piece) { return piece.atBorder ? 1 : 0; });
    addColumn(table, rows, {.name = "comes from", .shown = false},
              [&](const Piece& piece) { return tracks(from[at(piece)]); });
    addColumn(table, rows, {.name = "becomes", .shown = false},
              [&](const Piece& piece) { return tracks(to[at(piece)]); });
    table.names = 2;
    table.notes = {"pieces: " + piecesNote(info, graph, question),
                   "a piece: connected samples at a time; its number is the same while it neither merges nor splits",
                   "volumes and extents are those of the samples' cells; centroids and means by volume"};
    return table;
}

std::string tooManyPieces(const PieceGraph& graph) {
    if (graph.tracks <= kMostDrawnTracks) return {};
    return formatCount(graph.tracks) +
           " pieces are too many to draw: choose another value, or a least volume; a table " + "has all of them";
}

PiecesLayout layOutPieces(const volume::DatasetInfo& info, const PieceGraph& graph) {
    if (const std::string reason = tooManyPieces(graph); !reason.empty()) throw Error(reason);
    const PieceLanes lanes = pieceLanes(graph);
    PiecesLayout out{{}, lanes.count};
    for (const Piece& piece : graph.pieces)
        out.places.emplace_back(info.times[std::size_t(piece.time)],
                                lanes.count - 0.5 - lanes.lane[std::size_t(piece.track)]);
    return out;
}

Plot piecesPlot(const volume::DatasetInfo& info, const PieceGraph& graph, const PiecesQuestion& question,
                const PiecesLook& look, const PiecesLayout& layout) {
    constexpr double kHalfLane = 0.42;
    Plot plot;
    const std::vector<glm::dvec2>& places = layout.places;
    double largest = 0;
    for (const Piece& piece : graph.pieces) largest = std::max(largest, piece.volume);
    const double span = info.times.back() - info.times.front(), margin = span > 0 ? span * 0.03 : 1;
    plot.title = "Pieces of " + piecesName(info, question);
    plot.note = "width by volume, at most " + volumeText(info, largest);
    plot.x = {.title = timeWord(info),
              .range = {info.times.front() - margin, info.times.back() + margin},
              .unit = info.timeUnit};
    plot.y = {.title = "", .range = {0, double(std::max(1, layout.lanes))}, .numbered = false};
    plot.cursorX = look.time;
    const auto halfOf = [&](const Piece& piece) { return largest > 0 ? kHalfLane * piece.volume / largest : 0; };
    const glm::vec4 usual = look.dark ? glm::vec4(0.45f, 0.58f, 0.7f, 1) : glm::vec4(0.42f, 0.55f, 0.68f, 1),
                    chosen = glm::vec4(plotInk(0, look.dark), 1);
    const auto inkOf = [&](int track) { return track == look.chosen ? chosen : usual; };
    std::vector<std::vector<int>> before(graph.pieces.size()), after(graph.pieces.size());
    for (const volume::PieceLink& link : graph.links) {
        before[std::size_t(link.to)].push_back(link.from);
        after[std::size_t(link.from)].push_back(link.to);
    }
    for (const volume::PieceLink& link : graph.links) {
        const Piece &from = graph.pieces[std::size_t(link.from)], &to = graph.pieces[std::size_t(link.to)];
        if (from.track == to.track) continue;
        const auto first = std::size_t(link.from), last = std::size_t(link.to);
        PlotFlow& flow = plot.flows.emplace_back();
        flow.color = inkOf(from.track);
        addCurve(flow, endAt(graph, places, first, halfOf(from), after[first], link.to),
                 endAt(graph, places, last, halfOf(to), before[last], link.from));
    }
    std::vector<PlotFlow> tracks(std::size_t(graph.tracks) + 1);
    for (std::size_t p = 0; p < places.size(); ++p) {
        PlotFlow& flow = tracks[std::size_t(graph.pieces[p].track)];
        flow.color = inkOf(graph.pieces[p].track);
        flow.points.push_back(places[p]);
        flow.half.push_back(halfOf(graph.pieces[p]));
    }
    for (std::size_t p = 0; p < places.size(); ++p) {
        PlotFlow& flow = tracks[std::size_t(graph.pieces[p].track)];
        if (flow.points.size() != 1) continue;
        const double reach = quarterStep(info.times, graph.pieces[p].time);
        flow.points = {{std::max(places[p].x - reach, plot.x.range.lo), places[p].y},
                       {std::min(places[p].x + reach, plot.x.range.hi), places[p].y}};
        flow.half.push_back(flow.half.front());
    }
    for (std::size_t t = 1; t < tracks.size(); ++t) plot.flows.push_back(std::move(tracks[t]));
    if (!look.events) return plot;
    static constexpr std::array<const char*, 6> kNames{"birth", "death", "merge", "split", "enters", "leaves"};
    for (std::size_t kind = 0; kind < kNames.size(); ++kind) {
        PlotSeries series{.name = kNames[kind], .points = {}, .dots = true};
        series.color = plotInk(std::array<std::size_t, 6>{2, 5, 3, 0, 4, 1}[kind], look.dark);
        for (const PieceEvent& event : graph.events) {
            if (std::size_t(event.kind) != kind) continue;
            const bool begins = event.kind == PieceEventKind::Birth || event.kind == PieceEventKind::Enter ||
                                event.kind == PieceEventKind::Merge;
            series.points.push_back(places[std::size_t((begins ? event.to : event.from).front())]);
            series.points.emplace_back(std::nan(""), std::nan(""));
        }
        if (!series.points.empty()) plot.series.push_back(std::move(series));
    }
    return plot;
}

} // namespace tessera::app
