#include "volume/import/files/nrrd.h"

#include "volume/base/error.h"
#include "volume/base/trimmed.h"
#include "volume/base/unit_conversion.h"
#include "volume/import/files/nrrd_axes.h"
#include "volume/import/files/nrrd_header.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace tessera::volume {

namespace {

std::string inSmall(std::string_view text) {
    std::string out;
    for (const char c : text) out += char(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

StoredType typeOfNrrd(const std::string& stated) {
    static constexpr std::pair<std::string_view, StoredType> kTypes[] = {
        {"char", StoredType::I8},      {"int8", StoredType::I8},    {"uchar", StoredType::U8},
        {"uint8", StoredType::U8},     {"short", StoredType::I16},  {"int16", StoredType::I16},
        {"ushort", StoredType::U16},   {"uint16", StoredType::U16}, {"int", StoredType::I32},
        {"int32", StoredType::I32},    {"uint", StoredType::U32},   {"uint32", StoredType::U32},
        {"longlong", StoredType::I64}, {"int64", StoredType::I64},  {"ulonglong", StoredType::U64},
        {"uint64", StoredType::U64},   {"float", StoredType::F32},  {"double", StoredType::F64}};
    std::string word; // "unsigned long long int" is ulonglong
    for (const char c : inSmall(stated))
        if (std::isspace(static_cast<unsigned char>(c)) == 0) word += c;
    if (word.starts_with("signed")) word.erase(0, 6);
    if (word.starts_with("unsigned")) word = "u" + word.substr(8);
    if (word.ends_with("_t")) word.resize(word.size() - 2);
    for (const char* const long_ : {"shortint", "longlongint"})
        if (word.ends_with(long_)) word.resize(word.size() - 3);
    for (const auto& [name, type] : kTypes)
        if (name == word) return type;
    if (stated.empty()) throw Error("is missing", {}, "type");
    throw Error("has samples of type \"" + stated.substr(0, 40) + "\", which is not read: write it as numbers", {},
                "type");
}

SampleEncoding encodingOf(const std::string& stated) {
    const std::string word = inSmall(stated);
    if (word == "raw") return SampleEncoding::Raw;
    if (word == "gz" || word == "gzip") return SampleEncoding::Deflate;
    if (word == "bz2" || word == "bzip2") return SampleEncoding::Bzip2;
    if (word == "hex") return SampleEncoding::Hex;
    if (word == "txt" || word == "text" || word == "ascii") return SampleEncoding::Text;
    if (word.empty()) throw Error("is missing", {}, "encoding");
    throw Error("\"" + stated.substr(0, 40) + "\" is not read: write it with the encoding raw or gzip", {}, "encoding");
}

double wholeNumber(const NrrdHeader& header, const char* field) {
    const std::vector<double> stated = nrrdNumbers(header.field(field), field);
    if (stated.empty()) return 0;
    if (stated[0] != std::floor(stated[0]) || std::abs(stated[0]) > 1e15) throw Error("is out of range", {}, field);
    return stated[0];
}

void readPlaces(const NrrdHeader& header, StoredImage& image) {
    SampleFiles& files = image.files;
    files.encoding = encodingOf(header.field("encoding"));
    files.names = nrrdDataFiles(header);
    if (files.names.empty()) {
        if (!header.hasEnd) throw Error("the header does not end");
        files.begin = header.end;
    }
    const double lines = wholeNumber(header, "lineskip"), bytes = wholeNumber(header, "byteskip");
    if (lines < 0) throw Error("is out of range", {}, "line skip");
    const bool hasEnds = files.encoding != SampleEncoding::Hex && files.encoding != SampleEncoding::Text;
    if (bytes < 0 && !hasEnds) throw Error("below 0 is not possible for text", {}, "byte skip");
    files.lineSkip = std::uint64_t(lines);
    files.byteSkip = std::int64_t(bytes);
    const std::string endian = inSmall(header.field("endian"));
    image.bigEndian = endian == "big";
    if (!endian.empty() && endian != "big" && endian != "little")
        throw Error("is \"" + endian.substr(0, 40) + "\", not big or little", {}, "endian");
    if (endian.empty() && volume::sizeOf(image.type) > 1 && files.encoding != SampleEncoding::Text)
        image.notes.push_back("the file states no byte order: its samples are read as little-endian");
}

/// The names of components of some kinds.
std::vector<std::string> componentNames(const std::string& kind, const std::string& label, std::size_t count) {
    static const std::vector<std::pair<std::string_view, std::vector<std::string>>> kNamed = {
        {"hsv-color", {"hue", "saturation", "brightness"}},
        {"xyz-color", {"X", "Y", "Z"}},
        {"quaternion", {"w", "x", "y", "z"}},
        {"2d-symmetric-matrix", {"xx", "xy", "yy"}},
        {"2d-masked-symmetric-matrix", {"confidence", "xx", "xy", "yy"}},
        {"2d-matrix", {"xx", "xy", "yx", "yy"}},
        {"2d-masked-matrix", {"confidence", "xx", "xy", "yx", "yy"}},
        {"3d-symmetric-matrix", {"xx", "xy", "xz", "yy", "yz", "zz"}},
        {"3d-masked-symmetric-matrix", {"confidence", "xx", "xy", "xz", "yy", "yz", "zz"}},
        {"3d-matrix", {"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"}},
        {"3d-masked-matrix", {"confidence", "xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"}}};
    for (const auto& [name, names] : kNamed)
        if (name == kind && names.size() == count) return names;
    std::vector<std::string> words; // a label such as "Vx;Vy;Vz"
    for (std::size_t at = 0; at <= label.size();) {
        const std::size_t end = std::min(label.find_first_of(";,", at), label.size());
        words.emplace_back(trimmed(std::string_view(label).substr(at, end - at)));
        at = end + 1;
    }
    return words.size() == count && count > 1 ? words : std::vector<std::string>();
}

void nameChannels(const NrrdHeader& header, const std::vector<NrrdAxis>& axes, StoredImage& image) {
    std::string kind, label;
    std::size_t lists = 0;
    for (const NrrdAxis& axis : axes)
        if (axis.along == StoredAxis::Along::Components && axis.size > 1 && lists++ == 0) {
            kind = axis.kind;
            label = axis.label;
        }
    const std::size_t count = image.offsets.size();
    const auto is = [&](std::initializer_list<const char*> kinds) {
        return std::ranges::find(kinds, kind) != kinds.end();
    };
    ComponentKind parts = ComponentKind::Channels;
    if (is({"vector", "2-vector", "3-vector", "covariant-vector", "normal", "point", "3-gradient", "3-normal"}))
        parts = ComponentKind::Vector;
    if (is({"rgb-color", "rgba-color", "3-color", "4-color"})) parts = ComponentKind::Colors;
    if (kind == "complex") parts = ComponentKind::Complex;
    if (count == 3 && (kind.empty() || kind == "???" || kind == "none")) {
        parts = ComponentKind::Vector;
        image.notes.emplace_back("the file does not say what its 3 components are: they are shown as a vector");
    }
    if (lists > 1 && parts == ComponentKind::Colors) parts = ComponentKind::Channels;
    const std::string& content = header.field("content");
    setChannels(image, content.empty() ? "value" : content, parts, componentNames(kind, label, count));
}

void addRangeNote(const NrrdHeader& header, StoredImage& image) {
    const std::string &low = header.field("oldmin"), &high = header.field("oldmax");
    const bool whole = image.type != StoredType::F32 && image.type != StoredType::F64;
    if (low.empty() || high.empty() || !whole) return;
    const std::vector<double> lo = nrrdNumbers(low, "old min"), hi = nrrdNumbers(high, "old max");
    if (lo.size() != 1 || hi.size() != 1 || !std::isfinite(lo[0]) || !std::isfinite(hi[0])) return;
    char text[200];
    std::snprintf(text, sizeof text,
                  "the stored numbers are shown; they were made from values between %.10g and %.10g (old min, old max)",
                  lo[0], hi[0]);
    image.notes.emplace_back(text);
}

/// An identity, or not stated.
bool isUsualFrame(const std::string& frame) {
    if (frame.empty()) return true;
    const auto columns = nrrdVectors(frame, "measurement frame");
    for (std::size_t c = 0; c < columns.size(); ++c)
        for (std::size_t r = 0; columns[c] && r < columns[c]->size(); ++r)
            if (std::abs((*columns[c])[r] - (r == c ? 1 : 0)) > 1e-6) return false;
    return true;
}

} // namespace

StoredImage parseNrrd(std::string_view head) {
    const NrrdHeader header = readNrrdHeader(head);
    StoredImage image;
    image.type = typeOfNrrd(header.field("type"));
    readPlaces(header, image);
    const std::vector<NrrdAxis> axes = nrrdAxes(header, image.notes);
    std::vector<StoredAxis> stored;
    for (const NrrdAxis& axis : axes) stored.push_back({axis.along, axis.size});
    setAxes(image, stored);
    placeNrrd(header, axes, image);
    nameChannels(header, axes, image);
    image.unit = nrrdWords(header.field("sampleunits")).empty() ? "" : header.field("sampleunits");
    if (image.unit.size() > 1 && image.unit.front() == '"') image.unit = nrrdWords(image.unit).front();
    if (const auto own = header.pairs.find("unit"); own != header.pairs.end()) image.unit = own->second;
    if (const auto time = header.pairs.find("time"); time != header.pairs.end() && image.frames == 1) {
        const std::vector<double> stated = nrrdNumbers(time->second, "time");
        if (stated.size() == 1 && std::isfinite(stated[0])) image.times = stated;
    }
    addRangeNote(header, image);
    if (!isUsualFrame(header.field("measurementframe")) && image.offsets.size() > 1)
        image.notes.emplace_back(
            "components are along the axes of the file's measurement frame, not turned to x, y, z");
    for (const std::string& field : header.unknown)
        image.notes.push_back("the field \"" + field.substr(0, 60) + "\" is not one of NRRD and was left out");
    return image;
}

} // namespace tessera::volume
