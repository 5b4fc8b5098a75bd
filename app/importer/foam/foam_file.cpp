#include "app/importer/foam/foam_file.h"

#include "app/importer/readers/check_file.h"
#include "volume/base/trimmed.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <zlib.h>

namespace tessera::importer {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostHead = 8192; // of a header with its banner

bool isBlankOfFoam(char c) {
    return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

bool isMarkOfFoam(char c) {
    return c == '(' || c == ')' || c == '{' || c == '}' || c == '[' || c == ']' || c == ';';
}

/// The first bytes of a gzip file, inflated.
std::string inflated(const std::string& path, std::size_t most) {
    gzFile file = gzopen(path.c_str(), "rb");
    if (file == nullptr) throw std::runtime_error("cannot be read");
    std::string out;
    int failed = Z_OK;
    for (std::size_t got = 1; got != 0 && out.size() < most;) {
        const std::size_t before = out.size(), step = std::min<std::size_t>(most - before, std::size_t(1) << 20);
        out.resize(before + step);
        const int read = gzread(file, out.data() + before, static_cast<unsigned>(step));
        got = read > 0 ? std::size_t(read) : 0;
        out.resize(before + got);
    }
    gzerror(file, &failed);
    gzclose(file);
    if (failed != Z_OK && failed != Z_STREAM_END) throw std::runtime_error("ends too early or is damaged");
    return out;
}

/// Part `wanted` of a file of all processors: "N (bytes)" for each, after a header.
std::string partOfCollated(const FoamFile& all, int wanted) {
    FoamCursor in(all);
    for (int part = 0;; ++part) {
        if (!in.more()) throw std::runtime_error("has fewer parts than its folder's name says");
        const std::int64_t size = in.label();
        if (size < 0) throw std::runtime_error("has a part of negative size");
        if (size > 0) in.expect('(');
        const std::size_t begin = in.at(), length = std::size_t(size);
        if (length > all.bytes.size() - begin && (all.whole || part < wanted))
            throw std::runtime_error("ends too early: truncated");
        if (part == wanted) return all.bytes.substr(begin, length);
        in.moveTo(begin + length);
        if (size > 0) in.expect(')');
    }
}

/// Takes over what the header says; where there is none nothing is known.
void readHeader(FoamFile& file) {
    file.body = 0;
    file.kind.clear();
    const std::string_view head = std::string_view(file.bytes).substr(0, kMostHead);
    if (head.find("FoamFile") == std::string_view::npos) return;
    FoamCursor in(file);
    while (in.more() && in.peek() != '{' && in.word() != "FoamFile") {
    }
    in.expect('{');
    while (in.peek() != '}') {
        const std::string key(in.word());
        if (in.peek() == '{') {
            in.skipBrackets();
            continue;
        }
        std::string value = in.statement();
        std::erase(value, '"');
        if (key == "class") file.kind = value;
        if (key == "format") file.binary = value == "binary";
        if (key != "arch") continue;
        file.swap = value.find("MSB") != std::string::npos;
        if (value.find("label=64") != std::string::npos) file.labelBytes = 8;
        if (value.find("scalar=32") != std::string::npos) file.scalarBytes = 4;
    }
    in.expect('}');
    file.body = in.at();
}

template <class T> T foamNumberAt(const char* bytes, bool swap) {
    char raw[sizeof(T)];
    std::memcpy(raw, bytes, sizeof raw);
    if (swap) std::reverse(raw, raw + sizeof raw);
    return std::bit_cast<T>(raw);
}

} // namespace

FoamPlace foamPlace(const std::string& folder, const std::string& name, int processor, const std::string& root) {
    const fs::path base = fs::path(folder) / name;
    for (const char* packed : {"", ".gz"}) {
        const std::string path = base.string() + packed;
        std::error_code problem;
        if (fs::is_regular_file(path, problem))
            return {path, fs::path(path).lexically_relative(root).string(), processor};
    }
    return {};
}

FoamFile readFoamFile(const FoamPlace& place, std::size_t most) {
    FoamFile file;
    file.place = place;
    try {
        const bool collated = place.processor >= 0;
        const std::size_t wanted = place.processor > 0 ? kWholeFoamFile : most; // a part may begin anywhere
        if (place.path.ends_with(".gz"))
            file.bytes = inflated(place.path, wanted);
        else
            file.bytes = readPart(place.path, 0, std::min(wanted, bytesIn(place.path)));
        file.whole = file.bytes.size() < wanted;
        readHeader(file);
        if (!collated || file.kind != "decomposedBlockData") return file;
        FoamFile all;
        std::swap(all, file);
        file.place = place;
        file.bytes = partOfCollated(all, 0);
        file.whole = all.whole;
        readHeader(file);
        if (place.processor > 0) { // the first part alone has a header
            const std::string first = file.bytes.substr(0, file.body);
            file.bytes = first + partOfCollated(all, place.processor);
        }
    } catch (const std::runtime_error& error) {
        throw std::runtime_error("its file " + place.shown + " " + error.what());
    }
    return file;
}

void FoamCursor::endsEarly() {
    throw std::runtime_error("ends too early: truncated");
}

bool FoamCursor::more() {
    const std::string& text = file_.bytes;
    while (at_ < text.size()) {
        if (isBlankOfFoam(text[at_])) {
            ++at_;
            continue;
        }
        if (text[at_] != '/' || at_ + 1 >= text.size() || (text[at_ + 1] != '/' && text[at_ + 1] != '*')) return true;
        const bool line = text[at_ + 1] == '/';
        const std::size_t end = text.find(line ? "\n" : "*/", at_ + 2);
        if (end == std::string::npos && !line) throw std::runtime_error("ends within a comment: truncated");
        at_ = end == std::string::npos ? text.size() : end + (line ? 1 : 2);
    }
    return false;
}

std::string_view FoamCursor::word() {
    if (!more()) endsEarly();
    const std::string& text = file_.bytes;
    const std::size_t begin = at_;
    if (text[at_] == '"') {
        at_ = text.find('"', at_ + 1);
        if (at_ == std::string::npos) endsEarly();
        ++at_;
    } else if (isMarkOfFoam(text[at_])) {
        ++at_;
    } else {
        while (at_ < text.size() && !isBlankOfFoam(text[at_]) && !isMarkOfFoam(text[at_]) && text[at_] != '"') ++at_;
        if (at_ == text.size() && !file_.whole) endsEarly(); // the rest of the word was not read
    }
    return std::string_view(text).substr(begin, at_ - begin);
}

void FoamCursor::expect(char c) {
    if (!more()) endsEarly();
    if (file_.bytes[at_] != c)
        throw std::runtime_error("has \"" + std::string(word().substr(0, 20)) + "\" where " + c + " is expected");
    ++at_;
}

void FoamCursor::skipBrackets() {
    int depth = 0;
    do {
        const std::string_view next = word();
        if (next == "(" || next == "{" || next == "[") ++depth;
        if (next == ")" || next == "}" || next == "]") --depth;
    } while (depth > 0);
}

std::string FoamCursor::statement() {
    more();
    const std::size_t begin = at_;
    for (int depth = 0;;) {
        if (!more()) endsEarly();
        if (file_.bytes.compare(at_, 2, "#{") == 0) { // code up to #}
            at_ = file_.bytes.find("#}", at_);
            if (at_ == std::string::npos) endsEarly();
            at_ += 2;
            continue;
        }
        const std::string_view next = word();
        if (next == "(" || next == "{" || next == "[") ++depth;
        if (next == ")" || next == "}" || next == "]") --depth;
        if (depth < 0) throw std::runtime_error("lacks a semicolon");
        if (next == ";" && depth == 0) break;
    }
    return std::string(volume::trimmed(std::string_view(file_.bytes).substr(begin, at_ - 1 - begin)));
}

double FoamCursor::number() {
    if (!more()) endsEarly();
    const char *begin = file_.bytes.data() + at_, *end = file_.bytes.data() + file_.bytes.size();
    if (*begin == '+') ++begin;
    double value = 0;
    const auto [stop, failed] = std::from_chars(begin, end, value);
    if (failed == std::errc::result_out_of_range) // from_chars leaves 1e-400 and 1e400 to us
        value = std::strtod(std::string(begin, stop).c_str(), nullptr);
    else if (failed != std::errc())
        throw std::runtime_error("has \"" + std::string(word().substr(0, 20)) + "\" where a number is expected");
    at_ = std::size_t(stop - file_.bytes.data());
    if (at_ == file_.bytes.size()) endsEarly(); // the number may be cut
    return value;
}

std::int64_t FoamCursor::label() {
    if (!more()) endsEarly();
    const char *begin = file_.bytes.data() + at_, *end = file_.bytes.data() + file_.bytes.size();
    std::int64_t value = 0;
    const auto [stop, failed] = std::from_chars(begin, end, value);
    if (failed != std::errc())
        throw std::runtime_error("has \"" + std::string(word().substr(0, 20)) + "\" where a whole number is expected");
    at_ = std::size_t(stop - file_.bytes.data());
    return value;
}

std::int64_t FoamCursor::count(std::size_t most) {
    if (peek() == '(') return -1;
    const std::int64_t count = label();
    if (count < 0 || std::uint64_t(count) > most)
        throw std::runtime_error("has a list of " + std::to_string(count) + " values, more than there can be");
    return count;
}

/// The bytes of each number of a binary list: as the header says, or the other size where the list ends there.
std::size_t FoamCursor::binaryList(std::size_t bytes, std::size_t other, std::size_t count) {
    expect('(');
    const std::size_t left = file_.bytes.size() - at_;
    const auto closes = [&](std::size_t each) {
        return left > 0 && count <= (left - 1) / each && file_.bytes[at_ + count * each] == ')';
    };
    if (closes(bytes)) return bytes;
    if (closes(other)) return other;
    if (left == 0 || count > (left - 1) / bytes) endsEarly();
    throw std::runtime_error("has a binary list of another length than it states");
}

void FoamCursor::addLabels(std::size_t most, std::vector<std::int32_t>& out) {
    const auto add = [&](std::int64_t value) {
        if (value < -1 || value > std::numeric_limits<std::int32_t>::max())
            throw std::runtime_error("has the number " + std::to_string(value) + ", which is no index");
        out.push_back(static_cast<std::int32_t>(value));
    };
    const std::int64_t stated = count(most);
    if (stated == 0) {
        if (peek() == '(') skipBrackets();
        return;
    }
    const std::size_t wanted = std::size_t(std::max<std::int64_t>(stated, 0)), before = out.size();
    if (stated > 0 && peek() == '{') { // also in binary files
        ++at_;
        add(label());
        expect('}');
        out.resize(before + wanted, out.back());
        return;
    }
    if (file_.binary && stated > 0) {
        const std::size_t each = binaryList(file_.labelBytes, 12 - file_.labelBytes, wanted);
        const char* from = file_.bytes.data() + at_;
        for (std::size_t i = 0; i < wanted; ++i)
            add(each == 8 ? foamNumberAt<std::int64_t>(from + 8 * i, file_.swap)
                          : foamNumberAt<std::int32_t>(from + 4 * i, file_.swap));
        at_ += wanted * each + 1;
        return;
    }
    expect('(');
    if (stated > 0 && wanted > file_.bytes.size() - at_) endsEarly();
    while (peek() != ')') add(label());
    ++at_;
    if (stated > 0 && out.size() - before != wanted)
        throw std::runtime_error("has " + std::to_string(out.size() - before) + " numbers in a list of " +
                                 std::to_string(wanted));
}

void FoamCursor::value(double* out, std::size_t components) {
    if (components == 1 && peek() != '(') {
        *out = number();
        return;
    }
    expect('(');
    for (std::size_t c = 0; c < components; ++c) out[c] = number();
    expect(')');
}

std::vector<double> FoamCursor::numbers(std::size_t components, std::size_t most) {
    std::vector<double> out;
    const std::int64_t stated = count(most);
    if (stated == 0) {
        if (peek() == '(') skipBrackets();
        return out;
    }
    const auto wanted = std::size_t(std::max<std::int64_t>(stated, 0));
    if (stated > 0 && peek() == '{') {
        ++at_;
        std::vector<double> one(components);
        value(one.data(), components);
        expect('}');
        out.reserve(wanted * components);
        for (std::size_t i = 0; i < wanted; ++i) out.insert(out.end(), one.begin(), one.end());
        return out;
    }
    if (file_.binary && stated > 0) {
        const std::size_t each = binaryList(file_.scalarBytes, 12 - file_.scalarBytes, wanted * components);
        out.resize(wanted * components);
        const char* from = file_.bytes.data() + at_;
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] = each == 8 ? foamNumberAt<double>(from + 8 * i, file_.swap)
                               : double(foamNumberAt<float>(from + 4 * i, file_.swap));
        at_ += out.size() * each + 1;
        return out;
    }
    expect('(');
    if (stated > 0 && wanted > file_.bytes.size() - at_) endsEarly();
    out.reserve(wanted * components);
    std::vector<double> one(components);
    while (peek() != ')') {
        value(one.data(), components);
        out.insert(out.end(), one.begin(), one.end());
    }
    ++at_;
    if (stated > 0 && out.size() != wanted * components)
        throw std::runtime_error("has " + std::to_string(out.size() / components) + " values in a list of " +
                                 std::to_string(wanted));
    return out;
}

void FoamCursor::expectEnd() {
    if (file_.binary) {
        const std::string& text = file_.bytes;
        const std::size_t last = text.find_last_not_of(" \t\r\n");
        const bool comment = last != std::string::npos && last > 0 && text.compare(last - 1, 2, "//") == 0;
        if (last == std::string::npos || (!comment && text[last] != '}' && text[last] != ')' && text[last] != ';'))
            endsEarly();
        return;
    }
    int depth = 0;
    char last = '}';
    while (more()) {
        const std::string_view next = word();
        last = next.back();
        if (depth == 0 && next.front() == '#' && more()) { // #remove "inlet.*" needs no semicolon
            word();
            last = ';';
            continue;
        }
        if (next == "(" || next == "{" || next == "[") ++depth;
        if (next == ")" || next == "}" || next == "]") --depth;
    }
    if (depth != 0 || (last != '}' && last != ')' && last != ';')) endsEarly();
}

} // namespace tessera::importer
