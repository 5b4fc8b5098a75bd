#include "codec/pack/pack_numbers.h"

#include "codec/container/coded_numbers.h"
#include "volume/import/import.h"
#include "volume/sources/layer_source.h"
#include "volume/sources/memory_source.h"

#include <algorithm>

namespace tessera::codec {

namespace {

constexpr int kBrickOfNumbers = 32; ///< as of files, whose numbers are summed in the same order

volume::ComputedNumbers computedFrom(volume::Dataset source, std::size_t bytes, const Progress& progress) {
    const std::size_t cacheBytes = std::min(volume::BalanceQuery().cacheBytes, bytes / 4), budget = bytes / 2;
    const bool inParts = source.read.inParts() && source.info.lattice.kind == volume::LatticeKind::CC;
    const volume::LatticeKind kind = source.info.lattice.kind;
    const auto bricks =
        inParts ? volume::makeLayerSource(std::move(source), kBrickOfNumbers, budget)
                : volume::makeMemorySource(std::move(source),
                                           {.lattice = kind, .brickSize = kBrickOfNumbers, .budget = budget});
    const double times = double(bricks->info().times.size());
    volume::ComputedNumbers numbers;
    for (int time = 0; time < int(bricks->info().times.size()); ++time)
        numbers.push_back(volume::computeNumbers(*bricks, time, cacheBytes,
                                                 progress.part(double(time) / times, double(time + 1) / times)));
    return numbers;
}

/// The data with the ranges of the parameters that are known elsewhere; the others are found.
volume::Dataset withRanges(volume::Dataset data, const volume::DatasetInfo& known, const Progress& progress) {
    for (volume::Parameter& parameter : data.info.parameters)
        for (const volume::Parameter& same : known.parameters)
            if (parameter.ranges.empty() && same.name == parameter.name) parameter.ranges = same.ranges;
    const auto lacks = [](const volume::Parameter& parameter) {
        return !parameter.categorical && parameter.ranges.empty();
    };
    if (std::ranges::any_of(data.info.parameters, lacks)) volume::scanRanges(data, progress);
    return data;
}

/// What the last block of numbers of an archive is of; "" if there is none that can be read.
std::string shapeBefore(const Archive* grown) {
    try {
        const auto numbers = grown ? grown->numbers() : nullptr;
        return numbers ? numbers->shape : std::string();
    } catch (const Error&) {
        return {};
    }
}

} // namespace

std::string addNumbers(ArchiveWriter& writer, const volume::Dataset& source, const PackedBefore& before,
                       const Archive* grown, const MemoryPlan& memory, Metadata& metadata, const Progress& progress) {
    // What the format keeps of a region counts every sample alike; cells of uneven axes differ in volume.
    if (!metadata.options.regionNumbers || !metadata.source.isEven()) return {};
    const volume::Dataset& from = before.whole ? *before.whole : source;
    volume::ComputedNumbers numbers;
    if (before.numbers)
        numbers = volume::selectedNumbers(before.numbers->numbers, from.info);
    else if (!before.lossless || before.maxError > 0 || !before.resampled.empty())
        return "numbers of regions are left out: those of the source are not known";
    else if (memory.numberBytes == 0)
        return "too little memory for numbers of regions: they are left out";
    else
        numbers = computedFrom(withRanges(from, source.info, {{}, progress.stop}), memory.numberBytes, progress);
    std::string shape = shapeBefore(grown);
    for (const Bytes& block : encodeNumbers(numbers, shape))
        metadata.numbers.push_back(writer.addPart(block, kRegionNumbers));
    return {};
}

} // namespace tessera::codec
