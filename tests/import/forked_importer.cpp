// Starting tessera-import takes a twentieth of a second, nearly all of it for loading VTK, and the tests beside this
// file open thousands of damaged files. A process that has loaded VTK stands in for it: split off before the first
// test, it splits again for each start, and what comes of that does what the program's main() does, confined alike. The
// first start of a run and every sixteenth after it are of the program itself; all of them with TESSERA_IMPORT in the
// environment.
#include "tests/import/forked_importer.h"

#include "app/importer/serve.h"
#include "volume/system/own_path.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <mutex>
#include <sched.h>
#include <span>
#include <spawn.h>
#include <string>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace tessera::volume {
namespace {

constexpr int kEvery = 16;
constexpr std::size_t kMostBytes = 65536; // of arguments
using Files = std::array<int, 4>;         ///< stdin, stdout, stderr and the working folder

std::mutex mutex;
int toFork = -1; ///< the socket of the process that forks; -1: none
Starts counted;
thread_local Files asked{-1, -1, -1, -1};

/// The arguments, each with its 0, as one message, and the files with it.
msghdr message(iovec& bytes, std::span<char> room) {
    msghdr head{};
    head.msg_iov = &bytes;
    head.msg_iovlen = 1;
    head.msg_control = room.data();
    head.msg_controllen = room.size();
    return head;
}
using Room = std::array<char, CMSG_SPACE(sizeof(Files))>;

[[noreturn]] void serveAs(const Files& files, char* words, std::size_t bytes) {
    for (int file = 0; file < 3; ++file) dup2(files[std::size_t(file)], file);
    bool placed = fchdir(files[3]) == 0;
    for (const int file : files) placed = close(file) == 0 && placed;
    std::vector<char*> arguments;
    for (std::size_t at = 0; at < bytes; at += std::strlen(words + at) + 1) arguments.push_back(words + at);
    arguments.push_back(nullptr);
    const int status = placed ? importer::serve(int(arguments.size()) - 1, arguments.data()) : 1;
    std::fflush(nullptr);
    _exit(status);
}

/// Until the tests have ended: a child for each message, whose parent is not this process but that of the tests.
[[noreturn]] void forkFor(int socket) {
    static std::array<char, kMostBytes> words;
    for (;;) {
        alignas(cmsghdr) Room room{};
        iovec bytes{words.data(), words.size()};
        msghdr head = message(bytes, room);
        const ssize_t got = recvmsg(socket, &head, 0);
        if (got <= 0) _exit(0);
        Files files;
        std::memcpy(files.data(), CMSG_DATA(CMSG_FIRSTHDR(&head)), sizeof files);
        const auto child = static_cast<pid_t>(syscall(SYS_clone, CLONE_PARENT | SIGCHLD, 0, 0, 0, 0));
        if (child == 0) {
            close(socket);
            serveAs(files, words.data(), std::size_t(got));
        }
        for (const int file : files) close(file);
        if (send(socket, &child, sizeof child, 0) != ssize_t(sizeof child)) _exit(1);
    }
}

class Forker final : public testing::Environment {
public:
    void SetUp() override {
        int ends[2];
        if (std::getenv("TESSERA_IMPORT") != nullptr ||
            socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0)
            return;
        child_ = fork();
        if (child_ == 0) {
            close(ends[0]);
            forkFor(ends[1]);
        }
        close(ends[1]);
        toFork = ends[0];
    }
    void TearDown() override {
        if (toFork < 0) return;
        close(toFork);
        waitpid(child_, nullptr, 0);
    }

private:
    pid_t child_ = -1;
};
const testing::Environment* const kForker = testing::AddGlobalTestEnvironment(new Forker);

/// The process id of a new child; 0 where the program itself is to be started.
pid_t forked(const char* program, char* const words[]) {
    static const std::string own = programBeside("tessera-import");
    const std::lock_guard lock(mutex);
    if (toFork < 0 || own != program) return 0;
    if (counted.all++ % kEvery == 0) {
        ++counted.ofTheProgram;
        return 0;
    }
    std::string text;
    for (; *words != nullptr; ++words) text.append(*words, std::strlen(*words) + 1);
    Files files = asked;
    files[3] = open(".", O_PATH | O_DIRECTORY | O_CLOEXEC);
    alignas(cmsghdr) Room room{};
    iovec bytes{text.data(), text.size()};
    msghdr head = message(bytes, room);
    cmsghdr* const about = CMSG_FIRSTHDR(&head);
    about->cmsg_level = SOL_SOCKET;
    about->cmsg_type = SCM_RIGHTS;
    about->cmsg_len = CMSG_LEN(sizeof files);
    std::memcpy(CMSG_DATA(about), files.data(), sizeof files);
    pid_t child = -1;
    const bool told = text.size() <= kMostBytes && sendmsg(toFork, &head, MSG_NOSIGNAL) == ssize_t(text.size()) &&
                      recv(toFork, &child, sizeof child, 0) == ssize_t(sizeof child);
    close(files[3]);
    return told ? child : -1;
}

} // namespace

Starts starts() {
    const std::lock_guard lock(mutex);
    return counted;
}

} // namespace tessera::volume

// What volume/system/process.cpp starts programs with; the linker names these in their place.
extern "C" {

int __real_posix_spawn_file_actions_adddup2(posix_spawn_file_actions_t* actions, int from, int to);
int __real_posix_spawnp(pid_t* child, const char* program, const posix_spawn_file_actions_t* actions,
                        const posix_spawnattr_t* attributes, char* const words[], char* const environment[]);

int __wrap_posix_spawn_file_actions_adddup2(posix_spawn_file_actions_t* actions, int from, int to) {
    if (to >= 0 && to < 3) tessera::volume::asked[std::size_t(to)] = from;
    return __real_posix_spawn_file_actions_adddup2(actions, from, to);
}

int __wrap_posix_spawnp(pid_t* child, const char* program, const posix_spawn_file_actions_t* actions,
                        const posix_spawnattr_t* attributes, char* const words[], char* const environment[]) {
    const pid_t started = tessera::volume::forked(program, words);
    if (started == 0) return __real_posix_spawnp(child, program, actions, attributes, words, environment);
    *child = started;
    return started > 0 ? 0 : EAGAIN;
}

} // extern "C"
