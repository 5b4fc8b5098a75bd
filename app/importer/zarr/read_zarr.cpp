// Folders of Zarr version 2: which of the images or arrays in them is shown.
#include "app/importer/readers/read_files.h"
#include "app/importer/zarr/ome_zarr.h"
#include "app/importer/zarr/zarr_array.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

namespace tessera::importer {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

bool has(const std::string& folder, const char* file) {
    std::error_code missing;
    return fs::is_regular_file(fs::path(folder) / file, missing);
}

/// Folders inside one that are images, those named by numbers in their order.
std::vector<std::string> imagesIn(const std::string& folder) {
    std::vector<std::string> names;
    std::error_code failed;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed))
        if (entry.is_directory(failed) && has(entry.path().string(), ".zattrs") &&
            zarrJson(entry.path().string(), ".zattrs").contains("multiscales"))
            names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end(), [](const std::string& a, const std::string& b) {
        return a.size() != b.size() ? a.size() < b.size() : a < b;
    });
    return names;
}

} // namespace

void openZarr(Source& source) {
    std::string folder = source.path;
    while (folder.size() > 1 && folder.back() == '/') folder.pop_back();
    if (!fs::is_directory(folder))
        throw std::runtime_error("is a file: Zarr is read as a folder (unpack it if it is packed)");
    if (!has(folder, ".zgroup") && !has(folder, ".zarray") && !has(folder, ".zattrs")) {
        if (has(folder, "zarr.json"))
            throw std::runtime_error("is Zarr version 3, which is not read: write it as version 2 (zarr_format=2; "
                                     "OME-Zarr 0.4)");
        throw std::runtime_error("is no Zarr folder: it has neither .zgroup nor .zarray");
    }
    if (has(folder, ".zarray")) return openPlainZarr(source, folder);
    const json about = zarrJson(folder, ".zattrs");
    if (about.contains("multiscales")) return openOmeZarr(source, folder);
    if (about.contains("plate"))
        throw std::runtime_error("is a plate of wells: open the folder of one image in it, such as A/1/0");
    const std::vector<std::string> images = imagesIn(folder);
    if (images.empty()) return openPlainZarr(source, folder);
    if (images.size() > 1)
        source.notes.push_back("the first of " + std::to_string(images.size()) + " images shown, \"" + images.front() +
                               "\"; each is a folder that opens by itself");
    openOmeZarr(source, (fs::path(folder) / images.front()).string());
}

} // namespace tessera::importer
