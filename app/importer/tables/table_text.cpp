#include "app/importer/tables/table_text.h"

#include "volume/base/trimmed.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <limits>

namespace tessera::importer {

namespace {

void appendUtf8(std::string& out, std::uint32_t code) {
    if (code < 0x80) {
        out += char(code);
        return;
    }
    if (code < 0x800) {
        out += char(0xC0 | code >> 6);
    } else {
        if (code < 0x10000) {
            out += char(0xE0 | code >> 12);
        } else {
            out += char(0xF0 | code >> 18);
            out += char(0x80 | (code >> 12 & 0x3F));
        }
        out += char(0x80 | (code >> 6 & 0x3F));
    }
    out += char(0x80 | (code & 0x3F));
}

bool isUtf8(std::string_view text) {
    for (std::size_t i = 0; i < text.size();) {
        const auto lead = static_cast<unsigned char>(text[i]);
        const std::size_t more = lead < 0x80   ? 0
                                 : lead < 0xC2 ? 9
                                 : lead < 0xE0 ? 1
                                 : lead < 0xF0 ? 2
                                 : lead < 0xF5 ? 3
                                               : 9;
        if (more == 9 || more >= text.size() - i) return false;
        for (std::size_t k = 1; k <= more; ++k)
            if ((static_cast<unsigned char>(text[i + k]) & 0xC0) != 0x80) return false;
        i += more + 1;
    }
    return true;
}

std::string fromUtf16(std::string_view bytes, bool bigEndian) {
    std::string out;
    std::uint32_t high = 0;
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
        const auto a = static_cast<unsigned char>(bytes[i]), b = static_cast<unsigned char>(bytes[i + 1]);
        const std::uint32_t unit = bigEndian ? std::uint32_t(a) << 8 | b : std::uint32_t(b) << 8 | a;
        if (unit >= 0xD800 && unit < 0xDC00) {
            high = unit;
            continue;
        }
        const bool pair = high != 0 && unit >= 0xDC00 && unit < 0xE000;
        appendUtf8(out, pair ? 0x10000 + ((high - 0xD800) << 10) + (unit - 0xDC00) : unit);
        high = 0;
    }
    return out;
}

std::string fromWindows(std::string_view bytes) {
    static constexpr std::array<std::uint16_t, 32> kFrom80 = {
        0x20AC, 0x81,   0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
        0x2039, 0x0152, 0x8D,   0x017D, 0x8F,   0x90,   0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
        0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0x9D,   0x017E, 0x0178};
    std::string out;
    for (const char c : bytes) {
        const auto code = static_cast<unsigned char>(c);
        appendUtf8(out, code >= 0x80 && code < 0xA0 ? kFrom80[code - 0x80u] : code);
    }
    return out;
}

std::string lowerCase(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return out;
}

bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

/// A number at the start of a text and how many characters it has, 0 if there is none. Slower ways are for what
/// Fortran writes.
std::pair<double, std::size_t> leadingNumber(std::string_view text, bool decimalComma) {
    const std::size_t sign = text.starts_with('+') ? 1 : 0;
    double value = 0;
    const bool plain = !decimalComma || text.find(',') == std::string_view::npos;
    if (plain) {
        const auto parsed = std::from_chars(text.data() + sign, text.data() + text.size(), value);
        const auto length = std::size_t(parsed.ptr - text.data());
        if (parsed.ec == std::errc() && length == text.size()) return {value, length};
    }
    // digits [. digits] [e|E|d|D] [sign digits]
    std::string word;
    std::size_t at = 0;
    if (at < text.size() && (text[at] == '+' || text[at] == '-')) word += text[at++];
    const std::size_t first = at;
    std::size_t digits = 0;
    bool point = false;
    for (; at < text.size(); ++at) {
        if (isDigit(text[at])) {
            ++digits;
            word += text[at];
        } else if (!point && (text[at] == '.' || (decimalComma && text[at] == ','))) {
            point = true;
            word += '.';
        } else {
            break;
        }
    }
    if (digits == 0 || at == first) return {0, 0};
    std::size_t power = at;
    const bool letter = power < text.size() && std::string_view("eEdD").find(text[power]) != std::string_view::npos;
    if (letter) ++power;
    const bool signedPower = power < text.size() && (text[power] == '+' || text[power] == '-');
    std::string exponent = signedPower ? std::string(1, text[power++]) : std::string();
    const std::size_t begin = power;
    while (power < text.size() && isDigit(text[power])) exponent += text[power++];
    // A power without a letter has three digits and ends the number.
    if (power > begin && (letter || (signedPower && power - begin == 3 && power == text.size()))) {
        word += 'e' + exponent;
        at = power;
    }
    return {std::strtod(word.c_str(), nullptr), at};
}

} // namespace

std::string asUtf8(std::string bytes) {
    if (bytes.starts_with("\xEF\xBB\xBF")) bytes.erase(0, 3);
    if (bytes.starts_with("\xFF\xFE")) return fromUtf16(std::string_view(bytes).substr(2), false);
    if (bytes.starts_with("\xFE\xFF")) return fromUtf16(std::string_view(bytes).substr(2), true);
    return isUtf8(bytes) ? bytes : fromWindows(bytes);
}

std::optional<TextLine> TextLines::next() {
    while (!rest_.empty()) {
        const std::size_t end = std::min(rest_.size(), rest_.find_first_of("\r\n"));
        const std::string_view text = volume::trimmed(rest_.substr(0, end));
        const bool whole = end < rest_.size();
        const bool pair = whole && rest_[end] == '\r' && end + 1 < rest_.size() && rest_[end + 1] == '\n';
        rest_.remove_prefix(std::min(rest_.size(), end + (pair ? 2 : 1)));
        ++number_;
        if (!text.empty()) return TextLine{text, number_, whole};
    }
    return std::nullopt;
}

void Fields::add(std::string_view field) {
    field = volume::trimmed(field);
    if (field.find('"') == std::string_view::npos) {
        views_.push_back(field);
        return;
    }
    if (field.size() >= 2 && field.front() == '"' && field.back() == '"' &&
        field.substr(1, field.size() - 2).find('"') == std::string_view::npos) {
        views_.push_back(volume::trimmed(field.substr(1, field.size() - 2)));
        return;
    }
    std::string text;
    bool quoted = false;
    for (std::size_t i = 0; i < field.size(); ++i) {
        if (field[i] != '"') {
            text += field[i];
        } else if (quoted && i + 1 < field.size() && field[i + 1] == '"') {
            text += field[i++];
        } else {
            quoted = !quoted;
        }
    }
    views_.push_back(unquoted_.emplace_back(volume::trimmed(text)));
}

void Fields::split(std::string_view line, char separator) {
    views_.clear();
    unquoted_.clear();
    const bool blanks = separator == ' ';
    bool quoted = false;
    std::size_t begin = 0;
    const auto close = [&](std::size_t end) {
        if (!blanks || end > begin) add(line.substr(begin, end - begin));
        begin = end + 1;
    };
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '"') quoted = !quoted;
        if (!quoted && (line[i] == separator || (blanks && line[i] == '\t'))) close(i);
    }
    close(line.size());
}

bool isMissingWord(std::string_view field) {
    if (field.empty()) return true;
    const char c = field.front();
    if (isDigit(c) && field.find('#') == std::string_view::npos) return false;
    static constexpr std::array<std::string_view, 15> kWords = {"null", "na",  "n/a",  "nan", "-nan", "+nan", "-", "--",
                                                                "none", "nil", "nan.", "?",   ".",    "n.a.", "nd"};
    const std::string word = lowerCase(field);
    if (std::ranges::find(kWords, word) != kWords.end()) return true;
    if (word.starts_with("nan(") || word.starts_with("-nan(")) return true;
    if (c == '#' || c == '*') // #DIV/0! of spreadsheets, **** of Fortran
        return word == "#n/a" || word.ends_with('!') || word == "#name?" ||
               word.find_first_not_of('*') == std::string::npos;
    return word.find("1.#") != std::string::npos; // 1.#QNAN of Windows
}

std::optional<double> numberIn(std::string_view field, bool decimalComma) {
    const auto [value, length] = leadingNumber(field, decimalComma);
    if (length == field.size() && length > 0) return value;
    if (isMissingWord(field)) return std::numeric_limits<double>::quiet_NaN();
    return std::nullopt;
}

std::optional<std::complex<double>> complexIn(std::string_view field, bool decimalComma) {
    if (field.size() < 2 || (field.back() != 'i' && field.back() != 'j')) return std::nullopt;
    const std::string_view body = field.substr(0, field.size() - 1);
    // The imaginary part begins at the last sign that does not follow an exponent's letter.
    std::size_t sign = body.size();
    for (std::size_t i = body.size(); i-- > 0;)
        if ((body[i] == '+' || body[i] == '-') &&
            (i == 0 || std::string_view("eEdD").find(body[i - 1]) == std::string_view::npos)) {
            sign = i;
            break;
        }
    const std::size_t split = sign == body.size() ? 0 : sign;
    const bool any = field.find_first_of("0123456789") != std::string_view::npos ||
                     lowerCase(field).find("nan") != std::string::npos;
    if (!any) return std::nullopt;
    const auto part = [&](std::string_view text) -> std::optional<double> {
        if (text.empty()) return 0.0;
        if (text.size() == 1 && !isDigit(text.front())) return std::nullopt;
        return numberIn(text, decimalComma);
    };
    const std::optional<double> real = part(body.substr(0, split)), imaginary = part(body.substr(split));
    if (!real || !imaginary) return std::nullopt;
    return std::complex<double>(*real, *imaginary);
}

char separatorOf(std::string_view line) {
    Fields fields;
    for (const char c : {';', '\t', ','}) {
        if (line.find(c) == std::string_view::npos) continue;
        if (c != ',') return c;
        fields.split(line, c);
        // "0,5 1,5" has decimal commas and blanks between its numbers.
        bool numbersWithin = false;
        for (std::size_t i = 0; i < fields.size(); ++i) {
            const std::size_t blank = fields[i].find_first_of(" \t");
            numbersWithin = numbersWithin || (blank != std::string_view::npos && isDigit(fields[i][0]) &&
                                              isDigit(fields[i][blank - 1]) && isDigit(fields[i].back()));
        }
        if (!numbersWithin) return c;
    }
    return ' ';
}

} // namespace tessera::importer
