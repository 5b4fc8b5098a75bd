#include "codec/blocks/join.h"

#include "codec/archive/append_frames.h"
#include "codec/archive/archive.h"
#include "codec/archive/brick_access.h"
#include "codec/pack/continuation.h"

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

} // namespace

bool canJoin(const std::string& path, const std::string& more) {
    const Archive archive(path), added(more);
    return !archive.metadata().alternating && !added.metadata().alternating && codingOf(archive) == codingOf(added) &&
           bringsTimes(archive, added.info());
}

PackSummary join(const std::string& path, const std::string& more) {
    const auto begin = std::chrono::steady_clock::now();
    const Archive archive(path), added(more);
    if (archive.metadata().alternating || added.metadata().alternating)
        throw Error("archives on D4* cannot be joined", more);
    if (codingOf(archive) != codingOf(added)) throw Error("it was packed with other options than " + path, more);
    if (!bringsTimes(archive, added.info())) throw Error("it has no parameter of " + path, more);
    Metadata now = added.metadata();
    const Continuation place = continuationOf(archive, now);
    place.widen(added.info(), now.info);
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
