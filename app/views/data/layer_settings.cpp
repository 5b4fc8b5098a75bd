#include "app/data/first_view.h"
#include "app/edits/error_band.h"
#include "app/edits/region_surface.h"
#include "app/edits/show_parameter.h"
#include "app/pane/view_parts.h"
#include "app/session/own_functions.h"
#include "app/tools/lens_list.h"
#include "app/ui/parameter_widget.h"
#include "app/views/data/glyph_part_list.h"
#include "app/views/data/layer_list.h"
#include "app/views/data/task_settings.h"
#include "vis/glyphs/glyph_parts.h"
#include "volume/flow/flow_channels.h"

#include <algorithm>
#include <cmath>
#include <imgui.h>
#include <imgui_stdlib.h>
#include <optional>

/// The settings of one layer. Those whose choices are things of the session have widgets of their own.
namespace tessera::app {

namespace {

/// The lens that a layer is drawn in.
void drawLens(const WidgetContext& widgets, const Session& session, vis::Layer& layer) {
    if (session.lenses.empty()) return;
    drawLabel(widgets, "Drawn", "Draw everywhere, or inside one lens only");
    chooseLens("##lens", session, layer.lens, "everywhere");
}

bool isLabel(const volume::DatasetInfo& info, const std::string& name) {
    const auto channel = info.findChannel(name);
    return channel && volume::parameterOf(info, *channel).categorical;
}

/// The region that a surface of a label is around, by its name; true for fields that such a surface does not have.
bool drawRegion(const WidgetContext& widgets, vis::IsoLayer& surface, const volume::DatasetInfo& info,
                const FieldInfo& field) {
    const auto channel = info.findChannel(surface.channel);
    if (!channel || (field.key != "value" && field.key != "method")) return false;
    const volume::Parameter& label = volume::parameterOf(info, *channel);
    if (!label.categorical) return false;
    if (field.key == "method") return surface.method == vis::SurfaceMethod::Polygons; // as they should be
    drawLabel(widgets, "Region", "Region that the surface is around");
    const int now = int(std::lround(surface.value));
    if (!ImGui::BeginCombo("##region", volume::labelName(label, now).c_str())) return true;
    for (const volume::Label& each : label.labels)
        if (ImGui::Selectable((each.name + "##" + std::to_string(each.value)).c_str(), each.value == now))
            aimAtRegion(surface, label, each.value);
    ImGui::EndCombo();
    return true;
}

void tellFaintly(const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    ImGui::TextWrapped("%s", text.c_str());
    ImGui::PopStyleColor();
}

/// By how much a vector moves particles, above the factor on it.
void tellSpeed(const vis::FlowLayer& flow, const volume::DatasetInfo& info) {
    if (!vis::followsParticles(flow.kind)) return;
    const auto vector = std::ranges::find(info.parameters, flow.vector, &volume::Parameter::name);
    if (vector == info.parameters.end()) return;
    tellFaintly(flow.ignoreUnits ? "A vector of 1 is taken as 1 " + info.lengthFactor() + " per " +
                                       (info.timeUnit.empty() ? "time" : info.timeUnit)
                                 : volume::flowUnitsText(info, *vector));
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

/// A button that shows how far a surface may lie elsewhere, since packed samples are off by up to a bound: that, in the
/// unit of the parameter, where it is pressed.
std::optional<double> errorBandButton(const ViewContext& context, const vis::Layer& layer) {
    const auto* const surface = std::get_if<vis::IsoLayer>(&layer.technique);
    const auto channel = surface ? context.numbers->info().findChannel(surface->channel) : std::nullopt;
    if (!channel || isOfErrorBand(layer)) return std::nullopt;
    const volume::Channel own = context.numbers->info().channel(*channel);
    const auto bound = packingBound(context.origin, context.numbers->info(), own);
    if (!bound || !(bound->most > 0)) return std::nullopt;
    const std::string text = "\u00b1 " + boundWithUnit(bound->most, own.unit);
    const bool pressed = ImGui::SmallButton(("Show the band of " + text).c_str());
    if (ImGui::IsItemHovered())
        tooltip(
            ("Two translucent surfaces between which this one lies in the data that were packed: " + boundKind(*bound))
                .c_str());
    return pressed ? std::optional(bound->most) : std::nullopt;
}

} // namespace

void drawLayerSettings(ViewContext& context, const WidgetContext& widgets, vis::Layer& layer, const std::string& path) {
    const std::string before = vis::shownChannel(layer.technique), coloured = channelOfFunction(layer.technique);
    std::vector<OwnFunction> functions;
    if (!layer.transfer.empty()) functions = ownFunctions(context.session);
    const WidgetContext place = widgets.at(path);
    drawMembers(valueOf(layer), place, [&](Value member, const FieldInfo& field) {
        if (field.key == "name") {
            drawLabel(widgets, "Name", "Name of the layer; empty: what it shows");
            ImGui::InputTextWithHint("##name", layerTitle(layer, context.source->info()).c_str(), &layer.name);
        } else if (field.key == "technique") {
            auto* const surface = std::get_if<vis::IsoLayer>(&layer.technique);
            auto* const glyphs = std::get_if<vis::GlyphLayer>(&layer.technique);
            const auto* const flow = std::get_if<vis::FlowLayer>(&layer.technique);
            const auto kind = glyphs ? glyphs->kind : vis::GlyphKind();
            drawMembers(member.inside(), place.under(field.key), [&](Value, const FieldInfo& own) {
                if (flow && own.key == "vector" && widgets.info->timeAxis())
                    tellFaintly("Not drawn: an axis of these data is time, and vectors have no direction along it.");
                if (flow && own.key == "speed") tellSpeed(*flow, *widgets.info);
                if (glyphs && own.key == "parts") return drawGlyphParts(widgets, *glyphs);
                return surface && drawRegion(widgets, *surface, *widgets.info, own);
            });
            if (glyphs && glyphs->kind != kind) glyphs->parts = vis::partsOnKind(glyphs->parts, kind, glyphs->kind);
        } else if (field.key == "lens") {
            drawLens(widgets, context.session, layer);
        } else if (field.key == "transfer") {
            drawOwnFunction(widgets, context.session, layer);
        } else {
            return field.key == "visible"; // the eye in the list
        }
        return true;
    });
    const std::optional<double> band = errorBandButton(context, layer);
    const std::string now = vis::shownChannel(layer.technique);
    followChannel(layer.name, before, now);
    if (channelOfFunction(layer.technique) != coloured) {
        dropFormerFunction(context.session, layer, functions, context.source->info());
        followSelectedLayer(context.session);
    }
    if (band) // last, since layers move
        return showErrorBand(context.session, static_cast<std::size_t>(&layer - context.session.layers.data()), *band);
    if (now == before) return;
    if (auto* const surface = std::get_if<vis::IsoLayer>(&layer.technique); surface && isLabel(*widgets.info, before)) {
        surface->method = vis::IsoLayer().method;
        surface->color = vis::IsoLayer().color;
    }
    aimLayer(context.session, *context.source, layer);
}

} // namespace tessera::app
