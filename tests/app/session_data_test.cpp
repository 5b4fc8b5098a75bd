#include "app/session/session_file.h"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace tessera::app {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class SessionDataTest : public testing::Test {
protected:
    void SetUp() override { fs::create_directories(folder_ / "one"); }
    void TearDown() override { fs::remove_all(folder_); }
    std::string in(const std::string& name) const { return (folder_ / name).generic_string(); }
    void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
    void writeList(const std::string& name, int files) const {
        std::string text = "<VTKFile type=\"Collection\"><Collection>\n";
        for (int i = 0; i < files; ++i)
            text += "<DataSet timestep=\"" + std::to_string(i) + "\" file=\"t" + std::to_string(i) + ".vti\"/>\n";
        write(name, text + "</Collection></VTKFile>");
    }
    /// A session that shows a file, saved in "one" and read from where it is now.
    void save(const std::string& data) const {
        SessionDocument document;
        document.session.data.files = {describeFile(in(data))};
        saveSession(document, in("one/a.tessera.json"));
    }
    ResolvedData resolve(const std::string& at) const {
        return resolveData(loadSession(in(at + "/a.tessera.json")).session.data, in(at));
    }
    fs::path folder_ = fs::canonical(fs::temp_directory_path()) / ("tessera_data_" + std::to_string(getpid()));
};

TEST_F(SessionDataTest, EveryFileOfASeriesIsCovered) {
    writeList("one/run.pvd", 3);
    for (int i = 0; i < 3; ++i) write("one/t" + std::to_string(i) + ".vti", "samples");
    save("one/run.pvd");
    fs::rename(folder_ / "one", folder_ / "two");
    EXPECT_THAT(resolve("two").warnings, IsEmpty());
    write("two/t1.vti", "sampleS");
    EXPECT_THAT(resolve("two").warnings, ElementsAre(in("two/t1.vti") + " has changed since the session was saved"));
    write("two/t1.vti", "samples");
    EXPECT_THAT(resolve("two").warnings, IsEmpty());
    writeList("two/run.pvd", 4); // another list, of one more
    write("two/t3.vti", "samples");
    EXPECT_THAT(resolve("two").warnings,
                ElementsAre(HasSubstr("run.pvd has changed"), in("two/t3.vti") + " was not read with " +
                                                                  in("two/run.pvd") + " when the session was saved"));
    EXPECT_TRUE(resolve("two").missing.empty());
}

TEST_F(SessionDataTest, AFolderIsFoundAgainAndItsFilesCompared) {
    fs::create_directories(folder_ / "one/series");
    write("one/series/t1.vti", "a"), write("one/series/t2.vti", "b");
    save("one/series/");
    EXPECT_TRUE(resolve("one").missing.empty());
    EXPECT_THAT(resolve("one").warnings, IsEmpty());
    write("one/series/t2.vti", "bb");
    EXPECT_THAT(resolve("one").warnings,
                ElementsAre(in("one/series/t2.vti") + " has changed since the session was saved"));
    fs::remove(folder_ / "one/series/t2.vti");
    EXPECT_THAT(resolve("one").warnings, ElementsAre(HasSubstr("t2.vti is no longer read with")));
    fs::remove_all(folder_ / "one/series");
    EXPECT_EQ(resolve("one").missing.size(), 1u);
}

TEST_F(SessionDataTest, ManyChangesAreAShortList) {
    constexpr int kFiles = 50;
    writeList("one/run.pvd", kFiles);
    for (int i = 0; i < kFiles; ++i) write("one/t" + std::to_string(i) + ".vti", "a");
    save("one/run.pvd");
    for (int i = 0; i < kFiles; ++i) write("one/t" + std::to_string(i) + ".vti", "b");
    const std::vector<std::string> warnings = resolve("one").warnings;
    ASSERT_EQ(warnings.size(), 21u);
    EXPECT_THAT(warnings.back(), HasSubstr("30 further files"));
}

} // namespace
} // namespace tessera::app
