// NumPy, HDF5, TIFF and DICOM: files written here byte by byte or by their libraries.
#include "tests/import/foreign_files.h"
#include "volume/import/files/formats.h"
#include "volume/import/files/named_files.h"

#include <hdf5.h>
#include <map>
#include <set>
#include <sstream>
#include <tiffio.h>

namespace tessera::volume {
namespace {

using BinaryFormats = ForeignFiles;

constexpr glm::ivec3 kSize(5, 4, 6);
constexpr int kCount = 5 * 4 * 6;

/// [t, z, y, x (, components)]
template <class T> std::vector<T> numbers(int times, int components) {
    std::vector<T> out;
    for (int n = 0; n < times * kCount * components; ++n) out.push_back(static_cast<T>((n * 7) % 113 + 1));
    return out;
}
/// What of `numbers` is at a sample.
double at(int time, int sample, int component, int components) {
    return double((((time * kCount + sample) * components + component) * 7) % 113 + 1);
}

std::string npy(const std::string& descr, const std::string& shape, const std::string& data, bool fortran = false) {
    std::string header =
        "{'descr': '" + descr + "', 'fortran_order': " + (fortran ? "True" : "False") + ", 'shape': (" + shape + "), }";
    header += std::string(64 - (11 + header.size()) % 64, ' ') + "\n";
    return std::string("\x93NUMPY\x01\0", 8) + bytesOf(std::uint16_t(header.size())) + header + data;
}

TEST_F(BinaryFormats, NumPyArrays) {
    const std::string path = write("T.npy", npy("<f8", "2, 6, 4, 5", bytesOf(numbers<double>(2, 1))));
    const Dataset dataset = openFiles({path}, {});
    ASSERT_EQ(dataset.info.lattice.size, kSize);
    EXPECT_EQ(dataset.info.parameters[0].name, "T");
    EXPECT_EQ(dataset.info.times.size(), 2u);
    EXPECT_EQ(dataset.info.lengthUnit, "");
    for (int t = 0; t < 2; ++t)
        for (int i = 0; i < kCount; ++i) ASSERT_EQ(dataset.read(0, 0, t).value(std::size_t(i)), at(t, i, 0, 1));
    expectCutsAreTold(path, path);

    const std::string big = write("U.npy", npy(">i2", "6, 4, 5, 3", bytesOf(numbers<std::int16_t>(1, 3), true)));
    const Dataset vector = openFiles({big}, {});
    EXPECT_EQ(vector.info.parameters[0].components, 3);
    EXPECT_EQ(vector.info.parameters[0].type, ScalarType::I16);
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < kCount; ++i) ASSERT_EQ(vector.read(0, c, 0).value(std::size_t(i)), at(0, i, c, 3));

    std::vector<float> turned(kCount); // the first index is the fastest
    for (int k = 0; k < 6; ++k)
        for (int j = 0; j < 4; ++j)
            for (int i = 0; i < 5; ++i)
                turned[std::size_t((i * 4 + j) * 6 + k)] = float(at(0, (k * 4 + j) * 5 + i, 0, 1));
    const Dataset fortran = openFiles({write("f.npy", npy("<f4", "6, 4, 5", bytesOf(turned), true))}, {});
    for (int i = 0; i < kCount; ++i) ASSERT_EQ(fortran.read(0, 0, 0).value(std::size_t(i)), at(0, i, 0, 1));
    EXPECT_THAT(failure(write("short.npy", npy("<f4", "6, 4, 5", std::string(479, 'a')))),
                testing::HasSubstr("has 479 bytes of samples, but its header announces 480"));
    EXPECT_THAT(failure(write("huge.npy", npy("<f4", "6000000000000, 4000000000000", std::string(480, 'a')))),
                testing::HasSubstr("announces 9.6e+25"));
    EXPECT_THAT(failure(write("negative.npy", npy("<f4", "6, 4, -5", std::string(480, 'a')))),
                testing::HasSubstr("damaged header"));
    EXPECT_THAT(failure(write("c.npy", npy("<c8", "6, 4, 5", std::string(960, 'a')))), testing::HasSubstr("astype"));
}

std::string zipOf(const std::map<std::string, std::string>& members) {
    std::string out, list;
    for (const auto& [name, data] : members) {
        const std::string crc = stored(data, false).substr(stored(data, false).size() - 8, 4);
        const std::string sizes = crc + bytesOf(std::uint32_t(data.size())) + bytesOf(std::uint32_t(data.size()));
        list += "PK\1\2" + bytesOf(std::vector<std::uint16_t>{20, 20, 0, 0, 0, 0}) + sizes +
                bytesOf(std::vector<std::uint16_t>{std::uint16_t(name.size()), 0, 0, 0, 0, 0, 0}) +
                bytesOf(std::uint32_t(out.size())) + name;
        out += "PK\3\4" + bytesOf(std::vector<std::uint16_t>{20, 0, 0, 0, 0}) + sizes +
               bytesOf(std::vector<std::uint16_t>{std::uint16_t(name.size()), 0}) + name + data;
    }
    const auto count = std::uint16_t(members.size());
    return out + list + "PK\5\6" + bytesOf(std::vector<std::uint16_t>{0, 0, count, count}) +
           bytesOf(std::uint32_t(list.size())) + bytesOf(std::uint32_t(out.size())) + bytesOf(std::uint16_t(0));
}

TEST_F(BinaryFormats, NumPyArchiveWithPlacesAndTimes) {
    const std::string path =
        write("a.npz", zipOf({{"T.npy", npy("<f4", "2, 6, 4, 5", bytesOf(numbers<float>(2, 1)))},
                              {"U.npy", npy("<f4", "2, 6, 4, 5, 3", bytesOf(numbers<float>(2, 3)))},
                              {"mask.npy", npy("|u1", "6, 4, 5", bytesOf(numbers<std::uint8_t>(1, 1)))},
                              {"t.npy", npy("<f8", "2,", bytesOf(std::vector<double>{0.5, 2}))},
                              {"x.npy", npy("<f8", "5,", bytesOf(std::vector<double>{1, 3, 5, 7, 9}))}}));
    const Dataset dataset = openFiles({path}, {});
    EXPECT_EQ(dataset.info.times, (std::vector<double>{0.5, 2}));
    EXPECT_EQ(dataset.info.lattice.origin, glm::dvec3(1, 0, 0));
    EXPECT_EQ(dataset.info.lattice.spacing, glm::dvec3(2, 1, 1));
    ASSERT_EQ(dataset.info.parameters.size(), 3u);
    EXPECT_EQ(dataset.read(1, 2, 1).value(9), at(1, 9, 2, 3));
    EXPECT_EQ(dataset.read(2, 0, 1).value(9), at(0, 9, 0, 1));
    expectCutsAreTold(path, path);
    const Dataset list =
        openFiles({write("b.npz", zipOf({{"h.npy", npy("<f4", "6, 4, 5", bytesOf(numbers<float>(1, 1)))},
                                         {"z.npy", npy("<f4", "6,", bytesOf(std::vector<float>{9, 8, 7, 6, 5, 4}))}}))},
                  {});
    EXPECT_EQ(list.info.lattice.origin.z, 4); // falling places are turned round
    EXPECT_EQ(list.read(0, 0, 0).value(0), at(0, 5 * 20, 0, 1));
}

void putArray(hid_t file, const char* path, std::vector<hsize_t> dims, const void* data, hid_t type, const char* unit) {
    const hid_t links = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    const hid_t space = H5Screate_simple(int(dims.size()), dims.data(), nullptr);
    const hid_t dataset = H5Dcreate2(file, path, type, space, links, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
    if (unit != nullptr) {
        const hid_t text = H5Tcopy(H5T_C_S1), one = H5Screate(H5S_SCALAR);
        H5Tset_size(text, std::strlen(unit));
        const hid_t attribute = H5Acreate2(dataset, "units", text, one, H5P_DEFAULT, H5P_DEFAULT);
        H5Awrite(attribute, text, unit);
        H5Aclose(attribute);
        H5Sclose(one);
        H5Tclose(text);
    }
    H5Dclose(dataset);
    H5Sclose(space);
    H5Pclose(links);
}

TEST_F(BinaryFormats, Hdf5ByPath) {
    const std::string path = (folder_ / "a.h5").string();
    const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    putArray(file, "/fields/T", {2, 6, 4, 5}, numbers<float>(2, 1).data(), H5T_NATIVE_FLOAT, "K");
    putArray(file, "/fields/U", {2, 6, 4, 5, 3}, numbers<double>(2, 3).data(), H5T_NATIVE_DOUBLE, "m/s");
    putArray(file, "/region", {6, 4, 5}, numbers<std::uint8_t>(1, 1).data(), H5T_NATIVE_UCHAR, nullptr);
    putArray(file, "/other", {3, 3}, numbers<float>(1, 1).data(), H5T_NATIVE_FLOAT, nullptr);
    putArray(file, "/time", {2}, std::vector<double>{1, 4}.data(), H5T_NATIVE_DOUBLE, "s");
    putArray(file, "/z", {6}, std::vector<double>{0, 2, 4, 6, 8, 10}.data(), H5T_NATIVE_DOUBLE, "um");
    H5Fclose(file);
    const Dataset dataset = openFiles({path}, {});
    EXPECT_EQ(dataset.info.times, (std::vector<double>{1, 4}));
    EXPECT_EQ(dataset.info.timeUnit, "s");
    EXPECT_EQ(dataset.info.lengthUnit, "um");
    EXPECT_EQ(dataset.info.lattice.spacing.z, 2);
    ASSERT_EQ(dataset.info.parameters.size(), 3u);
    EXPECT_EQ(dataset.info.parameters[0].name, "fields/T");
    EXPECT_EQ(dataset.info.parameters[0].unit, "K");
    for (int i = 0; i < kCount; ++i) {
        ASSERT_EQ(dataset.read(0, 0, 1).value(std::size_t(i)), at(1, i, 0, 1));
        ASSERT_EQ(dataset.read(1, 1, 1).value(std::size_t(i)), at(1, i, 1, 3));
        ASSERT_EQ(dataset.read(2, 0, 1).value(std::size_t(i)), at(0, i, 0, 1));
    }
    EXPECT_THAT(previewFiles({path}, {}).notes, testing::Contains(testing::HasSubstr("1 array of another size")));
    expectCutsAreTold(path, path);
}

// A few bytes of a damaged file can state more times than their list has room for.
TEST_F(BinaryFormats, Hdf5OfEndlessTimesIsRefused) {
    const std::string path = (folder_ / "a.h5").string();
    const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hsize_t dims[] = {hsize_t(1) << 50, 6, 4, 5}, chunk[] = {1, 6, 4, 5};
    const hid_t space = H5Screate_simple(4, dims, nullptr), parts = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(parts, 4, chunk);
    H5Dclose(H5Dcreate2(file, "T", H5T_NATIVE_FLOAT, space, H5P_DEFAULT, parts, H5P_DEFAULT));
    H5Pclose(parts);
    H5Sclose(space);
    H5Fclose(file);
    EXPECT_THAT(failure(path), testing::HasSubstr("array \"T\" states 1125899906842624 times, more than 10000000"));
}

/// A dataset of 2 GB in a few KB: only its first chunk is written, if any.
std::string hollow(const std::string& path, bool written) {
    const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hsize_t dims[] = {1000, 1000, 500}, chunk[] = {1, 10, 500}, begin[] = {0, 0, 0};
    const hid_t space = H5Screate_simple(3, dims, nullptr), part = H5Screate_simple(3, chunk, nullptr);
    const hid_t parts = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(parts, 3, chunk);
    H5Pset_deflate(parts, 9);
    const hid_t dataset = H5Dcreate2(file, "T", H5T_NATIVE_FLOAT, space, H5P_DEFAULT, parts, H5P_DEFAULT);
    const std::vector<float> values(5000, 1);
    H5Sselect_hyperslab(space, H5S_SELECT_SET, begin, nullptr, chunk, nullptr);
    if (written) H5Dwrite(dataset, H5T_NATIVE_FLOAT, part, space, H5P_DEFAULT, values.data());
    H5Dclose(dataset);
    H5Pclose(parts);
    H5Sclose(part);
    H5Sclose(space);
    H5Fclose(file);
    return path;
}

TEST_F(BinaryFormats, Hdf5OfFarMoreThanIsStoredIsRefusedAtOnce) {
    for (const bool written : {false, true}) {
        const std::string path = hollow((folder_ / "a.h5").string(), written);
        EXPECT_LT(fs::file_size(path), 10000u);
        EXPECT_THAT(failure(path), testing::HasSubstr("array \"T\" states 2 GB, of which")) << written;
    }
    // As densely as deflate can pack it, and small ones without any stored sample: both are read.
    const std::string path = (folder_ / "b.h5").string();
    const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hsize_t dims[] = {300, 300, 300}, chunk[] = {300, 300, 300};
    for (const bool written : {false, true}) {
        const hid_t space = H5Screate_simple(3, dims, nullptr), parts = H5Pcreate(H5P_DATASET_CREATE);
        H5Pset_chunk(parts, 3, chunk);
        H5Pset_deflate(parts, 9);
        const hid_t dataset =
            H5Dcreate2(file, written ? "dense" : "unwritten", H5T_NATIVE_UCHAR, space, H5P_DEFAULT, parts, H5P_DEFAULT);
        const std::vector<std::uint8_t> values(27'000'000, 7);
        if (written) H5Dwrite(dataset, H5T_NATIVE_UCHAR, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
        H5Dclose(dataset);
        H5Pclose(parts);
        H5Sclose(space);
    }
    H5Fclose(file);
    EXPECT_EQ(openFiles({path}, {}).info.parameters.size(), 2u);
}

TEST_F(BinaryFormats, VtkHdfImage) {
    const std::string path = (folder_ / "a.vtkhdf").string();
    const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t root = H5Gcreate2(file, "VTKHDF", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const auto put = [&](const char* name, hid_t type, std::vector<hsize_t> dims, const void* data) {
        const hid_t space = H5Screate_simple(int(dims.size()), dims.data(), nullptr);
        const hid_t attribute = H5Acreate2(root, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
        H5Awrite(attribute, type, data);
        H5Aclose(attribute);
        H5Sclose(space);
    };
    const hid_t text = H5Tcopy(H5T_C_S1), one = H5Screate(H5S_SCALAR);
    H5Tset_size(text, 9);
    const hid_t kind = H5Acreate2(root, "Type", text, one, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(kind, text, "ImageData");
    put("Version", H5T_NATIVE_INT, {2}, std::vector<int>{1, 0}.data());
    put("WholeExtent", H5T_NATIVE_INT, {6}, std::vector<int>{0, 4, 0, 3, 0, 5}.data());
    put("Origin", H5T_NATIVE_DOUBLE, {3}, std::vector<double>{1, 2, 3}.data());
    put("Spacing", H5T_NATIVE_DOUBLE, {3}, std::vector<double>{0.5, 1, 2}.data());
    put("Direction", H5T_NATIVE_DOUBLE, {9}, std::vector<double>{1, 0, 0, 0, 1, 0, 0, 0, 1}.data());
    H5Aclose(kind);
    H5Sclose(one);
    H5Tclose(text);
    H5Gclose(root);
    putArray(file, "/VTKHDF/PointData/T", {6, 4, 5}, numbers<float>(1, 1).data(), H5T_NATIVE_FLOAT, nullptr);
    H5Fclose(file);
    const Dataset dataset = openFiles({path}, {});
    ASSERT_EQ(dataset.info.lattice.size, kSize);
    EXPECT_EQ(dataset.info.lattice.origin, glm::dvec3(1, 2, 3));
    for (int i = 0; i < kCount; ++i) ASSERT_EQ(dataset.read(0, 0, 0).value(std::size_t(i)), at(0, i, 0, 1));
    expectCutsAreTold(path, path);
}

void writeTiff(const std::string& path, int first, int pages, bool packed, const std::string& words = {}) {
    TIFF* file = TIFFOpen(path.c_str(), "w");
    std::vector<std::uint16_t> all = numbers<std::uint16_t>(1, 1);
    for (int page = first; page < first + pages; ++page) {
        TIFFSetField(file, TIFFTAG_IMAGEWIDTH, 5);
        TIFFSetField(file, TIFFTAG_IMAGELENGTH, 4);
        TIFFSetField(file, TIFFTAG_BITSPERSAMPLE, 16);
        TIFFSetField(file, TIFFTAG_SAMPLESPERPIXEL, 1);
        TIFFSetField(file, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
        TIFFSetField(file, TIFFTAG_COMPRESSION, packed ? COMPRESSION_LZW : COMPRESSION_NONE);
        TIFFSetField(file, TIFFTAG_XRESOLUTION, 4.0);
        TIFFSetField(file, TIFFTAG_YRESOLUTION, 2.0);
        if (!words.empty()) TIFFSetField(file, TIFFTAG_IMAGEDESCRIPTION, words.c_str());
        for (std::uint32_t y = 0; y < 4; ++y)
            TIFFWriteScanline(file, all.data() + std::size_t(page) * 20 + y * 5, y, 0);
        TIFFWriteDirectory(file);
    }
    TIFFClose(file);
}

TEST_F(BinaryFormats, TiffStack) {
    for (const bool packed : {false, true}) {
        const std::string path = (folder_ / "a.tif").string();
        writeTiff(path, 0, 6, packed);
        const Dataset dataset = openFiles({path}, {});
        ASSERT_EQ(dataset.info.lattice.size, kSize);
        EXPECT_EQ(dataset.info.parameters[0].type, ScalarType::U16);
        for (int i = 0; i < kCount; ++i) ASSERT_EQ(dataset.read(0, 0, 0).value(std::size_t(i)), at(0, i, 0, 1));
        expectCutsAreTold(path, path);
    }
    const std::string imagej = (folder_ / "b.tif").string();
    writeTiff(imagej, 0, 6, false, "ImageJ=1.53t\nimages=6\nslices=3\nframes=2\nspacing=3\nunit=um\nfinterval=5\n");
    const Dataset dataset = openFiles({imagej}, {});
    EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(5, 4, 3));
    EXPECT_EQ(dataset.info.lattice.spacing, glm::dvec3(0.25, 0.5, 3));
    EXPECT_EQ(dataset.info.lengthUnit, "um");
    EXPECT_EQ(dataset.info.times, (std::vector<double>{0, 5}));
    EXPECT_EQ(dataset.read(0, 0, 1).value(7), at(0, 67, 0, 1));
    writeTiff(imagej, 0, 6, false, "ImageJ=1.53t\nimages=1e300\n");
    EXPECT_THAT(failure(imagej), testing::HasSubstr("announces 1e300 images, holds 6"));
    writeTiff(imagej, 0, 6, false, "ImageJ=1.53t\nimages=6\nframes=1e300\n");
    EXPECT_EQ(openFiles({imagej}, {}).info.times.size(), 1u);
    // A header of few bytes that announces gigabytes.
    writeTiff(imagej, 0, 1, false);
    std::string bytes = read(imagej);
    const auto shorts = [](int tag, int value) {
        return bytesOf(std::uint16_t(tag)) + bytesOf(std::uint16_t(3)) + bytesOf(std::uint32_t(1)) +
               bytesOf(std::uint32_t(value));
    };
    for (const auto& [tag, was] : {std::pair{256, 5}, {257, 4}}) {
        const std::size_t field = bytes.find(shorts(tag, was));
        ASSERT_NE(field, std::string::npos);
        bytes.replace(field, 12, shorts(tag, 65000));
    }
    EXPECT_THAT(failure(write("b.tif", bytes)), testing::HasSubstr("states 8.45 GB, of which"));
}

TEST_F(BinaryFormats, TiffSlicesInFiles) {
    for (int page = 0; page < 6; ++page)
        writeTiff((folder_ / ("s_" + std::to_string(page + 7) + ".tif")).string(), page, 1, false);
    for (const std::string& named : {folder_.string(), (folder_ / "s_*.tif").string()}) {
        const Dataset dataset = openFiles({named}, {});
        ASSERT_EQ(dataset.info.lattice.size, kSize);
        EXPECT_EQ(dataset.info.times.size(), 1u);
        for (int i = 0; i < kCount; ++i) ASSERT_EQ(dataset.read(0, 0, 0).value(std::size_t(i)), at(0, i, 0, 1));
    }
    EXPECT_EQ(filesNamedBy(folder_.string()).size(), 6u); // what a session's hash covers
    const std::string slice = (folder_ / "s_9.tif").string();
    const std::string whole = read(slice);
    write("s_9.tif", whole.substr(0, 30)); // within the samples
    EXPECT_THAT(failure(folder_.string()), testing::HasSubstr("its slice s_9.tif"));
}

std::string dicom(int slice, bool typed, double place) {
    const auto element = [&](int group, int number, const char* type, std::string data) {
        if (data.size() % 2 != 0) data += type[0] == 'U' && type[1] == 'I' ? '\0' : ' ';
        std::string out = bytesOf(std::uint16_t(group)) + bytesOf(std::uint16_t(number));
        if (!typed && group != 2) return out + bytesOf(std::uint32_t(data.size())) + data;
        if (std::string(type) == "OW" || std::string(type) == "SQ")
            return out + type + std::string(2, '\0') + bytesOf(std::uint32_t(data.size())) + data;
        return out + type + bytesOf(std::uint16_t(data.size())) + data;
    };
    const auto word = [](int value) { return bytesOf(std::uint16_t(value)); };
    std::string out(128, '\0');
    out += "DICM" + element(2, 0x10, "UI", typed ? "1.2.840.10008.1.2.1" : "1.2.840.10008.1.2");
    out += element(8, 0x60, "CS", "CT") + element(0x18, 0x50, "DS", "2.5");
    if (typed) // a sequence of undefined length
        out += bytesOf(std::uint16_t(0x18)) + bytesOf(std::uint16_t(0x9999)) + "SQ" + std::string(2, '\0') +
               bytesOf(0xffffffffu) + "\xfe\xff" + bytesOf(std::uint16_t(0xe000)) + bytesOf(0xffffffffu) +
               element(8, 0x60, "CS", "XX") + "\xfe\xff" + bytesOf(std::uint16_t(0xe00d)) + bytesOf(0u) + "\xfe\xff" +
               bytesOf(std::uint16_t(0xe0dd)) + bytesOf(0u);
    out += element(0x20, 0x0e, "UI", "1.2.3") + element(0x20, 0x32, "DS", "-10\\5\\" + std::to_string(place));
    out += element(0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0") + element(0x28, 2, "US", word(1));
    out += element(0x28, 0x10, "US", word(4)) + element(0x28, 0x11, "US", word(5));
    out += element(0x28, 0x30, "DS", "0.5\\0.25") + element(0x28, 0x100, "US", word(16));
    out += element(0x28, 0x103, "US", word(1)) + element(0x28, 0x1052, "DS", "-1000");
    out += element(0x28, 0x1053, "DS", "1");
    const std::vector<std::int16_t> all = numbers<std::int16_t>(1, 1);
    return out + element(0x7fe0, 0x10, "OW",
                         bytesOf(std::vector<std::int16_t>(all.begin() + slice * 20, all.begin() + slice * 20 + 20)));
}

TEST_F(BinaryFormats, DicomFolder) {
    for (const bool typed : {true, false}) {
        // Files in an order that is not that of their places, all but one without suffix.
        for (int slice = 0; slice < 6; ++slice)
            write("scan/IM" + std::to_string((slice * 5) % 7) + (slice == 1 ? ".dcm" : ""),
                  dicom(slice, typed, 100 + 2.5 * slice));
        const std::string folder = (folder_ / "scan").string();
        const Dataset dataset = openFiles({folder}, {});
        ASSERT_EQ(dataset.info.lattice.size, kSize);
        EXPECT_EQ(dataset.info.lattice.spacing, glm::dvec3(0.25, 0.5, 2.5));
        EXPECT_EQ(dataset.info.lengthUnit, "mm");
        EXPECT_EQ(dataset.info.parameters[0].unit, "HU");
        for (int i = 0; i < kCount; ++i) ASSERT_EQ(dataset.read(0, 0, 0).value(std::size_t(i)), at(0, i, 0, 1) - 1000);
        expectCutsAreTold(folder, folder + "/IM5.dcm", {}, 10);
        fs::remove(folder_ / "scan/IM3");
        EXPECT_EQ(openFiles({folder}, {}).info.lattice.size, kSize);
        EXPECT_THAT(previewFiles({folder}, {}).notes, testing::Contains(testing::HasSubstr("1 slice is missing")));
    }
}

TEST_F(BinaryFormats, FilesWithoutAReaderNameAnotherFormat) {
    for (const FileFormat& format : fileFormats()) {
        const std::string first(format.suffixes.substr(0, format.suffixes.find(' ')));
        const std::string line = failure(write("a" + first, "this is no such file\n"));
        EXPECT_NE(line, "") << first;
        EXPECT_EQ(line.find('\n'), std::string::npos) << line;
        EXPECT_THAT(line, testing::HasSubstr(std::string(format.advice)));
        EXPECT_THAT(line, testing::HasSubstr("a" + first));
        EXPECT_EQ(line.find("which is not read") == std::string::npos, format.advice.empty()) << line;
    }
    EXPECT_THAT(failure(write("a.cas.h5", "x")), testing::HasSubstr("is not an HDF5 file"));
}

/// The words between back ticks of the table of forms that the README has, those that begin with a dot.
/// CHGCAR: files that have this name and no ending.
bool isFileName(const std::string& part) {
    return std::ranges::all_of(part, [](char c) { return c >= 'A' && c <= 'Z'; });
}

std::string lowered(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

std::set<std::string> suffixesOfReadme() {
    std::ifstream in(fs::path(TESSERA_SOURCE_DIR) / "README.md");
    std::set<std::string> found;
    bool inTable = false;
    for (std::string line; std::getline(in, line);) {
        inTable = line.starts_with("| form |") || (inTable && line.starts_with("|"));
        if (!inTable) continue;
        std::istringstream parts(line);
        std::string part;
        for (int i = 0; std::getline(parts, part, '`'); ++i)
            if (i % 2 == 1 && (part.starts_with(".") || isFileName(part))) found.insert(lowered(part));
    }
    return found;
}

TEST(FileFormats, TheReadmeListsTheTableAndNothingElse) {
    // Read by the program itself, the values of PLOT3D, and what names the files of DICOM.
    std::set<std::string> wanted{".tsr", ".raw", ".pvd", ".series", ".q", ".f", "dicomdir"};
    std::istringstream suffixes(readableSuffixes());
    for (std::string suffix; suffixes >> suffix;)
        EXPECT_TRUE(wanted.insert(suffix).second) << suffix << " stands twice";
    EXPECT_EQ(suffixesOfReadme(), wanted);
}

TEST(FileFormats, TheLongestSuffixCounts) {
    EXPECT_EQ(formatOf("/a/b.NII.GZ")->name, "NIfTI");
    EXPECT_EQ(formatOf("case.cas.h5")->name, "Fluent in HDF5");
    EXPECT_EQ(formatOf("case.h5")->name, "HDF5");
    EXPECT_EQ(formatOf("case.unheard"), nullptr);
}

} // namespace
} // namespace tessera::volume
