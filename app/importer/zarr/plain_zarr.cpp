#include "app/importer/arrays/array_file.h"
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

} // namespace

void openPlainZarr(Source& source, const std::string& folder) {
    std::vector<std::pair<std::string, std::string>> found;
    findArrays(folder, "", 0, found);
    std::vector<StoredArray> arrays;
    for (const auto& [name, path] : found) {
        try {
            const ZarrArray array = openZarrArray(path);
            const json about = zarrJson(path, ".zattrs");
            StoredArray stored{name, "", array.shape, array.statedBytes(), array.stored, {}};
            if (const auto unit = about.find("units"); unit != about.end() && unit->is_string())
                stored.unit = unit->get<std::string>();
            stored.read = [array](std::size_t first, std::size_t count) {
                std::vector<std::size_t> begin(array.shape.size(), 0), size = array.shape;
                begin[0] = first;
                size[0] = count;
                return readZarr(array, begin, size);
            };
            if (const StoredForm form = formOf(about, array); form != StoredForm{}) source.stored[name] = form;
            if (!array.shape.empty()) arrays.push_back(std::move(stored));
        } catch (const std::runtime_error& error) {
            if (found.size() == 1) throw;
            source.notes.push_back("array \"" + name + "\" left out: it " + error.what());
        }
    }
    if (arrays.empty()) throw std::runtime_error("holds no array of numbers");
    openArrays(std::move(arrays), source);
}

} // namespace tessera::importer
