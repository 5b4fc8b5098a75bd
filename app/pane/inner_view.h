#pragma once

#include "app/pane/view_context.h"

/// A view inside a view: of another session, or of other data.
namespace tessera::app {

/// The context of a part of a view that shows and edits `session`, with numbers of its data. Other data than those of
/// `outer` come with a renderer and caches of their own. Commands of the window are left out.
ViewContext innerContext(const ViewContext& outer, Session& session, std::shared_ptr<const volume::BrickSource> source,
                         vis::Renderer& renderer, std::map<std::string, std::unique_ptr<ViewCache>>& caches);

/// Takes over what a part has to say, with words before its messages, and whether it is being edited.
void takeAnswers(ViewContext& outer, const ViewContext& part, const std::string& words = {});

} // namespace tessera::app
