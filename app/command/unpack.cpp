#include "codec/unpack.h"
#include "app/command/command.h"
#include "app/command/format.h"
#include "volume/export.h"

#include <algorithm>
#include <cstdio>
#include <memory>

namespace tessera::app {

namespace {

struct Request {
    std::string input, output;
    std::vector<std::string> parameters;
    std::vector<double> times;
    int level = 0;
};

volume::ExportSelection select(const Request& request, const volume::DatasetInfo& info) {
    volume::ExportSelection selection;
    for (const std::string& wanted : request.parameters) {
        const auto found = info.findChannel(wanted);
        if (!found) throw Error("there is no parameter \"" + wanted + "\"", request.input);
        const int parameter = info.channels()[std::size_t(*found)].parameter;
        if (std::find(selection.parameters.begin(), selection.parameters.end(), parameter) ==
            selection.parameters.end())
            selection.parameters.push_back(parameter);
        if (request.parameters.size() == 1 && hasEnding(request.output, ".nrrd")) selection.channel = *found;
    }
    for (const double time : request.times) selection.times.push_back(info.nearestTime(time));
    std::sort(selection.times.begin(), selection.times.end());
    selection.times.erase(std::unique(selection.times.begin(), selection.times.end()), selection.times.end());
    return selection;
}

void run(const Request& request) {
    const auto archive = std::make_shared<const codec::Archive>(request.input);
    const volume::Dataset dataset = codec::gridDataset(archive, request.level);
    const Progress progress = terminalProgress("unpack");
    for (const std::string& written :
         volume::exportDataset(dataset, select(request, dataset.info), request.output, progress))
        std::printf("%s\n", written.c_str());
}

} // namespace

void addUnpackCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand("unpack", "Write an archive as a regular grid: .raw, .vti, .pvd or .nrrd");
    const auto request = std::make_shared<Request>();
    command->add_option("IN", request->input, "Archive (.tsr)")->required();
    command->add_option("-o,--output", request->output, "File to write; its ending says how")->required();
    command->add_option("-p,--parameters", request->parameters, "Only these, separated by commas (default: all)")
        ->delimiter(',');
    command->add_option("-t,--times", request->times, "Only the times nearest to these, separated by commas")
        ->delimiter(',');
    command->add_option("-l,--level", request->level, "Level of detail: 0 is full resolution")
        ->check(CLI::NonNegativeNumber);
    command->callback([request] { run(*request); });
}

} // namespace tessera::app
