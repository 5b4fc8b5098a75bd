#include "app/platform/headless.h"

#include "app/drawing/drawing.h"
#include "app/platform/gui.h"
#include "vis/gl/headless.h"
#include "volume/base/error.h"

namespace tessera::app {

namespace {

vis::Image renderAndInspect(const SessionDocument& document, const Sources& sources,
                            std::shared_ptr<vis::Renderer> renderer, const PictureRequest& request,
                            const Inspect& inspect) {
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
    vis::Image image = drawUntilDone(workbench, request.size, request.scale);
    image.dpi = request.dpi;
    if (inspect) inspect(workbench);
    return image;
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
    request.controls = true;
    std::string text;
    renderAndInspect(document, sources, impl_->renderer, request, [&](const Workbench& workbench) {
        const ViewExport* offered = workbench.exported(request.pane);
        const bool table = ending == "csv";
        if (!offered || (table ? !offered->csv : !offered->figure))
            throw Error("has no " + ending + " of what it shows", "--view", request.pane);
        text = table ? offered->csv(progress) : fileOf(offered->figure(progress), ending);
    });
    return text;
}

vis::Image PictureMaker::render(const SessionDocument& document, const Sources& sources, const PictureRequest& request,
                                const Inspect& inspect) {
    return renderAndInspect(document, sources, impl_->renderer, request, inspect);
}

} // namespace tessera::app
