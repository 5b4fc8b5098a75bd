#pragma once

#include "volume/field/dataset.h"

#include <string>

/// Provenance texts (DatasetInfo::provenance, stored in archives) of data that were sampled from a mesh or resampled
/// from other grids.
namespace tessera::volume {

inline constexpr std::string_view kFromMesh = "resampled from a mesh";

/// A sentence that starts with kFromMesh and states the cells of the mesh and the samples of the grid.
inline std::string meshProvenance(double cells, glm::ivec3 samples) {
    return std::string(kFromMesh) + " of " + std::to_string(static_cast<long long>(cells)) + " cells to " +
           std::to_string(samples.x) + " x " + std::to_string(samples.y) + " x " + std::to_string(samples.z) +
           " samples";
}

/// A mesh whose cells are boxes between planes, with one sample for each: nothing is resampled.
inline std::string cellsProvenance(double cells) {
    return "a mesh of " + std::to_string(static_cast<long long>(cells)) + " cells, one sample for each";
}

/// Data of several different grids, or of points that do not fill a grid, sampled on one grid.
inline constexpr std::string_view kFromGrids = "resampled from several different grids",
                                  kFromPoints = "resampled from scattered points";

inline bool isResampled(const DatasetInfo& info) {
    return info.provenance.find("resampled from ") != std::string::npos;
}

} // namespace tessera::volume
