#include "app/edits/label_names.h"

#include "app/session/label_colors.h"
#include "volume/field/labels.h"
#include "volume/flow/flow_channels.h"

#include <gtest/gtest.h>

namespace tessera::app {
namespace {

volume::Parameter region() {
    volume::Parameter label;
    label.name = "region";
    label.categorical = true;
    label.type = volume::ScalarType::U8;
    label.labels = {{0, "region 0"}, {1, "region 1"}, {3, "fuel", "#112233"}};
    label.ranges = {{0, 3}};
    return label;
}

glm::vec3 drawn(const Session& session, double value) {
    return glm::vec3(vis::evaluate(session.transfer.at("region"), {0, 3}, value));
}

void expectNear(glm::vec3 a, glm::vec3 b) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-6f);
}

TEST(LabelNames, AreStatedOneByOneAndColourThePicture) {
    Session session;
    const volume::Parameter label = region();
    stateLabel(session, label, {1, "cathode", ""});
    stateLabel(session, label, {0, "", "#e07b39"});
    stateLabel(session, label, {1, "air, side", ""}); // a rule holds no comma
    EXPECT_EQ(session.data.import.labels, (std::vector<std::string>{"region:0=#e07b39,1=air side"}));
    const std::vector<volume::Label> now = statedLabels(session, label);
    ASSERT_EQ(now.size(), 3u);
    EXPECT_EQ(now[0], (volume::Label{0, "region 0", "#e07b39"}));
    EXPECT_EQ(now[1], (volume::Label{1, "air side", ""}));
    EXPECT_EQ(now[2], label.labels[2]);
    expectNear(drawn(session, 0), *parsedColor("#e07b39"));
    expectNear(drawn(session, 1), labelColor(label, 1));
    expectNear(drawn(session, 3), *parsedColor("#112233"));
    stateLabel(session, label, {1, "", ""}); // says nothing
    EXPECT_EQ(session.data.import.labels.size(), 1u);
    EXPECT_EQ(statedLabels(session, label)[1].name, "air side");
}

TEST(LabelNames, AreTakenBackAsIfNeverStated) {
    Session session;
    volume::Parameter label = region();
    session.data.import.labels = {"other:1=x"};
    stateLabel(session, label, {1, "air", ""});
    stateLabel(session, label, {0, "land", "#e07b39"});
    toggleRegionBrush(session, label, 1);
    unstateLabelName(session, label, 1);
    EXPECT_EQ(session.data.import.labels, (std::vector<std::string>{"other:1=x", "region:0=land#e07b39"}));
    EXPECT_EQ(statedLabels(session, label)[1], label.labels[1]);
    EXPECT_EQ(session.selection.brushes[0].name, "region 1");
    unstateLabelName(session, label, 0);
    EXPECT_EQ(statedLabels(session, label)[0], (volume::Label{0, "region 0", "#e07b39"})) << "a colour stays";
    unstateLabelName(session, label, 3); // never stated
    EXPECT_EQ(session.data.import.labels, (std::vector<std::string>{"other:1=x", "region:0=#e07b39"}));
}

TEST(LabelNames, BrushesHoldARegionAndAreCalledLikeIt) {
    Session session;
    const volume::Parameter label = region();
    stateLabel(session, label, {1, "cathode", "#e07b39"});
    toggleRegionBrush(session, label, 1);
    toggleRegionBrush(session, label, 3);
    ASSERT_EQ(session.selection.brushes.size(), 2u);
    EXPECT_EQ(session.selection.brushes[0].name, "cathode");
    EXPECT_EQ(session.selection.brushes[1].name, "fuel");
    expectNear(session.selection.brushes[0].color, *parsedColor("#e07b39"));
    const auto interest = [&](double value) {
        return vis::degreeOfInterest(session.selection, [&](const std::string&) { return value; });
    };
    EXPECT_EQ(interest(0), 0);
    EXPECT_EQ(interest(1), 1); // both together
    EXPECT_EQ(interest(2), 0);
    EXPECT_EQ(interest(3), 1);
    for (const double between : {0.5, 1.5, 2.5, 3.5}) EXPECT_EQ(interest(between), 0) << "in pictures, of no region";
    EXPECT_TRUE(regionBrushed(session, label, 1));
    EXPECT_FALSE(regionBrushed(session, label, 0));
    stateLabel(session, label, {3, "anode", ""});
    EXPECT_EQ(session.selection.brushes[1].name, "anode");
    toggleRegionBrush(session, label, 1);
    ASSERT_EQ(session.selection.brushes.size(), 1u);
    EXPECT_FALSE(regionBrushed(session, label, 1));
}

TEST(LabelNames, ColoursAreTextsAndBack) {
    expectNear(*parsedColor("#ff8000"), glm::vec3(1, 128 / 255.0f, 0));
    EXPECT_EQ(colorText(*parsedColor("#0072b2")), "#0072b2");
    for (const char* wrong : {"", "ff8000", "#ff80", "#ff800g", "#ff80000", "# f8000"})
        EXPECT_FALSE(parsedColor(wrong)) << wrong;
    volume::Parameter label = region();
    EXPECT_EQ(labelStops(label, {0, 3}).size(), 6u);
    label.labels[2].color = "";
    EXPECT_TRUE(labelStops(label, {0, 3}).empty()); // the map has them all
    EXPECT_NE(labelColor(label, 0), labelColor(label, 1));
}

} // namespace
} // namespace tessera::app
