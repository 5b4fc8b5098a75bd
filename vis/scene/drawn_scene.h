#pragma once

#include "vis/scene/scene.h"
#include "volume/field/dataset.h"

#include <optional>
#include <string>
#include <vector>

/// What a scene draws of the data. What its layers leave open is decided here, once for all engines.
namespace tessera::vis {

/// A channel that is drawn, and the function that its values are looked up in.
struct DrawnChannel {
    int channel = 0;           ///< index into DatasetInfo::channels()
    bool categorical = false;  ///< labels, which are never interpolated
    std::string transfer = {}; ///< name of a function of a layer's own; "": that of the channel
    double timeShift = 0;      ///< in the unit of the times of the data, added to the time of the scene
    const TransferFunction* function = nullptr;
    Range range = {}; ///< of the function
};

/// The channel with the function of that name, "": its own. It refers to the scene.
DrawnChannel drawnChannel(const Scene& scene, const volume::DatasetInfo& info, int channel,
                          const std::string& transfer = {}, double timeShift = 0);

/// A layer that rays meet.
struct DrawnLayer {
    int layer = 0; ///< index into Scene::layers
    /// Its technique: one of these. They refer to the scene.
    const VolumeLayer* volume = nullptr;
    const IsoLayer* surface = nullptr;
    const SliceLayer* slice = nullptr;
    const Look* look = nullptr; ///< of a volume that is composited or a surface
    int lens = -1;              ///< index into DrawnScene::lenses of that which it is drawn in, -1: everywhere
    BrushEffect brushes = BrushEffect::Fade;
    DrawnChannel shown;
    std::optional<DrawnChannel> colors = {}; ///< the channel that colours it instead of its own
    /// Of volumes that are composited by value; others and labels are classified after interpolation.
    Classification classification = Classification::Post;
    bool byRegions = false; ///< classified by regions of value and gradient magnitude
    bool gradient = false;  ///< shows the gradient magnitude
    bool shaded = false;    ///< by the gradient of its values, which labels do not have
};

struct DrawnScene {
    std::vector<PlacedLens> lenses;
    std::vector<DrawnLayer> layers; ///< in the order of Scene::layers
    std::vector<int> brushed;       ///< channels of enabled brushes
};

/// Left out are hidden layers, those of lenses and channels that do not exist, and those that are drawn as
/// Scene::geometry: flow, and surfaces as polygons. The answer refers to the scene.
DrawnScene drawnScene(const Scene& scene, const volume::DatasetInfo& info);

/// A layer of Scene::geometry that is drawn.
struct DrawnGeometry {
    int layer = 0; ///< index into Scene::geometry
    int lens = -1; ///< as in DrawnLayer
};
std::vector<DrawnGeometry> drawnGeometry(const Scene& scene, const std::vector<PlacedLens>& lenses);

/// What the scalars of a geometry layer are looked up in; nothing where it has a colour of its own.
std::optional<DrawnChannel> colorsOf(const Scene& scene, const volume::DatasetInfo& info, const GeometryLayer& layer);

} // namespace tessera::vis
