#include "app/importer/meshes/foam_units.h"

#include "app/importer/readers/check_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <vector>

namespace tessera::importer {

namespace fs = std::filesystem;

namespace {

using Exponents = std::array<double, 7>;

/// "m2" for an exponent of 2.
std::string power(std::string_view base, double exponent) {
    std::string out(base);
    if (exponent == 1) return out;
    if (exponent == std::floor(exponent)) return out + std::to_string(int(exponent));
    char text[16];
    std::snprintf(text, sizeof text, "^%g", exponent);
    return out + text;
}

std::string composed(const Exponents& e) {
    static constexpr std::string_view kBases[] = {"kg", "m", "s", "K", "mol", "A", "cd"};
    std::string above, below;
    int denominators = 0;
    for (const std::size_t i : {4u, 0u, 5u, 6u, 1u, 2u, 3u}) { // mol and A first, as is usual
        if (e[i] > 0) above += (above.empty() ? "" : " ") + power(kBases[i], e[i]);
        if (e[i] >= 0) continue;
        below += (below.empty() ? "" : " ") + power(kBases[i], -e[i]);
        ++denominators;
    }
    if (below.empty()) return above;
    return (above.empty() ? "1" : above) + "/" + (denominators > 1 ? "(" + below + ")" : below);
}

} // namespace

bool namesTime(const std::string& folder) {
    char* end = nullptr;
    std::strtod(folder.c_str(), &end);
    return !folder.empty() && end == folder.c_str() + folder.size();
}

std::string unitOfDimensions(std::string_view brackets) {
    Exponents e{};
    const std::string text(brackets.substr(std::min(brackets.size(), brackets.find('[') + 1)));
    const char* at = text.c_str();
    for (double& exponent : e) {
        char* end = nullptr;
        exponent = std::strtod(at, &end);
        if (end == at) break; // only five dimensions are mandatory
        at = end;
    }
    static const struct {
        const char* unit;
        Exponents exponents;
    } kNamed[] = {{"Pa", {1, -1, -2}},
                  {"Pa s", {1, -1, -1}},
                  {"J", {1, 2, -2}},
                  {"N", {1, 1, -2}},
                  {"W", {1, 2, -3}},
                  {"W/m2", {1, 0, -3}},
                  {"W/m3", {1, -1, -3}},
                  {"W/(m K)", {1, 1, -3, -1}},
                  {"J/(kg K)", {0, 2, -2, -1}},
                  {"V", {1, 2, -3, 0, 0, -1}},
                  {"S/m", {-1, -3, 3, 0, 0, 2}},
                  {"J/(m3 K)", {1, -1, -2, -1}},
                  {"J/(mol K)", {1, 2, -2, -1, -1}}};
    for (const auto& [unit, exponents] : kNamed)
        if (exponents == e) return unit;
    return composed(e);
}

std::map<std::string, std::string> foamUnits(const std::string& path) {
    const fs::path given = fs::is_directory(path) ? fs::path(path) : fs::path(path).parent_path();
    const fs::path folder = given.empty() ? fs::path(".") : given;
    std::vector<std::pair<double, fs::path>> times;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        if (entry.is_directory() && namesTime(entry.path().filename().string()))
            times.emplace_back(std::stod(entry.path().filename().string()), entry.path());
    std::sort(times.begin(), times.end());
    std::map<std::string, std::string> units;
    std::set<std::string> differ, seen; // names; files within a time
    for (const auto& [time, root] : times)
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root)) {
            if (!entry.is_regular_file() || !seen.insert(entry.path().lexically_relative(root).string()).second)
                continue;
            const std::string head = readPart(entry.path().string(), 0, 4096);
            const std::size_t at = head.find("\ndimensions");
            if (head.find("FoamFile") == std::string::npos || at == std::string::npos) continue;
            const std::size_t open = head.find('[', at), close = head.find(']', at);
            if (open == std::string::npos || close == std::string::npos) continue;
            const std::string name = entry.path().filename().string();
            const std::string unit = unitOfDimensions(head.substr(open, close - open));
            const auto [known, first] = units.emplace(name, unit);
            if (!first && known->second != unit) differ.insert(name);
        }
    for (const std::string& name : differ) units.erase(name);
    return units;
}

} // namespace tessera::importer
