// Frames at one place: which of what is said of them tells them apart.
#include "app/importer/dicom/dicom_stack.h"

#include "volume/base/number_text.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace tessera::importer {

namespace {

constexpr int kKinds = 100; ///< behind the axes: the kind of image (magnitude, phase, water, fat)

using Values = std::vector<double>; ///< of each frame

/// Values of an axis, nothing unless all frames have one and they differ.
std::vector<Values> valuesAlong(const std::vector<DicomFrame>& frames, const std::vector<std::size_t>& chosen, int axis,
                                std::vector<std::string>& kinds) {
    Values out;
    if (axis == kKinds) {
        for (const std::size_t f : chosen)
            if (std::ranges::find(kinds, frames[f].kind) == kinds.end()) kinds.push_back(frames[f].kind);
        for (const std::size_t f : chosen)
            out.push_back(double(std::ranges::find(kinds, frames[f].kind) - kinds.begin()));
    } else {
        for (const std::size_t f : chosen) {
            const auto at = frames[f].axes.find(DicomAxis(axis));
            if (at == frames[f].axes.end()) return {};
            out.push_back(at->second);
        }
    }
    if (std::ranges::all_of(out, [&](double value) { return value == out.front(); })) return {};
    return {out};
}

bool tellsApart(const DicomPlaces& places, const std::vector<const Values*>& by) {
    std::set<std::vector<double>> seen;
    for (std::size_t i = 0; i < places.ofFrame.size(); ++i) {
        std::vector<double> key{double(places.ofFrame[i])};
        for (const Values* values : by) key.push_back((*values)[i]);
        if (!seen.insert(key).second) return false;
    }
    return true;
}

std::vector<double> distinct(const Values& values) {
    const std::set<double> all(values.begin(), values.end());
    return {all.begin(), all.end()};
}

std::size_t mostAtOnePlace(const DicomPlaces& places) {
    std::map<std::size_t, std::size_t> count;
    std::size_t most = 0;
    for (const std::size_t place : places.ofFrame) most = std::max(most, ++count[place]);
    return most;
}

/// The position of each frame among those of its place and group, by a value, then by number.
std::vector<std::size_t> ranks(const DicomPlaces& places, const std::vector<std::size_t>& group, const Values& by,
                               const std::vector<DicomFrame>& frames, const std::vector<std::size_t>& chosen) {
    std::vector<std::size_t> order(chosen.size()), rank(chosen.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
        if (by[a] != by[b]) return by[a] < by[b];
        return frames[chosen[a]].number < frames[chosen[b]].number;
    });
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> next;
    for (const std::size_t i : order) rank[i] = next[{places.ofFrame[i], group[i]}]++;
    return rank;
}

/// Times by an axis: its values where they are the same at each place, else ranks, with the values of one place.
void setTimes(DicomOrder& order, int axis, const Values& values, std::size_t most, const DicomPlaces& places,
              const std::vector<DicomFrame>& frames, const std::vector<std::size_t>& chosen) {
    const DicomAxisWords words = wordsOf(DicomAxis(axis));
    order.timeName = words.name;
    order.timeUnit = words.unit;
    const bool clock = axis == int(DicomAxis::Acquired) || axis == int(DicomAxis::Content);
    if (const std::vector<double> all = distinct(values); all.size() == most) {
        order.times = all;
        for (std::size_t i = 0; i < values.size(); ++i)
            order.time[i] = std::size_t(std::ranges::find(all, values[i]) - all.begin());
    } else {
        order.time = ranks(places, order.parameter, values, frames, chosen);
        const std::size_t count = *std::ranges::max_element(order.time) + 1;
        order.times.assign(count, 0);
        std::vector<bool> known(count);
        for (std::size_t i = 0; i < values.size(); ++i) {
            const std::size_t rank = order.time[i];
            if (!known[rank] || values[i] < order.times[rank]) order.times[rank] = values[i];
            known[rank] = true;
        }
        order.notes.push_back("the " + order.timeName +
                              " differs from slice to slice: each time is that of its first slice");
    }
    if (clock) {
        const double begin = order.times.front();
        for (double& time : order.times) time -= begin;
    }
    if (clock) order.timeName = "time";
    if (std::ranges::is_sorted(order.times, std::less_equal<>()) && order.times.size() > 1) return;
    std::iota(order.times.begin(), order.times.end(), 0);
    order.timeName = "image";
    order.timeUnit.clear();
}

/// Positions in time as times, where the file says how far apart they are or when each was taken.
void setTemporal(DicomOrder& order, const std::vector<DicomImage>& images, const std::map<int, Values>& weak,
                 std::size_t most, const DicomPlaces& places, const std::vector<DicomFrame>& frames,
                 const std::vector<std::size_t>& chosen) {
    const double step = images[frames[chosen.front()].image].temporalStep.value_or(0);
    if (step > 0) {
        const double first = order.times.front();
        for (double& time : order.times) time = (time - first) * step;
        order.timeUnit = "ms";
        order.timeName = "time";
        return;
    }
    const auto clock = weak.find(int(DicomAxis::Acquired));
    if (clock == weak.end() || !tellsApart(places, {&clock->second})) return;
    DicomOrder byClock = order;
    setTimes(byClock, clock->first, clock->second, most, places, frames, chosen);
    if (byClock.time == order.time && byClock.times.size() == order.times.size()) order = byClock;
}

/// What of the words of an image type tells a kind apart. Not "phase", which is a name of labels (of materials) here.
std::string wordsOfKind(const std::vector<std::string>& kinds, std::size_t index) {
    const auto split = [](const std::string& text) {
        std::vector<std::string> out(1);
        for (const char c : text)
            if (c == '\\')
                out.emplace_back();
            else
                out.back() += c;
        return out;
    };
    std::string out;
    const std::vector<std::string> own = split(kinds[index]);
    for (std::size_t i = 0; i < own.size(); ++i) {
        const bool same = std::ranges::all_of(kinds, [&](const std::string& other) {
            const std::vector<std::string> words = split(other);
            return i < words.size() && words[i] == own[i];
        });
        if (same || own[i].empty()) continue;
        static constexpr std::pair<const char*, const char*> kLong[] = {
            {"M", "magnitude"}, {"P", "angle"}, {"R", "real"}, {"I", "imaginary"}};
        std::string word = own[i];
        for (const auto& [brief, whole] : kLong)
            if (word == brief) word = whole;
        out += (out.empty() ? "" : " ") + word;
    }
    return out.empty() ? "other" : out;
}

void setParameters(DicomOrder& order, int axis, const Values& values, const std::vector<std::string>& kinds) {
    const std::vector<double> all = distinct(values);
    order.parameters.clear();
    for (const double value : all) {
        if (axis == kKinds) {
            order.parameters.push_back(wordsOfKind(kinds, std::size_t(value)));
            continue;
        }
        const DicomAxisWords words = wordsOf(DicomAxis(axis));
        order.parameters.push_back(std::string(words.name) + " " + exactText(value) + (*words.unit != 0 ? " " : "") +
                                   words.unit);
    }
    for (std::size_t i = 0; i < values.size(); ++i)
        order.parameter[i] = std::size_t(std::ranges::find(all, values[i]) - all.begin());
}

/// Keeps the first of those at each place.
void dropDoubles(DicomOrder& order, const DicomPlaces& places, const std::vector<DicomFrame>& frames,
                 const std::vector<std::size_t>& chosen) {
    const std::vector<std::size_t> rank = ranks(places, order.parameter, Values(chosen.size(), 0), frames, chosen);
    std::size_t left = 0;
    for (std::size_t i = 0; i < rank.size(); ++i)
        if (rank[i] > 0) {
            order.time[i] = kNoFrame;
            ++left;
        }
    order.notes.push_back(std::to_string(left) + (left == 1 ? " slice is" : " slices are") +
                          " there twice: the one with the lower number is shown");
}

} // namespace

DicomOrder orderDicom(const std::vector<DicomImage>& images, const std::vector<DicomFrame>& frames,
                      const std::vector<std::size_t>& chosen, const DicomPlaces& places) {
    DicomOrder order;
    order.times = {0};
    order.time.assign(chosen.size(), 0);
    order.parameter.assign(chosen.size(), 0);
    const std::size_t most = mostAtOnePlace(places);
    if (most == 1) return order;
    const std::size_t extra = chosen.size() - places.at.size();
    const bool fewDoubles = extra * 2 < places.at.size();
    std::vector<std::string> kinds;
    std::map<int, Values> strong, weak;
    for (int axis = 0; axis <= int(DicomAxis::Acquisition); ++axis)
        for (Values& values : valuesAlong(frames, chosen, axis, kinds))
            (axis < int(DicomAxis::Acquired) ? strong : weak)[axis] = std::move(values);
    for (Values& values : valuesAlong(frames, chosen, kKinds, kinds)) strong[kKinds] = std::move(values);
    for (const auto& [axis, values] : strong)
        if (tellsApart(places, {&values})) {
            const bool categories = axis == kKinds || axis == int(DicomAxis::Energy);
            if (fewDoubles && distinct(values).size() > most) continue; // differs between the slices anyhow
            if (categories && distinct(values).size() <= 16)
                setParameters(order, axis, values, kinds);
            else if (!categories)
                setTimes(order, axis, values, most, places, frames, chosen);
            else
                continue;
            if (axis == int(DicomAxis::Temporal)) setTemporal(order, images, weak, most, places, frames, chosen);
            return order;
        }
    if (fewDoubles) {
        dropDoubles(order, places, frames, chosen);
        return order;
    }
    // Two together: the one that is more like a time is the axis of times, the other makes parameters.
    std::map<int, Values> all = strong;
    all.insert(weak.begin(), weak.end());
    for (auto inner = strong.rbegin(); inner != strong.rend(); ++inner)
        for (const auto& [axis, values] : all) {
            const std::size_t parameters = distinct(inner->second).size();
            if (axis == inner->first || axis == kKinds || parameters > 16 || most % parameters != 0 ||
                !tellsApart(places, {&values, &inner->second}))
                continue;
            setParameters(order, inner->first, inner->second, kinds);
            setTimes(order, axis, values, most / parameters, places, frames, chosen);
            if (axis == int(DicomAxis::Temporal)) setTemporal(order, images, {}, most, places, frames, chosen);
            return order;
        }
    for (const auto& [axis, values] : strong)
        order.notes.push_back(axis == kKinds ? "images of several kinds are told apart by their order alone"
                                             : std::string("the ") + wordsOf(DicomAxis(axis)).name +
                                                   " differs between the images at one place, too, and is not shown");
    for (const auto& [axis, values] : weak)
        if (tellsApart(places, {&values})) {
            setTimes(order, axis, values, most, places, frames, chosen);
            return order;
        }
    order.time = ranks(places, order.parameter, Values(chosen.size(), 0), frames, chosen);
    order.times.resize(most);
    std::iota(order.times.begin(), order.times.end(), 0);
    order.timeName = "image";
    order.notes.push_back(
        std::to_string(most) +
        " images lie at each place, and nothing says at what time: they are in order of their numbers");
    return order;
}

} // namespace tessera::importer
