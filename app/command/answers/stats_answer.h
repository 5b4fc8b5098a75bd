#pragma once

#include "app/command/answers/stats_question.h"
#include "app/described/describe_json.h"
#include "app/values/plot.h"
#include "volume/base/progress.h"

#include <string>
#include <vector>

/// The numbers that `tessera stats` prints, writes and draws.
namespace tessera::app {

/// Numbers as rows of a text, of CSV, and of JSON.
struct Answer {
    std::string text, csv;
    Json json = Json::array(), units = Json::object(); ///< units: by the keys of the rows
    std::vector<std::string> notes;
};

/// The requested numbers at one time: averages over planes, a balance, or statistics of regions. `first`: the CSV has
/// its head.
Answer answerAt(const StatsRequest& request, const Question& question, double time, bool first,
                const Progress& progress);

/// The same as text, for another process.
std::string textOf(const Answer& answer);
/// Adds the answer of a later time, as textOf() gives it.
void addAnswer(Answer& sum, const std::string& later);

/// The figure of averages over planes at the requested times: several are a family of lines.
std::vector<Plot> sectionFigure(const StatsRequest& request, const Question& question, const Progress& progress);
/// The figure of a request without planes, from the rows of all requested times. Means over times: a panel for each
/// parameter with a line for each region, or a dot if that is one time. Balances: a panel for each region with
/// a line for each surface over the times, or a bar if that is one time.
std::vector<Plot> figureOf(const Question& question, const Json& rows);

} // namespace tessera::app
