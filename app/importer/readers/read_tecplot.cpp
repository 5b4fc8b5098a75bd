// Tecplot ASCII: zones of points in order, structured or of finite elements, values of points or cells. Own reader,
// because VTK's takes what a truncated file lacks as 0 and knows no times.
#include "app/importer/readers/point_table.h"
#include "app/importer/readers/read_files.h"
#include "app/importer/readers/whole_file.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string_view>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkCompositeDataSet.h>
#include <vtkDoubleArray.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStructuredGrid.h>
#include <vtkUnstructuredGrid.h>

namespace tessera::importer {

namespace {

std::string upper(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return char(std::toupper(c)); });
    return out;
}

struct Zone {
    std::map<std::string, std::string> words; ///< by keyword in capitals
    std::set<std::size_t> ofCells;            ///< variables, from 0
    std::vector<std::vector<double>> values;
    std::vector<std::int64_t> corners; ///< of finite elements, from 0
    bool has(const char* key) const { return words.contains(key); }
    std::string word(const char* key, const char* otherwise = "") const {
        const auto at = words.find(key);
        return at == words.end() ? otherwise : at->second;
    }
    std::size_t size(const char* key, std::size_t otherwise) const {
        const auto at = words.find(key);
        if (at == words.end()) return otherwise;
        const double value = std::strtod(at->second.c_str(), nullptr);
        if (!(value >= 0 && value < 1e10)) throw std::runtime_error("has a zone with a bad " + at->first);
        return static_cast<std::size_t>(value);
    }
};

/// A file as words: names with their values, texts in quotes, numbers.
class Words {
public:
    explicit Words(std::string text) : text_(std::move(text)) {}

    bool atEnd() {
        skip();
        return at_ >= text_.size();
    }
    char peek() {
        skip();
        return at_ < text_.size() ? text_[at_] : '\0';
    }
    /// The next word without reading on.
    std::string ahead() {
        const std::size_t at = at_;
        const std::string word = next();
        at_ = at;
        return word;
    }
    std::string next() {
        skip();
        if (at_ >= text_.size()) throw std::runtime_error("ends too early: truncated");
        if (text_[at_] == '"') {
            const std::size_t end = text_.find('"', at_ + 1);
            if (end == std::string::npos) throw std::runtime_error("ends within a name: truncated");
            const std::string word = text_.substr(at_ + 1, end - at_ - 1);
            at_ = end + 1;
            return word;
        }
        if (text_[at_] == '(' || text_[at_] == '=') {
            const std::size_t end = text_[at_] == '=' ? at_ : text_.find(')', at_);
            if (end == std::string::npos) throw std::runtime_error("ends within a list: truncated");
            const std::string word = text_.substr(at_, end - at_ + 1);
            at_ = end + 1;
            return word;
        }
        const std::size_t end = std::min(text_.size(), text_.find_first_of(" \t\r\n,=(\"", at_));
        const std::string word = text_.substr(at_, end - at_);
        at_ = end;
        return word;
    }
    double number() {
        if (repeats_ > 0) {
            --repeats_;
            return repeated_;
        }
        std::string word = next();
        if (const std::size_t times = word.find('*'); times != std::string::npos) { // 3*1.5
            repeats_ = std::max(1L, std::strtol(word.c_str(), nullptr, 10)) - 1;
            word = word.substr(times + 1);
            return repeated_ = parse(word);
        }
        return parse(word);
    }
    void endOfList() const {
        if (repeats_ > 0) throw std::runtime_error("has more numbers than a zone announces");
    }

private:
    static double parse(std::string word) {
        std::replace(word.begin(), word.end(), 'D', 'E'); // of Fortran
        char* end = nullptr;
        const double value = std::strtod(word.c_str(), &end);
        if (word.empty() || end != word.c_str() + word.size())
            throw std::runtime_error("has \"" + word.substr(0, 40) + "\" where a number belongs");
        return value;
    }
    void skip() {
        while (at_ < text_.size()) {
            if (text_[at_] == '#' && (at_ == 0 || text_[at_ - 1] == '\n'))
                at_ = std::min(text_.size(), text_.find('\n', at_));
            else if (std::isspace(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == ',')
                ++at_;
            else
                return;
        }
    }
    std::string text_;
    std::size_t at_ = 0;
    long repeats_ = 0;
    double repeated_ = 0;
};

bool isNumber(const std::string& word) {
    return !word.empty() && (std::isdigit(static_cast<unsigned char>(word[0])) != 0 || word[0] == '-' ||
                             word[0] == '+' || word[0] == '.');
}

/// "([4-5,7]=CELLCENTERED)" -> 3, 4, 6.
std::set<std::size_t> cellVariables(std::string text, std::size_t variables) {
    std::set<std::size_t> out;
    text = upper(text);
    std::size_t from = 0;
    for (std::size_t at; (at = text.find("CELLCENTERED", from)) != std::string::npos; from = at + 1) {
        const std::size_t open = text.rfind('[', at), close = text.rfind(']', at);
        if (open == std::string::npos || open < from || close < open) { // ( NODAL, CELLCENTERED, .. )
            out.insert(static_cast<std::size_t>(std::count(text.begin(), text.begin() + std::ptrdiff_t(at), ',')));
            continue;
        }
        std::string list = text.substr(open + 1, close - open - 1);
        std::replace(list.begin(), list.end(), ',', ' ');
        for (std::size_t i = 0; i < list.size();) {
            char* end = nullptr;
            const long first = std::strtol(list.c_str() + i, &end, 10);
            if (end == list.c_str() + i) break;
            long last = first;
            if (*end == '-') last = std::strtol(end + 1, &end, 10);
            for (long v = first; v <= last && v >= 1 && v <= long(variables); ++v) out.insert(std::size_t(v - 1));
            i = static_cast<std::size_t>(end - list.c_str());
        }
    }
    return out;
}

struct Shape {
    std::size_t i, j, k, points, cells, corners;
    int cellType;
};

Shape shapeOf(const Zone& zone) {
    const std::string type = upper(zone.word("ZONETYPE", zone.has("ET") ? zone.word("ET").c_str() : "ORDERED"));
    Shape shape{zone.size("I", 1), zone.size("J", 1), zone.size("K", 1), 0, 0, 0, 0};
    if (type == "ORDERED") {
        shape.points = shape.i * shape.j * shape.k;
        const auto less = [](std::size_t n) { return std::max<std::size_t>(n, 2) - 1; };
        shape.cells = less(shape.i) * less(shape.j) * less(shape.k);
        return shape;
    }
    shape.points = zone.size("NODES", zone.size("N", 0));
    shape.cells = zone.size("ELEMENTS", zone.size("E", 0));
    if (type.find("BRICK") != std::string::npos) {
        shape.corners = 8;
        shape.cellType = VTK_HEXAHEDRON;
    } else if (type.find("TETRA") != std::string::npos) {
        shape.corners = 4;
        shape.cellType = VTK_TETRA;
    } else if (type.find("QUAD") != std::string::npos) {
        shape.corners = 4;
        shape.cellType = VTK_QUAD;
    } else if (type.find("TRIANGLE") != std::string::npos) {
        shape.corners = 3;
        shape.cellType = VTK_TRIANGLE;
    } else {
        throw std::runtime_error("has a zone of kind " + type + ", which is not read: write it as FEBRICK or FETETRA");
    }
    return shape;
}

Zone readZone(Words& words, std::size_t variables) {
    Zone zone;
    while (!words.atEnd() && words.peek() != '"' && !isNumber(words.ahead())) {
        const std::string key = upper(words.next());
        if (key == "AUXDATA") words.next(); // its own name
        if (words.peek() != '=') throw std::runtime_error("has \"" + key.substr(0, 40) + "\" in a zone");
        words.next();
        const std::string value = words.next();
        if (key == "AUXDATA" || key == "DT") continue;
        zone.words[key] = value;
    }
    if (zone.has("VARSHARELIST") || zone.has("CONNECTIVITYSHAREZONE") || zone.has("PASSIVEVARLIST"))
        throw std::runtime_error(
            "has a zone that shares variables of another, which is not read: write each zone whole");
    zone.ofCells = cellVariables(zone.word("VARLOCATION"), variables);
    const Shape shape = shapeOf(zone);
    std::string packing = upper(zone.word("DATAPACKING", zone.word("F", "POINT").c_str()));
    if (packing.starts_with("FE")) packing = packing.substr(2);
    zone.values.resize(variables);
    if (shape.points == 0) throw std::runtime_error("has a zone without points");
    if (packing == "POINT") {
        if (!zone.ofCells.empty()) throw std::runtime_error("has values of cells in a zone of points");
        for (std::size_t n = 0; n < shape.points; ++n)
            for (std::vector<double>& values : zone.values) values.push_back(words.number());
    } else {
        for (std::size_t v = 0; v < variables; ++v) {
            const std::size_t count = zone.ofCells.contains(v) ? shape.cells : shape.points;
            for (std::size_t n = 0; n < count; ++n) zone.values[v].push_back(words.number());
        }
    }
    for (std::size_t n = 0; n < shape.cells * shape.corners; ++n) {
        const double corner = words.number();
        if (!(corner >= 1 && corner <= double(shape.points))) throw std::runtime_error("has a cell with a bad corner");
        zone.corners.push_back(std::int64_t(corner) - 1);
    }
    words.endOfList();
    return zone;
}

vtkSmartPointer<vtkPoints> pointsOf(const PointTable& table, std::size_t count, Source& source) {
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    points->SetNumberOfPoints(vtkIdType(count));
    bool any[3] = {false, false, false};
    std::vector<double> places[3];
    for (std::size_t c = 0; c < table.columns.size(); ++c)
        if (const int axis = axisOf(table.headings[c].name); axis >= 0 && !any[axis]) {
            any[axis] = true;
            places[axis] = table.columns[c];
            if (!table.headings[c].unit.empty()) source.lengthUnit = table.headings[c].unit;
        }
    if (!any[0] || !any[1]) throw std::runtime_error("has no variables X and Y with places");
    for (std::size_t n = 0; n < count; ++n)
        points->SetPoint(vtkIdType(n), places[0][n], places[1][n], any[2] ? places[2][n] : 0);
    return points;
}

vtkSmartPointer<vtkDataSet> dataOf(const Zone& zone, const std::vector<Heading>& headings, Source& source) {
    const Shape shape = shapeOf(zone);
    PointTable ofPoints, ofCells;
    for (std::size_t v = 0; v < headings.size(); ++v) {
        PointTable& table = zone.ofCells.contains(v) ? ofCells : ofPoints;
        table.headings.push_back(headings[v]);
        table.columns.push_back(zone.values[v]);
    }
    if (shape.corners == 0 && shape.j == 1 && shape.k == 1) return gridOfPoints(ofPoints, source);
    const auto fill = [&](vtkPointSet* mesh) {
        mesh->SetPoints(pointsOf(ofPoints, shape.points, source));
        addColumns(ofPoints, mesh->GetPointData(), source);
        addColumns(ofCells, mesh->GetCellData(), source);
    };
    if (shape.corners == 0) {
        vtkNew<vtkStructuredGrid> grid;
        grid->SetDimensions(int(shape.i), int(shape.j), int(shape.k));
        fill(grid);
        return grid;
    }
    vtkNew<vtkUnstructuredGrid> mesh;
    mesh->Allocate(vtkIdType(shape.cells));
    for (std::size_t c = 0; c < shape.cells; ++c) {
        std::vector<vtkIdType> corners(zone.corners.begin() + std::ptrdiff_t(c * shape.corners),
                                       zone.corners.begin() + std::ptrdiff_t((c + 1) * shape.corners));
        mesh->InsertNextCell(shape.cellType, vtkIdType(corners.size()), corners.data());
    }
    fill(mesh);
    return mesh;
}

} // namespace

void openTecplot(Source& source) {
    const std::string head = readPart(source.path, 0, 512);
    if (head.starts_with("#!TD"))
        throw std::runtime_error(
            "is binary Tecplot, which is not read: write it as Tecplot ASCII (.dat), or as CGNS or "
            "EnSight Gold from the program that made it");
    if (head.find("(0 \"") != std::string::npos || head.starts_with("("))
        throw std::runtime_error("holds the values of a Fluent case: open the .cas file of the same name");
    const std::string text = readWhole(source.path);
    checkLastLine(text);
    Words words(text);
    std::vector<Heading> headings;
    std::map<double, std::vector<Zone>> zones; // by time
    bool times = true;
    while (!words.atEnd()) {
        const std::string key = upper(words.next());
        if (key == "TITLE" || key == "FILETYPE" || key == "DATASETAUXDATA" || key == "VARAUXDATA") {
            while (!words.atEnd() && words.peek() == '=') words.next();
            words.next();
            if (key.ends_with("AUXDATA"))
                while (!words.atEnd() && (words.peek() == '=' || words.peek() == '"')) words.next();
        } else if (key == "VARIABLES") {
            words.next();
            headings.clear();
            while (!words.atEnd() && (words.peek() == '"' || upper(words.ahead()) != "ZONE"))
                headings.push_back(parseHeading(words.next()));
        } else if (key == "ZONE") {
            if (headings.empty()) throw std::runtime_error("has a zone before its VARIABLES: is it Tecplot ASCII?");
            Zone zone = readZone(words, headings.size());
            times = times && zone.has("SOLUTIONTIME");
            const double time = std::strtod(zone.word("SOLUTIONTIME", "0").c_str(), nullptr);
            zones[time].push_back(std::move(zone));
        } else {
            throw std::runtime_error("has \"" + key.substr(0, 40) + "\" where ZONE belongs: is it Tecplot ASCII?");
        }
    }
    if (zones.empty()) throw std::runtime_error("holds no zone");
    if (!times) // zones that state no time are there at all times
        for (auto at = std::next(zones.begin()); at != zones.end(); at = zones.erase(at))
            for (Zone& zone : at->second) zones.begin()->second.push_back(std::move(zone));
    if (times)
        for (const auto& [time, list] : zones) source.times.push_back(time);
    const auto kept = std::make_shared<const std::map<double, std::vector<Zone>>>(std::move(zones));
    Source units = source;
    for (const Zone& zone : kept->begin()->second) dataOf(zone, headings, source);
    source.read = [kept, headings, units](std::size_t time) -> vtkSmartPointer<vtkDataObject> {
        Source scratch = units;
        const std::vector<Zone>& list = std::next(kept->begin(), std::ptrdiff_t(time))->second;
        vtkNew<vtkMultiBlockDataSet> blocks;
        for (unsigned z = 0; z < list.size(); ++z) {
            blocks->SetBlock(z, dataOf(list[z], headings, scratch));
            blocks->GetMetaData(z)->Set(vtkCompositeDataSet::NAME(),
                                        list.size() > 1 ? list[z].word("T", ("zone " + std::to_string(z + 1)).c_str())
                                                        : std::string());
        }
        return blocks;
    };
}

} // namespace tessera::importer
