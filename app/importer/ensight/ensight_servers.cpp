#include "app/importer/ensight/ensight_case.h"
#include "app/importer/readers/check_file.h"
#include "volume/base/trimmed.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <sstream>
#include <stdexcept>

namespace tessera::importer {

namespace fs = std::filesystem;

namespace {

std::string lowered(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

} // namespace

std::vector<std::string> casesOfServers(const std::string& path) {
    std::istringstream in(readWhole(path));
    std::vector<std::string> cases;
    std::string folder, named;
    const auto add = [&] {
        if (named.empty()) return;
        const std::string beside = besides(path, named);
        cases.push_back(fs::exists(beside) || folder.empty() ? beside
                                                             : besides(path, (fs::path(folder) / named).string()));
        named.clear();
        folder.clear();
    };
    for (std::string line; std::getline(in, line);) {
        const std::size_t colon = line.find(':');
        if (colon == std::string::npos) continue;
        const std::string key = std::string(volume::trimmed(lowered(line.substr(0, colon))));
        std::string value = std::string(volume::trimmed(line.substr(colon + 1)));
        if (value.starts_with('"') && value.ends_with('"') && value.size() > 1)
            value = value.substr(1, value.size() - 2);
        if (key == "machine id") add();
        if (key == "data_path" || key == "data path") folder = value;
        if (key == "casefile") named = value;
    }
    add();
    if (cases.empty()) throw std::runtime_error("names no case file (casefile:)");
    return cases;
}

} // namespace tessera::importer
