// Vectors and tensors on the points and the cells of meshes: every component is a linear function of place of its own,
// and has to be that one on the grid the mesh is resampled to.
#include "tests/import/foreign_files.h"

#include <array>
#include <cmath>
#include <sstream>

namespace tessera::volume {
namespace {

using MeshComponents = ForeignFiles;

constexpr glm::ivec3 kCells(6, 5, 4);
constexpr double kEdge = 0.5;

/// An array of the file. Of integers the functions have whole numbers at the points and cells.
struct Made {
    std::string name;
    int components = 1;
    bool ofCells = false, integer = false;
};
const std::vector<Made> kMade{{"s", 1},
                              {"w", 2},
                              {"v", 3},
                              {"sym", 6},
                              {"t", 9},
                              {"cs", 1, true},
                              {"cw", 2, true},
                              {"cv", 3, true},
                              {"csym", 6, true},
                              {"ct", 9, true},
                              {"iv", 3, false, true},
                              {"civ", 3, true, true}};

struct Linear {
    double offset = 0;
    glm::dvec3 slope{0};
    double at(glm::dvec3 place) const { return offset + slope.x * place.x + slope.y * place.y + slope.z * place.z; }
};
/// Far enough from each other that no component is mistaken for another.
Linear courseOf(const Made& made, int component, int time) {
    const auto number = double(&made - kMade.data());
    const double c = component;
    if (made.integer)
        return {1000 * (c + 1) + 100 * time, glm::dvec3(4 + 4 * c, 12 - 4 * c, 20 * time - 8) / kEdge / 2.0};
    return {70 * c + 1000 * number + 500 * time, {1 + c, 2 - 0.7 * c, time - 1.5 + 0.3 * c}};
}

template <class Visit> void forAll(glm::ivec3 size, const Visit& visit) {
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) visit(glm::ivec3(x, y, z));
}

std::string dataArray(const std::string& name, const std::string& type, int components, const std::string& numbers) {
    return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" + std::to_string(components) +
           "\" format=\"ascii\">" + numbers + "</DataArray>\n";
}

/// A box of cubes, or of tetrahedra, six in a cube, as a .vtu file.
std::string meshFile(bool tetrahedra, int time) {
    const glm::ivec3 count = kCells + 1;
    std::vector<glm::dvec3> points, middles;
    forAll(count, [&](glm::ivec3 at) { points.push_back(kEdge * glm::dvec3(at)); });
    std::ostringstream places, connectivity, offsets, types;
    for (const glm::dvec3& point : points) places << point.x << ' ' << point.y << ' ' << point.z << ' ';
    int ends = 0;
    const auto add = [&](const std::vector<int>& corners) {
        glm::dvec3 sum(0);
        for (const int corner : corners) connectivity << corner << ' ', sum += points[std::size_t(corner)];
        middles.push_back(sum / double(corners.size()));
        offsets << (ends += int(corners.size())) << ' ';
        types << (tetrahedra ? "10 " : "12 ");
    };
    forAll(kCells, [&](glm::ivec3 at) {
        const int a = (at.z * count.y + at.y) * count.x + at.x, dy = count.x, dz = count.x * count.y;
        if (!tetrahedra) {
            add({a, a + 1, a + 1 + dy, a + dy, a + dz, a + 1 + dz, a + 1 + dy + dz, a + dy + dz});
            return;
        }
        // Along the diagonal: one for each order of the axes.
        const std::array<int, 3> steps{1, dy, dz};
        std::array<int, 3> order{0, 1, 2};
        do {
            const int b = a + steps[std::size_t(order[0])], c = b + steps[std::size_t(order[1])];
            const int d = c + steps[std::size_t(order[2])];
            const bool even = order[1] == (order[0] + 1) % 3;
            add(even ? std::vector<int>{a, b, c, d} : std::vector<int>{a, c, b, d});
        } while (std::next_permutation(order.begin(), order.end()));
    });
    std::ostringstream out, ofPoints, ofCells;
    for (const Made& made : kMade) {
        std::ostringstream numbers;
        numbers.precision(12);
        for (const glm::dvec3& place : made.ofCells ? middles : points)
            for (int c = 0; c < made.components; ++c) {
                const double value = courseOf(made, c, time).at(place);
                numbers << (made.integer ? std::rint(value) : value) << ' ';
            }
        (made.ofCells ? ofCells : ofPoints)
            << dataArray(made.name, made.integer ? "Int32" : "Float32", made.components, numbers.str());
    }
    out << "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\"><UnstructuredGrid><Piece "
        << "NumberOfPoints=\"" << points.size() << "\" NumberOfCells=\"" << middles.size() << "\"><Points>"
        << dataArray("Points", "Float64", 3, places.str()) << "</Points><Cells>"
        << dataArray("connectivity", "Int64", 1, connectivity.str()) << dataArray("offsets", "Int64", 1, offsets.str())
        << dataArray("types", "UInt8", 1, types.str()) << "</Cells><PointData>" << ofPoints.str()
        << "</PointData><CellData>" << ofCells.str() << "</CellData></Piece></UnstructuredGrid></VTKFile>\n";
    return out.str();
}

/// How far a sample may be from its function: values of cells and integers are not interpolated all the way.
double allowed(const Made& made, const Linear& course, bool tetrahedra) {
    const double acrossCell = kEdge * (std::abs(course.slope.x) + std::abs(course.slope.y) + std::abs(course.slope.z));
    if (made.integer) return acrossCell + 0.5;
    return made.ofCells && tetrahedra ? 0.5 * acrossCell : 2e-6 * (1 + std::abs(course.offset)) + 1e-4;
}

void expectEveryComponent(const Dataset& dataset, bool tetrahedra) {
    const DatasetInfo& info = dataset.info;
    const glm::dvec3 end = kEdge * glm::dvec3(kCells);
    ASSERT_EQ(info.times.size(), 2u);
    for (const Made& made : kMade)
        for (int component = 0; component < made.components; ++component) {
            // Three numbers are a vector, others stand for themselves.
            const bool alone = made.components == 1 || made.components == 3;
            const std::string name = alone ? made.name : made.name + "." + std::to_string(component);
            const auto found = std::ranges::find(info.parameters, name, &Parameter::name);
            ASSERT_NE(found, info.parameters.end()) << name;
            ASSERT_EQ(found->components, alone ? made.components : 1) << name;
            ASSERT_EQ(found->type, made.integer ? ScalarType::I32 : ScalarType::F32) << name;
            for (int time = 0; time < 2; ++time) {
                const Field field = dataset.read(int(found - info.parameters.begin()), alone ? component : 0, time);
                const Linear course = courseOf(made, component, time);
                const double most = allowed(made, course, tetrahedra);
                int inner = 0;
                double worst = 0;
                forAll(info.lattice.size, [&](glm::ivec3 at) {
                    const std::size_t i = info.lattice.index(at);
                    const glm::dvec3 place = info.lattice.position(at);
                    EXPECT_TRUE(field.present(i));
                    bool border = false; // where cells have no neighbour their course levels off
                    for (int axis = 0; axis < 3; ++axis)
                        border = border || place[axis] < 1.001 * kEdge || place[axis] > end[axis] - 1.001 * kEdge;
                    if (made.ofCells && border) return;
                    ++inner;
                    worst = std::max(worst, std::abs(field.value(i) - course.at(place)));
                });
                EXPECT_LE(worst, most) << name << " component " << component << " time " << time;
                EXPECT_GT(inner, 100) << name;
            }
        }
    std::size_t parameters = 0;
    for (const Made& made : kMade)
        parameters += std::size_t(made.components == 1 || made.components == 3 ? 1 : made.components);
    EXPECT_EQ(info.parameters.size(), parameters);
}

TEST_F(MeshComponents, AreEachTheirOwnFunctionOnCubesAndTetrahedra) {
    for (const bool tetrahedra : {false, true}) {
        SCOPED_TRACE(tetrahedra ? "tetrahedra" : "cubes");
        const std::string first = write("a_0.vtu", meshFile(tetrahedra, 0));
        const std::string second = write("a_1.vtu", meshFile(tetrahedra, 1));
        ImportOptions options;
        options.gridSize = {14, 11, 9};
        options.autoAbsent = false;
        options.parts = {"*=joined"};
        expectEveryComponent(openFiles({first, second}, options), tetrahedra);
    }
}

} // namespace
} // namespace tessera::volume
