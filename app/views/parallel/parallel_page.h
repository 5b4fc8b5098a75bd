#pragma once

#include "app/drawing/drawing.h"
#include "app/values/page_form.h"
#include "app/values/table.h"
#include "app/views/parallel/parallel_plot.h"

/// Parallel coordinates on a page and as a table.
namespace tessera::app {

/// One time of the view.
struct ParallelState {
    std::string name; ///< of the time; "" where only one is shown
    double time = 0;
    std::shared_ptr<const ParallelResult> result;
    std::vector<ParallelAxis> axes; ///< of the result, without places
};

/// A range on an axis that a brush selects; `taken`: it takes away.
struct ParallelBand {
    std::string channel;
    Range range;
    glm::vec3 color{0};
    bool taken = false;
};

struct ParallelPageLook {
    bool logDensity = true, histograms = true;
    std::vector<glm::vec3> focus;                           ///< by group; of pages with a light ground as they are
    std::vector<std::vector<std::optional<double>>> cursor; ///< by state and axis; absent: empty
    std::vector<ParallelBand> brushed = {};
};

/// The states below each other. Throws Error where texts leave no room for the plots.
VectorPage parallelPage(const std::vector<ParallelState>& states, const ParallelPageLook& look, const PageForm& form);

/// A row for each pair of bins of neighbouring axes that holds samples; ends of bins are empty where samples lack the
/// parameter, or lie beyond the end of the axis that is not empty. `selected`: the name of what is selected, "" for
/// nothing.
Table parallelTable(const std::vector<ParallelState>& states, const volume::DatasetInfo& info,
                    const std::string& selected);

} // namespace tessera::app
