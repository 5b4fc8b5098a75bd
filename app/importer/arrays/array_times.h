#pragma once

#include "app/importer/arrays/array_file.h"

#include <map>
#include <string>
#include <vector>

/// The times of arrays that may each have an axis of their own.
namespace tessera::importer {

struct TimesOfArrays {
    std::vector<double> times; ///< of all axes, rising; empty = no array has such an axis
    std::string unit, name;    ///< "" = not stated
    /// By axis: the index along it at each of the times, -1 where it has none.
    std::map<int, std::vector<int>> along;
    std::vector<std::size_t> shownAt{0}; ///< times that together show all axes
};

/// Throws where a damaged file states so many times that their list alone would fill the memory.
void refuseEndless(const std::string& name, std::size_t times);

/// The axes along which frames follow each other, one for each array of `drawn` that has one: of time, else a long one
/// that nothing else is (a frequency). -1 = none. Arrays of axes whose times cannot be brought together are taken out
/// of `drawn` and named in `notes`.
TimesOfArrays timesOf(const ArrayFile& file, std::vector<const StoredArray*>& drawn, std::vector<std::string>& notes);

/// The axis of an array that counts its times; -1 = none.
int timeAxisOf(const TimesOfArrays& times, const StoredArray& array);

} // namespace tessera::importer
