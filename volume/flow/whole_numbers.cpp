#include "volume/flow/whole_numbers.h"

#include <algorithm>

namespace tessera::volume {

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

Summary wholeSummary(const RegionStatistics& regions, std::size_t channel, const Summary& known) {
    Summary out = known;
    double sum = 0, samples = 0;
    bool any = false;
    for (const std::vector<Summary>& summaries : regions.summary) {
        const Summary& of = summaries[channel];
        if (!(of.samples > 0)) continue;
        out.min = any ? std::min(out.min, of.min) : of.min;
        out.max = any ? std::max(out.max, of.max) : of.max;
        any = true;
        sum += of.samples * of.mean;
        samples += of.samples;
    }
    out.mean = samples > 0 ? sum / samples : 0;
    return out;
}

} // namespace tessera::volume
