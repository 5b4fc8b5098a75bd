#include "app/data/apply_layout.h"
#include "codec/pack/pack.h"
#include "tests/app/open_fixture.h"
#include "volume/base/error.h"
#include "volume/synthetic/models.h"

#include <algorithm>
#include <gmock/gmock.h>

namespace tessera::app {
namespace {

using LayoutTest = OpenTest;

TEST_F(LayoutTest, ALayoutFitsAnyData) {
    OpenRequest request = rawRequest(raw("a.raw"));
    for (const std::string& name : layoutNames()) {
        request.layout = name;
        const Opened opened = open(request);
        ASSERT_TRUE(opened.source) << name;
        const std::string only =
            opened.source->info().channel(0).name + (opened.document.session.data.originals ? " error" : "");
        ASSERT_FALSE(opened.document.session.layers.empty()) << name;
        for (const vis::Layer& layer : opened.document.session.layers)
            std::visit([&](const auto& technique) { EXPECT_EQ(technique.channel, only) << name; }, layer.technique);
        EXPECT_FALSE(opened.messages.empty()) << name << ": nobody is told that parameters were replaced";
        EXPECT_TRUE(opened.document.session.dock.root.children.size() == 2) << name;
    }
}

OpenRequest smallCell(int times) {
    OpenRequest request;
    request.data.emplace();
    request.data->model = "fuel-cell";
    request.data->settings = {{"nx", 7}, {"ny", 13}, {"nz", 20}, {"times", double(times)}};
    return request;
}

// Parameters of a simulation may be far from their overall range at one time: a surface must be looked for there.
TEST_F(LayoutTest, ALayoutChosenKeepsTheTimeAndItsSurfacesExistThen) {
    const Opened opened = open(smallCell(5));
    const volume::DatasetInfo& info = opened.source->info();
    for (const char* name : {"evening", "charcoal", "compareLattice", "gases"})
        for (std::size_t t = 0; t < info.times.size(); ++t) {
            Session shown = opened.document.session;
            shown.time = info.times[t];
            shown.probes = {{"inlet", shown.cursor, shown.time}};
            std::vector<std::string> messages;
            const Session session = changeLayout(loadSession(findLayout(name)), *opened.source, shown, messages);
            EXPECT_EQ(session.time, shown.time) << name;
            EXPECT_EQ(session.probes, shown.probes) << name;
            EXPECT_EQ(session.cursor, shown.cursor) << name;
            bool surface = false;
            for (const vis::Layer& layer : session.layers) {
                const auto* iso = std::get_if<vis::IsoLayer>(&layer.technique);
                if (!iso) continue;
                surface = true;
                std::size_t below = 0, above = 0;
                const glm::ivec3 count = opened.source->grid().count();
                for (int z = 0; z < count.z; ++z)
                    for (int y = 0; y < count.y; ++y)
                        for (int x = 0; x < count.x; ++x) {
                            const volume::BrickSamples samples = opened.source->read(
                                {info.findChannel(iso->channel).value(), static_cast<int>(t), 0, {x, y, z}});
                            for (std::size_t i = 0; i < samples.values.size(); ++i)
                                if (samples.present.empty() || samples.present[i])
                                    ++(double(samples.values[i]) < iso->value ? below : above);
                        }
                EXPECT_GT(below, 0u) << name << " at " << shown.time << ": " << iso->channel << " = " << iso->value;
                EXPECT_GT(above, 0u) << name << " at " << shown.time << ": " << iso->channel << " = " << iso->value;
            }
            EXPECT_TRUE(surface) << name;
        }
}

// A surface of a parameter that the data do not have shows the strongest boundary of the one that takes its place.
TEST_F(LayoutTest, ALayoutsSurfaceFollowsABoundaryOfOtherData) {
    std::string bytes;
    for (int z = 0; z < 14; ++z)
        for (int y = 0; y < 6; ++y)
            for (int x = 0; x < 5; ++x) bytes += static_cast<char>(z < 4 ? 10 : z < 7 ? 40 * (z - 3) + 30 : 200);
    std::ofstream(folder / "step.raw", std::ios::binary) << bytes; // 10, then 70, 110, 150, then 200
    OpenRequest request = rawRequest(in("step.raw"));
    request.layout = "charcoal";
    const Session session = open(request).document.session;
    int surfaces = 0;
    for (const vis::Layer& layer : session.layers)
        if (const auto* iso = std::get_if<vis::IsoLayer>(&layer.technique)) {
            ++surfaces;
            EXPECT_GT(iso->value, 60) << layer.name;
            EXPECT_LT(iso->value, 160) << layer.name;
            EXPECT_GT(std::abs(iso->value - 105), 2) << "the middle of the range is no boundary";
        }
    EXPECT_GT(surfaces, 0);
}

TEST_F(LayoutTest, ASurfaceThatCannotBeIsToldOf) {
    std::ofstream(folder / "flat.raw", std::ios::binary) << std::string(5 * 6 * 14, '\x21');
    const Opened opened = open(rawRequest(in("flat.raw")));
    std::vector<std::string> messages;
    changeLayout(loadSession(findLayout("evening")), *opened.source, opened.document.session, messages);
    EXPECT_TRUE(std::ranges::any_of(
        messages, [](const std::string& text) { return text.find("surface is empty") != std::string::npos; }));
}

TEST_F(LayoutTest, ALayoutOfErrorsOnDataWithoutOriginalsIsToldOf) {
    const Opened opened = open(smallCell(2));
    Session shown = opened.document.session;
    for (const bool originals : {false, true}) {
        shown.data.originals = originals;
        std::vector<std::string> messages;
        changeLayout(loadSession(findLayout("compressionError")), *opened.source, shown, messages);
        EXPECT_EQ(std::ranges::count_if(
                      messages, [](const std::string& text) { return text.find("originals") != std::string::npos; }),
                  originals ? 0 : 1);
    }
}

TEST_F(LayoutTest, ALayoutChosenKeepsTheBrushesOfTheUser) {
    const Opened opened = open(smallCell(3));
    const auto change = [&](const Session& from, const char* name, std::vector<std::string>& messages) {
        return changeLayout(loadSession(findLayout(name)), *opened.source, from, messages);
    };
    const auto names = [](const Session& session) {
        std::vector<std::string> all;
        for (const vis::Brush& brush : session.selection.brushes)
            all.push_back(brush.name + (brush.enabled ? "" : " off"));
        return all;
    };
    using Names = std::vector<std::string>;
    Session shown = opened.document.session;
    std::vector<std::string> messages;
    EXPECT_EQ(names(change(shown, "focus", messages)), Names{"hot and starved"});
    EXPECT_EQ(names(change(change(shown, "focus", messages), "statistics", messages)), Names{"little oxygen"})
        << "a brush that came from a layout goes with it";
    EXPECT_TRUE(change(change(shown, "focus", messages), "overview", messages).selection.brushes.empty());

    // As do those of a layout file of the user's own, whatever became of the file.
    SessionDocument own = loadSession(findLayout("focus"));
    own.session.selection.brushes[0].name = "hot";
    own.raw["selection"] = toJson(own.session)["selection"];
    Session brushed = changeLayout(own, *opened.source, shown, messages);
    ASSERT_EQ(names(brushed), Names{"hot"});
    brushed = sessionFromJson(toJson(brushed), {}); // as saved and opened again
    EXPECT_EQ(names(change(brushed, "statistics", messages)), Names{"little oxygen"});
    brushed.selection.brushes[0].inverted = true;
    EXPECT_EQ(names(change(brushed, "overview", messages)), Names{"hot"}) << "it is the user's once it was changed";

    shown.selection.brushes = {vis::rangeBrush({{"T", 340, 350, 0}}, "mine")};
    messages.clear();
    const Session plain = change(shown, "overview", messages);
    EXPECT_EQ(plain.selection.brushes, shown.selection.brushes);
    const Session focus = change(shown, "focus", messages);
    EXPECT_EQ(names(focus), (Names{"mine", "hot and starved off"})) << "the selection stays";
    EXPECT_THAT(messages, testing::Contains("the layout's brush hot and starved is switched off, beside yours"));
    EXPECT_EQ(names(change(focus, "overview", messages)), Names{"mine"});
    shown.selection.brushes[0].name = "hot and starved";
    messages.clear();
    EXPECT_EQ(change(shown, "focus", messages).selection.brushes, shown.selection.brushes);
    EXPECT_THAT(messages,
                testing::Contains("the layout's brush hot and starved is left out: yours of that name stays"));

    shown.selection.brushes[0].region = vis::LensRegion{.lens = "glass"};
    messages.clear();
    EXPECT_TRUE(change(shown, "overview", messages).selection.brushes.empty());
    EXPECT_THAT(messages, testing::Contains("brush hot and starved is removed: the layout has no lens glass"));
}

TEST_F(LayoutTest, ADrawingOfAFieldHasItsBox) {
    const SessionDocument layout = loadSession(findLayout("charcoal"));
    const auto box = [](const Session& session) {
        const auto& view = std::get<VolumeView>(session.views.at("volume"));
        return view.showBox && view.drawingBox;
    };
    std::vector<std::string> messages;
    const Opened cell = open(smallCell(2));
    const Session drawn = changeLayout(layout, *cell.source, cell.document.session, messages);
    EXPECT_TRUE(box(drawn)) << "its surfaces float in the paper else";
    const Opened scan = open(rawRequest(raw("scan.raw")));
    const Session body = changeLayout(layout, *scan.source, scan.document.session, messages);
    EXPECT_FALSE(box(body));
    OpenRequest own;
    own.layout = "charcoal";
    EXPECT_FALSE(box(open(own).document.session)) << "with its own data a layout is as it was made";
}

TEST_F(LayoutTest, VariantsOfAnotherModelAreLeftOut) {
    OpenRequest request = smallCell(2);
    const Opened opened = open(request);
    std::vector<std::string> messages;
    const SessionDocument layout = loadSession(findLayout("compareLattice"));
    const Session session = changeLayout(layout, *opened.source, opened.document.session, messages);
    const auto& compare = std::get<CompareView>(session.views.at("compare"));
    ASSERT_EQ(compare.variants.size(), 5u);
    EXPECT_EQ(compare.variants[0].name, "CC, trilinear");
    EXPECT_EQ(compare.reference, 0);
    EXPECT_TRUE(std::ranges::any_of(messages, [](const std::string& text) {
        return text.starts_with("this comparison uses the model marschner-lobb");
    }));
    // On the model itself all are there.
    request.data->model = "marschner-lobb";
    request.data->settings = {{"nx", 8}, {"ny", 8}, {"nz", 8}};
    const Opened own = open(request);
    const Session whole = changeLayout(layout, *own.source, own.document.session, messages);
    EXPECT_EQ(std::get<CompareView>(whole.views.at("compare")).variants.size(), 6u);
    // The truth is one of the signal shown, not of the layout's.
    const auto truth = [](const Session& from) {
        const auto& variants = std::get<CompareView>(from.views.at("compare")).variants;
        return Json::parse(variants.at(0).changes.at("/data/settings"));
    };
    EXPECT_EQ(truth(layout.session), (Json{{"fM", 3}, {"nx", 128}, {"ny", 128}, {"nz", 128}}));
    EXPECT_EQ(truth(whole), (Json{{"nx", 128}, {"ny", 128}, {"nz", 128}}));
    request.data->settings["fM"] = 5;
    const Opened other = open(request);
    EXPECT_EQ(truth(changeLayout(layout, *other.source, other.document.session, messages))["fM"], 5);
}

/// Data that are not packed are packed to show the errors of that; an archive has no originals.
TEST_F(LayoutTest, TheLayoutOfErrorsPacksOtherData) {
    OpenRequest request;
    request.data.emplace();
    request.data->model = "marschner-lobb";
    request.data->settings = {{"nx", 12}, {"ny", 12}, {"nz", 12}};
    request.layout = "compressionError";
    const Opened opened = open(request);
    const Session& session = opened.document.session;
    EXPECT_TRUE(session.data.originals);
    ASSERT_TRUE(session.data.packed);
    const volume::DatasetInfo& info = opened.numbers->info();
    const auto error = info.findChannel("rho error");
    ASSERT_TRUE(error);
    EXPECT_FALSE(info.findChannel("T error"));
    EXPECT_EQ(std::get<vis::VolumeLayer>(session.layers.at(0).technique).channel, "rho error");
    EXPECT_EQ(std::get<HistogramView>(session.views.at("histogram")).channel, "rho error");
    EXPECT_TRUE(session.transfer.at("rho error").aboutZero);
    const Range errors = info.channelRange(info.channel(*error));
    EXPECT_GT(errors.hi - errors.lo, 0);
    const auto says = [](const Opened& what, const std::string& text) {
        return std::ranges::any_of(what.messages, [&](const std::string& each) { return each.find(text) + 1 > 0; });
    };
    EXPECT_TRUE(says(opened, "samples are within 1.0 % of each parameter's range"));
    EXPECT_FALSE(says(opened, "another lattice"));
    EXPECT_FALSE(says(opened, "an archive has no originals"));
    // A file of one's own, and as an archive.
    request = rawRequest(raw("own.raw"));
    request.layout = "compressionError";
    EXPECT_TRUE(open(request).document.session.data.originals);
    volume::Dataset signal = volume::makeModel("marschner-lobb", {{"nx", 12}, {"ny", 12}, {"nz", 12}});
    codec::pack(signal, {}, in("own.tsr"));
    request = {};
    request.paths = {in("own.tsr")};
    request.layout = "compressionError";
    const Opened archive = open(request);
    EXPECT_FALSE(archive.document.session.data.originals);
    EXPECT_TRUE(says(archive, "an archive has no originals"));
}

TEST_F(LayoutTest, SurfacesInCalloutsExistInOtherData) {
    OpenRequest request = rawRequest(raw("a.raw"));
    request.layout = "callouts";
    const Opened opened = open(request);
    std::size_t surfaces = 0;
    for (const Callout& callout : opened.document.session.callouts)
        for (const vis::Layer& layer : callout.layers.value_or(std::vector<vis::Layer>())) {
            const auto* iso = std::get_if<vis::IsoLayer>(&layer.technique);
            if (!iso) continue;
            ++surfaces;
            const volume::DatasetInfo& info = opened.numbers->info();
            const auto channel = info.findChannel(iso->channel);
            ASSERT_TRUE(channel);
            const Range range = info.channelRange(info.channel(*channel));
            EXPECT_GT(iso->value, range.lo);
            EXPECT_LT(iso->value, range.hi);
        }
    EXPECT_EQ(surfaces, 1u);
}

// Where they were in the layout's data means nothing here.
TEST_F(LayoutTest, LensesAndLinesLieInOtherData) {
    OpenRequest request = rawRequest(raw("a.raw"));
    request.layout = "lens";
    const Opened opened = open(request);
    const volume::DatasetInfo& info = opened.source->info();
    const Session& session = opened.document.session;
    ASSERT_EQ(session.lenses.size(), 2u);
    const glm::dvec3 size = info.bounds.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    for (std::size_t i = 0; i < 2; ++i)
        for (int a = 0; a < 3; ++a) {
            const double expected =
                a == axis ? info.bounds.lo[a] + size[a] * (0.25 + 0.5 * double(i)) : session.cursor[a];
            EXPECT_NEAR(session.lenses[i].center[a], expected, 1e-9 * size[a]) << i << ' ' << a;
        }
    SessionDocument layout = loadSession(findLayout("statistics"));
    auto& profile = std::get<ProfileView>(layout.session.views.at("profile"));
    profile.points = {{0, 0, 0}, {1, 1, 1}};
    layout.raw = toJson(layout.session);
    std::vector<std::string> messages;
    const Session applied = applyLayout(layout, info, session.data, messages);
    EXPECT_TRUE(std::get<ProfileView>(applied.views.at("profile")).points.empty());
    EXPECT_THAT(messages, testing::Contains(testing::HasSubstr("line of a profile")));
    // With its own data all stays.
    const Session own = applyLayout(layout, info, layout.session.data, messages);
    EXPECT_EQ(std::get<ProfileView>(own.views.at("profile")).points, profile.points);
}

TEST_F(LayoutTest, WhatALayoutLosesIsTold) {
    OpenRequest request = rawRequest(raw("a.raw"));
    request.layout = "starved";
    const Opened opened = open(request);
    EXPECT_TRUE(opened.document.session.selection.brushes.empty());
    EXPECT_THAT(opened.messages, testing::Contains(testing::HasSubstr("brushes were made for other data")));
    SessionDocument layout = loadSession(findLayout("overview"));
    const std::string name = opened.source->info().channel(0).name;
    layout.raw["transfer"][name] = {{"autoRange", false}, {"range", {1, 2}}};
    std::vector<std::string> messages;
    const Session applied = applyLayout(layout, opened.source->info(), opened.document.session.data, messages);
    EXPECT_TRUE(applied.transfer.at(name).autoRange);
    EXPECT_THAT(messages, testing::Contains(testing::HasSubstr("colours of " + name)));
}

TEST_F(LayoutTest, FunctionsOfALayerOrFaceAloneAreTaken) {
    SessionDocument layout = loadSession(findLayout("shadowCube"));
    vis::TransferFunction far;
    far.colormap = "gray";
    layout.session.transfer["far"] = layout.session.transfer["nobody's"] = far;
    std::get<ShadowCubeView>(layout.session.views.at("shadowCube")).back.transfer = "far";
    layout.raw = toJson(layout.session);
    const Opened opened = open(rawRequest(raw("a.raw")));
    std::vector<std::string> messages;
    const Session applied = applyLayout(layout, opened.source->info(), opened.document.session.data, messages);
    EXPECT_TRUE(applied.transfer.contains("far") && applied.transfer.at("far") == far);
    EXPECT_FALSE(applied.transfer.contains("nobody's"));
}

TEST_F(LayoutTest, DemonstrationsAreFew) {
    const std::vector<std::string> names = layoutNames();
    EXPECT_EQ(std::ranges::count_if(names, isDemonstration), 5);
    EXPECT_FALSE(isDemonstration("overview"));
}

// Views are "shadowCube", models "fuel-cell": who mixes them up is understood.
TEST_F(LayoutTest, NamesAreFoundHoweverTheyAreSpelled) {
    const std::string path = findLayout("shadowCube");
    for (const char* name : {"shadowcube", "shadow_cube", "Shadow cube", "SHADOW-CUBE"})
        EXPECT_EQ(findLayout(name), path) << name;
    EXPECT_EQ(findLayout("over_time"), findLayout("overTime"));
    EXPECT_THROW(findLayout("shadow"), Error);
    EXPECT_THROW(findLayout("../layouts/overview"), Error);
    EXPECT_TRUE(viewOfKind("shadow_cube") && viewOfKind("SliceMatrix"));
    EXPECT_FALSE(viewOfKind("slice"));
    for (const std::string& name : layoutNames())
        EXPECT_EQ(name.find('_'), std::string::npos) << "one spelling is listed";
}

TEST_F(LayoutTest, ShippedLayoutsAreValid) {
    const std::vector<std::string> names = layoutNames();
    EXPECT_TRUE(std::find(names.begin(), names.end(), "overview") != names.end());
    for (const char* shipped : {"gases", "starved", "statistics", "flow", "lens", "focus", "charcoal", "illustration",
                                "shadowCube", "tesseract", "animation"})
        EXPECT_TRUE(std::find(names.begin(), names.end(), shipped) != names.end()) << shipped;
    for (const std::string& name : names) {
        const SessionDocument layout = loadSession(findLayout(name));
        EXPECT_TRUE(layout.messages.empty()) << layout.messages.front();
        std::vector<std::string> panes = panesOf(layout.session.dock), keys = paneKeys(layout.session);
        std::sort(panes.begin(), panes.end());
        EXPECT_EQ(panes, keys) << name;
    }
    EXPECT_THROW(findLayout("no such layout"), Error);
}

} // namespace
} // namespace tessera::app
