#include "bench/pictures/least_sample.h"

#include "bench/pictures/bench_volumes.h"
#include "vis/packet/packet_scene.h"
#include "volume/sources/memory_source.h"

#include <algorithm>
#include <ctime>
#include <numeric>

namespace tessera::app {

namespace {

constexpr int kRepeats = 5; ///< the fastest counts: whatever else runs only delays

/// Nanoseconds of processor time that a call takes at least.
template <class Call> double leastNs(const Call& call) {
    double least = 1e300;
    for (int i = 0; i < kRepeats; ++i) {
        const std::clock_t begin = std::clock();
        call();
        least = std::min(least, 1e9 * double(std::clock() - begin) / CLOCKS_PER_SEC);
    }
    return least;
}

template <class Value> void keep(const Value& value) {
    asm volatile("" : : "r"(&value) : "memory"); // whoever computes it may not leave it out
}

float readBy(vis::packet::InstructionSet with, const vis::packet::VolumeView& volume, int rounds, long& taken) {
#ifdef TESSERA_X86
    if (with == vis::packet::InstructionSet::Avx512) return readAvx512(volume, rounds, taken);
    if (with == vis::packet::InstructionSet::Avx2) return readAvx2(volume, rounds, taken);
#endif
    (void)with;
    return readPlain(volume, rounds, taken);
}

double sampleNs(volume::LatticeKind lattice) {
    constexpr int kRounds = 20000;
    const BenchVolume noise = phantomVolume(2 * vis::packet::kBrick);
    const auto source = volume::makeMemorySource(benchDataset(noise), {.lattice = lattice});
    const vis::packet::PacketVolume volume = vis::packet::readPacketVolume(*source, {});
    const vis::packet::VolumeView view = vis::packet::viewOf(volume);
    long taken = 0;
    const double ns = leastNs([&] {
        taken = 0;
        keep(readBy(vis::packet::instructionSets().back(), view, kRounds, taken));
    });
    return ns / double(taken);
}

double memoryGigabytes() {
    const std::vector<std::uint64_t> words(std::size_t(1) << 24, 1); // 128 MiB: more than caches hold
    const double ns = leastNs([&] { keep(std::accumulate(words.begin(), words.end(), std::uint64_t(0))); });
    return double(words.size() * sizeof words[0]) / ns;
}

} // namespace

LeastCost leastCost() {
    return {{sampleNs(volume::LatticeKind::CC), sampleNs(volume::LatticeKind::BCC)}, memoryGigabytes()};
}

} // namespace tessera::app
