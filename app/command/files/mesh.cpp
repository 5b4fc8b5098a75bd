#include "app/command/command.h"
#include "app/data/import_options.h"
#include "app/data/open.h"
#include "app/described/describe_cli.h"
#include "app/described/describe_json.h"
#include "app/queries/geometry_query.h"
#include "app/ui/ticks.h"
#include "codec/blocks/share_results.h"
#include "volume/base/error.h"
#include "volume/base/terminal.h"
#include "volume/export/time_files.h"
#include "volume/flow/flow_channels.h"
#include "volume/four/isosurface4.h"
#include "volume/four/tetra_file.h"
#include "volume/mesh/mesh_file.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>

namespace tessera::app {

namespace {

/// The options of the surface.
struct MeshOptions {
    std::string channel, colorBy;
    std::optional<double> iso, time;
    int level = 0;
    bool bcc = false, allTimes = false, four = false;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel, FieldInfo{"channel", "Parameter whose surface is extracted (default: the only one)"});
        visit(self.iso, FieldInfo{"iso", "Value on the surface, in the parameter's unit"});
        visit(self.time, FieldInfo{"time", "Time, in the unit of the data (default: the first)"});
        visit(self.allTimes,
              FieldInfo{"allTimes",
                        "A file for every time, OUT_0000.vtp and so on, with .vtp also OUT.pvd; processes of "
                        "mpirun or srun share the times"});
        visit(self.four, FieldInfo{"four", "The surface over x, y, z and time as one mesh of tetrahedra, OUT.vtu, with "
                                           "the time as an array of its points"});
        visit(self.colorBy, FieldInfo{"colorBy", "Parameter whose values are stored at the vertices"});
        visit(self.level,
              FieldInfo{.key = "level", .doc = "Level of detail: 0 is full resolution", .range = Range{0, 16}});
        visit(self.bcc, FieldInfo{"bcc", "Resample data files to the body-centred cubic lattice first"});
    }
};

struct MeshRequest {
    std::vector<std::string> inputs;
    std::string output;
    bool alone = false;
    MeshOptions mesh;
    volume::ImportOptions import;
};

DataRef dataOf(const MeshRequest& request, const Progress& progress) {
    DataRef data = dataNamed(request.inputs, request.import, progress);
    data.lattice = request.mesh.bcc ? PictureLattice::BodyCentred : PictureLattice::Grid;
    return data;
}

void check(const MeshRequest& request) {
    if (request.mesh.four) {
        if (!request.output.ends_with(volume::kTetraEnding))
            throw Error("surfaces in space and time are written as .vtu", request.output);
        if (request.mesh.time || request.mesh.allTimes)
            throw Error("with --four the surface is one over all times", {},
                        request.mesh.time ? "--time" : "--all-times");
        if (!request.mesh.colorBy.empty())
            throw Error("a surface in space and time has its time at its points", {}, "--color-by");
        return requireFolderOf(request.output);
    }
    if (std::ranges::none_of(volume::kMeshEndings, [&](auto ending) { return request.output.ends_with(ending); }))
        throw Error("meshes are written as .ply, .stl, .obj or .vtp", request.output);
    requireFolderOf(request.output);
    if (request.mesh.allTimes && request.mesh.time)
        throw Error("with --all-times there is no single time", {}, "--time");
}

/// Sets the parameter where none is named; throws Error for parameters and levels that are not there.
void settle(MeshRequest& request, const volume::BrickSource& source) {
    const volume::DatasetInfo& info = source.info();
    const std::string known = volume::channelNames(info);
    if (request.mesh.channel.empty()) {
        if (info.channels().size() > 1)
            throw Error("name a parameter with --channel; there are " + known, request.inputs[0]);
        request.mesh.channel = known;
    }
    for (const std::string* name : {&request.mesh.channel, &request.mesh.colorBy})
        if (!(name == &request.mesh.colorBy && name->empty()) && !info.findChannel(*name))
            throw Error("there is no parameter \"" + *name + "\"; there are " + known, request.inputs[0]);
    if (request.mesh.time) request.mesh.time = timeWithin(info, *request.mesh.time);
    if (request.mesh.level >= source.grid().levels)
        throw Error("there are " + std::to_string(source.grid().levels) + " levels", "--level",
                    std::to_string(request.mesh.level));
}

[[noreturn]] void throwEmpty(const MeshRequest& request, const volume::DatasetInfo& info) {
    const Range range = info.channelRange(info.channel(*info.findChannel(request.mesh.channel)));
    const bool within = *request.mesh.iso >= range.lo && *request.mesh.iso <= range.hi;
    throw Error("the surface is empty: values run from " + formatNumber(range.lo) + " to " + formatNumber(range.hi) +
                    (info.times.size() > 1 ? " over all times" : "") +
                    (within ? std::string(", but no cell whose corners are all present reaches this value ") +
                                  (request.mesh.allTimes || request.mesh.four ? "at any time" : "at this time")
                            : ""),
                "--iso", formatNumber(*request.mesh.iso));
}

std::string countsOf(std::size_t vertices, std::size_t triangles) {
    return std::to_string(vertices) + " vertices, " + std::to_string(triangles) + " triangles";
}

std::string textOf(const volume::SurfaceMesh& mesh, const std::string& file) {
    const std::string shift = volume::meshShift(mesh, file);
    return countsOf(mesh.positions.size(), mesh.triangles.size()) + (shift.empty() ? "" : "; " + shift);
}

using SurfaceAt = std::function<std::shared_ptr<const vis::Geometry>(double time, const Progress& progress)>;

/// A file for every time, empty where there is no surface, unless there is none at any time.
void writeAllTimes(const MeshRequest& request, const DataRef& data, const volume::DatasetInfo& info,
                   const SurfaceAt& surfaceAt, const Progress& progress) {
    std::vector<std::string> files;
    for (std::size_t t = 0; t < info.times.size(); ++t) files.push_back(volume::fileOfTime(request.output, t));
    const std::string none = countsOf(0, 0);
    const auto compute = [&](std::size_t t, const Progress& part) {
        const auto surface = surfaceAt(info.times[t], part.part(0, 0.7));
        if (surface->mesh.triangles.empty()) return none;
        volume::writeMesh(surface->mesh, files[t], request.mesh.colorBy, part.part(0.7, 1));
        return textOf(surface->mesh, files[t]);
    };
    const auto isMade = [&](std::size_t t, const std::string& counts) {
        return counts == none || std::filesystem::exists(files[t]);
    };
    const auto isEmpty = [&](const std::vector<std::string>& counts) {
        return std::ranges::all_of(counts, [&](const std::string& each) { return each == none; });
    };
    const bool collects = request.output.ends_with(".vtp");
    const auto finish = [&](const std::vector<std::string>& counts, const Progress&) {
        if (isEmpty(counts)) return;
        for (std::size_t t = 0; t < counts.size(); ++t)
            if (counts[t] == none) volume::writeMesh({}, files[t], request.mesh.colorBy);
        if (collects) volume::writeCollection(request.output, info.times, files);
    };
    const std::optional<Launched> started = sharing(request.alone);
    const std::string about = aboutText({{"data", toJson(data)}, {"options", toJson(request.mesh)}}, data);
    const codec::SharedResults done =
        codec::shareResults({request.output, about, started, isMade}, files.size(), compute, finish, progress);
    if (isEmpty(done.results)) throwEmpty(request, info);
    for (std::size_t t = 0; done.last && t < files.size(); ++t)
        say("%s: %s\n", files[t].c_str(), done.results[t].c_str());
    if (done.last && collects) say("%s\n", volume::collectionOf(request.output).c_str());
    sayShare(done.own, files.size(), "surfaces", started);
}

/// The surface in space and time.
void writeFour(const MeshRequest& request, const volume::BrickSource& source, const Progress& progress) {
    const volume::DatasetInfo& info = source.info();
    if (info.times.size() < 2)
        throw Error("a surface in space and time needs several times; there is one", request.inputs[0], "--four");
    const volume::TetraMesh mesh = volume::extractIsosurface4(
        source, *info.findChannel(request.mesh.channel), *request.mesh.iso, request.mesh.level, progress.part(0, 0.8));
    if (mesh.tetrahedra.empty()) throwEmpty(request, info);
    volume::writeTetraMesh(mesh, request.output, info.timeName, progress.part(0.8, 1));
    say("%s: %zu vertices, %zu tetrahedra over x, y, z and %s\n", request.output.c_str(), mesh.points.size(),
        mesh.tetrahedra.size(), info.timeName.c_str());
}

void run(MeshRequest request) {
    check(request);
    const Progress progress = terminalProgress("mesh");
    const DataRef data = dataOf(request, progress.part(0, 0.1));
    std::vector<std::string> messages;
    const auto source = openSource(data, messages, progress.part(0.1, 0.3));
    for (const std::string& message : messages) warn("tessera: %s\n", message.c_str());
    settle(request, *source);
    const volume::DatasetInfo& info = source->info();
    const MeshOptions& mesh = request.mesh;
    const vis::IsoLayer layer{.channel = mesh.channel, .value = *mesh.iso, .colorBy = mesh.colorBy};
    const auto surfaceAt = [&](double time, const Progress& part) {
        return extractLayer(source, layer, volume::timesAround(info.times, time), mesh.level, part);
    };
    const Progress rest = progress.part(0.3, 1);
    if (mesh.four) return writeFour(request, *source, rest);
    if (!mesh.allTimes) {
        const auto surface = surfaceAt(mesh.time.value_or(info.times.front()), rest.part(0, 0.7));
        if (surface->mesh.triangles.empty()) throwEmpty(request, info);
        volume::writeMesh(surface->mesh, request.output, mesh.colorBy, rest.part(0.7, 1));
        say("%s: %s\n", request.output.c_str(), textOf(surface->mesh, request.output).c_str());
        return;
    }
    writeAllTimes(request, data, info, surfaceAt, rest);
}

} // namespace

void addMeshCommand(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("mesh", "Write an iso-surface as triangles: .ply, .stl, .obj or .vtp by the ending; with "
                                   "--four as tetrahedra in space and time: .vtu");
    const auto request = std::make_shared<MeshRequest>();
    command->add_option("IN", request->inputs, "Archive, data files that belong together, or a built-in model")
        ->required();
    command->add_option("-o,--output", request->output, "File to write")->required();
    addDescribed(*command, request->mesh);
    command->get_option("--iso")->required();
    addImportOptions(*command, request->import);
    addAloneOption(*command, request->alone);
    command->callback([request] { run(*request); });
}

} // namespace tessera::app
