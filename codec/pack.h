#pragma once

#include "codec/lifting.h"
#include "volume/dataset.h"
#include "volume/describe.h"
#include "volume/progress.h"

#include <string>
#include <vector>

/// The pipeline from a data set to an archive.
namespace tessera::codec {

/// How to pack. Described once: widgets, JSON and command-line options come from here.
struct PackOptions {
    volume::LatticeKind lattice = volume::LatticeKind::BCC;
    bool lossless = true;
    double maxError = 0;
    Wavelet wavelet = Wavelet::W22;
    int brickSize = 32;
    int levels = 0;
    int zstdLevel =
        1; ///< higher ones find matches that residuals do not have: measured within 1.5 % of ratio, 1.5 x the time

    bool operator==(const PackOptions&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.lattice, FieldInfo{.key = "lattice",
                                      .unit = "",
                                      .doc = "Lattice of the stored samples: bcc keeps 70.7 % of them",
                                      .names = volume::kLatticeNames});
        visit(self.lossless,
              FieldInfo{.key = "lossless", .unit = "", .doc = "Store every sample of the lattice bit for bit"});
        visit(self.maxError, FieldInfo{.key = "maxError",
                                       .unit = "of range",
                                       .doc = "Largest error of a float sample, relative to its parameter's range; "
                                              "above 0 it replaces lossless",
                                       .range = Range{0, 1}});
        visit(self.wavelet, FieldInfo{.key = "wavelet",
                                      .unit = "",
                                      .doc = "Vanishing moments N,N~ of the integer wavelet",
                                      .names = kWaveletNames});
        visit(self.brickSize, FieldInfo{.key = "brickSize",
                                        .unit = "texel",
                                        .doc = "Edge of a brick, a power of two",
                                        .range = Range{4, 128}});
        visit(self.levels, FieldInfo{.key = "levels",
                                     .unit = "",
                                     .doc = "Levels of detail; 0 = until a brick is 4 texels wide",
                                     .range = Range{0, 8}});
        visit(self.zstdLevel,
              FieldInfo{.key = "zstdLevel", .unit = "", .doc = "Effort of the entropy coder", .range = Range{1, 19}});
    }
};

/// What was done.
struct PackSummary {
    std::uint64_t sourceBytes = 0; ///< of all samples read
    std::uint64_t sourceSamples = 0, storedSamples = 0;
    std::uint64_t archiveBytes = 0;
    double seconds = 0, loadSeconds = 0, resampleSeconds = 0, codeSeconds = 0;
    std::vector<std::string> notes; ///< what the user should know, one line each
};

/// Packs a data set into `path`. Streams: one time of one parameter and its working copies are in memory. Ranges, where
/// unknown, are gathered on the way (with `maxError`, in a pass before). Categorical parameters are resampled to the
/// nearest and only predicted, so that every level holds labels. Nothing is left behind when it throws: Error for bad
/// input or options, MachineError when the file cannot be written, Cancelled.
PackSummary pack(volume::Dataset& dataset, const PackOptions& options, const std::string& path,
                 const Progress& progress = {});

} // namespace tessera::codec
