#include "app/callouts/callout_menu.h"

#include "app/data/first_view.h"
#include "app/edits/add_callout.h"
#include "app/pane/view_parts.h"
#include "app/tools/lens_list.h"
#include "app/ui/parameter_widget.h"
#include "app/ui/widgets.h"

#include <algorithm>

namespace tessera::app {

namespace {

constexpr const char* kKindEntries[] = {"Scene, cut to its place", "Slice", "Histogram", "Profile", "Table of numbers"};
static_assert(std::size(kKindEntries) == std::size(kCalloutKindNames));

/// A menu of parameters; calls `chosen` with the name of the one that is clicked.
template <class Chosen> void parameterMenu(const ViewContext& context, const char* name, const Chosen& chosen) {
    if (!ImGui::BeginMenu(name)) return;
    const volume::DatasetInfo& info = context.source->info();
    for (const int channel : comparedChannels(info)) {
        const volume::Channel own = info.channel(channel);
        if (ImGui::MenuItem(titleWithUnit(own.name, own.unit).c_str())) chosen(own.name);
    }
    ImGui::EndMenu();
}

/// A layer of its own that shows a parameter, aimed as a new one of the view would be.
void showAlone(ViewContext& context, Callout& callout, const std::string& channel, bool surface) {
    const volume::DatasetInfo& info = context.source->info();
    vis::Layer layer{.name = channel, .technique = vis::VolumeLayer{.channel = channel}};
    if (surface) {
        const Range range = info.channelRange(info.channel(info.findChannel(channel).value_or(0)));
        layer.technique = vis::IsoLayer{.channel = channel, .value = 0.5 * (range.lo + range.hi)};
    }
    aimLayer(context.session, *context.source, layer);
    callout.layers = {std::move(layer)};
}

void drawSceneEntries(ViewContext& context, Callout& callout) {
    if (ImGui::MenuItem("Layers of the view", nullptr, !callout.layers)) callout.layers.reset();
    parameterMenu(context, "Volume of", [&](const std::string& name) { showAlone(context, callout, name, false); });
    parameterMenu(context, "Surface of", [&](const std::string& name) { showAlone(context, callout, name, true); });
    if (ImGui::MenuItem("Turn as the view", "double click", false, callout.turn != glm::quat(1, 0, 0, 0)))
        callout.turn = glm::quat(1, 0, 0, 0);
}

/// A copy of a callout that shows another parameter.
void compareWith(ViewContext& context, Callout other) {
    Session& session = context.session;
    const std::string name = parameterToCompare(session, context.source->info(), other.of, other.placeholder);
    other.name.clear();
    if (other.kind != CalloutKind::Scene)
        other.channel = name;
    else if (!name.empty())
        showAlone(context, other, name, false);
    session.callouts.push_back(std::move(other));
}

} // namespace

void calloutOfLens(Session& session, const volume::DatasetInfo& info, std::string lens) {
    if (lens.empty() && session.lenses.empty()) {
        vis::Lens mark = newLens(session, info, vis::LensEffect::Enhance);
        mark.strength = 0;
        mark.marks = false;
        session.lenses.push_back(std::move(mark));
    }
    if (lens.empty()) lens = session.lenses.back().name;
    addCallout(session, info, CalloutOf::Lens, lens);
}

void calloutOfBrush(Session& session, const volume::DatasetInfo& info) {
    addCallout(session, info, CalloutOf::Brush, session.selection.brushes.back().name);
}

void drawCalloutEntries(ViewContext& context, const std::string& lens) {
    Session& session = context.session;
    const volume::DatasetInfo& info = context.source->info();
    const bool room = takesCallout(session);
    if (ImGui::MenuItem("Callout of lens", nullptr, false, room)) calloutOfLens(session, info, lens);
    if (ImGui::MenuItem("Callout of plane", nullptr, false, room))
        addCallout(session, info, CalloutOf::Plane, firstPlane(session));
    if (ImGui::MenuItem("Callout of brush", nullptr, false, room && !session.selection.brushes.empty()))
        calloutOfBrush(session, info);
}

void drawPlaneCalloutEntry(ViewContext& context, const std::string& plane, const std::string& channel) {
    Session& session = context.session;
    if (!ImGui::MenuItem("Callout of plane", nullptr, false, takesCallout(session))) return;
    const std::size_t added = addCallout(session, context.source->info(), CalloutOf::Plane, plane);
    if (session.callouts[added].channel.empty()) session.callouts[added].channel = channel;
}

bool drawCalloutMenu(ViewContext& context, std::size_t index) {
    Session& session = context.session;
    Callout& callout = session.callouts[index];
    const volume::DatasetInfo& info = context.source->info();
    for (std::size_t kind = 0; kind < std::size(kKindEntries); ++kind)
        if (ImGui::MenuItem(kKindEntries[kind], nullptr, std::size_t(callout.kind) == kind))
            callout.kind = static_cast<CalloutKind>(kind);
    ImGui::Separator();
    if (callout.kind == CalloutKind::Scene)
        drawSceneEntries(context, callout);
    else if (callout.kind != CalloutKind::Numbers)
        parameterMenu(context, "Parameter", [&](const std::string& name) { callout.channel = name; });
    if (info.times.size() > 1)
        if (bool own = callout.time.has_value(); ImGui::MenuItem("Keep this time", nullptr, &own))
            callout.time = own ? std::optional(session.time) : std::nullopt;
    if (ImGui::BeginMenu("Settings")) {
        ImGui::Dummy({em() * 24, 0}); // its least width
        drawDescribed(callout, WidgetContext{.info = &info});
        ImGui::EndMenu();
    }
    ImGui::Separator();
    if (ImGui::MenuItem("Compare with another parameter", nullptr, false, takesCallout(session)))
        compareWith(context, callout);
    return ImGui::MenuItem("Remove callout");
}

} // namespace tessera::app
