#include "app/described/key_words.h"
#include "app/edits/scene_task.h"
#include "app/pane/axes3d.h"
#include "app/tools/lens_list.h"
#include "app/ui/widgets.h"
#include "tests/app/drawn_text.h"
#include "tests/app/hands_fixture.h"
#include "tests/app/views_fixture.h"
#include "tests/app/workbench_fixture.h"

#include <algorithm>
#include <gmock/gmock.h>

/// The tabs of the pane of layers: a task each, none below a fold of another, and what brings them to the front.
namespace tessera::app {
namespace {

using testing::Contains;

class TaskHands : public Hands {
protected:
    void showTask(SceneTask task, glm::ivec2 size) {
        show(LayersView{.task = task}, size, [](Session& edited) {
            edited.layers.clear();
            edited.layers.push_back({"fog", true, vis::VolumeLayer{.channel = "T"}});
            edited.layers.push_back({"plane", true, vis::SliceLayer{.channel = "T"}});
            for (const char* name : {"p", "q", "r", "s", "t", "u"}) {
                edited.lenses.push_back({.name = name});
                edited.selection.brushes.push_back(vis::rangeBrush({{"T", 353, 355, 0}}, name));
            }
        });
    }
    LayersView& layers() { return view<LayersView>(); }
    void choose(const char* tab) { click(inPane({tab}).GetCenter()); }
    ImGuiWindow* inFront() { return window(std::string(kSceneTaskNames[std::size_t(layers().task)])); }
};

constexpr const char* kTabNames[] = {"Layers", "Brushes", "Lenses", "Clips", "Light", "Picture"};

TEST_F(TaskHands, ATabShowsItsTaskRightBelowTheTabs) {
    showTask(SceneTask::Layers, {320, 440});
    // What the first lines of each say.
    constexpr const char* kFirst[] = {"fog", "p", "p", "No clips: the whole data are shown.", "Model", "Camera"};
    for (const std::size_t i : {4, 2, 5, 1, 3, 0}) {
        choose(kTabNames[i]);
        EXPECT_EQ(std::size_t(layers().task), i);
        std::vector<std::string> near;
        const float below = inPane({kTabNames[i]}).Max.y;
        for (const DrawnText& text : drawnTexts())
            if (text.min.y > below && text.max.y < below + 40) near.push_back(text.text);
        EXPECT_THAT(near, Contains(testing::HasSubstr(kFirst[i]))) << kTabNames[i];
        ASSERT_TRUE(inFront()) << kTabNames[i];
    }
    settle();
    EXPECT_EQ(steps(), 0u) << "which tab is in front is no edit";
}

TEST_F(TaskHands, EachTaskStaysWhereItWasScrolledTo) {
    showTask(SceneTask::Lenses, {320, 220});
    const auto scrollTo = [&](float by) {
        moveTo(inFront()->Rect().GetCenter());
        turnWheel(by);
        for (int i = 0; i < 3; ++i) frame();
        return inFront()->Scroll.y;
    };
    const float lenses = scrollTo(-1);
    ASSERT_GT(lenses, 0);
    choose("Brushes");
    EXPECT_EQ(inFront()->Scroll.y, 0) << "one does not scroll the other";
    const float brushes = scrollTo(-1.5f);
    ASSERT_GT(brushes, 0);
    choose("Picture");
    choose("Lenses");
    EXPECT_EQ(inFront()->Scroll.y, lenses);
    choose("Brushes");
    EXPECT_EQ(inFront()->Scroll.y, brushes);
}

TEST_F(TaskHands, TheListOfLayersStaysInSightOfTheSettings) {
    showTask(SceneTask::Layers, {320, 440});
    const auto settings = [&](const char* kind) {
        ImGuiWindow* const found = window(kind);
        EXPECT_TRUE(found) << kind;
        return found;
    };
    click(item(settings("Volume"), {"###look"}).GetCenter()); // unfolds
    moveTo(settings("Volume")->Rect().GetCenter());
    turnWheel(-0.5f);
    for (int i = 0; i < 3; ++i) frame();
    const float scrolled = settings("Volume")->Scroll.y;
    ASSERT_GT(scrolled, 0);
    EXPECT_EQ(window("layers")->Scroll.y, 0);
    click(item(window("layers"), {1, "##row"}).GetCenter());
    EXPECT_EQ(layers().selected, 1);
    EXPECT_EQ(settings("Slice")->Scroll.y, 0) << "another kind has a place of its own";
    click(item(window("layers"), {0, "##row"}).GetCenter());
    EXPECT_EQ(settings("Volume")->Scroll.y, scrolled);
}

TEST_F(TaskHands, TabsHaveRoomInAnyWidth) {
    for (const int width : {700, 420, 300, 210, 140, 90}) {
        showTask(SceneTask::Brushes, {width, 300});
        ImRect before;
        for (const char* name : kTabNames) {
            const ImRect tab = inPane({name});
            EXPECT_GE(tab.Min.x, 0) << name << width;
            EXPECT_LE(tab.Max.x, float(width)) << name << width;
            EXPECT_FALSE(tab.Overlaps(before)) << name << width;
            before = tab;
        }
        if (width >= 300) {
            EXPECT_EQ(inPane({"Layers"}).Min.y, before.Min.y) << "one row in " << width;
        }
        std::vector<std::string> texts;
        for (const DrawnText& text : drawnTexts()) texts.push_back(text.text);
        if (width >= 210) {
            EXPECT_THAT(texts, Contains(testing::HasSubstr("Brushes"))) << "the one in front has its name in " << width;
        }
    }
}

TEST_F(TaskHands, WhatIsMadeElsewhereComesToTheFrontUnfolded) {
    showTask(SceneTask::Picture, {320, 440});
    const auto unfolded = [&](std::vector<std::variant<std::string, int>> path) {
        ImGuiID id = inFront()->ID;
        for (const auto& part : path)
            id = std::holds_alternative<int>(part) ? ImHashData(&std::get<int>(part), sizeof(int), id)
                                                   : ImHashStr(std::get<std::string>(part).c_str(), 0, id);
        return inFront()->StateStorage.GetInt(id) != 0;
    };
    session().selection.brushes.push_back(vis::rangeBrush({{"T", 353, 354, 0}}, "new"));
    for (int i = 0; i < 2; ++i) frame();
    EXPECT_EQ(layers().task, SceneTask::Brushes);
    EXPECT_TRUE(unfolded({6, "###region"}));
    session().clips.emplace_back();
    for (int i = 0; i < 2; ++i) frame();
    EXPECT_EQ(layers().task, SceneTask::Clips);
    EXPECT_TRUE(unfolded({"###clips0"}));
    session().lighting.lights.emplace_back();
    for (int i = 0; i < 2; ++i) frame();
    EXPECT_EQ(layers().task, SceneTask::Light);
    EXPECT_TRUE(unfolded({"###lights1"}));
    EXPECT_FALSE(unfolded({"###lights0"}));
    session().lenses.push_back({.name = "new"});
    for (int i = 0; i < 2; ++i) frame();
    EXPECT_EQ(layers().task, SceneTask::Lenses);
    EXPECT_TRUE(unfolded({6, "###lens"}));
    EXPECT_EQ(layers().next, -1) << "once";
    // What is taken away, or comes with much else, does not.
    layers().task = SceneTask::Picture;
    session().lenses.pop_back();
    for (int i = 0; i < 2; ++i) frame();
    EXPECT_EQ(layers().task, SceneTask::Picture);
    session().lenses.push_back({.name = "new"});
    session().clips.clear();
    for (int i = 0; i < 2; ++i) frame();
    EXPECT_EQ(layers().task, SceneTask::Picture);
}

TEST_F(TaskHands, WhatIsDraggedInAViewHasItsTaskInFront) {
    VolumeView volume;
    volume.showGizmo = volume.showLegend = false;
    const glm::dvec3 lo(formula::kOrigin[0], formula::kOrigin[1], formula::kOrigin[2]);
    const volume::Box box{
        lo, lo + glm::dvec3(formula::kSpacing[0] * 7, formula::kSpacing[1] * 6, formula::kSpacing[2] * 8)};
    show(volume, {400, 300}, [&](Session& edited) {
        edited.layers.clear();
        edited.camera = {};
        edited.camera.orientation = glm::quat(1, 0, 0, 0);
        edited.camera.projection = vis::Projection::Orthographic;
        edited.views["layers"] = LayersView{};
        edited.lenses.resize(2);
        edited.lenses[0].center = box.lo;
        edited.lenses[1].center = box.center();
        edited.clips = {{.kind = vis::ClipKind::Sphere, .keep = vis::ClipKeep::Outside, .center = glm::vec3(0.2f)}};
    });
    const ImRect picture = pictures().back();
    const auto pixel = [&](glm::dvec3 share) {
        return *spaceFrame(picture.Min, picture.Max, session().camera, box, session().stretch)
                    .pixel(box.lo + share * box.size());
    };
    const auto pane = [&]() -> LayersView& { return std::get<LayersView>(session().views.at("layers")); };
    const ImVec2 clip = pixel(glm::dvec3(0.2));
    drag(clip, {clip.x + 5, clip.y});
    EXPECT_NE(session().clips[0].center.x, 0.2f);
    EXPECT_EQ(pane().task, SceneTask::Clips);
    EXPECT_EQ(pane().next, 0);
    const ImVec2 lens = pixel(glm::dvec3(0.5));
    drag(lens, {lens.x + 20, lens.y});
    EXPECT_NE(session().lenses[1].center, box.center());
    EXPECT_EQ(pane().task, SceneTask::Lenses);
    EXPECT_EQ(pane().next, 1);
    settle();
    EXPECT_EQ(steps(), 2u) << "the drags alone";
}

TEST(SceneTasks, OfSeveralPanesTheOneThatShowsATaskTakesWhatIsNew) {
    Session session;
    session.views["a"] = LayersView{};
    session.views["b"] = LayersView{.task = SceneTask::Lenses};
    const auto at = [&](const char* pane) { return std::get<LayersView>(session.views.at(pane)); };
    EXPECT_EQ(turnToTask(session, SceneTask::Lenses, 3), "b");
    EXPECT_EQ(at("a"), LayersView{});
    EXPECT_EQ(at("b").next, 3);
    EXPECT_EQ(turnToTask(session, SceneTask::Clips), "a");
    EXPECT_EQ(at("a").task, SceneTask::Clips);
    EXPECT_EQ(turnToTask(session, SceneTask::Layers, 2), "a");
    EXPECT_EQ(at("a").selected, 2);
    EXPECT_EQ(at("a").next, -1) << "a layer has no line to unfold";
    EXPECT_TRUE(takesTask(session, "b", SceneTask::Lenses));
    EXPECT_FALSE(takesTask(session, "a", SceneTask::Lenses));
    session.views.clear();
    EXPECT_EQ(turnToTask(session, SceneTask::Clips), "");
}

TEST(SceneTasks, ThePaneComesToTheFrontOfItsStack) {
    Session session;
    session.views["data"] = DataView{};
    session.views["layers"] = LayersView{};
    session.views["volume"] = VolumeView{};
    session.dock.root.tabs = {"data", "layers"};
    session.dock.root.active = 0;
    session.dock.maximised = "volume";
    showTask(session, SceneTask::Lenses);
    EXPECT_EQ(session.dock.root.active, 0) << "not over a pane that fills the window";
    session.dock.maximised.clear();
    showTask(session, SceneTask::Lenses);
    EXPECT_EQ(session.dock.root.active, 1);
}

class TaskTexts : public ViewsTest {
protected:
    /// All that a task draws with every section unfolded.
    std::vector<std::string> of(SceneTask task) {
        layersView.task = task;
        ImGui::GetIO().DisplaySize.y = 4000; // nothing is cut off
        const auto body = [&] { draw("layers", layersView, drawLayersView, {720, 4000}); };
        for (int i = 0; i < 3; ++i) frame(body);
        said(body); // a frame that is logged unfolds sections
        std::vector<std::string> texts;
        for (const DrawnText& text : drawnTexts()) texts.push_back(text.text);
        return texts;
    }
    /// The labels of members that have a widget.
    template <class T> static std::vector<std::string> labels(T& value) {
        std::vector<std::string> names;
        const std::function<void(Value)> collect = [&](Value of) {
            of.visitMembers([&](Value member, const FieldInfo& field) {
                if (field.hidden || !field.applies) return;
                if (member.kind() != ValueKind::Variant) names.push_back(labelOf(field.key));
                if (member.kind() == ValueKind::Struct) collect(member);
                if (member.kind() == ValueKind::Variant) collect(member.inside());
            });
        };
        collect(valueOf(value));
        return names;
    }
    void expectLabels(const std::vector<std::string>& texts, std::vector<std::string> names) {
        for (const std::string& name : names)
            EXPECT_TRUE(std::ranges::any_of(texts, [&](const std::string& text) {
                return text == name || text.starts_with(name + " ");
            })) << name;
    }
};

TEST_F(TaskTexts, EverySettingIsBelowOneOfTheTabs) {
    show(fuelCell(volume::LatticeKind::CC));
    for (vis::Technique technique :
         {vis::Technique(vis::VolumeLayer{.channel = "T"}), vis::Technique(vis::IsoLayer{.channel = "T"}),
          vis::Technique(vis::SliceLayer{.channel = "T"}),
          vis::Technique(vis::FlowLayer{.vector = "U", .channel = "T"})}) {
        session.layers = {{"layer", true, technique}};
        std::vector<std::string> names = labels(session.layers[0]);
        for (const char* other : {"Visible", "Lens", "Transfer"}) std::erase(names, other);
        if (!std::holds_alternative<vis::IsoLayer>(technique)) names.emplace_back("Own transfer");
        expectLabels(of(SceneTask::Layers), names);
    }
    session.lenses.resize(1);
    expectLabels(of(SceneTask::Lenses), labels(session.lenses[0]));
    expectLabels(of(SceneTask::Layers), {"Drawn"});
    expectLabels(of(SceneTask::Brushes), labels(session.selection));
    session.clips.resize(1);
    expectLabels(of(SceneTask::Clips), labels(session.clips[0]));
    for (const vis::LightModel model : {vis::LightModel::Phong, vis::LightModel::Physical}) {
        session.lighting.model = model;
        std::vector<std::string> names = labels(session.lighting);
        std::replace(names.begin(), names.end(), std::string("Lights"), std::string("Light 1"));
        expectLabels(of(SceneTask::Light), names);
        expectLabels(of(SceneTask::Light), labels(session.lighting.lights[0]));
    }
    session.paper.emplace();
    session.tone.curve = vis::ToneCurve::Reinhard;
    const std::vector<std::string> picture = of(SceneTask::Picture);
    expectLabels(picture, labels(*session.paper));
    expectLabels(picture, labels(session.tone));
    expectLabels(picture, labels(session.camera));
    expectLabels(picture, labels(session.render));
    expectLabels(picture, {"Stretch", "True proportions"});
}

class TaskKeys : public DrawnWorkbench {
protected:
    void SetUp() override {
        Opened opened = smallData();
        opened.document.session.dock.maximised = "transfer"; // soon drawn
        opened.document.history.reset(opened.document.session);
        workbench.install(std::move(opened));
        settle();
    }
    LayersView& layers() { return std::get<LayersView>(workbench.session().views.at("layers")); }
};

TEST_F(TaskKeys, AltAndADigitShowATask) {
    for (const int digit : {3, 6, 1, 5, 2, 4}) {
        for (const bool down : {true, false})
            frame([&](ImGuiIO& io) {
                feedModifiers(io, false, false, true);
                feedKey(io, '0' + digit, down);
            });
        frame([](ImGuiIO& io) { feedModifiers(io, false, false, false); });
        EXPECT_EQ(int(layers().task), digit - 1);
        EXPECT_EQ(workbench.session().dock.maximised, "layers") << "in place of the one that fills the window";
    }
}

TEST_F(TaskKeys, ATabIsChosenByTheKeyboard) {
    run("Settings: layers");
    settle();
    press(key::kTab); // the first thing in the pane is the row of tabs
    ASSERT_TRUE(GImGui->NavWindow);
    EXPECT_NE(std::string_view(GImGui->NavWindow->Name).find("###pane.layers"), std::string_view::npos);
    for (int i = 0; i < 3; ++i) frame();
    press(key::kRight);
    frame();
    press(key::kRight);
    frame();
    press(key::kSpace);
    for (int i = 0; i < 2; ++i) frame();
    EXPECT_EQ(layers().task, SceneTask::Lenses);
}

TEST_F(TaskKeys, ThePaletteFindsEachTask) {
    for (const auto& [typed, wanted] : {std::pair{"lenses", "Settings: lenses"},
                                        {"brushes", "Settings: brushes"},
                                        {"clips", "Settings: clips"},
                                        {"clipping", "Settings: clips"},
                                        {"paper", "Settings: picture"},
                                        {"quality", "Settings: picture"},
                                        {"settings light", "Settings: light"},
                                        {"tone curve", "Settings: picture"}}) {
        const auto found = matchingCommands(typed, workbench.commands());
        EXPECT_TRUE(std::ranges::any_of(found, [&](const Command* each) { return each->title() == wanted; })) << typed;
    }
    EXPECT_EQ(matchingCommands("lenses", workbench.commands()).front()->title(), "Settings: lenses");
}

TEST_F(TaskKeys, WhatACommandAddsIsInFront) {
    workbench.session().dock.maximised.clear();
    for (const auto& [name, task] : {std::pair{"Add clip: box", SceneTask::Clips},
                                     {"Add light", SceneTask::Light},
                                     {"Add lens: enhance", SceneTask::Lenses},
                                     {"Brush a box at the cross-hair", SceneTask::Brushes},
                                     {"Add slice layer", SceneTask::Layers}}) {
        ASSERT_TRUE(run(name)) << name;
        EXPECT_EQ(layers().task, task) << name;
        for (int i = 0; i < 3; ++i) frame();
        EXPECT_EQ(layers().task, task) << name << ", drawn";
    }
}

} // namespace
} // namespace tessera::app
