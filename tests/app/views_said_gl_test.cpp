#include "app/queries/readout.h"
#include "app/tools/lens_list.h"
#include "app/ui/ticks.h"
#include "tests/app/drawn_text.h"
#include "tests/app/views_fixture.h"
#include "tests/volume/cell_lengths.h"
#include "volume/sources/plane_source.h"

#include <gmock/gmock.h>
#include <imgui_internal.h>

/// What views say in words: that there is nothing to show, and where there is, what it is.
namespace tessera::app {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class SaidViews : public ViewsTest {
protected:
    Readout readout;
    /// What a view says once it has settled.
    template <class View>
    std::string of(const char* pane, View& view, void (*function)(ViewContext&, const std::string&, View&)) {
        const auto body = [&] { draw(pane, view, function, {720, 560}); };
        for (int i = 0; i < 3 || (busy && i < 200); ++i) {
            jobs.wait();
            frame(body);
        }
        return said(body);
    }
};

TEST_F(SaidViews, WithDataAndRoomNothingIsMissing) {
    show(fuelCell(volume::LatticeKind::CC));
    const auto expectShown = [&](const std::string& text, const char* pane) {
        for (const char* hint : {"Not enough room", "No data", "No parameters", "Averaging", "Reading"})
            EXPECT_THAT(text, Not(HasSubstr(hint))) << pane;
    };
    expectShown(of("layers", layersView, drawLayersView), "layers");
    expectShown(of("timeline", timelineView, drawTimelineView), "timeline");
    expectShown(of("data", dataView, drawDataView), "data");
    expectShown(of("statistics", statisticsView, drawStatisticsView), "statistics");
    expectShown(of("histogram", histogramView, drawHistogramView), "histogram");
    expectShown(of("profile", profileView, drawProfileView), "profile");
    expectShown(of("sliceMatrix", sliceMatrixView, drawSliceMatrixView), "sliceMatrix");
    expectShown(of("curves", curvesView, drawCurvesView), "curves");
    expectShown(of("transfer", transferView, drawTransferView), "transfer");
    expectShown(of("scatterMatrix", scatterView, drawScatterMatrixView), "scatterMatrix");
}

TEST_F(SaidViews, WithoutDataEachSaysSo) {
    show(nullptr);
    EXPECT_THAT(of("volume", volumeView, drawVolumeView), HasSubstr("example data in the Help menu"));
    EXPECT_THAT(of("layers", layersView, drawLayersView), HasSubstr("No data"));
    EXPECT_THAT(of("timeline", timelineView, drawTimelineView), HasSubstr("No data"));
    EXPECT_THAT(of("data", dataView, drawDataView), HasSubstr("No data"));
    EXPECT_THAT(of("statistics", statisticsView, drawStatisticsView), HasSubstr("No data"));
    EXPECT_THAT(of("histogram", histogramView, drawHistogramView), HasSubstr("No data"));
    EXPECT_THAT(of("profile", profileView, drawProfileView), HasSubstr("No data"));
    EXPECT_THAT(of("sliceMatrix", sliceMatrixView, drawSliceMatrixView), HasSubstr("No data"));
    EXPECT_THAT(of("curves", curvesView, drawCurvesView), HasSubstr("No data"));
    EXPECT_THAT(of("transfer", transferView, drawTransferView), HasSubstr("No data"));
    EXPECT_THAT(of("scatterMatrix", scatterView, drawScatterMatrixView), HasSubstr("No data"));
}

TEST_F(SaidViews, TheTableOfTheSelectionHasItsHeads) {
    show(fuelCell(volume::LatticeKind::CC));
    const std::string plain = of("data", dataView, drawDataView);
    EXPECT_THAT(plain, HasSubstr("Mean and range now"));
    EXPECT_THAT(plain, Not(HasSubstr("Outside")));
    const volume::DatasetInfo& info = source->info();
    const std::string name = info.channels().front().name;
    const Range range = info.channelRange(info.channels().front());
    session.selection.brushes = {
        vis::rangeBrush({{.channel = name, .lo = range.lo, .hi = 0.5 * (range.lo + range.hi)}})};
    const std::string brushed = of("data", dataView, drawDataView);
    EXPECT_THAT(brushed, HasSubstr(" samples, "));
    for (const char* head : {"Parameter", "brush", "not brush"}) EXPECT_THAT(brushed, HasSubstr(head));
    // The means of the samples on either side, inside first.
    const volume::Dataset cell = volume::makeModel("fuel-cell", {{"nx", 7}, {"ny", 9}, {"nz", 21}, {"times", 2}});
    const volume::Field field = cell.read(0, 0, 0);
    double sum[2] = {}, count[2] = {};
    for (std::size_t i = 0; i < field.count(); ++i) {
        if (field.mask && (*field.mask)[i] == 0) continue;
        const double value = double(field.as<float>()[i]);
        const int side = value <= 0.5 * (range.lo + range.hi) ? 0 : 1;
        const glm::ivec3 size = field.lattice.size;
        const glm::ivec3 at(int(i) % size.x, int(i) / size.x % size.y, int(i) / size.x / size.y);
        const double volume = volume::test::volumeInBox(cell.info, at); // of the sample's cell
        sum[side] += volume * value;
        count[side] += volume;
    }
    ASSERT_GT(count[0], 0);
    ASSERT_GT(count[1], 0);
    const double digits = (range.hi - range.lo) / 1000;
    EXPECT_THAT(brushed, testing::ContainsRegex("\\| " + formatNumber(sum[0] / count[0], digits) + "[^|]*\\| " +
                                                formatNumber(sum[1] / count[1], digits)));
}

TEST_F(SaidViews, LayersAreListedByNameAndParameter) {
    show(fuelCell(volume::LatticeKind::CC));
    session.layers = {{"hot gas", true, vis::VolumeLayer{.channel = "T"}},
                      {"T above", true, vis::IsoLayer{.channel = "T", .value = 353}},
                      {"", false, vis::VolumeLayer{.channel = "H2"}}};
    const std::string text = of("layers", layersView, drawLayersView);
    for (const char* word : {"hot gas", "T above", "H2"}) EXPECT_THAT(text, HasSubstr(word));
}

TEST_F(SaidViews, FluxIsShownWhereThereIsAVelocity) {
    const auto sections = [&](SectionMeasure measure) {
        profileView.over = ProfileOver::Sections;
        profileView.sections.measure = measure;
        return of("profile", profileView, drawProfileView);
    };
    show(fuelCell(volume::LatticeKind::CC));
    for (const SectionMeasure measure : {SectionMeasure::Mean, SectionMeasure::Flux, SectionMeasure::Flow})
        EXPECT_THAT(sections(measure), Not(HasSubstr("No flux")));
    show(volume::makeMemorySource(volume::makeModel("marschner-lobb", {{"nx", 12}, {"ny", 12}, {"nz", 12}}), {}));
    EXPECT_THAT(sections(SectionMeasure::Mean), Not(HasSubstr("No flux")));
    EXPECT_THAT(sections(SectionMeasure::Flux), HasSubstr("No flux"));
    EXPECT_THAT(sections(SectionMeasure::Flow), HasSubstr("No flux"));
}

TEST_F(SaidViews, AnEyeSaysWhetherItsLayerIsShown) {
    show(fuelCell(volume::LatticeKind::CC));
    fonts.icons = nullptr; // words in place of glyphs
    session.layers = {{"seen", true, vis::VolumeLayer{.channel = "T"}},
                      {"hidden", false, vis::VolumeLayer{.channel = "T"}}};
    of("layers", layersView, drawLayersView);
    const auto eyeOf = [](const std::string& layer) { // the word before it in its line
        const std::vector<DrawnText> texts = drawnTexts();
        for (std::size_t i = 1; i < texts.size(); ++i)
            if (texts[i].text.ends_with(layer)) return texts[i - 1].text;
        return std::string();
    };
    EXPECT_EQ(eyeOf(" seen"), "on");
    EXPECT_EQ(eyeOf(" hidden"), "off");
}

TEST_F(SaidViews, AHintIsAHeadingAndWhatToDo) {
    show(volume::makeMemorySource(volume::makeModel("marschner-lobb", {{"nx", 12}, {"ny", 12}, {"nz", 12}}), {}));
    profileView.over = ProfileOver::Sections;
    profileView.sections.measure = SectionMeasure::Flux;
    const std::string text = of("profile", profileView, drawProfileView);
    const auto heading = text.find("No flux"), reason = text.find("The data have no vector");
    ASSERT_NE(reason, std::string::npos) << text;
    EXPECT_LT(heading, reason);
}

TEST_F(SaidViews, TheTimelineSaysAlongWhichAxisTimeRuns) {
    show(volume::makeMemorySource(volume::makeModel("marschner-lobb", {{"nx", 12}, {"ny", 12}, {"nz", 12}}), {}));
    EXPECT_THAT(of("timeline", timelineView, drawTimelineView), HasSubstr("These data have only one time."));
    const volume::TimeAxis cut{.axis = volume::SpaceAxis::Y};
    show(volume::makePlaneSource(fuelCell(volume::LatticeKind::CC), cut));
    session.data.timeAxis = cut;
    EXPECT_THAT(of("timeline", timelineView, drawTimelineView), HasSubstr("Time runs along y."));
}

TEST_F(SaidViews, AnEditorOfOpacityWithoutRoomSaysSo) {
    show(fuelCell(volume::LatticeKind::CC));
    for (const vis::TransferKind kind : {vis::TransferKind::Curve, vis::TransferKind::Regions}) {
        for (auto& [name, function] : session.transfer) function.kind = kind;
        const auto at = [&](ImVec2 size) {
            const auto body = [&] { draw("transfer", transferView, drawTransferView, size); };
            for (int i = 0; i < 3; ++i) frame(body);
            return said(body);
        };
        EXPECT_THAT(at({720, 560}), Not(HasSubstr("Not enough room")));
        EXPECT_THAT(at({70, 560}), HasSubstr("Not enough room")) << int(kind);
    }
}

TEST_F(SaidViews, AMatrixOfScatterplotsHasTheCorrelationsAboveItsDiagonal) {
    show(fuelCell(volume::LatticeKind::CC));
    scatterView.channels = {"T", "O2"};
    of("scatterMatrix", scatterView, drawScatterMatrixView);
    int numbers = 0;
    for (const DrawnText& text : drawnTexts())
        if (text.text.size() == 5 && (text.text[0] == '+' || text.text[0] == '-') && text.text[2] == '.') {
            ++numbers;
            EXPECT_GT(text.middle().x, 360);
            EXPECT_LT(text.middle().y, 300);
        }
    EXPECT_EQ(numbers, 1);
}

/// Numbers that are cut off say nothing: the column of regions gives way, then the table.
TEST_F(SaidViews, TheReadOutHasWholeNumbersInAnyWidth) {
    show(fuelCell(volume::LatticeKind::CC));
    const auto at = [&](float width) {
        const auto body = [&] {
            ViewContext context{session, source, renderer, jobs, caches};
            context.headless = true;
            ImGui::SetNextWindowPos({0, 0});
            ImGui::SetNextWindowSize({width, 560});
            ImGui::Begin("readout", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
            updateReadout(context, readout);
            drawReadout(context, readout);
            ImGui::End();
        };
        for (int i = 0; i < 3; ++i) {
            frame(body);
            jobs.wait();
        }
        return said(body);
    };
    const std::string wide = at(640), narrower = at(270), narrow = at(150);
    EXPECT_THAT(wide, HasSubstr("Nearest"));
    EXPECT_THAT(wide, HasSubstr("Region"));
    EXPECT_THAT(narrower, HasSubstr("Nearest"));
    EXPECT_THAT(narrower, Not(HasSubstr("Region")));
    EXPECT_THAT(narrow, Not(HasSubstr("Nearest")));
    EXPECT_THAT(narrow, HasSubstr("T 35"));
    const auto row = cellsOf(readoutTable(source->info(), readout));
    for (const std::vector<std::string>& each : row)
        if (each[0] != "region") {
            EXPECT_THAT(narrower, HasSubstr(each[1])) << each[0];
        }
}

/// Running lines are whole: the place gives way first, then units, then values, and all is under the mouse.
TEST_F(SaidViews, RunningValuesGiveUpUnitsBeforeNumbers) {
    show(fuelCell(volume::LatticeKind::CC));
    session.cursor = {0.0011, 0.0009, 0.02};
    float last = 0;
    const auto at = [&](float height) {
        const auto body = [&] {
            ViewContext context{session, source, renderer, jobs, caches};
            context.headless = true;
            ImGui::SetNextWindowPos({0, 0});
            ImGui::SetNextWindowSize({240, 400});
            ImGui::Begin("running", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
            updateReadout(context, readout);
            const float from = ImGui::GetCursorPosY();
            drawRunningReadout(context, readout, height);
            last = ImGui::GetCursorPosY() - ImGui::GetStyle().ItemSpacing.y - from;
            ImGui::End();
        };
        for (int i = 0; i < 3; ++i) {
            frame(body);
            jobs.wait();
        }
        EXPECT_LE(last, height) << "no line is cut off";
        return said(body);
    };
    const std::string whole = at(300);
    EXPECT_THAT(whole, AllOf(HasSubstr("x "), HasSubstr(" Pa"), HasSubstr("mol/m"), HasSubstr("region ")));
    const std::string unplaced = at(last - 2);
    EXPECT_THAT(unplaced, AllOf(Not(HasSubstr("x 1")), HasSubstr(" Pa"), HasSubstr("region ")));
    const std::string bare = at(last - 2);
    EXPECT_THAT(bare, AllOf(HasSubstr("p 1"), HasSubstr("region "), Not(HasSubstr(" Pa"))));
    mouse = {20, 12};
    const std::string few = at(ImGui::GetTextLineHeight());
    EXPECT_THAT(few, AllOf(HasSubstr("O2 "), HasSubstr("...")));
    EXPECT_THAT(few, AllOf(HasSubstr(" Pa"), HasSubstr("region "))) << "in the tooltip";
}

TEST_F(SaidViews, PicturesOverLineAndTimeHaveTheirColorsBesideThem) {
    show(fuelCell(volume::LatticeKind::CC));
    profileView.over = ProfileOver::LineAndTime;
    profileView.channels = {"T", "O2"};
    const auto shown = [&](const std::string& text) {
        of("profile", profileView, drawProfileView);
        const std::vector<std::string> words = drawnWords();
        return std::ranges::find(words, text) != words.end();
    };
    for (const std::string& name : profileView.channels) {
        const volume::Channel channel = source->info().channel(*source->info().findChannel(name));
        const Range range = source->info().channelRange(channel);
        for (const double end : {range.lo, range.hi})
            EXPECT_TRUE(shown(formatNumber(end, (range.hi - range.lo) / 100))) << name << " " << end;
        EXPECT_TRUE(shown(prettyUnit(channel.unit))) << name;
    }
    decoration.legend = false;
    EXPECT_FALSE(shown("K"));
}

TEST_F(SaidViews, LongNamesInTheReadOutGiveWayToValues) {
    volume::Dataset data = volume::makeModel("fuel-cell", {{"nx", 7}, {"ny", 9}, {"nz", 21}, {"times", 1}});
    for (volume::Parameter& parameter : data.info.parameters) {
        for (volume::Label& label : parameter.labels) label.name = parameter.name + " " + std::to_string(label.value);
        if (parameter.name == "T") parameter.name = "temperature_of_the_cathode_gas_diffusion_layer_after_correction";
    }
    show(volume::makeMemorySource(std::move(data), {.lattice = volume::LatticeKind::CC}));
    const auto body = [&] {
        ViewContext context{session, source, renderer, jobs, caches};
        context.headless = true;
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({200, 400});
        ImGui::Begin("long", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
        updateReadout(context, readout);
        drawRunningReadout(context, readout, 380);
        ImGui::End();
    };
    for (int i = 0; i < 3; ++i) {
        frame(body);
        jobs.wait();
    }
    const std::string text = said(body);
    EXPECT_THAT(text, testing::ContainsRegex("temperature_[a-z_]*\\.\\.\\. [0-9.]+ K"));
    EXPECT_THAT(text, AllOf(HasSubstr("region "), Not(HasSubstr("region region"))));
}

/// A lens that was added by a command is the thing to set up: the list goes to it.
TEST_F(SaidViews, TheListOfLayersGoesToANewLens) {
    headless = false;
    show(fuelCell(volume::LatticeKind::CC));
    for (int i = 0; i < 6; ++i) addLens(session, source->info(), vis::LensEffect::Enhance);
    const auto body = [&] { draw("layers", layersView, drawLayersView, {330, 260}); };
    for (int i = 0; i < 3; ++i) frame(body);
    addLens(session, source->info(), vis::LensEffect::Magnify);
    for (int i = 0; i < 4; ++i) frame(body);
    const ImGuiWindow* window = nullptr;
    for (const ImGuiWindow* each : GImGui->Windows)
        if (each->WasActive && std::string_view(each->Name).find("/lenses_") != std::string_view::npos) window = each;
    ASSERT_TRUE(window);
    EXPECT_GT(window->Scroll.y, 100);
}

} // namespace
} // namespace tessera::app
