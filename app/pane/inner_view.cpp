#include "app/pane/inner_view.h"

namespace tessera::app {

ViewContext innerContext(const ViewContext& outer, Session& session, std::shared_ptr<const volume::BrickSource> source,
                         vis::Renderer& renderer, std::map<std::string, std::unique_ptr<ViewCache>>& caches) {
    return {.session = session,
            .source = std::move(source),
            .renderer = renderer,
            .jobs = outer.jobs,
            .caches = caches,
            .iconFont = outer.iconFont,
            .scale = outer.scale,
            .headless = outer.headless,
            .renderers = outer.renderers,
            .volumes = outer.volumes,
            .figure = outer.figure,
            .decoration = outer.decoration,
            .whiteGround = outer.whiteGround,
            .interacting = outer.interacting};
}

void takeAnswers(ViewContext& outer, const ViewContext& part, const std::string& words) {
    outer.answers.join(part.answers);
    outer.interacting = outer.interacting || part.interacting;
    for (const std::string& text : part.answers.messages) outer.answers.messages.push_back(words + text);
}

} // namespace tessera::app
