// Archives of lattices with uneven axes.
#include "codec/archive/archive.h"
#include "codec/blocks/join.h"
#include "codec/container/container.h"
#include "codec/container/metadata.h"
#include "codec/pack/pack.h"
#include "codec/unpack/grid_box.h"
#include "codec/unpack/unpack.h"
#include "tests/codec/make_dataset.h"
#include "tests/volume/uneven.h"
#include "volume/base/error.h"
#include "volume/field/axes_json.h"
#include "volume/field/own_axes.h"

#include <cstring>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace tessera::codec::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using volume::AxisMap;
using volume::AxisMaps;
using volume::Lattice;
using volume::test::layeredLattice;

/// Some values on a layered lattice (too few for a commit between); with `axes` false on its sheet.
volume::Dataset layered(AxisMap::Of of, bool axes = true, int times = 2,
                        volume::LatticeKind kind = volume::LatticeKind::CC) {
    const Lattice lattice = layeredLattice(of, kind);
    using volume::ScalarType;
    volume::Dataset made = makeDataset(lattice.size,
                                       {{"a", ScalarType::U8, 1, Texture::Noise, false, false},
                                        {"d", ScalarType::U16, 1, Texture::Smooth, true, false},
                                        {"f", ScalarType::F32, 3, Texture::Smooth, true, false},
                                        {"region", ScalarType::U8, 1, Texture::Noise, false, true}},
                                       times, lattice.kind);
    made.info.lattice = lattice;
    made.info.bounds = volume::test::unevenBox(layeredLattice(of));
    if (!axes) made.info.lattice.axes = {};
    made.read = [read = made.read, at = made.info.lattice](int p, int c, int t) {
        volume::Field field = read(p, c, t);
        field.lattice = at;
        return field;
    };
    return made;
}

bool sameBits(const AxisMaps& a, const AxisMaps& b) {
    for (int axis = 0; axis < 3; ++axis) {
        if (!a[axis] != !b[axis]) return false;
        if (!a[axis]) continue;
        const auto &of = a[axis]->planes(), &other = b[axis]->planes();
        if (a[axis]->of() != b[axis]->of() || of.size() != other.size() ||
            std::memcmp(of.data(), other.data(), of.size() * sizeof(double)) != 0)
            return false;
    }
    return true;
}

Header headerOf(const std::vector<char>& bytes) {
    return parseHeaders(std::as_bytes(std::span(bytes)), bytes.size(), "a.tsr").header;
}

struct Way {
    StoredLattice lattice;
    double maxError;
};
constexpr Way kWays[] = {{StoredLattice::CC, 0},
                         {StoredLattice::CC, 1e-3},
                         {StoredLattice::BCC, 0},
                         {StoredLattice::BCC, 1e-3},
                         {StoredLattice::D4, 1e-2}};

PackOptions optionsOf(const Way& way) {
    PackOptions options;
    options.lattice = way.lattice;
    options.maxError = way.maxError;
    options.lossless = way.maxError == 0;
    options.regionNumbers = false;
    return options;
}

TEST(UnevenArchive, BytesOfSamplesAreThoseOfTheLatticeWithoutAxes) {
    const TemporaryFolder folder;
    for (const auto of : {AxisMap::Of::Cells, AxisMap::Of::Points})
        for (const Way& way : kWays) {
            std::vector<char> bytes[2];
            for (const bool axes : {false, true}) {
                volume::Dataset data = layered(of, axes, way.lattice == StoredLattice::D4 ? 8 : 1);
                pack(data, optionsOf(way), folder / "a.tsr");
                bytes[axes] = readFile(folder / "a.tsr");
            }
            const Header even = headerOf(bytes[0]), uneven = headerOf(bytes[1]);
            EXPECT_EQ(even.features & kUnevenAxes, 0u);
            EXPECT_EQ(uneven.features, even.features | kUnevenAxes);
            // Samples lie before the metadata. (Corrections are archives inside, with metadata of their own.)
            const Archive archive(folder / "a.tsr");
            const std::uint64_t end = archive.metadata().corrections.empty() ? even.metadata.offset
                                                                             : archive.metadata().corrections[0].offset;
            ASSERT_GT(end, kFirstChunk + 100);
            ASSERT_GE(uneven.metadata.offset, end);
            EXPECT_TRUE(std::equal(bytes[0].begin() + kFirstChunk, bytes[0].begin() + std::ptrdiff_t(end),
                                   bytes[1].begin() + kFirstChunk))
                << int(way.lattice) << " " << way.maxError;
        }
}

TEST(UnevenArchive, AxesComeBackBitForBit) {
    const TemporaryFolder folder;
    for (const auto of : {AxisMap::Of::Cells, AxisMap::Of::Points})
        for (const Way& way : kWays) {
            volume::Dataset data = layered(of, true, way.lattice == StoredLattice::D4 ? 8 : 2);
            pack(data, optionsOf(way), folder / "a.tsr");
            const auto archive = std::make_shared<const Archive>(folder / "a.tsr");
            EXPECT_TRUE(sameBits(archive->info().lattice.axes, data.info.lattice.axes));
            EXPECT_EQ(archive->metadata().source, data.info.lattice);
            EXPECT_EQ(archive->info().bounds.lo, data.info.bounds.lo);
            EXPECT_EQ(archive->info().bounds.hi, data.info.bounds.hi);
            const volume::Dataset grid = gridDataset(archive, 0);
            EXPECT_EQ(grid.info.lattice, data.info.lattice);
            EXPECT_EQ(grid.read(0, 0, 0).lattice, data.info.lattice);
            (void)verifyArchive(*archive);
            if (way.lattice == StoredLattice::D4 || way.maxError > 0) continue;
            volume::Dataset again = gridDataset(archive, 0);
            pack(again, optionsOf(way), folder / "b.tsr");
            EXPECT_TRUE(sameBits(Archive(folder / "b.tsr").info().lattice.axes, data.info.lattice.axes));
        }
}

TEST(UnevenArchive, AxesOfExtremeNumbersComeBackBitForBit) {
    const TemporaryFolder folder;
    Lattice lattice;
    lattice.size = {1, 1, 1};
    const auto axis = [](AxisMap::Of of, std::vector<double> planes) {
        return std::make_shared<const AxisMap>(of, std::move(planes));
    };
    lattice = withAxes(lattice, {{axis(AxisMap::Of::Points, {-0.1, 5e-324, 1.0 / 3}),
                                  axis(AxisMap::Of::Cells, {std::nextafter(1.0, 0), 1, std::nextafter(1.0, 2), 2}),
                                  axis(AxisMap::Of::Cells, {-1e99, 0.1 + 0.2})}});
    volume::Dataset data = makeDataset(lattice.size, {{"a"}}, 1);
    data.info.lattice = lattice;
    data.info.bounds = volume::gridBounds(lattice);
    pack(data, optionsOf(kWays[0]), folder / "a.tsr");
    EXPECT_TRUE(sameBits(Archive(folder / "a.tsr").info().lattice.axes, lattice.axes));
}

TEST(UnevenArchive, ABccSourceKeepsTheAxesOfItsGrid) {
    const TemporaryFolder folder;
    volume::Dataset data = layered(AxisMap::Of::Cells, true, 1, volume::LatticeKind::BCC);
    PackOptions options = optionsOf(kWays[2]);
    pack(data, options, folder / "a.tsr");
    EXPECT_EQ(Archive(folder / "a.tsr").info().lattice, data.info.lattice);
}

TEST(UnevenArchive, LaterTimesLieAtTheSamePlanes) {
    const TemporaryFolder folder;
    const std::string path = folder / "a.tsr";
    volume::Dataset data = layered(AxisMap::Of::Cells);
    const auto later = [&](double share) { // planes moved by a share of the thinnest cell
        volume::Dataset made = layered(AxisMap::Of::Cells);
        std::vector<double> planes = made.info.lattice.axes[2]->planes();
        planes[3] += share * 5e-6;
        made.info.lattice.axes.of[2] = std::make_shared<const AxisMap>(AxisMap::Of::Cells, planes);
        made.info.times = {5, 6};
        return made;
    };
    pack(data, optionsOf(kWays[0]), path);
    volume::Dataset same = later(0), rounded = later(1e-6), moved = later(1e-3), points = layered(AxisMap::Of::Points),
                    even = layered(AxisMap::Of::Cells, false);
    append(same, path);
    for (volume::Dataset* other : {&moved, &even}) {
        other->info.times = {7, 8};
        try {
            append(*other, path);
            ADD_FAILURE() << "was appended";
        } catch (const Error& error) {
            EXPECT_THAT(error.what(), HasSubstr(other == &even ? "other planes of x" : "other planes of z"));
        }
    }
    points.info.times = {7, 8};
    EXPECT_THROW(append(points, path), Error);
    rounded.info.times = {7, 8};
    append(rounded, path);
    const Archive archive(path);
    EXPECT_EQ(archive.info().times.size(), 6u);
    EXPECT_TRUE(sameBits(archive.info().lattice.axes, data.info.lattice.axes));
    EXPECT_NE(headerOf(readFile(path)).features & kUnevenAxes, 0u);
    // And an archive of even axes takes none of uneven ones.
    volume::Dataset first = layered(AxisMap::Of::Cells, false), then = layered(AxisMap::Of::Cells);
    pack(first, optionsOf(kWays[0]), path);
    then.info.times = {7, 8};
    EXPECT_THROW(append(then, path), Error);
}

TEST(UnevenArchive, CoarseLevelsStateThePlacesOfTheirSamples) {
    const TemporaryFolder folder;
    volume::Dataset data = layered(AxisMap::Of::Cells);
    PackOptions options = optionsOf(kWays[0]);
    options.brickSize = 8;
    options.wavelet = WaveletChoice::W22;
    pack(data, options, folder / "a.tsr");
    const auto archive = std::make_shared<const Archive>(folder / "a.tsr");
    ASSERT_EQ(archive->grid().phase, 0);
    const volume::Dataset coarse = gridDataset(archive, 1);
    const Lattice &fine = data.info.lattice, &own = coarse.info.lattice;
    EXPECT_EQ(own.size, (fine.size + 1) / 2);
    ASSERT_TRUE(own.axes[2]);
    EXPECT_EQ(own.axes[2]->of(), AxisMap::Of::Points);
    for (int z = 0; z < own.size.z; ++z) {
        const double there = fine.position({0, 0, 2 * z}).z;
        EXPECT_NEAR(own.axes[2]->planes()[std::size_t(z)], there, 1e-15);
        EXPECT_NEAR(own.position({0, 0, z}).z, there, 1e-15);
    }
    EXPECT_EQ(coarse.read(2, 0, 1).lattice, own);
    EXPECT_EQ(GridBoxes(archive).info(1).lattice, own);
}

TEST(UnevenArchive, NumbersOfRegionsAreLeftOut) {
    const TemporaryFolder folder;
    for (const bool axes : {false, true}) {
        volume::Dataset data = layered(AxisMap::Of::Cells, axes);
        PackOptions options = optionsOf(kWays[1]);
        options.regionNumbers = true;
        pack(data, options, folder / "a.tsr");
        EXPECT_EQ(Archive(folder / "a.tsr").metadata().numbers.empty(), axes);
    }
}

/// The metadata of a layered archive as JSON.
json layeredMetadata() {
    const TemporaryFolder folder;
    volume::Dataset data = layered(AxisMap::Of::Cells);
    pack(data, optionsOf(kWays[0]), folder / "a.tsr");
    const Bytes block = serialise(Archive(folder / "a.tsr").metadata(), kUsualFeatures & ~kCompact);
    Bytes text(std::to_integer<std::size_t>(block[0]) | std::to_integer<std::size_t>(block[1]) << 8 |
               std::to_integer<std::size_t>(block[2]) << 16);
    const auto body = std::span(block).subspan(4);
    if (text.size() == body.size())
        std::ranges::copy(body, text.begin());
    else
        EXPECT_EQ(decompress(body, text), DecodeStatus::Ok);
    return json::parse(reinterpret_cast<const char*>(text.data()),
                       reinterpret_cast<const char*>(text.data() + text.size()));
}

Metadata parsed(const json& document, std::uint32_t features = kUnevenAxes) {
    const std::string text = document.dump();
    Bytes block;
    appendU32(block, std::uint32_t(text.size()));
    const auto bytes = std::as_bytes(std::span(text));
    block.insert(block.end(), bytes.begin(), bytes.end());
    return parseMetadata(block, features, "a.tsr");
}

std::string refusalOfAxes(const json& document, std::uint32_t features = kUnevenAxes) {
    try {
        (void)parsed(document, features);
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        EXPECT_THAT(error.what(), HasSubstr("a.tsr: metadata /data/lattice/axes"));
        return error.what();
    }
    return "taken";
}

TEST(UnevenArchive, DamagedAxesAreRefusedInOneLine) {
    const json good = layeredMetadata();
    EXPECT_EQ(refusalOfAxes(good), "taken");
    EXPECT_TRUE(sameBits(parsed(good).source.axes, layeredLattice(AxisMap::Of::Cells).axes));
    EXPECT_THAT(refusalOfAxes(good, 0), HasSubstr("does not declare"));
    const auto changed = [&](auto&& change) {
        json bad = good;
        change(bad["data"]["lattice"]["axes"]);
        return refusalOfAxes(bad);
    };
    EXPECT_THAT(changed([](json& axes) { axes = 7; }), HasSubstr("list of three"));
    EXPECT_THAT(changed([](json& axes) { axes.push_back(nullptr); }), HasSubstr("list of three"));
    EXPECT_THAT(changed([](json& axes) { axes[2] = "cells"; }), HasSubstr("axes[2]: must be null"));
    EXPECT_THAT(changed([](json& axes) { axes[2]["of"] = "faces"; }), HasSubstr("axes[2].of"));
    EXPECT_THAT(changed([](json& axes) { axes[2].erase("of"); }), HasSubstr("axes[2].of"));
    EXPECT_THAT(changed([](json& axes) { axes[2].erase("planes"); }), HasSubstr("axes[2].planes"));
    EXPECT_THAT(changed([](json& axes) { axes[2]["planes"].push_back(9); }), HasSubstr("22 numbers, but 20 samples"));
    EXPECT_THAT(changed([](json& axes) { axes[2]["planes"].erase(3); }), HasSubstr("20 numbers, but 20 samples"));
    EXPECT_THAT(changed([](json& axes) { axes[2]["of"] = "points"; }), HasSubstr("need 20"));
    EXPECT_THAT(changed([](json& axes) { axes[2]["planes"] = json::array(); }), HasSubstr("0 numbers"));
    EXPECT_THAT(changed([](json& axes) { axes[2]["planes"][4] = nullptr; }), HasSubstr("planes[4]: must be a number"));
    EXPECT_THAT(changed([](json& axes) { axes[2]["planes"][4] = axes[2]["planes"][3]; }), HasSubstr("do not rise"));
    EXPECT_THAT(changed([](json& axes) { std::swap(axes[2]["planes"][4], axes[2]["planes"][3]); }),
                HasSubstr("do not rise"));
    EXPECT_THAT(changed([](json& axes) { axes[2]["planes"].back() = 2; }), HasSubstr("spacing and origin are not"));
    EXPECT_THAT(changed([](json& axes) { axes[2]["planes"].back() = 1e308; }), HasSubstr("spacing and origin are not"));
    EXPECT_THAT(changed([](json& axes) {
                    for (json& plane : axes[2]["planes"]) plane = plane.get<double>() + 1e-3;
                }),
                HasSubstr("spacing and origin are not"));
    EXPECT_THAT(changed([](json& axes) {
                    axes[2]["planes"] = json::array();
                    for (int i = 0; i < volume::kMostPlanes + 1; ++i) axes[2]["planes"].push_back(0);
                }),
                HasSubstr("more than 1048577"));
}

TEST(UnevenArchive, PlanesThatNoReaderAcceptsAreNotPacked) {
    const TemporaryFolder folder;
    volume::Dataset data = layered(AxisMap::Of::Cells);
    data.info.lattice.size.z -= 1;
    try {
        pack(data, optionsOf(kWays[0]), folder / "a.tsr");
        ADD_FAILURE() << "was packed";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("21 numbers, but 19 samples need 20"));
    }
    EXPECT_EQ(folder.files(), 0u);
}

} // namespace
} // namespace tessera::codec::testing
