#include "app/views/compare/compare_questions.h"

#include "app/pane/plot.h"
#include "app/ui/ticks.h"

#include <algorithm>
#include <cmath>
#include <imgui.h>
#include <imgui_stdlib.h>

namespace tessera::app {

Table questionsTable(const std::vector<CompareQuestion>& questions) {
    Table table;
    addColumn(table, questions, {.name = "question"}, &CompareQuestion::text);
    addColumn(table, questions, {.name = "answer"}, &CompareQuestion::answer);
    addColumn(table, questions, {.name = "seconds"},
              [](const CompareQuestion& each) { return each.seconds > 0 ? each.seconds : std::nan(""); });
    return table;
}

float questionsHeight(const CompareView& view) {
    if (view.questions.empty()) return 0;
    return ImGui::GetFrameHeightWithSpacing() * static_cast<float>(view.questions.size() + 1) + em() * 0.4f;
}

void drawQuestions(const ViewContext& context, CompareView& view, QuestionClock& clock,
                   const std::vector<std::string>& variants) {
    if (view.questions.empty()) {
        clock = {};
        return;
    }
    if (clock.shown < 0) clock.shown = ImGui::GetTime();
    const float width = ImGui::GetContentRegionAvail().x;
    const float remove = iconButtonWidth(context, icons::kTrash), time = em() * 5;
    // Answers are names of variants; where there is little room, the questions come first.
    const float room = width - ImGui::GetFrameHeight() - time - remove;
    float longest = 0;
    for (const CompareQuestion& question : view.questions)
        longest =
            std::max(longest, ImGui::CalcTextSize(question.text.c_str()).x + 2 * ImGui::GetStyle().FramePadding.x);
    const float answer = std::clamp(room - longest, std::min(em() * 7, room * 0.35f), em() * 14);
    const auto answered = [&](CompareQuestion& question) { question.seconds = ImGui::GetTime() - clock.shown; };
    std::size_t removed = view.questions.size();
    for (std::size_t i = 0; i < view.questions.size(); ++i) {
        CompareQuestion& question = view.questions[i];
        ImGui::PushID(static_cast<int>(i));
        ImGui::SetNextItemWidth(std::max(em() * 4, room - answer));
        ImGui::InputTextWithHint("##question", "A question, such as: which spot is hotter?", &question.text);
        const float shown = ImGui::GetItemRectSize().x - 2 * ImGui::GetStyle().FramePadding.x;
        if (ImGui::IsItemHovered() && !ImGui::IsItemActive() && ImGui::CalcTextSize(question.text.c_str()).x > shown)
            tooltip(question.text.c_str());
        ImGui::SameLine(0, em() * 0.4f);
        ImGui::SetNextItemWidth(answer);
        if (ImGui::InputTextWithHint("##answer", "answer", &question.answer)) answered(question);
        ImGui::SameLine(0, 0);
        if (ImGui::BeginCombo("##variants", "", ImGuiComboFlags_NoPreview | ImGuiComboFlags_PopupAlignLeft)) {
            for (const std::string& name : variants)
                if (ImGui::Selectable(name.c_str(), name == question.answer)) {
                    question.answer = name;
                    answered(question);
                }
            ImGui::EndCombo();
        }
        ImGui::SameLine(0, em() * 0.4f);
        ImGui::AlignTextToFramePadding();
        ImGui::TextDisabled("%s", question.seconds > 0 ? formatQuantity(question.seconds, "s", 0.1).c_str() : "-");
        if (ImGui::IsItemHovered()) tooltip("Time to the answer");
        ImGui::SameLine(width - remove);
        if (iconButton(context, "remove", icons::kTrash, "Remove the question")) removed = i;
        ImGui::PopID();
    }
    if (removed < view.questions.size())
        view.questions.erase(view.questions.begin() + static_cast<std::ptrdiff_t>(removed));
    if (ImGui::SmallButton("Copy answers as CSV"))
        ImGui::SetClipboardText(csvOf(questionsTable(view.questions)).c_str());
    ImGui::SameLine(0, em() * 0.5f);
    if (ImGui::SmallButton("Clear answers")) {
        for (CompareQuestion& question : view.questions) question.answer.clear(), question.seconds = 0;
        clock = {};
    }
}

} // namespace tessera::app
