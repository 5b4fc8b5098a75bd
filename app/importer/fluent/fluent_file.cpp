#include "app/importer/fluent/fluent_file.h"

#include "app/importer/readers/check_file.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <zlib.h>

namespace tessera::importer {

namespace {

[[noreturn]] void cut() {
    throw std::runtime_error("ends within a section: truncated");
}

bool isBlank(char c) {
    return std::isspace(static_cast<unsigned char>(c)) != 0;
}

/// The bytes of a gzip file; throws if its stream does not end.
std::string inflated(const std::string& path) {
    checkDeflated(path, 0, 0);
    gzFile file = gzopen(path.c_str(), "rb");
    if (file == nullptr) throw std::runtime_error("cannot be read");
    std::string out;
    std::vector<char> some(1 << 20);
    for (int got = 0; (got = gzread(file, some.data(), unsigned(some.size()))) > 0;)
        out.append(some.data(), std::size_t(got));
    gzclose(file);
    return out;
}

std::vector<std::string> wordsIn(std::string_view text) {
    std::vector<std::string> words;
    for (std::size_t at = 0; at < text.size();) {
        while (at < text.size() && isBlank(text[at])) ++at;
        const std::size_t begin = at;
        while (at < text.size() && !isBlank(text[at])) ++at;
        if (at > begin) words.emplace_back(text.substr(begin, at - begin));
    }
    return words;
}

template <class T> T numberFrom(const char* bytes, bool swap) {
    char raw[sizeof(T)];
    std::memcpy(raw, bytes, sizeof(T));
    if (swap) std::reverse(raw, raw + sizeof(T));
    T value;
    std::memcpy(&value, raw, sizeof(T));
    return value;
}

} // namespace

FluentFile::FluentFile(const std::string& path) {
    bytes_ = readPart(path, 0, 2) == "\x1f\x8b" ? inflated(path) : readWhole(path);
}

void FluentFile::skipBlank() {
    while (at_ < bytes_.size() && isBlank(bytes_[at_])) ++at_;
}

/// The bracket that closes the one at `open`; quoted words may hold brackets.
std::size_t FluentFile::closing(std::size_t open) const {
    int depth = 0;
    bool quoted = false;
    for (std::size_t at = open; at < bytes_.size(); ++at) {
        const char c = bytes_[at];
        if (c == '"') quoted = !quoted;
        if (quoted) continue;
        if (c == '(') ++depth;
        if (c == ')' && --depth == 0) return at;
    }
    cut();
}

/// Finds "End of Binary Section 3300)" behind binary numbers. Some writers close the section's bracket again after it.
void FluentFile::endOfBinary(FluentSection& section) {
    static constexpr std::string_view kEnd = "End of Binary Section";
    std::size_t at = section.begin;
    while (true) {
        at = bytes_.find(kEnd, at);
        if (at == std::string::npos) cut();
        std::size_t digits = at + kEnd.size();
        while (digits < bytes_.size() && isBlank(bytes_[digits])) ++digits;
        int number = 0;
        const auto [end, failed] = std::from_chars(bytes_.data() + digits, bytes_.data() + bytes_.size(), number);
        const auto after = std::size_t(end - bytes_.data());
        if (after >= bytes_.size()) cut();
        if (failed == std::errc() && number % 1000 == section.number && bytes_[after] == ')') {
            section.end = at; // blanks and a bracket may be between
            at_ = after;
            section.close = at;
            while (at_ < bytes_.size() && bytes_[at_] == ')') ++at_;
            return;
        }
        ++at;
    }
}

bool FluentFile::next(FluentSection& section) {
    while (true) {
        skipBlank();
        if (at_ >= bytes_.size()) return false;
        if (bytes_[at_] != '(') throw std::runtime_error("has something between its sections");
        const std::size_t open = at_;
        std::size_t at = open + 1;
        while (at < bytes_.size() && isBlank(bytes_[at])) ++at;
        int number = -1;
        const auto parsed = std::from_chars(bytes_.data() + at, bytes_.data() + bytes_.size(), number);
        at = std::size_t(parsed.ptr - bytes_.data());
        section = {};
        section.binary = number >= 2000 && number < 4000;
        section.wide = section.binary && number >= 3000;
        section.number = section.binary ? number % 1000 : number;
        while (at < bytes_.size() && isBlank(bytes_[at])) ++at;
        if (number == 0) { // a remark
            const std::size_t end = closing(open);
            comment_ = bytes_.substr(at, end - at);
            at_ = end + 1;
            continue;
        }
        if (at >= bytes_.size()) cut();
        if (bytes_[at] == '(') {
            const std::size_t end = bytes_.find(')', at);
            if (end == std::string::npos) cut();
            section.header = wordsIn(std::string_view(bytes_).substr(at + 1, end - at - 1));
            std::size_t body = end + 1;
            while (body < bytes_.size() && isBlank(bytes_[body])) ++body;
            if (body < bytes_.size() && bytes_[body] == '(') section.begin = body + 1;
        } else {
            const std::size_t end = closing(open);
            section.header = wordsIn(std::string_view(bytes_).substr(at, end - at));
        }
        if (section.number == 4) swap_ = !section.header.empty() && section.header[0] != "60";
        section.comment = std::move(comment_);
        comment_.clear();
        section.open = open;
        if (section.binary && section.begin != 0) {
            endOfBinary(section);
            return true;
        }
        const std::size_t end = closing(open);
        section.end = section.begin == 0 ? 0 : end;
        while (section.end > section.begin && (isBlank(bytes_[section.end - 1]) || bytes_[section.end - 1] == ')'))
            --section.end;
        at_ = end + 1;
        section.close = end;
        return true;
    }
}

std::vector<double> FluentFile::numbers(const FluentSection& section, std::size_t& at, std::size_t count) const {
    std::vector<double> out;
    const std::size_t each = section.binary ? (section.wide ? 8 : 4) : 1;
    if (section.end < at || count > (section.end - at) / each + 1) cut();
    out.reserve(count);
    for (std::size_t n = 0; n < count; ++n) {
        if (section.binary) {
            if (section.end - at < each) cut();
            out.push_back(section.wide ? numberFrom<double>(bytes_.data() + at, swap_)
                                       : double(numberFrom<float>(bytes_.data() + at, swap_)));
            at += each;
            continue;
        }
        while (at < section.end && isBlank(bytes_[at])) ++at;
        if (at >= section.end) cut();
        if (bytes_[at] == '+') ++at;
        double value = 0;
        const auto [stop, failed] = std::from_chars(bytes_.data() + at, bytes_.data() + section.end, value);
        if (failed == std::errc::invalid_argument)
            throw std::runtime_error("has \"" + bytes_.substr(at, 20) + "\" where a number belongs");
        at = std::size_t(stop - bytes_.data());
        out.push_back(value);
    }
    return out;
}

std::int64_t FluentFile::whole(const FluentSection& section, std::size_t& at) const {
    if (section.binary) {
        if (section.end < at + 4) cut();
        const auto value = numberFrom<std::int32_t>(bytes_.data() + at, swap_);
        at += 4;
        return value;
    }
    while (at < section.end && isBlank(bytes_[at])) ++at;
    std::int64_t value = 0;
    const auto [stop, failed] = std::from_chars(bytes_.data() + at, bytes_.data() + section.end, value, 16);
    if (at >= section.end) cut();
    if (failed != std::errc()) throw std::runtime_error("has \"" + bytes_.substr(at, 20) + "\" where a number belongs");
    at = std::size_t(stop - bytes_.data());
    return value;
}

bool FluentFile::atEnd(const FluentSection& section, std::size_t at) const {
    if (section.binary) return section.end < at + 4;
    while (at < section.end && isBlank(bytes_[at])) ++at;
    return at >= section.end;
}

std::int64_t headerNumber(const FluentSection& section, std::size_t index, int base) {
    if (index >= section.header.size()) return -1;
    const std::string& word = section.header[index];
    std::int64_t value = 0;
    const auto [end, failed] = std::from_chars(word.data(), word.data() + word.size(), value, base);
    return failed == std::errc() && end == word.data() + word.size() ? value : -1;
}

} // namespace tessera::importer
