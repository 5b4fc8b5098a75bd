#include "app/views/data/layers_view.h"
#include "app/data/first_view.h"
#include "app/edits/add_layer.h"
#include "app/edits/context_style.h"
#include "app/pane/pane_title.h"
#include "app/pane/view_parts.h"
#include "app/session/shown_scene.h"
#include "app/tools/brush_list.h"
#include "app/tools/lens_list.h"
#include "app/ui/parameter_widget.h"
#include "app/ui/ticks.h"
#include "app/views/timeline/keyframes.h"

#include <algorithm>
#include <imgui.h>
#include <imgui_stdlib.h>
#include <utility>

namespace tessera::app {

namespace {

constexpr const char* kLayerPayload = "tessera-layer";

struct LayersCache : ViewCache {
    LensStatistics lenses;
};

Icon iconOf(const vis::Technique& technique) {
    static constexpr Icon kIcons[] = {icons::kCube, icons::kIso, icons::kSlice, icons::kFlow};
    return kIcons[technique.index()];
}

const char* kindName(const vis::Technique& technique) {
    static constexpr const char* kNames[] = {"Volume", "Iso-surface", "Slice", "Flow"};
    return kNames[technique.index()];
}

std::string channelOf(const vis::Technique& technique) {
    return std::visit([](const auto& own) { return own.channel; }, technique);
}

/// A layer of a kind that shows something at once: an iso-surface lies in the middle of its parameter's range.
vis::Layer newLayer(const Session& session, const volume::DatasetInfo& info, std::size_t kind) {
    vis::Layer layer;
    const auto channel = resolveChannel(info, session, "");
    const std::string name = channel ? info.channel(*channel).name : "";
    if (kind == 0) layer.technique = vis::VolumeLayer{.channel = name};
    if (kind == 1) {
        vis::IsoLayer iso{.channel = name};
        if (channel) {
            const Range range = info.channelRange(info.channel(*channel));
            iso.value = (range.lo + range.hi) / 2;
        }
        layer.technique = iso;
    }
    if (kind == 2) layer.technique = vis::SliceLayer{.channel = name};
    if (kind == 3) {
        const std::string vector = firstVector(info);
        layer.technique = vis::FlowLayer{.vector = vector, .channel = vector.empty() ? name : "|" + vector + "|"};
    }
    return layer;
}

void drawList(ViewContext& context, const volume::DatasetInfo& info, int& selected) {
    std::vector<vis::Layer>& layers = context.session.layers;
    int moveFrom = -1, moveTo = 0;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        vis::Layer& layer = layers[i];
        ImGui::PushID(static_cast<int>(i));
        if (iconButton(context, "eye", layer.visible ? icons::kEye : icons::kEyeOff,
                       layer.visible ? "Hide this layer" : "Show this layer"))
            layer.visible = !layer.visible;
        ImGui::SameLine(0, em() * 0.3f);
        const bool chosen = selected == static_cast<int>(i);
        const float height = ImGui::GetFrameHeight();
        const ImVec2 at = ImGui::GetCursorPos();
        if (ImGui::Selectable("##row", chosen, ImGuiSelectableFlags_AllowItemOverlap, {0, height}))
            selected = static_cast<int>(i);
        if (ImGui::BeginDragDropSource()) {
            const int index = static_cast<int>(i);
            ImGui::SetDragDropPayload(kLayerPayload, &index, sizeof index);
            ImGui::TextUnformatted(layerTitle(layer, info).c_str());
            ImGui::EndDragDropSource();
        }
        if (ImGui::BeginDragDropTarget()) {
            if (const ImGuiPayload* payload = ImGui::AcceptDragDropPayload(kLayerPayload)) {
                moveFrom = *static_cast<const int*>(payload->Data);
                moveTo = static_cast<int>(i);
            }
            ImGui::EndDragDropTarget();
        }
        const bool hovered = ImGui::IsItemHovered();
        ImGui::SetCursorPos(at);
        iconText(context, iconOf(layer.technique),
                 ImGui::GetColorU32(layer.visible ? ImGuiCol_Text : ImGuiCol_TextDisabled));
        ImGui::SameLine(0, em() * 0.3f);
        ImGui::AlignTextToFramePadding();
        // A layer named after its parameter need not say it twice.
        std::string channel = channelOf(layer.technique);
        const std::string whole = layerTitle(layer, info);
        if (whole == channel || whole.starts_with(channel + " ") || layer.name.empty()) channel.clear();
        const float room = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(channel.c_str()).x - em() * 1.5f;
        const std::string name = fitText(whole, room);
        if (hovered) tooltip(((name == whole ? "" : whole + "\n") + kindName(layer.technique)).c_str());
        if (layer.visible)
            ImGui::TextUnformatted(name.c_str());
        else
            ImGui::TextDisabled("%s", name.c_str());
        ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(channel.c_str()).x - em() * 0.4f);
        ImGui::TextDisabled("%s", channel.c_str());
        ImGui::PopID();
    }
    if (moveFrom >= 0 && moveFrom != moveTo) {
        const vis::Layer moved = layers[static_cast<std::size_t>(moveFrom)];
        layers.erase(layers.begin() + moveFrom);
        layers.insert(layers.begin() + moveTo, moved);
        selected = moveTo;
    }
    if (layers.empty()) faintText("No layers: the volume view is empty.");
}

/// The heading of the list, which says whose layers it has where there are several lists.
std::string listTitle(const Session& session, const std::string& pane, const volume::DatasetInfo& info) {
    if (layerLists(session).size() < 2) return "Layers";
    const VolumeView* view = volumeView(session, pane);
    return view && view->layers ? "Layers of " + shownTitle(session, pane, info) + " alone" : "Layers, shared";
}

/// The place in the session of the layers shown.
std::string layersPath(const Session& session, const std::string& pane) {
    const VolumeView* view = volumeView(session, pane);
    return view && view->layers ? detail::joinPointer("/views", pane) + "/layers" : "/layers";
}

/// Whether a layer of any list has this function for its own.
bool usesFunction(const Session& session, const std::string& name) {
    return std::ranges::any_of(layerLists(session), [&](const auto* layers) {
        return std::ranges::any_of(*layers, [&](const vis::Layer& layer) { return layer.transfer == name; });
    });
}

/// The lens, transfer function and time that a layer has of its own.
void drawPlace(const WidgetContext& widgets, Session& session, vis::Layer& layer) {
    if (!session.lenses.empty()) {
        drawLabel(widgets, "Drawn", "Draw everywhere, or inside one lens only");
        chooseLens("##lens", session, layer.lens, "everywhere");
    }
    const auto* surface = std::get_if<vis::IsoLayer>(&layer.technique);
    if (!surface || !surface->colorBy.empty()) {
        bool own = !layer.transfer.empty();
        const FieldInfo field{.key = "ownTransfer",
                              .unit = "",
                              .doc =
                                  "Use a separate transfer function for this layer, instead of that of its parameter"};
        if (drawBool(widgets, field, own)) {
            const std::string channel = surface ? surface->colorBy : channelOf(layer.technique);
            const vis::TransferFunction now = transferOf(session, layer.transfer.empty() ? channel : layer.transfer);
            std::string name = channel + " in " + layerName(layer);
            while (own && session.transfer.contains(name)) name += "'";
            if (own) session.transfer[name] = now;
            const std::string former = std::exchange(layer.transfer, own ? name : "");
            if (!own && !usesFunction(session, former)) session.transfer.erase(former);
        }
    }
    bool changed = false;
    std::optional<Range> scale;
    std::string unit;
    const MemberToWidget draw{widgets, changed, scale, unit};
    valueOf(layer).visitMembers([&](Value value, const FieldInfo& field) {
        if (field.key == "timeShift" || field.key == "brushes") draw(value, field);
    });
}

/// One click for each way of drawing what is not brushed, and the weights of its hull.
void drawContextStyles(ViewContext& context, const WidgetContext& widgets, const std::string& layersPath) {
    Session& session = context.session;
    ImGui::TextDisabled("What is not brushed");
    const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    for (std::size_t i = 0; i < std::size(kContextStyleNames); ++i) {
        const std::string name(kContextStyleNames[i]);
        const float width = ImGui::CalcTextSize(name.c_str()).x + 2 * ImGui::GetStyle().FramePadding.x;
        if (i > 0 && ImGui::GetItemRectMax().x + ImGui::GetStyle().ItemSpacing.x + width <= right) ImGui::SameLine();
        const auto style = static_cast<ContextStyle>(i);
        if (ImGui::SmallButton(name.c_str())) setContextStyle(session, context.source->info(), style);
        if (ImGui::IsItemHovered()) tooltip(std::string(contextStyleHelp(style)).c_str());
    }
    drawDescribed(session.selection, widgets.at("/selection"));
    const std::optional<std::size_t> hull = hullLayer(session);
    if (!hull) return;
    auto& surface = std::get<vis::IsoLayer>(session.layers[*hull].technique);
    const std::string path = layersPath + "/" + std::to_string(*hull) + "/technique";
    ImGui::PushID("hull");
    if (ImGui::TreeNodeEx("Hull", ImGuiTreeNodeFlags_DefaultOpen | ImGuiTreeNodeFlags_SpanAvailWidth)) {
        drawDescribed(surface, widgets.at(path));
        ImGui::TreePop();
    }
    ImGui::PopID();
}

/// The camera of a volume view, its own or the shared one.
void drawCamera(Session& session, const std::string& pane, const WidgetContext& widgets) {
    VolumeView* const view = volumeView(session, pane);
    const bool own = view && view->camera;
    drawDescribed(own ? *view->camera : session.camera,
                  widgets.at(own ? detail::joinPointer("/views", pane) + "/camera" : "/camera"));
}

/// How much longer than true each axis is drawn.
void drawProportions(Session& session, const WidgetContext& widgets) {
    double stretch[] = {session.stretch.x, session.stretch.y, session.stretch.z};
    const FieldInfo field{.key = "stretch",
                          .unit = "",
                          .doc = "Factor by which each axis is stretched; 1 = true proportions",
                          .range = Range{0.01, 1000},
                          .logScale = true};
    if (drawNumber(widgets, field, {}, stretch, 3, false)) session.stretch = {stretch[0], stretch[1], stretch[2]};
    if (ImGui::SmallButton("True proportions")) session.stretch = glm::dvec3(1);
}

void drawListButtons(ViewContext& context, const volume::DatasetInfo& info, int& selected) {
    std::vector<vis::Layer>& layers = context.session.layers;
    const bool any = selected >= 0 && selected < static_cast<int>(layers.size());
    if (iconButton(context, "add", icons::kPlus, "Add a layer")) ImGui::OpenPopup("add layer");
    if (ImGui::BeginPopup("add layer")) {
        static constexpr const char* kNames[] = {"Volume", "Iso-surface", "Slice", "Flow"};
        for (std::size_t kind = 0; kind < std::size(kNames); ++kind)
            if (ImGui::MenuItem(kNames[kind], nullptr, false, kind != 3 || !firstVector(info).empty())) {
                addLayer(context.session, *context.source, kind);
                selected = static_cast<int>(layers.size()) - 1;
            }
        ImGui::EndPopup();
    }
    ImGui::SameLine(0, em() * 0.2f);
    if (iconButton(context, "copy", icons::kCopy, "Duplicate the layer", any)) {
        vis::Layer copy = layers[static_cast<std::size_t>(selected)];
        if (!copy.name.empty()) copy.name += " copy";
        layers.insert(layers.begin() + selected + 1, copy);
        ++selected;
    }
    ImGui::SameLine(0, em() * 0.2f);
    if (iconButton(context, "remove", icons::kTrash, "Remove the layer", any)) {
        layers.erase(layers.begin() + selected);
        selected = std::min(selected, static_cast<int>(layers.size()) - 1);
    }
    ImGui::SameLine(0, em() * 0.8f);
    faintText("drag to reorder");
}

} // namespace

void addLayer(Session& session, const volume::BrickSource& source, std::size_t kind) {
    vis::Layer layer = newLayer(session, source.info(), kind);
    aimLayer(session, source, layer);
    addLayer(session, std::move(layer));
}

void followChannel(std::string& name, const std::string& before, const std::string& now) {
    if (before.empty() || before == now) return;
    if (name == before || name.starts_with(before + " "))
        name = now + name.substr(before.size());
    else if (name.ends_with(" of " + before))
        name = name.substr(0, name.size() - before.size()) + now;
}

void drawLayersView(ViewContext& context, const std::string& pane, LayersView& view) {
    if (!context.source) {
        drawHint("No data", "Lists the layers that the 3D views draw.");
        return;
    }
    const volume::DatasetInfo& info = context.source->info();
    Session& session = context.session;
    const std::string of = volumePane(session);
    const std::string title = listTitle(session, of, info) + "###layers", path = layersPath(session, of);
    ShownScene scene(session, of, {Owned::Layers}); // numbers are those of the time that is shared
    // Paths lead into the session as it is.
    const std::function<void(const std::string&)> menu = [&, own = parameterMenu(context)](const std::string& at) {
        scene.outside([&] { own(at); });
    };
    const WidgetContext widgets{.info = &info, .menu = &menu};
    ImGui::BeginChild("layers");
    // Lists differ in length: only a choice of the user is stored.
    const auto last = [&] { return std::max(0, static_cast<int>(session.layers.size()) - 1); };
    const int chosen = std::clamp(view.selected, 0, last());
    int selected = chosen;
    if (ImGui::CollapsingHeader(title.c_str(), ImGuiTreeNodeFlags_DefaultOpen)) {
        drawList(context, info, selected);
        drawListButtons(context, info, selected);
    }
    selected = std::clamp(selected, 0, last());
    if (selected != chosen) view.selected = selected;
    if (!session.layers.empty()) {
        vis::Layer& layer = session.layers[static_cast<std::size_t>(selected)];
        const std::string kind = std::string(kindName(layer.technique)) + "###technique";
        if (ImGui::CollapsingHeader(kind.c_str(), ImGuiTreeNodeFlags_DefaultOpen)) {
            ImGui::PushID(selected);
            drawLabel(widgets, "Name", "Name of the layer; empty: what it shows");
            ImGui::InputTextWithHint("##name", layerTitle(layer, info).c_str(), &layer.name);
            const std::string before = channelOf(layer.technique);
            const WidgetContext own = widgets.at(path + "/" + std::to_string(selected) + "/technique");
            std::visit([&](auto& technique) { drawDescribed(technique, own); }, layer.technique);
            const std::string now = channelOf(layer.technique);
            followChannel(layer.name, before, now);
            if (now != before) aimLayer(session, *context.source, layer);
            drawPlace(widgets, session, layer);
            ImGui::PopID();
        }
    }
    if (ImGui::CollapsingHeader("Lenses", ImGuiTreeNodeFlags_DefaultOpen))
        drawLensList(context, pane, cacheOf<LayersCache>(context, pane).lenses);
    if (ImGui::CollapsingHeader("Focus and context", ImGuiTreeNodeFlags_DefaultOpen)) {
        drawBrushList(context);
        drawContextStyles(context, widgets, path);
    }
    if (ImGui::CollapsingHeader("Camera")) drawCamera(session, of, widgets);
    if (ImGui::CollapsingHeader("Light")) {
        const std::function<void()> browse = [&] {
            context.askFile("Picture of the surroundings", [](Session& now, const std::string& file) {
                now.lighting.environment.kind = vis::Environment::Picture;
                now.lighting.environment.picture = file;
            });
        };
        WidgetContext light = widgets.at("/lighting");
        light.browse = &browse;
        drawDescribed(session.lighting, light);
    }
    if (ImGui::CollapsingHeader("Paper")) {
        bool paper = session.paper.has_value();
        if (drawBool(widgets, {.key = "paper", .unit = "", .doc = "Draw on paper with the settings below"}, paper)) {
            const std::optional<vis::Paper> shown = vis::paperOf(sceneOf(session));
            session.paper = paper ? std::optional(shown.value_or(vis::Paper{})) : std::nullopt;
        }
        if (session.paper) drawDescribed(*session.paper, widgets.at("/paper"));
    }
    if (ImGui::CollapsingHeader("Clipping"))
        drawDescribedList(widgets.at("/clips"),
                          {.key = "clips", .unit = "", .doc = "Planes and bodies that cut the data open"},
                          session.clips);
    if (ImGui::CollapsingHeader("Tone curve")) drawDescribed(session.tone, widgets.at("/tone"));
    if (ImGui::CollapsingHeader("Quality")) drawDescribed(session.render, widgets.at("/render"));
    if (ImGui::CollapsingHeader("Proportions")) drawProportions(session, widgets);
    ImGui::EndChild();
}

} // namespace tessera::app
