#pragma once

#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"
#include "volume/worth/finding.h"

#include <functional>
#include <span>
#include <vector>

/// When something changes most, and where.
namespace tessera::volume {

struct ChangesQuery {
    std::vector<int> channels;
    int level = 0;
    int label = -1; ///< channel of a label that names the place; -1: none
    std::vector<int> doiChannels = {};
    /// As of WorthSamplesQuery: only samples that are inside at both times count. Empty: all.
    std::function<double(std::span<const float> values, glm::dvec3 position)> doi = {};
};

/// Runs of steps with more change than others, before a choice by rate, and how much was looked at.
struct Changes {
    Findings findings;
    double samples = 0; ///< grid points with any value at any time
};

/// Of data of fewer than three times nothing: there is nothing to compare a change with. A step is tested by the ratio
/// of its mean square change to the lower quartile of all, whose logarithm is about normal for independent steps of
/// fields with as many independent samples; and by that of its change per time, whichever says less: of a steady drift
/// the longest step is no news, nor of noise the shortest. Steps without a sample that is there at both times take no
/// part, NaN in the series. Neighbouring steps are joined by joinedSteps.
Changes findChanges(const BrickSource& source, const ChangesQuery& query, const Progress& progress = {});

/// Neighbouring steps of a channel as one finding: when it begins and ends, the later time of the fastest change, the
/// place of the greatest change of its first step, and the chance and samples of its surest step.
std::vector<Finding> joinedSteps(std::vector<Finding> steps);

} // namespace tessera::volume
