#pragma once

#include "app/session/session.h"
#include "vis/image/image_io.h"
#include "volume/field/dataset.h"

#include <cmath>
#include <gtest/gtest.h>
#include <imgui.h>
#include <vector>

/// A data set with one bright place, another at each time, that lies in another part of each axis: whatever shows it
/// upside down, mirrored or with two axes swapped shows it elsewhere.
namespace tessera::app::beacon {

inline constexpr glm::ivec3 kSize{11, 9, 13};
inline constexpr glm::dvec3 kSpacing{1e-3, 1.5e-3, 0.8e-3}, kOrigin{0.02, -0.01, 0.005};
inline constexpr double kTimes[3] = {0, 1, 4};
inline constexpr glm::ivec3 kPlaces[3] = {{8, 2, 3}, {2, 6, 3}, {8, 6, 10}}; ///< sample, by time

/// The bright sample's physical position.
inline glm::dvec3 position(int time) {
    return kOrigin + kSpacing * glm::dvec3(kPlaces[time]);
}
/// Where it lies between the ends of an axis, 0..1.
inline double share(int time, int axis) {
    return double(kPlaces[time][axis]) / (kSize[axis] - 1);
}

/// "beacon" is 1 at the place and falls within a sample or two; "a" and "b" are two plain values each (2 or 10, 1 or 5,
/// the higher from x index 7 on), but b is 21 at the first sample.
inline float value(int parameter, glm::ivec3 at, int time) {
    if (parameter == 1) return at.x < 7 ? 2 : 10;
    if (parameter == 2) return at == glm::ivec3(0) ? 21 : at.x < 7 ? 1 : 5;
    const glm::dvec3 away(at - kPlaces[time]);
    return float(std::exp(-glm::dot(away, away) / 2));
}

inline volume::Dataset makeBeacon() {
    volume::Dataset data;
    volume::DatasetInfo& info = data.info;
    info.name = "beacon";
    info.lattice.size = kSize;
    info.lattice.spacing = kSpacing;
    info.lattice.origin = kOrigin;
    info.bounds = {kOrigin, kOrigin + kSpacing * glm::dvec3(kSize - 1)};
    info.times = {kTimes[0], kTimes[1], kTimes[2]};
    for (const auto& [name, range] : {std::pair("beacon", Range{0, 1}), {"a", {2, 10}}, {"b", {1, 21}}}) {
        volume::Parameter& made = info.parameters.emplace_back();
        made.name = name, made.unit = "V", made.ranges = {range};
    }
    data.read = [lattice = info.lattice](int parameter, int, int time) {
        volume::Field field = volume::makeField(lattice, volume::ScalarType::F32);
        std::size_t i = 0;
        for (int z = 0; z < kSize.z; ++z)
            for (int y = 0; y < kSize.y; ++y)
                for (int x = 0; x < kSize.x; ++x) field.as<float>()[i++] = value(parameter, {x, y, z}, time);
        return field;
    };
    return data;
}

/// Colours that no theme has: green where the beacon is not, magenta where it is bright, which alone is opaque.
inline void color(Session& session) {
    vis::TransferFunction& function = session.transfer["beacon"];
    function.autoRange = false;
    function.range = {0, 1};
    function.colors = {{0, {0, 0.5f, 0}}, {0.4f, {0, 0.5f, 0}}, {0.5f, {1, 0, 1}}, {1, {1, 0, 1}}};
    function.opacity = {{0, 0}, {0.4f, 0}, {0.5f, 1}, {1, 1}};
    session.layers = {vis::Layer{"beacon", true, vis::VolumeLayer{.channel = "beacon", .shaded = false, .density = 9}}};
    session.selection.brushes.clear();
    session.render.samples = 1;
}

/// Pixels of a picture, x right, y down.
struct Pixels {
    const vis::Image& image;
    glm::ivec3 at(int x, int y) const {
        const std::size_t i = 4 * (std::size_t(y) * std::size_t(image.size.x) + std::size_t(x));
        return {image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]};
    }
    bool bright(int x, int y) const {
        const glm::ivec3 c = at(x, y);
        return c.r > 150 && c.b > 150 && c.g < 90 && std::abs(c.r - c.b) < 40;
    }
    /// Of the map's colours, at either end.
    bool mapped(int x, int y) const {
        const glm::ivec3 c = at(x, y);
        return bright(x, y) || (c.g > 100 && c.g < 150 && c.r < 40 && c.b < 40);
    }
};

/// A rectangle of pixels, ends excluded at the lower right.
struct Area {
    glm::ivec2 min{0}, max{0};
    glm::dvec2 at(double right, double up) const {
        return {min.x + right * (max.x - min.x), max.y - up * (max.y - min.y)};
    }
};
inline Area whole(const vis::Image& image) {
    return {{0, 0}, image.size};
}

/// The areas that the map's colours fill, in rows from the top and from left to right; what is less than 20 pixels wide
/// or high is none (a legend). Those within `gap` pixels are one.
inline std::vector<Area> mappedAreas(const vis::Image& image, int gap = 4) {
    const Pixels pixels{image};
    const auto runs = [&](int from, int to, const auto& any) {
        std::vector<glm::ivec2> out;
        for (int i = from; i < to; ++i) {
            if (!any(i)) continue;
            if (out.empty() || i - out.back().y > gap) out.push_back({i, i});
            out.back().y = i + 1;
        }
        std::erase_if(out, [](glm::ivec2 run) { return run.y - run.x < 20; });
        return out;
    };
    const auto rowsIn = [&](glm::ivec2 columns) {
        return runs(0, image.size.y, [&](int y) {
            for (int x = columns.x; x < columns.y; ++x)
                if (pixels.mapped(x, y)) return true;
            return false;
        });
    };
    std::vector<Area> areas;
    for (const glm::ivec2 band : rowsIn({0, image.size.x}))
        for (const glm::ivec2 columns : runs(0, image.size.x, [&](int x) {
                 for (int y = band.x; y < band.y; ++y)
                     if (pixels.mapped(x, y)) return true;
                 return false;
             }))
            for (const glm::ivec2 rows : rowsIn(columns))
                if (rows.x >= band.x && rows.y <= band.y) areas.push_back({{columns.x, rows.x}, {columns.y, rows.y}});
    return areas;
}

/// The picture is bright around these places (pixels) and nowhere else within an area.
inline void expectBrightAt(const vis::Image& image, Area within, const std::vector<glm::dvec2>& places, double radius) {
    const Pixels pixels{image};
    std::vector<glm::dvec2> sum(places.size());
    std::vector<double> count(places.size());
    int stray = 0;
    glm::ivec2 worst(-1);
    for (int y = within.min.y; y < within.max.y; ++y)
        for (int x = within.min.x; x < within.max.x; ++x) {
            if (!pixels.bright(x, y)) continue;
            const glm::dvec2 middle(x + 0.5, y + 0.5);
            std::size_t nearest = 0;
            for (std::size_t i = 1; i < places.size(); ++i)
                if (glm::distance(middle, places[i]) < glm::distance(middle, places[nearest])) nearest = i;
            if (places.empty() || glm::distance(middle, places[nearest]) > radius) {
                ++stray, worst = {x, y};
                continue;
            }
            sum[nearest] += middle, count[nearest] += 1;
        }
    EXPECT_EQ(stray, 0) << "bright elsewhere, at " << worst.x << ' ' << worst.y;
    for (std::size_t i = 0; i < places.size(); ++i) {
        ASSERT_GT(count[i], 3) << "not bright at " << places[i].x << ' ' << places[i].y;
        EXPECT_NEAR(sum[i].x / count[i], places[i].x, radius / 3) << i;
        EXPECT_NEAR(sum[i].y / count[i], places[i].y, radius / 3) << i;
    }
}

} // namespace tessera::app::beacon
