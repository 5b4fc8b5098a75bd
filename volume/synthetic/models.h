#pragma once

#include "volume/base/progress.h"
#include "volume/field/dataset.h"

#include <map>
#include <string>
#include <vector>

namespace tessera::volume {

/// The data sets the program can compute itself: "fuel-cell", the same with "planted" events,
/// "marschner-lobb", "casting", "membrane", "bubbles" and "branching-pulse".
std::vector<std::string> modelNames();

/// A model as a Dataset on a CC grid, ranges known. `settings` may give nx, ny, nz, times and what the model's
/// docstring lists; unknown settings and sizes out of range throw Error.
Dataset makeModel(const std::string& name, const std::map<std::string, double>& settings,
                  const Progress& progress = {});

} // namespace tessera::volume
