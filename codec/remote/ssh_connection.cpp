#include "codec/remote/connection.h"
#include "volume/system/process.h"

#include <algorithm>
#include <chrono>
#include <utility>

/// The protocol of sftp, version 3, as far as reading needs it (draft-ietf-secsh-filexfer-02).
namespace tessera::codec {

namespace {

constexpr std::uint32_t kVersion = 3, kReadFlag = 1, kLongestReply = 1 << 18;
constexpr std::uint32_t kHasSize = 1, kHasOwner = 2, kHasPermissions = 4, kHasTimes = 8;
constexpr std::uint32_t kEndOfFile = 1, kNoSuchFile = 2, kDenied = 3;
enum Kind : std::uint8_t {
    Init = 1,
    Version = 2,
    Open = 3,
    Close = 4,
    Read = 5,
    Fstat = 8,
    Status = 101,
    Handle = 102,
    Data = 103,
    Attributes = 105
};
constexpr std::uint64_t kPiece = 1 << 15; ///< bytes of a request that every server answers
constexpr std::size_t kUnderway = 64;     ///< requests sent ahead of their answers
constexpr auto kStalled = std::chrono::seconds(15);

/// A message without its length.
class Message {
public:
    explicit Message(Kind kind) { bytes_ += static_cast<char>(kind); }
    Message& number(std::uint32_t value) {
        for (int shift = 24; shift >= 0; shift -= 8) bytes_ += static_cast<char>(value >> shift);
        return *this;
    }
    Message& number64(std::uint64_t value) {
        return number(static_cast<std::uint32_t>(value >> 32)).number(static_cast<std::uint32_t>(value));
    }
    Message& text(const std::string& value) {
        number(static_cast<std::uint32_t>(value.size()));
        bytes_ += value;
        return *this;
    }
    std::string withLength() const {
        Message length(Init);
        return length.number(static_cast<std::uint32_t>(bytes_.size())).bytes_.substr(1) + bytes_;
    }

private:
    std::string bytes_;
};

/// A message from the server; `get` throws Error beyond its end.
class Answer3 {
public:
    Answer3(std::vector<std::byte> bytes, const std::string& address) : bytes_(std::move(bytes)), address_(address) {}
    std::span<const std::byte> take(std::size_t count) {
        if (count > bytes_.size() - at_) throw Error("the server breaks the protocol of sftp", address_);
        at_ += count;
        return std::span(bytes_).subspan(at_ - count, count);
    }
    std::uint8_t byte() { return static_cast<std::uint8_t>(take(1)[0]); }
    std::uint32_t number() {
        std::uint32_t value = 0;
        for (const std::byte byte : take(4)) value = value << 8 | static_cast<std::uint32_t>(byte);
        return value;
    }
    std::uint64_t number64() {
        const std::uint64_t high = number();
        return high << 32 | number();
    }
    std::span<const std::byte> text() { return take(number()); }

private:
    std::vector<std::byte> bytes_;
    std::size_t at_ = 0;
    const std::string& address_;
};

std::vector<std::string> sshCommand(const Address& address) {
    // BatchMode: no questions; an unknown host key or a missing key is an error.
    std::vector<std::string> words{"ssh",
                                   "-x",
                                   "-a",
                                   "-T",
                                   "-oBatchMode=yes",
                                   "-oConnectTimeout=10",
                                   "-oClearAllForwardings=yes",
                                   "-oServerAliveInterval=5",
                                   "-oServerAliveCountMax=3"};
    if (!address.port.empty()) words.insert(words.end(), {"-p", address.port});
    if (!address.user.empty()) words.insert(words.end(), {"-l", address.user});
    words.insert(words.end(), {"-s", address.host, "sftp"});
    return words;
}

class SshConnection final : public Connection {
public:
    explicit SshConnection(const Address& address) : address_(address), ssh_(sshCommand(address)) {}

    Reply read(FileRange range, const std::stop_token& stop) override {
        stop_ = &stop;
        if (stale_) close();
        if (handle_.empty()) open();
        Reply reply{{}, fileBytes_, state_};
        reply.bytes.resize(range.offset < fileBytes_ ? std::min(range.length, fileBytes_ - range.offset) : 0);
        std::vector<FileRange> wanted; // pieces of the reply; answers may come in any order
        for (std::uint64_t at = 0; at < reply.bytes.size(); at += kPiece)
            wanted.push_back({at, std::min<std::uint64_t>(kPiece, reply.bytes.size() - at)});
        std::size_t sent = 0, answered = 0;
        while (answered < wanted.size()) {
            for (; sent < wanted.size() && sent - answered < kUnderway; ++sent)
                send(Message(Read)
                         .number(static_cast<std::uint32_t>(sent))
                         .text(handle_)
                         .number64(range.offset + wanted[sent].offset)
                         .number(static_cast<std::uint32_t>(wanted[sent].length)));
            Answer3 answer = receive();
            const auto kind = answer.byte();
            const std::uint32_t number = answer.number();
            if (number >= sent) throw Error("the server breaks the protocol of sftp", address_.text);
            if (kind != Data) refuse(kind, answer);
            const auto bytes = answer.text();
            const FileRange piece = std::exchange(wanted[number], FileRange{}); // nothing is left for a second answer
            if (bytes.empty() || bytes.size() > piece.length)
                throw Error("the server breaks the protocol of sftp", address_.text);
            std::copy(bytes.begin(), bytes.end(), reply.bytes.begin() + std::ptrdiff_t(piece.offset));
            if (bytes.size() < piece.length) // the rest is asked for again
                wanted.push_back({piece.offset + bytes.size(), piece.length - bytes.size()});
            ++answered;
        }
        return reply;
    }

    void lookAgain() override { stale_ = true; }

private:
    void greet() {
        send(Message(Init).number(kVersion));
        if (Answer3 answer = receive(); answer.byte() != Version)
            throw Error("the server breaks the protocol of sftp", address_.text);
        greeted_ = true;
    }

    void close() {
        stale_ = false;
        if (handle_.empty()) return;
        send(Message(Close).number(0).text(std::exchange(handle_, {})));
        (void)expect(Status);
    }

    void open() {
        if (!greeted_) greet();
        const std::string path = address_.path.starts_with("/~/") ? address_.path.substr(3) : address_.path;
        send(Message(Open).number(0).text(path).number(kReadFlag).number(0));
        Answer3 opened = expect(Handle);
        const auto handle = opened.text();
        send(Message(Fstat).number(0).text({reinterpret_cast<const char*>(handle.data()), handle.size()}));
        Answer3 about = expect(Attributes);
        const std::uint32_t has = about.number();
        if ((has & kHasSize) == 0) throw Error("the server does not say how long the file is", address_.text);
        fileBytes_ = about.number64();
        if ((has & kHasOwner) != 0) about.take(8);
        if ((has & kHasPermissions) != 0) about.take(4);
        if ((has & kHasTimes) != 0) about.take(4), state_ = std::to_string(about.number());
        handle_.assign(reinterpret_cast<const char*>(handle.data()), handle.size());
    }

    void send(const Message& message) { ssh_.write(message.withLength()); }

    void fill(std::span<std::byte> bytes) {
        const auto begin = std::chrono::steady_clock::now();
        const bool read = ssh_.read(bytes, [&] {
            if (stop_->stop_requested()) throw Cancelled();
            if (std::chrono::steady_clock::now() - begin > kStalled) throw PassingError("no answer", address_.text);
        });
        if (!read) ended();
    }

    Answer3 receive() {
        std::vector<std::byte> length(4);
        fill(length);
        const std::uint32_t bytes = Answer3(length, address_.text).number();
        if (bytes == 0 || bytes > kLongestReply) throw Error("the server breaks the protocol of sftp", address_.text);
        std::vector<std::byte> message(bytes);
        fill(message);
        return {std::move(message), address_.text};
    }

    /// The answer to request 0.
    Answer3 expect(Kind wanted) {
        Answer3 answer = receive();
        const auto kind = answer.byte();
        (void)answer.number();
        if (kind != wanted) refuse(kind, answer);
        return answer;
    }

    [[noreturn]] void refuse(std::uint8_t kind, Answer3& answer) const {
        if (kind != Status) throw Error("the server breaks the protocol of sftp", address_.text);
        switch (const std::uint32_t code = answer.number()) {
        case kNoSuchFile:
            throw Error("no such file", address_.text);
        case kDenied:
            throw Error("access denied", address_.text);
        case kEndOfFile:
            throw Error("the file on the server is shorter than it was when it was opened", address_.text);
        default:
            throw Error("the server refuses (sftp status " + std::to_string(code) + ")", address_.text);
        }
    }

    /// ssh has ended: says why.
    [[noreturn]] void ended() {
        const std::string why = ssh_.ending();
        const auto says = [&](const char* words) { return why.find(words) != std::string::npos; };
        const std::string there = (address_.user.empty() ? "" : address_.user + "@") + address_.host,
                          command = "ssh " + (address_.port.empty() ? "" : "-p " + address_.port + " ") + there;
        if (says("Host key verification failed"))
            throw Error("the key of this machine is not known to ssh, or is not the known one: run \"" + command +
                            "\" in a terminal and compare the fingerprint",
                        address_.text);
        if (says("Permission denied"))
            throw Error("ssh is not let in without a question: load a key (ssh-add) or allow one there, until \"" +
                            command + "\" asks nothing (" + why + ")",
                        address_.text);
        if (says("subsystem request failed")) throw Error("the machine offers no sftp", address_.text);
        throw PassingError("ssh " + (why.empty() ? "ended" : why), address_.text);
    }

    Address address_;
    volume::ChildProcess ssh_;
    const std::stop_token* stop_ = nullptr;
    std::string handle_, state_;
    bool greeted_ = false, stale_ = false;
    std::uint64_t fileBytes_ = 0;
};

} // namespace

std::unique_ptr<Connection> connectSsh(const Address& address) {
    return std::make_unique<SshConnection>(address);
}

} // namespace tessera::codec
