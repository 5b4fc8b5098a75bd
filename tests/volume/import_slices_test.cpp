#include "volume/base/error.h"
#include "volume/import/import.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <random>
#include <unistd.h>

namespace tessera::volume {
namespace {

namespace fs = std::filesystem;

class ImportSlices : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("tessera_slices_" + std::to_string(getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::string write(const std::string& name, const std::string& bytes) const {
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
        return (folder_ / name).string();
    }
    /// Every parameter and time, cut in several ways, equals the same slices of the whole frame.
    static void expectSlices(const Dataset& data) {
        ASSERT_TRUE(data.read.inParts());
        const DatasetInfo& info = data.info;
        for (int p = 0; p < int(info.parameters.size()); ++p)
            for (int c = 0; c < info.parameters[std::size_t(p)].components; ++c)
                for (int t = 0; t < int(info.times.size()); ++t) {
                    const Field whole = data.read(p, c, t);
                    for (const int step : {1, 3, 4, info.lattice.size.z})
                        for (int first = 0; first < info.lattice.size.z; first += step) {
                            const int count = std::min(step, info.lattice.size.z - first);
                            const Field part = data.read(p, c, t, {first, count}),
                                        wanted = slicesOf(whole, first, count);
                            EXPECT_EQ(part.lattice, wanted.lattice);
                            EXPECT_EQ(part.type, wanted.type);
                            EXPECT_EQ(part.offset, wanted.offset);
                            EXPECT_EQ(part.scale, wanted.scale);
                            EXPECT_EQ(part.samples, wanted.samples) << p << ' ' << c << ' ' << t << ' ' << first;
                            for (std::size_t i = 0; i < wanted.count(); ++i)
                                ASSERT_EQ(part.present(i), wanted.present(i)) << p << ' ' << first << ' ' << i;
                        }
                }
    }
    fs::path folder_;
};

TEST_F(ImportSlices, OfRawFilesWithAllThatIsDoneToThem) {
    const glm::ivec3 size(5, 4, 11);
    const std::size_t n = 5 * 4 * 11;
    std::mt19937 random(2);
    std::string bytes;
    const auto add = [&](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
    for (int time = 0; time < 2; ++time) {
        for (std::size_t i = 0; i < n; ++i) add(float(random() % 4));             // region: a label as float
        for (std::size_t i = 0; i < n; ++i) add(random() % 7 ? double(i) : -1.0); // a, with a value that is missing
        for (std::size_t i = 0; i < 3 * n; ++i) add(std::int16_t(random() % 5));  // v, a vector
        for (std::size_t i = 0; i < n; ++i) add(std::int8_t(random()));           // b, scaled
        for (std::size_t i = 0; i < n; ++i) add(std::uint8_t(random() % 3));      // where b is present
    }
    write("all.raw", bytes);
    const std::string path =
        write("all.json", R"({"dims": [5, 4, 11], "dtype": "int16", "times": [0, 1], "components": [
        {"name": "region", "dtype": "float32"}, {"name": "a", "dtype": "float64", "missing_value": -1},
        {"name": "v.x"}, {"name": "v.y"}, {"name": "v.z"},
        {"name": "b", "dtype": "int8", "scale": 0.5, "offset": 3},
        {"name": "there", "dtype": "uint8", "presence_of": "b"}]})");
    ImportOptions options;
    options.absent = {"v=0", "a=region:2"};
    options.parts = {"*=joined"}; // noise jumps everywhere
    const Dataset data = openFiles({path}, options);
    EXPECT_EQ(data.info.lattice.size, size);
    EXPECT_EQ(data.info.parameters.at(0).type, ScalarType::I32);
    expectSlices(data);
    options.parameters = {"b", "v"};
    const Dataset some = openFiles({path}, options);
    ASSERT_EQ(some.info.parameters.size(), 2u);
    expectSlices(some);
}

TEST_F(ImportSlices, OfSeveralFiles) {
    ImportOptions options;
    options.raw = "dims=3x4x9,type=u16,big-endian,skip=7";
    std::string bytes(7 + 2 * 3 * 4 * 9, ' ');
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = char(i * 37);
    const std::string first = write("p_1.raw", bytes);
    std::reverse(bytes.begin(), bytes.end());
    const std::string second = write("p_2.raw", bytes);
    const Dataset data = openFiles({first, second}, options);
    EXPECT_EQ(data.info.times.size(), 2u);
    expectSlices(data);
}

TEST_F(ImportSlices, OfPlainNrrd) {
    const std::string path = write("a.nrrd", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 4 3 8\nencoding: raw\n\n" +
                                                 std::string(4 * 3 * 8 / 2, 'x') + std::string(4 * 3 * 8 / 2, 'y'));
    expectSlices(openFiles({path}, {}));
}

} // namespace
} // namespace tessera::volume
