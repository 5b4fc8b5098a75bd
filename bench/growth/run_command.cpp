#include "bench/growth/run_command.h"

#include "volume/base/error.h"
#include "volume/system/own_path.h"

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tessera::app {

namespace fs = std::filesystem;

namespace {

/// The environment of this process with the user's folders in `home`.
std::vector<std::string> environmentIn(const std::string& home, const std::string& display) {
    std::vector<std::string> all;
    for (char** each = environ; *each != nullptr; ++each) {
        const std::string_view text(*each);
        if (!text.starts_with("XDG_") && !text.starts_with("MESA_SHADER_CACHE_DIR=") && !text.starts_with("HOME=") &&
            !text.starts_with("DISPLAY=") && !text.starts_with("WAYLAND_DISPLAY="))
            all.emplace_back(text);
    }
    all.push_back("HOME=" + home);
    all.push_back("XDG_RUNTIME_DIR=" + home);
    all.push_back("MESA_SHADER_CACHE_DIR=" + home);
    if (!display.empty()) all.push_back("DISPLAY=" + display);
    return all;
}

std::vector<char*> pointersTo(std::vector<std::string>& texts) {
    std::vector<char*> pointers;
    for (std::string& text : texts) pointers.push_back(text.data());
    pointers.push_back(nullptr);
    return pointers;
}

std::string lastLineOf(const std::string& path) {
    std::ifstream in(path);
    std::string line, last;
    while (std::getline(in, line))
        if (!line.empty()) last = line;
    return last;
}

double secondsOf(const timeval& time) {
    return double(time.tv_sec) + 1e-6 * double(time.tv_usec);
}

} // namespace

BenchFolder::BenchFolder() {
    std::string name = (fs::temp_directory_path() / "tessera-bench-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw MachineError(std::strerror(errno), name);
    path_ = name;
}

BenchFolder::~BenchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

std::string programUnderTest() {
    std::string program = programBeside("tessera");
    if (program.empty()) throw Error("the program tessera does not lie beside tessera-bench");
    return program;
}

pid_t startProgram(const std::vector<std::string>& words, const std::string& home, const std::string& display) {
    std::error_code ignored;
    fs::create_directories(home, ignored);
    std::vector<std::string> arguments = words, environment = environmentIn(home, display);
    const std::string said = home + "/said";
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, said.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    pid_t child = -1;
    const int problem = posix_spawnp(&child, words[0].c_str(), &files, nullptr, pointersTo(arguments).data(),
                                     pointersTo(environment).data());
    posix_spawn_file_actions_destroy(&files);
    if (problem != 0) throw MachineError(std::strerror(problem), words[0]);
    return child;
}

CommandCost runCommand(const std::vector<std::string>& words, const std::string& home) {
    const auto begin = std::chrono::steady_clock::now();
    const pid_t child = startProgram(words, home);
    int status = 0;
    rusage used{};
    while (wait4(child, &status, 0, &used) < 0)
        if (errno != EINTR) throw MachineError(std::strerror(errno), words[0]);
    CommandCost cost;
    cost.passed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    cost.done = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    cost.processor = secondsOf(used.ru_utime) + secondsOf(used.ru_stime);
    cost.megabytes = double(used.ru_maxrss) * 1024 / 1e6;
    if (!cost.done) cost.lastWords = lastLineOf(home + "/said");
    return cost;
}

} // namespace tessera::app
