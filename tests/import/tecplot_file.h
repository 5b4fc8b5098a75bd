#pragma once

#include "tests/import/foreign_files.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

/// Binary Tecplot files, written word by word as the Data Format Guide describes them.
namespace tessera::volume::tecplot {

inline constexpr double kGhost = -12345; ///< beside values of cells, never to be seen

struct Variable {
    std::vector<double> values; ///< of points, or of cells without ghosts
    int format = 1;             ///< 1 float, 2 double, 3 long, 4 short, 5 byte, 6 bit
    bool ofCells = false, passive = false;
    int from = -1; ///< zone that stores it
};

struct Zone {
    std::string name;
    std::vector<Variable> variables;
    std::array<int, 3> size{1, 1, 1}; ///< of an ordered zone
    int type = 0;                     ///< 0 ordered, 2 triangles, 3 quadrilaterals, 4 tetrahedra, 5 bricks
    int points = 0, cells = 0;        ///< of elements
    std::vector<int> corners{};
    int cornersFrom = -1;
    int strand = -1;
    double time = 0;
    bool inPoints = false;
    std::vector<int> faceNeighbours{};
    int neighbours = 0, neighbourMode = 0;
    std::vector<int> neighbourList{};
    std::vector<std::pair<std::string, std::string>> auxiliary{};
};

struct File {
    int version = 112;
    bool big = false;
    std::vector<std::string> names;
    std::vector<Zone> zones;
    int type = 0;
    std::string records{}; ///< of the header, after the zones

    std::string integer(std::int32_t value) const { return bytesOf(value, big); }
    std::string single(float value) const { return bytesOf(value, big); }
    std::string real(double value) const { return bytesOf(value, big); }
    std::string text(const std::string& word) const {
        std::string out;
        for (const char c : word) out += integer(static_cast<unsigned char>(c));
        return out + integer(0);
    }
    std::string number(double value, int format) const {
        switch (format) {
        case 1:
            return bytesOf(float(value), big);
        case 2:
            return bytesOf(value, big);
        case 3:
            return bytesOf(std::int32_t(value), big);
        case 4:
            return bytesOf(std::int16_t(value), big);
        default:
            return bytesOf(std::uint8_t(value), big);
        }
    }
    std::string zoneHeader(const Zone& zone) const {
        std::string out = single(299) + text(zone.name);
        if (version >= 107) out += integer(-1);
        if (version >= 106) out += integer(zone.strand) + real(zone.time);
        out += integer(-1) + integer(zone.type);
        if (version < 112) out += integer(zone.inPoints ? 1 : 0);
        bool located = false;
        for (const Variable& variable : zone.variables) located = located || variable.ofCells;
        out += integer(located ? 1 : 0);
        if (located)
            for (const Variable& variable : zone.variables) out += integer(variable.ofCells ? 1 : 0);
        if (version >= 108) out += integer(zone.faceNeighbours.empty() ? 0 : 1);
        out += integer(zone.neighbours);
        if (zone.neighbours != 0) out += integer(zone.neighbourMode);
        if (zone.neighbours != 0 && version >= 108 && zone.type != 0) out += integer(0);
        if (zone.type == 0)
            for (const int n : zone.size) out += integer(n);
        else
            out += integer(zone.points) + integer(zone.cells) + integer(0) + integer(0) + integer(0);
        for (const auto& [name, value] : zone.auxiliary) out += integer(1) + text(name) + integer(0) + text(value);
        return out + integer(0);
    }
    /// Values of cells as Tecplot writes them: rows and planes as long as those of points, without the last plane.
    std::vector<double> padded(const Zone& zone, const Variable& variable) const {
        if (!variable.ofCells || zone.type != 0) return variable.values;
        const auto [i, j, k] = zone.size;
        if (j == 1 && k == 1) return variable.values;
        std::vector<double> out;
        std::size_t from = 0;
        for (int c = 0; c < std::max(k - 1, 1); ++c)
            for (int b = 0; b < (k > 1 ? j : j - 1); ++b)
                for (int a = 0; a < i; ++a)
                    out.push_back(a < i - 1 && b < std::max(j - 1, 1) ? variable.values[from++] : kGhost);
        return out;
    }
    std::string zoneData(const Zone& zone) const {
        std::string out = single(299);
        bool passive = false, shared = false;
        for (const Variable& variable : zone.variables) {
            out += integer(variable.format);
            passive = passive || variable.passive;
            shared = shared || variable.from >= 0;
        }
        if (version >= 105) out += integer(passive ? 1 : 0);
        if (passive)
            for (const Variable& variable : zone.variables) out += integer(variable.passive ? 1 : 0);
        out += integer(shared ? 1 : 0);
        if (shared)
            for (const Variable& variable : zone.variables) out += integer(variable.from);
        out += integer(zone.cornersFrom);
        std::vector<Variable> stored;
        for (const Variable& variable : zone.variables)
            if (!variable.passive && variable.from < 0) stored.push_back(variable);
        if (version >= 105)
            for (const Variable& variable : stored)
                out +=
                    real(*std::ranges::min_element(variable.values)) + real(*std::ranges::max_element(variable.values));
        if (zone.inPoints)
            for (std::size_t n = 0; n < stored.front().values.size(); ++n)
                for (const Variable& variable : stored) out += number(variable.values[n], variable.format);
        else
            for (const Variable& variable : stored)
                for (const double value : padded(zone, variable)) out += number(value, variable.format);
        if (zone.cornersFrom < 0)
            for (const int corner : zone.corners) out += integer(corner);
        for (const int cell : zone.faceNeighbours) out += integer(cell);
        for (const int word : zone.neighbourList) out += integer(word);
        return out;
    }
    std::string header() const {
        std::string out = "#!TDV" + std::to_string(version) + integer(1);
        if (version >= 109) out += integer(type);
        out += text("a title") + integer(std::int32_t(names.size()));
        for (const std::string& name : names) out += text(name);
        for (const Zone& zone : zones) out += zoneHeader(zone);
        return out + records + single(357);
    }
    std::string bytes() const {
        std::string out = header();
        for (const Zone& zone : zones) out += zoneData(zone);
        return out;
    }
};

/// The grid of the tests, and formulas over it.
using Formula = std::function<double(glm::dvec3)>;

inline constexpr glm::ivec3 kSize(4, 3, 5);

inline glm::dvec3 place(double i, double j, double k) {
    return {0.25 * i - 1, 10 + 2 * j, 0.5 * k};
}
inline double linear(glm::dvec3 x) {
    return 300 + x.x + 2 * x.y + 3 * x.z;
}

/// Over the points of the grid, or the middles of its cells, x fastest.
inline Variable over(const Formula& of, int format = 1, bool ofCells = false) {
    Variable out;
    out.format = format;
    out.ofCells = ofCells;
    const int less = ofCells ? 1 : 0;
    const double half = ofCells ? 0.5 : 0;
    for (int k = 0; k < kSize.z - less; ++k)
        for (int j = 0; j < kSize.y - less; ++j)
            for (int i = 0; i < kSize.x - less; ++i) out.values.push_back(of(place(i + half, j + half, k + half)));
    return out;
}
inline std::vector<Variable> places(int format = 1, double along = 0) {
    return {over([along](glm::dvec3 x) { return x.x + along; }, format), over([](glm::dvec3 x) { return x.y; }, format),
            over([](glm::dvec3 x) { return x.z; }, format)};
}
inline Variable sharedWith(int zone, int format = 1, bool ofCells = false) {
    Variable out;
    out.format = format;
    out.ofCells = ofCells;
    out.from = zone;
    return out;
}
inline Variable passive(int format = 1) {
    Variable out;
    out.format = format;
    out.passive = true;
    return out;
}
inline Zone ordered(const std::string& name, std::vector<Variable> variables) {
    Zone zone;
    zone.name = name;
    zone.variables = std::move(variables);
    zone.size = {kSize.x, kSize.y, kSize.z};
    return zone;
}
/// The same grid as bricks, or as six tetrahedra for each of them.
inline Zone elements(const std::string& name, std::vector<Variable> variables, bool tetrahedra) {
    Zone zone;
    zone.name = name;
    zone.variables = std::move(variables);
    zone.type = tetrahedra ? 4 : 5;
    zone.points = kSize.x * kSize.y * kSize.z;
    const int row = kSize.x, plane = kSize.x * kSize.y;
    for (int k = 0; k + 1 < kSize.z; ++k)
        for (int j = 0; j + 1 < kSize.y; ++j)
            for (int i = 0; i + 1 < kSize.x; ++i) {
                const int n = i + row * j + plane * k;
                const int c[8] = {n,         n + 1,         n + row + 1,         n + row,
                                  n + plane, n + plane + 1, n + plane + row + 1, n + plane + row};
                if (!tetrahedra) {
                    zone.corners.insert(zone.corners.end(), c, c + 8);
                    ++zone.cells;
                    continue;
                }
                constexpr int kSix[6][4] = {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6},
                                            {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
                for (const auto& tetra : kSix) {
                    for (const int corner : tetra) zone.corners.push_back(c[corner]);
                    ++zone.cells;
                }
            }
    return zone;
}
inline std::vector<Variable> with(std::vector<Variable> variables, const std::vector<Variable>& more) {
    variables.insert(variables.end(), more.begin(), more.end());
    return variables;
}

} // namespace tessera::volume::tecplot
