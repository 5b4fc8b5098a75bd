#include "app/callouts/callout_list.h"

#include "app/callouts/callout_place.h"
#include "app/pane/view_parts.h"
#include "app/ui/fitted_text.h"
#include "app/ui/parameter_widget.h"
#include "app/ui/widgets.h"

namespace tessera::app {

namespace {

/// "slice of lens catalyst: O2", or its own name.
std::string calloutRowText(const Callout& callout) {
    if (!callout.name.empty()) return callout.name;
    const std::string channel = callout.kind == CalloutKind::Scene || callout.channel.empty() ? "" : callout.channel;
    return std::string(kCalloutKindNames[std::size_t(callout.kind)]) + " of " +
           std::string(kCalloutOfNames[std::size_t(callout.of)]) + " " + callout.placeholder +
           (channel.empty() ? "" : ": " + channel);
}

/// One callout; true when it is to be removed.
bool drawCalloutRow(ViewContext& context, Callout& callout) {
    const volume::DatasetInfo& info = context.source->info();
    ImGui::Checkbox("##enabled", &callout.enabled);
    if (ImGui::IsItemHovered()) tooltip("Show this callout");
    ImGui::SameLine(0, em() * 0.3f);
    const bool removed = iconButton(context, "delete", icons::kTrash, "Remove this callout");
    ImGui::SameLine(0, em() * 0.3f);
    if (fittedTreeNode(calloutRowText(callout), "callout", {})) {
        if (callout.enabled && !calloutPlace(context.session, info, callout))
            faintText("There is no such " + std::string(kCalloutOfNames[std::size_t(callout.of)]) + ", or it is off.");
        drawDescribed(callout, WidgetContext{.info = &info});
        ImGui::TreePop();
    }
    return removed;
}

} // namespace

void drawCalloutList(ViewContext& context) {
    std::vector<Callout>& callouts = context.session.callouts;
    if (callouts.empty()) return;
    ImGui::Separator();
    ImGui::TextDisabled("Callouts, beside the volume");
    std::optional<std::size_t> gone;
    for (std::size_t i = 0; i < callouts.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        ImGui::PushID("callouts");
        if (drawCalloutRow(context, callouts[i])) gone = i;
        ImGui::PopID();
        ImGui::PopID();
    }
    if (gone) callouts.erase(callouts.begin() + static_cast<std::ptrdiff_t>(*gone));
}

} // namespace tessera::app
