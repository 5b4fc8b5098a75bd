#include "app/views/scatter3d/cloud_raster.h"
#include "tests/app/hands_fixture.h"

/// The cloud over three parameters: what it shows, how it is turned, and what a lasso in it selects.
namespace tessera::app {
namespace {

volume::PlaceCounts someCube(int bins) {
    volume::PlaceCounts cube{std::vector<std::uint64_t>(std::size_t(bins * bins * bins)), {}};
    for (std::size_t i = 0; i < cube.all.size(); ++i) cube.all[i] = i % 5 == 0 ? i % 11 : 0;
    return cube;
}

TEST(CloudRaster, HoldsAllSamplesFromAnySide) {
    const volume::PlaceCounts cube = someCube(6);
    double all = 0;
    for (const std::uint64_t count : cube.all) all += double(count);
    for (const glm::dvec2 turn : {glm::dvec2(0, 0), {-35, 25}, {90, 0}, {17, 90}, {-170, -40}}) {
        const CloudPlace place{{60, 60}, 55, cloudDirections(turn)};
        double sum = 0;
        for (const double each : rasterCloud(cube, 6, place, 120, 120).all) sum += each;
        EXPECT_NEAR(sum, all, all * 1e-9) << turn.x << " " << turn.y;
    }
}

TEST(CloudRaster, SeenAlongAnAxisIsTheScatterplotOfTheOthers) {
    const int bins = 6;
    const volume::PlaceCounts cube = someCube(bins);
    for (const auto& [turn, faced] : {std::pair{glm::dvec2(0, 0), std::array{0, 2}},
                                      {glm::dvec2(90, 0), std::array{1, 2}},
                                      {glm::dvec2(0, 90), std::array{0, 1}}}) {
        const CloudPlace place{{30, 30}, 60, cloudDirections(turn)};
        ASSERT_EQ(facedAxes(place.directions), faced);
        const GapDensity density = rasterCloud(cube, bins, place, 60, 60);
        for (int a = 0; a < bins; ++a)
            for (int b = 0; b < bins; ++b) {
                double expected = 0;
                for (int behind = 0; behind < bins; ++behind) {
                    int at[3];
                    at[faced[0]] = a, at[faced[1]] = b, at[3 - faced[0] - faced[1]] = behind;
                    expected += double(cube.all[std::size_t((at[0] * bins + at[1]) * bins + at[2])]);
                }
                const int column = a * 10 + 5, row = 59 - (b * 10 + 5); // the middle of ten pixels
                EXPECT_NEAR(density.all[std::size_t(row * 60 + column)], expected / 100, 1e-9) << a << " " << b;
            }
    }
    EXPECT_FALSE(facedAxes(cloudDirections({-35, 25})));
    EXPECT_FALSE(facedAxes(cloudDirections({180, 0}))) << "x runs to the left";
}

class CloudHands : public Hands {
protected:
    void showCloud(glm::dvec2 turn) {
        Scatter3dView cloud;
        cloud.channels = {"T", "|U|", "c"};
        cloud.bins = 24;
        cloud.turn = turn;
        show(cloud, {480, 420});
    }
    glm::dvec2 turn() { return view<Scatter3dView>().turn; }
};

TEST_F(CloudHands, ADragTurnsIt) {
    showCloud({-35, 25});
    const Session before = session();
    const ImRect cloud = inPane({"cloud"});
    drag(within(cloud, 0.4, 0.5), {within(cloud, 0.4, 0.5).x + 50, within(cloud, 0.4, 0.5).y + 20});
    EXPECT_NEAR(turn().x, -55, 1e-3);
    EXPECT_NEAR(turn().y, 33, 1e-3);
    EXPECT_TRUE(session().selection.brushes.empty());
    settle();
    EXPECT_EQ(steps(), 1u);
    undo();
    EXPECT_TRUE(session() == before) << apart(before);
}

TEST_F(CloudHands, WhereTwoAxesFaceTheViewerADragSelects) {
    showCloud({-35, 25});
    click(inPane({"xy"}).GetCenter());
    EXPECT_EQ(turn(), glm::dvec2(0, 90));
    settle();
    const ImRect cloud = inPane({"cloud"});
    const ImVec2 corners[] = {within(cloud, 0.4, 0.35), within(cloud, 0.6, 0.35), within(cloud, 0.6, 0.65),
                              within(cloud, 0.4, 0.65)};
    moveTo(corners[0]);
    button(0, true);
    for (const ImVec2 corner : corners) moveTo(corner);
    button(0, false);
    settle();
    ASSERT_EQ(session().selection.brushes.size(), 1u);
    const auto& lasso = std::get<vis::LassoRegion>(session().selection.brushes[0].region);
    EXPECT_EQ(lasso.x, "T");
    EXPECT_EQ(lasso.y, "|U|");
    EXPECT_EQ(turn(), glm::dvec2(0, 90)) << "it is not turned";
    // The lasso is a box around the middle of both axes, as wide as it was drawn.
    const Range t = formula::rangeOf("T");
    for (const glm::dvec2& point : lasso.points) {
        EXPECT_GT(point.x, t.lo + 0.1 * (t.hi - t.lo));
        EXPECT_LT(point.x, t.hi - 0.1 * (t.hi - t.lo));
    }
    EXPECT_NEAR((lasso.points[0].x + lasso.points[1].x) / 2, (t.lo + t.hi) / 2, 0.02 * (t.hi - t.lo));
    drag(within(cloud, 0.4, 0.5), {within(cloud, 0.4, 0.5).x + 50, within(cloud, 0.4, 0.5).y - 25}, 2);
    EXPECT_NEAR(turn().x, -20, 1e-3) << "the middle button turns";
    EXPECT_NEAR(turn().y, 80, 1e-3);
}

} // namespace
} // namespace tessera::app
