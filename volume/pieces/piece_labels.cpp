#include "volume/pieces/piece_labels.h"

#include <algorithm>
#include <glm/common.hpp>
#include <tbb/task_arena.h>
#include <unordered_map>
#include <utility>

namespace tessera::volume {

namespace {

constexpr std::size_t kNumberBudget = std::size_t(128) << 20;

} // namespace

PieceLabels::PieceLabels(std::shared_ptr<const BrickSource> source, PiecesQuery query)
    : source_(std::move(source)), query_(std::move(query)),
      times_(
          kNumberBudget, [this](int time) { return std::make_shared<const Numbers>(numbersAt(time)); },
          [](const Numbers& of) { return of.numbers.size() * 4 + of.present.size(); }) {}

std::shared_ptr<const PieceGraph> PieceLabels::graph(const Progress& progress) const {
    const std::lock_guard lock(mutex_);
    // Isolated: while this thread waits for parallel work it must not pick up an outer task that asks for the same.
    if (!graph_)
        graph_ = tbb::this_task_arena::isolate(
            [&] { return std::make_shared<const PieceGraph>(findPieces(*source_, query_, progress)); });
    return graph_;
}

PieceLabels::Numbers PieceLabels::numbersAt(int time) const {
    LabelledPieces labelled = labelPieces(*source_, query_, time);
    std::unordered_map<std::uint64_t, std::uint32_t> trackOf; // by the first sample
    const auto found = graph();
    for (const Piece& piece : found->pieces)
        if (piece.time == time) trackOf[piece.first] = std::uint32_t(piece.track);
    std::vector<std::uint32_t> tracks{0}; // by label; what is left out has none
    for (const std::uint64_t first : labelled.first) {
        const auto track = trackOf.find(first);
        tracks.push_back(track == trackOf.end() ? 0 : track->second);
    }
    for (std::uint32_t& label : labelled.labels) label = tracks[label];
    return {labelled.size, std::move(labelled.labels), std::move(labelled.present)};
}

BrickSamples PieceLabels::brick(const BrickKey& key) const {
    const BrickGrid& grid = source_->grid();
    const auto numbers = times_.get(key.time);
    const bool bcc = grid.lattice.kind == LatticeKind::BCC, pairs = bcc && query_.level > 0;
    const auto atLevel = [&](int index) {
        return key.level >= query_.level ? index << (key.level - query_.level) : index >> (query_.level - key.level);
    };
    BrickSamples out;
    out.size = grid.brickSamples(key.index, key.level);
    const glm::ivec3 first = grid.levelBegin(key.index, key.level);
    for (int z = 0; z < out.size.z; ++z)
        for (int y = 0; y < out.size.y; ++y)
            for (int x = 0; x < out.size.x; ++x) {
                const glm::ivec3 own = first + glm::ivec3(x, y, z);
                glm::ivec3 at(atLevel(own.x), atLevel(own.y), atLevel(bcc ? own.z / 2 : own.z));
                if (bcc && !pairs) at.z = 2 * at.z + own.z % 2;
                at = glm::min(at, numbers->size - 1);
                const std::size_t sample = (std::size_t(at.z) * std::size_t(numbers->size.y) + std::size_t(at.y)) *
                                               std::size_t(numbers->size.x) +
                                           std::size_t(at.x);
                out.values.push_back(float(numbers->numbers[sample]));
                if (!numbers->present.empty()) out.present.push_back(numbers->present[sample]);
            }
    return out;
}

} // namespace tessera::volume
