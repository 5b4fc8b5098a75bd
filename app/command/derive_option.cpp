#include "app/command/derive_option.h"

#include "volume/base/error.h"
#include "volume/reconstruct/sample_grid.h"
#include "volume/sources/memory_source.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

namespace tessera::app {

namespace {

std::string trimmed(const std::string& text) {
    const auto first = text.find_first_not_of(" \t");
    if (first == std::string::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

} // namespace

volume::DerivedParameter parseDerived(const std::string& text) {
    const auto equals = text.find('=');
    std::string name = trimmed(text.substr(0, equals)), unit;
    if (const auto bracket = name.rfind('['); name.ends_with(']') && bracket != std::string::npos) {
        unit = trimmed(name.substr(bracket + 1, name.size() - bracket - 2));
        name = trimmed(name.substr(0, bracket));
    }
    if (equals == std::string::npos || name.empty())
        throw CLI::ValidationError("--derive", "needs NAME [UNIT] = FORMULA, not \"" + text + "\"");
    return {name, unit, volume::ExpressionRecipe{trimmed(text.substr(equals + 1))}};
}

void addDeriveOption(CLI::App& command, std::vector<volume::DerivedParameter>& parameters) {
    command
        .add_option_function<std::vector<std::string>>(
            "--derive",
            [&parameters](const std::vector<std::string>& texts) {
                for (const std::string& text : texts) parameters.push_back(parseDerived(text));
            },
            "A parameter computed from others, e.g. \"dT [K] = T - at(T, first)\"; may be repeated")
        ->type_name("NAME [UNIT] = FORMULA")
        ->expected(1)
        ->take_all();
}

void checkDerived(const std::vector<volume::DerivedParameter>& parameters, const volume::DatasetInfo& info) {
    const std::vector<std::string> problems = volume::derivedProblems(parameters, info);
    for (std::size_t i = 0; i < problems.size(); ++i)
        if (!problems[i].empty()) throw Error(problems[i], parameters[i].name);
}

volume::Field fieldOf(const volume::BrickSource& source, int parameter, int component, int time) {
    const std::vector<volume::Channel> channels = source.info().channels();
    const auto found = std::find_if(channels.begin(), channels.end(), [&](const volume::Channel& own) {
        return own.parameter == parameter && own.component == component;
    });
    volume::SampleGrid samples = volume::readSamples(source, int(found - channels.begin()), time, 0);
    volume::Field field = volume::makeField(samples.lattice, volume::ScalarType::F32);
    std::copy(samples.values.begin(), samples.values.end(), field.as<float>().begin());
    if (!samples.present.empty()) field.mask = std::make_shared<const volume::Mask>(std::move(samples.present));
    return field;
}

volume::Dataset withDerived(volume::Dataset dataset, const std::vector<volume::DerivedParameter>& parameters,
                            const Progress& progress) {
    if (parameters.empty()) return dataset;
    const int own = int(dataset.info.parameters.size());
    std::shared_ptr<const volume::BrickSource> source =
        volume::makeMemorySource(dataset, {.lattice = dataset.info.lattice.kind});
    for (std::size_t i = 0; i < parameters.size(); ++i)
        source = volume::derive(
            source, parameters[i],
            progress.part(double(i) / double(parameters.size()), double(i + 1) / double(parameters.size())));
    volume::Dataset made;
    made.info = dataset.info;
    const std::vector<volume::Parameter>& all = source->info().parameters;
    made.info.parameters.insert(made.info.parameters.end(), all.begin() + own, all.end());
    made.read = [read = dataset.read, source, own](int parameter, int component, int time) {
        return parameter < own ? read(parameter, component, time) : fieldOf(*source, parameter, component, time);
    };
    return made;
}

} // namespace tessera::app
