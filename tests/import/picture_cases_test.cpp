// TIFF as ImageJ, OME and tifffile write it, and stacks of other pictures.
#include "tests/import/case_files.h"

namespace tessera::volume {

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class PictureCases : public CaseFiles {};

TEST_F(PictureCases, ImageJ) {
    expectRamp(openFiles({stored("tiff/tif_imagej_depth_1um.tif")}, {}), {0.2, 0.2, 1}, "um");
    expectRamp(openFiles({stored("tiff/tif_imagej_one_directory.tif")}, {}), {0.2, 0.2, 1.5}, "um");
    const Dataset shifted = openFiles({stored("tiff/tif_imagej_signed16.tif")}, {});
    EXPECT_EQ(shifted.info.lattice.spacing, glm::dvec3(1, 1, 1.5));
    EXPECT_EQ(shifted.info.parameters[0].type, ScalarType::I16);
    const double first = shifted.read(0, 0, 0).value(0);
    EXPECT_LT(first, 0);
    EXPECT_EQ(wrong(shifted, 0, 0, 0, [&](int x, int y, int z) { return first + ramp(x, y, z); }), 0);
    const Dataset hyper = openFiles({stored("tiff/imagej_hyperstack.tif")}, {});
    EXPECT_EQ(hyper.info.lattice.size, glm::ivec3(6, 5, 3));
    EXPECT_EQ(hyper.info.lattice.spacing, glm::dvec3(0.3, 0.3, 1.25));
    EXPECT_THAT(names(hyper), ElementsAre("DAPI", "GFP", "RFP", "Cy5"));
    EXPECT_THAT(hyper.info.times, ElementsAre(0, 2.5));
    EXPECT_EQ(hyper.info.timeUnit, "s");
    for (const int t : {1, 0})
        for (int c = 0; c < 4; ++c)
            EXPECT_EQ(wrong(hyper, c, 0, t,
                            [&](int x, int y, int z) { return (x + 6 * (y + 5 * (c + 4 * (z + 3 * t)))) % 256; }),
                      0);
}

TEST_F(PictureCases, OneDirectoryIsWhole) {
    const std::string path = write("one.tif", read(stored("tiff/tif_imagej_one_directory.tif")));
    expectCutsAreTold(path, path);
}

TEST_F(PictureCases, Ome) {
    const Dataset dataset = openFiles({stored("tiff/tif_ome_tczyx.ome.tif")}, {});
    EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(10, 11, 4));
    EXPECT_EQ(dataset.info.lattice.spacing, glm::dvec3(0.5, 0.5, 2));
    EXPECT_EQ(dataset.info.lengthUnit, "um");
    EXPECT_THAT(names(dataset), ElementsAre("channel 1", "channel 2"));
    EXPECT_THAT(dataset.info.times, ElementsAre(0, 0.5, 1));
    EXPECT_EQ(dataset.info.timeUnit, "s");
    // In several files, of which one is not there.
    const std::string path = stored("tiff/ome/first.ome.tif");
    const Dataset several = openFiles({path}, {});
    EXPECT_THAT(names(several), ElementsAre("DAPI", "GFP"));
    EXPECT_EQ(several.info.lattice.size, glm::ivec3(10, 11, 3));
    EXPECT_EQ(wrong(several, 0, 0, 0, ramp), 0);
    EXPECT_EQ(wrong(several, 1, 0, 0, [](int x, int y, int z) { return 5000 + ramp(x, y, z); }), 110);
    EXPECT_FALSE(several.read(1, 0, 0).present(220));
    EXPECT_THAT(notesOn(path), HasSubstr("lost.ome.tif is not there"));
}

TEST_F(PictureCases, Microscope) {
    const Dataset dataset = openFiles({stored("tiff/zeiss.lsm")}, {});
    EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(10, 11, 2));
    EXPECT_EQ(dataset.info.lattice.spacing, glm::dvec3(0.1, 0.2, 0.5));
    EXPECT_THAT(dataset.info.times, ElementsAre(0, 1.5));
    EXPECT_EQ(wrong(dataset, 1, 0, 1, [](int x, int y, int z) { return 5000 + ramp(x, y, z + 2); }), 0);
}

TEST_F(PictureCases, NumbersOfAnyBits) {
    expectRamp(openFiles({stored("tiff/tif_float16.tif")}, {}), {1, 1, 1}, "");
    for (const int bits : {1, 4, 12}) {
        const Dataset dataset = openFiles({stored("tiff/bits" + std::to_string(bits) + ".tif")}, {});
        EXPECT_EQ(wrong(dataset, 0, 0, 0, [&](int x, int y, int) { return (x + 9 * y) * 37 % (1 << bits); }), 0)
            << bits;
    }
    const Dataset colours = openFiles({stored("tiff/planes.tif")}, {});
    EXPECT_THAT(names(colours), ElementsAre("red", "green", "blue"));
    for (int c = 0; c < 3; ++c)
        EXPECT_EQ(wrong(colours, c, 0, 0, [&](int x, int y, int z) { return (c + 3 * (x + 10 * (y + 11 * z))) % 251; }),
                  0);
}

TEST_F(PictureCases, ResolutionAndOtherPages) {
    const std::string path = stored("tiff/cm.tif");
    const Dataset dataset = openFiles({path}, {});
    EXPECT_EQ(dataset.info.lattice.spacing, glm::dvec3(0.001, 0.0005, 0.001));
    EXPECT_EQ(dataset.info.lengthUnit, "cm");
    EXPECT_THAT(notesOn(path), HasSubstr("distance of slices is not stated"));
    const std::string small = stored("tiff/thumbnails.tif");
    const Dataset large = openFiles({small}, {});
    EXPECT_EQ(large.info.lattice.size, glm::ivec3(10, 11, 3));
    EXPECT_EQ(wrong(large, 0, 0, 0, ramp), 0);
    EXPECT_THAT(notesOn(small), HasSubstr("3 of its 6 pages"));
}

TEST_F(PictureCases, MissingSliceIsTold) {
    const std::string folder = stored("tiff/tif_slices_gap");
    const Dataset dataset = openFiles({folder}, {});
    EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(10, 11, 11));
    EXPECT_EQ(wrong(dataset, 0, 0, 0, [](int x, int y, int z) { return ramp(x, y, z < 5 ? z : z + 1); }), 0);
    EXPECT_THAT(notesOn(folder), HasSubstr("the slice of number 5 is missing"));
}

TEST_F(PictureCases, Png) {
    for (const std::string& named : {stored("pictures/png_slices"), stored("pictures/png_slices/s_*.png")}) {
        const Dataset dataset = openFiles({named}, {});
        EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(10, 11, 12));
        EXPECT_EQ(wrong(dataset, 0, 0, 0, [](int x, int y, int z) { return int(ramp(x, y, z)) % 256; }), 0);
    }
    const std::string png = read(stored("pictures/png_slices/s_0003.png"));
    const std::string path = write("one.png", png);
    EXPECT_EQ(openFiles({path}, {}).info.lattice.size, glm::ivec3(10, 11, 1));
    expectCutsAreTold(path, path);
    // A picture beside a stack is none of its slices.
    for (const char* name : {"l/s1.png", "l/s2.png"}) write(name, png);
    write("l/logo.png", read(stored("pictures/png_slices/s_0001.png")));
    const Dataset stack = openFiles({(folder_ / "l").string()}, {});
    EXPECT_EQ(stack.info.lattice.size, glm::ivec3(10, 11, 2));
    EXPECT_EQ(stack.info.parameters.size(), 1u);
    // Pictures beside data are not the data.
    write("mixed/a.png", png);
    write("mixed/b.png", png);
    write("mixed/t.csv", "x,y,z,T\n0,0,0,1\n1,0,0,2\n0,1,0,3\n1,1,0,4\n0,0,1,1\n1,0,1,2\n0,1,1,3\n1,1,1,4\n");
    EXPECT_THAT(names(openFiles({(folder_ / "mixed").string()}, {})), ElementsAre("T"));
}

std::string bmp(int first, bool topDown) { // 3 x 2 pixels of a grey palette
    std::string head = "BM" + bytesOf(std::uint32_t(0)) + bytesOf(std::uint32_t(0)) +
                       bytesOf(std::uint32_t(54 + 1024)) + bytesOf(std::uint32_t(40)) + bytesOf(std::int32_t(3)) +
                       bytesOf(std::int32_t(topDown ? -2 : 2)) + bytesOf(std::uint16_t(1)) + bytesOf(std::uint16_t(8)) +
                       std::string(24, '\0');
    for (int i = 0; i < 256; ++i) head += std::string(3, char(i)) + std::string(1, '\0');
    const std::string top{char(first), char(first + 1), char(first + 2), 0};
    const std::string low{char(first + 3), char(first + 4), char(first + 5), 0};
    return head + (topDown ? top + low : low + top);
}

TEST_F(PictureCases, BmpAndNetpbm) {
    for (const bool topDown : {false, true}) {
        for (int z = 8; z < 11; ++z) write("b/s" + std::to_string(z) + ".bmp", bmp(10 * z, topDown));
        const Dataset dataset = openFiles({(folder_ / "b").string()}, {});
        EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(3, 2, 3));
        EXPECT_EQ(wrong(dataset, 0, 0, 0, [](int x, int y, int z) { return 10 * (z + 8) + x + 3 * y; }), 0);
    }
    write("b/s9.bmp", bmp(0, false).substr(0, 1080));
    EXPECT_THAT(failure((folder_ / "b").string()), HasSubstr("its slice s9.bmp has"));
    const std::string grey = write("g.pgm", "P5\n# words\n3 2\n1000\n" + std::string("\0\1\0\2\0\3\2\0\2\1\2\2", 12));
    const Dataset dataset = openFiles({grey}, {});
    EXPECT_EQ(dataset.info.parameters[0].type, ScalarType::U16);
    EXPECT_EQ(wrong(dataset, 0, 0, 0, [](int x, int y, int) { return y == 0 ? x + 1 : 512 + x; }), 0);
    EXPECT_EQ(openFiles({write("c.ppm", "P3 1 1 255 7 8 9")}, {}).read(2, 0, 0).value(0), 9);
}

TEST_F(PictureCases, NamesOfSlicesChannelsAndTimes) {
    const std::string png = read(stored("pictures/png_slices/s_0003.png"));
    for (const char* time : {"t1", "t2"})
        for (const char* slice : {"z8", "z9", "z10"})
            for (const char* channel : {"c0", "c1"})
                write(std::string("n/run_") + time + "_" + slice + "_" + channel + ".png", png);
    const Dataset dataset = openFiles({(folder_ / "n").string()}, {});
    EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(10, 11, 3));
    EXPECT_THAT(dataset.info.times, ElementsAre(1, 2));
    EXPECT_EQ(dataset.info.parameters.size(), 2u);
    // The same letter in all names is none of slices.
    for (int n = 1; n < 5; ++n) write("m/z5_" + std::to_string(n) + ".png", png);
    EXPECT_EQ(openFiles({(folder_ / "m").string()}, {}).info.lattice.size, glm::ivec3(10, 11, 4));
}

} // namespace

} // namespace tessera::volume
