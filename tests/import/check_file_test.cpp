// Truncated files: one line of reason, or exactly what the whole file holds. Never zeros.
#include "tests/import/foreign_files.h"
#include "volume/export/export.h"

namespace tessera::volume {
namespace {

using WholeFile = ForeignFiles;

constexpr int kX = 5, kY = 4, kZ = 6, kCount = kX * kY * kZ;

template <class T> std::vector<T> numbers(int seed, std::size_t count = kCount) {
    std::vector<T> out(count);
    for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<T>(1.25 + double((i * 37 + std::size_t(seed)) % 101));
    return out;
}
std::string asText(const std::vector<float>& values, const char* between = " ") {
    std::string out;
    for (const float value : values) out += std::to_string(value) + between;
    return out;
}

std::string legacy(bool binary) {
    std::string out = "# vtk DataFile Version 3.0\nx\n" + std::string(binary ? "BINARY" : "ASCII") +
                      "\nDATASET STRUCTURED_POINTS\nDIMENSIONS 5 4 6\nORIGIN 0 0 0\nSPACING 1 2 3\nPOINT_DATA 120\n"
                      "FIELD FieldData 2\n";
    const auto values = [&](int seed, std::size_t count) {
        return (binary ? bytesOf(numbers<float>(seed, count), true) : asText(numbers<float>(seed, count))) + "\n";
    };
    out += "T 1 120 float\n" + values(1, kCount);
    out += "p 1 120 float\n" + values(2, kCount);
    return out + "VECTORS U float\n" + values(3, 3 * kCount);
}

TEST_F(WholeFile, LegacyVtk) {
    for (const bool binary : {true, false}) {
        const std::string path = write("a.vtk", legacy(binary));
        expectCutsAreTold(path, path);
    }
}

/// Where the bytes can tell that something is missing they do; where they cannot, arrays are fewer and the rest is as
/// in the whole file.
TEST_F(WholeFile, LegacyVtkCutBetweenItsSections) {
    for (const bool binary : {true, false}) {
        const auto values = [&](int seed, std::size_t count) {
            return (binary ? bytesOf(numbers<float>(seed, count), true) : asText(numbers<float>(seed, count))) + "\n";
        };
        const std::vector<std::pair<std::string, std::string>> sections{
            {"# vtk DataFile Version 3.0\nx\n" + std::string(binary ? "BINARY" : "ASCII") + "\n", ""},
            {"DATASET STRUCTURED_POINTS\nDIMENSIONS 5 4 6\nORIGIN 0 0 0\nSPACING 1 2 3\n", ""},
            {"POINT_DATA 120\n", ""},
            {"SCALARS T float 1\n", ""},
            {"LOOKUP_TABLE default\n", ""},
            {values(1, kCount), "T"},
            {"FIELD FieldData 2\n", ""},
            {"p 1 120 float\n", ""},
            {values(2, kCount), ""},
            {"q 1 120 float\n", ""},
            {values(3, kCount), "T p q"},
            {"VECTORS U float\n", ""},
            {values(4, 3 * kCount), "T p q U"},
            {"CELL_DATA 60\n", ""},
            {"SCALARS c float 1\nLOOKUP_TABLE default\n", ""},
            {values(5, 60), "T p q U"}}; // of cells beside points none are taken
        std::string text, whole;
        for (const auto& section : sections) whole += section.first;
        const Dataset wanted = openFiles({write("whole.vtk", whole)}, {});
        for (const auto& [section, arrays] : sections) {
            text += section;
            const std::string path = write("cut.vtk", text);
            if (arrays.empty()) {
                EXPECT_NE(failure(path), "") << text.size() << (binary ? " bytes" : " characters");
                continue;
            }
            const Dataset dataset = openFiles({path}, {});
            std::string found;
            for (std::size_t p = 0; p < dataset.info.parameters.size(); ++p) {
                found += (found.empty() ? "" : " ") + dataset.info.parameters[p].name;
                const Field field = dataset.read(int(p), 0, 0), same = wanted.read(int(p), 0, 0);
                for (std::size_t i = 0; i < field.count(); ++i) ASSERT_EQ(field.value(i), same.value(i));
            }
            EXPECT_EQ(found, arrays);
        }
    }
}

TEST_F(WholeFile, LegacyVtkOfTheFuelCellAsItWasReported) {
    const std::string archive = testData("fuel-cell/other-formats.tar.xz");
    if (archive.empty()) GTEST_SKIP() << "no test data";
    const std::string name = "formats/open_small_last_legacy_binary.vtk";
    ASSERT_EQ(std::system(("tar xJf '" + archive + "' -C '" + folder_.string() + "' " + name).c_str()), 0);
    const std::string path = (folder_ / name).string();
    expectCutsAreTold(path, path, {}, 12);
}

TEST_F(WholeFile, LegacyVtkUnstructured) {
    std::string text = "# vtk DataFile Version 3.0\nx\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 float\n";
    text += bytesOf(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1}, true);
    text += "\nCELLS 1 9\n" + bytesOf(std::vector<std::int32_t>{8, 0, 1, 2, 3, 4, 5, 6, 7}, true);
    text += "\nCELL_TYPES 1\n" + bytesOf(std::int32_t(12), true) + "\nPOINT_DATA 8\nSCALARS T double\n";
    text += "LOOKUP_TABLE default\n" + bytesOf(numbers<double>(1, 8), true) + "\n";
    const std::string path = write("a.vtk", text);
    expectCutsAreTold(path, path, {}, 40);
}

TEST_F(WholeFile, VtkXml) {
    Dataset dataset;
    dataset.info.lattice.size = {kX, kY, kZ};
    dataset.info.parameters = {{"T", "K", 1, ScalarType::F32, false, {}, {}},
                               {"U", "m/s", 3, ScalarType::F32, false, {}, {}}};
    dataset.read = [](int p, int c, int) {
        Field field = makeField(Lattice{.size = {kX, kY, kZ}}, ScalarType::F32);
        std::ranges::copy(numbers<float>(p * 3 + c), field.as<float>().begin());
        return field;
    };
    const std::string path = (folder_ / "a.vti").string();
    exportDataset(dataset, {}, path);
    expectCutsAreTold(path, path);
    const std::string parts = write("a.vtm", "<?xml version=\"1.0\"?><VTKFile type=\"vtkMultiBlockDataSet\" "
                                             "version=\"1.0\"><vtkMultiBlockDataSet><DataSet index=\"0\" "
                                             "file=\"a.vti\"/></vtkMultiBlockDataSet></VTKFile>\n");
    expectCutsAreTold(parts, parts);
    expectCutsAreTold(parts, path);
    EXPECT_THAT(failure(write("b.vtm", "<VTKFile type=\"vtkMultiBlockDataSet\"><vtkMultiBlockDataSet><DataSet index=\"0"
                                       "\" file=\"gone.vti\"/></vtkMultiBlockDataSet></VTKFile>\n")),
                testing::HasSubstr("gone.vti"));
}

TEST_F(WholeFile, Raw) {
    write("a.json", "{\"dims\": [5, 4, 6], \"dtype\": \"float32\"}\n");
    const std::string path = write("a.raw", bytesOf(numbers<float>(1)));
    EXPECT_EQ(expectCutsAreTold(path, path), 15); // every one
    expectCutsAreTold(path, (folder_ / "a.json").string(), {}, 10);
}

TEST_F(WholeFile, Nrrd) {
    const std::string head = "NRRD0004\ntype: float\ndimension: 3\nsizes: 5 4 6\nendian: little\nencoding: ";
    const std::string samples = bytesOf(numbers<float>(1));
    for (const auto& [encoding, data] : {std::pair<std::string, std::string>("raw", samples),
                                         {"gzip", stored(samples, false)},
                                         {"ascii", asText(numbers<float>(1), "\n")}}) {
        const std::string path = write("a.nrrd", head + encoding + "\n\n" + data);
        expectCutsAreTold(path, path);
        const std::string detached = write("b.nhdr", head + encoding + "\ndata file: b.dat\n\n");
        write("b.dat", data);
        expectCutsAreTold(detached, (folder_ / "b.dat").string());
    }
}

TEST_F(WholeFile, NrrdAsTextHoldsItsNumbers) {
    const std::string head = "NRRD0004\ntype: float\ndimension: 3\nsizes: 5 4 6\nspacings: 1 2 3\nencoding: ascii\n";
    const std::vector<float> values = numbers<float>(1);
    const std::string bytes =
        "NRRD0004\ntype: unsigned char\ndimension: 4\nsizes: 2 5 4 6\nkinds: vector domain domain "
        "domain\nencoding: text\n\n";
    const std::vector<std::uint8_t> pairs = numbers<std::uint8_t>(1, 2 * kCount);
    std::string pairText;
    for (const std::uint8_t value : pairs) pairText += std::to_string(value) + (value % 2 == 0 ? "\n" : " ");
    write("b.dat", asText(values));
    // In the file of the header or in one beside it; with blanks only behind the last number, or no line end.
    for (const std::string& path :
         {write("a.nrrd", head + "\n" + asText(values, "\n")), write("c.nrrd", head + "\n" + asText(values) + " \n"),
          write("d.nrrd", head + "\n" + asText(values)), write("b.nhdr", head + "data file: b.dat\n\n")}) {
        const Dataset dataset = openFiles({path}, {});
        ASSERT_EQ(dataset.info.lattice.size, glm::ivec3(kX, kY, kZ));
        EXPECT_EQ(dataset.info.lattice.spacing, glm::dvec3(1, 2, 3));
        const Field field = dataset.read(0, 0, 0);
        for (std::size_t i = 0; i < values.size(); ++i)
            ASSERT_EQ(field.value(i), double(values[i])) << path << " " << i;
    }
    const Dataset dataset = openFiles({write("e.nrrd", bytes + pairText + "\n")}, {});
    ASSERT_EQ(dataset.info.parameters.size(), 2u);
    for (int c = 0; c < 2; ++c) {
        const Field field = dataset.read(c, 0, 0);
        for (std::size_t i = 0; i < field.count(); ++i) ASSERT_EQ(field.value(i), pairs[2 * i + std::size_t(c)]);
    }
    EXPECT_THAT(failure(write("g.nrrd", head + "\nx " + asText(values) + "\n")), testing::HasSubstr("\"x\" where"));
}

TEST_F(WholeFile, MetaImage) {
    const std::string samples = bytesOf(numbers<float>(1));
    const auto head = [](const std::string& more, const std::string& data) {
        return "ObjectType = Image\nNDims = 3\n" + more +
               "BinaryDataByteOrderMSB = False\nElementSpacing = 1 2 3\nDimSize = 5 4 6\nElementType = MET_FLOAT\n"
               "ElementDataFile = " +
               data + "\n";
    };
    const std::string local = write("a.mha", head("BinaryData = True\n", "LOCAL") + samples);
    expectCutsAreTold(local, local);
    const std::string beside = write("b.mhd", head("BinaryData = True\n", "b.bin"));
    const std::string data = write("b.bin", samples);
    expectCutsAreTold(beside, beside);
    expectCutsAreTold(beside, data);
    const std::string small = stored(samples, true);
    const std::string compressed = write(
        "c.mha",
        head("BinaryData = True\nCompressedData = True\nCompressedDataSize = " + std::to_string(small.size()) + "\n",
             "LOCAL") +
            small);
    expectCutsAreTold(compressed, compressed);
    const std::string text = write("d.mha", head("BinaryData = False\n", "LOCAL") + asText(numbers<float>(1)) + "\n");
    expectCutsAreTold(text, text);
}

TEST_F(WholeFile, Nifti) {
    std::string head(352, '\0');
    const auto put = [&](std::size_t at, const std::string& bytes) { head.replace(at, bytes.size(), bytes); };
    put(0, bytesOf(std::int32_t(348)));
    put(40, bytesOf(std::vector<std::int16_t>{3, kX, kY, kZ, 1, 1, 1, 1}));
    put(70, bytesOf(std::vector<std::int16_t>{16, 32}));
    put(76, bytesOf(std::vector<float>{1, 1, 2, 3}));
    put(108, bytesOf(352.0f));
    put(344, std::string("n+1\0", 4));
    const std::string file = head + bytesOf(numbers<float>(1));
    const std::string path = write("a.nii", file), packed = write("b.nii.gz", stored(file, false));
    expectCutsAreTold(path, path);
    expectCutsAreTold(packed, packed);
}

/// A classic NetCDF file: T(z, y, x) fixed, or p(time, z, y, x) with records.
std::string classicNetCdf(bool records) {
    const auto number = [](std::int32_t value) { return bytesOf(value, true); };
    const auto name = [&](const std::string& text) {
        return number(std::int32_t(text.size())) + inBytes(text, (text.size() + 3) / 4 * 4);
    };
    const auto dimension = [&](const char* word, int length) { return name(word) + number(length); };
    std::string out = "CDF\x01" + number(records ? 3 : 0) + number(10) + number(records ? 4 : 3);
    if (records) out += dimension("time", 0);
    out += dimension("z", kZ) + dimension("y", kY) + dimension("x", kX);
    out += number(0) + number(0) + number(11) + number(records ? 2 : 1);
    const std::string seconds = "seconds since 2000-01-01";
    const std::string unit =
        number(12) + number(1) + name("units") + number(2) + number(std::int32_t(seconds.size())) + seconds;
    const auto variable = [&](const char* word, const std::vector<std::int32_t>& axes, int type, int bytes, int begin) {
        return name(word) + number(std::int32_t(axes.size())) + bytesOf(axes, true) +
               (axes.size() == 1 ? unit : number(0) + number(0)) + number(type) + number(bytes) + number(begin);
    };
    const auto add = [&](int begin) {
        if (!records) return variable("T", {0, 1, 2}, 5, 4 * kCount, begin);
        return variable("time", {0}, 6, 8, begin) + variable("p", {0, 1, 2, 3}, 5, 4 * kCount, begin + 8);
    };
    const int begin = int((out + add(0)).size());
    out += add(begin);
    for (int t = 0; t < (records ? 3 : 1); ++t) {
        if (records) out += bytesOf(0.5 * t, true);
        out += bytesOf(numbers<float>(t), true);
    }
    return out;
}

TEST_F(WholeFile, NetCdf) {
    for (const bool records : {false, true}) {
        const std::string path = write("a.nc", classicNetCdf(records));
        const Dataset dataset = openFiles({path}, {});
        EXPECT_EQ(dataset.info.times.size(), records ? 3u : 1u);
        EXPECT_EQ(dataset.read(0, 0, 0).value(7), double(numbers<float>(0)[7]));
        expectCutsAreTold(path, path);
    }
}

/// Two hexahedra side by side in two parts, with T on the points and U on the cells.
struct GoldCase {
    bool binary = false;
    std::string line(const std::string& text) const { return binary ? inBytes(text, 80) : text + "\n"; }
    std::string whole(int value) const {
        return binary ? bytesOf(std::int32_t(value))
                      : std::string(10 - std::to_string(value).size(), ' ') + std::to_string(value) + "\n";
    }
    std::string floats(const std::vector<float>& values) const {
        if (binary) return bytesOf(values);
        std::string out;
        char text[32];
        for (const float value : values) {
            std::snprintf(text, sizeof text, "%12.5e\n", double(value));
            out += text;
        }
        return out;
    }
    std::string geometry() const {
        std::string out = binary ? inBytes("C Binary", 80) : "";
        out += line("one") + line("two") + line("node id assign") + line("element id assign");
        for (int part = 0; part < 2; ++part) {
            out += line("part") + whole(part + 1) + line(part == 0 ? "left" : "right") + line("coordinates") + whole(8);
            const float a = float(part), b = a + 1;
            out += floats({a, b, b, a, a, b, b, a}) + floats({0, 0, 1, 1, 0, 0, 1, 1}) +
                   floats({0, 0, 0, 0, 1, 1, 1, 1}) + line("hexa8") + whole(1);
            if (binary)
                out += bytesOf(std::vector<std::int32_t>{1, 2, 3, 4, 5, 6, 7, 8});
            else
                out += "         1         2         3         4         5         6         7         8\n";
        }
        return out;
    }
    std::string ofPoints() const {
        std::string out = line("T");
        for (int part = 0; part < 2; ++part)
            out += line("part") + whole(part + 1) + line("coordinates") + floats(numbers<float>(part, 8));
        return out;
    }
    std::string ofCells() const {
        std::string out = line("U");
        for (int part = 0; part < 2; ++part)
            out += line("part") + whole(part + 1) + line("hexa8") + floats(numbers<float>(part, 3));
        return out;
    }
};

TEST_F(WholeFile, EnSightGold) {
    ImportOptions options;
    options.gridSize = {4, 2, 2};
    for (const bool binary : {true, false}) {
        const GoldCase gold{binary};
        const std::string path =
            write("a.case", "FORMAT\ntype: ensight gold\n\nGEOMETRY\nmodel: a.geo\n\nVARIABLE\nscalar per node: T a.T\n"
                            "vector per element: U a.U\n");
        const std::string geometry = write("a.geo", gold.geometry()), t = write("a.T", gold.ofPoints()),
                          u = write("a.U", gold.ofCells());
        constexpr int kCuts = 9; // none between two parts, where nothing tells that a further one followed
        for (const std::string& file : {path, geometry, t, u}) expectCutsAreTold(path, file, options, kCuts);
    }
}

TEST_F(WholeFile, OpenFoam) {
    const auto head = [](const char* kind, const char* object) {
        return "FoamFile\n{\n    version 2.0;\n    format ascii;\n    class " + std::string(kind) + ";\n    object " +
               object + ";\n}\n";
    };
    write("c/system/controlDict", head("dictionary", "controlDict") + "startTime 0;\n");
    const std::string mesh = "c/constant/polyMesh/";
    std::vector<std::string> files;
    files.push_back(write(mesh + "points", head("vectorField", "points") +
                                               "12\n(\n(0 0 0)\n(1 0 0)\n(2 0 0)\n(0 1 0)\n(1 1 0)\n(2 1 0)\n(0 0 "
                                               "1)\n(1 0 1)\n(2 0 1)\n(0 1 1)\n(1 1 1)\n(2 1 1)\n)\n"));
    files.push_back(write(
        mesh + "faces", head("faceList", "faces") +
                            "11\n(\n4(1 4 10 7)\n4(0 6 9 3)\n4(2 5 11 8)\n4(0 1 7 6)\n4(1 2 8 7)\n4(3 9 10 4)\n4(4 10 "
                            "11 5)\n4(0 3 4 1)\n4(1 4 5 2)\n4(6 7 10 9)\n4(7 8 11 10)\n)\n"));
    files.push_back(write(mesh + "owner", head("labelList", "owner") + "11\n(\n0\n0\n1\n0\n1\n0\n1\n0\n1\n0\n1\n)\n"));
    files.push_back(write(mesh + "neighbour", head("labelList", "neighbour") + "1\n(\n1\n)\n"));
    files.push_back(write(mesh + "boundary", head("polyBoundaryMesh", "boundary") +
                                                 "1\n(\nwalls { type wall; nFaces 10; startFace 1; }\n)\n"));
    files.push_back(write("c/0/T", head("volScalarField", "T") +
                                       "dimensions [0 0 0 1 0 0 0];\ninternalField nonuniform List<scalar> "
                                       "2\n(\n300.5\n400.25\n)\n;\nboundaryField { walls { type zeroGradient; } }\n"));
    const std::string path = write("c/c.foam", "");
    const Dataset dataset = openFiles({path}, {});
    EXPECT_GT(dataset.read(0, 0, 0).value(0), 300);
    for (const std::string& file : files) expectCutsAreTold(path, file, {}, 16);
}

} // namespace
} // namespace tessera::volume
