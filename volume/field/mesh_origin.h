#pragma once

#include "volume/field/dataset.h"

#include <string>

/// Data sampled from a mesh, or anew from grids, say so in DatasetInfo::provenance, which archives keep.
namespace tessera::volume {

inline constexpr std::string_view kFromMesh = "resampled from a mesh";

/// `cells` of the mesh, as a sentence that begins with kFromMesh and tells the samples of the grid.
inline std::string meshProvenance(double cells, glm::ivec3 samples) {
    return std::string(kFromMesh) + " of " + std::to_string(static_cast<long long>(cells)) + " cells to " +
           std::to_string(samples.x) + " x " + std::to_string(samples.y) + " x " + std::to_string(samples.z) +
           " samples";
}

/// Data of several grids that differ, or of points that fill none, sampled on one.
inline constexpr std::string_view kFromGrids = "resampled from grids that differ",
                                  kFromPoints = "resampled from scattered points";

inline bool isResampled(const DatasetInfo& info) {
    return info.provenance.find("resampled from ") != std::string::npos;
}

} // namespace tessera::volume
