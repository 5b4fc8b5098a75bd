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

} // namespace

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
        if (std::isnan(own[0]) || std::isnan(along)) continue;
        const glm::dvec3 physical(samples.positions[i]);
        const double fourth = shareOf(style.fourth, along);
        const glm::dvec3 inBox =
            glm::clamp((style.axes.toSheet(physical) - style.bounds.lo) / size, 0.0, 1.0) * 2.0 - 1.0;
        CloudPoint point;
        point.position = glm::vec4(glm::dvec4(inBox, fourth * 2 - 1) * style.half);
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

std::optional<std::size_t> nearestPoint(std::span<const CloudPoint> points, const glm::dmat4& rotation,
                                        const Projection4& projection, glm::dvec2 at, double reach) {
    std::optional<std::size_t> best;
    double least = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Projected4 seen = project(projection, 1, rotation * glm::dvec4(points[i].position));
        const glm::dvec2 away = seen.at - at;
        const double distance = glm::dot(away, away);
        if (distance > reach * reach) continue;
        const double cost = std::floor(5 * std::sqrt(distance) / reach) + seen.depth;
        if (!best || cost < least) best = i, least = cost;
    }
    return best;
}

} // namespace tessera::vis
