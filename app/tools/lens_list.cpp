#include "app/tools/lens_list.h"

#include "app/data/first_view.h"
#include "app/edits/add_callout.h"
#include "app/edits/add_layer.h"
#include "app/edits/scene_task.h"
#include "app/pane/view_parts.h"
#include "app/session/shown_scene.h"
#include "app/ui/parameter_widget.h"
#include "app/ui/ticks.h"

#include <algorithm>
#include <imgui_stdlib.h>

namespace tessera::app {

namespace {

/// How effects are called in menus, and what they do.
struct EffectWords {
    const char* name;
    const char* help;
};
constexpr EffectWords kEffects[] = {
    {"replace", "Inside, the layers of the lens replace the others; a lens without layers cuts them away"},
    {"only this", "Only what is inside is drawn"},
    {"enhance", "What is inside becomes more opaque"},
    {"suppress", "What is inside becomes faint and grey"},
    {"magnify", "The centre is magnified, as by a fisheye lens"},
    {"brushes", "Brushes act inside only; outside, nothing fades"},
};
static_assert(std::size(kEffects) == std::size(vis::kLensEffectNames));

/// Unlike those of brushes (brush_edit.cpp), with colour blindness too.
constexpr glm::vec3 kColors[] = {{0.8f, 0.75f, 1.0f}, {0.75f, 0.6f, 0.45f}, {0.35f, 0.65f, 0.7f}, {0.8f, 0.0f, 0.75f}};

std::string freeName(const Session& session, std::string wanted, std::size_t except) {
    const std::string base = wanted;
    const auto taken = [&] {
        for (std::size_t i = 0; i < session.lenses.size(); ++i)
            if (i != except && session.lenses[i].name == wanted) return true;
        return false;
    };
    for (int number = 2; wanted.empty() || taken(); ++number)
        wanted = (base.empty() ? "lens" : base) + " " + std::to_string(number);
    return wanted;
}

std::string layersOf(const Session& session, const std::string& lens) {
    std::string names;
    for (const vis::Layer& layer : session.layers)
        if (layer.lens == lens) names += (names.empty() ? "" : ", ") + layerName(layer);
    return names;
}

/// Mean and range of every parameter inside of a lens.
void drawStatistics(ViewContext& context, const std::string& pane, LensStatistics& statistics, const vis::Lens& lens) {
    const volume::DatasetInfo& info = context.numbers->info();
    const std::vector<int> shown = chosenChannels(info, {}, 12);
    if (shown.empty() || !vis::activeAt(lens, context.session.time) || !lens.inSpace()) return;
    BrushedQuery query;
    query.channels = shown;
    const std::vector<volume::Channel> channels = info.channels();
    for (const int channel : shown)
        query.ranges.push_back(paddedRange(info.channelRange(channels[static_cast<std::size_t>(channel)])));
    query.time = volume::timesAround(info.times, context.session.time);
    query.bins = 1;
    query.selection.brushes = {{.name = "", .color = {}, .region = vis::LensRegion{lens.name}}};
    query.lenses = lensSpace(context.session, info);
    std::erase_if(query.lenses.lenses, [&](const vis::PlacedLens& other) { return other.name != lens.name; });
    const auto result = statistics.byLens[lens.name].get(context, pane + " lens " + lens.name, query);
    if (!result) {
        ImGui::TextDisabled("Counting...");
        return;
    }
    faintText(originText(context, shown));
    if (!ImGui::BeginTable("inside", 3, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp)) return;
    for (const char* name : {"Inside", "Mean", "Range"}) ImGui::TableSetupColumn(name);
    tableHeader({"Inside", "Mean", "Range"}, 1);
    for (std::size_t i = 0; i < shown.size() && i < result->statistics.channels.size(); ++i) {
        const volume::Channel& channel = channels[static_cast<std::size_t>(shown[i])];
        const volume::Summary& inside = result->statistics.channels[i].inside;
        const Range range = info.channelRange(channel);
        const double digits = (range.hi - range.lo) / 1000;
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(titleWithUnit(channel.name, channel.unit).c_str());
        ImGui::TableNextColumn();
        textRight(inside.samples > 0 ? formatNumber(inside.mean, digits) : "-");
        ImGui::TableNextColumn();
        textRight(inside.samples > 0 ? formatNumber(inside.min, digits) + " .. " + formatNumber(inside.max, digits)
                                     : "-",
                  true);
    }
    ImGui::EndTable();
}

void chooseEffect(vis::Lens& lens) {
    const auto now = static_cast<std::size_t>(lens.effect);
    ImGui::SetNextItemWidth(em() * 5.6f);
    if (ImGui::BeginCombo("##effect", kEffects[now].name)) {
        for (std::size_t i = 0; i < std::size(kEffects); ++i) {
            if (ImGui::Selectable(kEffects[i].name, i == now)) lens.effect = static_cast<vis::LensEffect>(i);
            if (ImGui::IsItemHovered()) tooltip(kEffects[i].help);
        }
        ImGui::EndCombo();
    }
    if (ImGui::IsItemHovered()) tooltip(kEffects[now].help);
}

constexpr const char* kLensPayload = "tessera-lens";

enum class RowAction { None, Remove, Up };

/// A grip in front of a lens: dragged onto another one it takes that one's place in the order. Returns the place of the
/// lens that was dropped here, -1 for none.
int drawGrip(const ViewContext& context, const vis::Lens& lens, std::size_t index) {
    iconButton(context, "grip", {"\uf142", "::"},
               "Drag onto another lens to change the order; later ones lie over earlier ones");
    if (ImGui::BeginDragDropSource()) {
        const int from = static_cast<int>(index);
        ImGui::SetDragDropPayload(kLensPayload, &from, sizeof from);
        ImGui::TextUnformatted(lens.name.c_str());
        ImGui::EndDragDropSource();
    }
    int dropped = -1;
    if (ImGui::BeginDragDropTarget()) {
        if (const ImGuiPayload* payload = ImGui::AcceptDragDropPayload(kLensPayload))
            dropped = *static_cast<const int*>(payload->Data);
        ImGui::EndDragDropTarget();
    }
    ImGui::SameLine(0, em() * 0.3f);
    return dropped;
}

RowAction drawLens(ViewContext& context, const std::string& pane, LensStatistics& statistics, std::size_t index,
                   std::optional<bool> unfold) {
    Session& session = context.session;
    vis::Lens& lens = session.lenses[index];
    RowAction action = RowAction::None;
    ImGui::Checkbox("##enabled", &lens.enabled);
    if (ImGui::IsItemHovered()) tooltip("Apply and show this lens");
    ImGui::SameLine(0, em() * 0.3f);
    ImGui::ColorEdit3("##color", &lens.color.x,
                      ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_NoLabel | ImGuiColorEditFlags_NoTooltip);
    if (ImGui::IsItemHovered()) tooltip("Colour of its outline");
    ImGui::SameLine(0, em() * 0.3f);
    const bool narrow = narrowRows();
    if (!narrow) {
        chooseEffect(lens);
        ImGui::SameLine(0, em() * 0.3f);
    }
    const float buttons = ImGui::GetFrameHeight() * (narrow ? 2 : 3) + em() * (narrow ? 0.9f : 1.1f);
    ImGui::SetNextItemWidth(std::max(em() * 3, ImGui::GetContentRegionAvail().x - buttons));
    std::string name = lens.name;
    if (ImGui::InputText("##name", &name) && !name.empty()) renameLens(session, index, name);
    ImGui::SameLine(0, em() * 0.3f);
    const auto up = [&] {
        if (iconButton(context, "up", {"\uf062", "up"}, "Move below the lens above it", index > 0))
            action = RowAction::Up;
    };
    if (!narrow) {
        up();
        ImGui::SameLine(0, em() * 0.2f);
    }
    if (iconButton(context, "invert", icons::kInvert, "Act outside instead of inside", true, lens.inverted))
        lens.inverted = !lens.inverted;
    ImGui::SameLine(0, em() * 0.2f);
    if (iconButton(context, "delete", icons::kTrash, "Remove this lens; its layers are no longer drawn"))
        action = RowAction::Remove;
    ImGui::Indent(em() * 1.6f);
    if (narrow) {
        chooseEffect(lens);
        ImGui::SameLine(0, em() * 0.3f);
        up();
    }
    const std::string inside = layersOf(session, lens.name);
    const std::string text = std::string(vis::kLensShapeNames[static_cast<std::size_t>(lens.shape)]) +
                             (inside.empty() ? "" : "  with " + inside) +
                             (lens.enabled && !vis::activeAt(lens, session.time) ? ", not at this time" : "");
    if (fittedTreeNode(text, "lens", unfold)) {
        const WidgetContext widgets{.info = &context.source->info()};
        vis::Lens edited = lens;
        drawDescribed(edited, widgets);
        if (edited.name != lens.name) {
            renameLens(session, index, edited.name);
            edited.name = lens.name;
        }
        lens = edited;
        if (lens.inSpace()) {
            if (ImGui::SmallButton("To the cross-hair")) lens.center = session.cursor;
            ImGui::SameLine();
        } else if (!session.selection.active()) {
            faintText("No brush is in use: everything is inside.");
        }
        if (ImGui::SmallButton("Callout") && takesCallout(session))
            addCallout(session, context.source->info(), CalloutOf::Lens, lens.name);
        if (ImGui::IsItemHovered()) tooltip("Show its inside enlarged beside the volume");
        drawStatistics(context, pane, statistics, lens);
        ImGui::TreePop();
    }
    ImGui::Unindent(em() * 1.6f);
    return action;
}

} // namespace

vis::Lens newLens(const Session& session, const volume::DatasetInfo& info, vis::LensEffect effect) {
    const glm::dvec3 half = vis::worldFrame(info, session.stretch).halfSize;
    const double middle = half.x + half.y + half.z - std::max({half.x, half.y, half.z}) -
                          std::min({half.x, half.y, half.z}); // the second largest
    vis::Lens lens;
    lens.name = freeName(session, "lens", session.lenses.size());
    lens.effect = effect;
    lens.center = session.cursor;
    lens.size = glm::vec3(static_cast<float>(std::clamp(0.8 * middle, 0.05, 0.3)));
    lens.color = kColors[session.lenses.size() % std::size(kColors)];
    return lens;
}

void addLens(Session& session, const volume::DatasetInfo& info, vis::LensEffect effect) {
    session.lenses.push_back(newLens(session, info, effect));
    if (effect == vis::LensEffect::Magnify) session.lenses.back().shape = vis::LensShape::Disc;
}

void addLensWith(Session& session, const volume::DatasetInfo& info, vis::Technique technique) {
    const vis::Lens lens = newLens(session, info, vis::LensEffect::Replace);
    vis::Layer layer;
    layer.name = vis::shownChannel(technique) + " in " + lens.name;
    layer.technique = std::move(technique);
    layer.lens = lens.name;
    session.lenses.push_back(lens);
    addLayer(session, std::move(layer));
}

void addLensOf(Session& session, const volume::BrickSource& source, const std::string& channel, bool surface) {
    const volume::DatasetInfo& info = source.info();
    const auto found = info.findChannel(channel);
    if (!found) return;
    if (surface) {
        const Range range = info.channelRange(info.channel(*found));
        addLensWith(session, info, vis::IsoLayer{.channel = channel, .value = 0.5 * (range.lo + range.hi)});
    } else {
        addLensWith(session, info, vis::VolumeLayer{.channel = channel});
    }
    aimLayer(session, source, session.layers.back());
}

void renameLens(Session& session, std::size_t index, const std::string& name) {
    const std::string before = session.lenses[index].name, now = freeName(session, name, index);
    session.lenses[index].name = now;
    for (auto* const layers : layerLists(session))
        for (vis::Layer& layer : *layers)
            if (!before.empty() && layer.lens == before) layer.lens = now;
    for (vis::Brush& brush : session.selection.brushes)
        if (auto* region = std::get_if<vis::LensRegion>(&brush.region);
            region && region->lens == before && !before.empty())
            region->lens = now;
    renameCallouts(session, CalloutOf::Lens, before, now);
}

void moveLens(Session& session, std::size_t from, std::size_t to) {
    if (from >= session.lenses.size() || to >= session.lenses.size()) return;
    const vis::Lens moved = session.lenses[from];
    session.lenses.erase(session.lenses.begin() + static_cast<std::ptrdiff_t>(from));
    session.lenses.insert(session.lenses.begin() + static_cast<std::ptrdiff_t>(to), moved);
}

void removeLens(Session& session, std::size_t index) {
    const std::string name = session.lenses[index].name;
    session.lenses.erase(session.lenses.begin() + static_cast<std::ptrdiff_t>(index));
    for (auto* const layers : layerLists(session))
        for (vis::Layer& layer : *layers)
            if (layer.lens == name) {
                layer.lens.clear();
                layer.visible = false;
            }
    std::erase_if(session.selection.brushes, [&](const vis::Brush& brush) {
        const auto* region = std::get_if<vis::LensRegion>(&brush.region);
        return region && region->lens == name && !name.empty();
    });
    removeCallouts(session, CalloutOf::Lens, name);
}

void drawLensMenu(ViewContext& context) {
    Session& session = context.session;
    const volume::DatasetInfo& info = context.source->info();
    const std::size_t before = session.lenses.size();
    for (const bool surface : {false, true})
        if (ImGui::BeginMenu(surface ? "Lens: an iso-surface" : "Lens: another parameter")) {
            for (const int channel : comparedChannels(info))
                if (const std::string name = info.channel(channel).name; ImGui::MenuItem(name.c_str()))
                    addLensOf(session, *context.source, name, surface);
            ImGui::EndMenu();
        }
    static constexpr const char* kItems[] = {"Lens: cut away", "Lens: only this", "Lens: enhance",
                                             "Lens: suppress", "Lens: magnify",   "Lens: brushes inside"};
    for (std::size_t i = 0; i < std::size(kItems); ++i)
        if (ImGui::MenuItem(kItems[i])) addLens(session, info, static_cast<vis::LensEffect>(i));
    if (session.lenses.size() != before) showTask(session, SceneTask::Lenses, int(before));
}

bool chooseLens(const char* id, const Session& session, std::string& value, const char* none) {
    bool changed = false;
    if (!ImGui::BeginCombo(id, value.empty() ? none : ("inside " + value).c_str())) return false;
    const auto offer = [&](const char* text, const std::string& name) {
        if (!ImGui::Selectable(text, value == name)) return;
        changed = value != name;
        value = name;
    };
    offer(none, "");
    for (const vis::Lens& lens : session.lenses) offer(("inside " + lens.name).c_str(), lens.name);
    ImGui::EndCombo();
    return changed;
}

void drawLensList(ViewContext& context, const std::string& pane, LensStatistics& statistics, NextEntry next) {
    Session& session = context.session;
    RowAction action = RowAction::None;
    std::size_t which = 0, from = 0, to = 0;
    for (std::size_t i = 0; i < session.lenses.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        if (i == next.entry && !context.headless) ImGui::SetScrollHereY(0.1f); // pictures show the same
        if (const int dropped = drawGrip(context, session.lenses[i], i); dropped >= 0) {
            from = static_cast<std::size_t>(dropped);
            to = i;
        }
        if (const RowAction own = drawLens(context, pane, statistics, i, next.unfolds(i)); own != RowAction::None) {
            action = own;
            which = i;
        }
        ImGui::PopID();
    }
    if (action == RowAction::Remove) removeLens(session, which);
    if (action == RowAction::Up) std::swap(session.lenses[which], session.lenses[which - 1]);
    if (action == RowAction::None && from != to) moveLens(session, from, to);
    if (session.lenses.empty()) faintText("No lenses: add one at the cross-hair.");
    if (iconButton(context, "add lens", icons::kPlus, "Add a lens at the cross-hair")) ImGui::OpenPopup("add lens");
    if (ImGui::BeginPopup("add lens")) {
        drawLensMenu(context);
        ImGui::EndPopup();
    }
    if (!session.lenses.empty()) {
        ImGui::SameLine(0, em() * 0.8f);
        ImGui::PushTextWrapPos(0);
        ImGui::TextDisabled("Alt+drag moves, Alt+wheel resizes, F follows the mouse");
        ImGui::PopTextWrapPos();
    }
}

} // namespace tessera::app
