#include "app/described/describe_cli.h"

#include "app/session/session.h"
#include "codec/pack/pack.h"

#include <gtest/gtest.h>

namespace tessera::app {
namespace {

codec::PackOptions parsed(const std::string& line) {
    codec::PackOptions options;
    CLI::App app;
    addDescribed(app, options);
    app.parse(line);
    return options;
}

TEST(DescribeCli, WhatIsStatedOverridesAPresetWhereverItStands) {
    EXPECT_EQ(parsed("--preset visual"), codec::PackOptions::preset("visual"));
    for (const char* line : {"--preset lossless --lattice bcc", "--lattice bcc --preset lossless"})
        EXPECT_EQ(parsed(line).lattice, codec::StoredLattice::BCC) << line;
    const codec::PackOptions options =
        parsed("--max-error 0 --brick-size 0 --no-threshold.by-importance --preset thesis");
    codec::PackOptions wanted = *codec::PackOptions::preset("thesis");
    wanted.brickSize = 0;
    wanted.threshold.byImportance = false;
    EXPECT_EQ(options, wanted);
    EXPECT_THROW(parsed("--preset best"), CLI::ValidationError);
}

TEST(DescribeCli, JsonMeansTheSame) {
    const auto read = [](const char* text) {
        DataRef data;
        std::vector<JsonIssue> issues;
        fromJson(data, parseJson(text, "test"), issues);
        EXPECT_TRUE(issues.empty()) << text;
        return data.packed;
    };
    EXPECT_EQ(read(R"({"packed": "visual"})"), codec::PackOptions::preset("visual"));
    EXPECT_EQ(read(R"({"packed": {"lattice": "bcc", "preset": "lossless"}})")->lattice, codec::StoredLattice::BCC);
    EXPECT_EQ(read(R"({"packed": {"preset": "small"}})")->zstdLevel, 19);
    EXPECT_EQ(read(R"({"packed": {"preset": "none", "maxError": 0.5}})")->maxError, 0.5);
}

} // namespace
} // namespace tessera::app
