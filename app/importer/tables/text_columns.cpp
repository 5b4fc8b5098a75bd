#include "app/importer/tables/text_columns.h"

#include "app/importer/tables/table_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>

namespace tessera::importer {

namespace {

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMostWords = 255, kMostColumns = 20'000;

std::string shortWord(std::string_view field) {
    std::size_t end = std::min<std::size_t>(field.size(), 40);
    while (end < field.size() && end > 0 && (static_cast<unsigned char>(field[end]) & 0xC0) == 0x80) --end;
    return "\"" + std::string(field.substr(0, end)) + "\"";
}

std::string count(std::size_t n, const char* one, const char* many) {
    return std::to_string(n) + " " + (n == 1 ? one : many);
}

/// Names of columns that number the points or cells.
bool isCounter(std::string_view name) {
    std::string word;
    for (const char c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) != 0) word += char(std::tolower(static_cast<unsigned char>(c)));
    static constexpr std::array<std::string_view, 14> kNames = {
        "nodenumber", "cellnumber", "pointid", "cellid", "nodeid",    "vertexid",      "vtkoriginalpointids",
        "elementid",  "pointids",   "cellids", "index",  "rownumber", "elementnumber", "pointnumber"};
    return std::ranges::find(kNames, word) != kNames.end();
}

bool countsRows(const std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size(); ++i)
        if (values[i] != values.front() + double(i)) return false;
    return !values.empty() && (values.front() == 0 || values.front() == 1);
}

} // namespace

void TextColumn::add(std::string_view field, bool decimalComma, std::size_t line) {
    if (const std::optional<double> number = numberIn(field, decimalComma)) {
        values.push_back(*number);
        numberCount_ += std::isnan(*number) ? 0 : 1;
        if (!imaginary.empty()) imaginary.push_back(std::isnan(*number) ? kAbsent : 0);
        if (!codes_.empty()) codes_.push_back(-1);
        return;
    }
    if (const auto number = complexIn(field, decimalComma)) {
        if (imaginary.empty())
            for (const double value : values) imaginary.push_back(std::isnan(value) ? kAbsent : 0);
        values.push_back(number->real());
        imaginary.push_back(number->imag());
        ++numberCount_;
        if (!codes_.empty()) codes_.push_back(-1);
        return;
    }
    if (wordCount_++ == 0) firstPlace_ = "line " + std::to_string(line) + ", column %: " + shortWord(field);
    if (codes_.empty()) codes_.assign(values.size(), -1);
    auto known = std::ranges::find(words_, field);
    if (known == words_.end()) {
        tooMany_ = tooMany_ || words_.size() >= kMostWords;
        if (!tooMany_) known = words_.emplace(words_.end(), field);
    }
    codes_.push_back(known == words_.end() ? -1 : int(known - words_.begin()));
    values.push_back(kAbsent);
    if (!imaginary.empty()) imaginary.push_back(kAbsent);
}

TextColumn::Kind TextColumn::settle(const std::string& name, std::string& note) {
    if (wordCount_ == 0) return Kind::Numbers;
    std::string place = firstPlace_;
    place.replace(place.find('%'), 1, name);
    if (wordCount_ <= numberCount_ / 9) {
        note = place + " is not a number: " + count(wordCount_, "such field is", "such fields are") + " absent";
        return Kind::Numbers;
    }
    if (wordCount_ <= numberCount_ || !imaginary.empty()) {
        note = place + " is not a number: the column is left out";
        return Kind::Unread;
    }
    for (std::size_t row = 0; row < values.size() && !tooMany_; ++row) { // numbers among the words are words
        if (codes_[row] >= 0 || std::isnan(values[row])) continue;
        char text[32];
        std::snprintf(text, sizeof text, "%.9g", values[row]);
        auto known = std::ranges::find(words_, text);
        tooMany_ = known == words_.end() && words_.size() >= kMostWords;
        if (known == words_.end()) known = words_.emplace(words_.end(), text);
        codes_[row] = int(known - words_.begin());
    }
    if (tooMany_) {
        note = "column " + name + " is left out: it holds more than " + std::to_string(kMostWords) +
               " different words, such as " + place.substr(place.find(": ") + 2);
        return Kind::Unread;
    }
    for (std::size_t w = 0; w < words_.size(); ++w) labels.push_back({int(w) + 1, words_[w]});
    for (std::size_t row = 0; row < values.size(); ++row) values[row] = codes_[row] < 0 ? kAbsent : codes_[row] + 1;
    return Kind::Labels;
}

void TextTable::setHeadings(std::vector<Heading> headings) {
    if (headings.size() > kMostColumns)
        throw std::runtime_error("names " + std::to_string(headings.size()) + " columns: more than " +
                                 std::to_string(kMostColumns) + " are not read");
    headings_ = std::move(headings);
    columns_ = std::vector<TextColumn>(headings_.size());
    rows_ = 0;
}

PointTable TextTable::table(std::vector<std::string>& notes) {
    PointTable out;
    std::array<std::ptrdiff_t, 3> places{};
    for (int axis = 0; axis < 3; ++axis) places[std::size_t(axis)] = placeColumn(headings_, axis);
    std::vector<std::size_t> kept;
    for (std::size_t row = 0; row < rows_; ++row)
        if (std::ranges::all_of(
                places, [&](std::ptrdiff_t c) { return c < 0 || std::isfinite(columns_[std::size_t(c)].values[row]); }))
            kept.push_back(row);
    if (kept.size() < rows_)
        notes.push_back(count(rows_ - kept.size(), "row is left out: it has", "rows are left out: they have") +
                        " no position");
    std::set<std::string> taken;
    std::map<std::string, int> counts; // of names that come again
    std::set<std::string> complex;     // a quantity that is complex at one time is at all
    for (std::size_t c = 0; c < columns_.size(); ++c)
        if (!columns_[c].imaginary.empty()) complex.insert(headings_[c].name.substr(0, headings_[c].name.find(" @ ")));
    const auto add = [&](Heading heading, std::vector<double> values, std::vector<volume::Label> labels) {
        const std::string named = heading.name;
        for (int& last = counts.try_emplace(named, 1).first->second; !taken.insert(heading.name).second;)
            heading.name = named + "." + std::to_string(++last);
        if (heading.name != named) notes.push_back("column " + named + " comes again: it is named " + heading.name);
        if (kept.size() < values.size()) {
            std::vector<double> some;
            some.reserve(kept.size());
            for (const std::size_t row : kept) some.push_back(values[row]);
            values = std::move(some);
        }
        out.headings.push_back(std::move(heading));
        out.columns.push_back(std::move(values));
        out.labels.push_back(std::move(labels));
    };
    std::string firstUnread;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
        TextColumn& column = columns_[c];
        Heading heading = headings_[c];
        const bool isPlace = std::ranges::find(places, std::ptrdiff_t(c)) != places.end();
        if (!isPlace && axisOf(heading.name) >= 0) {
            notes.push_back("column " + heading.name + " is left out: another one has these positions");
            continue;
        }
        if (heading.name.empty()) heading.name = "column " + std::to_string(c + 1);
        if (isCounter(heading.name) && countsRows(column.values)) {
            notes.push_back("column " + heading.name + " is left out: it counts the rows");
            continue;
        }
        std::string note;
        const TextColumn::Kind kind = isPlace ? TextColumn::Kind::Numbers : column.settle(heading.name, note);
        if (!note.empty()) notes.push_back(note);
        if (kind == TextColumn::Kind::Unread) {
            if (firstUnread.empty()) firstUnread = note;
            continue;
        }
        const std::size_t at = heading.name.find(" @ ");
        if (const std::string base = heading.name.substr(0, at); !isPlace && complex.contains(base)) {
            const std::string rest = at == std::string::npos ? "" : heading.name.substr(at);
            if (column.imaginary.empty())
                for (const double value : column.values) column.imaginary.push_back(std::isnan(value) ? kAbsent : 0);
            add({base + ".real" + rest, heading.unit}, std::move(column.values), {});
            add({base + ".imag" + rest, heading.unit}, std::move(column.imaginary), {});
            continue;
        }
        add(std::move(heading), std::move(column.values), std::move(column.labels));
    }
    const bool anyValues = std::ranges::any_of(out.headings, [](const Heading& h) { return axisOf(h.name) < 0; });
    if (!anyValues && !firstUnread.empty()) throw std::runtime_error(firstUnread);
    if (out.rows() == 0 && rows_ > 0) throw std::runtime_error("has no row with a position");
    return out;
}

} // namespace tessera::importer
