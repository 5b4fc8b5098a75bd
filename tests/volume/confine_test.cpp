#include "volume/system/confine.h"

#include <arpa/inet.h>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

/// What a confined process can still do. Each test asks a child, since rights do not come back.
namespace tessera::volume {
namespace {

namespace fs = std::filesystem;

/// How a child ended that did this: its exit status, or minus the signal.
int childThat(const std::function<int()>& does) {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(does());
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

bool kernelConfines() {
    return childThat([] { return confine({}) ? 0 : 1; }) == 0;
}

bool writes(const fs::path& path) {
    std::FILE* const file = std::fopen(path.c_str(), "wb");
    if (!file) return false;
    std::fclose(file);
    return true;
}

class Confine : public testing::Test {
protected:
    void SetUp() override {
        if (!kernelConfines()) GTEST_SKIP() << "this kernel has no Landlock";
        fs::create_directories(root / "mine");
        std::ofstream(root / "known") << "text";
    }
    void TearDown() override { fs::remove_all(root); }
    Confinement mine() const { return {.writable = {(root / "mine").string(), "/dev/null"}}; }

    fs::path root = fs::path(testing::TempDir()) / ("confine_" + std::to_string(::getpid()));
};

TEST_F(Confine, FilesAreReadEverywhereAndWrittenWhereAllowed) {
    const auto tries = [&](const std::function<bool()>& works) {
        return childThat([&] {
            if (!confine(mine())) return 2;
            return works() ? 1 : 0;
        });
    };
    EXPECT_EQ(tries([&] { return std::ifstream(root / "known").good(); }), 1);
    EXPECT_EQ(tries([&] { return fs::directory_iterator(root) != fs::directory_iterator(); }), 1);
    EXPECT_EQ(tries([&] { return writes(root / "mine" / "new"); }), 1);
    EXPECT_EQ(tries([&] { return writes("/dev/null"); }), 1);
    EXPECT_EQ(tries([&] { return writes(root / "new"); }), 0);
    EXPECT_EQ(tries([&] { return writes(root / "known"); }), 0) << "truncates a file";
    EXPECT_EQ(tries([&] { return std::remove((root / "known").c_str()) == 0; }), 0);
    EXPECT_EQ(tries([&] { return std::rename((root / "known").c_str(), (root / "mine" / "k").c_str()) == 0; }), 0);
    EXPECT_EQ(tries([&] {
                  bool wrote = false;
                  std::thread([&] { wrote = writes(root / "new"); }).join();
                  return wrote;
              }),
              0)
        << "a thread that starts later";
    EXPECT_EQ(fs::file_size(root / "known"), 4U);
}

TEST_F(Confine, NoProgramStartsAndNoPortOpens) {
    const auto starts = [] {
        char name[] = "/bin/true";
        char* const words[] = {name, nullptr};
        pid_t child = 0;
        if (::posix_spawn(&child, name, nullptr, nullptr, words, environ) != 0) return 0;
        ::waitpid(child, nullptr, 0);
        return 1;
    };
    EXPECT_EQ(childThat(starts), 1);
    EXPECT_EQ(childThat([&] { return confine(mine()) ? starts() : 2; }), 0);

    const auto opens = [] {
        const int port = ::socket(AF_INET, SOCK_STREAM, 0);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        return ::bind(port, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ? 1 : 0;
    };
    const auto connects = [] {
        const int port = ::socket(AF_INET, SOCK_STREAM, 0);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(1);
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        const int status = ::connect(port, reinterpret_cast<const sockaddr*>(&address), sizeof address);
        return status != 0 && errno == EACCES ? 0 : 1; // nobody listens there
    };
    EXPECT_EQ(childThat(opens), 1);
    EXPECT_EQ(childThat(connects), 1);
    if (childThat([&] { return confine(mine()) ? opens() : 2; }) == 1) GTEST_SKIP() << "this kernel confines no ports";
    EXPECT_EQ(childThat([&] { return confine(mine()) ? connects() : 2; }), 0);
}

TEST_F(Confine, MemoryAndProcessorTimeEnd) {
    const auto takes = [](std::size_t bytes) {
        void* const got = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        return got == MAP_FAILED ? 0 : 1;
    };
    constexpr std::size_t kMega = 1 << 20;
    Confinement limited = mine();
    limited.memory = 64 * kMega;
    EXPECT_EQ(childThat([&] { return confine(limited) ? takes(16 * kMega) : 2; }), 1);
    EXPECT_EQ(childThat([&] { return confine(limited) ? takes(128 * kMega) : 2; }), 0);
    EXPECT_EQ(childThat([] {
                  limitProcessorTime(std::chrono::seconds(0));
                  while (std::clock() >= 0) {
                  }
                  return 0;
              }),
              -SIGXCPU);
    EXPECT_EQ(childThat([] {
                  limitProcessorTime(std::chrono::seconds(0));
                  limitProcessorTime(std::chrono::hours(1)); // a later call starts anew
                  const std::clock_t end = std::clock() + 3 * CLOCKS_PER_SEC / 2;
                  while (std::clock() < end) {
                  }
                  return 7;
              }),
              7);
}

} // namespace
} // namespace tessera::volume
