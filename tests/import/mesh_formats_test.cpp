// CGNS, Exodus, Fluent and PLOT3D: small meshes with a linear field, whole and cut.
#include "tests/import/foreign_files.h"

#include <hdf5.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkExodusIIWriter.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>
#include <vtk_netcdf.h>

namespace tessera::volume {
namespace {

using MeshFormats = ForeignFiles;

constexpr glm::ivec3 kSize(5, 4, 6);

glm::dvec3 place(int i, int j, int k) {
    return {0.5 * i, 2 + 0.25 * j, 1.0 * k};
}
double value(glm::dvec3 x) {
    return 300 + x.x + 2 * x.y + 3 * x.z;
}
template <class T> std::vector<T> overGrid(auto&& of) {
    std::vector<T> out;
    for (int k = 0; k < kSize.z; ++k)
        for (int j = 0; j < kSize.y; ++j)
            for (int i = 0; i < kSize.x; ++i) out.push_back(static_cast<T>(of(place(i, j, k))));
    return out;
}

void expectLinear(const Dataset& dataset, const char* name) {
    const auto channel = dataset.info.findChannel(name);
    ASSERT_TRUE(channel) << name;
    const Field field = dataset.read(dataset.info.channel(*channel).parameter, 0, 0);
    const Lattice& lattice = dataset.info.lattice;
    int present = 0;
    for (int k = 0; k < lattice.size.z; ++k)
        for (int j = 0; j < lattice.size.y; ++j)
            for (int i = 0; i < lattice.size.x; ++i) {
                const std::size_t at = lattice.index({i, j, k});
                if (!field.present(at)) continue;
                ++present;
                ASSERT_NEAR(field.value(at), value(lattice.position({i, j, k})), 1e-3) << i << " " << j << " " << k;
            }
    EXPECT_EQ(present, int(lattice.count()));
}

/// A node of CGNS in HDF5: a group with words as attributes and its numbers in " data".
hid_t node(hid_t parent, const char* name, const char* label, const char* type) {
    const hid_t ordered = H5Pcreate(H5P_GROUP_CREATE); // CGNS lists nodes in the order they were made
    H5Pset_link_creation_order(ordered, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
    const hid_t group = H5Gcreate2(parent, name, H5P_DEFAULT, ordered, H5P_DEFAULT);
    H5Pclose(ordered);
    const auto word = [&](const char* key, const char* text, std::size_t bytes) {
        const hid_t kind = H5Tcopy(H5T_C_S1), one = H5Screate(H5S_SCALAR);
        H5Tset_size(kind, bytes);
        const std::string filled = inBytes(text, bytes);
        const hid_t attribute = H5Acreate2(group, key, kind, one, H5P_DEFAULT, H5P_DEFAULT);
        H5Awrite(attribute, kind, filled.data());
        H5Aclose(attribute);
        H5Sclose(one);
        H5Tclose(kind);
    };
    word("name", name, 33);
    word("label", label, 33);
    word("type", type, 3);
    const hsize_t count = 1;
    const int flags = 1;
    const hid_t one = H5Screate_simple(1, &count, nullptr);
    const hid_t attribute = H5Acreate2(group, "flags", H5T_NATIVE_INT, one, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(attribute, H5T_NATIVE_INT, &flags);
    H5Aclose(attribute);
    H5Sclose(one);
    return group;
}
void put(hid_t group, const char* name, std::vector<hsize_t> dims, hid_t type, const void* data) {
    const hid_t space = H5Screate_simple(int(dims.size()), dims.data(), nullptr);
    const hid_t dataset = H5Dcreate2(group, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
    H5Dclose(dataset);
    H5Sclose(space);
}

/// `length`: the word of DimensionalUnits_t; "": there is none.
void writeCgns(const std::string& path, const std::string& length = "") {
    const hid_t ordered = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_link_creation_order(ordered, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
    const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, ordered, H5P_DEFAULT);
    H5Pclose(ordered);
    const auto rootWord = [&](const char* key, const char* text, std::size_t bytes) {
        const hid_t kind = H5Tcopy(H5T_C_S1), one = H5Screate(H5S_SCALAR);
        H5Tset_size(kind, bytes);
        const std::string filled = inBytes(text, bytes);
        const hid_t attribute = H5Acreate2(file, key, kind, one, H5P_DEFAULT, H5P_DEFAULT);
        H5Awrite(attribute, kind, filled.data());
        H5Aclose(attribute);
        H5Sclose(one);
        H5Tclose(kind);
    };
    rootWord("name", "HDF5 MotherNode", 33);
    rootWord("label", "Root Node of HDF5 File", 33);
    rootWord("type", "MT", 3);
    put(file, " format", {15}, H5T_NATIVE_CHAR, inBytes("IEEE_LITTLE_32", 15).data());
    put(file, " hdf5version", {33}, H5T_NATIVE_CHAR, inBytes("HDF5 Version 1.10.8", 33).data());
    std::vector<hid_t> open;
    const auto add = [&](hid_t parent, const char* name, const char* label, const char* type) {
        open.push_back(node(parent, name, label, type));
        return open.back();
    };
    const float version = 3.3f;
    put(add(file, "CGNSLibraryVersion", "CGNSLibraryVersion_t", "R4"), " data", {1}, H5T_NATIVE_FLOAT, &version);
    const hid_t base = add(file, "Base", "CGNSBase_t", "I4");
    put(base, " data", {2}, H5T_NATIVE_INT, std::vector<int>{3, 3}.data());
    if (!length.empty()) {
        std::string words;
        for (const std::string& word :
             {std::string("Kilogram"), length, std::string("Second"), std::string("Kelvin"), std::string("Radian")})
            words += word + std::string(32 - word.size(), ' ');
        put(add(base, "DimensionalUnits", "DimensionalUnits_t", "C1"), " data", {5, 32}, H5T_NATIVE_CHAR, words.data());
    }
    const hid_t zone = add(base, "Zone", "Zone_t", "I4");
    put(zone, " data", {3, 3}, H5T_NATIVE_INT, std::vector<int>{5, 4, 6, 4, 3, 5, 0, 0, 0}.data());
    put(add(zone, "ZoneType", "ZoneType_t", "C1"), " data", {10}, H5T_NATIVE_CHAR, "Structured");
    const hid_t grid = add(zone, "GridCoordinates", "GridCoordinates_t", "MT");
    for (int axis = 0; axis < 3; ++axis)
        put(add(grid, ("Coordinate" + std::string(1, char('X' + axis))).c_str(), "DataArray_t", "R8"), " data",
            {6, 4, 5}, H5T_NATIVE_DOUBLE, overGrid<double>([&](glm::dvec3 x) { return x[axis]; }).data());
    const hid_t solution = add(zone, "FlowSolution", "FlowSolution_t", "MT");
    put(add(solution, "GridLocation", "GridLocation_t", "C1"), " data", {6}, H5T_NATIVE_CHAR, "Vertex");
    const hid_t temperature = add(solution, "Temperature", "DataArray_t", "R8");
    put(temperature, " data", {6, 4, 5}, H5T_NATIVE_DOUBLE, overGrid<double>(value).data());
    if (!length.empty())
        put(add(temperature, "DimensionalExponents", "DimensionalExponents_t", "R4"), " data", {5}, H5T_NATIVE_FLOAT,
            std::vector<float>{0, 0, 0, 1, 0}.data());
    for (const hid_t group : open) H5Gclose(group);
    H5Fclose(file);
}

TEST_F(MeshFormats, Cgns) {
    const std::string path = (folder_ / "a.cgns").string();
    writeCgns(path);
    const Dataset dataset = openFiles({path}, {});
    EXPECT_EQ(dataset.info.lattice.size, kSize); // its steps are even: samples stay as they are
    expectLinear(dataset, "Temperature");
    EXPECT_EQ(dataset.info.parameters[0].unit, "K");
    EXPECT_TRUE(dataset.info.parameters[0].unitGuessed);
    EXPECT_EQ(dataset.info.lengthUnit, "") << "none is stated";
    expectCutsAreTold(path, path, {}, 16);
    for (const auto& [word, unit] :
         {std::pair{"Meter", "m"}, {"Millimeter", "mm"}, {"Inch", "in"}, {"UserDefined", ""}}) {
        writeCgns(path, word);
        const DatasetInfo info = openFiles({path}, {}).info;
        EXPECT_EQ(info.lengthUnit, unit) << word;
        EXPECT_EQ(info.parameters[0].unit, "K");
        EXPECT_FALSE(info.parameters[0].unitGuessed) << "the file states it";
    }
}

// VTK's reader shows memory that nobody wrote for such a file.
TEST_F(MeshFormats, ExodusOfTwoFormsIsRefused) {
    int file = 0, dimension = 0, step = 0, variable = 0;
    const std::string path = (folder_ / "mixed.e").string();
    ASSERT_EQ(nc_create(path.c_str(), NC_CLOBBER, &file), NC_NOERR);
    const int wordSize = 8;
    nc_put_att_int(file, NC_GLOBAL, "floating_point_word_size", NC_INT, 1, &wordSize);
    nc_def_dim(file, "time_step", 1, &step);
    nc_def_dim(file, "num_nodes", 8, &dimension);
    const int axes[2] = {step, dimension};
    nc_def_var(file, "vals_nod_var1", NC_DOUBLE, 2, axes, &variable);
    nc_enddef(file);
    const std::vector<double> values(8, 1);
    nc_put_var_double(file, variable, values.data());
    nc_close(file);
    EXPECT_THAT(failure(path), testing::HasSubstr("mixes the two forms of Exodus (vals_nod_var1)"));
}

TEST_F(MeshFormats, Exodus) {
    vtkNew<vtkUnstructuredGrid> mesh;
    vtkNew<vtkPoints> points;
    vtkNew<vtkDoubleArray> t, cells;
    t->SetName("Temp");
    cells->SetName("source");
    for (int k = 0; k < kSize.z; ++k)
        for (int j = 0; j < kSize.y; ++j)
            for (int i = 0; i < kSize.x; ++i) {
                const glm::dvec3 x = place(i, j, k);
                points->InsertNextPoint(x.x, x.y, x.z);
                t->InsertNextValue(value(x));
            }
    for (int k = 0; k + 1 < kSize.z; ++k)
        for (int j = 0; j + 1 < kSize.y; ++j)
            for (int i = 0; i + 1 < kSize.x; ++i) {
                const vtkIdType a = (k * 4 + j) * 5 + i;
                const vtkIdType corners[8] = {a, a + 1, a + 6, a + 5, a + 20, a + 21, a + 26, a + 25};
                mesh->InsertNextCell(12, 8, corners);
                cells->InsertNextValue(7);
            }
    mesh->SetPoints(points);
    mesh->GetPointData()->AddArray(t);
    mesh->GetCellData()->AddArray(cells);
    const std::string path = (folder_ / "a.exo").string();
    vtkNew<vtkExodusIIWriter> writer;
    writer->SetFileName(path.c_str());
    writer->SetInputData(mesh);
    writer->Write();
    ImportOptions options;
    options.gridSize = kSize;
    const Dataset dataset = openFiles({path}, options);
    expectLinear(dataset, "Temp");
    const auto source = dataset.info.findChannel("source");
    ASSERT_TRUE(source);
    expectCutsAreTold(path, path, options, 16);
}

TEST_F(MeshFormats, Fluent) {
    const std::string cas = write(
        "a.cas",
        "(0 \"two cells\")\n(2 3)\n(10 (0 1 C 0 3))\n(10 (1 1 C 1 3)(\n0 0 0\n1 0 0\n2 0 0\n0 1 0\n1 1 0\n2 1 0\n0 "
        "0 1\n1 0 1\n2 0 1\n0 1 1\n1 1 1\n2 1 1\n))\n(12 (0 1 2 0))\n(12 (1 1 2 1 4))\n(13 (0 1 B 0))\n(13 (2 1 "
        "1 2 4)(\n2 5 B 8 1 2\n))\n(13 (3 2 B 3 4)(\n1 7 A 4 1 0\n3 6 C 9 2 0\n1 2 8 7 1 0\n2 3 9 8 2 0\n4 A B 5 1 "
        "0\n5 B C 6 2 0\n1 4 5 2 1 0\n2 5 6 3 2 0\n7 8 B A 1 0\n8 9 C B 2 0\n))\n");
    const std::string dat = write(
        "a.dat", "(0 \"values\")\n(33 (2 11 12))\n(300 (3 1 1 0 0 1 2)(\n300.5\n400.25\n))\n(300 (1 1 1 0 0 1 2)(\n"
                 "1000\n2000\n))\n");
    ImportOptions options;
    options.gridSize = {4, 2, 2};
    const Dataset dataset = openFiles({cas}, options);
    ASSERT_EQ(dataset.info.parameters.size(), 2u);
    for (const Parameter& parameter : dataset.info.parameters) {
        const int p = int(&parameter - dataset.info.parameters.data());
        const Field field = dataset.read(p, 0, 0);
        for (std::size_t i = 0; i < field.count(); ++i) {
            ASSERT_TRUE(field.present(i));
            // The slope from one cell to the other goes on to the walls, and the range says so.
            EXPECT_GE(field.value(i), parameter.ranges[0].lo - 1e-3) << parameter.name;
            EXPECT_LE(field.value(i), parameter.ranges[0].hi + 1e-3) << parameter.name;
        }
        EXPECT_LT(field.value(0), field.value(3)) << parameter.name;
    }
    expectCutsAreTold(cas, cas, options, 30);
    // These cuts lie within sections.
    expectCutsAreTold(cas, dat, options, 19);
    // Between two sections nothing tells how many follow: no variables are an error, fewer are as in the whole file.
    const std::string whole = read(dat);
    for (std::size_t at = whole.find("\n(", 1); at != std::string::npos; at = whole.find("\n(", at + 1)) {
        write("a.dat", whole.substr(0, at + 1));
        const bool none = whole.substr(0, at).find("(300 ") == std::string::npos;
        EXPECT_EQ(failure(cas, options).empty(), !none);
        if (none) continue;
        const Dataset cut = openFiles({cas}, options);
        ASSERT_EQ(cut.info.parameters.size(), 1u);
        const auto same = std::ranges::find(dataset.info.parameters, cut.info.parameters[0].name, &Parameter::name);
        ASSERT_NE(same, dataset.info.parameters.end());
        const Field some = cut.read(0, 0, 0);
        write("a.dat", whole);
        const Field all = openFiles({cas}, options).read(int(same - dataset.info.parameters.begin()), 0, 0);
        for (std::size_t i = 0; i < some.count(); ++i) EXPECT_EQ(some.value(i), all.value(i));
    }
    write("a.dat", whole);
    EXPECT_THAT(failure(dat), testing::HasSubstr("open the .cas file"));
    fs::remove(dat);
    EXPECT_THAT(failure(cas), testing::HasSubstr("without values"));
}

TEST_F(MeshFormats, Plot3d) {
    const std::string dims = bytesOf(std::vector<std::int32_t>{5, 4, 6}, true);
    std::string grid = dims, solution = dims + bytesOf(std::vector<float>{0.5f, 0, 1e6f, 0}, true);
    for (int axis = 0; axis < 3; ++axis) grid += bytesOf(overGrid<float>([&](glm::dvec3 x) { return x[axis]; }), true);
    for (int n = 0; n < 5; ++n) solution += bytesOf(overGrid<float>(value), true);
    const std::string path = write("a.xyz", grid), values = write("a.q", solution);
    const Dataset dataset = openFiles({path}, {});
    EXPECT_EQ(dataset.info.lattice.size, kSize);
    expectLinear(dataset, "Density");
    expectCutsAreTold(path, path, {}, 16);
    expectCutsAreTold(path, values, {}, 16);
    fs::remove(values);
    EXPECT_THAT(failure(path), testing::HasSubstr("without values"));
}

} // namespace
} // namespace tessera::volume
