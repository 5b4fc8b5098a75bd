// What is said of files before, or without, their samples: names, formats, usual units.
#include "volume/import/import.h"
#include "volume/import/names/unit_guess.h"

#include "tests/volume/fields.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace tessera::volume {
namespace {

namespace fs = std::filesystem;

class ImportNames : public testing::Test {
protected:
    void SetUp() override { fs::create_directories(folder_); }
    void TearDown() override { fs::remove_all(folder_); }
    std::string write(const std::string& name, const std::string& bytes) const {
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
        return (folder_ / name).string();
    }
    const fs::path folder_ = fs::temp_directory_path() / ("tessera_names_" + std::to_string(getpid()));
};

TEST_F(ImportNames, PreviewOfManySamplesReadsNone) {
    const std::string path = write("big.raw", "");
    fs::resize_file(path, 65 << 20);
    write("big.json", R"({"dims":[1024,1024,65],"dtype":"uint8","components":[{"name":"region","categorical":true}]})");
    EXPECT_TRUE(previewFiles({path}, {}).info.parameters[0].labels.empty()) << "which are found in the samples";
    fs::resize_file(path, 1 << 20);
    write("big.json", R"({"dims":[1024,1024,1],"dtype":"uint8","components":[{"name":"region","categorical":true}]})");
    EXPECT_EQ(previewFiles({path}, {}).info.parameters[0].labels.size(), 1u) << "of few it takes no time";
}

TEST_F(ImportNames, TheDataAreNamedAfterTheirFiles) {
    const auto nameOf = [&](const std::vector<std::string>& files) {
        std::vector<std::string> paths;
        for (const std::string& file : files) {
            paths.push_back(write(file, "x"));
            write(fs::path(file).stem().string() + ".json", R"({"dims":[1,1,1],"dtype":"uint8"})");
        }
        return openFiles(paths, {}).info.name;
    };
    EXPECT_EQ(nameOf({"air.raw"}), "air");
    EXPECT_EQ(nameOf({"air.2.raw"}), "air");
    EXPECT_EQ(nameOf({"-run-7.raw"}), "-run-7");
    EXPECT_EQ(nameOf({"-run-7.raw", "-run-8.raw"}), "-run");
    EXPECT_EQ(nameOf({"_scan__7.raw", "_scan__8.raw"}), "_scan");
    EXPECT_EQ(nameOf({"7.raw", "8.raw"}), "data");
}

TEST_F(ImportNames, TheFormatIsThatOfTheFirstFile) {
    const std::string raw = write("a.raw", "x");
    write("a.json", R"({"dims":[1,1,1],"dtype":"uint8"})");
    const std::string nrrd = write("b.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 1 1 1\nencoding: raw\n\nx");
    EXPECT_EQ(previewFiles({raw, nrrd}, {}).format, "raw");
    EXPECT_NE(previewFiles({nrrd, raw}, {}).format, "raw");
}

TEST(UnitGuess, IsTheUsualUnitWhereTheValuesAllowIt) {
    const auto guessed = [](const std::string& name, double value) {
        Dataset data =
            test::datasetOf({test::sampled<float>(test::ccLattice({2, 2, 2}), [&](glm::dvec3) { return value; })});
        data.info.parameters[0].name = name;
        guessUnits(data, true);
        EXPECT_EQ(data.info.parameters[0].unitGuessed, !data.info.parameters[0].unit.empty());
        return data.info.parameters[0].unit;
    };
    EXPECT_EQ(guessed("T", 353), "K");
    EXPECT_EQ(guessed("T", 80), "") << "degrees Celsius, or a part of the whole";
    EXPECT_EQ(guessed("p", 101325), "Pa");
    EXPECT_EQ(guessed("p", -2000), "Pa");
    EXPECT_EQ(guessed("p", 101), "");
    EXPECT_EQ(guessed("rho", 1.2), "kg/m3");
    EXPECT_EQ(guessed("rho", -1), "");
    EXPECT_EQ(guessed("u_gas", -1), "m/s");
    EXPECT_EQ(guessed("phase", 400), "");
}

} // namespace
} // namespace tessera::volume
