#include "volume/import/files/nrrd.h"

#include "volume/base/error.h"
#include "volume/base/unit_conversion.h"
#include "volume/import/files/import_limits.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <vector>

namespace tessera::volume {

namespace {

std::vector<double> numbers(std::string text, const std::string& file, const std::string& field) {
    std::replace(text.begin(), text.end(), ',', ' ');
    std::istringstream in(text);
    std::vector<double> out;
    for (double value = 0; in >> value;) out.push_back(value);
    if (!in.eof()) throw Error("\"" + text.substr(0, 60) + "\" is not a list of numbers", file, field);
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
        if (word.size() < 2 || word.front() != '(' || word.back() != ')') throw Error("needs vectors", file, field);
        double sum = 0;
        for (const double x : numbers(word.substr(1, word.size() - 2), file, field)) sum += x * x;
        out.push_back(std::sqrt(sum));
    }
    return out;
}

/// What a header says, field by field.
struct Header {
    std::string spaceUnits, axisUnits; ///< words in quotes, one for each axis
    std::optional<RawType> type;
    std::vector<double> sizes, spacing, origin;
    std::string encoding, kinds, content;
    bool skips = false;  ///< lines or bytes before the samples
    std::size_t end = 0; ///< of the header, where it ends
    bool hasEnd = false; ///< false: the file ends before the header does
};

/// A key with a value of its own, "key:=value".
void takePair(const std::string& key, const std::string& value, const std::string& file, RawForm& form,
              RawForm::Component& component) {
    if (key == "unit") component.unit = value;
    if (key == "time" && !value.empty()) form.times = numbers(value, file, key);
}

void takeField(const std::string& key, const std::string& value, const std::string& file, RawForm& form,
               Header& header) {
    if (key == "type")
        header.type = typeOf(value);
    else if (key == "encoding")
        header.encoding = value;
    else if (key == "sizes")
        header.sizes = numbers(value, file, key);
    else if (key == "spacings")
        header.spacing = numbers(value, file, key);
    else if (key == "space directions")
        header.spacing = lengths(value, file, key);
    else if (key == "space origin" && value.size() > 1)
        header.origin = numbers(value.substr(1, value.size() - 2), file, key);
    else if (key == "kinds")
        header.kinds = value;
    else if (key == "space units")
        header.spaceUnits = value;
    else if (key == "units")
        header.axisUnits = value;
    else if (key == "content")
        header.content = value;
    else if (key == "endian")
        form.bigEndian = value == "big";
    else if (key == "data file" || key == "datafile")
        form.dataFile = value;
    else if (key == "line skip" || key == "lineskip" || key == "byte skip" || key == "byteskip")
        header.skips = header.skips || value != "0";
}

/// The unit of "\"mm\" \"mm\" \"mm\"", "" where axes differ or state none.
std::string unitOfAxes(const std::string& quoted) {
    std::vector<std::string> axes;
    std::istringstream in(quoted);
    for (std::string word; in >> std::quoted(word);)
        if (!word.empty() && axes.size() < 3) axes.push_back(word); // a further axis counts components or times
    return lengthUnitOfAxes(axes);
}

std::string lengthUnitOf(const Header& header) {
    const std::string unit = unitOfAxes(header.spaceUnits);
    return unit.empty() ? unitOfAxes(header.axisUnits) : unit;
}

Header readHeader(std::string_view head, const std::string& file, RawForm& form, RawForm::Component& component) {
    Header header;
    while (header.end < head.size() && !header.skips) {
        const std::size_t end = head.find('\n', header.end);
        if (end == std::string_view::npos) break;
        std::string line(head.substr(header.end, end - header.end));
        header.end = end + 1;
        if (line.ends_with('\r')) line.pop_back();
        if (line.empty()) {
            header.hasEnd = true;
            break;
        }
        if (line.starts_with('#') || line.starts_with("NRRD")) continue;
        if (const std::size_t pair = line.find(":="); pair != std::string::npos) {
            takePair(line.substr(0, pair), line.substr(pair + 2), file, form, component);
            continue;
        }
        const std::size_t colon = line.find(": ");
        if (colon == std::string::npos) throw Error("\"" + line.substr(0, 60) + "\" is not a field", file, "header");
        std::string value = line.substr(colon + 2);
        value.erase(value.find_last_not_of(" \t") + 1);
        takeField(line.substr(0, colon), value, file, form, header);
    }
    return header;
}

} // namespace

std::string lengthUnitOfNrrd(std::string_view head) {
    RawForm form;
    RawForm::Component component;
    return lengthUnitOf(readHeader(head, {}, form, component));
}

std::optional<RawForm> parseNrrd(std::string_view head, const std::string& file, NrrdEncoding wanted) {
    if (!head.starts_with("NRRD")) throw Error("is not an NRRD file", file);
    RawForm form;
    RawForm::Component component;
    component.name = "value";
    const Header header = readHeader(head, file, form, component);
    if (header.skips) return std::nullopt;
    if (!header.hasEnd && form.dataFile.empty()) throw Error("the header does not end", file);
    if (header.sizes.empty()) throw Error("is missing", file, "sizes");
    const auto isKind = [&](const char* kind) { return header.kinds.find(kind) != std::string::npos; };
    const bool vector = isKind("vector") || isKind("color") || isKind("list") || isKind("matrix");
    const bool text = header.encoding == "ascii" || header.encoding == "text" || header.encoding == "txt";
    const bool asWanted = wanted == NrrdEncoding::Raw ? header.encoding == "raw" : text;
    if (!asWanted || !header.type || header.sizes.size() > 3 || vector ||
        form.dataFile.find(' ') != std::string::npos || form.dataFile == "LIST")
        return std::nullopt;
    for (std::size_t axis = 0; axis < header.sizes.size(); ++axis) {
        const int i = static_cast<int>(axis);
        const double size = header.sizes[axis];
        if (!(size >= 1 && size <= kMostSamplesPerAxis) || size != std::floor(size))
            throw Error("is out of range", file, "sizes");
        form.lattice.size[i] = static_cast<int>(size);
        if (axis < header.spacing.size() && header.spacing[axis] > 0 && std::isfinite(header.spacing[axis]))
            form.lattice.spacing[i] = header.spacing[axis];
        if (axis < header.origin.size() && std::isfinite(header.origin[axis]))
            form.lattice.origin[i] = header.origin[axis];
    }
    if (form.times.size() > 1 || (form.times.size() == 1 && !std::isfinite(form.times[0]))) form.times.clear();
    if (!header.content.empty()) component.name = header.content;
    component.type = *header.type;
    if (form.dataFile.empty()) form.skip = header.end;
    form.components.push_back(std::move(component));
    form.lengthUnit = lengthUnitOf(header);
    return form;
}

} // namespace tessera::volume
