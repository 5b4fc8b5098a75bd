// Volumes of NRRD, NIfTI, MetaImage and MGH files: every value at its place, times, units, names. Files in cases/scans
// were made by teem, nibabel, or by hand to the format's rules; their samples are x + 10 y + 110 z where nothing else
// is said.
#include "tests/import/foreign_files.h"

#include <cmath>
#include <limits>

using testing::ElementsAre;
using testing::HasSubstr;

namespace tessera::volume {

namespace {

std::string scan(const std::string& name) {
    return std::string(TESSERA_SOURCE_DIR) + "/tests/import/cases/scans/" + name;
}

class ScanCases : public ForeignFiles {
protected:
    /// The number of absent samples; others are value(at) at each place, all at one time.
    template <class Value>
    static void expectSamples(const Dataset& dataset, const Value& value, int parameter = 0, int component = 0,
                              int time = 0) {
        const Field field = dataset.read(parameter, component, time);
        const Lattice& lattice = dataset.info.lattice;
        ASSERT_EQ(field.count(), lattice.count());
        for (int z = 0; z < lattice.size.z; ++z)
            for (int y = 0; y < lattice.size.y; ++y)
                for (int x = 0; x < lattice.size.x; ++x) {
                    const std::size_t at = lattice.index({x, y, z});
                    ASSERT_TRUE(field.present(at));
                    ASSERT_EQ(field.value(at), double(value(x, y, z))) << x << " " << y << " " << z;
                }
    }
    static double counted(int x, int y, int z) { return x + 10 * y + 110 * z; }
    /// All but the time of the series, at dimensions 10 x 11 x 12.
    static Dataset openCase(const std::string& name, glm::dvec3 spacing, const std::string& unit) {
        Dataset dataset = openFiles({scan(name)}, {});
        EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(10, 11, 12)) << name;
        EXPECT_EQ(dataset.info.lattice.spacing, spacing) << name;
        EXPECT_EQ(dataset.info.lengthUnit, unit) << name;
        return dataset;
    }
    static std::string notesOf(const std::string& path) {
        std::string all;
        for (const std::string& note : previewFiles({path}, {}).notes) all += note + "\n";
        return all;
    }
    /// A NRRD file of bytes 0, 1, 2 ...
    std::string nrrd(const std::string& sizes, const std::string& fields) const {
        std::string head = "NRRD0005\ntype: uchar\nsizes: " + sizes + "\n" + fields;
        std::string samples;
        for (int i = 0; i < 255; ++i) samples += char(i);
        return write("a.nrrd", head + "encoding: raw\n\n" + samples);
    }
};

} // namespace

TEST_F(ScanCases, NrrdInEveryEncoding) {
    expectSamples(openCase("nrrd_gzip_bigendian.nrrd", {0.5, 0.5, 2}, "um"), counted);
    expectSamples(openCase("nrrd_hex.nrrd", {1, 1, 2}, ""), counted);
    expectSamples(openCase("nrrd_lineskip/lineskip.nhdr", {1, 1, 2}, ""), counted);
    expectSamples(openCase("nrrd_list/list.nhdr", {1, 1, 2}, ""), counted);
}

TEST_F(ScanCases, NrrdWithComponents) {
    const Dataset vectors = openFiles({scan("nrrd_gzip_vector.nrrd")}, {});
    ASSERT_EQ(vectors.info.parameters.size(), 1u);
    ASSERT_EQ(vectors.info.parameters[0].components, 3);
    EXPECT_EQ(vectors.info.lattice.size, glm::ivec3(10, 11, 12));
    EXPECT_EQ(vectors.info.lattice.spacing, glm::dvec3(0.5, 0.5, 2));
    double least = 1e9, most = -1e9;
    for (int c = 0; c < 3; ++c) {
        const Field field = vectors.read(0, c, 0);
        for (std::size_t i = 0; i < field.count(); ++i) {
            least = std::min(least, field.value(i));
            most = std::max(most, field.value(i));
        }
    }
    EXPECT_EQ(least, 0);
    EXPECT_EQ(most, 250);

    const Dataset lists = openFiles({scan("nrrd_vector_named_space.nrrd")}, {});
    EXPECT_EQ(lists.info.lattice.size, glm::ivec3(64, 9, 8));
    EXPECT_EQ(lists.info.lattice.spacing, glm::dvec3(0.5, 0.5, 2));
    EXPECT_EQ(lists.info.parameters.size(), 2u);
}

TEST_F(ScanCases, NrrdWithTimes) {
    const Dataset dataset = openCase("nrrd_4d_time_last_x10.nrrd", {0.5, 0.5, 2}, "mm");
    EXPECT_THAT(dataset.info.times, ElementsAre(0, 1.5, 3, 4.5, 6));
    EXPECT_EQ(dataset.info.timeUnit, "s");
    EXPECT_EQ(dataset.info.parameters.size(), 1u);
    // The time may be any axis, and its samples lie between those of a row.
    const std::string path = nrrd("2 3 4 5", "kinds: time domain domain domain\nspacings: 0.1 1 2 3\n"
                                             "axis mins: 5 nan nan nan\nunits: \"ms\" \"m\" \"m\" \"m\"\n");
    const Dataset first = openFiles({path}, {});
    EXPECT_EQ(first.info.lattice.size, glm::ivec3(3, 4, 5));
    EXPECT_THAT(first.info.times, ElementsAre(5, 5.1));
    EXPECT_EQ(first.info.timeUnit, "ms");
    for (const int t : {1, 0, 1})
        expectSamples(
            first, [&](int x, int y, int z) { return t + 2 * (x + 3 * (y + 4 * z)); }, 0, 0, t);
}

TEST_F(ScanCases, NrrdInAnyDirection) {
    // x runs backwards from 10: the first sample is the last of the file's rows.
    const Dataset flipped = openCase("nrrd_flip_x.nrrd", {0.5, 0.5, 2}, "");
    EXPECT_EQ(flipped.info.lattice.origin, glm::dvec3(5.5, 0, 0));
    expectSamples(flipped, [](int x, int y, int z) { return counted(9 - x, y, z); });
    EXPECT_THAT(notesOf(scan("nrrd_flip_x.nrrd")), HasSubstr("left, posterior and superior"));

    const std::string path = nrrd("3 4 5", "space: RAS\nspace directions: (0,0,-2) ( -0.5, 0, 0 ) (0,1,0)\n"
                                           "space origin: (1, 2, 3)\nspace units: \"mm\" \"mm\" \"mm\"\n");
    const Dataset turned = openFiles({path}, {});
    EXPECT_EQ(turned.info.lattice.size, glm::ivec3(4, 5, 3));
    EXPECT_EQ(turned.info.lattice.origin, glm::dvec3(-0.5, 2, -1));
    EXPECT_EQ(turned.info.lattice.spacing, glm::dvec3(0.5, 1, 2));
    expectSamples(turned, [](int x, int y, int z) { return (2 - z) + 3 * ((3 - x) + 4 * y); });

    // Slices alone, of a file whose layers run backwards.
    const std::string down = nrrd("3 4 5", "space dimension: 3\nspace directions: (1,0,0) (0,-1,0) (0,0,-1)\n");
    const Dataset backwards = openFiles({down}, {});
    ASSERT_TRUE(backwards.read.inParts());
    const Field part = backwards.read(0, 0, 0, SliceRange{1, 2});
    ASSERT_EQ(part.count(), 24u);
    for (int z = 0; z < 2; ++z)
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 3; ++x)
                EXPECT_EQ(part.value(std::size_t(x + 3 * (y + 4 * z))), x + 3 * ((3 - y) + 4 * (3 - z)));
}

TEST_F(ScanCases, NrrdFieldsAsTheyAreWritten) {
    const auto lattice = [&](const std::string& fields) { return openFiles({nrrd("4 5 6", fields)}, {}).info.lattice; };
    const Lattice cells = lattice("axis mins: 0 0 10\naxis maxs: 8 5 16\ncenters: cell cell cell\n");
    EXPECT_EQ(cells.spacing, glm::dvec3(2, 1, 1));
    EXPECT_EQ(cells.origin, glm::dvec3(1, 0.5, 10.5));
    const Lattice nodes = lattice("AXISMINS: 0 0 10\naxismaxs: 3 8 15\nCenterings: node node node\n");
    EXPECT_EQ(nodes.spacing, glm::dvec3(1, 2, 1));
    EXPECT_EQ(nodes.origin, glm::dvec3(0, 0, 10));
    EXPECT_EQ(lattice("spacings: NaN 2 nan\n").spacing, glm::dvec3(1, 2, 1));
    EXPECT_EQ(lattice("Space Dimension: 3\nSPACE DIRECTIONS: ( 2 , 0, 0) (0,3,0 ) (0,0,4)\n").spacing,
              glm::dvec3(2, 3, 4));
    const Dataset named = openFiles({nrrd("4 5 6", "content: flow rate\nsample units: \"m/s\"\nkey:=a: b\n")}, {});
    EXPECT_EQ(named.info.parameters[0].name, "flow rate");
    EXPECT_EQ(named.info.parameters[0].unit, "m/s");
    EXPECT_THAT(notesOf(nrrd("4 5 6", "old min: -1\nold max: 2.5\n")), HasSubstr("-1 and 2.5"));
    EXPECT_THAT(notesOf(nrrd("4 5 6", "colour: blue\n")), HasSubstr("\"colour\""));
}

TEST_F(ScanCases, NrrdAxesOfEveryKind) {
    const auto names = [&](const std::string& sizes, const std::string& fields) {
        const Dataset dataset = openFiles({nrrd(sizes, fields)}, {});
        std::string all;
        for (const Parameter& parameter : dataset.info.parameters)
            all += (all.empty() ? "" : " ") + parameter.name + (parameter.components == 3 ? "[3]" : "");
        return all + " " + std::to_string(dataset.info.times.size());
    };
    EXPECT_EQ(names("3 2 3 4", "kinds: vector domain domain domain\n"), "value[3] 1");
    EXPECT_EQ(names("3 2 3 4", "kinds: RGB-color domain domain domain\n"), "red green blue 1");
    EXPECT_EQ(names("2 2 3 4", "kinds: complex domain domain domain\n"), "real imaginary 1");
    EXPECT_EQ(names("2 3 4 3", "kinds: domain domain domain list\n"), "value.0 value.1 value.2 1");
    EXPECT_EQ(names("2 3 4 3", "kinds: domain domain domain 3-vector\ncontent: U\n"), "U[3] 1");
    EXPECT_EQ(names("2 3 4 3", "kinds: domain domain domain domain\n"), "value 3");
    EXPECT_EQ(names("2 3 2 17", "kinds: domain domain domain list\n"), "value 17");
    EXPECT_EQ(names("3 2 2 2 2", "kinds: vector domain domain domain time\n"), "value[3] 2");
    EXPECT_EQ(names("6 2 2 2", "kinds: 3D-symmetric-matrix domain domain domain\n"), "xx xy xz yy yz zz 1");
    EXPECT_THAT(notesOf(nrrd("5 6 7", "kinds: domain domain domain\n")), testing::Not(HasSubstr("taken as")));
    EXPECT_THAT(notesOf(nrrd("2 3 4 5", "")), HasSubstr("it is taken as"));
}

TEST_F(ScanCases, NrrdThatIsNoImageSaysWhy) {
    EXPECT_THAT(failure(nrrd("4 5 600", "")), HasSubstr("announces 12000"));
    EXPECT_THAT(failure(nrrd("4 5 0", "")), HasSubstr("out of range"));
    EXPECT_THAT(failure(nrrd("4 5 6", "dimension: 4\n")), HasSubstr("not the dimension"));
    EXPECT_THAT(failure(nrrd("4 5 6", "type: block\nblock size: 4\n")), HasSubstr("block"));
    EXPECT_THAT(failure(write("b.nhdr", "NRRD0004\ntype: uchar\nsizes: 2 2 2\nencoding: raw\ndata file: no.raw\n")),
                HasSubstr("no.raw cannot be read"));
    EXPECT_THAT(failure(write("c.nrrd", "NRRD0004\ntype: uchar\nsizes: 900000 900000 900\nencoding: gzip\n\nx")),
                HasSubstr("of which"));
}

TEST_F(ScanCases, NiftiByItsPlacement) {
    const Dataset dataset = openFiles({scan("nii_4d.nii")}, {});
    EXPECT_EQ(dataset.info.times.size(), 5u);
    EXPECT_DOUBLE_EQ(dataset.info.times[4] - dataset.info.times[0], 10);
    EXPECT_EQ(dataset.info.timeUnit, "s");
    const Dataset las = openFiles({scan("nii_las.nii")}, {});
    EXPECT_EQ(las.info.lattice.size, glm::ivec3(10, 11, 12));
    expectSamples(las, [](int x, int y, int z) { return counted(9 - x, y, z); });
}

namespace {

/// A NIfTI-1 header for 2 x 3 x 4 samples.
struct Nifti {
    std::string head = std::string(352, '\0');
    bool big = false;

    explicit Nifti(bool bigEndian = false) : big(bigEndian) {
        put(0, std::int32_t(348));
        sizes({3, 2, 3, 4, 1, 1, 1, 1});
        type(2, 8);
        steps({1, 1, 2, 3, 0, 0, 0, 0});
        put(108, 352.0f);
        head.replace(344, 4, std::string("n+1\0", 4));
    }
    template <class T> void put(std::size_t at, const T& values) {
        const std::string bytes = bytesOf(values, big);
        head.replace(at, bytes.size(), bytes);
    }
    void sizes(const std::vector<std::int16_t>& dims) { put(40, dims); }
    void type(std::int16_t code, std::int16_t bits) { put(70, std::vector<std::int16_t>{code, bits}); }
    void steps(const std::vector<float>& pixdim) { put(76, pixdim); }
    void sform(const std::vector<float>& rows) {
        put(254, std::int16_t(1));
        put(280, rows);
    }
};

} // namespace

TEST_F(ScanCases, NiftiOfEveryType) {
    const auto values = [&]<class T>(std::int16_t code, T, bool big) {
        Nifti nifti(big);
        nifti.type(code, std::int16_t(8 * sizeof(T)));
        std::vector<T> numbers;
        for (int i = 0; i < 24; ++i) numbers.push_back(T(100 - i));
        const Dataset dataset = openFiles({write("a.nii", nifti.head + bytesOf(numbers, big))}, {});
        expectSamples(dataset, [](int x, int y, int z) { return 100 - (x + 2 * (y + 3 * z)); });
        return dataset.info.parameters[0].type;
    };
    for (const bool big : {false, true}) {
        EXPECT_EQ(values(2, std::uint8_t(), big), ScalarType::U8);
        EXPECT_EQ(values(256, std::int8_t(), big), ScalarType::I16);
        EXPECT_EQ(values(4, std::int16_t(), big), ScalarType::I16);
        EXPECT_EQ(values(512, std::uint16_t(), big), ScalarType::U16);
        EXPECT_EQ(values(8, std::int32_t(), big), ScalarType::I32);
        EXPECT_EQ(values(768, std::uint32_t(), big), ScalarType::I32);
        EXPECT_EQ(values(1024, std::int64_t(), big), ScalarType::I32);
        EXPECT_EQ(values(1280, std::uint64_t(), big), ScalarType::I32);
        EXPECT_EQ(values(16, float(), big), ScalarType::F32);
        EXPECT_EQ(values(64, double(), big), ScalarType::F32);
    }
    Nifti tall;
    tall.type(1280, 64);
    const std::vector<std::uint64_t> large(24, std::uint64_t(1) << 40);
    const std::string path = write("b.nii", tall.head + bytesOf(large));
    EXPECT_EQ(openFiles({path}, {}).read(0, 0, 0).value(5), std::ldexp(1.0, 40));
    EXPECT_THAT(notesOf(path), HasSubstr("rounded"));
    Nifti wide;
    wide.type(1536, 128);
    EXPECT_THAT(failure(write("c.nii", wide.head + std::string(400, 'x'))), HasSubstr("128 bits"));
}

TEST_F(ScanCases, NiftiScalesAndHasComponents) {
    Nifti scaled;
    scaled.put(112, 0.5f);
    scaled.put(116, -1.0f);
    const std::string bytes(24, '\x08');
    EXPECT_EQ(openFiles({write("a.nii", scaled.head + bytes)}, {}).read(0, 0, 0).value(3), 3);
    scaled.put(112, std::numeric_limits<float>::quiet_NaN());
    EXPECT_EQ(openFiles({write("a.nii", scaled.head + bytes)}, {}).read(0, 0, 0).value(3), 8);

    Nifti vectors;
    vectors.sizes({5, 2, 3, 4, 1, 3, 1, 1});
    vectors.put(68, std::int16_t(1007));
    vectors.head.replace(328, 4, "flow");
    std::string samples;
    for (int i = 0; i < 72; ++i) samples += char(i);
    const Dataset flow = openFiles({write("b.nii", vectors.head + samples)}, {});
    ASSERT_EQ(flow.info.parameters.size(), 1u);
    EXPECT_EQ(flow.info.parameters[0].name, "flow");
    for (int c = 0; c < 3; ++c)
        expectSamples(
            flow, [&](int x, int y, int z) { return x + 2 * (y + 3 * z) + 24 * c; }, 0, c);

    Nifti colors;
    colors.type(128, 24);
    const Dataset rgb = openFiles({write("c.nii", colors.head + samples)}, {});
    ASSERT_EQ(rgb.info.parameters.size(), 3u);
    EXPECT_EQ(rgb.info.parameters[2].name, "blue");
    expectSamples(
        rgb, [](int x, int y, int z) { return 3 * (x + 2 * (y + 3 * z)) + 2; }, 2);
}

TEST_F(ScanCases, NiftiSaysWhatPlacesIt) {
    const std::string bytes(24, 'x');
    Nifti nifti;
    EXPECT_THAT(notesOf(write("a.nii", nifti.head + bytes)), HasSubstr("no orientation"));
    nifti.sform({0, -2, 0, 10, 1, 0, 0, 20, 0, 0, 3, 30});
    const Dataset turned = openFiles({write("a.nii", nifti.head + bytes)}, {});
    EXPECT_EQ(turned.info.lattice.size, glm::ivec3(3, 2, 4));
    EXPECT_EQ(turned.info.lattice.origin, glm::dvec3(6, 20, 30));
    nifti.put(252, std::int16_t(1)); // a qform of no rotation
    EXPECT_THAT(notesOf(write("a.nii", nifti.head + bytes)), HasSubstr("sform is taken"));
    nifti.put(254, std::int16_t(0));
    nifti.put(268, std::vector<float>{1, 2, 3});
    nifti.steps({-1, 1, 2, 3, 0, 0, 0, 0}); // its third axis is turned round
    const Dataset byQform = openFiles({write("a.nii", nifti.head + bytes)}, {});
    EXPECT_EQ(byQform.info.lattice.origin, glm::dvec3(1, 2, 3 - 9));
    EXPECT_EQ(byQform.info.lattice.spacing, glm::dvec3(1, 2, 3));

    Nifti pair;
    pair.head.replace(344, 4, std::string("ni1\0", 4));
    pair.put(108, 0.0f);
    write("p.img", bytes);
    const std::string header = write("p.hdr", pair.head.substr(0, 348));
    EXPECT_EQ(openFiles({header}, {}).read(0, 0, 0).value(0), 'x');
    EXPECT_EQ(openFiles({(folder_ / "p.img").string()}, {}).read(0, 0, 0).value(0), 'x');
    fs::remove(folder_ / "p.img");
    EXPECT_THAT(failure(header), HasSubstr("p.img is missing"));
    write("p.img.gz", stored(bytes, false));
    EXPECT_EQ(openFiles({header}, {}).read(0, 0, 0).value(0), 'x');
    pair.head.replace(344, 4, std::string(4, '\0'));
    EXPECT_THAT(notesOf(write("p.hdr", pair.head.substr(0, 348))), HasSubstr("Analyze 7.5"));
}

TEST_F(ScanCases, MetaImage) {
    const Dataset longs = openCase("mha_long.mha", {0.5, 0.5, 2}, "");
    expectSamples(longs, counted);
    expectSamples(openCase("mha_compressed_size_too_small.mha", {1, 1, 1}, ""), counted);

    const auto meta = [&](const std::string& fields, const std::string& data, const std::string& samples) {
        return write("a.mha", "ObjectType = Image\n" + fields + "ElementDataFile = " + data + "\n" + samples);
    };
    std::string bytes;
    for (int i = 0; i < 48; ++i) bytes += char(i);
    const Dataset turned = openFiles({meta("NDims = 3\nDimSize = 2 3 4\nElementType = MET_UCHAR\nOffset = 1 2 3\n"
                                           "ElementSpacing = 1 2 3\nTransformMatrix = 0 1 0 -1 0 0 0 0 1\n",
                                           "LOCAL", bytes)},
                                     {});
    EXPECT_EQ(turned.info.lattice.size, glm::ivec3(3, 2, 4)); // the first axis runs along y, the second against x
    EXPECT_EQ(turned.info.lattice.origin, glm::dvec3(-3, 2, 3));
    EXPECT_EQ(turned.info.lattice.spacing, glm::dvec3(2, 1, 3));
    expectSamples(turned, [](int x, int y, int z) { return y + 2 * ((2 - x) + 3 * z); });

    const Dataset times = openFiles({meta("NDims = 4\nDimSize = 2 3 4 2\nElementType = MET_UCHAR\n"
                                          "ElementSpacing = 1 1 1 0.5\nOffset = 0 0 0 2\n",
                                          "LOCAL", bytes)},
                                    {});
    EXPECT_THAT(times.info.times, ElementsAre(2, 2.5));
    expectSamples(
        times, [](int x, int y, int z) { return 24 + x + 2 * (y + 3 * z); }, 0, 0, 1);

    for (int i = 0; i < 4; ++i) write("s" + std::to_string(i) + ".raw", "head" + bytes.substr(std::size_t(i) * 6, 6));
    for (const char* const files : {"LIST\ns0.raw\ns1.raw\ns2.raw\ns3.raw", "s%d.raw 0 3 1"})
        for (const char* const skip : {"4", "-1"}) {
            const Dataset listed = openFiles(
                {meta("NDims = 3\nDimSize = 2 3 4\nElementType = MET_UCHAR\nHeaderSize = " + std::string(skip) + "\n",
                      files, "")},
                {});
            expectSamples(listed, [](int x, int y, int z) { return x + 2 * (y + 3 * z); });
        }
}

TEST_F(ScanCases, Mgh) {
    std::string head;
    for (const std::int32_t number : {1, 2, 3, 4, 1, 4, 0}) head += bytesOf(number, true);
    head += bytesOf(std::int16_t(1), true);
    // Steps of 1, 2, 3; the first axis runs against x, the others along z and y; the middle at (10, 20, 30).
    head += bytesOf(std::vector<float>{1, 2, 3, -1, 0, 0, 0, 0, 1, 0, 1, 0, 10, 20, 30}, true);
    head.resize(284, '\0');
    std::vector<std::int16_t> numbers;
    for (int i = 0; i < 24; ++i) numbers.push_back(std::int16_t(i));
    const std::string file = head + bytesOf(numbers, true);
    for (const std::string& path : {write("a.mgh", file), write("a.mgz", stored(file, false))}) {
        const Dataset dataset = openFiles({path}, {});
        EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(2, 4, 3));
        EXPECT_EQ(dataset.info.lattice.spacing, glm::dvec3(1, 3, 2));
        EXPECT_EQ(dataset.info.lattice.origin, glm::dvec3(10, 14, 27));
        EXPECT_EQ(dataset.info.lengthUnit, "mm");
        expectSamples(dataset, [](int x, int y, int z) { return (1 - x) + 2 * (z + 3 * y); });
    }
    EXPECT_NE(failure(write("cut.mgh", file.substr(0, file.size() - 1))), "");
}

} // namespace tessera::volume
