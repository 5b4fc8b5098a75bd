// NRRD in all its forms: every value at its place, times, units, names.
#include "tests/import/scan_files.h"

using testing::ElementsAre;
using testing::HasSubstr;

namespace tessera::volume {

TEST_F(ScanCases, NrrdInEveryEncoding) {
    expectSamples(openCase("nrrd_gzip_bigendian.nrrd", {0.5, 0.5, 2}, "um"), counted);
    expectSamples(openCase("nrrd_hex.nrrd", {1, 1, 2}, ""), counted);
    expectSamples(openCase("nrrd_lineskip/lineskip.nhdr", {1, 1, 2}, ""), counted);
    expectSamples(openCase("nrrd_list/list.nhdr", {1, 1, 2}, ""), counted);
}

TEST_F(ScanCases, NrrdSkipsWhatItsHeaderSays) {
    const std::string bytes = "abcdefgh";
    const auto first = [&](const std::string& fields, const std::string& data) {
        write("s.bin", data);
        const std::string head = "NRRD0004\ntype: uchar\nsizes: 2 2 2\n" + fields + "data file: s.bin\n";
        return openFiles({write("s.nhdr", head)}, {}).read(0, 0, 0).value(0);
    };
    EXPECT_EQ(first("encoding: raw\nline skip: 1\nbyte skip: 2\n", "one\nxx" + bytes), 'a');
    EXPECT_EQ(first("encoding: raw\nbyteskip: -1\n", "anything" + bytes), 'a');
    EXPECT_EQ(first("encoding: raw\nbyteskip: -3\n", "anything" + bytes + "zz"), 'a');
    EXPECT_EQ(first("encoding: gzip\nline skip: 1\nbyte skip: 2\n", "one\n" + stored("xx" + bytes, false)), 'a');
    EXPECT_EQ(first("encoding: gzip\nbyte skip: -2\n", stored("anything" + bytes + "z", false)), 'a');
    EXPECT_EQ(first("encoding: text\nline skip: 1\n", "# head\n97 2 3 4, 5 6 7 8"), 'a');
}

TEST_F(ScanCases, DamageOfCompressedSamplesIsTold) {
    std::string samples;
    for (int i = 0; i < 5 * 6 * 700; ++i) samples += char(i * i / 7);
    const std::string head = "NRRD0004\ntype: uchar\nsizes: 5 6 700\nencoding: gzip\n\n",
                      packed = stored(samples, false);
    const auto failure = [&](const std::string& bytes) -> std::string {
        try {
            openFiles({write("s.nrrd", head + bytes)}, {}).read(0, 0, 0);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(failure(packed), "");
    EXPECT_EQ(failure(packed + "something else"), "");
    for (std::size_t at = 100; at < packed.size();
         at += 1517) { // the stream is not compressed: only its checksum tells
        std::string damaged = packed;
        damaged[at] = char(damaged[at] ^ 1);
        EXPECT_NE(failure(damaged), "") << at;
    }
    for (const std::size_t missing : {1, 4, 8}) EXPECT_NE(failure(packed.substr(0, packed.size() - missing)), "");
}

TEST_F(ScanCases, NrrdWithComponents) {
    const Dataset vectors = openFiles({scan("nrrd_gzip_vector.nrrd")}, {});
    ASSERT_EQ(vectors.info.parameters.size(), 1u);
    ASSERT_EQ(vectors.info.parameters[0].components, 3);
    EXPECT_EQ(vectors.info.lattice.size, glm::ivec3(10, 11, 12));
    EXPECT_EQ(vectors.info.lattice.spacing, glm::dvec3(0.5, 0.5, 2));
    double least = 1e9, most = -1e9;
    for (int c = 0; c < 3; ++c) {
        const Field field = vectors.read(0, c, 0);
        for (std::size_t i = 0; i < field.count(); ++i) {
            least = std::min(least, field.value(i));
            most = std::max(most, field.value(i));
        }
    }
    EXPECT_EQ(least, 0);
    EXPECT_EQ(most, 250);

    const Dataset lists = openFiles({scan("nrrd_vector_named_space.nrrd")}, {});
    EXPECT_EQ(lists.info.lattice.size, glm::ivec3(64, 9, 8));
    EXPECT_EQ(lists.info.lattice.spacing, glm::dvec3(0.5, 0.5, 2));
    EXPECT_EQ(lists.info.parameters.size(), 2u);
}

TEST_F(ScanCases, NrrdWithTimes) {
    const Dataset dataset = openCase("nrrd_4d_time_last_x10.nrrd", {0.5, 0.5, 2}, "mm");
    EXPECT_THAT(dataset.info.times, ElementsAre(0, 1.5, 3, 4.5, 6));
    EXPECT_EQ(dataset.info.timeUnit, "s");
    EXPECT_EQ(dataset.info.parameters.size(), 1u);
    // The time may be any axis, and its samples lie between those of a row.
    const std::string path = nrrd("2 3 4 5", "kinds: time domain domain domain\nspacings: 0.1 1 2 3\n"
                                             "axis mins: 5 nan nan nan\nunits: \"ms\" \"m\" \"m\" \"m\"\n");
    const Dataset first = openFiles({path}, {});
    EXPECT_EQ(first.info.lattice.size, glm::ivec3(3, 4, 5));
    EXPECT_THAT(first.info.times, ElementsAre(5, 5.1));
    EXPECT_EQ(first.info.timeUnit, "ms");
    for (const int t : {1, 0, 1})
        expectSamples(
            first, [&](int x, int y, int z) { return t + 2 * (x + 3 * (y + 4 * z)); }, 0, 0, t);
}

TEST_F(ScanCases, NrrdInAnyDirection) {
    // x runs backwards from 10: the first sample is the last of the file's rows.
    const Dataset flipped = openCase("nrrd_flip_x.nrrd", {0.5, 0.5, 2}, "");
    EXPECT_EQ(flipped.info.lattice.origin, glm::dvec3(5.5, 0, 0));
    expectSamples(flipped, [](int x, int y, int z) { return counted(9 - x, y, z); });
    EXPECT_THAT(notesOf(scan("nrrd_flip_x.nrrd")), HasSubstr("left, posterior and superior"));

    const std::string path = nrrd("3 4 5", "space: RAS\nspace directions: (0,0,-2) ( -0.5, 0, 0 ) (0,1,0)\n"
                                           "space origin: (1, 2, 3)\nspace units: \"mm\" \"mm\" \"mm\"\n");
    const Dataset turned = openFiles({path}, {});
    EXPECT_EQ(turned.info.lattice.size, glm::ivec3(4, 5, 3));
    EXPECT_EQ(turned.info.lattice.origin, glm::dvec3(-0.5, 2, -1));
    EXPECT_EQ(turned.info.lattice.spacing, glm::dvec3(0.5, 1, 2));
    expectSamples(turned, [](int x, int y, int z) { return (2 - z) + 3 * ((3 - x) + 4 * y); });

    // Slices alone, of a file whose layers run backwards.
    const std::string down = nrrd("3 4 5", "space dimension: 3\nspace directions: (1,0,0) (0,-1,0) (0,0,-1)\n");
    const Dataset backwards = openFiles({down}, {});
    ASSERT_TRUE(backwards.read.inParts());
    const Field part = backwards.read(0, 0, 0, SliceRange{1, 2});
    ASSERT_EQ(part.count(), 24u);
    for (int z = 0; z < 2; ++z)
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 3; ++x)
                EXPECT_EQ(part.value(std::size_t(x + 3 * (y + 4 * z))), x + 3 * ((3 - y) + 4 * (3 - z)));
}

TEST_F(ScanCases, NrrdFieldsAsTheyAreWritten) {
    const auto lattice = [&](const std::string& fields) { return openFiles({nrrd("4 5 6", fields)}, {}).info.lattice; };
    const Lattice cells = lattice("axis mins: 0 0 10\naxis maxs: 8 5 16\ncenters: cell cell cell\n");
    EXPECT_EQ(cells.spacing, glm::dvec3(2, 1, 1));
    EXPECT_EQ(cells.origin, glm::dvec3(1, 0.5, 10.5));
    const Lattice nodes = lattice("AXISMINS: 0 0 10\naxismaxs: 3 8 15\nCenterings: node node node\n");
    EXPECT_EQ(nodes.spacing, glm::dvec3(1, 2, 1));
    EXPECT_EQ(nodes.origin, glm::dvec3(0, 0, 10));
    EXPECT_EQ(lattice("spacings: NaN 2 nan\n").spacing, glm::dvec3(1, 2, 1));
    EXPECT_EQ(lattice("Space Dimension: 3\nSPACE DIRECTIONS: ( 2 , 0, 0) (0,3,0 ) (0,0,4)\n").spacing,
              glm::dvec3(2, 3, 4));
    const Dataset named = openFiles({nrrd("4 5 6", "content: flow rate\nsample units: \"m/s\"\nkey:=a: b\n")}, {});
    EXPECT_EQ(named.info.parameters[0].name, "flow rate");
    EXPECT_EQ(named.info.parameters[0].unit, "m/s");
    EXPECT_THAT(notesOf(nrrd("4 5 6", "old min: -1\nold max: 2.5\n")), HasSubstr("-1 and 2.5"));
    EXPECT_THAT(notesOf(nrrd("4 5 6", "colour: blue\n")), HasSubstr("\"colour\""));
}

TEST_F(ScanCases, NrrdAxesOfEveryKind) {
    const auto names = [&](const std::string& sizes, const std::string& fields) {
        const Dataset dataset = openFiles({nrrd(sizes, fields)}, {});
        std::string all;
        for (const Parameter& parameter : dataset.info.parameters)
            all += (all.empty() ? "" : " ") + parameter.name + (parameter.components == 3 ? "[3]" : "");
        return all + " " + std::to_string(dataset.info.times.size());
    };
    EXPECT_EQ(names("3 2 3 4", "kinds: vector domain domain domain\n"), "value[3] 1");
    EXPECT_EQ(names("3 2 3 4", "kinds: RGB-color domain domain domain\n"), "red green blue 1");
    EXPECT_EQ(names("2 2 3 4", "kinds: complex domain domain domain\n"), "real imaginary 1");
    EXPECT_EQ(names("2 3 4 3", "kinds: domain domain domain list\n"), "value.0 value.1 value.2 1");
    EXPECT_EQ(names("2 3 4 3", "kinds: domain domain domain 3-vector\ncontent: U\n"), "U[3] 1");
    EXPECT_EQ(names("2 3 4 3", "kinds: domain domain domain domain\n"), "value 3");
    EXPECT_EQ(names("2 3 2 17", "kinds: domain domain domain list\n"), "value 17");
    EXPECT_EQ(names("3 2 2 2 2", "kinds: vector domain domain domain time\n"), "value[3] 2");
    EXPECT_EQ(names("6 2 2 2", "kinds: 3D-symmetric-matrix domain domain domain\n"), "xx xy xz yy yz zz 1");
    EXPECT_THAT(notesOf(nrrd("5 6 7", "kinds: domain domain domain\n")), testing::Not(HasSubstr("taken as")));
    EXPECT_THAT(notesOf(nrrd("2 3 4 5", "")), HasSubstr("it is taken as"));
}

TEST_F(ScanCases, NrrdThatIsNoImageSaysWhy) {
    EXPECT_THAT(failure(nrrd("4 5 600", "")), HasSubstr("announces 12000"));
    EXPECT_THAT(failure(nrrd("4 5 0", "")), HasSubstr("out of range"));
    EXPECT_THAT(failure(nrrd("4 5 6", "dimension: 4\n")), HasSubstr("not the dimension"));
    EXPECT_THAT(failure(nrrd("4 5 6", "type: block\nblock size: 4\n")), HasSubstr("block"));
    EXPECT_THAT(failure(write("b.nhdr", "NRRD0004\ntype: uchar\nsizes: 2 2 2\nencoding: raw\ndata file: no.raw\n")),
                HasSubstr("no.raw cannot be read"));
    EXPECT_THAT(failure(write("c.nrrd", "NRRD0004\ntype: uchar\nsizes: 900000 900000 900\nencoding: gzip\n\nx")),
                HasSubstr("of which"));
}

} // namespace tessera::volume
