#include "volume/export/export.h"

#include "volume/base/error.h"
#include "volume/base/number_text.h"
#include "volume/base/printable.h"
#include "volume/export/export_formats.h"
#include "volume/field/own_axes.h"

#include <cmath>
#include <cstddef>
#include <cstring>
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

/// The magnitude of a vector.
Field lengthOf(const Dataset& dataset, int parameter, int time) {
    Field field = asFloat(dataset.read(parameter, 0, time));
    const auto sum = field.as<float>();
    std::vector<double> squares(field.count(), 0);
    for (int c = 0; c < dataset.info.parameters[std::size_t(parameter)].components; ++c) {
        const Field part = asFloat(dataset.read(parameter, c, time));
        const auto values = part.as<float>();
        for (std::size_t i = 0; i < squares.size(); ++i) squares[i] += double(values[i]) * double(values[i]);
    }
    for (std::size_t i = 0; i < squares.size(); ++i) sum[i] = static_cast<float>(std::sqrt(squares[i]));
    return field;
}

/// What a .nrrd file holds: the components of a parameter, or one channel; all of one type.
struct NrrdContent {
    std::string name, unit;
    std::vector<Field> components;
};

/// Components as they are stored, or as floats where one is scaled or has absent samples, which are then NaN.
std::vector<Field> nrrdFields(const Dataset& dataset, int parameter, int first, int count, int time,
                              const std::string& path) {
    std::vector<Field> out;
    bool floats = false;
    for (int c = first; c < first + count; ++c) {
        const Field& field = out.emplace_back(dataset.read(parameter, c, time));
        floats = floats || field.mask || field.scale != 1 || field.offset != 0;
    }
    if (!floats) return out;
    for (Field& field : out) {
        const Field converted = asFloat(field);
        if (field.scale == 1 && field.offset == 0 && !holdsSame(converted, field))
            throw Error(".nrrd marks absent samples as floats do, which cannot hold integers of " +
                            dataset.info.parameters[std::size_t(parameter)].name + ": write .vti or .raw",
                        path);
        field = converted;
    }
    return out;
}

NrrdContent nrrdContent(const Dataset& dataset, const ExportSelection& selection, const std::vector<int>& parameters,
                        int time, const std::string& path) {
    const DatasetInfo& info = dataset.info;
    if (selection.channel) {
        const Channel channel = info.channel(*selection.channel);
        if (channel.magnitude) return {channel.name, channel.unit, {lengthOf(dataset, channel.parameter, time)}};
        return {channel.name, channel.unit, nrrdFields(dataset, channel.parameter, channel.component, 1, time, path)};
    }
    if (parameters.size() != 1)
        throw Error(".nrrd holds one parameter, " + std::to_string(parameters.size()) + " are asked for", path);
    const Parameter& parameter = info.parameters[std::size_t(parameters[0])];
    return {parameter.name, parameter.unit, nrrdFields(dataset, parameters[0], 0, parameter.components, time, path)};
}

/// Samples with the components of each beside each other.
void writeInterleaved(AtomicFile& file, const std::vector<Field>& components) {
    const std::size_t bytes = byteSize(components[0].type), slices = std::size_t(components[0].lattice.size.z);
    const std::size_t perSlice = components[0].count() / slices;
    std::vector<std::byte> slice(perSlice * components.size() * bytes);
    for (std::size_t k = 0; k < slices; ++k) {
        for (std::size_t c = 0; c < components.size(); ++c)
            for (std::size_t i = 0; i < perSlice; ++i)
                std::memcpy(&slice[(i * components.size() + c) * bytes],
                            components[c].samples.data() + (k * perSlice + i) * bytes, bytes);
        file.write(slice.data(), slice.size());
    }
}

/// The line of the units of the axes, "" where none is stated.
std::string spaceUnits(const DatasetInfo& info) {
    std::string line = "space units:";
    bool stated = false;
    for (const std::string& own : info.axisUnits) {
        std::string unit = printable(own.empty() ? info.lengthUnit : own);
        if (unit.find('"') != std::string::npos) unit.clear();
        stated = stated || !unit.empty();
        line += " \"" + unit + "\"";
    }
    return stated ? line + "\n" : "";
}

std::string writeNrrd(const Dataset& dataset, const ExportSelection& selection, const std::vector<int>& parameters,
                      const std::vector<int>& times, const std::string& path) {
    const DatasetInfo& info = dataset.info;
    if (times.size() != 1)
        throw Error(".nrrd holds one time, " + std::to_string(times.size()) + " are asked for", path);
    const NrrdContent content = nrrdContent(dataset, selection, parameters, times[0], path);
    const std::size_t components = content.components.size();
    const bool vector = components > 1;
    const ScalarType type = content.components[0].type;
    const Lattice& lattice = info.lattice;
    std::string head = "NRRD0004\n# " + printable(content.name + " " + content.unit) + "\n";
    head += "type: " + std::string(type == ScalarType::F32 ? "float" : name(type)) +
            "\ndimension: " + (vector ? "4" : "3") + "\n";
    head += "sizes: " + (vector ? std::to_string(components) + " " : "") + std::to_string(lattice.size.x) + " " +
            std::to_string(lattice.size.y) + " " + std::to_string(lattice.size.z) + "\n";
    head += std::string("space dimension: 3\nspace directions: ") + (vector ? "none " : "") + "(" +
            exactText(lattice.spacing.x) + ",0,0) (0," + exactText(lattice.spacing.y) + ",0) (0,0," +
            exactText(lattice.spacing.z) + ")\n";
    head += "space origin: (" + exactText(lattice.origin.x) + "," + exactText(lattice.origin.y) + "," +
            exactText(lattice.origin.z) + ")\nkinds: " + (vector ? "vector " : "") +
            "domain domain domain\nencoding: raw\n";
    head += spaceUnits(info);
    if (type != ScalarType::U8) head += "endian: little\n";
    head += "content: " + printable(content.name) + "\nunit:=" + printable(content.unit) +
            "\ntime:=" + exactText(info.times[std::size_t(times[0])]) + "\n\n";
    AtomicFile file(path);
    file.write(head);
    if (vector)
        writeInterleaved(file, content.components);
    else
        writeField(file, content.components[0]);
    file.commit();
    return path;
}

/// Throws Error where a format of one spacing per axis cannot hold the grid.
void requireEven(const Lattice& lattice, const std::string& ending, const std::string& path) {
    std::string uneven;
    for (int axis = 0; axis < 3; ++axis)
        if (lattice.axes[axis]) uneven += (uneven.empty() ? "" : ", ") + std::string(1, "xyz"[axis]);
    if (!uneven.empty())
        throw Error(ending + " holds one spacing per axis, but that along " + uneven +
                        " is uneven: write .vtr, or .raw with its sidecar, or an even grid by --even",
                    path);
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
    const std::string ending = fs::path(path).extension().string();
    if (ending == ".vti" || ending == ".nrrd") requireEven(info.lattice, ending, path);
    Dataset dataset = selection.values ? withValues(source, parameters, times) : source;
    dataset.info.lattice = withOwnAxes(dataset.info.lattice);
    std::vector<std::string> written;
    if ((ending == ".vti" || ending == ".vtr") && times.size() == 1) {
        writeVtk(dataset, parameters, times[0], path, progress);
        written = {path};
    } else if (ending == ".vti" || ending == ".vtr" || ending == ".pvd") {
        written = writeSeries(dataset, parameters, times, path, progress);
    } else if (ending == ".nrrd") {
        written = {writeNrrd(dataset, selection, parameters, times, path)};
    } else if (ending == ".raw" || ending == ".json") {
        written = writeRaw(dataset, parameters, times, path, progress);
    } else {
        throw Error("unknown ending \"" + ending + "\": .vti, .vtr, .pvd, .nrrd or .raw", path);
    }
    progress.advance(1);
    return written;
}

} // namespace tessera::volume
