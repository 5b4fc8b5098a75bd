#include "app/command/command.h"
#include "app/data/format.h"
#include "app/described/describe_cli.h"
#include "codec/pack/pack.h"
#include "volume/base/byte_text.h"
#include "volume/base/terminal.h"
#include "volume/export/export.h"
#include "volume/synthetic/branching.h"
#include "volume/synthetic/bubbles.h"
#include "volume/synthetic/casting.h"
#include "volume/synthetic/fuel_cell.h"
#include "volume/synthetic/marschner_lobb.h"
#include "volume/synthetic/membrane.h"
#include "volume/synthetic/models.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

namespace tessera::app {

namespace {

struct GenerateRequest {
    std::string model, output, size;
    std::optional<int> times;
    std::vector<std::string> settings;
    bool even = false, list = false;
    codec::PackOptions options;
};

// The number, if it is the whole text.
std::optional<double> wholeNumber(const std::string& text) {
    try {
        std::size_t used = 0;
        const double value = std::stod(text, &used);
        if (used == text.size() && !text.empty()) return value;
    } catch (const std::exception&) {
    }
    return std::nullopt;
}

std::map<std::string, double> modelSettings(const GenerateRequest& request) {
    std::map<std::string, double> settings;
    if (!request.size.empty()) {
        std::string rest = request.size;
        for (const char* key : {"nx", "ny", "nz"}) {
            const std::size_t end = std::string(key) == "nz" ? std::string::npos : rest.find('x');
            const auto value = wholeNumber(rest.substr(0, end));
            if (!value || (std::string(key) != "nz" && end == std::string::npos))
                throw CLI::ValidationError("--size", "expected NXxNYxNZ, not \"" + request.size + "\"");
            settings[key] = *value;
            if (end != std::string::npos) rest = rest.substr(end + 1);
        }
    }
    if (request.times) settings["times"] = *request.times;
    if (request.even) settings["even"] = 1;
    for (const std::string& setting : request.settings) {
        const std::size_t equals = setting.find('=');
        const auto value = equals == std::string::npos ? std::nullopt : wholeNumber(setting.substr(equals + 1));
        if (!value) throw CLI::ValidationError("--set", "expected KEY=NUMBER, not \"" + setting + "\"");
        settings[setting.substr(0, equals)] = *value;
    }
    return settings;
}

struct PrintSetting {
    template <class T> void operator()(const T& value, const FieldInfo& info) const {
        std::string range;
        if (info.range) range = numberText(info.range->lo) + " .. " + numberText(info.range->hi);
        say("%-22s %-9s %-18s %-5s %s\n", std::string(info.key).c_str(), numberText(double(value)).c_str(),
            range.c_str(), std::string(info.unit).c_str(), std::string(info.doc).c_str());
    }
};

void listSettings(const std::string& model) {
    say("%-22s %-9s %-18s %-5s %s\n", "setting", "default", "range", "unit", "meaning");
    const volume::FuelCellSettings cell;
    const volume::MarschnerLobbSettings signal;
    const volume::CastingSettings casting;
    const volume::MembraneSettings membrane;
    const volume::BubblesSettings bubbles;
    const volume::BranchingSettings pulse;
    if (model == "marschner-lobb")
        volume::MarschnerLobbSettings::describe(signal, PrintSetting());
    else if (model == "casting")
        volume::CastingSettings::describe(casting, PrintSetting());
    else if (model == "branching-pulse")
        volume::BranchingSettings::describe(pulse, PrintSetting());
    else if (model == "membrane")
        volume::MembraneSettings::describe(membrane, PrintSetting());
    else if (model == "bubbles")
        volume::BubblesSettings::describe(bubbles, PrintSetting());
    else
        volume::FuelCellSettings::describe(cell, PrintSetting());
}

void run(const GenerateRequest& request) {
    const std::map<std::string, double> settings = modelSettings(request);
    if (request.list) {
        listSettings(request.model);
        return;
    }
    const bool archive = hasEnding(request.output, ".tsr");
    bool known = archive;
    for (const char* ending : {".vti", ".vtr", ".pvd", ".raw", ".json", ".nrrd"})
        known |= hasEnding(request.output, ending);
    if (!known)
        throw Error("cannot write this kind of file; use a name ending in .tsr, .vti, .vtr, .pvd, .raw or .nrrd",
                    request.output);

    const Progress progress = terminalProgress("generate");
    volume::Dataset dataset = volume::makeModel(request.model, settings, progress.part(0, 0.7));
    if (archive) {
        const codec::PackSummary summary = codec::pack(dataset, request.options, request.output, progress.part(0.7, 1));
        say("%s: %s of %s\n", request.output.c_str(), textOfBytes(double(summary.archiveBytes)).c_str(),
            textOfBytes(double(summary.sourceBytes)).c_str());
        return;
    }
    for (const std::string& file : volume::exportDataset(dataset, {}, request.output, progress.part(0.7, 1)))
        say("%s\n", file.c_str());
}

} // namespace

void addGenerateCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand("generate", "Compute a built-in data set and write it");
    const auto request = std::make_shared<GenerateRequest>();
    command
        ->add_option(
            "MODEL", request->model,
            "fuel-cell, planted (the fuel cell with added events of known place), marschner-lobb, casting "
            "(a CT scan), membrane (layers of known integrals, with uneven spacing), bubbles (which rise, merge "
            "and split at known times) or branching-pulse (a pulse that moves through a pipe and parts into two)")
        ->required()
        ->check(CLI::IsMember(volume::modelNames()));
    CLI::Option* output =
        command->add_option("-o,--output", request->output, "File to write: .tsr, .vti or .vtr (.pvd), .raw or .nrrd");
    command->add_option("--size", request->size, "Samples, e.g. 11x13x101")->type_name("NXxNYxNZ");
    command->add_option("--times", request->times, "Number of times");
    command->add_flag("--even", request->even, "fuel-cell: cells of one height, as in versions before (--set even=1)");
    command->add_option("--set", request->settings, "A setting of the model")->type_name("KEY=NUMBER");
    command->add_flag("--list", request->list, "Show the settings of the model instead")->excludes(output);
    addDescribed(*command, request->options);
    command->callback([request, output] {
        if (!request->list && output->count() == 0) throw CLI::RequiredError("--output");
        run(*request);
    });
}

} // namespace tessera::app
