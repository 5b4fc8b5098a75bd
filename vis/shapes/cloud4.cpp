#include "vis/shapes/cloud4.h"

#include "vis/optics/ray_setup.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace tessera::vis {

namespace {

constexpr std::size_t kColors = 1024;
constexpr double kReferencePoints = 60000;

/// Linear colours and opacities sampled along a range.
std::array<glm::vec4, kColors> tableOf(const TransferFunction& function) {
    std::array<glm::vec4, kColors> table{};
    for (std::size_t i = 0; i < kColors; ++i) {
        const glm::dvec4 srgb = evaluate(function, {0, 1}, double(i) / double(kColors - 1));
        table[i] = glm::vec4(linearFromSrgb(glm::dvec3(srgb)), srgb.a);
    }
    return table;
}

double shareOf(Range range, double value) {
    return range.hi > range.lo ? std::clamp((value - range.lo) / (range.hi - range.lo), 0.0, 1.0) : 0.5;
}

const glm::vec4& entry(const std::array<glm::vec4, kColors>& table, double share) {
    return table[std::size_t(share * double(kColors - 1) + 0.5)];
}

/// The normal in the box of a gradient in space and time: a gradient grows as its axis is drawn shorter.
glm::vec4 normalOf(glm::vec4 gradient, const CloudStyle& style, glm::dvec3 size) {
    const double along = style.fourth.hi - style.fourth.lo;
    glm::dvec4 out(gradient);
    if (style.fourthChannel >= 0) out.w = -1;
    const glm::dvec4 half = firstFour(style.half);
    for (int axis = 0; axis < 4; ++axis)
        out[axis] = half[axis] > 0 ? out[axis] * (axis < 3 ? size[axis] : along) / (2 * half[axis]) : 0;
    const double length = glm::length(out);
    return length > 0 ? glm::vec4(out / length) : glm::vec4(0);
}

} // namespace

double litBy(const Light4& light, glm::dvec4 turned) {
    if (light.towards == glm::dvec4(0) || turned == glm::dvec4(0)) return 1;
    return light.ambient + (1 - light.ambient) * std::abs(glm::dot(turned, light.towards));
}

std::vector<CloudPoint> makeCloud(const volume::Samples4& samples, const CloudStyle& style) {
    const auto colors = tableOf(style.transfer);
    const auto fourthColors = tableOf(style.fourthColors.value_or(TransferFunction{}));
    LensSpace space;
    space.frame.axes = style.axes;
    const DoiFunction interest(style.selection, space);
    const bool brushed = style.selection.active();
    const double power = style.density * kReferencePoints / std::max(1.0, double(samples.count()));
    const glm::dvec3 size = glm::max(style.bounds.size(), glm::dvec3(std::numeric_limits<double>::min()));
    const auto channels = std::size_t(samples.channels);
    std::vector<double> values(style.doiChannels.size());
    std::vector<CloudPoint> points;
    for (std::size_t i = 0; i < samples.count(); ++i) {
        const float* own = &samples.values[i * channels];
        const double along = style.fourthChannel < 0 ? double(samples.times[i]) : double(own[style.fourthChannel]);
        const auto lacks = [&](const CloudAxis& axis) { return std::isnan(own[axis.channel]); };
        if (std::isnan(own[0]) || std::isnan(along) || std::ranges::any_of(style.further, lacks)) continue;
        const glm::dvec3 physical(samples.positions[i]);
        const double fourth = shareOf(style.fourth, along);
        glm::dvec3 inBox = glm::clamp((style.axes.toSheet(physical) - style.bounds.lo) / size, 0.0, 1.0) * 2.0 - 1.0;
        for (int axis = 0; axis < 3; ++axis) // without extent: in the middle, whichever grid of BCC it belongs to
            if (!(style.bounds.hi[axis] > style.bounds.lo[axis])) inBox[axis] = 0;
        CloudPoint point;
        point.position = glm::vec4(glm::dvec4(inBox, fourth * 2 - 1) * firstFour(style.half));
        for (std::size_t a = 0; a < style.further.size(); ++a) {
            const double share = shareOf(style.further[a].range, double(own[style.further[a].channel]));
            point.further[int(a)] = float((share * 2 - 1) * style.half[4 + a]);
        }
        if (!samples.gradients.empty()) point.normal = normalOf(samples.gradients[i], style, size);
        point.color = entry(colors, shareOf(style.range, double(own[0])));
        if (style.fourthColors) point.color = glm::vec4(glm::vec3(entry(fourthColors, fourth)), point.color.a);
        double opacity = double(point.color.a);
        if (brushed) {
            for (std::size_t c = 0; c < values.size(); ++c)
                values[c] = style.doiChannels[c] < 0 ? std::numeric_limits<double>::quiet_NaN()
                                                     : double(own[style.doiChannels[c]]);
            const double doi = interest(values, physical);
            opacity *= glm::mix(double(style.selection.contextOpacity), 1.0, doi);
            const double saturation = glm::mix(double(style.selection.contextSaturation), 1.0, doi);
            const glm::dvec3 color(point.color);
            point.color = glm::vec4(glm::mix(glm::dvec3(luminance(color)), color, saturation), 0);
        }
        opacity = 1 - std::pow(1 - std::min(opacity, 0.9999), power);
        if (opacity < 1e-4) continue;
        point.color.a = float(opacity);
        point.sample = std::uint32_t(i);
        points.push_back(point);
    }
    return points;
}

std::optional<std::size_t> nearestPoint(std::span<const CloudPoint> points, const RotationN& rotation,
                                        const Projection4& projection, glm::dvec2 at, double reach) {
    std::optional<std::size_t> best;
    double least = 0;
    const glm::dmat4 first = rotation.firstAxes(), further = rotation.furtherAxes();
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Projected4 seen =
            project(projection, 1, first * glm::dvec4(points[i].position) + further * glm::dvec4(points[i].further));
        const glm::dvec2 away = seen.at - at;
        const double distance = glm::dot(away, away);
        if (distance > reach * reach) continue;
        const double cost = std::floor(5 * std::sqrt(distance) / reach) + seen.depth;
        if (!best || cost < least) best = i, least = cost;
    }
    return best;
}

} // namespace tessera::vis
