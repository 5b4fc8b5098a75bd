#include "tests/volume/fields.h"
#include "volume/base/error.h"
#include "volume/bricks/brick_importance.h"
#include "volume/field/frame_reader.h"
#include "volume/resample/resample.h"
#include "volume/resample/resample_slices.h"
#include "volume/system/scratch_file.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>

namespace tessera::volume {
namespace {

/// Noise, with gaps of single samples and of whole regions.
template <class T> Field gappyNoise(const Lattice& lattice, bool gaps, std::mt19937& random) {
    Field field = makeField(lattice, scalarTypeOf<T>());
    std::uniform_real_distribution<double> number(0, 250), chance(0, 1);
    for (T& sample : field.as<T>()) sample = static_cast<T>(number(random));
    if (!gaps) return field;
    Mask mask(field.count(), 1);
    for (std::size_t i = 0; i < mask.size(); ++i)
        if (chance(random) < 0.05 || (i / 7) % 11 < 3) mask[i] = 0;
    field.mask = std::make_shared<const Mask>(std::move(mask));
    return field;
}

SlicedFrame slicedFrame(const Field& field) {
    SlicedFrame frame{field.lattice, [&field](int first, int count) { return slicesOf(field, first, count); }, {}};
    frame.extent.add(field);
    return frame;
}

/// The slices of a frame put together again, `step` of them at a time.
Field joined(const SlicedFrame& frame, ScalarType type, int step) {
    Field out = makeField(frame.lattice, type);
    Mask mask(out.count(), 1);
    const std::size_t slice = std::size_t(frame.lattice.size.x) * std::size_t(frame.lattice.size.y);
    for (int first = 0; first < frame.lattice.size.z; first += step) {
        const Field part = frame.read(first, std::min(step, frame.lattice.size.z - first));
        EXPECT_EQ(part.lattice, slicesOf(frame.lattice, first, part.lattice.size.z));
        const std::size_t at = slice * std::size_t(first);
        std::copy(part.samples.begin(), part.samples.end(), out.samples.begin() + std::ptrdiff_t(at * byteSize(type)));
        if (part.mask) std::copy(part.mask->begin(), part.mask->end(), mask.begin() + std::ptrdiff_t(at));
    }
    out.mask = std::make_shared<const Mask>(std::move(mask));
    return out;
}

void expectSame(const Field& a, const Field& b, const std::string& what) {
    ASSERT_EQ(a.samples.size(), b.samples.size());
    EXPECT_EQ(a.samples, b.samples) << what;
    for (std::size_t i = 0; i < a.count(); ++i) ASSERT_EQ(a.present(i), b.present(i)) << what << ' ' << i;
}

// Every filter, kind of number and target, with and without gaps, cut anywhere: bit for bit what the whole gives.
TEST(Slices, ResampledInPartsIsTheSameAsWhole) {
    std::mt19937 random(3);
    const Lattice source = test::ccLattice({13, 11, 29}, {1, 2, 0.5}, {3, -1, 7});
    std::vector<ResampleOptions> all;
    for (const ResampleFilter filter :
         {ResampleFilter::Nearest, ResampleFilter::Linear, ResampleFilter::Cubic, ResampleFilter::BSpline3,
          ResampleFilter::BSpline5, ResampleFilter::Lagrange, ResampleFilter::Sinc})
        all.push_back({.filter = filter});
    all.push_back({.filter = ResampleFilter::Cubic, .sharpen = 0.7});
    all.push_back({.filter = ResampleFilter::BSpline3, .sharpen = 0.7, .sharpenWhen = SharpenWhen::After});
    for (const bool gaps : {false, true})
        for (const Lattice& target :
             {bccFor(source), test::ccLattice({9, 12, 40}, {1.3, 1.9, 0.4}, {3, -1, 7}), source})
            for (const ResampleOptions& options : all) {
                const auto compare = [&]<class T>(T) {
                    const Field field = gappyNoise<T>(source, gaps, random);
                    const Field whole = resample(field, target, options);
                    const int step = 2 * std::uniform_int_distribution(1, 9)(random);
                    const SlicedFrame parts =
                        resampled(slicedFrame(field), target, options, {step / 2, testing::TempDir()});
                    expectSame(whole, joined(parts, field.type, step),
                               std::string(kResampleFilterNames[std::size_t(options.filter)]) + " gaps " +
                                   std::to_string(gaps) + " step " + std::to_string(step));
                };
                compare(std::uint8_t{});
                compare(std::int32_t{});
                compare(float{});
            }
}

// Only what the filter reaches is read of a source.
TEST(Slices, APartOfTheSourceIsRead) {
    std::mt19937 random(4);
    const Field field = gappyNoise<std::uint8_t>(test::ccLattice({6, 6, 100}), false, random);
    int most = 0;
    SlicedFrame frame = slicedFrame(field);
    frame.read = [&, read = frame.read](int first, int count) {
        most = std::max(most, count);
        return read(first, count);
    };
    joined(resampled(frame, bccFor(field.lattice), {}, {8, testing::TempDir()}), field.type, 8);
    EXPECT_LE(most, 10); // 8 slices of BCC are 5.7 of CC, and 2 on either side
    EXPECT_GE(most, 6);
}

TEST(Slices, ImportanceInPartsIsTheSameAsWhole) {
    std::mt19937 random(5);
    for (const bool gaps : {false, true})
        for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC})
            for (const int depth : {61, 63, 64, 70}) {
                Lattice lattice = test::ccLattice({20, 17, depth});
                lattice.kind = kind;
                const BrickGrid grid{lattice, 8, 2, 0};
                const auto compare = [&](const Field& field, Range range, bool categorical) {
                    const auto whole = importanceOfBricks(grid, field, range, categorical);
                    for (const int layers : {1, 2, 3, 100}) {
                        const auto read = [from = slicedFrame(field).read](int first, int count, Field& part) {
                            part = from(first, count);
                        };
                        const auto parts = importanceOfBricks(grid, read, layers, range, categorical);
                        ASSERT_EQ(parts.size(), whole.size());
                        for (std::size_t i = 0; i < whole.size(); ++i) {
                            EXPECT_EQ(parts[i].importance, whole[i].importance) << i << " layers " << layers;
                            EXPECT_EQ(parts[i].detail, whole[i].detail) << i << " layers " << layers;
                        }
                    }
                };
                compare(gappyNoise<float>(lattice, gaps, random), {1, 0}, false);
                compare(gappyNoise<std::uint8_t>(lattice, gaps, random), {10, 200}, false);
                compare(gappyNoise<std::uint16_t>(lattice, gaps, random), {0, 250}, true);
            }
}

// A reader of whole frames gives slices too; one made of another reads in parts where that does.
TEST(FrameReaders, GiveSlicesOfWholeFrames) {
    std::mt19937 random(6);
    const Field field = gappyNoise<std::uint16_t>(test::ccLattice({5, 4, 9}), true, random);
    const FrameReader whole = [&](int, int, int) { return field; };
    EXPECT_FALSE(whole.inParts());
    expectSame(whole(0, 0, 0), field, "whole");
    expectSame(whole(0, 0, 0, {2, 3}), slicesOf(field, 2, 3), "some");
    expectSame(whole(0, 0, 0, {4}), slicesOf(field, 4, 5), "the last ones");
    EXPECT_EQ(whole(0, 0, 0, {4}).lattice, slicesOf(field.lattice, 4, 5));

    const auto timeBefore = [](const FrameReader& read, int parameter, int component, int time, SliceRange slices) {
        return read(parameter, component, time - 1, slices);
    };
    EXPECT_FALSE(whole.through(timeBefore).inParts());
    SliceRange asked;
    const FrameReader parts = [&](int, int, int time, SliceRange slices) {
        EXPECT_EQ(time, 2);
        asked = slices;
        return slicesOf(field, slices);
    };
    EXPECT_TRUE(parts.inParts());
    const FrameReader later = parts.through(timeBefore);
    EXPECT_TRUE(later.inParts());
    expectSame(later(0, 0, 3, {1, 2}), slicesOf(field, 1, 2), "through another");
    EXPECT_EQ(asked, (SliceRange{1, 2}));
}

TEST(ScratchFileTest, GivesBackWhatWasWritten) {
    ScratchFile file(testing::TempDir());
    std::vector<std::byte> bytes(1000);
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = std::byte(i * 7);
    file.write(5000, bytes);
    file.write(1, std::span(bytes).first(10));
    std::vector<std::byte> back(500);
    file.read(5300, back);
    EXPECT_TRUE(std::equal(back.begin(), back.end(), bytes.begin() + 300));
    back.resize(11);
    file.read(0, back);
    EXPECT_EQ(back[0], std::byte{0});
    EXPECT_EQ(back[10], bytes[9]);
    back.resize(2000);
    EXPECT_THROW(file.read(5500, back), MachineError); // beyond the end
    EXPECT_THROW(ScratchFile("/no such folder"), MachineError);
}

} // namespace
} // namespace tessera::volume
