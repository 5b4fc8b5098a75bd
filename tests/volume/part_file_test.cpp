#include "volume/system/part_file.h"

#include "volume/base/error.h"
#include "volume/system/atomic_file.h"

#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
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

TEST_F(PartFile, WhatALinkLeadsToIsReplaced) {
    const std::string file = touch("run-5.tsr"), link = (folder_ / "latest.tsr").string(),
                      dangling = (folder_ / "next.tsr").string();
    fs::create_symlink("run-5.tsr", link);
    fs::create_symlink("latest.tsr", folder_ / "link.tsr");
    fs::create_symlink("run-6.tsr", dangling);
    writeAtomically((folder_ / "link.tsr").string(), "the new one");
    writeAtomically(dangling, "another one");
    const auto textOf = [](const std::string& path) {
        std::ifstream in(path);
        return std::string(std::istreambuf_iterator<char>(in), {});
    };
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_TRUE(fs::is_symlink(dangling));
    EXPECT_EQ(textOf(file), "the new one");
    EXPECT_EQ(textOf((folder_ / "run-6.tsr").string()), "another one");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 5) << "nothing else";
    EXPECT_EQ(replacedFile(file), file);
    fs::create_symlink("circle", folder_ / "circle");
    EXPECT_EQ(replacedFile((folder_ / "circle").string()), (folder_ / "circle").string()) << "it ends";
}

TEST_F(PartFile, WhatIsNoFileIsNotReplaced) {
    const std::string pipe = (folder_ / "pipe").string();
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    fs::create_symlink("pipe", folder_ / "link");
    EXPECT_THROW(writeAtomically(pipe, "text"), MachineError);
    EXPECT_THROW(writeAtomically((folder_ / "link").string(), "text"), MachineError);
    EXPECT_TRUE(fs::is_fifo(pipe));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 2);
}

} // namespace
} // namespace tessera
