#include "app/importer/readers/check_file.h"

#include "volume/base/byte_text.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <stdexcept>
#include <vector>
#include <zlib.h>

namespace tessera::importer {

namespace fs = std::filesystem;

namespace {

void checkXml(const std::string& path, std::set<std::string>& seen) {
    if (!seen.insert(path).second) return;
    constexpr std::size_t kTail = 4096;
    const std::size_t size = bytesIn(path);
    if (readPart(path, 0, kTail).find("<VTKFile") == std::string::npos)
        throw std::runtime_error("is not a VTK XML file");
    if (readPart(path, size - std::min(size, kTail), kTail).find("</VTKFile>") == std::string::npos)
        throw std::runtime_error("ends before its last tag: truncated");
    const std::string ending = fs::path(path).extension().string();
    const bool lists = ending.starts_with(".vtm") || ending == ".vtb" || ending == ".vtpd" || ending == ".vtpc" ||
                       ending.starts_with(".pv");
    if (!lists) return;
    const std::string text = readWhole(path);
    static const std::regex kNamed("\\s(?:file|Source)\\s*=\\s*\"([^\"]*)\"");
    for (std::sregex_iterator at(text.begin(), text.end(), kNamed), end; at != end; ++at) {
        const std::string name = (*at)[1].str(), inner = besides(path, name);
        if (!fs::exists(inner)) throw std::runtime_error("names " + name + ", which does not exist");
        try {
            checkXml(inner, seen);
        } catch (const std::runtime_error& error) {
            throw std::runtime_error("its part " + name + " " + error.what());
        }
    }
}

} // namespace

std::string besides(const std::string& file, const std::string& name) {
    const fs::path path(name);
    return path.is_absolute() ? name : (fs::path(file).parent_path() / path).string();
}

std::string readPart(const std::string& path, std::size_t begin, std::size_t count) {
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

void checkXml(const std::string& path) {
    std::set<std::string> seen;
    checkXml(path, seen);
}

void checkDeflated(const std::string& path, std::size_t begin, double wanted) {
    std::ifstream in(path, std::ios::binary);
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
