#include "tests/app/workbench_fixture.h"

#include <algorithm>

/// The palette finds every pane and action, by the words that people have for it.
namespace tessera::app {
namespace {

class Palette : public DrawnWorkbench {
protected:
    void SetUp() override {
        OpenRequest request;
        request.data.emplace();
        request.data->model = "fuel-cell";
        request.data->settings = {{"nx", 9}, {"ny", 9}, {"nz", 21}, {"times", 3}};
        Opened opened = open(request);
        opened.document.session.dock.maximised = "layers"; // soon drawn
        opened.document.history.reset(opened.document.session);
        workbench.install(std::move(opened));
        settle();
    }
    std::vector<std::string> found(const std::string& typed) const {
        std::vector<std::string> names;
        for (const Command* command : matchingCommands(typed, workbench.commands())) names.push_back(command->title());
        return names;
    }
    bool finds(const std::string& typed, const std::string& wanted) const {
        return std::ranges::count(found(typed), wanted) == 1;
    }
    void type(const std::string& text) {
        for (const char c : text) frame([c](ImGuiIO& io) { io.AddInputCharacter(static_cast<unsigned char>(c)); });
    }
};

TEST_F(Palette, FindsByOtherWords) {
    for (const auto& [typed, wanted] : {std::pair{"flow", "Add flow layer"},
                                        {"streamlines", "Add flow layer"},
                                        {"screenshot", "Save picture..."},
                                        {"save picture", "Save picture..."},
                                        {"picture save", "Save picture..."},
                                        {"png", "Save picture..."},
                                        {"isosurface", "Add iso-surface layer"},
                                        {"contour", "Add iso-surface layer"},
                                        {"contour", "New: Slices"},
                                        {"legend", "Show legends"},
                                        {"color bar", "Show legends"},
                                        {"undo", "Undo"},
                                        {"undo", "New: History"},
                                        {"dark", "Light theme"},
                                        {"full screen", "Maximise pane"},
                                        {"exit", "Quit"},
                                        {"load", "Open..."},
                                        {"mesh", "Export surface..."},
                                        {"movie", "Play"},
                                        {"sphere", "Brush a sphere at the cross-hair"},
                                        {"orthographic", "Parallel projection"},
                                        {"histogram", "New: Histogram"},
                                        {"charcoal", "Look: charcoal"},
                                        {"drawing style", "Look: hatching"},
                                        {"formula", "Add derived parameter: formula"},
                                        {"add formula", "Add derived parameter: formula"},
                                        {"gradient", "Add derived parameter: gradient"},
                                        {"vorticity", "Add derived parameter: vorticity"},
                                        {"divergence", "Add derived parameter: divergence"},
                                        {"curl", "Add derived parameter: vorticity"},
                                        {"export table", "Export table..."},
                                        {"csv", "Export table..."},
                                        {"versus", "Compare with another file..."},
                                        {"difference", "Compare with another file..."}})
        EXPECT_TRUE(finds(typed, wanted)) << typed << " should find " << wanted;
    EXPECT_EQ(found("flow").front(), "Add flow layer");
    EXPECT_EQ(found("screenshot").front(), "Save picture...");
    EXPECT_TRUE(finds("undo", "Undo")) << "also with nothing to undo";
    ASSERT_FALSE(run("Undo"));
}

TEST_F(Palette, HasEveryPaneAndEveryItemOfAMenu) {
    forEachViewKind([&]<class Kind>(const Kind& kind) {
        const std::string title(kind.traits.title);
        ASSERT_FALSE(found(title).empty()) << title;
        EXPECT_TRUE(finds(title, "New: " + title));
        EXPECT_FALSE(kind.traits.words.empty()) << title << " has no other words";
    });
    for (const Command& command : workbench.commands()) {
        EXPECT_TRUE(finds(command.title(), command.title()));
        EXPECT_FALSE(command.words.empty()) << command.title() << " has no other words";
    }
    // What the menu of a volume and the lists of layers, brushes and lenses offer.
    for (const char* item : {"box",
                             "axes",
                             "legends",
                             "cross-hair",
                             "direction gizmo",
                             "scale bar",
                             "outlines and handles",
                             "parallel projection",
                             "sphere at the cross-hair",
                             "box at the cross-hair",
                             "clear brushes",
                             "inside the lens",
                             "legends of drawings",
                             "box and cross-hair of drawings",
                             "data in space",
                             "seed brushed",
                             "look: charcoal",
                             "soft pencil",
                             "lens: another parameter",
                             "lens: an iso-surface",
                             "lens: cut away",
                             "lens: only this",
                             "lens: enhance",
                             "lens: suppress",
                             "lens: magnify",
                             "lens: brushes inside",
                             "volume layer",
                             "iso-surface layer",
                             "slice layer",
                             "flow layer",
                             "save picture",
                             "front",
                             "back",
                             "left",
                             "right",
                             "top",
                             "below",
                             "isometric",
                             "reset view"}) {
        const std::vector<const Command*> match = matchingCommands(item, workbench.commands());
        ASSERT_FALSE(match.empty()) << item;
        const std::string name = match.front()->menu + ": " + match.front()->title();
        EXPECT_GE(matchScore(item, name, match.front()->words), kWholeWords) << item;
    }
}

// What it adds is selected, and gone again by one step back.
TEST_F(Palette, ALensOfAnotherParameterAndSeedsInTheSelectionAreOneStepEach) {
    const auto selected = [&] { return std::get<LayersView>(workbench.session().views.at("layers")).selected; };
    const Session start = workbench.session();
    ASSERT_TRUE(run("Lens: another parameter"));
    settle();
    const Session lens = workbench.session();
    ASSERT_EQ(lens.layers.size(), start.layers.size() + 1);
    ASSERT_EQ(lens.lenses.size(), start.lenses.size() + 1);
    EXPECT_EQ(lens.layers.back().lens, lens.lenses.back().name);
    const std::string other = std::get<vis::VolumeLayer>(lens.layers.back().technique).channel;
    for (const vis::Layer& layer : start.layers)
        EXPECT_NE(std::visit([](const auto& own) { return own.channel; }, layer.technique), other);
    EXPECT_EQ(selected(), int(start.layers.size()));
    ASSERT_TRUE(run("Undo"));
    settle();
    Session undone = workbench.session();
    EXPECT_EQ(std::get<LayersView>(undone.views.at("layers")).task, SceneTask::Lenses) << "the tab in front is no edit";
    std::get<LayersView>(undone.views.at("layers")).task = SceneTask::Layers;
    EXPECT_TRUE(undone == start);

    ASSERT_FALSE(run("Seed brushed")) << "there is no flow";
    ASSERT_TRUE(run("Add flow layer"));
    settle();
    const Session flow = workbench.session();
    ASSERT_FALSE(run("Look: charcoal")) << "flow is selected, which has no look";
    ASSERT_TRUE(run("Seed brushed"));
    settle();
    EXPECT_TRUE(std::get<vis::FlowLayer>(workbench.session().layers.back().technique).seedBrushed);
    ASSERT_TRUE(run("Undo"));
    settle();
    EXPECT_TRUE(workbench.session() == flow);
}

TEST_F(Palette, AddsWhatItNames) {
    const std::size_t before = workbench.session().layers.size();
    ASSERT_TRUE(run("Add slice with strokes"));
    settle();
    ASSERT_EQ(workbench.session().layers.size(), before + 1);
    const auto* slice = std::get_if<vis::SliceLayer>(&workbench.session().layers.back().technique);
    ASSERT_TRUE(slice);
    EXPECT_EQ(slice->strokes.vector, "U");
}

TEST_F(Palette, ADerivedParameterIsAddedAndItsPanelShown) {
    ASSERT_TRUE(run("Add derived parameter: vorticity"));
    settle();
    EXPECT_EQ(workbench.session().data.derived.back().name, "curl U");
    EXPECT_EQ(workbench.session().dock.maximised, "data") << "the panel is seen";
    EXPECT_TRUE(workbench.source()->info().findChannel("|curl U|").has_value());
}

TEST_F(Palette, TheTableOfThePaneClickedLastIsExported) {
    ASSERT_FALSE(run("Export table...")) << "the list of layers has none";
    ASSERT_TRUE(run("New: Histogram"));
    settle();
    ASSERT_TRUE(run("Export table..."));
    for (int i = 0; i < 3; ++i) frame();
    EXPECT_TRUE(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel))
        << "a file is asked";
    press(key::kEscape);
}

TEST_F(Palette, TheSelectionIsSavedAsATable) {
    ASSERT_FALSE(run("Save the selection as a table...")) << "nothing is brushed";
    addBrush("starved");
    const std::size_t views = workbench.session().views.size();
    ASSERT_TRUE(run("Save the selection as a table..."));
    for (int i = 0; i < 3; ++i) frame();
    EXPECT_EQ(workbench.session().views.size(), views + 1) << "a table of it is shown";
    EXPECT_TRUE(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel))
        << "a file is asked";
    press(key::kEscape);
}

TEST_F(Palette, ExtremesOfTheDataAreFound) {
    const glm::dvec3 before = workbench.session().cursor;
    workbench.palette().open = true;
    for (int i = 0; i < 3; ++i) frame();
    type("maximum of");
    press(key::kEnter);
    settle();
    EXPECT_NE(workbench.session().cursor, before);
}

TEST_F(Palette, WhatIsTypedIsRunByEnter) {
    const std::size_t layers = workbench.session().layers.size();
    workbench.palette().open = true;
    for (int i = 0; i < 3; ++i) frame();
    type("flow");
    press(key::kEnter);
    for (int i = 0; i < 3; ++i) frame();
    ASSERT_EQ(workbench.session().layers.size(), layers + 1);
    EXPECT_TRUE(std::holds_alternative<vis::FlowLayer>(workbench.session().layers.back().technique));
    EXPECT_EQ(std::get<LayersView>(workbench.session().views.at("layers")).selected, int(layers));
}

// Enter runs nothing that is not possible, and what is typed next takes the place of the text.
TEST_F(Palette, EnterOnWhatIsNotPossibleKeepsTheHands) {
    const std::size_t layers = workbench.session().layers.size();
    workbench.palette().open = true;
    for (int i = 0; i < 3; ++i) frame();
    type("undo");
    press(key::kEnter);
    for (int i = 0; i < 3; ++i) frame();
    EXPECT_TRUE(workbench.palette().shown);
    EXPECT_EQ(workbench.palette().text, "undo");
    type("flow");
    EXPECT_EQ(workbench.palette().text, "flow");
    press(key::kEnter);
    for (int i = 0; i < 3; ++i) frame();
    EXPECT_FALSE(workbench.palette().shown);
    EXPECT_EQ(workbench.session().layers.size(), layers + 1);
}

} // namespace
} // namespace tessera::app
