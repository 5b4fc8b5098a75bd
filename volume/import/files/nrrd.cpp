#include "volume/import/files/nrrd.h"

#include "volume/base/error.h"
#include "volume/import/files/import_limits.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

namespace tessera::volume {

namespace {

std::vector<double> numbers(std::string text, const std::string& file, const std::string& field) {
    std::replace(text.begin(), text.end(), ',', ' ');
    std::istringstream in(text);
    std::vector<double> out;
    for (double value = 0; in >> value;) out.push_back(value);
    if (!in.eof()) throw Error("\"" + text.substr(0, 60) + "\" is no list of numbers", file, field);
    return out;
}

std::optional<RawType> typeOf(const std::string& word) {
    static constexpr std::pair<std::string_view, RawType> kTypes[] = {
        {"signed char", RawType::I8},     {"int8", RawType::I8},
        {"int8_t", RawType::I8},          {"uchar", RawType::U8},
        {"unsigned char", RawType::U8},   {"uint8", RawType::U8},
        {"uint8_t", RawType::U8},         {"short", RawType::I16},
        {"short int", RawType::I16},      {"int16", RawType::I16},
        {"int16_t", RawType::I16},        {"ushort", RawType::U16},
        {"unsigned short", RawType::U16}, {"uint16", RawType::U16},
        {"uint16_t", RawType::U16},       {"int", RawType::I32},
        {"int32", RawType::I32},          {"int32_t", RawType::I32},
        {"float", RawType::F32},          {"double", RawType::F64}};
    for (const auto& [name, type] : kTypes)
        if (name == word) return type;
    return std::nullopt;
}

/// Lengths of the vectors "(a,b,c) (d,e,f) ..."; "none" gives 1.
std::vector<double> lengths(const std::string& text, const std::string& file, const std::string& field) {
    std::vector<double> out;
    std::istringstream in(text);
    for (std::string word; in >> word;) {
        if (word == "none") {
            out.push_back(1);
            continue;
        }
        if (word.size() < 2 || word.front() != '(' || word.back() != ')') throw Error("wants vectors", file, field);
        double sum = 0;
        for (const double x : numbers(word.substr(1, word.size() - 2), file, field)) sum += x * x;
        out.push_back(std::sqrt(sum));
    }
    return out;
}

} // namespace

std::optional<RawForm> parseNrrd(std::string_view head, const std::string& file, NrrdEncoding wanted) {
    if (!head.starts_with("NRRD")) throw Error("is no NRRD file", file);
    RawForm form;
    RawForm::Component component;
    component.name = "value";
    std::optional<RawType> type;
    std::vector<double> sizes, spacing, origin;
    std::string encoding, kinds, content;
    std::size_t at = 0;
    bool ended = false;
    while (at < head.size()) {
        const std::size_t end = head.find('\n', at);
        if (end == std::string_view::npos) break;
        std::string line(head.substr(at, end - at));
        at = end + 1;
        if (line.ends_with('\r')) line.pop_back();
        if (line.empty()) {
            ended = true;
            break;
        }
        if (line.starts_with('#') || line.starts_with("NRRD")) continue;
        if (const std::size_t pair = line.find(":="); pair != std::string::npos) {
            const std::string key = line.substr(0, pair), value = line.substr(pair + 2);
            if (key == "unit") component.unit = value;
            if (key == "time" && !value.empty()) form.times = numbers(value, file, key);
            continue;
        }
        const std::size_t colon = line.find(": ");
        if (colon == std::string::npos) throw Error("\"" + line.substr(0, 60) + "\" is no field", file, "header");
        const std::string key = line.substr(0, colon);
        std::string value = line.substr(colon + 2);
        value.erase(value.find_last_not_of(" \t") + 1);
        if (key == "type")
            type = typeOf(value);
        else if (key == "encoding")
            encoding = value;
        else if (key == "sizes")
            sizes = numbers(value, file, key);
        else if (key == "spacings")
            spacing = numbers(value, file, key);
        else if (key == "space directions")
            spacing = lengths(value, file, key);
        else if (key == "space origin" && value.size() > 1)
            origin = numbers(value.substr(1, value.size() - 2), file, key);
        else if (key == "kinds")
            kinds = value;
        else if (key == "content")
            content = value;
        else if (key == "endian")
            form.bigEndian = value == "big";
        else if (key == "data file" || key == "datafile")
            form.dataFile = value;
        else if (key == "line skip" || key == "lineskip" || key == "byte skip" || key == "byteskip") {
            if (value != "0") return std::nullopt;
        }
    }
    if (!ended && form.dataFile.empty()) throw Error("the header does not end", file);
    if (sizes.empty()) throw Error("is missing", file, "sizes");
    const bool vector = kinds.find("vector") != std::string::npos || kinds.find("color") != std::string::npos ||
                        kinds.find("list") != std::string::npos || kinds.find("matrix") != std::string::npos;
    const bool text = encoding == "ascii" || encoding == "text" || encoding == "txt";
    const bool asWanted = wanted == NrrdEncoding::Raw ? encoding == "raw" : text;
    if (!asWanted || !type || sizes.size() > 3 || vector || form.dataFile.find(' ') != std::string::npos ||
        form.dataFile == "LIST")
        return std::nullopt;
    for (std::size_t axis = 0; axis < sizes.size(); ++axis) {
        const int i = static_cast<int>(axis);
        if (!(sizes[axis] >= 1 && sizes[axis] <= kMostSamplesPerAxis) || sizes[axis] != std::floor(sizes[axis]))
            throw Error("is out of range", file, "sizes");
        form.lattice.size[i] = static_cast<int>(sizes[axis]);
        if (axis < spacing.size() && spacing[axis] > 0 && std::isfinite(spacing[axis]))
            form.lattice.spacing[i] = spacing[axis];
        if (axis < origin.size() && std::isfinite(origin[axis])) form.lattice.origin[i] = origin[axis];
    }
    if (form.times.size() > 1 || (form.times.size() == 1 && !std::isfinite(form.times[0]))) form.times.clear();
    if (!content.empty()) component.name = content;
    component.type = *type;
    if (form.dataFile.empty()) form.skip = at;
    form.components.push_back(std::move(component));
    return form;
}

} // namespace tessera::volume
