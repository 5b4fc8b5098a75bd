#include "app/views/transfer/transfer_controls.h"

#include "app/described/describe_json.h"
#include "app/pane/view_parts.h"
#include "app/session/shown_scene.h"
#include "app/ui/ticks.h"
#include "app/ui/widgets.h"
#include "app/user_files/colormap_file.h"
#include "app/views/transfer/color_edit.h"
#include "vis/transfer/simplify_colors.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr double kImportedAlike = 0.004; ///< of a colour, 0..1: one step of 8 bits

/// A button with a small picture of the curve it sets.
bool presetButton(OpacityPreset preset) {
    const float size = ImGui::GetFrameHeight();
    const std::string name(kOpacityPresetNames[static_cast<std::size_t>(preset)]);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool pressed = ImGui::Button(("##" + name).c_str(), {size * 1.25f, size});
    const float pad = size * 0.24f;
    std::vector<ImVec2> line;
    for (glm::vec2 point : opacityPreset(preset))
        line.push_back(
            {at.x + pad + point.x * (size * 1.25f - 2 * pad), at.y + size - pad - point.y * (size - 2 * pad)});
    ImGui::GetWindowDrawList()->AddPolyline(line.data(), static_cast<int>(line.size()),
                                            ImGui::GetColorU32(ImGuiCol_Text), 0, std::max(1.2f, em() * 0.1f));
    if (ImGui::IsItemHovered()) tooltip(("Opacity curve: " + name).c_str());
    return pressed;
}

/// The typed ends of the range; greyed while the range follows the data.
void drawRange(vis::TransferFunction& function, Range data, float width) {
    const Range range = vis::effectiveRange(function, data);
    bool fixed = !function.autoRange;
    if (ImGui::Checkbox("range", &fixed)) {
        function.autoRange = !fixed;
        function.range = range;
    }
    if (ImGui::IsItemHovered()) tooltip("Set the values at the ends of the colour map; off: the range of the data");
    ImGui::SameLine();
    ImGui::BeginDisabled(function.autoRange);
    double ends[2] = {range.lo, range.hi};
    ImGui::SetNextItemWidth(std::max(em() * 6, width - ImGui::GetFrameHeight() - em() * 4));
    const double step = (data.hi - data.lo) / 1000;
    const int decimals = step > 0 ? std::clamp(static_cast<int>(std::ceil(-std::log10(step))), 0, 9) : 3;
    const std::string format = std::abs(data.hi) < 1e7 && decimals < 9 ? "%." + std::to_string(decimals) + "f" : "%.5g";
    if (ImGui::DragScalarN("##ends", ImGuiDataType_Double, ends, 2, static_cast<float>(step), nullptr, nullptr,
                           format.c_str()) &&
        ends[0] < ends[1])
        function.range = {ends[0], ends[1]};
    ImGui::EndDisabled();
}

/// What is edited: the curve over values, regions, or the emphasis of boundaries that makes the curve; or the library.
void drawPages(const FindingPages& pages, TransferView& view, vis::TransferFunction& function) {
    const auto page = [&](const char* name, bool chosen, const char* help) {
        continueLine(buttonWidth(name));
        if (chosen) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
        const bool pressed = ImGui::Button(name);
        if (chosen) ImGui::PopStyleColor();
        if (ImGui::IsItemHovered()) tooltip(help);
        return pressed && !chosen;
    };
    const auto choose = [&](vis::TransferKind kind, bool boundary) {
        function.kind = kind;
        view.boundaries = boundary;
        view.library = false;
    };
    const bool curve = function.kind == vis::TransferKind::Curve, editor = !view.library;
    if (page("library", view.library, "Transfer functions by name, as pictures of these data")) view.library = true;
    if (page("curve", editor && curve && !view.boundaries, "Opacity from the value, by a curve that you draw"))
        choose(vis::TransferKind::Curve, false);
    if (page("regions", editor && !curve, "Opacity from value and gradient magnitude, by areas of their plane")) {
        choose(vis::TransferKind::Regions, false);
        pages.regions.fit = function.regions.empty();
    }
    if (page("boundary", editor && curve && view.boundaries,
             "Opacity from the distance to a boundary between materials; computes a new curve")) {
        choose(vis::TransferKind::Curve, true);
        pages.boundaries.apply = true;
        pages.boundaries.from.reset();
    }
}

/// Gradient magnitude at the top of the plane.
void drawGradientTop(vis::TransferFunction& function, RegionPage& page) {
    continueLine(buttonWidth("fit"));
    if (ImGui::Button("fit")) page.fit = true;
    if (ImGui::IsItemHovered()) tooltip("Make the plane as high as the gradients of the data; regions stay in place");
    const float width = std::min(em() * 9, ImGui::GetContentRegionAvail().x - em() * 2);
    continueLine(width + em() * 2);
    ImGui::SetNextItemWidth(width);
    ImGui::SliderFloat("top", &function.gradientTop, 1e-3f, 2, "%.3g ranges/cell",
                       ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    if (ImGui::IsItemHovered())
        tooltip("Gradient magnitude at the top of the plane: change per cell, as a multiple of the value range");
}

/// Curves to begin with, and what is shown behind the curve.
void drawCurveControls(TransferView& view, vis::TransferFunction& function) {
    const float square = ImGui::GetFrameHeight();
    for (std::size_t i = 0; i < std::size(kOpacityPresetNames); ++i) {
        continueLine(square * 1.25f);
        const auto preset = static_cast<OpacityPreset>(i);
        if (presetButton(preset)) function.opacity = opacityPreset(preset);
    }
    const auto check = [&](const char* name, bool& on, const char* help) {
        continueLine(square + ImGui::GetStyle().ItemInnerSpacing.x + ImGui::CalcTextSize(name).x);
        ImGui::Checkbox(name, &on);
        if (ImGui::IsItemHovered()) tooltip(help);
    };
    check("log", view.logHistogram, "Logarithmic number of samples");
    check("visible", view.visibility, "Show which values contribute how much to the visible 3D picture");
}

/// Functions that layers have of their own, in the order of the layers.
std::vector<std::string> ownFunctions(const Session& session) {
    std::vector<std::string> names;
    for (const auto* layers : layerLists(session))
        for (const vis::Layer& layer : *layers)
            if (!layer.transfer.empty() && std::ranges::find(names, layer.transfer) == names.end())
                names.push_back(layer.transfer);
    return names;
}

/// A choice among a parameter's own function and those of layers.
void chooseFunction(const Session& session, TransferView& view, const std::string& channel) {
    const std::string shown = layerOfFunction(session, view.channel) ? view.channel : "all layers";
    if (!ImGui::BeginCombo("##function", shown.c_str())) return;
    if (ImGui::Selectable("all layers", shown == "all layers")) view.channel = channel;
    for (const std::string& name : ownFunctions(session))
        if (ImGui::Selectable(name.c_str(), name == view.channel)) view.channel = name;
    ImGui::EndCombo();
}

/// Colours of one's own: from the map in use, from a file, into one.
void drawOwnColors(ViewContext& context, vis::TransferFunction& function, const std::string& channel) {
    const bool own = !function.colors.empty();
    if (iconButton(context, "custom colours", icons::kColors, "Custom colours", true, own))
        ImGui::OpenPopup("custom colours");
    if (!ImGui::BeginPopup("custom colours")) return;
    if (ImGui::MenuItem("0 in the middle", nullptr, function.autoRange && function.aboutZero, function.autoRange))
        function.aboutZero = !function.aboutZero;
    if (ImGui::MenuItem("Edit", nullptr, own)) {
        std::vector<vis::ColorStop> colors;
        if (!own) {
            colors = ownColors(function);
            function.reversed = false; // they run as the map did
        }
        function.colors = std::move(colors);
    }
    if (ImGui::MenuItem("Import...", nullptr, false, bool(context.askFile)))
        context.askFile("Import colours", [channel](Session& session, const std::string& path) {
            vis::TransferFunction& changed = transferOf(session, channel);
            // Files of other programs hold hundreds of samples, which nobody could edit.
            changed.colors = vis::simplified(readColormap(path), kImportedAlike);
            changed.reversed = false;
        });
    if (ImGui::MenuItem("Export...", nullptr, false, own && context.exportText))
        context.exportText(channel + "-colors.json", [colors = function.colors](const Progress&) {
            return Json{{"colors", toJson(colors)}}.dump(2) + "\n";
        });
    ImGui::EndPopup();
}

} // namespace

const vis::Layer* layerOfFunction(const Session& session, const std::string& name) {
    if (name.empty()) return nullptr;
    for (const auto* layers : layerLists(session))
        for (const vis::Layer& layer : *layers)
            if (layer.transfer == name) return &layer;
    return nullptr;
}

std::string functionName(const Session& session, const TransferView& view, const std::string& channel) {
    return layerOfFunction(session, view.channel) ? view.channel : channel;
}

void drawTransferControls(ViewContext& context, TransferView& view, const FindingPages& pages,
                          const volume::DatasetInfo& info, std::string channel) {
    const float room = ImGui::GetContentRegionAvail().x, gap = ImGui::GetStyle().ItemSpacing.x;
    const float reverse = ImGui::GetFrameHeight() + em() * 0.4f;
    const float combo = std::min(em() * 11, (room - 2 * reverse - 3 * gap) / 2);
    ImGui::SetNextItemWidth(combo);
    if (chooseChannel("##channel", &info, channel)) view.channel = channel;
    if (ImGui::IsItemHovered()) tooltip("Parameter whose colours and opacity are edited");
    const bool choice = !ownFunctions(context.session).empty();
    if (choice) {
        ImGui::SameLine();
        ImGui::SetNextItemWidth(combo);
        chooseFunction(context.session, view, channel);
        if (ImGui::IsItemHovered()) tooltip("Transfer function of all layers, or of one layer that has its own");
    }
    vis::TransferFunction& function = transferOf(context.session, functionName(context.session, view, channel));
    if (choice && room < em() * 34) ImGui::NewLine();
    ImGui::SameLine();
    ImGui::SetNextItemWidth(combo);
    if (chooseColormap("##colormap", function.colormap, function.reversed)) function.colors.clear();
    if (ImGui::IsItemHovered()) tooltip("Colour map; type to search, perceptually uniform ones are listed first");
    ImGui::SameLine();
    if (iconButton(context, "reverse", icons::kReverse, "Reverse the colour map", true, function.reversed)) {
        if (function.colors.empty())
            function.reversed = !function.reversed;
        else
            reverseColors(function.colors);
    }
    ImGui::SameLine(0, em() * 0.2f);
    drawOwnColors(context, function, functionName(context.session, view, channel));

    const Range data = info.channelRange(info.channel(*info.findChannel(channel)));
    const float ends = std::min(em() * 16, room);
    continueLine(ends);
    drawRange(function, data, ends);
    drawPages(pages, view, function);
    if (view.library) return;
    if (function.kind == vis::TransferKind::Regions) {
        drawGradientTop(function, pages.regions);
        return;
    }
    if (view.boundaries) return;
    drawCurveControls(view, function);
}

} // namespace tessera::app
