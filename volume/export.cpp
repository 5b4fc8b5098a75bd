#include "volume/export.h"

#include "volume/atomic_file.h"
#include "volume/error.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
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

/// Shortest text that reads back equal.
std::string text(double value) {
    return nlohmann::json(value).dump();
}

std::string escaped(const std::string& name) {
    std::string out;
    for (const char c : name) {
        switch (c) {
        case '&':
            out += "&amp;";
            break;
        case '<':
            out += "&lt;";
            break;
        case '>':
            out += "&gt;";
            break;
        case '"':
            out += "&quot;";
            break;
        default:
            out += c;
        }
    }
    return out;
}

/// A name in a list of names and units: separators as %20, %2C, %3B.
std::string listed(const std::string& name) {
    std::string out;
    for (const char c : name) {
        char code[4] = {c, 0, 0, 0};
        if (c == ' ' || c == ',' || c == ';' || c == '%') std::snprintf(code, sizeof code, "%%%02X", unsigned(c));
        out += code;
    }
    return out;
}

/// Absent floats become NaN; integers stay as they are.
void markAbsent(Field& field) {
    if (!field.mask || field.type != ScalarType::F32) return;
    const auto values = field.as<float>();
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!field.present(i)) values[i] = std::numeric_limits<float>::quiet_NaN();
}

/// Physical values as float, absent ones NaN.
Field asFloat(const Field& field) {
    Field out = makeField(field.lattice, ScalarType::F32);
    const auto values = out.as<float>();
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(field.value(i));
    out.mask = field.mask;
    markAbsent(out);
    return out;
}

/// How a parameter is stored at the chosen times: found by looking at its integer frames once.
struct Storage {
    ScalarType type = ScalarType::F32;
    bool presence = false; ///< some sample is absent, and the type has no NaN
    double scale = 1, offset = 0;
};

Storage storageOf(const Dataset& dataset, int parameter, const std::vector<int>& times) {
    const Parameter& what = dataset.info.parameters[std::size_t(parameter)];
    Storage storage{what.type, false, 1, 0};
    if (what.type == ScalarType::F32) return storage;
    for (std::size_t t = 0; t < times.size(); ++t) {
        const Field field = dataset.load(parameter, 0, times[t]);
        storage.presence = storage.presence || field.mask;
        if (t == 0) {
            storage.scale = field.scale;
            storage.offset = field.offset;
        } else if (field.scale != storage.scale || field.offset != storage.offset) {
            return {};
        }
    }
    return storage;
}

bool isStoredAs(const Field& field, const Storage& storage) {
    return field.type == storage.type && (field.type != ScalarType::F32 || (field.scale == 1 && field.offset == 0));
}

/// A frame as `storage` wants it, absent floats NaN.
Field loadAs(const Dataset& dataset, int parameter, int component, int time, const Storage& storage) {
    Field field = dataset.load(parameter, component, time);
    if (!isStoredAs(field, storage)) field = asFloat(field);
    markAbsent(field);
    return field;
}

std::vector<std::uint8_t> presenceOf(const Field& field) {
    return field.mask ? *field.mask : Mask(field.count(), 1);
}

void writeField(AtomicFile& file, const Field& field) {
    file.write(field.samples.data(), field.samples.size());
}

std::string_view vtkName(ScalarType type) {
    constexpr std::string_view kNames[] = {"UInt8", "Int16", "UInt16", "Int32", "Float32"};
    return kNames[std::size_t(type)];
}

void writeVti(const Dataset& dataset, const std::vector<int>& parameters, int time, const std::string& path,
              const Progress& progress) {
    const DatasetInfo& info = dataset.info;
    const Lattice& lattice = info.lattice;
    struct Block {
        int parameter;
        Storage storage;
        bool flags; ///< the presence flags of the parameter instead of its samples
    };
    std::vector<Block> blocks;
    std::string units, labels;
    for (const int p : parameters) {
        Storage storage = storageOf(dataset, p, {time});
        if (storage.scale != 1 || storage.offset != 0) storage = {};
        blocks.push_back({p, storage, false});
        if (storage.presence) blocks.push_back({p, storage, true});
        const Parameter& what = info.parameters[std::size_t(p)];
        units += (units.empty() ? "" : "; ") + listed(what.name) + " " + (what.unit.empty() ? "-" : what.unit);
        for (const Label& label : what.labels)
            labels +=
                (labels.empty() ? "" : "; ") + listed(what.name) + " " + std::to_string(label.value) + " " + label.name;
    }
    const std::string extent = "0 " + std::to_string(lattice.size.x - 1) + " 0 " + std::to_string(lattice.size.y - 1) +
                               " 0 " + std::to_string(lattice.size.z - 1);
    const auto triple = [](glm::dvec3 v) { return text(v.x) + " " + text(v.y) + " " + text(v.z); };
    std::string head = "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" "
                       "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n";
    head += "<ImageData WholeExtent=\"" + extent + "\" Origin=\"" + triple(lattice.origin) + "\" Spacing=\"" +
            triple(lattice.spacing) + "\">\n<FieldData>\n";
    head += "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">" +
            text(info.times[std::size_t(time)]) + "</DataArray>\n";
    const auto words = [](const std::string& name, const std::string& value) {
        std::string codes;
        for (const char c : value) codes += std::to_string(int(static_cast<unsigned char>(c))) + " ";
        return "<Array type=\"String\" Name=\"" + name + "\" NumberOfTuples=\"1\" format=\"ascii\">" + codes +
               "0</Array>\n";
    };
    head += words("units", units);
    if (!labels.empty()) head += words("labels", labels);
    head += words("length_unit", info.lengthUnit);
    head += "</FieldData>\n<Piece Extent=\"" + extent + "\">\n<PointData>\n";
    std::size_t offset = 0;
    const auto sizeOf = [&](const Block& block) {
        const Parameter& what = info.parameters[std::size_t(block.parameter)];
        return block.flags ? lattice.count()
                           : lattice.count() * std::size_t(what.components) * byteSize(block.storage.type);
    };
    for (const Block& block : blocks) {
        const Parameter& what = info.parameters[std::size_t(block.parameter)];
        head += "<DataArray type=\"" + std::string(block.flags ? "UInt8" : vtkName(block.storage.type)) + "\" Name=\"" +
                escaped(what.name) + (block.flags ? ".present" : "") + "\"";
        if (what.components > 1 && !block.flags)
            head += " NumberOfComponents=\"" + std::to_string(what.components) + "\"";
        head += " format=\"appended\" offset=\"" + std::to_string(offset) + "\"/>\n";
        offset += sizeof(std::uint64_t) + sizeOf(block);
    }
    head += "</PointData>\n</Piece>\n</ImageData>\n<AppendedData encoding=\"raw\">\n_";

    AtomicFile file(path);
    file.write(head);
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        const Block& block = blocks[b];
        const Parameter& what = info.parameters[std::size_t(block.parameter)];
        progress.advance(double(b) / double(blocks.size()), what.name);
        const std::uint64_t size = sizeOf(block);
        file.write(&size, sizeof size);
        if (block.flags) {
            const auto flags = presenceOf(dataset.load(block.parameter, 0, time));
            file.write(flags.data(), flags.size());
        } else if (what.components == 1) {
            writeField(file, loadAs(dataset, block.parameter, 0, time, block.storage));
        } else { // components side by side
            const std::size_t bytes = byteSize(block.storage.type), stride = bytes * std::size_t(what.components);
            std::vector<std::byte> tuples(size);
            for (int c = 0; c < what.components; ++c) {
                const Field field = loadAs(dataset, block.parameter, c, time, block.storage);
                for (std::size_t i = 0; i < field.count(); ++i)
                    std::memcpy(tuples.data() + i * stride + std::size_t(c) * bytes, field.samples.data() + i * bytes,
                                bytes);
            }
            file.write(tuples.data(), tuples.size());
        }
    }
    file.write("\n</AppendedData>\n</VTKFile>\n");
    file.commit();
}

std::vector<std::string> writeSeries(const Dataset& dataset, const std::vector<int>& parameters,
                                     const std::vector<int>& times, const fs::path& path, const Progress& progress) {
    std::vector<std::string> written;
    fs::path base = path;
    base.replace_extension();
    std::string list = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
                       "byte_order=\"LittleEndian\">\n<Collection>\n";
    for (std::size_t t = 0; t < times.size(); ++t) {
        char number[32];
        std::snprintf(number, sizeof number, "_%04zu.vti", t);
        const fs::path frame = base.string() + number;
        writeVti(dataset, parameters, times[t], frame.string(),
                 progress.part(double(t) / double(times.size()), double(t + 1) / double(times.size())));
        written.push_back(frame.string());
        list += "<DataSet timestep=\"" + text(dataset.info.times[std::size_t(times[t])]) +
                "\" group=\"\" part=\"0\" file=\"" + escaped(frame.filename().string()) + "\"/>\n";
    }
    list += "</Collection>\n</VTKFile>\n";
    AtomicFile file(base.string() + ".pvd");
    file.write(list);
    file.commit();
    written.push_back(file.path());
    return written;
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
        field = asFloat(dataset.load(channel.parameter, 0, times[0]));
        const auto sum = field.as<float>();
        std::vector<double> squares(field.count(), 0);
        for (int c = 0; c < info.parameters[std::size_t(channel.parameter)].components; ++c) {
            const Field part = asFloat(dataset.load(channel.parameter, c, times[0]));
            const auto values = part.as<float>();
            for (std::size_t i = 0; i < squares.size(); ++i) squares[i] += double(values[i]) * double(values[i]);
        }
        for (std::size_t i = 0; i < squares.size(); ++i) sum[i] = static_cast<float>(std::sqrt(squares[i]));
    } else {
        field = dataset.load(channel.parameter, channel.component, times[0]);
        if (field.mask || field.scale != 1 || field.offset != 0) field = asFloat(field);
    }
    const Lattice& lattice = info.lattice;
    std::string head = "NRRD0004\n# " + channel.name + " " + channel.unit + "\n";
    head += "type: " + std::string(field.type == ScalarType::F32 ? "float" : name(field.type)) + "\ndimension: 3\n";
    head += "sizes: " + std::to_string(lattice.size.x) + " " + std::to_string(lattice.size.y) + " " +
            std::to_string(lattice.size.z) + "\n";
    head += "space dimension: 3\nspace directions: (" + text(lattice.spacing.x) + ",0,0) (0," +
            text(lattice.spacing.y) + ",0) (0,0," + text(lattice.spacing.z) + ")\n";
    head += "space origin: (" + text(lattice.origin.x) + "," + text(lattice.origin.y) + "," + text(lattice.origin.z) +
            ")\nkinds: domain domain domain\nencoding: raw\n";
    if (field.type != ScalarType::U8) head += "endian: little\n";
    head += "content: " + channel.name + "\nunit:=" + channel.unit +
            "\ntime:=" + text(info.times[std::size_t(times[0])]) + "\n\n";
    AtomicFile file(path);
    file.write(head);
    writeField(file, field);
    file.commit();
    return path;
}

/// How absent samples of one component can be told by their stored numbers, which .raw keeps bit for bit.
struct Marker {
    bool works = true;           ///< false: a present sample has the number, or there are several numbers
    std::optional<double> value; ///< none: nothing is absent, or NaN says it
};

Marker markerOf(const Dataset& dataset, int parameter, int component, const std::vector<int>& times) {
    Marker marker;
    for (const int time : times) {
        const Field field = dataset.load(parameter, component, time);
        if (!field.mask) continue;
        dispatch(field.type, [&]<class T>(T) {
            const auto stored = field.as<T>();
            for (std::size_t i = 0; i < stored.size() && marker.works; ++i) {
                const auto number = static_cast<double>(stored[i]);
                if (field.present(i) || std::isnan(number)) continue;
                if (!marker.value) marker.value = number;
                marker.works = number == *marker.value;
            }
        });
    }
    if (!marker.value) return marker;
    for (const int time : times) {
        const Field field = dataset.load(parameter, component, time);
        dispatch(field.type, [&]<class T>(T) {
            const auto stored = field.as<T>();
            for (std::size_t i = 0; i < stored.size() && marker.works; ++i)
                marker.works = !field.present(i) || static_cast<double>(stored[i]) != *marker.value;
        });
    }
    return marker;
}

std::vector<std::string> writeRaw(const Dataset& dataset, const std::vector<int>& parameters,
                                  const std::vector<int>& times, const fs::path& path, const Progress& progress) {
    const DatasetInfo& info = dataset.info;
    fs::path raw = path, sidecar = path;
    raw.replace_extension(".raw");
    sidecar.replace_extension(".json");
    std::vector<Storage> storage;
    std::vector<std::vector<Marker>> markers; // of each component
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        progress.advance(0.3 * double(i) / double(parameters.size()), "forms");
        storage.push_back(storageOf(dataset, parameters[i], times));
        std::vector<Marker>& own = markers.emplace_back();
        bool works = true;
        for (int c = 0; c < info.parameters[std::size_t(parameters[i])].components; ++c) {
            own.push_back(markerOf(dataset, parameters[i], c, times));
            works = works && own.back().works;
        }
        // Numbers that are converted to physical floats say it by NaN.
        const bool converted = !isStoredAs(dataset.load(parameters[i], 0, times.front()), storage.back());
        storage.back().presence = !works && !converted;
        if (!works || converted) own.assign(own.size(), {});
    }

    using json = nlohmann::ordered_json;
    json components = json::array();
    const auto add = [&](const std::string& componentName, const std::string& unit, ScalarType type) -> json& {
        json entry;
        entry["name"] = componentName;
        entry["unit"] = unit;
        if (type != storage.front().type) entry["dtype"] = name(type);
        components.push_back(std::move(entry));
        return components.back();
    };
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        const Parameter& what = info.parameters[std::size_t(parameters[i])];
        for (int c = 0; c < what.components; ++c) {
            const std::string suffix = what.components == 1 ? ""
                                       : c < 3              ? std::string(".") + "xyz"[c]
                                                            : "." + std::to_string(c);
            json& entry = add(what.name + suffix, what.unit, storage[i].type);
            if (storage[i].scale != 1) entry["scale"] = storage[i].scale;
            if (storage[i].offset != 0) entry["offset"] = storage[i].offset;
            const Marker& marker = markers[i][std::size_t(c)];
            if (marker.value) entry["missing_value"] = *marker.value;
            if (what.categorical) entry["categorical"] = true;
            for (const Label& label : what.labels) entry["labels"][std::to_string(label.value)] = label.name;
        }
        if (storage[i].presence) add(what.name + ".present", "", ScalarType::U8)["presence_of"] = what.name;
    }
    AtomicFile file(raw.string());
    double written = 0, done = 0;
    for (const int t : times)
        for (std::size_t i = 0; i < parameters.size(); ++i) {
            const Parameter& what = info.parameters[std::size_t(parameters[i])];
            progress.advance(0.3 + 0.7 * done++ / double(times.size() * parameters.size()), what.name);
            Field field;
            for (int c = 0; c < what.components; ++c) {
                field = dataset.load(parameters[i], c, t); // absent samples as they are
                if (!isStoredAs(field, storage[i])) field = asFloat(field);
                writeField(file, field);
                written += double(field.samples.size());
            }
            if (storage[i].presence) {
                const auto flags = presenceOf(field);
                file.write(flags.data(), flags.size());
                written += double(flags.size());
            }
        }
    json out;
    out["name"] = info.name;
    out["file"] = raw.filename().string();
    const Lattice& lattice = info.lattice;
    out["dims"] = {lattice.size.x, lattice.size.y, lattice.size.z};
    out["dtype"] = name(storage.front().type);
    out["byte_order"] = "little";
    out["layout"] = "[time][component][z][y][x], x fastest";
    out["spacing"] = {lattice.spacing.x, lattice.spacing.y, lattice.spacing.z};
    out["origin"] = {lattice.origin.x, lattice.origin.y, lattice.origin.z};
    out["length_unit"] = info.lengthUnit;
    out["components"] = std::move(components);
    out["times"] = json::array();
    for (const int t : times) out["times"].push_back(info.times[std::size_t(t)]);
    out["time_unit"] = info.timeUnit;
    out["missing_value"] = nullptr;
    out["bytes"] = static_cast<std::uint64_t>(written);
    if (!info.provenance.empty()) out["provenance"] = info.provenance;
    AtomicFile words(sidecar.string());
    words.write(out.dump(1) + "\n");
    file.commit();
    words.commit();
    return {raw.string(), sidecar.string()};
}

} // namespace

std::vector<std::string> exportDataset(const Dataset& dataset, const ExportSelection& selection,
                                       const std::string& path, const Progress& progress) {
    const DatasetInfo& info = dataset.info;
    if (info.lattice.kind != LatticeKind::CC) throw Error("only a regular grid can be exported", path);
    const std::vector<int> parameters = orAll(selection.parameters, info.parameters.size());
    const std::vector<int> times = orAll(selection.times, info.times.size());
    if (parameters.empty() || times.empty()) throw Error("nothing to write", path);
    for (const int p : parameters)
        if (p < 0 || p >= int(info.parameters.size())) throw Error("parameter out of range", path);
    for (const int t : times)
        if (t < 0 || t >= int(info.times.size())) throw Error("time out of range", path);
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
