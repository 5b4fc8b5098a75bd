#include "app/views/pieces/piece_lanes.h"

#include <algorithm>
#include <cstddef>

namespace tessera::app {

namespace {

/// First and last time of a track, and the tracks that it is linked with.
struct TrackSpan {
    int first = -1, last = -1;
    std::vector<int> before, after;
};

std::vector<TrackSpan> spansOf(const volume::PieceGraph& graph) {
    std::vector<TrackSpan> spans(std::size_t(graph.tracks) + 1);
    for (const volume::Piece& piece : graph.pieces) {
        TrackSpan& own = spans[std::size_t(piece.track)];
        if (own.first < 0) own.first = piece.time;
        own.last = piece.time;
    }
    for (const volume::PieceLink& link : graph.links) {
        const int from = graph.pieces[std::size_t(link.from)].track, to = graph.pieces[std::size_t(link.to)].track;
        if (from == to) continue;
        spans[std::size_t(from)].after.push_back(to);
        spans[std::size_t(to)].before.push_back(from);
    }
    return spans;
}

} // namespace

PieceLanes pieceLanes(const volume::PieceGraph& graph) {
    const std::vector<TrackSpan> spans = spansOf(graph);
    // From the top: numbers rise with time, so that what a track comes from is placed before it.
    std::vector<int> order;
    const auto placeOf = [&](int track) { return std::ranges::find(order, track); };
    const auto behind = [&](int track, const std::vector<int>& near) {
        auto at = order.end();
        if (!near.empty()) {
            // In the middle of those it comes from, or behind what it will be one with.
            std::vector<std::ptrdiff_t> places;
            for (const int each : near) places.push_back(placeOf(each) - order.begin());
            std::ranges::sort(places);
            at = order.begin() + places[(places.size() - 1) / 2] + 1;
        }
        order.insert(at, track);
    };
    for (int track = 1; track <= graph.tracks; ++track) {
        const TrackSpan& own = spans[std::size_t(track)];
        std::vector<int> near = own.before;
        if (near.empty())
            for (const int next : own.after)
                for (const int mate : spans[std::size_t(next)].before)
                    if (mate != track && placeOf(mate) != order.end()) near.push_back(mate);
        behind(track, near);
    }
    PieceLanes lanes{std::vector<int>(spans.size(), 0), 0};
    for (std::size_t i = 0; i < order.size(); ++i) {
        const TrackSpan& own = spans[std::size_t(order[i])];
        int lane = 0;
        for (std::size_t j = 0; j < i; ++j) {
            const TrackSpan& other = spans[std::size_t(order[j])];
            // What goes over into each other may do so on one lane; what has nothing to do with it stays apart.
            const int apart =
                std::ranges::count(own.before, order[j]) + std::ranges::count(own.after, order[j]) > 0 ? 0 : 1;
            if (other.last + apart >= own.first && own.last + apart >= other.first)
                lane = std::max(lane, lanes.lane[std::size_t(order[j])] + 1);
        }
        lanes.lane[std::size_t(order[i])] = lane;
        lanes.count = std::max(lanes.count, lane + 1);
    }
    return lanes;
}

} // namespace tessera::app
