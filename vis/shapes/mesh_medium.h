#pragma once

#include "vis/optics/light_volume.h"
#include "vis/scene/scene.h"
#include "volume/field/dataset.h"

#include <memory>
#include <stop_token>
#include <vector>

/// Meshes as extinction of a light volume: they cast shadows on volumes and on each other.
namespace tessera::vis {

/// The geometry of a scene that casts shadows: everything drawn that has triangles; lines cast none. Brushes and looks
/// do not affect shadows.
struct MeshCasters {
    struct Caster {
        std::shared_ptr<const Geometry> geometry;
        TransferFunction function; ///< colours of the scalars
        Range range;
        glm::dvec3 color{1}; ///< linear; for meshes without scalars
        bool scalars = false;
        double opacity = 1;
        int lens = -1; ///< index of the lens that it is drawn in
    };
    std::vector<Caster> casters;
    std::vector<PlacedClip> clips;
    std::vector<PlacedLens> lenses;
    WorldFrame frame;
};
/// Empty if the scene's shadows exclude meshes.
MeshCasters meshCasters(const Scene& scene, const volume::DatasetInfo& info);

/// The extinction of the meshes. Triangles are subdivided into equal parts with edges of at most half a cell; each part
/// adds -ln(1 - min(opacity, kThickest)) times its area over a cell's volume to the cells around its centroid, with
/// trilinear weights, so that integrated along the normal of a flat surface it gives the opacity. Parts with a clipped
/// centroid are left out; lenses act as on the surface. Stops early, with an undefined result, when the token asks.
template <class Number>
Medium<Number> meshMedium(const LightGrid& grid, const MeshCasters& casters, std::stop_token stop = {});

extern template Medium<float> meshMedium(const LightGrid&, const MeshCasters&, std::stop_token);
extern template Medium<double> meshMedium(const LightGrid&, const MeshCasters&, std::stop_token);

} // namespace tessera::vis
