#include "volume/base/error.h"
#include "volume/import/file_groups.h"
#include "volume/import/files/series.h"
#include "volume/import/import.h"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <optional>
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

/// Reads that this process has asked the system for; nothing where it does not count them.
std::optional<long> readsSoFar() {
    std::ifstream in("/proc/self/io");
    for (std::string word; in >> word;)
        if (long count = 0; word == "syscr:" && in >> count) return count;
    return std::nullopt;
}

TEST_F(ImportSeries, AFileOfASeriesIsReadAsOftenHoweverLongItIs) {
    if (!readsSoFar()) GTEST_SKIP() << "the system does not count reads";
    const auto reads = [&](int times) {
        const std::string name = "of" + std::to_string(times);
        for (int t = 0; t < times; ++t) {
            write(name + "/a_" + std::to_string(t) + ".raw", std::string(8, char(t)));
            write(name + "/a_" + std::to_string(t) + ".json", R"({"dims": [2, 2, 2], "dtype": "uint8"})");
        }
        const long before = *readsSoFar();
        const Dataset series = openFiles({(folder_ / name).string()}, {});
        EXPECT_EQ(series.info.times.size(), std::size_t(times));
        for (int t = 0; t < times; ++t) EXPECT_EQ(series.read(0, 0, t).value(0), double(t));
        return *readsSoFar() - before;
    };
    const long few = reads(20), some = reads(40), many = reads(100);
    EXPECT_LE(many - some, 3 * (some - few));
    EXPECT_LE(some - few, 6 * 20); // of the sidecar, then of the samples
}

TEST_F(ImportSeries, BlocksOfOneNameKeepTheirOrderInEachFile) {
    const auto file = [](const char* path, const std::vector<const char*>& names) {
        OpenedFile opened;
        opened.entry.path = path;
        opened.entry.group = "a_#.vtm";
        for (const char* name : names) {
            FileBlock& block = opened.blocks.emplace_back();
            block.name = name;
            block.arrays = {{"T", "K", 1, ScalarType::F32, false, {}}};
        }
        return opened;
    };
    std::vector<OpenedFile> files{file("a_0.vtm", {"air", "air", "fuel"}), file("a_1.vtm", {"air", "fuel", "air"}),
                                  file("a_2.vtm", {"fuel", "land"})};
    files[2].blocks[0].arrays.insert(files[2].blocks[0].arrays.begin(), {"p", "Pa", 1, ScalarType::F32, false, {}});
    const std::vector<FileGroup> groups = groupsInTime(files);
    ASSERT_EQ(groups.size(), 1u);
    ASSERT_EQ(groups[0].blocks.size(), 4u);
    EXPECT_EQ(groups[0].blocks[0].at, (std::vector<int>{0, 0, -1}));
    EXPECT_EQ(groups[0].blocks[1].at, (std::vector<int>{1, 2, -1}));
    EXPECT_EQ(groups[0].blocks[2].at, (std::vector<int>{2, 1, 0}));
    EXPECT_EQ(groups[0].blocks[3].at, (std::vector<int>{-1, -1, 1}));
    ASSERT_EQ(groups[0].blocks[2].arrays.size(), 2u);
    EXPECT_EQ(groups[0].blocks[2].arrays[0], (std::vector<int>{0, 0, 1})); // T
    EXPECT_EQ(groups[0].blocks[2].arrays[1], (std::vector<int>{-1, -1, 0}));
}

TEST_F(ImportSeries, FilesOfOnePatternWithoutASharedArrayAreParameters) {
    std::vector<OpenedFile> files(3);
    for (std::size_t f = 0; f < files.size(); ++f) {
        files[f].entry.path = "q" + std::to_string(f) + ".vti";
        files[f].entry.number = double(f);
        files[f].entry.group = "q#.vti";
        const std::string name = f == 2 ? "q0" : "q" + std::to_string(f);
        files[f].blocks.emplace_back().arrays = {{name, "", 1, ScalarType::F32, false, {}}};
    }
    const std::vector<FileGroup> groups = groupsInTime(files);
    ASSERT_EQ(groups.size(), 2u);
    EXPECT_THAT(groups[0].files, testing::ElementsAre(&files[0], &files[2]));
    EXPECT_THAT(groups[1].files, testing::ElementsAre(&files[1]));
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
