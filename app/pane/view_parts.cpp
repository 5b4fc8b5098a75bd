#include "app/pane/view_parts.h"

#include "app/pane/axes3d.h"
#include "app/pane/plot.h"
#include "app/session/shown_scene.h"
#include "app/ui/fitted_text.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "app/ui/widgets.h"
#include "vis/glyphs/glyph_parts.h"
#include "volume/flow/flow_channels.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <set>

namespace tessera::app {

void drawHint(const char* title, const char* hint) {
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const ImVec2 start = ImGui::GetCursorPos();
    const float wrap = std::max(1.0f, std::min(room.x - em(), em() * 26));
    const ImVec2 a = ImGui::CalcTextSize(title, nullptr, false, wrap),
                 b = ImGui::CalcTextSize(hint, nullptr, false, wrap);
    float y = start.y + std::max(0.0f, (room.y - a.y - b.y - em() * 0.5f) / 2);
    const auto line = [&](const char* text, ImVec2 size, ImGuiCol color) {
        ImGui::SetCursorPos({start.x + std::max(0.0f, (room.x - size.x) / 2), y});
        ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + size.x + 1);
        ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(color));
        ImGui::TextUnformatted(text);
        ImGui::PopStyleColor();
        ImGui::PopTextWrapPos();
        y += size.y + em() * 0.5f;
    };
    line(title, a, ImGuiCol_Text);
    if (*hint) line(hint, b, ImGuiCol_TextDisabled);
}

std::string originText(const ViewContext& context, const std::vector<int>& channels) {
    return originText(context.origin, context.numbers->info(), channels);
}

void drawOrigin(const ViewContext& context, ToolRow& tools, const std::vector<int>& channels, bool atOneTime) {
    drawOriginText(context, tools, originText(context, channels), atOneTime);
}

void drawOriginText(const ViewContext& context, ToolRow& tools, std::string text, bool atOneTime) {
    const volume::DatasetInfo& info = context.numbers->info();
    const auto ownTime = [](const auto& each) {
        const auto* volume = std::get_if<VolumeView>(&each.second);
        return volume && volume->time;
    };
    if (atOneTime && info.times.size() > 1 && std::ranges::any_of(context.session.views, ownTime))
        text += ", at " + timeText(info, context.session.time);
    const float whole = ImGui::CalcTextSize(text.c_str()).x, least = std::min(whole, em() * 12);
    if (!tools.next(least)) return;
    const std::string fitted = fitText(text, tools.grow(least, whole));
    ImGui::TextDisabled("%s", fitted.c_str());
    if (ImGui::IsItemHovered()) tooltip(("Numbers: " + text).c_str());
}

void drawNote(ToolRow& tools, const std::string& text) {
    const float width = ImGui::CalcTextSize(text.c_str()).x;
    if (tools.narrow() && !tools.fits(width)) return;
    if (tools.next(width)) ImGui::TextDisabled("%s", text.c_str());
}

bool narrowRows() {
    return ImGui::GetContentRegionAvail().x < em() * 14;
}

float heightAtLeast(float least) {
    const float left = ImGui::GetContentRegionAvail().y;
    if (left >= least) return left;
    const ImVec2 at = ImGui::GetCursorPos();
    ImGui::Dummy({1, least}); // what is drawn there without items takes part in the height of the content
    ImGui::SetCursorPos(at);
    return least;
}

void tableHeader(std::initializer_list<const char*> names, int right) {
    tableHeader(std::vector<std::string>(names.begin(), names.end()), right);
}

void tableHeader(const std::vector<std::string>& names, int right) {
    ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
    int column = 0;
    for (const std::string& each : names) {
        const char* const name = each.c_str();
        ImGui::TableSetColumnIndex(column);
        if (column >= right) {
            const float room = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(name).x;
            if (room > 0) ImGui::SetCursorPosX(ImGui::GetCursorPosX() + room);
        }
        ImGui::PushID(column++);
        ImGui::TableHeader(name);
        ImGui::PopID();
    }
}

bool linkRight(const std::string& id, const std::string& text, const std::string& tip, bool faint) {
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const float room = ImGui::GetContentRegionAvail().x - size.x;
    if (room > 0) ImGui::SetCursorPosX(ImGui::GetCursorPosX() + room);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool clicked = mouseArea(id.c_str(), size);
    const ImU32 color = ImGui::GetColorU32(faint ? ImGuiCol_TextDisabled : ImGuiCol_Text);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddText(at, color, text.c_str());
    if (ImGui::IsItemHovered()) {
        draw.AddLine({at.x, at.y + size.y}, {at.x + size.x, at.y + size.y}, color);
        ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
        tooltip(tip.c_str());
    }
    return clicked;
}

void textRight(const std::string& text, bool faint) {
    const float room = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(text.c_str()).x;
    if (room > 0) ImGui::SetCursorPosX(ImGui::GetCursorPosX() + room);
    if (faint)
        ImGui::TextDisabled("%s", text.c_str());
    else
        ImGui::TextUnformatted(text.c_str());
}

std::vector<int> comparedChannels(const volume::DatasetInfo& info) {
    std::vector<int> out;
    const std::vector<volume::Channel> channels = info.channels();
    for (std::size_t i = 0; i < channels.size(); ++i) {
        const volume::Parameter& parameter = info.parameters[static_cast<std::size_t>(channels[i].parameter)];
        if (parameter.categorical) continue;
        if (parameter.components == 1 || channels[i].magnitude) out.push_back(static_cast<int>(i));
    }
    return out;
}

std::vector<int> chosenChannels(const volume::DatasetInfo& info, const std::vector<std::string>& names,
                                std::size_t most) {
    std::vector<int> out;
    for (const std::string& name : names)
        if (const auto channel = info.findChannel(name))
            if (std::find(out.begin(), out.end(), *channel) == out.end()) out.push_back(*channel);
    if (!out.empty()) return out;
    out = comparedChannels(info);
    if (out.size() > most) out.resize(most);
    return out;
}

void chooseChannels(ToolRow& tools, const volume::DatasetInfo& info, std::vector<std::string>& names,
                    const std::vector<int>& shown) {
    if (!tools.next(em() * 7.8f)) return;
    const std::size_t all = comparedChannels(info).size();
    // More than are shown where the user has not chosen: says so.
    const bool cut = names.empty() && shown.size() < all;
    const std::string label = cut ? std::to_string(shown.size()) + " of " + std::to_string(all) + " shown"
                                  : std::to_string(shown.size()) + (shown.size() == 1 ? " parameter" : " parameters");
    ImGui::SetNextItemWidth(em() * 7.8f);
    if (ImGui::BeginCombo("##channels", label.c_str(), ImGuiComboFlags_HeightLarge)) {
        const std::vector<volume::Channel> channels = info.channels();
        for (std::size_t i = 0; i < channels.size(); ++i) {
            if (info.parameters[static_cast<std::size_t>(channels[i].parameter)].categorical) continue;
            bool on = std::find(shown.begin(), shown.end(), static_cast<int>(i)) != shown.end();
            if (!ImGui::Checkbox(titleWithUnit(channels[i].name, channels[i].unit).c_str(), &on)) continue;
            std::vector<std::string> chosen;
            for (std::size_t k = 0; k < channels.size(); ++k) {
                const bool was = std::find(shown.begin(), shown.end(), static_cast<int>(k)) != shown.end();
                if (k == i ? on : was) chosen.push_back(channels[k].name);
            }
            if (!chosen.empty()) names = chosen;
        }
        ImGui::Separator();
        if (ImGui::Selectable("All scalars and magnitudes")) names.clear();
        ImGui::EndCombo();
    }
    if (ImGui::IsItemHovered()) tooltip("Parameters shown");
}

std::string otherTimeText(const vis::Layer& layer, const volume::DatasetInfo& info, double shown) {
    if (layer.timeShift == 0 || info.times.size() < 2) return {};
    const double time = std::clamp(shown + layer.timeShift, info.times.front(), info.times.back());
    return " at " + stateNames(info, {time}).front();
}

std::string layerTitle(const vis::Layer& layer, const volume::DatasetInfo& info) {
    std::string name = layerName(layer);
    const auto* surface = std::get_if<vis::IsoLayer>(&layer.technique);
    const auto channel = surface && layer.name.empty() ? info.findChannel(surface->channel) : std::nullopt;
    if (!channel) return name;
    const volume::Parameter& parameter = info.parameters[std::size_t(info.channel(*channel).parameter)];
    if (parameter.categorical) return volume::labelName(parameter, int(std::lround(surface->value))) + " surface";
    char rounded[32]; // four digits without zeros at the end
    std::snprintf(rounded, sizeof rounded, "%.4g", surface->value);
    return name + " " + formatQuantity(std::strtod(rounded, nullptr), info.channel(*channel).unit);
}

std::optional<int> resolveChannel(const volume::DatasetInfo& info, const Session& session, const std::string& wanted) {
    if (const auto found = info.findChannel(wanted); found && !wanted.empty()) return found;
    for (const vis::Layer& layer : session.layers) {
        const std::string& name = vis::shownChannel(layer.technique);
        if (const auto found = info.findChannel(name)) return found;
    }
    const std::vector<int> compared = comparedChannels(info);
    if (!compared.empty()) return compared.front();
    return info.channels().empty() ? std::nullopt : std::optional<int>(0);
}

const vis::TransferFunction& transferOf(const Session& session, const std::string& channel) {
    static const vis::TransferFunction fallback;
    const auto found = session.transfer.find(channel);
    return found == session.transfer.end() ? fallback : found->second;
}

vis::TransferFunction& transferOf(Session& session, const std::string& channel) {
    return session.transfer[channel];
}

LegendEntry legendOf(const Session& session, const volume::DatasetInfo& info, int channel,
                     const std::string& function) {
    const volume::Channel c = info.channel(channel);
    LegendEntry entry;
    entry.title = c.name;
    entry.unit = c.unit;
    entry.function = transferOf(session, function.empty() ? c.name : function);
    entry.data = info.channelRange(c);
    entry.range = vis::effectiveRange(entry.function, entry.data);
    const volume::Parameter& parameter = info.parameters[static_cast<std::size_t>(c.parameter)];
    if (parameter.categorical)
        for (const volume::Label& label : parameter.labels)
            entry.names.push_back({label.name, glm::vec3(vis::evaluate(entry.function, entry.range, label.value))});
    return entry;
}

void measureShare(LegendEntry& entry) {
    entry.unit = "%";
    entry.range = entry.data = {0, 100};
    entry.names.clear();
}

namespace {

/// The legend of a volume layer with the colours of its own parameter.
LegendEntry legendOfVolume(const vis::VolumeLayer& volume, const volume::DatasetInfo& info, LegendEntry entry) {
    // Along rays lengths are those of the picture.
    const std::string drawn = info.lattice.isEven() ? "" : " over the drawing";
    if (volume.style == vis::RayStyle::XRay) {
        entry.title = "absorption by " + entry.title + drawn;
        measureShare(entry);
    } else if (volume.quantity == vis::Quantity::Gradient) {
        const double top = double(entry.function.gradientTop) * (entry.range.hi - entry.range.lo);
        entry.title = "change of " + entry.title + " over a cell";
        entry.range = {0, top};
        entry.data = {0, entry.data.hi - entry.data.lo}; // what changes more has the last colour: an arrow head
        entry.names.clear();
    } else {
        entry.regions = volume.style == vis::RayStyle::Composite && entry.function.kind == vis::TransferKind::Regions;
        if (volume.style == vis::RayStyle::Average && !drawn.empty()) entry.title = "mean " + entry.title + drawn;
    }
    return entry;
}

/// The glyph with its parts, and the colours of what has none of its own.
void addGlyphLegends(const Session& session, const volume::DatasetInfo& info, const vis::Layer& layer,
                     const vis::GlyphLayer& glyphs, std::set<std::string>& seen, std::vector<LegendEntry>& entries) {
    GlyphLegend parts = glyphLegendOf(glyphs, info);
    if (!parts.parts.empty()) {
        LegendEntry entry;
        entry.title = layer.name.empty() ? glyphKindTitle(glyphs.kind) : layer.name;
        entry.glyph = std::move(parts);
        entries.push_back(std::move(entry));
    }
    const auto color = info.findChannel(vis::glyphColorChannel(glyphs));
    if (!color || !vis::glyphShowsColor(glyphs)) return;
    LegendEntry colors = legendOf(session, info, *color, layer.transfer);
    if (seen.insert(layer.transfer.empty() ? colors.title : layer.transfer).second)
        entries.push_back(std::move(colors));
}

} // namespace

std::optional<FigureLegends> figureLegends(const ViewContext& context) {
    if (context.takesInput()) return std::nullopt;
    return context.session.appearance.legends;
}

std::vector<LegendEntry> sceneLegends(const Session& session, const volume::DatasetInfo& info, bool drawings) {
    std::vector<LegendEntry> entries;
    std::set<std::string> seen;
    for (const vis::Layer& layer : session.layers) {
        if (!layer.visible || (!drawings && isDrawing(layer.technique))) continue;
        const std::string& name = vis::shownChannel(layer.technique);
        const auto channel = info.findChannel(name);
        if (!channel) continue;
        if (const auto* glyphs = std::get_if<vis::GlyphLayer>(&layer.technique)) {
            addGlyphLegends(session, info, layer, *glyphs, seen, entries);
            continue;
        }
        LegendEntry entry = legendOf(session, info, *channel, layer.transfer);
        const std::string otherTime = otherTimeText(layer, info, session.time);
        const std::string& colorBy = vis::colorByOf(layer.technique);
        const auto color = colorBy.empty() ? std::nullopt : info.findChannel(colorBy);
        const auto* iso = std::get_if<vis::IsoLayer>(&layer.technique);
        if (iso) {
            entry.swatch = true;
            entry.color = {iso->color.r, iso->color.g, iso->color.b};
            if (color) entry.color = {0.5, 0.5, 0.5};
            entry.value = iso->value;
            entry.title += otherTime;
            entries.push_back(entry);
        } else if (color) {
            const auto* volume = std::get_if<vis::VolumeLayer>(&layer.technique);
            if (volume && volume->style != vis::RayStyle::XRay) entry = legendOfVolume(*volume, info, std::move(entry));
            entry.regions = false;
            entry.opacity = true;
            entry.title = "opacity by " + entry.title + otherTime;
            entry.names.clear();
            if (seen.insert(entry.title + " " + layer.transfer).second) entries.push_back(entry);
        } else {
            const std::string function = layer.transfer.empty() ? name : layer.transfer;
            if (const auto* volume = std::get_if<vis::VolumeLayer>(&layer.technique))
                entry = legendOfVolume(*volume, info, std::move(entry));
            entry.title += otherTime;
            const bool ofValues = entry.title == info.channel(*channel).name;
            if (seen.insert(ofValues ? function : entry.title + " " + function).second) entries.push_back(entry);
        }
        // A surface's own function is that of its colours.
        const std::string function = iso && !layer.transfer.empty() ? layer.transfer : colorBy;
        if (!color || !seen.insert(function + otherTime).second) continue;
        entries.push_back(legendOf(session, info, *color, iso ? layer.transfer : std::string()));
        entries.back().title += otherTime;
    }
    return entries;
}

vis::Scene sceneWithLimits(const ViewContext& context) {
    vis::Scene scene = sceneOf(context.session);
    scene.showBox = scene.showBox && context.decoration.box && !onlyDrawings(context.session);
    if (context.whiteGround) {
        scene.background = glm::vec3(1);
        if (vis::paperOf(scene)) scene.paper = vis::Paper{.color = glm::vec3(1), .tooth = 0};
    }
    for (int* limit : {&scene.render.limits.textureMemory, &scene.render.limits.brickMemory})
        *limit = std::max(1, *limit / std::max(1, context.renderers));
    return scene;
}

ImTextureID textureId(vis::TextureName name) {
    return (ImTextureID)name; // NOLINT(performance-no-int-to-ptr): ImGui only hands it back
}

void addPicture(ImDrawList& draw, vis::TextureName texture, ImVec2 min, ImVec2 max) {
    draw.AddImage(textureId(texture), min, max, {0, 1}, {1, 0});
}

void drawStretch(const ViewContext& context) {
    const volume::AxisMaps& axes = context.source->info().lattice.axes;
    const std::string whole = stretchText(context.session.stretch, axes), uneven = stretchText(glm::dvec3(1), axes);
    if (whole.empty()) return;
    if (ImGui::GetCursorPosY() > ImGui::GetCursorStartPos().y) ImGui::SameLine();
    const float room = ImGui::GetContentRegionAvail().x - em();
    std::string text =
        firstThatFits({whole, whole.substr(whole.find(' ') + 1), uneven, uneven.empty() ? "" : "by cells", ""}, room);
    const bool beside = !text.empty();
    if (!beside) text = uneven.empty() ? "" : "by cells";
    const float width = ImGui::CalcTextSize(text.c_str()).x;
    if (beside)
        ImGui::SameLine(ImGui::GetContentRegionMax().x - width);
    else
        ImGui::NewLine();
    if (text.empty()) return;
    if (!beside) ImGui::SetCursorPosX(std::max(ImGui::GetContentRegionMax().x - width, ImGui::GetCursorPosX()));
    ImGui::AlignTextToFramePadding();
    if (context.decoration.title)
        ImGui::TextDisabled("%s", text.c_str());
    else
        ImGui::Dummy({width, em()});
}

} // namespace tessera::app
