#pragma once

#include "app/pane/view_context.h"
#include "app/pane/view_parts.h"
#include "app/ui/theme.h"
#include "tests/app/fed_imgui.h"
#include "vis/gl/headless.h"
#include "volume/sources/memory_source.h"
#include "volume/synthetic/models.h"

namespace tessera::app {

/// Every view in a window of its own size, without a window system: ImGui fed by hand, pictures by EGL.
class ViewsTest : public FedImGui {
protected:
    ViewsTest() : FedImGui({1280, 800}) {}
    void SetUp() override {
        fonts = loadFonts(1);
        applyTheme(Theme::Dark, 1);
    }

    void show(std::shared_ptr<const volume::BrickSource> data) {
        source = std::move(data);
        caches.clear();
        renderer.setSource(source);
        session = source ? defaultSession(source->info(), {}) : Session{};
    }

    template <class View>
    void draw(const char* pane, View& view, void (*function)(ViewContext&, const std::string&, View&), ImVec2 size) {
        ViewContext context{session, source, renderer, jobs, caches};
        context.iconFont = fonts.icons;
        context.headless = headless;
        context.figure = figure;
        context.decoration = decoration;
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize(size);
        ImGui::Begin(pane, nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
        function(context, pane, view);
        ImGui::End();
        busy = busy || context.answers.unfinished();
    }
    void frame(const std::function<void()>& body) {
        busy = false;
        feed(body);
        messages = jobs.collect();
    }
    void drawAll(ImVec2 size) {
        draw("volume", volumeView, drawVolumeView, size);
        draw("slices", slicesView, drawSlicesView, size);
        draw("scatterMatrix", scatterView, drawScatterMatrixView, size);
        draw("transfer", transferView, drawTransferView, size);
        draw("layers", layersView, drawLayersView, size);
        draw("timeline", timelineView, drawTimelineView, size);
        draw("data", dataView, drawDataView, size);
        draw("statistics", statisticsView, drawStatisticsView, size);
        draw("histogram", histogramView, drawHistogramView, size);
        draw("profile", profileView, drawProfileView, size);
        draw("sliceMatrix", sliceMatrixView, drawSliceMatrixView, size);
        draw("shadowCube", shadowCubeView, drawShadowCubeView, size);
        draw("tesseract", tesseractView, drawTesseractView, size);
        draw("curves", curvesView, drawCurvesView, size);
    }
    void drawAllSizes() {
        for (const ImVec2 size : {ImVec2{640, 480}, ImVec2{200, 120}, ImVec2{40, 30}})
            for (int i = 0; i < 2; ++i) frame([&] { drawAll(size); });
    }

    vis::HeadlessContext gl;
    Fonts fonts;
    vis::Renderer renderer;
    Jobs jobs;
    std::map<std::string, std::unique_ptr<ViewCache>> caches;
    std::shared_ptr<const volume::BrickSource> source;
    Session session;
    bool headless = true, figure = false, busy = false;
    Decoration decoration;
    std::vector<std::string> messages;
    VolumeView volumeView;
    SlicesView slicesView;
    ScatterMatrixView scatterView;
    TransferView transferView;
    LayersView layersView;
    TimelineView timelineView;
    DataView dataView;
    StatisticsView statisticsView;
    HistogramView histogramView;
    ProfileView profileView;
    SliceMatrixView sliceMatrixView;
    ShadowCubeView shadowCubeView;
    TesseractView tesseractView;
    CurvesView curvesView;
};

inline std::shared_ptr<const volume::BrickSource> fuelCell(volume::LatticeKind lattice) {
    volume::Dataset cell = volume::makeModel("fuel-cell", {{"nx", 7}, {"ny", 9}, {"nz", 21}, {"times", 2}});
    return volume::makeMemorySource(std::move(cell), {.lattice = lattice});
}

} // namespace tessera::app
