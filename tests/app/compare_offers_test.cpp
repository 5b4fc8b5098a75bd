#include "app/edits/compare.h"
#include "app/history/parameter_path.h"
#include "app/views/compare/compare_offers.h"
#include "tests/app/cell_info.h"

#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tessera::app {
namespace {

volume::DatasetInfo offeredInfo() {
    volume::DatasetInfo info = cellInfo();
    info.times = {0, 1, 2, 3};
    volume::Parameter label;
    label.name = "region";
    label.categorical = true;
    info.parameters.push_back(label);
    info.timeUnit = "s";
    return info;
}

Session offeredSession() {
    Session session;
    session.data.model = "fuel-cell";
    session.layers.push_back({"O2", true, vis::VolumeLayer{.channel = "O2"}});
    session.time = 1;
    return session;
}

const CompareOffers* find(const std::vector<CompareOffers>& groups, const std::string& title) {
    const auto found = std::ranges::find(groups, title, &CompareOffers::title);
    return found == groups.end() ? nullptr : &*found;
}

std::vector<std::string> titles(const CompareOffers& group) {
    std::vector<std::string> out;
    for (const CompareOffer& offer : group.offers) out.push_back(offer.title);
    return out;
}

TEST(CompareOffers, WhatANewcomerUnderstandsComesFirst) {
    const auto groups = compareOffers(offeredSession(), offeredInfo());
    std::vector<std::string> names;
    for (const CompareOffers& group : groups) names.push_back(group.title);
    ASSERT_GE(names.size(), 5u);
    names.resize(4);
    EXPECT_THAT(names,
                testing::ElementsAre("Another time", "Another parameter", "Another style", "Exact or compressed"));
    EXPECT_TRUE(std::ranges::is_partitioned(groups, [](const CompareOffers& group) { return !group.technique; }));
    EXPECT_TRUE(groups.back().technique);
}

TEST(CompareOffers, TimesAreThoseNotShown) {
    const auto groups = compareOffers(offeredSession(), offeredInfo());
    const CompareOffers* times = find(groups, "Another time");
    ASSERT_TRUE(times);
    EXPECT_THAT(titles(*times), testing::ElementsAre("Each of these", "0 s", "2 s", "3 s"));
    EXPECT_EQ(times->offers[0].variants.size(), 3u);
    EXPECT_EQ(variantSession(offeredSession(), times->offers[3].variants[0]).time, 3);
    volume::DatasetInfo many = offeredInfo();
    many.times.clear();
    for (int i = 0; i <= 100; ++i) many.times.push_back(i);
    const auto some = compareOffers(offeredSession(), many);
    EXPECT_THAT(titles(*find(some, "Another time")),
                testing::ElementsAre("Each of these", "0 s", "15 s", "29 s", "43 s", "57 s", "71 s", "85 s", "100 s"));
    volume::DatasetInfo one = offeredInfo();
    one.times = {1};
    EXPECT_FALSE(find(compareOffers(offeredSession(), one), "Another time"));
}

TEST(CompareOffers, ParametersAndStylesAreThoseOfTheFirstLayerNotShown) {
    const Session session = offeredSession();
    const auto groups = compareOffers(session, offeredInfo());
    const CompareOffers* parameters = find(groups, "Another parameter");
    ASSERT_TRUE(parameters);
    for (const CompareOffer& offer : parameters->offers) {
        EXPECT_NE(offer.title, "O2");
        EXPECT_NE(offer.title, "region") << "labels are no values";
        if (offer.variants.size() != 1) continue;
        const Session changed = variantSession(session, offer.variants[0]);
        EXPECT_EQ(std::get<vis::VolumeLayer>(changed.layers[0].technique).channel, offer.title);
    }
    EXPECT_EQ(parameters->offers[0].title, "One view per parameter");
    const CompareOffers* styles = find(groups, "Another style");
    ASSERT_TRUE(styles);
    const auto titled = [&](const char* title) {
        return *std::ranges::find(styles->offers, title, &CompareOffer::title);
    };
    EXPECT_EQ(titled("Every style of rays").variants.size(), vis::kVolumeStyleNames.size() - 1);
    for (const CompareVariant& variant : titled("Every style of rays").variants)
        EXPECT_NE(std::get<vis::VolumeLayer>(variantSession(session, variant).layers[0].technique).style,
                  vis::RayStyle::Composite);
    EXPECT_THAT(titles(*styles), testing::IsSupersetOf({"X-ray", "local maximum"}));
    Session surface = session;
    surface.layers[0].technique = vis::IsoLayer{.channel = "O2"};
    EXPECT_FALSE(find(compareOffers(surface, offeredInfo()), "Another parameter")) << "its value is one of O2";
}

// The first of another style, by the names that the settings of a layer have for them.
TEST(CompareOffers, DrawingStylesAreStyles) {
    const Session session = offeredSession();
    const auto groups = compareOffers(session, offeredInfo());
    const CompareOffers* styles = find(groups, "Another style");
    ASSERT_TRUE(styles);
    EXPECT_EQ(styles->offers[0].title, "Six drawing styles");
    EXPECT_EQ(styles->offers[0].variants.size(), 6u);
    EXPECT_THAT(titles(*styles), testing::IsSupersetOf({"tone", "charcoal", "soft pencil", "pencil", "chalk"}));
    EXPECT_THAT(titles(*styles), testing::Not(testing::Contains("plain"))) << "it is";
    const auto look = [](const Session& of) { return std::get<vis::VolumeLayer>(of.layers[0].technique); };
    for (const CompareOffer& offer : styles->offers)
        if (offer.title == "charcoal") {
            EXPECT_TRUE(look(variantSession(session, offer.variants[0])).look == *vis::Look::preset("charcoal"));
        }
    Session maximum = session;
    std::get<vis::VolumeLayer>(maximum.layers[0].technique).style = vis::RayStyle::Maximum;
    const auto others = compareOffers(maximum, offeredInfo());
    for (const CompareVariant& variant : find(others, "Another style")->offers[0].variants)
        EXPECT_EQ(look(variantSession(maximum, variant)).style, vis::RayStyle::Composite) << "others have no look";
    Session surface = session;
    surface.layers[0].technique = vis::IsoLayer{.channel = "O2"};
    EXPECT_TRUE(find(compareOffers(surface, offeredInfo()), "Another style"));
}

TEST(CompareOffers, EveryOfferFitsTheSession) {
    const Session session = offeredSession();
    for (const CompareOffers& group : compareOffers(session, offeredInfo()))
        for (const CompareOffer& offer : group.offers)
            for (const CompareVariant& variant : offer.variants) {
                SCOPED_TRACE(group.title + " > " + offer.title);
                EXPECT_FALSE(variantSession(session, variant) == session);
                EXPECT_FALSE(variant.name.empty());
            }
}

TEST(CompareOffers, AnArchiveIsNotPackedAgain) {
    Session session = offeredSession();
    session.data = {};
    session.data.files = {{.path = "run.tsr", .absolutePath = "/data/run.tsr", .bytes = 0, .hash = ""}};
    const auto groups = compareOffers(session, offeredInfo());
    EXPECT_FALSE(find(groups, "Exact or compressed"));
    for (const std::string& path : variantPaths(session))
        EXPECT_TRUE(!path.starts_with("/data/") || path == "/data/lattice") << path;
}

TEST(CompareOffers, ArchivesOfARegularGridAreDrawnOnTheOtherLattice) {
    Session session = offeredSession();
    session.data = {};
    session.data.files = {{.path = "run.tsr", .absolutePath = "/data/run.tsr", .bytes = 0, .hash = ""}};
    volume::DatasetInfo info = offeredInfo();
    for (const PictureLattice lattice : {PictureLattice::BodyCentred, PictureLattice::Grid}) {
        session.data.lattice = lattice;
        info.lattice.kind =
            lattice == PictureLattice::Grid ? volume::LatticeKind::CC : volume::LatticeKind::BCC; // as it is drawn
        const auto groups = compareOffers(session, info);
        const CompareOffers* other = find(groups, "The other lattice");
        ASSERT_TRUE(other);
        EXPECT_NE(variantSession(session, other->offers.at(0).variants.at(0)).data.lattice, lattice);
    }
    info.lattice.kind = volume::LatticeKind::BCC; // drawn as stored, though the grid is wanted
    EXPECT_FALSE(find(compareOffers(session, info), "The other lattice"));
}

TEST(CompareOffers, AnEmptyComparisonShowsTheOtherEndOfTime) {
    Session session = offeredSession();
    const auto second = [&](const volume::DatasetInfo& info) {
        const auto shown = shownVariants({}, session, info);
        EXPECT_EQ(shown.size(), 2u);
        EXPECT_EQ(shown[0], CompareVariant{});
        return variantSession(session, shown.at(1));
    };
    EXPECT_EQ(second(offeredInfo()).time, 3);
    session.time = 2.5;
    EXPECT_EQ(second(offeredInfo()).time, 0);
    volume::DatasetInfo one = offeredInfo();
    one.times = {2.5};
    EXPECT_NE(std::get<vis::VolumeLayer>(second(one).layers[0].technique).channel, "O2");
    CompareView own;
    own.variants = {{"mine", {}}};
    EXPECT_EQ(shownVariants(own, session, one), own.variants);
}

TEST(CompareOffers, PackingAndTimeAlongAnAxisCanBeChanged) {
    const Session session = offeredSession();
    const auto paths = variantPaths(session);
    for (const char* path : {"/data/packed/wavelet", "/data/packed/threshold/kind", "/data/packed/lattice",
                             "/data/packed/maxError", "/data/timeAxis/axis", "/render/step"})
        EXPECT_THAT(paths, testing::Contains(path));
    for (const std::string& path : paths) {
        SCOPED_TRACE(path);
        CompareVariant variant;
        startChange(variant, session, path);
        const Session changed = variantSession(session, variant); // fits
        EXPECT_EQ(changed.data.packed.has_value(), path.starts_with("/data/packed"));
        EXPECT_EQ(changed.data.timeAxis.has_value(), path.starts_with("/data/timeAxis"));
    }
    CompareVariant variant;
    startChange(variant, session, "/data/packed/lattice");
    variant.changes["/data/packed/lattice"] = "d4";
    EXPECT_EQ(variantSession(session, variant).data.packed->lattice, codec::StoredLattice::D4);
    EXPECT_EQ(changesText(session, variant), "packed, lattice d4");
}

} // namespace
} // namespace tessera::app
