#include "volume/flow/computed_numbers.h"

#include "volume/flow/flow_channels.h"
#include "volume/flow/sections.h"
#include "volume/flow/whole_numbers.h"

#include <algorithm>

namespace tessera::volume {

namespace {

/// Adds the statistics of further channels of the same samples and regions.
void addChannels(RegionStatistics&& more, RegionStatistics& statistics) {
    if (statistics.all.empty()) {
        statistics = std::move(more);
        return;
    }
    statistics.all.insert(statistics.all.end(), more.all.begin(), more.all.end());
    for (std::size_t r = 0; r < more.summary.size(); ++r)
        statistics.summary[r].insert(statistics.summary[r].end(), more.summary[r].begin(), more.summary[r].end());
}

/// Of a label, or of everything, whose balances follow from those of a label that covers it (`covering`, or null).
LabelNumbers numbersOfLabel(const BrickSource& source, int label, int time, const LabelNumbers* covering,
                            std::size_t cacheBytes, const Progress& progress) {
    const DatasetInfo& info = source.info();
    const std::vector<Channel> channels = info.channels();
    LabelNumbers out;
    std::vector<int> regions;
    if (label >= 0) {
        out.label = channels[std::size_t(label)].name;
        regions = labelValues(source, label, time, progress.part(0, 0.1));
        if (regions.size() > kMostRegions) return {};
    }
    const auto velocity = velocityChannels(info);
    if (velocity) out.velocity = parameterOf(info, (*velocity)[0]).name;
    for (std::size_t c = 0; c < channels.size();) {
        const Parameter& parameter = info.parameters[std::size_t(channels[c].parameter)];
        std::vector<int> own;
        const Progress part = progress.part(0.1 + 0.9 * double(c) / double(channels.size()), 1);
        for (const int parameterNumber = channels[c].parameter;
             c < channels.size() && channels[c].parameter == parameterNumber; ++c)
            own.push_back(int(c));
        if (parameter.categorical) continue;
        for (const int channel : own) out.channels.push_back(channels[std::size_t(channel)].name);
        addChannels(computeRegionStatistics(source, {own, label, regions, time, 0}, {{}, part.stop}), out.statistics);
        if (!velocity || parameter.components != 1) continue;
        out.carried.push_back(out.channels.back());
        if (covering) {
            out.balances.push_back({wholeBalance(covering->balances[out.balances.size()])});
            continue;
        }
        BalanceQuery query{own.front(), *velocity, label, regions, time};
        query.cacheBytes = cacheBytes;
        out.balances.push_back(computeBalance(source, query, {{}, part.stop}));
        progress.advance(0.1 + 0.9 * double(c) / double(channels.size()), "numbers of regions");
    }
    return out;
}

const NumbersAtTime* at(const ComputedNumbers& numbers, double time) {
    const auto found = std::ranges::find(numbers, time, &NumbersAtTime::time);
    return found == numbers.end() ? nullptr : &*found;
}

} // namespace

NumbersAtTime computeNumbers(const BrickSource& source, int time, std::size_t cacheBytes, const Progress& progress) {
    const DatasetInfo& info = source.info();
    NumbersAtTime out;
    out.time = info.times[std::size_t(time)];
    std::vector<int> labels;
    const std::vector<Channel> channels = info.channels();
    for (std::size_t c = 0; c < channels.size(); ++c)
        if (info.parameters[std::size_t(channels[c].parameter)].categorical) labels.push_back(int(c));
    const double count = double(labels.size()) + 1;
    for (std::size_t l = 0; l < labels.size(); ++l) {
        const Progress part = progress.part(double(l) / count, double(l + 1) / count);
        LabelNumbers numbers = numbersOfLabel(source, labels[l], time, nullptr, cacheBytes, part);
        if (!numbers.channels.empty()) out.labels.push_back(std::move(numbers));
    }
    const bool covers = !out.labels.empty() && coversAll(out.labels.front().statistics);
    LabelNumbers whole = numbersOfLabel(source, -1, time, covers ? &out.labels.front() : nullptr, cacheBytes,
                                        progress.part(1 - 1 / count, 1));
    if (whole.channels.empty()) return out; // there are labels alone
    out.labels.insert(out.labels.begin(), std::move(whole));
    return out;
}

bool coversAll(const RegionStatistics& statistics) {
    double samples = 0;
    for (const double of : statistics.samples) samples += of;
    return samples == statistics.allSamples;
}

RegionBalance wholeBalance(const std::vector<RegionBalance>& regions) {
    const auto add = [](Crossing& to, const Crossing& from) {
        to.area += from.area;
        to.in += from.in;
        to.out += from.out;
        to.flow += from.flow;
    };
    RegionBalance out;
    for (const RegionBalance& region : regions) {
        for (std::size_t face = 0; face < 6; ++face) add(out.faces[face], region.faces[face]);
        add(out.absent, region.absent);
        out.volume += region.volume;
        out.amount += region.amount;
    }
    return out;
}

Summary wholeSummary(const RegionStatistics& regions, std::size_t channel, const Summary& known, bool byVolume) {
    Summary out = known;
    double sum = 0, weights = 0;
    bool any = false;
    for (const std::vector<Summary>& summaries : regions.summary) {
        const Summary& of = summaries[channel];
        if (!(of.samples > 0)) continue;
        out.min = any ? std::min(out.min, of.min) : of.min;
        out.max = any ? std::max(out.max, of.max) : of.max;
        any = true;
        const double weight = byVolume ? of.volume : of.samples;
        sum += weight * of.mean;
        weights += weight;
    }
    out.mean = weights > 0 ? sum / weights : 0;
    return out;
}

ComputedNumbers selectedNumbers(const ComputedNumbers& numbers, const DatasetInfo& info) {
    const auto has = [&](const std::string& channel) { return info.findChannel(channel).has_value(); };
    ComputedNumbers out;
    for (const NumbersAtTime& time : numbers) {
        if (std::ranges::find(info.times, time.time) == info.times.end()) continue;
        NumbersAtTime kept{time.time, {}};
        for (const LabelNumbers& from : time.labels) {
            if (!from.label.empty() && !has(from.label)) continue;
            LabelNumbers to{from.label, from.velocity, {}, {}, from.statistics, {}, from.byVolume};
            to.statistics.all.clear();
            for (std::vector<Summary>& summaries : to.statistics.summary) summaries.clear();
            for (std::size_t c = 0; c < from.channels.size(); ++c) {
                if (!has(from.channels[c])) continue;
                to.channels.push_back(from.channels[c]);
                to.statistics.all.push_back(from.statistics.all[c]);
                for (std::size_t r = 0; r < from.statistics.summary.size(); ++r)
                    to.statistics.summary[r].push_back(from.statistics.summary[r][c]);
            }
            for (std::size_t k = 0; k < from.carried.size(); ++k)
                if (has(from.carried[k])) {
                    to.carried.push_back(from.carried[k]);
                    to.balances.push_back(from.balances[k]);
                }
            if (!to.channels.empty()) kept.labels.push_back(std::move(to));
        }
        if (!kept.labels.empty()) out.push_back(std::move(kept));
    }
    return out;
}

std::optional<RegionStatistics> knownStatistics(const ComputedNumbers& numbers, double time, const std::string& label,
                                                const std::vector<std::string>& channels) {
    const NumbersAtTime* const known = at(numbers, time);
    if (!known || channels.empty()) return std::nullopt;
    std::optional<RegionStatistics> out;
    for (const std::string& channel : channels) {
        bool found = false;
        for (const LabelNumbers& each : known->labels) {
            const auto name = std::ranges::find(each.channels, channel);
            if (each.label != label || name == each.channels.end() || !each.byVolume) continue;
            const auto position = std::size_t(name - each.channels.begin());
            const RegionStatistics& from = each.statistics;
            if (!out) {
                out = from;
                out->all.clear();
                for (std::vector<Summary>& summaries : out->summary) summaries.clear();
            } else if (out->regions != from.regions) {
                return std::nullopt;
            }
            out->all.push_back(from.all[position]);
            for (std::size_t r = 0; r < from.regions.size(); ++r) out->summary[r].push_back(from.summary[r][position]);
            found = true;
            break;
        }
        if (!found) return std::nullopt;
    }
    return out;
}

std::optional<std::vector<RegionBalance>> knownBalance(const ComputedNumbers& numbers, double time,
                                                       const std::string& label, const std::string& channel,
                                                       const std::string& velocity) {
    const NumbersAtTime* const known = at(numbers, time);
    if (!known) return std::nullopt;
    for (const LabelNumbers& each : known->labels) {
        const auto name = std::ranges::find(each.carried, channel);
        if (each.label == label && each.velocity == velocity && name != each.carried.end())
            return each.balances[std::size_t(name - each.carried.begin())];
    }
    return std::nullopt;
}

} // namespace tessera::volume
