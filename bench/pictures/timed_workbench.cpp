#include "bench/pictures/timed_workbench.h"

#include "volume/base/error.h"

#include <algorithm>
#include <chrono>
#include <imgui.h>

namespace tessera::app {

namespace {

using Clock = std::chrono::steady_clock;
constexpr glm::ivec2 kWindow{1500, 950};
constexpr int kTimedSteps = 9;    // steps of a drag; the median is reported
constexpr double kLongest = 3000; // milliseconds until every view has followed
constexpr int kMostAtRest = 5000; // until every view is refined

double millisecondsSince(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

} // namespace

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    std::ranges::sort(values);
    return values[values.size() / 2];
}

void Followed::addTo(BenchTable& table, const std::string& what) const {
    double sum = 0;
    for (const auto& [pane, times] : drawing) {
        sum += median(times);
        table.rows.push_back({what, pane, decimals(median(times), 1), decimals(median(shown.at(pane)), 1)});
    }
    table.rows.push_back({what, "every view", decimals(sum, 1), decimals(median(all), 1)});
}

TimedWorkbench::TimedWorkbench()
    : workbench_({.renderer = nullptr,
                  .render = {},
                  .headless = false,
                  .onlyPane = {},
                  .stateFolder = {},
                  .wake =
                      [this] {
                          const std::lock_guard lock(mutex_);
                          woke_ = true;
                          woken_.notify_one();
                      },
                  .paneDrawn =
                      [this](const std::string& pane, bool behind) {
                          if (paneDrawn_) paneDrawn_(pane, behind);
                      }}),
      frames_(kWindow) {}

void TimedWorkbench::wait() {
    std::unique_lock lock(mutex_);
    const double longest = std::min(workbench_.idleSeconds(), 0.25);
    if (longest > 0) woken_.wait_for(lock, std::chrono::duration<double>(longest), [this] { return woke_; });
    woke_ = false;
}

std::map<std::string, double> TimedWorkbench::untilShown() {
    const Clock::time_point begin = Clock::now();
    std::map<std::string, double> first;
    bool behind = true;
    for (int frame = 0; frame < kMostAtRest && behind; ++frame) {
        behind = false;
        paneDrawn_ = [&](const std::string& pane, bool late) {
            OffscreenFrames::finish();
            behind = behind || late;
            if (!late) first.try_emplace(pane, millisecondsSince(begin));
        };
        frames_.draw(workbench_, 1);
        frames_.show();
        if (behind) wait();
    }
    paneDrawn_ = nullptr;
    return first;
}

double TimedWorkbench::untilRest() {
    const Clock::time_point begin = Clock::now();
    for (int frame = 0; frame == 0 || (workbench_.busy() && frame < kMostAtRest); ++frame) {
        frames_.draw(workbench_, 1);
        frames_.show();
        if (workbench_.busy()) wait();
    }
    return millisecondsSince(begin);
}

Followed TimedWorkbench::drag(const std::function<void(Session&, double)>& edit) {
    Followed out;
    untilRest(); // the state in which a drag begins
    const auto held =
        [](ImGuiIO& io) { // over the status bar, where a held button only makes views draw at reduced quality
            io.MousePos = {40, float(kWindow.y) - 6};
            io.MouseDown[0] = true;
        };
    for (int step = 0; step <= kTimedSteps; ++step) {
        const Clock::time_point begin = Clock::now();
        edit(session(), double(step) / kTimedSteps);
        std::map<std::string, double> first;
        bool behind = true;
        for (int frame = 0; behind && millisecondsSince(begin) < kLongest; ++frame) {
            behind = false;
            Clock::time_point before = Clock::now();
            paneDrawn_ = [&](const std::string& pane, bool late) {
                OffscreenFrames::finish();
                if (step > 0 && frame == 0) out.drawing[pane].push_back(millisecondsSince(before));
                behind = behind || late;
                if (!late) first.try_emplace(pane, millisecondsSince(begin));
                before = Clock::now();
            };
            frames_.draw(workbench_, 1, held);
            frames_.show();
            OffscreenFrames::finish();
            if (behind) wait();
        }
        paneDrawn_ = nullptr;
        if (!ImGui::IsAnyItemActive()) throw MachineError("the mouse holds nothing");
        if (step == 0) continue;
        for (const auto& [pane, time] : first) out.shown[pane].push_back(time);
        out.all.push_back(millisecondsSince(begin));
    }
    frames_.draw(workbench_, 1);
    return out;
}

} // namespace tessera::app
