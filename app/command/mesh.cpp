#include "app/command/command.h"
#include "app/data/import_options.h"
#include "app/data/open.h"
#include "app/described/describe_cli.h"
#include "app/queries/surface_query.h"
#include "volume/base/error.h"
#include "volume/mesh/mesh_file.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

namespace tessera::app {

namespace {

/// The options of the surface.
struct MeshOptions {
    std::string channel, colorBy;
    std::optional<double> iso, time;
    int level = 0;
    bool bcc = false;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel, FieldInfo{.key = "channel",
                                      .unit = "",
                                      .doc = "Parameter whose surface is extracted (default: the only one)"});
        visit(self.iso, FieldInfo{.key = "iso", .unit = "", .doc = "Value on the surface, in the parameter's unit"});
        visit(self.time,
              FieldInfo{.key = "time", .unit = "", .doc = "Time, in the unit of the data (default: the first)"});
        visit(self.colorBy,
              FieldInfo{.key = "colorBy", .unit = "", .doc = "Parameter whose values are stored at the vertices"});
        visit(self.level,
              FieldInfo{
                  .key = "level", .unit = "", .doc = "Level of detail: 0 is full resolution", .range = Range{0, 16}});
        visit(
            self.bcc,
            FieldInfo{.key = "bcc", .unit = "", .doc = "Resample data files to the body-centred cubic lattice first"});
    }
};

struct MeshRequest {
    std::vector<std::string> inputs;
    std::string output;
    MeshOptions mesh;
    volume::ImportOptions import;
};

std::shared_ptr<const volume::BrickSource> openInput(const MeshRequest& request, const Progress& progress) {
    DataRef data = dataNamed(request.inputs, request.import, progress.part(0, 0.1));
    data.lattice = request.mesh.bcc ? PictureLattice::BodyCentred : PictureLattice::Grid;
    std::vector<std::string> messages;
    auto source = openSource(data, messages, progress.part(0.1, 1));
    for (const std::string& message : messages) std::fprintf(stderr, "tessera: %s\n", message.c_str());
    return source;
}

void run(MeshRequest request) {
    const std::string& path = request.output;
    if (std::ranges::none_of(volume::kMeshEndings, [&](auto ending) { return path.ends_with(ending); }))
        throw Error("meshes are written as .ply, .stl, .obj or .vtp", path);
    const Progress progress = terminalProgress("mesh");
    const auto source = openInput(request, progress.part(0, 0.3));
    const volume::DatasetInfo& info = source->info();
    std::string known;
    for (const volume::Channel& channel : info.channels()) known += (known.empty() ? "" : ", ") + channel.name;
    if (request.mesh.channel.empty()) {
        if (info.channels().size() > 1)
            throw Error("name a parameter with --channel; there are " + known, request.inputs[0]);
        request.mesh.channel = known;
    }
    for (const std::string* name : {&request.mesh.channel, &request.mesh.colorBy})
        if (!(name == &request.mesh.colorBy && name->empty()) && !info.findChannel(*name))
            throw Error("there is no parameter \"" + *name + "\"; there are " + known, request.inputs[0]);
    if (request.mesh.level >= source->grid().levels)
        throw Error("there are " + std::to_string(source->grid().levels) + " levels", "--level",
                    std::to_string(request.mesh.level));
    const vis::IsoLayer layer{
        .channel = request.mesh.channel, .value = *request.mesh.iso, .colorBy = request.mesh.colorBy};
    const volume::TimePair time = volume::timesAround(info.times, request.mesh.time.value_or(info.times.front()));
    const auto geometry = extractLayer(source, layer, time, request.mesh.level, progress.part(0.3, 0.8));
    if (geometry->mesh.triangles.empty()) {
        const Range range = info.channelRange(info.channel(*info.findChannel(layer.channel)));
        throw Error("the surface is empty: values run from " + std::to_string(range.lo) + " to " +
                        std::to_string(range.hi),
                    "--iso", std::to_string(layer.value));
    }
    volume::writeMesh(geometry->mesh, path, request.mesh.colorBy, progress.part(0.8, 1));
    std::printf("%s: %zu vertices, %zu triangles\n", path.c_str(), geometry->mesh.positions.size(),
                geometry->mesh.triangles.size());
}

} // namespace

void addMeshCommand(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("mesh", "Write an iso-surface as triangles: .ply, .stl, .obj or .vtp by the ending");
    const auto request = std::make_shared<MeshRequest>();
    command->add_option("IN", request->inputs, "Archive, data files that belong together, or a built-in model")
        ->required();
    command->add_option("-o,--output", request->output, "File to write")->required();
    addDescribed(*command, request->mesh);
    command->get_option("--iso")->required();
    addImportOptions(*command, request->import);
    command->callback([request] { run(*request); });
}

} // namespace tessera::app
