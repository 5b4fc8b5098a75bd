#include "vis/shapes/proxy.h"

#include "vis/optics/ray_setup.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::vis {

bool drawnByProxy(const Scene& scene) {
    if (scene.render.proxy == Proxy::Rays || peelsOf(scene) > 0) return false;
    return std::all_of(scene.layers.begin(), scene.layers.end(), [&](const Layer& layer) {
        const auto* volume = std::get_if<VolumeLayer>(&layer.technique);
        return !layer.visible ||
               (volume && volume->style == RayStyle::Composite && volume->quantity == Quantity::Value &&
                volume->classification == Classification::Post && !volume->look.any() &&
                transferFor(scene, layer.transfer.empty() ? volume->channel : layer.transfer).kind ==
                    TransferKind::Curve);
    });
}

ProxySurfaces proxySurfaces(const Scene& scene, const volume::Lattice& lattice, const WorldFrame& frame,
                            double stepFactor) {
    const Ray middle = cameraRay(scene.camera, 1, {0, 0});
    const glm::dvec3 cell = worldCell(lattice, frame);
    const bool perspective = scene.camera.projection == Projection::Perspective;
    ProxySurfaces out;
    out.shells = scene.render.proxy == Proxy::Shells && perspective;
    out.normal = middle.direction;
    out.spacing = double(scene.render.stepVoxels) * stepFactor / glm::length(middle.direction / cell);
    double phase = 0.5; // offset of the first surface behind the nearest corner, in spacings
    double nearest = std::numeric_limits<double>::infinity(), furthest = -nearest;
    const glm::dvec3 edges = lattice.spacing * frame.scale; // edges of a sublattice cell, with sign
    if (scene.render.proxy == Proxy::Stacks) {
        int axis = 0;
        for (int i = 1; i < 3; ++i)
            if (std::abs(middle.direction[i]) > std::abs(middle.direction[axis])) axis = i;
        out.normal = glm::dvec3(0);
        out.normal[axis] = middle.direction[axis] < 0 ? -1 : 1;
        out.spacing = std::abs(edges[axis]) / (lattice.kind == volume::LatticeKind::BCC ? 2 : 1);
        const double through = out.normal[axis] * frame.sheetToWorld(lattice.origin)[axis]; // offset of a lattice plane
        const double nearFace = -frame.halfSize[axis];
        phase = (through - nearFace) / out.spacing;
        phase -= std::floor(phase + 1e-6);
    }
    if (out.shells) {
        const glm::dvec3 closest = glm::clamp(middle.origin, -frame.halfSize, frame.halfSize);
        nearest = glm::length(closest - middle.origin);
    }
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 at =
            frame.halfSize * glm::dvec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        const double along = out.shells ? glm::length(at - middle.origin) : glm::dot(out.normal, at);
        if (!out.shells) nearest = std::min(nearest, along);
        furthest = std::max(furthest, along);
    }
    // Planes behind the eye are not visible.
    if (!out.shells && perspective && scene.render.proxy != Proxy::Stacks)
        nearest = std::max(nearest, glm::dot(out.normal, middle.origin));
    out.first = nearest + phase * out.spacing;
    out.count = std::clamp(int(std::floor((furthest - out.first) / out.spacing + 1e-6)) + 1, 0, 1 << 16);
    return out;
}

} // namespace tessera::vis
