#pragma once

#include "app/data/boundary_value.h"
#include "app/data/open.h"
#include "vis/optics/ray_setup.h"
#include "vis/optics/visibility.h"
#include "vis/processor/processor_renderer.h"
#include "vis/shapes/flow_geometry.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <numeric>

/// What can be measured of the picture of a volume view.
namespace tessera::app {

struct PictureMeasures {
    double seen = 0;    ///< share of the pixels of the box that differ visibly from the ground
    double body = 0;    ///< the same where every value above the surroundings of a scan is opaque
    double opacity = 0; ///< mean opacity over the box
    int colours = 0;    ///< parts of the colour map, of 16, that have at least 0.5 % of what is visible
    int parts = 0;      ///< parts of it that at least 2 % of the samples have
    double covered = 0; ///< share of the values that occur, in 48 parts of their range, of which something is visible
    double extent = 0;  ///< of the box, over the shorter side of the picture
    bool cut = false;   ///< part of the box lies outside of the picture
};

/// Lightness and colour of sRGB (CIE 1976 L*a*b*, D65), in which equal distances look equal.
inline glm::dvec3 lab(glm::dvec3 srgb) {
    const auto linear = [](double x) { return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4); };
    const glm::dvec3 c(linear(srgb.x), linear(srgb.y), linear(srgb.z));
    const glm::dvec3 xyz((0.4124 * c.x + 0.3576 * c.y + 0.1805 * c.z) / 0.9505,
                         0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z,
                         (0.0193 * c.x + 0.1192 * c.y + 0.9505 * c.z) / 1.089);
    const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
    return {116 * f(xyz.y) - 16, 500 * (f(xyz.x) - f(xyz.y)), 200 * (f(xyz.y) - f(xyz.z))};
}

inline constexpr double kVisible = 10; ///< distance of colours that is seen at a glance; 2.3 is just noticeable

/// The picture of the session's scene, RGBA8, rows top down, without box, axes and legends.
inline std::vector<std::uint8_t> pictureOf(vis::Scene scene, const std::shared_ptr<const volume::BrickSource>& source,
                                           glm::ivec2 size) {
    scene.showBox = false;
    scene.render.samples = 1;
    const int time = source->info().nearestTime(scene.time);
    for (const vis::Layer& layer : scene.layers)
        if (const auto* flow = std::get_if<vis::FlowLayer>(&layer.technique); flow && layer.visible)
            scene.geometry.push_back({.geometry = vis::makeFlow(*source, *flow, time, scene.stretch),
                                      .style = flow->style,
                                      .channel = flow->channel});
    vis::ProcessorRenderer renderer({.openGl = false});
    renderer.setSource(source);
    vis::ProcessorPicture picture;
    renderer.draw(picture, scene, size);
    return vis::shownRows(picture);
}

/// The first visible volume layer; null if there is none.
inline const vis::VolumeLayer* volumeShown(const Session& session) {
    for (const vis::Layer& layer : session.layers)
        if (const auto* volume = std::get_if<vis::VolumeLayer>(&layer.technique); volume && layer.visible)
            return volume;
    return nullptr;
}

/// Of a scan, the share of the range up to which the surroundings of the object reach; else 0.
inline double surroundingsOf(const volume::BrickSource& numbers, const std::string& name, int time) {
    const volume::DatasetInfo& info = numbers.info();
    const auto channel = info.findChannel(name);
    if (!channel) return 0;
    if (const auto background = backgroundShare(numbers, *channel, time)) return *background;
    const bool whole = info.parameters[std::size_t(info.channel(*channel).parameter)].type != volume::ScalarType::F32;
    const auto materials = materialsOf(numbers, *channel, time);
    const auto classes = materials || !whole ? materials : classesOf(numbers, *channel, time);
    return classes ? classes->below : 0;
}

inline double seenShareOf(const std::vector<std::uint8_t>& rgba, const Session& session,
                          const volume::DatasetInfo& info, glm::ivec2 size) {
    const vis::WorldFrame frame = vis::worldFrame(info, session.stretch);
    const glm::dvec3 ground = lab(glm::dvec3(sceneOf(session).background));
    double box = 0, seen = 0;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const glm::dvec2 ndc((x + 0.5) / size.x * 2 - 1, 1 - (y + 0.5) / size.y * 2);
            const vis::Ray ray = vis::cameraRay(session.camera, double(size.x) / size.y, ndc);
            if (!vis::clipToBox(ray, glm::max(frame.halfSize, glm::dvec3(1e-6)), true)) continue;
            box += 1;
            const std::uint8_t* const pixel = &rgba[4 * (std::size_t(y) * std::size_t(size.x) + std::size_t(x))];
            seen += glm::distance(lab(glm::dvec3(pixel[0], pixel[1], pixel[2]) / 255.0), ground) >= kVisible;
        }
    return box > 0 ? seen / box : 0;
}

/// Of the first visible volume layer: what its rays see by value. `from`: share of the range that is surroundings.
inline void measureValues(PictureMeasures& out, const Session& session, const volume::BrickSource& source,
                          double aspect, double from) {
    constexpr int kBins = 48, kMap = 16;
    const volume::DatasetInfo& info = source.info();
    const vis::VolumeLayer* const volume = volumeShown(session);
    const auto channel = volume ? info.findChannel(volume->channel) : std::nullopt;
    if (!channel) return;
    const volume::SampleGrid grid =
        volume::readSamples(source, *channel, info.nearestTime(session.time), source.grid().levelWithin(4e5));
    vis::VisibilityQuery query;
    query.camera = session.camera;
    query.aspect = aspect;
    query.stretch = session.stretch;
    query.function = session.transfer.at(volume->channel);
    query.range = vis::effectiveRange(query.function, info.channelRange(info.channel(*channel)));
    query.density = double(volume->density);
    query.bins = kBins * kMap;
    const std::vector<double> visible = vis::visibilityHistogram(grid, info.bounds, query);
    const double all = std::accumulate(visible.begin(), visible.end(), 0.0);
    out.opacity = all;
    std::vector<double> occurring(visible.size(), 0);
    double samples = 0;
    for (std::size_t i = 0; i < grid.values.size(); ++i) {
        const double share = (double(grid.values[i]) - query.range.lo) / (query.range.hi - query.range.lo);
        if (!grid.isPresent(i) || (from > 0 && share < from)) continue;
        occurring[std::size_t(std::clamp(share, 0.0, 1.0) * (double(query.bins) - 1e-9))] += 1;
        samples += 1;
    }
    // The range of all values but a thousandth at either end.
    std::size_t lo = 0, hi = occurring.size() - 1;
    for (double sum = occurring[lo]; lo < hi && sum < 0.001 * samples; sum += occurring[lo]) ++lo;
    for (double sum = occurring[hi]; hi > lo && sum < 0.001 * samples; sum += occurring[hi]) --hi;
    const double width = double(hi - lo + 1) / kBins;
    int occur = 0, seen = 0;
    for (int bin = 0; bin < kBins; ++bin) {
        const std::size_t begin = lo + std::size_t(bin * width),
                          end = std::max(lo + std::size_t((bin + 1) * width), begin + 1);
        const auto sum = [&](const std::vector<double>& of) {
            return std::accumulate(of.begin() + long(begin), of.begin() + long(end), 0.0);
        };
        if (sum(occurring) < 5e-4 * samples) continue;
        ++occur;
        seen += all > 0.01 && sum(visible) > 2.5e-4 * all;
    }
    out.covered = occur > 0 ? double(seen) / occur : 0;
    for (int part = 0; part < kMap; ++part) {
        const auto begin = visible.begin() + part * kBins;
        out.colours += std::accumulate(begin, begin + kBins, 0.0) > 0.005 * all && all > 0.01;
        const auto first = occurring.begin() + part * kBins;
        out.parts += std::accumulate(first, first + kBins, 0.0) > 0.02 * samples;
    }
}

/// Measures the session's picture at a size. `numbers`: the data, of which `source` is drawn.
inline PictureMeasures measure(const Session& session, const std::shared_ptr<const volume::BrickSource>& source,
                               const volume::BrickSource& numbers, glm::ivec2 size,
                               std::vector<std::uint8_t>* picture = nullptr) {
    PictureMeasures out;
    const vis::Scene scene = sceneOf(session);
    const std::vector<std::uint8_t> rgba = pictureOf(scene, source, size);
    if (picture) *picture = rgba;
    out.seen = seenShareOf(rgba, session, source->info(), size);
    if (const vis::VolumeLayer* const volume = volumeShown(session)) {
        const double from = surroundingsOf(numbers, volume->channel, numbers.info().nearestTime(session.time));
        vis::Scene opaque = scene;
        vis::TransferFunction& function = opaque.transfer[volume->channel];
        function.opacity = {
            {0.0f, from > 0 ? 0.0f : 1.0f}, {float(from), from > 0 ? 0.0f : 1.0f}, {float(from), 1.0f}, {1.0f, 1.0f}};
        function.colors = {{0, glm::vec3(1)}, {1, glm::vec3(1)}};
        out.body = seenShareOf(pictureOf(opaque, source, size), session, source->info(), size);
        measureValues(out, session, *source, double(size.x) / size.y, from);
    }
    const double aspect = double(size.x) / size.y;
    const vis::WorldFrame frame = vis::worldFrame(source->info(), session.stretch);
    const glm::dmat4 toClip = vis::projectionMatrix(session.camera, aspect) * vis::viewMatrix(session.camera);
    glm::dvec2 lo(1e9), hi(-1e9);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        const glm::dvec4 clip = toClip * glm::dvec4(frame.halfSize * sign, 1);
        lo = glm::min(lo, glm::dvec2(clip) / clip.w);
        hi = glm::max(hi, glm::dvec2(clip) / clip.w);
    }
    out.cut = lo.x < -1 || lo.y < -1 || hi.x > 1 || hi.y > 1;
    const glm::dvec2 pixels = (hi - lo) * 0.5 * glm::dvec2(size);
    out.extent = std::max(pixels.x, pixels.y) / std::min(size.x, size.y);
    return out;
}

} // namespace tessera::app
