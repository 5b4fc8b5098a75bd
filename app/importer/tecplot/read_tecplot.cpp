// Tecplot, text and binary. Not read by VTK, whose reader fills truncated files with 0 and ignores times.
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"
#include "app/importer/tecplot/tecplot_words.h"
#include "app/importer/tecplot/tecplot_zones.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace tessera::importer {

namespace fs = std::filesystem;

namespace {

TecplotFile readTecplotFile(const std::string& path) {
    const std::string head = readPart(path, 0, 512);
    if (head.starts_with("#!TDV")) return readBinaryTecplot(path);
    if (head.starts_with("#!SZPLT"))
        throw std::runtime_error("has subzones (.szplt), which are not read: write it as binary Tecplot (.plt)");
    if (head.find("(0 \"") != std::string::npos || head.starts_with("("))
        throw std::runtime_error("holds the values of a Fluent case: open the .cas file of the same name");
    return readAsciiTecplot(path);
}

/// The grid that belongs to a file with a solution alone: the only one beside it, or the one most alike in name.
std::string gridBeside(const std::string& path) {
    const fs::path folder = fs::path(path).parent_path().empty() ? fs::path(".") : fs::path(path).parent_path();
    std::vector<std::pair<std::size_t, std::string>> found;
    const std::string own = fs::path(path).filename().string();
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string(), kind = entry.path().extension().string();
        if (name == own || !entry.is_regular_file() ||
            (kind != ".plt" && kind != ".dat" && kind != ".tec" && kind != ".tp"))
            continue;
        const std::string place = (fs::path(path).parent_path() / name).string();
        const std::string head = readPart(place, 0, 4096);
        const std::string words = upper(head);
        const std::size_t stated = words.find("FILETYPE");
        const bool text =
            stated != std::string::npos && words.find_first_not_of(" \t=", stated + 8) == words.find("GRID", stated);
        const bool binary = head.starts_with("#!TDV") && isTecplotGrid(head);
        if (!text && !binary) continue;
        const auto same =
            std::size_t(std::mismatch(own.begin(), own.end(), name.begin(), name.end()).first - own.begin());
        found.emplace_back(same, place);
    }
    if (found.empty())
        throw std::runtime_error("holds a solution without its grid, and no file with a grid (file type GRID) lies "
                                 "beside it");
    return std::ranges::max_element(found, {}, [](const auto& one) { return one.first; })->second;
}

/// Puts the variables of the grid in front of those of the solution, zone by zone; the zones of a grid that has fewer
/// are used again.
void joinGrid(const TecplotFile& grid, TecplotFile& file) {
    const std::size_t of = grid.headings.size();
    if (grid.zones.empty() || file.zones.size() % grid.zones.size() != 0)
        throw std::runtime_error("has " + std::to_string(file.zones.size()) + " zones, its grid " +
                                 std::to_string(grid.zones.size()));
    file.headings.insert(file.headings.begin(), grid.headings.begin(), grid.headings.end());
    for (std::size_t z = 0; z < file.zones.size(); ++z) {
        TecplotZone& zone = file.zones[z];
        const TecplotZone& from = grid.zones[z % grid.zones.size()];
        if (from.points != zone.points || from.cells != zone.cells)
            throw std::runtime_error("has a zone of another size than its grid");
        zone.types.insert(zone.types.begin(), from.types.begin(), from.types.end());
        zone.ofCells.insert(zone.ofCells.begin(), from.ofCells.begin(), from.ofCells.end());
        zone.values = [of, own = zone.values, places = from.values](std::size_t variable) {
            return variable < of ? places(variable) : own(variable - of);
        };
        zone.corners = from.corners;
        zone.faces = from.faces;
    }
}

} // namespace

void openTecplot(Source& source) {
    TecplotFile file = readTecplotFile(source.path);
    if (file.solution) {
        const std::string path = gridBeside(source.path);
        const TecplotFile grid = readTecplotFile(path);
        joinGrid(grid, file);
        source.notes.push_back("holds a solution alone: its grid is that of " + fs::path(path).filename().string());
    } else if (file.grid) {
        bool any = false;
        for (const Heading& heading : file.headings) any = any || axisOf(heading.name) < 0;
        if (!any) throw std::runtime_error("holds a grid without values: open the file with its solution");
    }
    if (file.drawings) source.notes.push_back("its texts and drawings are left out");
    giveZones(std::move(file.headings), std::move(file.zones), source);
}

} // namespace tessera::importer
