#include "app/importer/arrays/array_file.h"
#include "app/importer/arrays/conventions.h"
#include "app/importer/arrays/open_arrays.h"
#include "app/importer/zarr/ome_zarr.h"
#include "app/importer/zarr/zarr_array.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

namespace tessera::importer {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::size_t kMostArrays = 10'000;
constexpr int kMostDepth = 8;

/// Folders of arrays, by their names below the first folder.
void findArrays(const fs::path& folder, const std::string& name, int depth,
                std::vector<std::pair<std::string, std::string>>& found) {
    std::error_code failed;
    if (fs::is_regular_file(folder / ".zarray", failed)) {
        found.emplace_back(name.empty() ? "value" : name, folder.string());
        return;
    }
    if (depth == kMostDepth || found.size() > kMostArrays) return;
    std::vector<fs::path> inside;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed))
        if (entry.is_directory(failed)) inside.push_back(entry.path());
    std::sort(inside.begin(), inside.end());
    for (const fs::path& path : inside)
        findArrays(path, (name.empty() ? "" : name + "/") + path.filename().string(), depth + 1, found);
}

/// Attributes of an array as those of NetCDF, which xarray writes to Zarr.
Attributes attributesOf(const json& about) {
    Attributes attributes;
    for (const auto& [name, value] : about.items()) {
        Attribute& attribute = attributes[name];
        if (value.is_string()) attribute.text = value.get<std::string>();
        if (value.is_number()) attribute.numbers = {value.get<double>()};
        attribute.floating = value.is_number_float();
    }
    return attributes;
}

/// Numbers of the axes that xarray names, by name and length; an axis that has an array of its own name has its places.
std::vector<int> axesByNames(const json& about, const ZarrArray& array, ArrayFile& file) {
    const auto names = about.find("_ARRAY_DIMENSIONS");
    if (names == about.end() || !names->is_array() || names->size() != array.shape.size()) return {};
    std::vector<int> axes;
    for (std::size_t n = 0; n < names->size(); ++n) {
        const std::string name = (*names)[n].is_string() ? (*names)[n].get<std::string>() : std::string();
        const auto known = std::ranges::find_if(
            file.axes, [&](const StoredAxis& axis) { return axis.name == name && axis.length == array.shape[n]; });
        axes.push_back(int(known - file.axes.begin()));
        if (known == file.axes.end())
            file.axes.push_back({.name = name, .length = array.shape[n], .kind = kindByName(name)});
    }
    return axes;
}

void addArray(const std::string& name, const std::string& path, ArrayFile& file) {
    const ZarrArray array = openZarrArray(path);
    const json about = zarrJson(path, ".zattrs");
    Attributes attributes = attributesOf(about);
    StoredArray stored{name, shownUnit(textOf(attributes, "units")), array.shape, axesByNames(about, array, file)};
    stored.vtkType = array.vtkType();
    if (!stored.axes.empty() && array.fill) attributes["_FillValue"].numbers = {*array.fill}; // as xarray means it
    stored.form = formBy(attributes, stored.vtkType);
    stored.statedBytes = array.statedBytes();
    stored.storedBytes = array.stored;
    stored.words = wordsOfFlags(attributes);
    stored.read = [array](const Slab& part) { return readZarr(array, part.first, part.count); };
    if (array.shape.size() == 1 && stored.axes.size() == 1 &&
        file.axes[std::size_t(stored.axes[0])].name == leafOf(name)) {
        StoredAxis& axis = file.axes[std::size_t(stored.axes[0])];
        refuseHollow(stored);
        describeAxis(axis, attributes);
        axis.places = valuesBy(stored.form, numbersOf(stored));
        return;
    }
    if (!array.shape.empty()) file.arrays.push_back(std::move(stored));
}

} // namespace

void openPlainZarr(Source& source, const std::string& folder) {
    std::vector<std::pair<std::string, std::string>> found;
    findArrays(folder, "", 0, found);
    ArrayFile file;
    for (const auto& [name, path] : found) {
        try {
            addArray(name, path, file);
        } catch (const std::runtime_error& error) {
            if (found.size() == 1) throw;
            source.notes.push_back("array \"" + name + "\" left out: it " + error.what());
        }
    }
    if (file.arrays.empty()) throw std::runtime_error("holds no array of numbers");
    openArrays(std::move(file), source);
}

} // namespace tessera::importer
