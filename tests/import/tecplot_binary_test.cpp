// Binary Tecplot: values are formulas of their place, read back from every version, byte order and kind of zone.
#include "tests/import/tecplot_file.h"

#include <cmath>

namespace tessera::volume {
namespace {

using namespace tecplot;
using TecplotBinary = ForeignFiles;

int parameterOf(const Dataset& dataset, const std::string& name) {
    for (std::size_t p = 0; p < dataset.info.parameters.size(); ++p)
        if (dataset.info.parameters[p].name == name) return int(p);
    ADD_FAILURE() << name << " is missing";
    return 0;
}
/// Every present sample is what the formula says of its place; gives how many there are.
int expectFormula(const Dataset& dataset, const std::string& name, const Formula& of, int time = 0, int component = 0,
                  double tolerance = 1e-3) {
    const Field field = dataset.read(parameterOf(dataset, name), component, time);
    const Lattice& lattice = dataset.info.lattice;
    int present = 0;
    for (int k = 0; k < lattice.size.z; ++k)
        for (int j = 0; j < lattice.size.y; ++j)
            for (int i = 0; i < lattice.size.x; ++i) {
                const std::size_t at = lattice.index({i, j, k});
                if (!field.present(at)) continue;
                ++present;
                EXPECT_NEAR(field.value(at), of(lattice.position({i, j, k})), tolerance)
                    << name << " at " << i << " " << j << " " << k;
            }
    return present;
}

TEST_F(TecplotBinary, EveryVersionOrderAndPacking) {
    for (const int version : {101, 102, 108, 109, 110, 111, 112, 191})
        for (const bool big : {false, true})
            for (const bool inPoints : {false, true}) {
                if (inPoints && version >= 112) continue;
                File file{version, big, {"X [mm]", "Y [mm]", "Z [mm]", "T [K]", "U", "V", "W"}, {}};
                Zone zone = ordered("grid", with(places(), {over(linear, 2), over([](glm::dvec3 x) { return x.x; }),
                                                            over([](glm::dvec3 x) { return x.y; }),
                                                            over([](glm::dvec3 x) { return x.z; })}));
                zone.inPoints = inPoints;
                file.zones = {zone};
                const std::string path = write("a.plt", file.bytes());
                SCOPED_TRACE(std::to_string(version) + (big ? " big" : " little") + (inPoints ? " points" : ""));
                const Dataset dataset = openFiles({path}, {});
                ASSERT_EQ(dataset.info.lattice.size, kSize);
                EXPECT_LT(glm::distance(dataset.info.lattice.position({3, 2, 4}), place(3, 2, 4)), 1e-6);
                EXPECT_EQ(dataset.info.lengthUnit, "mm");
                ASSERT_EQ(dataset.info.parameters.size(), 2u);
                EXPECT_EQ(dataset.info.parameters[0].unit, "K");
                EXPECT_EQ(dataset.info.parameters[1].components, 3);
                EXPECT_EQ(expectFormula(dataset, "T", linear), 60);
                EXPECT_EQ(expectFormula(
                              dataset, "U", [](glm::dvec3 x) { return x.z; }, 0, 2),
                          60);
                EXPECT_EQ(contents(write("b.dat", file.bytes())), contents(path)) << "the file tells, not its name";
            }
}

TEST_F(TecplotBinary, IntegersStayIntegers) {
    const Formula number = [](glm::dvec3 x) { return std::round(4 * x.x + x.z * 2); };
    for (const bool big : {false, true}) {
        File file{112, big, {"X", "Y", "Z", "i", "s", "b"}, {}};
        const Formula large = [&](glm::dvec3 x) { return 16777217 + number(x); }; // no float has it
        const Formula negative = [&](glm::dvec3 x) { return -300 + number(x); };
        const Formula byte = [&](glm::dvec3 x) { return 200 + number(x); };
        file.zones = {ordered("", with(places(2), {over(large, 3), over(negative, 4), over(byte, 5)}))};
        const Dataset dataset = openFiles({write("a.plt", file.bytes())}, {});
        EXPECT_EQ(expectFormula(dataset, "i", large, 0, 0, 0), 60);
        EXPECT_EQ(expectFormula(dataset, "s", negative, 0, 0, 0), 60);
        EXPECT_EQ(expectFormula(dataset, "b", byte, 0, 0, 0), 60);
        EXPECT_EQ(dataset.info.parameters[1].type, ScalarType::I16);
        EXPECT_EQ(dataset.info.parameters[2].type, ScalarType::U8);
    }
}

TEST_F(TecplotBinary, ValuesOfCellsLieBetweenGhosts) {
    File file{112, false, {"X", "Y", "Z", "T", "p"}, {}};
    file.zones = {
        ordered("", with(places(), {over(linear, 1, true), over([](glm::dvec3 x) { return x.x; }, 2, true)}))};
    const Dataset dataset = openFiles({write("a.plt", file.bytes())}, {});
    ASSERT_EQ(dataset.info.lattice.size, kSize - 1);
    EXPECT_EQ(expectFormula(dataset, "T", linear), 24);
    EXPECT_EQ(expectFormula(dataset, "p", [](glm::dvec3 x) { return x.x; }), 24);

    file.zones[0].variables[3] = over(linear); // of points beside those of cells
    ImportOptions options;
    options.gridSize = {7, 5, 9};
    const Dataset both = openFiles({write("b.plt", file.bytes())}, options);
    EXPECT_GT(expectFormula(both, "T", linear), 100);
    const Field p = both.read(parameterOf(both, "p"), 0, 0);
    for (std::size_t i = 0; i < p.count(); ++i)
        if (p.present(i)) {
            EXPECT_NEAR(p.value(i), -0.625, 0.3751) << "of some cell, no ghost";
        }
}

TEST_F(TecplotBinary, PlanesAndRowsHaveNoGhostsBeyondTheirEnd) {
    File file{112, false, {"X", "Y", "T"}, {}};
    const auto plane = [](int i, int j) {
        Zone zone;
        zone.name = "plane";
        zone.size = {i, j, 1};
        zone.variables.resize(3);
        zone.variables[2].ofCells = j > 1;
        for (int b = 0; b < j; ++b)
            for (int a = 0; a < i; ++a) {
                zone.variables[0].values.push_back(a);
                zone.variables[1].values.push_back(b);
                if (a + 1 < i && (b + 1 < j)) zone.variables[2].values.push_back(a + 10 * b);
                if (j == 1) zone.variables[2].values.push_back(a);
            }
        return zone;
    };
    file.zones = {plane(4, 3)};
    const Dataset dataset = openFiles({write("a.plt", file.bytes())}, {});
    ASSERT_EQ(dataset.info.lattice.size, glm::ivec3(3, 2, 1));
    for (int n = 0; n < 6; ++n) EXPECT_EQ(dataset.read(0, 0, 0).value(std::size_t(n)), n % 3 + 10 * (n / 3));
    file.zones = {plane(6, 1)};
    const Dataset row = openFiles({write("b.plt", file.bytes())}, {});
    ASSERT_EQ(row.info.lattice.size, glm::ivec3(6, 1, 1));
    for (int n = 0; n < 6; ++n) EXPECT_EQ(row.read(0, 0, 0).value(std::size_t(n)), n);
}

TEST_F(TecplotBinary, BricksAndTetrahedra) {
    for (const int version : {111, 112})
        for (const bool tetrahedra : {false, true}) {
            File file{version, version == 111, {"X", "Y", "Z", "T", "cell"}, {}};
            Zone zone = elements("mesh", with(places(), {over(linear, 2)}), tetrahedra);
            Variable cell;
            cell.ofCells = true;
            cell.format = 3;
            for (int c = 0; c < zone.cells; ++c) cell.values.push_back(c);
            zone.variables.push_back(cell);
            zone.faceNeighbours.assign(std::size_t(zone.cells) * (tetrahedra ? 4 : 6), -1);
            zone.neighbours = 3; // of one face of one cell, then one of another
            zone.neighbourMode = 1;
            zone.neighbourList = {0, 1, 0, 2, 5, 6, 1, 1, 0, 1, 7};
            file.zones = {zone, zone}; // what comes behind is found
            file.zones[1].variables[0] = over([](glm::dvec3 x) { return x.x + 0.75; });
            file.zones[1].variables[3] = over([](glm::dvec3 x) { return linear(x) + 0.75; });
            ImportOptions options;
            options.gridSize = {13, 5, 9};
            const std::string path = write("a.plt", file.bytes());
            const Dataset dataset = openFiles({path}, options);
            EXPECT_EQ(expectFormula(dataset, "T", linear), 13 * 5 * 9);
            const Field cells = dataset.read(parameterOf(dataset, "cell"), 0, 0);
            for (int k = 1; k < 9; k += 2) { // in the middle of cells
                const double layer = std::min(std::floor(dataset.info.lattice.position({3, 1, k}).z / 0.5), 3.0);
                const double perLayer = zone.cells / 4.0;
                EXPECT_EQ(std::floor(cells.value(dataset.info.lattice.index({3, 1, k})) / perLayer), layer) << k;
            }
            expectCutsAreTold(path, path, options, 40);
        }
}

/// Wedges, pyramids and tetrahedra are written as bricks with corners that coincide, in several orders.
TEST_F(TecplotBinary, BricksWithCornersThatCoincide) {
    const std::vector<glm::dvec3> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},    {0, 0, 1},
                                         {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {0.5, 0.5, 2}};
    const std::vector<std::vector<int>> kinds{
        {0, 1, 2, 2, 4, 5, 6, 6, 0, 0, 2, 3, 4, 4, 6, 7, 4, 5, 6, 7, 8, 8, 8, 8}, // wedges, a pyramid above
        {0, 1, 1, 2, 4, 5, 5, 6, 0, 2, 3, 0, 4, 6, 7, 4, 8, 8, 8, 8, 4, 5, 6, 7}, // turned; upside down
        {0, 1, 2, 2, 4, 5, 6, 6, 0, 2, 3, 3, 4, 6, 7, 7, 4, 5, 6, 6, 8, 8, 8, 8, 4, 6, 7, 7, 8, 8, 8, 8}}; // tetrahedra
    for (const std::vector<int>& corners : kinds) {
        Zone zone;
        zone.type = 5;
        zone.points = int(points.size());
        zone.cells = int(corners.size()) / 8;
        zone.corners = corners;
        zone.variables.resize(4);
        for (const glm::dvec3& x : points) {
            for (int axis = 0; axis < 3; ++axis) zone.variables[std::size_t(axis)].values.push_back(x[axis]);
            zone.variables[3].values.push_back(linear(x));
        }
        ImportOptions options;
        options.gridSize = {11, 11, 21};
        const Dataset dataset =
            openFiles({write("a.plt", File{112, false, {"X", "Y", "Z", "T"}, {zone}}.bytes())}, options);
        const Lattice& lattice = dataset.info.lattice;
        int inside = 0;
        for (int k = 0; k < 21; ++k)
            for (int j = 0; j < 11; ++j)
                for (int i = 0; i < 11; ++i) {
                    const glm::dvec3 x = lattice.position({i, j, k});
                    const double half = x.z <= 1 ? 0.5 : 0.5 * (2 - x.z);
                    if (std::abs(x.x - 0.5) < half + 1e-6 && std::abs(x.y - 0.5) < half + 1e-6) ++inside;
                }
        EXPECT_EQ(expectFormula(dataset, "T", linear), inside);
        EXPECT_GT(inside, 900);
    }
}

TEST_F(TecplotBinary, TimesStaticZonesAndSharedNumbers) {
    File file{112, false, {"X", "Y", "Z", "T", "c"}, {}};
    const auto at = [](double time) { return [time](glm::dvec3 x) { return linear(x) + 100 * time; }; };
    const double times[3] = {0.5, 1.5, 4};
    const auto one = [&](int place, const std::string& name, double time, std::vector<Variable> from) {
        Zone zone = elements(name, with(std::move(from), {over(at(time), 2), over(at(time), 2, true)}), false);
        zone.time = time;
        zone.strand = place;
        if (zone.variables[0].from >= 0) {
            zone.cornersFrom = zone.variables[0].from;
            zone.corners.clear();
        }
        return zone;
    };
    const auto shift = [](glm::dvec3 x) { return x.x + 0.75; };
    // The solid is there at all times. Zones of later times share the places of those before, one through another.
    Zone solid = elements("solid", with(places(), {passive(2), over([](glm::dvec3) { return 7; }, 2, true)}), true);
    solid.variables[4] = passive(2);
    solid.variables[0] = over([](glm::dvec3 x) { return x.x - 0.75; });
    file.zones = {solid,
                  one(4, "air t=0.5", 0.5, places()),
                  one(9, "fuel t=0.5", 0.5, with({over(shift)}, {sharedWith(1), sharedWith(1)})),
                  one(9, "fuel t=4", 4, {sharedWith(2), sharedWith(2), sharedWith(2)}), // not in the order of times
                  one(4, "air t=4", 4, {sharedWith(1), sharedWith(1), sharedWith(1)}),
                  one(4, "air t=1.5", 1.5, {sharedWith(4), sharedWith(4), sharedWith(4)}),
                  one(9, "fuel t=1.5", 1.5, {sharedWith(3), sharedWith(3), sharedWith(3)})};
    file.zones[2].cornersFrom = 1;
    file.zones[2].corners.clear();
    ImportOptions options;
    options.gridSize = {18, 5, 9}; // no sample between two zones
    const std::string path = write("a.plt", file.bytes());
    const Dataset dataset = openFiles({path}, options);
    EXPECT_EQ(dataset.info.times, (std::vector<double>(times, times + 3)));
    std::vector<Label> labels;
    for (const Parameter& parameter : dataset.info.parameters)
        if (!parameter.labels.empty()) labels = parameter.labels;
    EXPECT_EQ(labels, (std::vector<Label>{{1, "solid"}, {2, "air"}, {3, "fuel"}}));
    const Lattice& lattice = dataset.info.lattice;
    for (int t = 0; t < 3; ++t) {
        const Field field = dataset.read(parameterOf(dataset, "T"), 0, t);
        for (int i = 0; i < 18; ++i) {
            const glm::dvec3 x = lattice.position({i, 2, 4});
            const std::size_t n = lattice.index({i, 2, 4});
            EXPECT_EQ(field.present(n), x.x > -1) << "the solid has no T, at " << x.x;
            if (!field.present(n)) continue;
            const double own = x.x > -0.25 ? x.x - 0.75 : x.x; // the fuel shares the numbers of places, not T
            EXPECT_NEAR(field.value(n), at(times[t])({own, x.y, x.z}), 1e-3) << i << " at " << times[t];
        }
    }
    expectCutsAreTold(path, path, options, 60);
}

TEST_F(TecplotBinary, PassiveAtSomeTimesIsAbsentThere) {
    File file{112, true, {"X", "Y", "Z", "T", "n"}, {}};
    file.zones = {ordered("t0", with(places(), {over(linear), passive(3)})),
                  ordered("t1", with({sharedWith(0), sharedWith(0), sharedWith(0)},
                                     {passive(), over([](glm::dvec3 x) { return std::round(x.z * 2); }, 3)}))};
    file.zones[0].strand = file.zones[1].strand = 0;
    file.zones[1].time = 1;
    const Dataset dataset = openFiles({write("a.plt", file.bytes())}, {});
    EXPECT_EQ(dataset.info.times, (std::vector<double>{0, 1}));
    EXPECT_EQ(expectFormula(dataset, "T", linear, 0), 60);
    EXPECT_EQ(expectFormula(dataset, "T", linear, 1), 0);
    EXPECT_EQ(expectFormula(dataset, "n", linear, 0), 0);
    EXPECT_EQ(expectFormula(
                  dataset, "n", [](glm::dvec3 x) { return std::round(x.z * 2); }, 1),
              60);
}

TEST_F(TecplotBinary, TimesWithoutStrands) {
    File file{112, false, {"X", "Y", "Z", "T"}, {}};
    file.zones = {ordered("b", with(places(), {over([](glm::dvec3) { return 2; })})),
                  ordered("a", with(places(), {over([](glm::dvec3) { return 1; })}))};
    file.zones[0].time = 2;
    file.zones[1].time = 1;
    const Dataset dataset = openFiles({write("a.plt", file.bytes())}, {});
    EXPECT_EQ(dataset.info.times, (std::vector<double>{1, 2}));
    for (int t = 0; t < 2; ++t) EXPECT_EQ(dataset.read(0, 0, t).value(7), t + 1);
    file = {102, false, {"X", "Y", "Z", "T"}, {file.zones[0]}};
    file.zones[0].auxiliary = {{"Common.Note", "4"}, {"Common.Time", "3.5"}};
    EXPECT_EQ(openFiles({write("b.plt", file.bytes())}, {}).info.times, std::vector<double>{3.5});
}

TEST_F(TecplotBinary, OtherRecordsArePassedOver) {
    File file{112, true, {"X", "Y", "Z", "T"}, {}};
    const auto integers = [&](const std::vector<int>& words) {
        std::string out;
        for (const int word : words) out += file.integer(word);
        return out;
    };
    const auto reals = [&](int count) {
        std::string out;
        for (int n = 0; n < count; ++n) out += file.real(299); // the bytes of no marker
        return out;
    };
    const auto geometry = [&](int system, int kind, int type, const std::string& end) {
        return file.single(399) + integers({system, 0, 0}) + reals(3) + integers({0, 1, 1, 0, kind, 0}) + reals(2) +
               integers({72, 0, 0}) + reals(2) + file.text("a macro") + integers({type, 1}) + end;
    };
    const std::string single = file.single(1);
    file.records =
        geometry(0, 0, 1, integers({2, 1}) + single + single + integers({2}) + single + single + single + single);
    file.records += geometry(4, 0, 2, integers({1, 2}) + reals(6));
    file.records += geometry(1, 1, 2, reals(2)) + geometry(1, 2, 1, single) + geometry(1, 3, 2, reals(1)) +
                    geometry(1, 4, 1, single + single);
    file.records += file.single(499) + integers({1, 0}) + reals(3) + integers({2, 1}) + reals(1) + integers({0}) +
                    reals(2) + integers({1, 1}) + reals(2) + integers({0, 0, 1}) + file.text("") + integers({0}) +
                    file.text("a word");
    file.records += file.single(599) + integers({2}) + file.text("one") + file.text("two");
    file.records += file.single(699) + file.text("a record");
    file.records += file.single(799) + file.text("Common.Note") + integers({0}) + file.text("3");
    file.records += file.single(899) + integers({3}) + file.text("Note") + integers({0}) + file.text("x");
    Zone zone = ordered("grid", with(places(), {over(linear)}));
    zone.neighbours = 2; // one to one of another zone
    zone.neighbourMode = 2;
    zone.neighbourList = {0, 0, 0, 1, 1, 1, 0, 0};
    zone.auxiliary = {{"Note", "of the zone"}, {"Other", ""}};
    file.zones = {zone};
    const std::string path = write("a.plt", file.bytes());
    EXPECT_EQ(expectFormula(openFiles({path}, {}), "T", linear), 60);
    expectCutsAreTold(path, path, {}, 200);
}

TEST_F(TecplotBinary, NamesInUtf8AndLatin1) {
    File file{112, false, {"X", "Y", "Z", "u [\xC2\xB5m]", "v [m\xB2]"}, {}};
    file.zones = {ordered("", with(places(), {over(linear), over(linear)}))};
    const Dataset dataset = openFiles({write("a.plt", file.bytes())}, {});
    EXPECT_EQ(dataset.info.parameters[0].unit, "\xC2\xB5m");
    EXPECT_EQ(dataset.info.parameters[1].unit, "m\xC2\xB2");
}

} // namespace
} // namespace tessera::volume
