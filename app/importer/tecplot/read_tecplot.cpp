// Tecplot ASCII: zones of points in order, structured or of finite elements, values of points or cells. Not read by
// VTK, whose reader fills truncated files with 0 and ignores times.
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"
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

std::string upper(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return char(std::toupper(c)); });
    return out;
}

struct Zone {
    std::map<std::string, std::string> words; ///< by keyword in capitals
    std::set<std::size_t> ofCells;            ///< variables, from 0
    std::vector<std::vector<double>> values;
    std::vector<vtkIdType> corners; ///< of finite elements, from 0
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

/// Splits a file into words: names with their values, quoted texts, numbers.
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
    /// The next word, without consuming it.
    std::string ahead() {
        const std::size_t at = at_;
        std::string word = next();
        at_ = at;
        return word;
    }
    std::string next() {
        skip();
        if (at_ >= text_.size()) throw std::runtime_error("ends too early: truncated");
        if (text_[at_] == '"') {
            const std::size_t end = text_.find('"', at_ + 1);
            if (end == std::string::npos) throw std::runtime_error("ends within a name: truncated");
            std::string word = text_.substr(at_ + 1, end - at_ - 1);
            at_ = end + 1;
            return word;
        }
        if (text_[at_] == '(' || text_[at_] == '=') {
            const std::size_t end = text_[at_] == '=' ? at_ : text_.find(')', at_);
            if (end == std::string::npos) throw std::runtime_error("ends within a list: truncated");
            std::string word = text_.substr(at_, end - at_ + 1);
            at_ = end + 1;
            return word;
        }
        const std::size_t end = std::min(text_.size(), text_.find_first_of(" \t\r\n,=(\"", at_));
        std::string word = text_.substr(at_, end - at_);
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
        std::replace(word.begin(), word.end(), 'D', 'E'); // Fortran's exponent
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
    else
        throw std::runtime_error("has a zone of kind " + type + ", which is not read: write it as FEBRICK or FETETRA");
    return shape;
}

Zone readZone(Words& words, std::size_t variables) {
    Zone zone;
    while (!words.atEnd() && words.peek() != '"' && !isNumber(words.ahead())) {
        const std::string key = upper(words.next());
        if (key == "AUXDATA") words.next(); // the name of the auxiliary value
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
    const TecplotZone shape = shapeOf(zone);
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
    for (std::size_t n = 0; n < shape.cells * cornersOf(shape.cellType); ++n) {
        const double corner = words.number();
        if (!(corner >= 1 && corner <= double(shape.points))) throw std::runtime_error("has a cell with a bad corner");
        zone.corners.push_back(vtkIdType(corner) - 1);
    }
    words.endOfList();
    return zone;
}

TecplotZone described(const std::shared_ptr<const Zone>& zone, std::size_t variables) {
    TecplotZone out = shapeOf(*zone);
    out.name = zone->word("T");
    if (zone->has("SOLUTIONTIME")) out.time = std::strtod(zone->word("SOLUTIONTIME").c_str(), nullptr);
    if (zone->has("STRANDID")) out.strand = std::atoi(zone->word("STRANDID").c_str());
    out.types.assign(variables, VTK_FLOAT);
    for (std::size_t v = 0; v < variables; ++v) out.ofCells.push_back(zone->ofCells.contains(v));
    out.values = [zone](std::size_t variable) { return zone->values[variable]; };
    out.corners = [zone] { return zone->corners; };
    return out;
}

} // namespace

void openTecplot(Source& source) {
    const std::string head = readPart(source.path, 0, 512);
    if (head.starts_with("#!TDV")) {
        openBinaryTecplot(source);
        return;
    }
    if (head.starts_with("#!SZPLT"))
        throw std::runtime_error("has subzones (.szplt), which are not read: write it as binary Tecplot (.plt)");
    if (head.find("(0 \"") != std::string::npos || head.starts_with("("))
        throw std::runtime_error("holds the values of a Fluent case: open the .cas file of the same name");
    const std::string text = readWhole(source.path);
    checkLastLine(text);
    Words words(text);
    std::vector<Heading> headings;
    std::vector<TecplotZone> zones;
    while (!words.atEnd()) {
        const std::string key = upper(words.next());
        if (key == "TITLE" || key == "FILETYPE" || key == "DATASETAUXDATA" || key == "VARAUXDATA") {
            while (!words.atEnd() && words.peek() == '=') words.next();
            words.next();
            if (key.ends_with("AUXDATA"))
                while (!words.atEnd() && (words.peek() == '=' || words.peek() == '"')) words.next();
        } else if (key == "VARIABLES") {
            words.next();
            std::vector<Heading> stated;
            while (!words.atEnd() && (words.peek() == '"' || upper(words.ahead()) != "ZONE"))
                stated.push_back(parseHeading(words.next()));
            if (!zones.empty() && !std::ranges::equal(stated, headings, {}, &Heading::name, &Heading::name))
                throw std::runtime_error("states other VARIABLES after its first zone: write each set to a file");
            headings = std::move(stated);
        } else if (key == "ZONE") {
            if (headings.empty()) throw std::runtime_error("has a zone before its VARIABLES: is it Tecplot ASCII?");
            zones.push_back(described(std::make_shared<const Zone>(readZone(words, headings.size())), headings.size()));
        } else {
            throw std::runtime_error("has \"" + key.substr(0, 40) + "\" where ZONE belongs: is it Tecplot ASCII?");
        }
    }
    giveZones(std::move(headings), std::move(zones), source);
}

} // namespace tessera::importer
