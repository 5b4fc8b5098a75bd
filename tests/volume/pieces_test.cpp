#include "tests/volume/uneven.h"
#include "volume/bricks/sample_cells.h"
#include "volume/derived/derived.h"
#include "volume/four/isosurface4.h"
#include "volume/pieces/find_pieces.h"
#include "volume/reconstruct/sample_grid.h"
#include "volume/sources/memory_source.h"
#include "volume/synthetic/bubbles.h"
#include "volume/synthetic/models.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <map>
#include <numbers>
#include <random>
#include <set>

namespace tessera::volume {
namespace {

using Value4 = std::function<double(glm::dvec3 place, int time)>;

Dataset piecesData(const Lattice& lattice, int times, const Value4& value) {
    std::vector<Field> fields;
    for (int t = 0; t < times; ++t)
        fields.push_back(test::sampled<float>(lattice, [&](glm::dvec3 place) { return value(place, t); }));
    return test::datasetOf(std::move(fields), std::size_t(times));
}

std::shared_ptr<const BrickSource> piecesSource(Dataset dataset, LatticeKind lattice = LatticeKind::CC) {
    return makeMemorySource(std::move(dataset), {.lattice = lattice, .brickSize = 8});
}

/// How far inside of the nearest of two balls on one line.
double twoBalls(glm::dvec3 place, double apart, double radius) {
    const glm::dvec3 middle(10, 5, 5);
    const glm::dvec3 half(apart / 2, 0, 0);
    return radius - std::min(glm::length(place - middle - half), glm::length(place - middle + half));
}

std::vector<std::pair<PieceEventKind, int>> eventsOf(const PieceGraph& graph) {
    std::vector<std::pair<PieceEventKind, int>> out;
    for (const PieceEvent& event : graph.events) out.emplace_back(event.kind, event.time);
    return out;
}

using Events = std::vector<std::pair<PieceEventKind, int>>;

TEST(Pieces, MergeAndSplitWhereTheBallsDo) {
    const Lattice lattice = test::ccLattice({21, 11, 11});
    // 12, 10.5, 9, 7.5, 6 apart, of radius 4: one as soon as their surfaces are less than a cell apart.
    const auto merging = [](glm::dvec3 place, int t) { return twoBalls(place, 12 - 1.5 * t, 4); };
    const PieceGraph merged = findPieces(*piecesSource(piecesData(lattice, 5, merging)), {});
    EXPECT_EQ(eventsOf(merged), (Events{{PieceEventKind::Merge, 3}}));
    EXPECT_EQ(merged.tracks, 3);
    const PieceEvent& event = merged.events.front();
    ASSERT_EQ(event.from.size(), 2u);
    EXPECT_EQ(merged.pieces[std::size_t(event.from[0])].track, 1);
    EXPECT_EQ(merged.pieces[std::size_t(event.from[1])].track, 2);
    EXPECT_EQ(merged.pieces[std::size_t(event.to[0])].track, 3);

    const auto splitting = [](glm::dvec3 place, int t) { return twoBalls(place, 6 + 1.5 * t, 4); };
    const PieceGraph split = findPieces(*piecesSource(piecesData(lattice, 5, splitting)), {});
    EXPECT_EQ(eventsOf(split), (Events{{PieceEventKind::Split, 2}}));
    ASSERT_EQ(split.events.front().to.size(), 2u);
    EXPECT_EQ(split.pieces[std::size_t(split.events.front().to[1])].track, 3);
}

TEST(Pieces, AreBornDieEnterAndLeave) {
    const Lattice lattice = test::ccLattice({15, 11, 11});
    const auto value = [](glm::dvec3 place, int t) {
        const double grows = (t == 1 || t == 2 ? 2.5 : -1) - glm::length(place - glm::dvec3(4, 4, 3));
        const double leaves = 2.5 - glm::length(place - glm::dvec3(8 + 3.4 * t, 8, 7));
        return std::max(grows, leaves);
    };
    const PieceGraph graph = findPieces(*piecesSource(piecesData(lattice, 5, value)), {});
    EXPECT_EQ(eventsOf(graph),
              (Events{{PieceEventKind::Birth, 1}, {PieceEventKind::Death, 3}, {PieceEventKind::Leave, 3}}));
    const auto back = [&](glm::dvec3 place, int t) { return value(place, 4 - t); };
    EXPECT_EQ(eventsOf(findPieces(*piecesSource(piecesData(lattice, 5, back)), {})),
              (Events{{PieceEventKind::Birth, 2}, {PieceEventKind::Enter, 2}, {PieceEventKind::Death, 4}}));
    // What is below is one piece around them.
    const PieceGraph below = findPieces(*piecesSource(piecesData(lattice, 5, value)), {.side = PieceSide::Below});
    EXPECT_EQ(below.tracks, 1);
    EXPECT_TRUE(below.events.empty());
}

struct ByHand {
    double volume = 0, samples = 0, sum = 0;
    glm::dvec3 moment{0};
    std::set<std::size_t> members;
};

/// Flood fill with the 14 neighbours that differ by 0 or 1 in all coordinates, or by 0 or -1.
std::vector<ByHand> byHand(const BrickSource& source, double value, int time) {
    const SampleGrid grid = readSamples(source, 0, time, 0);
    const SampleCells cells(source.grid(), source.info().bounds, 0);
    const Lattice& lattice = grid.lattice;
    std::vector<ByHand> out;
    std::set<std::size_t> seen;
    for (std::size_t start = 0; start < grid.values.size(); ++start) {
        if (!grid.isPresent(start) || grid.values[start] < value || seen.contains(start)) continue;
        ByHand& piece = out.emplace_back();
        std::vector<std::size_t> open{start};
        seen.insert(start);
        while (!open.empty()) {
            const std::size_t i = open.back();
            open.pop_back();
            const auto nx = std::size_t(lattice.size.x), ny = std::size_t(lattice.size.y);
            const glm::ivec3 at(int(i % nx), int(i / nx % ny), int(i / (nx * ny)));
            piece.members.insert(i);
            piece.samples += 1;
            piece.volume += cells.volume(at);
            piece.sum += cells.volume(at) * double(grid.values[i]);
            piece.moment += cells.volume(at) * lattice.position(at);
            for (int way : {1, -1})
                for (int bits = 1; bits < 8; ++bits) {
                    const glm::ivec3 to = at + way * glm::ivec3(bits & 1, bits >> 1 & 1, bits >> 2);
                    if (to.x < 0 || to.y < 0 || to.z < 0 || to.x >= lattice.size.x || to.y >= lattice.size.y ||
                        to.z >= lattice.size.z)
                        continue;
                    const std::size_t j = lattice.index(to);
                    if (grid.isPresent(j) && grid.values[j] >= value && seen.insert(j).second) open.push_back(j);
                }
        }
    }
    return out;
}

TEST(Pieces, NumbersAreThoseOfAFloodFillOnUnevenCells) {
    const Lattice lattice = test::layeredLattice(AxisMap::Of::Cells);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> even(0, 1);
    std::vector<Field> fields;
    for (int t = 0; t < 3; ++t) {
        fields.push_back(test::sampled<float>(lattice, [&](glm::dvec3) { return double(even(random)); }));
        test::removeWhere(fields.back(), [&](glm::dvec3) { return even(random) < 0.1f; });
    }
    Dataset dataset = test::unevenDataset(std::move(fields), 3);
    dataset.info.times = {0, 1, 5};
    const auto source = piecesSource(dataset);
    const PieceGraph graph = findPieces(*source, {.value = 0.8});
    std::size_t next = 0;
    std::vector<std::vector<ByHand>> hands;
    for (int t = 0; t < 3; ++t) {
        hands.push_back(byHand(*source, double(0.8f), t));
        for (const ByHand& hand : hands.back()) {
            ASSERT_LT(next, graph.pieces.size());
            const Piece& piece = graph.pieces[next++];
            EXPECT_EQ(piece.time, t);
            EXPECT_EQ(piece.samples, hand.samples);
            EXPECT_NEAR(piece.volume, hand.volume, 1e-9 * hand.volume);
            EXPECT_NEAR(piece.mean, hand.sum / hand.volume, 1e-6);
            for (int axis = 0; axis < 3; ++axis)
                EXPECT_NEAR(piece.centroid[axis], hand.moment[axis] / hand.volume, 1e-9);
        }
    }
    EXPECT_EQ(next, graph.pieces.size());
    // What the pieces of a time share with those of the next.
    double shared = 0, expected = 0;
    for (const PieceLink& link : graph.links) shared += link.shared;
    const SampleCells cells(source->grid(), source->info().bounds, 0);
    const auto nx = std::size_t(lattice.size.x), ny = std::size_t(lattice.size.y);
    for (std::size_t t = 0; t + 1 < hands.size(); ++t)
        for (const ByHand& a : hands[t])
            for (const ByHand& b : hands[t + 1])
                for (const std::size_t i : a.members)
                    if (b.members.contains(i))
                        expected += cells.volume({int(i % nx), int(i / nx % ny), int(i / (nx * ny))});
    EXPECT_NEAR(shared, expected, 1e-9 * expected);
    // The volume of all pieces and of all that is below is that of all samples present.
    double all = 0, present = 0;
    for (const PieceSide side : {PieceSide::Above, PieceSide::Below})
        for (const Piece& piece : findPieces(*source, {.value = 0.8, .side = side}).pieces) all += piece.volume;
    for (int t = 0; t < 3; ++t) {
        const SampleGrid grid = readSamples(*source, 0, t, 0);
        for (std::size_t i = 0; i < grid.values.size(); ++i)
            if (grid.isPresent(i)) present += cells.volume({int(i % nx), int(i / nx % ny), int(i / (nx * ny))});
    }
    EXPECT_NEAR(all, present, 1e-9 * present);
}

/// Connected sets among `count` things that are joined in pairs.
std::size_t connectedSets(std::size_t count, const std::vector<std::pair<std::size_t, std::size_t>>& joined) {
    std::vector<std::size_t> parent(count);
    for (std::size_t i = 0; i < count; ++i) parent[i] = i;
    const auto rootOf = [&](std::size_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    std::size_t sets = count;
    for (const auto& [a, b] : joined) {
        const std::size_t from = rootOf(a), to = rootOf(b);
        if (from == to) continue;
        parent[from] = to;
        --sets;
    }
    return sets;
}

std::size_t piecesOverTime(const PieceGraph& graph) {
    std::vector<std::pair<std::size_t, std::size_t>> joined;
    for (const PieceLink& link : graph.links) joined.emplace_back(link.from, link.to);
    return connectedSets(graph.pieces.size(), joined);
}

// Each connected surface in a box has one piece inside and one outside, and none of them lie around each other in a
// ring: there is one surface less than pieces on both sides.
TEST(Pieces, AreThoseOfTheSurfaceInSpaceAndTime) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> even(0, 1);
    const auto source =
        piecesSource(piecesData(test::ccLattice({9, 8, 7}), 4, [&](glm::dvec3, int) { return double(even(random)); }));
    for (const double value : {0.04, 0.5, 0.96}) {
        const std::size_t above = piecesOverTime(findPieces(*source, {.value = value})),
                          below = piecesOverTime(findPieces(*source, {.value = value, .side = PieceSide::Below}));
        const TetraMesh mesh = extractIsosurface4(*source, 0, value, 0);
        std::vector<std::pair<std::size_t, std::size_t>> joined;
        for (const glm::uvec4& t : mesh.tetrahedra)
            for (int i = 1; i < 4; ++i) joined.emplace_back(t[0], t[i]);
        EXPECT_EQ(connectedSets(mesh.points.size(), joined), above + below - 1) << value;
        EXPECT_GT(above + below, value == 0.5 ? 1u : 20u);
    }
}

TEST(Pieces, OfRegionsAreNeverJoinedAndSmallOnesAreCounted) {
    const Lattice lattice = test::ccLattice({12, 8, 8});
    std::vector<Field> fields;
    const auto bar = [](glm::dvec3 p) { return p.y > 2 && p.y < 5 && p.z > 2 && p.z < 5; };
    for (int t = 0; t < 2; ++t)
        fields.push_back(test::sampled<float>(
            lattice, [&](glm::dvec3 p) { return bar(p) || p == glm::dvec3(1, 7, 7) ? 1.0 : 0.0; }));
    Mask mask(lattice.count(), 1);
    mask[0] = 0;
    for (Field& field : fields) field.mask = std::make_shared<const Mask>(mask);
    for (int t = 0; t < 2; ++t)
        fields.push_back(test::sampled<std::uint8_t>(lattice, [](glm::dvec3 p) { return p.x < 6 ? 1 : 2; }));
    Dataset dataset = test::datasetOf(std::move(fields), 2);
    dataset.info.parameters[1].categorical = true;
    dataset.info.parameters[1].ranges = {{1, 2}};
    const PieceGraph whole = findPieces(*piecesSource(dataset), {.value = 0.5});
    EXPECT_EQ(whole.tracks, 2); // the bar and the speck
    EXPECT_EQ(whole.leftOutTracks, 0u);
    dataset.info.parameters[0].parts = {"p1", {{1}, {2}}};
    const PieceGraph apart = findPieces(*piecesSource(dataset), {.value = 0.5, .leastVolume = 5});
    EXPECT_EQ(apart.tracks, 2); // the bar in two, without the speck
    EXPECT_EQ(apart.leftOutTracks, 1u);
    EXPECT_EQ(apart.leftOut, 2u);
    for (const Piece& piece : apart.pieces) EXPECT_EQ(piece.samples, 6 * 4);
    EXPECT_TRUE(apart.events.empty());
    // Of a degree of interest, whatever the value.
    PiecesQuery brushed{.value = 99, .doiChannels = {1}};
    brushed.doi = [](std::span<const float> values, glm::dvec3 place) {
        return values[0] == 2 && place.z < 1 ? 0.5 : 0.49;
    };
    const PieceGraph selected = findPieces(*piecesSource(dataset), brushed);
    ASSERT_EQ(selected.pieces.size(), 2u);
    EXPECT_EQ(selected.pieces[0].samples, 6 * 8);
    EXPECT_EQ(selected.pieces[0].mean, 0);
    // A brush in space takes absent samples too, which are none of a piece.
    const PieceGraph all = findPieces(*piecesSource(dataset), {.doi = [](auto, auto) { return 1; }});
    EXPECT_EQ(all.pieces[0].samples + all.pieces[1].samples, 12 * 8 * 8 - 1);
}

TEST(Pieces, LabelSamplesWithTheirNumbers) {
    const Lattice lattice = test::ccLattice({21, 11, 11});
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
        const auto below = piecesSource(
            piecesData(lattice, 5, [](glm::dvec3 place, int t) { return twoBalls(place, 12 - 1.5 * t, 4); }), kind);
        const auto source = derive(below, {"piece", "", PiecesRecipe{.channel = "p0", .value = 0}});
        const Parameter& label = source->info().parameters.back();
        EXPECT_TRUE(label.categorical);
        EXPECT_EQ(label.ranges.front(), (Range{0, 3}));
        const PieceGraph graph = findPieces(*below, {});
        ASSERT_EQ(graph.tracks, 3);
        for (int t = 0; t < 5; ++t) {
            std::map<int, double> samples;
            const SampleGrid numbers = readSamples(*source, 1, t, 0), values = readSamples(*below, 0, t, 0);
            for (std::size_t i = 0; i < numbers.values.size(); ++i) {
                EXPECT_EQ(numbers.values[i] > 0, values.values[i] >= 0);
                ++samples[int(numbers.values[i])];
            }
            for (const Piece& piece : graph.pieces)
                if (piece.time == t) {
                    EXPECT_EQ(samples[piece.track], piece.samples) << t;
                }
        }
        const BrickSamples coarse = source->read({1, 0, 1, {0, 0, 0}});
        EXPECT_EQ(std::ranges::max(coarse.values), 1); // the second ball lies in other bricks
    }
}

TEST(Pieces, OfTheBubblesFollowWhatIsKnownOfThem) {
    const Dataset dataset = makeModel("bubbles", {});
    const auto source = makeMemorySource(dataset, {});
    const PieceGraph graph = findPieces(*source, {.channel = 0, .value = 0.5});
    std::map<PieceEventKind, std::vector<double>> when;
    for (const PieceEvent& event : graph.events)
        when[event.kind].push_back(dataset.info.times[std::size_t(event.time)]);
    const auto once = [&](PieceEventKind kind, double time, double within) {
        ASSERT_EQ(when[kind].size(), 1u) << kPieceEventNames[std::size_t(kind)];
        EXPECT_NEAR(when[kind].front(), time, within) << kPieceEventNames[std::size_t(kind)];
    };
    once(PieceEventKind::Merge, bubbles::kMerge, 0.13); // a gap of less than a cell is none
    once(PieceEventKind::Split, bubbles::kSplit, 0.13);
    once(PieceEventKind::Leave, bubbles::kLeave, 0.06);
    once(PieceEventKind::Birth, bubbles::kBirth, 0.06);
    once(PieceEventKind::Death, bubbles::kDeath, 0.06);
    EXPECT_EQ(graph.events.size(), 5u);
    // At first: two bubbles of 6 mm radius, one of 5 mm that will split, one of 5 mm that leaves.
    std::vector<double> volumes;
    for (const Piece& piece : graph.pieces)
        if (piece.time == 0) volumes.push_back(piece.volume);
    std::ranges::sort(volumes);
    ASSERT_EQ(volumes.size(), 4u);
    const auto ball = [](double radius) { return 4 * std::numbers::pi / 3 * std::pow(radius, 3); };
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(volumes[i], ball(i < 2 ? 5e-3 : 6e-3), 0.04 * ball(6e-3));
}

} // namespace
} // namespace tessera::volume
