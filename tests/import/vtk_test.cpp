// What comes through tessera-import. Skipped where it was not built.
#include "tests/import/foreign_files.h"
#include "volume/base/error.h"
#include "volume/export/export.h"
#include "volume/import/foreign.h"
#include "volume/import/import.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <iterator>
#include <random>
#include <unistd.h>

namespace tessera::volume {
namespace {

class ImportVtk : public ForeignFiles {};

Dataset sample(glm::ivec3 size) {
    Dataset dataset;
    dataset.info.lattice.size = size;
    dataset.info.lattice.spacing = {2e-5, 0.1, 1.0 / 3};
    dataset.info.lattice.origin = {-0.7, 0.1, 12};
    dataset.info.lengthUnit = "mm";
    dataset.info.times = {0.1, 0.7};
    dataset.info.parameters = {{"O2", "mol/m3", 1, ScalarType::F32, false, {}, {}},
                               {"U & V", "m/s", 3, ScalarType::F32, false, {}, {}},
                               {"region", "", 1, ScalarType::U8, true, {{0, "solid"}, {2, "air side"}}, {}},
                               {"a", "", 1, ScalarType::I16, false, {}, {}},
                               {"b", "", 1, ScalarType::U16, false, {}, {}},
                               {"c", "K", 1, ScalarType::I32, false, {}, {}}};
    dataset.read = [lattice = dataset.info.lattice, parameters = dataset.info.parameters](int p, int c, int t) {
        std::mt19937 random(unsigned(p * 100 + c * 10 + t));
        Field field = makeField(lattice, parameters[std::size_t(p)].type);
        Mask mask(field.count(), 1);
        for (std::size_t i = 0; i < field.count(); ++i) {
            dispatch(field.type, [&]<class T>(T) { field.as<T>()[i] = static_cast<T>(random()); });
            if (field.type == ScalarType::F32) field.as<float>()[i] *= 1e-9f;
            if (p == 2) field.as<std::uint8_t>()[i] = random() % 2 == 0 ? 0 : 2;
            mask[i] = i % 5 != 2;
        }
        if (p == 0 || p == 3) field.mask = std::make_shared<const Mask>(mask);
        return field;
    };
    return dataset;
}

std::string words(const DatasetInfo& info) {
    std::string text;
    for (const Parameter& p : info.parameters) {
        text += p.name + " [" + p.unit + "] " + std::string(name(p.type)) + " " + std::to_string(p.components);
        for (const Label& label : p.labels) text += " " + std::to_string(label.value) + "=" + label.name;
        text += "\n";
    }
    return text;
}

void expectEqual(const Dataset& a, const Dataset& b) {
    ASSERT_EQ(a.info.lattice.size, b.info.lattice.size);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_DOUBLE_EQ(a.info.lattice.spacing[axis], b.info.lattice.spacing[axis]);
        EXPECT_DOUBLE_EQ(a.info.lattice.origin[axis], b.info.lattice.origin[axis]);
    }
    EXPECT_EQ(a.info.times, b.info.times);
    EXPECT_EQ(a.info.lengthUnit, b.info.lengthUnit);
    ASSERT_EQ(words(a.info), words(b.info));
    ASSERT_TRUE(a.info.parameters == b.info.parameters);
    for (std::size_t p = 0; p < a.info.parameters.size(); ++p)
        for (int c = 0; c < a.info.parameters[p].components; ++c)
            for (std::size_t t = 0; t < a.info.times.size(); ++t) {
                const Field f = a.read(int(p), c, int(t)), g = b.read(int(p), c, int(t));
                for (std::size_t i = 0; i < f.count(); ++i) {
                    ASSERT_EQ(f.present(i), g.present(i)) << a.info.parameters[p].name << i;
                    if (f.present(i)) {
                        ASSERT_EQ(f.value(i), g.value(i)) << a.info.parameters[p].name << i;
                    }
                }
            }
}

TEST_F(ImportVtk, VtiComesBackBitForBit) {
    ImportOptions asIs;
    asIs.autoAbsent = false;
    asIs.parts = {"*=joined"}; // noise jumps everywhere
    for (const glm::ivec3 size : {glm::ivec3(3, 2, 17), glm::ivec3(1, 1, 1), glm::ivec3(5, 1, 4)}) {
        const Dataset dataset = sample(size);
        const std::string path = (folder_ / "series.vti").string();
        EXPECT_EQ(exportDataset(dataset, {}, path).size(), 3u);
        expectEqual(dataset, openFiles({(folder_ / "series.pvd").string()}, asIs));
        expectEqual(dataset,
                    openFiles({(folder_ / "series_0000.vti").string(), (folder_ / "series_0001.vti").string()}, asIs));
        ImportOptions look = asIs;
        const ImportPreview preview = previewFiles({(folder_ / "series.pvd").string()}, look);
        EXPECT_EQ(preview.format, "vti");
        EXPECT_EQ(words(preview.info), words(dataset.info));
    }
}

TEST_F(ImportVtk, NrrdComesBack) {
    const Dataset dataset = sample({4, 3, 2});
    ExportSelection selection;
    selection.times = {1};
    for (const char* channel : {"O2", "U & V.y", "region", "a", "b", "c"}) {
        selection.channel = dataset.info.findChannel(channel);
        const std::string path = (folder_ / "one.nrrd").string();
        exportDataset(dataset, selection, path);
        const Dataset back = openFiles({path}, {});
        ASSERT_EQ(back.info.parameters.size(), 1u);
        EXPECT_EQ(back.info.parameters[0].name, channel);
        EXPECT_EQ(back.info.times, std::vector<double>{0.7});
        EXPECT_EQ(back.info.lattice.size, dataset.info.lattice.size);
        EXPECT_NEAR(back.info.lattice.spacing.z, dataset.info.lattice.spacing.z, 1e-9);
        const Channel from = dataset.info.channel(*selection.channel);
        const Field f = dataset.read(from.parameter, from.component, 1), g = back.read(0, 0, 0);
        for (std::size_t i = 0; i < f.count(); ++i) {
            ASSERT_EQ(f.present(i), g.present(i)) << channel;
            if (f.present(i)) {
                ASSERT_EQ(f.value(i), g.value(i)) << channel;
            }
        }
    }
}

/// Two boxes of hexahedra side by side in x, [0, 1] and [1, 2], each n^3 cells, with T = x + 2 y + 3 z on the points.
std::string boxMesh(double from, int n, const std::string& extra, bool cells) {
    std::string points, connectivity, offsets, types, point, cell;
    const int m = n + 1;
    for (int k = 0; k < m; ++k)
        for (int j = 0; j < m; ++j)
            for (int i = 0; i < m; ++i) {
                const double x = from + double(i) / n, y = 0.1 * j / n, z = double(k) / n;
                points += std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
                point += std::to_string(x + 2 * y + 3 * z) + "\n";
            }
    for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                for (const auto& at :
                     {glm::ivec3(0, 0, 0), glm::ivec3(1, 0, 0), glm::ivec3(1, 1, 0), glm::ivec3(0, 1, 0),
                      glm::ivec3(0, 0, 1), glm::ivec3(1, 0, 1), glm::ivec3(1, 1, 1), glm::ivec3(0, 1, 1)})
                    connectivity += std::to_string(((k + at.z) * m + j + at.y) * m + i + at.x) + " ";
                offsets += std::to_string(8 * ((k * n + j) * n + i + 1)) + " ";
                types += "12 ";
                cell += std::to_string(7 + from) + " ";
            }
    const auto array = [](const std::string& type, const std::string& name, const std::string& text,
                          const char* more = "") {
        return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" format=\"ascii\" " + more + ">" + text +
               "</DataArray>";
    };
    return "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\"><UnstructuredGrid><Piece "
           "NumberOfPoints=\"" +
           std::to_string(m * m * m) + "\" NumberOfCells=\"" + std::to_string(n * n * n) + "\"><PointData>" +
           (cells ? "" : array("Float64", "T", point)) + "</PointData><CellData>" +
           (cells ? array("Float32", extra, cell) : "") + "</CellData><Points>" +
           array("Float32", "Points", points, "NumberOfComponents=\"3\"") + "</Points><Cells>" +
           array("Int32", "connectivity", connectivity) + array("Int32", "offsets", offsets) +
           array("UInt8", "types", types) + "</Cells></Piece></UnstructuredGrid></VTKFile>";
}

TEST_F(ImportVtk, MeshIsSampledExactlyWhereTheFieldIsLinear) {
    const std::string path = write("box.vtu", boxMesh(0, 3, "", false));
    ImportOptions options;
    EXPECT_EQ(previewFiles({path}, options).info.lattice.size, glm::ivec3(4, 4, 4)); // its points
    options.gridSize = {7, 5, 9};
    const Dataset dataset = openFiles({path}, options);
    ASSERT_EQ(dataset.info.lattice.size, options.gridSize);
    const Field field = dataset.read(0, 0, 0);
    EXPECT_EQ(field.mask, nullptr); // the border belongs to the mesh
    for (int k = 0; k < 9; ++k)
        for (int j = 0; j < 5; ++j)
            for (int i = 0; i < 7; ++i) {
                const glm::dvec3 x = field.lattice.position({i, j, k});
                ASSERT_NEAR(field.value(field.lattice.index({i, j, k})), x.x + 2 * x.y + 3 * x.z, 2e-5);
            }
}

TEST_F(ImportVtk, RegionsAreMergedAndDoNotBleed) {
    const std::string air = write("air_1.vtu", boxMesh(0, 4, "T", true)),
                      fuel = write("fuel_1.vtu", boxMesh(1, 4, "T", true));
    const Dataset dataset = openFiles({air, fuel}, {});
    ASSERT_EQ(dataset.info.lattice.size, glm::ivec3(8, 4, 4)); // one sample a cell
    ASSERT_EQ(dataset.info.parameters.size(), 2u);
    const Parameter& region = dataset.info.parameters[1];
    EXPECT_TRUE(region.categorical);
    EXPECT_EQ(region.labels, (std::vector<Label>{{1, "air"}, {2, "fuel"}}));
    const Field t = dataset.read(0, 0, 0), label = dataset.read(1, 0, 0);
    for (std::size_t i = 0; i < t.count(); ++i) {
        EXPECT_TRUE(t.present(i));
        EXPECT_EQ(t.value(i), i % 8 < 4 ? 7 : 8);
        EXPECT_EQ(label.value(i), i % 8 < 4 ? 1 : 2);
    }
    write("other.vtu", boxMesh(1, 4, "O2.fuel", true));
    const Dataset two = openFiles({air, (folder_ / "other.vtu").string()}, {});
    ASSERT_EQ(two.info.parameters.size(), 3u);
    const Field gas = two.read(1, 0, 0);
    for (std::size_t i = 0; i < gas.count(); ++i) EXPECT_EQ(gas.present(i), i % 8 >= 4);
}

TEST_F(ImportVtk, LegacyFileWithValidPointMask) {
    const std::string path =
        write("a.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 1\n"
                       "ORIGIN 0 0 0\nSPACING 1 2 3\nPOINT_DATA 4\nSCALARS T double 1\nLOOKUP_TABLE default\n1 2 3 4\n"
                       "SCALARS vtkValidPointMask char 1\nLOOKUP_TABLE default\n1 0 1 1\n");
    const Dataset dataset = openFiles({path}, {});
    ASSERT_EQ(dataset.info.parameters.size(), 1u);
    const Field field = dataset.read(0, 0, 0);
    EXPECT_EQ(field.value(3), 4);
    EXPECT_EQ(field.type, ScalarType::F32);
    EXPECT_TRUE(field.present(0));
    EXPECT_FALSE(field.present(1));
    EXPECT_TRUE(field.present(2));
}

TEST_F(ImportVtk, MetaImageAndItsBadForms) {
    const std::string head =
        "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
        "ElementSpacing = 1 2 3\nOffset = 4 5 6\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n";
    const std::string path = write("a.mha", head + "12345678");
    const Dataset dataset = openFiles({path}, {});
    EXPECT_EQ(dataset.info.lattice.spacing, glm::dvec3(1, 2, 3));
    EXPECT_EQ(dataset.info.lattice.origin, glm::dvec3(4, 5, 6));
    EXPECT_EQ(dataset.read(0, 0, 0).value(7), '8');
    EXPECT_NE(failure(write("cut.mha", head + "123")), "");
    EXPECT_NE(failure(write("not.mha", "hello")), "");
}

TEST_F(ImportVtk, BadFilesGiveOneLine) {
    const Dataset dataset = sample({4, 3, 2});
    ExportSelection selection;
    selection.times = {0};
    const std::string path = (folder_ / "good.vti").string();
    exportDataset(dataset, selection, path);
    const std::string good = read(path);
    EXPECT_EQ(failure(path), "");
    for (const double part : {0.0, 0.05, 0.2, 0.5, 0.8, 0.95}) {
        const std::string line = failure(write("cut.vti", good.substr(0, std::size_t(double(good.size()) * part))));
        EXPECT_NE(line, "") << part;
        EXPECT_EQ(line.find('\n'), std::string::npos) << line;
        EXPECT_THAT(line, testing::HasSubstr("cut.vti"));
    }
    for (const char* name : {"a.vti", "a.vtu", "a.vtm", "a.vtk", "a.nrrd", "a.nii", "a.nii.gz", "a.nc", "a.case",
                             "a.foam", "a.mhd", "a.vtr"}) {
        const std::string line = failure(write(name, "this is no such file\n"));
        EXPECT_NE(line, "") << name;
        EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    }
    const std::string legacy = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 1\n"
                               "ORIGIN 0 0 0\nSPACING 1 2 3\nPOINT_DATA 4\nFIELD FieldData 2\nT 1 4 double\n1 2 3 4\n";
    EXPECT_EQ(failure(write("whole.vtk", legacy + "p 1 4 double\n5 6 7 8\n")), "");
    EXPECT_THAT(failure(write("cut.vtk", legacy)), testing::HasSubstr("ends too early"));
    EXPECT_THAT(failure(write("a.unheard", "1")), testing::HasSubstr("unknown ending"));
    EXPECT_THAT(
        failure(write("none.vti", "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 1 0 1 0 1\" Origin=\"0 0 0\" "
                                  "Spacing=\"1 1 1\"><Piece Extent=\"0 1 0 1 0 1\"/></ImageData></VTKFile>")),
        testing::HasSubstr("no array"));
}

TEST_F(ImportVtk, FuelCellGridsHaveTheRangesStated) {
    struct Wanted {
        const char* name;
        double lo, hi, tolerance;
    };
    for (const char* list : {"fuel-cell/grid/large.pvd", "fuel-cell/grid/small.pvd"}) {
        const std::string path = testData(list);
        if (path.empty()) GTEST_SKIP() << "no test data";
        Dataset dataset = openFiles({path}, {});
        EXPECT_EQ(dataset.info.times.size(), 26u);
        EXPECT_DOUBLE_EQ(dataset.info.times[25], 0.26);
        scanRanges(dataset);
        const bool large = dataset.info.lattice.size == glm::ivec3(24, 32, 88);
        if (!large) {
            EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(11, 13, 101));
        }
        const std::vector<Wanted> all =
            large ? std::vector<Wanted>{{"O2", 2.34, 5.55, 0.005},   {"H2", 20.67, 21.97, 0.005},
                                        {"H2O", 0.88, 6.92, 0.005},  {"p", 99998, 100016, 0.5},
                                        {"T", 434.16, 437.87, 0.07}, {"|U|", 0, 1.25, 0.003}}
                  : std::vector<Wanted>{
                        {"O2", 2.4488, 5.551, 0.005}, {"T", 434.16, 437.87, 0.006}, {"|U|", 0, 1.233, 0.003}};
        for (const Wanted& wanted : all) {
            const auto index = dataset.info.findChannel(wanted.name);
            ASSERT_TRUE(index) << wanted.name;
            const Range range = dataset.info.channelRange(dataset.info.channel(*index));
            EXPECT_NEAR(range.lo, wanted.lo, wanted.tolerance) << list << wanted.name;
            EXPECT_NEAR(range.hi, wanted.hi, wanted.tolerance) << list << wanted.name;
        }
        // No gas where there is none: O2 on the air side, H2 on the fuel side, water and flow on both.
        const auto find = [&](const char* name) {
            return dataset.info.channel(*dataset.info.findChannel(name)).parameter;
        };
        const Field region = dataset.read(find("region"), 0, 25);
        for (const auto& [name, sides] :
             {std::pair{"O2", "1"}, {"H2", "3"}, {"H2O", "13"}, {"p", "13"}, {"U.x", "13"}, {"T", "013"}}) {
            const Field field = dataset.read(find(name), 0, 25);
            for (std::size_t i = 0; i < field.count(); ++i)
                ASSERT_EQ(field.present(i),
                          std::string(sides).find(char('0' + int(region.value(i)))) != std::string::npos)
                    << name << i;
        }
        EXPECT_EQ(dataset.info.parameters[std::size_t(find("O2"))].unit, "mol/m3");
        ImportOptions stated;
        stated.autoAbsent = false;
        stated.absent = {"O2=region:0,3"};
        const Dataset byRule = openFiles({path}, stated);
        EXPECT_EQ(*byRule.read(find("O2"), 0, 3).mask, *dataset.read(find("O2"), 0, 3).mask);
        EXPECT_EQ(byRule.read(find("H2"), 0, 3).mask, nullptr);
    }
}

TEST_F(ImportVtk, NativeMeshesOfTheFuelCell) {
    const std::string folder = testData("fuel-cell/unstructured");
    if (folder.empty()) GTEST_SKIP() << "no test data";
    ImportOptions options;
    options.parameters = {"O2.air", "H2.fuel", "p", "U.air", "region"};
    Dataset dataset = openFiles(
        {folder + "/air_100.vtu", folder + "/fuel_100.vtu", folder + "/air_260.vtu", folder + "/fuel_260.vtu"},
        options);
    EXPECT_EQ(dataset.info.times, (std::vector<double>{0.1, 0.26}));
    EXPECT_EQ(dataset.info.parameters[3].components, 3);
    scanRanges(dataset);
    const auto& info = dataset.info;
    EXPECT_NEAR(info.parameters[0].ranges[0].hi, 0.2249,
                0.0005); // mass fraction at the inlet, from the file's own range
    EXPECT_GT(info.parameters[0].ranges[0].lo, 0.10);
    EXPECT_NEAR(info.parameters[2].ranges[0].lo, 99998, 1);
    const Field air = dataset.read(0, 0, 1), fuel = dataset.read(1, 0, 1), p = dataset.read(2, 0, 1);
    for (std::size_t i = 0; i < air.count(); ++i) {
        ASSERT_FALSE(air.present(i) && fuel.present(i));
        ASSERT_EQ(p.present(i), air.present(i) || fuel.present(i));
    }
}

TEST_F(ImportVtk, OpenFoamCaseOfSeveralRegions) {
    const std::string archive = testData("fuel-cell/openfoam-case.tar.xz");
    if (archive.empty()) GTEST_SKIP() << "no test data";
    ASSERT_EQ(std::system(("tar xJf '" + archive + "' -C '" + folder_.string() + "'").c_str()), 0);
    ImportOptions options;
    options.gridSize = {6, 6, 400};
    options.parameters = {"O2.air", "T", "region"};
    for (const char* named : {"cell", "cell/cell.foam"}) {
        Dataset dataset = openFiles({(folder_ / named).string()}, options);
        EXPECT_EQ(dataset.info.lattice.size, options.gridSize);
        EXPECT_EQ(dataset.info.times, std::vector<double>{0.26});
        scanRanges(dataset);
        EXPECT_NEAR(dataset.info.parameters[1].ranges[0].lo, 434.16, 0.1);
        EXPECT_NEAR(dataset.info.parameters[1].ranges[0].hi, 437.8, 0.2);
        std::string names;
        for (const Label& label : dataset.info.parameters[2].labels) names += label.name + ";";
        EXPECT_THAT(names, testing::AllOf(testing::HasSubstr("air"), testing::HasSubstr("fuel"),
                                          testing::HasSubstr("electrolyte"), testing::HasSubstr("interconnect")));
        const Field oxygen = dataset.read(0, 0, 0), region = dataset.read(2, 0, 0);
        for (std::size_t i = 0; i < oxygen.count(); ++i) {
            const int value = int(region.value(i));
            const auto& labels = dataset.info.parameters[2].labels;
            const auto label =
                std::find_if(labels.begin(), labels.end(), [&](const Label& l) { return l.value == value; });
            ASSERT_NE(label, labels.end());
            ASSERT_EQ(oxygen.present(i), label->name.find("air") != std::string::npos);
        }
    }
}

TEST_F(ImportVtk, OtherFormatsOfTheFuelCell) {
    const std::string archive = testData("fuel-cell/other-formats.tar.xz");
    if (archive.empty()) GTEST_SKIP() << "no test data";
    ASSERT_EQ(std::system(("tar xJf '" + archive + "' -C '" + folder_.string() + "'").c_str()), 0);
    const std::string formats = (folder_ / "formats").string() + "/";
    for (const char* name : {"open_small_last_legacy_binary.vtk", "open_small_last_nan_f64_ascii.vti",
                             "open_small_last_nan_f64_base64.vti"}) {
        Dataset dataset = openFiles({formats + name}, {});
        EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(11, 13, 101)) << name;
        scanRanges(dataset);
        const Range oxygen = dataset.info.channelRange(dataset.info.channel(dataset.info.findChannel("O2").value()));
        EXPECT_NEAR(oxygen.lo, 2.46681, 1e-4) << name;
        EXPECT_NEAR(oxygen.hi, 5.54863, 1e-4) << name;
    }
    const Dataset ensight = openFiles({formats + "EnSight_air/htT.case"}, {});
    ASSERT_EQ(ensight.info.times.size(), 2u);
    EXPECT_NEAR(ensight.info.times[1], 0.26, 1e-6);
    EXPECT_TRUE(ensight.info.findChannel("O2air"));
    EXPECT_TRUE(ensight.info.findChannel("|Uair|"));
    const Field early = ensight.read(2, 0, 0), late = ensight.read(2, 0, 1);
    bool differs = false;
    for (std::size_t i = 0; i < early.count(); ++i)
        differs = differs || (early.present(i) && early.value(i) != late.value(i));
    EXPECT_TRUE(differs);
}

} // namespace
} // namespace tessera::volume
