#include "volume/base/error.h"
#include "volume/field/mesh_origin.h"
#include "volume/import/files/stream.h"
#include "volume/import/import.h"
#include "volume/system/process.h"

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace tessera::volume {
namespace {

namespace fs = std::filesystem;

template <class T> void put(std::vector<std::byte>& bytes, T value) {
    const auto* from = reinterpret_cast<const std::byte*>(&value);
    bytes.insert(bytes.end(), from, from + sizeof value);
}

std::vector<std::byte> head(std::uint32_t magic, std::uint32_t kind, std::uint64_t length) {
    std::vector<std::byte> bytes;
    put(bytes, magic);
    put(bytes, kind);
    put(bytes, length);
    return bytes;
}

std::vector<std::byte> frame(ScalarType type, std::uint32_t mask, glm::ivec3 size, std::size_t samples) {
    std::vector<std::byte> bytes;
    put(bytes, static_cast<std::uint32_t>(type));
    put(bytes, mask);
    for (int axis = 0; axis < 3; ++axis) put(bytes, std::int32_t(size[axis]));
    bytes.resize(bytes.size() + samples, std::byte{1});
    return bytes;
}

const std::string kHeader = R"({"format":"vti","blocks":[{"name":"","mesh":false,"cellData":false,"dims":[2,1,3],
 "spacing":[1,1,1],"origin":[0,0,0],"times":[0.5],"arrays":[{"name":"T","unit":"K","components":1,"type":"float32"}]}]})";

TEST(Stream, HeadsOfImpossibleMessagesAreRefused) {
    Lattice lattice;
    lattice.size = {2, 3, 4};
    EXPECT_EQ(parseMessageHead(head(kStreamMagic, 2, 20 + 96), lattice, ScalarType::F32).length, 116u);
    EXPECT_EQ(parseMessageHead(head(kStreamMagic, 2, 20 + 120), lattice, ScalarType::F32).length, 140u);
    EXPECT_EQ(parseMessageHead(head(kStreamMagic, 1, 5), lattice, ScalarType::F32).kind, MessageKind::Header);
    for (const auto& bad :
         {head(kStreamMagic + 1, 1, 5), head(kStreamMagic, 0, 5), head(kStreamMagic, 4, 5), head(kStreamMagic, 2, 115),
          head(kStreamMagic, 2, 0), head(kStreamMagic, 1, ~0ull), head(kStreamMagic, 3, kMostTextBytes + 1)})
        EXPECT_THROW(parseMessageHead(bad, lattice, ScalarType::F32), Error);
    std::vector<std::byte> cut = head(kStreamMagic, 1, 5);
    cut.pop_back();
    EXPECT_THROW(parseMessageHead(cut, lattice, ScalarType::F32), Error);
}

TEST(Stream, FramesOfAnotherFormAreRefused) {
    Lattice lattice;
    lattice.size = {2, 3, 1};
    EXPECT_EQ(parseFrame(frame(ScalarType::U8, 0, {2, 3, 1}, 6), lattice, ScalarType::U8).mask, nullptr);
    EXPECT_NE(parseFrame(frame(ScalarType::U8, 1, {2, 3, 1}, 12), lattice, ScalarType::U8).mask, nullptr);
    for (const auto& bad :
         {frame(ScalarType::U8, 0, {2, 3, 1}, 5), frame(ScalarType::U8, 0, {2, 3, 1}, 7),
          frame(ScalarType::U8, 1, {2, 3, 1}, 6), frame(ScalarType::U8, 2, {2, 3, 1}, 12),
          frame(ScalarType::I16, 0, {2, 3, 1}, 6), frame(ScalarType::U8, 0, {3, 2, 1}, 6), std::vector<std::byte>(3)})
        EXPECT_THROW(parseFrame(bad, lattice, ScalarType::U8), Error);
}

TEST(Stream, HeadersOutOfFormAreRefused) {
    ASSERT_EQ(parseStreamHeader(kHeader, "a").size(), 1u);
    EXPECT_EQ(parseStreamHeader(kHeader, "a")[0].arrays[0].unit, "K");
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string text = kHeader;
        const std::size_t at = text.find(from);
        text.replace(at, from.size(), to);
        return text;
    };
    for (const std::string& bad :
         {std::string(), std::string("{}"), std::string("[]"), kHeader.substr(0, 100), with("[2,1,3]", "[2,1]"),
          with("[2,1,3]", "[2,1,-3]"), with("[2,1,3]", "[1e9,1e9,1e9]"), with("[2,1,3]", "[2,1,1.5]"),
          with("float32", "float64"), with("\"components\":1", "\"components\":2"), with("[0.5]", "[1,1]"),
          with("[0.5]", "[\"x\"]"), with("\"T\"", "\"\""), with("[1,1,1]", "[0,1,1]"), with("false", "3")})
        EXPECT_THROW(parseStreamHeader(bad, "a"), Error) << bad;
}

TEST(Stream, HeadersThatAreNoObjectAreCalledSo) {
    for (const char* bad : {"", "{", "[]", "3", "null"}) try {
            parseStreamHeader(bad, "a");
            ADD_FAILURE() << bad;
        } catch (const Error& error) {
            EXPECT_STREQ(error.what(), "a: its answer is not JSON") << bad;
        }
}

TEST(ChildProcess, SaysHowItEnded) {
    const auto run = [](const std::string& script) {
        ChildProcess child({"/bin/sh", "-c", script});
        std::byte bytes[4];
        EXPECT_FALSE(child.read(bytes, {}));
        return child.ending();
    };
    EXPECT_EQ(run("exit 0"), "");
    EXPECT_EQ(run("echo one >&2; echo two >&2; exit 3"), "ended with status 3: two");
    EXPECT_EQ(run("kill -SEGV $$"), "crashed (signal 11)");
    EXPECT_EQ(run("head -c 1000000 /dev/zero | tr '\\0' 'x' >&2; echo >&2; echo last >&2; exit 1"),
              "ended with status 1: last");
    EXPECT_THROW(ChildProcess({"/no/such/program"}), Error);
}

TEST(ChildProcess, IsStoppedWhileItHangs) {
    ChildProcess child({"/bin/sh", "-c", "exec sleep 1000"});
    std::byte bytes[4];
    int waited = 0;
    EXPECT_THROW(child.read(bytes,
                            [&] {
                                if (++waited == 2) throw Cancelled();
                            }),
                 Cancelled);
}

/// A tessera-import that is a shell script.
class FakeImporter : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("tessera_fake_" + std::to_string(getpid()));
        fs::create_directories(folder_);
        std::ofstream(folder_ / "a.vti") << "x";
        if (const char* named = std::getenv("TESSERA_IMPORT")) before_ = named;
    }
    void TearDown() override {
        fs::remove_all(folder_);
        if (before_.empty())
            unsetenv("TESSERA_IMPORT");
        else
            setenv("TESSERA_IMPORT", before_.c_str(), 1);
    }
    void use(const std::string& script) const {
        const fs::path program = folder_ / "importer";
        std::ofstream(program) << "#!/bin/sh\n" << script << "\n";
        fs::permissions(program, fs::perms::owner_all);
        setenv("TESSERA_IMPORT", program.c_str(), 1);
    }
    /// Shell words that send a message.
    static std::string message(std::uint32_t kind, const std::string& text) {
        std::string words = "printf '";
        for (const std::byte byte : head(kStreamMagic, kind, text.size())) {
            char octal[8];
            std::snprintf(octal, sizeof octal, "\\%03o", unsigned(byte));
            words += octal;
        }
        return words + "'; printf '%s' '" + text + "'\n";
    }
    std::string failure(const Progress& progress = {}) const {
        try {
            Dataset dataset = openFiles({(folder_ / "a.vti").string()}, {}, progress);
            dataset.read(0, 0, 0);
            return "";
        } catch (const Error& error) {
            return error.what();
        }
    }
    fs::path folder_;
    std::string before_;
};

TEST_F(FakeImporter, FailuresCostOneLine) {
    use("exit 7");
    EXPECT_THAT(failure(),
                testing::EndsWith("a.vti: the reader of this file (tessera-import) failed: it ended with status 7"));
    use("echo broken pipe of gas >&2; kill -SEGV $$");
    EXPECT_THAT(failure(), testing::EndsWith("failed: it crashed (signal 11): broken pipe of gas"));
    use("head -c 4000 /dev/urandom");
    EXPECT_THAT(failure(), testing::HasSubstr("its answer is no message"));
    use("printf 'TSI1'");
    EXPECT_THAT(failure(), testing::HasSubstr("ended early"));
    use(message(3, "is damaged"));
    EXPECT_THAT(failure(), testing::EndsWith("a.vti: is damaged"));
    // Also what it said last stands in the line.
    use("echo a spacing of 0 >&2; " + message(1, "{}") + "exit 5");
    EXPECT_THAT(failure(),
                testing::EndsWith("a.vti: the reader of this file (tessera-import) failed: blocks: is missing "
                                  "in its answer, or cannot be used; it ended with status 5: a spacing of 0"));
    use(message(1, R"({"format":"vti","blocks":[]})"));
    EXPECT_THAT(failure(), testing::HasSubstr("holds no data"));
    use(message(1, kHeader) + "exit 0");
    EXPECT_THAT(failure(), testing::HasSubstr("ended early"));
    use(message(1, kHeader) + "read line; " + message(3, "no such array"));
    EXPECT_THAT(failure(), testing::EndsWith("no such array"));
    use(message(1, kHeader) + "read line; " + message(2, std::string(44, 'x')));
    EXPECT_THAT(failure(), testing::HasSubstr("another layout"));
    setenv("TESSERA_IMPORT", "/no/such/program", 1);
    EXPECT_THAT(failure(), testing::HasSubstr("cannot be started"));
}

TEST_F(FakeImporter, ScatteredPointsAreNamedAsTheOrigin) {
    const auto provenance = [&](const std::string& note) {
        std::string header = kHeader;
        header.insert(header.find("\"mesh\""), "\"notes\":[\"" + note + "\"],");
        use(message(1, header) + "sleep 1000");
        return previewFiles({(folder_ / "a.vti").string()}, {}).info.provenance;
    };
    EXPECT_EQ(provenance("scattered points: the nearest one counts"), kFromPoints);
    EXPECT_EQ(provenance("something else"), "");
}

TEST_F(FakeImporter, HangsAreCancelled) {
    use("exec sleep 1000");
    std::stop_source stop;
    int reports = 0;
    Progress progress{[&](double, const std::string&) {
                          if (++reports == 3) stop.request_stop();
                      },
                      stop.get_token()};
    EXPECT_THROW(failure(progress), Cancelled);
    // As Ctrl-C does to the whole group. A program that a shell put into the background ignores it, and so do those
    // that it starts: here it counts.
    const auto before = std::signal(SIGINT, SIG_DFL);
    use("kill -INT $$");
    EXPECT_THROW(failure(), Cancelled);
    std::signal(SIGINT, before);
}

} // namespace
} // namespace tessera::volume
