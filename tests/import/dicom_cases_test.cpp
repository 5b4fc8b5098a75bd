// DICOM written by pydicom, DCMTK and GDCM: every value, place, time and unit. Unless stated otherwise a sample is
// x + 10 y + 110 z + 2000 t.
#include "tests/import/foreign_files.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace tessera::volume {
namespace {

class DicomCases : public ForeignFiles {
protected:
    static std::string given(const std::string& name) {
        return (fs::path(TESSERA_SOURCE_DIR) / "tests/import/cases/dicom" / name).string();
    }
    static std::string notesOf(const std::string& path) {
        std::string all;
        for (const std::string& note : previewFiles({path}, {}).notes) all += note + "\n";
        return all;
    }
    /// Every sample, slice by slice: `wanted` gives NaN where there is none.
    static void expectSamples(const std::string& path, const std::function<double(glm::ivec3, int)>& wanted,
                              int parameter = 0) {
        const Dataset data = openFiles({path}, {});
        const glm::ivec3 size = data.info.lattice.size;
        int wrong = 0;
        for (int t = 0; t < int(data.info.times.size()); ++t) {
            const Field field = data.read(parameter, 0, t);
            std::size_t i = 0;
            for (int z = 0; z < size.z; ++z)
                for (int y = 0; y < size.y; ++y)
                    for (int x = 0; x < size.x; ++x, ++i) {
                        const double value = wanted({x, y, z}, t);
                        const bool right = std::isnan(value) ? !field.present(i)
                                                             : field.present(i) && std::abs(field.value(i) - value) <=
                                                                                       1e-6 * std::abs(value);
                        if (!right && ++wrong < 4)
                            ADD_FAILURE() << path << " at " << x << " " << y << " " << z << " " << t << ": "
                                          << field.value(i) << ", not " << value;
                    }
        }
        EXPECT_EQ(wrong, 0);
    }
    static void expectGrid(const std::string& path, glm::ivec3 size, glm::dvec3 spacing, glm::dvec3 origin) {
        const DatasetInfo info = openFiles({path}, {}).info;
        EXPECT_EQ(info.lattice.size, size) << path;
        EXPECT_LT(glm::length(info.lattice.spacing - spacing), 1e-9) << path;
        EXPECT_LT(glm::length(info.lattice.origin - origin), 1e-9) << path;
        EXPECT_EQ(info.lengthUnit, "mm") << path;
    }
    /// A folder of copies, which may be changed.
    std::string copied(const std::string& name) const {
        fs::copy(given(name), folder_ / name, fs::copy_options::recursive);
        return (folder_ / name).string();
    }
};

constexpr glm::ivec3 kTenElevenTwelve{10, 11, 12};
double usual(glm::ivec3 at, int t) {
    return at.x + 10 * at.y + 110 * at.z + 2000 * t;
}

TEST_F(DicomCases, FunctionalGroupsCountWhateverTheClassOfTheFile) {
    const std::string path = given("dcm_enhanced.dcm");
    expectGrid(path, kTenElevenTwelve, {0.25, 0.5, 2}, {1, 2, 10});
    expectSamples(path, [](glm::ivec3 at, int t) { return 2 * usual(at, t) - 1000; });
    EXPECT_EQ(openFiles({path}, {}).info.parameters[0].unit, "HU");
}

TEST_F(DicomCases, FramesInAnyOrderBecomeSlicesAndTimes) {
    const std::string path = given("kinds/enh_mr.dcm"); // its 36 frames are shuffled
    expectGrid(path, kTenElevenTwelve, {0.25, 0.5, 2}, {1, 2, 10});
    expectSamples(path, [](glm::ivec3 at, int t) { return 2 * usual(at, t) - 1000; });
    const DatasetInfo info = openFiles({path}, {}).info;
    EXPECT_EQ(info.times, (std::vector<double>{1, 2, 3}));
    EXPECT_EQ(info.timeName, "temporal position");
}

TEST_F(DicomCases, TwelveBitsWithASign) {
    expectGrid(given("dcm_signed12"), kTenElevenTwelve, {0.25, 0.5, 2}, {1, 2, 10});
    expectSamples(given("dcm_signed12"), [](glm::ivec3 at, int t) { return usual(at, t) - 600; });
    EXPECT_EQ(openFiles({given("dcm_signed12")}, {}).info.parameters[0].unit, "") << "HU needs a rescale";
    EXPECT_THAT(notesOf(given("dcm_signed12")), testing::HasSubstr("without a rescale"));
}

TEST_F(DicomCases, TiltedSlicesAreSheared) {
    expectSamples(given("dcm_tilt"), usual);
    EXPECT_THAT(notesOf(given("dcm_tilt")), testing::HasSubstr("oblique to each other: up to 18.5 degrees"));
}

TEST_F(DicomCases, TheLargestSeriesIsShownAndOthersNamed) {
    expectGrid(given("dcm_twoseries"), kTenElevenTwelve, {0.25, 0.5, 2}, {1, 2, 10});
    expectSamples(given("dcm_twoseries"), usual);
    EXPECT_THAT(notesOf(given("dcm_twoseries")), testing::HasSubstr("1 image of 20 x 20: open loc.dcm"));
    EXPECT_EQ(openFiles({given("dcm_twoseries/loc.dcm")}, {}).info.lattice.size, glm::ivec3(20, 20, 1));
}

TEST_F(DicomCases, EveryEncodingHoldsTheSameNumbers) {
    for (const char* form : {"plain", "implicit", "big", "deflated", "j2k", "jpeg", "jpegls", "rle"}) {
        SCOPED_TRACE(form);
        expectSamples(given(std::string("forms/") + form + ".dcm"), [](glm::ivec3 at, int) {
            return at.y == 0 ? std::nan("") : at.x + 10 * at.y + 330 - 1024; // -2000 is padding
        });
    }
}

TEST_F(DicomCases, FilmsAreTimes) {
    const DatasetInfo film = openFiles({given("kinds/us.dcm")}, {}).info;
    EXPECT_EQ(film.lattice.size, glm::ivec3(10, 11, 1));
    EXPECT_LT(glm::length(film.lattice.spacing - glm::dvec3(0.2, 0.3, 1)), 1e-9) << "cm of its region";
    ASSERT_EQ(film.times.size(), 5u);
    EXPECT_NEAR(film.times[4], 4 * 33.3, 1e-9);
    EXPECT_EQ(film.timeUnit, "ms");
    expectSamples(given("kinds/us.dcm"), [](glm::ivec3 at, int t) { return (at.x + 10 * at.y + 110 * t) % 256; });
    const DatasetInfo windows = openFiles({given("kinds/nm_dyn.dcm")}, {}).info; // two energies, three phases
    ASSERT_EQ(windows.parameters.size(), 2u);
    EXPECT_EQ(windows.parameters[1].name, "energy window 2");
    EXPECT_EQ(windows.times.size(), 3u);
    expectSamples(
        given("kinds/nm_dyn.dcm"), [](glm::ivec3 at, int t) { return at.x + 10 * at.y + 110 * (t + 3); }, 1);
}

TEST_F(DicomCases, SeveralImagesAtOnePlaceAreTimesOrParameters) {
    struct Axis {
        const char *folder, *name, *unit;
        double second;
    };
    for (const Axis& axis : {Axis{"trigger", "trigger time", "ms", 40.5},
                             {"clock", "time", "s", 3},
                             {"bvalue", "b-value", "s/mm2", 500},
                             {"order", "image", "", 1}}) {
        SCOPED_TRACE(axis.folder);
        const std::string folder = given(std::string("series/") + axis.folder);
        expectGrid(folder, {3, 2, 2}, {0.25, 0.5, 2}, {1, 2, 10});
        expectSamples(folder, usual);
        const DatasetInfo info = openFiles({folder}, {}).info;
        EXPECT_EQ(info.times, (std::vector<double>{0, axis.second}));
        EXPECT_EQ(info.timeName, axis.name);
        EXPECT_EQ(info.timeUnit, axis.unit);
    }
    EXPECT_THAT(notesOf(given("series/order")), testing::HasSubstr("in order of their numbers"));
    const DatasetInfo kinds = openFiles({given("series/kinds")}, {}).info;
    ASSERT_EQ(kinds.parameters.size(), 2u);
    EXPECT_EQ(kinds.parameters[0].name, "magnitude");
    EXPECT_EQ(kinds.parameters[1].name, "angle");
    EXPECT_FALSE(kinds.parameters[1].categorical);
    expectSamples(
        given("series/kinds"), [](glm::ivec3 at, int) { return usual(at, 1); }, 1);
}

TEST_F(DicomCases, EachSliceHasItsOwnRescale) {
    expectSamples(given("series/pet"), [](glm::ivec3 at, int t) { return usual(at, t) * (0.5 + 0.25 * at.z); });
    EXPECT_EQ(openFiles({given("series/pet")}, {}).info.parameters[0].unit, "Bq/ml");
    EXPECT_THAT(notesOf(given("series/pet")), testing::HasSubstr("differs from slice to slice"));
}

TEST_F(DicomCases, SagittalSlicesRunAlongX) {
    expectGrid(given("series/sagittal"), {2, 3, 2}, {3, 0.25, 0.5}, {2, 2, 9.5}); // the second slice comes first
    expectSamples(given("series/sagittal"), [](glm::ivec3 at, int) { return usual({at.y, 1 - at.z, 1 - at.x}, 0); });
}

TEST_F(DicomCases, DosesAreScaledAndPlacedByTheirList) {
    expectGrid(given("kinds/dose.dcm"), kTenElevenTwelve, {0.25, 0.5, 2}, {1, 2, 10});
    expectSamples(given("kinds/dose.dcm"), [](glm::ivec3 at, int t) { return 0.1 * usual(at, t); });
    EXPECT_EQ(openFiles({given("kinds/dose.dcm")}, {}).info.parameters[0].unit, "Gy");
}

TEST_F(DicomCases, SegmentsAreLabelsOrParameters) {
    const auto inside = [](glm::ivec3 at, glm::ivec3 lo, glm::ivec3 hi) {
        return at.x >= lo.x && at.y >= lo.y && at.z >= lo.z && at.x < hi.x && at.y < hi.y && at.z < hi.z;
    };
    const Dataset labels = openFiles({given("kinds/seg.dcm")}, {});
    EXPECT_TRUE(labels.info.parameters[0].categorical);
    expectGrid(given("kinds/seg.dcm"), {10, 11, 5}, {0.25, 0.5, 2}, {1, 2, 14}); // the slices that it has
    expectSamples(given("kinds/seg.dcm"), [&](glm::ivec3 at, int) {
        return (inside(at, {2, 3, 0}, {5, 6, 3}) ? 1 : 0) + (inside(at, {5, 6, 2}, {9, 9, 5}) ? 2 : 0);
    });
    std::string names;
    for (const Label& label : labels.info.parameters[0].labels) names += label.name + "|";
    EXPECT_EQ(names, "Liver|Left kidney|");
    const Dataset both = openFiles({given("kinds/seg_overlap.dcm")}, {});
    ASSERT_EQ(both.info.parameters.size(), 2u);
    EXPECT_EQ(both.info.parameters[0].name, "Liver");
    EXPECT_THAT(notesOf(given("kinds/seg_overlap.dcm")), testing::HasSubstr("segments overlap"));
    expectSamples(given("kinds/seg_frac.dcm"), [&](glm::ivec3 at, int) {
        return inside(at, {2, 3, 0}, {5, 6, 3}) ? 200.0 / 255 : 0.0;
    });
}

TEST_F(DicomCases, WhatIsMissingOrThereTwiceIsSaid) {
    const std::string folder = copied("dcm_signed12");
    fs::remove(folder + "/im004.dcm");
    expectSamples(folder, [](glm::ivec3 at, int t) { return at.z == 4 ? std::nan("") : usual(at, t) - 600; });
    EXPECT_THAT(notesOf(folder), testing::HasSubstr("1 slice is missing and left empty, at 18"));
    fs::copy(given("dcm_signed12/im004.dcm"), folder + "/im004.dcm");
    fs::copy(given("dcm_signed12/im004.dcm"), folder + "/again.dcm");
    expectSamples(folder, [](glm::ivec3 at, int t) { return usual(at, t) - 600; });
    EXPECT_THAT(notesOf(folder), testing::HasSubstr("1 slice is there twice"));
}

TEST_F(DicomCases, OtherFilesInTheFolderDoNotMatter) {
    const std::string folder = copied("dcm_signed12");
    write("dcm_signed12/page.dcm", "<html>" + std::string(200, 'x') + "</html>");
    write("dcm_signed12/README", "not an image");
    fs::rename(folder + "/im000.dcm", folder + "/1.2.840.113619.2.55.3");
    expectSamples(folder, [](glm::ivec3 at, int t) { return usual(at, t) - 600; });
    EXPECT_THAT(notesOf(folder), testing::HasSubstr("page.dcm is left out: it is not a DICOM file"));
}

TEST_F(DicomCases, SlicesAtUnevenDistancesKeepThem) {
    const std::string folder = copied("dcm_signed12");
    for (const char* name : {"im004.dcm", "im005.dcm", "im007.dcm"}) fs::remove(folder + "/" + std::string(name));
    std::string moved = read(folder + "/im006.dcm");
    const std::size_t at = moved.find("22.0");
    ASSERT_NE(at, std::string::npos);
    moved.replace(at, 4, "21.1");
    write("dcm_signed12/im006.dcm", moved);
    EXPECT_THAT(notesOf(folder), testing::HasSubstr("uneven distances, from 2 to 5.1"));
    const Dataset data = openFiles({folder}, {});
    EXPECT_NEAR(data.info.bounds.lo.z, 10, 1e-9);
    EXPECT_NEAR(data.info.bounds.hi.z, 32, 1e-9);
}

TEST_F(DicomCases, WhatIsNotReadNamesAWayOut) {
    EXPECT_THAT(failure(given("kinds/video.dcm")), testing::HasSubstr("gdcmraw"));
    std::string other = read(given("kinds/video.dcm"));
    const std::string syntax = "1.2.840.10008.1.2.4.102";
    other.replace(other.find(syntax), syntax.size(), "1.2.840.10008.1.2.4.201");
    EXPECT_THAT(failure(write("a.dcm", other)), testing::HasSubstr("write it uncompressed"));
}

TEST_F(DicomCases, HostileSizesAreRefused) {
    // An element of 4 GiB in a file of a few bytes, and 65535 x 65535 frames that are not there.
    const std::string head =
        std::string(128, '\0') + "DICM" + std::string("\x02\0\x10\0UI\x14\0", 8) + inBytes("1.2.840.10008.1.2.1", 20);
    const std::string huge = std::string("\x08\0\x99\x99OB\0\0", 8) + bytesOf(0xfffffff0u) + "abc";
    EXPECT_THAT(failure(write("huge.dcm", head + huge)), testing::HasSubstr("truncated"));
    for (const char* form : {"plain", "j2k", "jpeg", "jpegls", "rle", "deflated"}) {
        std::string bytes = read(given(std::string("forms/") + form + ".dcm"));
        const std::string rows = std::string("\x28\0\x10\0US\2\0", 8);
        if (const std::size_t at = bytes.find(rows); at != std::string::npos)
            bytes.replace(at + 8, 2, "\xff\xff");
        else
            bytes.resize(bytes.size() / 2);
        EXPECT_NE(failure(write("a.dcm", bytes)), "") << form;
        const std::string path = copied(std::string("forms"));
        const std::string cut = path + "/" + form + ".dcm";
        expectCutsAreTold(cut, cut);
        fs::remove_all(path);
    }
}

} // namespace
} // namespace tessera::volume
