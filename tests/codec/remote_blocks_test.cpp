#include "codec/remote/address.h"
#include "codec/remote/block_cache.h"
#include "codec/remote/block_runs.h"
#include "volume/base/error.h"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <string>
#include <thread>
#include <unistd.h>
#include <vector>

namespace tessera::codec {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

using Runs = std::vector<BlockRun>;

TEST(BlockRuns, NeighboursShareARequest) {
    EXPECT_EQ(blockRuns({}, 1, 16), Runs{});
    EXPECT_EQ(blockRuns({7}, 1, 16), (Runs{{7, 1}}));
    EXPECT_EQ(blockRuns({4, 2, 3, 3}, 0, 16), (Runs{{2, 3}}));
    EXPECT_EQ(blockRuns({2, 4, 7}, 0, 16), (Runs{{2, 1}, {4, 1}, {7, 1}}));
    EXPECT_EQ(blockRuns({2, 4, 7}, 1, 16), (Runs{{2, 3}, {7, 1}})); // block 3 comes along, 5 and 6 do not
    EXPECT_EQ(blockRuns({0, 1, 2, 3, 4}, 1, 2), (Runs{{0, 2}, {2, 2}, {4, 1}}));
    EXPECT_EQ(blockRuns({0, 2}, 1, 2), (Runs{{0, 1}, {2, 1}})); // together they would be too long
}

TEST(Addresses, AreTakenApart) {
    const Address web = parseAddress("HTTPS://data.example.org:8443/runs/a%20b.tsr?key=1");
    EXPECT_EQ(web.scheme, Address::Scheme::Https);
    EXPECT_EQ(web.host, "data.example.org");
    EXPECT_EQ(web.port, "8443");
    EXPECT_EQ(web.text, "HTTPS://data.example.org:8443/runs/a%20b.tsr?key=1");
    const Address ssh = parseAddress("sftp://me@cluster/scratch/a%20b%zz.tsr");
    EXPECT_EQ(ssh.scheme, Address::Scheme::Sftp);
    EXPECT_EQ(ssh.user, "me");
    EXPECT_EQ(ssh.port, "");
    EXPECT_EQ(ssh.path, "/scratch/a b%zz.tsr");
    EXPECT_EQ(parseAddress("http://[::1]:80/a").host, "::1");
    EXPECT_EQ(parseAddress("http://[::1]/a").port, "");
}

std::string refusal(const std::string& text) {
    try {
        parseAddress(text);
    } catch (const Error& error) {
        return error.what();
    }
    return "accepted";
}

TEST(Addresses, ThatCannotBeOpenedAreRefused) {
    EXPECT_THAT(refusal("ftp://a/b"), HasSubstr("not an address"));
    EXPECT_THAT(refusal("http://host"), HasSubstr("names no file"));
    EXPECT_THAT(refusal("http://host/"), HasSubstr("names no file"));
    EXPECT_THAT(refusal("http:///a"), HasSubstr("no valid host"));
    EXPECT_THAT(refusal("http://host:8x/a"), HasSubstr("port"));
    EXPECT_THAT(refusal("sftp://-oProxyCommand=x/a"), HasSubstr("no valid host"));
    EXPECT_THAT(refusal("sftp://-oX@host/a"), HasSubstr("the user of the address"));
    const std::string said = refusal("https://me:secret@host/a.tsr");
    EXPECT_THAT(said, HasSubstr("~/.netrc"));
    EXPECT_THAT(said, ::testing::Not(HasSubstr("secret"))); // neither shown nor logged
}

TEST(Addresses, AreTakenForArchives) {
    EXPECT_TRUE(isRemote("Http://a/b"));
    EXPECT_FALSE(isRemote("http:/a/b"));
    EXPECT_FALSE(isRemote("/data/http://a"));
    EXPECT_TRUE(namesArchive("run.TSR"));
    EXPECT_TRUE(namesArchive("https://a/b.tsr?token=1"));
    EXPECT_FALSE(namesArchive("tsr"));
    EXPECT_FALSE(namesArchive("run.vti"));
}

class BlockCacheTest : public ::testing::Test {
protected:
    const std::string folder = ::testing::TempDir() + "tessera_blocks_" + std::to_string(::getpid());
    void SetUp() override { fs::create_directories(folder); }
    void TearDown() override { fs::remove_all(folder); }

    static std::vector<std::byte> block(int value, std::size_t bytes = 1000) {
        return std::vector<std::byte>(bytes, static_cast<std::byte>(value));
    }
    std::uintmax_t bytesKept() const {
        std::uintmax_t sum = 0;
        for (const auto& entry : fs::recursive_directory_iterator(folder))
            if (entry.is_regular_file()) sum += entry.file_size();
        return sum;
    }
    static bool holds(const BlockCache& cache, std::uint64_t number, int value) {
        std::vector<std::byte> read(1000);
        return cache.read(number, read) && read == block(value);
    }
    /// Makes a block as old as this.
    void use(const std::string& name, int number, int minutesAgo) const {
        fs::last_write_time(folder + "/" + name + "/" + std::to_string(number),
                            fs::file_time_type::clock::now() - std::chrono::minutes(minutesAgo));
    }
};

TEST_F(BlockCacheTest, KeepsBlocksForTheNextRunAndOtherPrograms) {
    BlockCache first(folder, "a", 1 << 20);
    EXPECT_FALSE(holds(first, 3, 7));
    first.write(3, block(7));
    BlockCache second(folder, "a", 1 << 20), other(folder, "b", 1 << 20);
    EXPECT_TRUE(holds(second, 3, 7));
    EXPECT_TRUE(second.has(3, 1000));
    EXPECT_FALSE(holds(other, 3, 7)); // of another file
    fs::resize_file(folder + "/a/3", 999);
    EXPECT_FALSE(holds(second, 3, 7)); // cut off
    EXPECT_FALSE(second.has(3, 1000));
    second.write(3, block(8));
    EXPECT_TRUE(holds(first, 3, 8));
    other.write(3, block(9));
    second.clear();
    EXPECT_FALSE(holds(first, 3, 8));
    EXPECT_TRUE(holds(other, 3, 9));
}

TEST_F(BlockCacheTest, RemovesWhatWasUsedLeastRecently) {
    {
        BlockCache cache(folder, "a", 1 << 20), other(folder, "b", 1 << 20);
        for (int number = 0; number < 5; ++number) cache.write(std::uint64_t(number), block(number));
        other.write(0, block(9));
        for (int number = 0; number < 5; ++number) use("a", number, 10 + number);
        use("b", 0, 60);
        EXPECT_TRUE(holds(cache, 4, 4)); // used now, though it was written first
    }
    trimCache(folder, 3000);
    EXPECT_EQ(bytesKept(), 3000u);
    const BlockCache cache(folder, "a", 1 << 20);
    EXPECT_TRUE(holds(cache, 0, 0));
    EXPECT_TRUE(holds(cache, 1, 1));
    EXPECT_TRUE(holds(cache, 4, 4));
    EXPECT_FALSE(fs::exists(folder + "/b")); // its last block is gone
}

TEST_F(BlockCacheTest, StaysBelowItsLimitWhileTwoWrite) {
    constexpr std::uint64_t kLimit = 100'000;
    BlockCache one(folder, "a", kLimit), two(folder, "b", kLimit);
    std::uintmax_t most = 0;
    for (int number = 0; number < 400; ++number) {
        one.write(std::uint64_t(number), block(1));
        two.write(std::uint64_t(number), block(2));
        most = std::max(most, bytesKept());
    }
    EXPECT_LE(most, kLimit);
    EXPECT_GT(most, kLimit / 2);
    EXPECT_TRUE(holds(one, 399, 1));
    EXPECT_FALSE(holds(one, 0, 1));
}

TEST_F(BlockCacheTest, AGrownFileTakesOverWhatWasKeptOfIt) {
    BlockCache before(folder, "before", 1 << 20), after(folder, "after", 1 << 20);
    before.write(0, block(1));
    before.write(3, block(2));
    after.write(3, block(9)); // read anew: it is longer now
    after.takeOver("before");
    EXPECT_TRUE(holds(after, 0, 1));
    EXPECT_TRUE(holds(after, 3, 9));
    EXPECT_FALSE(before.has(0, block(1).size()));
    before.write(0, block(5)); // one that still shows the former state goes on
    EXPECT_TRUE(holds(before, 0, 5));
    after.takeOver("never there");
    after.takeOver("after");
    EXPECT_TRUE(holds(after, 0, 1));
}

TEST_F(BlockCacheTest, ASmallerLimitHoldsAtOnce) {
    BlockCache(folder, "a", 1 << 20).write(0, block(1));
    const BlockCache smaller(folder, "b", 500);
    EXPECT_EQ(bytesKept(), 0u);
}

TEST_F(BlockCacheTest, WithoutAFolderItLastsAsLongAsTheObject) {
    fs::path own;
    {
        BlockCache cache("", "a", 1 << 20);
        cache.write(0, block(5));
        EXPECT_TRUE(holds(cache, 0, 5));
    }
    EXPECT_EQ(bytesKept(), 0u);
}

TEST_F(BlockCacheTest, ADiskThatTakesNothingIsNoError) {
    BlockCache cache(folder + "/absent/deeper", "a", 1 << 20);
    cache.write(0, block(1));
    EXPECT_FALSE(holds(cache, 0, 1));
}

} // namespace
} // namespace tessera::codec
