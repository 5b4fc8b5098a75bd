#pragma once

#include "volume/base/load_once.h"
#include "volume/pieces/find_pieces.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>

namespace tessera::volume {

/// The number of the piece that each sample belongs to (Piece::track), as bricks: 0 in none, absent where the parameter
/// is. Found once all times are read (findPieces), at query.level; finer samples have the number of the coarse one.
/// Thread-safe.
class PieceLabels {
public:
    PieceLabels(std::shared_ptr<const BrickSource> source, PiecesQuery query);

    /// `key.channel` is ignored; key.time is a stored one.
    BrickSamples brick(const BrickKey& key) const;
    /// Found once, by the first who asks. Throws what the source throws; Cancelled, after which others may ask.
    std::shared_ptr<const PieceGraph> graph(const Progress& progress = {}) const;

private:
    struct Numbers {
        glm::ivec3 size{0};
        std::vector<std::uint32_t> numbers;
        std::vector<std::uint8_t> present;
    };
    Numbers numbersAt(int time) const;

    std::shared_ptr<const BrickSource> source_;
    PiecesQuery query_;
    mutable std::mutex mutex_;
    mutable std::shared_ptr<const PieceGraph> graph_; ///< under the mutex
    mutable LoadOnce<int, Numbers, std::hash<int>> times_;
};

} // namespace tessera::volume
