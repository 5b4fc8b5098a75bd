#pragma once

#include "app/data/number_origin.h"
#include "app/session/views/section_settings.h"
#include "app/ui/ticks.h"
#include "app/values/plot.h"
#include "app/values/table.h"
#include "vis/scene/selection.h"
#include "volume/base/progress.h"
#include "volume/base/unit_product.h"
#include "volume/field/time_pair.h"
#include "volume/flow/sections.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Averages over planes, as numbers, tables and figures.
namespace tessera::app {

/// What is asked for; equal queries have equal answers.
struct SectionCurvesQuery {
    std::vector<int> channels; ///< indices of DatasetInfo::channels()
    volume::SpaceAxis axis = volume::SpaceAxis::Z;
    std::vector<glm::dvec3> line; ///< start and end of a line instead of the axis
    int planes = 100;             ///< across a line
    volume::SectionWeight weight = volume::SectionWeight::Area;
    std::string velocity;     ///< "" = found by name and unit
    int label = -1;           ///< channel of the label that says the region
    std::vector<int> regions; ///< its values, one curve each; empty: every one that occurs
    volume::TimePair time;
    vis::Selection selection; ///< samples count by their degree of interest where a brush is enabled
    vis::LensSpace lenses;
    bool operator==(const SectionCurvesQuery&) const = default;
};

struct SectionCurves {
    SectionCurvesQuery query; ///< with the regions that have a curve
    volume::Sections sections;
    std::string velocity; ///< the parameter that carries, "" where there is none
    /// Bounds on the errors of samples by position in the query's channels, NaN where not known; empty: there are none.
    std::vector<double> errors = {};
};

inline constexpr const char* kSectionMeasureDocs[] = {
    "Mean over the plane, weighted by area, volume or mass flow",
    "Smallest value in the plane",
    "Largest value in the plane",
    "Integral over the plane: sum of value x area",
    "Flow of the parameter through the plane: sum of value x velocity x area",
    "Volume flow through the plane: sum of velocity x area",
    "Area of the plane where the parameter exists"};

/// Computes the curves. Throws Error (no velocity for mass flow or a flux), Cancelled.
SectionCurves readSections(const std::shared_ptr<const volume::BrickSource>& source, const SectionCurvesQuery& query,
                           const Progress& progress = {}, const NumberOrigin& origin = {});

/// Unit of a measure of a channel; values are multiplied by `factor` to be in it.
volume::ComposedUnit measureUnit(const volume::DatasetInfo& info, int channel, const std::string& velocity,
                                 SectionMeasure measure);
/// One measure of a plane in that unit.
double measured(const volume::SectionValues& values, SectionMeasure measure, double factor);
/// Bound on its error, for the channel at a position of the query; NaN where it is not known.
double errorOf(const SectionCurves& curves, std::size_t channel, const volume::SectionValues& values,
               SectionMeasure measure, double factor);

/// Names and colours of the curves, by SectionCurvesQuery::regions: "all", the name of the selection or the regions'.
struct CurveLook {
    std::string name;
    glm::vec3 color{0};
};
std::vector<CurveLook> curveLooks(const volume::DatasetInfo& info, const SectionCurvesQuery& query);

/// The title of the places along the axis or line, without unit.
std::string placeTitle(const volume::DatasetInfo& info, const SectionCurvesQuery& query);
/// Their unit: that of lengths, or one that suits a length; of an axis that is time that of times.
LengthUnit placeUnit(const volume::DatasetInfo& info, const SectionCurvesQuery& query,
                     std::optional<double> length = {});

/// Names of states that are drawn together, by what differs between them: their times, the selection and everything.
std::vector<std::string> sectionStateNames(const volume::DatasetInfo& info, const std::vector<SectionCurves>& states);

/// A row for each state, region, parameter (where the region has it) and plane, with every measure. `states`: the same
/// question of several times or selections; with more than one they are named.
Table sectionTable(const volume::DatasetInfo& info, const std::vector<SectionCurves>& states);
/// A plot for each parameter, a line for each region; of several states a plot for each parameter and region, a line
/// for each state. Throws Error for a flux without a velocity.
std::vector<Plot> sectionPanels(const volume::DatasetInfo& info, const std::vector<SectionCurves>& states,
                                SectionMeasure measure, bool dark = false);

/// Notes on how the numbers were computed, one sentence each.
std::vector<std::string> sectionNotes(const volume::DatasetInfo& info, const SectionCurves& curves);

} // namespace tessera::app
