#include "volume/pieces/piece_tracks.h"

#include <algorithm>
#include <utility>

namespace tessera::volume {

namespace {

/// For each piece those linked to it at the time before, and at the next.
struct PieceNeighbours {
    std::vector<std::vector<int>> before, after;

    explicit PieceNeighbours(const PieceGraph& graph) : before(graph.pieces.size()), after(graph.pieces.size()) {
        for (const PieceLink& link : graph.links) {
            before[std::size_t(link.to)].push_back(link.from);
            after[std::size_t(link.from)].push_back(link.to);
        }
        for (auto* lists : {&before, &after})
            for (std::vector<int>& list : *lists) std::ranges::sort(list);
    }
};

void numberPieces(PieceGraph& graph, const PieceNeighbours& near) {
    graph.tracks = 0;
    for (std::size_t p = 0; p < graph.pieces.size(); ++p) {
        const std::vector<int>& before = near.before[p];
        const bool goesOn = before.size() == 1 && near.after[std::size_t(before[0])].size() == 1;
        graph.pieces[p].track = goesOn ? graph.pieces[std::size_t(before[0])].track : ++graph.tracks;
    }
}

void leaveOutSmall(PieceGraph& graph, double leastVolume) {
    std::vector<double> largest(std::size_t(graph.tracks) + 1, 0);
    for (const Piece& piece : graph.pieces)
        largest[std::size_t(piece.track)] = std::max(largest[std::size_t(piece.track)], piece.volume);
    const auto isSmall = [&](const Piece& piece) { return largest[std::size_t(piece.track)] < leastVolume; };
    std::vector<int> index;
    std::vector<Piece> kept;
    for (const Piece& piece : graph.pieces) {
        index.push_back(isSmall(piece) ? -1 : int(kept.size()));
        if (index.back() >= 0) kept.push_back(piece);
    }
    graph.leftOut = graph.pieces.size() - kept.size();
    graph.leftOutTracks = std::size_t(
        std::count_if(largest.begin() + 1, largest.end(), [&](double volume) { return volume < leastVolume; }));
    graph.pieces = std::move(kept);
    std::vector<PieceLink> links;
    for (const PieceLink& link : graph.links) {
        const int from = index[std::size_t(link.from)], to = index[std::size_t(link.to)];
        if (from >= 0 && to >= 0) links.push_back({from, to, link.shared});
    }
    graph.links = std::move(links);
}

void tellEvents(PieceGraph& graph, const PieceNeighbours& near, int times) {
    graph.events.clear();
    for (std::size_t p = 0; p < graph.pieces.size(); ++p) {
        const Piece& piece = graph.pieces[p];
        const int own = int(p);
        const std::vector<int>&before = near.before[p], &after = near.after[p];
        if (before.empty() && piece.time > 0)
            graph.events.push_back(
                {piece.atBorder ? PieceEventKind::Enter : PieceEventKind::Birth, piece.time, {}, {own}});
        if (before.size() > 1) graph.events.push_back({PieceEventKind::Merge, piece.time, before, {own}});
        if (after.size() > 1) graph.events.push_back({PieceEventKind::Split, piece.time + 1, {own}, after});
        if (after.empty() && piece.time + 1 < times)
            graph.events.push_back(
                {piece.atBorder ? PieceEventKind::Leave : PieceEventKind::Death, piece.time + 1, {own}, {}});
    }
    std::ranges::stable_sort(graph.events, {}, &PieceEvent::time);
}

} // namespace

void followPieces(PieceGraph& graph, double leastVolume, int times) {
    numberPieces(graph, PieceNeighbours(graph));
    leaveOutSmall(graph, leastVolume);
    const PieceNeighbours near(graph);
    numberPieces(graph, near);
    tellEvents(graph, near, times);
}

} // namespace tessera::volume
