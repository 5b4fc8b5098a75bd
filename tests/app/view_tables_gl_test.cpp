#include "app/views/slices/slice_matrix.h"
#include "tests/app/formula_view.h"
#include "tests/app/table_text.h"

#include <gmock/gmock.h>
#include <map>
#include <set>

/// What views export, read back and compared with numbers computed from the formulas, for several times and selections.
namespace tessera::app {
namespace {

using formula::between;
using formula::Place;
using formula::Sum;
using formula::summed;
using testing::HasSubstr;
using testing::Not;

/// Times, with and without a brush of T, that every table is read at.
struct Case {
    double time = 0;
    std::optional<Range> brush; ///< of T
    bool inverted = false;
};

std::vector<Case> cases() {
    return {{0.5, {}}, {0, {}}, {2, {}}, {0.875, {}}, {0.5, Range{318.5, 1e9}}, {2, Range{340.2, 352.9}, true}};
}

/// Degree of interest of a sample.
double interest(const Case& of, Place at) {
    if (!of.brush) return 1;
    const double t = formula::valueAt("T", at, of.time).value();
    return (t >= of.brush->lo && t <= of.brush->hi) != of.inverted ? 1 : 0;
}

double correlation(const std::string& a, const std::string& b, double time) {
    double n = 0, sa = 0, sb = 0, aa = 0, bb = 0, ab = 0;
    formula::forEachPlace([&](Place at) {
        const auto x = formula::valueAt(a, at, time), y = formula::valueAt(b, at, time);
        if (!x || !y) return;
        const double u = *x - 300, v = *y, w = formula::cellShare(at);
        n += w, sa += w * u, sb += w * v, aa += w * u * u, bb += w * v * v, ab += w * u * v;
    });
    return (ab / n - sa / n * sb / n) / std::sqrt((aa / n - sa / n * sa / n) * (bb / n - sb / n * sb / n));
}

/// What plots reach over: the range of all times and a fiftieth of it beyond either end.
Range plotted(const std::string& channel) {
    const Range range = formula::rangeOf(channel);
    const double margin = 0.02 * (range.hi - range.lo);
    return {range.lo - margin, range.hi + margin};
}

class ViewTables : public FormulaView {
protected:
    TableText shownAt(const Case& of) {
        Session session = start;
        session.time = of.time;
        if (of.brush) {
            session.selection.brushes = {
                vis::rangeBrush({{.channel = "T", .lo = of.brush->lo, .hi = of.brush->hi}}, "warm")};
            session.selection.brushes[0].inverted = of.inverted;
        }
        return tableOf(table(session));
    }
};

TEST_F(ViewTables, StatisticsAreThoseOfTheSamples) {
    install(StatisticsView{});
    for (const Case& of : cases()) {
        SCOPED_TRACE(of.time);
        const TableText table = shownAt(of);
        ASSERT_EQ(table.rows.size(), of.brush ? 9u : 3u);
        for (std::size_t row = 0; row < table.rows.size(); ++row) {
            const std::string name = table.text(row, "parameter"), part = table.text(row, "region");
            EXPECT_EQ(table.text(row, "unit"), name == "T" ? "K" : name == "c" ? "mol/m3" : "m/s");
            const Sum sum = summed(name, of.time, [&](Place at) {
                return part == "all" || (part == (of.inverted ? "not warm" : "warm")) == (interest(of, at) == 1);
            });
            SCOPED_TRACE(name + " " + part);
            EXPECT_GT(sum.samples, 0);
            EXPECT_EQ(table.number(row, "samples"), sum.samples);
            EXPECT_NEAR(*table.number(row, "mean"), sum.mean, 2e-4);
            EXPECT_NEAR(*table.number(row, "deviation"), sum.deviation, 2e-4);
            EXPECT_NEAR(*table.number(row, "min"), sum.least, 2e-4);
            EXPECT_NEAR(*table.number(row, "max"), sum.most, 2e-4);
            if (part == "all" && name == "T") {
                EXPECT_NEAR(*table.number(row, "volume [m3]"), 7e-3 * 12e-3 * 4e-3, 1e-12) << "of the whole box";
                EXPECT_NEAR(*table.number(row, "correlation with c"), correlation("T", "c", of.time), 1e-3);
            }
        }
    }
}

TEST_F(ViewTables, RegionsAreCountedEachByItself) {
    StatisticsView view;
    view.byRegion = true;
    install(view);
    for (const Case& of : cases()) {
        SCOPED_TRACE(of.time);
        const TableText table = shownAt(of);
        ASSERT_EQ(table.rows.size(), 8u); // T and |U| in west, east, all; c in west and all
        for (std::size_t row = 0; row < table.rows.size(); ++row) {
            const std::string name = table.text(row, "parameter"), region = table.text(row, "region");
            SCOPED_TRACE(name + " " + region);
            const Sum sum =
                summed(name, of.time, [&](Place at) { return region == "all" || (region == "west") == (at.x < 4); });
            EXPECT_EQ(table.number(row, "samples"), sum.samples);
            EXPECT_NEAR(*table.number(row, "mean"), sum.mean, 2e-4);
            EXPECT_NEAR(*table.number(row, "min"), sum.least, 2e-4);
            EXPECT_NEAR(*table.number(row, "max"), sum.most, 2e-4);
            EXPECT_NEAR(*table.number(row, "shareOfAll"), sum.samples / (8 * 7 * 9), 1e-9);
        }
    }
}

TEST_F(ViewTables, RegionsAreCountedWithinTheSelection) {
    StatisticsView view;
    view.byRegion = view.selected = true;
    install(view);
    for (const Case& of : cases()) {
        SCOPED_TRACE(of.time);
        const TableText table = shownAt(of);
        const std::string whole = !of.brush ? "all" : of.inverted ? "not warm" : "warm";
        std::set<std::string> named;
        for (std::size_t row = 0; row < table.rows.size(); ++row) {
            const std::string name = table.text(row, "parameter"), region = table.text(row, "region");
            SCOPED_TRACE(name + " " + region);
            named.insert(region);
            const auto in = [&](Place at) {
                return interest(of, at) == 1 && (region == whole || (region == "west") == (at.x < 4));
            };
            const Sum sum = summed(name, of.time, in);
            EXPECT_EQ(table.number(row, "samples"), sum.samples);
            EXPECT_NEAR(*table.number(row, "mean"), sum.mean, 2e-4);
            EXPECT_NEAR(*table.number(row, "min"), sum.least, 2e-4);
            EXPECT_NEAR(*table.number(row, "max"), sum.most, 2e-4);
            EXPECT_NEAR(*table.number(row, "shareOfAll"), sum.samples / (8 * 7 * 9), 1e-9);
        }
        EXPECT_TRUE(named.contains(whole));
        EXPECT_GE(named.size(), 2u);
    }
}

TEST_F(ViewTables, ExportsStateHowTheSelectionIsDefined) {
    StatisticsView view;
    install(view);
    Session session = start;
    session.time = 0.5;
    session.selection.brushes = {vis::rangeBrush({{.channel = "T", .lo = 318.5, .hi = 341.25, .soft = 2}}, "warm")};
    std::string csv = table(session);
    EXPECT_THAT(csv, HasSubstr("# selection \"warm\": T 318.5 .. 341.25 K (soft edge 2 K)\n"));
    EXPECT_THAT(csv, HasSubstr("weightedSamples")) << "a soft edge counts parts of samples";
    EXPECT_THAT(csv, HasSubstr("at t = 0.5"));
    EXPECT_THAT(csv, Not(HasSubstr("inside")));
    session.selection.brushes[0].region =
        vis::BoxRegion{.center = {0.012, 0.004, -0.001}, .radius = {0.002, 0.003, 0.0005}};
    session.selection.brushes.push_back(vis::rangeBrush({{.channel = "T", .lo = 0, .hi = 341.25}}, "cool"));
    session.selection.brushes[1].combine = vis::BrushCombine::Minus;
    csv = table(session);
    EXPECT_THAT(csv, HasSubstr("# selection \"warm without cool\"\n"));
    EXPECT_THAT(csv, HasSubstr("# brush \"warm\": box 4 \u00d7 6 \u00d7 1 mm around x 12, y 4, z -1 mm\n"));
    EXPECT_THAT(csv, HasSubstr("# brush \"cool\": T 0 .. 341.25 K\n"));
    EXPECT_THAT(csv, HasSubstr("not (warm without cool)"));
    session.selection.name = "hot spot";
    csv = table(session);
    EXPECT_THAT(csv, HasSubstr("# selection \"hot spot\": warm without cool\n"));
    EXPECT_THAT(csv, HasSubstr(",not hot spot,"));
    EXPECT_THAT(csv, HasSubstr(",samples,")) << "whole ones";
}

TEST_F(ViewTables, HistogramsCountEachSampleInItsBin) {
    for (const char* channel : {"T", "c"}) {
        HistogramView view;
        view.channel = channel;
        view.bins = 37;
        install(view);
        const Range range = plotted(channel);
        for (const Case& of : cases()) {
            SCOPED_TRACE(std::string(channel) + " at " + std::to_string(of.time));
            const TableText table = shownAt(of);
            const std::string unit = channel == std::string("T") ? "K" : "mol/m3";
            ASSERT_EQ(table.rows.size(), 37u);
            std::vector<double> count(37), focus(37);
            formula::forEachPlace([&](Place at) {
                const auto v = formula::valueAt(channel, at, of.time);
                if (!v) return;
                const auto bin = std::min(36, int((*v - range.lo) / (range.hi - range.lo) * 37));
                count[std::size_t(bin)] += 1;
                focus[std::size_t(bin)] += interest(of, at);
            });
            for (std::size_t i = 0; i < 37; ++i) {
                EXPECT_EQ(table.text(i, "parameter"), channel);
                EXPECT_NEAR(*table.number(i, "from [" + unit + "]"), range.lo + (range.hi - range.lo) * double(i) / 37,
                            1e-6 * range.hi);
                EXPECT_EQ(table.number(i, "samples"), count[i]) << i;
                if (of.brush) {
                    EXPECT_NEAR(*table.number(i, of.inverted ? "samples in not warm" : "samples in warm"), focus[i],
                                1e-6)
                        << i;
                }
            }
        }
    }
}

TEST_F(ViewTables, ScatterplotsCountPairsInTheirBins) {
    ScatterMatrixView view;
    view.channels = {"T", "c"};
    view.bins = 19;
    install(view);
    const Range t = plotted("T"), c = plotted("c");
    for (const Case& of : cases()) {
        SCOPED_TRACE(of.time);
        std::map<std::pair<int, int>, std::pair<double, double>> wanted;
        formula::forEachPlace([&](Place at) {
            const auto x = formula::valueAt("T", at, of.time), y = formula::valueAt("c", at, of.time);
            if (!x || !y) return;
            const auto bin = [](double v, Range range) {
                return std::min(18, int((v - range.lo) / (range.hi - range.lo) * 19));
            };
            auto& [count, focus] = wanted[{bin(*x, t), bin(*y, c)}];
            count += 1, focus += interest(of, at);
        });
        const TableText table = shownAt(of);
        EXPECT_EQ(table.rows.size(), wanted.size());
        for (std::size_t row = 0; row < table.rows.size(); ++row) {
            EXPECT_EQ(table.text(row, "x parameter") + table.text(row, "x unit"), "TK");
            EXPECT_EQ(table.text(row, "y parameter") + table.text(row, "y unit"), "cmol/m3");
            const auto bin = [&](const char* head, Range range) {
                return int((*table.number(row, head) - range.lo) / (range.hi - range.lo) * 19);
            };
            const auto found = wanted.find({bin("x", t), bin("y", c)});
            ASSERT_NE(found, wanted.end()) << row;
            EXPECT_EQ(table.number(row, "samples"), found->second.first);
            if (of.brush) {
                EXPECT_NEAR(*table.number(row, of.inverted ? "samples in not warm" : "samples in warm"),
                            found->second.second, 1e-6);
            }
        }
    }
}

TEST_F(ViewTables, ProfilesAreReadAlongTheirLine) {
    ProfileView view;
    view.channels = {"T", "c"};
    view.samples = 33;
    view.points = {{0.0101, 0.0007, -0.0018}, {0.0168, 0.0113, 0.0019}};
    install(view);
    for (const Case& of : cases()) {
        SCOPED_TRACE(of.time);
        const TableText table = shownAt(of);
        ASSERT_EQ(table.rows.size(), 33u);
        const double length = glm::distance(view.points[0], view.points[1]);
        for (std::size_t i = 0; i < 33; ++i) {
            const double along = double(i) / 32;
            const glm::dvec3 at = glm::mix(view.points[0], view.points[1], along);
            EXPECT_NEAR(*table.number(i, "distance [m]"), length * along, 1e-9);
            for (int axis = 0; axis < 3; ++axis)
                EXPECT_NEAR(*table.number(i, std::string(1, "xyz"[axis]) + " [m]"), at[axis], 1e-9);
            EXPECT_NEAR(*table.number(i, "T [K]"), between("T", at, of.time), 3e-4);
            if (at.x < 0.0129) {
                EXPECT_NEAR(*table.number(i, "c [mol/m3]"), between("c", at, of.time), 3e-5);
            } else if (at.x > 0.0136) {
                EXPECT_FALSE(table.number(i, "c [mol/m3]"));
            }
        }
    }
}

TEST_F(ViewTables, ProfilesOverTimeAreReadAtTheCursor) {
    ProfileView view;
    view.channels = {"T"};
    view.over = ProfileOver::Time;
    install(view);
    Session session = start;
    session.cursor = {0.0137, 0.0066, 0.0003};
    const TableText table = tableOf(this->table(session));
    ASSERT_EQ(table.rows.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(table.number(i, "time [s]"), formula::kTimes[i]);
        EXPECT_NEAR(*table.number(i, "T [K]"), between("T", session.cursor, formula::kTimes[i]), 3e-4);
    }
}

TEST_F(ViewTables, SectionsAreOfTheirPlaneAndRegion) {
    ProfileView view;
    view.channels = {"T", "c"};
    view.over = ProfileOver::Sections;
    view.sections.across = SectionAcross::Z;
    install(view);
    for (const Case& of : cases()) {
        SCOPED_TRACE(of.time);
        const TableText table = shownAt(of);
        std::size_t checked = 0;
        for (std::size_t row = 0; row < table.rows.size(); ++row) {
            EXPECT_NEAR(*table.number(row, "time [s]"), of.time, 1e-9);
            const double place = *table.number(row, "z [m]");
            const std::string region = table.text(row, "region"), name = table.text(row, "parameter");
            const Sum sum = summed(name, of.time, [&](Place at) {
                const double z = formula::kOrigin[2] + formula::kSpacing[2] * at.z;
                const bool inside = region.starts_with("west")   ? at.x < 4
                                    : region.starts_with("east") ? at.x >= 4
                                                                 : true;
                return std::abs(z - place) < 1e-9 && inside && interest(of, at) == 1;
            });
            SCOPED_TRACE(name + " " + region + " " + std::to_string(place));
            EXPECT_NEAR(*table.number(row, "samples"), sum.samples, 1e-6);
            if (sum.samples == 0) continue;
            EXPECT_NEAR(*table.number(row, "min"), sum.least, 2e-4);
            EXPECT_NEAR(*table.number(row, "max"), sum.most, 2e-4);
            ++checked;
        }
        EXPECT_GE(checked, of.brush ? 9u : 27u);
    }
}

/// A place in a row of a table of planes, metres; the rows have 9 digits of millimetres.
glm::dvec3 placeIn(const TableText& table, std::size_t row) {
    return glm::dvec3(*table.number(row, "x [mm]"), *table.number(row, "y [mm]"), *table.number(row, "z [mm]")) /
           1000.0;
}

TEST_F(ViewTables, PlanesAreReadWhereTheyStand) {
    SliceMatrixView view;
    view.channels = {"T"};
    view.planes = 2;
    install(view);
    for (const Case& of : cases()) {
        SCOPED_TRACE(of.time);
        const TableText table = shownAt(of);
        ASSERT_GT(table.rows.size(), 1000u);
        for (const std::size_t row : {std::size_t(0), std::size_t(1), table.rows.size() / 3, table.rows.size() - 1}) {
            const glm::dvec3 at = placeIn(table, row);
            EXPECT_NEAR(*table.number(row, "T [K]"), between("T", at, of.time), 3e-4) << row;
        }
    }
}

TEST_F(ViewTables, SlicesOfSeveralTimesAreReadAtEachOfThem) {
    SliceMatrixView view;
    view.channels = {"T"};
    view.columns = MatrixAxis::Times;
    view.times = 2; // the first and the last of three
    install(view);
    const TableText table = shownAt({0.5, {}});
    std::set<double> times;
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        const double time = *table.number(row, "time [s]");
        times.insert(time);
        const glm::dvec3 at = placeIn(table, row);
        EXPECT_NEAR(at.z, start.cursor.z, 1e-11) << "through the cross-hair";
        if (row % 53 == 0) {
            EXPECT_NEAR(*table.number(row, "T [K]"), between("T", at, time), 3e-4) << row;
        }
    }
    EXPECT_EQ(times, (std::set<double>{formula::kTimes[0], formula::kTimes[2]}));
}

TEST_F(ViewTables, ASliceMatrixDiffersInWhatIsChosen) {
    install(SliceMatrixView{});
    const Session session = start;
    const volume::DatasetInfo& info = workbench.document().info();
    const std::vector<int> channels{*info.findChannel("T"), *info.findChannel("c")};
    const auto of = [&](MatrixAxis rows, MatrixAxis columns) {
        SliceMatrixView view;
        view.rows = rows, view.columns = columns, view.planes = 5, view.times = 24;
        return sliceMatrix(session, info, view, channels);
    };
    const std::map<MatrixAxis, int> counts{
        {MatrixAxis::Parameters, 2}, {MatrixAxis::Directions, 3}, {MatrixAxis::Positions, 5}, {MatrixAxis::Times, 3}};
    for (const auto& [rows, high] : counts)
        for (const auto& [columns, wide] : counts) {
            const SliceMatrix matrix = of(rows, columns);
            ASSERT_EQ(matrix.rows, rows == columns ? 1 : high);
            ASSERT_EQ(matrix.columns, wide);
            ASSERT_EQ(matrix.pictures.size(), std::size_t(matrix.rows * matrix.columns));
            EXPECT_EQ(matrix.rowNames.size(), std::size_t(matrix.rows));
            EXPECT_EQ(std::set<std::string>(matrix.columnNames.begin(), matrix.columnNames.end()).size(),
                      std::size_t(wide))
                << "each column is called differently";
        }
    const SliceMatrix matrix = of(MatrixAxis::Directions, MatrixAxis::Times);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) {
            const PlanePicture& slice = matrix.at(row, column);
            EXPECT_EQ(slice.axes->normal, row);
            EXPECT_EQ(slice.ownTime, formula::kTimes[column]);
            EXPECT_NEAR(slice.placeAt({0, 0})[row], session.cursor[row], 1e-12);
            EXPECT_EQ(slice.shows.channel, channels[0]);
        }
    // "c" is missing in the east, and at no plane of T.
    const volume::BrickSource& source = *workbench.source();
    SliceMatrixView across;
    across.axis = volume::SpaceAxis::X;
    across.planes = 8;
    const SliceMatrix planes = sliceMatrix(session, info, across, channels);
    int empty = 0;
    for (int column = 0; column < across.planes; ++column) {
        EXPECT_TRUE(showsValues(source, planes.at(0, column)));
        empty += showsValues(source, planes.at(1, column)) ? 0 : 1;
    }
    EXPECT_TRUE(empty >= 2 && empty <= 6) << empty;
    EXPECT_TRUE(showsValues(source, planes.at(1, 0))) << "the west has it";
    EXPECT_FALSE(showsValues(source, planes.at(1, across.planes - 1)));
}

TEST_F(ViewTables, ThreeSlicesAreReadAtTheCrossHair) {
    SlicesView view;
    view.channel = "c";
    install(view);
    for (const Case& of : cases()) {
        SCOPED_TRACE(of.time);
        const TableText table = shownAt(of);
        EXPECT_EQ(table.heads, (std::vector<std::string>{"plane", "x [mm]", "y [mm]", "z [mm]", "T [K]", "c [mol/m3]",
                                                         "|U| [m/s]"}));
        std::map<std::string, glm::dvec3> least, most; // of each plane
        std::size_t absent = 0, present = 0;
        for (std::size_t row = 0; row < table.rows.size(); ++row) {
            const glm::dvec3 at = placeIn(table, row);
            const std::string plane = table.text(row, "plane");
            least.try_emplace(plane, at), most.try_emplace(plane, at);
            least[plane] = glm::min(least[plane], at), most[plane] = glm::max(most[plane], at);
            const auto c = table.number(row, "c [mol/m3]");
            const double x = (at.x - formula::kOrigin[0]) / formula::kSpacing[0];
            if (x < 3) {
                ASSERT_TRUE(c) << row;
                if (row % 97 == 0) {
                    EXPECT_NEAR(*c, between("c", at, of.time), 3e-4) << row;
                }
            } else if (x > 4) {
                EXPECT_FALSE(c) << "absent in the east: " << row;
            }
            (c ? present : absent) += 1;
            if (row % 97 == 0) {
                EXPECT_NEAR(*table.number(row, "T [K]"), between("T", at, of.time), 3e-4) << row;
            }
        }
        EXPECT_GT(present, 100u);
        EXPECT_GT(absent, 100u);
        ASSERT_EQ(least.size(), 3u);
        const std::map<std::string, int> normals{{"x = 12.30 mm", 0}, {"y = 4.1 mm", 1}, {"z = -0.90 mm", 2}};
        for (const auto& [plane, normal] : normals) {
            ASSERT_TRUE(least.contains(plane)) << least.begin()->first << ", " << least.rbegin()->first;
            for (int axis = 0; axis < 3; ++axis) {
                const double lo = formula::kOrigin[axis],
                             hi = lo + formula::kSpacing[axis] * (formula::kSize[axis] - 1);
                const double place = start.cursor[axis];
                EXPECT_NEAR(least[plane][axis], axis == normal ? place : lo, 1e-11) << plane;
                EXPECT_NEAR(most[plane][axis], axis == normal ? place : hi, 1e-11) << plane;
            }
        }
    }
}

TEST_F(ViewTables, EveryViewOfPlanesHasTheSameValueAtAPlace) {
    SliceMatrixView matrix;
    matrix.channels = {"T"};
    matrix.planes = 3;
    ObliqueView across;
    across.normal = {0, 0, 1};
    for (const ViewState& view : {ViewState(SlicesView{}), ViewState(matrix), ViewState(across)}) {
        install(view);
        start.cursor.z = formula::kOrigin[2] + formula::kSpacing[2] * 4; // that of the second of three planes
        const TableText table = shownAt({0.875, {}});
        std::size_t found = 0;
        for (std::size_t row = 0; row < table.rows.size(); ++row) {
            const glm::dvec3 at = placeIn(table, row);
            if (std::abs(at.z - start.cursor.z) > 1e-11) continue;
            ++found;
            ASSERT_NEAR(*table.number(row, "T [K]"), between("T", at, 0.875), 3e-4) << row;
        }
        EXPECT_GT(found, 3000u) << view.index();
    }
}

TEST_F(ViewTables, CurvesAreStatisticsOfEveryTime) {
    CurvesView view;
    view.x = "time";
    view.y = {"mean(T)", "max(T)", "voltage * current"};
    install(view);
    const TableText table = shownAt({0.5, {}});
    ASSERT_EQ(table.rows.size(), 3u);
    constexpr double kPower[] = {4200, 5580, 8500};
    for (std::size_t i = 0; i < 3; ++i) {
        const Sum sum = summed("T", formula::kTimes[i], [](Place) { return true; });
        EXPECT_EQ(table.number(i, "time [s]"), formula::kTimes[i]);
        EXPECT_NEAR(*table.number(i, "mean(T) [K]"), sum.mean, 2e-4);
        EXPECT_NEAR(*table.number(i, "max(T) [K]"), sum.most, 2e-4);
        EXPECT_NEAR(std::stod(table.rows[i].back()), kPower[i], 1e-6) << table.heads.back();
    }
}

} // namespace
} // namespace tessera::app
