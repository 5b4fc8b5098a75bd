#include "tests/import/foreign_files.h"

namespace tessera::volume {
namespace {

std::string vtkHdfCase(const std::string& name) {
    return std::string(TESSERA_SOURCE_DIR) + "/tests/import/cases/vtkhdf/" + name;
}

/// The parameter of a name; -1 if there is none.
int parameterOf(const Dataset& dataset, const std::string& name) {
    for (std::size_t p = 0; p < dataset.info.parameters.size(); ++p)
        if (dataset.info.parameters[p].name == name) return int(p);
    return -1;
}

double at(const Dataset& dataset, const std::string& name, int component, int time, glm::ivec3 place) {
    const Field field = dataset.read(parameterOf(dataset, name), component, time);
    return field.value(dataset.info.lattice.index(place));
}

class VtkHdfCases : public ForeignFiles {};

TEST_F(VtkHdfCases, StepsOfVersionTwoAreTimes) {
    const Dataset dataset = openFiles({vtkHdfCase("transient.vtkhdf")}, {});
    EXPECT_EQ(dataset.info.times, (std::vector<double>{0, 0.5, 1}));
    EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(6, 5, 4));
    for (const int t : {2, 0, 1, 2}) EXPECT_EQ(at(dataset, "T", 0, t, {3, 1, 2}), 303 + 10 * t);
}

TEST_F(VtkHdfCases, AnImageIsTurnedAndChangesInTime) {
    const std::string path = vtkHdfCase("image_times.vtkhdf");
    const Dataset dataset = openFiles({path}, {});
    EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(4, 5, 6));
    EXPECT_EQ(dataset.info.lattice.spacing, glm::dvec3(0.5, 1, 2));
    EXPECT_EQ(dataset.info.lattice.origin, glm::dvec3(-1.5, 2, 3)); // x from 0 (index 2) down to -1.5
    EXPECT_EQ(dataset.info.times, (std::vector<double>{0.1, 0.2, 0.4}));
    for (const int t : {1, 2, 0}) {
        EXPECT_EQ(at(dataset, "v", 0, t, {0, 0, 0}), 3 + 1000 * t);
        EXPECT_EQ(at(dataset, "v", 0, t, {3, 4, 5}), 540 + 1000 * t);
        EXPECT_EQ(at(dataset, "same", 0, t, {3, 4, 5}), 540);
        EXPECT_EQ(at(dataset, "U", 0, t, {3, 4, 5}), 540 + t);
        EXPECT_EQ(at(dataset, "U", 2, t, {3, 4, 5}), 3 * 540);
    }
    ASSERT_EQ(dataset.info.quantities.size(), 1u);
    EXPECT_EQ(dataset.info.quantities[0].name, "voltage");
    EXPECT_EQ(dataset.info.quantities[0].values, (std::vector<double>{0.6, 0.7, 0.8}));
    const ImportPreview preview = previewFiles({path}, {});
    EXPECT_THAT(preview.notes, testing::Contains(testing::HasSubstr("\"short\" left out: it has another size")));
    EXPECT_THAT(preview.notes, testing::Contains(testing::HasSubstr("\"words\" left out: it holds no numbers")));
}

TEST_F(VtkHdfCases, CellsOfAnImageLieAtTheirCentres) {
    const DatasetInfo info = openFiles({vtkHdfCase("image_cells.vtkhdf")}, {}).info;
    EXPECT_EQ(info.lattice.size, glm::ivec3(4, 5, 6));
    EXPECT_EQ(info.lattice.origin, glm::dvec3(1.25, 2.5, 4));
    EXPECT_EQ(info.lattice.spacing, glm::dvec3(0.5, 1, 2));
    EXPECT_EQ(info.bounds.lo, glm::dvec3(1, 2, 3)); // and reach its faces
    EXPECT_EQ(info.bounds.hi, glm::dvec3(3, 7, 15));
}

TEST_F(VtkHdfCases, PartsAreJoinedAndTheMeshMoves) {
    ImportOptions unitCells;
    unitCells.gridSize = {8, 4, 4};
    const Dataset dataset = openFiles({vtkHdfCase("moving_parts.vtkhdf")}, unitCells);
    EXPECT_EQ(dataset.info.bounds.hi, glm::dvec3(8, 4, 4)); // of both times
    EXPECT_NEAR(at(dataset, "c", 0, 1, {0, 0, 0}), 100, 2);
    EXPECT_NEAR(at(dataset, "c", 0, 1, {7, 3, 3}), 117, 2);
    const Field first = dataset.read(parameterOf(dataset, "c"), 0, 0);
    EXPECT_TRUE(first.present(dataset.info.lattice.index({0, 0, 0})));
    EXPECT_FALSE(first.present(dataset.info.lattice.index({3, 1, 1}))); // the ghost
    EXPECT_FALSE(first.present(dataset.info.lattice.index({7, 3, 3}))); // not yet so large
}

TEST_F(VtkHdfCases, BlocksOfATreeHaveTheirNames) {
    const std::string path = vtkHdfCase("multi.vtkhdf");
    const Dataset dataset = openFiles({path}, {});
    const Parameter& region = dataset.info.parameters[std::size_t(parameterOf(dataset, "region"))];
    ASSERT_EQ(region.labels.size(), 2u);
    EXPECT_EQ(region.labels[0].name, "air");
    EXPECT_EQ(region.labels[1].name, "solid");
    EXPECT_EQ(at(dataset, "c", 0, 0, {0, 0, 0}), 0);
    EXPECT_EQ(at(dataset, "c", 0, 0, {3, 1, 1}), 27);
    EXPECT_THAT(previewFiles({path}, {}).notes,
                testing::Contains(testing::HasSubstr("\"skin\" left out: it holds surfaces")));
}

TEST_F(VtkHdfCases, PolyhedraAndLevelsOfDetail) {
    const Dataset poly = openFiles({vtkHdfCase("polyhedron.vtkhdf")}, {});
    EXPECT_EQ(poly.info.lattice.size, glm::ivec3(2, 1, 1));
    EXPECT_EQ(at(poly, "c", 0, 0, {0, 0, 0}), 5);
    EXPECT_EQ(at(poly, "c", 0, 0, {1, 0, 0}), 7);
    const Dataset amr = openFiles({vtkHdfCase("amr.vtkhdf")}, {});
    EXPECT_EQ(amr.info.lattice.size, glm::ivec3(8, 8, 4));
    EXPECT_EQ(at(amr, "d", 0, 0, {0, 0, 0}), 0);
    EXPECT_EQ(at(amr, "d", 0, 0, {7, 7, 3}), 31);
    EXPECT_EQ(at(amr, "d", 0, 0, {2, 2, 0}), 100); // finer
    EXPECT_EQ(at(amr, "d", 0, 0, {3, 3, 1}), 107);
    EXPECT_EQ(at(amr, "d", 0, 0, {4, 2, 0}), 6);
}

TEST_F(VtkHdfCases, CutFilesAreTold) {
    for (const char* name : {"transient.vtkhdf", "multi.vtkhdf"}) {
        const std::string path = write(name, read(vtkHdfCase(name)));
        expectCutsAreTold(path, path);
    }
}

} // namespace
} // namespace tessera::volume
