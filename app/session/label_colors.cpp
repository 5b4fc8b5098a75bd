#include "app/session/label_colors.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace tessera::app {

std::optional<glm::vec3> parsedColor(const std::string& text) {
    if (text.size() != 7 || text[0] != '#') return std::nullopt;
    unsigned value = 0;
    const auto parsed = std::from_chars(text.data() + 1, text.data() + 7, value, 16);
    if (parsed.ec != std::errc() || parsed.ptr != text.data() + 7) return std::nullopt;
    return glm::vec3(value >> 16 & 255, value >> 8 & 255, value & 255) / 255.0f;
}

std::string colorText(glm::vec3 color) {
    const auto byte = [](float v) { return static_cast<unsigned>(std::lround(std::clamp(v, 0.0f, 1.0f) * 255)); };
    char text[16];
    std::snprintf(text, sizeof text, "#%02x%02x%02x", byte(color.r), byte(color.g), byte(color.b));
    return text;
}

glm::vec3 labelColor(const volume::Parameter& label, int value) {
    for (const volume::Label& known : label.labels)
        if (known.value == value)
            if (const auto stated = parsedColor(known.color)) return *stated;
    vis::TransferFunction map;
    map.colormap = "labels";
    return glm::vec3(vis::evaluate(map, {0, 1}, value));
}

std::vector<vis::ColorStop> labelStops(const volume::Parameter& label, Range range) {
    std::vector<vis::ColorStop> stops;
    const bool stated = std::ranges::any_of(label.labels, [](const volume::Label& one) { return !one.color.empty(); });
    if (!stated || !(range.hi > range.lo)) return stops;
    for (const volume::Label& one : label.labels) {
        const auto place = [&](double value) {
            return static_cast<float>(std::clamp((value - range.lo) / (range.hi - range.lo), 0.0, 1.0));
        };
        const glm::vec3 color = labelColor(label, one.value);
        stops.push_back({place(one.value - 0.5), color});
        stops.push_back({place(one.value + 0.5), color});
    }
    return stops;
}

} // namespace tessera::app
