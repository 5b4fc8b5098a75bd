#include "app/views/pieces/pieces_data.h"

#include "app/views/pieces/piece_lanes.h"
#include "app/views/pieces/select_piece.h"
#include "volume/derived/derived.h"
#include "volume/reconstruct/sample_grid.h"
#include "volume/sources/memory_source.h"
#include "volume/synthetic/models.h"

#include <algorithm>
#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <set>

/// The graph of pieces of the bubbles: its lines, words and table, and a piece of it as the selection.
namespace tessera::app {
namespace {

using testing::HasSubstr;

class PiecesGraph : public testing::Test {
protected:
    static void SetUpTestSuite() {
        source = volume::makeMemorySource(
            volume::makeModel("bubbles", {{"nx", 24}, {"ny", 24}, {"nz", 48}, {"times", 16}}), {});
        question = piecesQuestion({}, source->info(), {}, 0);
        graph = readPieces(*source, question, 0);
    }
    static void TearDownTestSuite() { source.reset(); }
    static const volume::PieceEvent& eventOf(volume::PieceEventKind kind) {
        return *std::ranges::find(graph.events, kind, &volume::PieceEvent::kind);
    }
    static inline std::shared_ptr<const volume::BrickSource> source;
    static inline PiecesQuestion question;
    static inline volume::PieceGraph graph;
};

TEST_F(PiecesGraph, AsksForTheMiddleOfTheRangeUnlessToldOtherwise) {
    EXPECT_EQ(question.value, 0.5);
    EXPECT_EQ(piecesName(source->info(), question), "gas of at least 0.5");
    PiecesView view;
    view.of = PiecesOf::Below;
    view.value = 350;
    EXPECT_EQ(piecesName(source->info(), piecesQuestion({}, source->info(), view, 1)), "T of at most 350 K");
}

TEST_F(PiecesGraph, HasALaneForEachTrackThatIsThere) {
    const PieceLanes lanes = pieceLanes(graph);
    ASSERT_EQ(lanes.lane.size(), std::size_t(graph.tracks) + 1);
    std::set<std::pair<int, int>> taken; // time and lane
    for (const volume::Piece& piece : graph.pieces) {
        const int lane = lanes.lane[std::size_t(piece.track)];
        EXPECT_LT(lane, lanes.count);
        EXPECT_TRUE(taken.insert({piece.time, lane}).second) << "two pieces on one place";
    }
    // Those that merge run beside each other, with none in between while they are there.
    const volume::PieceEvent& merge = eventOf(volume::PieceEventKind::Merge);
    ASSERT_EQ(merge.from.size(), 2u);
    const int a = lanes.lane[std::size_t(graph.pieces[std::size_t(merge.from[0])].track)],
              b = lanes.lane[std::size_t(graph.pieces[std::size_t(merge.from[1])].track)];
    for (int lane = std::min(a, b) + 1; lane < std::max(a, b); ++lane)
        EXPECT_FALSE(taken.contains({merge.time - 1, lane}));
    EXPECT_LE(lanes.count, graph.tracks);
}

TEST_F(PiecesGraph, DrawsVolumesAsWidthsAtTheirTimes) {
    const volume::DatasetInfo& info = source->info();
    const PiecesLayout layout = layOutPieces(info, graph);
    const Plot plot = piecesPlot(info, graph, question, {}, layout);
    const std::vector<glm::dvec2>& places = layout.places;
    const auto largest = std::ranges::max_element(graph.pieces, {}, &volume::Piece::volume);
    std::size_t checked = 0;
    for (const PlotFlow& flow : plot.flows) {
        ASSERT_EQ(flow.points.size(), flow.half.size());
        EXPECT_TRUE(std::ranges::is_sorted(flow.points, {}, &glm::dvec2::x));
        EXPECT_GE(flow.points.front().x, plot.x.range.lo) << "beside the plot";
        EXPECT_LE(flow.points.back().x, plot.x.range.hi);
        for (std::size_t i = 0; i < flow.points.size(); ++i)
            for (std::size_t p = 0; p < places.size(); ++p)
                if (places[p] == flow.points[i]) {
                    EXPECT_NEAR(flow.half[i], 0.42 * graph.pieces[p].volume / largest->volume, 1e-12);
                    ++checked;
                }
    }
    EXPECT_GT(checked, 20u);
    std::set<std::string> named;
    std::size_t dots = 0;
    for (const PlotSeries& series : plot.series) {
        named.insert(series.name);
        dots += std::size_t(std::ranges::count_if(series.points, [](glm::dvec2 at) { return std::isfinite(at.x); }));
    }
    EXPECT_EQ(named, (std::set<std::string>{"birth", "death", "leaves", "merge", "split"}));
    EXPECT_EQ(dots, graph.events.size());
}

TEST_F(PiecesGraph, SaysWhatAPieceIsAndBecomes) {
    const volume::DatasetInfo& info = source->info();
    const volume::PieceEvent& merge = eventOf(volume::PieceEventKind::Merge);
    const std::string text = pieceText(info, graph, question, std::size_t(merge.from.front()));
    const volume::Piece& piece = graph.pieces[std::size_t(merge.from.front())];
    EXPECT_THAT(text, HasSubstr("piece " + std::to_string(piece.track) + " at t = "));
    EXPECT_THAT(text, HasSubstr("mm³"));
    EXPECT_THAT(text, HasSubstr(" merge into " + std::to_string(graph.pieces[std::size_t(merge.to.front())].track)));
    EXPECT_EQ(text.find("splits"), std::string::npos);
    EXPECT_THAT(piecesNote(info, graph, question), HasSubstr("5 events"));
    const Table table = piecesTable(info, graph, question);
    ASSERT_EQ(rowsOf(table), graph.pieces.size());
    const auto column = [&](std::string_view name) {
        return *std::ranges::find(table.columns, name, &TableColumn::name);
    };
    const auto to = std::size_t(merge.to.front());
    EXPECT_EQ(column("event").texts[to], "merge");
    EXPECT_EQ(column("comes from").texts[to],
              std::to_string(piece.track) + " " + std::to_string(graph.pieces[std::size_t(merge.from.back())].track));
    EXPECT_EQ(column("volume").numbers[to], graph.pieces[to].volume);
    EXPECT_EQ(column("time").numbers[to], info.times[std::size_t(merge.time)]);
    EXPECT_EQ(column("mean gas").numbers[to], graph.pieces[to].mean);
    EXPECT_EQ(column("greatest z").numbers[to], graph.pieces[to].extent.hi.z);
}

TEST_F(PiecesGraph, AreDrawnOnlyWhereTheyAreTold) {
    volume::PieceGraph many;
    many.tracks = kMostDrawnTracks + 1;
    EXPECT_THROW(layOutPieces(source->info(), many), Error);
    EXPECT_THAT(tooManyPieces(many), HasSubstr("too many to draw"));
    EXPECT_EQ(tooManyPieces(graph), "");
}

TEST_F(PiecesGraph, SaysTimesAlongTheAxisOfAPlaneThatIsTime) {
    volume::DatasetInfo info = source->info();
    info.plane.emplace();
    info.plane->solved = 2;
    info.plane->timePerLength = 0.5;
    ASSERT_EQ(info.timeAxis(), 2);
    const Table table = piecesTable(info, graph, question);
    const auto column = [&](std::string_view name) {
        return *std::ranges::find(table.columns, name, &TableColumn::name);
    };
    EXPECT_EQ(column("centroid t").unit, info.timeUnit);
    EXPECT_EQ(column("centroid t").numbers[0], graph.pieces[0].centroid.z * 0.5);
    EXPECT_EQ(column("volume").unit, info.lengthUnit + "2 " + info.timeUnit);
    EXPECT_EQ(column("volume").numbers[0], graph.pieces[0].volume * 0.5);
}

TEST_F(PiecesGraph, SelectsExactlyTheSamplesOfAPiece) {
    const volume::DatasetInfo& info = source->info();
    Session session;
    const std::size_t middle = graph.pieces.size() / 2;
    const volume::Piece& piece = graph.pieces[middle];
    selectPiece(session, info, question, piece, false);
    EXPECT_EQ(session.time, info.times[std::size_t(piece.time)]);
    EXPECT_EQ(session.cursor, piece.centroid);
    EXPECT_TRUE(session.selection.brushes.empty()) << "numbers of a coarse level are not those of the label";

    selectPiece(session, info, question, graph.pieces.front(), true);
    selectPiece(session, info, question, piece, true);
    EXPECT_EQ(session.data.derived.size(), 1u);
    EXPECT_EQ(chosenPiece(session, info, question), piece.track);
    PiecesQuestion other = question;
    other.value = 0.7;
    EXPECT_EQ(chosenPiece(session, info, other), 0);

    std::vector<std::string> messages;
    const auto derived = volume::deriveAll(source, session.data.derived, messages);
    EXPECT_TRUE(messages.empty());
    const BrushedQuery brushed = brushedQuery(session, derived->info(), {}, {}, 1, false);
    const volume::StatisticsQuery query = samplesQuery(brushed, derived->info(), 0);
    ASSERT_EQ(brushed.channels.size(), 1u);
    std::get<vis::RangeRegion>(session.selection.brushes.back().region).intervals[0].lo = 0;
    EXPECT_EQ(chosenPiece(session, info, question), 0) << "a brush of several pieces is of none alone";
    for (const volume::Piece& each : graph.pieces) {
        if (each.track != piece.track) continue;
        const volume::SampleGrid numbers = volume::readSamples(*derived, brushed.channels[0], each.time, 0);
        double selected = 0;
        for (const float number : numbers.values) selected += query.doi({&number, 1}, {}) >= 0.5 ? 1 : 0;
        EXPECT_EQ(selected, each.samples);
    }
}

} // namespace
} // namespace tessera::app
