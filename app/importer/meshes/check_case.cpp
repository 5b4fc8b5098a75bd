// Checks for truncated EnSight cases, in which each array is a separate file.
#include "app/importer/readers/check_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace tessera::importer {

namespace fs = std::filesystem;

namespace {

std::string nameIn(const fs::path& folder, const fs::path& file) {
    return file.lexically_relative(folder).string();
}

/// A part of an EnSight geometry: its number of points, and of cells by type.
struct GoldPart {
    std::size_t points = 0;
    std::vector<std::pair<std::string, std::size_t>> cells;
    bool block = false;
};

/// Reads EnSight Gold files: ASCII, C binary and Fortran binary.
class GoldFile {
public:
    explicit GoldFile(const std::string& path, bool isGeometry, bool binary, bool fortran)
        : bytes_(readWhole(path)), binary_(binary), fortran_(fortran) {
        if (isGeometry) {
            fortran_ = bytes_.size() > 12 && bytes_.compare(4, 14, "Fortran Binary") == 0;
            binary_ = fortran_ || bytes_.starts_with("C Binary");
            if (binary_) line();
        }
        if (!binary_) checkLastLine(bytes_);
    }
    bool binary() const { return binary_; }
    bool fortran() const { return fortran_; }
    bool atEnd() {
        if (!binary_) at_ = std::min(bytes_.size(), bytes_.find_first_not_of(" \t\r\n", at_));
        return at_ >= bytes_.size();
    }
    std::string line() {
        std::string text;
        if (binary_) {
            text = record(80);
            text.resize(std::min(text.find('\0'), text.size()));
        } else {
            if (at_ >= bytes_.size()) shortFile();
            const std::size_t end = bytes_.find('\n', at_);
            text = bytes_.substr(at_, end - at_);
            at_ = end + 1;
        }
        text.erase(text.find_last_not_of(" \t\r\n") + 1);
        return text;
    }
    std::vector<std::int32_t> integers(std::size_t count) {
        std::vector<std::int32_t> out(count);
        if (binary_) {
            const std::string bytes = record(4 * count);
            std::memcpy(out.data(), bytes.data(), bytes.size());
            if (!out.empty() && (out[0] < 0 || out[0] > (1 << 28)) && (swapped(out[0]) >> 28) == 0)
                for (std::int32_t& value : out) value = swapped(value);
            return out;
        }
        for (std::int32_t& value : out) value = static_cast<std::int32_t>(std::strtol(word().c_str(), nullptr, 10));
        return out;
    }
    void numbers(std::size_t count) {
        if (binary_)
            skip(4 * count);
        else
            for (std::size_t i = 0; i < count; ++i) word();
    }
    void endLine() {
        if (!binary_) at_ = std::min(bytes_.size(), bytes_.find_first_not_of(" \t\r\n", at_));
    }

private:
    [[noreturn]] static void shortFile() { throw std::runtime_error("ends too early: truncated"); }
    static std::int32_t swapped(std::int32_t value) {
        return static_cast<std::int32_t>(__builtin_bswap32(static_cast<std::uint32_t>(value)));
    }
    void skip(std::size_t count) {
        const std::size_t all = count + (fortran_ ? 8 : 0);
        if (bytes_.size() - at_ < all) shortFile();
        at_ += all;
    }
    std::string record(std::size_t count) {
        const std::size_t from = at_ + (fortran_ ? 4 : 0);
        skip(count);
        return bytes_.substr(from, count);
    }
    std::string word() {
        endLine();
        if (at_ >= bytes_.size()) shortFile();
        const std::size_t end = std::min(bytes_.size(), bytes_.find_first_of(" \t\r\n", at_));
        std::string text = bytes_.substr(at_, end - at_);
        at_ = end;
        return text;
    }
    std::string bytes_;
    bool binary_, fortran_;
    std::size_t at_ = 0;
};

std::size_t nodesOf(const std::string& cell) {
    static const std::map<std::string, std::size_t> kNodes = {
        {"point", 1},  {"bar2", 2},       {"bar3", 3},   {"tria3", 3},    {"tria6", 6},
        {"quad4", 4},  {"quad8", 8},      {"tetra4", 4}, {"tetra10", 10}, {"pyramid5", 5},
        {"penta6", 6}, {"pyramid13", 13}, {"hexa8", 8},  {"hexa20", 20},  {"penta15", 15}};
    const auto at = kNodes.find(cell.starts_with("g_") ? cell.substr(2) : cell);
    return at == kNodes.end() ? 0 : at->second;
}

bool readCells(GoldFile& file, const std::string& type, bool ids, GoldPart& part) {
    const std::string plain = type.starts_with("g_") ? type.substr(2) : type;
    const std::size_t nodes = nodesOf(type);
    if (nodes == 0 && plain != "nsided" && plain != "nfaced") return false;
    const auto count = static_cast<std::size_t>(file.integers(1)[0]);
    if (ids) file.numbers(count);
    if (nodes > 0) {
        file.numbers(count * nodes);
    } else {
        std::vector<std::int32_t> pieces = file.integers(count);
        if (plain == "nfaced") {
            std::size_t faces = 0;
            for (const std::int32_t n : pieces) faces += static_cast<std::size_t>(n);
            pieces = file.integers(faces);
        }
        std::size_t all = 0;
        for (const std::int32_t n : pieces) all += static_cast<std::size_t>(n);
        file.numbers(all);
    }
    file.endLine();
    part.cells.emplace_back(type, count);
    return true;
}

/// The parts by number; empty for structured blocks, which are not checked here.
std::map<int, GoldPart> readGeometry(GoldFile& file) {
    file.line();
    file.line();
    const auto given = [](const std::string& line) {
        return line.find("given") != std::string::npos || line.find("ignore") != std::string::npos;
    };
    const bool nodeIds = given(file.line()), cellIds = given(file.line());
    std::map<int, GoldPart> parts;
    std::string line = file.line();
    if (line.starts_with("extents")) {
        file.numbers(6);
        file.endLine();
        line = file.line();
    }
    while (line.starts_with("part")) {
        const int number = file.integers(1)[0];
        file.endLine();
        GoldPart& part = parts[number];
        file.line();
        line = file.line();
        if (line.starts_with("block")) return {};
        if (line != "coordinates") throw std::runtime_error("has \"" + line.substr(0, 40) + "\" for coordinates");
        part.points = static_cast<std::size_t>(file.integers(1)[0]);
        if (nodeIds) file.numbers(part.points);
        file.numbers(3 * part.points);
        file.endLine();
        line.clear();
        while (!file.atEnd()) {
            line = file.line();
            if (!readCells(file, line, cellIds, part)) break;
            line.clear();
        }
        if (line.empty() && file.atEnd()) break;
        if (!line.starts_with("part")) throw std::runtime_error("has \"" + line.substr(0, 40) + "\" for a part");
    }
    return parts;
}

void checkVariable(GoldFile& file, const std::map<int, GoldPart>& parts, std::size_t components) {
    file.line();
    while (!file.atEnd()) {
        if (std::string line = file.line(); !line.starts_with("part")) {
            if (line.starts_with("BEGIN TIME STEP") || line.starts_with("END TIME STEP"))
                return; // several steps in one file: not checked
            throw std::runtime_error("has \"" + line.substr(0, 40) + "\" for a part");
        }
        const auto part = parts.find(file.integers(1)[0]);
        file.endLine();
        if (part == parts.end()) throw std::runtime_error("has a part that is not in the geometry");
        std::size_t cellsLeft = part->second.cells.size();
        for (bool any = false; any || !file.atEnd(); any = false) {
            const std::string kind = file.line();
            if (kind.find(' ') != std::string::npos || kind.starts_with("block")) return; // partial values: not checked
            std::size_t count = 0;
            if (kind == "coordinates") {
                count = part->second.points;
                cellsLeft = 1;
            } else {
                const auto& cells = part->second.cells;
                const auto at =
                    std::find_if(cells.begin(), cells.end(), [&](const auto& c) { return c.first == kind; });
                if (at == cells.end()) throw std::runtime_error("has \"" + kind.substr(0, 40) + "\" for cells");
                count = at->second;
            }
            file.numbers(components * count);
            file.endLine();
            if (--cellsLeft == 0) break;
        }
        if (cellsLeft != 0) throw std::runtime_error("ends before its last cells: truncated");
    }
}

/// Files that match a name with asterisks for the number of the step.
std::vector<fs::path> filesOf(const fs::path& folder, const std::string& pattern) {
    std::vector<fs::path> files;
    if (pattern.find('*') == std::string::npos) {
        if (!fs::exists(folder / pattern)) throw std::runtime_error("names " + pattern + ", which does not exist");
        return {folder / pattern};
    }
    std::string expression;
    for (const char c : pattern) {
        if (c == '*') {
            expression += "[0-9]";
            continue;
        }
        if (std::strchr(".+()[]{}^$|?\\", c) != nullptr) expression += '\\';
        expression += c;
    }
    const std::regex fits(expression);
    const fs::path root = folder / pattern.substr(0, pattern.find('*'));
    const fs::path start = pattern.find('/') < pattern.find('*') ? root.parent_path() : folder;
    if (!fs::is_directory(start)) throw std::runtime_error("names " + pattern + ", which does not exist");
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(start))
        if (entry.is_regular_file() && std::regex_match(nameIn(folder, entry.path()), fits))
            files.push_back(entry.path());
    if (files.empty()) throw std::runtime_error("names " + pattern + ", which does not exist");
    std::sort(files.begin(), files.end());
    return files;
}

} // namespace

void checkEnSight(const std::string& path, std::size_t step, std::size_t steps) {
    const std::string text = readWhole(path);
    checkLastLine(text);
    if (text.find("gold") == std::string::npos) return; // EnSight 6: left to VTK's reader
    const fs::path folder = fs::path(path).parent_path().empty() ? "." : fs::path(path).parent_path();
    std::istringstream lines(text);
    std::map<int, GoldPart> parts;
    bool binary = false, fortran = false;
    const auto ofStep = [&](const std::vector<fs::path>& files) {
        return files[files.size() == steps ? step : std::min(step, files.size() - 1)];
    };
    const auto check = [&](const fs::path& file, const auto& body) {
        try {
            body();
        } catch (const std::runtime_error& error) {
            throw std::runtime_error("its file " + nameIn(folder, file) + " " + error.what());
        }
    };
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line.substr(std::min(line.size(), line.find(':') + 1)));
        std::vector<std::string> parsed;
        for (std::string word; words >> word;) parsed.push_back(word);
        if (parsed.empty()) continue;
        if (line.starts_with("model:")) {
            while (parsed.size() > 1 && std::isdigit(static_cast<unsigned char>(parsed[0][0])) != 0)
                parsed.erase(parsed.begin());
            const fs::path file = ofStep(filesOf(folder, parsed[0]));
            check(file, [&] {
                GoldFile geometry(file.string(), true, false, false);
                binary = geometry.binary();
                fortran = geometry.fortran();
                parts = readGeometry(geometry);
            });
        }
        const bool scalar = line.starts_with("scalar per "), vector = line.starts_with("vector per ");
        if ((!scalar && !vector) || line.find(" case:") != std::string::npos ||
            line.find("measured") != std::string::npos)
            continue;
        const fs::path file = ofStep(filesOf(folder, parsed.back()));
        if (!parts.empty())
            check(file, [&] {
                GoldFile variable(file.string(), false, binary, fortran);
                checkVariable(variable, parts, vector ? 3 : 1);
            });
    }
}

} // namespace tessera::importer
