#include "app/platform/headless.h"

#include "app/drawing/panels.h"
#include "app/platform/gui.h"
#include "vis/gl/headless.h"
#include "volume/base/error.h"
#include "volume/base/terminal.h"
#include "volume/system/atomic_file.h"

#include <cstdio>
#include <optional>

namespace tessera::app {

namespace {

/// Points of a page per pixel of a picture; on screens there are 96 pixels in an inch.
double pointsPerPixel(const PictureRequest& request) {
    constexpr double kOfScreens = 96;
    return 72 / (request.dpi > 0 ? request.dpi : kOfScreens);
}

} // namespace

PageForm pageForm(const PictureRequest& request, Theme theme) {
    const double points = pointsPerPixel(request);
    const Decoration& shown = request.decoration;
    return {.size = glm::dvec2(request.size) * points,
            .text = textPixels(request.scale) * points,
            .dark = request.ground == PictureGround::Shown && theme == Theme::Dark,
            .legend = shown.legend,
            .axes = shown.axes,
            .title = shown.title,
            .cursor = shown.cursor,
            .outlines = shown.outlines};
}

namespace {

/// Installs a session in a workbench without a window, and calls `draw(workbench)`.
template <class Draw>
auto withWorkbench(const SessionDocument& document, const Sources& sources, std::shared_ptr<vis::Renderer> renderer,
                   const PictureRequest& request, const Draw& draw) {
    if (!request.pane.empty() && !document.session.views.contains(request.pane)) {
        std::string known;
        for (const std::string& pane : paneKeys(document.session)) known += (known.empty() ? "" : ", ") + pane;
        throw Error("no view named " + request.pane + "; there are " + known);
    }
    const Gui gui(renderer->textures());
    const bool white = request.ground == PictureGround::White;
    Workbench workbench({.renderer = std::move(renderer),
                         .headless = true,
                         .onlyPane = request.pane,
                         .decoration = request.decoration,
                         .whiteGround = white});
    Opened opened;
    opened.document = document;
    Session& drawn = opened.document.session;
    drawn.animation.playing = false;
    if (request.dpi > 0) drawn.appearance.scale = 1; // the size of text is that on paper
    if (white) {
        drawn.appearance.theme = Theme::Light;
        drawn.paper = vis::Paper{.color = glm::vec3(1), .tooth = 0};
    }
    opened.take(sources);
    workbench.install(std::move(opened));
    return draw(workbench);
}

/// A view as a page: its own figure if that has all that the pane shows, else what ImGui draws of it.
VectorPage pageOfPane(const SessionDocument& document, const Sources& sources, std::shared_ptr<vis::Renderer> renderer,
                      const PictureRequest& request, const Inspect& inspect) {
    return withWorkbench(document, sources, std::move(renderer), request, [&](Workbench& workbench) {
        OffscreenFrames target(request.size, false);
        drawUntilDone(target, workbench, request.scale);
        if (inspect) inspect(workbench);
        const ViewExport* offered = workbench.exported(request.pane);
        if (offered && offered->figure && offered->whole)
            return offered->figure(pageForm(request, document.session.appearance.theme), {});
        VectorPage page = target.page(workbench, pointsPerPixel(request));
        page.numbers = originText(sources.origin, sources.numbers->info());
        return page;
    });
}

vis::Image imageOfPane(const SessionDocument& document, const Sources& sources, std::shared_ptr<vis::Renderer> renderer,
                       const PictureRequest& request, const Inspect& inspect) {
    return withWorkbench(document, sources, std::move(renderer), request, [&](Workbench& workbench) {
        vis::Image image = drawUntilDone(workbench, request.size, request.scale);
        if (inspect) inspect(workbench);
        return image;
    });
}

/// The panels of a request as one page; `pageOf(request of a panel)`.
template <class PageOf> VectorPage panelsOf(const PictureRequest& request, Theme theme, const PageOf& pageOf) {
    const int count = int(request.panels.size());
    const double points = pointsPerPixel(request), text = textPixels(request.scale);
    const std::vector<PanelPlace> places =
        panelPlaces(request.size, count, request.columns > 0 ? request.columns : usualColumns(count), text);
    std::vector<VectorPage> pages;
    for (std::size_t i = 0; i < places.size(); ++i) {
        PictureRequest panel = request;
        panel.panels.clear();
        panel.pane = request.panels[i];
        panel.size = places[i].hi - places[i].lo;
        pages.push_back(pageOf(panel));
    }
    const bool dark = request.ground == PictureGround::Shown && theme == Theme::Dark;
    return figureOfPanels(glm::dvec2(request.size) * points, places, pages, points, text * points,
                          request.ground == PictureGround::White ? glm::vec4(1) : glm::vec4(windowGround(theme), 1),
                          glm::vec4(glm::vec3(dark ? 0.9f : 0.1f), 1));
}

VectorPage pageOfRequest(const SessionDocument& document, const Sources& sources,
                         const std::shared_ptr<vis::Renderer>& renderer, const PictureRequest& request,
                         const Inspect& inspect) {
    const auto page = [&](const PictureRequest& one) { return pageOfPane(document, sources, renderer, one, inspect); };
    return request.panels.empty() ? page(request) : panelsOf(request, document.session.appearance.theme, page);
}

vis::Image renderAndInspect(const SessionDocument& document, const Sources& sources,
                            std::shared_ptr<vis::Renderer> renderer, const PictureRequest& request,
                            const Inspect& inspect) {
    vis::Image image;
    if (request.panels.empty()) {
        image = imageOfPane(document, sources, renderer, request, inspect);
    } else {
        const auto page = [&](const PictureRequest& one) {
            const double points = pointsPerPixel(request);
            VectorPage made;
            made.size = glm::dvec2(one.size) * points;
            made.marks.push_back({shapes::Picture{.box = {{0, 0}, made.size},
                                                  .image = imageOfPane(document, sources, renderer, one, inspect),
                                                  .smooth = false}});
            return made;
        };
        image = imageOf(panelsOf(request, document.session.appearance.theme, page), request.size);
    }
    image.dpi = request.dpi;
    return image;
}

/// The suffix of a path to vector graphics, "svg" or "pdf", else "".
std::string vectorSuffix(const std::string& path) {
    for (const char* suffix : {"svg", "pdf"})
        if (path.ends_with(std::string(".") + suffix)) return suffix;
    return "";
}

} // namespace

void writePicture(const SessionDocument& document, const Sources& sources, std::shared_ptr<vis::Renderer> renderer,
                  const PictureRequest& request, const std::string& path, const Inspect& inspect) {
    if (const std::string suffix = vectorSuffix(path); !suffix.empty()) {
        VectorPage page = pageOfRequest(document, sources, renderer, request, inspect);
        page.session = printSession(document, path);
        AtomicFile file(path);
        file.write(fileOf(page, suffix));
        return file.commit();
    }
    const vis::Image image = renderAndInspect(document, sources, std::move(renderer), request, inspect);
    vis::writePng(path, image, {{vis::kSessionTextKey, printSession(document, path)}});
}

struct PictureMaker::Impl {
    std::optional<vis::HeadlessContext> context;
    std::shared_ptr<vis::Renderer> renderer;
};

PictureMaker::PictureMaker(const vis::RendererOptions& options) : impl_(std::make_unique<Impl>()) {
    vis::RendererOptions own = options;
    try {
        if (own.openGl) impl_->context.emplace();
    } catch (const MachineError& error) {
        warn("tessera: the processor draws without OpenGL: %s\n", error.what());
        own.openGl = false;
    }
    impl_->renderer = std::make_shared<vis::Renderer>(vis::quickestOptions(own));
}

PictureMaker::~PictureMaker() = default;

std::string PictureMaker::table(const SessionDocument& document, const Sources& sources, const PictureRequest& request,
                                const Progress& progress) {
    std::string text;
    renderAndInspect(document, sources, impl_->renderer, request, [&](const Workbench& workbench) {
        const ViewExport* offered = workbench.exported(request.pane);
        if (offered && offered->table) text = csvOf(offered->table(progress));
    });
    if (text.empty()) throw Error("has no table of what it shows", "--view", request.pane);
    return text;
}

VectorPage PictureMaker::page(const SessionDocument& document, const Sources& sources, const PictureRequest& request) {
    return pageOfRequest(document, sources, impl_->renderer, request, {});
}

void PictureMaker::write(const SessionDocument& document, const Sources& sources, const PictureRequest& request,
                         const std::string& path, const Inspect& inspect) {
    writePicture(document, sources, impl_->renderer, request, path, inspect);
}

vis::Image PictureMaker::render(const SessionDocument& document, const Sources& sources, const PictureRequest& request,
                                const Inspect& inspect) {
    return renderAndInspect(document, sources, impl_->renderer, request, inspect);
}

} // namespace tessera::app
