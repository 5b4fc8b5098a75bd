#include "volume/import/find_parts.h"

#include "volume/field/own_axes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

namespace tessera::volume {

namespace {

constexpr double kJumpOfInside = 3, kJumpOfRange = 0.002, kThinJumpOfRange = 0.1, kShareOfBorder = 0.25;
constexpr std::size_t kMostValues = 32;         // of a label, to look for parts
constexpr std::size_t kMostSamples = 4'000'000; // looked at along each axis

/// Evidence from the samples on both sides of a border at one time: for pairs where neither side, one side, or both
/// sides have a neighbour inside their region to extrapolate from.
struct Border {
    struct Pairs {
        std::vector<double> jump, inside;
    };
    std::array<Pairs, 3> by;
    /// The most reliable pairs. If at most one side can be extrapolated, curvature looks like a jump, so a larger
    /// difference is needed.
    const Pairs& best() const { return !by[2].jump.empty() ? by[2] : !by[1].jump.empty() ? by[1] : by[0]; }
    double leastOfRange() const { return by[2].jump.empty() ? kThinJumpOfRange : kJumpOfRange; }
};
using Borders = std::map<std::pair<int, int>, Border>; ///< by label values, the lesser first

/// One component at one time with the label; absent samples have no region.
struct Samples {
    std::vector<double> values;
    std::vector<int> regions;
    static constexpr int kNone = std::numeric_limits<int>::min();
};

Samples samplesOf(const Field& field, const Field& label) {
    Samples out{physicalValues(field), std::vector<int>(field.count(), Samples::kNone)};
    for (std::size_t i = 0; i < out.regions.size(); ++i)
        if (field.present(i) && label.present(i) && std::isfinite(out.values[i]))
            out.regions[i] = int(std::lround(label.value(i)));
    return out;
}

/// Looks along one line of samples, which are at these places of their axis.
void alongLine(const Samples& samples, std::size_t first, std::size_t step, const std::vector<double>& places,
               Borders& borders) {
    const int count = int(places.size());
    const auto at = [&](int i) { return first + std::size_t(i) * step; };
    const auto between = [&](int a, int b) { return std::abs(places[std::size_t(b)] - places[std::size_t(a)]); };
    // The slope towards the next sample, or nothing if that is in another region.
    const auto slope = [&](int i, int side, int region) -> std::optional<double> {
        const int next = i + side;
        if (next < 0 || next >= count || samples.regions[at(next)] != region) return std::nullopt;
        return (samples.values[at(next)] - samples.values[at(i)]) * side / between(i, next);
    };
    int before = -1; // the last sample present
    for (int i = 0; i < count; ++i) {
        const int region = samples.regions[at(i)];
        if (region == Samples::kNone) continue;
        const int last = before;
        before = i;
        if (last < 0 || i - last >= kPartsApart) continue;
        const int other = samples.regions[at(last)];
        if (other == region) continue;
        const std::optional<double> lower = slope(last, -1, other), upper = slope(i, 1, region);
        const double gap = between(last, i);
        const double a = lower ? *lower : upper.value_or(0), b = upper ? *upper : lower.value_or(0);
        Border::Pairs& pairs = borders[std::minmax(region, other)].by[(lower ? 1u : 0u) + (upper ? 1u : 0u)];
        pairs.jump.push_back(std::abs(samples.values[at(i)] - samples.values[at(last)] - gap * (a + b) / 2));
        pairs.inside.push_back(gap * std::max(std::abs(a), std::abs(b)));
    }
}

Borders bordersOf(const Samples& samples, const Lattice& lattice) {
    Borders borders;
    const glm::ivec3 size = lattice.size;
    const std::array<std::vector<double>, 3> places = samplePlaces(lattice);
    const std::array<std::size_t, 3> steps{1, std::size_t(size.x), std::size_t(size.x) * std::size_t(size.y)};
    const std::size_t stride = std::max<std::size_t>(1, samples.values.size() / kMostSamples);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
        std::size_t line = 0;
        for (int j = 0; j < size[int(v)]; ++j)
            for (int i = 0; i < size[int(u)]; ++i, ++line)
                if (line % stride == 0)
                    alongLine(samples, std::size_t(i) * steps[u] + std::size_t(j) * steps[v], steps[axis], places[axis],
                              borders);
    }
    return borders;
}

double medianOf(std::vector<double> values) {
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

bool jumpsAt(const Border& about, double range) {
    const Border::Pairs& border = about.best();
    const double least = about.leastOfRange() * range;
    const double typical = medianOf(border.inside);
    std::size_t jumps = 0;
    for (std::size_t i = 0; i < border.jump.size(); ++i)
        if (border.jump[i] > kJumpOfInside * std::max(typical, border.inside[i]) + least) ++jumps;
    return double(jumps) >= kShareOfBorder * double(border.jump.size());
}

/// Joins regions without a jump between them, then forms as few parts as possible such that no part contains a jump.
class Grouping {
public:
    explicit Grouping(const std::set<int>& regions) {
        for (const int region : regions) group_[region] = region;
    }
    void join(int a, int b) {
        const int to = std::min(group_[a], group_[b]), from = std::max(group_[a], group_[b]);
        for (auto& [region, group] : group_)
            if (group == from) group = to;
    }
    bool joined(int a, int b) { return group_[a] == group_[b]; }

    std::vector<std::vector<int>> parts(const std::set<std::pair<int, int>>& jumps) {
        std::map<int, std::size_t> partOf; // by group
        std::vector<std::vector<int>> parts;
        for (const auto& [region, group] : group_) {
            if (!partOf.contains(group)) {
                std::set<std::size_t> taken;
                for (const auto& [a, b] : jumps)
                    for (const auto& [own, other] : {std::pair(a, b), std::pair(b, a)})
                        if (group_[own] == group && partOf.contains(group_[other])) taken.insert(partOf[group_[other]]);
                std::size_t part = 0;
                while (taken.contains(part)) ++part;
                partOf[group] = part;
            }
            parts.resize(std::max(parts.size(), partOf[group] + 1));
            parts[partOf[group]].push_back(region);
        }
        return parts;
    }

private:
    std::map<int, int> group_; ///< the smallest label value among the joined regions
};

} // namespace

Parts foundParts(const Dataset& dataset, int parameter, int label, const Progress& progress) {
    const DatasetInfo& info = dataset.info;
    const int last = int(info.times.size()) - 1;
    const std::set<int> times{0, last / 2, last};
    const int components = info.parameters[std::size_t(parameter)].components;
    std::set<int> regions;
    std::set<std::pair<int, int>> meets, jumps;
    double done = 0;
    for (const int time : times) {
        const Field labels = dataset.read(label, 0, time);
        std::vector<Borders> borders;
        double range = 0; // the largest of all components
        for (int c = 0; c < components; ++c) {
            progress.advance(done++ / double(times.size() * std::size_t(components)), "parts");
            const Samples samples = samplesOf(dataset.read(parameter, c, time), labels);
            double lo = std::numeric_limits<double>::infinity(), hi = -lo;
            int known = Samples::kNone;
            for (std::size_t i = 0; i < samples.values.size(); ++i) {
                if (samples.regions[i] == Samples::kNone) continue;
                if (samples.regions[i] != known) regions.insert(known = samples.regions[i]);
                lo = std::min(lo, samples.values[i]);
                hi = std::max(hi, samples.values[i]);
            }
            if (regions.size() > kMostValues) return {};
            range = std::max(range, hi - lo);
            if (regions.size() > 1) borders.push_back(bordersOf(samples, labels.lattice));
        }
        for (const Borders& of : borders)
            for (const auto& [pair, border] : of) {
                meets.insert(pair);
                if (jumpsAt(border, range)) jumps.insert(pair);
            }
    }
    Grouping grouping(regions);
    for (const auto& pair : meets) {
        if (jumps.contains(pair)) continue;
        // Regions already joined through others must not be joined across a jump.
        Grouping trial = grouping;
        trial.join(pair.first, pair.second);
        if (std::none_of(jumps.begin(), jumps.end(),
                         [&](const auto& jump) { return trial.joined(jump.first, jump.second); }))
            grouping = trial;
        else
            jumps.insert(pair);
    }
    const std::vector<std::vector<int>> parts = grouping.parts(jumps);
    return parts.size() > 1 ? Parts{info.parameters[std::size_t(label)].name, parts} : Parts{};
}

std::vector<std::string> findParts(Dataset& dataset, const std::vector<PartsRule>& stated,
                                   const std::vector<std::string>& only, const Progress& progress) {
    std::vector<Parameter>& parameters = dataset.info.parameters;
    const auto label = std::find_if(parameters.begin(), parameters.end(), [](const Parameter& parameter) {
        return parameter.categorical && parameter.components == 1;
    });
    std::vector<std::string> notes;
    if (label == parameters.end()) return notes;
    for (std::size_t p = 0; p < parameters.size(); ++p) {
        Parameter& parameter = parameters[p];
        const bool isStated = std::any_of(stated.begin(), stated.end(), [&](const PartsRule& rule) {
            return rule.parameter == parameter.name || rule.parameter == "*";
        });
        const bool isWanted = only.empty() || std::find(only.begin(), only.end(), parameter.name) != only.end();
        if (parameter.categorical || isStated || !isWanted) continue;
        const Progress own =
            progress.part(double(p) / double(parameters.size()), double(p + 1) / double(parameters.size()));
        parameter.parts = foundParts(dataset, int(p), int(label - parameters.begin()), own);
        if (parameter.parts.count() > 1)
            notes.push_back(parameter.name + ": " + partsText(parameter) + ", found from the data (--parts " +
                            parameter.name + "=joined makes it one)");
    }
    return notes;
}

} // namespace tessera::volume
