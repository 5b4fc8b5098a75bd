// Tables and Tecplot: places, names, units, times, and files that end early.
#include "tests/import/foreign_files.h"

#include <glm/geometric.hpp>
#include <random>

namespace tessera::volume {
namespace {

using TextFormats = ForeignFiles;

constexpr glm::ivec3 kSize(4, 3, 5);

glm::dvec3 place(int i, int j, int k) {
    return {0.25 * i - 1, 10 + 2 * j, 0.5 * k};
}
double value(glm::dvec3 x) {
    return 300 + x.x + 2 * x.y + 3 * x.z;
}
std::string text(double number) {
    char out[40];
    std::snprintf(out, sizeof out, "%.9g", number);
    return out;
}
/// Rows x, y, z, T, Ux, Uy, Uz of the grid, x fastest.
std::vector<std::string> rows(const std::string& between) {
    std::vector<std::string> out;
    for (int k = 0; k < kSize.z; ++k)
        for (int j = 0; j < kSize.y; ++j)
            for (int i = 0; i < kSize.x; ++i) {
                const glm::dvec3 x = place(i, j, k);
                std::string row;
                for (const double number : {x.x, x.y, x.z, value(x), x.x + 1, x.y + 1, x.z + 1})
                    row += (row.empty() ? "" : between) + text(number);
                out.push_back(row);
            }
    return out;
}
std::string join(const std::vector<std::string>& lines) {
    std::string out;
    for (const std::string& line : lines) out += line + "\n";
    return out;
}

void expectTheGrid(const Dataset& dataset, int time = 0, double more = 0) {
    ASSERT_EQ(dataset.info.lattice.size, kSize);
    const auto t = dataset.info.findChannel("T");
    ASSERT_TRUE(t);
    const Field field = dataset.read(dataset.info.channel(*t).parameter, 0, time);
    for (int k = 0; k < kSize.z; ++k)
        for (int j = 0; j < kSize.y; ++j)
            for (int i = 0; i < kSize.x; ++i) {
                const std::size_t at = dataset.info.lattice.index({i, j, k});
                ASSERT_LT(glm::distance(dataset.info.lattice.position({i, j, k}), place(i, j, k)), 1e-6);
                ASSERT_TRUE(field.present(at));
                ASSERT_NEAR(field.value(at), value(place(i, j, k)) + more, 1e-4);
            }
}

TEST_F(TextFormats, CsvOnAGrid) {
    const std::string path =
        write("a.csv", "x [mm],y [mm],z [mm],T [K],Ux [m/s],Uy [m/s],Uz [m/s]\n" + join(rows(",")));
    const Dataset dataset = openFiles({path}, {});
    expectTheGrid(dataset);
    EXPECT_EQ(dataset.info.lengthUnit, "mm");
    ASSERT_EQ(dataset.info.parameters.size(), 2u);
    EXPECT_EQ(dataset.info.parameters[0].unit, "K");
    EXPECT_EQ(dataset.info.parameters[1].name, "U");
    EXPECT_EQ(dataset.info.parameters[1].unit, "m/s");
    EXPECT_EQ(dataset.info.parameters[1].components, 3);
    EXPECT_NEAR(dataset.read(1, 2, 0).value(59), place(3, 2, 4).z + 1, 1e-6);
    expectCutsAreTold(path, path, {}, 57);
}

TEST_F(TextFormats, CsvOfOtherPrograms) {
    std::vector<std::string> shuffled = rows(",");
    std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(7));
    expectTheGrid(openFiles(
        {write("a.csv", "\"Points:0\",\"Points:1\",\"Points:2\",\"T\",\"U:0\",\"U:1\",\"U:2\"\n" + join(shuffled))},
        {})); // ParaView
    const Dataset comsol = openFiles(
        {write("b.txt", "% Model: cell.mph\n% x  y  z  T (K)  u (m/s)  v (m/s)  w (m/s)\n" + join(rows("   ")))}, {});
    expectTheGrid(comsol);
    EXPECT_EQ(comsol.info.parameters[0].unit, "K");
    EXPECT_EQ(comsol.info.parameters[1].components, 3);
    std::string comma = join(rows(";"));
    std::replace(comma.begin(), comma.end(), '.', ',');
    expectTheGrid(openFiles({write("c.csv", "X;Y;Z;T;a;b;c\n" + comma)}, {})); // a German spreadsheet
    expectTheGrid(
        openFiles({write("d.csv", "x-coordinate, y-coordinate, z-coordinate, T, x-velocity, y-velocity, z-velocity\n" +
                                      join(rows(", ")))},
                  {})); // Fluent
}

TEST_F(TextFormats, CsvWithPointsLeftOutHasNoneThere) {
    std::vector<std::string> some = rows(",");
    some.erase(some.begin() + 17);
    some.erase(some.begin() + 3);
    const Dataset dataset = openFiles({write("a.csv", "x,y,z,T,a,b,c\n" + join(some))}, {});
    ASSERT_EQ(dataset.info.lattice.size, kSize);
    const Field field = dataset.read(0, 0, 0);
    for (std::size_t i = 0; i < field.count(); ++i) EXPECT_EQ(field.present(i), i != 3 && i != 17) << i;
}

TEST_F(TextFormats, CsvOfScatteredPointsTakesTheNearest) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<glm::dvec3> points;
    std::vector<std::string> lines;
    for (int n = 0; n < 500; ++n) {
        points.emplace_back(unit(random), unit(random), unit(random));
        lines.push_back(text(points.back().x) + "," + text(points.back().y) + "," + text(points.back().z) + "," +
                        std::to_string(n));
    }
    const std::string path = write("a.csv", "x,y,z,n\n" + join(lines));
    const ImportPreview preview = previewFiles({path}, {});
    EXPECT_THAT(preview.notes, testing::Contains(testing::HasSubstr("nearest of 500 points")));
    const Dataset dataset = openFiles({path}, {});
    const Lattice& lattice = dataset.info.lattice;
    EXPECT_NEAR(double(lattice.count()), 500, 250);
    const Field field = dataset.read(0, 0, 0);
    int present = 0;
    for (int k = 0; k < lattice.size.z; ++k)
        for (int j = 0; j < lattice.size.y; ++j)
            for (int i = 0; i < lattice.size.x; ++i) {
                const auto far = [&](const glm::dvec3& p) {
                    return glm::length((p - lattice.position({i, j, k})) / lattice.spacing);
                };
                const auto best = std::ranges::min_element(points, {}, far);
                const std::size_t at = lattice.index({i, j, k});
                ASSERT_EQ(field.present(at), far(*best) <= 1.5);
                if (!field.present(at)) continue;
                ++present;
                ASSERT_EQ(field.value(at), double(best - points.begin()));
            }
    EXPECT_GT(present, 200);
}

// A thin axis among points far apart made steps as small as itself, and a thousand samples along the others.
TEST_F(TextFormats, CsvOfFewPointsFarApartHasFewSamples) {
    for (const double thin : {1e-3, 1e-9, 1.0}) {
        std::string text = "x,y,z,T\n";
        for (int n = 0; n < 14; ++n)
            text += std::to_string(1e6 * (n * 37 % 101)) + "," + std::to_string(1e6 * (n * 53 % 97)) + "," +
                    std::to_string(n * 29 % 31) + (thin < 1 ? (thin < 1e-6 ? "e-9," : "e-3,") : ",") +
                    std::to_string(300 + n) + "\n";
        ASSERT_LT(text.size(), 600u);
        const Dataset dataset = openFiles({write("a.csv", text)}, {});
        EXPECT_LT(dataset.info.lattice.count(), 200u) << thin;
        EXPECT_GT(dataset.info.lattice.count(), 7u) << thin;
        const Field field = dataset.read(0, 0, 0);
        int present = 0;
        for (std::size_t i = 0; i < field.count(); ++i) present += field.present(i) ? 1 : 0;
        EXPECT_GT(present, 7) << thin;
    }
}

TEST_F(TextFormats, CsvOverTime) {
    std::vector<std::string> lines;
    for (const int t : {0, 1, 2})
        for (int k = 0; k < kSize.z; ++k)
            for (int j = 0; j < kSize.y; ++j)
                for (int i = 0; i < kSize.x; ++i) {
                    const glm::dvec3 x = place(i, j, k);
                    lines.push_back(text(0.5 * t) + "," + text(x.x) + "," + text(x.y) + "," + text(x.z) + "," +
                                    text(value(x) + t));
                }
    const std::string path = write("a.csv", "time [s],x,y,z,T\n" + join(lines));
    const Dataset dataset = openFiles({path}, {});
    EXPECT_EQ(dataset.info.times, (std::vector<double>{0, 0.5, 1}));
    for (const int t : {0, 1, 2}) expectTheGrid(dataset, t, t);
}

TEST_F(TextFormats, BadTablesSayWhere) {
    EXPECT_THAT(failure(write("a.csv", "x,y,z,T\n0,0,0,1\n1,0,0,hot\n")), testing::HasSubstr("line 3, column T"));
    EXPECT_THAT(failure(write("a.csv", "x,y,z,T\n0,0,0\n")), testing::HasSubstr("line 2 has 3 fields"));
    EXPECT_THAT(failure(write("a.csv", "1,2,3\n4,5,6\n")), testing::HasSubstr("no heading"));
    EXPECT_THAT(failure(write("a.csv", "time,voltage\n0,1\n")), testing::HasSubstr("--over-time"));
    EXPECT_THAT(failure(write("a.csv", "x,y,z,T\n0,0,0,1\n1,0,0,1\n0,0,0,2\n")), testing::HasSubstr("same position"));
}

TEST_F(TextFormats, TecplotStructured) {
    const std::string head =
        "TITLE = \"a = b\"\nVARIABLES = \"X [mm]\" \"Y [mm]\" \"Z [mm]\" \"T [K]\" \"U\" \"V\" \"W\"\n";
    const auto zone = [&](const std::string& time) {
        return "# a comment\nZONE T=\"grid\", I=4, J=3, K=5, DATAPACKING=POINT" + time + "\n" + join(rows(" "));
    };
    const std::string path = write("a.dat", head + zone(", SOLUTIONTIME=0.5") + zone(", SOLUTIONTIME=1.5"));
    const Dataset dataset = openFiles({path}, {});
    expectTheGrid(dataset, 1);
    EXPECT_EQ(dataset.info.times, (std::vector<double>{0.5, 1.5}));
    EXPECT_EQ(dataset.info.lengthUnit, "mm");
    EXPECT_EQ(dataset.info.parameters[0].unit, "K");
    EXPECT_EQ(dataset.info.parameters[1].components, 3);
    const std::string one = write("b.dat", head + zone(""));
    expectCutsAreTold(one, one, {}, 60);
}

TEST_F(TextFormats, TecplotBlocksOfCellsAndRepeatedNumbers) {
    const std::string path =
        write("a.dat",
              "VARIABLES = X Y Z T p\nZONE NODES=12, ELEMENTS=2, DATAPACKING=BLOCK, ZONETYPE=FEBRICK, "
              "VARLOCATION=([5]=CELLCENTERED)\n"
              "0 1 2 0 1 2 0 1 2 0 1 2\n3*0 3*1 3*0 3*1\n6*0 6*1\n"
              "0 1 2 0 1 2 0 1 2 0 1 2\n100 200\n1 2 5 4 7 8 11 10\n3 6 5 2 9 12 11 8\n"); // cut within its last number
                                                                                           // it would be whole
    ImportOptions options;
    options.gridSize = {5, 2, 2};
    const Dataset dataset = openFiles({path}, options);
    ASSERT_EQ(dataset.info.parameters.size(), 2u);
    const Field t = dataset.read(0, 0, 0), p = dataset.read(1, 0, 0);
    for (int i = 0; i < 5; ++i) {
        const double x = dataset.info.lattice.position({i, 0, 0}).x;
        EXPECT_NEAR(t.value(std::size_t(i)), x, 1e-4);
        EXPECT_NEAR(p.value(std::size_t(i)), 50 + 100 * x, 0.1) << "100 and 200 in the middle of two cells";
    }
    expectCutsAreTold(path, path, options, 40);
}

TEST_F(TextFormats, TecplotZonesAreRegions) {
    const auto zone = [](const char* name, int from) {
        const std::string a = std::to_string(from), b = std::to_string(from + 1);
        std::string out = "ZONE T=\"" + std::string(name) + "\" I=2 J=2 K=2 F=POINT\n";
        for (const char* z : {"0", "1"})
            for (const char* y : {"0", "1"})
                for (const std::string& x : {a, b})
                    out += x + " " + y + " " + z + " " + std::to_string(7 + from) + "\n";
        return out;
    };
    ImportOptions options;
    options.gridSize = {4, 2, 2};
    const Dataset dataset = openFiles(
        {write("a.tec", "VARIABLES = \"x\", \"y\", \"z\", \"T\"\n" + zone("air", 0) + zone("fuel", 1))}, options);
    const std::string variables = "VARIABLES = \"x\", \"y\", \"z\", \"T\"\n";
    const Dataset twice =
        openFiles({write("twice.tec", variables + zone("air", 0) + variables + zone("fuel", 1))}, options);
    EXPECT_EQ(twice.info.parameters.size(), dataset.info.parameters.size());
    for (const std::string other :
         {"VARIABLES = \"x\", \"y\", \"z\", \"p\"\n", "VARIABLES = \"x\", \"y\", \"z\", \"T\", \"p\"\n"})
        EXPECT_THAT(failure(write("other.tec", variables + zone("air", 0) + other + zone("fuel", 1))),
                    testing::HasSubstr("states other VARIABLES after its first zone"));
    ASSERT_EQ(dataset.info.parameters.size(), 2u);
    const Field t = dataset.read(0, 0, 0), region = dataset.read(1, 0, 0);
    for (std::size_t i = 0; i < t.count(); ++i) {
        EXPECT_NEAR(t.value(i), i % 4 < 2 ? 7 : 8, 1e-6);
        EXPECT_EQ(region.value(i), i % 4 < 2 ? 1 : 2);
    }
    EXPECT_EQ(dataset.info.parameters[1].labels, (std::vector<Label>{{1, "air"}, {2, "fuel"}}));
}

TEST_F(TextFormats, OfTheFuelCell) {
    const std::string archive = testData("fuel-cell/other-formats.tar.xz");
    if (archive.empty()) GTEST_SKIP() << "no test data";
    ASSERT_EQ(std::system(("tar xJf '" + archive + "' -C '" + folder_.string() + "'").c_str()), 0);
    const std::string formats = (folder_ / "formats").string() + "/";
    const Dataset vtk = openFiles({formats + "open_small_last_legacy_binary.vtk"}, {});
    const int wanted = vtk.info.channel(*vtk.info.findChannel("T")).parameter;
    const Field truth = vtk.read(wanted, 0, 0);
    for (const char* name : {"open_small_last.csv", "open_small_last.dat", "open_small.h5"}) {
        const Dataset dataset = openFiles({formats + name}, {});
        ASSERT_EQ(dataset.info.lattice.size, glm::ivec3(11, 13, 101)) << name;
        const int t = dataset.info.channel(*dataset.info.findChannel("T")).parameter;
        const Field field = dataset.read(t, 0, int(dataset.info.times.size()) - 1);
        for (std::size_t i = 0; i < field.count(); ++i) ASSERT_NEAR(field.value(i), truth.value(i), 1e-3) << name << i;
        const auto o2 = dataset.info.findChannel("O2");
        ASSERT_TRUE(o2);
        EXPECT_EQ(dataset.info.channel(*o2).unit, name == std::string("open_small_last.dat") ? "" : "mol/m^3");
    }
}

} // namespace
} // namespace tessera::volume
