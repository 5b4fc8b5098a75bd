#pragma once

#include <string>
#include <sys/types.h>
#include <vector>

/// Programs started as a user starts them, and what they took.
namespace tessera::app {

/// A folder of its own under the temporary one, removed with all that is in it.
class BenchFolder {
public:
    BenchFolder();
    ~BenchFolder();
    BenchFolder(const BenchFolder&) = delete;
    BenchFolder& operator=(const BenchFolder&) = delete;
    const std::string& path() const { return path_; }
    std::string file(const std::string& name) const { return path_ + "/" + name; }

private:
    std::string path_;
};

/// What a program took, together with those that it started and waited for.
struct CommandCost {
    bool done = false;     ///< ended with status 0
    double processor = 0;  ///< seconds, of all threads and programs
    double passed = 0;     ///< seconds from its start to its end
    double megabytes = 0;  ///< most memory of the largest of the programs; at least what tessera-bench itself uses
    std::string lastWords; ///< the last line of its errors, where it failed
};

/// `tessera` beside this program. Throws Error where it is not there.
std::string programUnderTest();

/// Starts a program with files of the user (settings, caches, compiled shaders) in the folder `home`; `words[0]` is a
/// path or on PATH. What it says goes to `home`/said. `display`: of X11, "" for none. Throws MachineError.
pid_t startProgram(const std::vector<std::string>& words, const std::string& home, const std::string& display = {});

/// Runs a program to its end.
CommandCost runCommand(const std::vector<std::string>& words, const std::string& home);

} // namespace tessera::app
