#include "app/views/compare/compare_panes.h"

#include "app/pane/inner_view.h"
#include "app/pane/view_parts.h"

#include <algorithm>

namespace tessera::app {

namespace {

/// What views edit of what they share; the rest belongs to the variants.
void takeEdits(Session& session, const Session& before, const Session& after) {
    const auto take = [&](auto Session::*member) {
        if (!(before.*member == after.*member)) session.*member = after.*member;
    };
    take(&Session::time);
    take(&Session::cursor);
    take(&Session::camera);
    take(&Session::selection);
}

void drawState(ViewContext& context, const std::string& pane, ViewState& state) {
    forEachViewKind([&, at = std::size_t(0), index = state.index()]<class Kind>(const Kind&) mutable {
        if (at++ == index) Kind::draw(context, pane, std::get<typename Kind::State>(state));
    });
}

} // namespace

bool canBeCompared(const ViewState& view) {
    const ViewTraits& traits = traitsOf(view);
    return (traits.figure || traits.csv || traits.inSpace) && !std::holds_alternative<CompareView>(view) &&
           !std::holds_alternative<VolumeView>(view);
}

CompareMode modeOf(const CompareView& view) {
    if (view.shows.empty() || view.mode == CompareMode::Blink) return view.mode;
    return CompareMode::Grid;
}

void drawComparedPane(ViewContext& context, const std::string& pane, const std::string& shows, std::size_t index,
                      CompareCell& cell, const PictureBox& box) {
    const auto found = context.session.views.find(shows);
    if (found == context.session.views.end() || !canBeCompared(found->second)) {
        addTextWithBackdrop(*ImGui::GetWindowDrawList(), {box.min.x + box.size.x / 2, box.min.y + box.size.y / 2},
                            {0.5f, 0.5f}, plotColors().faint, ("No view is named " + shows).c_str());
        return;
    }
    CompareData* data = cell.data.get();
    if (data && !data->renderer) {
        data->renderer = context.renderer.another();
        data->renderer->setSource(data->source);
    }
    Session edited = cell.session;
    ViewState state = found->second;
    Decoration decoration = context.decoration;
    decoration.legend = decoration.legend && !std::holds_alternative<SlicesView>(state);
    ViewContext own = innerContext(context, edited, data ? data->source : context.source,
                                   data ? *data->renderer : context.renderer, cell.caches);
    own.numbers = data ? data->numbers : context.numbers;
    own.origin = data ? data->origin : context.origin;
    own.figure = true;
    own.decoration = decoration;
    ImGui::SetCursorScreenPos(box.min);
    ImGui::BeginChild("view", box.size, false, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
    drawState(own, pane + "/" + std::to_string(index), state);
    ImGui::EndChild();
    takeEdits(context.session, cell.session, edited);
    // Drawing may have changed the list of views.
    const auto kept = context.session.views.find(shows);
    if (kept != context.session.views.end() && !(state == kept->second)) kept->second = state;
    takeAnswers(context, own);
}

CompareLegends paneLegends(const ViewContext& context, const std::string& shows,
                           const std::vector<std::shared_ptr<CompareCell>>& cells,
                           const std::vector<std::size_t>& shown) {
    const auto found = context.session.views.find(shows);
    const SlicesView* slices = found == context.session.views.end() ? nullptr : std::get_if<SlicesView>(&found->second);
    CompareLegends legends;
    for (const std::size_t index : shown) {
        std::vector<LegendEntry>& own = legends.emplace_back();
        const CompareCell& cell = *cells[index];
        const auto& source = cell.isOpening() ? context.source : cell.source(context);
        if (!slices || !cell.failure.empty() || !source) continue;
        if (const auto channel = resolveChannel(source->info(), cell.session, slices->channel))
            own.push_back(legendOf(cell.session, source->info(), *channel));
    }
    return legends;
}

} // namespace tessera::app
