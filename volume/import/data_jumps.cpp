#include "volume/import/data_jumps.h"

#include "volume/base/error.h"
#include "volume/field/part_masks.h"
#include "volume/import/find_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <set>
#include <utility>

namespace tessera::volume {

namespace {

constexpr double kJumpOfBeside = 3, kLeastJump = 0.01, kLeastJumpOfOneSide = 0.1, kShareOfJumpBeside = 0.5;
constexpr std::size_t kLeastRegion = 27; // samples

using IndexPair = std::pair<std::size_t, std::size_t>;

/// Calls `visit(first index, distance between samples, count)` for every line of samples along an axis.
template <class Visit> void forLines(glm::ivec3 size, int axis, const Visit& visit) {
    const std::array<std::size_t, 3> steps{1, std::size_t(size.x), std::size_t(size.x) * std::size_t(size.y)};
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int j = 0; j < size[v]; ++j)
        for (int i = 0; i < size[u]; ++i)
            visit(std::size_t(i) * steps[std::size_t(u)] + std::size_t(j) * steps[std::size_t(v)],
                  steps[std::size_t(axis)], size[axis]);
}

/// Separations between neighbouring samples of a frame.
struct Cuts {
    std::vector<std::uint8_t> after; ///< by sample, bit `axis`: separated from the next one along that axis
    std::vector<IndexPair> acrossGaps;
};

/// Separations by one component; `present` is of all components.
class ComponentCuts {
public:
    ComponentCuts(glm::ivec3 size, std::vector<double> values, const std::vector<bool>& present, Cuts& cuts)
        : size_(size), values_(std::move(values)), present_(present), cuts_(cuts), jump_(values_.size()) {
        double lo = std::numeric_limits<double>::infinity(), hi = -lo;
        for (std::size_t i = 0; i < values_.size(); ++i)
            if (present_[i]) lo = std::min(lo, values_[i]), hi = std::max(hi, values_[i]);
        if (!(hi > lo)) return;
        range_ = hi - lo;
        for (int axis = 0; axis < 3; ++axis)
            forLines(size_, axis,
                     [&](std::size_t first, std::size_t step, int count) { alongLine(axis, first, step, count); });
        besideJumps();
    }

private:
    void alongLine(int axis, std::size_t first, std::size_t step, int count) {
        const auto at = [&](int i) { return first + std::size_t(i) * step; };
        const auto there = [&](int i) { return i >= 0 && i < count && present_[at(i)]; };
        int last = -1;
        for (int i = 0; i < count; ++i) {
            if (!there(i)) continue;
            const int before = std::exchange(last, i), gap = i - before;
            if (before < 0 || gap >= kPartsApart) continue;
            const bool lower = there(before - 1), upper = there(i + 1);
            if (!lower && !upper) continue;
            const double a = lower ? values_[at(before)] - values_[at(before - 1)] : 0,
                         b = upper ? values_[at(i + 1)] - values_[at(i)] : 0;
            const double slope = lower && upper ? (a + b) / 2 : a + b;
            const double jump = std::abs(values_[at(i)] - values_[at(before)] - gap * slope);
            const double least = (lower && upper ? kLeastJump : kLeastJumpOfOneSide) * range_;
            if (!(jump > kJumpOfBeside * gap * std::max(std::abs(a), std::abs(b)) + least)) continue;
            if (gap > 1) {
                cuts_.acrossGaps.emplace_back(at(before), at(i));
                continue;
            }
            cuts_.after[at(before)] = std::uint8_t(cuts_.after[at(before)] | 1u << axis);
            for (const std::size_t end : {at(before), at(i)}) jump_[end] = std::max(jump_[end], float(jump));
        }
    }

    /// Beside a larger jump, half its size is enough: in a region one sample thick neither side can be extrapolated.
    void besideJumps() {
        std::vector<float> beside = jump_;
        for (int axis = 0; axis < 3; ++axis)
            forLines(size_, axis, [&](std::size_t first, std::size_t step, int count) {
                for (int i = 0; i + 1 < count; ++i) {
                    const std::size_t a = first + std::size_t(i) * step, b = a + step;
                    beside[a] = std::max(beside[a], jump_[b]);
                    beside[b] = std::max(beside[b], jump_[a]);
                }
            });
        for (int axis = 0; axis < 3; ++axis)
            forLines(size_, axis, [&](std::size_t first, std::size_t step, int count) {
                for (int i = 0; i + 1 < count; ++i) {
                    const std::size_t a = first + std::size_t(i) * step, b = a + step;
                    const double near = std::max(beside[a], beside[b]);
                    if (near > 0 && present_[a] && present_[b] &&
                        std::abs(values_[b] - values_[a]) > kShareOfJumpBeside * near)
                        cuts_.after[a] = std::uint8_t(cuts_.after[a] | 1u << axis);
                }
            });
    }

    glm::ivec3 size_;
    std::vector<double> values_;
    const std::vector<bool>& present_;
    Cuts& cuts_;
    std::vector<float> jump_; ///< by sample: the largest jump to a neighbour
    double range_ = 0;
};

/// Disjoint sets of samples; the smallest index represents a set.
class Sets {
public:
    explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), std::size_t(0)); }
    std::size_t of(std::size_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::size_t a, std::size_t b) {
        a = of(a);
        b = of(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<std::size_t> parent_;
};

/// Calls `visit(a, b, separated)` for all pairs of present neighbours.
template <class Visit>
void forNeighbours(glm::ivec3 size, const std::vector<bool>& present, const Cuts& cuts, const Visit& visit) {
    for (int axis = 0; axis < 3; ++axis)
        forLines(size, axis, [&](std::size_t first, std::size_t step, int count) {
            for (int i = 0; i + 1 < count; ++i) {
                const std::size_t a = first + std::size_t(i) * step, b = a + step;
                if (present[a] && present[b]) visit(a, b, (cuts.after[a] >> axis & 1) != 0);
            }
        });
}

/// Merges small sets into the one they share most borders with, the smallest first.
void joinSmallSets(glm::ivec3 size, const std::vector<bool>& present, const Cuts& cuts, Sets& sets) {
    std::vector<std::uint32_t> counts(present.size());
    for (std::size_t i = 0; i < present.size(); ++i)
        if (present[i]) ++counts[sets.of(i)];
    std::map<std::size_t, std::map<std::size_t, std::size_t>> touching; // by small set, how often which other
    forNeighbours(size, present, cuts, [&](std::size_t a, std::size_t b, bool apart) {
        if (!apart) return;
        a = sets.of(a);
        b = sets.of(b);
        if (a == b) return;
        if (counts[a] < kLeastRegion) ++touching[a][b];
        if (counts[b] < kLeastRegion) ++touching[b][a];
    });
    std::vector<IndexPair> small; // count, set
    for (const auto& [set, others] : touching) small.emplace_back(counts[set], set);
    std::sort(small.begin(), small.end());
    for (const auto& [count, set] : small) {
        std::size_t most = 0, to = set;
        for (const auto& [other, times] : touching[set])
            if (times > most && sets.of(other) != sets.of(set)) most = times, to = other;
        sets.join(set, to);
    }
}

} // namespace

std::vector<std::uint8_t> regionsOfJumps(std::span<const Field> components) {
    const Lattice& lattice = components.front().lattice;
    if (lattice.kind != LatticeKind::CC) throw Error("jumps can be found on regular grids only");
    std::vector<bool> present(lattice.count(), true);
    std::vector<std::vector<double>> values;
    for (const Field& field : components) {
        values.push_back(physicalValues(field));
        for (std::size_t i = 0; i < present.size(); ++i)
            if (!field.present(i) || !std::isfinite(values.back()[i])) present[i] = false;
    }
    Cuts cuts{std::vector<std::uint8_t>(present.size()), {}};
    for (std::vector<double>& of : values) ComponentCuts(lattice.size, std::move(of), present, cuts);

    Sets sets(present.size());
    forNeighbours(lattice.size, present, cuts, [&](std::size_t a, std::size_t b, bool apart) {
        if (!apart) sets.join(a, b);
    });
    joinSmallSets(lattice.size, present, cuts, sets);
    std::map<std::size_t, std::set<std::size_t>> touching;
    const auto touch = [&](std::size_t a, std::size_t b) {
        a = sets.of(a);
        b = sets.of(b);
        if (a == b) return;
        touching[a].insert(b);
        touching[b].insert(a);
    };
    forNeighbours(lattice.size, present, cuts, [&](std::size_t a, std::size_t b, bool apart) {
        if (apart) touch(a, b);
    });
    for (const auto& [a, b] : cuts.acrossGaps) touch(a, b);
    std::map<std::size_t, std::uint8_t> numbers; // of sets that touch others, in the order of their first samples
    for (const auto& [set, others] : touching) {
        std::set<std::uint8_t> taken;
        for (const std::size_t other : others)
            if (const auto known = numbers.find(other); known != numbers.end()) taken.insert(known->second);
        std::uint8_t number = 1;
        while (taken.contains(number)) ++number;
        if (number > kMostParts) throw Error("its jumps separate more than " + std::to_string(kMostParts) + " parts");
        numbers[set] = number;
    }
    std::vector<std::uint8_t> out(present.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (!present[i]) continue;
        const auto known = numbers.find(sets.of(i));
        out[i] = known != numbers.end() ? known->second : std::uint8_t(1);
    }
    return out;
}

namespace {

/// Serves frames of the generated labels, which come after the parameters of the files.
class JumpLabels {
public:
    JumpLabels(const Dataset& dataset, std::vector<int> of) : read_(dataset.read), of_(std::move(of)) {
        for (const int parameter : of_)
            components_.push_back(dataset.info.parameters[std::size_t(parameter)].components);
    }
    /// `label`: its number among them.
    const Field& at(std::size_t label, int time) {
        if (label_ == label && time_ == time) return frame_;
        std::vector<Field> components;
        for (int c = 0; c < components_[label]; ++c) components.push_back(read_(of_[label], c, time));
        const std::vector<std::uint8_t> regions = regionsOfJumps(components);
        frame_ = makeField(components.front().lattice, ScalarType::U8);
        std::ranges::copy(regions, frame_.as<std::uint8_t>().begin());
        if (std::ranges::find(regions, std::uint8_t(0)) != regions.end()) {
            Mask mask(regions.size());
            std::ranges::transform(regions, mask.begin(), [](std::uint8_t region) { return region != 0 ? 1 : 0; });
            frame_.mask = std::make_shared<const Mask>(std::move(mask));
        }
        label_ = label;
        time_ = time;
        return frame_;
    }

private:
    FrameReader read_;
    std::vector<int> of_, components_;
    std::size_t label_ = 0;
    int time_ = -1;
    Field frame_;
};

/// The parameters whose last rule says jumps.
std::vector<int> parametersOfJumps(const DatasetInfo& info, const std::vector<PartsRule>& rules) {
    std::vector<int> out;
    for (const PartsRule& rule : rules)
        if (rule.jumps && rule.parameter != "*" &&
            std::ranges::find(info.parameters, rule.parameter, &Parameter::name) == info.parameters.end())
            throw Error("there is no parameter \"" + rule.parameter + "\"", {}, "--parts " + rule.parameter + "=jumps");
    for (std::size_t p = 0; p < info.parameters.size(); ++p) {
        bool jumps = false;
        for (const PartsRule& rule : rules)
            if (rule.parameter == info.parameters[p].name || (rule.parameter == "*" && !info.parameters[p].categorical))
                jumps = rule.jumps;
        if (!jumps) continue;
        if (info.parameters[p].categorical)
            throw Error("a label has no parts", {}, "--parts " + info.parameters[p].name + "=jumps");
        out.push_back(int(p));
    }
    return out;
}

} // namespace

Dataset withJumps(Dataset data, const std::vector<PartsRule>& rules, std::vector<std::string>& notes,
                  const Progress& progress) {
    const std::vector<int> of = parametersOfJumps(data.info, rules);
    if (of.empty()) return data;
    const auto labels = std::make_shared<JumpLabels>(data, of);
    const std::size_t own = data.info.parameters.size(), times = data.info.times.size();
    std::vector<std::size_t> kept; // labels that separate anything
    for (std::size_t n = 0; n < of.size(); ++n) {
        Parameter& parameter = data.info.parameters[std::size_t(of[n])];
        const std::string name = parameter.name, label = jumpsLabel(name);
        if (std::ranges::find(data.info.parameters, label, &Parameter::name) != data.info.parameters.end())
            throw Error("there is a parameter \"" + label + "\" already", {}, "--parts " + name + "=jumps");
        int count = 1;
        for (std::size_t t = 0; t < times; ++t) {
            progress.advance((double(n) + double(t) / double(times)) / double(of.size()), "jumps");
            try {
                for (const std::uint8_t region : labels->at(n, int(t)).as<std::uint8_t>())
                    count = std::max(count, int(region));
            } catch (const Cancelled&) {
                throw;
            } catch (const Error& error) {
                throw Error(error.what(), {}, "--parts " + name + "=jumps");
            }
        }
        if (count < 2) {
            notes.push_back(name + ": no jumps enclose a region, so it has one part");
            continue;
        }
        parameter.parts = {label, {}};
        Parameter added{label, "", 1, ScalarType::U8, true, {}, {}, {}, false};
        for (int value = 1; value <= count; ++value) {
            parameter.parts.regions.push_back({value});
            added.labels.push_back({value, "part " + std::to_string(value)});
        }
        notes.push_back(name + ": " + partsText(parameter));
        kept.push_back(n);
        data.info.parameters.push_back(std::move(added));
    }
    data.read = data.read.through(
        [labels, kept, own](const FrameReader& read, int parameter, int component, int time, SliceRange slices) {
            if (std::size_t(parameter) < own) return read(parameter, component, time, slices);
            return slicesOf(labels->at(kept[std::size_t(parameter) - own], time), slices);
        });
    return data;
}

} // namespace tessera::volume
