#include "codec/container/options_json.h"
#include "codec/pack/pack.h"
#include "codec/unpack/grid_box.h"
#include "volume/field/own_axes.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

/// The extension module `tessera._tessera`: what the Python package of the same folder is made of. Arrays are indexed
/// [z, y, x] with x fastest, sizes and positions are (x, y, z).
namespace tessera::codec {

namespace py = pybind11;

namespace {

using volume::ScalarType;

using Triple = std::array<double, 3>;
using Index = std::array<int, 3>;

Triple tripleOf(glm::dvec3 v) {
    return {v.x, v.y, v.z};
}
glm::ivec3 vectorOf(const Index& i) {
    return {i[0], i[1], i[2]};
}

/// Whether the values of a field are its samples.
bool unscaled(const volume::Field& field) {
    return field.offset == 0 && field.scale == 1;
}

/// Values of a field, and where they are absent (None: nowhere). Samples without scaling keep their type, others are
/// float32.
py::tuple arraysOf(const volume::Field& field) {
    const glm::ivec3 size = field.lattice.size;
    const std::vector<py::ssize_t> shape{size.z, size.y, size.x};
    py::array values;
    volume::dispatch(unscaled(field) ? field.type : ScalarType::F32, [&]<class T>(T) {
        py::array_t<T> out(shape);
        T* to = out.mutable_data();
        if (unscaled(field))
            std::ranges::copy(field.as<T>(), to);
        else
            for (std::size_t i = 0; i < field.count(); ++i) to[i] = static_cast<T>(field.value(i));
        values = std::move(out);
    });
    if (!field.mask) return py::make_tuple(values, py::none());
    py::array_t<bool> absent(shape);
    std::ranges::transform(*field.mask, absent.mutable_data(), [](std::uint8_t present) { return present == 0; });
    return py::make_tuple(values, absent);
}

py::dict dictOf(const volume::Parameter& parameter) {
    py::dict out;
    out["name"] = parameter.name;
    out["unit"] = parameter.unit;
    out["components"] = parameter.components;
    out["categorical"] = parameter.categorical;
    py::dict labels;
    for (const volume::Label& label : parameter.labels) labels[py::int_(label.value)] = label.name;
    out["labels"] = labels;
    py::list ranges;
    for (const Range& range : parameter.ranges) ranges.append(py::make_tuple(range.lo, range.hi));
    out["ranges"] = ranges;
    return out;
}

constexpr const char *kCells = "cells", *kPoints = "points";

/// Per axis None (even), or ("cells" | "points", planes).
py::list axesOf(const volume::AxisMaps& axes) {
    py::list out;
    for (int axis = 0; axis < 3; ++axis)
        if (const volume::AxisMap* map = axes[axis])
            out.append(py::make_tuple(map->of() == volume::AxisMap::Of::Cells ? kCells : kPoints, map->planes()));
        else
            out.append(py::none());
    return out;
}

/// The same read; of `size` samples.
volume::AxisMaps axesFrom(const py::list& axes, glm::ivec3 size) {
    volume::AxisMaps out;
    for (int axis = 0; axis < 3; ++axis) {
        const py::object given = axes[std::size_t(axis)];
        if (given.is_none()) continue;
        auto [of, planes] = given.cast<std::pair<std::string, std::vector<double>>>();
        const std::string name(1, "xyz"[axis]);
        const bool cells = of == kCells;
        if (!cells && of != kPoints) throw Error("axes: " + name + ": planes are of \"cells\" or of \"points\"");
        const std::size_t wanted = std::size_t(size[axis]) + (cells ? 1 : 0);
        if (planes.size() != wanted)
            throw Error("axes: " + name + ": " + std::to_string(planes.size()) + " planes, " +
                        std::to_string(size[axis]) + " samples need " + std::to_string(wanted));
        try {
            out.of[std::size_t(axis)] = std::make_shared<const volume::AxisMap>(
                cells ? volume::AxisMap::Of::Cells : volume::AxisMap::Of::Points, std::move(planes));
        } catch (const Error& error) {
            throw Error("axes: " + name + ": " + error.reason());
        }
    }
    return out;
}

py::dict dictOf(const volume::DatasetInfo& info) {
    py::dict out;
    out["name"] = info.name;
    out["size"] = Index{info.lattice.size.x, info.lattice.size.y, info.lattice.size.z};
    out["spacing"] = tripleOf(info.lattice.spacing);
    out["origin"] = tripleOf(info.lattice.origin);
    out["axes"] = axesOf(info.lattice.axes);
    out["coordinates"] = volume::samplePlaces(info.lattice);
    out["length_unit"] = info.lengthUnit;
    out["times"] = info.times;
    out["time_name"] = info.timeName;
    out["time_unit"] = info.timeUnit;
    py::list parameters;
    for (const volume::Parameter& parameter : info.parameters) parameters.append(dictOf(parameter));
    out["parameters"] = parameters;
    py::list quantities;
    for (const volume::Quantity& quantity : info.quantities)
        quantities.append(py::make_tuple(quantity.name, quantity.unit, quantity.values));
    out["quantities"] = quantities;
    out["provenance"] = info.provenance;
    return out;
}

/// An open archive.
class Reader {
public:
    explicit Reader(const std::string& path) : boxes_(std::make_shared<const Archive>(path)) {}

    py::dict info(int level) const { return dictOf(boxes_.info(level)); }
    int levels() const { return boxes_.archive().grid().levels; }
    std::string lattice() const {
        const Metadata& metadata = boxes_.archive().metadata();
        return metadata.alternating ? "d4"
                                    : std::string(volume::kLatticeNames[std::size_t(metadata.info.lattice.kind)]);
    }
    bool lossless() const { return boxes_.archive().metadata().lossless; }
    double maxError() const { return boxes_.archive().metadata().maxError; }
    py::tuple read(int parameter, int component, int time, int level, const Index& begin, const Index& end) const {
        volume::Field field;
        {
            const py::gil_scoped_release others;
            field = boxes_.read(parameter, component, time, level, vectorOf(begin), vectorOf(end));
        }
        return arraysOf(field);
    }

private:
    GridBoxes boxes_;
};

/// A parameter to write: samples [time, z, y, x, component], contiguous, and where they are absent (or an empty array).
struct Given {
    volume::Parameter about;
    py::array samples;
    py::array_t<std::uint8_t> absent;
};

ScalarType typeOf(const py::array& samples) {
    const std::string word = py::str(samples.dtype());
    const std::optional<ScalarType> type = volume::parseScalarType(word);
    if (!type) throw Error("samples of type " + word + " are not stored: use uint8, int16, uint16, int32 or float32");
    return *type;
}

/// One component at one time.
volume::Field frameOf(const Given& given, const volume::Lattice& lattice, int component, int time) {
    volume::Field field = volume::makeField(lattice, given.about.type);
    const std::size_t count = field.count(), components = std::size_t(given.about.components);
    const std::size_t first = std::size_t(time) * count * components + std::size_t(component);
    volume::dispatch(given.about.type, [&]<class T>(T) {
        const T* from = static_cast<const T*>(given.samples.data()) + first;
        for (const auto to = field.as<T>(); T & each : to) each = *from, from += components;
    });
    if (given.absent.size() == 0) return field;
    volume::Mask mask(count);
    const std::uint8_t* absent = given.absent.data() + first;
    for (std::uint8_t& each : mask) each = *absent == 0, absent += components;
    field.mask = std::make_shared<const volume::Mask>(std::move(mask));
    return field;
}

/// Options as in the metadata of an archive. Reading those is tolerant; here what is not taken as given is an error.
PackOptions optionsOf(const std::string& text) {
    const nlohmann::json given = nlohmann::json::parse(text);
    const PackOptions options = optionsFromJson(given);
    const nlohmann::json taken = toJson(options);
    for (const auto& [key, value] : given.items())
        if (!taken.contains(key) || taken[key] != value)
            throw Error("the option " + key + " = " + value.dump() + " is unknown, not allowed, or the default");
    return options;
}

/// Packs arrays into an archive. `about` has the keys of info(); options as in the metadata of an archive.
void write(const std::string& path, const py::dict& about, const py::list& parameters, const std::string& options) {
    volume::Dataset dataset;
    const auto size = about["size"].cast<Index>();
    const auto spacing = about["spacing"].cast<Triple>(), origin = about["origin"].cast<Triple>();
    volume::Lattice& lattice = dataset.info.lattice;
    lattice.size = vectorOf(size);
    lattice.spacing = {spacing[0], spacing[1], spacing[2]};
    lattice.origin = {origin[0], origin[1], origin[2]};
    lattice = volume::withAxes(lattice, axesFrom(about["axes"].cast<py::list>(), lattice.size));
    dataset.info.bounds = volume::gridBounds(lattice);
    dataset.info.name = about["name"].cast<std::string>();
    dataset.info.lengthUnit = about["length_unit"].cast<std::string>();
    dataset.info.times = about["times"].cast<std::vector<double>>();
    dataset.info.timeName = about["time_name"].cast<std::string>();
    dataset.info.timeUnit = about["time_unit"].cast<std::string>();
    for (const py::handle& each : about["quantities"]) {
        const auto [name, unit, values] = each.cast<std::tuple<std::string, std::string, std::vector<double>>>();
        dataset.info.quantities.push_back({name, unit, values});
    }
    std::vector<Given> given;
    for (const py::handle& each : parameters) {
        const auto parameter = each.cast<py::dict>();
        Given one{{}, parameter["samples"].cast<py::array>(), parameter["absent"].cast<py::array_t<std::uint8_t>>()};
        one.about.name = parameter["name"].cast<std::string>();
        one.about.unit = parameter["unit"].cast<std::string>();
        one.about.components = int(one.samples.shape(4));
        one.about.categorical = parameter["categorical"].cast<bool>();
        for (const auto& [value, name] : parameter["labels"].cast<std::map<int, std::string>>())
            one.about.labels.push_back({value, name});
        one.about.type = typeOf(one.samples);
        dataset.info.parameters.push_back(one.about);
        given.push_back(std::move(one));
    }
    dataset.read = [&given, lattice](int parameter, int component, int time) {
        return frameOf(given[std::size_t(parameter)], lattice, component, time);
    };
    const PackOptions packed = optionsOf(options);
    const py::gil_scoped_release others;
    pack(dataset, packed, path);
}

} // namespace

} // namespace tessera::codec

PYBIND11_MODULE(_tessera, module) {
    namespace py = pybind11;
    using tessera::codec::Reader;
    py::register_exception<tessera::Error>(module, "Error", PyExc_OSError);
    py::class_<Reader>(module, "Reader")
        .def(py::init<const std::string&>())
        .def("info", &Reader::info)
        .def("read", &Reader::read)
        .def_property_readonly("levels", &Reader::levels)
        .def_property_readonly("lattice", &Reader::lattice)
        .def_property_readonly("lossless", &Reader::lossless)
        .def_property_readonly("max_error", &Reader::maxError);
    module.def("write", &tessera::codec::write);
}
