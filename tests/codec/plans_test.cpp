#include "codec/bytes/lzma.h"
#include "codec/container/container.h"
#include "codec/container/metadata.h"
#include "codec/pack/memory_plan.h"
#include "tests/codec/least_memory.h"
#include "tests/codec/make_dataset.h"
#include "volume/base/error.h"
#include "volume/resample/resample.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

/// What is decided before a sample is read, and what is said of it.
namespace tessera::codec {
namespace {

using namespace testing;
using volume::ScalarType;

Metadata metadataOf(const volume::DatasetInfo& info, volume::LatticeKind kind) {
    Metadata metadata;
    metadata.info = info;
    metadata.source = info.lattice;
    if (kind == volume::LatticeKind::BCC) metadata.info.lattice = volume::bccFor(info.lattice);
    metadata.grid = {metadata.info.lattice, 32, 3, 0};
    metadata.program = "a test";
    return metadata;
}

// Of a slab at least its source, its result, and for sharpening two copies of both, with a flag each, are in memory.
TEST(MemoryPlan, SlabsFitTheLimit) {
    volume::Dataset made;
    made.info.lattice = {volume::LatticeKind::CC, {128, 128, 4096}, {1, 1, 1}, {0, 0, 0}};
    made.info.parameters = {{"v", "", 1, ScalarType::F32, false, {}, {}}};
    made.read = [](int, int, int, volume::SliceRange) { return volume::Field(); };
    const Metadata metadata = metadataOf(made.info, volume::LatticeKind::BCC);
    for (const double limit : {300.0, 600.0}) {
        for (const double sharpen : {0.0, 0.5}) {
            PackOptions options;
            options.memoryMb = limit;
            options.resample.sharpen = sharpen;
            const MemoryPlan plan = planMemory(metadata, made, options, 0);
            const glm::ivec3 size = metadata.info.lattice.size;
            const double texels = plan.slabLayers * 32, stored = double(size.x) * size.y * 2 * texels,
                         source = 128 * 128 * texels * metadata.info.lattice.spacing.z;
            const double bytes = (stored + source) * (sizeof(float) + 1) * (sharpen > 0 ? 3 : 1);
            EXPECT_LE(bytes, limit * 1e6) << sharpen;
            EXPECT_GE(bytes, 0.2 * limit * 1e6) << sharpen << ": with all that is needed besides";
        }
    }
}

/// The least memory, in MB, for packing on so many threads.
double leastOn(int threads, const Metadata& metadata, const volume::Dataset& made, PackOptions options) {
    return tbb::task_arena(threads).execute([&] {
        return leastMemory([&](double limit) {
            options.memoryMb = limit;
            (void)planMemory(metadata, made, options, 0);
        });
    });
}

// Every thread codes a brick of its own, as long as there are bricks in a batch.
TEST(MemoryPlan, CountsTheBricksOfAllThreads) {
    volume::Dataset made = makeDataset({256, 128, 256}, {{"v", ScalarType::U16}}, 1);
    Metadata metadata = metadataOf(made.info, volume::LatticeKind::CC);
    PackOptions options;
    options.lattice = StoredLattice::CC;
    metadata.grid.brickSize = 64; // 32 bricks, each of which takes 15 bytes a sample while it is coded
    const double one = leastOn(1, metadata, made, options), brick = 64 * 64 * 64 * 15e-6;
    EXPECT_GT(one, 64 + 256 * 128 * 256 * 9e-6);
    EXPECT_NEAR(leastOn(16, metadata, made, options), one + 15 * brick, 0.2);
    EXPECT_NEAR(leastOn(100, metadata, made, options), one + 31 * brick, 0.2);
    metadata.grid.brickSize = 128; // 4 bricks
    const double large = leastOn(1, metadata, made, options);
    EXPECT_NEAR(leastOn(100, metadata, made, options), large + 3 * 8 * brick, 0.2);
}

// A brick whose coefficients may be quantised takes 33 bytes a sample while it is coded, another one 17.
TEST(MemoryPlan, CountsBricksThatAreCodedWithinABound) {
    volume::Dataset made = makeDataset({100, 100, 100}, {{"v"}}, 1);
    Metadata metadata = metadataOf(made.info, volume::LatticeKind::CC);
    metadata.grid.brickSize = 128;
    PackOptions options;
    options.lattice = StoredLattice::CC;
    options.memoryMb = 98;
    EXPECT_NO_THROW((void)planMemory(metadata, made, options, 0));
    options.memoryMb = 94;
    EXPECT_THROW((void)planMemory(metadata, made, options, 0), Error);
    options.memoryMb = 98;
    options.maxError = 1e-3;
    EXPECT_THROW((void)planMemory(metadata, made, options, 0), Error);
    options.memoryMb = 120;
    EXPECT_NO_THROW((void)planMemory(metadata, made, options, 0));
}

TEST(MetadataText, MistakesAreNamedByPlaceAndReason) {
    const volume::DatasetInfo info = makeDataset({9, 8, 7}, {{"v", ScalarType::U8}}, 1).info;
    Bytes plain;
    ASSERT_EQ(decodeBlock(serialise(metadataOf(info, volume::LatticeKind::CC), kCompact), plain), DecodeStatus::Ok);
    const std::string text(reinterpret_cast<const char*>(plain.data()), plain.size());
    const auto problem = [&](const std::string& from, const std::string& to) {
        std::string changed = text;
        const std::size_t at = changed.find(from);
        EXPECT_NE(at, std::string::npos) << from << " in " << text;
        changed.replace(at, from.size(), to);
        try {
            parseMetadata(encodeBlock(std::as_bytes(std::span(changed))), kCompact, "a.tsr");
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(problem("\"v\"", "\"w\""), "");
    EXPECT_EQ(problem("\"brickSize\":32", "\"brickSize\":33"), "a.tsr: metadata /grid/brickSize: not a power of two");
    EXPECT_EQ(problem("\"brickSize\":32", "\"brickSize\":2"), "a.tsr: metadata /grid/brickSize: not between 4 and 128");
    EXPECT_EQ(problem("\"lossless\":true", "\"lossless\":1"), "a.tsr: metadata /lossless: not true or false");
    EXPECT_EQ(problem("\"program\"", "\"programme\""), "a.tsr: metadata : the key 'program' is missing");
}

} // namespace
} // namespace tessera::codec
