#include "volume/system/kept_numbers.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace tessera {
namespace {

namespace fs = std::filesystem;

class KeptNumbers : public ::testing::Test {
protected:
    void SetUp() override { fs::create_directories(folder_); }
    void TearDown() override { fs::remove_all(folder_); }

    /// Asks for three numbers; counts how often they are computed.
    std::vector<float> ask() {
        return computedOnce(folder_.string(), "three", 3, [this] {
            ++computed_;
            return std::vector<float>{1.5f, -2, 3e-30f};
        });
    }
    std::string bytes() const {
        std::ifstream in(folder_ / "three", std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    void replace(const std::string& bytes) const { std::ofstream(folder_ / "three", std::ios::binary) << bytes; }

    fs::path folder_ = fs::path(::testing::TempDir()) / ("tessera_kept_" + std::to_string(::getpid()));
    const std::vector<float> expected_{1.5f, -2, 3e-30f};
    int computed_ = 0;
};

TEST_F(KeptNumbers, AreComputedOnce) {
    EXPECT_EQ(ask(), expected_);
    EXPECT_EQ(ask(), expected_);
    EXPECT_EQ(computed_, 1);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1) << "a temporary file is left";
}

TEST_F(KeptNumbers, ADamagedFileIsComputedAnewAndReplaced) {
    ask();
    const std::string whole = bytes();
    ASSERT_GT(whole.size(), 12u);
    for (std::size_t i = 0; i < whole.size(); ++i) { // among them the program's identity
        std::string flipped = whole;
        flipped[i] = char(flipped[i] ^ 0x20);
        replace(flipped);
        computed_ = 0;
        EXPECT_EQ(ask(), expected_) << i;
        EXPECT_EQ(computed_, 1) << i;
        EXPECT_EQ(bytes(), whole) << i;
    }
    for (const std::string& other : {whole.substr(0, whole.size() - 1), whole + "x", std::string()}) {
        replace(other);
        computed_ = 0;
        EXPECT_EQ(ask(), expected_);
        EXPECT_EQ(computed_, 1);
    }
}

TEST_F(KeptNumbers, WhatAKilledProgramLeftIsRemoved) {
    const pid_t gone = ::fork();
    if (gone == 0) ::_exit(0);
    ASSERT_EQ(::waitpid(gone, nullptr, 0), gone);
    std::ofstream(folder_ / ("three.part-" + std::to_string(gone))) << "half";
    EXPECT_EQ(ask(), expected_);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

TEST_F(KeptNumbers, AreComputedWhereNothingCanBeKept) {
    const auto three = [this] {
        ++computed_;
        return expected_;
    };
    EXPECT_EQ(computedOnce("", "three", 3, three), expected_);
    EXPECT_EQ(computedOnce((folder_ / "missing").string(), "three", 3, three), expected_);
    EXPECT_EQ(computed_, 2);
    EXPECT_EQ(computedOnce(folder_.string(), "three", 4, three), expected_) << "another count is not kept";
    EXPECT_FALSE(fs::exists(folder_ / "three"));
}

} // namespace
} // namespace tessera
