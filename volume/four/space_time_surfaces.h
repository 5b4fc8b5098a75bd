#pragma once

#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"
#include "volume/field/space_time_plane.h"
#include "volume/field/time_pair.h"
#include "volume/four/tetra_mesh.h"
#include "volume/mesh/surface_mesh.h"

#include <cstddef>
#include <list>
#include <memory>
#include <mutex>

namespace tessera::volume {

/// Surfaces in space and time (isosurface4.h) and what they are cut into: the surface of a time between stored ones,
/// and that of a tilted plane. The meshes of tetrahedra are kept for the next cuts, of a time only what lies between
/// the two stored times around it, so that a cut needs neither samples nor a search. Thread-safe.
class SpaceTimeSurfaces {
public:
    /// `bytes`: of meshes that are kept, and the last one whatever its size.
    explicit SpaceTimeSurfaces(std::size_t bytes = std::size_t(512) << 20) : budget_(bytes) {}

    /// The surface of a channel at a time, from samples of a level of detail, up to the bounds of the data, as those of
    /// extractIsosurface. Positions are those of the sheet of `axes`. Beyond the first and the last time that of the
    /// nearest. Data of one time have none. Throws Error, Cancelled.
    SurfaceMesh atTime(const std::shared_ptr<const BrickSource>& source, int channel, double value,
                       const TimePair& time, const AxisMaps& axes, int level, const Progress& progress = {});
    /// The surface in a plane, at the positions of the plane's data (SpaceTimePlane::positionOf), its normals pointing
    /// to lower values there. `axes`: of these data, as above.
    SurfaceMesh inPlane(const std::shared_ptr<const BrickSource>& source, int channel, double value,
                        const SpaceTimePlane& plane, const AxisMaps& axes, int level, const Progress& progress = {});
    /// Whether the mesh that atTime() cuts is kept.
    bool keeps(const std::shared_ptr<const BrickSource>& source, int channel, double value, const TimePair& time,
               int level) const;

private:
    struct Key {
        std::weak_ptr<const BrickSource> source;
        int channel = 0, level = 0;
        double value = 0;
        int first = 0, last = 0; ///< times
        bool operator==(const Key& other) const;
    };
    struct Kept {
        Key key;
        std::shared_ptr<const TetraMesh> mesh;
    };
    static Key around(const std::shared_ptr<const BrickSource>& source, int channel, double value, const TimePair& time,
                      int level);
    std::shared_ptr<const TetraMesh> find(const Key& key) const;
    std::shared_ptr<const TetraMesh> meshOf(const BrickSource& source, const Key& key, const Progress& progress);

    std::size_t budget_;
    mutable std::mutex mutex_;
    std::list<Kept> kept_; ///< newest first
};

/// The finest level of detail that a surface in space and time is made of, for `times` of them at once: beyond that
/// many samples it would take minutes and gigabytes.
int levelOfSpaceTime(const BrickGrid& grid, int times);

} // namespace tessera::volume
