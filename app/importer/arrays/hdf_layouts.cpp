#include "app/importer/arrays/hdf_layouts.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

namespace tessera::importer {

namespace {

/// What a file says of one axis of a data set.
struct AxisHint {
    std::string name;                   ///< "" = nothing
    const HdfDataset* places = nullptr; ///< null = none
    AxisKind kind = AxisKind::Unknown;
    double step = 0; ///< between samples; 0 = not stated
    std::string unit = {};
};
using Hints = std::vector<AxisHint>;

/// "theta:y:x" or "[y, x]" as words.
std::vector<std::string> wordsOf(std::string text) {
    std::ranges::replace_if(
        text, [](char c) { return c == ':' || c == ',' || c == '[' || c == ']' || c == '"'; }, ' ');
    std::vector<std::string> words;
    std::istringstream in(text);
    for (std::string word; in >> word;) words.push_back(word);
    return words;
}

std::string groupOf(const std::string& path) {
    const std::size_t slash = path.rfind('/');
    return slash == std::string::npos ? "" : path.substr(0, slash + 1);
}

/// Axes by names that are data sets beside this one, where there are some.
Hints hintsByNames(const HdfArrays& hdf, const HdfDataset& dataset, const std::vector<std::string>& names,
                   const std::string& group) {
    if (names.size() > dataset.dims.size()) return {};
    Hints hints(dataset.dims.size());
    for (std::size_t a = 0; a < names.size(); ++a) {
        if (names[a] == "." || names[a].empty()) continue;
        hints[a].name = group + names[a];
        const HdfDataset* places = hdf.find(group + names[a]);
        if (places != nullptr && places->vtkType != VTK_VOID && places->dims.size() == 1) hints[a].places = places;
    }
    return hints;
}

/// The axes of the signals of all groups NXdata, by key.
std::map<std::string, Hints> nexusHints(const HdfArrays& hdf) {
    std::map<std::string, Hints> out;
    for (const std::string& path : hdf.groups()) {
        const Attributes attributes = hdf.attributesOf(path);
        const std::string group = path.empty() ? "" : path + "/";
        std::vector<std::string> signals = wordsOf(textOf(attributes, "signal"));
        for (const std::string& more : wordsOf(textOf(attributes, "auxiliary_signals"))) signals.push_back(more);
        const std::vector<std::string> axes = wordsOf(textOf(attributes, "axes"));
        for (const std::string& name : signals) {
            const HdfDataset* signal = hdf.find(group + name);
            if (signal == nullptr) continue;
            Hints hints = hintsByNames(hdf, *signal, axes, group);
            for (std::size_t a = 0; a < axes.size() && !hints.empty(); ++a) { // an index may be stated
                const auto at = attributes.find(axes[a] + "_indices");
                if (at == attributes.end() || at->second.numbers.size() != 1) continue;
                const double index = at->second.numbers.front();
                if (index < 0 || index >= double(hints.size()) || index == double(a)) continue;
                hints[std::size_t(index)] = hintsByNames(hdf, *signal, {axes[a]}, group).front();
            }
            out[signal->key] = std::move(hints);
        }
    }
    return out;
}

/// "axistags" of vigra: JSON with a key for each axis, and its resolution.
Hints tagHints(const HdfDataset& dataset) {
    const std::string text = textOf(dataset.attributes, "axistags");
    if (text.empty()) return {};
    const nlohmann::json tags = nlohmann::json::parse(text, nullptr, false);
    const auto list = tags.is_object() ? tags.find("axes") : tags.end();
    if (!tags.is_object() || list == tags.end() || !list->is_array() || list->size() != dataset.dims.size()) return {};
    Hints hints;
    for (const nlohmann::json& tag : *list) {
        AxisHint hint;
        if (tag.is_object() && tag.contains("key") && tag["key"].is_string()) hint.name = tag["key"].get<std::string>();
        if (tag.is_object() && tag.contains("resolution") && tag["resolution"].is_number())
            hint.step = tag["resolution"].get<double>();
        hints.push_back(hint);
    }
    return hints;
}

/// Whether a scale only names an axis, without places.
bool namesOnly(const HdfDataset& scale) {
    return textOf(scale.attributes, "NAME").starts_with("This is a netCDF dimension but not");
}

Hints scaleHints(const HdfArrays& hdf, const HdfDataset& dataset) {
    Hints hints(dataset.dims.size());
    for (std::size_t a = 0; a < hints.size(); ++a) {
        if (a < dataset.labels.size()) hints[a].name = dataset.labels[a];
        const HdfDataset* scale = a < dataset.scales.size() ? hdf.findKey(dataset.scales[a]) : nullptr;
        if (scale == nullptr) continue;
        if (hints[a].name.empty()) hints[a].name = scale->path;
        if (scale->vtkType != VTK_VOID && !namesOnly(*scale)) hints[a].places = scale;
    }
    return hints;
}

Hints hintsOf(const HdfArrays& hdf, const HdfDataset& dataset, const std::map<std::string, Hints>& nexus) {
    if (const auto at = nexus.find(dataset.key); at != nexus.end()) return at->second;
    Hints hints = tagHints(dataset);
    if (!hints.empty()) return hints;
    if (!dataset.scales.empty() || !dataset.labels.empty()) return scaleHints(hdf, dataset);
    return hintsByNames(hdf, dataset, wordsOf(textOf(dataset.attributes, "axes")), groupOf(dataset.path));
}

/// The axis that a hint describes; equal ones are one.
int axisBy(const HdfArrays& hdf, const AxisHint& hint, std::size_t length, ArrayFile& file,
           std::set<std::string>& used) {
    StoredAxis axis{hint.name, length};
    axis.kind = kindByName(hint.name);
    if (hint.step > 0 && length < 10'000'000)
        for (std::size_t i = 0; i < length; ++i) axis.places.push_back(double(i) * hint.step);
    const HdfDataset* places = hint.places;
    if (places != nullptr && places->dims == Dims{length}) {
        describeAxis(axis, places->attributes);
        if (axis.kind == AxisKind::Unknown) axis.kind = kindByName(places->path);
        axis.places = hdf.numbers(*places);
        used.insert(places->key);
    } else if (places != nullptr && places->dims == Dims{length + 1}) { // of the faces of cells
        describeAxis(axis, places->attributes);
        axis.faces = hdf.numbers(*places);
        for (std::size_t i = 0; i < length; ++i) axis.places.push_back((axis.faces[i] + axis.faces[i + 1]) / 2);
        used.insert(places->key);
    }
    const auto known = std::ranges::find(file.axes, axis);
    if (known != file.axes.end()) return int(known - file.axes.begin());
    file.axes.push_back(std::move(axis));
    return int(file.axes.size()) - 1;
}

/// The axis of the arrays along which a one-dimensional data set lies, by its scale; -1 = none.
int knownAxis(const HdfArrays& hdf, const HdfDataset& dataset, const ArrayFile& file) {
    const HdfDataset* scale = dataset.scales.empty() ? nullptr : hdf.findKey(dataset.scales.front());
    for (std::size_t a = 0; scale != nullptr && a < file.axes.size(); ++a)
        if (leafOf(scale->path) == leafOf(file.axes[a].name) && file.axes[a].length == dataset.dims[0]) return int(a);
    return -1;
}

} // namespace

ArrayFile readHdfArrays(const HdfArrays& hdf) {
    ArrayFile file;
    const std::map<std::string, Hints> nexus = nexusHints(hdf);
    std::set<std::string> used;
    std::vector<std::pair<StoredArray, std::string>> arrays;
    for (const HdfDataset& dataset : hdf.datasets()) {
        if (!dataset.problem.empty()) {
            file.unread.push_back("\"" + dataset.path + "\" (" + dataset.problem + ")");
            continue;
        }
        StoredArray array = hdf.arrayOf(dataset);
        const Hints hints = dataset.dims.size() < 2 ? Hints() : hintsOf(hdf, dataset, nexus);
        const bool any = std::ranges::any_of(hints, [](const AxisHint& hint) { return !hint.name.empty(); });
        for (std::size_t a = 0; any && a < hints.size(); ++a)
            array.axes.push_back(axisBy(hdf, hints[a], dataset.dims[a], file, used));
        array.chosen = dataset.path == "exchange/data" || nexus.contains(dataset.key);
        arrays.emplace_back(std::move(array), dataset.key);
    }
    for (auto& [array, key] : arrays) {
        const HdfDataset* dataset = hdf.findKey(key);
        if (used.contains(key) || (dataset != nullptr && namesOnly(*dataset))) continue;
        if (dataset != nullptr && array.dims.size() == 1)
            if (const int axis = knownAxis(hdf, *dataset, file); axis >= 0) array.axes = {axis};
        file.arrays.push_back(std::move(array));
    }
    return file;
}

} // namespace tessera::importer
