// Extent and ranges of meshes, which come through tessera-import. Skipped where it was not built.
#include "volume/analysis/statistics.h"
#include "volume/field/mesh_origin.h"
#include "volume/import/foreign.h"
#include "volume/import/import.h"
#include "volume/sources/memory_source.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <unistd.h>

namespace tessera::volume {
namespace {

namespace fs = std::filesystem;

/// A box of hexahedra whose corners lie at these coordinates.
struct Mesh {
    std::array<std::vector<double>, 3> corners;
    glm::ivec3 points() const { return {int(corners[0].size()), int(corners[1].size()), int(corners[2].size())}; }
    glm::ivec3 cells() const { return points() - 1; }
};

template <class Visit> void forEach(glm::ivec3 size, const Visit& visit) {
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) visit(glm::ivec3(x, y, z));
}

/// As a .vtu file with one array of points or cells, `components` numbers each.
std::string vtu(const Mesh& mesh, bool ofCells, const std::vector<double>& values, int components = 1) {
    const glm::ivec3 n = mesh.points();
    const auto point = [&](int x, int y, int z) { return (z * n.y + y) * n.x + x; };
    std::ostringstream out, connectivity, offsets, types, points, numbers;
    points.precision(17);
    numbers.precision(17);
    forEach(n, [&](glm::ivec3 at) {
        for (int axis = 0; axis < 3; ++axis) points << mesh.corners[std::size_t(axis)][std::size_t(at[axis])] << ' ';
    });
    int cells = 0;
    forEach(mesh.cells(), [&](glm::ivec3 at) {
        for (const glm::ivec3 corner :
             {glm::ivec3(0, 0, 0), glm::ivec3(1, 0, 0), glm::ivec3(1, 1, 0), glm::ivec3(0, 1, 0), glm::ivec3(0, 0, 1),
              glm::ivec3(1, 0, 1), glm::ivec3(1, 1, 1), glm::ivec3(0, 1, 1)})
            connectivity << point(at.x + corner.x, at.y + corner.y, at.z + corner.z) << ' ';
        offsets << 8 * ++cells << ' ';
        types << "12 ";
    });
    for (const double value : values) numbers << value << ' ';
    const std::string array = "<DataArray type=\"Float32\" Name=\"T\" NumberOfComponents=\"" +
                              std::to_string(components) + "\" format=\"ascii\">" + numbers.str() + "</DataArray>";
    out << "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\"><UnstructuredGrid><Piece "
        << "NumberOfPoints=\"" << n.x * n.y * n.z << "\" NumberOfCells=\"" << cells << "\">"
        << "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">" << points.str()
        << "</DataArray></Points><Cells><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">"
        << connectivity.str() << "</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">"
        << offsets.str() << "</DataArray><DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">" << types.str()
        << "</DataArray></Cells>" << (ofCells ? "<CellData>" : "<PointData>") << array
        << (ofCells ? "</CellData>" : "</PointData>") << "</Piece></UnstructuredGrid></VTKFile>\n";
    return out.str();
}

ImportOptions onGrid(glm::ivec3 size) {
    ImportOptions options;
    options.gridSize = size;
    return options;
}

class ImportMesh : public testing::Test {
protected:
    void SetUp() override {
        if (findImporter().empty()) GTEST_SKIP() << "tessera-import was not built";
        path_ = (fs::temp_directory_path() / ("tessera_mesh_" + std::to_string(getpid()) + ".vtu")).string();
    }
    void TearDown() override { fs::remove(path_); }
    Dataset opened(const std::string& text, const ImportOptions& options = {}) {
        std::ofstream(path_, std::ios::binary) << text;
        Dataset dataset = openFiles({path_}, options);
        scanRanges(dataset);
        return dataset;
    }
    std::string path_;
};

// Samples lie in the middle of cells, and have their values; the box is that of the mesh, so every cell counts whole.
TEST_F(ImportMesh, CellsKeepTheirValuesAndTheMeshItsBox) {
    const Mesh mesh{{{{0, 1, 2, 3, 4}, {-2, 0, 2, 4}, {10, 13, 16}}}};
    std::vector<double> values;
    forEach(mesh.cells(), [&](glm::ivec3 at) { values.push_back((at.x * 7 + at.y * 5 + at.z * 11) % 13 - 4); });
    const Dataset dataset = opened(vtu(mesh, true, values));
    EXPECT_EQ(dataset.info.bounds, (Box{{0, -2, 10}, {4, 4, 16}}));
    EXPECT_FALSE(isResampled(dataset.info)) << dataset.info.provenance;
    ASSERT_EQ(dataset.info.lattice.size, mesh.cells());
    const Field field = dataset.read(0, 0, 0);
    double sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        EXPECT_EQ(field.value(i), values[i]) << i;
        sum += values[i];
    }
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    EXPECT_EQ(dataset.info.parameters[0].ranges, (std::vector<Range>{{*least, *most}}));
    StatisticsQuery query;
    query.channels = {0};
    const Statistics statistics = computeStatistics(*makeMemorySource(dataset, {}), query);
    EXPECT_EQ(statistics.channels[0].all.samples, double(values.size()));
    EXPECT_NEAR(statistics.channels[0].all.volume, 4 * 6 * 6, 1e-9);
    EXPECT_NEAR(statistics.channels[0].all.mean, sum / double(values.size()), 1e-6);
}

// A linear course is one between the middles of cells too, up to the border of the mesh.
TEST_F(ImportMesh, CellsKeepALinearCourse) {
    const Mesh mesh{{{{0, 1, 2, 3, 4, 5, 6}, {0, 1, 2, 3, 4, 5}, {0, 1, 2, 3, 4}}}};
    std::vector<double> values;
    const auto course = [](glm::dvec3 at) { return 3 * at.x - 2 * at.y + 0.5 * at.z; };
    forEach(mesh.cells(), [&](glm::ivec3 at) { values.push_back(course(glm::dvec3(at) + 0.5)); });
    std::ofstream(path_, std::ios::binary) << vtu(mesh, true, values);
    ImportOptions options;
    options.gridSize = {25, 20, 15};
    const Dataset dataset = openFiles({path_}, options);
    const Field field = dataset.read(0, 0, 0);
    forEach(options.gridSize, [&](glm::ivec3 at) {
        const glm::dvec3 place = dataset.info.lattice.position(at);
        EXPECT_NEAR(field.value(dataset.info.lattice.index(at)), course(place), 1e-4) << place.x << " " << place.y;
    });
}

const Mesh kGraded{{{{0, 1, 3, 7, 15}, {0, 0.5, 1, 1.5}, {2, 2.025, 2.05, 2.06, 2.07, 2.17, 3.17}}}};

// A graded block mesh is kept as it is: a sample for each cell, at its place and with its value, in a cell as thick.
TEST_F(ImportMesh, GradedCellsAreSamples) {
    std::vector<double> values;
    forEach(kGraded.cells(), [&](glm::ivec3 at) { values.push_back((at.x * 7 + at.y * 5 + at.z * 11) % 13 - 4); });
    const Dataset dataset = opened(vtu(kGraded, true, values));
    const Lattice& lattice = dataset.info.lattice;
    ASSERT_EQ(lattice.size, kGraded.cells());
    EXPECT_EQ(dataset.info.bounds, (Box{{0, 0, 2}, {15, 1.5, 3.17}}));
    ASSERT_NE(lattice.axes[0], nullptr);
    EXPECT_EQ(lattice.axes[0]->planes(), kGraded.corners[0]);
    EXPECT_EQ(lattice.axes[1], nullptr);
    ASSERT_NE(lattice.axes[2], nullptr);
    EXPECT_EQ(lattice.axes[2]->planes(), kGraded.corners[2]);
    const Field field = dataset.read(0, 0, 0);
    for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(field.value(i), values[i]) << i;
    EXPECT_NE(std::ranges::find_if(dataset.info.notes,
                                   [](const std::string& note) {
                                       return note.ends_with("sampled on 4 x 3 x 6, one sample for each cell");
                                   }),
              dataset.info.notes.end());

    ImportOptions even;
    even.grid = GridChoice::Even;
    EXPECT_TRUE(opened(vtu(kGraded, true, values), even).info.lattice.isEven());
}

// Values at points are samples on the planes.
TEST_F(ImportMesh, GradedPointsAreSamples) {
    std::vector<double> values;
    forEach(kGraded.points(), [&](glm::ivec3 at) { values.push_back((at.x * 7 + at.y * 5 + at.z * 11) % 13 - 4); });
    const Dataset dataset = opened(vtu(kGraded, false, values));
    ASSERT_EQ(dataset.info.lattice.size, kGraded.points());
    const Field field = dataset.read(0, 0, 0);
    forEach(kGraded.points(), [&](glm::ivec3 at) {
        const std::size_t i = field.lattice.index(at);
        EXPECT_EQ(field.value(i), values[i]) << i;
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(field.lattice.position(at)[axis], kGraded.corners[std::size_t(axis)][std::size_t(at[axis])],
                        1e-14);
    });
}

/// A rectilinear grid of values of cells.
std::string vtr(const Mesh& mesh, const std::vector<double>& values) {
    const glm::ivec3 last = mesh.points() - 1;
    std::ostringstream out;
    out.precision(17);
    const auto array = [&](const char* name, const std::vector<double>& numbers) {
        out << "<DataArray type=\"Float64\" Name=\"" << name << "\" format=\"ascii\">";
        for (const double number : numbers) out << number << ' ';
        out << "</DataArray>";
    };
    std::ostringstream extent;
    extent << "0 " << last.x << " 0 " << last.y << " 0 " << last.z;
    out << "<VTKFile type=\"RectilinearGrid\" version=\"1.0\" byte_order=\"LittleEndian\"><RectilinearGrid "
           "WholeExtent=\""
        << extent.str() << "\"><Piece Extent=\"" << extent.str() << "\"><CellData>";
    array("T", values);
    out << "</CellData><Coordinates>";
    for (int axis = 0; axis < 3; ++axis) array(std::string(1, "xyz"[axis]).c_str(), mesh.corners[std::size_t(axis)]);
    out << "</Coordinates></Piece></RectilinearGrid></VTKFile>\n";
    return out.str();
}

// A grid is kept as it is: its axes, its values, and the box that it has, flat or not.
TEST_F(ImportMesh, UnevenGridsKeepTheirAxes) {
    path_.replace(path_.size() - 3, 3, "vtr");
    std::vector<double> values;
    forEach(kGraded.cells(), [&](glm::ivec3 at) { values.push_back((at.x * 7 + at.y * 5 + at.z * 11) % 13 - 4); });
    const Dataset dataset = opened(vtr(kGraded, values));
    ASSERT_EQ(dataset.info.lattice.size, kGraded.cells());
    EXPECT_EQ(dataset.info.bounds, (Box{{0, 0, 2}, {15, 1.5, 3.17}}));
    ASSERT_NE(dataset.info.lattice.axes[2], nullptr);
    EXPECT_EQ(dataset.info.lattice.axes[2]->planes(), kGraded.corners[2]);
    EXPECT_FALSE(isResampled(dataset.info));
    const Field field = dataset.read(0, 0, 0);
    for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(field.value(i), values[i]) << i;

    Mesh flat = kGraded;
    flat.corners[2] = {0.5};
    std::vector<double> plane(values.begin(), values.begin() + 12);
    const Dataset sheet = opened(vtr(flat, plane));
    EXPECT_EQ(sheet.info.lattice.size, glm::ivec3(4, 3, 1));
    EXPECT_EQ(sheet.info.bounds, (Box{{0, 0, 0.5}, {15, 1.5, 0.5}}));

    // Evenly on request: the linear course of a grid of cells stays linear.
    const Dataset even = opened(vtr(kGraded, values), onGrid({15, 3, 20}));
    EXPECT_EQ(even.info.lattice.size, glm::ivec3(15, 3, 20));
    EXPECT_TRUE(even.info.lattice.isEven());
}

// A wall where cells have been graded towards it: no slope is lost, and no value leaves the course.
TEST_F(ImportMesh, CellsOfAGradedMeshKeepALinearCourseOnAFinerGrid) {
    std::vector<double> values;
    const auto course = [](glm::dvec3 at) { return 300 + 3 * at.x - 2 * at.y + 20 * at.z; };
    forEach(kGraded.cells(), [&](glm::ivec3 at) {
        glm::dvec3 middle;
        for (int axis = 0; axis < 3; ++axis) {
            const auto& corners = kGraded.corners[std::size_t(axis)];
            middle[axis] = 0.5 * (corners[std::size_t(at[axis])] + corners[std::size_t(at[axis]) + 1]);
        }
        values.push_back(course(middle));
    });
    const Dataset dataset = opened(vtu(kGraded, true, values), onGrid({30, 9, 40}));
    const Field field = dataset.read(0, 0, 0);
    forEach(field.lattice.size, [&](glm::ivec3 at) {
        EXPECT_NEAR(field.value(field.lattice.index(at)), course(field.lattice.position(at)), 1e-3)
            << at.x << " " << at.y << " " << at.z;
    });
}

// The peak lies at a point that no sample of the grid meets.
TEST_F(ImportMesh, RangesAreThoseOfThePoints) {
    const Mesh mesh{{{{0, 0.13, 0.21, 1}, {0, 0.5, 1}, {2, 2.07, 3}}}};
    std::vector<double> values;
    forEach(mesh.points(), [&](glm::ivec3 at) {
        const bool peak = at == glm::ivec3(1, 1, 1);
        for (const double value : {peak ? 12.5 : 1.0, peak ? -7.25 : 0.5, 0.0}) values.push_back(value);
    });
    const Dataset dataset = opened(vtu(mesh, false, values, 3), onGrid({9, 9, 9}));
    EXPECT_EQ(dataset.info.bounds, (Box{{0, 0, 2}, {1, 1, 3}}));
    const std::vector<Range> wanted{{1, 12.5}, {-7.25, 0.5}, {0, 0}, {std::hypot(1, 0.5), std::hypot(12.5, 7.25)}};
    ASSERT_EQ(dataset.info.parameters[0].ranges.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(dataset.info.parameters[0].ranges[i].lo, wanted[i].lo, 1e-12) << i;
        EXPECT_NEAR(dataset.info.parameters[0].ranges[i].hi, wanted[i].hi, 1e-12) << i;
    }
    double most = 0;
    const Field field = dataset.read(0, 0, 0);
    for (std::size_t i = 0; i < field.count(); ++i) most = std::max(most, field.value(i));
    EXPECT_LT(most, 12.5) << "samples alone do not tell";
}

} // namespace
} // namespace tessera::volume
