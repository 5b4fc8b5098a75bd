#include "volume/system/part_file.h"

#include "volume/system/atomic_file.h"

#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tessera {
namespace {

namespace fs = std::filesystem;
using namespace testing;

class PartFile : public Test {
protected:
    void SetUp() override { fs::create_directories(folder_); }
    void TearDown() override { fs::remove_all(folder_); }

    std::string touch(const std::string& name) const {
        std::ofstream(folder_ / name) << "begun";
        return (folder_ / name).string();
    }
    /// The number of a process that is gone.
    static std::string gone() {
        const pid_t child = ::fork();
        if (child == 0) ::_exit(0);
        ::waitpid(child, nullptr, 0);
        return std::to_string(child);
    }
    const fs::path folder_ = fs::temp_directory_path() / ("tessera_part_" + std::to_string(::getpid()));
    const std::string target_ = (folder_ / "a.tsr").string();
};

TEST_F(PartFile, IsFoundWhereItsProcessIsGone) {
    const std::string left = touch("a.tsr.part-" + gone());
    touch("a.tsr.part-" + std::to_string(::getpid()));
    touch("a.tsr.part-1");
    touch("b.tsr.part-" + gone());
    touch("a.tsr.part-");
    touch("a.tsr.part--5");
    touch("a.tsr.part-12x");
    touch("a.tsr.part-99999999999999999999");
    EXPECT_THAT(leftParts(target_), ElementsAre(left));
    EXPECT_THAT(leftParts((folder_ / "none" / "a.tsr").string()), IsEmpty());
}

TEST_F(PartFile, IsKeptWhileAWriterElsewhereLocksIt) {
    const std::string left = touch("a.tsr.part-" + gone());
    const int file = ::open(left.c_str(), O_RDWR);
    ASSERT_EQ(::flock(file, LOCK_EX), 0);
    EXPECT_THAT(leftParts(target_), IsEmpty());
    ::close(file);
    EXPECT_THAT(leftParts(target_), ElementsAre(left));
}

TEST_F(PartFile, MayBeAFolderWithFiles) {
    const fs::path left = folder_ / ("a.tsr.part-" + gone()), elsewhere = folder_ / "elsewhere";
    fs::create_directories(left);
    std::ofstream(left / "frame") << "begun";
    fs::create_directories(elsewhere);
    const fs::path link = folder_ / ("a.tsr.part-" + gone());
    fs::create_directory_symlink(elsewhere, link);
    EXPECT_THAT(leftParts(target_), ElementsAre(left.string()));
    removeLeftParts(target_);
    EXPECT_FALSE(fs::exists(left));
    EXPECT_TRUE(fs::exists(link)) << "links are nobody's parts";
}

TEST_F(PartFile, TheNextWriterOfTheSameFileRemovesIt) {
    const std::string left = touch("a.tsr.part-" + gone());
    const std::string other = touch("b.tsr.part-" + gone());
    AtomicFile file(target_);
    EXPECT_FALSE(fs::exists(left));
    EXPECT_TRUE(fs::exists(other));
    EXPECT_TRUE(fs::exists(partFileOf(target_)));
    file.commit();
    EXPECT_TRUE(fs::exists(target_));
}

// Others may read what has its name before its writer is gone.
TEST_F(PartFile, WhatIsCommittedIsWhole) {
    AtomicFile file(target_);
    file.write("all of it");
    file.commit();
    std::ifstream in(target_);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), "all of it");
}

} // namespace
} // namespace tessera
