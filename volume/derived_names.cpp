#include "volume/derived_names.h"

#include "volume/error.h"
#include "volume/expression.h"

#include <algorithm>

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
    const bool vector = std::holds_alternative<GradientRecipe>(recipe) ||
                        std::holds_alternative<VorticityRecipe>(recipe) ||
                        std::holds_alternative<PositionRecipe>(recipe);
    return vector ? 3 : 1;
}

namespace {

const Parameter* findVector(const DatasetInfo& info, const std::string& name) {
    for (const Parameter& parameter : info.parameters)
        if (parameter.name == name && parameter.components == 3) return &parameter;
    return nullptr;
}

/// What is wrong with a recipe; "" if nothing is.
struct Problem {
    const DatasetInfo& info;
    std::string channel(const std::string& name) const {
        return info.findChannel(name) ? "" : "no parameter is named \"" + name + "\"";
    }
    std::string operator()(const ExpressionRecipe& recipe) const {
        try {
            const FormulaNames names(info);
            const Expression check(recipe.formula, names.names);
            return {};
        } catch (const Error& error) {
            return error.what();
        }
    }
    std::string operator()(const MagnitudeRecipe& recipe) const {
        for (const std::string& name : {recipe.x, recipe.y, recipe.z})
            if (const std::string problem = channel(name); !problem.empty()) return problem;
        return {};
    }
    std::string vector(const std::string& name) const {
        return findVector(info, name) ? "" : "no vector is named \"" + name + "\"";
    }
    std::string operator()(const GradientRecipe& recipe) const { return channel(recipe.channel); }
    std::string operator()(const DivergenceRecipe& recipe) const { return vector(recipe.vector); }
    std::string operator()(const VorticityRecipe& recipe) const { return vector(recipe.vector); }
    std::string operator()(const DeviationRecipe& recipe) const { return channel(recipe.channel); }
    std::string operator()(const SmoothRecipe& recipe) const {
        if (!(recipe.width >= 0.1 && recipe.width <= 16)) return "the width must be between 0.1 and 16 cells";
        return channel(recipe.channel);
    }
    std::string operator()(const PositionRecipe&) const { return {}; }
    std::string operator()(const TimeRecipe&) const { return {}; }
};

} // namespace

std::string derivedProblem(const DerivedParameter& parameter, const DatasetInfo& info) {
    if (parameter.name.empty()) return "it needs a name";
    if (parameter.name.find('`') != std::string::npos) return "the name must not hold a back quote";
    if (std::any_of(info.parameters.begin(), info.parameters.end(),
                    [&](const Parameter& own) { return own.name == parameter.name; }) ||
        info.findChannel(parameter.name))
        return "the name \"" + parameter.name + "\" is taken";
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
        info.parameters.push_back(std::move(parameter));
    }
    return problems;
}

} // namespace tessera::volume
