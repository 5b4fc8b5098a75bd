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

/// How much a channel changes over each step of time: of steps().size() == times - 1.
struct ChannelChanges {
    int channel = 0;
    std::vector<double> rms;       ///< of the differences between both times, in the channel's unit
    std::vector<double> effective; ///< independent samples of these differences
};

struct Changes {
    std::vector<ChannelChanges> channels;
    Findings findings; ///< runs of steps with more change than the lower quartile of all steps; before a choice by rate
};

/// Of data of fewer than three times nothing: there is nothing to compare a change with. A step is tested by the ratio
/// of its mean square change to the lower quartile of all, whose logarithm is about normal for independent steps of
/// fields with as many independent samples.
/// Neighbouring steps are joined by joinedSteps.
Changes findChanges(const BrickSource& source, const ChangesQuery& query, const Progress& progress = {});

/// Neighbouring steps of a channel as one finding: when it begins and ends, the later time of the greatest change, and
/// the place of the greatest change of its first step.
std::vector<Finding> joinedSteps(std::vector<Finding> steps);

} // namespace tessera::volume
