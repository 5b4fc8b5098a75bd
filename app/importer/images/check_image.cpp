// Checks for truncated image files: the size must be at least what the header states.
#include "app/importer/readers/check_file.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace tessera::importer {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kHead = 1 << 20;

double fileBytes(const std::string& path, const std::string& name) {
    std::error_code failed;
    const auto size = fs::file_size(path, failed);
    if (failed) throw std::runtime_error("its samples' file " + name + " cannot be read");
    return double(size);
}

std::size_t countWords(const std::string& text) {
    std::istringstream in(text);
    std::size_t count = 0;
    for (std::string word; in >> word;) ++count;
    return count;
}

/// Reads "key = value" or "key: value" lines up to the key `last`; sets `end` to the position after that line.
std::map<std::string, std::string> readFields(const std::string& text, const std::string& separator,
                                              const std::string& last, std::size_t& end) {
    std::map<std::string, std::string> fields;
    std::size_t at = 0;
    while (at < text.size()) {
        const std::size_t stop = text.find('\n', at);
        if (stop == std::string::npos) throw std::runtime_error("ends within its header: truncated");
        std::string line = text.substr(at, stop - at);
        at = stop + 1;
        if (line.ends_with('\r')) line.pop_back();
        if (line.empty() && last.empty()) {
            end = at;
            return fields;
        }
        const std::size_t equals = line.find(separator);
        if (equals == std::string::npos) continue;
        std::string key = line.substr(0, equals), value = line.substr(equals + separator.size());
        key.erase(key.find_last_not_of(" \t") + 1);
        value.erase(0, value.find_first_not_of(" \t"));
        value.erase(value.find_last_not_of(" \t") + 1);
        fields[key] = value;
        if (key == last) {
            end = at;
            return fields;
        }
    }
    if (!last.empty()) throw std::runtime_error("ends within its header: truncated");
    end = text.size();
    return fields;
}

double product(const std::string& sizes) {
    std::istringstream in(sizes);
    double all = 1;
    for (double one = 0; in >> one;) all *= one;
    return all;
}

/// The location and encoding of the samples of a NRRD file.
struct NrrdPlace {
    std::string type, encoding; ///< as in the header
    std::string file, name;     ///< path of the samples, and its name in the header; "" = the file itself
    std::size_t begin = 0;
    double samples = 0;
    bool severalFiles = false;
};

NrrdPlace placeOfNrrd(const std::string& path) {
    const std::string head = readPart(path, 0, kHead);
    if (!head.starts_with("NRRD")) throw std::runtime_error("is damaged or has another format");
    NrrdPlace place;
    std::map<std::string, std::string> fields = readFields(head, ": ", "", place.begin);
    place.type = fields["type"];
    place.encoding = fields["encoding"];
    std::ranges::transform(place.encoding, place.encoding.begin(),
                           [](unsigned char c) { return char(std::tolower(c)); });
    place.samples = product(fields["sizes"]);
    place.name = fields["data file"] + fields["datafile"];
    place.severalFiles = place.name.find(' ') != std::string::npos || place.name == "LIST";
    place.file = place.name.empty() ? path : besides(path, place.name);
    if (!place.name.empty()) place.begin = 0;
    return place;
}

} // namespace

void checkMetaImage(const std::string& path) {
    const std::string head = readPart(path, 0, kHead);
    std::size_t begin = 0;
    std::map<std::string, std::string> fields = readFields(head, "=", "ElementDataFile", begin);
    static const std::map<std::string, int> kBytes = {{"MET_CHAR", 1},      {"MET_UCHAR", 1},  {"MET_SHORT", 2},
                                                      {"MET_USHORT", 2},    {"MET_INT", 4},    {"MET_UINT", 4},
                                                      {"MET_LONG", 4},      {"MET_ULONG", 4},  {"MET_FLOAT", 4},
                                                      {"MET_LONG_LONG", 8}, {"MET_DOUBLE", 8}, {"MET_ULONG_LONG", 8}};
    const auto type = kBytes.find(fields["ElementType"]);
    if (type == kBytes.end()) throw std::runtime_error("has samples of unknown type " + fields["ElementType"]);
    double channels = 1;
    if (fields.contains("ElementNumberOfChannels")) channels = product(fields["ElementNumberOfChannels"]);
    const double wanted = product(fields["DimSize"]) * channels * type->second;
    const std::string data = fields["ElementDataFile"];
    const bool compressed = fields["CompressedData"] == "True" || fields["CompressedData"] == "true";
    if (fields["BinaryData"] == "False" || fields["BinaryData"] == "false") {
        const std::string text = data == "LOCAL" ? readWhole(path).substr(begin) : readWhole(besides(path, data));
        checkLastLine(text);
        wantBytes(double(countWords(text)) * type->second, wanted);
    } else if (data == "LIST" || data.starts_with("LIST ")) {
        std::istringstream lines(readWhole(path).substr(begin));
        std::vector<std::string> names;
        for (std::string name; lines >> name;) names.push_back(name);
        if (names.empty()) throw std::runtime_error("names no file of samples");
        for (const std::string& name : names)
            if (!compressed) wantBytes(fileBytes(besides(path, name), name), wanted / double(names.size()), name);
    } else if (data.find('%') == std::string::npos) {
        const bool local = data == "LOCAL" || data == "Local" || data == "local";
        const std::string file = local ? path : besides(path, data);
        const double has = fileBytes(file, data) - (local ? double(begin) : 0);
        if (compressed)
            checkDeflated(file, local ? begin : 0, wanted);
        else
            wantBytes(has, wanted, local ? "" : data);
    }
}

void checkNifti(const std::string& path) {
    if (path.ends_with(".gz")) {
        checkDeflated(path, 0, 0); // the inflated size is checked by VTK's reader
        return;
    }
    std::string head = readPart(path, 0, 540);
    const auto number = [&]<class T>(T, std::size_t at, bool swap) {
        char bytes[sizeof(T)];
        std::memcpy(bytes, head.data() + at, sizeof(T));
        if (swap) std::reverse(bytes, bytes + sizeof(T));
        return std::bit_cast<T>(bytes);
    };
    if (head.size() < 348) throw std::runtime_error("ends within its header: truncated");
    double wanted = 1, begin = 0;
    for (const bool swap : {false, true}) {
        const std::int32_t size = number(std::int32_t(), 0, swap);
        if (size == 348) {
            const int axes = number(std::int16_t(), 40, swap);
            for (int i = 1; i <= std::clamp(axes, 0, 7); ++i)
                wanted *= number(std::int16_t(), 40 + 2 * std::size_t(i), swap);
            wanted *= number(std::int16_t(), 72, swap) / 8.0;
            begin = double(number(float(), 108, swap));
        } else if (size == 540 && head.size() == 540) {
            const auto axes = static_cast<int>(number(std::int64_t(), 16, swap));
            for (int i = 1; i <= std::clamp(axes, 0, 7); ++i)
                wanted *= double(number(std::int64_t(), 16 + 8 * std::size_t(i), swap));
            wanted *= number(std::int16_t(), 14, swap) / 8.0;
            begin = double(number(std::int64_t(), 168, swap));
        } else {
            continue;
        }
        wantBytes(double(bytesIn(path)) - begin, wanted);
        return;
    }
    throw std::runtime_error("is damaged or has another format");
}

void checkNrrd(const std::string& path) {
    const NrrdPlace place = placeOfNrrd(path);
    static const std::map<std::string, int> kBytes = {{"char", 1},     {"int8", 1},   {"short", 2}, {"int16", 2},
                                                      {"ushort", 2},   {"uint16", 2}, {"int", 4},   {"int32", 4},
                                                      {"uint", 4},     {"uint32", 4}, {"float", 4}, {"double", 8},
                                                      {"longlong", 8}, {"int64", 8},  {"uint64", 8}};
    std::string word = place.type;
    if (word.starts_with("unsigned ")) word = word.substr(9);
    if (word.starts_with("signed ")) word = word.substr(7);
    if (word.ends_with("_t")) word.resize(word.size() - 2);
    if (word.ends_with(" int") && word != "int") word.resize(word.size() - 4);
    const auto type = kBytes.find(word);
    const double wanted = place.samples * (type == kBytes.end() ? 1 : type->second);
    if (place.severalFiles) return; // VTK reports missing files
    if (place.encoding == "raw")
        wantBytes(fileBytes(place.file, place.name) - double(place.begin), wanted, place.name);
    else if (place.encoding == "gzip" || place.encoding == "gz")
        checkDeflated(place.file, place.begin, wanted);
    else if (const auto text = textOfNrrd(path); text && double(countWords(*text)) < place.samples)
        throw std::runtime_error("holds fewer samples than it announces");
}

std::optional<std::string> textOfNrrd(const std::string& path) {
    const NrrdPlace place = placeOfNrrd(path);
    if (place.severalFiles || (place.encoding != "ascii" && place.encoding != "text" && place.encoding != "txt"))
        return std::nullopt;
    std::string text = readWhole(place.file).substr(place.begin);
    checkLastLine(text);
    return text;
}

} // namespace tessera::importer
