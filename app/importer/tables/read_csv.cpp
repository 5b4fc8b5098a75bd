// Tables with a heading: CSV of ParaView, Fluent, STAR-CCM+, COMSOL and spreadsheets.
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"
#include "app/importer/tables/point_table.h"
#include "volume/base/trimmed.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace tessera::importer {

namespace {

/// Fields of a line without their quotes. If a blank is the separator, several count as one.
std::vector<std::string> split(std::string_view line, char separator) {
    std::vector<std::string> out;
    std::string field;
    bool quoted = false, any = false;
    for (const char c : line) {
        if (c == '"') {
            quoted = !quoted;
            any = true;
            continue;
        }
        const bool ends = !quoted && (separator == ' ' ? c == ' ' || c == '\t' : c == separator);
        if (!ends) {
            field += c;
            continue;
        }
        if (separator != ' ' || any || !field.empty()) out.push_back(std::string(volume::trimmed(field)));
        field.clear();
        any = false;
    }
    if (separator != ' ' || any || !volume::trimmed(field).empty()) out.push_back(std::string(volume::trimmed(field)));
    return out;
}

std::optional<double> number(std::string text, bool decimalComma) {
    if (text.empty()) return std::numeric_limits<double>::quiet_NaN();
    if (decimalComma) std::replace(text.begin(), text.end(), ',', '.');
    if (text.front() == '+') text.erase(0, 1);
    double value = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
    if (parsed.ec == std::errc::result_out_of_range) return std::strtod(text.c_str(), nullptr);
    if (parsed.ec != std::errc() || parsed.ptr != text.data() + text.size()) return std::nullopt;
    return value;
}

char separatorOf(std::string_view line) {
    for (const char c : {';', ',', '\t'})
        if (line.find(c) != std::string_view::npos) return c;
    return ' ';
}

PointTable parseTable(std::string_view text) {
    PointTable table;
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3); // byte order mark
    std::string_view comment, heading;
    std::size_t lineNumber = 0;
    char separator = ',';
    bool decimalComma = false;
    while (!text.empty()) {
        const std::size_t end = std::min(text.size(), text.find('\n'));
        const std::string_view line = volume::trimmed(text.substr(0, end));
        text.remove_prefix(std::min(text.size(), end + 1));
        ++lineNumber;
        if (line.empty()) continue;
        if (line.front() == '#' || line.front() == '%') {
            if (heading.empty()) comment = volume::trimmed(line.substr(1)); // the last comment may be the heading
            continue;
        }
        if (heading.empty()) {
            const char own = separatorOf(line);
            const std::vector<std::string> first = split(line, own);
            const bool numbers = std::all_of(first.begin(), first.end(), [&](const std::string& word) {
                return number(word, own == ';').has_value();
            });
            if (numbers && comment.empty()) throw std::runtime_error("has no heading that names its columns");
            heading = numbers ? comment : line;
            separator = separatorOf(heading);
            // COMSOL: "% x  y  z  T (K)" above numbers that blanks or commas separate.
            std::vector<std::string> names = split(heading, separator);
            if (separator == ' ') {
                std::vector<std::string> merged;
                for (const std::string& name : names)
                    if (!merged.empty() && (name.front() == '(' || name.front() == '[' || name.front() == '@'))
                        merged.back() += " " + name;
                    else
                        merged.push_back(name);
                names = merged;
            }
            if (names.size() > 1 && names.back().empty()) names.pop_back(); // a separator at the end of the line
            for (const std::string& name : names) table.headings.push_back(parseHeading(name));
            table.columns.resize(names.size());
            if (!numbers) continue;
            separator = own;
        }
        decimalComma = separator == ';';
        std::vector<std::string> fields = split(line, separator);
        if (fields.size() == table.headings.size() + 1 && fields.back().empty()) fields.pop_back();
        const std::string place = "line " + std::to_string(lineNumber);
        if (fields.size() != table.headings.size())
            throw std::runtime_error(place + " has " + std::to_string(fields.size()) + " fields, its heading " +
                                     std::to_string(table.headings.size()));
        for (std::size_t c = 0; c < fields.size(); ++c) {
            const std::optional<double> value = number(fields[c], decimalComma);
            if (!value)
                throw std::runtime_error(place + ", column " + table.headings[c].name + ": \"" +
                                         fields[c].substr(0, 40) + "\" is not a number");
            table.columns[c].push_back(*value);
        }
    }
    if (table.headings.empty()) throw std::runtime_error("has no heading that names its columns");
    if (table.rows() == 0) throw std::runtime_error("has a heading and no numbers");
    return table;
}

/// The rows of each time.
std::map<double, PointTable> byTime(const PointTable& table, std::size_t column) {
    std::map<double, PointTable> out;
    for (std::size_t row = 0; row < table.rows(); ++row) {
        const double time = table.columns[column][row];
        if (!std::isfinite(time)) throw std::runtime_error("has a time that is not a number");
        PointTable& part = out[time];
        if (part.headings.empty()) {
            part.headings = table.headings;
            part.headings.erase(part.headings.begin() + std::ptrdiff_t(column));
            part.columns.resize(part.headings.size());
        }
        for (std::size_t c = 0, to = 0; c < table.columns.size(); ++c)
            if (c != column) part.columns[to++].push_back(table.columns[c][row]);
    }
    return out;
}

} // namespace

void openCsv(Source& source) {
    const std::string text = readWhole(source.path);
    checkLastLine(text);
    PointTable table = parseTable(text);
    bool places = false;
    std::optional<std::size_t> timeColumn;
    for (std::size_t c = 0; c < table.headings.size(); ++c) {
        std::string word = table.headings[c].name;
        std::transform(word.begin(), word.end(), word.begin(), [](unsigned char l) { return char(std::tolower(l)); });
        places = places || axisOf(word) == 0;
        if (word == "time" || (table.headings[c].name == "t" && !timeColumn)) timeColumn = c;
    }
    if (!places)
        throw std::runtime_error("has no columns x, y and z with positions (for quantities over time use --over-time)");
    if (!timeColumn) {
        auto grid = gridOfPoints(table, source);
        source.read = [grid](std::size_t) { return grid; };
        return;
    }
    source.timeUnit = table.headings[*timeColumn].unit;
    auto tables = std::make_shared<std::vector<PointTable>>();
    for (auto& [time, part] : byTime(table, *timeColumn)) {
        source.times.push_back(time);
        tables->push_back(std::move(part));
        if (tables->back().rows() != tables->front().rows())
            throw std::runtime_error("has " + std::to_string(tables->back().rows()) + " rows at time " +
                                     std::to_string(time) + " and " + std::to_string(tables->front().rows()) +
                                     " at the first");
    }
    gridOfPoints(tables->front(), source); // sets the units of `source`
    const Source stated = source;
    source.read = [tables, stated](std::size_t time) -> vtkSmartPointer<vtkDataObject> {
        Source scratch = stated;
        return gridOfPoints((*tables)[time], scratch);
    };
}

} // namespace tessera::importer
