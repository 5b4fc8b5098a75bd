// NIfTI, Analyze, MetaImage, MGH and MINC: every value at its place, times, units, names.
#include "tests/import/scan_files.h"

#include <cmath>
#include <limits>

using testing::ElementsAre;
using testing::HasSubstr;

namespace tessera::volume {

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
    const Field whole = openCase("mha_compressed_size_too_small.mha", {1, 1, 1}, "").read(0, 0, 0);
    double sum = 0;
    for (std::size_t i = 0; i < whole.count(); ++i) sum += whole.value(i);
    EXPECT_EQ(whole.value(1), 235);
    EXPECT_EQ(whole.value(1319), 2202);
    EXPECT_EQ(sum, 1969657);

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

TEST_F(ScanCases, Minc) {
    for (const char* const name : {"minc1.mnc", "minc2.mnc"}) {
        const Dataset dataset = openFiles({scan(name)}, {});
        EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(5, 4, 3));
        EXPECT_EQ(dataset.info.lattice.spacing, glm::dvec3(0.5, 1, 2));
        EXPECT_EQ(dataset.info.lattice.origin, glm::dvec3(10, 17, 30));
        EXPECT_EQ(dataset.info.lengthUnit, "mm");
        // y runs backwards; stored numbers 0 .. 59 are values 0 .. 590.
        expectSamples(dataset, [](int x, int y, int z) { return 10 * (x + 5 * ((3 - y) + 4 * z)); });
    }
    const std::string whole = read(scan("minc1.mnc"));
    EXPECT_NE(failure(write("cut.mnc", whole.substr(0, whole.size() / 2))), "");
    EXPECT_NE(failure(write("not.mnc", "hello")), "");
}

} // namespace tessera::volume
