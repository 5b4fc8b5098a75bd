#pragma once

#include "app/command/stats_question.h"
#include "app/described/describe_json.h"
#include "app/pane/figure.h"
#include "volume/base/progress.h"

#include <string>
#include <vector>

/// The numbers that `tessera stats` prints, writes and draws.
namespace tessera::app {

/// Numbers as rows of a text, of CSV, and of JSON.
struct Answer {
    std::string text, csv;
    Json json = Json::array();
    std::vector<std::string> notes;
    std::vector<FigurePanel> panels;
};

/// Adds the requested numbers at one time: averages over planes, a balance, or statistics of regions.
void addAnswer(Answer& answer, const StatsRequest& request, const Question& question, double time,
               const Progress& progress);

/// The figure of a request without planes. Means over all times: a panel for each parameter with a line for each
/// region. Balances: a panel for each region with a line for each surface over the requested times, or a bar if that is
/// one time.
std::vector<FigurePanel> figureOf(const StatsRequest& request, const Question& question, const Progress& progress);

} // namespace tessera::app
