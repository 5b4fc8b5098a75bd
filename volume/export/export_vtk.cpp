#include "volume/base/error.h"
#include "volume/base/number_text.h"
#include "volume/export/export_formats.h"
#include "volume/export/time_files.h"
#include "volume/field/labels.h"
#include "volume/field/own_axes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace tessera::volume {

namespace fs = std::filesystem;

namespace {

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

std::string_view vtkName(ScalarType type) {
    constexpr std::string_view kNames[] = {"UInt8", "Int16", "UInt16", "Int32", "Float32"};
    return kNames[std::size_t(type)];
}

/// An array of the file: the samples of a parameter, or its presence flags.
struct Block {
    int parameter;
    Storage storage;
    bool flags; ///< the presence flags of the parameter instead of its samples
};

std::vector<Block> blocksOf(const Dataset& dataset, const std::vector<int>& parameters, int time) {
    std::vector<Block> blocks;
    for (const int p : parameters) {
        Storage storage = storageOf(dataset, p, {time});
        const bool plain = std::all_of(storage.scaling.begin(), storage.scaling.end(),
                                       [](const Scaling& scaling) { return scaling == Scaling{}; });
        if (!plain || (storage.presence && !masksAgree(dataset, p, {time})))
            storage = floatStorage(dataset.info.parameters[std::size_t(p)].components);
        blocks.push_back({p, storage, false});
        if (storage.presence) blocks.push_back({p, storage, true});
    }
    return blocks;
}

std::size_t bytesOf(const Block& block, const DatasetInfo& info) {
    const auto components = std::size_t(info.parameters[std::size_t(block.parameter)].components);
    return info.lattice.count() * (block.flags ? 1 : components * byteSize(block.storage.type));
}

/// The field data of a frame: its time, quantities, units, labels.
std::string fieldData(const DatasetInfo& info, const std::vector<int>& parameters, int time) {
    std::string units, labels;
    for (const int p : parameters) {
        const Parameter& what = info.parameters[std::size_t(p)];
        units += (units.empty() ? "" : "; ") + listed(what.name) + " " +
                 (what.unit.empty() || what.unitGuessed ? "-" : what.unit);
        for (const Label& label : what.labels)
            labels += (labels.empty() ? "" : "; ") + listed(what.name) + " " + std::to_string(label.value) + " " +
                      labelText(label);
    }
    const auto number = [](const std::string& name, double value) {
        return "<DataArray type=\"Float64\" Name=\"" + name + "\" NumberOfTuples=\"1\" format=\"ascii\">" +
               exactText(value) + "</DataArray>\n";
    };
    std::string out = number("TimeValue", info.times[std::size_t(time)]);
    for (const Quantity& quantity : info.quantities) {
        units += "; " + listed(quantity.name) + " " + (quantity.unit.empty() ? "-" : quantity.unit);
        if (std::isfinite(quantity.values[std::size_t(time)]))
            out += number(xmlText(quantity.name), quantity.values[std::size_t(time)]);
    }
    const auto words = [](const std::string& name, const std::string& value) {
        std::string codes;
        for (const char c : value) codes += std::to_string(int(static_cast<unsigned char>(c))) + " ";
        return "<Array type=\"String\" Name=\"" + name + "\" NumberOfTuples=\"1\" format=\"ascii\">" + codes +
               "0</Array>\n";
    };
    out += words("units", units);
    if (!labels.empty()) out += words("labels", labels);
    if (info.axisUnits != std::array<std::string, 3>{})
        out += words("axis_units", info.axisUnits[0] + "; " + info.axisUnits[1] + "; " + info.axisUnits[2]);
    return out + words("length_unit", info.lengthUnit) + words("time_name", info.timeName) +
           words("time_unit", info.timeUnit);
}

/// Places along each axis that a rectilinear grid states.
struct Rulers {
    bool cells = false; ///< values belong to cells between these places, not to the places
    std::array<std::vector<double>, 3> places;
};

/// If one axis is of cells, all values are of cells: along the others these end in the middle between samples.
Rulers rulersOf(const Lattice& lattice) {
    Rulers rulers{hasCells(lattice.axes), samplePlaces(lattice)};
    for (int axis = 0; rulers.cells && axis < 3; ++axis) {
        std::vector<double>& places = rulers.places[std::size_t(axis)];
        places.clear();
        for (int i = 0; i <= lattice.size[axis]; ++i)
            places.push_back(lattice.axes[axis] ? lattice.axes[axis]->border(i)
                                                : lattice.origin[axis] + lattice.spacing[axis] * (i - 0.5));
    }
    return rulers;
}

std::string extentText(glm::ivec3 points) {
    return "0 " + std::to_string(points.x - 1) + " 0 " + std::to_string(points.y - 1) + " 0 " +
           std::to_string(points.z - 1);
}

/// The arrays of a piece, whose samples begin at byte `offset` of the appended data.
std::string arraysText(const DatasetInfo& info, const std::vector<Block>& blocks, std::size_t offset) {
    std::string out;
    for (const Block& block : blocks) {
        const Parameter& what = info.parameters[std::size_t(block.parameter)];
        out += "<DataArray type=\"" + std::string(block.flags ? "UInt8" : vtkName(block.storage.type)) + "\" Name=\"" +
               xmlText(what.name) + (block.flags ? ".present" : "") + "\"";
        if (what.components > 1 && !block.flags)
            out += " NumberOfComponents=\"" + std::to_string(what.components) + "\"";
        out += " format=\"appended\" offset=\"" + std::to_string(offset) + "\"/>\n";
        offset += sizeof(std::uint64_t) + bytesOf(block, info);
    }
    return out;
}

std::string openingOf(const std::string& kind) {
    return "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + kind +
           "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n";
}

/// The header of image data, up to the samples.
std::string headOf(const DatasetInfo& info, const std::vector<int>& parameters, const std::vector<Block>& blocks,
                   int time) {
    const Lattice& lattice = info.lattice;
    const std::string extent = extentText(lattice.size);
    const auto triple = [](glm::dvec3 v) { return exactText(v.x) + " " + exactText(v.y) + " " + exactText(v.z); };
    return openingOf("ImageData") + "<ImageData WholeExtent=\"" + extent + "\" Origin=\"" + triple(lattice.origin) +
           "\" Spacing=\"" + triple(lattice.spacing) + "\">\n<FieldData>\n" + fieldData(info, parameters, time) +
           "</FieldData>\n<Piece Extent=\"" + extent + "\">\n<PointData>\n" + arraysText(info, blocks, 0) +
           "</PointData>\n</Piece>\n</ImageData>\n<AppendedData encoding=\"raw\">\n_";
}

/// Field data of the axes of points among axes of cells: their places, which borders of cells do not tell.
std::string pointsText(const Lattice& lattice, const Rulers& rulers) {
    std::string out;
    for (int axis = 0; rulers.cells && axis < 3; ++axis) {
        const AxisMap* map = lattice.axes[axis];
        if (!map || map->of() == AxisMap::Of::Cells) continue;
        out += std::string("<DataArray type=\"Float64\" Name=\"points_") + "xyz"[axis] + "\" NumberOfTuples=\"" +
               std::to_string(map->samples()) + "\" format=\"ascii\">";
        for (const double place : map->planes()) out += exactText(place) + " ";
        out += "</DataArray>\n";
    }
    return out;
}

/// The header of a rectilinear grid, up to its coordinates, which come before the samples.
std::string headOf(const DatasetInfo& info, const Rulers& rulers, const std::vector<int>& parameters,
                   const std::vector<Block>& blocks, int time) {
    const std::string extent = extentText(info.lattice.size + (rulers.cells ? 1 : 0));
    const std::string values = rulers.cells ? "CellData" : "PointData";
    std::string coordinates;
    std::size_t offset = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        coordinates += std::string("<DataArray type=\"Float64\" Name=\"") + "xyz"[axis] +
                       "\" format=\"appended\" offset=\"" + std::to_string(offset) + "\"/>\n";
        offset += sizeof(std::uint64_t) + rulers.places[axis].size() * sizeof(double);
    }
    return openingOf("RectilinearGrid") + "<RectilinearGrid WholeExtent=\"" + extent + "\">\n<FieldData>\n" +
           fieldData(info, parameters, time) + pointsText(info.lattice, rulers) + "</FieldData>\n<Piece Extent=\"" +
           extent + "\">\n<Coordinates>\n" + coordinates + "</Coordinates>\n<" + values + ">\n" +
           arraysText(info, blocks, offset) + "</" + values +
           ">\n</Piece>\n</RectilinearGrid>\n<AppendedData encoding=\"raw\">\n_";
}

/// The samples of a vector, components interleaved.
std::vector<std::byte> tuplesOf(const Dataset& dataset, const Block& block, int time) {
    const int components = dataset.info.parameters[std::size_t(block.parameter)].components;
    const std::size_t bytes = byteSize(block.storage.type), stride = bytes * std::size_t(components);
    std::vector<std::byte> tuples(bytesOf(block, dataset.info));
    for (int c = 0; c < components; ++c) {
        const Field field = loadAs(dataset, block.parameter, c, time, block.storage);
        for (std::size_t i = 0; i < field.count(); ++i)
            std::memcpy(tuples.data() + i * stride + std::size_t(c) * bytes, field.samples.data() + i * bytes, bytes);
    }
    return tuples;
}

} // namespace

void writeVtk(const Dataset& dataset, const std::vector<int>& parameters, int time, const std::string& path,
              const Progress& progress) {
    const DatasetInfo& info = dataset.info;
    const std::vector<Block> blocks = blocksOf(dataset, parameters, time);
    AtomicFile file(path);
    if (fs::path(path).extension() == ".vtr") {
        const Rulers rulers = rulersOf(info.lattice);
        file.write(headOf(info, rulers, parameters, blocks, time));
        for (const std::vector<double>& places : rulers.places) {
            const std::uint64_t size = places.size() * sizeof(double);
            file.write(&size, sizeof size);
            file.write(places.data(), size);
        }
    } else {
        file.write(headOf(info, parameters, blocks, time));
    }
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        const Block& block = blocks[b];
        const Parameter& what = info.parameters[std::size_t(block.parameter)];
        progress.advance(double(b) / double(blocks.size()), what.name);
        const std::uint64_t size = bytesOf(block, info);
        file.write(&size, sizeof size);
        if (block.flags) {
            const auto flags = presenceOf(dataset.read(block.parameter, 0, time));
            file.write(flags.data(), flags.size());
        } else if (what.components == 1) {
            writeField(file, loadAs(dataset, block.parameter, 0, time, block.storage));
        } else {
            const std::vector<std::byte> tuples = tuplesOf(dataset, block, time);
            file.write(tuples.data(), tuples.size());
        }
    }
    file.write("\n</AppendedData>\n</VTKFile>\n");
    file.commit();
}

std::vector<std::string> writeSeries(const Dataset& dataset, const std::vector<int>& parameters,
                                     const std::vector<int>& times, const fs::path& path, const Progress& progress) {
    std::vector<std::string> written;
    std::vector<double> at;
    fs::path name = path;
    name.replace_extension(dataset.info.lattice.isEven() && path.extension() != ".vtr" ? ".vti" : ".vtr");
    for (std::size_t t = 0; t < times.size(); ++t) {
        const std::string frame = fileOfTime(name.string(), t);
        writeVtk(dataset, parameters, times[t], frame,
                 progress.part(double(t) / double(times.size()), double(t + 1) / double(times.size())));
        written.push_back(frame);
        at.push_back(dataset.info.times[std::size_t(times[t])]);
    }
    writeCollection(path.string(), at, written);
    written.push_back(collectionOf(path.string()));
    return written;
}

} // namespace tessera::volume
