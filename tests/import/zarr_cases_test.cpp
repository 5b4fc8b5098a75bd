#include "tests/import/foreign_files.h"

namespace tessera::volume {
namespace {

std::string zarrCase(const std::string& name) {
    return std::string(TESSERA_SOURCE_DIR) + "/tests/import/cases/zarr/" + name;
}

class ZarrCases : public ForeignFiles {
protected:
    /// An array of 6 x 5 x 4 numbers of int16 in chunks of 4 x 5 x 4, of which the second is not stored.
    std::string writeArray(const std::string& folder, const std::string& more = "",
                           const std::string& chunk = "") const {
        write(folder + "/.zarray",
              "{\"zarr_format\":2,\"shape\":[6,5,4],\"chunks\":[4,5,4],\"dtype\":\"<i2\",\"order\":\"C\","
              "\"fill_value\":-7,\"filters\":null" +
                  (more.empty() ? ",\"compressor\":null" : more) + "}");
        std::vector<std::int16_t> numbers;
        for (int z = 0; z < 4; ++z)
            for (int y = 0; y < 5; ++y)
                for (int x = 0; x < 4; ++x) numbers.push_back(std::int16_t(x + 10 * y + 100 * z));
        write(folder + "/0.0.0", chunk.empty() ? bytesOf(numbers) : chunk);
        return (folder_ / folder).string();
    }
};

TEST_F(ZarrCases, OmeImage) {
    for (const char* slash : {"", "/"}) {
        const Dataset dataset = openFiles({zarrCase("ome.zarr") + slash}, {});
        EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(10, 11, 12));
        EXPECT_EQ(dataset.info.lattice.spacing, glm::dvec3(0.5, 0.5, 2));
        EXPECT_EQ(dataset.info.lengthUnit, "um");
        const Field field = dataset.read(0, 0, 0);
        for (const glm::ivec3 at : {glm::ivec3(0), glm::ivec3(1, 2, 3), glm::ivec3(9, 10, 11)})
            EXPECT_EQ(field.value(dataset.info.lattice.index(at)), at.x + 10 * at.y + 110 * at.z);
    }
}

TEST_F(ZarrCases, TimesChannelsAndPlaces) {
    const Dataset dataset = openFiles({zarrCase("tczyx.zarr")}, {});
    const DatasetInfo& info = dataset.info;
    EXPECT_EQ(info.lattice.size, glm::ivec3(4, 5, 6));
    EXPECT_EQ(info.lattice.spacing, glm::dvec3(0.25, 0.5, 2));
    EXPECT_EQ(info.lattice.origin, glm::dvec3(30, 20, 10));
    EXPECT_EQ(info.times, (std::vector<double>{0, 1.5, 3}));
    EXPECT_EQ(info.timeUnit, "s");
    ASSERT_EQ(info.parameters.size(), 2u);
    EXPECT_EQ(info.parameters[0].name, "DAPI");
    EXPECT_EQ(info.parameters[1].name, "GFP");
    EXPECT_EQ(info.parameters[0].type, ScalarType::U16);
    for (const int t : {2, 0, 1})
        for (const int c : {0, 1}) {
            const Field field = dataset.read(c, 0, t);
            EXPECT_EQ(field.value(0), 10000 * c + 1000 * t);
            EXPECT_EQ(field.value(field.count() - 1), 543 + 10000 * c + 1000 * t);
        }
}

TEST_F(ZarrCases, AChunkThatIsNotStoredHasTheFillValue) {
    const Dataset dataset = openFiles({writeArray("plain.zarr")}, {});
    const Field field = dataset.read(0, 0, 0);
    EXPECT_EQ(field.value(dataset.info.lattice.index({3, 4, 3})), 343);
    EXPECT_EQ(field.value(dataset.info.lattice.index({0, 0, 4})), -7);
    EXPECT_EQ(field.value(dataset.info.lattice.index({3, 4, 5})), -7);
}

TEST_F(ZarrCases, CompressedChunks) {
    const std::string whole = read(writeArray("raw.zarr") + "/0.0.0");
    for (const bool zlib : {true, false}) {
        const std::string more = std::string(",\"compressor\":{\"id\":\"") + (zlib ? "zlib" : "gzip") + "\"}";
        const Dataset dataset = openFiles({writeArray("packed.zarr", more, stored(whole, zlib))}, {});
        EXPECT_EQ(dataset.read(0, 0, 0).value(dataset.info.lattice.index({1, 2, 3})), 321);
    }
}

TEST_F(ZarrCases, WhatCannotBeReadIsTold) {
    write("v3.zarr/zarr.json", "{\"zarr_format\":3}");
    EXPECT_THAT(failure((folder_ / "v3.zarr").string()),
                testing::HasSubstr("Zarr version 3, which is not read: write it as version 2"));
    EXPECT_THAT(failure(writeArray("a.zarr", "", "short")), testing::HasSubstr("has another size than stated"));
    EXPECT_THAT(failure(writeArray("b.zarr", ",\"compressor\":{\"id\":\"jpeg\"}")),
                testing::HasSubstr("is compressed by jpeg, which is not read"));
    EXPECT_THAT(failure(writeArray("c.zarr", ",\"compressor\":{\"id\":\"blosc\"}", "no blosc at all, not even nearly")),
                testing::HasSubstr("is damaged"));
    write("d.zarr/.zarray",
          "{\"zarr_format\":2,\"shape\":[60000,60000,60000],\"chunks\":[500,500,500],\"dtype\":\"<f8\","
          "\"order\":\"C\",\"fill_value\":0,\"filters\":null,\"compressor\":null}");
    EXPECT_THAT(failure((folder_ / "d.zarr").string()), testing::HasSubstr("are stored"));
    write("e.zarr/.zattrs", "{\"plate\":{}}");
    EXPECT_THAT(failure((folder_ / "e.zarr").string()), testing::HasSubstr("open the folder of one image"));
}

} // namespace
} // namespace tessera::volume
