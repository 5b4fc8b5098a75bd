#include "app/described/describe_json.h"
#include "app/session/shown_scene.h"
#include "tests/app/formula_view.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <set>

/// Every view against everything in the session that it may depend on: what must change what it shows, and what must
/// not.
namespace tessera::app {
namespace {

/// What of a session is changed. A new part of the session needs an input here, see kSessionParts.
enum Input {
    kTime,
    kBetween, ///< a time between two stored ones
    kCursor,
    kStretch,
    kCamera,
    kBrush,
    kTransfer,
    kLayers,
    kRender,
    kLighting,
    kClips,
    kLenses,
    kTone,
    kPaper,
    kDepthMask,
    kCallouts,
    kLattice,
    kDerived,
    // What a volume view has of its own: the view itself, or another one beside it.
    kOwnCamera,
    kOwnLayers,
    kOwnTime,
    kProbes,
    kUnit, ///< last: these are other data
    kInputs
};

/// Every part of a session by its key, and the input that changes it; kInputs: no part of what views show of the data.
const std::map<std::string, Input> kSessionParts = {
    {"schema", kInputs},        {"title", kInputs},      {"data", kLattice},  {"time", kTime},
    {"cursor", kCursor},        {"stretch", kStretch},   {"camera", kCamera}, {"selection", kBrush},
    {"transfer", kTransfer},    {"layers", kLayers},     {"render", kRender}, {"lighting", kLighting},
    {"clips", kClips},          {"lenses", kLenses},     {"tone", kTone},     {"paper", kPaper},
    {"animation", kInputs},     {"appearance", kInputs}, {"views", kInputs},  {"dock", kInputs},
    {"layoutBrushes", kInputs}, {"probes", kProbes},     {"figure", kInputs}, {"depthMask", kDepthMask},
    {"callouts", kCallouts}};

/// By kind of view: F where what it shows follows the input, a dot where it must stay as it is. Of views that can be
/// exported that is the table, of the others and of slices the picture.
struct Consumer {
    const char* kind;
    const char* effects;
};
void PrintTo(const Consumer& each, std::ostream* out) {
    *out << each.kind;
}
// clang-format off
//                       time
//                       | between
//                       | | cursor
//                       | | | stretch
//                       | | | | camera
//                       | | | | | brush
//                       | | | | | | transfer
//                       | | | | | | | layers
//                       | | | | | | | | render
//                       | | | | | | | | | lighting
//                       | | | | | | | | | | clips
//                       | | | | | | | | | | | lenses
//                       | | | | | | | | | | | | tone
//                       | | | | | | | | | | | | | paper
//                       | | | | | | | | | | | | | | depth mask
//                       | | | | | | | | | | | | | | | callouts
//                       | | | | | | | | | | | | | | | | lattice
//                       | | | | | | | | | | | | | | | | | derived
//                       | | | | | | | | | | | | | | | | | | own camera
//                       | | | | | | | | | | | | | | | | | | | own layers
//                       | | | | | | | | | | | | | | | | | | | | own time
//                       | | | | | | | | | | | | | | | | | | | | | probes
//                       | | | | | | | | | | | | | | | | | | | | | | unit
constexpr Consumer kConsumers[] = {
    {"volume",          "F F F F F F F F F F F F F F F F F . F F F F F"},
    {"slices",          "F F F F . F F . F . F F F . . . F F . . . . F"},
    {"scatterMatrix",   "F F . . . F . . . . . F . . . . . F . . . . F"},
    {"transfer",        "F F F . . F F . . . . F . . . . . . . F . . F"},
    {"layers",          ". . . . . F . F . . F F . . . . . . . F . . ."},
    {"timeline",        "F F . . . . . . . . . . . . . . . . . . . . ."},
    {"data",            "F F . . . F . . . . . F . . . . F F . . . . F"},
    {"history",         ""}, // lists the edits themselves
    {"log",             ". . . . . . . . . . . . . . . . . . . . . . ."},
    {"statistics",      "F F . . . F . . . . . F . . . . . F . . . . F"},
    {"histogram",       "F F . . . F . . . . . F . . . . . . . . . . F"},
    {"probes",          ". . . . . . . . . . . . . . . . . F . . . F F"},
    {"profile",         "F F F . . . . . . . . . . . . . . F . . . . F"},
    {"curves",          ". . . . . F . . . . . F . . . . . . . . . . F"},
    {"sliceMatrix",     "F F . . . . . . . . . . . . . . . F . . . . F"},
    {"oblique",         "F F F F . . . . . . . . . . . . . F . . . . F"},
    {"shadowCube",      "F F F F F F F F F F F F F . F . F . . . . . F"},
    {"tesseract",       "F F F . . F F . . . . . . . . . F . . . . . F"},
    {"parallelCoordinates", "F F . . . F . . . . . F . . . . . F . . . . F"},
    {"scatter3d",       "F F . . . F . . . . . F . . . . . . . . . . F"},
    {"hyperSlice",      "F F F . . . . . . . . . . . . . . . . . . . F"},
    {"hierarchy",       "F F . . . F . . . . . . . . . . . . . . . . F"},
    {"worthSeeing",     "F . . . . . . . . . . . . . . . . F . . . . ."},
    {"pieces",          ". . . . . . . . . . . . . . . . . . . . . . F"},
    {"compare",         "F F F F F F F F F F F F F F F . F . . . . . F"},
};
// clang-format on
constexpr bool hasEveryKindInOrder() {
    std::size_t row = 0;
    bool same = true;
    forEachViewKind([&]<class Kind>(const Kind&) {
        same = same && row < std::size(kConsumers) && kConsumers[row++].kind == Kind::State::kType;
    });
    return same && row == std::size(kConsumers);
}
static_assert(hasEveryKindInOrder(), "needs a row for each of kViewKinds, in its order");
static_assert(std::ranges::all_of(kConsumers,
                                  [](const Consumer& each) {
                                      const std::string_view row = each.effects;
                                      return row.empty() || row.size() == 2 * kInputs - 1;
                                  }),
              "a row without its column");

class Consumers : public FormulaView, public testing::WithParamInterface<Consumer> {
protected:
    void SetUp() override {
        ViewState view = *viewOfKind(GetParam().kind);
        if (auto* compare = std::get_if<CompareView>(&view)) compare->showTable = false; // of times
        if (auto* curves = std::get_if<CurvesView>(&view)) curves->y = {"mean(T)"}, curves->brushed = true;
        install(view);
        if (std::holds_alternative<HierarchyView>(view))
            start.selection.brushes = {vis::rangeBrush({{.channel = "T", .lo = 312, .hi = 1e9}}, "warm")};
        if (std::holds_alternative<ProbesView>(view)) start.probes = {{"one", {0.0121, 0.0042, -0.0004}, 0.5}};
    }

    void change(Session& session, Input input) const {
        switch (input) {
        case kTime:
            session.time = 2;
            break;
        case kBetween:
            session.time = 0.875;
            break;
        case kCursor:
            session.cursor = {0.0152, 0.0083, 0.0007};
            break;
        case kStretch:
            session.stretch = {1, 1, 3};
            break;
        case kCamera:
            session.camera.distance *= 0.8f;
            vis::orbit(session.camera, {0, 0}, {0.2f, 0.1f}); // which the shadow cube follows alone
            break;
        case kBrush:
            session.selection.brushes = {hot()};
            break;
        case kTransfer:
            session.transfer["T"].colormap = "plasma";
            session.transfer["T"].autoRange = false;
            session.transfer["T"].range = {305, 340};
            break;
        case kLayers:
            session.layers.front().visible = false;
            break;
        case kRender:
            session.render.filter = vis::Filter::Tetrahedral;
            break;
        case kLighting:
            session.lighting.ambient += 0.4f;
            break;
        case kClips:
            session.clips = {{.axis = {0, 0, 1}}};
            break;
        case kLenses:
            session.lenses = {{.shape = vis::LensShape::Disc, .center = session.cursor}};
            break;
        case kTone:
            session.tone.curve = vis::ToneCurve::Reinhard;
            break;
        case kPaper:
            session.paper.emplace();
            break;
        case kDepthMask:
            session.depthMask.strength = 3;
            break;
        case kCallouts:
            session.callouts = {{.of = CalloutOf::Plane, .placeholder = "z", .kind = CalloutKind::Slice}};
            break;
        case kLattice:
            session.data.lattice = PictureLattice::Grid;
            break;
        case kDerived:
            session.data.derived = {{"twice", "K", volume::ExpressionRecipe{"2*T"}}};
            break;
        case kOwnCamera:
            volumeOf(session).camera = session.camera;
            volumeOf(session).camera->distance *= 0.8f;
            break;
        case kOwnLayers:
            volumeOf(session).layers = {{"", true, vis::VolumeLayer{.channel = "c"}}};
            break;
        case kOwnTime:
            volumeOf(session).time = 2;
            break;
        case kProbes:
            session.probes.push_back({"other", {0.0152, 0.0083, 0.0007}, 2});
            break;
        case kUnit:
        case kInputs:
            break;
        }
    }
    /// The view under test if it is of the scene, else another one, which is not drawn.
    static VolumeView& volumeOf(Session& session) {
        if (auto* const own = std::get_if<VolumeView>(&session.views.at("pane"))) return *own;
        session.views["volume"] = VolumeView{};
        repair(session.dock, paneKeys(session));
        return std::get<VolumeView>(session.views.at("volume"));
    }
    static vis::Brush hot() { return vis::rangeBrush({{.channel = "T", .lo = 318.5, .hi = 1e9}}, "hot"); }

    /// What the view shows of a session: the table it exports, else its picture.
    std::string shown(const Session& session) {
        const std::string_view kind = GetParam().kind;
        const bool scene = kind == "volume" || kind == "shadowCube", several = kind == "compare";
        const vis::Image image = picture(session, scene     ? glm::ivec2(260, 200)
                                                  : several ? glm::ivec2(520, 300)
                                                            : glm::ivec2(420, 640));
        const ViewExport* offered = workbench.exported("pane");
        const std::string table = offered && offered->table && !several ? csvOf(offered->table({})) : std::string();
        if (!table.empty() && kind != "slices") return table;
        return table + std::string(image.rgba.begin(), image.rgba.end());
    }
};

TEST_P(Consumers, FollowWhatTheyDependOnAndNothingElse) {
    if (std::string_view(GetParam().effects).empty()) return;
    const std::string before = shown(start);
    const ViewExport* offered = workbench.exported("pane");
    EXPECT_EQ(offered && offered->figure, traitsOf(start.views.at("pane")).figure);
    EXPECT_EQ(offered && offered->table, traitsOf(start.views.at("pane")).csv);
    ASSERT_TRUE(before == shown(start)) << "shows the same of the same";
    std::string effects;
    for (int input = 0; input < kInputs; ++input) {
        effects += input > 0 ? " " : "";
        if (input == kUnit) {
            install(start.views.at("pane"), "degC");
            effects += shown(start) == before ? '.' : 'F';
            continue;
        }
        Session changed = start;
        change(changed, Input(input));
        ASSERT_FALSE(changed == start) << input;
        effects += shown(changed) == before ? '.' : 'F';
        EXPECT_TRUE(shown(start) == before) << "it does not come back after input " << input;
    }
    EXPECT_EQ(effects, GetParam().effects);
}

INSTANTIATE_TEST_SUITE_P(EveryView, Consumers, testing::ValuesIn(kConsumers),
                         [](const auto& each) { return std::string(each.param.kind); });

/// Figures of a view, without its controls.
class OwnedConsumers : public FormulaView {
protected:
    OwnedConsumers() : FormulaView(false) {}
    std::string shown(const Session& session) {
        const vis::Image image = picture(session, {260, 200});
        return {image.rgba.begin(), image.rgba.end()};
    }
};

TEST_F(OwnedConsumers, WhatAViewOwnsLooksAsWhenItIsShared) {
    install(VolumeView{});
    const auto changes = {+[](Session& session) { session.camera.distance *= 0.8f; },
                          +[](Session& session) {
                              session.layers = {{"", true, vis::VolumeLayer{.channel = "c"}}};
                          },
                          +[](Session& session) { session.time = 2; }};
    const std::string before = shown(start);
    auto what = std::begin(kOwned);
    for (const auto change : changes) {
        Session shared = start, own = start;
        change(shared);
        VolumeView& view = std::get<VolumeView>(own.views.at("pane"));
        setOwned(shared, view, *what, true); // a copy of the changed one
        const std::string wanted = shown(shared);
        EXPECT_FALSE(wanted == before);
        EXPECT_TRUE(shown(own) == wanted) << int(*what);
        // What is shared does not matter any more.
        setOwned(start, view, *what, false);
        setOwned(start, view, *what, true);
        change(own);
        EXPECT_TRUE(shown(own) == before) << int(*what);
        ++what;
    }
}

TEST(ConsumersTable, HasEveryPartOfASession) {
    Session session;
    std::set<std::string> parts;
    Session::describe(session, [&](auto&, const FieldInfo& info) {
        parts.insert(std::string(info.key));
        EXPECT_TRUE(kSessionParts.contains(std::string(info.key))) << info.key << " has no input";
    });
    EXPECT_EQ(parts.size(), kSessionParts.size());
}

} // namespace
} // namespace tessera::app
