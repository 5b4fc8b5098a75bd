#pragma once

#include "app/importer/arrays/array_file.h"

#include <array>
#include <string>
#include <vector>

/// Which axes of arrays are those of space and time.
namespace tessera::importer {

/// What was guessed, by names of arrays and numbers of axes; told only of those that are drawn.
struct GuessedAxes {
    std::vector<std::string> likeOthers, byOrder, channels; ///< arrays
    std::vector<int> kinds;                                 ///< axes
};

/// Gives axes to arrays that name none: those of an array of the same shape that has some, else by the shape that most
/// share. One-dimensional arrays named x, y, z, t, time or times become the places along such axes, and their lengths
/// tell the order where they can.
void giveAxes(ArrayFile& file, GuessedAxes& guessed);

/// Gives a kind to axes of which nothing is known, by their order: what is left of z, y, x, and of time before them.
void guessKinds(ArrayFile& file, GuessedAxes& guessed);

/// Notes on what was guessed about these arrays.
std::vector<std::string> notesOn(const GuessedAxes& guessed, const ArrayFile& file,
                                 const std::vector<const StoredArray*>& drawn);

/// Axes that are the same in all but their group become one.
void joinAxes(ArrayFile& file);

/// The axes of space of a grid, x, y, z, as indices of ArrayFile::axes; -1 = it has none.
using GridAxes = std::array<int, 3>;

GridAxes gridOf(const ArrayFile& file, const StoredArray& array);

/// The grid to read: that of a chosen array, else three long axes before two, most arrays, most samples. Throws if
/// there is none.
GridAxes commonGrid(const ArrayFile& file);

/// Whether an array is drawn: on a grid of two or more axes.
bool isOnGrid(const ArrayFile& file, const StoredArray& array, const GridAxes& grid);

/// "(time, lat, lon)", or "(2, 11, 10)" where its axes have no names.
std::string axesText(const ArrayFile& file, const StoredArray& array);

} // namespace tessera::importer
