#include "app/history/session_file.h"

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
                ElementsAre(HasSubstr("run.pvd has changed"), in("two/t3.vti") + " was not opened together with " +
                                                                  in("two/run.pvd") + " when the session was saved"));
    EXPECT_TRUE(resolve("two").missing.empty());
}

// The file may be moved anywhere: an address is the same from everywhere, and is not asked for what lies there.
TEST_F(SessionDataTest, AddressesStayAsTheyAre) {
    const std::string address = "sftp://me@no-such-host.invalid:2022/scratch/a//b/../run.tsr";
    SessionDocument document;
    document.session.data.files = {describeFile(address)};
    document.session.data.other =
        OtherData{.files = {describeFile(address)}, .model = {}, .settings = {}, .import = {}};
    document.session.data.remote.cache = 77;
    EXPECT_EQ(document.session.data.files[0].absolutePath, address);
    saveSession(document, in("one/a.tessera.json"));
    fs::rename(folder_ / "one", folder_ / "two");
    ResolvedData found = resolve("two");
    EXPECT_TRUE(found.missing.empty());
    EXPECT_THAT(found.warnings, IsEmpty());
    ASSERT_EQ(found.data.files.size(), 1u);
    EXPECT_EQ(found.data.files[0].path, address);
    EXPECT_EQ(found.data.files[0].absolutePath, address);
    EXPECT_EQ(found.data.other->files[0].absolutePath, address);
    EXPECT_EQ(found.data.remote.cache, 77);
    EXPECT_EQ(found.data.files, document.session.data.files);
    // Written by hand: only the path is there.
    found.data.files[0].absolutePath.clear();
    EXPECT_EQ(resolveData(found.data, in("two")).data.files[0].absolutePath, address);
}

TEST_F(SessionDataTest, TablesOverTimeAreFoundAgainAsFilesAre) {
    fs::create_directories(folder_ / "one/more");
    write("one/a.tsr", "12345"), write("one/b.tsr", "123");
    write("one/more/history.csv", "time,U\n0,1\n"), write("one/other.csv", "time,I\n0,1\n");
    SessionDocument document;
    DataRef& data = document.session.data;
    data.files = {describeFile(in("one/a.tsr"))};
    data.import.overTime = in("one/more/history.csv");
    data.other = OtherData{.files = {describeFile(in("one/b.tsr"))}, .model = {}, .settings = {}, .import = {}};
    data.other->import.overTime = in("one/other.csv");
    saveSession(document, in("one/a.tessera.json"));
    const Json saved = Json::parse(readText(in("one/a.tessera.json")))["data"];
    EXPECT_EQ(saved["table"]["path"], "more/history.csv");
    EXPECT_EQ(saved["other"]["table"]["path"], "other.csv");
    fs::rename(folder_ / "one", folder_ / "two");
    const ResolvedData moved = resolve("two");
    EXPECT_TRUE(moved.missing.empty());
    EXPECT_THAT(moved.warnings, IsEmpty());
    EXPECT_EQ(moved.data.import.overTime, in("two/more/history.csv"));
    EXPECT_EQ(moved.data.other->import.overTime, in("two/other.csv"));
    write("two/more/history.csv", "time,U\n0,2\n");
    EXPECT_THAT(resolve("two").warnings, ElementsAre(HasSubstr("history.csv has changed since the session was saved")));
    fs::remove(folder_ / "two/more/history.csv"), fs::remove(folder_ / "two/other.csv");
    const ResolvedData gone = resolve("two");
    ASSERT_EQ(gone.missing.size(), 2u);
    EXPECT_TRUE(gone.missing[0].table && gone.missing[1].table && gone.missing[1].other);
    EXPECT_EQ(gone.missing[0].wanted.bytes, 11);
    // Where the user says they are, and that is what is saved.
    write("elsewhere.csv", "time,U\n0,1\n");
    SessionDocument located = loadSession(in("two/a.tessera.json"));
    for (const MissingData& missing : gone.missing) locate(located.session.data, missing, in("elsewhere.csv"));
    EXPECT_TRUE(resolveData(located.session.data, in("two")).missing.empty());
    saveSession(located, in("two/a.tessera.json"));
    EXPECT_EQ(resolve("two").data.other->import.overTime, in("elsewhere.csv"));
    // A table that is no longer stated is no longer looked for; sessions of before name its path alone.
    located.session.data.import.overTime.clear();
    located.session.data.other->table.reset();
    const Json plain = Json::parse(printSession(located, in("two/b.tessera.json")))["data"];
    EXPECT_TRUE(!plain.contains("table") || plain["table"].is_null());
    EXPECT_TRUE(resolveData(located.session.data, in("two")).missing.empty());
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
    EXPECT_THAT(resolve("one").warnings, ElementsAre(HasSubstr("t2.vti is no longer opened together with")));
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
