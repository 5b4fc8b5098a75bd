#include "app/data/apply_layout.h"
#include "app/data/open.h"
#include "app/described/key_words.h"
#include "app/edits/context_style.h"
#include "app/session/shown_scene.h"
#include "app/tools/lens_list.h"
#include "tests/app/workbench_fixture.h"

#include <algorithm>
#include <functional>
#include <gtest/gtest.h>
#include <map>
#include <set>

/// Every command of the menus and the palette: what it changes, by menu and by key, and that undo takes it back
/// exactly.
namespace tessera::app {
namespace {

using Check = std::function<void(const Session& before, const Session& after)>;

/// Commands that change no session, with the test that tries them.
const std::set<std::string> kElsewhere = {
    "Open...",                                    // tests/e2e/window.sh
    "Save session",                               // WorkbenchLeaving.ACancelledSaveLeavesEverythingAsItIs
    "Save session as...",                         // the same
    "Pack into an archive...",                    // WorkbenchData.WhatIsEditedWhilePackingStays
    "Compare with another file...",               // ComparedFiles
    "Save picture...",                            // tests/e2e/window.sh
    "Export table...",                            // Palette.TheTableOfThePaneClickedLastIsExported
    "Save the selection as a table...",           // Palette.TheSelectionIsSavedAsATable
    "Export surface...",                          // AsyncQueries, tests/e2e/mesh.sh
    "Both grids of D4* or BCC",                   // WorkbenchData.OneGridOfAnArchiveInSpaceAndTimeIsAStepOfTheHistory
    "First grid of D4* or BCC alone, as stored",  // the same
    "Second grid of D4* or BCC alone, as stored", // the same
    "Draw grids with uneven spacing to scale",    // UnevenData.PicturesToScaleAreAStepOfTheHistory
    "Cancel jobs",                                // WorkbenchData.CancelJobsLeavesThoseThatAreNotListed
    "Copy session",                               // CommandTable.ASessionGoesThroughTheClipboard
    "Paste session",                              // the same
    "Quit",                                       // WorkbenchGl.WhatIsNotSavedIsNotGivenUpUnasked
    "Undo",                                       // every case here
    "Redo",                                       // every case here
    "Add flow layer",                             // Palette.FindsByOtherWords
    "Add slice with strokes",                     // Palette.AddsWhatItNames
    "Seed brushed",                               // Palette.ALensOfAnotherParameterAndSeedsInTheSelectionAreOneStepEach
    "Add derived parameter: divergence",          // Palette.FindsByOtherWords, they need a vector
    "Add derived parameter: vorticity",           // the same
    "Lens: another parameter",                    // the same
    "Data in space",                              // TimeAlongWorkbench.TheDataInSpaceStandBesideAsTheyWere
    "Shortcuts",                                  // CommandTable.HelpAndPaletteOpen
    "Menu bar",                                   // Keyboard.AltAndF10OpenTheMenusAndArrowsWalkThem
    "Next part of the window",                    // Keyboard.F6GoesToEveryPaneAndBack
    "Previous part of the window",                // the same
    "Next tab",                                   // Keyboard.CtrlPageDownGoesThroughTheTabs
    "Previous tab",                               // the same
    "Command palette",                            // the same
    "About Tessera",
    "One view per parameter", // Multiples.ShowEachParameterAndUndoRestoresTheDock
    "One view per time",      // Multiples.ShowTimesWithOneLegend
    "Play",                   // tests/app/views_playback_test.cpp, and below for its state
    "Look from the front",    // WorkbenchMenus.CameraCommandsActOnAVolume, tests/app/camera_controller_gl_test.cpp
    "Look from the right",
    "Look from the top",
    "Look isometric",
    "Parallel projection",
    "Reset the camera",
};

Check added(std::string_view kind) {
    return [kind](const Session& before, const Session& after) {
        ASSERT_EQ(after.views.size(), before.views.size() + 1);
        std::string pane;
        for (const auto& [name, view] : after.views)
            if (!before.views.contains(name)) pane = name;
        const ViewState wanted = *viewOfKind(kind);
        EXPECT_TRUE(after.views.at(pane) == wanted);
        EXPECT_TRUE(std::ranges::count(paneKeys(after), pane) == 1);
    };
}

/// A view without settings is shown instead of a second one, where there is one.
Check shown(std::string_view kind) {
    return [kind](const Session& before, const Session& after) {
        EXPECT_EQ(after.views.size(), before.views.size());
        EXPECT_EQ(before.dock.maximised, "layers");
        EXPECT_EQ(after.dock.maximised, kind);
        std::vector<std::string> front;
        const std::function<void(const DockNode&)> look = [&](const DockNode& node) {
            for (const DockNode& child : node.children) look(child);
            if (!node.tabs.empty()) front.push_back(node.tabs.at(std::size_t(node.active)));
        };
        look(after.dock.root);
        EXPECT_EQ(std::ranges::count(front, kind), 1);
    };
}

Check scaled(float by) {
    return [by](const Session& before, const Session& after) {
        EXPECT_NEAR(after.appearance.scale, before.appearance.scale * by, 0.03);
        EXPECT_EQ(after.appearance.scale > before.appearance.scale, by > 1);
    };
}

Check timeOf(double time) {
    return [time](const Session&, const Session& after) { EXPECT_NEAR(after.time, time, 1e-9); };
}

Check difference(const char* name) {
    return [name](const Session& before, const Session& after) {
        ASSERT_EQ(after.data.derived.size(), before.data.derived.size() + 1);
        EXPECT_EQ(after.data.derived.back().name, name);
        EXPECT_TRUE(after.transfer.at(name).aboutZero);
    };
}

Check derivedAdded(const char* name) {
    return [name](const Session& before, const Session& after) {
        ASSERT_EQ(after.data.derived.size(), before.data.derived.size() + 1);
        EXPECT_EQ(after.data.derived.back().name, name);
    };
}

Check timeAlong(volume::SpaceAxis axis) {
    return [axis](const Session& before, const Session& after) {
        EXPECT_FALSE(before.data.timeAxis);
        ASSERT_TRUE(after.data.timeAxis);
        EXPECT_EQ(after.data.timeAxis->axis, axis);
    };
}

template <class Technique> void layerAdded(const Session& before, const Session& after) {
    ASSERT_EQ(after.layers.size(), before.layers.size() + 1);
    EXPECT_TRUE(std::holds_alternative<Technique>(after.layers.back().technique));
    EXPECT_EQ(std::get<LayersView>(after.views.at("layers")).selected, int(before.layers.size())) << "selected";
}

Check lensAdded(vis::LensEffect effect) {
    return [effect](const Session& before, const Session& after) {
        ASSERT_EQ(after.lenses.size(), before.lenses.size() + 1);
        EXPECT_EQ(after.lenses.back().effect, effect);
        EXPECT_EQ(after.lenses.back().center, after.cursor);
    };
}

/// The selected layer, the only one, is drawn in this style.
Check drawnIn(std::string_view look) {
    return [look](const Session& before, const Session& after) {
        Session wanted = before;
        std::get<vis::VolumeLayer>(wanted.layers.front().technique).look = *vis::Look::preset(look);
        EXPECT_TRUE(after == wanted);
    };
}

Check clipAdded(vis::ClipKind kind) {
    return [kind](const Session& before, const Session& after) {
        ASSERT_EQ(after.clips.size(), before.clips.size() + 1);
        EXPECT_EQ(after.clips.back().kind, kind);
    };
}

/// Three times of a small volume.
Opened smallSignal() {
    OpenRequest request;
    request.data.emplace();
    request.data->model = "marschner-lobb";
    request.data->settings = {{"nx", 12}, {"ny", 12}, {"nz", 12}, {"times", 3}};
    return open(request);
}

/// A style of what is not brushed: the same as its button makes.
Check contextStyled(ContextStyle style) {
    return [style](const Session& before, const Session& after) {
        static const volume::DatasetInfo info = smallSignal().source->info();
        Session wanted = before;
        setContextStyle(wanted, info, style);
        EXPECT_TRUE(after.selection == wanted.selection && after.layers == wanted.layers);
    };
}

template <class Region> void brushAdded(const Session& before, const Session& after) {
    ASSERT_EQ(after.selection.brushes.size(), before.selection.brushes.size() + 1);
    EXPECT_EQ(std::get<Region>(after.selection.brushes.back().region).center, after.cursor);
}

Check inFront(SceneTask task) {
    return [task](const Session& before, const Session& after) {
        EXPECT_EQ(after.views.size(), before.views.size());
        EXPECT_EQ(std::get<LayersView>(after.views.at("layers")).task, task);
    };
}

Check unlinked(Owned what) {
    return [what](const Session& before, const Session& after) {
        EXPECT_FALSE(owns(std::get<VolumeView>(before.views.at("volume")), what));
        EXPECT_TRUE(owns(std::get<VolumeView>(after.views.at("volume")), what));
        const Session shown = sessionShownIn(after, "volume");
        EXPECT_TRUE(shown.camera == before.camera && shown.layers == before.layers && shown.time == before.time);
    };
}

Check turned(bool VolumeView::*member) {
    return [member](const Session& before, const Session& after) {
        const auto of = [&](const Session& session) {
            return std::get<VolumeView>(session.views.at("volume")).*member;
        };
        EXPECT_NE(of(after), of(before));
    };
}

Check calloutAdded(CalloutOf of, CalloutKind kind) {
    return [of, kind](const Session& before, const Session& after) {
        ASSERT_EQ(after.callouts.size(), before.callouts.size() + 1);
        const Callout& added = after.callouts.back();
        EXPECT_EQ(added.of, of);
        EXPECT_EQ(added.kind, kind);
        if (of == CalloutOf::Lens) {
            EXPECT_EQ(added.placeholder, after.lenses.back().name);
        }
        if (of == CalloutOf::Brush) {
            EXPECT_EQ(added.placeholder, after.selection.brushes.back().name);
        }
    };
}

const std::map<std::string, Check>& checks() {
    static const std::map<std::string, Check> all = [] {
        std::map<std::string, Check> made = {
            {"Clear brushes",
             [](const Session&, const Session& after) { EXPECT_TRUE(after.selection.brushes.empty()); }},
            {"Invert brushes",
             [](const Session& before, const Session& after) {
                 ASSERT_EQ(after.selection.brushes.size(), before.selection.brushes.size());
                 for (std::size_t i = 0; i < after.selection.brushes.size(); ++i)
                     EXPECT_NE(after.selection.brushes[i].inverted, before.selection.brushes[i].inverted);
             }},
            {"Go to the maximum",
             [](const Session& before, const Session& after) { EXPECT_NE(after.cursor, before.cursor); }},
            {"Go to the minimum",
             [](const Session& before, const Session& after) { EXPECT_NE(after.cursor, before.cursor); }},
            {"Keep the values here",
             [](const Session& before, const Session& after) {
                 ASSERT_EQ(after.probes.size(), before.probes.size() + 1);
                 EXPECT_EQ(after.probes.back().position, before.cursor);
                 EXPECT_EQ(after.probes.back().time, before.time);
                 EXPECT_EQ(after.views.size(), before.views.size() + 1) << "the list is shown";
             }},
            {"Library of transfer functions",
             [](const Session&, const Session& after) {
                 EXPECT_TRUE(std::ranges::any_of(after.views, [](const auto& view) {
                     const auto* shown = std::get_if<TransferView>(&view.second);
                     return shown && shown->library;
                 }));
             }},
            {"Previous time", timeOf(0)},
            {"Next time", timeOf(2.0 / 3)},
            {"Ten times back", timeOf(0)},
            {"Ten times on", timeOf(2.0 / 3)},
            {"First time", timeOf(0)},
            {"Last time", timeOf(2.0 / 3)},
            {"Settings: layers", inFront(SceneTask::Layers)},
            {"Settings: brushes", inFront(SceneTask::Brushes)},
            {"Settings: lenses", inFront(SceneTask::Lenses)},
            {"Settings: clips", inFront(SceneTask::Clips)},
            {"Settings: light", inFront(SceneTask::Light)},
            {"Settings: picture", inFront(SceneTask::Picture)},
            {"Add volume layer", layerAdded<vis::VolumeLayer>},
            {"Add iso-surface layer", layerAdded<vis::IsoLayer>},
            {"Add slice layer", layerAdded<vis::SliceLayer>},
            {"Add glyph layer", layerAdded<vis::GlyphLayer>},
            {"Add lens: cut away", lensAdded(vis::LensEffect::Replace)},
            {"Add lens: only this", lensAdded(vis::LensEffect::Only)},
            {"Add lens: enhance", lensAdded(vis::LensEffect::Enhance)},
            {"Add lens: suppress", lensAdded(vis::LensEffect::Suppress)},
            {"Add lens: magnify", lensAdded(vis::LensEffect::Magnify)},
            {"Add lens: brushes inside", lensAdded(vis::LensEffect::Focus)},
            {"Lens: an iso-surface",
             [](const Session& before, const Session& after) {
                 layerAdded<vis::IsoLayer>(before, after);
                 lensAdded(vis::LensEffect::Replace)(before, after);
                 EXPECT_EQ(after.layers.back().lens, after.lenses.back().name);
             }},
            {"Lens: what is brushed",
             [](const Session& before, const Session& after) {
                 lensAdded(vis::LensEffect::Replace)(before, after);
                 EXPECT_EQ(after.lenses.back().shape, vis::LensShape::Selection);
             }},
            {"Brush inside the lens",
             [](const Session& before, const Session& after) {
                 ASSERT_EQ(after.selection.brushes.size(), before.selection.brushes.size() + 1);
                 EXPECT_EQ(std::get<vis::LensRegion>(after.selection.brushes.back().region).lens,
                           before.lenses.back().name);
             }},
            {"Callout of lens", calloutAdded(CalloutOf::Lens, CalloutKind::Scene)},
            {"Callout of plane", calloutAdded(CalloutOf::Plane, CalloutKind::Slice)},
            {"Callout of brush", calloutAdded(CalloutOf::Brush, CalloutKind::Scene)},
            {"Add clip: plane", clipAdded(vis::ClipKind::Plane)},
            {"Add clip: box", clipAdded(vis::ClipKind::Box)},
            {"Add clip: sphere", clipAdded(vis::ClipKind::Sphere)},
            {"Add clip: cylinder", clipAdded(vis::ClipKind::Cylinder)},
            {"Add light",
             [](const Session& before, const Session& after) {
                 EXPECT_EQ(after.lighting.lights.size(), before.lighting.lights.size() + 1);
             }},
            {"Make selection opaque",
             [](const Session& before, const Session& after) {
                 EXPECT_LT(before.selection.focusOpacity, 1);
                 EXPECT_EQ(after.selection.focusOpacity, 1);
             }},
            {"True proportions",
             [](const Session& before, const Session& after) {
                 EXPECT_NE(before.stretch, glm::dvec3(1));
                 EXPECT_EQ(after.stretch, glm::dvec3(1));
             }},
            {"Brush a sphere at the cross-hair", brushAdded<vis::SphereRegion>},
            {"Brush a box at the cross-hair", brushAdded<vis::BoxRegion>},
            {"Show box", turned(&VolumeView::showBox)},
            {"Show axes", turned(&VolumeView::showAxes)},
            {"Show legends", turned(&VolumeView::showLegend)},
            {"Show legends of drawings", turned(&VolumeView::drawingLegend)},
            {"Show box and cross-hair of drawings", turned(&VolumeView::drawingBox)},
            {"Show cross-hair", turned(&VolumeView::showCursor)},
            {"Show direction gizmo", turned(&VolumeView::showGizmo)},
            {"Show scale bar", turned(&VolumeView::showScaleBar)},
            {"Show outlines and handles", turned(&VolumeView::showLenses)},
            {"Show handles of lights", turned(&VolumeView::showLights)},
            {"Show callouts", turned(&VolumeView::showCallouts)},
            {"Depth of field",
             [](const Session& before, const Session& after) {
                 EXPECT_GT(after.camera.aperture, 0);
                 EXPECT_EQ(after.camera.focus, before.camera.focus);
             }},
            {"Focus on the cross-hair",
             [](const Session&, const Session& after) { EXPECT_GT(after.camera.aperture, 0); }}, // hands_planes_gl_test
            {"Face oblique slices to the viewer",
             [](const Session& before, const Session& after) {
                 ASSERT_EQ(after.views.size(), before.views.size() + 1);
                 EXPECT_TRUE(std::holds_alternative<ObliqueView>(after.views.at("oblique")));
             }},
            {"Link camera", unlinked(Owned::Camera)},
            {"Link layers", unlinked(Owned::Layers)},
            {"Link time", unlinked(Owned::Time)},
            {"Draw on the grid of the file",
             [](const Session&, const Session& after) { EXPECT_EQ(after.data.lattice, PictureLattice::Grid); }},
            {"Draw on the body-centred lattice (70.7 % of the samples)", // it is already
             [](const Session& before, const Session& after) { EXPECT_TRUE(after == before); }},
            {"Time along x", timeAlong(volume::SpaceAxis::X)},
            {"Time along y", timeAlong(volume::SpaceAxis::Y)},
            {"Time along z", timeAlong(volume::SpaceAxis::Z)},
            {"Plane in space and time",
             [](const Session& before, const Session& after) {
                 EXPECT_FALSE(before.data.timeAxis);
                 ASSERT_TRUE(after.data.timeAxis);
                 EXPECT_EQ(after.data.timeAxis->degrees, 45);
             }},
            {"Minus another time: first", difference("rho minus first")},
            {"Minus another time: previous", difference("rho minus previous")},
            {"Minus another time: last", difference("rho minus last")},
            {"Add derived parameter: formula", derivedAdded("new rho")},
            {"Add derived parameter: magnitude", derivedAdded("magnitude")},
            {"Add derived parameter: gradient", derivedAdded("grad rho")},
            {"Add derived parameter: deviation over time", derivedAdded("deviation rho")},
            {"Add derived parameter: smoothed", derivedAdded("smooth rho")},
            {"Add derived parameter: pieces", derivedAdded("pieces of rho")},
            {"Add derived parameter: uncertainty of packing", derivedAdded("uncertainty rho")},
            {"Add derived parameter: position", derivedAdded("position")},
            {"Add derived parameter: time", derivedAdded("time")},
            {"Maximise pane", [](const Session& before,
                                 const Session& after) { EXPECT_NE(after.dock.maximised, before.dock.maximised); }},
            {"Duplicate pane",
             [](const Session& before, const Session& after) {
                 EXPECT_EQ(after.views.size(), before.views.size() + 1);
                 EXPECT_TRUE(after.views.at("layers-2") == before.views.at("layers"));
             }},
            {"Light theme",
             [](const Session&, const Session& after) { EXPECT_EQ(after.appearance.theme, Theme::Light); }},
            {"Larger text", scaled(1.125f)},
            {"Smaller text", scaled(1 / 1.125f)},
            {"Reset arrangement",
             [](const Session&, const Session& after) {
                 EXPECT_TRUE(after.dock.maximised.empty());
                 for (const char* pane : {"volume", "slices", "scatterMatrix", "layers"})
                     EXPECT_TRUE(after.views.contains(pane)) << pane;
             }},
            {"New: Region table",
             [](const Session&, const Session& after) {
                 EXPECT_TRUE(std::get<StatisticsView>(after.views.at("statistics")).byRegion);
             }},
            {"New: Section averages", [](const Session&, const Session& after) {
                 EXPECT_EQ(std::get<ProfileView>(after.views.at("profile")).over, ProfileOver::Sections);
             }}};
        for (std::size_t style = 0; style < std::size(kContextStyleNames); ++style)
            made["What is not brushed: " + std::string(kContextStyleNames[style])] =
                contextStyled(static_cast<ContextStyle>(style));
        for (const std::string_view look : vis::Look::kPresetNames) made["Look: " + keyWords(look)] = drawnIn(look);
        forEachViewKind([&]<class Kind>(const Kind& kind) {
            using State = typename Kind::State;
            constexpr bool same =
                std::is_same_v<State, DataView> || std::is_same_v<State, HistoryView> || std::is_same_v<State, LogView>;
            made["New: " + std::string(kind.traits.title)] = same ? shown(State::kType) : added(State::kType);
        });
        return made;
    }();
    return all;
}

class CommandTable : public DrawnWorkbench {
protected:
    /// Three times of a small volume, the second one shown, one brush, one lens; only the list of layers is drawn,
    /// which is quick.
    void begin() {
        Opened opened = smallSignal();
        Session& session = opened.document.session;
        session.time = 1.0 / 3;
        session.stretch = {1, 2, 1};
        session.selection.brushes = {vis::rangeBrush({{.channel = "rho", .lo = 0.2, .hi = 0.6}}, "half")};
        session.lenses = {newLens(session, opened.source->info(), vis::LensEffect::Enhance)};
        session.dock.maximised = "layers";
        workbench.session().appearance = {};
        opened.document.history.reset(session);
        opened.firstView = false; // the same cameras each time
        workbench.install(std::move(opened));
        settle();
    }
    const Command& command(const std::string& title) const {
        return *std::ranges::find_if(workbench.commands(), [&](const Command& each) { return each.title() == title; });
    }
    void pressShortcut(const Shortcut& shortcut) {
        for (const bool down : {true, false})
            frame([&](ImGuiIO& io) {
                feedModifiers(io, shortcut.ctrl, shortcut.shift, shortcut.alt);
                feedKey(io, shortcut.key, down);
            });
        frame([](ImGuiIO& io) { feedModifiers(io, false, false, false); });
    }
};

TEST_F(CommandTable, HasACheckForEveryCommand) {
    begin();
    const std::vector<std::string> layouts = layoutNames();
    std::set<std::string> known;
    for (const Command& each : workbench.commands()) {
        const std::string title = each.title();
        known.insert(title);
        if (each.menu == "Layout" && title != "Reset arrangement") continue; // EveryLayoutIsOneStep
        if (title.starts_with("Example data: ") || title == "Minus another time: the time shown") continue;
        if (title.starts_with("Transfer function: ")) continue; // Library.TheSelectedLayerIsThatOfTheList
        EXPECT_TRUE(checks().contains(title) != kElsewhere.contains(title)) << title;
        EXPECT_FALSE(each.help.empty()) << title;
    }
    for (const auto& [title, check] : checks()) EXPECT_TRUE(known.contains(title)) << title << " is no command";
    for (const std::string& title : kElsewhere) EXPECT_TRUE(known.contains(title)) << title << " is no command";
}

TEST_F(CommandTable, EveryCommandDoesWhatItSaysAndUndoTakesItBack) {
    for (const auto& [title, check] : checks()) {
        SCOPED_TRACE(title);
        begin();
        const Session before = workbench.session();
        ASSERT_TRUE(run(title));
        settle();
        const Session after = workbench.session();
        check(before, after);
        if (const Shortcut shortcut = command(title).shortcut; shortcut.key != 0) {
            begin();
            pressShortcut(shortcut);
            settle();
            EXPECT_TRUE(workbench.session() == after) << "by its key";
        }
        Session front = before; // what is in front is no edit
        followFront(front, after);
        if (after == front) continue;
        if (title.starts_with("Time along ") ||
            title == "Plane in space and time") { // other data, no edit of these: the same command goes back
            ASSERT_TRUE(run(title));
            settle();
            EXPECT_TRUE(workbench.session().data == before.data);
            EXPECT_TRUE(workbench.session().views == before.views);
            EXPECT_NEAR(workbench.session().time, before.time, 1e-6);
            EXPECT_NEAR(glm::distance(workbench.session().cursor, before.cursor), 0, 1e-6);
            continue;
        }
        ASSERT_TRUE(run("Undo"));
        settle();
        followFront(workbench.session(), before);
        EXPECT_TRUE(workbench.session() == before) << "undone";
        ASSERT_TRUE(run("Redo"));
        settle();
        followFront(workbench.session(), after);
        EXPECT_TRUE(workbench.session() == after) << "done again";
    }
}

TEST_F(CommandTable, ASessionGoesThroughTheClipboard) {
    begin();
    const Session before = workbench.session();
    ASSERT_TRUE(run("Copy session"));
    OpenRequest other;
    other.data.emplace();
    other.data->model = "marschner-lobb";
    other.data->settings = {{"nx", 14}, {"ny", 14}, {"nz", 14}};
    workbench.install(open(other));
    settle();
    ASSERT_FALSE(workbench.session() == before);
    ASSERT_TRUE(run("Paste session"));
    settle();
    EXPECT_TRUE(workbench.session().selection == before.selection);
    EXPECT_EQ(workbench.session().data.settings, before.data.settings);
    EXPECT_EQ(workbench.session().time, before.time);
    ImGui::SetClipboardText("no session");
    const Session shown = workbench.session();
    ASSERT_TRUE(run("Paste session"));
    settle();
    EXPECT_TRUE(workbench.session() == shown);
}

TEST_F(CommandTable, HelpAndPaletteOpen) {
    begin();
    const auto popups = [] {
        return ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
    };
    for (const char* title : {"Shortcuts", "Command palette", "About Tessera"}) {
        ASSERT_FALSE(popups()) << title;
        ASSERT_TRUE(run(title));
        for (int i = 0; i < 3; ++i) frame();
        EXPECT_TRUE(popups()) << title;
        press(key::kEscape);
        for (int i = 0; i < 3; ++i) frame();
    }
}

TEST_F(CommandTable, PlayIsNoEdit) {
    begin();
    ASSERT_TRUE(run("Play"));
    frame();
    EXPECT_TRUE(workbench.session().animation.playing);
    ASSERT_TRUE(run("Play"));
    frame();
    EXPECT_FALSE(workbench.session().animation.playing);
}

} // namespace
} // namespace tessera::app
