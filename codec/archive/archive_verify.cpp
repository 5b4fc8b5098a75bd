#include "codec/archive/archive_impl.h"
#include "codec/brick/subsamples.h"
#include "codec/container/exactness.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <mutex>

namespace tessera::codec {

/// State of verifyArchive, with access to the internals of an archive.
struct Verifier {
    const Archive::Impl& impl;
    VerifyReport report;
    std::mutex mutex;
    std::vector<std::uint8_t> badModels, badMasks, badBricks; ///< per model; per mask and brick; per frame and brick

    void note(const std::string& what) {
        const std::lock_guard lock(mutex);
        ++report.damaged;
        if (report.damage.size() < 100) report.damage.push_back(what);
    }

    /// Runs `body`; if it throws Error, reports it and returns false. Throws ReadError.
    template <class Body> bool guarded(const std::string& what, Body&& body) {
        try {
            body();
            return true;
        } catch (const ReadError&) {
            throw; // not read, so not known to be damaged
        } catch (const Error& error) {
            note(what + ": " + error.place() + ": " + error.reason());
            return false;
        }
    }

    /// False also for a brick whose own bytes are damaged.
    bool isPredicted(const FrameRecord& record, std::size_t brick) const {
        try {
            return impl.depthOf(record, brick) > 0;
        } catch (const ReadError&) {
            throw;
        } catch (const Error&) {
            return false;
        }
    }

    /// Whether data that a brick depends on besides its own bytes were found damaged.
    bool lacks(std::size_t number, std::size_t brick) const {
        const FrameRecord& record = impl.index.frames[number];
        const std::size_t repeats = std::size_t(record.bricks[brick].notes.repeats);
        if (repeats > 0) return badBricks[(number - repeats * impl.components) * impl.bricks + brick] != 0;
        if (record.mask >= 0 && badMasks[std::size_t(record.mask) * impl.bricks + brick] != 0) return true;
        if (const FrameRecord* const before = record.predicted ? impl.before(record) : nullptr) {
            const auto from = std::size_t(before - impl.index.frames.data());
            if (badBricks[from * impl.bricks + brick] != 0 && isPredicted(record, brick)) return true;
        }
        return badModels[std::size_t(record.model)] != 0;
    }

    /// Decodes a brick at every level. Returns the bytes of its segments; throws Error.
    std::uint64_t brick(const FrameRecord& record, const volume::Parameter& parameter, std::size_t brick) {
        const glm::ivec3 at = impl.metadata.grid.indexOf(brick);
        const BrickFormat format = brickFormat(impl.metadata.grid, at, parameter.type, record);
        impl.fetchBrick(record, brick, impl.metadata.grid.levels);
        const std::vector<std::uint8_t> fine = impl.flags(record, brick);
        const PooledBrick decoded(impl);
        std::uint64_t bytes = 0;
        for (int level = impl.metadata.grid.levels - 1; level >= 0; --level) {
            impl.decode(record, format, brick, level, fine, *decoded);
            const std::size_t s = std::size_t(format.levels - 1 - level);
            bytes += record.segments[s * impl.bricks + brick].length;
        }
        const Bytes numbers = impl.numbersOf(record, parameter.type, *decoded);
        if (format.subsampled && decoded->subsamples != subsamplesOf(format, numbers, fine))
            throw Error("its coarsest samples differ from those of level 0", impl.path, "index");
        const FrameBrick& noted = record.bricks[brick];
        const bool counted = impl.hasStatistics();
        const BrickSummary found =
            summaryOf(parameter.type, record.valueOffset, record.valueScale, numbers, fine, counted);
        if (counted ? !agree(found, noted.min, noted.max, noted.histogram) : !sameRange(found, noted))
            throw Error(counted ? "its statistics differ from those of its samples"
                                : "its range differs from that of its samples",
                        impl.path, "index");
        return bytes;
    }

    /// Of a brick and what is stated of it, or of another. None has any order where no sample is present.
    static bool sameRange(const auto& brick, const FrameBrick& noted) {
        if (!(brick.min <= brick.max)) return !(noted.min <= noted.max);
        return brick.min == noted.min && brick.max == noted.max;
    }

    /// A repeated brick has the range of the one whose samples it has.
    void repeat(std::size_t number, std::size_t brick) const {
        const FrameBrick& noted = impl.index.frames[number].bricks[brick];
        const std::size_t first = number - std::size_t(noted.notes.repeats) * impl.components;
        if (!sameRange(impl.index.frames[first].bricks[brick], noted))
            throw Error("its range differs from that of the brick it repeats", impl.path, "index");
    }

    void frame(std::size_t number) {
        const FrameRecord& record = impl.index.frames[number];
        const std::size_t time = number / impl.components;
        const auto& parameters = impl.metadata.info.parameters;
        const std::size_t parameter = parameterOf(impl.metadata.info, number % impl.components);
        const std::size_t component = number % impl.components - firstComponent(impl.metadata.info, int(parameter));
        std::atomic<std::uint64_t> bytes = 0, samples = 0, bad = 0;
        parallelFor(impl.bricks, [&](std::size_t brick) {
            const glm::ivec3 at = impl.metadata.grid.indexOf(brick);
            const std::string where = parameters[parameter].name + " component " + std::to_string(component) +
                                      " time " + std::to_string(time) + " brick " + std::to_string(at.x) + "," +
                                      std::to_string(at.y) + "," + std::to_string(at.z);
            const bool lacking = lacks(number, brick), repeats = record.bricks[brick].notes.repeats > 0;
            bool whole = true;
            if (lacking && !repeats) // its own bytes may be damaged too
                whole = guarded(where, [&] {
                    for (std::size_t s = brick; s < record.segments.size(); s += impl.bricks)
                        (void)impl.segment(record.segments[s]);
                });
            else if (repeats) // its samples were checked with the brick it repeats
                whole = guarded(where, [&] { repeat(number, brick); });
            else
                whole = guarded(where, [&] { bytes += this->brick(record, parameters[parameter], brick); });
            if (whole && !lacking)
                samples += countOf(impl.metadata.grid.brickSamples(at, 0));
            else
                badBricks[number * impl.bricks + brick] = 1, ++bad;
        });
        report.bricks += impl.bricks;
        report.samples += samples;
        report.bytes += bytes;
        report.damagedBricks += bad;
    }

    /// The range of each component, as the metadata states it: colours and axes follow from it. It holds all samples of
    /// an archive that stores those of its source as they are.
    void ranges() {
        if (!impl.metadata.lossless || isResampled(impl.metadata)) return;
        for (std::size_t c = 0; c < impl.components; ++c) {
            const std::size_t number = parameterOf(impl.metadata.info, c);
            const volume::Parameter& parameter = impl.metadata.info.parameters[number];
            const std::size_t component = c - firstComponent(impl.metadata.info, int(number));
            if (component >= parameter.ranges.size()) continue;
            const Range stated = parameter.ranges[component];
            const bool isHeld = std::ranges::all_of(impl.index.frames, [&](const FrameRecord& frame) {
                return frame.component != c || std::ranges::all_of(frame.bricks, [&](const FrameBrick& brick) {
                           return !(brick.min <= brick.max) ||
                                  (brick.min >= float(stated.lo) && brick.max <= float(stated.hi));
                       });
            });
            if (!isHeld)
                note("metadata: the range of " + parameter.name + " component " + std::to_string(component) +
                     " leaves out some of its samples");
        }
    }

    /// The report on an archive inside this one.
    void add(const VerifyReport& inner) {
        report.bricks += inner.bricks;
        report.samples += inner.samples;
        report.bytes += inner.bytes;
        report.damaged += inner.damaged;
        report.damagedBricks += inner.damagedBricks;
        for (const std::string& line : inner.damage)
            if (report.damage.size() < 100) report.damage.push_back("corrections: " + line);
    }

    void headers() {
        report.damagedHeader = impl.header.damaged;
        if (impl.header.damaged) note("header: byte 0: one of its two copies is damaged");
    }

    void formerMetadata() {
        for (const Block& block : impl.index.retired) {
            guarded("former metadata", [&] { (void)checkedPart(*impl.bytes, block, impl.path, "it"); });
            report.bytes += block.length;
        }
    }

    /// The model or the steps of each frame, and models that no frame uses.
    void models() {
        const std::size_t count = impl.index.models.size();
        std::vector<FrameRecord> users(count);
        for (std::size_t m = 0; m < count; ++m) users[m].model = static_cast<std::int32_t>(m);
        for (const FrameRecord& frame : impl.index.frames)
            users[std::size_t(frame.model)].numbers.kind = frame.numbers.kind;
        for (std::size_t m = 0; m < count; ++m) {
            const auto load = [&] {
                if (users[m].numbers.kind == NumberKind::Stepped)
                    (void)impl.steps(users[m]);
                else
                    (void)impl.decoder(users[m]);
            };
            badModels.push_back(guarded("model " + std::to_string(m), load) ? 0 : 1);
            report.bytes += impl.index.models[m].length;
        }
    }

    /// Checks the masks before the bricks, so that each damage is reported once.
    void masks() {
        for (std::size_t m = 0; m < impl.index.masks.size(); ++m) {
            FrameRecord user;
            user.mask = static_cast<std::int32_t>(m);
            for (std::size_t brick = 0; brick < impl.bricks; ++brick)
                badMasks.push_back(guarded("mask " + std::to_string(m), [&] { (void)impl.flags(user, brick); }) ? 0
                                                                                                                : 1);
            report.bytes += impl.index.masks[m].length;
        }
    }
};

VerifyReport verifyArchive(const Archive& archive, const Progress& progress) {
    // The valid header, the metadata and the index were checked on opening.
    const Archive::Impl& impl = *archive.impl_;
    Verifier verifier{impl, {}, {}, {}, {}, {}};
    verifier.headers();
    verifier.formerMetadata();
    verifier.models();
    verifier.masks();
    const std::size_t frames = impl.index.frames.size();
    verifier.badBricks.resize(frames * impl.bricks);
    for (std::size_t f = 0; f < frames; ++f) {
        progress.advance(double(f) / double(frames));
        verifier.frame(f);
    }
    verifier.ranges();
    verifier.guarded("corrections", [&] {
        for (const auto& corrections : archive.corrections()) verifier.add(verifyArchive(*corrections));
    });
    verifier.guarded("numbers of regions", [&] { (void)archive.numbers(); });
    for (const FileRange& range : impl.metadata.numbers) verifier.report.bytes += range.length;
    progress.advance(1);
    return std::move(verifier.report);
}

} // namespace tessera::codec
