#pragma once

#include "app/planes/plane_picture.h"
#include "app/session/views/view_state_plots.h"
#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"

#include <string>
#include <vector>

/// The slices of a matrix as values, and how its cells are laid out in a pane.
namespace tessera::app {

struct SliceMatrix {
    int rows = 0, columns = 0;
    std::vector<PlanePicture> pictures; ///< row by row
    std::vector<std::string> rowNames, columnNames;

    const PlanePicture& at(int row, int column) const {
        return pictures[static_cast<std::size_t>(row * columns + column)];
    }
};

/// The longer axis of a slice lies level.
SliceAxes longAxesAcross(volume::SpaceAxis axis, const vis::WorldFrame& world);

/// The stored times shown, evenly chosen from the first to the last; of one, that nearest to the session's.
std::vector<double> matrixTimes(const volume::DatasetInfo& info, int count, double sessionTime);

/// What the view shows of `channels`: along rows and columns what each differs in; else the first channel, the axis of
/// the view, the plane through the cross-hair, and the session's time. Rows that differ in the same as columns are one
/// row. Directions in which the data have no extent are left out. Names of parameters have their unit.
SliceMatrix sliceMatrix(const Session& session, const volume::DatasetInfo& info, const SliceMatrixView& view,
                        const std::vector<int>& channels);

/// Whether a slice shows any value: asked where its samples lie, at 256 places along an edge at most. Throws Error,
/// Cancelled.
bool showsValues(const volume::BrickSource& source, const PlanePicture& slice, const Progress& progress = {});

/// What all its slices have in common, in words: "T, y to the right, x up, z = 3 mm, t = 0.2 s".
std::string commonText(const Session& session, const volume::DatasetInfo& info, const SliceMatrixView& view,
                       const SliceMatrix& matrix);

} // namespace tessera::app
