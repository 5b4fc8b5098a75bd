#include "bench/growth/watched_screen.h"

#include "volume/base/error.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace tessera::app {

namespace fs = std::filesystem;

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t kEach = 4; // of rows and pixels that are looked at
constexpr std::size_t kPixelBytes = 4;

double secondsSince(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Processor seconds of a program so far.
double processorSeconds(pid_t program) {
    std::ifstream in("/proc/" + std::to_string(program) + "/stat");
    std::string text((std::istreambuf_iterator<char>(in)), {});
    const std::size_t name = text.rfind(')'); // which may contain blanks
    if (name == std::string::npos) return 0;
    std::istringstream rest(text.substr(name + 1));
    std::string word;
    for (int field = 3; field < 14; ++field) rest >> word;
    double user = 0, system = 0;
    rest >> user >> system;
    return (user + system) / double(sysconf(_SC_CLK_TCK));
}

void end(pid_t program) {
    ::kill(program, SIGTERM);
    for (int wait = 0; wait < 300; ++wait) {
        if (::waitpid(program, nullptr, WNOHANG) != 0) return;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ::kill(program, SIGKILL);
    ::waitpid(program, nullptr, 0);
}

/// A number of the head of an XWD file, which are big-endian.
std::size_t headNumber(const std::uint8_t* bytes, std::size_t index) {
    std::size_t number = 0;
    for (std::size_t i = 0; i < 4; ++i) number = number << 8 | bytes[4 * index + i];
    return number;
}

/// The share of pixels that differ visibly.
double changedShare(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    constexpr int kVisible = 24;
    std::size_t changed = 0;
    for (std::size_t i = 0; i < a.size(); ++i) changed += std::abs(int(a[i]) - int(b[i])) > kVisible ? 1 : 0;
    return double(changed) / double(std::max<std::size_t>(a.size(), 1));
}

} // namespace

std::string programOnPath(const std::string& name) {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path != nullptr ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        const std::string program = (fs::path(folder) / name).string();
        if (::access(program.c_str(), X_OK) == 0) return program;
    }
    return {};
}

bool WatchedScreen::isAvailable() {
    return !programOnPath("Xvfb").empty();
}

WatchedScreen::WatchedScreen() {
    std::array<int, 2> pipe{};
    if (::pipe2(pipe.data(), 0) != 0) throw MachineError(std::strerror(errno), "Xvfb");
    ::fcntl(pipe[0], F_SETFD, FD_CLOEXEC);
    server_ = startProgram({"Xvfb", "-displayfd", std::to_string(pipe[1]), "-screen", "0", "1600x1000x24", "-fbdir",
                            folder_.path(), "-nolisten", "tcp", "-noreset"},
                           folder_.file("home"));
    ::close(pipe[1]);
    std::string number;
    for (char c = 0; ::read(pipe[0], &c, 1) == 1 && c != '\n';) number += c;
    ::close(pipe[0]);
    const std::string file = folder_.file("Xvfb_screen0");
    const int screen = number.empty() ? -1 : ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat about {};
    if (screen >= 0 && ::fstat(screen, &about) == 0) {
        size_ = std::size_t(about.st_size);
        void* const mapped = ::mmap(nullptr, size_, PROT_READ, MAP_SHARED, screen, 0);
        bytes_ = mapped == MAP_FAILED ? nullptr : static_cast<const std::uint8_t*>(mapped);
    }
    if (screen >= 0) ::close(screen);
    if (bytes_ != nullptr) {
        // Size of the head, height, bytes of a row, number of colours: fields 0, 5, 12 and 19 of it.
        constexpr std::size_t kColorBytes = 12;
        pixels_ = headNumber(bytes_, 0) + kColorBytes * headNumber(bytes_, 19);
        rows_ = headNumber(bytes_, 5);
        rowBytes_ = headNumber(bytes_, 12);
    }
    if (bytes_ == nullptr || rowBytes_ == 0 || pixels_ + rows_ * rowBytes_ > size_) {
        end(server_);
        throw MachineError("Xvfb could not be started", "Xvfb");
    }
    display_ = ":" + number;
}

WatchedScreen::~WatchedScreen() {
    ::munmap(const_cast<std::uint8_t*>(bytes_), size_);
    end(server_);
}

WatchedScreen::Picture WatchedScreen::look() const {
    Picture picture;
    for (std::size_t row = 0; row < rows_; row += kEach)
        for (std::size_t byte = 1; byte < rowBytes_; byte += kEach * kPixelBytes) // green
            picture.push_back(bytes_[pixels_ + row * rowBytes_ + byte]);
    return picture;
}

WatchedStart WatchedScreen::watch(const std::vector<std::string>& words, const std::string& home) const {
    constexpr double kRest = 2, kLongest = 90; // s
    struct Seen {
        Moment at;
        Picture picture;
    };
    std::vector<Seen> seen{{{}, look()}};
    const Clock::time_point begin = Clock::now();
    const pid_t program = startProgram(words, home, display_);
    while (secondsSince(begin) < kLongest &&
           (seen.size() == 1 || secondsSince(begin) - seen.back().at.passed < kRest)) {
        Picture now = look();
        if (now != seen.back().picture)
            seen.push_back({{secondsSince(begin), processorSeconds(program)}, std::move(now)});
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    end(program);
    std::this_thread::sleep_for(std::chrono::milliseconds(100)); // until its window is gone
    WatchedStart start;
    if (seen.size() < 2) return start;
    start.shown = true;
    start.window = seen[1].at;
    start.rest = seen.back().at;
    for (auto at = seen.rbegin(); at != seen.rend() && changedShare(at->picture, seen.back().picture) < 0.01; ++at)
        start.picture = at->at;
    return start;
}

} // namespace tessera::app
