#include "app/importer/tables/table_zones.h"

#include "volume/import/absent.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <unordered_map>
#include <utility>

namespace tessera::importer {

namespace {

using Place = std::array<double, 3>;
using Rows = std::vector<std::size_t>;

struct PlaceHash {
    std::size_t operator()(const Place& place) const {
        std::size_t hash = 1469598103934665603ull;
        for (const double x : place) hash = (hash ^ std::hash<double>()(x)) * 1099511628211ull;
        return hash;
    }
};

std::vector<Place> placesIn(const PointTable& table) {
    std::vector<Place> out(table.rows(), Place{});
    for (int axis = 0; axis < 3; ++axis)
        if (const std::ptrdiff_t column = placeColumn(table.headings, axis); column >= 0)
            for (std::size_t row = 0; row < out.size(); ++row)
                out[row][std::size_t(axis)] = table.columns[std::size_t(column)][row] + 0.0; // -0 is 0
    return out;
}

PointTable withRows(const PointTable& table, const Rows& rows) {
    PointTable out{table.headings, {}, table.types, table.labels};
    for (const std::vector<double>& column : table.columns) {
        std::vector<double>& some = out.columns.emplace_back();
        some.reserve(rows.size());
        for (const std::size_t row : rows) some.push_back(column[row]);
    }
    return out;
}

TimedTable withRows(const TimedTable& table, const Rows& rows, const std::string& name) {
    TimedTable out{name, table.times, {}};
    for (const PointTable& each : table.tables) out.tables.push_back(withRows(each, rows));
    return out;
}

bool agree(double a, double b) {
    return std::isnan(a) || std::isnan(b) || std::abs(a - b) <= 1e-6 * std::max(std::abs(a), std::abs(b));
}

/// For each row the first one with its position.
Rows firstRows(const std::vector<Place>& places) {
    std::unordered_map<Place, std::size_t, PlaceHash> first;
    first.reserve(places.size());
    Rows out;
    out.reserve(places.size());
    for (std::size_t row = 0; row < places.size(); ++row)
        out.push_back(first.try_emplace(places[row], row).first->second);
    return out;
}

/// Joins rows that agree with the first of their position. Gives the rows that are left, and how many of them disagree.
std::pair<Rows, std::size_t> joinEqual(TimedTable& table, const Rows& first) {
    Rows left;
    std::size_t disagree = 0;
    for (std::size_t row = 0; row < first.size(); ++row) {
        if (first[row] == row) {
            left.push_back(row);
            continue;
        }
        bool same = true;
        for (const PointTable& each : table.tables)
            for (const std::vector<double>& column : each.columns)
                same = same && agree(column[row], column[first[row]]);
        if (!same) {
            left.push_back(row);
            ++disagree;
            continue;
        }
        for (PointTable& each : table.tables)
            for (std::vector<double>& column : each.columns)
                if (std::isnan(column[first[row]])) column[first[row]] = column[row];
    }
    return {left, disagree};
}

/// Zones by a column of labels, if each position occurs once in each.
std::map<std::string, Rows> zonesByLabel(const PointTable& table, const std::vector<Place>& places) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
        const bool words = c < table.labels.size() && !table.labels[c].empty();
        if (!words && !volume::isLabelName(table.headings[c].name)) continue;
        std::map<double, Rows> zones;
        std::set<std::pair<Place, double>> seen;
        bool unique = true;
        for (std::size_t row = 0; row < places.size() && unique; ++row) {
            const double zone = table.columns[c][row];
            unique = !std::isnan(zone) && zones.size() <= 255 && seen.insert({places[row], zone}).second;
            zones[zone].push_back(row);
        }
        if (!unique || zones.size() < 2) continue;
        std::map<std::string, Rows> out;
        for (auto& [value, rows] : zones) {
            std::string name = table.headings[c].name + " " + std::to_string(static_cast<long long>(value));
            if (words)
                for (const volume::Label& label : table.labels[c])
                    if (label.value == int(value)) name = label.name;
            out[name] = std::move(rows);
        }
        return out;
    }
    return {};
}

/// Where the first zone of rows [from, ...) ends: between the last of its positions that come again and the row that
/// is first to come again; there, where its positions fill a grid, else at the longest way between two rows.
std::size_t endOfZone(const std::vector<Place>& places, std::size_t from) {
    std::unordered_map<Place, std::size_t, PlaceHash> seen;
    std::size_t again = from;
    for (; again < places.size(); ++again)
        if (!seen.try_emplace(places[again], again).second) break;
    if (again == places.size()) return again;
    std::size_t least = from; // the last row that must be in the zone
    for (std::size_t row = again; row < places.size(); ++row)
        if (const auto at = seen.find(places[row]); at != seen.end()) least = std::max(least, at->second);
    std::array<std::set<double>, 3> distinct;
    std::size_t longest = again;
    double length = -1;
    for (std::size_t row = from; row < again; ++row) {
        for (std::size_t axis = 0; axis < 3; ++axis) distinct[axis].insert(places[row][axis]);
        if (row < least) continue;
        const double filled = double(distinct[0].size()) * double(distinct[1].size()) * double(distinct[2].size());
        if (filled == double(row + 1 - from) && row + 1 - from > 1) return row + 1;
        double way = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) way += std::pow(places[row + 1][axis] - places[row][axis], 2);
        if (way > length) {
            length = way;
            longest = row + 1;
        }
    }
    return longest;
}

} // namespace

TimedTable byTime(const PointTable& table, std::size_t column) {
    TimedTable out;
    PointTable rest{table.headings, table.columns, {}, table.labels};
    rest.headings.erase(rest.headings.begin() + std::ptrdiff_t(column));
    rest.columns.erase(rest.columns.begin() + std::ptrdiff_t(column));
    if (!rest.labels.empty()) rest.labels.erase(rest.labels.begin() + std::ptrdiff_t(column));
    std::map<double, Rows> rows;
    for (std::size_t row = 0; row < table.rows(); ++row) {
        const double time = table.columns[column][row];
        if (!std::isfinite(time)) throw std::runtime_error("has a time that is not a number");
        rows[time].push_back(row);
    }
    // Points of all times; a position that occurs twice at one time is two points.
    const std::vector<Place> places = placesIn(rest);
    std::map<std::pair<Place, std::size_t>, std::size_t> points;
    std::vector<Place> of;
    std::vector<std::vector<std::ptrdiff_t>> rowOf; // by time, by point
    for (const auto& [time, own] : rows) {
        std::unordered_map<Place, std::size_t, PlaceHash> times;
        std::vector<std::ptrdiff_t>& at = rowOf.emplace_back(of.size(), -1);
        for (const std::size_t row : own) {
            const std::size_t occurrence = times[places[row]]++;
            const auto [point, isNew] = points.try_emplace({places[row], occurrence}, of.size());
            if (isNew) {
                of.push_back(places[row]);
                at.push_back(-1);
            }
            at[point->second] = std::ptrdiff_t(row);
        }
        out.times.push_back(time);
    }
    for (const std::vector<std::ptrdiff_t>& at : rowOf) {
        PointTable part{rest.headings, {}, {}, rest.labels};
        for (std::size_t c = 0; c < rest.columns.size(); ++c) {
            std::vector<double>& values =
                part.columns.emplace_back(of.size(), std::numeric_limits<double>::quiet_NaN());
            for (int axis = 0; axis < 3; ++axis)
                if (placeColumn(rest.headings, axis) == std::ptrdiff_t(c))
                    for (std::size_t p = 0; p < of.size(); ++p) values[p] = of[p][std::size_t(axis)];
            for (std::size_t p = 0; p < at.size(); ++p)
                if (at[p] >= 0) values[p] = rest.columns[c][std::size_t(at[p])];
        }
        out.tables.push_back(std::move(part));
    }
    return out;
}

std::vector<TimedTable> zonesOf(TimedTable table, std::vector<std::string>& notes) {
    const std::size_t rows = table.tables.front().rows();
    const Rows first = firstRows(placesIn(table.tables.front()));
    std::size_t repeated = 0;
    for (std::size_t row = 0; row < rows; ++row) repeated += first[row] != row ? 1 : 0;
    if (repeated == 0) return {std::move(table)};
    const auto [left, disagree] = joinEqual(table, first);
    if (disagree == 0) {
        notes.push_back(std::to_string(repeated) + (repeated == 1 ? " row repeats" : " rows repeat") +
                        " a position with the same values: joined");
        return {withRows(table, left, table.name)};
    }
    const std::vector<Place> places = placesIn(table.tables.front());
    const std::string prefix = table.name.empty() ? "" : table.name + " ";
    std::vector<TimedTable> zones;
    for (const auto& [name, own] : zonesByLabel(table.tables.front(), places))
        zones.push_back(withRows(table, own, prefix + name));
    for (std::size_t from = 0; zones.empty() || from > 0;) {
        const std::size_t end = endOfZone(places, from);
        constexpr std::size_t kMostZones = 255, kFewestRows = 4;
        if (end - from < kFewestRows || zones.size() >= kMostZones) {
            zones.clear();
            break;
        }
        Rows own(end - from);
        for (std::size_t i = 0; i < own.size(); ++i) own[i] = from + i;
        zones.push_back(withRows(table, own, prefix + "zone " + std::to_string(zones.size() + 1)));
        from = end;
        if (from == rows) break;
    }
    if (zones.size() > 1) {
        notes.push_back(std::to_string(disagree) + (disagree == 1 ? " row repeats" : " rows repeat") +
                        " a position with other values: the table is read as " + std::to_string(zones.size()) +
                        " zones that share their borders");
        return zones;
    }
    Rows once;
    std::size_t again = 0;
    for (std::size_t row = 0; row < rows; ++row) {
        if (first[row] == row)
            once.push_back(row);
        else if (again == 0)
            again = row;
    }
    if (double(disagree) > 0.01 * double(rows))
        throw std::runtime_error("has the same position in rows " + std::to_string(first[again] + 1) + " and " +
                                 std::to_string(again + 1) + " with other values, and its rows are not those of zones");
    notes.push_back(std::to_string(disagree) + (disagree == 1 ? " row repeats" : " rows repeat") +
                    " a position with other values: left out (the first is row " + std::to_string(again + 1) + ")");
    return {withRows(table, once, table.name)};
}

} // namespace tessera::importer
