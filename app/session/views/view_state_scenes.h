#pragma once

#include "app/session/views/contour_settings.h"
#include "app/session/views/view_kind.h"
#include "vis/scene/camera.h"
#include "vis/scene/layers.h"
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
    bool showReadout = true;
    bool operator==(const SlicesView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel, FieldInfo{.key = "channel", .doc = "Parameter shown", .refersTo = "channel"});
        ContourSettings::describe(self.lines, visit);
        visit(self.showReadout, FieldInfo{"readout", "List the value of every parameter at the cross-hair"});
    }
};
DrawView<SlicesView> drawSlicesView;

/// What a face of the cube shows of its parameter, along the axis that the face stands on.
enum class WallKind { Slice, Mean, Maximum, XRay, Shadow };
inline constexpr std::string_view kWallKindNames[] = {"slice", "mean", "maximum", "xray", "shadow"};

struct Wall {
    std::string channel = {}; ///< "" = the channel of the first layer
    WallKind kind = WallKind::Mean;
    std::string transfer = {}; ///< name of its own transfer function; "": that of its channel
    bool operator==(const Wall&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel, FieldInfo{.key = "channel", .doc = "Parameter shown", .refersTo = "channel"});
        visit(self.kind, FieldInfo{.key = "kind",
                                   .doc = "Projection along the axis: slice at the cross-hair, mean, maximum, "
                                          "absorption by the transfer function, or shadow of the selection",
                                   .names = kWallKindNames});
        visit(self.transfer,
              FieldInfo{"transfer", "Name of the transfer function of this face alone; empty: that of its parameter"});
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

/// The field in four dimensions, turned in six planes: splatted samples in a wire tesseract.
struct TesseractView {
    static constexpr std::string_view kType = "tesseract";
    std::string channel; ///< "" = the channel of the first layer
    std::string fourth;  ///< parameter along the fourth axis at the session's time; "" = time itself
    TesseractColor colorBy = TesseractColor::Value;
    glm::vec3 turn{0, -32, 22}, turn4{0, 0, 0};
    float eye = 1.8f, zoom = 1;
    float radius = 3;
    float density = 1;
    int points = 150000;
    bool cube = true;
    bool showWire = true, showNow = true, showLegend = true, showControls = true;
    int lattice = 0;
    bool tour = false;
    float tourSpeed = 12;
    bool operator==(const TesseractView&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel, FieldInfo{.key = "channel", .doc = "Parameter shown", .refersTo = "channel"});
        visit(self.fourth, FieldInfo{.key = "fourth",
                                     .doc = "Parameter along the fourth axis, at the time shown; empty: time itself",
                                     .refersTo = "optionalChannel"});
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
        visit(self.eye, FieldInfo{.key = "eye",
                                  .doc = "Distance of the eye along the fourth axis, in radii of the tesseract",
                                  .unit = "radius",
                                  .range = Range{1.1, 20},
                                  .logScale = true});
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
    }
};
DrawView<TesseractView> drawTesseractView;

} // namespace tessera::app
