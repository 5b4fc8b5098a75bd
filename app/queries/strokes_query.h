#pragma once

#include "app/queries/async_query.h"
#include "vis/optics/ray_setup.h"
#include "volume/field/time_pair.h"

#include <memory>
#include <string>

/// Strokes in slices (vis/lic), computed in the background and kept for a while.
namespace tessera::app {

/// What decides the strokes of a slice; how strong they are drawn is left out.
struct StrokesQuery {
    vis::Strokes strokes;
    volume::TimePair time;
    glm::dvec3 normal{0, 0, 1}; ///< of its plane, world
    double offset = 0;
    glm::dvec3 stretch{1};
    bool operator==(const StrokesQuery&) const = default;
};

class AsyncStrokes {
public:
    /// Adds the strokes of a scene's visible slices as far as they are made; while those of a place are not, those of
    /// the plane shown before it. Sets context.answers.awaiting while better ones are on their way; headless, makes
    /// them to the end. A failure is reported once and leaves the strokes out. `place`: what shows the scene.
    void addTo(ViewContext& context, vis::Scene& scene, const std::string& place);

private:
    using Query = AsyncQuery<StrokesQuery, std::shared_ptr<const vis::StrokePicture>>;
    static Query::Keep keep();
    Query query_{keep()};
};

} // namespace tessera::app
