#include "app/data/pack_child.h"

#include "codec/archive/archive.h"
#include "volume/base/error.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

using namespace tessera;
namespace fs = std::filesystem;

namespace {

const std::string kProgram = std::string(TESSERA_BINARY_DIR) + "/tessera";

struct PackChild : testing::Test {
    void SetUp() override {
        folder = fs::path(testing::TempDir()) / ("pack_child_" + std::to_string(getpid()));
        fs::create_directories(folder);
        std::ofstream(folder / "ramp.raw", std::ios::binary) << std::string(8 * 9 * 10, 'a');
        import.raw = "dims=8x9x10,type=u8";
        import.rename["value"] = "ramp";
        import.units["ramp"] = "K";
    }
    void TearDown() override { fs::remove_all(folder); }
    std::string at(const char* name) const { return (folder / name).string(); }

    fs::path folder;
    volume::ImportOptions import;
};

TEST_F(PackChild, MakesAnArchiveWithTheStatedOptions) {
    double last = 0;
    Progress progress;
    progress.report = [&](double fraction, const std::string&) { last = fraction; };
    const app::PackedArchive packed = app::packInChild(kProgram, {at("ramp.raw")}, import, at("out.tsr"), progress);
    EXPECT_EQ(packed.sourceBytes, 8 * 9 * 10);
    EXPECT_EQ(packed.archiveBytes, double(fs::file_size(at("out.tsr"))));
    EXPECT_GT(last, 0.9);
    const auto source = codec::openArchive(at("out.tsr"));
    EXPECT_EQ(source->info().parameters.at(0).name, "ramp");
    EXPECT_EQ(source->info().parameters.at(0).unit, "K");
}

TEST_F(PackChild, FailureIsOneLineAndLeavesNothing) {
    import.raw = "dims=8x9x11,type=u8";
    try {
        app::packInChild(kProgram, {at("ramp.raw")}, import, at("out.tsr"), {});
        FAIL() << "packed a file that is too short";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("ramp.raw"), std::string::npos) << error.what();
    }
    EXPECT_FALSE(fs::exists(at("out.tsr")));
}

TEST_F(PackChild, StopsWhenAsked) {
    std::stop_source stop;
    stop.request_stop();
    Progress progress;
    progress.stop = stop.get_token();
    EXPECT_THROW(app::packInChild(kProgram, {at("ramp.raw")}, import, at("out.tsr"), progress), Cancelled);
}

} // namespace
