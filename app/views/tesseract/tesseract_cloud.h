#pragma once

#include "app/views/tesseract/tesseract_query.h"
#include "app/views/tesseract/tesseract_wire.h"
#include "vis/passes/point_cloud.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

/// The points of a tesseract view: from samples to pictures.
namespace tessera::app {

struct TesseractCloud {
    AsyncSamples answers;
    /// Of the picture, or of both eyes.
    std::array<vis::PointCloud, 2> clouds;
    std::shared_ptr<const volume::Samples4> samples; ///< of the points
    std::vector<vis::CloudPoint> points;
    std::optional<vis::CloudStyle> style;
    std::array<std::optional<vis::CloudView>, 2> drawn;
    std::array<vis::TextureName, 2> textures{};
    bool both = false;    ///< the points are in both clouds
    bool current = false; ///< the points are of the axes and the parameter that update() was given last

    /// Brings the points up to date. Returns false while there are none.
    bool update(ViewContext& context, const std::string& pane, const TesseractView& view,
                const std::vector<TesseractAxis>& axes, int channel);
    /// The picture of the points, drawn anew where the view has changed; `eye`: 0 or 1.
    vis::TextureName picture(const vis::CloudView& view, int eye);
};

/// How many points are drawn and which share of the data that is, in words.
std::string cloudText(const TesseractCloud& cloud, const volume::DatasetInfo& info, const TesseractView& view,
                      std::size_t drawn, bool moreComing);

/// A ring at the cross-hair and the time shown, with the values there along axes of parameters; nothing where one of
/// them is absent.
void drawCursorRing(ViewContext& context, const TesseractFrame& frame);

/// The value, place and time of the point under the mouse, beside it; returns its sample, nothing where there is none.
std::optional<std::size_t> drawReading(ViewContext& context, const TesseractCloud& cloud, const TesseractFrame& frame,
                                       int channel);

} // namespace tessera::app
