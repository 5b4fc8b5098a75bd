#include "codec/unpack/unpack.h"
#include "app/command/command.h"
#include "app/command/derive_option.h"
#include "app/data/format.h"
#include "app/data/import_options.h"
#include "volume/base/terminal.h"
#include "volume/export/export.h"
#include "volume/flow/flow_channels.h"
#include "volume/resample/even_grid.h"
#include "volume/resample/hyperplane.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>

namespace tessera::app {

namespace {

struct UnpackRequest {
    std::string input, output;
    std::vector<std::string> parameters;
    std::vector<double> times;
    std::vector<double> plane;
    std::vector<volume::DerivedParameter> derived;
    int level = 0;
    bool even = false;
    volume::TimeFilter timeFilter = volume::TimeFilter::Cubic;
    codec::RemoteOptions remote;
};

/// `values`: the samples are computed ones, so the scaling of the source does not apply.
volume::ExportSelection select(const UnpackRequest& request, const volume::DatasetInfo& info, bool values) {
    volume::ExportSelection selection;
    selection.values = values;
    for (const std::string& wanted : request.parameters) {
        const auto found = info.findChannel(wanted);
        if (!found)
            throw Error("there is no parameter \"" + wanted + "\"; there are " + volume::channelNames(info),
                        request.input);
        const int parameter = info.channel(*found).parameter;
        if (std::find(selection.parameters.begin(), selection.parameters.end(), parameter) ==
            selection.parameters.end())
            selection.parameters.push_back(parameter);
        const bool whole = info.parameters[std::size_t(parameter)].name == wanted; // a vector, not its length
        if (request.parameters.size() == 1 && !whole && hasEnding(request.output, ".nrrd")) selection.channel = *found;
    }
    for (const double time : request.times) selection.times.push_back(info.nearestTime(time));
    std::sort(selection.times.begin(), selection.times.end());
    selection.times.erase(std::unique(selection.times.begin(), selection.times.end()), selection.times.end());
    return selection;
}

/// Every scalar of the archive on the plane a x + b y + c z + d t + e = 0, t in the archive's times.
volume::Dataset planeDataset(const std::shared_ptr<const codec::Archive>& archive, const std::vector<double>& plane) {
    const volume::DatasetInfo& stored = archive->info();
    if (stored.times.size() < 2) throw Error("a plane through space and time needs two times or more", archive->path());
    const volume::Hyperplane cut{{plane[0], plane[1], plane[2], plane[3]}, plane[4]};
    const auto slice = [archive, cut](int parameter, int component) {
        volume::Series series = codec::storedSeries(archive, parameter, component);
        if (series.lattice.kind == volume::LatticeKind4::D4 && !series.categorical)
            series = volume::prefiltered(series);
        return volume::sliceBy(series, cut, archive->info().times);
    };
    const volume::HyperplaneSlice shape = slice(0, 0);
    volume::Dataset dataset;
    dataset.info = stored;
    dataset.info.lattice = shape.field.lattice;
    dataset.info.times = {0};
    dataset.info.timeUnit.clear();
    dataset.info.quantities.clear();
    const auto unitText = [](const std::string& unit) { return unit.empty() ? std::string("-") : unit; };
    std::string axes; // of the plane, with their units
    for (int i = 0; i < 3; ++i) {
        const int axis = shape.axes[std::size_t(i)];
        const std::string unit = axis == 3 ? stored.timeUnit : stored.lengthUnit;
        axes += (i > 0 ? ", " : "") + (axis == 3 ? stored.timeName : std::string(1, "xyz"[axis])) + " [" +
                unitText(unit) + "]";
        dataset.info.axisUnits[std::size_t(i)] = unit;
    }
    if (shape.solved == 3)
        dataset.info.axisUnits = {};
    else
        dataset.info.lengthUnit.clear();
    dataset.info.provenance += (dataset.info.provenance.empty() ? "axes: " : "; axes: ") + axes;
    for (volume::Parameter& parameter : dataset.info.parameters) parameter.type = volume::ScalarType::F32;
    dataset.read = [slice, lattice = dataset.info.lattice](int parameter, int component, int) {
        volume::Field field = slice(parameter, component).field;
        field.lattice = lattice;
        return field;
    };
    return dataset;
}

void run(const UnpackRequest& request) {
    const auto archive = std::make_shared<const codec::Archive>(request.input, request.remote);
    const Progress progress = terminalProgress("unpack");
    const bool derives = !request.derived.empty();
    volume::Dataset dataset = request.plane.empty()
                                  ? withDerived(codec::gridDataset(archive, request.level, request.timeFilter),
                                                request.derived, progress.part(0, derives ? 0.5 : 0))
                                  : planeDataset(archive, request.plane);
    const bool resamples = request.even && !dataset.info.lattice.isEven();
    if (resamples) dataset = volume::onEvenGrid(dataset);
    const bool values = resamples || !archive->metadata().lossless;
    for (const std::string& written : volume::exportDataset(dataset, select(request, dataset.info, values),
                                                            request.output, progress.part(derives ? 0.5 : 0, 1)))
        say("%s\n", written.c_str());
}

} // namespace

void addUnpackCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand("unpack", "Write an archive as a grid: .raw, .vti, .vtr, .pvd or .nrrd");
    const auto request = std::make_shared<UnpackRequest>();
    command->add_option("IN", request->input, "Archive (.tsr), also by its address on another machine")->required();
    command->add_option("-o,--output", request->output, "File to write; its ending chooses the format")->required();
    command
        ->add_option("-p,--parameters", request->parameters,
                     "Only these parameters, separated by commas (default: all)")
        ->delimiter(',');
    command->add_option("-t,--times", request->times, "Only the times nearest to these, separated by commas")
        ->delimiter(',');
    command->add_option("-l,--level", request->level, "Level of detail: 0 is full resolution")
        ->check(CLI::NonNegativeNumber);
    command->add_flag(
        "--even", request->even,
        "Resample a grid of uneven axes to one spacing per axis, linearly, for formats that hold no other");
    command
        ->add_option(
            "--plane", request->plane,
            "A,B,C,D,E: write the slice a x + b y + c z + d t + e = 0 through space and time, in the units of the "
            "archive, as a grid over three of the four axes: y, z, t where the plane is steepest across x. "
            "Values are linear between samples and times; along t the grid has as many even steps as there "
            "are times")
        ->delimiter(',')
        ->expected(5);
    addDeriveOption(*command, request->derived);
    addRemoteOptions(*command, request->remote);
    for (const char* const other : {"--derive", "--level", "--times"}) // a plane is of all samples and all times
        command->get_option(other)->excludes("--plane");
    command
        ->add_option_function<std::string>(
            "--time-filter",
            [request](const std::string& name) {
                request->timeFilter = name == "linear" ? volume::TimeFilter::Linear : volume::TimeFilter::Cubic;
            },
            "Interpolation in time of a d4 archive: linear or cubic")
        ->check(CLI::IsMember({"linear", "cubic"}))
        ->default_str("cubic");
    command->callback([request] { run(*request); });
}

} // namespace tessera::app
