#include "app/pane/choose_times.h"

#include "app/pane/controls.h"
#include "app/pane/plot.h"
#include "app/ui/time_text.h"
#include "app/ui/widgets.h"

#include <algorithm>

namespace tessera::app {

std::vector<volume::TimePair> chosenTimes(const volume::DatasetInfo& info, const std::vector<double>& chosen,
                                          double shown) {
    std::vector<double> times = chosen;
    std::ranges::sort(times);
    std::vector<volume::TimePair> out;
    for (const double time : times) {
        if (time < info.times.front() || time > info.times.back()) continue;
        const volume::TimePair pair = volume::timesAround(info.times, time);
        if (out.empty() || out.back() != pair) out.push_back(pair);
    }
    if (out.empty()) out.push_back(volume::timesAround(info.times, shown));
    return out;
}

std::string chosenTimesText(const volume::DatasetInfo& info, const std::vector<double>& chosen, double shown) {
    if (chosen.empty()) return {};
    std::vector<double> times;
    for (const volume::TimePair& pair : chosenTimes(info, chosen, shown))
        times.push_back(volume::timeAt(info.times, pair));
    const std::vector<std::string> names = stateNames(info, times);
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i)
        text += (i == 0 ? ", at " : i + 1 == names.size() ? " and " : "; ") + names[i];
    return text;
}

void chooseTimes(ToolRow& tools, const volume::DatasetInfo& info, std::vector<double>& times, const Session& session) {
    const float width = em() * 8.5f;
    if (info.times.size() < 2 || !tools.next(width)) return;
    const std::vector<volume::TimePair> shown = chosenTimes(info, times, session.time);
    const std::string label = times.empty()       ? "at the time shown"
                              : shown.size() == 1 ? stateNames(info, {volume::timeAt(info.times, shown[0])})[0]
                                                  : std::to_string(shown.size()) + " times";
    ImGui::SetNextItemWidth(width);
    if (!ImGui::BeginCombo("##times", label.c_str(), ImGuiComboFlags_HeightLarge)) {
        if (ImGui::IsItemHovered()) tooltip("Times with a curve each");
        return;
    }
    if (ImGui::Selectable("The time shown", times.empty())) times.clear();
    if (ImGui::Selectable("Every time")) times = info.times;
    ImGui::Separator();
    for (std::size_t t = 0; t < info.times.size(); ++t) {
        const int stored = static_cast<int>(t);
        const volume::TimePair own{stored, stored, 0};
        bool on = std::ranges::find(shown, own) != shown.end();
        const std::string text = stateText(info, info.times[t], session.data.axis) + "##" + std::to_string(t);
        if (!ImGui::Checkbox(text.c_str(), &on)) continue;
        std::vector<double> chosen;
        for (const volume::TimePair& each : shown)
            if (on || each != own) chosen.push_back(volume::timeAt(info.times, each));
        if (on) chosen.push_back(info.times[t]);
        std::ranges::sort(chosen);
        times = chosen;
    }
    ImGui::EndCombo();
}

} // namespace tessera::app
