#include "tests/import/foreign_files.h"

namespace tessera::volume {
namespace {

std::string xdmfCase(const std::string& name) {
    return std::string(TESSERA_SOURCE_DIR) + "/tests/import/cases/xdmf/" + name;
}

double sampleAt(const Dataset& dataset, const std::string& name, int component, int time, glm::ivec3 place) {
    for (std::size_t p = 0; p < dataset.info.parameters.size(); ++p)
        if (dataset.info.parameters[p].name == name)
            return dataset.read(int(p), component, time).value(dataset.info.lattice.index(place));
    ADD_FAILURE() << "no " << name;
    return 0;
}

class XdmfCases : public ForeignFiles {};

TEST_F(XdmfCases, OriginAndStepsStandInTheOrderZYX) {
    const std::string path = xdmfCase("image.xmf");
    const Dataset dataset = openFiles({path}, {});
    EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(4, 5, 6));
    EXPECT_EQ(dataset.info.lattice.origin, glm::dvec3(1, 2, 3));
    EXPECT_EQ(dataset.info.lattice.spacing, glm::dvec3(0.5, 1, 2));
    for (const char* name : {"T", "part"}) {
        EXPECT_EQ(sampleAt(dataset, name, 0, 0, {0, 0, 0}), 0);
        EXPECT_EQ(sampleAt(dataset, name, 0, 0, {1, 2, 3}), 321);
        EXPECT_EQ(sampleAt(dataset, name, 0, 0, {3, 4, 5}), 543);
    }
    for (int component = 0; component < 3; ++component) EXPECT_EQ(sampleAt(dataset, "V", component, 0, {1, 2, 3}), 321);
    const std::vector<std::string> notes = previewFiles({path}, {}).notes;
    EXPECT_THAT(notes,
                testing::Contains(testing::HasSubstr("\"sum\" left out: it is computed by the function $0 + $1")));
    EXPECT_THAT(notes, testing::Contains(testing::HasSubstr("\"gone\" left out: it names \"nothing\"")));
    EXPECT_THAT(notes, testing::Contains(testing::HasSubstr("\"faces\" left out: it has values at each face")));
    EXPECT_EQ(dataset.info.parameters.size(), 3u);
}

TEST_F(XdmfCases, CellsAndListsOfCoordinates) {
    const Dataset cells = openFiles({xdmfCase("image_cells.xmf")}, {});
    EXPECT_EQ(cells.info.lattice.size, glm::ivec3(3, 4, 5));
    EXPECT_EQ(cells.info.lattice.origin, glm::dvec3(1.25, 2.5, 4));
    EXPECT_EQ(sampleAt(cells, "c", 0, 0, {2, 3, 4}), 432);
    const Dataset lists = openFiles({xdmfCase("lists.xmf")}, {});
    EXPECT_EQ(lists.info.lattice.size, glm::ivec3(4, 5, 6));
    EXPECT_EQ(lists.info.lattice.spacing, glm::dvec3(0.5, 1, 2));
    EXPECT_EQ(sampleAt(lists, "T", 0, 0, {3, 4, 5}), 543);
}

TEST_F(XdmfCases, TimesInAListAndGridsOfOtherFiles) {
    const Dataset list = openFiles({xdmfCase("time_list.xmf")}, {});
    EXPECT_EQ(list.info.times, (std::vector<double>{0.1, 0.7}));
    const Dataset included = openFiles({xdmfCase("included.xmf")}, {});
    EXPECT_EQ(included.info.times, (std::vector<double>{0.5, 3.5}));
    for (const Dataset* dataset : {&list, &included})
        for (const int t : {1, 0, 1}) EXPECT_EQ(sampleAt(*dataset, "T", 0, t, {3, 4, 5}), 543 + 1000 * t);
}

TEST_F(XdmfCases, MeshesOfMeshio) {
    const Dataset series = openFiles({xdmfCase("meshio_series.xdmf")}, {});
    EXPECT_EQ(series.info.times, (std::vector<double>{0, 0.25, 1.5}));
    ASSERT_EQ(series.info.lattice.size, glm::ivec3(3, 3, 3)); // it has values of cells, too
    for (const int t : {2, 0, 1}) {
        const double time = series.info.times[std::size_t(t)];
        EXPECT_NEAR(sampleAt(series, "T", 0, t, {2, 1, 0}), 2.5 + time, 1e-4);
        EXPECT_NEAR(sampleAt(series, "U", 1, t, {2, 1, 0}), 1.5 * time, 1e-6);
    }
    const Dataset mixed = openFiles({xdmfCase("meshio_mixed.xdmf")}, {});
    EXPECT_EQ(mixed.info.bounds.hi, glm::dvec3(3, 3, 5));
}

TEST_F(XdmfCases, BlocksAndUnitsInNames) {
    const Dataset dataset = openFiles({xdmfCase("blocks.xmf")}, {});
    EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(4, 2, 2));
    EXPECT_EQ(dataset.info.parameters[0].name, "p");
    EXPECT_EQ(dataset.info.parameters[0].unit, "Pa");
    EXPECT_EQ(sampleAt(dataset, "p", 0, 0, {0, 0, 0}), 0);
    EXPECT_EQ(sampleAt(dataset, "p", 0, 0, {3, 1, 1}), 9);
    EXPECT_EQ(dataset.info.parameters[1].labels[1].name, "solid");
}

TEST_F(XdmfCases, WhatIsDamagedIsTold) {
    EXPECT_THAT(failure(write("a.xmf", "<Xdmf><Domain>")), testing::HasSubstr("is no XDMF file, or ends early"));
    EXPECT_THAT(failure(write("b.xmf", "<Xdmf><Domain/></Xdmf>")), testing::HasSubstr("holds no grid"));
    const std::string hostile =
        "<Xdmf><Domain><Grid><Topology TopologyType='3DCoRectMesh' Dimensions='90000 90000 90000'/>"
        "<Geometry GeometryType='ORIGIN_DXDYDZ'><DataItem Dimensions='3'>0 0 0</DataItem>"
        "<DataItem Dimensions='3'>1 1 1</DataItem></Geometry></Grid></Domain></Xdmf>";
    EXPECT_THAT(failure(write("c.xmf", hostile)), testing::HasSubstr("more points than memory can hold"));
    const std::string path = write("d.xdmf", read(xdmfCase("blocks.xmf")));
    expectCutsAreTold(path, path);
}

} // namespace
} // namespace tessera::volume
