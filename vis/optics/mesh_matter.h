#pragma once

#include "vis/optics/light_volume.h"
#include "vis/scene/scene.h"
#include "volume/field/dataset.h"

#include <memory>
#include <stop_token>
#include <vector>

/// Surfaces of polygons as matter of a light volume: they cast shadows on the volumes around them, and on each other.
namespace tessera::vis {

/// What of a scene's geometry stands in the way of light: everything drawn that has triangles (lines cast no shadow).
/// Brushes and looks leave shadows as they are.
struct MeshCasters {
    struct Caster {
        std::shared_ptr<const Geometry> geometry;
        TransferFunction function; ///< colours the scalars
        Range range;
        glm::dvec3 color{1}; ///< linear; where there are no scalars
        bool scalars = false;
        double opacity = 1;
        int lens = -1; ///< that it is drawn in
    };
    std::vector<Caster> casters;
    std::vector<PlacedClip> clips;
    std::vector<PlacedLens> lenses;
    WorldFrame frame;
};
/// None where the scene's shadows leave meshes out.
MeshCasters meshCasters(const Scene& scene, const volume::DatasetInfo& info);

/// Their matter: triangles are cut into equal parts with edges of at most half a cell; each adds -ln(1 - min(opacity,
/// kThickest)) times its area over a cell's volume to the cells around its middle, by trilinear weights, so that along
/// the normal of a flat surface it adds up to the opacity. A part whose middle is clipped casts none; lenses act as on
/// the surface. Stops early, with an undefined result, when the token asks.
template <class Number>
Matter<Number> meshMatter(const LightGrid& grid, const MeshCasters& casters, std::stop_token stop = {});

extern template Matter<float> meshMatter(const LightGrid&, const MeshCasters&, std::stop_token);
extern template Matter<double> meshMatter(const LightGrid&, const MeshCasters&, std::stop_token);

} // namespace tessera::vis
