#include "codec/remote/connection.h"
#include "tests/codec/fake_ssh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <initializer_list>

/// What a connection by ssh makes of the answers of a server.
namespace tessera::codec {
namespace {

std::string number32(std::uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
    return bytes;
}

std::string text(const std::string& bytes) {
    return number32(static_cast<std::uint32_t>(bytes.size())) + bytes;
}

std::string message(int kind, std::initializer_list<std::string> parts) {
    std::string bytes(1, static_cast<char>(kind));
    for (const std::string& part : parts) bytes += part;
    return text(bytes);
}

constexpr std::uint32_t kPiece = 1 << 15; ///< what a connection asks for at a time

/// The begin of every conversation: version 3, the handle of a file, its size.
std::string opened(std::uint32_t size) {
    return message(2, {number32(3)}) + message(102, {number32(0), text("handle")}) +
           message(105, {number32(0), number32(1), number32(0), number32(size)});
}

std::string data(std::uint32_t request, const std::string& bytes) {
    return message(103, {number32(request), text(bytes)});
}

Reply replyTo(const std::string& answers, std::uint32_t bytes) {
    const test::FakeSsh ssh;
    ssh.answer(std::as_bytes(std::span(answers)));
    return connectSsh(parseAddress("sftp://host/run.tsr"))->read({0, bytes}, {});
}

/// The reason why answers are not taken.
std::string refusal(const std::string& answers, std::uint32_t bytes) {
    try {
        replyTo(answers, bytes);
    } catch (const Error& error) {
        return error.what();
    }
    return "taken";
}

std::string asText(const Reply& reply) {
    return {reinterpret_cast<const char*>(reply.bytes.data()), reply.bytes.size()};
}

TEST(SftpAnswers, ComeInAnyOrderAndInParts) {
    const std::string first(kPiece, 'a'), second = "bbbcc";
    const Reply reply = replyTo(opened(kPiece + 5) + data(1, "bbb") + data(0, first) + data(2, "cc"), kPiece + 5);
    EXPECT_EQ(reply.fileBytes, kPiece + 5);
    EXPECT_EQ(asText(reply), first + second);
}

// Else the last piece would never have been asked for, and its bytes would be zero.
TEST(SftpAnswers, OfOnePieceTwiceAreRefused) {
    const std::string piece(kPiece, 'a');
    EXPECT_THAT(refusal(opened(2 * kPiece) + data(0, piece) + data(0, piece), 2 * kPiece),
                ::testing::HasSubstr("breaks the protocol"));
}

TEST(SftpAnswers, LongerThanAskedForOrOfRequestsNeverSentAreRefused) {
    for (const std::string& wrong : {data(0, "abcdef"), data(1, "abcde"), data(0, "")})
        EXPECT_THAT(refusal(opened(5) + wrong, 5), ::testing::HasSubstr("breaks the protocol"));
}

} // namespace
} // namespace tessera::codec
