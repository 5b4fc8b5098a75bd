#include "app/views/parallel/parallel_axes.h"

#include "app/pane/plot.h"
#include "volume/flow/flow_channels.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr double kLeastOfGreatest = 1e-6; ///< of the values on a logarithmic axis that has values of 0 and below
constexpr double kMarginShare = 0.02;     ///< beyond both ends of the values
constexpr float kFarBeyond = 4;           ///< lengths of the axis

bool namedIn(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

Range logarithmicRange(Range values) {
    const double lo = values.lo > 0 ? values.lo : values.hi * kLeastOfGreatest;
    const double margin = std::pow(values.hi / lo, kMarginShare);
    if (!(margin > 1)) return {lo / 2, values.hi * 2};
    return {lo / margin, values.hi * margin};
}

/// 1, 2, 5 of decades, or decades, or every so many of them.
std::vector<double> decadeTicks(Range range, int most) {
    const int first = static_cast<int>(std::floor(std::log10(range.lo))),
              last = static_cast<int>(std::ceil(std::log10(range.hi)));
    const auto ticks = [&](const std::vector<double>& steps, int every) {
        std::vector<double> out;
        for (int decade = first; decade <= last; ++decade)
            for (const double step : steps) {
                const double value = step * std::pow(10.0, decade);
                if (decade % every == 0 && value >= range.lo * (1 - 1e-9) && value <= range.hi * (1 + 1e-9))
                    out.push_back(value);
            }
        return out;
    };
    std::vector<double> out = ticks({1, 2, 5}, 1);
    if (out.size() < 3) return niceTicks(range, most);
    for (int every = 1; static_cast<int>(out.size()) > most && every < 64; ++every) out = ticks({1}, every);
    return out;
}

} // namespace

float ParallelAxis::pixel(double value) const {
    const double share = std::clamp(volume::axisShare(density, value), -double(kFarBeyond), 1 + double(kFarBeyond));
    return static_cast<float>(bottom - (flipped ? 1 - share : share) * (bottom - top));
}

double ParallelAxis::value(float y) const {
    const double share = (bottom - y) / std::max(1e-6f, bottom - top);
    return volume::axisValue(density, flipped ? 1 - share : share);
}

Range ParallelAxis::between(float y0, float y1) const {
    const double a = value(y0), b = value(y1);
    return {std::min(a, b), std::max(a, b)};
}

double ParallelAxis::perPixel(float y) const {
    return std::abs(value(y + 0.5f) - value(y - 0.5f));
}

std::vector<ParallelAxis> parallelAxes(const volume::DatasetInfo& info, const ParallelCoordinatesView& view,
                                       const std::vector<int>& channels) {
    std::vector<ParallelAxis> out;
    for (const int channel : channels) {
        ParallelAxis& axis = out.emplace_back();
        axis.channel = info.channel(channel);
        axis.density.channel = channel;
        axis.flipped = namedIn(view.flipped, axis.channel.name);
        const Range values = info.channelRange(axis.channel);
        const volume::Parameter& parameter = volume::parameterOf(info, channel);
        axis.density.logarithmic =
            !parameter.categorical && values.hi > 0 && namedIn(view.logarithmic, axis.channel.name);
        axis.whole = axis.density.logarithmic ? logarithmicRange(values) : paddedRange(values, kMarginShare);
        if (parameter.categorical) {
            axis.labels = parameter.labels;
            axis.whole = {values.lo - 0.5, values.hi + 0.5};
        }
        const auto zoomed = view.zoom.find(axis.channel.name);
        const bool usable = zoomed != view.zoom.end() && zoomed->second.hi > zoomed->second.lo &&
                            (!axis.density.logarithmic || zoomed->second.lo > 0);
        axis.density.range = usable ? zoomed->second : axis.whole;
    }
    return out;
}

TickLabels axisTicks(const ParallelAxis& axis, double line) {
    const double length = double(axis.bottom - axis.top);
    const int most = std::max(2, static_cast<int>(length / (line * 2)));
    TickLabels out;
    if (!axis.labels.empty()) {
        for (const volume::Label& label : axis.labels) {
            if (!axis.shows(label.value)) continue;
            out.values.push_back(label.value);
            out.texts.push_back(label.name);
        }
        return out;
    }
    if (!axis.density.logarithmic)
        return fittingTicks(axis.density.range, length, line * 0.6, true, [&](const std::string&) { return line; });
    out.values = decadeTicks(axis.density.range, most);
    for (const double value : out.values) out.texts.push_back(formatNumber(value, value / 1000));
    return out;
}

std::string axisText(const ParallelAxis& axis, double value, double resolution) {
    if (axis.labels.empty()) return formatQuantity(value, axis.channel.unit, resolution);
    const int rounded = static_cast<int>(std::lround(value));
    for (const volume::Label& label : axis.labels)
        if (label.value == rounded) return label.name;
    return formatNumber(value, 1);
}

std::string axisTitle(const ParallelAxis& axis, const std::string& note) {
    std::string title = titleWithUnit(axis.channel.name, axis.channel.unit);
    if (!note.empty()) title += " " + note;
    if (axis.density.logarithmic) title += " log";
    return title;
}

namespace {

constexpr int kExactOrder = 12; ///< axes

double correlationStrength(const std::vector<double>& correlation, int size, int a, int b) {
    const double r = correlation[static_cast<std::size_t>(a * size + b)];
    return std::isnan(r) ? 0 : std::abs(r);
}

std::vector<int> exactOrder(const std::vector<double>& correlation, int size) {
    // best[set][last]: the greatest sum over orders of the axes in `set` that end with `last`.
    const auto sets = std::size_t(1) << size;
    const auto at = [&](std::size_t set, int last) { return set * std::size_t(size) + std::size_t(last); };
    std::vector<double> best(sets * std::size_t(size), -1);
    std::vector<int> before(best.size(), -1);
    for (int i = 0; i < size; ++i) best[at(std::size_t(1) << i, i)] = 0;
    for (std::size_t set = 1; set < sets; ++set)
        for (int last = 0; last < size; ++last) {
            const double sum = best[at(set, last)];
            if (sum < 0) continue;
            for (int next = 0; next < size; ++next) {
                if (set >> next & 1) continue;
                const std::size_t to = at(set | std::size_t(1) << next, next);
                const double with = sum + correlationStrength(correlation, size, last, next);
                if (with > best[to]) best[to] = with, before[to] = last;
            }
        }
    int last = 0;
    for (int i = 1; i < size; ++i)
        if (best[at(sets - 1, i)] > best[at(sets - 1, last)] + 1e-12) last = i;
    std::vector<int> order;
    for (std::size_t set = sets - 1; last >= 0;) {
        order.push_back(last);
        const int earlier = before[at(set, last)];
        set &= ~(std::size_t(1) << last);
        last = earlier;
    }
    return order;
}

std::vector<int> grownOrder(const std::vector<double>& correlation, int size) {
    int a = 0, b = 1;
    for (int i = 0; i < size; ++i)
        for (int j = i + 1; j < size; ++j)
            if (correlationStrength(correlation, size, i, j) > correlationStrength(correlation, size, a, b))
                a = i, b = j;
    std::vector<int> order{a, b};
    while (static_cast<int>(order.size()) < size) {
        int found = -1;
        bool front = false;
        double most = -1;
        for (int i = 0; i < size; ++i) {
            if (std::find(order.begin(), order.end(), i) != order.end()) continue;
            for (const bool first : {false, true}) {
                const double own = correlationStrength(correlation, size, i, first ? order.front() : order.back());
                if (own > most) most = own, found = i, front = first;
            }
        }
        order.insert(front ? order.begin() : order.end(), found);
    }
    return order;
}

} // namespace

std::vector<int> correlationOrder(const std::vector<double>& correlation, int size) {
    if (size < 2) return std::vector<int>(static_cast<std::size_t>(std::max(0, size)), 0);
    std::vector<int> order = size <= kExactOrder ? exactOrder(correlation, size) : grownOrder(correlation, size);
    if (order.front() > order.back()) std::reverse(order.begin(), order.end());
    return order;
}

} // namespace tessera::app
