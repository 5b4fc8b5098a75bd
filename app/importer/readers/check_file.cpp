#include "app/importer/readers/check_file.h"

#include "app/importer/readers/piece_cover.h"
#include "volume/base/byte_text.h"
#include "volume/system/input_file.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <pugixml.hpp>
#include <set>
#include <stdexcept>
#include <vector>
#include <zlib.h>

namespace tessera::importer {

namespace fs = std::filesystem;

namespace {

volume::Outside allowedOutside = volume::Outside::Refused; ///< of the process: it reads files for one request

/// The files that a VTK XML file names, of the kinds that hold no samples of their own.
std::vector<std::string> namedInXml(const std::string& path) {
    constexpr std::size_t kMostList = std::size_t(1) << 30;
    if (bytesIn(path) > kMostList) throw std::runtime_error("is too large for a list of files");
    const std::string text = readWhole(path);
    // Names might be put together from entities, or be defaults of attributes, which VTK's reader knows.
    if (text.find("<!DOCTYPE") != std::string::npos)
        throw std::runtime_error("declares a document type, as no VTK file does");
    pugi::xml_document document;
    document.load_buffer(text.data(), text.size());
    std::vector<std::string> names;
    struct Walker : pugi::xml_tree_walker {
        std::vector<std::string>* to = nullptr;
        bool for_each(pugi::xml_node& node) override {
            for (const pugi::xml_attribute& attribute : node.attributes())
                if (std::string_view(attribute.name()) == "file" || std::string_view(attribute.name()) == "Source")
                    to->emplace_back(attribute.value());
            return true;
        }
    } walker;
    walker.to = &names;
    document.traverse(walker);
    return names;
}

/// Whether a VTK XML file lists others, by its head as VTK's readers take it, or by its ending as they choose a reader.
bool listsFiles(const std::string& path, const std::string& head) {
    const std::string ending = fs::path(path).extension().string();
    if (ending.starts_with(".vtm") || ending.starts_with(".vth") || ending == ".vtb" || ending == ".vtpd" ||
        ending == ".vtpc" || ending.starts_with(".pv"))
        return true;
    const std::size_t type = head.find("type", std::min(head.find("<VTKFile"), head.size()));
    const std::string_view kind = std::string_view(head).substr(std::min(type, head.size()), 40);
    if (kind.find("\"PolyData") != std::string_view::npos) return false;
    return kind.find("\"P") != std::string_view::npos || kind.find("'P") != std::string_view::npos ||
           kind.find("vtk") != std::string_view::npos;
}

/// Every part of a list holds the samples that the list says it has.
void checkParts(const std::string& path, const GridPieces& pieces) {
    for (std::size_t p = 0; p < pieces.sources.size() && p < pieces.parts.size(); ++p) {
        std::optional<GridPieces> inner = piecesOf(besides(path, pieces.sources[p]));
        if (!inner) continue; // another kind: VTK tells
        inner->whole = pieces.parts[p];
        if (const std::size_t missing = missingIn(*inner, false); missing > 0)
            throw std::runtime_error("its part " + pieces.sources[p] + " lacks " + std::to_string(missing) +
                                     " of the samples that it should have");
    }
}

void checkXml(const std::string& path, bool gaps, std::set<std::string>& seen) {
    if (!seen.insert(path).second) return;
    constexpr std::size_t kTail = 4096;
    const std::size_t size = bytesIn(path);
    const std::string head = readPart(path, 0, kTail);
    if (head.find("<VTKFile") == std::string::npos) throw std::runtime_error("is not a VTK XML file");
    if (readPart(path, size - std::min(size, kTail), kTail).find("</VTKFile>") == std::string::npos)
        throw std::runtime_error("ends before its last tag: truncated");
    if (listsFiles(path, head))
        for (const std::string& name : namedInXml(path)) {
            const std::string inner = besides(path, name);
            if (!fs::exists(inner)) throw std::runtime_error("names " + name + ", which does not exist");
            try {
                checkXml(inner, false, seen);
            } catch (const std::runtime_error& error) {
                throw std::runtime_error("its part " + name + " " + error.what());
            }
        }
    const std::optional<GridPieces> pieces = piecesOf(path);
    if (!pieces) return;
    checkParts(path, *pieces);
    if (const std::size_t missing = gaps ? 0 : missingIn(*pieces, false); missing > 0)
        throw std::runtime_error("its pieces leave out " + std::to_string(missing) +
                                 " of the samples of its whole extent");
}

} // namespace

void letNameOutside(volume::Outside outside) {
    allowedOutside = outside;
}

volume::Outside outsideOfFolders() {
    return allowedOutside;
}

std::string besidesIn(const std::string& folder, const std::string& name) {
    std::string path = volume::namedPathIn(folder, name, allowedOutside);
    if (whyNoFile(path) == kPipeOrDevice)
        throw std::runtime_error("names \"" + name.substr(0, 200) + "\", which " + kPipeOrDevice);
    return path;
}

std::string besides(const std::string& file, const std::string& name) {
    return besidesIn(fs::path(file).parent_path().string(), name);
}

std::string readPart(const std::string& path, std::size_t begin, std::size_t count) {
    if (whyNoFile(path) == kPipeOrDevice)
        throw std::runtime_error(fs::path(path).filename().string() + " " + kPipeOrDevice);
    std::ifstream in(path, std::ios::binary);
    in.seekg(0, std::ios::end);
    const std::streamoff end = in.tellg(); // a count from a damaged header must take no memory
    const std::size_t left = end > 0 && std::size_t(end) > begin ? std::size_t(end) - begin : 0;
    in.seekg(static_cast<std::streamoff>(begin));
    std::string text(std::min(count, left), '\0');
    in.read(text.data(), static_cast<std::streamsize>(count));
    text.resize(static_cast<std::size_t>(in.gcount()));
    return text;
}

std::string readWhole(const std::string& path) {
    return readPart(path, 0, bytesIn(path));
}

std::size_t bytesIn(const std::string& path) {
    std::error_code failed;
    const std::uintmax_t size = fs::file_size(path, failed);
    if (failed) throw std::runtime_error(fs::path(path).filename().string() + " cannot be read");
    return static_cast<std::size_t>(size);
}

void wantBytes(double has, double wanted, const std::string& where, const char* what) {
    if (has >= wanted) return;
    char numbers[128]; // as %g, since a damaged header may announce more than an integer holds
    std::snprintf(numbers, sizeof numbers, "has %.15g %s, but its header announces %.15g", std::max(has, 0.0), what,
                  wanted);
    throw std::runtime_error((where.empty() ? "" : "its file " + where + " ") + numbers);
}

void refuseHollow(double stated, double stored, const std::string& what) {
    // Of the filters in use zstd packs equal numbers most densely, 128 KiB in a block of 4 bytes: 32768 to 1 (deflate
    // reaches 1032 to 1). A little may be left to its fill value altogether.
    constexpr double kMostPerByte = 40'000, kHarmless = double(64 << 20);
    if (stated <= kHarmless + kMostPerByte * stored) return;
    throw std::runtime_error((what.empty() ? "" : what + " ") + "states " + textOfBytes(stated) + ", of which " +
                             textOfBytes(stored) + " are stored");
}

void checkLastLine(std::string_view text) {
    if (text.empty()) throw std::runtime_error("is empty");
    if (std::isspace(static_cast<unsigned char>(text.back())) == 0)
        throw std::runtime_error("ends within a line: truncated (a whole file ends with a line end)");
}

void checkXml(const std::string& path, bool gaps) {
    std::set<std::string> seen;
    checkXml(path, gaps, seen);
}

void checkDeflated(const std::string& path, std::size_t begin, double wanted) {
    std::ifstream in = openInput(path);
    in.seekg(static_cast<std::streamoff>(begin));
    z_stream stream{};
    constexpr int kAnyHeader = 15 + 32;
    if (inflateInit2(&stream, kAnyHeader) != Z_OK) throw std::runtime_error("cannot be decompressed");
    std::vector<char> bytes(1 << 16), out(1 << 18);
    double got = 0;
    int status = Z_OK;
    bool ended = false; // a gzip file may consist of several streams
    while (status == Z_OK || status == Z_BUF_ERROR || status == Z_STREAM_END) {
        if (stream.avail_in == 0) {
            in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
            stream.avail_in = static_cast<unsigned>(in.gcount());
            stream.next_in = reinterpret_cast<Bytef*>(bytes.data());
            if (stream.avail_in == 0) break;
        }
        if (status == Z_STREAM_END) {
            if (*stream.next_in != 0x1f) break; // something else follows
            inflateReset(&stream);
        }
        stream.avail_out = static_cast<unsigned>(out.size());
        stream.next_out = reinterpret_cast<Bytef*>(out.data());
        status = inflate(&stream, Z_NO_FLUSH);
        got += double(out.size()) - stream.avail_out;
        ended = status == Z_STREAM_END;
    }
    inflateEnd(&stream);
    if (!ended) throw std::runtime_error("its compressed samples end early: truncated or damaged");
    wantBytes(got, wanted);
}

void checkLegacy(const std::string& path, std::size_t arrays) {
    const std::string text = readWhole(path);
    const std::string head = text.substr(0, 1024);
    if (head.find("\nASCII") != std::string::npos) checkLastLine(text);
    std::size_t announced = 0, attributes = std::string::npos;
    for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1)) {
        static constexpr const char* kWords[] = {"SCALARS ", "VECTORS ", "NORMALS ", "TENSORS ", "COLOR_SCALARS "};
        for (const char* word : kWords)
            if (text.compare(at + 1, std::strlen(word), word) == 0) ++announced;
        unsigned number = 0;
        if (text.compare(at + 1, 6, "FIELD ") == 0 && std::sscanf(text.c_str() + at + 7, "%*255s %u", &number) == 1)
            announced += number;
        if (text.compare(at + 1, 10, "NULL_ARRAY") == 0 && announced > 0) --announced;
        if (text.compare(at + 1, 11, "POINT_DATA ") == 0 || text.compare(at + 1, 10, "CELL_DATA ") == 0)
            attributes = text.find('\n', at + 1);
    }
    if (attributes != std::string::npos && text.find_first_not_of(" \t\r\n", attributes) == std::string::npos)
        throw std::runtime_error("ends too early: announces values of points or cells, and none follow");
    if (arrays < announced)
        throw std::runtime_error("ends too early: announces " + std::to_string(announced) + " arrays, holds " +
                                 std::to_string(arrays));
}

} // namespace tessera::importer
