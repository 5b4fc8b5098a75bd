#pragma once

#include "volume/base/describe.h"
#include "volume/field/lattice.h"

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

/// What a search found, as numbers: programs make words and pictures of it.
namespace tessera::volume {

enum class FindingKind {
    Dependence, ///< Pearson's r of two parameters, everywhere or in a region
    Contrast,   ///< r in a region and elsewhere differ
    Nonlinear,  ///< distance correlation far above r
    Outliers,   ///< values far beyond those of the rest, in one place
    Jump,       ///< a difference between neighbours unlike those beside it, in one place
    Change,     ///< steps of time with more change than others
    Differs,    ///< a parameter inside and outside of the selection
    Around,     ///< a parameter in the selection and right around it, unlike where the brush is moved elsewhere
    Region,     ///< a region's share of what is selected and of the rest
    Time,       ///< a time with another share of samples selected
};

struct Finding {
    FindingKind kind = FindingKind::Dependence;
    int x = -1, y = -1;             ///< indices of DatasetInfo::channels(); -1: none
    std::optional<int> region = {}; ///< value of the label; none: everywhere
    /// What the sentence tells: r, distance correlation; r elsewhere, or |r|. Of places: the extreme value, and that of
    /// the surroundings. Of changes: the mean change where it is greatest, and the usual RMS change of a step. Of
    /// selections: means or shares inside and outside.
    double number = 0, other = 0;
    double strength = 0;               ///< 0..1: what entries of a kind are ranked by
    double p = 1;                      ///< chance of this or more where nothing is to be found
    double q = 1;                      ///< false discovery rate at which it is a finding, among all tests of the search
    double samples = 0, effective = 0; ///< that it is of, and how many independent ones these are worth
    glm::dvec3 place{0};               ///< of the extreme sample
    Box box = {};                      ///< of places: around them
    Range values{0, 0};                ///< of places: of the samples found
    int time = 0, first = 0, last = 0; ///< indices of times: of a change, the later of the greatest; first and last
    std::vector<float> series =
        {}; ///< of changes: RMS change of each step; of times: share selected at each; NaN: no samples
};

/// The tests of a search: findings, and how many tests found nothing.
struct Findings {
    std::vector<Finding> found;
    std::size_t tests = 0; ///< of all, those of `found` included
    void add(Finding finding) {
        found.push_back(std::move(finding));
        ++tests;
    }
};

/// Sets the rates of all tests (falseDiscoveryRates), removes what is above `rate`, and orders the rest: places and
/// changes first, since relations of all samples are everywhere, then by strength.
void keepDiscoveries(Findings& findings, double rate);

} // namespace tessera::volume
