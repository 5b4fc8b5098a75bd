#include "volume/base/error.h"
#include "volume/import/files/named_path.h"
#include "volume/import/files/series.h"
#include "volume/import/import.h"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <string>
#include <unistd.h>

namespace tessera::volume {
namespace {

namespace fs = std::filesystem;

std::string refusal(const std::string& file, const std::string& name) {
    try {
        namedPath(file, name, Outside::Refused);
    } catch (const Error& error) {
        return error.reason();
    }
    return "";
}

TEST(NamedPath, FilesBesideAndBelowAreTheirs) {
    for (const char* name : {"a.raw", "./a.raw", "b/c/a.raw", "b/../a.raw", "b/../../data/a.raw", "/x/data/a.raw",
                             "..a.raw", "b/..c/a.raw", "/x/data/../data/b/a.raw"})
        EXPECT_EQ(refusal("/x/data/a.mhd", name), "") << name;
    for (const char* name :
         {"../a.raw", "/etc/passwd", "b/../../a.raw", "/x/database/a.raw", "/x/data/../a.raw", "..", "/x", "/"}) {
        EXPECT_THAT(refusal("/x/data/a.mhd", name), testing::HasSubstr("--allow-outside")) << name;
        EXPECT_EQ(namedPath("/x/data/a.mhd", name, Outside::Allowed), (fs::path("/x/data") / name).string());
    }
    // The same where the folder is the working one, or named from there.
    for (const char* file : {"a.mhd", "./a.mhd", "b/a.mhd", "../tests/a.mhd"}) {
        EXPECT_EQ(refusal(file, "a.raw"), "") << file;
        EXPECT_NE(refusal(file, "../a.raw"), "") << file;
        EXPECT_NE(refusal(file, "/etc/passwd"), "") << file;
    }
}

TEST(NamedPath, NamesWithAZeroByteAreNone) {
    for (const Outside outside : {Outside::Refused, Outside::Allowed})
        EXPECT_THROW(namedPath("/x/data/a.mhd", std::string("a.raw\0b", 7), outside), Error);
}

TEST(NamedPath, ALinkToTheFolderIsTheFolder) {
    const fs::path folder = fs::temp_directory_path() / ("tessera_linked_" + std::to_string(getpid()));
    fs::create_directories(folder / "real/run");
    fs::create_directory_symlink(folder / "real/run", folder / "link");
    EXPECT_EQ(refusal((folder / "link/a.pvd").string(), (folder / "real/run/b.vti").string()), "");
    EXPECT_NE(refusal((folder / "link/a.pvd").string(), (folder / "real/b.vti").string()), "");
    fs::remove_all(folder);
}

class NamesOutside : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("tessera_outside_" + std::to_string(getpid()));
        fs::create_directories(folder_ / "data");
        for (const char* name : {"secret.raw", "data/own.raw"}) std::ofstream(folder_ / name) << "abcdefgh";
    }
    void TearDown() override { fs::remove_all(folder_); }
    std::string write(const std::string& name, const std::string& text) const {
        const std::string path = (folder_ / "data" / name).string();
        std::ofstream(path) << text;
        return path;
    }
    /// Of the samples outside: refused unless they are allowed, and then read.
    void expectAsked(const std::string& path) const {
        try {
            openFiles({path}, {}).read(0, 0, 0);
            ADD_FAILURE() << path << " is read";
        } catch (const Error& error) {
            EXPECT_THAT(error.what(), testing::HasSubstr("outside of its folder")) << path;
        }
        ImportOptions allowed;
        allowed.allowOutside = true;
        EXPECT_EQ(openFiles({path}, allowed).read(0, 0, 0).value(0), 97) << path;
    }
    fs::path folder_;
};

TEST_F(NamesOutside, AreReadOnlyIfThatIsAllowed) {
    const std::string sidecar = R"({"dims": [2, 2, 2], "dtype": "uint8", "components": ["a"], "file": ")";
    expectAsked(write("a.json", sidecar + "../secret.raw\"}"));
    expectAsked(write("b.json", sidecar + (folder_ / "secret.raw").string() + "\"}"));
    const std::string head = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: ";
    expectAsked(write("a.nhdr", head + "../secret.raw\n"));
    expectAsked(write("b.nhdr", head + (folder_ / "secret.raw").string() + "\n"));
    std::ofstream(folder_ / "far.json") << R"({"dims": [2, 2, 2], "dtype": "uint8", "components": ["a"]})";
    fs::copy(folder_ / "secret.raw", folder_ / "far.raw");
    expectAsked(write("a.pvd", "<VTKFile><Collection><DataSet timestep=\"0\" file=\"../far.raw\"/></Collection>"));
    expectAsked(write("a.series", R"({"files": [{"name": "../far.raw", "time": 0}]})"));
    // Links are the user's own: what they lead to is read.
    fs::create_symlink(folder_ / "secret.raw", folder_ / "data/link.raw");
    EXPECT_EQ(openFiles({write("c.json", sidecar + "link.raw\"}")}, {}).read(0, 0, 0).value(0), 97);
}

} // namespace
} // namespace tessera::volume
