#pragma once

#include <string>

/// Inputs of any size for measurements of how cost grows. Each function writes into a folder, a piece at a time, and
/// gives the path to open. Values are waves with noise, so that they are coded like measured ones.
namespace tessera::app {

/// A raw file of about so many bytes: 32-bit floats on a cube.
std::string makeRawFile(const std::string& folder, double bytes);

/// A raw file of so many bytes, all zero, that takes no room on most disks.
std::string makeSparseFile(const std::string& folder, double bytes);

/// So many parameters on 32x32x32 samples in one raw file.
std::string makeParameters(const std::string& folder, int count);

/// A folder with a raw file of 8x8x8 bytes and its sidecar for each time.
std::string makeRawSeries(const std::string& folder, int times);

/// A folder with a VTK image of 8x8x8 bytes for each time, which tessera-import reads.
std::string makeImageSeries(const std::string& folder, int times);

/// A table of points as CSV: x, y, z and a value, on a grid of about so many rows.
std::string makeTable(const std::string& folder, int rows);

/// A table of 1000 points as CSV with so many columns of values besides x, y, z.
std::string makeWideTable(const std::string& folder, int columns);

/// A table of 64 points as CSV with a column "T @ t=..." for each time.
std::string makeSweptTable(const std::string& folder, int times);

/// A table over time as CSV, of so many quantities at 1000 times, for --over-time.
std::string makeTimeTable(const std::string& folder, int columns, int times);

/// A VTK mesh of about so many hexahedra with a value at each point.
std::string makeMesh(const std::string& folder, int cells);

} // namespace tessera::app
