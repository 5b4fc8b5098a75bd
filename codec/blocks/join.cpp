#include "codec/blocks/join.h"

#include "codec/archive/archive.h"
#include "codec/archive/brick_access.h"
#include "codec/blocks/append_frames.h"
#include "codec/pack/continuation.h"

#include <algorithm>
#include <chrono>
#include <vector>

namespace tessera::codec {

namespace {

/// The options that an archive's samples depend on.
PackOptions codingOf(const Archive& archive) {
    PackOptions options = archive.metadata().options;
    options.memoryMb = 0;
    return options;
}

/// Whether a parameter has no sample at any time.
bool holdsNothing(const Archive& archive, int parameter) {
    const int channel = archive.info().channelIndex(parameter, 0);
    for (int time = 0; time < int(archive.info().times.size()); ++time)
        for (std::size_t brick = 0; brick < archive.grid().brickCount(); ++brick)
            if (archive.stats({channel, time, 0, archive.grid().indexOf(brick)}).presentFraction > 0) return false;
    return true;
}

/// The range of a parameter without samples is stated as 0 to 0, which says nothing of another archive's.
void forgetEmpty(const Archive& archive, volume::DatasetInfo& info) {
    const auto isZero = [](const Range& range) { return range.lo == 0 && range.hi == 0; };
    for (std::size_t p = 0; p < archive.info().parameters.size(); ++p)
        for (volume::Parameter& parameter : info.parameters)
            if (parameter.name == archive.info().parameters[p].name && std::ranges::all_of(parameter.ranges, isZero) &&
                holdsNothing(archive, int(p)))
                parameter.ranges.clear();
}

} // namespace

bool canJoin(const std::string& path, const std::string& more) {
    const Archive archive(path), added(more);
    const auto named = [](const Archive& of) {
        std::vector<std::string> names;
        for (const volume::Parameter& parameter : of.info().parameters) names.push_back(parameter.name);
        std::ranges::sort(names);
        return names;
    };
    return !archive.metadata().alternating && !added.metadata().alternating && codingOf(archive) == codingOf(added) &&
           codedAlike(archive, added) && archive.grid().brickSize == added.grid().brickSize &&
           archive.grid().levels == added.grid().levels && named(archive) == named(added);
}

PackSummary join(const std::string& path, const std::string& more) {
    const auto begin = std::chrono::steady_clock::now();
    const Archive archive(path), added(more);
    if (archive.metadata().alternating || added.metadata().alternating)
        throw Error("archives on D4* cannot be joined", more);
    if (codingOf(archive) != codingOf(added)) throw Error("it was packed with other options than " + path, more);
    Metadata now = added.metadata();
    const Continuation place = continuationOf(archive, now);
    forgetEmpty(archive, now.info);
    volume::DatasetInfo info = added.info();
    forgetEmpty(added, info);
    place.widen(info, now.info);
    for (std::size_t p = 0; p < archive.info().parameters.size(); ++p) // absent in both
        if (now.info.parameters[p].ranges.empty()) now.info.parameters[p].ranges = archive.info().parameters[p].ranges;
    place.noteResampled(added.metadata().resampled, {}, now);
    PackSummary summary;
    const std::uint64_t samples = added.info().lattice.count() * added.info().times.size();
    std::vector<std::size_t> componentOf;
    for (std::size_t p = 0; p < place.parameterOf.size(); ++p) {
        const volume::Parameter& parameter = added.info().parameters[p];
        for (int c = 0; c < parameter.components; ++c)
            componentOf.push_back(firstComponent(now.info, place.parameterOf[p]) + std::size_t(c));
        summary.storedSamples += samples * std::uint64_t(parameter.components);
        summary.storedBytes += samples * std::uint64_t(parameter.components) * volume::byteSize(parameter.type);
    }
    summary.sourceSamples = summary.storedSamples;
    summary.sourceBytes = summary.storedBytes;
    summary.bricks = now.grid.brickCount();
    summary.maxError = now.maxError;
    summary.archiveBytes = appendFrames(archive, added, now, componentOf);
    summary.addedBytes = summary.archiveBytes - archive.fileBytes();
    summary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return summary;
}

} // namespace tessera::codec
