#pragma once

#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"
#include "volume/pieces/piece_graph.h"

#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace tessera::volume {

enum class PieceSide { Above, Below };
inline constexpr std::string_view kPieceSideNames[] = {"above", "below"};

struct PiecesQuery {
    int channel = 0; ///< of DatasetInfo::channels(): what is compared, and of which means are
    double value = 0;
    PieceSide side = PieceSide::Above; ///< samples of at least the value, or of at most
    double leastVolume = 0;            ///< of a piece at the time when it is largest; smaller ones are left out
    int level = 0;                     ///< of detail
    std::vector<int> doiChannels = {};
    /// Degree of interest 0..1 of a sample, given the values of `doiChannels` (NaN where absent) and its position:
    /// where it is given, samples of at least 1/2 make the pieces, whatever their value, but not those that have none
    /// of `channel` nor of `doiChannels`. Called from several threads.
    std::function<double(std::span<const float> values, glm::dvec3 position)> doi = {};
};

/// The finest level whose samples of all times together are so few that pieces are found within seconds to minutes.
int piecesLevel(const BrickGrid& grid, std::size_t times);

/// The connected sets of samples at each time, and how they follow each other.
///
/// Samples are neighbours where an edge of the simplices of the surface in space and time joins them
/// (volume/four/isosurface4.h): on CC at the offsets (0 or 1, 0 or 1, 0 or 1) and back, on BCC the 14 nearest; between
/// a time and the next the same sample, and those after it in storage. So pieces are those of the quantity as it is
/// between the samples: two are one where the surface around them is. Samples of different parts
/// (volume/field/parts.h) are no neighbours, absent ones are in no piece.
///
/// A piece keeps its number as long as exactly one piece follows it that follows it alone. Pieces whose number never
/// has the least volume are left out first, then links, numbers and events are those of what remains.
///
/// Reads one time after the other and keeps the samples of two. Throws what the source throws, Cancelled.
PieceGraph findPieces(const BrickSource& source, const PiecesQuery& query, const Progress& progress = {});

/// The piece of each sample at one time: 0, or 1 + its position among the pieces of that time, by first sample, of any
/// volume. In storage order of `size`, the samples of the level (of a coarse level of BCC those of readSamples).
struct LabelledPieces {
    glm::ivec3 size{0};
    std::vector<std::uint32_t> labels;
    std::vector<std::uint64_t> first; ///< the first sample of each
    std::vector<std::uint8_t> present;
};
LabelledPieces labelPieces(const BrickSource& source, const PiecesQuery& query, int time,
                           const Progress& progress = {});

} // namespace tessera::volume
