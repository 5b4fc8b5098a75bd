#include "app/views/transfer/transfer_controls.h"

#include "app/described/describe_json.h"
#include "app/pane/tool_row.h"
#include "app/pane/view_parts.h"
#include "app/session/own_functions.h"
#include "app/session/shown_scene.h"
#include "app/ui/number_field.h"
#include "app/ui/ticks.h"
#include "app/ui/widgets.h"
#include "app/user_files/colormap_file.h"
#include "app/views/transfer/color_edit.h"
#include "codec/container/json_text.h"
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

/// What is edited.
enum class TransferPage { Library, Curve, Regions, Boundary };
constexpr const char* kTransferPages[] = {"library", "curve", "regions", "boundary"};
constexpr const char* kTransferPageHelp[] = {
    "Transfer functions by name, as pictures of these data", "Opacity from the value, by a curve that you draw",
    "Opacity from value and gradient magnitude, by areas of their plane",
    "Opacity from the distance to a boundary between materials; computes a new curve"};

TransferPage pageOf(const TransferView& view, const vis::TransferFunction& function) {
    if (view.library) return TransferPage::Library;
    if (function.kind == vis::TransferKind::Regions) return TransferPage::Regions;
    return view.boundaries ? TransferPage::Boundary : TransferPage::Curve;
}

void goTo(TransferPage page, const FindingPages& pages, TransferView& view, vis::TransferFunction& function) {
    view.library = page == TransferPage::Library;
    if (view.library) return;
    function.kind = page == TransferPage::Regions ? vis::TransferKind::Regions : vis::TransferKind::Curve;
    view.boundaries = page == TransferPage::Boundary;
    if (page == TransferPage::Regions) pages.regions.fit = function.regions.empty();
    if (page != TransferPage::Boundary) return;
    pages.boundaries.apply = true;
    pages.boundaries.from.reset();
}

bool litButton(const char* name, bool lit) {
    if (lit) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    const bool pressed = ImGui::Button(name);
    if (lit) ImGui::PopStyleColor();
    return pressed;
}

/// Buttons for the pages, or in narrow rows of tools a list of them.
void drawPages(ToolRow& tools, const FindingPages& pages, TransferView& view, vis::TransferFunction& function) {
    const TransferPage now = pageOf(view, function);
    TransferPage chosen = now;
    const auto offer = [&](std::size_t i, const auto& draw) {
        const auto page = static_cast<TransferPage>(i);
        if (draw(kTransferPages[i], page == now)) chosen = page;
        if (ImGui::IsItemHovered()) tooltip(kTransferPageHelp[i]);
    };
    const float width = em() * 5.8f;
    if (!tools.narrow()) {
        for (std::size_t i = 0; i < std::size(kTransferPages); ++i)
            if (tools.next(buttonWidth(kTransferPages[i]))) offer(i, litButton);
    } else if (tools.next(width)) {
        ImGui::SetNextItemWidth(width);
        if (ImGui::BeginCombo("##page", kTransferPages[static_cast<std::size_t>(now)])) {
            for (std::size_t i = 0; i < std::size(kTransferPages); ++i)
                offer(i, [](const char* name, bool lit) { return ImGui::Selectable(name, lit); });
            ImGui::EndCombo();
        }
    }
    if (chosen != now) goTo(chosen, pages, view, function);
}

/// Opens the settings of the selected region.
void drawRegionTool(ViewContext& context, ToolRow& tools, RegionPage& page, vis::TransferFunction& function,
                    const volume::DatasetInfo& info) {
    if (!tools.next(buttonWidth("region"))) return;
    if (ImGui::Button("region")) ImGui::OpenPopup("region");
    if (ImGui::IsItemHovered()) tooltip("Add, remove or change a region: click on one to select it");
    if (!ImGui::BeginPopup("region")) return;
    ImGui::Dummy({em() * 20, 0});
    drawRegionSettings(context, page, function, info);
    ImGui::EndPopup();
}

/// Gradient magnitude at the top of the plane.
void drawGradientTop(ToolRow& tools, vis::TransferFunction& function, RegionPage& page) {
    if (tools.next(buttonWidth("fit"))) {
        if (ImGui::Button("fit")) page.fit = true;
        if (ImGui::IsItemHovered())
            tooltip("Make the plane as high as the gradients of the data; regions stay in place");
    }
    const float width = std::min(em() * 9, tools.room() - em() * 2);
    if (!tools.next(width + em() * 2)) return;
    ImGui::SetNextItemWidth(width);
    slider("top", function.gradientTop, 1e-3f, 2, "%.3g ranges/cell", ImGuiSliderFlags_Logarithmic);
    if (ImGui::IsItemHovered())
        tooltip("Gradient magnitude at the top of the plane: change per cell, as a multiple of the value range");
}

/// Curves to begin with, and what is shown behind the curve.
void drawCurveControls(ToolRow& tools, TransferView& view, vis::TransferFunction& function) {
    const float square = ImGui::GetFrameHeight();
    for (std::size_t i = 0; i < std::size(kOpacityPresetNames); ++i) {
        const auto preset = static_cast<OpacityPreset>(i);
        if (tools.next(square * 1.25f) && presetButton(preset)) function.opacity = opacityPreset(preset);
    }
    const auto check = [&](const char* name, bool& on, const char* help) {
        if (!tools.next(checkboxWidth(name))) return;
        ImGui::Checkbox(name, &on);
        if (ImGui::IsItemHovered()) tooltip(help);
    };
    check("log", view.logHistogram, "Logarithmic number of samples");
    check("visible", view.visibility, "Show which values contribute how much to the visible 3D picture");
}

/// A choice among a parameter's function and those that layers and faces have of their own.
void chooseFunction(Session& session, TransferView& view, const std::string& channel) {
    const std::string now = functionName(session, view, channel), shared = "shared by " + channel;
    const bool own = now != channel;
    if (!ImGui::BeginCombo("##function", own ? now.c_str() : shared.c_str())) return;
    if (ImGui::Selectable(shared.c_str(), !own)) view.channel = channel;
    for (const OwnFunction& each : ownFunctions(session))
        if (ImGui::Selectable(each.name.c_str(), own && each.name == now)) view.channel = each.name;
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
            return jsonText({{"colors", toJson(colors)}}, 2) + "\n";
        });
    ImGui::EndPopup();
}

/// The colour map in a list of this width, which way round it runs, and colours of one's own.
void drawColorTools(ViewContext& context, vis::TransferFunction& function, const std::string& name, float width) {
    ImGui::SetNextItemWidth(width);
    if (chooseColormap("##colormap", function.colormap, function.reversed)) function.colors.clear();
    if (ImGui::IsItemHovered())
        tooltip(
            (function.colormap + ": colour map; type to search, perceptually uniform ones are listed first").c_str());
    ImGui::SameLine();
    if (iconButton(context, "reverse", icons::kReverse, "Reverse the colour map", true, function.reversed)) {
        if (function.colors.empty())
            function.reversed = !function.reversed;
        else
            reverseColors(function.colors);
    }
    ImGui::SameLine(0, em() * 0.2f);
    drawOwnColors(context, function, name);
}

} // namespace

std::string functionName(Session& session, const TransferView& view, const std::string& channel) {
    const ShownScene scene(session, volumePane(session)); // has the layer selected
    const std::string shown = shownFunction(session, view);
    return ownFunction(session, shown) ? shown : channel;
}

void drawTransferControls(ViewContext& context, TransferView& view, const FindingPages& pages,
                          const volume::DatasetInfo& info, std::string channel) {
    ToolRow tools(context);
    const float gap = ImGui::GetStyle().ItemSpacing.x, reverse = ImGui::GetFrameHeight() + em() * 0.4f;
    const float combo = std::min(em() * 11, (tools.room() - 2 * reverse - 3 * gap) / 2);
    if (tools.next(combo)) {
        ImGui::SetNextItemWidth(combo);
        if (chooseChannel("##channel", &info, channel)) view.channel = channel;
        if (ImGui::IsItemHovered()) tooltip("Parameter whose colours and opacity are edited");
    }
    if (!ownFunctions(context.session).empty() && tools.next(combo)) {
        ImGui::SetNextItemWidth(combo);
        chooseFunction(context.session, view, channel);
        if (ImGui::IsItemHovered())
            tooltip("Transfer function of the parameter, or of a layer or face that has its own");
    }
    const std::string name = functionName(context.session, view, channel);
    vis::TransferFunction& function = transferOf(context.session, name);
    if (tools.narrow()) drawPages(tools, pages, view, function);
    const float beside = tools.widest() - 2 * reverse - gap;
    const float map = tools.narrow() ? std::clamp(beside, em() * 5, em() * 9) : combo;
    if (tools.next(map + gap + 2 * reverse)) drawColorTools(context, function, name, map);
    const float ends = std::min(em() * 16, tools.narrow() ? tools.widest() : tools.room());
    if (tools.next(ends))
        drawRange(function, info.channelRange(info.channel(*info.findChannel(channel))),
                  tools.inMenu() ? em() * 16 : ends);
    if (!tools.narrow()) drawPages(tools, pages, view, function);
    const TransferPage page = pageOf(view, function);
    if (page == TransferPage::Regions) {
        if (!regionSettingsBeside(tools.room())) drawRegionTool(context, tools, pages.regions, function, info);
        drawGradientTop(tools, function, pages.regions);
    }
    if (page == TransferPage::Curve) drawCurveControls(tools, view, function);
}

} // namespace tessera::app
