#include "app/pages/table_page.h"
#include "app/pane/view_parts.h"
#include "app/queries/async_query.h"
#include "app/queries/probe_values.h"
#include "app/tables/table_view.h"

#include <imgui_stdlib.h>
#include <memory>

namespace tessera::app {

namespace {

using ProbeNumbers = std::vector<std::vector<volume::ProbeValue>>;

struct ProbesCache : ViewCache {
    AsyncQuery<std::vector<Probe>, ProbeNumbers> answers;
};

/// The name of the probe at the cross-hair, to be typed, and the button that removes it.
void editHere(ViewContext& context, ToolRow& tools) {
    Session& session = context.session;
    const std::size_t here = probeHere(session, context.numbers->info());
    if (here >= session.probes.size()) return;
    if (tools.next(em() * 10)) {
        ImGui::SetNextItemWidth(em() * 10);
        ImGui::InputText("##name", &session.probes[here].name);
        if (ImGui::IsItemHovered()) tooltip("Name of the probe at the cross-hair");
    }
    if (tools.next(ImGui::GetFrameHeight()) &&
        iconButton(context, "remove", icons::kTrash, "Remove the probe at the cross-hair"))
        session.probes.erase(session.probes.begin() + static_cast<std::ptrdiff_t>(here));
}

} // namespace

void drawProbesView(ViewContext& context, const std::string& pane, ProbesView& view) {
    if (!context.source) {
        drawHint("No data", "Lists the values at places and times that you keep.");
        return;
    }
    Session& session = context.session;
    const volume::DatasetInfo& info = context.numbers->info();
    const std::vector<int> shown = chosenChannels(info, view.channels, 64);
    ToolRow tools(context);
    if (tools.next(ImGui::GetFrameHeight()) &&
        iconButton(context, "add", icons::kPlus, "Keep the values at the cross-hair, at the time shown (P)"))
        addProbe(session, info);
    chooseChannels(tools, info, view.channels, shown);
    editHere(context, tools);
    std::vector<Probe> places = session.probes;
    for (Probe& place : places) place.name.clear(); // values do not depend on it
    ProbesCache& cache = cacheOf<ProbesCache>(context, pane);
    const auto values = cache.answers.get(
        context, context.numbers, {.key = "probes " + pane, .title = "Values at probes", .quiet = true}, places,
        [](const auto& source, const std::vector<Probe>& asked, int, const Progress&) {
            return readProbes(*source, asked);
        },
        // Values of the first ones stand while further ones are read.
        [](const std::vector<Probe>& read, const std::vector<Probe>& wanted) {
            return read.size() <= wanted.size() && std::equal(read.begin(), read.end(), wanted.begin());
        });
    if (!values) {
        const std::string failure = cache.answers.failure();
        return failure.empty() ? ImGui::TextDisabled("Reading...") : drawHint("No values", failure.c_str());
    }
    const auto table = std::make_shared<const Table>(probesTable(info, session.probes, *values, shown));
    exportMenu(context, tools,
               {.name = "probes",
                .figure = [table](const PageForm& form, const Progress&) { return tablePage(*table, form); },
                .table = [table](const Progress&) { return *table; }},
               false);
    if (session.probes.empty()) return drawHint("No probes", "Press P to keep the values at the cross-hair.");
    const std::size_t here = probeHere(session, info);
    const auto look = [&](std::size_t row) -> TableRowLook {
        return {.selected = row == here, .tip = "Click: the cross-hair and the time go there"};
    };
    if (const auto clicked = drawTable("probes", *table, {.row = look})) {
        const auto position = positionOf(session.probes[*clicked], info);
        if (!position) return;
        session.cursor = *position;
        session.time = session.probes[*clicked].time;
    }
}

} // namespace tessera::app
