#include "app/views/data/task_settings.h"

#include "app/data/sources.h"

#include "app/edits/context_style.h"
#include "app/pane/view_parts.h"
#include "app/session/shown_scene.h"
#include "app/ui/parameter_widget.h"

#include <imgui.h>
#include <optional>

namespace tessera::app {

namespace {

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
                          .doc = "Factor by which each axis is stretched; 1 = true proportions",
                          .range = Range{0.01, 1000},
                          .logScale = true};
    if (drawNumber(widgets, field, {}, stretch, 3, false)) session.stretch = {stretch[0], stretch[1], stretch[2]};
    if (ImGui::SmallButton("True proportions")) session.stretch = glm::dvec3(1);
}

void drawPaper(Session& session, const WidgetContext& widgets) {
    bool paper = session.paper.has_value();
    if (drawBool(widgets, {"paper", "Draw on paper with the settings below"}, paper)) {
        const std::optional<vis::Paper> shown = vis::paperOf(sceneOf(session));
        session.paper = paper ? std::optional(shown.value_or(vis::Paper{})) : std::nullopt;
    }
    if (session.paper) drawDescribed(*session.paper, widgets.at("/paper"));
}

} // namespace

void drawContextSettings(ViewContext& context, const WidgetContext& widgets, const std::string& layersPath) {
    Session& session = context.session;
    if (!ImGui::CollapsingHeader("What is not brushed", ImGuiTreeNodeFlags_DefaultOpen)) return;
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

void drawClipSettings(ViewContext& context, const WidgetContext& widgets) {
    if (context.session.clips.empty()) faintText("No clips: the whole data are shown.");
    drawDescribedList(widgets.at("/clips"), {"clips", "Planes and bodies that cut the data open"},
                      context.session.clips);
}

void drawLightSettings(ViewContext& context, const WidgetContext& widgets) {
    const std::function<void()> browse = [&] {
        context.askFile("Picture of the surroundings", [](Session& now, const std::string& file) {
            now.lighting.environment.kind = vis::Environment::Picture;
            now.lighting.environment.picture = file;
        });
    };
    WidgetContext light = widgets.at("/lighting");
    light.browse = &browse;
    drawDescribed(context.session.lighting, light);
}

void drawPictureSettings(ViewContext& context, const WidgetContext& widgets, const std::string& pane) {
    Session& session = context.session;
    if (ImGui::CollapsingHeader("Camera", ImGuiTreeNodeFlags_DefaultOpen)) drawCamera(session, pane, widgets);
    if (ImGui::CollapsingHeader("Paper", ImGuiTreeNodeFlags_DefaultOpen)) drawPaper(session, widgets);
    if (ImGui::CollapsingHeader("Tone curve", ImGuiTreeNodeFlags_DefaultOpen))
        drawDescribed(session.tone, widgets.at("/tone"));
    if (ImGui::CollapsingHeader("Shadows of depth", ImGuiTreeNodeFlags_DefaultOpen))
        drawDescribed(session.depthMask, widgets.at("/depthMask"));
    if (ImGui::CollapsingHeader("Proportions", ImGuiTreeNodeFlags_DefaultOpen)) drawProportions(session, widgets);
    if (ImGui::CollapsingHeader("Quality", ImGuiTreeNodeFlags_DefaultOpen)) {
        if (canChooseLattice(session.data, *context.numbers, context.origin))
            drawParameter(session, "/data/lattice", widgets);
        drawDescribed(session.render, widgets.at("/render"));
    }
}

} // namespace tessera::app
