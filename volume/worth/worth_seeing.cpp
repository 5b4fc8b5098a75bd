#include "volume/worth/worth_seeing.h"

#include "volume/worth/changes.h"
#include "volume/worth/dependence.h"
#include "volume/worth/differs.h"
#include "volume/worth/odd_places.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace tessera::volume {

namespace {

constexpr double kNumbersOfTimes = 4e6; ///< at most, of one time where all times are read

/// Whether a significant finding is strong enough to be looked at.
bool isWorth(const Finding& each) {
    switch (each.kind) {
    case FindingKind::Dependence:
        return each.strength >= 0.3;
    case FindingKind::Contrast:
        return each.strength >= 0.25;
    case FindingKind::Nonlinear:
        return each.strength >= 0.3 && each.strength - std::abs(each.other) >= 0.2;
    case FindingKind::Differs:
    case FindingKind::Region:
        return each.strength >= 0.1;
    default:
        return true;
    }
}

/// How much a kind says beyond a plain correlation, of the same pair.
double saying(const Finding& each) {
    const double more = each.kind == FindingKind::Contrast ? 0.5 : each.kind == FindingKind::Nonlinear ? 0.25 : 0;
    return each.strength + more - (each.kind == FindingKind::Dependence && each.region ? 0.1 : 0);
}

/// Of each pair of parameters the dependence that says most, of each parameter in a selection the surest difference.
void keepOneOfEach(std::vector<Finding>& found) {
    const auto ofPair = [](const Finding& each) {
        return each.y >= 0 || each.kind == FindingKind::Differs || each.kind == FindingKind::Around;
    };
    std::vector<Finding> kept;
    for (const Finding& each : found) {
        if (!ofPair(each)) {
            kept.push_back(each);
            continue;
        }
        const auto other =
            std::ranges::find_if(kept, [&](const Finding& k) { return ofPair(k) && k.x == each.x && k.y == each.y; });
        if (other == kept.end())
            kept.push_back(each);
        else if (each.y >= 0 ? saying(each) > saying(*other) : each.p < other->p)
            *other = each;
    }
    found = std::move(kept);
}

bool isOddPlace(const Finding& each) {
    return each.kind == FindingKind::Outliers || each.kind == FindingKind::Jump;
}

/// Whether two boxes meet once each is a tenth of the data larger on every side, or lie side by side: what crosses
/// several regions is found in each.
bool boxesNear(const Box& a, const Box& b, const Box& bounds) {
    int near = 0, beside = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double margin = 0.1 * bounds.size()[axis];
        near += a.lo[axis] <= b.hi[axis] + margin && a.hi[axis] >= b.lo[axis] - margin ? 1 : 0;
        const double common = std::min(a.hi[axis], b.hi[axis]) - std::max(a.lo[axis], b.lo[axis]);
        const double smaller = std::min(a.size()[axis], b.size()[axis]);
        beside += common >= 0 && common >= 0.5 * smaller ? 1 : 0;
    }
    return near == 3 || beside >= 2;
}

/// A place of a parameter is there once, as it is strongest, though regions share it; then the strongest place and the
/// strongest run of changes of each parameter come first, so that one parameter does not fill the list.
void spreadPlaces(std::vector<Finding>& found, const Box& bounds) {
    std::vector<Finding> first, then, rest;
    std::set<int> seen;
    for (const Finding& each : found) {
        if (!isOddPlace(each)) {
            rest.push_back(each);
            continue;
        }
        const auto same = [&](const Finding& other) {
            return other.x == each.x && boxesNear(other.box, each.box, bounds);
        };
        if (std::ranges::any_of(first, same) || std::ranges::any_of(then, same)) continue;
        (seen.insert(each.x).second ? first : then).push_back(each);
    }
    first.insert(first.end(), then.begin(), then.end());
    first.insert(first.end(), rest.begin(), rest.end());
    found = std::move(first);
}

void joinFindings(Findings& all, const Findings& more) {
    all.tests += more.tests;
    all.found.insert(all.found.end(), more.found.begin(), more.found.end());
}

WorthSamplesQuery worthSamplesOf(const WorthQuery& query, int level) {
    WorthSamplesQuery out{.channels = query.channels, .time = query.time, .level = level, .label = query.label};
    if (query.selected || query.search == WorthSearch::WhatElse) {
        out.doiChannels = query.doiChannels;
        out.doi = query.doi;
    }
    return out;
}

/// All tests of a list, the samples that those of one time are of, and how many have a value.
Findings searchedTests(const BrickSource& source, const WorthQuery& query, int timesLevel, WorthSamples& samples,
                       double& count, const Progress& progress) {
    if (query.search == WorthSearch::When) {
        Changes changes = findChanges(
            source, {query.channels, timesLevel, query.label, query.doiChannels, query.selected ? query.doi : nullptr},
            progress);
        count = changes.samples;
        return std::move(changes.findings);
    }
    samples = readWorthSamples(source, worthSamplesOf(query, query.level), progress.part(0, 0.4));
    if (query.search == WorthSearch::Views && query.selected) keepInside(samples);
    count = double(std::ranges::count(anyPresent(samples), 1));
    Findings all;
    if (query.search == WorthSearch::WhatElse) {
        joinFindings(all, findDifferences(samples, query.doiChannels, progress.part(0.4, 0.6)));
        joinFindings(all, findAround(samples, query.doiChannels));
        joinFindings(all, findSelectedTimes(source, {query.channels, query.doiChannels, query.doi, timesLevel},
                                            progress.part(0.6, 1)));
        return all;
    }
    joinFindings(all, findOddPlaces(samples, progress.part(0.4, 0.5)));
    joinFindings(all, findDependences(samples, progress.part(0.5, 1)));
    return all;
}

} // namespace

int worthLevel(const BrickGrid& grid, std::size_t channels, double numbers) {
    return grid.levelWithin(numbers / double(std::max<std::size_t>(1, channels)));
}

WorthFindings findWorthSeeing(const BrickSource& source, const WorthQuery& query, const Progress& progress) {
    const std::size_t times = source.info().times.size();
    const bool needsSelection = query.selected || query.search == WorthSearch::WhatElse;
    WorthFindings out;
    out.level = query.level;
    if (query.channels.empty()) out.missing = "the data have only labels";
    if (needsSelection && !query.doi) out.missing = "nothing is selected";
    if (query.search == WorthSearch::When && times < 3)
        out.missing = "changes need three times or more to be compared, and the data have " + std::to_string(times);
    if (!out.missing.empty()) return out;
    const int timesLevel = std::max(query.level, worthLevel(source.grid(), query.channels.size(), kNumbersOfTimes));
    if (query.search == WorthSearch::When) out.level = timesLevel;
    WorthSamples samples;
    Findings all = searchedTests(source, query, timesLevel, samples, out.samples, progress);
    out.regionsLeft = samples.regionsLeft;
    out.tests = std::max(all.tests, all.found.size());
    keepDiscoveries(all, query.rate);
    std::erase_if(all.found, [](const Finding& each) { return !isWorth(each); });
    if (query.search == WorthSearch::When) all.found = joinedSteps(std::move(all.found));
    keepOneOfEach(all.found);
    spreadPlaces(all.found, source.info().bounds);
    if (all.found.size() > query.most) all.found.resize(query.most);
    for (const Finding& each : all.found) out.pictures.push_back(pictureOf(samples, each));
    out.found = std::move(all.found);
    return out;
}

} // namespace tessera::volume
