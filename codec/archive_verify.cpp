#include "codec/archive_impl.h"
#include "volume/parallel.h"

#include <atomic>
#include <mutex>

namespace tessera::codec {

/// The work of verifyArchive, with access to the parts of an archive.
struct Verifier {
    const Archive::Impl& impl;
    VerifyReport report;
    std::mutex mutex;

    void note(const std::string& what) {
        const std::lock_guard lock(mutex);
        ++report.damaged;
        if (report.damage.size() < 100) report.damage.push_back(what);
    }

    template <class Body> void guarded(const std::string& what, Body&& body) {
        try {
            body();
        } catch (const Error& error) {
            note(what + ": " + error.place() + ": " + error.reason());
        }
    }

    void frame(std::size_t number) {
        const FrameRecord& record = impl.index.frames[number];
        const std::size_t time = number / impl.components;
        std::size_t component = number % impl.components, parameter = 0;
        const auto& parameters = impl.metadata.info.parameters;
        while (component >= std::size_t(parameters[parameter].components))
            component -= std::size_t(parameters[parameter++].components);
        std::atomic<std::uint64_t> bytes = 0, samples = 0;
        parallelFor(impl.bricks, [&](std::size_t brick) {
            const glm::ivec3 at = brickIndex(impl.metadata.grid, brick);
            const std::string where = parameters[parameter].name + " component " + std::to_string(component) +
                                      " time " + std::to_string(time) + " brick " + std::to_string(at.x) + "," +
                                      std::to_string(at.y) + "," + std::to_string(at.z);
            guarded(where, [&] {
                if (record.bricks[brick].notes.repeats > 0) { // decoded with the one it repeats
                    samples += countOf(impl.metadata.grid.brickSamples(at, 0));
                    return;
                }
                const BrickFormat format = brickFormat(impl.metadata.grid, at, parameters[parameter].type, record);
                const std::vector<std::uint8_t> fine = impl.flags(record, brick);
                const Lent decoded(impl);
                for (int level = impl.metadata.grid.levels - 1; level >= 0; --level) {
                    impl.decode(record, format, brick, level, fine, *decoded);
                    if (level == 0) samples += countOf(decoded->size);
                    const std::size_t s = std::size_t(format.levels - 1 - level);
                    bytes += record.segments[s * impl.bricks + brick].length;
                }
                if (!impl.hasTallies()) return;
                const FrameBrick& noted = record.bricks[brick];
                const volume::ScalarType type = parameters[parameter].type;
                const TalliedBrick found = tallied(type, record.valueOffset, record.valueScale,
                                                   impl.numbersOf(record, type, *decoded), fine, true);
                if (!agree(found, noted.min, noted.max, noted.tally))
                    throw Error("its statistics are not those of its samples", impl.path, "index");
            });
        });
        report.bricks += impl.bricks;
        report.samples += samples;
        report.bytes += bytes;
    }

    void headers() {
        if (impl.header.damaged) note("header: byte 0: one of its two copies is damaged");
    }

    void formerMetadata() {
        for (const Block& block : impl.index.retired) {
            guarded("former metadata", [&] {
                (void)checkedPart(impl.file.bytes(), block.offset, block.length, block.checksum, impl.path, "it");
            });
            report.bytes += block.length;
        }
    }

    void models() {
        for (std::size_t m = 0; m < impl.index.models.size(); ++m) {
            guarded("model " + std::to_string(m), [&] { (void)impl.decoder(static_cast<std::int32_t>(m)); });
            report.bytes += impl.index.models[m].length;
        }
    }

    /// Masks no brick above has read; their bytes are counted here.
    void masks() {
        for (std::size_t m = 0; m < impl.index.masks.size(); ++m) {
            FrameRecord user;
            user.mask = static_cast<std::int32_t>(m);
            for (std::size_t brick = 0; brick < impl.bricks; ++brick)
                guarded("mask " + std::to_string(m), [&] { (void)impl.flags(user, brick); });
            report.bytes += impl.index.masks[m].length;
        }
    }
};

VerifyReport verifyArchive(const Archive& archive, const Progress& progress) {
    // One header, metadata and index were checked when the archive was opened.
    const Archive::Impl& impl = *archive.impl_;
    Verifier verifier{impl, {}, {}};
    verifier.headers();
    verifier.formerMetadata();
    verifier.models();
    verifier.masks();
    const std::size_t frames = impl.index.frames.size();
    for (std::size_t f = 0; f < frames; ++f) {
        progress.advance(double(f) / double(frames));
        verifier.frame(f);
    }
    progress.advance(1);
    return std::move(verifier.report);
}

} // namespace tessera::codec
