#include "app/platform/headless.h"

#include "app/drawing/panels.h"
#include "app/platform/fitted_camera.h"
#include "app/platform/gui.h"
#include "app/session/shown_scene.h"
#include "vis/gl/headless.h"
#include "volume/base/error.h"
#include "volume/base/terminal.h"
#include "volume/system/atomic_file.h"

#include <cmath>
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
            .outlines = shown.outlines,
            .fixed = request.fixed};
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

/// The document with the camera of a volume view moved so that what is seen fills the picture, if figures are to be so.
SessionDocument fitted(const SessionDocument& document, const Sources& sources,
                       const std::shared_ptr<vis::Renderer>& renderer, const PictureRequest& request) {
    SessionDocument moved = document;
    VolumeView* const view = document.session.figure.fit ? volumeView(moved.session, request.pane) : nullptr;
    if (!view) return moved;
    constexpr double kLonger = 384; // pixels, of the pictures by which the camera is moved
    PictureRequest bare = request;
    bare.decoration = *Decoration::preset("none");
    bare.size =
        glm::max(glm::ivec2(glm::dvec2(request.size) * kLonger / double(std::max(request.size.x, request.size.y))),
                 glm::ivec2(16));
    bare.scale = 1;
    moved.session.paper = vis::Paper{.color = glm::vec3(1), .tooth = 0};
    vis::Camera& camera = view->camera ? *view->camera : moved.session.camera;
    constexpr int kRounds = 2; // since what is near is drawn larger
    for (int round = 0; round < kRounds; ++round) {
        const vis::Image image = withWorkbench(moved, sources, renderer, bare, [&](Workbench& workbench) {
            return drawUntilDone(workbench, bare.size, bare.scale);
        });
        const std::optional<SeenExtent> seen = seenExtent(image);
        if (!seen) break;
        fitToSeen(camera, *seen, double(bare.size.x) / double(bare.size.y));
    }
    moved.session.paper = document.session.paper;
    return moved;
}

/// The figure of the pane that a request draws, where that has all that the pane shows.
std::optional<VectorPage> figureOfPane(const Workbench& workbench, const PictureRequest& request, Theme theme) {
    const ViewExport* offered = request.pane.empty() ? nullptr : workbench.exported(request.pane);
    if (!offered || !offered->figure || !offered->whole) return {};
    return offered->figure(pageForm(request, theme), {});
}

/// A view as a page: its own figure if that has all that the pane shows, else what ImGui draws of it; as a picture
/// where `raster`.
VectorPage pageOfPane(const SessionDocument& document, const Sources& sources, std::shared_ptr<vis::Renderer> renderer,
                      const PictureRequest& request, const Inspect& inspect, bool raster) {
    const SessionDocument shown = fitted(document, sources, renderer, request);
    return withWorkbench(shown, sources, std::move(renderer), request, [&](Workbench& workbench) {
        OffscreenFrames target(request.size, raster);
        drawUntilDone(target, workbench, request.scale);
        if (inspect) inspect(workbench);
        if (auto figure = figureOfPane(workbench, request, document.session.appearance.theme)) return *figure;
        const double points = pointsPerPixel(request);
        if (!raster) {
            VectorPage page = target.page(workbench, points);
            page.numbers = originText(sources.origin, sources.numbers->info());
            return page;
        }
        VectorPage page;
        page.size = glm::dvec2(request.size) * points;
        page.marks.push_back({shapes::Picture{.box = {{0, 0}, page.size}, .image = target.read(), .smooth = false}});
        return page;
    });
}

vis::Image imageOfPane(const SessionDocument& document, const Sources& sources, std::shared_ptr<vis::Renderer> renderer,
                       const PictureRequest& request, const Inspect& inspect) {
    const SessionDocument shown = fitted(document, sources, renderer, request);
    return withWorkbench(shown, sources, std::move(renderer), request, [&](Workbench& workbench) {
        OffscreenFrames target(request.size);
        drawUntilDone(target, workbench, request.scale);
        if (inspect) inspect(workbench);
        if (const auto figure = figureOfPane(workbench, request, document.session.appearance.theme))
            return imageOf(*figure, request.size);
        return target.read();
    });
}

struct FigureInks {
    glm::vec4 ground, ink;
};
FigureInks figureInks(const PictureRequest& request, Theme theme) {
    const bool white = request.ground == PictureGround::White, dark = !white && theme == Theme::Dark;
    return {white ? glm::vec4(1) : glm::vec4(windowGround(theme), 1), glm::vec4(glm::vec3(dark ? 0.9f : 0.1f), 1)};
}

/// The request without the room of the title that is set for figures; none for a picture of the whole window.
PictureRequest belowTitle(const PictureRequest& request, const std::string& title) {
    PictureRequest below = request;
    if (title.empty() || panesOf(request).empty()) return below;
    const double text = textPixels(request.scale);
    below.size.y -= int(std::ceil(titleHeight(title, double(request.size.x), text)));
    constexpr int kLeast = 16;
    if (below.size.y < kLeast) throw Error("the title leaves no room for the figure: " + title);
    return below;
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
        panel.fixed = true;
        pages.push_back(pageOf(panel));
    }
    const FigureInks inks = figureInks(request, theme);
    return figureOfPanels(glm::dvec2(request.size) * points, places, pages, points, text * points, inks.ground,
                          inks.ink);
}

/// A figure with the title that the session states, of the size of the request; `make(request below the title)`.
template <class Make>
VectorPage titled(const SessionDocument& document, const PictureRequest& request, const Make& make) {
    const std::string& title = document.session.figure.title;
    const PictureRequest below = belowTitle(request, title);
    VectorPage page = make(below);
    if (below.size == request.size) return page;
    const double points = pointsPerPixel(request);
    const FigureInks inks = figureInks(request, document.session.appearance.theme);
    const bool whole = page.size.y >= double(below.size.y) * points - 1e-6; // not a table of its own height
    page = titledPage(std::move(page), title, textPixels(request.scale) * points, inks.ground, inks.ink);
    if (whole) page.size.y = double(request.size.y) * points;
    return page;
}

VectorPage pageOfRequest(const SessionDocument& document, const Sources& sources,
                         const std::shared_ptr<vis::Renderer>& renderer, const PictureRequest& request,
                         const Inspect& inspect, bool raster) {
    return titled(document, request, [&](const PictureRequest& below) {
        const auto page = [&](const PictureRequest& one) {
            return pageOfPane(document, sources, renderer, one, inspect, raster);
        };
        return below.panels.empty() ? page(below) : panelsOf(below, document.session.appearance.theme, page);
    });
}

vis::Image renderAndInspect(const SessionDocument& document, const Sources& sources,
                            const std::shared_ptr<vis::Renderer>& renderer, const PictureRequest& request,
                            const Inspect& inspect) {
    const bool composed = !request.panels.empty() || (!request.pane.empty() && !document.session.figure.title.empty());
    PictureRequest whole = request;
    whole.fixed = true;
    vis::Image image = composed
                           ? imageOf(pageOfRequest(document, sources, renderer, whole, inspect, true), request.size)
                           : imageOfPane(document, sources, renderer, whole, inspect);
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
        VectorPage page = pageOfRequest(document, sources, renderer, request, inspect, false);
        page.session = printSession(document, path);
        AtomicFile file(path);
        file.write(fileOf(page, suffix));
        return file.commit();
    }
    const vis::Image image = renderAndInspect(document, sources, renderer, request, inspect);
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
    return pageOfRequest(document, sources, impl_->renderer, request, {}, false);
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
