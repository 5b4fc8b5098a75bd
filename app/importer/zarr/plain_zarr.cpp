#include "app/importer/arrays/array_file.h"
#include "app/importer/arrays/conventions.h"
#include "app/importer/zarr/ome_zarr.h"
#include "app/importer/zarr/zarr_array.h"

#include <algorithm>
#include <cmath>
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

/// How xarray says what the stored numbers mean. Only there the fill value is no value.
StoredForm formOf(const json& about, const ZarrArray& array) {
    StoredForm form;
    const auto number = [&](const char* key, double other) {
        const auto at = about.find(key);
        return at != about.end() && at->is_number() ? at->get<double>() : other;
    };
    form.scale = number("scale_factor", 1);
    form.offset = number("add_offset", 0);
    if (about.contains("_ARRAY_DIMENSIONS") && array.fill && !std::isnan(*array.fill)) form.fill = {*array.fill};
    return form;
}

/// The axes that xarray names, as indices of the file's; none where it names none.
std::vector<int> axesOf(const json& about, const ZarrArray& array, ArrayFile& file) {
    const auto names = about.find("_ARRAY_DIMENSIONS");
    if (names == about.end() || !names->is_array() || names->size() != array.shape.size()) return {};
    std::vector<int> axes;
    for (std::size_t d = 0; d < array.shape.size(); ++d) {
        if (!(*names)[d].is_string()) return {};
        const auto name = (*names)[d].get<std::string>();
        const auto known = std::ranges::find_if(
            file.axes, [&](const StoredAxis& axis) { return axis.name == name && axis.length == array.shape[d]; });
        axes.push_back(int(known - file.axes.begin()));
        if (known == file.axes.end()) file.axes.push_back({name, array.shape[d], kindByName(name)});
    }
    return axes;
}

/// Arrays named like their only axis are its places.
void placeAxes(ArrayFile& file) {
    std::erase_if(file.arrays, [&](const StoredArray& array) {
        if (array.axes.size() != 1) return false;
        StoredAxis& axis = file.axes[std::size_t(array.axes.front())];
        if (array.name != axis.name) return false;
        refuseHollow(array);
        axis.places = valuesBy(array.form, numbersOf(array));
        axis.unit = array.unit;
        return true;
    });
}

} // namespace

void openPlainZarr(Source& source, const std::string& folder) {
    std::vector<std::pair<std::string, std::string>> found;
    findArrays(folder, "", 0, found);
    ArrayFile file;
    for (const auto& [name, path] : found) {
        try {
            const ZarrArray array = openZarrArray(path);
            const json about = zarrJson(path, ".zattrs");
            if (array.shape.empty()) continue;
            StoredArray stored{.name = name, .unit = "", .dims = array.shape, .axes = axesOf(about, array, file)};
            stored.vtkType = array.vtkType();
            stored.form = formOf(about, array);
            stored.statedBytes = array.statedBytes();
            stored.storedBytes = array.stored;
            if (const auto unit = about.find("units"); unit != about.end() && unit->is_string())
                stored.unit = unit->get<std::string>();
            stored.read = [array](const Slab& part) { return readZarr(array, part.first, part.count); };
            file.arrays.push_back(std::move(stored));
        } catch (const std::runtime_error& error) {
            if (found.size() == 1) throw;
            source.notes.push_back("array \"" + name + "\" left out: it " + error.what());
        }
    }
    if (file.arrays.empty()) throw std::runtime_error("holds no array of numbers");
    placeAxes(file);
    openArrays(std::move(file), source);
}

} // namespace tessera::importer
