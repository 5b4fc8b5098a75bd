#include "app/views/scatter3d/cloud_table.h"

#include "app/values/selection_text.h"

namespace tessera::app {

Table cloudTable(const ParallelResult& result, const std::vector<ParallelAxis>& axes, const std::string& selected) {
    Table table;
    for (const ParallelAxis& axis : axes)
        table.columns.push_back({.name = axis.channel.name, .unit = axis.channel.unit});
    table.columns.push_back({.name = "samples"});
    if (!selected.empty()) table.columns.push_back({.name = "samples in " + selected});
    const auto bins = static_cast<std::size_t>(result.densities.bins);
    const volume::PlaceCounts& cube = result.densities.cube;
    for (std::size_t cell = 0; cell < cube.all.size(); ++cell) {
        if (cube.all[cell] == 0) continue;
        const std::size_t at[3] = {cell / bins / bins, cell / bins % bins, cell % bins};
        for (std::size_t a = 0; a < 3; ++a)
            table.columns[a].numbers.push_back(
                volume::axisValue(result.query.axes[a], (double(at[a]) + 0.5) / double(bins)));
        table.columns[3].numbers.push_back(double(cube.all[cell]));
        if (!selected.empty()) table.columns[4].numbers.push_back(cube.selectedAt(cell));
    }
    if (!selected.empty()) sayWeighted(table.columns.back());
    if (result.densities.level > 0) table.notes.push_back("estimated from a coarser level");
    table.notes.push_back("values are the middles of bins; samples that lack one of the three take no part");
    return table;
}

} // namespace tessera::app
