// What is opened for reading: regular files, and nothing that may make a reader wait or never end.
#include "volume/base/error.h"
#include "volume/system/input_file.h"
#include "volume/system/mapped_file.h"
#include "volume/system/scratch_file.h"

#include <filesystem>
#include <fstream>
#include <functional>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <string>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>
#include <vector>

namespace tessera {
namespace {

namespace fs = std::filesystem;

class InputFile : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("tessera_input_" + std::to_string(getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    /// A pipe that nobody writes to, a socket that nobody listens at, and devices.
    std::vector<std::string> noFiles() const {
        EXPECT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
        const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
        sockaddr_un at{};
        at.sun_family = AF_UNIX;
        path("socket").copy(at.sun_path, sizeof at.sun_path - 1);
        EXPECT_EQ(bind(socket, reinterpret_cast<const sockaddr*>(&at), sizeof at), 0);
        close(socket);
        return {path("pipe"), path("socket"), "/dev/zero", "/dev/full", "/dev/null"};
    }
    static std::string reason(const std::function<void()>& body) {
        try {
            body();
        } catch (const Error& error) {
            return error.reason();
        }
        return "";
    }
    fs::path folder_;
};

TEST_F(InputFile, APipeASocketOrADeviceIsRefusedByEveryWayToOpenIt) {
    const std::vector<std::function<void(const std::string&)>> ways = {
        [](const std::string& file) { requireFile(file); },
        [](const std::string& file) { openInput(file); },
        [](const std::string& file) { close(openInputDescriptor(file)); },
        [](const std::string& file) { readInput(file, 1000); },
        [](const std::string& file) { const MappedFile mapped(file); },
        [](const std::string& file) { volume::ScratchFile::of(file); }};
    for (const std::string& file : noFiles()) {
        EXPECT_EQ(whyNoFile(file), kPipeOrDevice) << file;
        for (const auto& way : ways) EXPECT_THAT(reason([&] { way(file); }), testing::HasSubstr(kPipeOrDevice)) << file;
    }
    for (const auto& way : ways) {
        EXPECT_THAT(reason([&] { way(folder_.string()); }), testing::HasSubstr("is a folder"));
        EXPECT_NE(reason([&] { way(path("none")); }), "");
    }
    EXPECT_EQ(whyNoFile(path("none")), kNoSuchFile);
}

TEST_F(InputFile, AFileIsReadWholeUpToALimit) {
    const std::string text(3'000'000, 'a');
    std::ofstream(path("a")) << text;
    EXPECT_EQ(readInput(path("a"), 3'000'000), text);
    EXPECT_EQ(reason([&] { readInput(path("a"), 2'999'999); }), "is larger than 3 MB, more than is read");
    fs::create_symlink("a", path("link"));
    EXPECT_EQ(readInput(path("link"), 3'000'000).size(), text.size());
    EXPECT_FALSE(readInput("/proc/self/status", 1'000'000).empty()); // says that it has no byte
    fs::resize_file(path("a"), std::uintmax_t(1) << 40);             // takes no space
    EXPECT_THAT(reason([&] { readInput(path("a"), 5'000'000); }), testing::HasSubstr("larger than 5 MB"));
}

} // namespace
} // namespace tessera
