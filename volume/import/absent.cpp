#include "volume/import/absent.h"

#include "volume/base/error.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>

namespace tessera::volume {

namespace {

constexpr std::size_t kMostLabels = 256;
// Rules are suggested only for labels of few values, each with enough samples not to be a coincidence.
constexpr std::size_t kMostSuggested = 32, kFewestSamples = 4;

std::optional<double> parseNumber(std::string_view text) {
    double value = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
    if (parsed.ec != std::errc() || parsed.ptr != text.data() + text.size()) return std::nullopt;
    return value;
}

std::size_t findParameter(const DatasetInfo& info, const std::string& name, const std::string& rule) {
    for (std::size_t i = 0; i < info.parameters.size(); ++i)
        if (info.parameters[i].name == name) return i;
    throw Error("there is no parameter \"" + name + "\"", {}, "--absent " + rule);
}

/// Shares equal masks: returns one seen before instead of a new one. Keeps no mask alive.
class MaskPool {
public:
    std::shared_ptr<const Mask> share(Mask mask) {
        std::size_t hash = 1469598103934665603ull;
        for (const std::uint8_t byte : mask) hash = (hash ^ byte) * 1099511628211ull;
        const std::lock_guard lock(mutex_);
        auto& known = masks_[hash];
        std::erase_if(known, [](const auto& held) { return held.expired(); });
        for (const auto& held : known)
            if (auto same = held.lock(); same && *same == mask) return same;
        auto made = std::make_shared<const Mask>(std::move(mask));
        known.push_back(made);
        return made;
    }

private:
    std::mutex mutex_;
    std::map<std::size_t, std::vector<std::weak_ptr<const Mask>>> masks_;
};

/// A rule with names resolved.
struct Resolved {
    int label = -1; ///< parameter index, -1 = own values
    std::vector<double> values;
};

/// Marks samples of `field` whose value is one of `values` as absent in `mask`.
void markValues(const Field& field, const std::vector<double>& values, Mask& mask) {
    dispatch(field.type, [&]<class T>(T) {
        const auto stored = field.as<T>();
        for (const double value : values) {
            const double wanted = (value - field.offset) / field.scale;
            for (std::size_t i = 0; i < stored.size(); ++i)
                if (double(stored[i]) == wanted || (std::is_same_v<T, float> && float(stored[i]) == float(wanted)))
                    mask[i] = 0;
        }
    });
}

bool markNaN(const Field& field, Mask& mask) {
    if (field.type != ScalarType::F32) return false;
    const auto stored = field.as<float>();
    bool any = false;
    for (std::size_t i = 0; i < stored.size(); ++i)
        if (!std::isfinite(stored[i])) { // an infinity would spread to every sample resampled from it
            mask[i] = 0;
            any = true;
        }
    return any;
}

} // namespace

bool isLabelName(std::string_view name) {
    static constexpr std::array<std::string_view, 14> kWords = {"region",  "regions", "material", "materials", "label",
                                                                "labels",  "id",      "ids",      "zone",      "mat",
                                                                "segment", "phase",   "block",    "part"};
    std::string word;
    bool found = false;
    const auto close = [&] {
        found = found || std::find(kWords.begin(), kWords.end(), word) != kWords.end();
        word.clear();
    };
    for (std::size_t i = 0; i < name.size(); ++i) {
        const auto c = static_cast<unsigned char>(name[i]);
        if (!std::isalpha(c)) {
            close();
            continue;
        }
        if (std::isupper(c) && i > 0 && std::islower(static_cast<unsigned char>(name[i - 1]))) close();
        word += static_cast<char>(std::tolower(c));
    }
    close();
    return found;
}

AbsentRule parseAbsentRule(std::string_view text) {
    const std::string whole(text);
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos || equals == 0 || equals + 1 == text.size())
        throw Error("needs NAME=LABEL:VALUES, NAME=VALUE, NAME=nan or NAME=none", {}, "--absent " + whole);
    AbsentRule rule;
    rule.parameter = std::string(text.substr(0, equals));
    std::string_view right = text.substr(equals + 1);
    if (right == "none") {
        rule.nothing = true;
        return rule;
    }
    if (right == "nan" || right == "NaN") return rule;
    if (const std::size_t colon = right.find(':'); colon != std::string_view::npos) {
        rule.label = std::string(right.substr(0, colon));
        right.remove_prefix(colon + 1);
        if (rule.label.empty()) throw Error("the label has no name", {}, "--absent " + whole);
    }
    while (true) {
        const std::string_view item = right.substr(0, right.find(','));
        if (item.empty()) throw Error("an empty value", {}, "--absent " + whole);
        if (rule.label.empty() && !parseNumber(item))
            throw Error("\"" + std::string(item) + "\" is not a number", {}, "--absent " + whole);
        rule.values.emplace_back(item);
        if (item.size() == right.size()) break;
        right.remove_prefix(item.size() + 1);
    }
    return rule;
}

std::string toText(const AbsentRule& rule) {
    std::string text = rule.parameter + "=";
    if (rule.nothing) return text + "none";
    if (rule.values.empty()) return text + "nan";
    if (!rule.label.empty()) text += rule.label + ":";
    for (std::size_t i = 0; i < rule.values.size(); ++i) text += (i > 0 ? "," : "") + rule.values[i];
    return text;
}

std::vector<AbsentRule> suggestAbsentRules(const Dataset& dataset, const Progress& progress) {
    const DatasetInfo& info = dataset.info;
    const auto labelAt = std::find_if(info.parameters.begin(), info.parameters.end(),
                                      [](const Parameter& parameter) { return parameter.categorical; });
    if (labelAt == info.parameters.end()) return {};
    const int label = static_cast<int>(labelAt - info.parameters.begin());
    const int last = static_cast<int>(info.times.size()) - 1;
    const std::set<int> times{0, last / 2, last};

    // For each parameter: values of the label where a sample that is not 0 was seen, and all values.
    std::vector<std::set<double>> alive(info.parameters.size());
    std::map<double, std::size_t> values; // and how many samples have them
    double done = 0;
    const double total = double(times.size()) * double(info.parameters.size());
    for (const int time : times) {
        const Field region = dataset.read(label, 0, time);
        const std::vector<double> labels = physicalValues(region);
        for (std::size_t i = 0; i < labels.size(); ++i)
            if (region.present(i) && ++values[labels[i]] == 1 && values.size() > kMostSuggested) return {};
        for (std::size_t p = 0; p < info.parameters.size(); ++p) {
            progress.advance(done++ / total, info.parameters[p].name);
            if (info.parameters[p].categorical) continue;
            for (int c = 0; c < info.parameters[p].components; ++c) {
                const Field field = dataset.read(static_cast<int>(p), c, time);
                double lastAlive = std::nan("");
                for (std::size_t i = 0; i < labels.size(); ++i)
                    if (labels[i] != lastAlive && field.present(i) && region.present(i)) {
                        const double value = field.value(i);
                        if (value != 0 && !std::isnan(value)) {
                            lastAlive = labels[i];
                            alive[p].insert(labels[i]);
                        }
                    }
            }
        }
    }
    std::vector<AbsentRule> rules;
    for (std::size_t p = 0; p < info.parameters.size(); ++p) {
        if (info.parameters[p].categorical || alive[p].empty() || alive[p].size() == values.size()) continue;
        AbsentRule rule{info.parameters[p].name, labelAt->name, {}, false};
        for (const auto& [value, samples] : values)
            if (!alive[p].contains(value) && samples >= kFewestSamples)
                rule.values.push_back(std::to_string(static_cast<long long>(value)));
        if (!rule.values.empty()) rules.push_back(std::move(rule));
    }
    return rules;
}

void findLabels(Dataset& dataset) {
    for (std::size_t p = 0; p < dataset.info.parameters.size(); ++p) {
        Parameter& parameter = dataset.info.parameters[p];
        if (!parameter.categorical || !parameter.labels.empty()) continue;
        const Field field = dataset.read(static_cast<int>(p), 0, 0);
        std::set<int> values;
        int last = 0;
        for (std::size_t i = 0; i < field.count() && values.size() <= kMostLabels; ++i) {
            if (!field.present(i)) continue;
            const double value = field.value(i);
            if (!(std::abs(value) < 2e9)) continue;
            const int whole = static_cast<int>(std::lround(value));
            if (!values.empty() && whole == last) continue;
            values.insert(last = whole);
        }
        if (values.size() > kMostLabels) continue;
        for (const int value : values)
            parameter.labels.push_back({value, parameter.name + " " + std::to_string(value)});
    }
}

namespace {

/// The rules of each parameter.
std::vector<std::vector<Resolved>> resolvedRules(const DatasetInfo& info, const std::vector<AbsentRule>& rules) {
    std::vector<std::vector<Resolved>> byParameter(info.parameters.size());
    for (const AbsentRule& rule : rules) {
        if (rule.nothing || rule.values.empty()) continue;
        const std::string text = toText(rule);
        Resolved resolved;
        if (!rule.label.empty()) resolved.label = static_cast<int>(findParameter(info, rule.label, text));
        for (const std::string& value : rule.values) {
            std::optional<double> number = parseNumber(value);
            if (!number && resolved.label >= 0)
                for (const Label& label : info.parameters[std::size_t(resolved.label)].labels)
                    if (label.name == value) number = label.value;
            if (!number) throw Error("\"" + value + "\" is not a value of " + rule.label, {}, "--absent " + text);
            resolved.values.push_back(*number);
        }
        if (rule.parameter != "*") {
            byParameter[findParameter(info, rule.parameter, text)].push_back(resolved);
            continue;
        }
        for (std::size_t p = 0; p < info.parameters.size(); ++p)
            if (!info.parameters[p].categorical) byParameter[p].push_back(resolved);
    }
    return byParameter;
}

} // namespace

Dataset withAbsent(Dataset dataset, const std::vector<AbsentRule>& rules) {
    std::vector<int> components;
    for (const Parameter& parameter : dataset.info.parameters) components.push_back(parameter.components);
    dataset.read = dataset.read.through(
        [byParameter = resolvedRules(dataset.info, rules), components, pool = std::make_shared<MaskPool>()](
            const FrameReader& read, int parameter, int component, int time, SliceRange slices) {
            Field field = read(parameter, component, time, slices);
            const auto p = static_cast<std::size_t>(parameter);
            Mask mask = field.mask ? *field.mask : Mask(field.count(), 1);
            bool any = field.mask != nullptr;
            any = markNaN(field, mask) || any;
            for (const Resolved& rule : byParameter[p]) {
                any = true;
                if (rule.label >= 0) {
                    markValues(read(rule.label, 0, time, slices), rule.values, mask);
                    continue;
                }
                if (components[p] == 1) {
                    markValues(field, rule.values, mask);
                    continue;
                }
                // A vector is absent where all its components have the value.
                Mask kept(field.count(), 0);
                for (int c = 0; c < components[p]; ++c) {
                    Mask own(field.count(), 1);
                    markValues(c == component ? field : read(parameter, c, time, slices), rule.values, own);
                    for (std::size_t i = 0; i < own.size(); ++i) kept[i] |= own[i];
                }
                for (std::size_t i = 0; i < kept.size(); ++i) mask[i] &= kept[i];
            }
            if (any && std::find(mask.begin(), mask.end(), std::uint8_t(0)) == mask.end()) any = false;
            field.mask = any ? pool->share(std::move(mask)) : nullptr;
            return field;
        });
    return dataset;
}

} // namespace tessera::volume
