#include "vis/bricks/channel_load.h"

#include "tests/vis/function_source.h"
#include "volume/base/error.h"
#include "volume/system/file_bytes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <memory>
#include <string>

namespace tessera::vis {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Waves of which no brick can be read.
class Unread final : public FunctionSource {
public:
    explicit Unread(bool damaged)
        : FunctionSource(volume::LatticeKind::CC, {20, 20, 20}, glm::dvec3(1),
                         {{"v", [](glm::dvec3 p) { return 0.5 + 0.01 * p.x; }}}),
          damaged_(damaged) {}
    volume::BrickStats stats(const volume::BrickKey&) const override { return {0, 1, 1}; }
    volume::BrickSamples read(const volume::BrickKey&) const override {
        if (damaged_) throw Error("damaged", "a.tsr");
        throw ReadError("no answer", "http://there/a.tsr");
    }

private:
    bool damaged_;
};

struct Outcome {
    LoadedTexels texels;
    std::vector<std::string> messages;
};

Outcome outcomeOf(bool damaged) {
    LoadExchange exchange;
    exchange.source = std::make_shared<const Unread>(damaged);
    exchange.bricks = std::make_unique<volume::BrickCache>(exchange.source, 1 << 20);
    loadTexels(exchange, {.key = {}, .level = 0, .brick = glm::ivec3(0), .summary = nullptr, .encoding = {}}, {});
    return {std::move(exchange.loaded.at(0)), exchange.messages};
}

TEST(ChannelLoad, ADamagedBrickIsDrawnAsAbsent) {
    const Outcome outcome = outcomeOf(true);
    EXPECT_FALSE(outcome.texels.failed);
    EXPECT_TRUE(outcome.texels.damaged);
    EXPECT_THAT(outcome.messages, ElementsAre(HasSubstr("a brick cannot be read and is not drawn: a.tsr: damaged")));
}

// Labels keep their numbers: they are neither filtered nor scaled by a range that is not theirs.
TEST(ChannelLoad, LabelsAreReadAsSuchInAnyParameter) {
    LoadExchange exchange;
    const auto label = [](glm::dvec3 p) -> std::optional<double> { return p.x < 9.5 ? 3 : 7; };
    const auto value = [](glm::dvec3 p) -> std::optional<double> { return 0.3 + 0.01 * p.x; };
    exchange.source = std::make_shared<const FunctionSource>(
        volume::LatticeKind::CC, glm::ivec3(20), glm::dvec3(1),
        std::vector<FunctionSource::Channel>{{"v", value, {0, 1}}, {"label", label, {0, 9}, true}});
    exchange.bricks = std::make_unique<volume::BrickCache>(exchange.source, 1 << 20);
    for (const int channel : {0, 1})
        loadTexels(
            exchange,
            {.key = {.channel = channel}, .level = 0, .brick = glm::ivec3(0), .summary = nullptr, .encoding = {}}, {});
    const ChannelStats stats{.min = 3, .max = 7};
    const LoadedTexels &values = exchange.loaded.at(0), &labels = exchange.loaded.at(1);
    EXPECT_EQ(labels.encoding, makeEncoding(stats, true, false, labels.key.prefilter));
    EXPECT_NE(labels.encoding, makeEncoding(stats, false, false, labels.key.prefilter));
    EXPECT_EQ(values.encoding, makeEncoding(values.summary->all, false, false, values.key.prefilter));
    EXPECT_NE(values.encoding, makeEncoding(values.summary->all, true, false, values.key.prefilter));
}

// Samples that were corrected for pictures lie beyond the range of the data: texels have room for them and for the
// overshoot of the prefilter, alike at all times.
TEST(ChannelLoad, CorrectedSamplesHaveRoomAlikeAtAllTimes) {
    const Range all{10, 20};
    const ChannelStats within = commonStats({.min = 11, .max = 19}, all);
    EXPECT_EQ(within.min, 10);
    EXPECT_EQ(within.max, 20);
    for (const auto& [lo, hi] : {std::pair{7.5, 22.5}, std::pair{9.0, 15.0}, std::pair{10.0, 20.5}}) {
        const ChannelStats common = commonStats({.min = lo, .max = hi}, all);
        EXPECT_EQ(common.min, 7.5);
        EXPECT_EQ(common.max, 22.5);
        const TexelEncoding encoding = makeEncoding(common, false, false, volume::Prefilter::Linear);
        const double overshoot = 2.0 / 3 * 15; // of samples of the whole range
        EXPECT_LE(encoding.offset, 7.5 - overshoot + 1e-9);
        EXPECT_GE(encoding.offset + encoding.scale, 22.5 + overshoot - 1e-9);
    }
    const ChannelStats far = commonStats({.min = 6, .max = 20}, all);
    EXPECT_EQ(far.min, 6);
    EXPECT_EQ(far.max, 20);
}

// A network that fails makes no holes: what is drawn stays.
TEST(ChannelLoad, ABrickThatCannotBeReadNowStaysCoarser) {
    const Outcome outcome = outcomeOf(false);
    EXPECT_TRUE(outcome.texels.failed);
    EXPECT_FALSE(outcome.texels.damaged);
    EXPECT_THAT(outcome.messages, ElementsAre("v is drawn coarser until the view changes, since a part cannot be read: "
                                              "http://there/a.tsr: no answer"));
}

} // namespace
} // namespace tessera::vis
