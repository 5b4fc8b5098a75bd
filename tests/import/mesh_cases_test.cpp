// Meshes of solvers and mesh programs in tests/import/cases/meshes: each with its times, units, and values by place.
#include "tests/import/foreign_files.h"

#include <cmath>

namespace tessera::volume {
namespace {

using MeshCases = ForeignFiles;

std::string meshCase(const std::string& name) {
    return std::string(TESSERA_SOURCE_DIR) + "/tests/import/cases/meshes/" + name;
}
int parameterNamed(const Dataset& dataset, const std::string& name) {
    const auto at = std::ranges::find(dataset.info.parameters, name, &Parameter::name);
    EXPECT_NE(at, dataset.info.parameters.end()) << name;
    return at == dataset.info.parameters.end() ? 0 : int(at - dataset.info.parameters.begin());
}
std::size_t presentIn(const Field& field) {
    std::size_t present = 0;
    for (std::size_t i = 0; i < field.count(); ++i) present += field.present(i) ? 1 : 0;
    return present;
}
/// Mean of the present samples, NaN if there is none.
double meanOf(const Field& field) {
    double sum = 0;
    for (std::size_t i = 0; i < field.count(); ++i) sum += field.present(i) ? field.value(i) : 0;
    return sum / double(presentIn(field));
}

TEST_F(MeshCases, EnSightVariablesHaveTheirOwnTimes) {
    const Dataset dataset = openFiles({meshCase("ensight/timesets.case")}, {});
    EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(5, 4, 3));
    EXPECT_EQ(dataset.info.times, (std::vector<double>{0, 0.5, 1}));
    const int t = parameterNamed(dataset, "T"), late = parameterNamed(dataset, "O2");
    for (const int time : {2, 0, 1, 2}) {
        EXPECT_NEAR(meanOf(dataset.read(t, 0, time)), 302 + 10 * time, 1e-3) << time;
        EXPECT_EQ(presentIn(dataset.read(late, 0, time)), time == 0 ? 0u : 60u) << time;
    }
}

TEST_F(MeshCases, EnSightMeshThatMovesHasTheBoxOfAllTimes) {
    const Dataset dataset = openFiles({meshCase("ensight/moving.case")}, {});
    EXPECT_EQ(dataset.info.bounds.size(), glm::dvec3(5, 3, 2));
    ASSERT_EQ(dataset.info.lattice.size, glm::ivec3(5, 3, 2)); // in cells: 24 of them at each time
    for (const int time : {2, 0, 1}) EXPECT_EQ(presentIn(dataset.read(0, 0, time)), 24u) << time;
    EXPECT_NEAR(dataset.read(0, 0, 0).value(0), 300.5, 1e-3);
    EXPECT_NEAR(dataset.read(0, 0, 1).value(1), 311, 1e-3); // x from 0.5 to 4.5
    EXPECT_NEAR(dataset.read(0, 0, 2).value(1), 320.5, 1e-3);
    EXPECT_FALSE(dataset.read(0, 0, 2).present(0));
    ASSERT_EQ(dataset.info.quantities.size(), 1u);
    EXPECT_EQ(dataset.info.quantities[0].values, (std::vector<double>{0.1, 0.2, 0.3}));
}

TEST_F(MeshCases, EnSightUndefinedPointsAloneAreAbsent) {
    for (const char* name : {"ensight/partial.case", "ensight/noeol.case"}) {
        const Field field = openFiles({meshCase(name)}, {}).read(0, 0, 0);
        for (std::size_t i = 0; i < field.count(); ++i) {
            ASSERT_EQ(field.present(i), i % 5 != 4) << name << " " << i;
            if (!field.present(i)) continue;
            ASSERT_NEAR(field.value(i), 300 + double(i % 5), 1e-3);
        }
    }
    EXPECT_EQ(openFiles({meshCase("ensight/lower.case")}, {}).read(0, 0, 0).value(0), 300);
}

TEST_F(MeshCases, EnSightFileThatIsMissingSpoilsItselfAlone) {
    for (const char* name : {"timesets.case", "one.geo", "mvT.0000.scl", "mvT.0010.scl", "lateO2.0.scl"})
        write(name, read(meshCase(std::string("ensight/") + name)));
    const std::string path = (folder_ / "timesets.case").string();
    const Dataset dataset = openFiles({path}, {});
    EXPECT_EQ(presentIn(dataset.read(parameterNamed(dataset, "T"), 0, 1)), 0u);
    EXPECT_NEAR(meanOf(dataset.read(parameterNamed(dataset, "T"), 0, 2)), 322, 1e-3);
    EXPECT_THAT(previewFiles({path}, {}).notes,
                testing::Contains("T is absent at some times: its file mvT.0005.scl (time 0.5) does not exist"));
}

TEST_F(MeshCases, FluentBinary) {
    const Dataset dataset = openFiles({meshCase("fluent/two.cas")}, {});
    EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(4, 3, 2));
    EXPECT_EQ(dataset.info.lattice.spacing, glm::dvec3(0.5, 1, 2));
    EXPECT_EQ(dataset.info.lengthUnit, "m");
    EXPECT_EQ(dataset.info.times, std::vector<double>{0.25});
    const Parameter& t = dataset.info.parameters[std::size_t(parameterNamed(dataset, "temperature"))];
    EXPECT_EQ(t.unit, "K");
    EXPECT_FALSE(t.unitGuessed);
    EXPECT_EQ(presentIn(dataset.read(parameterNamed(dataset, "temperature"), 0, 0)), 24u);
    const int u = parameterNamed(dataset, "velocity");
    EXPECT_EQ(dataset.info.parameters[std::size_t(u)].components, 3);
    EXPECT_EQ(presentIn(dataset.read(u, 0, 0)), 12u) << "of the channel alone";
    parameterNamed(dataset, "temperature (domain 2)");
    EXPECT_THAT(previewFiles({meshCase("fluent/two.cas")}, {}).notes,
                testing::Contains(testing::HasSubstr("earlier time steps")));
}

TEST_F(MeshCases, FluentFormsHoldTheSame) {
    const Dataset plain = openFiles({meshCase("fluent/two.cas")}, {});
    const Dataset packed = openFiles({meshCase("fluent/packed.cas.gz")}, {}); // single, polyhedra, big-endian, gzip
    for (const char* name : {"temperature", "velocity"}) {
        const Field a = plain.read(parameterNamed(plain, name), 0, 0),
                    b = packed.read(parameterNamed(packed, name), 0, 0);
        ASSERT_EQ(a.count(), b.count());
        for (std::size_t i = 0; i < a.count(); ++i)
            ASSERT_TRUE(!a.present(i) || std::abs(a.value(i) - b.value(i)) < 1e-4) << name << " " << i;
    }
    // Some writers close the bracket of a section again behind its end.
    std::string values = read(meshCase("fluent/two.dat"));
    for (std::size_t at = 0; (at = values.find("Section   3300)", at)) != std::string::npos; at += 16)
        values.insert(at + 15, ")");
    write("b.cas", read(meshCase("fluent/two.cas")));
    write("b.dat", values);
    EXPECT_EQ(contents((folder_ / "b.cas").string()), contents(meshCase("fluent/two.cas")));
}

TEST_F(MeshCases, Plot3dOfSeveralGrids) {
    const Dataset dataset = openFiles({meshCase("plot3d/two.xyz")}, {});
    EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(6, 3, 3));
    const Field density = dataset.read(parameterNamed(dataset, "Density"), 0, 0);
    EXPECT_EQ(presentIn(density), 54u) << "8 and 12 cells";
    EXPECT_NEAR(density.value(0), 1, 1e-5);
    EXPECT_NEAR(density.value(5), 2.3, 1e-5);
    EXPECT_EQ(dataset.info.parameters[std::size_t(parameterNamed(dataset, "Momentum"))].components, 3);
}

TEST_F(MeshCases, TecplotZonesShareVariables) {
    const Dataset dataset = openFiles({meshCase("tecplot/share_times.dat")}, {});
    EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(5, 4, 3));
    EXPECT_EQ(dataset.info.times, (std::vector<double>{0, 0.5, 1}));
    for (const int time : {2, 0, 1}) {
        const Field field = dataset.read(0, 0, time);
        for (std::size_t i = 0; i < field.count(); ++i) ASSERT_EQ(field.value(i), 300 + 10 * time + double(i % 5));
    }
}

TEST_F(MeshCases, TecplotPolyhedraAndLaterZones) {
    const std::string path = meshCase("tecplot/polyhedra.dat");
    const Dataset dataset = openFiles({path}, {});
    EXPECT_EQ(dataset.info.times, (std::vector<double>{1, 2}));
    EXPECT_EQ(dataset.info.lengthUnit, "m");
    EXPECT_GT(dataset.info.lattice.position(dataset.info.lattice.size - 1).x, 5) << "a zone that begins later";
    const int t = parameterNamed(dataset, "T"), c = parameterNamed(dataset, "c");
    EXPECT_NEAR(dataset.read(t, 0, 0).value(0), 4.5, 1e-3) << "in the middle of eight points";
    EXPECT_NEAR(dataset.read(t, 0, 1).value(0), 14.5, 1e-3);
    EXPECT_GT(presentIn(dataset.read(c, 0, 0)), 0u);
    EXPECT_EQ(presentIn(dataset.read(c, 0, 1)), 0u) << "passive";
    EXPECT_THAT(previewFiles({path}, {}).notes, testing::Contains(testing::HasSubstr("texts and drawings")));
}

TEST_F(MeshCases, TecplotSolutionApartFromItsGrid) {
    const std::string path = meshCase("tecplot/apart_sol.dat");
    const Dataset dataset = openFiles({path}, {});
    EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(2, 2, 2));
    EXPECT_EQ(dataset.read(0, 0, 0).value(6), 7);
    EXPECT_EQ(dataset.read(0, 0, 1).value(6), 5);
    EXPECT_THAT(previewFiles({path}, {}).notes, testing::Contains(testing::HasSubstr("apart_grid.dat")));
    EXPECT_THAT(failure(meshCase("tecplot/apart_grid.dat")), testing::HasSubstr("grid without values"));
}

TEST_F(MeshCases, VtkGhostsAndPieces) {
    const Dataset ghosts = openFiles({meshCase("vtk/ghost.pvtu")}, {});
    const Field t = ghosts.read(parameterNamed(ghosts, "T"), 0, 0);
    EXPECT_EQ(presentIn(t), 160u);
    EXPECT_NEAR(meanOf(t), 305, 1e-3);
    const Dataset pieces = openFiles({meshCase("vtk/pieces.vtm")}, {});
    EXPECT_EQ(pieces.info.lattice.size, glm::ivec3(8, 4, 4));
    EXPECT_NEAR(meanOf(pieces.read(0, 0, 0)), 304, 1e-3);
    EXPECT_EQ(presentIn(pieces.read(0, 0, 0)), 128u);
}

TEST_F(MeshCases, VtkValuesOfCellsBesidePointsAreNamed) {
    const std::string path = write(
        "a.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nORIGIN 0 0 0\n"
                 "SPACING 1 1 1\nFIELD FieldData 1\nTimeValue 1 1 double\n2.5\nPOINT_DATA 8\nSCALARS T float 1\n"
                 "LOOKUP_TABLE default\n1 2 3 4 5 6 7 8\nCELL_DATA 1\nSCALARS source float 1\nLOOKUP_TABLE "
                 "default\n9\n");
    const Dataset dataset = openFiles({path}, {});
    EXPECT_EQ(dataset.info.times, std::vector<double>{2.5});
    EXPECT_THAT(previewFiles({path}, {}).notes, testing::Contains(testing::HasSubstr("points: source")));
}

TEST_F(MeshCases, GmshGroupsAndViews) {
    const std::string mesh = meshCase("gmsh/g41b.msh");
    const Dataset groups = openFiles({mesh}, {});
    const int group = parameterNamed(groups, "physical group");
    EXPECT_EQ(groups.info.parameters[std::size_t(group)].labels, (std::vector<Label>{{1, "air"}, {7, "solid"}}));
    EXPECT_THAT(previewFiles({mesh}, {}).notes, testing::Contains(testing::HasSubstr("of boundaries")));
    ImportOptions options;
    options.gridSize = {3, 2, 2};
    const Dataset views = openFiles({meshCase("gmsh/views22.msh")}, options);
    EXPECT_EQ(views.info.times, (std::vector<double>{0, 0.5}));
    for (const int time : {1, 0}) {
        const Field field = views.read(parameterNamed(views, "T"), 0, time);
        for (std::size_t i = 0; i < field.count(); ++i)
            ASSERT_NEAR(field.value(i), views.info.lattice.position({int(i % 3), 0, 0}).x + 5 * time, 1e-3);
        EXPECT_EQ(presentIn(views.read(parameterNamed(views, "late"), 0, time)), time == 0 ? 0u : field.count());
    }
}

} // namespace
} // namespace tessera::volume
