#pragma once

#include "volume/worth/finding.h"
#include "volume/worth/worth_pictures.h"

/// Lists of what is worth seeing in a data set.
namespace tessera::volume {

enum class WorthSearch { Views, WhatElse, When };

struct WorthQuery {
    WorthSearch search = WorthSearch::Views;
    std::vector<int> channels; ///< indices of DatasetInfo::channels(): scalars and magnitudes
    int label = -1;            ///< channel of the label that says the regions; -1: none
    int time = 0;
    bool selected = false; ///< Views and When: only samples that are selected
    double rate = 0.05;    ///< false discovery rate
    std::size_t most = 24;
    int level = 0; ///< of detail of the samples of one time
    std::vector<int> doiChannels = {};
    std::function<double(std::span<const float> values, glm::dvec3 position)> doi = {};
};

/// A list, best first. `tests`: how many tests were made for it.
struct WorthFindings {
    std::vector<Finding> found;
    std::vector<WorthPicture> pictures; ///< one for each
    std::size_t tests = 0;
    int level = 0;               ///< of the samples looked at, of the time searched
    double samples = 0;          ///< grid points looked at that have any value, of lists over the times at any of these
    std::size_t regionsLeft = 0; ///< that are searched with all others only, not by themselves
    std::string missing = {};    ///< why there is nothing to search: no selection, one time; "": there is
};

/// Levels of detail by how many numbers are read at most: samples times channels.
int worthLevel(const BrickGrid& grid, std::size_t channels, double numbers);

/// Throws Error, Cancelled.
WorthFindings findWorthSeeing(const BrickSource& source, const WorthQuery& query, const Progress& progress = {});

} // namespace tessera::volume
