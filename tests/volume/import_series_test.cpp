#include "volume/base/error.h"
#include "volume/import/files/series.h"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace tessera::volume {
namespace {

namespace fs = std::filesystem;

class ImportSeries : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("tessera_series_" + std::to_string(getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    std::string write(const std::string& name, const std::string& text = "x") const {
        fs::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name) << text;
        return (folder_ / name).string();
    }
    static std::vector<std::string> names(const std::vector<SeriesFile>& files) {
        std::vector<std::string> out;
        for (const SeriesFile& file : files) out.push_back(fs::path(file.path).filename().string());
        return out;
    }
    fs::path folder_;
};

TEST(NumberedNames, LastRunOfDigitsCounts) {
    EXPECT_EQ(numberedName("a/small_0010.vti").pattern, "a/small_#.vti");
    EXPECT_EQ(numberedName("a/small_0010.vti").number, 10);
    EXPECT_EQ(numberedName("run2_p7b.nii.gz").pattern, "run2_p#b.nii.gz");
    EXPECT_EQ(numberedName("T.raw").number, std::nullopt);
    EXPECT_EQ(numberedName("dir7/T.raw").number, std::nullopt);
    EXPECT_EQ(numberedName("a123456789012345678901234567890.raw").number, std::nullopt);
}

TEST(NumberedNames, DecimalsBelongToANumberThatStandsByItself) {
    const auto is = [](const std::string& name, const std::string& pattern, double number) {
        EXPECT_EQ(numberedName(name).pattern, pattern) << name;
        EXPECT_EQ(numberedName(name).number, number) << name;
    };
    is("run_0.05.vtu", "run_#.vtu", 0.05);
    is("run_10.vtu", "run_#.vtu", 10);
    is("run_0.15_mesh.vtu", "run_#_mesh.vtu", 0.15);
    is("t1e-05.vtu", "t#.vtu", 1e-5);
    is("T_2.5e+02.vtu", "T_#.vtu", 250);
    is("U_-0.7.vtu", "U_#.vtu", -0.7);
    is("a-7.vtu", "a-#.vtu", 7);
    is("0.25.vti", "#.vti", 0.25);
    is("run2.0001.vtu", "run2.#.vtu", 1); // a run and its first step
    is("v1.2.vtu", "v1.#.vtu", 2);
    is("a_00.5.vtu", "a_00.#.vtu", 5);
    is("cell1e5.vtu", "cell1e#.vtu", 5);
}

TEST_F(ImportSeries, FilesOfAGroupAreSortedByNumber) {
    for (const char* name : {"a_10.vti", "a_9.vti", "b.vti", "a_100.vti"}) write(name);
    const std::string base = folder_.string() + "/";
    EXPECT_THAT(names(expandPaths({base + "a_10.vti", base + "b.vti", base + "a_100.vti", base + "a_9.vti"})),
                testing::ElementsAre("a_9.vti", "a_10.vti", "a_100.vti", "b.vti"));
    EXPECT_THAT(names(expandPaths({base + "a_*.vti"})), testing::ElementsAre("a_9.vti", "a_10.vti", "a_100.vti"));
    EXPECT_EQ(expandPaths({folder_.string()}).size(), 4u);
    EXPECT_EQ(expandPaths({base + "b.vti", base + "b.vti"}).size(), 1u);
    EXPECT_THROW(expandPaths({base + "c_*.vti"}), Error);
    EXPECT_THROW(expandPaths({base + "c.vti"}), Error);
}

TEST_F(ImportSeries, WhatIsNamedTwiceCountsOnce) {
    const std::string a = write("n_0.raw"), b = write("n_1.raw");
    const std::string list = write("n.series", R"({"files": [{"name": "n_0.raw"}, {"name": "n_1.raw"}]})");
    EXPECT_THAT(names(expandPaths({a, a, b, b, b})), testing::ElementsAre("n_0.raw", "n_1.raw"));
    EXPECT_THAT(names(expandPaths({b, a, folder_.string() + "/n_*.raw", a})),
                testing::ElementsAre("n_0.raw", "n_1.raw"));
    EXPECT_THAT(names(expandPaths({list, list})), testing::ElementsAre("n_0.raw", "n_1.raw"));
}

TEST_F(ImportSeries, FoldersAreCasesOrLists) {
    write("case/system/controlDict");
    EXPECT_THAT(names(expandPaths({(folder_ / "case").string()})), testing::ElementsAre("case"));
    write("case/cell.foam");
    EXPECT_THAT(names(expandPaths({(folder_ / "case").string()})), testing::ElementsAre("cell.foam"));
    fs::create_directories(folder_ / "empty");
    EXPECT_THROW(expandPaths({(folder_ / "empty").string()}), Error);
    write("two/a.pvd");
    write("two/b.pvd");
    EXPECT_THROW(expandPaths({(folder_ / "two").string()}), Error);
}

TEST_F(ImportSeries, Pvd) {
    write("a.vti");
    write("b & c.vti");
    const std::string path = write("list.pvd", R"(<?xml version="1.0"?><VTKFile type="Collection"><Collection>
        <DataSet timestep="2" part="0" file="b &amp; c.vti"/>
        <DataSet part='0' timestep='0.5' file='a.vti' name="air"/></Collection></VTKFile>)");
    const std::vector<SeriesFile> files = expandPaths({path});
    EXPECT_THAT(names(files), testing::ElementsAre("a.vti", "b & c.vti"));
    EXPECT_EQ(files[0].time, 0.5);
    EXPECT_EQ(files[0].part, "air");
    EXPECT_EQ(files[0].group, files[1].group);
    for (const char* bad :
         {"", "<VTKFile/>", "<Collection></Collection>", "<Collection><DataSet timestep=\"1\"/>",
          "<Collection><DataSet file=\"a.vti\" timestep=\"x\"/>", "<Collection><DataSet file=\"a.vti\"",
          "<Collection><DataSet file=\"missing.vti\" timestep=\"1\"/>"}) {
        const std::string broken = write("broken.pvd", bad);
        EXPECT_THROW(expandPaths({broken}), Error) << bad;
    }
}

TEST_F(ImportSeries, AListOpensWithoutTheFilesThatAreMissingAndSaysWhich) {
    write("a.vti");
    write("c.vti");
    const std::string path = write("list.pvd", R"(<Collection><DataSet timestep="0" file="a.vti"/>
        <DataSet timestep="0.25" file="b.vti"/><DataSet timestep="2" file="c.vti"/></Collection>)");
    std::vector<std::string> missing;
    const std::vector<SeriesFile> files = expandPaths({path}, Outside::Refused, &missing);
    EXPECT_THAT(names(files), testing::ElementsAre("a.vti", "c.vti"));
    EXPECT_EQ(files[1].time, 2);
    ASSERT_EQ(missing.size(), 1u);
    EXPECT_THAT(missing[0], testing::AllOf(testing::HasSubstr("list.pvd lists "), testing::HasSubstr("b.vti"),
                                           testing::HasSubstr("does not exist: time 0.25 is left out")));
    const std::string none = write("none.pvd", R"(<Collection><DataSet timestep="0" file="b.vti"/></Collection>)");
    EXPECT_THROW(expandPaths({none}, Outside::Refused, &missing), Error);
    EXPECT_EQ(missing.size(), 1u);
}

TEST_F(ImportSeries, SeriesJson) {
    write("a.vtu");
    write("b.vtu");
    const std::string path = write("all.vtu.series", R"({"file-series-version":"1.0",
        "files":[{"name":"b.vtu","time":3},{"name":"a.vtu","time":1.5}]})");
    const std::vector<SeriesFile> files = expandPaths({path});
    EXPECT_THAT(names(files), testing::ElementsAre("a.vtu", "b.vtu"));
    EXPECT_EQ(files[1].time, 3);
    for (const char* bad : {"", "[]", "{}", R"({"files":[]})", R"({"files":[1]})", R"({"files":[{"name":1}]})",
                            R"({"files":[{"name":"a.vtu","time":"x"}]})", R"({"files":[{"name":"missing.vtu"}]})"}) {
        const std::string broken = write("broken.series", bad);
        EXPECT_THROW(expandPaths({broken}), Error) << bad;
    }
}

} // namespace
} // namespace tessera::volume
