#pragma once

#include "volume/analysis/statistics.h"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Curves over the times of a data set: quantities, statistics of parameters, and formulas of both, against each other.
namespace tessera::volume {

/// What is wanted. A formula (volume/derived/expression.h) may name "time" or the axis by its own name, quantities, and
/// statistics of a parameter: mean(T), min(T), max(T), deviation(T), share(T), volume(T), integral(T).
struct CurvesQuery {
    std::string x = "time";
    std::vector<std::string> y;
    /// Samples that statistics are of: where the label has one of these values; -1: everywhere.
    int label = -1;
    std::vector<int> regions;
    /// And by their degree of interest 0..1: a function of the values of `doiChannels` (indices of
    /// DatasetInfo::channels()) and the place. Empty: all.
    std::vector<int> doiChannels;
    std::function<double(std::span<const float> values, glm::dvec3 position)> doi;
    int level = 0; ///< of detail, of the statistics
    /// Statistics of a channel at a time, of all samples and of those inside the regions, that are known without
    /// samples, but for integrals; not asked where there is a degree of interest.
    std::function<std::optional<ChannelStatistics>(int channel, int time)> known;
};

struct Curve {
    std::string name, unit;     ///< unit "" where a formula has none that is known
    std::vector<double> values; ///< one for each time, NaN where not known
    bool operator==(const Curve&) const = default;
};

struct Curves {
    std::vector<double> times;
    std::string timeName, timeUnit;
    Curve x;
    std::vector<Curve> y;
    bool operator==(const Curves&) const = default;
};

/// mean, min, max and deviation are of samples present, those inside the region and the degree of interest; share is
/// what those are of all present samples; volume what they stand for, in cubic length units; integral the parameter
/// over that volume, its unit the product of both with lengths in metres (mol/m3 gives mol). Extremes count samples
/// with a degree of at least 1/2.
Curves computeCurves(const BrickSource& source, const CurvesQuery& query, const Progress& progress = {});

/// Names a formula may use: the axis, quantities, statistics of every parameter.
std::vector<std::string> curveNames(const DatasetInfo& info);

/// The two quantities of a polarisation curve by their names or units: a voltage, and a current or its density. Empty
/// names where the data have none.
struct CellQuantities {
    std::string voltage, current;
};
CellQuantities cellQuantities(const DatasetInfo& info);

/// One line per time: the time, x unless it is the time, every y; the first line names them with units.
std::vector<std::vector<double>> curveRows(const Curves& curves);

} // namespace tessera::volume
