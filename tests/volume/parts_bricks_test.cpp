#include "volume/bricks/parts_bricks.h"

#include <gtest/gtest.h>

namespace tessera::volume {
namespace {

Parameter madeParameter(std::string name, bool categorical = false) {
    Parameter parameter;
    parameter.name = std::move(name);
    parameter.categorical = categorical;
    return parameter;
}

TEST(PartsBricks, TheLabelOfAParameterIsFoundByName) {
    DatasetInfo info;
    info.parameters = {madeParameter("U"), madeParameter("region", true), madeParameter("p")};
    info.parameters[0].components = 3;
    EXPECT_FALSE(labelChannel(info, info.parameters[2])) << "one part needs no label";
    info.parameters[2].parts = {"region", {{1}, {3}}};
    ASSERT_TRUE(labelChannel(info, info.parameters[2]));
    EXPECT_EQ(*labelChannel(info, info.parameters[2]), 4) << "x, y, z and magnitude of U come first";
    info.parameters[2].parts.label = "zone";
    EXPECT_FALSE(labelChannel(info, info.parameters[2]));
    info.parameters[2].parts.label = "U";
    EXPECT_FALSE(labelChannel(info, info.parameters[2])) << "a label is categorical";
}

TEST(PartsBricks, SamplesOfOtherPartsAreAbsent) {
    const Parts parts{"region", {{1}, {3, 4}}};
    const BrickSamples labels{{5, 1, 1}, {1, 3, 4, 7, 3}, {1, 1, 1, 1, 0}};
    EXPECT_EQ(partsOfSamples(labels, parts), (std::vector<std::uint8_t>{0, 1, 1, 0, 0}));
    const BrickSamples values{{5, 1, 1}, {10, 11, 12, 13, 14}, {1, 0, 1, 1, 1}};
    EXPECT_EQ(onlyPart(values, labels, parts, 0).present, (std::vector<std::uint8_t>{1, 0, 0, 1, 1}));
    EXPECT_EQ(onlyPart(values, labels, parts, 1).present, (std::vector<std::uint8_t>{0, 0, 1, 0, 0}));
    EXPECT_EQ(onlyPart(values, labels, parts, 1).values, values.values);
    const BrickSamples alike{{2, 1, 1}, {3, 4}, {}};
    EXPECT_TRUE(onlyPart({{2, 1, 1}, {1, 2}, {}}, alike, parts, 1).present.empty()) << "none became absent";
}

} // namespace
} // namespace tessera::volume
