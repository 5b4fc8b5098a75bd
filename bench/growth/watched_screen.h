#pragma once

#include "bench/growth/run_command.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// When the window of a program shows its picture, seen from outside: on a screen in memory that is compared with what
/// it shows in the end. So any two programs can be compared.
namespace tessera::app {

/// When it happened, in seconds since the command, and the processor's seconds until then.
struct Moment {
    double passed = 0, processor = 0;
};

struct WatchedStart {
    Moment window;  ///< something of it is on the screen
    Moment picture; ///< from here on less than a hundredth of the screen changes visibly
    Moment rest;    ///< the last change
    bool shown = false;
};

/// An X server without a screen (Xvfb), whose pixels are read from its memory.
class WatchedScreen {
public:
    WatchedScreen();
    ~WatchedScreen();
    WatchedScreen(const WatchedScreen&) = delete;
    WatchedScreen& operator=(const WatchedScreen&) = delete;

    /// Whether Xvfb is installed.
    static bool isAvailable();
    /// Starts a program, waits until the screen has rested for a while, and ends it.
    WatchedStart watch(const std::vector<std::string>& words, const std::string& home) const;

private:
    using Picture = std::vector<std::uint8_t>;
    Picture look() const;

    BenchFolder folder_;
    std::string display_;
    pid_t server_ = -1;
    const std::uint8_t* bytes_ = nullptr; ///< of the file of the screen
    std::size_t size_ = 0, pixels_ = 0;   ///< of the file; where pixels begin
    std::size_t rows_ = 0, rowBytes_ = 0;
};

/// A program on PATH, "" where there is none.
std::string programOnPath(const std::string& name);

} // namespace tessera::app
