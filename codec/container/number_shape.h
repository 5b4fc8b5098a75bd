#pragma once

#include "volume/flow/computed_numbers.h"

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

/// What coded numbers of regions are of, and their order.
namespace tessera::codec {

/// Of one label at some times: regions and borders of all these times together.
struct NumberShape {
    std::string label, velocity;
    std::vector<std::string> channels, carried;
    std::vector<int> regions;
    std::vector<std::pair<int, int>> borders; ///< label values
    bool derived = false;                     ///< of everything: from the regions of the next label, which cover it
    bool byVolume = false;                    ///< LabelNumbers::byVolume
};

/// Throws Error with this reason.
[[noreturn]] void failNumbers(const std::string& reason);
inline void needNumbers(bool holds, const char* reason) {
    if (!holds) failNumbers(reason);
}

nlohmann::json toJson(const NumberShape& shape);
/// Reads what toJson() gives of several labels, of which the first is none. Throws Error.
std::vector<NumberShape> shapesOf(const std::string& text);

/// The shape of the numbers of one label at several times, which have it at the same place.
NumberShape shapeOf(std::span<const volume::NumbersAtTime> times, std::size_t place);

/// Numbers with all regions and borders of a shape: 0 where there is none.
volume::LabelNumbers emptyNumbers(const NumberShape& shape);
volume::LabelNumbers widened(const volume::LabelNumbers& from, const NumberShape& shape);
/// Leaves out the regions and borders that are not there.
void narrow(volume::LabelNumbers& numbers);

/// Calls visit(number, whether it keeps every bit) for all numbers of a label that are stored, in the order of the
/// format. `whole`: also those of everything. `derived`: these alone, and only what regions do not tell.
template <class Visit> void visitNumbers(volume::LabelNumbers& numbers, bool whole, bool derived, const Visit& visit) {
    const auto summary = [&](volume::Summary& of) {
        visit(of.samples, true);
        visit(of.volume, true);
        visit(of.deviation, false);
        if (derived) return;
        visit(of.mean, false);
        visit(of.min, true);
        visit(of.max, true);
    };
    const auto crossing = [&](volume::Crossing& of) {
        visit(of.area, true);
        visit(of.in, false);
        visit(of.out, false);
        visit(of.flow, false);
    };
    volume::RegionStatistics& statistics = numbers.statistics;
    if (whole) {
        visit(statistics.allSamples, true);
        visit(statistics.allVolume, true);
        for (volume::Summary& of : statistics.all) summary(of);
    }
    if (derived) return;
    for (std::size_t r = 0; r < statistics.regions.size(); ++r) {
        visit(statistics.samples[r], true);
        visit(statistics.volume[r], true);
        for (volume::Summary& of : statistics.summary[r]) summary(of);
    }
    for (std::vector<volume::RegionBalance>& balances : numbers.balances)
        for (volume::RegionBalance& balance : balances) {
            visit(balance.volume, true);
            visit(balance.amount, false);
            for (volume::Crossing& face : balance.faces) crossing(face);
            crossing(balance.absent);
            crossing(balance.unlabelled);
            for (volume::BorderCrossing& border : balance.borders) crossing(border.crossing);
        }
}

} // namespace tessera::codec
