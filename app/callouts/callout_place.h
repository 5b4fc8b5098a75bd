#pragma once

#include "app/session/session.h"
#include "vis/scene/camera.h"

#include <optional>
#include <string>

/// The placeholders of callouts in the world (vis/scene/camera.h), and the scenes that are cut to them.
namespace tessera::app {

/// What a callout shows: a body, or a plane.
struct CalloutPlace {
    std::string name;     ///< of the lens, the brush, or of the plane
    glm::vec3 color{1};   ///< of its outline, sRGB; of planes white
    glm::dvec3 center{0}; ///< world; of a plane the middle of its part in the box
    glm::dvec3 half{0};   ///< half the edges of the box around a body, of that of the data for a plane; world
    bool ball = false;    ///< it is one of radius half.x
    std::optional<vis::Lens> shape = {};        ///< cuts to a body that is neither a ball nor a box along the axes
    std::optional<glm::dvec3> normal = {};      ///< of a plane, on the sheet of the axes
    std::optional<volume::SpaceAxis> axis = {}; ///< across which a plane lies
    std::optional<vis::Region> region = {};     ///< whose samples a body holds
    std::optional<vis::Brush> alone = {};       ///< a brush of values: shown alone, in the whole box
    bool operator==(const CalloutPlace&) const = default;

    /// Of the ball around it, world.
    double radius() const;
};

/// Nothing where there is no such lens, brush or pane, or it is off. A disc, which reaches through the whole depth, has
/// the ball in its middle. A brush of values has the box of the data.
std::optional<CalloutPlace> calloutPlace(const Session& session, const volume::DatasetInfo& info,
                                         const Callout& callout);

/// The view's camera as a scene is seen in a callout: turned as that says, the placeholder in the middle, as large as
/// fits.
vis::Camera calloutCamera(const vis::Camera& view, const Callout& callout, const CalloutPlace& place, double aspect);

/// The scene of a view cut to the placeholder of a callout and seen by its camera, without box, ground and shadows of
/// what is cut away; of a plane all that lies behind it.
vis::Scene calloutScene(vis::Scene scene, const Callout& callout, const CalloutPlace& place,
                        const vis::WorldFrame& world, double aspect);

/// While it lives, layers and time of the session are those of a callout, as far as it has its own.
class ShownCallout {
public:
    ShownCallout(Session& session, Callout& callout) : session_(session), callout_(callout) { swap(); }
    ~ShownCallout() { swap(); }
    ShownCallout(const ShownCallout&) = delete;
    ShownCallout& operator=(const ShownCallout&) = delete;

private:
    void swap();

    Session& session_;
    Callout& callout_;
};

} // namespace tessera::app
