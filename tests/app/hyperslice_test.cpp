#include "app/drawing/drawing.h"
#include "app/pane/view_parts.h"
#include "app/session/session_json.h"
#include "app/views/hyperslice/hyper_page.h"
#include "vis/optics/ray_setup.h"
#include "volume/reconstruct/probe.h"
#include "volume/sources/memory_source.h"

#include <cmath>
#include <glm/common.hpp>
#include <gtest/gtest.h>
#include <random>

/// Matrices of slices through space and time: which values they show where.
namespace tessera::app {
namespace {

constexpr glm::ivec3 kSize{6, 5, 7};
const std::vector<double> kHyperTimes{0, 0.3, 2, 2.5};
const std::vector<double> kBorders{0, 0.1, 0.15, 0.4, 1.1, 1.2, 2, 3.7}; ///< of cells along z, mm

float formulaOf(int parameter, glm::ivec3 at, int time) {
    const double t = kHyperTimes[std::size_t(time)];
    if (parameter == 1) return float(at.x * at.y - at.z * (1 + t));
    return float(300 + 7.3 * at.x + 2.1 * at.y * (1 + t) - at.z * at.z * 0.7 + 11 * t * at.x);
}
bool missing(int parameter, glm::ivec3 at, int time) {
    return parameter == 0 && (at.x + 2 * at.y + 3 * at.z + 5 * time) % 7 == 0;
}

/// "A" with gaps, and "B"; x and y are even, z is not.
volume::Dataset hyperData(std::size_t times = kHyperTimes.size(), glm::ivec3 size = kSize) {
    volume::Dataset data;
    volume::DatasetInfo& info = data.info;
    info.lengthUnit = "mm";
    info.lattice.size = size;
    info.lattice.spacing = {0.5, 0.25, 1};
    info.lattice.origin = {1, -2, 0};
    info.bounds = {info.lattice.origin, info.lattice.origin + info.lattice.spacing * glm::dvec3(size - 1)};
    if (size == kSize) {
        const auto map = std::make_shared<const volume::AxisMap>(volume::AxisMap::Of::Cells, kBorders);
        info.lattice = volume::withAxes(info.lattice, {{nullptr, nullptr, map}});
        info.bounds.lo.z = map->lo(), info.bounds.hi.z = map->hi();
    }
    info.times = {kHyperTimes.begin(), kHyperTimes.begin() + std::ptrdiff_t(times)};
    const auto quantity = [&](const char* name, std::vector<double> values) {
        values.resize(times);
        info.quantities.push_back({name, "V", std::move(values)});
    };
    quantity("falling", {0.9, 0.7, 0.65, 0.2});
    quantity("both", {0.9, 0.7, 0.75, 0.2});
    quantity("unknown", {0.9, std::nan(""), 0.6, 0.2});
    for (const char* name : {"A", "B"}) {
        volume::Parameter& made = info.parameters.emplace_back();
        made.name = name, made.unit = "K";
        made.ranges = {name[0] == 'A' ? Range{250, 500} : Range{-25, 20}};
    }
    data.read = [lattice = info.lattice](int parameter, int, int time) {
        volume::Field field = volume::makeField(lattice, volume::ScalarType::F32);
        auto mask = std::make_shared<volume::Mask>(field.count(), std::uint8_t(1));
        std::size_t i = 0;
        for (int z = 0; z < lattice.size.z; ++z)
            for (int y = 0; y < lattice.size.y; ++y)
                for (int x = 0; x < lattice.size.x; ++x, ++i) {
                    field.as<float>()[i] = formulaOf(parameter, {x, y, z}, time);
                    if (missing(parameter, {x, y, z}, time)) (*mask)[i] = 0;
                }
        if (parameter == 0) field.mask = std::move(mask);
        return field;
    };
    return data;
}

class HyperSlices : public testing::Test {
protected:
    HyperSlices() : source(volume::makeMemorySource(hyperData(), {.brickSize = 4})), info(source->info()) {
        session.cursor = {2.1, -1.4, 0.7};
        session.time = 1.1;
    }
    std::vector<HyperAxis> axes(std::vector<std::string> names = {}) {
        view.axes = std::move(names);
        return axesOfView(view, session, info);
    }
    /// The parameter at a place and time, NaN where it is absent.
    double probed(int channel, glm::dvec3 at, double time) const {
        return volume::probe(*source, at, volume::timesAround(info.times, time))[std::size_t(channel)]
            .interpolated.value_or(std::nan(""));
    }
    double random(double lo, double hi) { return std::uniform_real_distribution(lo, hi)(engine); }

    std::shared_ptr<const volume::BrickSource> source;
    volume::DatasetInfo info;
    Session session;
    HyperSliceView view;
    std::mt19937 engine{11};
};

void expectSame(double a, double b) {
    if (std::isnan(a) || std::isnan(b))
        EXPECT_EQ(std::isnan(a), std::isnan(b));
    else
        EXPECT_NEAR(a, b, 1e-9 * std::max(1.0, std::abs(b)));
}

TEST_F(HyperSlices, HaveTheAxesThatTheDataHave) {
    const auto keys = [](const std::vector<HyperAxis>& found) {
        std::string out;
        for (const HyperAxis& axis : found) out += axis.key + " ";
        return out;
    };
    EXPECT_EQ(keys(axes()), "x y z time ");
    EXPECT_EQ(keys(possibleAxes(session, info)), "x y z time falling ") << "others have no place for each value";
    EXPECT_EQ(keys(axes({"falling", "x", "time", "x", "none", "both"})), "falling x ") << "one of time";
    EXPECT_EQ(keys(axes({"none"})), "x y z time ");
    info = hyperData(1).info;
    EXPECT_EQ(keys(axes()), "x y z ");
    info = hyperData(4, {6, 1, 7}).info;
    EXPECT_EQ(keys(axes()), "x z time ");
    info = hyperData(1, {1, 1, 1}).info;
    EXPECT_EQ(keys(axes()), "");
}

TEST_F(HyperSlices, PlacesOfQuantitiesAreThoseOfTimes) {
    const HyperAxis falling = axes({"falling"}).at(0);
    EXPECT_EQ(falling.whole, (Range{0.2, 0.9}));
    const volume::AxisMaps& maps = info.lattice.axes;
    EXPECT_EQ(falling.along.at(0.9, maps), 0);
    EXPECT_EQ(falling.along.at(0.2, maps), 2.5);
    EXPECT_NEAR(falling.along.at(0.675, maps), 1.15, 1e-12) << "half way from 0.3 to 2";
    for (const double time : {0.0, 0.1, 0.3, 1.15, 2.4, 2.5})
        EXPECT_NEAR(falling.along.at(falling.along.placeOf(time, maps), maps), time, 1e-12);
}

// Every pair of axes, any part of them, any cross-hair, between samples and times.
TEST_F(HyperSlices, EveryPanelHasTheValuesOfProbes) {
    int absent = 0, present = 0;
    for (int round = 0; round < 40; ++round) {
        for (int k = 0; k < 3; ++k) session.cursor[k] = random(info.bounds.lo[k], info.bounds.hi[k]);
        session.time = round % 3 == 0 ? kHyperTimes[std::size_t(round) % 4] : random(0, 2.5);
        view.zoom.clear();
        for (const HyperAxis& axis : possibleAxes(session, info))
            if (round % 2 == 1) {
                const double from = random(axis.whole.lo, axis.whole.hi), to = random(axis.whole.lo, axis.whole.hi);
                showPart(view, axis, {std::min(from, to), std::max(from, to)});
            }
        const std::vector<HyperAxis> all = axes({"x", "y", "z", round % 4 < 2 ? "time" : "falling"});
        for (const HyperAxis& across : all)
            for (const HyperAxis& up : all) {
                if (&across == &up) continue;
                const HyperValues panel = readPanel(*source, panelQuery(across, up, {0, 1}, {9, 7}, session, info));
                for (int n = 0; n < 12; ++n) {
                    const glm::ivec2 cell(int(random(0, 9)), int(random(0, 7)));
                    glm::dvec3 at = session.cursor;
                    double time = session.time;
                    const auto place = [&](const HyperAxis& axis, double share) {
                        const double along = axis.shown.lo + (axis.shown.hi - axis.shown.lo) * share;
                        if (axis.key == "x") at.x = along;
                        if (axis.key == "y") at.y = along;
                        if (axis.key == "z") at.z = info.lattice.axes[2]->toSpace(along);
                        if (axis.key == "time") time = along;
                        if (axis.key == "falling") { // by its table
                            const std::vector<double> volts{0.9, 0.7, 0.65, 0.2};
                            std::size_t i = 0;
                            while (i < 2 && along < volts[i + 1]) ++i;
                            time = kHyperTimes[i] + (kHyperTimes[i + 1] - kHyperTimes[i]) * (along - volts[i]) /
                                                        (volts[i + 1] - volts[i]);
                        }
                    };
                    place(across, (cell.x + 0.5) / 9);
                    place(up, (cell.y + 0.5) / 7);
                    for (const int channel : {0, 1}) {
                        const double value = panel.at(std::size_t(channel), cell);
                        expectSame(value, probed(channel, at, time));
                        std::isnan(value) ? ++absent : ++present;
                    }
                }
            }
    }
    EXPECT_GT(absent, 300) << "there are gaps";
    EXPECT_GT(present, 3000);
}

TEST_F(HyperSlices, ProfilesAreExactAtStoredTimesAndStraightBetween) {
    const glm::ivec3 sample{3, 2, 4};
    session.cursor = info.lattice.position(sample);
    const HyperAxis time = axes({"time"}).at(0);
    const ProfileAlong over = readProfileAlong(*source, profileAlongQuery(time, 1, 9, session, info));
    ASSERT_EQ(over.points.size(), 4u);
    for (int t = 0; t < 4; ++t) {
        EXPECT_EQ(over.points[std::size_t(t)].x, kHyperTimes[std::size_t(t)]);
        EXPECT_NEAR(over.points[std::size_t(t)].y, double(formulaOf(1, sample, t)), 1e-9);
    }
    for (const char* name : {"x", "y", "z"}) {
        const HyperAxis axis = axes({name}).at(0);
        for (const auto& point : readProfileAlong(*source, profileAlongQuery(axis, 0, 33, session, info)).points) {
            glm::dvec3 at = session.cursor;
            const int k = axis.along.dimension;
            at[k] = std::clamp(info.lattice.axes.toSpace(k, point.x), info.bounds.lo[k], info.bounds.hi[k]);
            expectSame(point.y, probed(0, at, session.time));
        }
    }
}

// What is dragged in a panel makes no other picture of it, and another one of each panel that it is across.
TEST_F(HyperSlices, AnswersDependOnWhatIsAcrossAlone) {
    const std::vector<HyperAxis> all = axes();
    const auto queries = [&] {
        std::vector<HyperQuery> out;
        for (std::size_t row = 0; row < 4; ++row)
            for (std::size_t column = 0; column < row; ++column)
                out.push_back(panelQuery(all[column], all[row], {0}, {8, 8}, session, info));
        return out;
    };
    const std::vector<HyperQuery> before = queries(); // xy xz yz xt yt zt
    goToPlace(all[0], 3.2, session, info);
    goToPlace(all[3], 2.2, session, info);
    EXPECT_EQ(session.cursor, glm::dvec3(3.2, -1.4, 0.7));
    EXPECT_EQ(session.time, 2.2);
    const std::vector<HyperQuery> after = queries();
    for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(after[i] == before[i], i == 3) << i;
}

TEST_F(HyperSlices, PartsAreKeptInTheNumbersOfTheirAxis) {
    const HyperAxis z = axes({"z"}).at(0);
    showPart(view, z, {z.along.placeOf(0.4, info.lattice.axes), z.along.placeOf(2, info.lattice.axes)});
    EXPECT_NEAR(view.zoom.at("z").lo, 0.4, 1e-12) << "in space, not by cells";
    EXPECT_NEAR(view.zoom.at("z").hi, 2, 1e-12);
    const HyperAxis shown = axes({"z"}).at(0);
    EXPECT_TRUE(shown.zoomed());
    EXPECT_NEAR(shown.shown.lo, z.along.placeOf(0.4, info.lattice.axes), 1e-12);
    const Range part = zoomedPart(shown, shown.shown.lo, 0.5, 0);
    EXPECT_EQ(part.lo, shown.shown.lo) << "about a place, which stays where it is";
    EXPECT_NEAR(part.hi - part.lo, (shown.shown.hi - shown.shown.lo) / 2, 1e-12);
    EXPECT_EQ(zoomedPart(shown, 0, 1, 1e9).hi, z.whole.hi) << "never beyond the data";
    showPart(view, z, zoomedPart(shown, 0, 1e9, 0));
    EXPECT_TRUE(view.zoom.empty()) << "all of it is no part";
    showPart(view, z, {1, 1});
    EXPECT_TRUE(view.zoom.empty());
}

TEST_F(HyperSlices, AreKeptInTheSession) {
    view.channel = "B";
    view.axes = {"x", "z", "falling"};
    view.zoom = {{"z", {0.25, 1.5}}, {"falling", {0.3, 0.6}}};
    view.lines = {.count = 7, .channel = "A", .values = true};
    session.views["hyperSlice"] = view;
    EXPECT_EQ(sessionFromJson(toJson(session), ""), session);
}

TEST_F(HyperSlices, PicturesHaveTheColoursOfTheParameterAndOfBrushes) {
    const std::vector<HyperAxis> all = axes();
    session.transfer["A"].colormap = "viridis";
    for (const bool brushed : {false, true}) {
        if (brushed) {
            session.selection.brushes = {vis::rangeBrush({{.channel = "B", .lo = -5, .hi = 4, .soft = 3}}, "b")};
            session.selection.contextOpacity = 0.2f;
            session.selection.contextSaturation = 0.5f;
            session.selection.brushColor = 0.4f;
        }
        const HyperContent content = hyperContent(view, 0, session, info);
        EXPECT_EQ(content.channels, brushed ? (std::vector{0, 1}) : std::vector{0});
        const HyperValues panel =
            readPanel(*source, panelQuery(all[0], all[3], content.channels, {11, 13}, session, info));
        const std::vector<std::uint8_t> rgba = panelImage(info, session, content, panel);
        ASSERT_EQ(rgba.size(), 11u * 13 * 4);
        std::set<int> opacities;
        for (int j = 0; j < 13; ++j)
            for (int i = 0; i < 11; ++i) {
                const std::uint8_t* pixel = &rgba[std::size_t((12 - j) * 11 + i) * 4];
                const double value = panel.at(0, {i, j});
                if (std::isnan(value)) {
                    EXPECT_EQ(pixel[3], 0) << "absent";
                    continue;
                }
                const glm::dvec3 full = glm::dvec3(vis::evaluate(session.transfer["A"], {250, 500}, value));
                glm::dvec4 expected(full, 1);
                if (brushed) {
                    const double b = panel.at(1, {i, j}), away = std::max({0.0, -5 - b, b - 4});
                    const double doi = std::max(0.0, 1 - away / 3);
                    const glm::dvec3 linear = vis::linearFromSrgb(full);
                    const double grey = 0.2126 * linear.x + 0.7152 * linear.y + 0.0722 * linear.z;
                    glm::dvec3 color = glm::mix(glm::dvec3(grey), linear, std::lerp(0.5, 1.0, doi));
                    color = glm::mix(color, vis::linearFromSrgb(glm::dvec3(session.selection.brushes[0].color)),
                                     double(0.4f) * doi * doi);
                    for (int k = 0; k < 3; ++k) expected[k] = vis::srgbFromLinear(color[k]);
                    expected.w = std::lerp(double(0.2f), 1.0, doi);
                }
                opacities.insert(pixel[3]);
                for (int k = 0; k < 4; ++k) EXPECT_NEAR(pixel[k], 255 * expected[k], 0.6) << i << " " << j;
            }
        EXPECT_EQ(opacities.size() > 2, brushed);
    }
}

TEST_F(HyperSlices, ContourLinesLieWhereTheValueIsTheLevel) {
    view.lines.count = 6;
    const std::vector<HyperAxis> all = axes();
    const HyperContent content = hyperContent(view, 1, session, info);
    ASSERT_EQ(content.lined, 1);
    std::size_t points = 0;
    for (const auto& [column, row] : {std::pair{0, 1}, {1, 2}, {0, 3}, {2, 3}}) {
        const HyperAxis &across = all[std::size_t(column)], &up = all[std::size_t(row)];
        const HyperValues panel =
            readPanel(*source, panelQuery(across, up, content.channels, {120, 120}, session, info));
        for (const volume::ContourLine& line : panelLines(info, content, panel))
            for (const glm::dvec2& point : line.points) {
                ++points;
                Session there = session;
                goToPlace(across, point.x, there, info);
                goToPlace(up, point.y, there, info);
                EXPECT_NEAR(probed(1, there.cursor, there.time), line.level, 0.05);
            }
    }
    EXPECT_GT(points, 300u);
}

TEST_F(HyperSlices, TablesAndPagesAreOfTheSource) {
    view.zoom["x"] = {1.5, 3};
    const HyperMatrix matrix{axes({"x", "z", "falling"}), hyperContent(view, 0, session, info), false, session};
    const Table table = hyperTable(*source, matrix);
    std::vector<std::string> names;
    for (const TableColumn& column : table.columns) names.push_back(column.name);
    ASSERT_EQ(names, (std::vector<std::string>{"panel", "x", "y", "z", "falling", "time", "A"}));
    EXPECT_EQ(rowsOf(table), 3u * 64 * 64 + 2 * 257 + 4);
    std::map<std::string, int> panels;
    const AxisLabels labels = axisLabels(session, info);
    for (std::size_t row = 0; row < rowsOf(table); ++row) {
        ++panels[table.columns[0].texts[row]];
        if (row % 37 != 0 && row + 300 < rowsOf(table)) continue;
        glm::dvec3 at;
        for (int k = 0; k < 3; ++k)
            at[k] = std::clamp(table.columns[std::size_t(k) + 1].numbers[row] / labels[std::size_t(k)].unit.perUnit,
                               info.bounds.lo[k], info.bounds.hi[k]);
        EXPECT_EQ(at.y, session.cursor.y);
        expectSame(table.columns[6].numbers[row], probed(0, at, table.columns[5].numbers[row]));
    }
    EXPECT_EQ(panels,
              (std::map<std::string, int>{
                  {"x, z", 4096}, {"x, falling", 4096}, {"z, falling", 4096}, {"x", 257}, {"z", 257}, {"falling", 4}}));
    session.selection.brushes.resize(1);
    session.selection.brushes[0].region = vis::BoxRegion{.center = {2, -1.4, 1}, .radius = {0.4, 0.2, 0.5}};
    const HyperMatrix boxed{matrix.axes, matrix.content, false, session};
    EXPECT_EQ(panelSections(session, info, matrix.axes[0].along, matrix.axes[1].along).size(), 1u);
    EXPECT_TRUE(panelSections(session, info, matrix.axes[0].along, matrix.axes[2].along).empty());
    const auto strokes = [](const VectorPage& drawn) {
        return std::ranges::count_if(drawn.marks, [](const shapes::Mark& mark) {
            return std::holds_alternative<shapes::Stroke>(mark.shape) ||
                   std::holds_alternative<shapes::Polygon>(mark.shape);
        });
    };
    PageForm form;
    EXPECT_GT(strokes(hyperPage(*source, boxed, form)), strokes(hyperPage(*source, matrix, form)));
    const VectorPage page = hyperPage(*source, matrix, form);
    int pictures = 0;
    std::set<std::string> words;
    for (const shapes::Mark& mark : page.marks) {
        pictures += std::holds_alternative<shapes::Picture>(mark.shape);
        if (const auto* each = std::get_if<shapes::Words>(&mark.shape)) words.insert(each->text);
    }
    EXPECT_EQ(pictures, 3 + 1) << "and the colours of the legend";
    for (const char* word : {"x [mm]", "z [mm]", "falling [V]", "A [K]", "not to scale, z by cells"})
        EXPECT_TRUE(words.contains(word)) << word;
}

} // namespace
} // namespace tessera::app
