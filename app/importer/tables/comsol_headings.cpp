#include "app/importer/tables/comsol_text.h"
#include "app/importer/tables/table_text.h"
#include "volume/base/trimmed.h"

#include <algorithm>
#include <utility>

namespace tessera::importer {

namespace {

/// Pieces between gaps of two blanks at least, or a tab.
std::vector<std::string> betweenGaps(std::string_view text) {
    std::vector<std::string> out;
    std::string piece;
    for (std::size_t i = 0; i <= text.size(); ++i) {
        const bool gap =
            i == text.size() || text[i] == '\t' || (text[i] == ' ' && i + 1 < text.size() && text[i + 1] == ' ');
        if (!gap) {
            if (!piece.empty() || text[i] != ' ') piece += text[i];
            continue;
        }
        if (!piece.empty()) out.push_back(std::exchange(piece, {}));
    }
    return out;
}

int bracketsOpen(std::string_view text) {
    return int(std::ranges::count(text, '(') + std::ranges::count(text, '[')) -
           int(std::ranges::count(text, ')') + std::ranges::count(text, ']'));
}

/// Headings that single blanks separate: each is words, a unit in brackets, and conditions after an "@".
std::vector<std::string> headingsWithin(const std::string& text, std::size_t coordinates) {
    std::vector<std::string> words;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find(' ', at), text.size());
        if (end > at) words.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    std::vector<std::string> out;
    std::string heading;
    bool unit = false, conditions = false;
    const auto close = [&] {
        if (!heading.empty()) out.push_back(std::exchange(heading, {}));
        unit = conditions = false;
    };
    for (std::size_t w = 0; w < words.size(); ++w) {
        const std::string& word = words[w];
        const bool inBrackets = bracketsOpen(heading) > 0;
        const bool continues = word == "@" || heading.ends_with(" @") ||
                               (conditions && (heading.ends_with(',') || heading.ends_with(':')));
        if (!inBrackets && !continues) {
            const bool opens = word.front() == '(' || word.front() == '[';
            if ((unit && !conditions) || conditions) close();
            if (!heading.empty() && out.size() < coordinates && !opens) close(); // names of coordinates are one word
            unit = opens || unit;
        }
        conditions = conditions || word == "@";
        heading += (heading.empty() ? "" : " ") + word;
    }
    close();
    return out;
}

/// "T (K) @ t=0" -> {"T @ t=0", "K"}.
Heading headingOf(const std::string& text) {
    const std::size_t at = text.find(" @ ");
    if (at == std::string::npos) return parseHeading(text);
    Heading heading = parseHeading(text.substr(0, at));
    heading.name += " @ " + std::string(volume::trimmed(std::string_view(text).substr(at + 3)));
    return heading;
}

/// What stands behind the conditions of every heading, such as ", Component 1".
std::string remarkOf(const std::string& text) {
    const std::size_t at = text.rfind('@'), equals = text.rfind('=');
    if (at == std::string::npos || equals == std::string::npos || equals < at) return {};
    const std::size_t comma = text.find(", ", equals);
    if (comma == std::string::npos) return {};
    const std::string remark = text.substr(comma);
    std::ptrdiff_t times = 0;
    for (std::size_t next = 0; (next = text.find(remark, next)) != std::string::npos; next += remark.size()) ++times;
    return times == std::ranges::count(text, '@') ? remark : std::string();
}

} // namespace

std::vector<Heading> comsolHeadings(std::string_view given, std::size_t columns, char separator, std::size_t dimension,
                                    std::vector<std::string>& notes) {
    std::string text(volume::trimmed(given));
    std::vector<std::string> names;
    if (const std::string remark = remarkOf(text); !remark.empty() && separator == ' ') {
        for (std::size_t at = 0; (at = text.find(remark, at)) != std::string::npos;) text.erase(at, remark.size());
        notes.push_back("the headings say \"" + remark.substr(2) + "\"");
    }
    if (separator == ' ') {
        const std::vector<std::string> pieces = betweenGaps(text);
        names = pieces;
        if (names.size() != columns) {
            names.clear();
            for (const std::string& piece : pieces) {
                const std::size_t left = dimension - std::min(dimension, names.size());
                for (std::string& name : headingsWithin(piece, left)) names.push_back(std::move(name));
            }
        }
        if (names.size() != columns) { // names without units
            Fields words;
            words.split(text, ' ');
            if (words.size() == columns) {
                names.clear();
                for (std::size_t i = 0; i < words.size(); ++i) names.emplace_back(words[i]);
            }
        }
    } else {
        Fields fields;
        fields.split(text, separator);
        std::size_t more = fields.size() - std::min(fields.size(), columns);
        for (std::size_t i = 0; i < fields.size(); ++i) {
            const std::string_view field = fields[i];
            const bool condition =
                field.find('=') != std::string_view::npos && field.find('@') == std::string_view::npos;
            const bool joins =
                more > 0 && !names.empty() &&
                ((condition && names.back().find('@') != std::string::npos) || bracketsOpen(names.back()) > 0);
            more -= joins ? 1 : 0;
            if (joins)
                names.back() += ", " + std::string(field);
            else
                names.emplace_back(field);
        }
        if (names.size() > columns && names.back().empty()) names.pop_back();
    }
    std::vector<Heading> headings;
    if (names.size() == columns) {
        for (const std::string& name : names) headings.push_back(headingOf(name));
        return headings;
    }
    for (std::size_t c = 0; c < columns; ++c)
        headings.push_back(c < dimension && c < names.size() ? headingOf(names[c])
                                                             : Heading{"column " + std::to_string(c + 1), {}});
    notes.push_back("the headings \"" + text.substr(0, 60) + "\" cannot be told apart (" +
                    std::to_string(names.size()) + " for " + std::to_string(columns) +
                    " columns): columns are named by their number");
    return headings;
}

} // namespace tessera::importer
