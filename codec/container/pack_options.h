#pragma once

#include "codec/wavelet/lifting.h"
#include "codec/wavelet/threshold.h"
#include "volume/base/describe.h"
#include "volume/bricks/brick_importance.h"
#include "volume/resample/resample.h"

#include <optional>
#include <string_view>

/// Packing options, recorded in the archive.
namespace tessera::codec {

/// A wavelet. Auto: selected by trial on some bricks of each frame, among those whose coarse samples coincide with fine
/// ones.
enum class WaveletChoice : std::uint8_t { Auto, N1, N2, W11, W13, W15, W22, W24, W26, N4, W42, W44, W46 };
inline constexpr std::string_view kWaveletChoiceNames[] = {"auto", "1,0", "2,0", "1,1", "1,3", "1,5", "2,2",
                                                           "2,4",  "2,6", "4,0", "4,2", "4,4", "4,6"};
constexpr std::optional<Wavelet> waveletOf(WaveletChoice choice) {
    if (choice == WaveletChoice::Auto) return std::nullopt;
    return static_cast<Wavelet>(static_cast<int>(choice) - 1);
}

/// Transform of BCC: each sublattice separately, or the odd one predicted from the even one. Auto: the shorter one, by
/// trial.
enum class BccTransform : std::uint8_t { Auto, Separable, BodyCentred };
inline constexpr std::string_view kBccTransformNames[] = {"auto", "separable", "bodyCentred"};

/// The lattice of the stored samples.
enum class StoredLattice : std::uint8_t { CC, BCC, D4 };
inline constexpr std::string_view kStoredLatticeNames[] = {"cc", "bcc", "d4"};

/// Packing options, described once for widgets, JSON and command line.
struct PackOptions {
    StoredLattice lattice = StoredLattice::CC;
    volume::ResampleOptions resample;
    bool lossless = true;
    double maxError = 0;
    double absError = 0;
    double psnr = 0;
    bool ofComponents = false;
    bool regionNumbers = true;
    double sizeMb = 0;
    ThresholdOptions threshold;
    double discard = 0;
    WaveletChoice wavelet = WaveletChoice::Auto;
    BccTransform bccTransform = BccTransform::Auto;
    int brickSize = 0;
    int levels = 0;
    int effort = 5;
    int zstdLevel = 9;
    int mostPredicted = 7;
    double memoryMb = 0;
    volume::ImportanceOptions importance;

    bool operator==(const PackOptions&) const = default;
    /// Presets for common purposes.
    static constexpr std::string_view kPresetNames[] = {"none", "lossless", "visual", "small", "thesis"};
    static constexpr std::string_view kPresetDoc =
        "Preset, which other options override: lossless (every sample of the source), visual (error 0.001 of "
        "range), small (error 0.01 of range, highest effort), thesis (BCC, bricks of 16, 3 levels, wavelet (2,2) on "
        "each sublattice, soft threshold by importance)";
    /// The options of one of kPresetNames; nullopt for other names.
    static std::optional<PackOptions> preset(std::string_view name);
    /// Whether a preset sets the lattice; others can be combined with any.
    static bool presetHasLattice(std::string_view name);
    static void describe(auto& self, auto&& visit) {
        visit(self.lattice,
              FieldInfo{.key = "lattice",
                        .doc = "Lattice of the stored samples: cc (the grid of the source), or resampled to bcc "
                               "(70.7 % of the samples) or d4 (50 %, in space and time, for eight evenly "
                               "spaced times or more)",
                        .names = kStoredLatticeNames});
        visit(self.resample, FieldInfo{"resample", "How samples of another lattice are computed"});
        visit(self.lossless, FieldInfo{"lossless", "Store every sample of the lattice bit for bit"});
        visit(self.maxError, FieldInfo{.key = "maxError",
                                       .doc = "Largest error of a sample, relative to the range of its parameter; a "
                                              "value above 0 replaces lossless",
                                       .unit = "of range",
                                       .range = Range{0, 1}});
        visit(self.absError, FieldInfo{.key = "absError",
                                       .doc = "Largest error of a sample, in the unit of its parameter; 0 = no such "
                                              "bound. The strictest of several bounds applies",
                                       .unit = "of the parameter",
                                       .range = Range{0, 1e30}});
        visit(self.psnr, FieldInfo{.key = "psnr",
                                   .doc = "Smallest peak signal-to-noise ratio at any time (range of the parameter / "
                                          "RMS error); 0 = no such bound",
                                   .unit = "dB",
                                   .range = Range{0, 200}});
        visit(self.ofComponents,
              FieldInfo{"ofComponents",
                        "Bounds relative to the range of a vector are relative to that of each component by "
                        "itself, instead of the widest one"});
        visit(self.regionNumbers,
              FieldInfo{"regionNumbers",
                        "With an error bound, keep means, extremes and balances of everything and of each "
                        "region as computed from the source: about a kilobyte for each time"});
        visit(self.sizeMb, FieldInfo{.key = "targetSize",
                                     .doc = "Largest size of the archive; the smallest error relative to the ranges "
                                            "that fits is searched for. 0 = no limit",
                                     .unit = "MB",
                                     .range = Range{0, 1e9}});
        visit(self.threshold, FieldInfo{"threshold", "Wavelet thresholding in addition to rounding. Bounds still hold; "
                                                     "without one the error is measured and stored"});
        visit(self.discard, FieldInfo{.key = "discard",
                                      .doc = "Omit bricks that are less important than this in every parameter at "
                                             "every time: their samples become absent; 0 = none",
                                      .unit = "importance",
                                      .range = Range{0, 1}});
        visit(self.wavelet, FieldInfo{.key = "wavelet",
                                      .doc = "Vanishing moments N,N~ of the integer wavelet; auto: chosen by trial",
                                      .names = kWaveletChoiceNames});
        visit(self.bccTransform, FieldInfo{.key = "bccTransform",
                                           .doc = "For BCC: transform each sublattice by itself (separable), or "
                                                  "predict one from the other (bodyCentred); auto: chosen by trial",
                                           .names = kBccTransformNames});
        visit(self.brickSize,
              FieldInfo{
                  .key = "brickSize",
                  .doc = "Edge of a brick, a power of two; 0 = automatic: 64; 128 for numbers with an error bound in "
                         "volumes of at most 128^3 samples, and for a small integer volume",
                  .unit = "texel",
                  .range = Range{0, 128}});
        visit(self.levels, FieldInfo{.key = "levels",
                                     .doc = "Number of levels of detail; 0 = until a brick is 4 samples wide",
                                     .range = Range{0, 8}});
        visit(self.effort,
              FieldInfo{.key = "effort",
                        .doc = "Time spent on a shorter archive. Up to 3 no filter is tried, and zstd works at level 3 "
                               "at most. From 7 on samples are also predicted by weights fitted to them, by which "
                               "scans gain most; such archives take ten times as long to pack, with 9 twenty, and two "
                               "to three times as long to read. With 9 data of integers get bricks of 128, too",
                        .range = Range{1, 9}});
        visit(self.zstdLevel, FieldInfo{.key = "zstdLevel",
                                        .doc = "Effort of zstd, which codes masks and repetitive bricks",
                                        .range = Range{1, 19}});
        visit(self.mostPredicted,
              FieldInfo{.key = "mostPredicted",
                        .doc = "Numbers with an error bound: longest run of times that are stored as differences from "
                               "the time before, where that is shorter; to read one, those before it in the run are "
                               "decoded, too. 0 = each time by itself",
                        .unit = "times",
                        .range = Range{0, 15}});
        visit(
            self.memoryMb,
            FieldInfo{
                .key = "memory",
                .doc =
                    "Limit of memory for packing; 0 = a quarter of the machine's, shared by the processes that mpirun "
                    "or srun start on it. With little memory, data are not "
                    "compared with the previous time, not read ahead, and read in slabs if one time does not fit",
                .unit = "MB",
                .range = Range{0, 1e9}});
        visit(self.importance, FieldInfo{"importance", "How the importance of a brick is computed from its samples"});
    }
};

bool hasThreshold(const PackOptions& options);
/// Whether the options keep all samples exactly, except in omitted bricks.
bool isExact(const PackOptions& options);
/// Whether bounds are relative to the range over all times, which must be known before the first one is coded.
bool isRelative(const PackOptions& options);

} // namespace tessera::codec
