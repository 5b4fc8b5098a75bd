#include "codec/remote/connection.h"
#include "codec/remote/consent.h"
#include "codec/remote/login.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <curl/curl.h>
#include <string_view>

namespace tessera::codec {

namespace {

constexpr long kConnectSeconds = 10, kStalledSeconds = 15;
constexpr long kLeastRate = 500; ///< bytes a second over kStalledSeconds; below, the request has failed
/// Bytes of an answer that are taken beyond those asked for: heads, and pages that only lead elsewhere.
constexpr std::size_t kMostHead = 1 << 18, kMostAside = 1 << 16;

/// One request: what the server says before and with the bytes.
struct Answer {
    FileRange range;
    const std::stop_token& stop;
    Reply reply;
    long status = 0;
    std::uint64_t announced = 0; ///< bytes of the body, if the server states them
    bool outside = false;        ///< the server sends other bytes than those asked for
    std::size_t headBytes = 0;   ///< of all answers up to the last
};

std::optional<std::uint64_t> numberOf(std::string_view text) {
    std::uint64_t number = 0;
    const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (failed != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

/// "bytes 0-159/4000", or "bytes */4000" if the range lies outside.
void takeContentRange(std::string_view value, Answer& answer) {
    constexpr std::string_view kUnit = "bytes ";
    const std::size_t slash = value.find('/'), dash = value.find('-');
    if (!value.starts_with(kUnit) || slash == std::string_view::npos) return;
    if (const auto total = numberOf(value.substr(slash + 1))) answer.reply.fileBytes = *total;
    if (dash >= slash) return;
    const auto first = numberOf(value.substr(kUnit.size(), dash - kUnit.size()));
    answer.outside = first != answer.range.offset;
}

std::size_t takeHeader(char* text, std::size_t, std::size_t bytes, void* user) {
    auto& answer = *static_cast<Answer*>(user);
    if ((answer.headBytes += bytes) > kMostHead) return 0; // ends the transfer
    std::string_view line(text, bytes);
    while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.remove_suffix(1);
    if (line.starts_with("HTTP/")) { // the first line, also of each answer that only leads to another address
        answer.reply = {};
        answer.announced = 0;
        answer.outside = false;
        const std::size_t blank = line.find(' ');
        answer.status = blank == std::string_view::npos ? 0 : long(numberOf(line.substr(blank + 1, 3)).value_or(0));
        return bytes;
    }
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) return bytes;
    std::string name(line.substr(0, colon));
    for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    line.remove_prefix(std::min(line.find_first_not_of(' ', colon + 1), line.size()));
    if (name == "content-range") takeContentRange(line, answer);
    if (name == "content-length") answer.announced = numberOf(line).value_or(0);
    if (name == "etag" || name == "last-modified") answer.reply.state += std::string(line) + "\n";
    return bytes;
}

std::size_t takeBody(char* text, std::size_t, std::size_t bytes, void* user) {
    auto& answer = *static_cast<Answer*>(user);
    if (answer.status >= 300) return 0; // a page that explains an error, of any length: ends the transfer
    const bool part = answer.status == 206 && !answer.outside;
    // A file that is shorter than the range may come as a whole.
    const bool whole = answer.status == 200 && answer.range.offset == 0 && answer.announced > 0 &&
                       answer.announced <= answer.range.length;
    auto& out = answer.reply.bytes;
    if ((!part && !whole) || out.size() + bytes > answer.range.length) return 0; // ends the transfer
    const auto* const from = reinterpret_cast<const std::byte*>(text);
    out.insert(out.end(), from, from + bytes);
    return bytes;
}

int goesOn(void* user, curl_off_t, curl_off_t received, curl_off_t, curl_off_t) {
    const auto& answer = *static_cast<Answer*>(user);
    return answer.stop.stop_requested() || std::uint64_t(received) > answer.range.length + kMostAside ? 1 : 0;
}

/// The address for libcurl, without the user, made of parts that were checked: it must not find another host in it.
std::string urlOf(const Address& address) {
    return machineOf(address) + address.text.substr(address.text.find('/', address.text.find("://") + 3));
}

class WebConnection final : public Connection {
public:
    explicit WebConnection(const Address& address) : address_(address.text) {
        static const CURLcode started = curl_global_init(CURL_GLOBAL_DEFAULT); // once, in whichever thread is first
        curl_ = started == CURLE_OK ? curl_easy_init() : nullptr;
        if (!curl_) throw MachineError("libcurl cannot be started", address_);
        set(CURLOPT_URL, urlOf(address).c_str());
        set(CURLOPT_PROTOCOLS_STR, "http,https");
        set(CURLOPT_REDIR_PROTOCOLS_STR, address.scheme == Address::Scheme::Https ? "https" : "http,https");
        set(CURLOPT_FOLLOWLOCATION, 1L);
        set(CURLOPT_MAXREDIRS, 8L);
        const std::optional<Login> login = storedLogin(address.host, address.user);
        if (const std::string& user = login ? login->user : address.user; !user.empty())
            set(CURLOPT_USERNAME, user.c_str());
        if (login) set(CURLOPT_PASSWORD, login->password.c_str()); // not sent to hosts that an answer leads to
        // Authorities that the system does not know, named as for the program curl.
        for (const char* const name : {"SSL_CERT_FILE", "CURL_CA_BUNDLE"})
            if (const char* const file = std::getenv(name); file && *file) set(CURLOPT_CAINFO, file);
        set(CURLOPT_NOSIGNAL, 1L);
        set(CURLOPT_CONNECTTIMEOUT, kConnectSeconds);
        set(CURLOPT_LOW_SPEED_LIMIT, kLeastRate);
        set(CURLOPT_LOW_SPEED_TIME, kStalledSeconds);
        set(CURLOPT_USERAGENT, "tessera");
        set(CURLOPT_ERRORBUFFER, problem_.data());
        set(CURLOPT_HEADERFUNCTION, takeHeader);
        set(CURLOPT_WRITEFUNCTION, takeBody);
        set(CURLOPT_XFERINFOFUNCTION, goesOn);
        set(CURLOPT_NOPROGRESS, 0L);
    }
    ~WebConnection() override { curl_easy_cleanup(curl_); }
    WebConnection(const WebConnection&) = delete;
    WebConnection& operator=(const WebConnection&) = delete;

    Reply read(FileRange range, const std::stop_token& stop) override {
        Answer answer{range, stop, {}, 0, 0, false, 0};
        const std::string wanted = std::to_string(range.offset) + "-" + std::to_string(range.offset + range.length - 1);
        set(CURLOPT_RANGE, wanted.c_str());
        set(CURLOPT_HEADERDATA, &answer);
        set(CURLOPT_WRITEDATA, &answer);
        set(CURLOPT_XFERINFODATA, &answer);
        problem_[0] = '\0';
        const CURLcode result = curl_easy_perform(curl_);
        if (stop.stop_requested()) throw Cancelled();
        refuse(answer, result);
        if (answer.status == 200) answer.reply.fileBytes = answer.reply.bytes.size();
        return std::move(answer.reply);
    }

private:
    template <class T> void set(CURLoption option, T value) { curl_easy_setopt(curl_, option, value); }

    /// Throws what is wrong with an answer.
    void refuse(const Answer& answer, CURLcode result) const {
        if (answer.headBytes > kMostHead || result == CURLE_ABORTED_BY_CALLBACK)
            throw Error("the server sends more than was asked for", address_);
        const std::string status = " (HTTP " + std::to_string(answer.status) + ")";
        if (answer.status == 401 || answer.status == 403 || answer.status == 407)
            throw Error("access denied" + status + "; passwords are read from ~/.netrc, from entries for the very host",
                        address_);
        if (answer.status == 404 || answer.status == 410) throw Error("no such file" + status, address_);
        if (answer.status == 408 || answer.status == 429 || answer.status >= 500)
            throw PassingError("the server cannot answer now" + status, address_);
        if (answer.status == 416)
            throw Error("the file on the server is shorter than it was when it was opened, or empty", address_);
        if (answer.status >= 300) throw Error("the server refuses" + status, address_);
        if (answer.outside) throw Error("the server sends another range than was asked for", address_);
        if (answer.status == 200 && (result == CURLE_WRITE_ERROR || answer.reply.bytes.empty()))
            throw Error("the server gives no ranges of files, only whole files: copy the archive and open the copy",
                        address_);
        if (result != CURLE_OK) {
            const std::string reason = problem_[0] ? problem_.data() : curl_easy_strerror(result);
            const bool lasting = result == CURLE_URL_MALFORMAT || result == CURLE_PEER_FAILED_VERIFICATION ||
                                 result == CURLE_UNSUPPORTED_PROTOCOL || result == CURLE_TOO_MANY_REDIRECTS ||
                                 result == CURLE_SSL_CACERT_BADFILE || result == CURLE_WRITE_ERROR;
            if (lasting) throw Error(reason, address_);
            throw PassingError(reason, address_);
        }
        if (answer.status == 206 && answer.reply.fileBytes == 0)
            throw Error("the server does not say how long the file is", address_);
    }

    std::string address_;
    CURL* curl_ = nullptr;
    std::array<char, CURL_ERROR_SIZE> problem_{};
};

} // namespace

std::unique_ptr<Connection> connectWeb(const Address& address) {
    return std::make_unique<WebConnection>(address);
}

} // namespace tessera::codec
