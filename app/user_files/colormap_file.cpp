#include "app/user_files/colormap_file.h"

#include "app/history/session_file.h"
#include "volume/base/error.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace tessera::app {

namespace {

double number(const Json& value, const std::string& file, const std::string& place) {
    if (!value.is_number()) throw Error("not a number", file, place);
    const double x = value.get<double>();
    if (!std::isfinite(x)) throw Error("not a finite number", file, place);
    return x;
}

float component(const Json& value, const std::string& file, const std::string& place) {
    const double x = number(value, file, place);
    if (x < 0 || x > 1) throw Error("a colour component is not within 0 to 1", file, place);
    return float(x);
}

/// Positions as they stand in the file.
using Stops = std::vector<std::pair<double, glm::vec3>>;

Stops ownStops(const Json& colors, const std::string& file) {
    Stops stops;
    for (std::size_t i = 0; i < colors.size(); ++i) {
        const std::string place = "/colors/" + std::to_string(i);
        const Json& one = colors[i];
        if (!one.is_object() || !one.contains("position") || !one.contains("color") || !one["color"].is_array() ||
            one["color"].size() != 3)
            throw Error("no {\"position\": x, \"color\": [r, g, b]}", file, place);
        glm::vec3 color;
        for (int c = 0; c < 3; ++c) color[c] = component(one["color"][std::size_t(c)], file, place + "/color");
        stops.emplace_back(number(one["position"], file, place + "/position"), color);
    }
    return stops;
}

Stops paraViewStops(const Json& points, const std::string& file) {
    const std::string place = "/0/RGBPoints";
    if (!points.is_array() || points.size() % 4 != 0) throw Error("no list of x, r, g, b", file, place);
    Stops stops;
    for (std::size_t i = 0; i < points.size(); i += 4) {
        glm::vec3 color;
        for (int c = 0; c < 3; ++c) color[c] = component(points[i + 1 + std::size_t(c)], file, place);
        stops.emplace_back(number(points[i], file, place), color);
    }
    return stops;
}

} // namespace

std::vector<vis::ColorStop> parseColormap(std::string_view text, const std::string& file) {
    const Json document = Json::parse(text, nullptr, false);
    if (document.is_discarded()) throw Error("no JSON", file);
    Stops stops;
    if (document.is_object() && document.contains("colors") && document["colors"].is_array())
        stops = ownStops(document["colors"], file);
    else if (document.is_array() && !document.empty() && document[0].is_object() && document[0].contains("RGBPoints"))
        stops = paraViewStops(document[0]["RGBPoints"], file);
    else
        throw Error("neither \"colors\" nor a list with \"RGBPoints\": no colour map", file);
    std::stable_sort(stops.begin(), stops.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    if (stops.size() < 2) throw Error("a colour map has at least two colours", file);
    const double lo = stops.front().first, width = stops.back().first - lo;
    if (!(width > 0)) throw Error("all colours have the same position", file);
    std::vector<vis::ColorStop> out;
    for (const auto& [position, color] : stops) out.push_back({float((position - lo) / width), color});
    return out;
}

std::vector<vis::ColorStop> readColormap(const std::string& path) {
    return parseColormap(readText(path), path);
}

} // namespace tessera::app
