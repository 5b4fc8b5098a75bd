#include "app/data/first_view.h"
#include "app/edits/show_parameter.h"
#include "app/pane/view_parts.h"
#include "app/session/own_functions.h"
#include "app/tools/lens_list.h"
#include "app/ui/parameter_widget.h"
#include "app/views/data/layer_list.h"
#include "app/views/data/task_settings.h"

#include <imgui.h>
#include <imgui_stdlib.h>

/// The settings of one layer. Those whose choices are things of the session have widgets of their own.
namespace tessera::app {

namespace {

/// The lens that a layer is drawn in.
void drawLens(const WidgetContext& widgets, const Session& session, vis::Layer& layer) {
    if (session.lenses.empty()) return;
    drawLabel(widgets, "Drawn", "Draw everywhere, or inside one lens only");
    chooseLens("##lens", session, layer.lens, "everywhere");
}

/// Whether a layer has a transfer function of its own, which begins as the one that it had.
void drawOwnFunction(const WidgetContext& widgets, Session& session, vis::Layer& layer) {
    const auto* surface = std::get_if<vis::IsoLayer>(&layer.technique);
    if (surface && surface->colorBy.empty()) return;
    bool own = !layer.transfer.empty();
    const FieldInfo field{"ownTransfer",
                          "Use a separate transfer function for this layer, instead of that of its parameter"};
    if (!drawBool(widgets, field, own)) return;
    const std::string channel = channelOfFunction(layer.technique);
    setOwnFunction(session, layer.transfer, channel, own, channel + " in " + layerName(layer));
}

} // namespace

void drawLayerSettings(ViewContext& context, const WidgetContext& widgets, vis::Layer& layer, const std::string& path) {
    const std::string before = vis::shownChannel(layer.technique);
    const WidgetContext place = widgets.at(path);
    drawMembers(valueOf(layer), place, [&](Value member, const FieldInfo& field) {
        if (field.key == "name") {
            drawLabel(widgets, "Name", "Name of the layer; empty: what it shows");
            ImGui::InputTextWithHint("##name", layerTitle(layer, context.source->info()).c_str(), &layer.name);
        } else if (field.key == "technique") {
            drawMembers(member.inside(), place.under(field.key));
        } else if (field.key == "lens") {
            drawLens(widgets, context.session, layer);
        } else if (field.key == "transfer") {
            drawOwnFunction(widgets, context.session, layer);
        } else {
            return field.key == "visible"; // the eye in the list
        }
        return true;
    });
    const std::string now = vis::shownChannel(layer.technique);
    followChannel(layer.name, before, now);
    if (now != before) aimLayer(context.session, *context.source, layer);
}

} // namespace tessera::app
