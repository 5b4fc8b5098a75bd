#pragma once

#include "volume/derived/derived_recipe.h"

#include <functional>
#include <string>
#include <vector>

/// Resolves and checks the names in recipes for a data set.
namespace tessera::volume {

/// Names a formula may use: channels, vectors (for their magnitude), then x, y, z, t where these are free.
struct FormulaNames {
    std::vector<std::string> names;
    static constexpr int kTime = -4;
    std::vector<int> channel; ///< by name; -1 - axis for a coordinate, kTime for the time

    explicit FormulaNames(const DatasetInfo& info);

private:
    void add(const std::string& name, int which);
};

/// Components of a derived parameter: 3 of a vector, else 1.
int componentsOf(const DerivedRecipe& recipe);

/// The parts of a derived parameter: those of its inputs. If their labels differ, the first one is used.
Parts partsOf(const DerivedRecipe& recipe, const DatasetInfo& info);

/// What a label of pieces is found by; the channel is there.
PiecesQuery piecesQuery(const PiecesRecipe& recipe, const DatasetInfo& info, const BrickGrid& grid);

/// Whether the parameter between two stored times is something else than that of both times mixed: where its formula
/// is, and where one of its inputs is (`computed`, by channel).
bool isComputedBetween(const DerivedRecipe& recipe, const DatasetInfo& info, const std::function<bool(int)>& computed);

/// Error message for a derived parameter of a data set, with the position in the formula; "" if it is valid.
std::string derivedProblem(const DerivedParameter& parameter, const DatasetInfo& info);

/// Error messages for several derived parameters, each of which may use those before it.
std::vector<std::string> derivedProblems(const std::vector<DerivedParameter>& parameters, DatasetInfo info);

} // namespace tessera::volume
