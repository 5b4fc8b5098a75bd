#include "app/edits/compare.h"
#include "app/edits/compare_files.h"
#include "app/views/compare/compare_offers.h"
#include "tests/app/cell_info.h"
#include "vis/transfer/transfer_function.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// What a comparison shows of two files.
namespace tessera::app {
namespace {

/// Data with T and p beside others that have T alone, up to 9 where the first end at 5.
volume::DatasetInfo twoFiles(const std::string& otherUnit = "K") {
    volume::DatasetInfo info = cellInfo();
    info.parameters[2].unit = "K";
    volume::Parameter other = info.parameters[2];
    other.name = "T (other)";
    other.unit = otherUnit;
    other.ranges = {{2, 9}};
    info.parameters.push_back(other);
    return info;
}

Session twoFilesSession(const char* own = "/data/old/run.pvd", const char* other = "/data/new/run.pvd") {
    Session session;
    session.data.files.resize(1);
    session.data.files[0].absolutePath = own;
    session.data.other.emplace();
    session.data.other->files.resize(1);
    session.data.other->files[0].absolutePath = other;
    session.layers.push_back({"", true, vis::VolumeLayer{.channel = "T"}});
    session.layers.push_back({"", true, vis::IsoLayer{.channel = "T", .value = 3}});
    session.layers.push_back({"", true, vis::SliceLayer{.channel = "O2"}});
    return session;
}

std::vector<std::string> channelsOf(const Session& session) {
    std::vector<std::string> names;
    for (const vis::Layer& layer : session.layers)
        names.push_back(std::visit([](const auto& own) { return own.channel; }, layer.technique));
    return names;
}

TEST(CompareFiles, EveryLayerThatTheOtherFileHasIsOfThat) {
    const Session session = twoFilesSession();
    const auto variants = fileVariants(session, twoFiles());
    ASSERT_EQ(variants.size(), 2u);
    EXPECT_TRUE(variantSession(session, variants[0]).layers == session.layers);
    const Session other = variantSession(session, variants[1]);
    EXPECT_THAT(channelsOf(other), testing::ElementsAre("T (other)", "T (other)", "O2"));
    EXPECT_EQ(other.layers[0].transfer, "T") << "one function for both";
    EXPECT_EQ(variants[0].name, "old/run.pvd");
    EXPECT_EQ(variants[1].name, "new/run.pvd");
    EXPECT_FALSE(showsOtherData(variants[0]));
    EXPECT_TRUE(showsOtherData(variants[1]));
}

TEST(CompareFiles, TheDifferenceIsThatOfTheFirstLayer) {
    Session session = twoFilesSession("/data/a.raw", "/data/b.raw");
    const volume::DatasetInfo info = twoFiles();
    ASSERT_EQ(comparedChannel(session, info), "T");
    EXPECT_EQ(addOtherDifference(session.data.derived, info, "T"), "T minus other");
    EXPECT_EQ(addOtherDifference(session.data.derived, info, "T"), "T minus other");
    ASSERT_EQ(session.data.derived.size(), 1u);
    EXPECT_EQ(session.data.derived[0].unit, "K");
    const auto variants = fileVariants(session, info);
    ASSERT_EQ(variants.size(), 3u);
    EXPECT_EQ(variants[2].name, "a.raw minus b.raw");
    EXPECT_THAT(channelsOf(variantSession(session, variants[2])), testing::ElementsAre("T minus other"));
    EXPECT_TRUE(showsOtherData(variants[2]));
    EXPECT_EQ(changesText(session, variants[2]), "shows T minus other volume");
    showOtherDifference(session, info, "T");
    const vis::TransferFunction& function = session.transfer.at("T minus other");
    EXPECT_TRUE(function.aboutZero);
    EXPECT_EQ(vis::curveAt(function.opacity, 0.495), 0) << "no fog where nothing differs";
    EXPECT_GT(vis::curveAt(function.opacity, 0.8), 0.3);
    EXPECT_EQ(comparedChannel(session, twoFiles("Pa")), "") << "what cannot be subtracted";
    const auto offers = compareOffers(session, info);
    ASSERT_FALSE(offers.empty());
    EXPECT_EQ(offers.front().title, "The other file");
    EXPECT_EQ(offers.front().offers.front().variants.size(), 2u);
}

// Slices and plots know no layers: they show a parameter by the function of its name.
TEST(CompareFiles, ViewsWithoutLayersFollowTheFunctionOfTheFirst) {
    Session session = twoFilesSession();
    const volume::DatasetInfo info = twoFiles();
    showOtherDifference(session, info, "T");
    const auto variants = fileVariants(session, info);
    session.transfer["T"].colormap = "inferno";
    session.transfer["T"].range = {2, 3};
    const Session other = variantSession(session, variants[1]);
    EXPECT_TRUE(other.transfer.at("T (other)") == session.transfer.at("T"));
    const Session first = variantSession(session, variants[0]);
    EXPECT_EQ(first.transfer.at("T").colormap, "inferno");
    // One of its own is its own.
    session.layers[0].transfer = session.layers[1].transfer = "mine";
    const Session own = variantSession(session, fileVariants(session, info)[1]);
    EXPECT_NE(own.transfer.at("T (other)").colormap, "inferno");
}

TEST(CompareFiles, ADifferenceThatIsNothingSaysSo) {
    Session session = twoFilesSession();
    volume::DatasetInfo info = twoFiles();
    showOtherDifference(session, info, "T");
    volume::Parameter difference = info.parameters.back();
    difference.name = "T minus other";
    difference.ranges = {{0, 0}};
    info.parameters.push_back(difference);
    EXPECT_EQ(equalText(session.data, info, "T minus other"), "T minus other is 0 everywhere: nothing differs");
    EXPECT_EQ(equalText(session, info), "") << "T is shown";
    session.layers = {{"", true, vis::VolumeLayer{.channel = "T minus other"}},
                      {"", false, vis::VolumeLayer{.channel = "T"}}};
    EXPECT_EQ(equalText(session, info), "T minus other is 0 everywhere: nothing differs");
    info.parameters.back().ranges = {{-1, 0}};
    EXPECT_EQ(equalText(session, info), "");
    info.parameters[2].ranges = {{0, 0}};
    EXPECT_EQ(equalText(session.data, info, "T"), "") << "a value, no difference";
    info.parameters.back().ranges = {{0, 0}};
    info.remote = true;
    EXPECT_THAT(equalText(session, info), testing::HasSubstr("wherever it was looked at"));
}

TEST(CompareFiles, WhatIsShownOfTheFirstKeepsItsValues) {
    Session session = twoFilesSession();
    const volume::DatasetInfo info = twoFiles();
    vis::TransferFunction& function = session.transfer["T"];
    function.opacity = {{0, 0}, {0.25f, 0.1f}, {1, 0.8f}};
    const vis::TransferFunction before = function;
    shareFunction(session, info, "T");
    const vis::TransferFunction& own = session.transfer.at("T");
    EXPECT_FALSE(own.autoRange);
    EXPECT_EQ(own.range, (Range{1, 9}));
    for (const double value : {1.0, 1.5, 2.0, 3.7, 5.0})
        EXPECT_NEAR(vis::evaluate(own, own.range, value).a, vis::evaluate(before, {1, 5}, value).a, 1e-6) << value;
    EXPECT_TRUE(session.transfer.at("T (other)") == own);
    shareFunction(session, info, "T");
    EXPECT_EQ(session.transfer.at("T").opacity.size(), own.opacity.size()) << "it is shared already";
}

TEST(CompareFiles, ARangeInAnotherUnitIsThatOfTheSameValues) {
    Session session = twoFilesSession();
    const volume::DatasetInfo info = twoFiles("degC");
    ASSERT_EQ(comparedChannel(session, info), "T");
    shareFunction(session, info, "T");
    const Range own = session.transfer.at("T").range, other = session.transfer.at("T (other)").range;
    EXPECT_NEAR(own.hi, 9 + 273.15, 1e-6);
    EXPECT_NEAR(other.hi, 9, 1e-6);
    EXPECT_NEAR(other.lo, own.lo - 273.15, 1e-6);
    EXPECT_TRUE(variantSession(session, fileVariants(session, info)[1]).layers[0].transfer.empty());
}

TEST(CompareFiles, GoWithAllThatShowsTheOther) {
    Session session = twoFilesSession();
    const volume::DatasetInfo info = twoFiles();
    addOtherDifference(session.data.derived, info, "T");
    session.data.derived.push_back({"twice", "", volume::ExpressionRecipe{"2*T"}});
    CompareView files, filters;
    files.variants = fileVariants(session, info);
    filters.variants = {{}, {.name = "average", .changes = {{"/render/filter", "average"}}}};
    session.views = {{"compare", files}, {"compare-2", filters}};
    dropOtherData(session);
    EXPECT_FALSE(session.data.other);
    ASSERT_EQ(session.data.derived.size(), 1u);
    EXPECT_EQ(session.data.derived[0].name, "twice");
    ASSERT_EQ(session.views.size(), 1u);
    EXPECT_TRUE(std::get<CompareView>(session.views.at("compare-2")) == filters);
}

} // namespace
} // namespace tessera::app
