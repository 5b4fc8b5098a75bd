#include "codec/bytes/lzma.h"
#include "codec/container/coded_numbers.h"
#include "codec/container/container.h"
#include "tests/codec/flow_cell.h"
#include "volume/base/error.h"

#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace tessera::codec {
namespace {

using namespace testing;
using volume::LabelNumbers;

/// Series that are constant, smooth, wild, and not finite; regions and borders that come and go.
volume::ComputedNumbers madeNumbers(int times) {
    volume::ComputedNumbers numbers = numbersOf(flowCell(3, 1));
    const volume::NumbersAtTime one = numbers.front();
    numbers.clear();
    std::mt19937_64 random(7);
    for (int t = 0; t < times; ++t) {
        volume::NumbersAtTime at = one;
        at.time = t / 3.0;
        for (LabelNumbers& of : at.labels)
            for (volume::Summary& summary : of.statistics.all) {
                summary.mean = std::exp(0.1 * t);
                summary.deviation = std::ldexp(double(random()), int(random() % 200) - 100);
                summary.min = t % 2 == 0 ? -std::numeric_limits<double>::infinity() : -0.5;
            }
        for (LabelNumbers& of : at.labels) of.statistics.all = at.labels.front().statistics.all;
        LabelNumbers& labelled = at.labels.back();
        labelled.statistics.samples.front() -= 1; // so they do not cover everything
        if (t % 3 == 1) {
            labelled.statistics.regions.pop_back();
            labelled.statistics.samples.pop_back();
            labelled.statistics.volume.pop_back();
            labelled.statistics.summary.pop_back();
            for (auto& balances : labelled.balances) balances.pop_back();
        }
        numbers.push_back(std::move(at));
    }
    return numbers;
}

TEST(CodedNumbers, AreCodedWhateverTheyAre) {
    for (const int times : {1, 2, 3, 40, 900}) {
        SCOPED_TRACE(times);
        const volume::ComputedNumbers numbers = madeNumbers(times);
        std::string shape, read;
        volume::ComputedNumbers back;
        const std::vector<Bytes> blocks = encodeNumbers(numbers, shape);
        EXPECT_EQ(blocks.size() > 1, times == 900) << "a block is small enough for LZMA";
        for (const Bytes& block : blocks) addNumbers(decodeNumbers(block, read), back);
        EXPECT_EQ(shape, read);
        ASSERT_NO_FATAL_FAILURE(expectSame(numbers, back));
        std::string again = shape;
        EXPECT_LT(encodeNumbers(numbers, again).front().size(), blocks.front().size()) << "the shape is known";
    }
}

TEST(CodedNumbers, DamagedBlocksAreRefused) {
    std::string shape;
    const Bytes block = encodeNumbers(madeNumbers(4), shape).front();
    const auto refused = [](const Bytes& bytes) {
        std::string before;
        try {
            (void)decodeNumbers(bytes, before);
            return false;
        } catch (const Error&) {
            return true;
        }
    };
    EXPECT_FALSE(refused(block));
    for (std::size_t length = 0; length < block.size(); ++length)
        ASSERT_TRUE(refused({block.begin(), block.begin() + std::ptrdiff_t(length)})) << length;
    for (std::size_t at = 0; at < block.size(); ++at) {
        Bytes flipped = block;
        flipped[at] ^= std::byte(0x10);
        ASSERT_TRUE(refused(flipped)) << at;
    }
    // With a checksum that fits: whatever it says, it is read or refused.
    Bytes content;
    ASSERT_EQ(decodeBlock(std::span(block).subspan(8), content), DecodeStatus::Ok);
    std::mt19937 random(5);
    int read = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        Bytes forged = content;
        for (int change = 1 + int(random() % 3); change-- > 0;)
            forged[random() % (trial % 2 == 0 ? 900 : forged.size())] = std::byte(random());
        if (trial % 7 == 0) forged.resize(random() % forged.size());
        ByteWriter out;
        const Bytes coded = encodeBlock(forged);
        out.put(checksum(coded));
        out.bytes.insert(out.bytes.end(), coded.begin(), coded.end());
        read += refused(out.bytes) ? 0 : 1;
    }
    EXPECT_GT(read, 0);
    EXPECT_LT(read, 3000);
}

TEST(CodedNumbers, FewBytesMayNotPromiseManyNumbers) {
    // A million times of zeros, and regions that fill the memory.
    const auto blockOf = [](const std::string& shape, std::uint32_t times, std::size_t series) {
        ByteWriter content;
        content.put(std::uint32_t(shape.size()));
        for (const char c : shape) content.put(std::uint8_t(c));
        content.put(times);
        for (std::uint32_t t = 0; t < times; ++t) content.put(double(t));
        for (std::size_t s = 0; s < series; ++s) content.put(std::uint8_t(0));
        const Bytes coded = encodeBlock(content.bytes);
        ByteWriter out;
        out.put(checksum(coded));
        out.bytes.insert(out.bytes.end(), coded.begin(), coded.end());
        return out.bytes;
    };
    std::string before;
    const std::string plain = R"({"labels":[{"label":"","channels":["a"]}]})";
    EXPECT_EQ(decodeNumbers(blockOf(plain, 3, 8), before).size(), 3u);
    EXPECT_THROW(decodeNumbers(blockOf(plain, 3, 9), before), Error);
    std::string channels = "\"a\"", regions = "0";
    for (int c = 0; c < 3000; ++c) channels += ",\"a\"";
    for (int r = 1; r < 9000; ++r) regions += "," + std::to_string(r);
    EXPECT_THROW(
        decodeNumbers(blockOf(R"({"labels":[{"label":"","channels":[)" + channels + "]}]}", 900, 18008), before),
        Error);
    EXPECT_THROW(
        decodeNumbers(blockOf(R"({"labels":[{"label":"","channels":[)" + channels + R"(]},{"label":"l","channels":[)" +
                                  channels + R"(],"regions":[)" + regions + "]}]}",
                              1, 9000),
                      before),
        Error);
}

} // namespace
} // namespace tessera::codec
