#pragma once

#include "app/queries/statistics_query.h"
#include "app/values/table.h"
#include "volume/worth/worth_seeing.h"

#include <memory>
#include <string>
#include <vector>

/// What the list of things worth seeing asks, and its findings in words and as a table.
namespace tessera::app {

/// Equal questions have equal answers.
struct WorthQuestion {
    WorthList list = WorthList::Views;
    std::vector<int> channels;
    int label = -1;
    int time = 0;          ///< index; 0 of lists that look at every time
    bool selected = false; ///< only what the brushes select
    double rate = 0.05;
    int most = 24;
    BrushedQuery brushes = {}; ///< of lists that depend on them
    std::string selection;     ///< the name of what is selected; "": nothing is
    bool operator==(const WorthQuestion&) const = default;
};

WorthQuestion worthQuestion(const Session& session, const volume::DatasetInfo& info, const WorthSeeingView& view,
                            const std::vector<int>& channels);

/// Levels for AsyncQuery: the coarsest that is worth an answer, and 0 for the finest that is searched. Throws Error,
/// Cancelled.
int firstWorthLevel(const volume::BrickGrid& grid, std::size_t channels);
volume::WorthFindings readWorth(const std::shared_ptr<const volume::BrickSource>& source, const WorthQuestion& question,
                                int level, const Progress& progress = {});

/// One sentence with its numbers: "O2 and H2O: r = -0.99 in cathode GDL".
std::string sentenceOf(const volume::Finding& finding, const WorthQuestion& question, const volume::DatasetInfo& info);
/// What the numbers must be read with: p, false discovery rate, samples, independent samples.
std::string evidenceOf(const volume::Finding& finding);
/// The number of a row: "r = -0.99", "22 mol/m³".
std::string numberOf(const volume::Finding& finding, const volume::DatasetInfo& info);

/// Rank, kind, sentence, number, p, q, samples, independent samples; and how it was searched.
Table worthTable(const volume::WorthFindings& answer, const WorthQuestion& question, const volume::DatasetInfo& info);
/// "at t = 0.69 s, 14 443 samples, 167 tests, false discovery rate 5 %".
std::string searchedText(const volume::WorthFindings& answer, const WorthQuestion& question,
                         const volume::DatasetInfo& info);
/// "as computed, at t = 0.69 s (0.4 V)": where the numbers come from, and the stored time that was searched. `axis`:
/// the quantity that comes first.
std::string searchedOrigin(const std::string& origin, const WorthQuestion& question, const volume::DatasetInfo& info,
                           const std::string& axis);

} // namespace tessera::app
