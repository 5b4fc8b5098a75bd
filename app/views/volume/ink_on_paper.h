#pragma once

#include "vis/scene/scene.h"

#include <imgui.h>

namespace tessera::app {

/// Colours of texts and lines on the paper under a picture, while it lives.
struct InkOnPaper {
    bool paper;
    explicit InkOnPaper(const vis::Scene& scene) : paper(vis::paperOf(scene).has_value()) {
        if (!paper) return;
        const glm::vec3 ground = vis::groundColor(scene);
        const float ink = ground.r + ground.g + ground.b < 1.5f ? 0.9f : 0.12f;
        ImGui::PushStyleColor(ImGuiCol_WindowBg, {ground.r, ground.g, ground.b, 1});
        ImGui::PushStyleColor(ImGuiCol_Text, {ink, ink, ink, 1});
    }
    InkOnPaper(const InkOnPaper&) = delete;
    InkOnPaper& operator=(const InkOnPaper&) = delete;
    ~InkOnPaper() {
        if (paper) ImGui::PopStyleColor(2);
    }
};

} // namespace tessera::app
