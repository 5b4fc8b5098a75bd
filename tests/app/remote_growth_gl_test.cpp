#include "app/platform/gui.h"
#include "app/platform/headless.h"
#include "app/workbench/workbench.h"
#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "vis/gl/headless.h"
#include "volume/field/quantities.h"
#include "volume/synthetic/models.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <curl/curl.h>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <optional>
#include <spawn.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace tessera::app {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

template <class Condition> bool comesIn10s(Condition&& condition) {
    for (int turn = 0; turn < 1000; ++turn, std::this_thread::sleep_for(10ms))
        if (condition()) return true;
    return false;
}

/// The web server of the end-to-end tests, of a folder of its own, and a cache of its own.
class RemoteGrowthGl : public ::testing::Test {
protected:
    void SetUp() override {
        folder = fs::temp_directory_path() / ("remote_growth_" + std::to_string(::getpid()));
        fs::create_directories(folder / "cache");
        if (const char* const before = std::getenv("XDG_CACHE_HOME")) cacheBefore = before;
        ::setenv("MESA_SHADER_CACHE_DIR", fs::temp_directory_path().c_str(), 0); // else Mesa's cache would go, too
        ::setenv("XDG_CACHE_HOME", (folder / "cache").c_str(), 1);
        std::string script = std::string(TESSERA_SOURCE_DIR) + "/tests/e2e/remote_server.py", port = folder / "port";
        std::string python = "python3", served = folder;
        char* const words[] = {python.data(), script.data(), served.data(), port.data(), nullptr};
        if (::posix_spawnp(&server, words[0], nullptr, nullptr, words, environ) != 0) GTEST_SKIP() << "no python3";
        ASSERT_TRUE(comesIn10s([&] { return fs::exists(port); }));
        std::string number;
        std::ifstream(port) >> number;
        address = "http://127.0.0.1:" + number;
    }
    void TearDown() override {
        if (server > 0) {
            ::kill(server, SIGKILL);
            ::waitpid(server, nullptr, 0);
        }
        if (cacheBefore)
            ::setenv("XDG_CACHE_HOME", cacheBefore->c_str(), 1);
        else
            ::unsetenv("XDG_CACHE_HOME");
        std::error_code ignored;
        fs::remove_all(folder, ignored);
    }
    /// Bytes that the server has sent since this was last asked.
    double told() const {
        std::string answer;
        CURL* const curl = curl_easy_init();
        curl_easy_setopt(curl, CURLOPT_URL, (address + "/told").c_str());
        curl_easy_setopt(curl, CURLOPT_WRITEDATA, &answer);
        curl_easy_setopt(
            curl, CURLOPT_WRITEFUNCTION, +[](char* bytes, std::size_t one, std::size_t count, void* to) {
                static_cast<std::string*>(to)->append(bytes, one * count);
                return one * count;
            });
        EXPECT_EQ(curl_easy_perform(curl), CURLE_OK);
        curl_easy_cleanup(curl);
        return std::strtod(answer.c_str(), nullptr);
    }

    fs::path folder;
    std::optional<std::string> cacheBefore;
    pid_t server = 0;
    std::string address;
};

/// Noise, whose archives are large: eight times.
volume::Dataset noise(const std::vector<int>& times) {
    volume::Dataset whole = volume::makeModel("marschner-lobb", {{"nx", 40}, {"ny", 40}, {"nz", 40}, {"times", 8}});
    whole.read = [read = whole.read](int p, int c, int t) {
        volume::Field field = read(p, c, t);
        std::uint32_t state = std::uint32_t(t) + 1;
        for (float& value : field.as<float>()) value += 1e-3f * float((state = state * 1664525u + 1013904223u) >> 8);
        return field;
    };
    return volume::withTimes(whole, times);
}

struct Shown {
    vis::HeadlessContext gl;
    Gui gui;
    Workbench workbench{{.renderer = nullptr,
                         .render = {},
                         .headless = false,
                         .onlyPane = {},
                         .stateFolder = {},
                         .growthInterval = 1ms}};

    explicit Shown(const std::string& address) {
        OpenRequest request;
        request.paths = {address};
        workbench.install(open(request));
        draw();
    }
    void draw() { (void)drawUntilDone(workbench, {600, 400}, 1); }
    void drawTimes(std::size_t count) {
        for (std::size_t time = 0; time < count; ++time) {
            workbench.session().time = workbench.source()->info().times[time];
            draw();
        }
    }
    bool gets(std::size_t times) {
        return comesIn10s([&] {
            draw();
            return workbench.source()->info().times.size() == times;
        });
    }
};

TEST_F(RemoteGrowthGl, NewTimesComeAndNothingIsReadTwice) {
    const std::string path = folder / "run.tsr";
    volume::Dataset early = noise({0, 1, 2, 3, 4, 5, 6}), late = noise({7});
    codec::pack(early, {}, path);
    const double whole = double(fs::file_size(path));
    Shown shown(address + "/run.tsr");
    shown.drawTimes(7); // all of it is here then
    ASSERT_GT(told(), 0.8 * whole);
    codec::append(late, path);
    ASSERT_TRUE(shown.gets(8));
    shown.drawTimes(8);
    const double more = double(fs::file_size(path)) - whole;
    EXPECT_LT(told(), more + 0.25 * whole) << "what was there before is read again";
}

/// A program that stands for ssh comes first in PATH.
TEST_F(RemoteGrowthGl, NewTimesComeBySftpAndAfterAReplacement) {
    const std::string path = folder / "run.tsr", next = folder / "next.tsr";
    volume::Dataset early = noise({0, 1}), middle = noise({2}), all = noise({0, 1, 2, 3});
    codec::pack(early, {}, path);
    fs::create_directory(folder / "bin");
    const std::string ssh = folder / "bin/ssh", script = std::string(TESSERA_SOURCE_DIR) + "/tests/e2e/fake_ssh.py";
    std::ofstream(ssh) << "#!/bin/sh\nFAKE_SSH_LOG=/dev/null exec python3 '" << script << "' \"$@\"\n";
    fs::permissions(ssh, fs::perms::owner_all);
    const std::string before = std::getenv("PATH");
    ::setenv("PATH", (folder / "bin").string().append(":").append(before).c_str(), 1);
    {
        Shown shown("sftp://me@cluster" + path);
        codec::append(middle, path);
        EXPECT_TRUE(shown.gets(3));
        codec::pack(all, {}, next);
        fs::rename(next, path); // another file, which goes on from the times of the first
        EXPECT_TRUE(shown.gets(4));
    }
    ::setenv("PATH", before.c_str(), 1);
}

} // namespace
} // namespace tessera::app
