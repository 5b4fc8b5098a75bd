#include "codec/container/number_shape.h"

#include "volume/base/error.h"
#include "volume/flow/whole_numbers.h"

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>

namespace tessera::codec {

using nlohmann::json;
using volume::LabelNumbers;
using volume::NumbersAtTime;
using volume::RegionBalance;

void failNumbers(const std::string& reason) {
    throw Error("the numbers of regions are damaged: " + reason);
}

json toJson(const NumberShape& shape) {
    json out{{"label", shape.label}, {"channels", shape.channels}};
    if (!shape.velocity.empty()) out["velocity"] = shape.velocity, out["carried"] = shape.carried;
    if (!shape.label.empty()) out["regions"] = shape.regions;
    if (!shape.borders.empty()) out["borders"] = shape.borders;
    if (shape.derived) out["derived"] = true;
    if (shape.byVolume) out["byVolume"] = true;
    return out;
}

std::vector<NumberShape> shapesOf(const std::string& text) {
    const json document = json::parse(text, nullptr, false);
    std::vector<NumberShape> out;
    try {
        for (const json& each : document.at("labels")) {
            NumberShape& shape = out.emplace_back();
            shape.label = each.at("label").get<std::string>();
            shape.channels = each.at("channels").get<std::vector<std::string>>();
            if (each.contains("velocity")) {
                shape.velocity = each.at("velocity").get<std::string>();
                shape.carried = each.at("carried").get<std::vector<std::string>>();
            }
            if (!shape.label.empty()) shape.regions = each.at("regions").get<std::vector<int>>();
            if (each.contains("derived")) shape.derived = each.at("derived").get<bool>();
            if (each.contains("byVolume")) shape.byVolume = each.at("byVolume").get<bool>();
            if (each.contains("borders")) shape.borders = each.at("borders").get<std::vector<std::pair<int, int>>>();
        }
    } catch (const json::exception&) {
        failNumbers("what they are of cannot be read");
    }
    needNumbers(!out.empty() && out.front().label.empty(), "those of everything are missing");
    needNumbers(!out.front().derived || (out.size() > 1 && out[1].carried == out[0].carried),
                "those of everything have no regions");
    for (const NumberShape& shape : out) {
        needNumbers(!shape.derived || shape.label.empty(), "those of a label are not those of everything");
        needNumbers(shape.channels == out.front().channels, "labels have different channels");
        needNumbers(std::ranges::is_sorted(shape.regions, std::less_equal<>()), "regions are out of order");
        needNumbers(std::ranges::is_sorted(shape.borders, std::less_equal<>()), "borders are out of order");
        for (const auto& [own, other] : shape.borders)
            needNumbers(std::ranges::binary_search(shape.regions, own), "a border has no region");
    }
    return out;
}

NumberShape shapeOf(std::span<const NumbersAtTime> times, std::size_t place) {
    const LabelNumbers& first = times.front().labels[place];
    NumberShape shape{first.label, first.velocity, first.channels, first.carried, {}, {}};
    std::set<int> regions;
    std::set<std::pair<int, int>> borders;
    for (const NumbersAtTime& time : times) {
        const LabelNumbers& numbers = time.labels[place];
        regions.insert(numbers.statistics.regions.begin(), numbers.statistics.regions.end());
        for (const std::vector<RegionBalance>& balances : numbers.balances)
            for (const RegionBalance& balance : balances)
                for (const volume::BorderCrossing& border : balance.borders)
                    borders.emplace(balance.region, border.region);
    }
    shape.byVolume = first.byVolume;
    shape.regions.assign(regions.begin(), regions.end());
    shape.borders.assign(borders.begin(), borders.end());
    shape.derived = place == 0 && std::ranges::all_of(times, [](const NumbersAtTime& time) {
                        return time.labels.size() > 1 && volume::coversAll(time.labels[1].statistics) &&
                               time.labels[1].carried == time.labels[0].carried;
                    });
    return shape;
}

namespace {

RegionBalance emptyBalance(const NumberShape& shape, int region) {
    RegionBalance balance;
    balance.region = region;
    for (const auto& [own, other] : shape.borders)
        if (own == region) balance.borders.push_back({other, {}});
    return balance;
}

void fill(RegionBalance& wide, const RegionBalance& from) {
    std::vector<volume::BorderCrossing> borders = std::move(wide.borders);
    wide = from;
    for (volume::BorderCrossing& border : borders)
        for (const volume::BorderCrossing& known : from.borders)
            if (known.region == border.region) border.crossing = known.crossing;
    wide.borders = std::move(borders);
}

} // namespace

LabelNumbers emptyNumbers(const NumberShape& shape) {
    LabelNumbers out{shape.label, shape.velocity, shape.channels, shape.carried, {}, {}, shape.byVolume};
    volume::RegionStatistics& statistics = out.statistics;
    statistics.regions = shape.regions;
    statistics.samples.resize(shape.regions.size());
    statistics.volume.resize(shape.regions.size());
    statistics.all.resize(shape.channels.size());
    statistics.summary.assign(shape.regions.size(), statistics.all);
    std::vector<RegionBalance> balances;
    if (shape.label.empty()) balances.push_back(emptyBalance(shape, 0));
    for (const int region : shape.regions) balances.push_back(emptyBalance(shape, region));
    out.balances.assign(shape.carried.size(), balances);
    return out;
}

LabelNumbers widened(const LabelNumbers& from, const NumberShape& shape) {
    LabelNumbers out = emptyNumbers(shape);
    out.statistics.allSamples = from.statistics.allSamples;
    out.statistics.allVolume = from.statistics.allVolume;
    out.statistics.all = from.statistics.all;
    for (std::size_t r = 0; r < from.statistics.regions.size(); ++r) {
        const auto to =
            std::size_t(std::ranges::lower_bound(shape.regions, from.statistics.regions[r]) - shape.regions.begin());
        out.statistics.samples[to] = from.statistics.samples[r];
        out.statistics.volume[to] = from.statistics.volume[r];
        out.statistics.summary[to] = from.statistics.summary[r];
    }
    for (std::size_t k = 0; k < out.balances.size(); ++k)
        for (RegionBalance& balance : out.balances[k])
            for (const RegionBalance& known : from.balances[k])
                if (known.region == balance.region) fill(balance, known);
    return out;
}

void narrow(LabelNumbers& numbers) {
    volume::RegionStatistics& statistics = numbers.statistics;
    std::size_t kept = 0;
    for (std::size_t r = 0; r < statistics.regions.size(); ++r) {
        if (!(statistics.samples[r] > 0)) continue;
        statistics.regions[kept] = statistics.regions[r];
        statistics.samples[kept] = statistics.samples[r];
        statistics.volume[kept] = statistics.volume[r];
        statistics.summary[kept++] = statistics.summary[r];
    }
    statistics.regions.resize(kept);
    statistics.samples.resize(kept);
    statistics.volume.resize(kept);
    statistics.summary.resize(kept);
    for (std::vector<RegionBalance>& balances : numbers.balances) {
        if (!numbers.label.empty())
            std::erase_if(balances, [&](const RegionBalance& balance) {
                return !std::ranges::binary_search(statistics.regions, balance.region);
            });
        for (RegionBalance& balance : balances)
            std::erase_if(balance.borders,
                          [](const volume::BorderCrossing& border) { return !(border.crossing.area > 0); });
    }
}

} // namespace tessera::codec
