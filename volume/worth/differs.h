#pragma once

#include "volume/worth/finding.h"
#include "volume/worth/worth_samples.h"

#include <functional>
#include <span>
#include <vector>

/// How what is selected differs from the rest: parameters, regions, times.
namespace tessera::volume {

/// The greatest distance of the cumulated shares of two samples (Kolmogorov-Smirnov). Sorts both.
double kolmogorovDistance(std::vector<float>& a, std::vector<float>& b);

/// A test for each parameter (but those of `without`, which the selection is made of): of the distance of both
/// distributions, and of the correlation with being selected, whichever is stronger. And one for the region whose
/// share of what is selected and of the rest differ most surely, of samples with a region or any value. All for as many
/// samples as are independent where the selection would be as large and lie elsewhere.
Findings findDifferences(const WorthSamples& samples, std::span<const int> without, const Progress& progress = {});

/// A test for each parameter (but those of `without`): of the difference between the mean in the selection and that
/// right around it, against the same differences where the brush is moved elsewhere. What is one place differs from the
/// rest wherever it is; this tells whether it differs more than other places would.
Findings findAround(const WorthSamples& samples, std::span<const int> without);

struct SelectedTimesQuery {
    std::vector<int> channels; ///< samples without a value of any of these do not count
    std::vector<int> doiChannels;
    std::function<double(std::span<const float> values, glm::dvec3 position)> doi;
    int level = 0;
};

/// The time with the greatest share of samples selected, and one test for it: whether the shares of all times follow
/// each other more closely than in random order. Times without samples are left out, NaN in the series. Of fewer than 8
/// times it finds nothing.
Findings findSelectedTimes(const BrickSource& source, const SelectedTimesQuery& query, const Progress& progress = {});

} // namespace tessera::volume
