#pragma once

#include "volume/base/progress.h"
#include "volume/field/dataset.h"
#include "volume/system/atomic_file.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

/// Shared by the formats of volume/export/export.h, and the formats that have a file of their own.
namespace tessera::volume {

/// How the numbers of one component are read: physical value = offset + scale * stored value.
struct Scaling {
    double scale = 1, offset = 0;
    bool operator==(const Scaling&) const = default;
};

/// How a parameter is written at the chosen times.
struct Storage {
    ScalarType type = ScalarType::F32; ///< of all components
    bool presence = false;             ///< some sample is absent, and the type has no NaN
    std::vector<Scaling> scaling;      ///< of each component
};

/// Examines every integer frame once. Integers stay integers if each component has the same scaling at all times; else
/// all components become floats.
Storage storageOf(const Dataset& dataset, int parameter, const std::vector<int>& times);

/// The data set with ExportSelection::values: looks at every integer frame of the selection once.
Dataset withValues(Dataset dataset, const std::vector<int>& parameters, const std::vector<int>& times);

/// Physical values as floats.
Storage floatStorage(int components);

/// Whether at each time all components lack the same samples, so that one array of flags is enough.
bool masksAgree(const Dataset& dataset, int parameter, const std::vector<int>& times);

/// False: the samples have to be converted.
bool isStoredAs(const Field& field, int component, const Storage& storage);

/// Physical values as float, absent ones NaN.
Field asFloat(const Field& field);

/// A frame as `storage` has it, absent floats NaN.
Field loadAs(const Dataset& dataset, int parameter, int component, int time, const Storage& storage);

/// A flag for each sample.
std::vector<std::uint8_t> presenceOf(const Field& field);

void writeField(AtomicFile& file, const Field& field);

/// A text as it stands in XML.
std::string xmlText(const std::string& text);

/// One time as VTK image data, or as a rectilinear grid where the path ends in .vtr.
void writeVtk(const Dataset& dataset, const std::vector<int>& parameters, int time, const std::string& path,
              const Progress& progress);

/// Times as image data, of uneven axes and for .vtr as rectilinear grids, and the .pvd that lists them; the files
/// written.
std::vector<std::string> writeSeries(const Dataset& dataset, const std::vector<int>& parameters,
                                     const std::vector<int>& times, const std::filesystem::path& path,
                                     const Progress& progress);

/// Samples as stored, and the sidecar; the files written.
std::vector<std::string> writeRaw(const Dataset& dataset, const std::vector<int>& parameters,
                                  const std::vector<int>& times, const std::filesystem::path& path,
                                  const Progress& progress);

} // namespace tessera::volume
