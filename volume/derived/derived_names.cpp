#include "volume/derived/derived_names.h"

#include "volume/base/error.h"
#include "volume/base/unit_conversion.h"
#include "volume/derived/expression.h"
#include "volume/derived/other_source.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace tessera::volume {

FormulaNames::FormulaNames(const DatasetInfo& info) {
    static constexpr const char* kCoordinates[] = {"x", "y", "z", "t"};
    for (int i = 0; i < 4; ++i) add(kCoordinates[i], -1 - i);
    const std::vector<Channel> channels = info.channels();
    for (std::size_t i = 0; i < channels.size(); ++i)
        if (channels[i].magnitude) add(info.parameters[std::size_t(channels[i].parameter)].name, int(i));
    for (std::size_t i = 0; i < channels.size(); ++i) add(channels[i].name, int(i));
}

void FormulaNames::add(const std::string& name, int which) {
    names.push_back(name);
    channel.push_back(which);
}

int componentsOf(const DerivedRecipe& recipe) {
    if (const auto* formula = std::get_if<ExpressionRecipe>(&recipe)) {
        try {
            return int(formulaComponents(formula->formula).size());
        } catch (const Error&) { // derivedProblem says so
            return 1;
        }
    }
    return kindOf(recipe).components;
}

namespace {

const Parameter* findVector(const DatasetInfo& info, const std::string& name) {
    for (const Parameter& parameter : info.parameters)
        if (parameter.name == name && parameter.components == 3) return &parameter;
    return nullptr;
}

/// Error message for a recipe; "" if it is valid.
struct Problem {
    const DatasetInfo& info;
    std::string channel(const std::string& name) const {
        return info.findChannel(name) ? "" : "no parameter is named \"" + name + "\"";
    }
    std::string operator()(const ExpressionRecipe& recipe) const {
        try {
            const FormulaNames names(info);
            for (const std::string& formula : formulaComponents(recipe.formula)) {
                const Expression check(formula, names.names, OtherTimes::Allowed);
                for (const Expression::Input& input : check.inputs())
                    if (input.at)
                        if (const std::string problem =
                                timeProblem(*input.at, info, names.channel[std::size_t(input.name)]);
                            !problem.empty())
                            throw Error(problem, {}, "position " + std::to_string(input.position));
            }
            return {};
        } catch (const Error& error) {
            return error.what();
        }
    }
    std::string vector(const std::string& name) const {
        return findVector(info, name) ? "" : "no vector is named \"" + name + "\"";
    }
    std::string operator()(const auto& recipe) const {
        std::string problem;
        forEachInput(recipe, [&](const std::string& name, bool isVector) {
            if (problem.empty()) problem = isVector ? vector(name) : channel(name);
        });
        return problem;
    }
    std::string operator()(const SmoothRecipe& recipe) const {
        if (!(recipe.width >= 0.1 && recipe.width <= 16)) return "the width must be between 0.1 and 16 cells";
        return channel(recipe.channel);
    }
    std::string operator()(const DifferenceRecipe& recipe) const {
        if (std::string problem = channel(recipe.channel); !problem.empty()) return problem;
        const int of = *info.findChannel(recipe.channel);
        if (std::string problem = timeProblem(recipe.reference(), info, of); !problem.empty()) return problem;
        if (recipe.from != OtherTime::Other) return {};
        const std::vector<Channel> channels = info.channels();
        const Channel &own = channels[std::size_t(of)], &other = channels[std::size_t(*otherChannel(info, of))];
        if (unitConversion(other.unit, own.unit)) return {};
        return own.name + " is in " + (own.unit.empty() ? "no unit" : own.unit) + ", in the other data in " +
               (other.unit.empty() ? "no unit" : other.unit) + ": they cannot be subtracted";
    }
};

/// Names of the parameters that a recipe uses.
struct Inputs {
    const DatasetInfo& info;
    std::vector<std::string> operator()(const ExpressionRecipe& recipe) const {
        const FormulaNames names(info);
        std::vector<std::string> out;
        for (const std::string& text : formulaComponents(recipe.formula)) {
            const Expression formula(text, names.names, OtherTimes::Allowed);
            for (const Expression::Input& input : formula.inputs())
                if (names.channel[std::size_t(input.name)] >= 0) out.push_back(names.names[std::size_t(input.name)]);
        }
        return out;
    }
    std::vector<std::string> operator()(const auto& recipe) const {
        std::vector<std::string> out;
        forEachInput(recipe, [&](const std::string& name, bool) { out.push_back(name); });
        return out;
    }
};

/// Regions that belong to one part in both labels.
Parts refined(const Parts& a, const Parts& b) {
    if (a.count() == 1 || a.label.empty()) return b;
    if (b.count() == 1 || b.label != a.label) return a;
    std::map<std::pair<std::size_t, std::size_t>, std::vector<int>> groups;
    groups[{0, 0}] = {}; // values without a region
    std::set<int> values;
    for (const Parts* parts : {&a, &b})
        for (const std::vector<int>& region : parts->regions) values.insert(region.begin(), region.end());
    for (const int value : values) groups[{a.partOf(value), b.partOf(value)}].push_back(value);
    Parts out{a.label, {}};
    for (auto& [which, regions] : groups) out.regions.push_back(std::move(regions));
    return out;
}

/// For a label itself: each value is a part.
Parts partsOfLabel(const Parameter& label) {
    constexpr double kMost = 64;
    if (label.ranges.empty() || label.ranges[0].hi - label.ranges[0].lo >= kMost) return {};
    Parts parts{label.name, {}};
    for (int value = int(label.ranges[0].lo); value <= int(label.ranges[0].hi); ++value)
        parts.regions.push_back({value});
    return parts;
}

} // namespace

PiecesQuery piecesQuery(const PiecesRecipe& recipe, const DatasetInfo& info, const BrickGrid& grid) {
    return {.channel = *info.findChannel(recipe.channel),
            .value = recipe.value,
            .side = recipe.side,
            .leastVolume = recipe.leastVolume,
            .level = piecesLevel(grid, info.times.size())};
}

Parts partsOf(const DerivedRecipe& recipe, const DatasetInfo& info) {
    if (kindOf(recipe).categorical) return {};
    const std::vector<Channel> channels = info.channels();
    Parts parts;
    for (const std::string& name : std::visit(Inputs{info}, recipe))
        if (const auto channel = info.findChannel(name)) {
            const Parameter& own = info.parameters[std::size_t(channels[std::size_t(*channel)].parameter)];
            parts = refined(parts, own.categorical ? partsOfLabel(own) : own.parts);
        }
    return parts;
}

bool isComputedBetween(const DerivedRecipe& recipe, const DatasetInfo& info, const std::function<bool(int)>& computed) {
    if (!kindOf(recipe).linear) return true;
    bool any = false;
    std::visit(
        [&](const auto& own) {
            forEachInput(own, [&](const std::string& name, bool isVector) {
                const Parameter* const vector = isVector ? findVector(info, name) : nullptr;
                const std::optional<int> channel =
                    vector ? info.channelIndex(int(vector - info.parameters.data()), 0) : info.findChannel(name);
                any = any || (channel && computed(*channel));
            });
        },
        recipe);
    return any;
}

std::string derivedProblem(const DerivedParameter& parameter, const DatasetInfo& info) {
    if (parameter.name.empty()) return "it needs a name";
    if (parameter.name.find('`') != std::string::npos) return "the name must not contain a back quote";
    if (std::any_of(info.parameters.begin(), info.parameters.end(),
                    [&](const Parameter& own) { return own.name == parameter.name; }) ||
        info.findChannel(parameter.name))
        return "the name \"" + parameter.name + "\" is already used";
    return std::visit(Problem{info}, parameter.recipe);
}

std::vector<std::string> derivedProblems(const std::vector<DerivedParameter>& parameters, DatasetInfo info) {
    std::vector<std::string> problems;
    for (const DerivedParameter& each : parameters) {
        problems.push_back(derivedProblem(each, info));
        if (!problems.back().empty()) continue;
        Parameter parameter;
        parameter.name = each.name;
        parameter.components = componentsOf(each.recipe);
        parameter.categorical = kindOf(each.recipe).categorical;
        info.parameters.push_back(std::move(parameter));
    }
    return problems;
}

} // namespace tessera::volume
