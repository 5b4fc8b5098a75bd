#pragma once

#include "app/data/number_origin.h"
#include "app/queries/statistics_query.h"
#include "app/values/place_text.h"
#include "app/values/table.h"
#include "volume/analysis/region_statistics.h"
#include "volume/field/time_pair.h"
#include "volume/flow/balance.h"

#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <vector>

/// Statistics and balances of regions as rows that tables, CSV files and the command line show.
namespace tessera::app {

/// For the numbers of every region; equal queries have equal answers.
struct RegionQuery {
    std::vector<int> channels;
    int label = -1;
    volume::TimePair time;
    BrushedQuery brushes = {}; ///< its channels and selection: samples count by their degree of interest
    bool operator==(const RegionQuery&) const = default;
};

/// Numbers, each either as computed or of the samples.
struct RegionNumbers {
    volume::RegionStatistics statistics;
    /// By position in the query's channels: bound on the errors of mean, deviation, least and most, in its unit; 0: as
    /// computed; NaN: not known. Empty: all are as computed.
    std::vector<double> errors = {};
};

/// Looks numbers up, and counts those that are not known; the regions are the values that the label has at that time.
/// Throws Error, Cancelled.
RegionNumbers readRegions(const std::shared_ptr<const volume::BrickSource>& source, const NumberOrigin& origin,
                          const RegionQuery& query, const Progress& progress = {});

/// Whether numbers of all channels are known as computed.
bool isKnown(const NumberOrigin& origin, const volume::DatasetInfo& info, const RegionQuery& query);

/// One row of the table: a parameter in a region.
struct RegionRow {
    std::string parameter, unit, region;
    int value = 0; ///< of the label
    glm::vec3 color{0};
    bool all = false;        ///< the whole grid, not a region
    double ofAll = 0;        ///< share of all samples of the grid, 0..1
    double ofExisting = 0;   ///< share of the samples where the parameter exists, of those selected
    volume::Summary summary; ///< of the samples where the parameter exists
    Range range;             ///< of the parameter, for the digits of texts
    double error = 0;        ///< bound on the errors of the summary; 0: as computed; NaN: not known
};

/// By parameter, then regions in their order, then the whole, which is called `whole`. Regions where a parameter has no
/// sample are left out.
std::vector<RegionRow> regionRows(const volume::DatasetInfo& info, const RegionQuery& query,
                                  const RegionNumbers& numbers, const std::string& whole = "all");

/// Whether some of the rows have a bound on their errors, so that tables have a column of these.
bool showsErrors(const std::vector<RegionRow>& rows);

/// Parameter, unit, region, samples, shares of them, volume, mean, deviation, least and most; `errors`: and the bound
/// on the errors of these four. `shares` false: without shares. `volumes`: what these are in (volumeUnit()).
Table regionTable(const std::vector<RegionRow>& rows, const LengthUnit& volumes, bool errors, bool shares = true);

struct RegionBalanceQuery {
    int channel = 0;
    std::string velocity; ///< "" = found by name and unit
    int label = -1;
    volume::TimePair time;
    bool operator==(const RegionBalanceQuery&) const = default;
};

struct Balance {
    RegionBalanceQuery query;
    std::string velocity; ///< the parameter that carries
    std::vector<volume::RegionBalance> regions;
    bool computed = true; ///< else of samples within bounds, which errors are of
    bool bounded = true;  ///< then: the bounds are known
};

/// Looks the balance of every region up, or computes it. Throws Error where there is no velocity, Cancelled.
Balance readBalance(const std::shared_ptr<const volume::BrickSource>& source, const NumberOrigin& origin,
                    const RegionBalanceQuery& query, const Progress& progress = {});
/// Whether it is known as computed.
bool isKnown(const NumberOrigin& origin, const volume::DatasetInfo& info, const RegionBalanceQuery& query);

/// A surface of a region, or a sum over all of its surfaces.
struct BalanceRow {
    std::string region, surface;                         ///< "x from below", "border to anode", "total: reacts"
    double in = 0, out = 0, net = 0, flow = 0, area = 0; ///< in the units of the table
    bool total = false;                                  ///< over the surfaces above; its `net` is what reacts
    double relative = 0;                                 ///< of a total: net by what flows in; NaN elsewhere
    double inside = 0;                                   ///< of a total: the amount in the region; NaN elsewhere
    /// Bounds on errors: of in, out and net, of the volume flow, of what is inside; 0: as computed, NaN: not known.
    double error = 0, flowError = 0, insideError = 0;
};
struct BalanceTable {
    std::string parameter, unit, flowUnit, areaUnit, insideUnit;
    std::vector<BalanceRow> rows;
    bool errors = false;            ///< the table has columns of errors
    std::vector<std::string> notes; ///< what is approximate
};
/// Surfaces that nothing touches are left out.
BalanceTable balanceTable(const volume::DatasetInfo& info, const Balance& balance);

/// What flows in, out and is inside, a row for each surface, with the notes.
Table tableOf(const BalanceTable& balance);

} // namespace tessera::app
