#include "app/views/data/glyph_part_list.h"

#include "app/pane/controls.h"
#include "app/pane/glyph_legend.h"
#include "app/pane/plot.h"
#include "vis/glyphs/glyph_parts.h"
#include "vis/glyphs/glyph_shapes.h"

#include <algorithm>

namespace tessera::app {

namespace {

constexpr float kPartPicture = 7; // em

/// The glyph with every part at its most, those that nothing moves too where none is moved.
void drawGlyphAtMost(const vis::GlyphLayer& layer) {
    std::vector<double> shares(vis::glyphPartNames(layer.kind).size(), vis::kPartAtRest);
    for (std::size_t i = vis::kCommonGlyphParts; i < shares.size() && layer.kind != vis::GlyphKind::Ellipsoid; ++i)
        if (std::ranges::find(layer.parts, vis::glyphPartNames(layer.kind)[i], &vis::GlyphPart::part) !=
            layer.parts.end())
            shares[i] = 1;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float size = em() * kPartPicture, room = ImGui::GetContentRegionAvail().x;
    drawGlyphPicture(*ImGui::GetWindowDrawList(), {at.x + room / 2, at.y + size / 2}, size * 0.95f, layer.kind, shares);
    ImGui::Dummy({room, size});
}

/// Values of the least and the most of a part; those of the parameter until they are changed.
void drawPartRange(const WidgetContext& widgets, vis::GlyphPart& part) {
    const auto range = vis::glyphPartRange(part, *widgets.info);
    if (!range) return;
    const volume::Channel channel = widgets.info->channel(*widgets.info->findChannel(part.channel));
    double ends[] = {range->lo, range->hi};
    const std::string id = "values of " + part.part;
    const FieldInfo field{.key = id, .doc = "Values of the least and the most of the part", .unit = channel.unit};
    if (drawNumber(widgets.at(""), field, widgets.info->channelRange(channel), ends, 2, false))
        part.range = {ends[0], ends[1]};
}

/// The parameter of a part, and that which is dropped on it.
void drawGlyphPart(const WidgetContext& widgets, vis::GlyphLayer& layer, std::size_t index) {
    const std::string name(vis::glyphPartNames(layer.kind)[index]);
    drawLabel(widgets.at(""), labelOf(name),
              index == vis::kColorPart ? "Parameter whose transfer function colours the glyph"
                                       : "Parameter that moves this part of the glyph; none: at rest");
    if (const auto color = vis::glyphPartColor(layer.kind, index)) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float height = ImGui::GetFrameHeight(), side = em() * 0.7f;
        ImGui::GetWindowDrawList()->AddRectFilled({at.x - side - em() * 0.4f, at.y + (height - side) / 2},
                                                  {at.x - em() * 0.4f, at.y + (height + side) / 2},
                                                  toColor({color->r, color->g, color->b}));
    }
    const auto found = std::ranges::find(layer.parts, name, &vis::GlyphPart::part);
    std::string channel = found == layer.parts.end() ? "" : found->channel;
    const std::string id = "##" + name;
    bool changed = chooseChannel(id.c_str(), widgets.info, channel, "none");
    if (ImGui::BeginDragDropTarget()) {
        if (const ImGuiPayload* payload = ImGui::AcceptDragDropPayload(kParameterPayload)) {
            channel = static_cast<const char*>(payload->Data);
            changed = true;
        }
        ImGui::EndDragDropTarget();
    }
    if (changed) setGlyphPart(layer, name, channel);
    const auto now = std::ranges::find(layer.parts, name, &vis::GlyphPart::part);
    if (now != layer.parts.end() && index != vis::kColorPart) drawPartRange(widgets, *now);
}

} // namespace

void setGlyphPart(vis::GlyphLayer& layer, std::string_view part, const std::string& channel) {
    const auto found = std::ranges::find(layer.parts, part, &vis::GlyphPart::part);
    if (channel.empty()) {
        if (found != layer.parts.end()) layer.parts.erase(found);
    } else if (found == layer.parts.end()) {
        layer.parts.push_back({.part = std::string(part), .channel = channel});
    } else if (found->channel != channel) {
        found->channel = channel;
        found->range = {0, 0};
    }
}

bool drawGlyphParts(const WidgetContext& widgets, vis::GlyphLayer& layer) {
    if (!widgets.info) return true;
    if (!beginSection("parts", "Parts of the glyph", "Parameters that move the parts of the glyph")) return true;
    drawGlyphAtMost(layer);
    const std::size_t count = vis::glyphPartNames(layer.kind).size();
    for (std::size_t i = vis::kCommonGlyphParts; i < count; ++i) drawGlyphPart(widgets, layer, i);
    for (std::size_t i = 0; i < vis::kCommonGlyphParts; ++i) drawGlyphPart(widgets, layer, i);
    endSection();
    return true;
}

} // namespace tessera::app
