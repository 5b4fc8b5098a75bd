// Samples that lie in no piece of a VTK XML file.
#include "app/importer/readers/piece_cover.h"
#include "tests/import/foreign_files.h"

#include <gmock/gmock.h>
#include <random>

namespace tessera::volume {
namespace {

using importer::GridPieces;
using importer::PointExtent;

/// Every point, or cell, asked of every piece.
std::vector<std::uint8_t> heldPlainly(const GridPieces& pieces, bool cells) {
    const auto inside = [&](const PointExtent& part, int axis, int at) {
        const bool flat = pieces.whole[std::size_t(2 * axis)] == pieces.whole[std::size_t(2 * axis + 1)];
        const int last = part[std::size_t(2 * axis + 1)] - (cells && !flat ? 1 : 0);
        return at >= part[std::size_t(2 * axis)] && at <= last;
    };
    std::vector<std::uint8_t> held;
    const PointExtent& w = pieces.whole;
    const auto last = [&](int axis) {
        const int lo = w[std::size_t(2 * axis)], hi = w[std::size_t(2 * axis + 1)];
        return cells && hi > lo ? hi - 1 : hi;
    };
    for (int z = w[4]; z <= last(2); ++z)
        for (int y = w[2]; y <= last(1); ++y)
            for (int x = w[0]; x <= last(0); ++x)
                held.push_back(std::ranges::any_of(pieces.parts, [&](const PointExtent& part) {
                    return inside(part, 0, x) && inside(part, 1, y) && inside(part, 2, z);
                }));
    return held;
}

TEST(PieceCover, IsThatOfEveryPointAskedOfEveryPiece) {
    std::mt19937 random(7);
    const auto number = [&](int lo, int hi) { return std::uniform_int_distribution(lo, hi)(random); };
    for (int n = 0; n < 2000; ++n) {
        GridPieces pieces;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            pieces.whole[2 * axis] = number(-2, 2);
            pieces.whole[2 * axis + 1] = pieces.whole[2 * axis] + number(0, 5);
        }
        for (int p = number(0, 6); p > 0; --p) {
            PointExtent part{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                part[2 * axis] = number(-4, 8);
                part[2 * axis + 1] = part[2 * axis] + number(-1, 7);
            }
            pieces.parts.push_back(part);
        }
        for (const bool cells : {false, true}) {
            const std::vector<std::uint8_t> wanted = heldPlainly(pieces, cells), held = heldBy(pieces, cells);
            const auto missing = std::size_t(std::ranges::count(wanted, 0));
            ASSERT_EQ(missingIn(pieces, cells), missing) << n;
            if (missing > 0)
                ASSERT_EQ(held, wanted) << n;
            else
                ASSERT_TRUE(held.empty()) << n;
        }
    }
}

class PieceFiles : public ForeignFiles {
protected:
    static std::string extent(int first, int last) {
        return std::to_string(first) + " " + std::to_string(last) + " 0 1 0 1";
    }
    static std::string values(int first, int last) {
        std::string text;
        for (int plane = 0; plane < 4; ++plane)
            for (int x = first; x <= last; ++x) text += std::to_string(100 + x) + " ";
        return text;
    }
    static std::string piece(int first, int last) {
        return "<Piece Extent=\"" + extent(first, last) +
               "\"><PointData><DataArray type=\"Float32\" Name=\"T\" format=\"ascii\">" + values(first, last) +
               "</DataArray></PointData></Piece>";
    }
    static std::string image(int first, int last, const std::string& pieces) {
        return "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"0.1\" byte_order=\"LittleEndian\">"
               "<ImageData WholeExtent=\"" +
               extent(first, last) + "\" Origin=\"0 0 0\" Spacing=\"1 1 1\">" + pieces + "</ImageData></VTKFile>\n";
    }
    static std::string list(int last, const std::vector<std::pair<std::string, std::string>>& pieces) {
        std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"PImageData\" version=\"0.1\"><PImageData "
                           "WholeExtent=\"" +
                           extent(0, last) +
                           "\" GhostLevel=\"0\" Origin=\"0 0 0\" Spacing=\"1 1 1\"><PPointData>"
                           "<PDataArray type=\"Float32\" Name=\"T\"/></PPointData>";
        for (const auto& [where, source] : pieces)
            text += "<Piece Extent=\"" + where + "\" Source=\"" + source + "\"/>";
        return text + "</PImageData></VTKFile>\n";
    }
    /// The values along x, "-" for those that are absent, and the notes.
    static std::string row(const std::string& path) {
        const Dataset data = openFiles({path}, {});
        const Field field = data.read(0, 0, 0);
        std::string text;
        for (int x = 0; x < data.info.lattice.size.x; ++x)
            text += field.present(std::size_t(x)) ? std::to_string(int(field.value(std::size_t(x)))) + " " : "- ";
        for (const std::string& note : data.info.notes) text += note;
        return text;
    }
};

TEST_F(PieceFiles, WhatNoPieceHoldsIsAbsent) {
    EXPECT_EQ(row(write("whole.vti", image(0, 4, piece(0, 2) + piece(2, 4)))), "100 101 102 103 104 ");
    EXPECT_THAT(row(write("gap.vti", image(0, 5, piece(0, 1) + piece(4, 5)))),
                testing::StartsWith("100 101 - - 104 105 its pieces leave out 8 samples and 3 cells"));
}

TEST_F(PieceFiles, AListWhosePartsLeaveSomethingOutIsRefused) {
    write("a.vti", image(0, 2, piece(0, 2)));
    write("b.vti", image(4, 6, piece(4, 6)));
    EXPECT_THAT(failure(write("gap.pvti", list(6, {{extent(0, 2), "a.vti"}, {extent(4, 6), "b.vti"}}))),
                testing::HasSubstr("its pieces leave out 4 of the samples"));
    write("b.vti", image(2, 6, piece(2, 6)));
    EXPECT_EQ(row(write("whole.pvti", list(6, {{extent(0, 2), "a.vti"}, {extent(2, 6), "b.vti"}}))),
              "100 101 102 103 104 105 106 ");
}

TEST_F(PieceFiles, APartThatHoldsLessThanItsListSaysIsRefused) {
    write("a.vti", image(0, 2, piece(0, 2)));
    EXPECT_THAT(failure(write("more.pvti", list(4, {{extent(0, 4), "a.vti"}}))),
                testing::HasSubstr("its part a.vti lacks 8 of the samples"));
    write("gap.vti", image(0, 5, piece(0, 1) + piece(4, 5)));
    EXPECT_THAT(failure(write("list.pvti", list(5, {{extent(0, 5), "gap.vti"}}))),
                testing::HasSubstr("gap.vti its pieces leave out 8 of the samples"));
    EXPECT_THAT(failure(write("none.pvti", list(4, {{extent(0, 2), "a.vti"}, {extent(2, 4), "b.vti"}}))),
                testing::HasSubstr("names b.vti, which does not exist"));
}

TEST_F(PieceFiles, APartElsewhereIsRefused) {
    for (const std::string& name : {std::string("../a.vti"), std::string("/etc/a.vti"), std::string("&#46;./a.vti")})
        EXPECT_THAT(failure(write("far.pvti", list(2, {{extent(0, 2), name}}))),
                    testing::HasSubstr("outside of its folder"));
    const std::string entity = "<?xml version=\"1.0\"?><!DOCTYPE a [<!ENTITY up \"../a.vti\">]>";
    EXPECT_THAT(failure(write("far.pvti", entity + list(2, {{extent(0, 2), "&up;"}}).substr(22))),
                testing::HasSubstr("declares a document type"));
}

} // namespace
} // namespace tessera::volume
