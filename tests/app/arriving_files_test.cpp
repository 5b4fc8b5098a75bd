#include "app/growing/arriving_files.h"

#include "volume/base/error.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

using namespace tessera;
using namespace tessera::app;
namespace fs = std::filesystem;

namespace {

/// A folder of files, and a clock that the test moves: files settle after 1 s and are tried for 10 s.
struct Arriving : testing::Test {
    void SetUp() override {
        folder = fs::path(testing::TempDir()) / ("arriving_" + std::to_string(getpid()));
        fs::create_directories(folder);
    }
    void TearDown() override { fs::remove_all(folder); }

    std::string at(const std::string& name) const { return (folder / name).string(); }
    void write(const std::string& name, const std::string& text) const { std::ofstream(at(name)) << text; }
    /// What is ready after further seconds, by its name.
    std::string readyAfter(double seconds) {
        now += std::chrono::duration_cast<ArrivingFiles::Clock::duration>(ArrivalTimes::Duration(seconds));
        files.look(now);
        const auto path = files.ready(now);
        return path ? fs::path(*path).filename().string() : "";
    }
    void done(const std::string& name) { files.done(at(name), now); }
    std::string notes() {
        std::string text;
        for (const auto& note : files.takeNotes(now))
            text += fs::path(note.path).filename().string() + ": " + note.text + "\n";
        return text;
    }

    fs::path folder;
    ArrivingFiles::Clock::time_point now = ArrivingFiles::Clock::now();
    ArrivingFiles files{
        (fs::path(testing::TempDir()) / ("arriving_" + std::to_string(getpid())) / "run_*.raw").string(),
        {ArrivalTimes::Duration(1), ArrivalTimes::Duration(10)}};
};

TEST_F(Arriving, ComeInTheOrderOfTheirNumbersOnceTheyRest) {
    EXPECT_EQ(readyAfter(0), "");
    write("run_10.raw", "a");
    write("run_9.raw", "a");
    EXPECT_EQ(readyAfter(0), "");
    EXPECT_EQ(readyAfter(0.9), "");
    EXPECT_EQ(readyAfter(0.2), "run_9.raw");
    done("run_9.raw");
    EXPECT_EQ(readyAfter(0), "run_10.raw") << "both rested at the same time";
    done("run_10.raw");
    EXPECT_EQ(readyAfter(5), "");
    EXPECT_EQ(notes(), "");
}

TEST_F(Arriving, AFileThatGrowsRestsAnew) {
    write("run_1.raw", "a");
    EXPECT_EQ(readyAfter(0), "");
    write("run_1.raw", "ab");
    EXPECT_EQ(readyAfter(0.9), "");
    EXPECT_EQ(readyAfter(0.9), "");
    EXPECT_EQ(readyAfter(0.2), "run_1.raw");
}

TEST_F(Arriving, AFileThatItNamesIsWatchedToo) {
    write("run_1.raw", "a");
    EXPECT_EQ(readyAfter(0), "");
    write("run_1.json", "{");
    EXPECT_EQ(readyAfter(1.5), "") << "the sidecar is new";
    EXPECT_EQ(readyAfter(1.1), "run_1.raw");
    write("run_1.json", "{}");
    EXPECT_EQ(readyAfter(0.1), "");
}

TEST_F(Arriving, LaterOnesWaitForOneThatCannotBeReadUntilItIsGivenUp) {
    write("run_1.raw", "a");
    write("run_2.raw", "a");
    readyAfter(0);
    EXPECT_EQ(readyAfter(1), "run_1.raw");
    files.failed(at("run_1.raw"), "ends early", now);
    EXPECT_EQ(readyAfter(0.5), "") << "not again at once";
    EXPECT_EQ(readyAfter(0.6), "run_1.raw");
    files.failed(at("run_1.raw"), "ends early", now);
    EXPECT_EQ(notes(), "");
    EXPECT_FALSE(files.quietFor(ArrivalTimes::Duration(0), now)) << "it is still to be tried";
    readyAfter(9);
    files.failed(at("run_1.raw"), "ends early", now);
    EXPECT_EQ(notes(), "run_1.raw: cannot be read so far: ends early\n");
    EXPECT_EQ(notes(), "") << "said once";
    EXPECT_EQ(readyAfter(0), "run_2.raw");
    EXPECT_EQ(files.missed(), 0u);
    done("run_2.raw");
    EXPECT_EQ(notes(), "run_1.raw: cannot be read (ends early): it is left out\n");
    EXPECT_EQ(files.missed(), 1u);
    EXPECT_TRUE(files.quietFor(ArrivalTimes::Duration(0), now));
    write("run_1.raw", "ab");
    EXPECT_EQ(readyAfter(5), "") << "its time is over";
}

TEST_F(Arriving, OneThatCannotBeReadIsTriedAgainOnceItChanges) {
    write("run_1.raw", "a");
    readyAfter(0);
    EXPECT_EQ(readyAfter(1), "run_1.raw");
    files.failed(at("run_1.raw"), "ends early", now);
    readyAfter(9.9);
    write("run_1.raw", "abc");
    EXPECT_EQ(readyAfter(0), "");
    EXPECT_EQ(notes(), "") << "the ten seconds begin again";
    EXPECT_EQ(readyAfter(1), "run_1.raw");
}

TEST_F(Arriving, WhatComesTooLateOrIsOfAnotherSeriesIsSaid) {
    write("run_3.raw", "a");
    readyAfter(0);
    readyAfter(1);
    done("run_3.raw");
    write("run_2.raw", "a");
    write("run_03.raw", "a");
    write("run_b_7.raw", "a");
    write("run_last.raw", "a");
    EXPECT_EQ(readyAfter(5), "");
    const std::string said = notes();
    EXPECT_NE(said.find("run_2.raw: came after a later time: it is left out\n"), std::string::npos) << said;
    EXPECT_NE(said.find("run_03.raw: came after a later time"), std::string::npos) << said;
    EXPECT_NE(said.find("run_b_7.raw: is not of the series "), std::string::npos) << said;
    EXPECT_NE(said.find("run_last.raw: is not of the series "), std::string::npos) << said;
    EXPECT_EQ(files.missed(), 2u);
}

TEST_F(Arriving, TwoSeriesFromTheStartAreAnError) {
    write("run_1.raw", "a");
    write("run_b_1.raw", "a");
    EXPECT_THROW(readyAfter(0), Error);
}

TEST_F(Arriving, QuietCountsFromTheLastNews) {
    const ArrivalTimes::Duration three(3);
    EXPECT_EQ(readyAfter(2), "");
    EXPECT_FALSE(files.quietFor(three, now));
    write("run_1.raw", "a");
    readyAfter(2);
    EXPECT_FALSE(files.quietFor(three, now));
    readyAfter(3);
    EXPECT_FALSE(files.quietFor(three, now)) << "a file waits";
    done("run_1.raw");
    EXPECT_FALSE(files.quietFor(three, now));
    readyAfter(3);
    EXPECT_TRUE(files.quietFor(three, now));
}

TEST_F(Arriving, AFileThatIsTakenAwayIsForgotten) {
    write("run_1.raw", "a");
    readyAfter(0);
    fs::remove(at("run_1.raw"));
    EXPECT_EQ(readyAfter(2), "");
    EXPECT_TRUE(files.waiting().empty());
    write("run_1.raw", "a");
    EXPECT_EQ(readyAfter(0), "");
    EXPECT_EQ(readyAfter(1), "run_1.raw");
}

} // namespace
