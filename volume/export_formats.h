#pragma once

#include "volume/atomic_file.h"
#include "volume/dataset.h"
#include "volume/progress.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

/// What the formats of volume/export.h share, and those that have a file of their own.
namespace tessera::volume {

/// How a parameter is stored at the chosen times: found by looking at its integer frames once.
struct Storage {
    ScalarType type = ScalarType::F32;
    bool presence = false; ///< some sample is absent, and the type has no NaN
    double scale = 1, offset = 0;
};

Storage storageOf(const Dataset& dataset, int parameter, const std::vector<int>& times);

bool isStoredAs(const Field& field, const Storage& storage);

/// Physical values as float, absent ones NaN.
Field asFloat(const Field& field);

/// A frame as `storage` wants it, absent floats NaN.
Field loadAs(const Dataset& dataset, int parameter, int component, int time, const Storage& storage);

/// A flag for each sample.
std::vector<std::uint8_t> presenceOf(const Field& field);

void writeField(AtomicFile& file, const Field& field);

/// Shortest text that reads back equal.
std::string exactText(double value);

/// One time as VTK image data.
void writeVti(const Dataset& dataset, const std::vector<int>& parameters, int time, const std::string& path,
              const Progress& progress);

/// Times as VTK image data, and the .pvd that lists them; the files written.
std::vector<std::string> writeSeries(const Dataset& dataset, const std::vector<int>& parameters,
                                     const std::vector<int>& times, const std::filesystem::path& path,
                                     const Progress& progress);

/// Samples as stored, and the sidecar; the files written.
std::vector<std::string> writeRaw(const Dataset& dataset, const std::vector<int>& parameters,
                                  const std::vector<int>& times, const std::filesystem::path& path,
                                  const Progress& progress);

} // namespace tessera::volume
