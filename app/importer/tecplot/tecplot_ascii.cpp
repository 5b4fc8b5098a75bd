// Tecplot ASCII: zones of points in order, structured or of finite elements, values of points or cells.
#include "app/importer/readers/check_file.h"
#include "app/importer/tecplot/tecplot_words.h"
#include "app/importer/tecplot/tecplot_zones.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string_view>

namespace tessera::importer {

namespace {

struct Zone {
    std::map<std::string, std::string> words; ///< by keyword in capitals
    std::set<std::size_t> ofCells;            ///< variables, from 0
    std::vector<std::vector<double>> values;
    std::vector<vtkIdType> corners;            ///< of finite elements, from 0
    FaceMesh faces;                            ///< of polyhedra and polygons
    std::map<std::size_t, std::size_t> shared; ///< variables that another zone stores, and that zone, from 0
    std::set<std::size_t> passive;             ///< variables without values
    std::shared_ptr<const Zone> cells;         ///< the zone that stores the cells, if another
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

bool isNumber(const std::string& word) {
    return !word.empty() && (std::isdigit(static_cast<unsigned char>(word[0])) != 0 || word[0] == '-' ||
                             word[0] == '+' || word[0] == '.');
}

/// "4-5,7" -> 3, 4, 6: variables, from 0.
std::set<std::size_t> variablesIn(std::string list, std::size_t variables) {
    std::set<std::size_t> out;
    for (char& c : list)
        if (c == ',' || c == '[' || c == ']' || c == '(' || c == ')') c = ' ';
    for (std::size_t i = 0; i < list.size();) {
        char* end = nullptr;
        const long first = std::strtol(list.c_str() + i, &end, 10);
        if (end == list.c_str() + i) break;
        long last = first;
        if (*end == '-') last = std::strtol(end + 1, &end, 10);
        for (long v = std::max(1L, first); v <= last && v <= long(variables); ++v) out.insert(std::size_t(v - 1));
        i = static_cast<std::size_t>(end - list.c_str());
    }
    return out;
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
        out.merge(variablesIn(text.substr(open, close - open), variables));
    }
    return out;
}

/// "([1-3]=1,[5]=2)": which zone stores a variable, both from 0. Without a zone it is the one before.
std::map<std::size_t, std::size_t> sharedVariables(const std::string& text, std::size_t variables, std::size_t zones) {
    std::map<std::size_t, std::size_t> out;
    std::size_t from = 0;
    for (std::size_t open; (open = text.find_first_of("[0123456789", from)) != std::string::npos;) {
        std::size_t close = text.find(text[open] == '[' ? "]" : "=", open);
        if (close == std::string::npos) close = text.size() - 1;
        const std::size_t equals = text.find_first_not_of(" \t]", close);
        long zone = long(zones);
        from = close + 1;
        if (equals != std::string::npos && text[equals] == '=') {
            char* end = nullptr;
            zone = std::strtol(text.c_str() + equals + 1, &end, 10);
            from = std::size_t(end - text.c_str());
        }
        if (zone < 1 || zone > long(zones))
            throw std::runtime_error("shares variables of zone " + std::to_string(zone) + ", which is not before it");
        for (const std::size_t v : variablesIn(text.substr(open, close - open), variables))
            out[v] = std::size_t(zone - 1);
    }
    return out;
}

/// Type of cells, and numbers of points and cells.
TecplotZone shapeOf(const Zone& zone) {
    const std::string type = upper(zone.word("ZONETYPE", zone.has("ET") ? zone.word("ET").c_str() : "ORDERED"));
    TecplotZone shape;
    if (type == "ORDERED") {
        shape.size = {zone.size("I", 1), zone.size("J", 1), zone.size("K", 1)};
        countOrdered(shape);
        return shape;
    }
    shape.points = zone.size("NODES", zone.size("N", 0));
    shape.cells = zone.size("ELEMENTS", zone.size("E", 0));
    if (type.find("BRICK") != std::string::npos)
        shape.cellType = VTK_HEXAHEDRON;
    else if (type.find("TETRA") != std::string::npos)
        shape.cellType = VTK_TETRA;
    else if (type.find("QUAD") != std::string::npos)
        shape.cellType = VTK_QUAD;
    else if (type.find("TRIANGLE") != std::string::npos)
        shape.cellType = VTK_TRIANGLE;
    else if (type.find("LINESEG") != std::string::npos)
        shape.cellType = VTK_LINE;
    else if (type.find("POLYHEDRON") != std::string::npos)
        shape.cellType = VTK_POLYHEDRON;
    else if (type.find("POLYGON") != std::string::npos)
        shape.cellType = VTK_POLYGON;
    else
        throw std::runtime_error("has a zone of kind " + type.substr(0, 40) + ", which Tecplot does not know");
    return shape;
}

using Zones = std::vector<std::shared_ptr<const Zone>>;

/// The words of the header of a zone.
Zone readZoneWords(TecplotWords& words) {
    Zone zone;
    while (!words.atEnd() && words.peek() != '"' && !isNumber(words.ahead())) {
        if (beginsRecord(upper(words.ahead()))) break; // a zone that shares all
        const std::string key = upper(words.next());
        if (key == "AUXDATA") words.next(); // the name of the auxiliary value
        if (words.peek() != '=') throw std::runtime_error("has \"" + key.substr(0, 40) + "\" in a zone");
        words.next();
        const std::string value = words.next();
        if (key == "AUXDATA" || key == "DT") continue;
        zone.words[key] = value;
    }
    return zone;
}

/// Faces of polyhedra or polygons: corners of each, then the cells on both sides.
FaceMesh readFaceMesh(TecplotWords& words, const Zone& zone, const TecplotZone& shape) {
    FaceMesh mesh;
    mesh.dimensions = shape.cellType == VTK_POLYGON ? 2 : 3;
    mesh.cells = shape.cells;
    const std::size_t faces = zone.size("FACES", 0);
    const auto count = [&] {
        const double n = mesh.dimensions == 2 ? 2 : words.number();
        if (!(n >= 2 && n < 10'000)) throw std::runtime_error("has a face with a bad number of corners");
        return std::size_t(n);
    };
    for (std::size_t f = 0; f < faces; ++f) mesh.begins.push_back(mesh.begins.back() + count());
    for (std::uint64_t n = 0; n < mesh.begins.back(); ++n) {
        const double corner = words.number();
        if (!(corner >= 1 && corner <= double(shape.points))) throw std::runtime_error("has a face with a bad corner");
        mesh.points.push_back(std::int32_t(corner) - 1);
    }
    mesh.sides.assign(2 * faces, -1);
    for (std::size_t side = 0; side < 2; ++side)
        for (std::size_t f = 0; f < faces; ++f) { // 0 and less: none, or cells of other zones
            const double cell = words.number();
            if (!(cell <= double(shape.cells))) throw std::runtime_error("has a face of a cell that is not there");
            mesh.sides[2 * f + side] = cell >= 1 ? std::int32_t(cell) - 1 : -1;
        }
    return mesh;
}

void readNumbers(TecplotWords& words, Zone& zone, const TecplotZone& shape) {
    std::string packing = upper(zone.word("DATAPACKING", zone.word("F", "POINT").c_str()));
    if (packing.starts_with("FE")) packing = packing.substr(2);
    const auto isStored = [&](std::size_t v) { return !zone.shared.contains(v) && !zone.passive.contains(v); };
    if (packing == "POINT") {
        for (std::size_t v = 0; v < zone.values.size(); ++v)
            if (isStored(v) && zone.ofCells.contains(v))
                throw std::runtime_error("has values of cells in a zone of points");
        for (std::size_t n = 0; n < shape.points; ++n)
            for (std::size_t v = 0; v < zone.values.size(); ++v)
                if (isStored(v)) zone.values[v].push_back(words.number());
        return;
    }
    for (std::size_t v = 0; v < zone.values.size(); ++v) {
        const std::size_t count = zone.ofCells.contains(v) ? shape.cells : shape.points;
        for (std::size_t n = 0; n < count && isStored(v); ++n) zone.values[v].push_back(words.number());
    }
}

/// `solution`: cells are in another file.
Zone readZone(TecplotWords& words, std::size_t variables, const Zones& before, bool solution) {
    Zone zone = readZoneWords(words);
    zone.ofCells = cellVariables(zone.word("VARLOCATION"), variables);
    zone.shared = sharedVariables(zone.word("VARSHARELIST"), variables, before.size());
    zone.passive = variablesIn(zone.word("PASSIVEVARLIST"), variables);
    const std::size_t from = zone.size("CONNECTIVITYSHAREZONE", 0);
    if (from > before.size()) throw std::runtime_error("shares cells of a zone that is not before it");
    if (from > 0) { // sizes need not be repeated
        zone.cells = before[from - 1]->cells != nullptr ? before[from - 1]->cells : before[from - 1];
        for (const char* key : {"NODES", "N", "ELEMENTS", "E", "ZONETYPE", "ET", "FACES"})
            if (!zone.has(key) && zone.cells->has(key)) zone.words[key] = zone.cells->word(key);
    }
    const TecplotZone shape = shapeOf(zone);
    zone.values.resize(variables);
    if (shape.points == 0) throw std::runtime_error("has a zone without points");
    for (const auto& [v, owner] : zone.shared) {
        const TecplotZone stores = shapeOf(*before[owner]);
        if (stores.points != shape.points || stores.cells != shape.cells ||
            before[owner]->ofCells.contains(v) != zone.ofCells.contains(v))
            throw std::runtime_error("shares numbers of another size in zone " + std::to_string(before.size() + 1));
    }
    readNumbers(words, zone, shape);
    if (zone.cells != nullptr && shapeOf(*zone.cells).cells != shape.cells)
        throw std::runtime_error("shares cells of another number in zone " + std::to_string(before.size() + 1));
    if (zone.cells == nullptr && !solution) {
        if (shape.cellType == VTK_POLYHEDRON || shape.cellType == VTK_POLYGON)
            zone.faces = readFaceMesh(words, zone, shape);
        for (std::size_t n = 0; n < shape.cells * cornersOf(shape.cellType); ++n) {
            const double corner = words.number();
            if (!(corner >= 1 && corner <= double(shape.points)))
                throw std::runtime_error("has a cell with a bad corner");
            zone.corners.push_back(vtkIdType(corner) - 1);
        }
    }
    words.endOfList();
    return zone;
}

/// The zone that stores a variable; null if none does.
const Zone* storing(const Zones& zones, std::size_t zone, std::size_t variable) {
    while (!zones[zone]->passive.contains(variable)) {
        const auto from = zones[zone]->shared.find(variable);
        if (from == zones[zone]->shared.end()) return zones[zone].get();
        zone = from->second; // always one before
    }
    return nullptr;
}

TecplotZone described(const std::shared_ptr<const Zones>& zones, std::size_t z, std::size_t variables) {
    const std::shared_ptr<const Zone> zone = (*zones)[z];
    TecplotZone out = shapeOf(*zone);
    out.name = zone->word("T");
    if (zone->has("SOLUTIONTIME")) out.time = std::strtod(zone->word("SOLUTIONTIME").c_str(), nullptr);
    if (zone->has("STRANDID")) out.strand = std::atoi(zone->word("STRANDID").c_str());
    if (out.strand == 0 && zone->has("STRANDID")) out.strand.reset(); // static
    for (std::size_t v = 0; v < variables; ++v) {
        out.types.push_back(storing(*zones, z, v) != nullptr ? VTK_FLOAT : VTK_VOID);
        out.ofCells.push_back(zone->ofCells.contains(v));
    }
    out.values = [zones, z](std::size_t variable) {
        const Zone* from = storing(*zones, z, variable);
        return from != nullptr ? from->values[variable] : std::vector<double>();
    };
    const std::shared_ptr<const Zone> cells = zone->cells != nullptr ? zone->cells : zone;
    out.corners = [cells] { return cells->corners; };
    if (cells->faces.faces() > 0) out.faces = [cells] { return cells->faces; };
    return out;
}

} // namespace

TecplotFile readAsciiTecplot(const std::string& path) {
    TecplotWords words(readWhole(path));
    TecplotFile file;
    const auto zones = std::make_shared<Zones>();
    while (!words.atEnd()) {
        const std::string key = upper(words.next());
        if (key == "TITLE" || key == "FILETYPE" || key == "DATASETAUXDATA" || key == "VARAUXDATA") {
            while (!words.atEnd() && words.peek() == '=') words.next();
            const std::string value = upper(words.next());
            if (key == "FILETYPE" && value == "SOLUTION") file.solution = true;
            if (key == "FILETYPE" && value == "GRID") file.grid = true;
            if (key.ends_with("AUXDATA"))
                while (!words.atEnd() && (words.peek() == '=' || words.peek() == '"')) words.next();
        } else if (key == "VARIABLES") {
            words.next();
            std::vector<Heading> stated;
            while (!words.atEnd() && (words.peek() == '"' || !beginsRecord(upper(words.ahead()))))
                stated.push_back(parseHeading(words.next()));
            if (!zones->empty() && !std::ranges::equal(stated, file.headings, {}, &Heading::name, &Heading::name))
                throw std::runtime_error("states other VARIABLES after its first zone: write each set to a file");
            file.headings = std::move(stated);
        } else if (key == "TEXT" || key == "GEOMETRY" || key == "CUSTOMLABELS") {
            words.skipRecord();
            file.drawings = true;
        } else if (key == "ZONE") {
            if (file.headings.empty())
                throw std::runtime_error("has a zone before its VARIABLES: is it Tecplot ASCII?");
            zones->push_back(
                std::make_shared<const Zone>(readZone(words, file.headings.size(), *zones, file.solution)));
        } else {
            throw std::runtime_error("has \"" + key.substr(0, 40) + "\" where ZONE belongs: is it Tecplot ASCII?");
        }
    }
    for (std::size_t z = 0; z < zones->size(); ++z) file.zones.push_back(described(zones, z, file.headings.size()));
    return file;
}

} // namespace tessera::importer
