// openPMD (openPMD-standard 1.0 to 2.0): iterations of meshes in HDF5.
#include "app/importer/arrays/hdf_layouts.h"
#include "volume/base/unit_product.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>

namespace tessera::importer {

namespace {

double numberOf(const Attributes& attributes, const std::string& name, double otherwise) {
    const auto at = attributes.find(name);
    return at == attributes.end() || at->second.numbers.empty() ? otherwise : at->second.numbers.front();
}

std::vector<double> listOf(const Attributes& attributes, const std::string& name, std::size_t count, double otherwise) {
    const auto at = attributes.find(name);
    std::vector<double> out(count, otherwise);
    if (at == attributes.end()) return out;
    for (std::size_t i = 0; i < count; ++i)
        if (!at->second.numbers.empty()) out[i] = at->second.numbers[std::min(i, at->second.numbers.size() - 1)];
    return out;
}

/// One component of a record in one iteration: a data set, or a group that states one value for all samples.
struct Component {
    StoredArray array;
    Attributes attributes;
};

bool readComponent(const HdfArrays& hdf, const std::string& path, Component& out) {
    out.attributes = hdf.attributesOf(path);
    if (const HdfDataset* dataset = hdf.find(path)) {
        if (!dataset->problem.empty()) return false;
        out.array = hdf.arrayOf(*dataset);
        return true;
    }
    const auto shape = out.attributes.find("shape"), value = out.attributes.find("value");
    if (shape == out.attributes.end() || value == out.attributes.end() || value->second.numbers.size() != 1)
        return false;
    out.array.vtkType = VTK_DOUBLE;
    out.array.statedBytes = 8;
    for (const double n : shape->second.numbers) {
        if (!(n >= 0 && n < 1e12)) return false;
        out.array.dims.push_back(std::size_t(n));
        out.array.statedBytes *= n;
    }
    out.array.read = [number = value->second.numbers.front()](const Slab& part) {
        vtkIdType all = 1;
        for (const std::size_t n : part.count) all *= vtkIdType(n);
        auto values = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(VTK_DOUBLE));
        values->SetNumberOfTuples(all);
        values->Fill(number);
        return values;
    };
    constexpr double kMostBytes = 4e9; // which the file does not store
    out.array.storedBytes = out.array.statedBytes;
    return out.array.statedBytes <= kMostBytes;
}

/// A record in one iteration: one component, or several of a vector.
struct Record {
    std::vector<Component> components;
    std::vector<std::string> names; ///< of the components; "" of a scalar
    Attributes attributes;
};

/// The unit of exponents of length, mass, time, current, temperature, amount and light.
std::string unitBy(const Attributes& attributes) {
    static constexpr const char* kBases[] = {"m", "kg", "s", "A", "K", "mol", "cd"};
    const std::vector<double> powers = listOf(attributes, "unitDimension", std::size(kBases), 0);
    std::vector<volume::UnitPower> factors;
    for (const std::size_t base : {1u, 0u, 2u, 3u, 4u, 5u, 6u})
        if (powers[base] != 0 && std::abs(powers[base]) < 100)
            factors.push_back({kBases[base], int(std::lround(powers[base]))});
    return factors.empty() ? std::string() : volume::composedUnit(factors).unit;
}

/// The axes of a record, slowest first as stored; empty if they cannot be drawn (cylinders).
std::vector<StoredAxis> axesOf(const Record& record) {
    const Component& first = record.components.front();
    const std::size_t count = first.array.dims.size();
    const std::string geometry = lowered(textOf(record.attributes, "geometry"));
    if (!geometry.empty() && geometry != "cartesian") return {};
    std::vector<std::string> labels;
    std::istringstream words(textOf(record.attributes, "axisLabels"));
    for (std::string word; words >> word;) labels.push_back(word);
    labels.resize(count);
    std::vector<double> spacing = listOf(record.attributes, "gridSpacing", count, 1);
    std::vector<double> offset = listOf(record.attributes, "gridGlobalOffset", count, 0);
    std::vector<double> unit = listOf(record.attributes, "gridUnitSI", count, 1);
    std::vector<double> position = listOf(first.attributes, "position", count, 0);
    for (const Component& other : record.components) // of a staggered grid they differ
        if (listOf(other.attributes, "position", count, 0) != position) position.assign(count, 0);
    if (textOf(record.attributes, "dataOrder") == "F") {
        std::ranges::reverse(labels);
        for (std::vector<double>* list : {&spacing, &offset, &unit, &position}) std::ranges::reverse(*list);
    }
    std::vector<StoredAxis> axes;
    for (std::size_t a = 0; a < count; ++a) {
        StoredAxis axis{labels[a], first.array.dims[a], kindByName(labels[a])};
        if (axis.length > 1'000'000) return {};
        for (std::size_t i = 0; i < axis.length; ++i)
            axis.places.push_back((offset[a] + spacing[a] * (double(i) + position[a])) * unit[a]);
        axis.unit = "m";
        axes.push_back(std::move(axis));
    }
    return axes;
}

/// A record over all iterations on the same axes: [time, (component,) axes].
struct Growing {
    std::vector<StoredAxis> axes;
    std::vector<Record> records;
    std::vector<double> times;
};

int addOwn(ArrayFile& file, const StoredAxis& axis) {
    const auto known = std::ranges::find(file.axes, axis);
    if (known != file.axes.end()) return int(known - file.axes.begin());
    file.axes.push_back(axis);
    return int(file.axes.size()) - 1;
}

StoredArray arrayOver(const std::string& name, const Growing& growing, ArrayFile& file) {
    const Record& first = growing.records.front();
    const bool vector = first.components.size() > 1;
    StoredArray array = first.components.front().array;
    array.name = name;
    array.unit = unitBy(first.attributes);
    array.form.scale *= numberOf(first.components.front().attributes, "unitSI", 1);
    array.dims.insert(array.dims.begin(), growing.records.size());
    array.axes = {addOwn(file, StoredAxis{"time", growing.records.size(), AxisKind::Time, growing.times, {}, "s"})};
    if (vector) {
        array.dims.insert(array.dims.begin() + 1, first.components.size());
        array.axes.push_back(addOwn(file, {"component", first.components.size(), AxisKind::Other}));
    }
    for (const StoredAxis& axis : growing.axes) array.axes.push_back(addOwn(file, axis));
    array.statedBytes *= double(growing.records.size() * first.components.size());
    array.storedBytes = array.statedBytes;
    for (const Record& record : growing.records)
        for (const Component& component : record.components) refuseHollow(component.array);
    array.read = [records = growing.records, vector, type = array.vtkType](const Slab& part) {
        const std::size_t skip = vector ? 2 : 1;
        const Slab inner{Dims(part.first.begin() + long(skip), part.first.end()),
                         Dims(part.count.begin() + long(skip), part.count.end())};
        std::size_t each = 1, to = 0;
        for (const std::size_t n : inner.count) each *= n;
        const std::size_t components = vector ? part.count[1] : 1, from = vector ? part.first[1] : 0;
        auto out = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
        out->SetNumberOfTuples(vtkIdType(part.count[0] * components * each));
        for (std::size_t t = 0; t < part.count[0]; ++t)
            for (std::size_t c = 0; c < components; ++c, to += each) {
                const auto values = records[part.first[0] + t].components[from + c].array.read(inner);
                for (std::size_t i = 0; i < each; ++i)
                    out->SetComponent(vtkIdType(to + i), 0, values->GetComponent(vtkIdType(i), 0));
            }
        return out;
    };
    return array;
}

/// The records of a folder of meshes by name; those that cannot be read are named.
std::map<std::string, Record> recordsIn(const HdfArrays& hdf, const std::string& folder,
                                        std::vector<std::string>& unread) {
    std::map<std::string, Record> out;
    std::map<std::string, std::vector<std::string>> components;
    const auto add = [&](const std::string& path) {
        if (!path.starts_with(folder) || path.size() == folder.size()) return;
        const std::string rest = path.substr(folder.size());
        const std::size_t slash = rest.find('/');
        auto& names = components[rest.substr(0, slash)];
        if (slash != std::string::npos) names.push_back(rest.substr(slash + 1));
    };
    for (const std::string& group : hdf.groups()) add(group);
    for (const HdfDataset& dataset : hdf.datasets()) add(dataset.path);
    for (auto& [name, names] : components) {
        Record record;
        record.attributes = hdf.attributesOf(folder + name);
        if (names.empty()) names.push_back("");
        std::ranges::sort(names);
        for (const std::string& one : names) {
            Component component;
            if (!readComponent(hdf, folder + name + (one.empty() ? "" : "/" + one), component)) continue;
            record.components.push_back(std::move(component));
            record.names.push_back(one);
        }
        if (record.components.empty())
            unread.push_back("\"" + name + "\"");
        else
            out[name] = std::move(record);
    }
    return out;
}

/// A record as arrays to join over time: one of a vector whose components are alike, else one for each component.
std::map<std::string, Record> partsOfRecord(const std::string& name, const Record& record) {
    const auto alike = [&](const Component& other) {
        const Component& first = record.components.front();
        return other.array.dims == first.array.dims && other.array.vtkType == first.array.vtkType &&
               numberOf(other.attributes, "unitSI", 1) == numberOf(first.attributes, "unitSI", 1);
    };
    if (record.names == std::vector<std::string>{"x", "y", "z"} && std::ranges::all_of(record.components, alike))
        return {{name, record}};
    std::map<std::string, Record> out;
    for (std::size_t c = 0; c < record.components.size(); ++c)
        out[record.names[c].empty() ? name : name + "/" + record.names[c]] = {
            {record.components[c]}, {record.names[c]}, record.attributes};
    return out;
}

} // namespace

bool isOpenPmd(const HdfArrays& hdf) {
    return !textOf(hdf.attributesOf(""), "openPMD").empty() && hdf.has("data");
}

ArrayFile readOpenPmd(const HdfArrays& hdf, std::vector<std::string>& notes) {
    ArrayFile file;
    std::string meshes = textOf(hdf.attributesOf(""), "meshesPath");
    if (meshes.empty()) meshes = "meshes/";
    if (!meshes.ends_with('/')) meshes += '/';
    std::map<double, std::string> iterations;
    for (const std::string& group : hdf.groups())
        if (group.starts_with("data/") && group.find('/', 5) == std::string::npos) {
            const Attributes attributes = hdf.attributesOf(group);
            const double time = numberOf(attributes, "time", double(iterations.size()));
            iterations[time * numberOf(attributes, "timeUnitSI", 1)] = group + "/" + meshes;
        }
    std::map<std::string, Growing> all;
    std::vector<std::string> unread;
    bool staggered = false;
    for (const auto& [time, folder] : iterations)
        for (const auto& [name, record] : recordsIn(hdf, folder, unread))
            for (const auto& [part, own] : partsOfRecord(name, record)) {
                const std::vector<StoredAxis> axes = axesOf(own);
                Growing& growing = all[part];
                if (growing.records.empty()) growing.axes = axes;
                if (axes.empty() || axes != growing.axes) {
                    unread.push_back("\"" + part + "\" at " + folder);
                    continue;
                }
                for (const Component& other : own.components)
                    staggered = staggered || listOf(other.attributes, "position", 3, 0) !=
                                                 listOf(own.components.front().attributes, "position", 3, 0);
                growing.records.push_back(own);
                growing.times.push_back(time);
            }
    for (const auto& [name, growing] : all)
        if (!growing.records.empty()) file.arrays.push_back(arrayOver(name, growing, file));
    for (std::size_t i = 0; i < unread.size() && i < 12; ++i) file.unread.push_back(unread[i]);
    if (staggered)
        notes.push_back("components of vectors lie up to half a cell apart (a staggered grid): drawn at one place");
    if (file.arrays.empty()) throw std::runtime_error("follows openPMD, but holds no meshes on even grids");
    return file;
}

} // namespace tessera::importer
