// What a web server answers when an archive is read from it: each connection gets the next part of the input. All
// addresses lead to this server, also those that an answer refers to, since it is the proxy.
#include "tests/codec/make_dataset.h"
#include "tests/fuzz/fuzz_remote.h"

#include <arpa/inet.h>
#include <mutex>
#include <string_view>
#include <sys/socket.h>
#include <thread>

namespace {

constexpr std::string_view kNext = "\n----\n"; ///< between the parts of the input

class Server {
public:
    Server() : listening_(::socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in place{};
        place.sin_family = AF_INET;
        place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof place;
        if (::bind(listening_, reinterpret_cast<sockaddr*>(&place), size) != 0 || ::listen(listening_, 8) != 0 ||
            ::getsockname(listening_, reinterpret_cast<sockaddr*>(&place), &size) != 0)
            std::abort();
        const std::string proxy = "http://127.0.0.1:" + std::to_string(ntohs(place.sin_port));
        for (const char* const name : {"http_proxy", "https_proxy"}) ::setenv(name, proxy.c_str(), 1);
        for (const char* const name : {"no_proxy", "NO_PROXY"}) ::unsetenv(name);
        std::thread([this] { serve(); }).detach();
    }

    void answer(std::string_view parts) {
        const std::lock_guard lock(mutex_);
        parts_ = parts;
    }

private:
    std::string next() {
        const std::lock_guard lock(mutex_);
        const std::size_t end = parts_.find(kNext);
        std::string part = parts_.substr(0, end);
        parts_ = end == std::string::npos ? std::string() : parts_.substr(end + kNext.size());
        return part;
    }

    void serve() {
        for (;;) {
            const int one = ::accept(listening_, nullptr, nullptr);
            if (one < 0) continue;
            std::string request(4096, '\0');
            (void)!::recv(one, request.data(), request.size(), 0);
            const std::string part = next();
            for (std::size_t at = 0; at < part.size();) {
                const ssize_t sent = ::send(one, part.data() + at, part.size() - at, MSG_NOSIGNAL);
                if (sent <= 0) break;
                at += std::size_t(sent);
            }
            ::close(one);
        }
    }

    int listening_;
    std::mutex mutex_;
    std::string parts_;
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const tessera::codec::testing::TemporaryFolder folder;
    static Server& server = *new Server; // its thread lasts as long as the process
    server.answer({reinterpret_cast<const char*>(data), size});
    tessera::fuzz::readRemote("http://fuzz/run.tsr", folder / "");
    return 0;
}
