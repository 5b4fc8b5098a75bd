#pragma once

#include "app/data/sources.h"
#include "app/session/views/section_settings.h"
#include "app/views/curves/section_data.h"
#include "volume/base/describe.h"
#include "volume/derived/derived.h"
#include "volume/field/time_pair.h"
#include "volume/import/import.h"
#include "volume/sources/labelled_source.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

/// The options of `tessera stats`, as given and as resolved for a data set.
namespace tessera::app {

struct StatsOptions {
    std::vector<double> time;
    bool allTimes = false;
    std::string by, of, along, line, balance, velocity, regions;
    volume::SectionWeight weight = volume::SectionWeight::Area;
    SectionMeasure show = SectionMeasure::Mean;
    int planes = 100;
    bool json = false;
    bool planesAcross() const { return !along.empty() || !line.empty(); }
    static void describe(auto& self, auto&& visit) {
        visit(self.time, FieldInfo{"time", "Time, in the unit of the data, or several: 0.1,0.26 (default: the last)"});
        visit(self.allTimes, FieldInfo{"allTimes", "Every time"});
        visit(self.by,
              FieldInfo{"by", "Label whose values are the regions, or none (default: the first label of the data)"});
        visit(self.regions, FieldInfo{"regions", "Only these regions, by name or value: cathode,3"});
        visit(self.of, FieldInfo{"of", "Only these parameters: O2,H2O (default: all)"});
        visit(self.along, FieldInfo{"along", "Averages over planes across an axis: x, y or z"});
        visit(self.line,
              FieldInfo{"line",
                        "Averages over planes across a line: x,y,z,x,y,z of its ends, in the length unit of the data"});
        visit(self.planes,
              FieldInfo{.key = "planes", .doc = "Number of planes across the line", .range = Range{1, 100000}});
        visit(
            self.weight,
            FieldInfo{.key = "weight", .doc = "Weight of the mean over a plane", .names = volume::kSectionWeightNames});
        visit(self.show, FieldInfo{.key = "show",
                                   .doc = "Which result is printed and drawn (CSV has all of them)",
                                   .names = kSectionMeasureNames});
        visit(self.balance, FieldInfo{"balance", "How much of this parameter flows into and out of every region"});
        visit(self.velocity, FieldInfo{"velocity", "Velocity of the flow (default: found by name and unit)"});
        visit(self.json, FieldInfo{"json", "Print JSON with stable keys"});
    }
};

struct StatsRequest {
    std::vector<std::string> inputs;
    std::string output;
    bool alone = false;
    StatsOptions options;
    std::vector<std::string> given; ///< names of the options that the user stated
    std::vector<volume::DerivedParameter> derived;
    volume::ImportOptions import;
    codec::RemoteOptions remote;
};

/// The request with names resolved to indices of the data set.
struct Question {
    std::shared_ptr<const volume::BrickSource> source;
    NumberOrigin from;
    std::vector<int> channels;
    int label = -1, balance = -1;
    std::vector<int> regions; ///< requested label values; empty: all
    std::vector<glm::dvec3> line;
    std::vector<double> times = {};       ///< rising
    std::vector<std::string> states = {}; ///< what a legend calls each, if there are several
    std::vector<bool> known = {};         ///< by channel: whether the numbers asked for are known as computed
    bool errors = false;                  ///< tables have bounds on errors of other numbers
    /// Where the numbers come from, in words.
    std::string origin() const;
    const volume::DatasetInfo& info() const { return source->info(); }
    volume::TimePair at(double time) const { return volume::timesAround(info().times, time); }
    bool several() const { return info().times.size() > 1; }
    std::string timeTitle() const {
        return info().timeName + (info().timeUnit.empty() ? "" : " [" + info().timeUnit + "]");
    }
};

/// Resolves a request for a data set. Throws Error for an unknown parameter, label, region or axis, or an invalid line.
Question questionOf(const StatsRequest& request, const Sources& sources);

} // namespace tessera::app
