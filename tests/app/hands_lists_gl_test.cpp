#include "app/data/boundary_value.h"
#include "app/pane/view_parts.h"
#include "tests/app/hands_fixture.h"

#include <algorithm>

/// The mouse in lists: layers and lenses are ordered, hidden and removed; what the pane of the data offers.
namespace tessera::app {
namespace {

class ListHands : public Hands {
protected:
    void showLists(SceneTask task = SceneTask::Layers, glm::ivec2 size = {420, 900}) {
        show(LayersView{.selected = 1, .task = task}, size, [](Session& edited) {
            edited.layers.clear();
            for (const char* name : {"a", "b", "c", "d"})
                edited.layers.push_back({name, true, vis::SliceLayer{.channel = "T"}});
            for (const char* name : {"p", "q", "r"})
                edited.lenses.push_back({.name = name, .center = {0.0135, 0.006, 0}});
        });
    }
    /// The pane below the tabs, of the layers their list.
    ImGuiWindow* inFront() { return window(std::string(kSceneTaskNames[std::size_t(view<LayersView>().task)])); }
    ImVec2 at(std::vector<std::variant<std::string, int>> path) { return item(inFront(), path).GetCenter(); }
    /// A button below the list of layers.
    ImVec2 button(const char* name) { return inPane({name}).GetCenter(); }
    using Hands::button;
    std::string layers() {
        std::string names;
        for (const vis::Layer& layer : session().layers) names += layer.name;
        return names;
    }
    std::string lenses() {
        std::string names;
        for (const vis::Lens& lens : session().lenses) names += lens.name;
        return names;
    }
    /// Whether a line of a list shows what is under it.
    bool unfolded(const std::vector<std::variant<std::string, int>>& path) {
        ImGuiWindow* const in = inFront();
        ImGuiID id = in->ID;
        for (const auto& part : path)
            id = std::holds_alternative<int>(part) ? ImHashData(&std::get<int>(part), sizeof(int), id)
                                                   : ImHashStr(std::get<std::string>(part).c_str(), 0, id);
        return in->StateStorage.GetInt(id) != 0;
    }
    int selected() { return view<LayersView>().selected; }
};

TEST_F(ListHands, LayersTakeThePlaceTheyAreDroppedOn) {
    showLists();
    const Session before = session();
    drag(at({0, "##row"}), at({2, "##row"}));
    EXPECT_EQ(layers(), "bcad");
    EXPECT_EQ(selected(), 2) << "what was dragged is selected";
    settle();
    EXPECT_EQ(steps(), 1u);
    undo();
    EXPECT_TRUE(session() == before) << apart(before);
    drag(at({3, "##row"}), at({1, "##row"}));
    EXPECT_EQ(layers(), "adbc");
    EXPECT_EQ(selected(), 1);
    const ImVec2 row = at({1, "##row"});
    drag(row, {row.x, row.y + 4000});
    EXPECT_EQ(layers(), "adbc") << "dropped nowhere";
}

TEST_F(ListHands, LayersAreSelectedHiddenCopiedAndRemoved) {
    showLists();
    click(at({2, "##row"}));
    EXPECT_EQ(selected(), 2);
    click(at({3, "##eye"}));
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(session().layers[i].visible, i != 3);
    EXPECT_EQ(selected(), 2) << "the eye selects nothing";
    click(at({3, "##eye"}));
    EXPECT_TRUE(session().layers[3].visible);
    click(button("##copy"));
    EXPECT_EQ(layers(), "abcc copyd");
    EXPECT_EQ(selected(), 3);
    EXPECT_EQ(session().layers[3].technique, session().layers[2].technique);
    click(button("##remove"));
    EXPECT_EQ(layers(), "abcd");
    click(button("##remove"));
    EXPECT_EQ(layers(), "abc");
    EXPECT_EQ(selected(), 2) << "the last one after the last one was removed";
    for (int i = 0; i < 3; ++i) click(button("##remove"));
    EXPECT_TRUE(session().layers.empty());
    click(button("##add"));
    ASSERT_TRUE(popup());
    click(item(popup(), {"Iso-surface"}).GetCenter());
    ASSERT_EQ(session().layers.size(), 1u);
    EXPECT_TRUE(std::holds_alternative<vis::IsoLayer>(session().layers[0].technique));
}

TEST_F(ListHands, EveryKindOfLayerIsAdded) {
    showLists();
    const auto added = [&](const char* kind) {
        click(button("##add"));
        EXPECT_TRUE(popup());
        click(item(popup(), {kind}).GetCenter());
        return session().layers.back().technique;
    };
    const std::string channel = std::get<vis::VolumeLayer>(added("Volume")).channel;
    EXPECT_EQ(channel, "T");
    const vis::Technique surface = added("Iso-surface");
    EXPECT_EQ(std::get<vis::IsoLayer>(surface).channel, channel);
    const int index = *workbench.source()->info().findChannel(channel);
    const int time = workbench.source()->info().nearestTime(session().time);
    EXPECT_FLOAT_EQ(float(std::get<vis::IsoLayer>(surface).value),
                    float(*surfaceValue(*workbench.source(), index, time)));
    EXPECT_EQ(std::get<vis::SliceLayer>(added("Slice")).channel, channel);
    const vis::Technique flow = added("Flow");
    EXPECT_EQ(std::get<vis::FlowLayer>(flow).vector, "U");
    EXPECT_EQ(std::get<vis::FlowLayer>(flow).channel, "|U|");
    const auto glyphs = std::get<vis::GlyphLayer>(added("Glyphs"));
    EXPECT_FALSE(glyphs.parts.empty()) << "it shows something at once";
    EXPECT_EQ(session().layers.size(), 9u);
}

TEST_F(ListHands, PartsOfAGlyphAreMovedByTheParametersChosenForThem) {
    show(LayersView{}, {460, 1600}, [](Session& edited) {
        edited.layers = {{"", true, vis::GlyphLayer{.channel = "T", .parts = {{"spoke 1", "T", {0, 0}}}}}};
    });
    const auto glyphs = [&] { return std::get<vis::GlyphLayer>(session().layers[0].technique); };
    const auto inSettings = [&](const char* name) {
        return item(window("Glyphs"), {"###parts", std::string("##") + name}).GetCenter();
    };
    const auto choose = [&](const char* part, const char* channel) {
        click(inSettings(part));
        ASSERT_TRUE(popup()) << part;
        click(item(popup(), {channel}).GetCenter());
    };
    click(item(window("Glyphs"), {"###parts"}).GetCenter());
    const Session before = session();
    choose("spoke 2", "c");
    ASSERT_EQ(glyphs().parts.size(), 2u);
    EXPECT_EQ(glyphs().parts[1], (vis::GlyphPart{"spoke 2", "c", {0, 0}})) << "by the range of the parameter";
    settle();
    EXPECT_EQ(steps(), 1u);
    undo();
    EXPECT_TRUE(session() == before) << apart(before);
    choose("spoke 1", "none");
    EXPECT_TRUE(glyphs().parts.empty()) << "at rest";
    choose("size", "|U|");
    choose("spoke 3", "T");
    ASSERT_EQ(glyphs().parts.size(), 2u);
    // Another kind shows the same parameters by its own parts.
    click(item(window("Glyphs"), {"##kind"}).GetCenter());
    ASSERT_TRUE(popup());
    click(item(popup(), {"Bars"}).GetCenter());
    EXPECT_EQ(glyphs().kind, vis::GlyphKind::Bars);
    ASSERT_EQ(glyphs().parts.size(), 2u);
    EXPECT_EQ(glyphs().parts[0].part, "size");
    EXPECT_EQ(glyphs().parts[1].part, "bar 1");
    EXPECT_EQ(glyphs().parts[1].channel, "T");
}

TEST_F(ListHands, ALayerIsNamedAfterWhatItShowsUntilTheUserNamesIt) {
    showLists();
    const auto title = [&] { return layerTitle(session().layers.back(), workbench.numbers()->info()); };
    click(button("##add"));
    ASSERT_TRUE(popup());
    click(item(popup(), {"Iso-surface"}).GetCenter());
    ASSERT_EQ(session().layers.size(), 5u);
    EXPECT_EQ(selected(), 4) << "the new one is selected";
    auto& surface = std::get<vis::IsoLayer>(session().layers.back().technique);
    surface.channel = "T";
    surface.value = 350;
    EXPECT_EQ(title(), "T surface 350 K");
    surface.value = 340;
    EXPECT_EQ(title(), "T surface 340 K");
    session().layers.back().technique = vis::SliceLayer{.channel = "c", .orientation = vis::SliceOrientation::X};
    EXPECT_EQ(title(), "c slice x");
    settle();
    // Its name is a field that says so; what is typed stays.
    click(item(window("Slice"), {"##name"}).GetCenter());
    for (const char c : std::string("inlet")) ImGui::GetIO().AddInputCharacter(static_cast<unsigned>(c)), frame();
    press(key::kEnter);
    EXPECT_EQ(title(), "inlet");
    session().layers.back().technique = vis::VolumeLayer{.channel = "T"};
    EXPECT_EQ(title(), "inlet");
    session().layers.back().name.clear();
    EXPECT_EQ(title(), "T volume");
}

TEST_F(ListHands, SeveralBrushesAreClearedByTheCommandThatAsks) {
    showLists(SceneTask::Brushes);
    session().selection.brushes.resize(2);
    settle();
    moveTo(at({"Clear all"}));
    button(0, true);
    button(0, false);
    EXPECT_EQ(session().selection.brushes.size(), 2u) << "the list itself clears nothing";
    frame();
    EXPECT_TRUE(session().selection.brushes.empty()) << "without a window the question is answered with yes";
}

TEST_F(ListHands, ANewClipIsUnfolded) {
    showLists(SceneTask::Clips);
    for (const int number : {0, 1}) {
        click(at({"Add clip"}));
        ASSERT_EQ(int(session().clips.size()), number + 1);
        EXPECT_TRUE(unfolded({"###clips" + std::to_string(number)})) << number;
    }
}

TEST_F(ListHands, ANewBrushOrLensIsUnfoldedAndTheOthersAreNot) {
    showLists(SceneTask::Lenses);
    click(at({"##add lens"}));
    ASSERT_TRUE(popup());
    click(item(popup(), {"Lens: enhance"}).GetCenter());
    ASSERT_EQ(session().lenses.size(), 4u);
    frame();
    EXPECT_TRUE(unfolded({3, "###lens"}));
    for (const int other : {0, 1, 2}) EXPECT_FALSE(unfolded({other, "###lens"}));
    click(at({"##add lens"}));
    click(item(popup(), {"Lens: suppress"}).GetCenter());
    frame();
    EXPECT_TRUE(unfolded({4, "###lens"}));
    EXPECT_FALSE(unfolded({3, "###lens"})) << "the newest alone";
}

TEST_F(ListHands, LensesAreOrderedByTheirGripsAndSwitches) {
    showLists(SceneTask::Lenses);
    drag(at({0, "##grip"}), at({2, "##grip"}));
    EXPECT_EQ(lenses(), "qrp");
    settle();
    EXPECT_EQ(steps(), 1u);
    drag(at({2, "##grip"}), at({0, "##grip"}));
    EXPECT_EQ(lenses(), "pqr");
    click(at({1, "##up"}));
    EXPECT_EQ(lenses(), "qpr");
    click(at({0, "##up"}));
    EXPECT_EQ(lenses(), "qpr") << "the first one has none above";
    click(at({1, "##enabled"}));
    click(at({2, "##invert"}));
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(session().lenses[i].enabled, i != 1);
        EXPECT_EQ(session().lenses[i].inverted, i == 2);
    }
    click(at({0, "##delete"}));
    EXPECT_EQ(lenses(), "pr");
}

class DataHands : public Hands {
protected:
    ImVec2 at(std::vector<std::variant<std::string, int>> path) { return item(window("data"), path).GetCenter(); }
};

TEST_F(DataHands, ANameOfALabelOpensTheNamesOfItsValues) {
    show(DataView{}, {460, 1000});
    click(at({"parameters", "region", "region"}));
    ASSERT_TRUE(popup());
    const ImRect west = item(popup(), {formula::kWest, "##name"}), east = item(popup(), {formula::kEast, "##name"});
    EXPECT_LT(west.Max.y, east.Min.y + 1) << "in the order of the values";
    press(key::kEscape);
    EXPECT_FALSE(popup());
}

TEST_F(DataHands, ADerivedParameterIsAddedAndRemoved) {
    show(DataView{}, {460, 1000});
    click(at({"Add..."}));
    ASSERT_TRUE(popup());
    click(item(popup(), {"Gradient"}).GetCenter());
    settle();
    ASSERT_EQ(session().data.derived.size(), 1u);
    const volume::DerivedParameter& made = session().data.derived[0];
    EXPECT_EQ(made.name, "grad T");
    EXPECT_EQ(made.unit, "K/m");
    EXPECT_TRUE(workbench.numbers()->info().findChannel("grad T")) << "it is there like any other";
    click(at({0, "###one", "Remove"}));
    settle();
    EXPECT_TRUE(session().data.derived.empty());
    EXPECT_FALSE(workbench.numbers()->info().findChannel("grad T"));
}

TEST_F(ListHands, TheLatticeOfPicturesIsChosen) {
    showLists(SceneTask::Picture, {460, 2400});
    ASSERT_EQ(session().data.lattice, PictureLattice::BodyCentred);
    click(at({"/data/lattice", "##lattice"}));
    ASSERT_TRUE(popup());
    moveTo(item(popup(), {"Grid"}).GetCenter());
    button(0, true);
    button(0, false); // no frame more: the workbench would compute them
    EXPECT_EQ(session().data.lattice, PictureLattice::Grid);
}

} // namespace
} // namespace tessera::app
