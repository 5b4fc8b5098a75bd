#pragma once

#include "volume/field/lattice.h"

#include <cstdint>
#include <string_view>
#include <vector>

/// Pieces of what is above a value, how they follow each other over time, and what becomes of them.
namespace tessera::volume {

/// A connected set of samples at one time. Volumes are those of the samples' cells (volume/bricks/sample_cells.h).
struct Piece {
    int time = 0;            ///< index
    int track = 0;           ///< the piece's number, from 1: the same as long as it neither merges nor splits
    double volume = 0;       ///< in cubes of the data set's length unit
    double samples = 0;      ///< how many
    double mean = 0;         ///< of the parameter, by volume; NaN where no sample has a value
    glm::dvec3 centroid{0};  ///< by volume
    Box extent;              ///< of the cells
    std::uint64_t first = 0; ///< its first sample in storage, of the level
    bool atBorder = false;   ///< it has samples at the border of the grid
    bool operator==(const Piece&) const = default;
};

/// Two pieces at neighbouring times that are connected; indices of pieces.
struct PieceLink {
    int from = 0, to = 0;
    double shared = 0; ///< volume of the samples that belong to both
    bool operator==(const PieceLink&) const = default;
};

enum class PieceEventKind { Birth, Death, Merge, Split, Enter, Leave };
inline constexpr std::string_view kPieceEventNames[] = {"birth", "death", "merge", "split", "enters", "leaves"};

/// What becomes of pieces between a time and the next. Pieces at the first time are not born, those at the last do not
/// die. One that appears at the border of the grid enters, one that is last seen there leaves.
struct PieceEvent {
    PieceEventKind kind = PieceEventKind::Birth;
    int time = 0;                ///< index of the later time; of a death the first one without the piece
    std::vector<int> from, to{}; ///< indices of pieces at the time before, and at this one
    bool operator==(const PieceEvent&) const = default;
};

struct PieceGraph {
    std::vector<Piece> pieces; ///< by time, then by first sample
    std::vector<PieceLink> links;
    std::vector<PieceEvent> events; ///< by time
    int tracks = 0;                 ///< the largest number of a piece
    std::size_t leftOut = 0;        ///< pieces smaller than the least volume, at all times together
    std::size_t leftOutTracks = 0;  ///< and how many they were, each counted once
    int level = 0;                  ///< of detail
    bool operator==(const PieceGraph&) const = default;
};

} // namespace tessera::volume
