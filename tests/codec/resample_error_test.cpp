#include "codec/container/exactness.h"
#include "codec/container/resample_error.h"

#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "codec/unpack/packed_before.h"
#include "codec/unpack/unpack.h"
#include "tests/codec/make_dataset.h"
#include "tests/codec/plain/decoder.h"
#include "volume/resample/resample.h"

#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tessera::codec {
namespace {

using namespace testing;
using ::testing::MatchesRegex;
using ::testing::StartsWith;
using volume::ScalarType;

volume::Dataset madeOf(int times) {
    return makeDataset({20, 17, 16},
                       {{"T", ScalarType::F32, 1, Texture::Smooth, false, false},
                        {"n", ScalarType::U8, 1, Texture::Noise, true, false},
                        {"U", ScalarType::F32, 2, Texture::Noise, false, false},
                        {"region", ScalarType::U8, 1, Texture::Noise, false, true}},
                       times);
}

PackOptions onBcc() {
    PackOptions options;
    options.lattice = StoredLattice::BCC;
    return options;
}

/// What unpacking gives beside the source, sample by sample.
ResampleError unpackedError(const volume::Dataset& made, const volume::Dataset& unpacked, int parameter) {
    double squares = 0;
    ResampleError error;
    const volume::Parameter& about = made.info.parameters[std::size_t(parameter)];
    for (int t = 0; t < int(made.info.times.size()); ++t)
        for (int c = 0; c < about.components; ++c) {
            const volume::Field a = made.read(parameter, c, t), b = unpacked.read(parameter, c, t);
            for (std::size_t i = 0; i < a.count(); ++i) {
                if (!a.present(i) || !b.present(i)) continue;
                double apart = std::abs(a.value(i) - b.value(i));
                if (about.categorical) apart = apart > 0 ? 1 : 0;
                squares += apart * apart;
                error.largest = std::max(error.largest, apart);
                error.samples += 1;
            }
        }
    error.meanSquare = squares / error.samples;
    return error;
}

void expectNear(const ResampleError& a, const ResampleError& b) {
    EXPECT_NEAR(a.meanSquare, b.meanSquare, 1e-9 * b.meanSquare);
    EXPECT_DOUBLE_EQ(a.largest, b.largest);
    EXPECT_EQ(a.samples, b.samples);
    EXPECT_EQ(a.share, 1);
}

TEST(ResampleErrors, AreThoseOfWhatUnpackingGives) {
    const TemporaryFolder folder;
    volume::Dataset made = madeOf(2);
    pack(made, onBcc(), folder / "a.tsr");
    const auto archive = std::make_shared<const Archive>(folder / "a.tsr");
    const Metadata& metadata = archive->metadata();
    ASSERT_EQ(metadata.resampled.size(), 4u);
    const volume::Dataset unpacked = gridDataset(archive, 0);
    for (int p = 0; p < 3; ++p) { // labels are exact
        SCOPED_TRACE(p);
        ASSERT_TRUE(metadata.resampled[std::size_t(p)]);
        const ResampleError expected = unpackedError(made, unpacked, p);
        EXPECT_GT(expected.largest, 0);
        expectNear(*metadata.resampled[std::size_t(p)], expected);
    }
    EXPECT_TRUE(metadata.lossless);
    EXPECT_THAT(
        exactnessText(metadata),
        MatchesRegex("resampled to BCC and back to the samples of the source \\(largest error [0-9.]+ % of range, "
                     "PSNR [0-9.]+ dB or more\\); labels and absent samples are exact"));
    const ResampleError& noise = *metadata.resampled[1];
    char words[128];
    std::snprintf(words, sizeof words, "PSNR %.1f dB, error at most %.4g K at the samples of the source",
                  10 * std::log10(99 * 99 / noise.meanSquare), noise.largest);
    EXPECT_EQ(resampledText(metadata, 1), "resampled: " + std::string(words));
    EXPECT_EQ(resampledText(metadata, 3), "exact");
    // As another reader finds it.
    const nlohmann::json plain = plain::Decoder(readFile(folder / "a.tsr")).metadata()["resampled"];
    ASSERT_EQ(plain.size(), 4u);
    EXPECT_EQ(plain[1]["largest"].get<double>(), noise.largest);
    EXPECT_EQ(plain[1]["meanSquare"].get<double>(), noise.meanSquare);
    EXPECT_EQ(plain[1]["samples"].get<double>(), noise.samples);
}

TEST(ResampleErrors, NothingIsSaidOfWhatWasNotResampled) {
    const TemporaryFolder folder;
    volume::Dataset made = madeOf(1);
    PackOptions options;
    options.lattice = StoredLattice::CC;
    pack(made, options, folder / "a.tsr");
    EXPECT_TRUE(Archive(folder / "a.tsr").metadata().resampled.empty());
    EXPECT_EQ(exactnessText(Archive(folder / "a.tsr").metadata()), "lossless: every sample is exact");
    volume::Dataset series = madeOf(8);
    options.lattice = StoredLattice::D4;
    pack(series, options, folder / "a.tsr");
    EXPECT_THAT(exactnessText(Archive(folder / "a.tsr").metadata()),
                StartsWith("resampled to D4* and back to the samples of the source (largest error "));
}

TEST(ResampleErrors, GoWithSamplesThatArePackedAgain) {
    const TemporaryFolder folder;
    volume::Dataset made = madeOf(1);
    pack(made, onBcc(), folder / "a.tsr");
    const auto archive = std::make_shared<const Archive>(folder / "a.tsr");
    volume::Dataset stored = storedDataset(archive), grid = gridDataset(archive, 0);
    pack(stored, onBcc(), folder / "bcc.tsr", {}, packedBefore(archive));
    for (std::size_t p = 0; p < 3; ++p)
        expectNear(*Archive(folder / "bcc.tsr").metadata().resampled[p], *archive->metadata().resampled[p]);
    PackOptions cc;
    cc.lattice = StoredLattice::CC;
    pack(grid, cc, folder / "cc.tsr", {}, packedBefore(archive));
    const Archive back(folder / "cc.tsr");
    EXPECT_EQ(back.metadata().resampled, archive->metadata().resampled);
    EXPECT_THAT(exactnessText(back.metadata()), StartsWith("every sample of the CC grid is exact; the source was"));
    // Once more on BCC: no less than either, the largest at most their sum.
    const auto again = std::make_shared<const Archive>(folder / "cc.tsr");
    volume::Dataset twice = storedDataset(again);
    pack(twice, onBcc(), folder / "twice.tsr", {}, packedBefore(again));
    const Archive end(folder / "twice.tsr");
    for (std::size_t p = 0; p < 3; ++p)
        EXPECT_GE(end.metadata().resampled[p]->largest, archive->metadata().resampled[p]->largest);
}

TEST(ResampleErrors, AreJoinedWhenAnArchiveGrows) {
    const TemporaryFolder folder;
    volume::Dataset made = madeOf(3), first = made, last = made;
    first.info.times.resize(2);
    last.info.times.erase(last.info.times.begin(), last.info.times.begin() + 2);
    last.read = [read = made.read](int p, int c, int) { return read(p, c, 2); };
    pack(made, onBcc(), folder / "whole.tsr");
    pack(first, onBcc(), folder / "grown.tsr");
    append(last, folder / "grown.tsr");
    const Archive whole(folder / "whole.tsr"), grown(folder / "grown.tsr");
    for (std::size_t p = 0; p < 3; ++p) {
        ASSERT_TRUE(grown.metadata().resampled[p]);
        expectNear(*grown.metadata().resampled[p], *whole.metadata().resampled[p]);
    }
}

} // namespace
} // namespace tessera::codec
