#include "volume/import/files/stored_image.h"

#include "volume/base/error.h"
#include "volume/import/files/import_limits.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <glm/geometric.hpp>

namespace tessera::volume {

namespace {

constexpr std::size_t kMostInSample = 4096;

std::string channelName(const std::string& name, const std::string& part) {
    return name == "value" && !part.empty() && std::isdigit(static_cast<unsigned char>(part[0])) == 0
               ? part
               : name + "." + part;
}

/// The name of a component among so many.
std::string partName(ComponentKind parts, std::size_t c, std::size_t count) {
    static constexpr const char* kColors[] = {"red", "green", "blue", "alpha"};
    if (parts == ComponentKind::Colors && count <= 4) return kColors[c];
    if (parts == ComponentKind::Vector && count == 2) return c == 0 ? "x" : "y";
    if (parts != ComponentKind::Complex) return std::to_string(c);
    const std::string which = c % 2 == 0 ? "real" : "imaginary";
    return count == 2 ? which : std::to_string(c / 2) + "." + which;
}

} // namespace

std::size_t sizeOf(StoredType type) {
    constexpr std::size_t kBytes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    return kBytes[std::size_t(type)];
}

std::size_t StoredImage::samples() const {
    std::size_t all = frames * offsets.size();
    for (int axis = 0; axis < 3; ++axis) all *= std::size_t(grid.size[axis]);
    return all;
}

void setAxes(StoredImage& image, std::span<const StoredAxis> axes) {
    constexpr double kMostBytes = 4e18;
    double bytes = double(sizeOf(image.type));
    std::size_t stride = 1, components = 1;
    int space = 0;
    image.offsets = {0};
    image.frames = 1;
    image.grid.size = glm::ivec3(1);
    for (const StoredAxis& axis : axes) {
        bytes *= double(axis.size);
        const std::size_t most = axis.along == StoredAxis::Along::Times ? kMostTimes : std::size_t(kMostSamplesPerAxis);
        if (axis.size < 1 || axis.size > most || bytes > kMostBytes) throw Error("is out of range", {}, "sizes");
        if (axis.along == StoredAxis::Along::Space) {
            if (space == 3) throw Error("has more than three axes of space");
            image.grid.size[space] = int(axis.size);
            image.stride[space++] = stride;
        } else if (axis.along == StoredAxis::Along::Times) {
            if (image.frames > 1) throw Error("has two axes of time");
            image.frames = axis.size;
            image.timeStride = stride;
        } else {
            components *= axis.size;
            if (components > kMostInSample)
                throw Error("has " + std::to_string(components) + " components in each sample");
            std::vector<std::size_t> offsets;
            for (std::size_t n = 0; n < axis.size; ++n)
                for (const std::size_t offset : image.offsets) offsets.push_back(offset + n * stride);
            image.offsets = std::move(offsets);
        }
        stride *= axis.size;
    }
    for (; space < 3; ++space) image.stride[space] = stride;
}

void setChannels(StoredImage& image, const std::string& name, ComponentKind parts,
                 const std::vector<std::string>& labels) {
    const std::size_t count = image.offsets.size();
    image.channels.clear();
    if (count == 1) {
        image.channels.push_back({name, 0, 1});
    } else if (parts == ComponentKind::Vector && count % 3 == 0) {
        for (std::size_t c = 0; c < count; c += 3)
            image.channels.push_back({count == 3 ? name : name + "." + std::to_string(c / 3), c, 3});
    } else {
        for (std::size_t c = 0; c < count; ++c) {
            const std::string part =
                labels.size() == count && !labels[c].empty() ? labels[c] : partName(parts, c, count);
            image.channels.push_back({channelName(name, part), c, 1});
        }
    }
}

void completeSteps(StoredGrid& grid, int axes) {
    if (axes == 2) {
        const glm::dvec3 across = glm::cross(grid.steps[0], grid.steps[1]);
        const double length = glm::length(across);
        grid.steps[2] = std::isfinite(length) && length > 0 ? across / length : glm::dvec3(0, 0, 1);
        return;
    }
    for (int axis = axes; axis < 3; ++axis) {
        int free = axis;
        double least = 2;
        for (int along = 2; along >= 0; --along) {
            double most = 0;
            for (int other = 0; other < axis; ++other)
                most = std::max(most, std::abs(grid.steps[other][along]) / glm::length(grid.steps[other]));
            if (most > least || !std::isfinite(most)) continue;
            least = most;
            free = along;
        }
        grid.steps[axis] = glm::dvec3(0);
        grid.steps[axis][free] = 1;
    }
}

std::vector<double> evenTimes(std::size_t frames, double first, double step) {
    std::vector<double> times;
    for (std::size_t n = 0; n < frames; ++n) {
        // 3 * 0.1 is 0.30000000000000004, and means 0.3.
        const double time = first + double(n) * step;
        const double grain = std::pow(10.0, 15 - std::ceil(std::log10(std::max(std::abs(time), 1e-290))));
        const double rounded = std::round(time * grain) / grain;
        times.push_back(std::isfinite(rounded) ? rounded : time);
    }
    return times;
}

} // namespace tessera::volume
