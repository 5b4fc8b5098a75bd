#include "volume/system/process.h"

#include "volume/base/error.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace tessera::volume {

namespace {

constexpr int kPollMilliseconds = 100;
constexpr std::size_t kKeptErrorBytes = 8192;

void closeFile(int& file) {
    if (file >= 0) close(file);
    file = -1;
}

std::string lastLine(const std::string& text) {
    std::size_t end = text.find_last_not_of(" \t\r\n");
    if (end == std::string::npos) return {};
    const std::size_t begin = text.find_last_of('\n', end);
    std::string line = text.substr(begin == std::string::npos ? 0 : begin + 1, end - (begin + 1) + 1);
    line.resize(std::min<std::size_t>(line.size(), 400));
    for (char& c : line)
        if (static_cast<unsigned char>(c) < ' ') c = ' ';
    return line;
}

} // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& arguments) {
    int in[2] = {-1, -1}, out[2] = {-1, -1}, err[2] = {-1, -1};
    // A socket, so that writing to a child that has ended gives an error instead of a signal.
    const bool made = socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, in) == 0 && pipe2(out, O_CLOEXEC) == 0 &&
                      pipe2(err, O_CLOEXEC) == 0;
    int failed = made ? 0 : errno;
    if (made) {
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, in[1], 0);
        posix_spawn_file_actions_adddup2(&actions, out[1], 1);
        posix_spawn_file_actions_adddup2(&actions, err[1], 2);
        std::vector<char*> words;
        for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
        words.push_back(nullptr);
        failed = posix_spawnp(&pid_, words[0], &actions, nullptr, words.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
    }
    closeFile(in[1]);
    closeFile(out[1]);
    closeFile(err[1]);
    input_ = in[0];
    output_ = out[0];
    errors_ = err[0];
    if (failed != 0) {
        closeFile(input_);
        closeFile(output_);
        closeFile(errors_);
        throw Error(std::string("cannot be started: ") + std::strerror(failed), arguments[0]);
    }
    fcntl(errors_, F_SETFL, fcntl(errors_, F_GETFL) | O_NONBLOCK);
}

ChildProcess::~ChildProcess() {
    closeFile(input_);
    closeFile(output_);
    closeFile(errors_);
    if (pid_ < 0) return;
    kill(pid_, SIGKILL);
    int status = 0;
    while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
}

void ChildProcess::write(const std::string& text) {
    std::size_t done = 0;
    while (done < text.size()) {
        const ssize_t wrote = send(input_, text.data() + done, text.size() - done, MSG_NOSIGNAL);
        if (wrote < 0 && errno == EINTR) continue;
        if (wrote <= 0) return;
        done += static_cast<std::size_t>(wrote);
    }
}

void ChildProcess::readErrors() {
    char buffer[4096];
    ssize_t got = 0;
    while (errors_ >= 0 && (got = ::read(errors_, buffer, sizeof buffer)) > 0) {
        tail_.append(buffer, static_cast<std::size_t>(got));
        if (tail_.size() > 2 * kKeptErrorBytes) tail_.erase(0, tail_.size() - kKeptErrorBytes);
    }
    if (got == 0) closeFile(errors_);
}

bool ChildProcess::read(std::span<std::byte> bytes, const std::function<void()>& waiting) {
    std::size_t done = 0;
    while (done < bytes.size()) {
        pollfd files[2] = {{output_, POLLIN, 0}, {errors_, POLLIN, 0}};
        const int ready = poll(files, errors_ >= 0 ? 2 : 1, kPollMilliseconds);
        if (ready < 0 && errno != EINTR) return false;
        if (ready <= 0) {
            if (waiting) waiting();
            continue;
        }
        if (errors_ >= 0 && files[1].revents != 0) readErrors();
        if (files[0].revents == 0) continue;
        const ssize_t got = ::read(output_, bytes.data() + done, bytes.size() - done);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        done += static_cast<std::size_t>(got);
    }
    return true;
}

std::string ChildProcess::ending() {
    if (pid_ < 0) return ended_;
    closeFile(input_);
    int status = 0;
    bool killed = false;
    for (int tries = 0;; ++tries) {
        readErrors();
        const pid_t reaped = waitpid(pid_, &status, WNOHANG);
        if (reaped == pid_ || (reaped < 0 && errno != EINTR)) break;
        if (tries == 100) {
            kill(pid_, SIGKILL);
            killed = true;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    readErrors();
    pid_ = -1;
    const std::string line = lastLine(tail_);
    if (killed)
        ended_ = "stopped answering";
    else if (WIFSIGNALED(status)) {
        const int signal = WTERMSIG(status);
        interrupted_ = signal == SIGINT || signal == SIGTERM;
        ended_ = signal == SIGXCPU ? "used too much processor time" : "crashed (signal " + std::to_string(signal) + ")";
    } else if (WEXITSTATUS(status) != 0)
        ended_ = "ended with status " + std::to_string(WEXITSTATUS(status));
    if (!ended_.empty() && !line.empty()) ended_ += ": " + line;
    return ended_;
}

} // namespace tessera::volume
