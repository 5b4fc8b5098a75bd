#include "codec/archive/archive.h"
#include "codec/bytes/lzma.h"
#include "codec/container/brick_histogram.h"
#include "codec/container/container.h"
#include "codec/pack/pack.h"
#include "tests/codec/make_dataset.h"
#include "tests/codec/plain/decoder.h"
#include "tests/codec/sealed_file.h"
#include "volume/analysis/statistics.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>

namespace tessera::codec {
namespace {

using namespace testing;
using volume::ScalarType;

/// Calls `visit(key)` for every brick of every channel and time.
template <class Visit> void forKeys(const volume::BrickSource& source, Visit&& visit) {
    const glm::ivec3 count = source.grid().count();
    for (int channel = 0; channel < int(source.info().channels().size()); ++channel)
        for (int time = 0; time < int(source.info().times.size()); ++time)
            for (int n = 0; n < count.x * count.y * count.z; ++n)
                visit(
                    volume::BrickKey{channel, time, 0, {n % count.x, n / count.x % count.y, n / (count.x * count.y)}});
}

/// What is noted of every brick is true of its samples.
void expectTrueDistributions(const Archive& archive) {
    const auto channels = archive.info().channels();
    int known = 0;
    forKeys(archive, [&](const volume::BrickKey& key) {
        const auto noted = archive.distribution(key);
        if (channels[std::size_t(key.channel)].magnitude) {
            EXPECT_FALSE(noted);
            return;
        }
        const volume::BrickSamples read = archive.read(key);
        std::vector<double> values;
        for (std::size_t i = 0; i < read.values.size(); ++i)
            if (read.isPresent(i)) values.push_back(double(read.values[i]));
        ASSERT_TRUE(noted);
        ASSERT_EQ(noted->samples, values.size());
        if (values.empty()) return;
        ++known;
        ASSERT_EQ(noted->range.lo, *std::min_element(values.begin(), values.end()));
        ASSERT_EQ(noted->range.hi, *std::max_element(values.begin(), values.end()));
        const double extent = noted->range.hi - noted->range.lo;
        double sum = 0;
        const std::size_t bins = noted->counts.size();
        std::vector<std::uint32_t> counts(bins, 0);
        for (const double value : values) {
            sum += value - noted->range.lo;
            const double place = extent > 0 ? (value - noted->range.lo) * double(bins) / extent : 0;
            ++counts[std::min(std::size_t(place), bins - 1)];
        }
        ASSERT_EQ(noted->counts, counts);
        ASSERT_NEAR(noted->mean - noted->range.lo, sum / double(values.size()),
                    extent * 1e-7 + std::abs(noted->mean) * 1e-15);
    });
    EXPECT_GT(known, 0);
}

PackOptions statisticsOptions(StoredLattice lattice, double maxError = 0) {
    PackOptions options;
    options.lattice = lattice;
    options.brickSize = 16;
    options.maxError = maxError;
    return options;
}

TEST(BrickDistribution, ArchivesSayWhatIsInTheirBricks) {
    const TemporaryFolder folder;
    for (const StoredLattice lattice : {StoredLattice::CC, StoredLattice::BCC, StoredLattice::D4})
        for (const double maxError : {0.0, 1e-3}) {
            volume::Dataset made = makeDataset({35, 18, 37}, everyKind(), lattice == StoredLattice::D4 ? 8 : 1);
            pack(made, statisticsOptions(lattice, maxError), folder / "a.tsr");
            const Archive archive(folder / "a.tsr");
            expectTrueDistributions(archive);
            EXPECT_EQ(verifyArchive(archive).damaged, 0u);
        }
}

// Of times and parameters that are appended as of those that were there at first; of bricks that repeat others too.
TEST(BrickDistribution, GrowingArchivesToo) {
    const TemporaryFolder folder;
    const std::vector<MadeParameter> kinds{{"a", ScalarType::U8, 1, Texture::Noise, true, false},
                                           {"c", ScalarType::U16, 1, Texture::Constant, false, false},
                                           {"f", ScalarType::F32, 1, Texture::Smooth, false, false}};
    const volume::Dataset all = makeDataset({20, 18, 37}, kinds, 4);
    const auto part = [&](int first, int count, std::size_t parameter, std::size_t parameters) {
        volume::Dataset some = all;
        some.info.times.assign(all.info.times.begin() + first, all.info.times.begin() + first + count);
        some.info.parameters.assign(all.info.parameters.begin() + std::ptrdiff_t(parameter),
                                    all.info.parameters.begin() + std::ptrdiff_t(parameter + parameters));
        // The last times are all the same.
        some.read = [read = all.read, first, parameter](int p, int c, int t) {
            return read(p + int(parameter), c, std::min(first + t, 2));
        };
        return some;
    };
    volume::Dataset whole = part(0, 4, 0, 3), begin = part(0, 2, 0, 2), end = part(2, 2, 0, 2), more = part(0, 4, 2, 1);
    pack(whole, statisticsOptions(StoredLattice::CC), folder / "whole.tsr");
    pack(begin, statisticsOptions(StoredLattice::CC), folder / "grown.tsr");
    append(end, folder / "grown.tsr");
    append(more, folder / "grown.tsr");
    const Archive once(folder / "whole.tsr"), grown(folder / "grown.tsr");
    EXPECT_GT(grown.repeats().bricks, 0u);
    expectTrueDistributions(grown);
    EXPECT_EQ(verifyArchive(grown).damaged, 0u);
    forKeys(once, [&](const volume::BrickKey& key) {
        const auto a = once.distribution(key), b = grown.distribution(key);
        ASSERT_TRUE(a && b);
        EXPECT_EQ(a->counts, b->counts);
        EXPECT_EQ(a->mean, b->mean);
    });
}

/// The last page of an archive, edited, and the file sealed again.
std::vector<char> withPage(const std::vector<char>& file, const std::function<void(Bytes&)>& edit) {
    const auto bytes = std::as_bytes(std::span(file));
    Header header = parseHeaders(bytes, file.size(), "test").header;
    Bytes page;
    EXPECT_EQ(decodeBlock(bytes.subspan(header.index.offset, header.index.length), page), DecodeStatus::Ok);
    edit(page);
    const Bytes packed = encodeBlock(page);
    Bytes out(bytes.begin(), bytes.begin() + std::ptrdiff_t(header.index.offset));
    out.insert(out.end(), packed.begin(), packed.end());
    header.index = {header.index.offset, packed.size(), checksum(packed)};
    return sealed(header, std::move(out));
}

// Statistics that are not true are found by verify, those that cannot be are refused; nothing else happens.
TEST(BrickDistribution, UntrueOnesAreFound) {
    const TemporaryFolder folder;
    volume::Dataset made = makeDataset({21, 18, 20},
                                       {{"a", ScalarType::U8, 1, Texture::Noise, true, false},
                                        {"g", ScalarType::F32, 1, Texture::Nasty, false, false}},
                                       1);
    pack(made, statisticsOptions(StoredLattice::CC), folder / "a.tsr");
    const std::vector<char> file = readFile(folder / "a.tsr");
    std::size_t bytes = 0; // of the statistics
    for (const int channel : {0, 1}) {
        BitWriter out;
        const Archive archive(folder / "a.tsr");
        forKeys(archive, [&](const volume::BrickKey& key) {
            if (key.channel != channel) return;
            const auto noted = archive.distribution(key);
            put(out, float(noted->range.lo), float(noted->range.hi), channel == 1,
                {std::uint32_t(noted->samples), channel == 1 ? 1u : 0u, 0, noted->counts});
        });
        bytes += out.bytes.size();
    }
    writeFile(folder / "same.tsr", withPage(file, [](Bytes&) {}));
    EXPECT_EQ(verifyArchive(Archive(folder / "same.tsr")).damaged, 0u);
    ASSERT_GT(bytes, 60u);
    std::size_t refused = 0, found = 0, unnoticed = 0;
    for (std::size_t i = 2; i < bytes; ++i) {
        const auto edited = withPage(file, [&](Bytes& page) { page[page.size() - i] ^= std::byte{16}; });
        writeFile(folder / "b.tsr", edited);
        try {
            const VerifyReport report = verifyArchive(Archive(folder / "b.tsr"));
            if (report.damaged == 0) { // the last digits of a mean
                ++unnoticed;
                continue;
            }
            EXPECT_NE(report.damage[0].find("statistics"), std::string::npos) << report.damage[0];
            ++found;
        } catch (const Error&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 0u);
    EXPECT_GT(found, 0u);
    EXPECT_LT(unnoticed, bytes / 10);
    for (const int more : {-1, 1}) {
        writeFile(folder / "b.tsr", withPage(file, [&](Bytes& page) { page.resize(page.size() + std::size_t(more)); }));
        EXPECT_THROW(Archive(folder / "b.tsr"), Error) << more;
    }
}

// A second reader finds the same in the file.
TEST(BrickDistribution, ThePlainReaderAgrees) {
    const TemporaryFolder folder;
    for (const StoredLattice lattice : {StoredLattice::CC, StoredLattice::BCC}) {
        std::vector<MadeParameter> kinds = everyKind();
        volume::Dataset made = makeDataset({35, 18, 37}, kinds, 1);
        pack(made, statisticsOptions(lattice), folder / "a.tsr");
        volume::Dataset more = makeDataset({35, 18, 37}, kinds, 1);
        more.info.times = {7};
        append(more, folder / "a.tsr");
        const Archive archive(folder / "a.tsr");
        const plain::Decoder decoder(readFile(folder / "a.tsr"));
        const glm::ivec3 count = archive.grid().count();
        const auto channels = archive.info().channels();
        std::size_t stored = 0;
        forKeys(archive, [&](const volume::BrickKey& key) {
            const volume::Channel& channel = channels[std::size_t(key.channel)];
            if (channel.magnitude) return;
            std::size_t component = std::size_t(channel.component);
            for (int p = 0; p < channel.parameter; ++p)
                component += std::size_t(archive.info().parameters[std::size_t(p)].components);
            const int number = (key.index.z * count.y + key.index.y) * count.x + key.index.x;
            const plain::Statistics read =
                decoder.statistics(std::size_t(key.time) * decoder.frames() / 2 + component, number);
            const auto noted = archive.distribution(key);
            ASSERT_TRUE(noted);
            ASSERT_EQ(read.samples, noted->samples);
            ++stored;
            if (read.samples == 0) return;
            EXPECT_EQ(read.counts, noted->counts);
            EXPECT_EQ(read.mean, noted->mean);
        });
        EXPECT_GT(stored, 50u);
    }
}

// The whole time of a channel, without reading a sample.
TEST(BrickDistribution, AHistogramOfAllNeedsNoSamples) {
    const TemporaryFolder folder;
    volume::Dataset made = makeDataset({70, 66, 64},
                                       {{"a", ScalarType::U8, 1, Texture::Smooth, true, false},
                                        {"f", ScalarType::F32, 1, Texture::Smooth, false, false}},
                                       1);
    volume::StatisticsQuery query;
    query.channels = {0, 1};
    query.bins = 20;
    PackOptions options;
    options.lattice = StoredLattice::BCC;
    pack(made, options, folder / "whole.tsr");
    EXPECT_FALSE(volume::notedStatistics(Archive(folder / "whole.tsr"), query)) << "nothing is noted of one brick";

    options.brickSize = 32;
    pack(made, options, folder / "a.tsr");
    const Archive archive(folder / "a.tsr");
    const auto noted = volume::notedStatistics(archive, query);
    ASSERT_TRUE(noted);
    EXPECT_EQ(noted->level, archive.grid().levels);
    const volume::Statistics exact = volume::computeStatistics(archive, query);
    for (std::size_t c = 0; c < 2; ++c) {
        const volume::Summary &a = noted->channels[c].all, &b = exact.channels[c].all;
        EXPECT_EQ(a.samples, b.samples);
        EXPECT_EQ(a.min, b.min);
        EXPECT_EQ(a.max, b.max);
        // Cells at the faces are halved: within a brick the noted mean is one of samples.
        EXPECT_NEAR(a.mean, b.mean, 0.01 * (b.max - b.min));
        EXPECT_NEAR(a.deviation, b.deviation, 0.03 * b.deviation);
        double off = 0;
        for (std::size_t bin = 0; bin < 20; ++bin)
            off += std::abs(double(noted->channels[c].histogram.count[bin]) -
                            double(exact.channels[c].histogram.count[bin]));
        EXPECT_LT(off, 0.05 * b.samples);
    }
}

} // namespace
} // namespace tessera::codec
