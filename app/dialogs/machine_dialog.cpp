#include "app/dialogs/machine_dialog.h"

#include "app/dialogs/modal.h"

#include <algorithm>
#include <imgui.h>
#include <iterator>
#include <utility>

namespace tessera::app {

std::optional<MachineDialog::Decision> MachineDialog::draw() {
    if (waiting_.empty()) return {};
    bool open = true;
    std::optional<Answer> answer;
    const std::string machine = waiting_.front().machine;
    if (beginDialog("Ask another machine?", open, ImGui::GetFontSize() * 34)) {
        ImGui::TextWrapped("%s:\nthe data lie on another machine, from which you have opened nothing yet:",
                           waiting_.front().title.c_str());
        ImGui::Spacing();
        ImGui::TextWrapped("%s", machine.c_str());
        ImGui::Spacing();
        ImGui::TextWrapped("To read them tells that machine that you do, and from where, and logs in there if you have "
                           "a key or a password for it. Always: do not ask again about this machine.");
        switch (dialogButtons({"Always", "Open", "No"})) { // Enter is the answer that does no harm
        case 0:
            answer = Answer::Always;
            break;
        case 1:
            answer = Answer::Once;
            break;
        case 2:
            answer = Answer::No;
            break;
        default:
            break;
        }
        if (answer) open = false;
        endDialog(open);
    }
    if (open) return {};
    Decision decision{answer.value_or(Answer::No), {}};
    const auto others = std::stable_partition(waiting_.begin(), waiting_.end(),
                                              [&](const Jobs::Refused& job) { return job.machine == machine; });
    std::move(waiting_.begin(), others, std::back_inserter(decision.jobs));
    waiting_.erase(waiting_.begin(), others);
    return decision;
}

} // namespace tessera::app
