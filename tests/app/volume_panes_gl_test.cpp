#include "app/pane/pane_title.h"
#include "app/pane/view_parts.h"
#include "app/session/shown_scene.h"
#include "tests/app/drawn_text.h"
#include "tests/app/hands_fixture.h"
#include "tests/app/workbench_fixture.h"

#include <algorithm>
#include <set>

/// Several volume views in one window: what each of them shares or owns, under the mouse and keys.
namespace tessera::app {
namespace {

class VolumePanes : public Hands {
protected:
    VolumePanes() : Hands({.headless = true}) {}

    /// Two volume views side by side, "pane" and "pane-2", above the list of layers.
    void showTwo(const std::function<void(Session&)>& prepare = {}) {
        show(VolumeView{}, {900, 600}, [&](Session& session) {
            session.views["pane-2"] = VolumeView{};
            session.views["layers"] = LayersView{};
            session.camera = {};
            session.camera.orientation = glm::quat(1, 0, 0, 0);
            session.dock = {};
            session.dock.root.id = 1;
            session.dock.root.tabs = {"pane"};
            insertPane(session.dock, "pane-2", 1, DockSide::Right);
            insertPane(session.dock, "layers", 1, DockSide::Bottom);
            if (prepare) prepare(session);
        });
    }
    static ImRect rectOf(const std::string& pane) {
        const ImGuiWindow* found = ImGui::FindWindowByName(("###pane." + pane).c_str());
        return found ? found->Rect() : ImRect();
    }
    VolumeView& volume(const std::string& pane) { return std::get<VolumeView>(session().views.at(pane)); }
    void own(const std::string& pane, Owned what) {
        setOwned(session(), volume(pane), what, true);
        settle();
    }
    void turn(const std::string& pane) {
        const ImRect at = rectOf(pane);
        drag(within(at, 0.4, 0.5), within(at, 0.7, 0.4));
        settle();
    }
    static ImVec2 chainOf(const std::string& pane) {
        const ImRect at = rectOf(pane);
        const float em = ImGui::GetFontSize();
        return {std::floor(at.Max.x - em), std::floor(at.Min.y + em)};
    }
};

TEST_F(VolumePanes, SharedTheyTurnTogetherOwnedAlone) {
    showTwo();
    const vis::Camera start = session().camera;
    turn("pane-2");
    const vis::Camera shared = session().camera;
    EXPECT_FALSE(shared == start) << "the one camera of both";
    EXPECT_FALSE(volume("pane-2").camera);
    own("pane-2", Owned::Camera);
    EXPECT_TRUE(*volume("pane-2").camera == shared) << "nothing jumps";
    const std::size_t steps = this->steps();
    const Session before = session();
    turn("pane-2");
    EXPECT_TRUE(session().camera == shared);
    EXPECT_FALSE(*volume("pane-2").camera == shared);
    EXPECT_EQ(this->steps(), steps + 1);
    const Session turned = session();
    turn("pane");
    EXPECT_FALSE(session().camera == shared);
    EXPECT_TRUE(*volume("pane-2").camera == *std::get<VolumeView>(turned.views.at("pane-2")).camera);
    undo();
    undo();
    EXPECT_EQ(session().dock.volume, "pane") << "clicked last, which is no edit";
    session().dock.volume = before.dock.volume;
    EXPECT_TRUE(session() == before) << apart(before);
}

TEST_F(VolumePanes, KeysWheelAndGizmoActOnTheViewUnderTheMouse) {
    showTwo([](Session& session) { std::get<VolumeView>(session.views.at("pane-2")).camera = session.camera; });
    const vis::Camera shared = session().camera;
    const auto mine = [&]() -> vis::Camera& { return *volume("pane-2").camera; };
    moveTo(within(rectOf("pane-2"), 0.5, 0.5));
    for (const int key : {'7', '3', '9', '5', 'R'}) {
        const vis::Camera before = mine();
        press(key);
        EXPECT_FALSE(mine() == before) << char(key);
        EXPECT_TRUE(session().camera == shared) << char(key);
    }
    const float distance = mine().distance;
    turnWheel(2);
    EXPECT_LT(mine().distance, distance);
    // The gizmo's x, to the right of its middle when seen from the front.
    press('1');
    const ImRect at = rectOf("pane-2");
    const float em = ImGui::GetFontSize(), radius = em * 2.6f;
    click({std::floor(at.Min.x + radius + em + radius - em * 0.52f), std::floor(at.Max.y - radius - em)});
    const glm::quat right = vis::standardOrientation(vis::StandardView::Right);
    EXPECT_GT(std::abs(glm::dot(mine().orientation, right)), 0.999f);
    EXPECT_TRUE(session().camera == shared);
    // A double click there, and the cross-hair moves for all.
    const glm::dvec3 cursor = session().cursor;
    press('R');
    settle();
    ImGui::GetIO().MouseDoubleClickTime = 10;
    const ImVec2 middle = within(rectOf("pane-2"), 0.5, 0.45);
    click(middle);
    click(middle);
    EXPECT_NE(session().cursor, cursor);
    EXPECT_TRUE(session().camera == shared);
}

TEST_F(VolumePanes, TheChainUnlinksACopyAndLinksToWhatIsShared) {
    showTwo();
    const Session before = session();
    click(chainOf("pane-2"));
    ASSERT_TRUE(popup());
    for (const auto& [name, what] :
         {std::pair{"Camera", Owned::Camera}, {"Layers", Owned::Layers}, {"Time", Owned::Time}}) {
        click(item(popup(), {name}).GetCenter());
        ASSERT_TRUE(popup()) << "stays open for the next";
        EXPECT_TRUE(owns(volume("pane-2"), what)) << name;
        const Session shown = sessionShownIn(session(), "pane-2");
        EXPECT_TRUE(shown.camera == before.camera && shown.layers == before.layers && shown.time == before.time);
    }
    // A step of the own time.
    click(item(popup(), {"##on"}).GetCenter());
    EXPECT_EQ(volume("pane-2").time, 2.0);
    EXPECT_EQ(session().time, before.time);
    press(key::kEscape);
    settle();
    EXPECT_FALSE(popup());
    turn("pane");
    click(chainOf("pane-2"));
    click(item(popup(), {"Camera"}).GetCenter());
    EXPECT_FALSE(volume("pane-2").camera);
    press(key::kEscape);
    settle();
    while (steps() > 0) undo();
    session().dock.volume = before.dock.volume;
    EXPECT_TRUE(session() == before) << apart(before);
}

TEST_F(VolumePanes, TheLayersListedAreThoseOfTheViewClickedLast) {
    showTwo([](Session& session) { session.layers.front().name.clear(); });
    own("pane-2", Owned::Layers);
    const ImVec2 eye = item(window("layers"), {0, "##eye"}).GetCenter();
    click(within(rectOf("pane"), 0.5, 0.5));
    click(eye);
    settle();
    EXPECT_FALSE(session().layers.front().visible) << "of a view that shares them";
    EXPECT_TRUE(volume("pane-2").layers->front().visible);
    const std::size_t before = steps();
    click(within(rectOf("pane-2"), 0.5, 0.5));
    settle();
    EXPECT_EQ(session().dock.volume, "pane-2");
    EXPECT_EQ(steps(), before) << "a choice, no edit";
    click(eye);
    settle();
    EXPECT_FALSE(volume("pane-2").layers->front().visible);
    EXPECT_FALSE(session().layers.front().visible) << "as it was";
    EXPECT_EQ(steps(), before + 1);
    EXPECT_EQ(workbench.history().steps().back().name,
              "Volume 2, " + layerName(session().layers.front()) + ": visible");
    // Commands add to the list that is shown.
    const std::size_t shared = session().layers.size();
    for (const Command& command : workbench.commands())
        if (command.title() == "Add slice layer") command.run();
    EXPECT_EQ(session().layers.size(), shared);
    EXPECT_EQ(volume("pane-2").layers->size(), shared + 1);
    click(within(rectOf("pane"), 0.5, 0.5));
    settle();
    EXPECT_EQ(session().dock.volume, "pane");
}

TEST_F(VolumePanes, TheLegendStandsWhereTheDataAreNot) {
    VolumeView plain;
    plain.showAxes = plain.showScaleBar = plain.showGizmo = false;
    show(plain, {420, 640}, [](Session& session) {
        session.camera = {};
        session.camera.orientation = glm::quat(1, 0, 0, 0);
        session.camera.distance = 6; // the picture is 2.5 x 3.8, the data 1 at most
    });
    const auto legend = [&](float x, float y) { // with the data there, from the middle of the picture
        session().camera.target = {-x, -y, 0};
        settle();
        for (const DrawnText& text : drawnTexts())
            if (text.text.find('[') != std::string::npos) return text.middle();
        ADD_FAILURE() << "no legend";
        return ImVec2{};
    };
    const ImVec2 usual = legend(0, 0.5f);
    EXPECT_GT(usual.x, 210);
    EXPECT_GT(usual.y, 500) << "the corner at the bottom right, which is free";
    const ImVec2 above = legend(0.8f, -1.6f);
    EXPECT_GT(above.x, 210);
    EXPECT_LT(above.y, 150);
    session().camera.distance = 1.2f; // the data are everywhere
    EXPECT_GT(legend(0, 0).y, 500);
}

TEST_F(VolumePanes, TitlesNameWhatIsOwned) {
    showTwo();
    const volume::DatasetInfo& info = workbench.document().info();
    EXPECT_EQ(shownTitle(session(), "pane-2", info), paneTitle(session(), "pane-2"));
    volume("pane-2").time = 0.5;
    EXPECT_EQ(shownTitle(session(), "pane-2", info), "t = 0.5 s");
    volume("pane-2").layers = {{"", true, vis::VolumeLayer{.channel = "p"}}};
    EXPECT_EQ(shownTitle(session(), "pane-2", info), "p, t = 0.5 s");
    volume("pane") = volume("pane-2");
    EXPECT_EQ(shownTitle(session(), "pane-2", info), "p, t = 0.5 s (Volume 2)");
    volume("pane-2").layers->push_back({"", true, vis::IsoLayer{.channel = "T"}});
    volume("pane-2").time.reset();
    EXPECT_EQ(shownTitle(session(), "pane-2", info), "p, T surface");
}

TEST_F(VolumePanes, WhatIsOwnedIsInTheFileAndFitsOtherData) {
    showTwo();
    for (const Owned what : kOwned) own("pane-2", what);
    volume("pane-2").layers->front().lens = "gone";
    volume("pane-2").time = 99;
    Session back = sessionFromJson(toJson(session()), "test");
    EXPECT_TRUE(back == session()) << apart(back);
    std::vector<std::string> messages;
    fitSession(back, workbench.document().info(), messages);
    const VolumeView& fitted = std::get<VolumeView>(back.views.at("pane-2"));
    EXPECT_EQ(fitted.time, workbench.document().info().times.back());
    EXPECT_FALSE(fitted.layers->front().visible);
    EXPECT_EQ(messages.size(), 1u);
}

/// Small multiples of the formula cell in a window.
class Multiples : public VolumePanes {
protected:
    void begin() {
        show(VolumeView{}, {1000, 700}, [](Session& session) {
            session.views.clear();
            const Session all = defaultSession(session, {});
            session.views = all.views;
            session.dock = all.dock;
        });
    }
    static Session defaultSession(const Session& session, int) {
        Opened opened;
        opened.source = volume::makeMemorySource(formula::makeCell(), {});
        return app::defaultSession(opened.source->info(), session.data);
    }
    bool run(const std::string& title) {
        for (const Command& command : workbench.commands())
            if (command.title() == title && command.available()) {
                command.run();
                settle();
                return true;
            }
        return false;
    }
    std::vector<std::string> multiples() {
        std::vector<std::string> panes;
        for (const auto& [pane, view] : session().views)
            if (const auto* found = std::get_if<VolumeView>(&view); found && found->multiple) panes.push_back(pane);
        return panes;
    }
    /// Every view is in the dock once, and each of the multiples has a place of its own.
    void expectDocked() {
        std::vector<std::string> docked = panesOf(session().dock), keys = paneKeys(session());
        std::ranges::sort(docked);
        EXPECT_EQ(docked, keys);
        std::set<int> stacks;
        for (const std::string& pane : multiples()) stacks.insert(stackWith(session().dock.root, pane));
        EXPECT_EQ(stacks.size(), multiples().size());
    }
};

TEST_F(Multiples, ShowEachParameterAndUndoRestoresTheDock) {
    begin();
    const Session before = session();
    ASSERT_TRUE(run("One view per parameter"));
    const volume::DatasetInfo& info = workbench.document().info();
    const std::vector<int> channels = comparedChannels(info);
    ASSERT_EQ(multiples().size(), channels.size());
    std::set<std::string> titles;
    for (const std::string& pane : multiples()) {
        EXPECT_FALSE(volume(pane).camera) << "one camera";
        EXPECT_TRUE(volume(pane).showLegend) << "each parameter has its own colours";
        titles.insert(shownTitle(session(), pane, info));
        EXPECT_FALSE(pictures().empty());
    }
    for (const int channel : channels) EXPECT_TRUE(titles.contains(info.channel(channel).name));
    expectDocked();
    EXPECT_EQ(steps(), 1u);
    for (const auto& [pane, view] : before.views) EXPECT_TRUE(session().views.contains(pane)) << pane;
    // Again, and by time: the former ones give way.
    ASSERT_TRUE(run("One view per parameter"));
    EXPECT_EQ(multiples().size(), channels.size());
    ASSERT_TRUE(run("One view per time"));
    EXPECT_EQ(multiples().size(), info.times.size());
    expectDocked();
    while (steps() > 0) undo();
    EXPECT_TRUE(session().dock.root == before.dock.root);
    session().dock.volume = before.dock.volume;
    EXPECT_TRUE(session() == before) << apart(before);
    ASSERT_TRUE(run("One view per parameter"));
    ASSERT_TRUE(run("Reset arrangement"));
    EXPECT_TRUE(multiples().empty());
    EXPECT_TRUE(session().dock.root == before.dock.root);
}

TEST_F(Multiples, ShowTimesWithOneLegend) {
    begin();
    ASSERT_TRUE(run("One view per time"));
    const std::vector<double>& times = workbench.document().info().times;
    ASSERT_EQ(multiples().size(), times.size());
    int legends = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
        const VolumeView& view = volume(multiples()[i]);
        EXPECT_EQ(view.time, times[i]);
        EXPECT_FALSE(view.layers) << "one transfer function";
        legends += view.showLegend;
    }
    EXPECT_EQ(legends, 1);
    const std::size_t before = steps();
    turn(multiples()[1]);
    EXPECT_EQ(steps(), before + 1) << "the camera of all";
    EXPECT_FALSE(volume(multiples()[1]).camera);
}

TEST_F(Multiples, StandBesideEachOtherInAWideWindowAndBelowEachOtherInAHighOne) {
    for (const glm::ivec2 size : {glm::ivec2(1800, 420), glm::ivec2(420, 1800)}) {
        begin();
        frames.emplace(size);
        session().dock = {};
        repair(session().dock, {"volume"});
        settle();
        ASSERT_TRUE(run("One view per time"));
        std::set<float> columns, rows;
        for (const std::string& pane : multiples()) {
            const ImGuiWindow* in = ImGui::FindWindowByName(("###pane." + pane).c_str());
            ASSERT_TRUE(in);
            columns.insert(in->Pos.x);
            rows.insert(in->Pos.y);
        }
        EXPECT_EQ(columns.size(), size.x > size.y ? 3u : 1u);
        EXPECT_EQ(rows.size(), size.x > size.y ? 1u : 3u);
    }
}

/// A window that draws on in frames, as users have it, not one that waits for its pictures.
class MultiplesInWindow : public DrawnWorkbench {
protected:
    /// Pixels with a colour in a rectangle of the last frame.
    int coloured(const ImRect& rect) const {
        const vis::Image image = frames.read();
        int count = 0;
        for (int y = int(rect.Min.y) + 1; y < int(rect.Max.y) - 1; ++y)
            for (int x = int(rect.Min.x) + 1; x < int(rect.Max.x) - 1; ++x) {
                const std::uint8_t* pixel =
                    &image.rgba[(std::size_t(y) * std::size_t(image.size.x) + std::size_t(x)) * 4];
                const auto [least, most] = std::minmax({pixel[0], pixel[1], pixel[2]});
                count += most - least > 40;
            }
        return count;
    }
};

TEST_F(MultiplesInWindow, EachTimeIsDrawnAndThenTheWindowRests) {
    OpenRequest request;
    request.data.emplace();
    request.data->model = "fuel-cell";
    request.data->settings = {{"nx", 7}, {"ny", 9}, {"nz", 21}, {"times", 4}};
    Opened opened = open(request);
    Session& session = opened.document.session;
    for (auto& [name, function] : session.transfer) function.opacity = {{0, 0.6f}, {1, 0.6f}};
    VolumeView& view = std::get<VolumeView>(session.views.at("volume"));
    view.showBox = view.showCursor = false;
    session.appearance.scale = 0.5f;
    opened.document.history.reset(session);
    workbench.install(std::move(opened));
    settle();
    ASSERT_TRUE(run("One view per time"));
    settle();
    int views = 0;
    for (const auto& [pane, state] : workbench.session().views) {
        const auto* volume = std::get_if<VolumeView>(&state);
        if (!volume) continue;
        ++views;
        const ImGuiWindow* window = ImGui::FindWindowByName(("###pane." + pane).c_str());
        ASSERT_TRUE(window && volume->time) << pane;
        EXPECT_GT(coloured(window->Rect()), 300) << "at " << *volume->time;
    }
    EXPECT_EQ(views, 4);
    for (int i = 0; i < 5; ++i) {
        frame();
        EXPECT_FALSE(workbench.busy());
        EXPECT_GT(workbench.idleSeconds(), 0);
    }
}

} // namespace
} // namespace tessera::app
