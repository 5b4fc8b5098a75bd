#include "volume/pieces/find_pieces.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/bricks/sample_cells.h"
#include "volume/pieces/neighbour_steps.h"
#include "volume/pieces/piece_tracks.h"
#include "volume/reconstruct/sample_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <map>
#include <utility>

namespace tessera::volume {

namespace {

constexpr double kMostPieceSamples = 2.5e8; ///< over all times

/// The samples of one time, and which of them make pieces.
struct PieceSamples {
    SampleGrid grid;
    std::vector<std::uint8_t> inside;

    int partOf(std::size_t sample) const { return grid.parts.empty() ? 0 : grid.parts[sample]; }
};

PieceSamples samplesInside(const BrickSource& source, const PiecesQuery& query, int time, const Progress& progress) {
    PieceSamples out{readSamples(source, query.channel, time, query.level, progress), {}};
    const std::size_t count = out.grid.values.size();
    if (count >= 0xffffffffu) throw Error("pieces need fewer samples a time");
    out.inside.assign(count, 0);
    if (!query.doi) {
        const bool above = query.side == PieceSide::Above;
        for (std::size_t i = 0; i < count; ++i) {
            const double value = double(out.grid.values[i]);
            out.inside[i] = out.grid.isPresent(i) && (above ? value >= query.value : value <= query.value) ? 1 : 0;
        }
        return out;
    }
    std::vector<SampleGrid> of;
    for (const int channel : query.doiChannels) of.push_back(readSamples(source, channel, time, query.level, progress));
    const Lattice& lattice = out.grid.lattice;
    parallelFor(std::size_t(lattice.size.z), [&](std::size_t z) {
        std::vector<float> values(of.size());
        for (int y = 0; y < lattice.size.y; ++y)
            for (int x = 0; x < lattice.size.x; ++x) {
                const glm::ivec3 at(x, y, int(z));
                const std::size_t i = lattice.index(at);
                bool there = out.grid.isPresent(i) && !std::isnan(out.grid.values[i]);
                for (std::size_t c = 0; c < of.size(); ++c) {
                    values[c] = of[c].isPresent(i) ? of[c].values[i] : std::numeric_limits<float>::quiet_NaN();
                    there = there || !std::isnan(values[c]);
                }
                out.inside[i] = there && query.doi(values, lattice.position(at)) >= 0.5 ? 1 : 0;
            }
    });
    return out;
}

/// Calls visit(at, index) for every sample in storage order.
template <class Visit> void forEachSample(const Lattice& lattice, const Visit& visit) {
    std::size_t index = 0;
    for (int z = 0; z < lattice.size.z; ++z)
        for (int y = 0; y < lattice.size.y; ++y)
            for (int x = 0; x < lattice.size.x; ++x, ++index) visit(glm::ivec3(x, y, z), index);
}

bool isWithin(glm::ivec3 at, glm::ivec3 size) {
    return at.x >= 0 && at.y >= 0 && at.z >= 0 && at.x < size.x && at.y < size.y && at.z < size.z;
}

/// Steps from samples of even slices, and from those of odd ones.
std::array<std::vector<glm::ivec3>, 2> stepsOf(LatticeKind kind) {
    return {stepsAfter(kind, false), stepsAfter(kind, true)};
}

LabelledPieces labelConnected(const PieceSamples& samples) {
    const Lattice& lattice = samples.grid.lattice;
    const auto steps = stepsOf(lattice.kind);
    std::vector<std::uint32_t> parent(samples.inside.size());
    const auto rootOf = [&](std::uint32_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = std::uint32_t(i);
    forEachSample(lattice, [&](glm::ivec3 at, std::size_t i) {
        if (samples.inside[i] == 0) return;
        for (const glm::ivec3 step : steps[std::size_t(at.z & 1)]) {
            if (!isWithin(at + step, lattice.size)) continue;
            const std::size_t j = lattice.index(at + step);
            if (samples.inside[j] == 0 || samples.partOf(i) != samples.partOf(j)) continue;
            const std::uint32_t a = rootOf(std::uint32_t(i)), b = rootOf(std::uint32_t(j));
            parent[std::max(a, b)] = std::min(a, b); // the root is the first sample
        }
    });
    LabelledPieces out{lattice.size, std::vector<std::uint32_t>(parent.size(), 0), {}, samples.grid.present};
    for (std::size_t i = 0; i < parent.size(); ++i) {
        if (samples.inside[i] == 0) continue;
        const std::uint32_t root = rootOf(std::uint32_t(i));
        if (root == i) out.first.push_back(i);
        out.labels[i] = root == i ? std::uint32_t(out.first.size()) : out.labels[root];
    }
    return out;
}

/// The cells of the samples that readSamples gives: of a coarse level of BCC those of two samples each.
class PieceCells {
public:
    PieceCells(const BrickSource& source, int level)
        : cells_(source.grid(), source.info().bounds, level), slices_(source.grid().levelSamples(level).z),
          pairs_(source.grid().lattice.kind == LatticeKind::BCC && level > 0) {}

    double volume(glm::ivec3 at) const {
        if (!pairs_) return cells_.volume(at);
        const glm::ivec3 even(at.x, at.y, 2 * at.z), odd = even + glm::ivec3(0, 0, 1);
        return cells_.volume(even) + (odd.z < slices_ ? cells_.volume(odd) : 0);
    }
    Box box(glm::ivec3 at) const {
        const glm::ivec3 sample = pairs_ ? glm::ivec3(at.x, at.y, 2 * at.z) : at;
        Box own{cells_.lower(sample), cells_.lower(sample) + cells_.size(sample)};
        if (!pairs_ || sample.z + 1 >= slices_) return own;
        const glm::ivec3 odd = sample + glm::ivec3(0, 0, 1);
        return {glm::min(own.lo, cells_.lower(odd)), glm::max(own.hi, cells_.lower(odd) + cells_.size(odd))};
    }

private:
    SampleCells cells_;
    int slices_;
    bool pairs_;
};

/// The pieces of one time, without numbers.
std::vector<Piece> measurePieces(const PieceSamples& samples, const LabelledPieces& labels, const PieceCells& cells,
                                 int time) {
    const Lattice& lattice = samples.grid.lattice;
    std::vector<Piece> out(labels.first.size());
    std::vector<double> valued(out.size(), 0); // volume of samples that have a value
    for (std::size_t p = 0; p < out.size(); ++p) {
        out[p].time = time;
        out[p].first = labels.first[p];
        out[p].extent = {glm::dvec3(std::numeric_limits<double>::infinity()),
                         glm::dvec3(-std::numeric_limits<double>::infinity())};
    }
    forEachSample(lattice, [&](glm::ivec3 at, std::size_t i) {
        if (labels.labels[i] == 0) return;
        Piece& piece = out[labels.labels[i] - 1];
        const double volume = cells.volume(at);
        const Box box = cells.box(at);
        piece.samples += 1;
        piece.volume += volume;
        piece.centroid += volume * lattice.position(at);
        piece.extent = {glm::min(piece.extent.lo, box.lo), glm::max(piece.extent.hi, box.hi)};
        if (samples.grid.isPresent(i) && std::isfinite(samples.grid.values[i])) {
            valued[labels.labels[i] - 1] += volume;
            piece.mean += volume * double(samples.grid.values[i]);
        }
        for (int axis = 0; axis < 3; ++axis)
            if (lattice.size[axis] > 1 && (at[axis] == 0 || at[axis] == lattice.size[axis] - 1)) piece.atBorder = true;
    });
    for (std::size_t p = 0; p < out.size(); ++p) {
        // Cells at the border of a flat box may have no volume: then every sample counts alike.
        const glm::dvec3 middle = out[p].extent.center();
        out[p].centroid = out[p].volume > 0 ? out[p].centroid / out[p].volume : middle;
        out[p].mean = valued[p] > 0 ? out[p].mean / valued[p] : std::numeric_limits<double>::quiet_NaN();
    }
    return out;
}

/// Links between the pieces of two times, by position among those of each.
std::vector<PieceLink> linkPieces(const PieceSamples& before, const LabelledPieces& from, const PieceSamples& after,
                                  const LabelledPieces& to, const PieceCells& cells) {
    const Lattice& lattice = after.grid.lattice;
    const auto steps = stepsOf(lattice.kind);
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> shared;
    forEachSample(lattice, [&](glm::ivec3 at, std::size_t i) {
        if (from.labels[i] == 0) return;
        if (to.labels[i] != 0 && before.partOf(i) == after.partOf(i))
            shared[{from.labels[i], to.labels[i]}] += cells.volume(at);
        for (const glm::ivec3 step : steps[std::size_t(at.z & 1)]) {
            if (!isWithin(at + step, lattice.size)) continue;
            const std::size_t j = lattice.index(at + step);
            if (to.labels[j] != 0 && to.labels[j] != to.labels[i] && before.partOf(i) == after.partOf(j))
                shared.try_emplace({from.labels[i], to.labels[j]}, 0.0);
        }
    });
    std::vector<PieceLink> out;
    for (const auto& [pair, volume] : shared) out.push_back({int(pair.first) - 1, int(pair.second) - 1, volume});
    return out;
}

} // namespace

int piecesLevel(const BrickGrid& grid, std::size_t times) {
    return grid.levelWithin(kMostPieceSamples / double(std::max<std::size_t>(1, times)));
}

LabelledPieces labelPieces(const BrickSource& source, const PiecesQuery& query, int time, const Progress& progress) {
    return labelConnected(samplesInside(source, query, time, progress));
}

PieceGraph findPieces(const BrickSource& source, const PiecesQuery& query, const Progress& progress) {
    const std::size_t times = source.info().times.size();
    const PieceCells cells(source, query.level);
    const Progress inner{{}, progress.stop};
    PieceGraph graph;
    graph.level = query.level;
    PieceSamples before;
    LabelledPieces labelsBefore;
    int firstBefore = 0; // of the pieces of the time before
    for (std::size_t t = 0; t < times; ++t) {
        progress.advance(double(t) / double(times), "pieces");
        PieceSamples now = samplesInside(source, query, int(t), inner);
        LabelledPieces labels = labelConnected(now);
        const int firstNow = int(graph.pieces.size());
        for (Piece& piece : measurePieces(now, labels, cells, int(t))) graph.pieces.push_back(std::move(piece));
        if (t > 0)
            for (const PieceLink& link : linkPieces(before, labelsBefore, now, labels, cells))
                graph.links.push_back({link.from + firstBefore, link.to + firstNow, link.shared});
        before = std::move(now);
        labelsBefore = std::move(labels);
        firstBefore = firstNow;
    }
    followPieces(graph, query.leastVolume, int(times));
    progress.advance(1, "pieces");
    return graph;
}

} // namespace tessera::volume
