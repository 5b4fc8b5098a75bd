#pragma once

#include "vis/scene/camera.h"
#include "volume/base/describe.h"

/// Pictures for both eyes.
namespace tessera::vis {

enum class StereoKind { Off, SideBySide, Anaglyph };
inline constexpr std::string_view kStereoKindNames[] = {"off", "sideBySide", "anaglyph"};

enum class Eye { Left, Right };

struct Stereo {
    StereoKind kind = StereoKind::Off;
    float eyeDistance = 0.06f; ///< in distances of the eye from the middle
    float convergence = 1;     ///< distance at which both eyes see the same, likewise
    bool crossed = false;
    bool operator==(const Stereo&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.kind, FieldInfo{.key = "kind",
                                   .doc = "A picture for each eye: side by side, or in one for glasses with a red left "
                                          "and a cyan right filter; without depth of field",
                                   .names = kStereoKindNames});
        const bool on = self.kind != StereoKind::Off;
        visit(self.eyeDistance,
              FieldInfo{.key = "eyeDistance",
                        .doc = "Distance between the eyes, as a share of their distance from the middle of the data",
                        .range = Range{0, 0.3},
                        .applies = on});
        visit(self.convergence,
              FieldInfo{.key = "convergence",
                        .doc = "Distance of what lies in the plane of the screen, as a share of the distance of the "
                               "middle of the data; what is nearer stands before the screen",
                        .range = Range{0.3, 3},
                        .logScale = true,
                        .applies = on});
        visit(self.crossed, FieldInfo{.key = "crossed",
                                      .doc = "Side by side with the picture of the left eye at the right, for looking "
                                             "cross-eyed",
                                      .applies = self.kind == StereoKind::SideBySide});
    }
    bool on() const { return kind != StereoKind::Off; }
    /// How far an eye lies to the right of the middle between both, in distances of the eye from the middle.
    double aside(Eye eye) const { return (eye == Eye::Left ? -0.5 : 0.5) * double(eyeDistance); }
};

/// The camera of one eye: moved aside, with parallel directions of view and frusta that share the plane of convergence
/// (off-axis projection, so that nothing is displaced upwards). Without depth of field.
Camera eyeCamera(Camera camera, const Stereo& stereo, Eye eye);

} // namespace tessera::vis
