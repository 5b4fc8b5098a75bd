#include "volume/import/files/named_files.h"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace tessera::volume {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;

class NamedFiles : public testing::Test {
protected:
    void SetUp() override { fs::create_directories(folder_); }
    void TearDown() override { fs::remove_all(folder_); }
    void write(const std::string& name, const std::string& text = "x") {
        fs::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name) << text;
    }
    /// Relative to the folder.
    std::vector<std::string> namedBy(const std::string& name) {
        std::vector<std::string> names;
        for (const std::string& file : filesNamedBy((folder_ / name).string()))
            names.push_back(fs::path(file).lexically_relative(fs::canonical(folder_)).string());
        return names;
    }
    fs::path folder_ = fs::canonical(fs::temp_directory_path()) / ("tessera_named_" + std::to_string(getpid()));
};

TEST_F(NamedFiles, AListNamesItsFilesAndWhatTheseName) {
    write("run.pvd", "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"0\" file=\"a b/t0.vtm\"/>"
                     "<DataSet timestep=\"1\" file=\"a b/t1.vtu\"/></Collection></VTKFile>");
    write("a b/t0.vtm", "<VTKFile type=\"vtkMultiBlockDataSet\"><DataSet index=\"0\" file=\"t0/air side.vtu\"/>\n"
                        "<DataSet index=\"1\" file=\"t0/gone.vtu\"/></VTKFile>");
    write("a b/t0/air side.vtu");
    write("a b/t1.vtu");
    write("a b/t2.vtu");
    EXPECT_THAT(namedBy("run.pvd"), ElementsAre("a b/t0/air side.vtu", "a b/t0.vtm", "a b/t1.vtu"));
    write("run.series", R"({"files": [{"name": "a b/t1.vtu", "time": 0}, {"name": "a b/t2.vtu", "time": 1}]})");
    EXPECT_THAT(namedBy("run.series"), ElementsAre("a b/t1.vtu", "a b/t2.vtu"));
}

TEST_F(NamedFiles, HeadersAndSidecars) {
    write("a.raw");
    write("a.json", R"({"dims": [1, 1, 1], "dtype": "uint8"})");
    EXPECT_THAT(namedBy("a.raw"), ElementsAre("a.json"));
    EXPECT_THAT(namedBy("a.json"), ElementsAre("a.raw"));
    write("b.json", R"({"dims": [1, 1, 1], "file": "other place.bin"})");
    write("other place.bin");
    EXPECT_THAT(namedBy("b.json"), ElementsAre("other place.bin"));
    write("c.nhdr", "NRRD0004\ntype: uchar\ndata file: c with space.bin\n");
    write("c with space.bin");
    EXPECT_THAT(namedBy("c.nhdr"), ElementsAre("c with space.bin"));
    write("e.nhdr", "NRRD0004\ntype: uchar\ndata file: e%03d.bin 1 2 1\n");
    for (const char* part : {"e001.bin", "e002.bin", "f.img"}) write(part, "x");
    EXPECT_THAT(namedBy("e.nhdr"), ElementsAre("e001.bin", "e002.bin"));
    write("f.hdr", "x");
    EXPECT_THAT(namedBy("f.hdr"), ElementsAre("f.img"));
    write("d.mhd", "NDims = 3\nElementDataFile = d.zraw\n");
    write("d.zraw");
    EXPECT_THAT(namedBy("d.mhd"), ElementsAre("d.zraw"));
    write("e.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: e.geo\nVARIABLE\nscalar per node: p e.p**\n");
    write("e.geo"), write("e.p00"), write("e.p01");
    EXPECT_THAT(namedBy("e.case"), ElementsAre("e.geo", "e.p00", "e.p01"));
    EXPECT_THAT(namedBy("c with space.bin"), IsEmpty());
    EXPECT_THAT(namedBy("nothing.pvd"), IsEmpty());
    write("broken.pvd", "<VTKFile");
    EXPECT_THAT(namedBy("broken.pvd"), IsEmpty());
}

TEST_F(NamedFiles, FoldersPatternsAndCases) {
    write("series/t_1.vti"), write("series/t_2.vti"), write("series/readme.txt");
    EXPECT_THAT(namedBy("series"), ElementsAre("series/t_1.vti", "series/t_2.vti"));
    EXPECT_THAT(namedBy("series/t_*.vti"), ElementsAre("series/t_1.vti", "series/t_2.vti"));
    write("case/system/controlDict"), write("case/0/T"), write("case/constant/polyMesh/points");
    EXPECT_THAT(namedBy("case"), ElementsAre("case/0/T", "case/constant/polyMesh/points", "case/system/controlDict"));
    write("case/cell.foam", "");
    write("case/processor1/-0.5/T");
    // What comes during the run, or from it, is not read.
    for (const char* other :
         {"case/log.solver", "case/run.tsr", "case/2.out", "case/postProcessing/0/p.dat", "case/2024_plots/p.png"})
        write(other);
    const std::vector<std::string> all{"case/0/T", "case/constant/polyMesh/points", "case/processor1/-0.5/T",
                                       "case/system/controlDict"};
    EXPECT_EQ(namedBy("case/cell.foam"), all);
    EXPECT_EQ(namedBy("case"), all);
}

} // namespace
} // namespace tessera::volume
