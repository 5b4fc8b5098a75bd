#include "volume/import/files/formats.h"

#include "volume/system/input_file.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <fstream>

namespace tessera::volume {

namespace {

constexpr FileFormat kFormats[] = {
#define TESSERA_FORMAT(name, suffixes, lengthUnit, slices, ...) FileFormat{name, suffixes, "", lengthUnit, slices},
#define TESSERA_UNREAD(name, suffixes, advice) FileFormat{name, suffixes, advice, "", false},
#include "volume/import/files/format_rows.inc"
};

/// Calls body(suffix) for each suffix of a row.
void eachSuffix(const FileFormat& format, auto&& body) {
    std::string_view rest = format.suffixes;
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.size(), rest.find(' '));
        body(rest.substr(0, end));
        rest.remove_prefix(std::min(rest.size(), end + 1));
    }
}

/// With its mark, or, as early files are, with the first element of its identification.
bool beginsLikeDicom(std::string_view head) {
    if (head.size() >= 132 && head.substr(128, 4) == "DICM") return true;
    if (head.size() < 132 || head[1] != 0 || head[3] != 0) return false;
    if (head[0] == 2 && head[2] == 0) return head.substr(4, 2) == "UL";
    if (head[0] != 8) return false;
    const auto isLetter = [](char c) { return c >= 'A' && c <= 'Z'; };
    const bool first = head[2] == 0 || head[2] == 5 || head[2] == 8 || head[2] == 0x12 || head[2] == 0x16;
    const bool brief = head[4] > 0 && head[4] <= 64 && head[5] == 0 && head[6] == 0 && head[7] == 0;
    return first && ((isLetter(head[4]) && isLetter(head[5])) || brief);
}

bool isDigits(std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// Removes a number after `mark` from the end of a name; false if there is none.
bool removeNumber(std::string& name, std::string_view mark) {
    const std::size_t at = name.rfind(mark);
    if (at == std::string::npos || !isDigits(std::string_view(name).substr(at + mark.size()))) return false;
    name.resize(at);
    return true;
}

} // namespace

std::span<const FileFormat> fileFormats() {
    return kFormats;
}

const FileFormat* formatOf(std::string_view path) {
    std::string name(path.substr(path.find_last_of('/') == std::string_view::npos ? 0 : path.find_last_of('/') + 1));
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    std::string parts = name; // Exodus of several processes: a.e.4.0
    if (removeNumber(parts, ".") && removeNumber(parts, ".") && parts.ends_with(".e"))
        return formatNamed("Exodus in parts");
    std::string later = name; // of a mesh that changed: a.e-s002
    if (removeNumber(later, "-s") && later.ends_with(".e")) name = later;
    const FileFormat* best = nullptr;
    std::size_t longest = 0;
    for (const FileFormat& format : kFormats)
        eachSuffix(format, [&](std::string_view suffix) {
            if (suffix.size() <= longest || !name.ends_with(suffix)) return;
            best = &format;
            longest = suffix.size();
        });
    return best;
}

const FileFormat* formatNamed(std::string_view name) {
    const auto at = std::find_if(std::begin(kFormats), std::end(kFormats),
                                 [&](const FileFormat& format) { return format.name == name; });
    return at == std::end(kFormats) ? nullptr : at;
}

const FileFormat* formatOfFile(const std::string& path) {
    if (const FileFormat* format = formatOf(path)) return format;
    if (namesFoamCase(path)) return formatNamed("OpenFOAM");
    // Raw files and their sidecars are read as such, whatever they begin with.
    if (path.ends_with(".raw") || path.ends_with(".json")) return nullptr;
    if (!whyNoFile(path).empty()) return nullptr;
    std::ifstream in(path, std::ios::binary);
    char head[132] = {};
    in.read(head, sizeof head);
    return beginsLikeDicom({head, static_cast<std::size_t>(in.gcount())}) ? formatNamed("DICOM") : nullptr;
}

bool isZarrFolder(const std::string& path) {
    const std::filesystem::path folder(path);
    std::error_code missing;
    if (!std::filesystem::is_directory(folder, missing)) return false;
    const std::filesystem::path named = folder.filename().empty() ? folder.parent_path() : folder;
    if (named.extension() == ".zarr") return true;
    for (const char* file : {".zgroup", ".zarray", "zarr.json"})
        if (std::filesystem::is_regular_file(folder / file, missing)) return true;
    return false;
}

bool isFoamCase(const std::string& folder) {
    const std::filesystem::path root(folder);
    std::error_code ignored;
    for (const char* part : {"system/controlDict", "system/controlDict.gz", "constant/polyMesh"})
        if (std::filesystem::exists(root / part, ignored)) return true;
    return false;
}

bool namesFoamCase(const std::string& path) {
    const std::filesystem::path file(path);
    const std::string name = file.filename().string(), folder = file.parent_path().filename().string();
    if (name == "controlDict" || name == "controlDict.gz")
        return folder == "system" || std::filesystem::absolute(file).parent_path().filename() == "system";
    const FileFormat* format = formatOf(path);
    return format != nullptr && format->name == "OpenFOAM";
}

bool isSlice(const FileFormat& format, const std::string& path) {
    if (!format.slices || format.name != "TIFF") return format.slices;
    if (!whyNoFile(path).empty()) return true;
    std::ifstream in(path, std::ios::binary);
    const auto number = [&](std::size_t bytes, bool big) {
        unsigned char raw[8] = {};
        in.read(reinterpret_cast<char*>(raw), static_cast<std::streamsize>(bytes));
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < bytes; ++i) value = value * 256 + raw[big ? i : bytes - 1 - i];
        return value;
    };
    char order[2] = {};
    in.read(order, 2);
    const bool big = order[0] == 'M', wide = number(2, big) == 43; // BigTIFF
    if (wide) number(4, big);
    const std::uint64_t directory = number(wide ? 8 : 4, big);
    in.seekg(static_cast<std::streamoff>(directory));
    const std::uint64_t entries = number(wide ? 8 : 2, big);
    in.seekg(static_cast<std::streamoff>(entries * (wide ? 20 : 12)), std::ios::cur);
    return number(wide ? 8 : 4, big) == 0 || !in;
}

bool isPicture(const FileFormat& format) {
    return format.slices && format.name != "TIFF" && format.name != "DICOM";
}

std::string readableSuffixes() {
    std::string all;
    for (const FileFormat& format : kFormats)
        if (format.advice.empty()) all += (all.empty() ? "" : " ") + std::string(format.suffixes);
    return all;
}

} // namespace tessera::volume
