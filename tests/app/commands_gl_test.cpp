#include "app/command/command.h"
#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "tests/app/formula_cell.h"
#include "tests/app/table_text.h"
#include "volume/base/byte_text.h"

#include <CLI/CLI.hpp>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <set>
#include <unistd.h>

/// What commands write for the state that their options choose, read back and compared with numbers of formulas.
namespace tessera::app {
namespace {

namespace fs = std::filesystem;
using formula::Place;

/// Options that choose the state a command answers for, each with the test below that reads its answer.
const std::set<std::pair<std::string, std::string>> kStateOptions = {
    {"stats", "--time"},                            // StatsAreOfTheTimeAndRegions
    {"stats", "--all-times"}, {"plot", "--time"},   // PlotMarksTheState
    {"mesh", "--time"},                             // MeshLiesOnItsValueAtItsTime
    {"unpack", "--times"},                          // UnpackWritesTheTimesAskedFor
    {"generate", "--times"},                        // GenerateMakesAsManyTimes
    {"generate", "--set"},    {"render", "--time"}, // RenderFollowsItsOptions
    {"render", "--layout"},   {"render", "--view"},       {"render", "--set"},
    {"replay", "--layout"},                                                        // tests/e2e/render.sh
    {"replay", "--view"},     {"replay", "--set"},        {"compare", "--layout"}, // tests/e2e/compare.sh
    {"compare", "--time"},    {"compare", "--view"},      {"compare", "--set"},
    {"mesh", "--all-times"},  {"compare", "--all-times"}, // tests/e2e/shared.sh
};

class Commands : public testing::Test {
protected:
    void SetUp() override {
        fs::create_directories(folder);
        volume::Dataset cell = formula::makeCell();
        codec::PackOptions options;
        options.lossless = true;
        options.lattice = codec::StoredLattice::CC;
        codec::pack(cell, options, in("cell.tsr"));
    }
    void TearDown() override { fs::remove_all(folder); }
    std::string in(const char* name) const { return (folder / name).string(); }
    std::string text(const char* name) const {
        std::ifstream file(folder / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    int run(std::vector<std::string> words) const {
        words.insert(words.begin(), "tessera");
        std::vector<const char*> arguments;
        for (const std::string& word : words) arguments.push_back(word.c_str());
        return runCommandLine(int(arguments.size()), arguments.data());
    }
    fs::path folder = fs::path(testing::TempDir()) / ("commands_" + std::to_string(::getpid()));
};

TEST(CommandsTable, HasEveryOptionThatChoosesAState) {
    CLI::App app;
    for (const auto add : {addCompareCommand, addConvertCommand, addDiffCommand, addGenerateCommand, addInfoCommand,
                           addMeshCommand, addPackCommand, addPiecesCommand, addPlotCommand, addRenderCommand,
                           addReplayCommand, addStatsCommand, addUnpackCommand, addVerifyCommand})
        add(app);
    std::set<std::pair<std::string, std::string>> found;
    for (const CLI::App* command : app.get_subcommands({}))
        for (const CLI::Option* option : command->get_options()) {
            if (option->get_group() == "Import") continue; // says what files are, not which state is meant
            for (const char* name : {"--time", "--times", "--all-times", "--layout", "--set", "--view"})
                if (option->check_name(name)) found.insert({command->get_name(), name});
        }
    EXPECT_EQ(found, kStateOptions);
}

TEST(CommandsTable, HelpOfEachCommandIsItsOwn) {
    for (const char* name : {"compare", "convert", "diff", "generate", "info", "mesh", "pack", "pieces", "plot",
                             "render", "replay", "stats", "unpack", "verify"}) {
        const char* words[] = {"tessera", name, "--help"};
        testing::internal::CaptureStdout();
        EXPECT_EQ(runCommandLine(3, words), 0);
        EXPECT_NE(testing::internal::GetCapturedStdout().find("tessera " + std::string(name)), std::string::npos)
            << name;
    }
}

TEST(CommandsTable, HelpListsThemAll) {
    const char* words[] = {"tessera", "--help"};
    testing::internal::CaptureStdout();
    EXPECT_EQ(runCommandLine(2, words), 0);
    const std::string said = testing::internal::GetCapturedStdout();
    for (const char* name : {"bench", "compare", "convert", "diff", "generate", "info", "mesh", "pack", "pieces",
                             "plot", "render", "replay", "stats", "unpack", "verify"})
        EXPECT_NE(said.find("\n  " + std::string(name) + " "), std::string::npos) << name;
}

TEST_F(Commands, InfoSaysTheBytesOfEachLevel) {
    testing::internal::CaptureStdout();
    ASSERT_EQ(run({"info", in("cell.tsr")}), 0);
    const std::string said = testing::internal::GetCapturedStdout();
    const codec::Archive archive(in("cell.tsr"));
    std::string levels = "levels from fine to coarse:";
    for (int level = 0; level < archive.grid().levels; ++level) {
        EXPECT_GT(archive.levelBytes(level), 0u);
        levels += (level > 0 ? ", " : " ") + textOfBytes(double(archive.levelBytes(level)));
    }
    EXPECT_NE(said.find(levels + "\n"), std::string::npos) << said;
    EXPECT_NE(said.find("  samples    8 x 7 x 9 on CC, from a grid of 8 x 7 x 9\n"), std::string::npos) << said;
    EXPECT_NE(said.find("  times      3: 0 .. 2 s\n"), std::string::npos) << said;
}

TEST_F(Commands, StatsAreOfTheTimeAndRegions) {
    const auto check = [&](const TableText& table, std::size_t row, double time) {
        const std::string name = table.text(row, "parameter"), region = table.text(row, "region");
        SCOPED_TRACE(name + " " + region + " at " + std::to_string(time));
        const formula::Sum sum =
            formula::summed(name, time, [&](Place at) { return region == "all" || (region == "west") == (at.x < 4); });
        EXPECT_EQ(table.number(row, "samples"), sum.samples);
        EXPECT_NEAR(*table.number(row, "mean"), sum.mean, 2e-4);
        EXPECT_NEAR(*table.number(row, "min"), sum.least, 2e-4);
        EXPECT_NEAR(*table.number(row, "max"), sum.most, 2e-4);
    };
    for (const double time : {0.0, 0.5, 0.875, 2.0}) {
        ASSERT_EQ(run({"stats", in("cell.tsr"), "--time", std::to_string(time), "-o", in("s.csv")}), 0);
        const TableText table = tableOf(text("s.csv"));
        ASSERT_EQ(table.rows.size(), 8u);
        for (std::size_t row = 0; row < 8; ++row) check(table, row, time);
    }
    ASSERT_EQ(run({"stats", in("cell.tsr"), "--all-times", "--of", "T", "--regions", "east", "-o", in("s.csv")}), 0);
    const TableText table = tableOf(text("s.csv"));
    ASSERT_EQ(table.rows.size() % 3, 0u);
    std::set<double> times;
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        EXPECT_EQ(table.text(row, "parameter"), "T");
        EXPECT_NE(table.text(row, "region"), "west") << "one region was asked for";
        times.insert(*table.number(row, "time [s]"));
        if (table.text(row, "region") == "east") check(table, row, *table.number(row, "time [s]"));
    }
    EXPECT_EQ(times, (std::set<double>{0, 0.5, 2}));
    // Planes of all times are a table, and a figure with a curve for each.
    EXPECT_EQ(run({"stats", in("cell.tsr"), "--along", "z", "--of", "T", "--all-times", "-o", in("s.csv")}), 0);
    EXPECT_GT(tableOf(text("s.csv")).rows.size(), 9u);
    EXPECT_EQ(run({"stats", in("cell.tsr"), "--along", "z", "--of", "T", "--all-times", "-o", in("s.svg")}), 0);
    EXPECT_EQ(run({"stats", in("cell.tsr"), "--along", "z", "--of", "T", "-o", in("s.svg")}), 0);
    EXPECT_EQ(run({"stats", in("cell.tsr"), "--of", "T", "--all-times", "-o", in("s.svg")}), 0);
}

TEST_F(Commands, PlotMarksTheState) {
    const auto ringAt = [&](const char* time) {
        EXPECT_EQ(run({"plot", in("cell.tsr"), "--x", "time", "--y", "max(T)", "--time", time, "-o", in("p.svg")}), 0);
        return text("p.svg");
    };
    EXPECT_NE(ringAt("0"), ringAt("2"));
    ASSERT_EQ(run({"plot", in("cell.tsr"), "--x", "time", "--y", "mean(c)", "--region", "west", "-o", in("p.csv")}), 0);
    const TableText table = tableOf(text("p.csv"));
    ASSERT_EQ(table.rows.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(std::stod(table.rows[i].back()),
                    formula::summed("c", formula::kTimes[i], [](Place) { return true; }).mean, 2e-4);
}

// On the edges of tetrahedra values run linearly between two samples.
TEST_F(Commands, MeshLiesOnItsValueAtItsTime) {
    for (const auto& [time, value] : {std::pair{"0.5", 320.0}, std::pair{"0.875", 330.0}, std::pair{"2", 365.0}}) {
        ASSERT_EQ(run({"mesh", in("cell.tsr"), "--channel", "T", "--iso", std::to_string(value), "--time", time, "-o",
                       in("s.obj")}),
                  0);
        std::istringstream file(text("s.obj"));
        std::size_t vertices = 0;
        for (std::string word; file >> word;) {
            if (word != "v") {
                std::getline(file, word);
                continue;
            }
            glm::dvec3 at;
            file >> at.x >> at.y >> at.z;
            EXPECT_NEAR(formula::between("T", at, std::stod(time)), value, 0.35);
            std::getline(file, word);
            ++vertices;
        }
        EXPECT_GT(vertices, 50u) << time;
    }
}

TEST_F(Commands, UnpackWritesTheTimesAskedFor) {
    const auto check = [&](const std::string& bytes, int time) {
        ASSERT_EQ(bytes.size(), 8u * 7 * 9 * 4);
        std::size_t i = 0;
        formula::forEachPlace([&](Place at) {
            float value = 0;
            std::memcpy(&value, bytes.data() + 4 * i++, 4);
            EXPECT_EQ(value, formula::value("T", at, time));
        });
    };
    for (int time = 0; time < 3; ++time) {
        ASSERT_EQ(run({"unpack", in("cell.tsr"), "-p", "T", "--times", std::to_string(formula::kTimes[time]), "-o",
                       in("t.raw")}),
                  0);
        check(text("t.raw"), time);
    }
}

TEST_F(Commands, GenerateMakesAsManyTimes) {
    ASSERT_EQ(run({"generate", "marschner-lobb", "--size", "12x12x12", "--times", "4", "--set", "alpha=0.5", "-o",
                   in("ml.tsr")}),
              0);
    EXPECT_EQ(run({"generate", "marschner-lobb", "--size", "12x12x12", "--times", "4", "-o", in("other.tsr")}), 0);
    const auto table = [&](const char* name) {
        EXPECT_EQ(run({"stats", in(name), "--all-times", "--by", "none", "-o", in("s.csv")}), 0);
        return tableOf(text("s.csv"));
    };
    EXPECT_EQ(table("ml.tsr").rows.size(), 4u);
    EXPECT_NE(table("ml.tsr").rows, table("other.tsr").rows);
}

TEST_F(Commands, RenderFollowsItsOptions) {
    const auto samples = [&](const std::vector<std::string>& words) {
        std::vector<std::string> all{"render", in("cell.tsr"), "--view", "statistics", "-o", in("s.csv")};
        all.insert(all.end(), words.begin(), words.end());
        EXPECT_EQ(run(all), 0);
        return tableOf(text("s.csv"));
    };
    const auto mean = [](double time) { return formula::summed("T", time, [](Place) { return true; }).mean; };
    EXPECT_NEAR(*samples({"--time", "0.5"}).number(0, "mean"), mean(0.5), 2e-4);
    EXPECT_NEAR(*samples({"--time", "2"}).number(0, "mean"), mean(2), 2e-4);
    EXPECT_NEAR(*samples({"--set", "/time=0.875"}).number(0, "mean"), mean(0.875), 2e-4);
    EXPECT_EQ(samples({"--set", "/views/statistics/channels=[\"c\"]"}).text(0, "parameter"), "c");
    EXPECT_EQ(samples({"--layout", "statistics"}).text(0, "parameter"), "T");
    EXPECT_EQ(run({"render", in("cell.tsr"), "--time", "2.5", "-o", in("no.png")}), 2);
    EXPECT_EQ(run({"render", in("cell.tsr"), "-o", in("no.csv")}), 2) << "a table is of one view";
    EXPECT_EQ(run({"render", in("cell.tsr"), "--view", "volume", "-o", in("no.csv")}), 2);
    EXPECT_FALSE(fs::exists(in("no.png")) || fs::exists(in("no.csv")));
}

} // namespace
} // namespace tessera::app
