#pragma once

#include "app/session/views/contour_settings.h"
#include "app/session/views/view_kind.h"
#include "vis/scene/camera.h"
#include "vis/scene/layers.h"
#include "vis/scene/stereo.h"
#include "volume/analysis/samples4.h"
#include "volume/base/data_units.h"
#include "volume/base/describe.h"

#include <array>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

/// The saved state of views of the scene and of the data in space and time.
namespace tessera::app {

struct VolumeView {
    static constexpr std::string_view kType = "volume";
    bool showBox = true, showAxes = true, showLegend = true, showCursor = true, showGizmo = true, showScaleBar = true,
         showLenses = true, showLights = false, showCallouts = true;
    bool drawingLegend = false, drawingBox = false;
    bool inSpace = false; ///< where time runs along an axis: the data that are cut
    vis::Stereo stereo;
    // Of its own, in place of the session's; see ShownScene.
    std::optional<vis::Camera> camera;
    std::optional<std::vector<vis::Layer>> layers;
    std::optional<double> time;
    bool multiple = false;
    bool operator==(const VolumeView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.showBox, FieldInfo{"box", "Draw the box around the data"});
        visit(self.showAxes, FieldInfo{"axes", "Draw axes with ticks and units"});
        visit(self.showLegend, FieldInfo{"legend", "Draw colour legends"});
        visit(self.drawingLegend,
              FieldInfo{.key = "drawingLegend",
                        .doc = "Legends of layers drawn in charcoal or chalk too, although their colours are not shown",
                        .applies = self.showLegend});
        visit(self.drawingBox,
              FieldInfo{.key = "drawingBox",
                        .doc = "Box and cross-hair also where all layers are drawn on paper in charcoal, ink or chalk",
                        .applies = self.showBox || self.showCursor});
        visit(self.showCursor, FieldInfo{"cursor", "Draw the linked cross-hair"});
        visit(self.showGizmo, FieldInfo{"gizmo", "Draw the axis triad; a click on an axis looks along it"});
        visit(self.showScaleBar, FieldInfo{"scaleBar", "Draw a scale bar"});
        visit(self.showLenses, FieldInfo{"lenses", "Draw outlines of lenses and planes, and handles"});
        visit(self.showLights, FieldInfo{.key = "lights",
                                         .doc = "Draw lights as arrows and points that can be dragged",
                                         .applies = self.showLenses});
        visit(self.showCallouts, FieldInfo{"callouts", "Draw callouts: details beside the volume"});
        visit(self.inSpace,
              FieldInfo{"inSpace", "With time along an axis: show the data in space, at the time of the "
                                   "cross-hair, with the outline of the plane that is shown at all times"});
        visit(self.stereo, FieldInfo{"stereo", "Pictures for both eyes"});
        visit(self.camera, FieldInfo{"camera", "Camera of this view alone; none: the one that all volume views share"});
        visit(self.layers, FieldInfo{"layers", "Layers of this view alone; none: those that all volume views share"});
        visit(self.time, FieldInfo{.key = "time",
                                   .doc = "Time of this view alone; none: that of the session",
                                   .unit = kUnitOfTimes});
        visit(self.multiple, FieldInfo{.key = "multiple",
                                       .doc = "One of small multiples, which give way to the next ones",
                                       .hidden = true});
    }
};
DrawView<VolumeView> drawVolumeView;

struct SlicesView {
    static constexpr std::string_view kType = "slices";
    std::string channel; ///< "" = the channel of the first layer
    ContourSettings lines;
    vis::Strokes strokes = {};
    bool showReadout = true;
    bool operator==(const SlicesView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel, FieldInfo{.key = "channel", .doc = "Parameter shown", .refersTo = "channel"});
        ContourSettings::describe(self.lines, visit);
        visit(self.strokes, vis::strokesField());
        visit(self.showReadout, FieldInfo{"readout", "List the value of every parameter at the cross-hair"});
    }
};
DrawView<SlicesView> drawSlicesView;

/// What a face of the cube shows of its parameter, along the axis that the face stands on.
enum class WallKind { Slice, Mean, Maximum, XRay, Shadow, Volume };
inline constexpr std::string_view kWallKindNames[] = {"slice", "mean", "maximum", "xray", "shadow", "volume"};

struct Wall {
    std::string channel = {}; ///< "" = the channel of the first layer
    WallKind kind = WallKind::Mean;
    std::string transfer = {}; ///< name of its own transfer function; "": that of its channel
    int contours = 0;          ///< contour lines of a slice
    vis::Look look = {};       ///< of a volume
    bool lenses = false;       ///< with what lenses do to it
    bool operator==(const Wall&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel, FieldInfo{.key = "channel", .doc = "Parameter shown", .refersTo = "channel"});
        visit(self.kind,
              FieldInfo{.key = "kind",
                        .doc = "Projection along the axis: slice at the cross-hair, mean, maximum, "
                               "absorption by the transfer function, shadow of the selection, or all of it as a volume",
                        .names = kWallKindNames});
        visit(self.transfer,
              FieldInfo{"transfer", "Name of the transfer function of this face alone; empty: that of its parameter"});
        visit(self.contours, FieldInfo{.key = "contours",
                                       .doc = "Number of contour lines, 0 = none",
                                       .range = Range{0, 50},
                                       .applies = self.kind == WallKind::Slice});
        visit(self.lenses, FieldInfo{.key = "lenses",
                                     .doc = "Show on this face what lenses do, and what is drawn inside of them",
                                     .applies = self.kind != WallKind::Shadow});
        visit(self.look, vis::lookField(self.kind == WallKind::Volume));
    }
};

/// The scene in a cube on whose inner faces, those turned to the viewer, parameters are projected.
struct ShadowCubeView {
    static constexpr std::string_view kType = "shadowCube";
    Wall left, right{.kind = WallKind::Slice}, bottom, top{.kind = WallKind::Slice}, back,
        front{.kind = WallKind::Slice}; ///< at the lower and upper end of x, y and z
    float gap = 0.22f, zoom = 1;
    glm::vec3 target{0};
    bool together = true;
    glm::quat orientation{1, 0, 0, 0};
    bool showAxes = true;
    bool brushing = false;
    bool operator==(const ShadowCubeView&) const = default;
    /// Its faces, in this order.
    static auto walls(auto& self) {
        return std::array{&self.left, &self.right, &self.bottom, &self.top, &self.back, &self.front};
    }
    static void describe(auto& self, auto&& visit) {
        visit(self.left, FieldInfo{"left", "Face at the lower end of x"});
        visit(self.right, FieldInfo{"right", "Face at the upper end of x"});
        visit(self.bottom, FieldInfo{"bottom", "Face at the lower end of y"});
        visit(self.top, FieldInfo{"top", "Face at the upper end of y"});
        visit(self.back, FieldInfo{"back", "Face at the lower end of z"});
        visit(self.front, FieldInfo{"front", "Face at the upper end of z"});
        visit(self.gap, FieldInfo{.key = "gap",
                                  .doc = "Distance from the data to the faces; longest edge = 1",
                                  .range = Range{0, 1}});
        visit(self.zoom, FieldInfo{.key = "zoom",
                                   .doc = "Magnification; at 1 the whole cube is in the picture",
                                   .range = Range{0.2, 10},
                                   .logScale = true});
        visit(self.target,
              FieldInfo{.key = "target", .doc = "World point in the middle of the picture", .hidden = true});
        visit(self.together, FieldInfo{"together", "Turn cube and data together; else each by itself"});
        visit(self.orientation, FieldInfo{.key = "orientation",
                                          .doc = "Rotation of the cube while it is turned by itself",
                                          .hidden = true});
        visit(self.showAxes, FieldInfo{"axes", "Draw axes with ticks and units at the edges of the cube"});
        visit(self.brushing, FieldInfo{"brushing", "Select the prism behind a face by dragging on the face"});
    }
};
DrawView<ShadowCubeView> drawShadowCubeView;

/// What colours the points of a tesseract.
enum class TesseractColor { Value, Fourth };
inline constexpr std::string_view kTesseractColorNames[] = {"value", "fourth"};

/// What a drag with the left button over a tesseract does.
enum class TesseractHand { Turn, Box, Lasso };
inline constexpr std::string_view kTesseractHandNames[] = {"turn", "box", "lasso"};

/// A light in four dimensions, fixed to the picture.
struct TesseractLight {
    bool on = false;
    glm::vec4 direction{-0.4f, 0.5f, 0.6f, 0.5f};
    float ambient = 0.25f;
    bool operator==(const TesseractLight&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.on,
              FieldInfo{"on", "Shade points by a light in four dimensions: by the gradient of the parameter in "
                              "space and time or, with a parameter along the fourth axis, by its slope"});
        visit(self.direction,
              FieldInfo{.key = "direction",
                        .doc = "Towards the light: to the right, up, towards the viewer, and towards the eye in the "
                               "fourth dimension",
                        .range = Range{-1, 1},
                        .applies = self.on});
        visit(self.ambient, FieldInfo{.key = "ambient",
                                      .doc = "Share of the light that comes from everywhere",
                                      .range = Range{0, 1},
                                      .applies = self.on});
    }
};

/// The field in four and more dimensions, turned in all planes: splatted samples in a wire tesseract.
struct TesseractView {
    static constexpr std::string_view kType = "tesseract";
    std::string channel;           ///< "" = the channel of the first layer
    std::string fourth;            ///< parameter along the fourth axis at the session's time; "" = time itself
    std::vector<std::string> more; ///< parameters along the fifth to the eighth axis
    TesseractColor colorBy = TesseractColor::Value;
    glm::vec3 turn{0, -32, 22}, turn4{0, 0, 0};
    std::vector<float> turnMore; ///< planes of the fifth axis and on, in the order of vis::planeIndex; missing: 0
    std::vector<float> stretch;  ///< of each axis; missing: 1
    float eye = 1.8f, zoom = 1;
    bool parallel = false;
    float radius = 3;
    float density = 1;
    int points = 150000;
    volume::SampleLattice samples = volume::SampleLattice::Stored;
    bool cube = true;
    bool showWire = true, showNow = true, showLegend = true, showControls = true;
    int lattice = 0;
    bool tour = false;
    float tourSpeed = 12;
    TesseractHand hand = TesseractHand::Turn;
    TesseractLight light;
    vis::Stereo stereo;
    bool operator==(const TesseractView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel, FieldInfo{.key = "channel", .doc = "Parameter shown", .refersTo = "channel"});
        visit(self.fourth, FieldInfo{.key = "fourth",
                                     .doc = "Parameter along the fourth axis, at the time shown; empty: time itself",
                                     .refersTo = "optionalChannel"});
        visit(self.more, FieldInfo{.key = "more",
                                   .doc = "Parameters along further axes, the fifth to the eighth",
                                   .refersTo = "channel"});
        visit(self.colorBy, FieldInfo{.key = "colorBy",
                                      .doc = "Colour points by their value or by the fourth axis",
                                      .names = kTesseractColorNames});
        const Range turn{-180, 180};
        visit(self.turn, FieldInfo{.key = "turn",
                                   .doc = "Rotation in the planes xy, xz, yz, in this order",
                                   .unit = "deg",
                                   .range = turn});
        visit(self.turn4, FieldInfo{.key = "turn4",
                                    .doc = "Rotation in the planes xw, yw, zw, after the others; w is the fourth axis",
                                    .unit = "deg",
                                    .range = turn});
        visit(self.turnMore,
              FieldInfo{.key = "turnMore",
                        .doc = "Rotation in the planes of the fifth axis with each one before it, then of "
                               "the sixth, and so on, after the others; missing: 0",
                        .unit = "deg",
                        .range = turn,
                        .hidden = true});
        visit(self.stretch, FieldInfo{.key = "stretch",
                                      .doc = "Factor on the length of each axis, in their order; missing: 1",
                                      .range = Range{0.1, 10},
                                      .logScale = true,
                                      .hidden = true});
        visit(self.eye, FieldInfo{.key = "eye",
                                  .doc = "Distance of the eye along the fourth axis, in radii of the tesseract",
                                  .unit = "radius",
                                  .range = Range{1.1, 20},
                                  .logScale = true,
                                  .applies = !self.parallel});
        visit(self.parallel, FieldInfo{"parallel", "Parallel projection: nothing is larger for being near; brushes "
                                                   "are drawn in it"});
        visit(self.zoom, FieldInfo{.key = "zoom",
                                   .doc = "Magnification; at 1 the tesseract fits at any angle",
                                   .range = Range{0.2, 10},
                                   .logScale = true});
        visit(self.radius,
              FieldInfo{.key = "radius", .doc = "Radius of a splat", .unit = "pixel", .range = Range{0.5, 20}});
        visit(self.density,
              FieldInfo{.key = "density", .doc = "Opacity of the points", .range = Range{0.01, 20}, .logScale = true});
        visit(self.points, FieldInfo{.key = "points",
                                     .doc = "Largest number of samples drawn",
                                     .range = Range{1000, 2000000},
                                     .logScale = true});
        visit(self.samples, FieldInfo{.key = "samples",
                                      .doc = "Samples drawn: all of each time, or only the half that forms a D4* "
                                             "lattice in space and time",
                                      .names = volume::kSampleLatticeNames});
        visit(self.cube, FieldInfo{"cube", "Draw all axes equally long; else in the proportions of the 3D view"});
        visit(self.showWire, FieldInfo{"wire", "Draw the edges of the tesseract"});
        visit(self.showNow, FieldInfo{"now", "Draw the cell of the time shown"});
        visit(self.showLegend, FieldInfo{"legend", "Draw colour legends"});
        visit(self.showControls, FieldInfo{"controls", "Show a slider for each plane"});
        visit(
            self.lattice,
            FieldInfo{.key = "lattice", .doc = "Lattice cells drawn along each axis; 0 = none", .range = Range{0, 8}});
        visit(self.tour, FieldInfo{"tour", "Keep turning in two planes at once"});
        visit(self.tourSpeed, FieldInfo{.key = "tourSpeed",
                                        .doc = "Speed of the tour",
                                        .unit = "deg/s",
                                        .range = Range{1, 90},
                                        .applies = self.tour});
        visit(self.hand, FieldInfo{.key = "hand",
                                   .doc = "What a drag with the left button does: turn, or select by a box or a lasso",
                                   .names = kTesseractHandNames});
        visit(self.light, FieldInfo{"light", "Light in four dimensions"});
        visit(self.stereo, FieldInfo{"stereo", "Pictures for both eyes"});
    }
};
DrawView<TesseractView> drawTesseractView;

} // namespace tessera::app
