#pragma once

#include "volume/derived/derived.h"

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace tessera::app {

/// Adds --derive "NAME [UNIT] = FORMULA", any number of times; `parameters` must outlive the parsing.
void addDeriveOption(CLI::App& command, std::vector<volume::DerivedParameter>& parameters);

/// "dT [K] = T - at(T, first)"; unit and brackets may be left out. Throws CLI::ValidationError.
volume::DerivedParameter parseDerived(const std::string& text);

/// Throws Error for the first parameter that cannot be derived from a data set (derivedProblems).
void checkDerived(const std::vector<volume::DerivedParameter>& parameters, const volume::DatasetInfo& info);

/// The data set with derived parameters appended, on the same lattice. Throws Error (derivedProblem), Cancelled.
volume::Dataset withDerived(volume::Dataset dataset, const std::vector<volume::DerivedParameter>& parameters,
                            const Progress& progress);

/// One stored component of a source at full resolution. Throws Error, Cancelled.
volume::Field fieldOf(const volume::BrickSource& source, int parameter, int component, int time);

} // namespace tessera::app
