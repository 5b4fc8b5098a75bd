// Volumes of microscopy and chemistry: MRC, AmiraMesh, Gaussian cube, XSF, VASP, OpenDX, BOV.
#include "tests/import/case_files.h"

namespace tessera::volume {

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class GridCases : public CaseFiles {};

TEST_F(GridCases, Mrc) {
    expectRamp(openFiles({stored("grids/plain.mrc")}, {}), {0.5, 0.5, 2}, "angstrom");
    // Columns along z, rows along x; a first sample; big-endian, an extended header, compressed.
    const Dataset turned = openFiles({stored("grids/permuted.map.gz")}, {});
    expectRamp(turned, {0.5, 0.5, 2}, "angstrom");
    EXPECT_EQ(turned.info.lattice.origin, glm::dvec3(1.5, 2, 4));
    const std::string path = write("a.mrc", read(stored("grids/plain.mrc")));
    expectCutsAreTold(path, path);
    const std::string packed = write("a.map.gz", read(stored("grids/permuted.map.gz")));
    expectCutsAreTold(packed, packed);
    std::string bytes = read(stored("grids/plain.mrc"));
    bytes.replace(0, 8, bytesOf(std::uint32_t(100000)) + bytesOf(std::uint32_t(100000)));
    EXPECT_THAT(failure(write("b.mrc", bytes)), HasSubstr("announces"));
    EXPECT_THAT(failure(write("c.map", "words")), HasSubstr("is no MRC or CCP4 map"));
}

TEST_F(GridCases, Amira) {
    expectRamp(openFiles({stored("grids/plain.am")}, {}), {0.5, 0.5, 2}, "um");
    const std::string path = stored("grids/labels.am");
    const Dataset labels = openFiles({path}, {});
    ASSERT_EQ(labels.info.parameters.size(), 1u);
    const Parameter& parameter = labels.info.parameters[0];
    EXPECT_EQ(parameter.name, "Labels");
    EXPECT_TRUE(parameter.categorical);
    ASSERT_EQ(parameter.labels.size(), 3u);
    EXPECT_EQ(parameter.labels[2].name, "Solid phase");
    EXPECT_EQ(labels.info.lattice.origin, glm::dvec3(1, 2, -3));
    EXPECT_EQ(labels.info.lengthUnit, "nm");
    EXPECT_EQ(wrong(labels, 0, 0, 0, [](int x, int y, int z) { return int(ramp(x, y, z)) / 440; }), 0);
    EXPECT_THAT(notesOn(path), HasSubstr("its array Odd (type HxBad) is not read"));
    // Turned by a quarter: x is the file's -y.
    const Dataset turned = openFiles({stored("grids/zipped.am")}, {});
    EXPECT_EQ(turned.info.lattice.size, glm::ivec3(11, 10, 12));
    EXPECT_EQ(turned.info.lattice.origin, glm::dvec3(3, 21, 27));
    EXPECT_EQ(wrong(turned, 0, 0, 0, [](int x, int y, int z) { return ramp(y, 10 - x, z); }), 0);
    for (const char* name : {"plain.am", "labels.am", "zipped.am"}) {
        const std::string copy = write(name, read(stored(std::string("grids/") + name)));
        expectCutsAreTold(copy, copy);
    }
}

TEST_F(GridCases, AmiraCoordinates) {
    const std::string head = "# AmiraMesh ASCII 1.0\ndefine Lattice 2 2 3\n",
                      values = "@1\n1 2 3 4 5 6 7 8 9 10 11 12\n";
    const Dataset stacked = openFiles(
        {write("s.am", head +
                           "define Coordinates 3\nParameters { CoordType \"stacked\", BoundingBoxXY 0 1 0 4 }\n"
                           "Lattice { float Data } = @1\nCoordinates { float z } = @2\n\n" +
                           values + "\n@2\n1 3 5\n")},
        {});
    EXPECT_EQ(stacked.info.lattice.spacing, glm::dvec3(1, 4, 2));
    EXPECT_EQ(stacked.info.lattice.origin, glm::dvec3(0, 0, 1));
    EXPECT_EQ(stacked.read(0, 0, 0).value(11), 12);
    EXPECT_THAT(failure(write("m.am", "# AmiraMesh ASCII 1.0\nnNodes 4\n@1\n1\n")), HasSubstr("defines no lattice"));
}

std::string cube(const std::string& atoms, const std::string& signs, const std::string& values) {
    return "words\nmore\n" + atoms + " 1 2 3\n" + signs + "2 0 0 0.5\n" + signs + "2 0 0.5 0\n" + signs +
           "3 -2 0 0\n1 1.0 0 0 0\n" + values;
}

TEST_F(GridCases, Cube) {
    const std::string path = stored("grids/plain.cube");
    expectRamp(openFiles({path}, {}), {0.5, 0.5, 2}, "bohr");
    EXPECT_THAT(notesOn(path), HasSubstr("its 1 atom is left out"));
    // The first axis is z, the last runs along -x; a negative number of samples means angstrom.
    const Dataset turned =
        openFiles({write("a.cube", cube("1", "-", "0 1 2\n10 11 12\n100 101 102\n110 111 112"))}, {});
    EXPECT_EQ(turned.info.lattice.size, glm::ivec3(3, 2, 2));
    EXPECT_EQ(turned.info.lattice.origin, glm::dvec3(-3, 2, 3));
    EXPECT_EQ(turned.info.lengthUnit, "angstrom");
    EXPECT_EQ(wrong(turned, 0, 0, 0, [](int x, int y, int z) { return 100 * z + 10 * y + 2 - x; }), 0);
    const std::string orbitals =
        write("o.cube", cube("-1", "", "2 5 6\n0 1 1 2 2 3\n4 5 5 6 6 7\n8 9 9 1 1 2\n3 4 4 5 5 1.0D+01\n"));
    const Dataset several = openFiles({orbitals}, {});
    EXPECT_THAT(names(several), ElementsAre("orbital 5", "orbital 6"));
    EXPECT_EQ(several.read(1, 0, 0).value(2), 1);
    EXPECT_EQ(several.read(1, 0, 0).value(9), 10);
    EXPECT_THAT(failure(write("b.cube", cube("1", "", "0 1 2 3"))), HasSubstr("numbers"));
    EXPECT_THAT(failure(write("c.cube", cube("1", "",
                                             "1e+00 1e+00 1e+00 1e+00 1e+00 1e+00 1e+00 1e+00 1e+00 1e+00 "
                                             "1e+00 1e+0"))),
                HasSubstr("ends within its last number"));
}

TEST_F(GridCases, Crystals) {
    const std::string twelve = "1 2 3 4\n5 6 7 8\n9 10 11 12\n";
    const Dataset xsf =
        openFiles({write("a.xsf", "CRYSTAL\nBEGIN_BLOCK_DATAGRID_3D\nwords\nBEGIN_DATAGRID_3D_rho\n2 2 3\n"
                                  "1 2 3\n1 0 0\n0 2 0\n0 0 6\n" +
                                      twelve + "END_DATAGRID_3D\n")},
                  {});
    EXPECT_EQ(xsf.info.lattice.spacing, glm::dvec3(1, 2, 3));
    EXPECT_EQ(xsf.info.lattice.origin, glm::dvec3(1, 2, 3));
    EXPECT_EQ(xsf.info.lengthUnit, "angstrom");
    EXPECT_THAT(names(xsf), ElementsAre("rho"));
    EXPECT_EQ(wrong(xsf, 0, 0, 0, [](int x, int y, int z) { return 1 + x + 2 * y + 4 * z; }), 0);
    const std::string path = write("CHGCAR", "words\n2.0\n1 0 0\n0 2 0\n0 0 3\nC H\n1 1\nDirect\n0 0 0\n0.5 0.5 0.5\n\n"
                                             " 2 2 3\n" +
                                                 twelve + "augmentation occupancies 1 1\n 0.5\n 2 2 3\n" + twelve);
    const Dataset vasp = openFiles({path}, {});
    EXPECT_EQ(vasp.info.lattice.spacing, glm::dvec3(1, 2, 2));
    EXPECT_THAT(names(vasp), ElementsAre("value", "magnetisation"));
    EXPECT_EQ(wrong(vasp, 1, 0, 0, [](int x, int y, int z) { return 1 + x + 2 * y + 4 * z; }), 0);
    EXPECT_THAT(notesOn(path), HasSubstr("densities times the volume"));
}

TEST_F(GridCases, DescribedByWords) {
    const std::string head =
        "object 1 class gridpositions counts 2 2 3\norigin 1 2 3\ndelta 1 0 0\ndelta 0 2 0\ndelta 0 0 3\n"
        "object 2 class gridconnections counts 2 2 3\nobject 3 class array type float rank 0 items 12 ";
    const Dataset text =
        openFiles({write("a.dx", head + "data follows\n1 2 3 4\n5 6 7 8\n9 10 11 12\nattribute \"dep\"\n")}, {});
    EXPECT_EQ(text.info.lattice.spacing, glm::dvec3(1, 2, 3));
    const auto wanted = [](int x, int y, int z) { return 1 + z + 3 * y + 6 * x; };
    EXPECT_EQ(wrong(text, 0, 0, 0, wanted), 0);
    std::vector<float> values;
    for (int i = 1; i <= 12; ++i) values.push_back(float(i));
    const Dataset binary =
        openFiles({write("b.dx", head + "msb ieee data follows\n" + bytesOf(values, true) + "\n")}, {});
    EXPECT_EQ(wrong(binary, 0, 0, 0, wanted), 0);
    write("b.bin", std::string(4, '\0') + bytesOf(values));
    const Dataset bov = openFiles({write("b.bov", "TIME: 1.5\nDATA_FILE: b.bin\nDATA_SIZE: 2 2 3\nDATA_FORMAT: FLOAT\n"
                                                  "VARIABLE: \"T\"\nDATA_ENDIAN: LITTLE\nCENTERING: zonal\n"
                                                  "BRICK_SIZE: 2. 4. 9.\nBYTE_OFFSET: 4\n")},
                                  {});
    EXPECT_THAT(names(bov), ElementsAre("T"));
    EXPECT_EQ(bov.info.lattice.spacing, glm::dvec3(1, 2, 3));
    EXPECT_EQ(bov.info.lattice.origin, glm::dvec3(0.5, 1, 1.5));
    EXPECT_EQ(wrong(bov, 0, 0, 0, [](int x, int y, int z) { return 1 + x + 2 * y + 4 * z; }), 0);
}

} // namespace

} // namespace tessera::volume
