#include "app/platform/headless.h"

#include "app/drawing/drawing.h"
#include "app/platform/gui.h"
#include "vis/gl/headless.h"
#include "volume/base/error.h"

namespace tessera::app {

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
    const Gui gui;
    const bool white = request.ground == PictureGround::White;
    Workbench workbench({.renderer = std::move(renderer),
                         .headless = true,
                         .onlyPane = request.pane,
                         .controls = request.controls,
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
    opened.source = sources.pictures;
    opened.numbers = sources.numbers;
    opened.origin = sources.origin;
    workbench.install(std::move(opened));
    return draw(workbench);
}

vis::Image renderAndInspect(const SessionDocument& document, const Sources& sources,
                            std::shared_ptr<vis::Renderer> renderer, const PictureRequest& request,
                            const Inspect& inspect) {
    return withWorkbench(document, sources, std::move(renderer), request, [&](Workbench& workbench) {
        vis::Image image = drawUntilDone(workbench, request.size, request.scale);
        image.dpi = request.dpi;
        if (inspect) inspect(workbench);
        return image;
    });
}

/// Points of a page per pixel of a picture; on screens there are 96 pixels in an inch.
double pointsPerPixel(const PictureRequest& request) {
    constexpr double kOfScreens = 96;
    return 72 / (request.dpi > 0 ? request.dpi : kOfScreens);
}

} // namespace

vis::Image renderPicture(const SessionDocument& document, const Sources& sources,
                         std::shared_ptr<vis::Renderer> renderer, const PictureRequest& request) {
    return renderAndInspect(document, sources, std::move(renderer), request, {});
}

struct PictureMaker::Impl {
    vis::HeadlessContext context;
    std::shared_ptr<vis::Renderer> renderer;
};

PictureMaker::PictureMaker(const vis::RendererOptions& options) : impl_(std::make_unique<Impl>()) {
    impl_->renderer = std::make_shared<vis::Renderer>(vis::quickestOptions(options));
}

PictureMaker::~PictureMaker() = default;

std::string PictureMaker::exportText(const SessionDocument& document, const Sources& sources, PictureRequest request,
                                     const std::string& ending, const Progress& progress) {
    const bool table = ending == "csv";
    std::string text;
    request.controls = true;
    if (!request.pane.empty())
        renderAndInspect(document, sources, impl_->renderer, request, [&](const Workbench& workbench) {
            const ViewExport* offered = workbench.exported(request.pane);
            if (offered && table && offered->csv) text = offered->csv(progress);
            if (offered && !table && offered->figure) text = fileOf(offered->figure(progress), ending);
        });
    if (!text.empty()) return text;
    if (table) throw Error("has no " + ending + " of what it shows", "--view", request.pane);
    request.controls = false;
    return fileOf(page(document, sources, request), ending);
}

VectorPage PictureMaker::page(const SessionDocument& document, const Sources& sources, const PictureRequest& request) {
    return withWorkbench(document, sources, impl_->renderer, request, [&](Workbench& workbench) {
        VectorPage page = drawPageUntilDone(workbench, request.size, request.scale, pointsPerPixel(request));
        page.numbers = originText(sources.origin, sources.numbers->info());
        return page;
    });
}

vis::Image PictureMaker::render(const SessionDocument& document, const Sources& sources, const PictureRequest& request,
                                const Inspect& inspect) {
    return renderAndInspect(document, sources, impl_->renderer, request, inspect);
}

} // namespace tessera::app
