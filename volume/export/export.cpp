#include "volume/export/export.h"

#include "volume/base/error.h"
#include "volume/base/number_text.h"
#include "volume/export/export_formats.h"

#include <cmath>
#include <numeric>

namespace tessera::volume {

namespace fs = std::filesystem;

namespace {

std::vector<int> orAll(const std::vector<int>& chosen, std::size_t count) {
    if (!chosen.empty()) return chosen;
    std::vector<int> all(count);
    std::iota(all.begin(), all.end(), 0);
    return all;
}

bool holdsSame(const Field& a, const Field& b) {
    for (std::size_t i = 0; i < a.count(); ++i)
        if (b.present(i) && a.value(i) != b.value(i)) return false;
    return true;
}

std::string writeNrrd(const Dataset& dataset, const ExportSelection& selection, const std::vector<int>& parameters,
                      const std::vector<int>& times, const std::string& path) {
    const DatasetInfo& info = dataset.info;
    const std::vector<Channel> channels = info.channels();
    if (times.size() != 1)
        throw Error(".nrrd holds one time, " + std::to_string(times.size()) + " are asked for", path);
    std::optional<int> chosen = selection.channel;
    if (!chosen && parameters.size() == 1) chosen = info.findChannel(info.parameters[std::size_t(parameters[0])].name);
    if (!chosen)
        throw Error(".nrrd holds one parameter, " + std::to_string(parameters.size()) + " are asked for", path);
    const Channel& channel = channels[std::size_t(*chosen)];
    Field field;
    if (channel.magnitude) {
        field = asFloat(dataset.read(channel.parameter, 0, times[0]));
        const auto sum = field.as<float>();
        std::vector<double> squares(field.count(), 0);
        for (int c = 0; c < info.parameters[std::size_t(channel.parameter)].components; ++c) {
            const Field part = asFloat(dataset.read(channel.parameter, c, times[0]));
            const auto values = part.as<float>();
            for (std::size_t i = 0; i < squares.size(); ++i) squares[i] += double(values[i]) * double(values[i]);
        }
        for (std::size_t i = 0; i < squares.size(); ++i) sum[i] = static_cast<float>(std::sqrt(squares[i]));
    } else {
        field = dataset.read(channel.parameter, channel.component, times[0]);
        if (field.mask || field.scale != 1 || field.offset != 0) {
            const Field floats = asFloat(field);
            if (field.mask && field.scale == 1 && field.offset == 0 && !holdsSame(floats, field))
                throw Error(".nrrd marks absent samples as floats do, which cannot hold integers of " + channel.name +
                                ": write .vti or .raw",
                            path);
            field = floats;
        }
    }
    const Lattice& lattice = info.lattice;
    std::string head = "NRRD0004\n# " + channel.name + " " + channel.unit + "\n";
    head += "type: " + std::string(field.type == ScalarType::F32 ? "float" : name(field.type)) + "\ndimension: 3\n";
    head += "sizes: " + std::to_string(lattice.size.x) + " " + std::to_string(lattice.size.y) + " " +
            std::to_string(lattice.size.z) + "\n";
    head += "space dimension: 3\nspace directions: (" + exactText(lattice.spacing.x) + ",0,0) (0," +
            exactText(lattice.spacing.y) + ",0) (0,0," + exactText(lattice.spacing.z) + ")\n";
    head += "space origin: (" + exactText(lattice.origin.x) + "," + exactText(lattice.origin.y) + "," +
            exactText(lattice.origin.z) + ")\nkinds: domain domain domain\nencoding: raw\n";
    if (const std::string& unit = info.lengthUnit; !unit.empty() && unit.find('"') == std::string::npos)
        head += "space units: \"" + unit + "\" \"" + unit + "\" \"" + unit + "\"\n";
    if (field.type != ScalarType::U8) head += "endian: little\n";
    head += "content: " + channel.name + "\nunit:=" + channel.unit +
            "\ntime:=" + exactText(info.times[std::size_t(times[0])]) + "\n\n";
    AtomicFile file(path);
    file.write(head);
    writeField(file, field);
    file.commit();
    return path;
}

} // namespace

std::vector<std::string> exportDataset(const Dataset& source, const ExportSelection& selection, const std::string& path,
                                       const Progress& progress) {
    const DatasetInfo& info = source.info;
    if (info.lattice.kind != LatticeKind::CC) throw Error("only a regular grid can be exported", path);
    const std::vector<int> parameters = orAll(selection.parameters, info.parameters.size());
    const std::vector<int> times = orAll(selection.times, info.times.size());
    if (parameters.empty() || times.empty()) throw Error("nothing to write", path);
    for (const int p : parameters)
        if (p < 0 || p >= int(info.parameters.size())) throw Error("parameter out of range", path);
    for (const int t : times)
        if (t < 0 || t >= int(info.times.size())) throw Error("time out of range", path);
    const Dataset dataset = selection.values ? withValues(source, parameters, times) : source;
    const std::string ending = fs::path(path).extension().string();
    std::vector<std::string> written;
    if (ending == ".vti" && times.size() == 1) {
        writeVti(dataset, parameters, times[0], path, progress);
        written = {path};
    } else if (ending == ".vti" || ending == ".pvd") {
        written = writeSeries(dataset, parameters, times, path, progress);
    } else if (ending == ".nrrd") {
        written = {writeNrrd(dataset, selection, parameters, times, path)};
    } else if (ending == ".raw" || ending == ".json") {
        written = writeRaw(dataset, parameters, times, path, progress);
    } else {
        throw Error("unknown ending \"" + ending + "\": .vti, .pvd, .nrrd or .raw", path);
    }
    progress.advance(1);
    return written;
}

} // namespace tessera::volume
