#include "volume/import/over_time.h"

#include "volume/base/error.h"
#include "volume/base/trimmed.h"
#include "volume/field/quantities.h"
#include "volume/system/input_file.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <set>

namespace tessera::volume {

namespace {

namespace fs = std::filesystem;

constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();
constexpr std::uintmax_t kMostTableBytes = 256u << 20;
constexpr std::size_t kMostColumns = 4096;

std::string lower(std::string_view text) {
    std::string out(text);
    std::ranges::transform(out, out.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return out;
}

/// Cells of a line; a quoted cell may contain the separator, and quotes doubled.
std::vector<std::string> cellsOf(std::string_view line, char separator) {
    std::vector<std::string> cells(1);
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char c = line[i];
        if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
            cells.back() += line[++i];
        else if (c == '"')
            quoted = !quoted;
        else if (c == separator && !quoted)
            cells.emplace_back();
        else
            cells.back() += c;
    }
    for (std::string& cell : cells) cell = std::string(trimmed(cell));
    return cells;
}

std::optional<double> numberOf(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
    if (parsed.ec != std::errc() || parsed.ptr != text.data() + text.size()) return std::nullopt;
    return value;
}

/// "voltage [V]" or "voltage (V)" -> {voltage, V}.
std::pair<std::string, std::string> nameAndUnit(std::string_view heading) {
    for (const auto& [open, close] : {std::pair('[', ']'), std::pair('(', ')')}) {
        const std::size_t begin = heading.rfind(open);
        if (begin == std::string_view::npos || begin == 0 || !heading.ends_with(close)) continue;
        const std::string unit(trimmed(heading.substr(begin + 1, heading.size() - begin - 2)));
        return {std::string(trimmed(heading.substr(0, begin))), unit == "-" ? std::string() : unit};
    }
    return {std::string(heading), {}};
}

/// Seconds in a unit of time; none for other units.
std::optional<double> secondsIn(const std::string& unit) {
    static constexpr std::pair<std::string_view, double> kUnits[] = {
        {"s", 1},        {"sec", 1},          {"second", 1},  {"seconds", 1},  {"ms", 1e-3},
        {"us", 1e-6},    {"\xC2\xB5s", 1e-6}, {"ns", 1e-9},   {"min", 60},     {"minute", 60},
        {"minutes", 60}, {"h", 3600},         {"hour", 3600}, {"hours", 3600}, {"d", 86400},
        {"day", 86400},  {"days", 86400}};
    const auto* found = std::ranges::find(kUnits, unit, &std::pair<std::string_view, double>::first);
    return found == std::end(kUnits) ? std::nullopt : std::optional(found->second);
}

/// The time of the data that matches a row, up to rounding by unit conversion.
double withNear(double time, const std::vector<double>& times) {
    const auto after = std::ranges::lower_bound(times, time);
    for (const auto at : {after, after == times.begin() ? after : std::prev(after)})
        if (at != times.end() && std::abs(*at - time) <= 1e-12 * std::abs(time)) return *at;
    return time;
}

struct Row {
    std::size_t line;
    std::vector<double> values;
};

/// Sorts the rows by time and makes columns of them.
TimeTable tableOf(std::vector<Row> rows, const std::vector<std::string>& headings, std::size_t timeColumn,
                  const std::string& file) {
    std::ranges::stable_sort(rows, {}, [timeColumn](const Row& row) { return row.values[timeColumn]; });
    for (std::size_t r = 1; r < rows.size(); ++r)
        if (rows[r].values[timeColumn] == rows[r - 1].values[timeColumn])
            throw Error("has the same time as line " + std::to_string(rows[r - 1].line), file,
                        "line " + std::to_string(rows[r].line));
    TimeTable table;
    table.file = file;
    for (std::size_t c = 0; c < headings.size(); ++c) {
        const auto [name, unit] = nameAndUnit(headings[c]);
        std::vector<double> values;
        for (const Row& row : rows) values.push_back(row.values[c]);
        if (c == timeColumn) {
            table.timeName = name;
            table.timeUnit = unit;
            table.times = std::move(values);
        } else {
            table.columns.push_back({name, unit, std::move(values)});
        }
    }
    return table;
}

} // namespace

TimeTable parseTimeTable(std::string_view text, const std::string& file) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    std::vector<std::string> headings;
    std::vector<Row> rows;
    std::size_t timeColumn = 0, number = 0;
    char separator = ',';
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = trimmed(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        const std::string place = "line " + std::to_string(++number);
        if (line.empty() || line.starts_with('#')) continue;
        if (headings.empty()) {
            for (const char candidate : {',', ';', '\t'})
                if (line.find(separator) == std::string_view::npos && line.find(candidate) != std::string_view::npos)
                    separator = candidate;
            headings = cellsOf(line, separator);
            if (headings.size() < 2) throw Error("names one column: needs time and at least one more", file, place);
            if (headings.size() > kMostColumns) throw Error("names too many columns", file, place);
            std::set<std::string> seen;
            for (std::size_t c = 0; c < headings.size(); ++c) {
                if (numberOf(headings[c])) throw Error("the first line must name the columns", file, place);
                const std::string name = nameAndUnit(headings[c]).first;
                if (name.empty()) throw Error("column " + std::to_string(c + 1) + " has no name", file, place);
                if (!seen.insert(name).second) throw Error("two columns are named " + name, file, place);
            }
            const auto isTime = [](const std::string& heading) {
                const std::string name = lower(nameAndUnit(heading).first);
                return name == "time" || name == "t";
            };
            if (const auto found = std::ranges::find_if(headings, isTime); found != headings.end())
                timeColumn = static_cast<std::size_t>(found - headings.begin());
            continue;
        }
        const std::vector<std::string> cells = cellsOf(line, separator);
        if (cells.size() != headings.size())
            throw Error("has " + std::to_string(cells.size()) + " values, the heading names " +
                            std::to_string(headings.size()) + " columns",
                        file, place);
        Row& row = rows.emplace_back(Row{number, {}});
        for (std::size_t c = 0; c < cells.size(); ++c) {
            const std::string word = lower(cells[c]);
            const bool unknown = word.empty() || word == "-" || word == "nan";
            const std::optional<double> value = unknown ? std::optional(kNotGiven) : numberOf(cells[c]);
            if (!value || std::isinf(*value))
                throw Error("\"" + cells[c].substr(0, 40) + "\" in column " + headings[c] + " is not a number", file,
                            place);
            if (unknown && c == timeColumn) throw Error("has no " + headings[c], file, place);
            row.values.push_back(*value);
        }
    }
    if (headings.empty()) throw Error("is empty: the first line must name the columns", file);
    if (rows.empty()) throw Error("has no row of numbers", file);
    return tableOf(std::move(rows), headings, timeColumn, file);
}

TimeTable readTimeTable(const std::string& path) {
    return parseTimeTable(readInput(path, kMostTableBytes), path);
}

namespace {

/// What rows and times of the data are matched by.
struct Match {
    std::vector<double> rows, times; ///< of each row of the table, rising; of each time of the data
    std::vector<Quantity> columns;   ///< in the order of the rows
    bool byAxis = true;              ///< the axis of the table is that of the data
};

bool isClock(const std::string& name) {
    const std::string word = lower(name);
    return word == "t" || word == "time";
}

/// Names that only count: files that are numbered, iterations of a solver.
bool isCounter(const std::string& name) {
    constexpr std::string_view kCounters[] = {"step", "iteration", "iter", "index", "cycle", "frame", "number", "n"};
    return std::ranges::find(kCounters, lower(name)) != std::end(kCounters);
}

/// By the axis of times of both, with its unit converted. Throws Error where the units do not fit.
Match matchAxis(const DatasetInfo& info, const TimeTable& table) {
    double perTable = 1; // times of the data per time of the table
    if (!table.timeUnit.empty() && !info.timeUnit.empty() && table.timeUnit != info.timeUnit) {
        const auto from = secondsIn(table.timeUnit), to = secondsIn(info.timeUnit);
        if (!from || !to)
            throw Error("counts " + table.timeName + " in " + table.timeUnit + ", but the times of the data are " +
                            info.timeName + " in " + info.timeUnit,
                        table.file);
        perTable = *from / *to;
    }
    Match out{{}, info.times, table.columns};
    for (const double time : table.times) out.rows.push_back(withNear(time * perTable, info.times));
    return out;
}

/// By a column of the table, which need not be its axis: rows without a number of it are left out. Nothing where it
/// repeats a number, since then it does not tell its rows apart.
std::optional<Match> matchColumn(const TimeTable& table, const std::vector<double>& values,
                                 const std::vector<double>& times) {
    std::vector<std::size_t> order;
    for (std::size_t r = 0; r < values.size(); ++r)
        if (std::isfinite(values[r])) order.push_back(r);
    std::ranges::sort(order, {}, [&](std::size_t r) { return values[r]; });
    std::vector<double> known = times;
    std::erase_if(known, [](double time) { return !std::isfinite(time); });
    std::ranges::sort(known);
    Match out{{}, times, {{table.timeName, table.timeUnit, {}}}, false};
    for (const std::size_t r : order) {
        const double value = withNear(values[r], known);
        if (!out.rows.empty() && out.rows.back() == value) return std::nullopt;
        out.rows.push_back(value);
        out.columns[0].values.push_back(table.times[r]);
    }
    for (const Quantity& column : table.columns) {
        Quantity& own = out.columns.emplace_back(Quantity{column.name, column.unit, {}});
        for (const std::size_t r : order) own.values.push_back(column.values[r]);
    }
    return out.rows.empty() ? std::nullopt : std::optional(out);
}

/// Whether any time of the data lies among the rows.
bool reaches(const Match& match) {
    return std::ranges::any_of(match.times,
                               [&](double time) { return time >= match.rows.front() && time <= match.rows.back(); });
}

/// By a quantity of both that is not the axis of both: a column named as the axis of the data, a counter of both, or a
/// quantity over time of the data, in the same unit where both state one.
std::optional<Match> matchShared(const DatasetInfo& info, const TimeTable& table) {
    std::vector<Quantity> columns = table.columns;
    columns.insert(columns.begin(), {table.timeName, table.timeUnit, table.times});
    const auto tried = [&](const Quantity& column, const std::vector<double>& times) -> std::optional<Match> {
        const auto match = matchColumn(table, column.values, times);
        return match && reaches(*match) ? match : std::nullopt;
    };
    const auto fits = [](const std::string& a, const std::string& b) { return a.empty() || b.empty() || a == b; };
    for (const Quantity& column : columns)
        if (lower(column.name) == lower(info.timeName) && fits(column.unit, info.timeUnit))
            if (auto match = tried(column, info.times)) return match;
    for (const Quantity& column : table.columns)
        if (isCounter(column.name) && isCounter(info.timeName))
            if (auto match = tried(column, info.times)) return match;
    for (const Quantity& own : info.quantities)
        for (const Quantity& column : columns)
            if (lower(column.name) == lower(own.name) && fits(column.unit, own.unit))
                if (auto match = tried(column, own.values)) return match;
    return std::nullopt;
}

std::string namesOf(const std::string& first, const std::string& unit, const std::vector<Quantity>& others) {
    std::string text = first + (unit.empty() ? "" : " [" + unit + "]");
    for (const Quantity& each : others) text += ", " + each.name + (each.unit.empty() ? "" : " [" + each.unit + "]");
    return text;
}

/// By the axis of both, else by what else both have. Throws Error that says what either has.
Match matchTable(const DatasetInfo& info, const TimeTable& table) {
    const bool sameAxis =
        lower(info.timeName) == lower(table.timeName) || (isClock(info.timeName) && isClock(table.timeName));
    const std::optional<Match> shared = sameAxis ? std::nullopt : matchShared(info, table);
    if (shared) return *shared;
    const bool numbered = isCounter(info.timeName) && isClock(table.timeName);
    std::string failure;
    if (numbered)
        failure = "counts time, the files of the data are only numbered: state what the numbers are with --time-name, "
                  "or their times with --times";
    else
        try {
            if (Match direct = matchAxis(info, table); reaches(direct)) return direct;
            failure = "has no row at the times of the data: " + std::to_string(table.times.front()) + " to " +
                      std::to_string(table.times.back()) + " " + table.timeUnit + " against " +
                      std::to_string(info.times.front()) + " to " + std::to_string(info.times.back()) + " " +
                      info.timeUnit;
        } catch (const Error& error) {
            failure = error.reason();
        }
    if (const auto other = matchShared(info, table)) return *other;
    throw Error(failure + " (the table has " + namesOf(table.timeName, table.timeUnit, table.columns) +
                    "; the data have " + namesOf(info.timeName, info.timeUnit, info.quantities) + ")",
                table.file);
}

} // namespace

void addTable(DatasetInfo& info, const TimeTable& table) {
    const Match match = matchTable(info, table);
    const std::vector<Quantity> columns = atTimes(match.columns, match.rows, match.times);
    if (match.byAxis) {
        if (info.timeUnit.empty()) info.timeUnit = table.timeUnit;
        const bool named = info.timeName != DatasetInfo().timeName && info.timeName != "step";
        if (!named && !isClock(table.timeName)) info.timeName = table.timeName;
    }
    for (const Quantity& column : columns)
        if (match.byAxis || lower(column.name) != lower(info.timeName)) setQuantity(info, column);
}

void stateQuantities(DatasetInfo& info, const ImportOptions& options) {
    if (!options.timeName.empty()) info.timeName = options.timeName;
    if (!options.timeUnit.empty()) info.timeUnit = options.timeUnit;
    if (!options.overTime.empty()) addTable(info, readTimeTable(options.overTime));
    for (Quantity& quantity : info.quantities)
        if (const auto unit = options.units.find(quantity.name); unit != options.units.end())
            quantity.unit = unit->second;
}

bool isTimeTable(const std::string& path) {
    const std::string ending = lower(fs::path(path).extension().string());
    if ((ending != ".csv" && ending != ".tsv") || !whyNoFile(path).empty()) return false;
    std::ifstream in(path);
    std::string line;
    while (std::getline(in, line) && (trimmed(line).empty() || trimmed(line).starts_with('#'))) {
    }
    if (line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
    for (const char separator : {',', ';', '\t'})
        for (const std::string& heading : cellsOf(line, separator)) {
            const std::string name = lower(nameAndUnit(heading).first);
            if (name == "x" || name == "y" || name == "z" || name.starts_with("points:")) return false;
        }
    return true;
}

} // namespace tessera::volume
