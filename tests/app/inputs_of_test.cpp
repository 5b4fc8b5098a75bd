#include "app/command/command.h"
#include "tests/codec/make_dataset.h"
#include "volume/import/import_options.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

/// What tells processes that continue a work whether they read the same as those before.
namespace tessera::app {
namespace {

namespace fs = std::filesystem;

class InputsOf : public testing::Test {
protected:
    void write(const std::string& name, const std::string& text) {
        fs::create_directories(fs::path(folder_ / name).parent_path());
        std::ofstream(folder_ / name) << text;
    }
    std::string of(const std::string& name) { return inputsOf({folder_ / name}, {}); }
    /// Whether what is stated of `input` changes with the length of `part`.
    bool tells(const std::string& input, const std::string& part) {
        const std::string before = of(input);
        std::ofstream(folder_ / part, std::ios::app) << " ";
        return of(input) != before;
    }
    codec::testing::TemporaryFolder folder_;
};

TEST_F(InputsOf, TellChangesOfEveryFileThatIsRead) {
    write("run.pvd", "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"0\" file=\"t0.vtm\"/>"
                     "</Collection></VTKFile>");
    write("t0.vtm", "<VTKFile type=\"vtkMultiBlockDataSet\"><DataSet index=\"0\" file=\"t0/air.vtu\"/></VTKFile>");
    write("t0/air.vtu", "x");
    for (const char* part : {"run.pvd", "t0.vtm", "t0/air.vtu"}) EXPECT_TRUE(tells("run.pvd", part)) << part;

    write("scan.nhdr", "NRRD0004\ndata file: scan.bytes\n");
    write("scan.bytes", "x");
    for (const char* part : {"scan.nhdr", "scan.bytes"}) EXPECT_TRUE(tells("scan.nhdr", part)) << part;
}

TEST_F(InputsOf, TellChangesOfFilesThatOptionsName) {
    write("samples.bin", "x");
    volume::ImportOptions options;
    for (std::string* option : {&options.raw, &options.overTime}) {
        *option = folder_ / "stated.txt";
        write("stated.txt", "x");
        const std::string before = inputsOf({folder_ / "samples.bin"}, options);
        write("stated.txt", "other");
        EXPECT_NE(inputsOf({folder_ / "samples.bin"}, options), before);
        option->clear();
    }
}

// Processes of one job start at different moments, and the first ones have begun to write by then.
TEST_F(InputsOf, DoNotDependOnResultsBesideThem) {
    write("case/system/controlDict", "x");
    write("case/0/T", "x");
    EXPECT_TRUE(tells("case", "case/0/T"));
    for (const char* result : {"case/log.solver", "case/run.tsr"}) {
        write(result, "x");
        EXPECT_FALSE(tells("case", result)) << result;
    }
    write("times/t_0.vti", "x");
    EXPECT_TRUE(tells("times", "times/t_0.vti"));
    const std::string before = of("times");
    write("times/run.tsr", "x");
    EXPECT_EQ(of("times"), before);
}

} // namespace
} // namespace tessera::app
