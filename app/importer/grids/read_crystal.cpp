// Grids of crystals as text: XSF of XCrySDen, and CHGCAR, LOCPOT, ELFCAR, PARCHG of VASP.
#include "app/importer/grids/grid_file.h"
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <vtkPointData.h>

namespace tessera::importer {

namespace {

struct CrystalGrid {
    glm::ivec3 size{1};
    glm::dvec3 origin{0};
    glm::dmat3 steps{1};
    std::vector<std::string> names;
    std::vector<std::size_t> begins; ///< of the numbers of each, x fastest
    bool fits(const CrystalGrid& other) const {
        return size == other.size && origin == other.origin && steps == other.steps;
    }
};

vtkSmartPointer<vtkDataObject> readCrystal(const std::string& path, const CrystalGrid& grid) {
    const std::string text = wholeGridText(path);
    auto image = gridImage(grid.size, grid.origin, grid.steps);
    const std::size_t count = samplesOfText(grid.size, grid.names.size(), text.size());
    for (std::size_t a = 0; a < grid.names.size(); ++a) {
        auto array = pixelArray(VTK_FLOAT, count, grid.names[a]);
        auto* values = static_cast<float*>(array->GetVoidPointer(0));
        GridWords words(std::string_view(text).substr(std::min(text.size(), grid.begins[a])));
        for (std::size_t i = 0; i < count; ++i) values[i] = float(words.number());
        image->GetPointData()->AddArray(array);
    }
    return image;
}

void skipNumbers(GridWords& words, glm::ivec3 size) {
    const double count = double(size.x) * size.y * size.z;
    for (double i = 0; i < count; ++i)
        if (words.word().empty()) throw std::runtime_error("ends early: holds fewer numbers than it announces");
}

std::string upper(std::string_view word) {
    std::string out(word);
    for (char& c : out) c = char(std::toupper(static_cast<unsigned char>(c)));
    return out;
}

/// The next line that says something.
std::string_view lineOf(GridWords& words) {
    while (!words.rest().empty()) {
        const std::string_view line = words.line();
        if (!line.empty() && !line.starts_with("#")) return line;
    }
    return {};
}

CrystalGrid gridOfXsf(const std::string& text, Source& source) {
    GridWords words(text);
    CrystalGrid first;
    std::size_t left = 0;
    while (!words.rest().empty()) {
        const std::string line = upper(lineOf(words));
        const bool begins = (line.starts_with("BEGIN_DATAGRID_3D") || line.starts_with("DATAGRID_3D"));
        if (!begins) continue;
        CrystalGrid grid;
        for (int axis = 0; axis < 3; ++axis) grid.size[axis] = words.count();
        for (int row = 0; row < 3; ++row) grid.origin[row] = words.number();
        for (int axis = 0; axis < 3; ++axis) // to the last sample, which repeats the first of a crystal
            for (int row = 0; row < 3; ++row) grid.steps[axis][row] = words.number() / std::max(1, grid.size[axis] - 1);
        const std::size_t prefix = line.find("3D") + 2;
        std::string name = line.size() > prefix + 1 ? line.substr(prefix + 1) : "value";
        std::ranges::transform(name, name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
        samplesOfText(grid.size, 1, words.rest().size());
        grid.begins = {text.size() - words.rest().size()};
        skipNumbers(words, grid.size);
        if (first.names.empty())
            first = grid;
        else if (first.fits(grid))
            first.begins.push_back(grid.begins[0]);
        else {
            ++left;
            continue;
        }
        first.names.push_back(name);
    }
    if (first.names.empty()) throw std::runtime_error("holds no DATAGRID_3D, so no volume");
    if (left > 0)
        source.notes.push_back(std::to_string(left) + " of its grids lie elsewhere than the first, and are left out.");
    first.names = distinctNames(first.names);
    return first;
}

/// The cell and atoms of a POSCAR, up to the grid.
CrystalGrid gridOfVasp(const std::string& text, Source& source) {
    GridWords words(text);
    words.line();
    double scale = words.number();
    CrystalGrid grid;
    for (int axis = 0; axis < 3; ++axis)
        for (int row = 0; row < 3; ++row) grid.steps[axis][row] = words.number();
    const double volume = std::abs(glm::determinant(grid.steps));
    if (scale < 0) scale = std::cbrt(-scale / volume); // states the volume of the cell
    grid.steps *= scale;
    words.line();
    std::string counts(lineOf(words));
    double value = 0;
    if (GridWords symbols(counts); !parseGridNumber(symbols.word(), value)) counts = std::string(lineOf(words));
    double atoms = 0;
    GridWords numbers(counts);
    for (std::string_view word = numbers.word(); parseGridNumber(word, value) && value >= 0; word = numbers.word())
        atoms += value;
    if (!(atoms >= 1) || atoms > 1e7) throw std::runtime_error("is no grid of VASP: states no atoms");
    std::string_view kind = lineOf(words);
    if (upper(kind).starts_with("S")) kind = lineOf(words); // "selective dynamics"
    for (double a = 0; a < atoms; ++a) words.line();
    for (int axis = 0; axis < 3; ++axis) grid.size[axis] = words.count();
    for (int axis = 0; axis < 3; ++axis) grid.steps[axis] /= double(grid.size[axis]);
    const glm::ivec3 size = grid.size;
    samplesOfText(size, 1, words.rest().size());
    // Further grids (spins) follow the same sizes, after occupancies.
    static constexpr const char* kSpins[] = {"magnetisation", "magnetisation y", "magnetisation z"};
    grid.names = {"value"};
    grid.begins = {text.size() - words.rest().size()};
    skipNumbers(words, size);
    const std::string sizes = std::to_string(size.x) + " " + std::to_string(size.y) + " " + std::to_string(size.z);
    while (!words.rest().empty() && grid.names.size() < 4) {
        GridWords line(words.line());
        std::string plain;
        for (std::string_view word = line.word(); !word.empty(); word = line.word())
            plain += (plain.empty() ? "" : " ") + std::string(word);
        if (plain != sizes) continue;
        grid.begins.push_back(text.size() - words.rest().size());
        grid.names.emplace_back(kSpins[grid.names.size() - 1]);
        skipNumbers(words, size);
    }
    source.notes.push_back("Its " + std::to_string(int(atoms)) + " atoms are left out.");
    return grid;
}

void openCrystal(Source& source, CrystalGrid (*gridOf)(const std::string&, Source&)) {
    const std::string text = wholeGridText(source.path);
    checkLastNumber(text);
    const CrystalGrid grid = gridOf(text, source);
    source.lengthUnit = "angstrom";
    source.read = [path = source.path, grid](std::size_t) { return readCrystal(path, grid); };
}

} // namespace

void openXsf(Source& source) {
    openCrystal(source, gridOfXsf);
}

void openVasp(Source& source) {
    openCrystal(source, gridOfVasp);
    const std::string name = upper(std::filesystem::path(source.path).filename().string());
    if (name.find("CHG") != std::string::npos)
        source.notes.emplace_back("The values are as VASP writes them: densities times the volume of the cell.");
}

} // namespace tessera::importer
