#pragma once

#include "app/queries/statistics_query.h"
#include "app/values/plot.h"
#include "app/values/table.h"
#include "volume/pieces/find_pieces.h"

#include <memory>
#include <optional>
#include <string>

/// What the graph of pieces asks, and its answer in words, as a table and as a plot.
namespace tessera::app {

/// Equal questions have equal answers.
struct PiecesQuestion {
    int channel = 0;
    PiecesOf of = PiecesOf::Above;
    double value = 0;
    double leastVolume = 0;
    BrushedQuery brushes = {}; ///< of what is selected
    std::string selection;     ///< its name; "": nothing is
    bool operator==(const PiecesQuestion&) const = default;
};

/// The value that a view shows: its own, or the middle of the range of the channel.
double piecesValue(const PiecesView& view, const volume::DatasetInfo& info, int channel);
PiecesQuestion piecesQuestion(const Session& session, const volume::DatasetInfo& info, const PiecesView& view,
                              int channel);

/// Levels for AsyncQuery: the coarsest that is worth an answer, and 0 for the finest that is searched
/// (volume::piecesLevel). Throws Error, Cancelled.
int firstPiecesLevel(const volume::BrickGrid& grid, std::size_t times);
volume::PieceGraph readPieces(const volume::BrickSource& source, const PiecesQuestion& question, int level,
                              const Progress& progress = {});

/// "gas of at least 0.5", "T of at most 350 K", "starved".
std::string piecesName(const volume::DatasetInfo& info, const PiecesQuestion& question);
/// "12 pieces, 31 events; 4 smaller than 1 mm³ left out"; which level, where that is not the finest.
std::string piecesNote(const volume::DatasetInfo& info, const volume::PieceGraph& graph,
                       const PiecesQuestion& question);
/// What a piece is at its time, and what becomes of its number, a line each.
std::string pieceText(const volume::DatasetInfo& info, const volume::PieceGraph& graph, const PiecesQuestion& question,
                      std::size_t piece);

/// A row for each piece at each time: numbers, places, extents, which numbers it comes from and becomes, its event.
Table piecesTable(const volume::DatasetInfo& info, const volume::PieceGraph& graph, const PiecesQuestion& question);

struct PiecesLook {
    bool events = true, dark = false;
    int chosen = 0; ///< number of the piece that is selected; 0: none
    std::optional<double> time = {};
};
/// More tracks are no longer told apart, and take seconds to lay out.
inline constexpr int kMostDrawnTracks = 2000;
/// Where the pieces are in the plot, by their index, and how many lanes it has.
struct PiecesLayout {
    std::vector<glm::dvec2> places;
    int lanes = 0;
};
/// Throws Error where there are more tracks than kMostDrawnTracks.
PiecesLayout layOutPieces(const volume::DatasetInfo& info, const volume::PieceGraph& graph);
/// "4 100 pieces are too many to draw: ..."; "" where they are not.
std::string tooManyPieces(const volume::PieceGraph& graph);
/// Tracks as lines over the true times, as wide as their volumes; events as dots. `layout` is that of the graph.
Plot piecesPlot(const volume::DatasetInfo& info, const volume::PieceGraph& graph, const PiecesQuestion& question,
                const PiecesLook& look, const PiecesLayout& layout);

} // namespace tessera::app
