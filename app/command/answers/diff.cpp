#include "app/command/command.h"
#include "app/command/derive_option.h"
#include "app/command/picture_options.h"
#include "app/data/format.h"
#include "app/data/import_options.h"
#include "app/data/open.h"
#include "app/ui/ticks.h"
#include "app/values/table.h"
#include "codec/pack/pack.h"
#include "vis/image/image_io.h"
#include "volume/base/error.h"
#include "volume/base/terminal.h"
#include "volume/derived/other_source.h"
#include "volume/export/export.h"
#include "volume/system/atomic_file.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>

namespace tessera::app {

namespace {

struct DiffRequest {
    std::string first, second, output;
    std::vector<std::string> parameters;
    volume::ImportOptions import;
};

/// One channel of the first data set minus that of the second at one time, over the samples of the first; of a label
/// only counts.
struct DiffRow {
    volume::Channel channel;
    bool label = false;
    double time = 0;
    std::size_t samples = 0, alone = 0; ///< present in both data sets, in only one of them
    std::size_t differing = 0;          ///< of those in both: another value, or another label
    double least = std::numeric_limits<double>::infinity(), most = -least, sum = 0, squares = 0;

    void add(const volume::BrickSamples& a, const volume::BrickSamples& b, const volume::UnitConversion& convert) {
        for (std::size_t i = 0; i < a.values.size(); ++i) {
            const bool inA = a.isPresent(i), inB = b.isPresent(i);
            if (inA != inB) ++alone;
            if (!inA || !inB) continue;
            const double apart = a.exact(i) - convert(b.exact(i));
            ++samples;
            if (apart != 0) ++differing;
            least = std::min(least, apart);
            most = std::max(most, apart);
            sum += apart;
            squares += apart * apart;
        }
    }
    void add(const DiffRow& other) {
        samples += other.samples;
        alone += other.alone;
        differing += other.differing;
        least = std::min(least, other.least);
        most = std::max(most, other.most);
        sum += other.sum;
        squares += other.squares;
    }
    double mean() const { return sum / double(samples); }
    double rms() const { return std::sqrt(squares / double(samples)); }
};

DataRef dataRef(const DiffRequest& request) {
    DataRef data = dataNamed({request.first}, request.import);
    const DataRef other = dataNamed({request.second}, request.import);
    data.other =
        OtherData{.files = other.files, .model = other.model, .settings = other.settings, .import = other.import};
    data.lattice = PictureLattice::Grid;
    return data;
}

/// The parameters of the first data set, for a message.
std::string namesOfFirst(const volume::DatasetInfo& info) {
    std::string names;
    for (const volume::Parameter& parameter : info.parameters)
        if (!parameter.name.ends_with(volume::kOtherSuffix)) names += (names.empty() ? "" : ", ") + parameter.name;
    return names;
}

bool isLabel(const volume::DatasetInfo& info, int channel) {
    return info.parameters[std::size_t(info.channel(channel).parameter)].categorical;
}

/// Parameters of both data sets with convertible units, and labels. Throws if a requested one is not among them.
std::vector<int> comparable(const volume::DatasetInfo& info, const DiffRequest& request) {
    std::vector<int> out;
    std::string left;
    const std::vector<volume::Channel> channels = info.channels();
    for (std::size_t i = 0; i < channels.size(); ++i) {
        const volume::Parameter& parameter = info.parameters[std::size_t(channels[i].parameter)];
        if (parameter.name.ends_with(volume::kOtherSuffix)) continue;
        const auto& wanted = request.parameters;
        const bool named = std::ranges::any_of(
            wanted, [&](const std::string& name) { return name == channels[i].name || name == parameter.name; });
        if (!named && !wanted.empty()) continue;
        const std::string problem = volume::derivedProblem(
            {"d", "", volume::DifferenceRecipe{channels[i].name, volume::OtherTime::Other}}, info);
        if (problem.empty()) {
            out.push_back(int(i));
        } else if (named) {
            throw Error(problem, request.first, channels[i].name);
        } else if (channels[i].component == 0) {
            left += (left.empty() ? "" : ", ") + parameter.name;
        }
    }
    for (const std::string& name : request.parameters)
        if (!info.findChannel(name))
            throw Error("there is no parameter \"" + name + "\"; there are " + namesOfFirst(info), request.first);
    if (out.empty()) throw Error("the two data sets have no parameter in common", request.second);
    if (!left.empty()) warn("tessera: cannot be compared: %s\n", left.c_str());
    return out;
}

std::vector<DiffRow> compare(const volume::BrickSource& source, const std::vector<int>& channels,
                             const Progress& progress) {
    const volume::DatasetInfo& info = source.info();
    const std::size_t bricks = source.grid().brickCount();
    const int times = int(info.times.size());
    std::vector<DiffRow> rows;
    const double total = double(channels.size()) * times * double(bricks);
    double done = 0;
    for (const int channel : channels) {
        const volume::UnitConversion convert = volume::otherConversion(info, channel).value();
        for (int time = 0; time < times; ++time) {
            DiffRow& row = rows.emplace_back();
            row.channel = info.channel(channel);
            row.label = isLabel(info, channel);
            row.time = info.times[std::size_t(time)];
            for (std::size_t n = 0; n < bricks; ++n) {
                const glm::ivec3 at = source.grid().indexOf(n);
                row.add(source.read({channel, time, 0, at}),
                        source.read({*volume::otherChannel(info, channel), time, 0, at}), convert);
                progress.advance(++done / total);
            }
        }
    }
    return rows;
}

/// A row for each channel, over all times or at each.
Table diffTable(const std::vector<DiffRow>& rows, const volume::DatasetInfo& info, bool ofTimes) {
    Table table;
    const auto add = [&](TableColumn column, auto of) -> TableColumn& {
        return addColumn(table, rows, std::move(column), of);
    };
    const auto ofValues = [](auto of) {
        return [of](const DiffRow& row) { return row.samples > 0 && !row.label ? std::invoke(of, row) : std::nan(""); };
    };
    TableColumn& parameter =
        add({.name = "parameter", .head = "Parameter"}, [](const DiffRow& row) { return row.channel.name; });
    for (std::size_t i = 0; i < rows.size(); ++i)
        parameter.words[i] = rows[i].label ? rows[i].channel.name + " (label)"
                                           : titleWithUnit(rows[i].channel.name, rows[i].channel.unit);
    add({.name = "unit", .shown = false}, [](const DiffRow& row) { return row.channel.unit; });
    if (ofTimes) add({.name = info.timeName, .unit = info.timeUnit}, &DiffRow::time);
    add({.name = "min", .head = "Minimum"}, ofValues(&DiffRow::least));
    add({.name = "mean", .head = "Mean"}, ofValues(&DiffRow::mean));
    add({.name = "RMS"}, ofValues(&DiffRow::rms));
    add({.name = "max", .head = "Maximum"}, ofValues(&DiffRow::most));
    add({.name = "samples", .head = "Samples", .kind = NumberKind::Count}, &DiffRow::samples);
    add({.name = "in one only", .head = "In one only", .kind = NumberKind::Count}, &DiffRow::alone);
    add({.name = "differing", .head = "Differing", .kind = NumberKind::Count}, &DiffRow::differing);
    return table;
}

void print(const std::vector<DiffRow>& rows, const DiffRequest& request, const volume::DatasetInfo& info,
           const std::string& how) {
    std::vector<DiffRow> sums;
    for (const DiffRow& row : rows)
        if (!sums.empty() && sums.back().channel == row.channel)
            sums.back().add(row);
        else
            sums.push_back(row);
    say("%s minus %s, %s, over all times\n%s", request.first.c_str(), request.second.c_str(), how.c_str(),
        textOf(diffTable(sums, info, false)).c_str());
    if (std::ranges::all_of(sums, [](const DiffRow& row) { return row.samples > 0 && row.alone + row.differing == 0; }))
        say("no sample differs\n");
}

/// The differences as a data set, with the names that the window gives them.
volume::Dataset differences(const std::shared_ptr<const volume::BrickSource>& source,
                            const std::vector<volume::DerivedParameter>& wanted) {
    volume::Dataset made;
    auto all = source;
    for (const volume::DerivedParameter& each : wanted) all = volume::derive(all, each);
    made.info = all->info();
    const std::size_t before = source->info().parameters.size();
    made.info.parameters.erase(made.info.parameters.begin(), made.info.parameters.begin() + std::ptrdiff_t(before));
    made.read = [all, before](int parameter, int component, int time) {
        return fieldOf(*all, int(before) + parameter, component, time);
    };
    return made;
}

/// The session that shows the first difference, as the window would.
void writePicture(const DiffRequest& request, const DataRef& data, const Progress& progress) {
    OpenRequest wanted;
    wanted.data = data;
    Opened opened = open(wanted, progress.part(0, 0.4));
    Session& session = opened.document.session;
    const std::string& name = data.derived.front().name;
    session.layers = {{name, true, vis::VolumeLayer{.channel = name}}};
    opened.document.history.reset(session);
    PictureOptions options;
    PictureRequest picture = pictureRequest(options, session);
    for (const auto& [pane, view] : session.views)
        if (std::holds_alternative<VolumeView>(view)) picture.pane = pane;
    PictureMaker maker;
    maker.write(opened.document, opened.sources(), picture, request.output);
    progress.advance(1);
}

/// Throws Error for a file that is not written, before the work starts.
void checkDiffOutput(const std::string& path) {
    constexpr const char* kEndings[] = {".csv", ".png", ".tsr", ".vti", ".vtr", ".pvd", ".nrrd", ".raw"};
    if (path.empty()) return;
    if (std::ranges::none_of(kEndings, [&](const char* ending) { return hasEnding(path, ending); }))
        throw Error("differences are written as .csv, .png, .tsr, .vti, .vtr, .pvd, .nrrd or .raw", path);
    requireFolderOf(path);
}

void run(const DiffRequest& request) {
    checkDiffOutput(request.output);
    const Progress progress = terminalProgress("diff");
    DataRef data = dataRef(request);
    std::vector<std::string> messages;
    const Sources sources = openSources(data, messages, progress.part(0, 0.3));
    const auto& source = sources.numbers;
    const std::vector<int> channels = comparable(source->info(), request);
    const std::vector<DiffRow> rows = compare(*source, channels, progress.part(0.3, 0.6));
    print(rows, request, source->info(), originText(sources.origin, source->info()));
    for (const int channel : channels) {
        if (isLabel(source->info(), channel)) continue;
        const volume::Channel of = source->info().channel(channel);
        data.derived.push_back(
            {of.name + " minus other", of.unit, volume::DifferenceRecipe{of.name, volume::OtherTime::Other}});
    }
    if (request.output.empty()) return;
    const Progress rest = progress.part(0.6, 1);
    if (hasEnding(request.output, ".csv")) {
        AtomicFile file(request.output);
        file.write(originLine(sources.origin, source->info()) + csvOf(diffTable(rows, source->info(), true)));
        file.commit();
    } else if (data.derived.empty()) {
        throw Error("labels have no difference: write a table (.csv)", request.output);
    } else if (hasEnding(request.output, ".png")) {
        writePicture(request, data, rest);
    } else if (volume::Dataset made = differences(source, data.derived); hasEnding(request.output, ".tsr")) {
        codec::pack(made, {}, request.output, rest);
    } else {
        for (const std::string& written : volume::exportDataset(made, {}, request.output, rest))
            say("%s\n", written.c_str());
    }
}

} // namespace

void addDiffCommand(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("diff", "Compare the values of two data sets, and count samples with another label, on the "
                                   "same grid or interpolated onto the grid of the first; an archive "
                                   "that was resampled from the grid of the other is unpacked to it");
    const auto request = std::make_shared<DiffRequest>();
    command->add_option("A", request->first, "Archive or data file")->required();
    command->add_option("B", request->second, "Archive or data file to subtract from it")->required();
    command->add_option("-o,--output", request->output,
                        "File to write: a table over all times (.csv), a picture (.png) or the differences as data "
                        "(.tsr, .vti, .vtr, .pvd, .nrrd, .raw)");
    command->add_option("-p,--only", request->parameters, "Only these parameters, separated by commas")->delimiter(',');
    addImportOptions(*command, request->import);
    command->callback([request] { run(*request); });
}

} // namespace tessera::app
