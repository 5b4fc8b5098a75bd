#include "volume/import/files/folder.h"

#include "volume/base/error.h"
#include "volume/import/files/formats.h"
#include "volume/import/files/series.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>

namespace tessera::volume {

namespace fs = std::filesystem;

namespace {

std::string endingOf(const std::string& path) {
    std::string text = fs::path(path).extension().string();
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

} // namespace

std::vector<std::string> filesOfFolder(const std::string& folder) {
    std::map<std::string, std::vector<std::string>> byEnding;
    std::map<const FileFormat*, std::vector<std::string>> byFormat;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with(".")) continue;
        if (!entry.is_regular_file() && !isZarrFolder(entry.path().string())) continue;
        byEnding[endingOf(name)].push_back(entry.path().string());
        const FileFormat* format =
            endingOf(name) == ".txt" ? nullptr : formatOfFile(entry.path().string()); // usually plain text
        if (format != nullptr && format->advice.empty()) byFormat[format].push_back(entry.path().string());
    }
    if (isFoamCase(folder)) { // any .foam file stands for it
        std::vector<std::string>& named = byEnding[".foam"];
        std::ranges::sort(named);
        return {named.empty() ? folder : named.front()};
    }
    for (const char* list : {".foam", ".pvd", ".series"})
        if (const auto at = byEnding.find(list); at != byEnding.end()) {
            if (at->second.size() > 1) throw Error("holds several " + std::string(list) + " files, name one", folder);
            return at->second;
        }
    std::vector<std::string> best; // others are the samples of a header beside them
    for (const std::string& path : byEnding[".raw"])
        if (fs::exists(fs::path(path).replace_extension(".json"))) best.push_back(path);
    const auto choose = [&](bool pictures) {
        for (const auto& [format, paths] : byFormat) // in the order of the table
            if (isPicture(*format) == pictures && paths.size() > best.size()) best = paths;
    };
    choose(false);
    if (best.empty()) { // pictures, which may also stand beside data, and beside the stack: a logo
        choose(true);
        std::map<std::string, std::size_t> alike;
        for (const std::string& path : best) ++alike[numberedName(path).pattern];
        const auto single = [&](const std::string& path) { return alike[numberedName(path).pattern] == 1; };
        if (!std::ranges::all_of(best, single)) std::erase_if(best, single);
    }
    const auto is = [](const char* kind) { return [kind](const std::string& path) { return path.ends_with(kind); }; };
    if (std::ranges::any_of(best, is(".cas.h5"))) std::erase_if(best, is(".dat.h5")); // Fluent's cases open their data
    if (best.empty()) best = byEnding[".raw"];
    if (best.empty()) throw Error("holds no data file", folder);
    std::sort(best.begin(), best.end());
    return best;
}

} // namespace tessera::volume
