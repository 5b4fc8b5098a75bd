#pragma once

#include "app/planes/contour_data.h"
#include "app/tools/plane_sections.h"
#include "app/views/hyperslice/hyper_axes.h"
#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <vector>

/// Values of a slice through the cross-hair, along two axes of space or time, and along one (J. van Wijk and R. van
/// Liere, HyperSlice, 1993).
namespace tessera::app {

/// What is asked for; equal queries have equal answers. The cross-hair counts across the panel alone: where it stands
/// along the panel's own axes makes no other query.
struct HyperQuery {
    std::array<AxisPlaces, 2> axes; ///< to the right, up
    std::array<Range, 2> shown;     ///< places
    glm::ivec2 cells{1};            ///< of a grid over them, values are of their middles
    std::vector<int> channels;      ///< indices of DatasetInfo::channels()
    glm::dvec3 cursor{0};           ///< physical; 0 along the panel's axes
    double time = 0;                ///< 0 where the panel has an axis of time
    bool operator==(const HyperQuery&) const = default;
};

/// Places of cells: the middles of even parts of a range.
double cellMiddle(Range range, int cell, int cells);

struct HyperValues {
    HyperQuery query;
    /// By channel of the query, then from below, then from the left (fastest): values between samples as probe() has
    /// them, between stored times too; NaN where absent.
    std::vector<std::vector<double>> values;

    /// The place of a cell in space, and its time.
    glm::dvec3 positionOf(glm::ivec2 cell, const volume::AxisMaps& maps) const;
    double at(std::size_t channel, glm::ivec2 cell) const;
};

/// A panel of a matrix that shows `channels` on a grid of cells.
HyperQuery panelQuery(const HyperAxis& across, const HyperAxis& up, std::vector<int> channels, glm::ivec2 cells,
                      const Session& session, const volume::DatasetInfo& info);

/// Reads the values, with all cores. Throws Error, Cancelled.
HyperValues readPanel(const volume::BrickSource& source, const HyperQuery& query, const Progress& progress = {});

/// Values along an axis through the cross-hair: at `count` even places of what is shown, both ends included; along time
/// at the stored times and the ends.
struct ProfileAlongQuery {
    AxisPlaces along;
    Range shown;
    int count = 2, channel = 0;
    glm::dvec3 cursor{0}; ///< 0 along the axis
    double time = 0;      ///< 0 along time
    bool operator==(const ProfileAlongQuery&) const = default;
};
struct ProfileAlong {
    ProfileAlongQuery query;
    std::vector<glm::dvec2> points; ///< rising place, value; NaN where absent
};
ProfileAlongQuery profileAlongQuery(const HyperAxis& axis, int channel, int count, const Session& session,
                                    const volume::DatasetInfo& info);
ProfileAlong readProfileAlong(const volume::BrickSource& source, const ProfileAlongQuery& query,
                              const Progress& progress = {});

/// What the panels of a view show beside the parameter of the colours: which channels are read, and where in the
/// answers they are.
struct HyperContent {
    int channel = 0;           ///< of the colours; the first of `channels`
    std::vector<int> channels; ///< each once
    std::optional<int> lined;  ///< of the contour lines
    ContourLevels levels;
    std::optional<int> label; ///< of the regions of the contoured parameter that are kept apart

    std::size_t place(int of) const; ///< in `channels`
};
HyperContent hyperContent(const HyperSliceView& view, int channel, const Session& session,
                          const volume::DatasetInfo& info);

/// The panel in the colours of its parameter, faded and tinted by the brushes as a slice is: RGBA, row 0 at the top,
/// clear where values are absent.
std::vector<std::uint8_t> panelImage(const volume::DatasetInfo& info, const Session& session,
                                     const HyperContent& content, const HyperValues& values);

/// Contour lines of a panel, as places of its axes; none between regions that are kept apart.
std::vector<volume::ContourLine> panelLines(const volume::DatasetInfo& info, const HyperContent& content,
                                            const HyperValues& values);

/// The plane of the data that a panel of two axes of space is; its directions run along them.
PicturePlane planeOfPanel(const Session& session, const volume::DatasetInfo& info, const AxisPlaces& across,
                          const AxisPlaces& up);
/// Outlines of lenses and brushes there; none with an axis of time.
std::vector<PlaneSection> panelSections(const Session& session, const volume::DatasetInfo& info,
                                        const AxisPlaces& across, const AxisPlaces& up);

} // namespace tessera::app
