#include "volume/export/export_formats.h"
#include "volume/field/axes_json.h"
#include "volume/field/labels.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

namespace tessera::volume {

namespace fs = std::filesystem;

namespace {

/// The stored number that marks absent samples of one component, since .raw keeps stored numbers bit for bit.
struct Marker {
    bool works = true;           ///< false: a present sample has this number, or absent ones have several
    std::optional<double> value; ///< none: nothing is absent, or NaN marks it
    bool converted = false;      ///< some frame is converted when written
};

Marker markerOf(const Dataset& dataset, int parameter, int component, const std::vector<int>& times,
                const Storage& storage) {
    Marker marker;
    for (const int time : times) {
        const Field field = dataset.read(parameter, component, time);
        marker.converted = marker.converted || !isStoredAs(field, component, storage);
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
        const Field field = dataset.read(parameter, component, time);
        dispatch(field.type, [&]<class T>(T) {
            const auto stored = field.as<T>();
            for (std::size_t i = 0; i < stored.size() && marker.works; ++i)
                marker.works = !field.present(i) || static_cast<double>(stored[i]) != *marker.value;
        });
    }
    return marker;
}

/// How a parameter is written.
struct Form {
    Storage storage;
    bool converted = false;     ///< to physical floats, NaN where absent
    std::vector<Marker> marker; ///< of each component
};

Form formOf(const Dataset& dataset, int parameter, const std::vector<int>& times) {
    Form form{storageOf(dataset, parameter, times), false, {}};
    const int components = dataset.info.parameters[std::size_t(parameter)].components;
    bool marked = true;
    for (int c = 0; c < components; ++c) {
        form.marker.push_back(markerOf(dataset, parameter, c, times, form.storage));
        marked = marked && form.marker.back().works;
        form.converted = form.converted || form.marker.back().converted;
    }
    if (!marked && !form.converted) form.converted = !masksAgree(dataset, parameter, times);
    if (form.converted) form.storage = floatStorage(components);
    form.storage.presence = !marked && !form.converted;
    if (!marked || form.converted) form.marker.assign(form.marker.size(), {});
    return form;
}

using OrderedJson = nlohmann::ordered_json;

/// The sidecar's list of components.
OrderedJson componentsOf(const DatasetInfo& info, const std::vector<int>& parameters, const std::vector<Form>& forms) {
    OrderedJson components = OrderedJson::array();
    const auto add = [&](const std::string& componentName, const std::string& unit, ScalarType type) -> OrderedJson& {
        OrderedJson entry;
        entry["name"] = componentName;
        entry["unit"] = unit;
        if (type != forms.front().storage.type) entry["dtype"] = name(type);
        components.push_back(std::move(entry));
        return components.back();
    };
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        const Parameter& what = info.parameters[std::size_t(parameters[i])];
        for (int c = 0; c < what.components; ++c) {
            const std::string suffix = what.components == 1 ? ""
                                       : c < 3              ? std::string(".") + "xyz"[c]
                                                            : "." + std::to_string(c);
            OrderedJson& entry = add(what.name + suffix, what.unitGuessed ? "" : what.unit, forms[i].storage.type);
            const Scaling& scaling = forms[i].storage.scaling[std::size_t(c)];
            if (scaling.scale != 1) entry["scale"] = scaling.scale;
            if (scaling.offset != 0) entry["offset"] = scaling.offset;
            const Marker& marker = forms[i].marker[std::size_t(c)];
            if (marker.value) entry["missing_value"] = *marker.value;
            if (what.categorical) entry["categorical"] = true;
            for (const Label& label : what.labels) entry["labels"][std::to_string(label.value)] = labelText(label);
        }
        if (forms[i].storage.presence) add(what.name + ".present", "", ScalarType::U8)["presence_of"] = what.name;
    }
    return components;
}

/// Writes every frame; returns the bytes written.
std::uint64_t writeFrames(const Dataset& dataset, const std::vector<int>& parameters, const std::vector<Form>& forms,
                          const std::vector<int>& times, AtomicFile& file, const Progress& progress) {
    double written = 0, done = 0;
    for (const int t : times)
        for (std::size_t i = 0; i < parameters.size(); ++i) {
            const Parameter& what = dataset.info.parameters[std::size_t(parameters[i])];
            progress.advance(done++ / double(times.size() * parameters.size()), what.name);
            Field field;
            for (int c = 0; c < what.components; ++c) {
                field = forms[i].converted
                            ? loadAs(dataset, parameters[i], c, t, forms[i].storage)
                            : dataset.read(parameters[i], c, t); // keeps the stored numbers of absent samples
                writeField(file, field);
                written += double(field.samples.size());
            }
            if (forms[i].storage.presence) {
                const auto flags = presenceOf(field);
                file.write(flags.data(), flags.size());
                written += double(flags.size());
            }
        }
    return static_cast<std::uint64_t>(written);
}

/// The sidecar's list of quantities.
OrderedJson quantitiesOf(const DatasetInfo& info, const std::vector<int>& times) {
    OrderedJson quantities;
    for (const Quantity& quantity : info.quantities) {
        OrderedJson values = OrderedJson::array();
        for (const int t : times) {
            const double value = quantity.values[std::size_t(t)];
            values.push_back(std::isfinite(value) ? OrderedJson(value) : OrderedJson());
        }
        quantities.push_back({{"name", quantity.name}, {"unit", quantity.unit}, {"values", values}});
    }
    return quantities;
}

} // namespace

std::vector<std::string> writeRaw(const Dataset& dataset, const std::vector<int>& parameters,
                                  const std::vector<int>& times, const fs::path& path, const Progress& progress) {
    const DatasetInfo& info = dataset.info;
    fs::path raw = path, sidecar = path;
    raw.replace_extension(".raw");
    sidecar.replace_extension(".json");
    std::vector<Form> forms;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        progress.advance(0.3 * double(i) / double(parameters.size()), "forms");
        forms.push_back(formOf(dataset, parameters[i], times));
    }
    AtomicFile file(raw.string());
    const std::uint64_t bytes = writeFrames(dataset, parameters, forms, times, file, progress.part(0.3, 1));
    OrderedJson out;
    out["name"] = info.name;
    out["file"] = raw.filename().string();
    const Lattice& lattice = info.lattice;
    out["dims"] = {lattice.size.x, lattice.size.y, lattice.size.z};
    out["dtype"] = name(forms.front().storage.type);
    out["byte_order"] = "little";
    out["layout"] = "[time][component][z][y][x], x fastest";
    out["spacing"] = {lattice.spacing.x, lattice.spacing.y, lattice.spacing.z};
    out["origin"] = {lattice.origin.x, lattice.origin.y, lattice.origin.z};
    if (!lattice.isEven()) out["axes"] = OrderedJson::parse(axesJson(lattice.axes));
    out["length_unit"] = info.lengthUnit;
    if (info.axisUnits != std::array<std::string, 3>{}) out["axis_units"] = info.axisUnits;
    out["components"] = componentsOf(info, parameters, forms);
    out["times"] = OrderedJson::array();
    for (const int t : times) out["times"].push_back(info.times[std::size_t(t)]);
    out["time_name"] = info.timeName;
    out["time_unit"] = info.timeUnit;
    if (!info.quantities.empty()) out["quantities"] = quantitiesOf(info, times);
    out["missing_value"] = nullptr;
    out["bytes"] = bytes;
    if (!info.provenance.empty()) out["provenance"] = info.provenance;
    AtomicFile words(sidecar.string());
    words.write(out.dump(1, ' ', false, OrderedJson::error_handler_t::replace) + "\n");
    file.commit();
    words.commit();
    return {raw.string(), sidecar.string()};
}

} // namespace tessera::volume
