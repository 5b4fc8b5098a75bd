#include "app/importer/readers/give_times.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace tessera::importer {

std::vector<std::size_t> giveTimes(Source& source, const std::vector<double>& times) {
    std::vector<std::size_t> order(times.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    source.times.clear();
    if (std::ranges::any_of(times, [](double time) { return !std::isfinite(time); })) {
        for (const std::size_t step : order) source.times.push_back(double(step));
        source.timeUnit = "step";
        source.notes.push_back("a time of the file is no number: its steps are counted");
        return order;
    }
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return times[a] < times[b]; });
    std::vector<std::size_t> kept;
    for (const std::size_t step : order) {
        if (!kept.empty() && times[kept.back()] == times[step])
            kept.back() = step;
        else
            kept.push_back(step);
    }
    if (kept.size() < order.size())
        source.notes.push_back(std::to_string(order.size() - kept.size()) +
                               " steps left out: a later one of the file has the same time");
    for (const std::size_t step : kept) source.times.push_back(meantTime(times[step]));
    return kept;
}

} // namespace tessera::importer
