#include "volume/system/confine.h"

#include <fcntl.h>
#include <fstream>
#include <linux/landlock.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace tessera::volume {

namespace {

/// Rights by the versions of Landlock that brought them; the headers of Debian 12 have the first two versions alone.
constexpr std::uint64_t kReadRights = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR,
                        kFirstRights = (std::uint64_t(1) << 13) - 1, // execute, read, write, make and remove
    kRefer = std::uint64_t(1) << 13, kTruncate = std::uint64_t(1) << 14, kPorts = 3;
constexpr std::uint64_t kFileRights =
    LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_READ_FILE | kTruncate; ///< what a rule of a file may name

/// Argument of landlock_create_ruleset.
struct Ruleset {
    std::uint64_t files = 0, ports = 0;
};

std::uint64_t knownRights(long version) {
    return kFirstRights | (version >= 2 ? kRefer : 0) | (version >= 3 ? kTruncate : 0);
}

bool isFolder(int file) {
    struct stat about {};
    return ::fstat(file, &about) == 0 && S_ISDIR(about.st_mode);
}

/// Adds rights to whatever lies at or below a path; false where the path cannot be opened.
bool allow(int ruleset, const std::string& path, std::uint64_t rights) {
    const int at = ::open(path.c_str(), O_PATH | O_CLOEXEC);
    if (at < 0) return false;
    landlock_path_beneath_attr rule{};
    rule.allowed_access = isFolder(at) ? rights : rights & kFileRights;
    rule.parent_fd = at;
    const bool added = ::syscall(SYS_landlock_add_rule, ruleset, LANDLOCK_RULE_PATH_BENEATH, &rule, 0) == 0;
    ::close(at);
    return added;
}

bool confineFiles(const std::vector<std::string>& writable) {
    const long version = ::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
    if (version < 1) return false;
    const std::uint64_t all = knownRights(version);
    const Ruleset given{.files = all, .ports = kPorts};
    const std::size_t size = version >= 4 ? sizeof given : sizeof given.files;
    const int ruleset = int(::syscall(SYS_landlock_create_ruleset, &given, size, 0));
    if (ruleset < 0) return false;
    bool good = allow(ruleset, "/", kReadRights);
    for (const std::string& path : writable) allow(ruleset, path, all & ~std::uint64_t(LANDLOCK_ACCESS_FS_EXECUTE));
    good =
        good && ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && ::syscall(SYS_landlock_restrict_self, ruleset, 0) == 0;
    ::close(ruleset);
    return good;
}

void lower(decltype(RLIMIT_CPU) what, std::uint64_t limit) {
    rlimit now{};
    if (::getrlimit(what, &now) != 0) return;
    now.rlim_cur = now.rlim_max == RLIM_INFINITY || limit < now.rlim_max ? rlim_t(limit) : now.rlim_max;
    ::setrlimit(what, &now);
}

/// Bytes that RLIMIT_DATA counts so far; sanitizers have reserved much.
std::uint64_t dataBytes() {
    std::ifstream statistics("/proc/self/statm");
    std::uint64_t pages = 0;
    for (int field = 0; field < 6; ++field) statistics >> pages; // the sixth: data and stack
    return pages * std::uint64_t(::sysconf(_SC_PAGESIZE));
}

} // namespace

bool confine(const Confinement& allowed) {
    if (allowed.memory > 0) lower(RLIMIT_DATA, dataBytes() + allowed.memory);
    return confineFiles(allowed.writable);
}

void limitProcessorTime(std::chrono::seconds most) {
    rusage used{};
    if (::getrusage(RUSAGE_SELF, &used) != 0) return;
    lower(RLIMIT_CPU, std::uint64_t(used.ru_utime.tv_sec + used.ru_stime.tv_sec + 1 + most.count()));
}

} // namespace tessera::volume
