#include "app/views/shadow_cube/wall_projection.h"

#include "vis/optics/ray_setup.h"
#include "volume/reconstruct/probe.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::app {

namespace {

constexpr int kMostPlaces = 4096;
constexpr double kThinnest = 1e-3; ///< half edge of data without extent, for a camera

/// Middles of even parts of the line through the data behind a place as it is drawn, two to a cell of the lattice.
std::vector<glm::dvec3> placesBehind(const volume::Box& bounds, const volume::Lattice& drawn, const CubeFace& face,
                                     glm::dvec3 position) {
    const double length = bounds.size()[face.axis];
    const double spacing = std::abs(drawn.spacing[face.axis]);
    const double cells = spacing > 0 ? length / spacing : 0;
    const int count = std::clamp(2 * int(std::lround(cells)), 1, kMostPlaces);
    std::vector<glm::dvec3> places;
    for (int i = 0; i < count; ++i) {
        places.push_back(position);
        places.back()[face.axis] = drawn.axes.toSpace(face.axis, bounds.lo[face.axis] + length * (i + 0.5) / count);
    }
    return places;
}

double greatestInterest(const volume::BrickSource& source, const Session& session, const volume::AxisMaps& axes,
                        const std::vector<glm::dvec3>& places, int time) {
    vis::LensSpace space; // walls have no lenses
    space.frame.axes = axes;
    const vis::DoiFunction interest(session.selection, space);
    std::vector<std::vector<volume::ProbeValue>> columns;
    for (const std::string& name : interest.channels()) {
        const auto channel = source.info().findChannel(name);
        columns.push_back(channel ? volume::probeAlong(source, *channel, places, time)
                                  : std::vector<volume::ProbeValue>(places.size()));
    }
    double most = 0;
    std::vector<double> values(columns.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        for (std::size_t c = 0; c < columns.size(); ++c)
            values[c] = columns[c][i].interpolated.value_or(std::numeric_limits<double>::quiet_NaN());
        most = std::max(most, interest(values, places[i]));
    }
    return most;
}

/// Keeps the lenses on a face: what is drawn inside of them is drawn as `wall` is.
void addFaceLenses(vis::Scene& out, const vis::Scene& scene, const vis::Layer& wall, bool opaque) {
    out.selection = scene.selection; // of which lenses may be
    for (const vis::Lens& lens : scene.lenses) {
        if (lens.shape == vis::LensShape::Disc) continue; // it faces the viewer of the cube
        out.lenses.push_back(lens);
        for (const vis::Layer& layer : scene.layers) {
            if (!layer.visible || layer.lens != lens.name) continue;
            vis::Layer inner = wall;
            inner.lens = lens.name;
            inner.transfer = layer.transfer;
            inner.timeShift = layer.timeShift;
            const std::string channel = vis::shownChannel(layer.technique);
            std::visit([&](auto& own) { own.channel = channel; }, inner.technique);
            if (opaque) out.transfer[inner.transfer.empty() ? channel : inner.transfer].opacity = {{0, 1}, {1, 1}};
            out.layers.push_back(std::move(inner));
        }
    }
}

} // namespace

glm::dvec3 CubeFace::at(double s, double t, glm::dvec3 half) const {
    glm::dvec3 place(0);
    place[axis] = upper ? half[axis] : -half[axis];
    place[right()] = s;
    place[up()] = t;
    return place;
}

const Wall& wallOf(const ShadowCubeView& view, std::size_t face) {
    return *ShadowCubeView::walls(view)[face];
}

Wall& wallOf(ShadowCubeView& view, std::size_t face) {
    return *ShadowCubeView::walls(view)[face];
}

bool facesViewer(const CubeFace& face, glm::dvec3 half, const vis::Camera& camera) {
    const vis::Ray middle = vis::cameraRay(camera, 1, {0, 0});
    const double outward = face.upper ? 1 : -1;
    // Visible from inside: the direction from the eye to the face points outwards.
    // A face seen edge on does not count in spite of rounding.
    if (camera.projection == vis::Projection::Orthographic) return middle.direction[face.axis] * outward > 1e-6;
    return (outward * half[face.axis] - middle.origin[face.axis]) * outward > 0;
}

std::optional<FaceHit> hitFace(const vis::Ray& ray, glm::dvec3 half, const vis::Camera& camera) {
    for (std::size_t i = 0; i < kCubeFaces.size(); ++i) {
        const CubeFace& face = kCubeFaces[i];
        const double slope = ray.direction[face.axis];
        if (!facesViewer(face, half, camera) || std::abs(slope) < 1e-9) continue;
        const double along = ((face.upper ? 1 : -1) * half[face.axis] - ray.origin[face.axis]) / slope;
        const glm::dvec3 place = ray.origin + along * ray.direction;
        const FaceHit hit{i, place[face.right()], place[face.up()]};
        if (along > 0 && std::abs(hit.s) <= half[face.right()] && std::abs(hit.t) <= half[face.up()]) return hit;
    }
    return std::nullopt;
}

vis::Camera cubeCamera(const ShadowCubeView& view, vis::Camera camera, glm::dvec3 half, double aspect,
                       glm::dvec2 share) {
    vis::WorldFrame cube;
    cube.halfSize = half;
    vis::fit(camera, cube, aspect * share.x / share.y);
    camera.distance /= float(share.y) * view.zoom;
    camera.target = view.target;
    return camera;
}

vis::Scene wallScene(const vis::Scene& scene, const std::string& channel, const Wall& wall, const CubeFace& face,
                     const vis::WorldFrame& world, glm::vec3 shadow) {
    const WallKind kind = wall.kind;
    vis::Scene out = scene;
    out.geometry.clear();
    out.strokes.clear();
    out.clips.clear();
    out.lenses.clear();
    out.tone = {};
    out.depthMask = {};
    out.lighting.shadows = {};
    out.paper.reset();
    out.showBox = out.showGround = false;
    out.render.samples = 1;
    out.render.proxy = vis::Proxy::Rays;
    const bool selected = scene.selection.active();
    out.selection = {};
    vis::TransferFunction& function = out.transfer[wall.transfer.empty() ? channel : wall.transfer];
    vis::VolumeLayer layer{.channel = channel};
    const bool opaque = kind == WallKind::Mean || kind == WallKind::Maximum;
    if (opaque) {
        layer.style = kind == WallKind::Mean ? vis::RayStyle::Average : vis::RayStyle::Maximum;
        function.opacity = {{0, 1}, {1, 1}};
    } else if (kind == WallKind::Volume) {
        layer.look = wall.look;
    } else {
        layer.style = vis::RayStyle::XRay;
    }
    if (kind == WallKind::Shadow) {
        out.selection = scene.selection;
        out.selection.contextOpacity = 0;
        function.colors = {{0, shadow}, {1, shadow}};
        if (selected) function.opacity = {{0, 0.6f}, {1, 0.6f}};
        layer.density = 4;
    }
    out.layers = {{.name = "wall", .technique = layer, .transfer = wall.transfer}};
    if (kind == WallKind::Slice)
        out.layers[0].technique = vis::SliceLayer{.channel = channel,
                                                  .orientation = static_cast<vis::SliceOrientation>(face.axis),
                                                  .contours = wall.contours};
    if (wall.lenses && kind != WallKind::Shadow) {
        out.layers[0].brushes = vis::BrushEffect::None;
        addFaceLenses(out, scene, vis::Layer(out.layers[0]), opaque);
    }
    out.camera = {};
    out.camera.projection = vis::Projection::Orthographic;
    glm::vec3 right(0), up(0);
    right[face.right()] = 1;
    up[face.up()] = 1;
    out.camera.orientation =
        glm::normalize(glm::quat_cast(glm::transpose(glm::mat3(right, up, glm::cross(right, up)))));
    const double height = std::max(world.halfSize[face.up()], kThinnest);
    out.camera.distance = float(height / std::tan(glm::radians(double(out.camera.fieldOfView)) / 2));
    return out;
}

std::optional<double> readWall(const volume::BrickSource& source, const Session& session, int channel, const Wall& wall,
                               const CubeFace& face, glm::dvec3 position, int time, const volume::Lattice* drawn) {
    const WallKind kind = wall.kind;
    const volume::DatasetInfo& info = source.info();
    const volume::Lattice& lattice = drawn ? *drawn : info.lattice;
    if (kind == WallKind::Slice) {
        position[face.axis] = session.cursor[face.axis];
        return volume::probeChannel(source, channel, position, time).interpolated;
    }
    const std::vector<glm::dvec3> places = placesBehind(info.bounds, lattice, face, position);
    if (kind == WallKind::Shadow) return greatestInterest(source, session, lattice.axes, places, time);
    const volume::Channel known = info.channel(channel);
    const vis::Scene scene = sceneOf(session);
    const vis::TransferFunction& function = vis::transferFor(scene, wall.transfer.empty() ? known.name : wall.transfer);
    const Range range = vis::effectiveRange(function, info.channelRange(known));
    const vis::WorldFrame world = vis::worldFrame(info, session.stretch);
    const double step = 2 * world.halfSize[face.axis] / double(places.size());
    double sum = 0, most = -std::numeric_limits<double>::infinity(), through = 1;
    int count = 0;
    for (const volume::ProbeValue& each : volume::probeAlong(source, channel, places, time)) {
        if (!each.interpolated) continue;
        ++count;
        sum += *each.interpolated;
        most = std::max(most, *each.interpolated);
        if (kind == WallKind::XRay || kind == WallKind::Volume)
            through *= 1 - vis::correctedOpacity(vis::evaluate(function, range, *each.interpolated).a, step, 1);
    }
    if (count == 0) return std::nullopt;
    return kind == WallKind::Mean ? sum / count : kind == WallKind::Maximum ? most : 1 - through;
}

vis::BoxRegion prism(const CubeFace& face, glm::dvec3 from, glm::dvec3 to, const volume::Box& bounds) {
    from[face.axis] = bounds.lo[face.axis];
    to[face.axis] = bounds.hi[face.axis];
    const glm::dvec3 a = glm::clamp(from, bounds.lo, bounds.hi), b = glm::clamp(to, bounds.lo, bounds.hi);
    vis::BoxRegion region;
    region.center = (a + b) / 2.0;
    region.radius = glm::max(glm::abs(b - a) / 2.0, 1e-9 * bounds.size());
    // Slightly beyond the data, so that samples on the faces of their box are inside.
    region.radius[face.axis] *= 1.001;
    return region;
}

} // namespace tessera::app
