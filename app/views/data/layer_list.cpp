#include "app/views/data/layer_list.h"

#include "app/data/first_view.h"
#include "app/edits/add_layer.h"
#include "app/pane/view_parts.h"
#include "app/session/own_functions.h"
#include "app/session/session_json.h"
#include "app/views/timeline/keyframes.h"
#include "vis/glyphs/glyph_parts.h"

#include <algorithm>
#include <imgui.h>
#include <utility>

namespace tessera::app {

namespace {

constexpr const char* kLayerPayload = "tessera-layer";
/// By the index of vis::Technique.
constexpr const char* kLayerKinds[] = {"Volume", "Iso-surface", "Slice", "Flow", "Glyphs"};
static_assert(std::size(kLayerKinds) == std::variant_size_v<vis::Technique>);

Icon iconOf(const vis::Technique& technique) {
    static constexpr Icon kIcons[] = {icons::kCube, icons::kIso, icons::kSlice, icons::kFlow, icons::kGlyph};
    return kIcons[technique.index()];
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
    if (kind == 4) {
        vis::GlyphLayer glyphs{.channel = name};
        glyphs.parts = vis::firstGlyphParts(glyphs.kind, info);
        layer.technique = glyphs;
    }
    return layer;
}

} // namespace

const char* kindName(const vis::Technique& technique) {
    return kLayerKinds[technique.index()];
}

void addLayer(Session& session, const volume::BrickSource& source, std::size_t kind) {
    vis::Layer layer = newLayer(session, source.info(), kind);
    aimLayer(session, source, layer);
    addLayer(session, std::move(layer));
}

void drawLayerList(ViewContext& context, const volume::DatasetInfo& info, int& selected) {
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
        if (ImGui::Selectable("##row", chosen, ImGuiSelectableFlags_AllowItemOverlap, {0, height})) {
            selected = static_cast<int>(i);
            followSelectedLayer(context.session);
        }
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
        std::string channel = vis::shownChannel(layer.technique);
        const std::string whole = layerTitle(layer, info) + otherTimeText(layer, info, context.session.time);
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

void drawLayerButtons(ViewContext& context, const volume::DatasetInfo& info, int& selected) {
    std::vector<vis::Layer>& layers = context.session.layers;
    const bool any = selected >= 0 && selected < static_cast<int>(layers.size());
    const bool room = layers.size() < kMostLayers;
    if (iconButton(context, "add", icons::kPlus, "Add a layer", room)) ImGui::OpenPopup("add layer");
    if (ImGui::BeginPopup("add layer")) {
        for (std::size_t kind = 0; kind < std::size(kLayerKinds); ++kind)
            if (ImGui::MenuItem(kLayerKinds[kind], nullptr, false, kind != 3 || !firstVector(info).empty())) {
                addLayer(context.session, *context.source, kind);
                selected = static_cast<int>(layers.size()) - 1;
                followSelectedLayer(context.session);
            }
        ImGui::EndPopup();
    }
    ImGui::SameLine(0, em() * 0.2f);
    if (iconButton(context, "copy", icons::kCopy, "Duplicate the layer", any && room)) {
        vis::Layer copy = layers[static_cast<std::size_t>(selected)];
        if (!copy.name.empty()) copy.name += " copy";
        layers.insert(layers.begin() + selected + 1, copy);
        ++selected;
    }
    ImGui::SameLine(0, em() * 0.2f);
    if (iconButton(context, "remove", icons::kTrash, "Remove the layer", any)) {
        const std::vector<OwnFunction> before = ownFunctions(context.session);
        layers.erase(layers.begin() + selected);
        removeUnused(context.session, before, context.source->info());
        selected = std::min(selected, static_cast<int>(layers.size()) - 1);
    }
    ImGui::SameLine(0, em() * 0.8f);
    faintText("drag to reorder");
}

} // namespace tessera::app
