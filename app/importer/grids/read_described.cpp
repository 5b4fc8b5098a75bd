// Samples described by a header of words: OpenDX, and BOV ("brick of values") of VisIt and PuMA.
#include "app/importer/grids/grid_file.h"
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>
#include <vtkCellData.h>
#include <vtkPointData.h>

namespace tessera::importer {

namespace {

struct DescribedGrid {
    glm::ivec3 size{1}; ///< samples
    glm::dvec3 origin{0};
    glm::dmat3 steps{1};
    std::string name = "value", file;
    PixelForm number; ///< of one sample
    int components = 1;
    std::size_t begin = 0;
    bool text = false, bigEndian = false, cells = false, zFastest = false;
    double count() const { return double(size.x) * size.y * size.z; }
};

/// Puts numbers in their order of the file, z or x fastest, into an array.
void placeNumbers(const DescribedGrid& grid, vtkDataArray& stored, vtkDataArray& to) {
    const auto nx = vtkIdType(grid.size.x), ny = vtkIdType(grid.size.y), nz = vtkIdType(grid.size.z);
    vtkIdType next = 0;
    for (vtkIdType x = 0; x < nx; ++x)
        for (vtkIdType y = 0; y < ny; ++y)
            for (vtkIdType z = 0; z < nz; ++z) to.SetTuple(x + nx * (y + ny * z), next++, &stored);
}

vtkSmartPointer<vtkDataObject> readDescribed(const DescribedGrid& grid) {
    const int type = vtkTypeOf(grid.number);
    const auto count = std::size_t(grid.count());
    auto stored = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
    stored->SetName(grid.name.c_str());
    stored->SetNumberOfComponents(grid.components);
    stored->SetNumberOfTuples(vtkIdType(count));
    if (grid.text) {
        const std::string text = wholeGridText(grid.file);
        checkLastNumber(text);
        GridWords words(std::string_view(text).substr(std::min(grid.begin, text.size())));
        for (vtkIdType i = 0; i < vtkIdType(count); ++i)
            for (int c = 0; c < grid.components; ++c) stored->SetComponent(i, c, words.number());
    } else {
        const auto each = std::size_t(grid.number.bits / 8);
        GridBytes file(grid.file);
        auto* bytes = static_cast<char*>(stored->GetVoidPointer(0));
        const std::size_t all = count * std::size_t(grid.components) * each;
        file.read(grid.begin, all, bytes);
        if (grid.bigEndian == (std::endian::native == std::endian::little))
            for (std::size_t at = 0; each > 1 && at < all; at += each) std::reverse(bytes + at, bytes + at + each);
    }
    vtkSmartPointer<vtkDataArray> values = stored;
    if (grid.zFastest) {
        values = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
        values->SetName(grid.name.c_str());
        values->SetNumberOfComponents(grid.components);
        values->SetNumberOfTuples(vtkIdType(count));
        placeNumbers(grid, *stored, *values);
    }
    auto image = gridImage(grid.size + (grid.cells ? 1 : 0), grid.origin, grid.steps);
    if (grid.cells)
        image->GetCellData()->AddArray(values);
    else
        image->GetPointData()->AddArray(values);
    return image;
}

void checkDescribed(const DescribedGrid& grid) {
    vtkTypeOf(grid.number);
    if (grid.components < 1 || grid.components > 16)
        throw std::runtime_error("states an impossible number of components");
    const double wanted = grid.count() * grid.components * grid.number.bits / 8, has = double(bytesIn(grid.file));
    refuseHollow(wanted, has);
    if (grid.text)
        samplesOfText(grid.size, std::size_t(grid.components), bytesIn(grid.file));
    else if (readPart(grid.file, 0, 2) != "\x1f\x8b")
        wantBytes(has - double(grid.begin), wanted);
}

std::string lowerWord(std::string_view word) {
    std::string out(word);
    for (char& c : out) c = char(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

PixelForm numberNamed(const std::string& word) {
    using enum PixelNumbers;
    static const std::map<std::string, std::pair<int, PixelNumbers>> kTypes{
        {"byte", {8, Unsigned}},    {"ubyte", {8, Unsigned}}, {"char", {8, Unsigned}},   {"short", {16, Signed}},
        {"ushort", {16, Unsigned}}, {"int", {32, Signed}},    {"integer", {32, Signed}}, {"uint", {32, Unsigned}},
        {"float", {32, Float}},     {"double", {64, Float}},  {"long", {64, Signed}},    {"bytes", {8, Unsigned}},
        {"shorts", {16, Signed}},   {"ints", {32, Signed}},   {"floats", {32, Float}},   {"doubles", {64, Float}}};
    const auto at = kTypes.find(lowerWord(word));
    if (at == kTypes.end())
        throw std::runtime_error("has numbers of type \"" + word.substr(0, 40) + "\", which is not read");
    return {1, 1, at->second.first, 1, at->second.second};
}

/// "object 3 class array type double rank 0 items 1320 data follows", with words of a further line.
void readDxArray(GridWords& line, DescribedGrid& grid, double& items) {
    for (std::string word = lowerWord(line.word()); !word.empty(); word = lowerWord(line.word())) {
        if (word == "type") {
            std::string type = lowerWord(line.word());
            if (type == "unsigned" || type == "signed") type = (type == "unsigned" ? "u" : "") + lowerWord(line.word());
            grid.number = numberNamed(type);
        } else if (word == "shape") {
            grid.components = line.count();
        } else if (word == "items") {
            items = line.number();
        } else if (word == "lsb" || word == "msb" || word == "ieee" || word == "binary") {
            grid.text = false;
            if (word != "ieee" && word != "binary") grid.bigEndian = word == "msb";
        } else if (word == "text" || word == "ascii") {
            grid.text = true;
        } else if (word == "data") {
            if (lowerWord(line.word()) != "follows")
                throw std::runtime_error(
                    "keeps its samples in another file, which is not read: write them behind the header");
            return;
        }
    }
}

DescribedGrid gridOfDx(const std::string& path) {
    constexpr std::size_t kMostDx = 1 << 20;
    const std::string head = GridBytes(path).part(0, kMostDx);
    DescribedGrid grid;
    grid.file = path;
    grid.text = grid.zFastest = true;
    GridWords words(head);
    int delta = 0;
    bool positions = false;
    while (!words.rest().empty()) {
        const std::string_view text = words.line();
        if (text.empty() || text.starts_with("#")) continue;
        GridWords line(text);
        std::string word = lowerWord(line.word());
        if (word == "origin") {
            for (int row = 0; row < 3; ++row) grid.origin[row] = line.number();
        } else if (word == "delta" && delta < 3) {
            for (int row = 0; row < 3; ++row) grid.steps[delta][row] = line.number();
            ++delta;
        } else if (word == "object" && text.find("gridpositions") != std::string_view::npos) {
            while (!word.empty() && word != "counts") word = lowerWord(line.word());
            for (int axis = 0; axis < 3; ++axis) grid.size[axis] = line.count();
            positions = true;
        } else if (word == "object" && text.find("class array") != std::string_view::npos) {
            double items = 0;
            grid.text = true;
            readDxArray(line, grid, items);
            const double cells =
                double(std::max(1, grid.size.x - 1)) * std::max(1, grid.size.y - 1) * std::max(1, grid.size.z - 1);
            grid.begin = head.size() - words.rest().size();
            if (!positions) break;
            if (items == cells && items != grid.count()) {
                grid.cells = true;
                grid.size -= 1;
            } else if (items != grid.count()) {
                throw std::runtime_error("has another number of samples than its grid");
            }
            return grid;
        }
    }
    throw std::runtime_error("is no OpenDX file of a regular grid");
}

} // namespace

void openDx(Source& source) {
    const DescribedGrid grid = gridOfDx(source.path);
    checkDescribed(grid);
    source.read = [grid](std::size_t) { return readDescribed(grid); };
}

void openBov(Source& source) {
    std::map<std::string, std::string> entries;
    constexpr std::size_t kMostBov = 1 << 16;
    const std::string head = readPart(source.path, 0, kMostBov);
    for (GridWords words(head); !words.rest().empty();) {
        const std::string line(words.line());
        const std::size_t colon = line.find(':');
        if (line.starts_with("#") || colon == std::string::npos) continue;
        std::string key = lowerWord(line.substr(0, colon)), value = line.substr(colon + 1);
        std::ranges::replace(key, ' ', '_');
        GridWords clean(value);
        std::string joined;
        for (std::string_view word = clean.word(); !word.empty(); word = clean.word())
            joined += (joined.empty() ? "" : " ") + std::string(word);
        std::erase(joined, '"');
        entries[key] = joined;
    }
    if (entries["data_file"].empty() || entries["data_size"].empty()) throw std::runtime_error("is no BOV header");
    DescribedGrid grid;
    grid.file = besides(source.path, entries["data_file"]);
    GridWords size(entries["data_size"]);
    for (int axis = 0; axis < 3; ++axis) grid.size[axis] = size.count();
    grid.number = numberNamed(entries["data_format"]);
    if (!entries["variable"].empty()) grid.name = entries["variable"];
    grid.bigEndian = lowerWord(entries["data_endian"]) == "big";
    grid.cells = lowerWord(entries["centering"]) != "nodal"; // of zones where it is not stated
    if (!entries["data_components"].empty()) {
        GridWords word(entries["data_components"]);
        grid.components = word.count();
    }
    if (!entries["byte_offset"].empty()) {
        GridWords word(entries["byte_offset"]);
        const double offset = word.number();
        if (!(offset >= 0) || offset > 1e15) throw std::runtime_error("states an impossible BYTE_OFFSET");
        grid.begin = std::size_t(offset);
    }
    glm::dvec3 length = glm::dvec3(1); // a box of 1 x 1 x 1 where it is not stated
    if (GridWords word(entries["brick_origin"]); !word.atEnd())
        for (int axis = 0; axis < 3; ++axis) grid.origin[axis] = word.number();
    if (GridWords word(entries["brick_size"]); !word.atEnd())
        for (int axis = 0; axis < 3; ++axis) length[axis] = word.number();
    else
        source.notes.emplace_back("It states no BRICK_SIZE: its box is 1 x 1 x 1, as in VisIt.");
    for (int axis = 0; axis < 3; ++axis)
        grid.steps[axis] = glm::dvec3(0),
        grid.steps[axis][axis] = length[axis] / std::max(1, grid.size[axis] - (grid.cells ? 0 : 1));
    double time = 0;
    if (GridWords word(entries["time"]); parseGridNumber(word.word(), time)) source.times = {time};
    checkDescribed(grid);
    source.read = [grid](std::size_t) { return readDescribed(grid); };
}

} // namespace tessera::importer
