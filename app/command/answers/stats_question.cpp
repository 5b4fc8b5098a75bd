#include "app/command/answers/stats_question.h"

#include "app/command/command.h"
#include "app/pane/view_parts.h"
#include "app/ui/time_text.h"
#include "app/views/statistics/region_data.h"
#include "volume/base/error.h"
#include "volume/flow/flow_channels.h"

#include <algorithm>
#include <cstdlib>
#include <set>
#include <utility>

namespace tessera::app {

namespace {

std::vector<std::string> splitList(const std::string& text) {
    std::vector<std::string> parts;
    std::string part;
    for (const char c : text + ",")
        if (c != ',')
            part += c;
        else if (!part.empty())
            parts.push_back(std::exchange(part, {}));
    return parts;
}

int channelNamed(const Question& question, const std::string& name) {
    if (const auto channel = question.info().findChannel(name)) return *channel;
    throw Error("there is no parameter \"" + name + "\"; there are " + volume::channelNames(question.info()),
                question.info().name);
}

int regionNamed(const Question& question, const std::string& name) {
    const volume::DatasetInfo& info = question.info();
    if (question.label < 0) throw Error("there is no label to take regions from", info.name, "--regions " + name);
    const volume::Parameter& label = volume::parameterOf(info, question.label);
    if (const auto value = volume::labelValue(label, name)) return *value;
    std::string known;
    for (const volume::Label& each : label.labels)
        known += (known.empty() ? "" : ", ") + (each.name.empty() ? std::to_string(each.value) : each.name);
    throw Error("there is no region \"" + name + "\"; " +
                    (known.empty() ? "regions of " + label.name + " are named by their values" : "there are " + known),
                info.name);
}

/// Finds out what is known as computed, and whether there are bounds for the rest.
void findKnown(Question& question, const StatsOptions& options) {
    const volume::DatasetInfo& info = question.info();
    const auto bounded = [&](int channel) {
        return boundsNumbers(question.from) && errorBound(question.from, info, info.channel(channel)) > 0;
    };
    if (question.balance >= 0) {
        const auto velocity = volume::velocityChannels(info, options.velocity);
        const bool known = std::ranges::all_of(question.times, [&](double time) {
            return isKnown(question.from, info,
                           {question.balance, options.velocity, question.label, question.at(time)});
        });
        question.channels = {question.balance};
        if (velocity) question.channels.insert(question.channels.end(), velocity->begin(), velocity->end());
        question.known.assign(question.channels.size(), known);
        question.errors = !known && std::ranges::any_of(question.channels, bounded);
    } else if (!options.planesAcross()) {
        question.known =
            knownStatistics(question.from, info, question.channels,
                            question.label >= 0 ? info.channel(question.label).name : std::string(), question.times);
        for (std::size_t c = 0; c < question.channels.size(); ++c)
            question.errors = question.errors || (!question.known[c] && bounded(question.channels[c]));
    }
}

/// The requested times in order, each once.
std::vector<double> timesOf(const StatsOptions& options, const volume::DatasetInfo& info) {
    if (options.allTimes) return info.times;
    if (options.time.empty()) return {info.times.back()};
    std::set<double> times;
    for (const double time : options.time) times.insert(timeWithin(info, time));
    return {times.begin(), times.end()};
}

} // namespace

Question questionOf(const StatsRequest& request, const Sources& sources) {
    const StatsOptions& options = request.options;
    Question out{sources.numbers, sources.origin, {}, -1, -1, {}, {}};
    const volume::DatasetInfo& info = out.info();
    for (const std::string& name : splitList(options.of)) out.channels.push_back(channelNamed(out, name));
    if (out.channels.empty()) out.channels = comparedChannels(info);
    if (options.by != "none") {
        const auto label = volume::labelChannel(info, options.by);
        if (!label && !options.by.empty())
            throw Error("there is no label \"" + options.by + "\" to take regions from", info.name);
        out.label = label.value_or(-1);
    }
    if (!options.balance.empty()) out.balance = channelNamed(out, options.balance);
    for (const std::string& name : splitList(options.regions)) out.regions.push_back(regionNamed(out, name));
    if (!options.line.empty()) {
        const std::vector<std::string> parts = splitList(options.line);
        glm::dvec3 ends[2];
        bool numbers = parts.size() == 6;
        for (std::size_t i = 0; numbers && i < 6; ++i) {
            char* end = nullptr;
            ends[i / 3][static_cast<int>(i % 3)] = std::strtod(parts[i].c_str(), &end);
            numbers = *end == '\0';
        }
        if (!numbers) throw Error("needs x,y,z,x,y,z, not \"" + options.line + "\"", "--line");
        out.line = {ends[0], ends[1]};
    }
    if (!options.along.empty() && options.along != "x" && options.along != "y" && options.along != "z")
        throw Error("needs x, y or z, not \"" + options.along + "\"", "--along");
    out.times = timesOf(options, info);
    if (out.times.size() > 1) out.states = stateNames(info, out.times);
    findKnown(out, options);
    return out;
}

std::string Question::origin() const {
    return originText(from, info(), channels, known);
}

} // namespace tessera::app
