#include "volume/four/space_time_surfaces.h"

#include "volume/four/hyperplane_cut.h"
#include "volume/four/isosurface4.h"
#include "volume/mesh/isosurface.h"

#include <algorithm>
#include <glm/common.hpp>
#include <utility>

namespace tessera::volume {

namespace {

constexpr double kMostSamplesInTime = 3e7; ///< of all times

std::size_t meshBytes(const TetraMesh& mesh) {
    return mesh.points.size() * sizeof(glm::dvec4) + mesh.tetrahedra.size() * sizeof(glm::uvec4);
}

/// Samples as surfaces of them reach the bounds of the data.
SampleGrid samplesUpToBounds(const BrickSource& source, int channel, int time, int level, const Progress& progress) {
    SampleGrid grid = readSamples(source, channel, time, level, progress);
    return spans(grid, source.info().bounds) ? grid : padded(grid);
}

/// Triangles in space whose scalars are how long after `begin` their vertices are.
SurfaceMesh cutInSpace(const TriangleMesh4& cut, const Box& bounds, double begin) {
    SurfaceMesh mesh;
    mesh.origin = originFor(bounds);
    for (const glm::dvec4& point : cut.points) {
        mesh.positions.emplace_back(glm::dvec3(point) - mesh.origin);
        mesh.scalars.push_back(float(point.w - begin));
    }
    mesh.triangles = cut.triangles;
    clipToBox(mesh, bounds);
    return mesh;
}

/// The triangles with their vertices elsewhere, without scalars.
template <class Place> SurfaceMesh movedTo(const SurfaceMesh& mesh, const Place& place) {
    std::vector<glm::dvec3> places;
    Box box{glm::dvec3(0), glm::dvec3(0)};
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        places.push_back(place(i));
        box = i == 0 ? Box{places[0], places[0]} : Box{glm::min(box.lo, places[i]), glm::max(box.hi, places[i])};
    }
    SurfaceMesh out;
    out.origin = originFor(box);
    for (const glm::dvec3& at : places) out.positions.emplace_back(at - out.origin);
    out.triangles = mesh.triangles;
    out.normals = faceNormals(out);
    return out;
}

/// Whether triangles that are oriented in four dimensions (cutByHyperplane) run the other way round at the positions
/// of a plane's data.
bool runsBackwards(const SpaceTimePlane& plane) {
    const double along = plane.normal[plane.solved];
    if (!plane.hasTimeAxis()) return along < 0;
    return (along > 0) != (plane.timePerLength < 0);
}

} // namespace

bool SpaceTimeSurfaces::Key::operator==(const Key& other) const {
    const bool alike = !source.owner_before(other.source) && !other.source.owner_before(source);
    return alike && channel == other.channel && level == other.level && value == other.value && first == other.first &&
           last == other.last;
}

SpaceTimeSurfaces::Key SpaceTimeSurfaces::around(const std::shared_ptr<const BrickSource>& source, int channel,
                                                 double value, const TimePair& time, int level) {
    const int first = std::clamp(time.earlier, 0, std::max(0, int(source->info().times.size()) - 2));
    return {source, channel, level, value, first, first + 1};
}

std::shared_ptr<const TetraMesh> SpaceTimeSurfaces::find(const Key& key) const {
    const std::lock_guard lock(mutex_);
    const auto found = std::ranges::find(kept_, key, &Kept::key);
    return found == kept_.end() ? nullptr : found->mesh;
}

bool SpaceTimeSurfaces::keeps(const std::shared_ptr<const BrickSource>& source, int channel, double value,
                              const TimePair& time, int level) const {
    return find(around(source, channel, value, time, level)) != nullptr;
}

std::shared_ptr<const TetraMesh> SpaceTimeSurfaces::meshOf(const BrickSource& source, const Key& key,
                                                           const Progress& progress) {
    if (auto known = find(key)) return known;
    const std::vector<double>& all = source.info().times;
    const std::vector<double> times(all.begin() + key.first, all.begin() + key.last + 1);
    const Progress inner{{}, progress.stop};
    auto made = std::make_shared<const TetraMesh>(extractIsosurface4(
        times, [&](int time) { return samplesUpToBounds(source, key.channel, key.first + time, key.level, inner); },
        key.value, progress));
    const std::lock_guard lock(mutex_);
    std::erase_if(kept_, [&](const Kept& old) { return old.key == key || old.key.source.expired(); });
    kept_.push_front({key, made});
    std::size_t used = 0;
    std::erase_if(kept_, [&](const Kept& old) {
        used += meshBytes(*old.mesh);
        return used > budget_ && old.mesh != made;
    });
    return made;
}

SurfaceMesh SpaceTimeSurfaces::atTime(const std::shared_ptr<const BrickSource>& source, int channel, double value,
                                      const TimePair& time, const AxisMaps& axes, int level, const Progress& progress) {
    const std::vector<double>& times = source->info().times;
    if (times.size() < 2) return {};
    const auto mesh = meshOf(*source, around(source, channel, value, time, level), progress.part(0, 0.9));
    const SurfaceMesh cut =
        cutInSpace(cutByHyperplane(*mesh, {0, 0, 0, 1}, timeAt(times, time)), source->info().bounds, times.front());
    progress.advance(1);
    return movedTo(cut, [&](std::size_t i) { return axes.toSheet(placeOf(cut, i)); });
}

SurfaceMesh SpaceTimeSurfaces::inPlane(const std::shared_ptr<const BrickSource>& source, int channel, double value,
                                       const SpaceTimePlane& plane, const AxisMaps& axes, int level,
                                       const Progress& progress) {
    const std::vector<double>& times = source->info().times;
    if (times.size() < 2) return {};
    const Key whole{source, channel, level, value, 0, int(times.size()) - 1};
    const auto mesh = meshOf(*source, whole, progress.part(0, 0.9));
    SurfaceMesh cut = cutInSpace(cutByHyperplane(*mesh, plane.normal, -plane.e), source->info().bounds, times.front());
    if (runsBackwards(plane))
        for (glm::uvec3& triangle : cut.triangles) std::swap(triangle.y, triangle.z);
    progress.advance(1);
    return movedTo(cut, [&](std::size_t i) {
        return axes.toSheet(plane.positionOf({placeOf(cut, i), times.front() + double(cut.scalars[i])}));
    });
}

int levelOfSpaceTime(const BrickGrid& grid, int times) {
    return grid.levelWithin(kMostSamplesInTime / std::max(1, times));
}

} // namespace tessera::volume
