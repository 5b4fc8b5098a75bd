#pragma once

#include <string>
#include <vector>

/// The tables that `tessera bench` prints. Rows that are compared are measured right after each other, so that ratios
/// are valid even on a busy machine.
namespace tessera::app {

struct BenchTable {
    std::string name; ///< also its key in --json
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows; ///< one text per column; numbers as plain decimals without units
};

/// A number with so many decimals, for a cell of a table.
std::string decimals(double value, int digits);

/// Processor seconds and memory of commands for inputs of rising sizes, and how they grow. To be measured first: no
/// program is seen to take less memory than this one has taken so far. `only`: inputs whose name contains it.
BenchTable benchGrowth(const std::string& only);
/// Seconds from a command to the picture of its window, of this program and of others at hand, and of `tessera info`.
BenchTable benchStart();
/// Reconstruction error of CC and BCC, with each filter, at equal and at 70.7 % of the samples, and of D4* at 50 %.
BenchTable benchLattice();
/// Archives on BCC with three transforms: each sublattice separately, both as one array, and one predicted from the
/// other.
BenchTable benchBccTransforms();
/// Archives on BCC and D4*, beside CC archives with the same error against the samples of the source.
BenchTable benchLatticeBytes();
/// Archives of one signal on CC and BCC, with the numbers of samples that give equal error.
BenchTable benchSignalBytes();
/// Seconds to resample a volume to BCC with each filter, and a series to D4*.
BenchTable benchResample();
/// Pack throughput and archive size against raw and against zstd -19 of the same bytes.
BenchTable benchCodec();
/// Packing within an error bound: the built-in cell, which has parts, on CC and BCC, and volumes of floats.
BenchTable benchBounded();
/// Archives beside zstd and whatever else is installed (lz4, xz, blosc, HDF5, OpenJPEG, zfp), in one process.
BenchTable benchPeers();
/// Time to decode coarse levels and single bricks beside whole frames, and frames on two threads beside one.
BenchTable benchLevels();
/// Tables 6.1 and 6.2, 6.4, 6.5, 6.3 of the thesis, its numbers beside ours for the volumes at hand.
BenchTable benchThesisSizes();
/// Bricks by importance, merged in each way, and their size if merged bricks were coded as one.
BenchTable benchBricks();
BenchTable benchThesisCoding();
BenchTable benchThesisFrames();
BenchTable benchThesisPictures();
/// CPU milliseconds of all threads per frame at 512x512 beside VTK's mappers where they are at hand, with geometric
/// means over the volumes. `volume`: only those whose name contains it.
BenchTable benchRender(const std::string& volume);
/// CPU milliseconds of refined pictures by the processor: rays where they are needed beside all rays everywhere, and
/// the likeness of both pictures. `volume` as above.
BenchTable benchRefined(const std::string& volume);
/// Milliseconds per frame of the fuel cell's temperature in each look, beside plain compositing.
BenchTable benchStyles();
/// Milliseconds until every view shows what is dragged, on a fuel cell of 64x64x256 volumes, and the share of each.
BenchTable benchLink();
/// Milliseconds until a scatterplot matrix shows its first counts and all of them, and until it follows a brush.
BenchTable benchScatter();
/// Milliseconds until a time of 256^3 bytes that was not shown before is first seen, and until it is refined.
BenchTable benchNewData();
/// Pictures a second while two series are played for the first time, from memory and from archives.
BenchTable benchPlaying();
/// From an archive of 250x250x1000 samples to the first picture, to every view refined, and what dragging costs then.
BenchTable benchLarge();
/// Every mode of the ray caster on small, 256^3 and full-model volumes: CPU milliseconds of all threads per frame at
/// 512x512, samples taken, bytes in textures, error against the double-precision reference. `volume` as above.
BenchTable benchModes(const std::string& volume);

} // namespace tessera::app
