#pragma once

#include "app/session/session.h"

#include <string>
#include <vector>

/// Small multiples: a grid of volume views from one camera that differ in their parameter or in their time.
namespace tessera::app {

/// Copies of the volume view of the pane `from`, one for each parameter, which is drawn as the first visible volume or
/// slice of that view is. Each has its own legend; they share the camera.
std::vector<VolumeView> viewsByParameter(const Session& session, const std::string& from,
                                         const std::vector<std::string>& channels);
/// Copies of it, one for each time, with one legend in the last.
std::vector<VolumeView> viewsByTime(const Session& session, const std::string& from, const std::vector<double>& times);

/// Indices of at most `most` of `count` times, evenly spread, the first and the last among them.
std::vector<std::size_t> spreadTimes(std::size_t count, std::size_t most);

/// The part of the dock that a grid takes: that around the pane in which all views show data, and no tools.
const DockNode* placeOfMultiples(const Session& session, const std::string& from);

/// Replaces the volume view of the pane `from`, and former small multiples, by a grid of views. `aspect`: width of the
/// grid's place by its height; `object`: the same of what each view shows, to choose the columns by. Other views at
/// that place become tabs elsewhere.
void makeMultiples(Session& session, const std::string& from, std::vector<VolumeView> views, double aspect,
                   double object);

/// Columns of a grid of `count` cells in which an object of the aspect `object` is largest.
int gridColumns(int count, double aspect, double object);

} // namespace tessera::app
