// Data with uneven axes in the whole workbench.
#include "app/data/open.h"
#include "app/data/picture_lattice.h"
#include "app/data/sources.h"
#include "tests/app/workbench_fixture.h"
#include "volume/analysis/statistics.h"

#include <gtest/gtest.h>

namespace tessera::app {
namespace {

class UnevenData : public DrawnWorkbench {
protected:
    Opened membrane() {
        DataRef data;
        data.model = "membrane";
        return open({.paths = {}, .layout = {}, .data = data, .import = {}});
    }
    static volume::Summary ofT(const volume::BrickSource& source) {
        volume::StatisticsQuery query;
        query.channels = {source.info().findChannel("T").value()};
        return volume::computeStatistics(source, query).channels[0].all;
    }
};

TEST_F(UnevenData, PicturesToScaleAreAStepOfTheHistory) {
    workbench.install(membrane());
    settle();
    const auto numbers = workbench.numbers();
    ASSERT_FALSE(numbers->info().lattice.isEven());
    EXPECT_EQ(workbench.session().data.lattice, PictureLattice::Grid) << "a membrane is thin: by cells";
    EXPECT_EQ(workbench.source(), numbers);
    const volume::Box box = numbers->info().bounds;
    const volume::Summary before = ofT(*workbench.numbers());

    ASSERT_TRUE(run("Draw grids with uneven spacing to scale"));
    settle();
    EXPECT_EQ(workbench.session().data.lattice, PictureLattice::Even);
    EXPECT_TRUE(workbench.source()->info().lattice.isEven());
    EXPECT_EQ(workbench.source()->info().bounds, box);
    EXPECT_EQ(workbench.numbers(), numbers) << "numbers stay those of the file";
    EXPECT_NEAR(ofT(*workbench.source()).mean, before.mean, 0.01);

    // A formula is computed from the samples of the file, and drawn to scale as all else.
    workbench.session().data.derived = {{"twice", "", volume::ExpressionRecipe{"2*T"}}};
    settle();
    EXPECT_TRUE(workbench.source()->info().lattice.isEven());
    EXPECT_FALSE(workbench.numbers()->info().lattice.isEven());
    EXPECT_TRUE(workbench.source()->info().findChannel("twice").has_value());

    while (run("Undo")) settle();
    EXPECT_EQ(workbench.session().data.lattice, PictureLattice::Grid);
    EXPECT_FALSE(workbench.source()->info().lattice.isEven());
}

TEST_F(UnevenData, MildGradingsAreDrawnToScaleFirst) {
    volume::DatasetInfo info;
    info.lattice.size = glm::ivec3(4);
    const auto graded = [&](std::vector<double> planes) {
        volume::DatasetInfo out = info;
        volume::AxisMaps axes;
        axes.of[2] = std::make_shared<const volume::AxisMap>(volume::AxisMap::Of::Cells, std::move(planes));
        out.lattice = volume::withAxes(info.lattice, axes);
        return out;
    };
    EXPECT_EQ(firstLattice(PictureLattice::BodyCentred, info), PictureLattice::BodyCentred);
    EXPECT_EQ(firstLattice(PictureLattice::BodyCentred, graded({0, 1, 3, 6})), PictureLattice::Even);
    EXPECT_EQ(firstLattice(PictureLattice::BodyCentred, graded({0, 1, 9, 20})), PictureLattice::Grid);
    volume::DatasetInfo elsewhere = graded({0, 1, 3, 6});
    elsewhere.remote = true;
    EXPECT_EQ(firstLattice(PictureLattice::BodyCentred, elsewhere), PictureLattice::Grid);
}

} // namespace
} // namespace tessera::app
