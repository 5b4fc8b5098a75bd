#include "volume/import/files/nrrd_header.h"

#include "volume/base/error.h"
#include "volume/base/trimmed.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace tessera::volume {

namespace {

constexpr std::size_t kMostDataFiles = 100'000;

std::string plainName(std::string_view name) {
    std::string out;
    for (const char c : name)
        if (c != ' ' && c != '\t') out += char(std::tolower(static_cast<unsigned char>(c)));
    return out == "centers" ? "centerings" : out;
}

bool isField(const std::string& name) {
    static constexpr std::array<std::string_view, 29> kFields = {
        "content", "number",   "type",        "blocksize", "dimension",   "space",           "spacedimension",
        "sizes",   "spacings", "thicknesses", "axismins",  "axismaxs",    "spacedirections", "centerings",
        "kinds",   "labels",   "units",       "min",       "max",         "oldmin",          "oldmax",
        "endian",  "encoding", "lineskip",    "byteskip",  "sampleunits", "spaceunits",      "spaceorigin",
        "datafile"};
    return std::ranges::find(kFields, name) != kFields.end() || name == "measurementframe";
}

/// Takes the next line off a text, without its end; false at the end of the text.
bool takeLine(std::string_view text, std::size_t& at, std::string_view& line) {
    if (at >= text.size()) return false;
    const std::size_t end = std::min(text.find('\n', at), text.size());
    line = text.substr(at, end - at);
    if (line.ends_with('\r')) line.remove_suffix(1);
    at = std::min(end + 1, text.size());
    return true;
}

void takeLineOfHeader(std::string_view line, NrrdHeader& header) {
    if (line.starts_with('#')) return;
    const std::size_t colon = line.find(':');
    const std::string name = colon == std::string_view::npos ? "" : plainName(line.substr(0, colon));
    const bool pair = colon != std::string_view::npos && line.substr(colon).starts_with(":=");
    if (pair) {
        header.pairs[std::string(line.substr(0, colon))] = std::string(line.substr(colon + 2));
    } else if (colon != std::string_view::npos && isField(name)) {
        header.fields[name] = std::string(trimmed(line.substr(colon + 1)));
    } else if (const std::size_t later = line.find(":="); later != std::string_view::npos) { // a key with a colon
        header.pairs[std::string(line.substr(0, later))] = std::string(line.substr(later + 2));
    } else if (line.find(": ") != std::string_view::npos) {
        header.unknown.emplace_back(line.substr(0, colon));
    } else {
        throw Error("\"" + std::string(line.substr(0, 60)) + "\" is not a field", {}, "header");
    }
}

double numberOf(std::string_view word, const char* field) {
    const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
    double value = 0;
    const auto [end, failed] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (failed == std::errc::result_out_of_range) return digits.starts_with('-') ? -HUGE_VAL : HUGE_VAL;
    if (failed != std::errc() || end != digits.data() + digits.size())
        throw Error("\"" + std::string(word.substr(0, 60)) + "\" is not a number", {}, field);
    return value;
}

} // namespace

const std::string& NrrdHeader::field(const char* name) const {
    static const std::string kNone;
    const auto at = fields.find(name);
    return at == fields.end() ? kNone : at->second;
}

NrrdHeader readNrrdHeader(std::string_view head) {
    if (!head.starts_with("NRRD")) throw Error("is damaged or has another format");
    NrrdHeader header;
    std::string_view line;
    takeLine(head, header.end, line); // NRRD0005
    while (takeLine(head, header.end, line)) {
        if (line.empty()) {
            header.hasEnd = true;
            return header;
        }
        takeLineOfHeader(line, header);
        if (header.field("datafile").substr(0, 4) != "LIST") continue;
        while (takeLine(head, header.end, line) && !line.empty() && header.list.size() < kMostDataFiles)
            header.list.emplace_back(trimmed(line));
        break;
    }
    return header;
}

std::vector<double> nrrdNumbers(std::string_view text, const char* field) {
    constexpr std::string_view kBetween = " \t,\r\n";
    std::vector<double> out;
    for (std::size_t at = text.find_first_not_of(kBetween); at != std::string_view::npos;
         at = text.find_first_not_of(kBetween, at)) {
        const std::size_t end = std::min(text.find_first_of(kBetween, at), text.size());
        out.push_back(numberOf(text.substr(at, end - at), field));
        at = end;
    }
    return out;
}

std::vector<std::optional<std::vector<double>>> nrrdVectors(std::string_view text, const char* field) {
    std::vector<std::optional<std::vector<double>>> out;
    text = trimmed(text);
    while (!text.empty()) {
        if (text.front() == '(') {
            const std::size_t end = text.find(')');
            if (end == std::string_view::npos) throw Error("has a vector that does not end", {}, field);
            out.emplace_back(nrrdNumbers(text.substr(1, end - 1), field));
            text.remove_prefix(end + 1);
        } else if (plainName(text.substr(0, 4)) == "none") {
            out.emplace_back(std::nullopt);
            text.remove_prefix(4);
        } else {
            throw Error("needs vectors", {}, field);
        }
        text = trimmed(text);
    }
    return out;
}

std::vector<std::string> nrrdWords(const std::string& text) {
    std::vector<std::string> out;
    std::istringstream in(text);
    for (std::string word; in >> std::quoted(word);) out.push_back(word);
    return out;
}

std::optional<std::string> numberedFile(std::string_view pattern, long number) {
    const std::size_t mark = pattern.find('%');
    if (mark == std::string_view::npos) return std::nullopt;
    std::size_t at = mark + 1;
    const bool zeros = at < pattern.size() && pattern[at] == '0';
    std::size_t width = 0;
    for (; at < pattern.size() && std::isdigit(static_cast<unsigned char>(pattern[at])) != 0; ++at)
        width = std::min<std::size_t>(width * 10 + std::size_t(pattern[at] - '0'), 64);
    if (at >= pattern.size() || std::string_view("diu").find(pattern[at]) == std::string_view::npos)
        return std::nullopt;
    if (pattern.find('%', at) != std::string_view::npos)
        throw Error("\"" + std::string(pattern.substr(0, 60)) +
                    "\" is no pattern of one number, such as slice%03d.raw");
    std::string digits = std::to_string(number);
    if (digits.size() < width) digits.insert(zeros && number < 0 ? 1 : 0, width - digits.size(), zeros ? '0' : ' ');
    return std::string(pattern.substr(0, mark)) + digits + std::string(pattern.substr(at + 1));
}

std::vector<std::string> nrrdDataFiles(const NrrdHeader& header) {
    const std::string& stated = header.field("datafile");
    if (stated.empty()) return {};
    if (stated == "LIST" || stated.starts_with("LIST ")) {
        if (header.list.empty()) throw Error("names no file of samples", {}, "data file");
        return header.list;
    }
    std::istringstream in(stated);
    std::string pattern;
    long first = 0, last = 0, step = 0;
    in >> pattern >> first >> last >> step;
    if (!in || !numberedFile(pattern, first)) return {stated};
    const double count = std::floor((double(last) - double(first)) / double(step)) + 1;
    if (step == 0 || !(count >= 1 && count <= double(kMostDataFiles)))
        throw Error("\"" + stated.substr(0, 60) + "\" states no files", {}, "data file");
    std::vector<std::string> names;
    for (long n = 0; n < long(count); ++n) names.push_back(*numberedFile(pattern, first + n * step));
    return names;
}

} // namespace tessera::volume
