// Nothing is packed that cannot be read again.
#include "codec/archive/archive.h"
#include "codec/container/metadata.h"
#include "codec/pack/pack.h"
#include "tests/codec/make_dataset.h"
#include "volume/base/error.h"

#include <filesystem>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace tessera::codec::testing {
namespace {

namespace fs = std::filesystem;

volume::Dataset withParameters(std::size_t count) {
    std::vector<MadeParameter> parameters;
    for (std::size_t p = 0; p < count; ++p) parameters.push_back({"a" + std::to_string(p)});
    return makeDataset({2, 2, 2}, parameters, 1);
}

std::string reasonOf(volume::Dataset& data, const std::string& path) {
    try {
        pack(data, {}, path);
    } catch (const Error& error) {
        return error.reason();
    }
    return "";
}

TEST(Storable, WhatReadersRefuseIsRefusedBeforeAnyWork) {
    const fs::path folder = fs::temp_directory_path() / ("tessera_storable_" + std::to_string(getpid()));
    fs::create_directories(folder);
    const std::string path = (folder / "a.tsr").string();
    volume::Dataset many = withParameters(kMostParameters + 1);
    bool read = false;
    many.read = [&read](int, int, int) -> volume::Field {
        read = true;
        throw Error("is not to be read");
    };
    EXPECT_THAT(reasonOf(many, path), ::testing::HasSubstr("4097 parameters do not fit into an archive"));
    EXPECT_FALSE(read);
    EXPECT_TRUE(fs::is_empty(folder));

    volume::Dataset labels = withParameters(1), quantities = withParameters(1), notes = withParameters(1);
    labels.info.parameters[0].labels.resize(65537);
    quantities.info.quantities.resize(4097, {"q", "", {1}});
    notes.info.notes.resize(4097);
    for (volume::Dataset* data : {&labels, &quantities, &notes}) {
        EXPECT_THAT(reasonOf(*data, path), ::testing::HasSubstr("does not fit into an archive"));
        EXPECT_TRUE(fs::is_empty(folder));
    }
    volume::Dataset few = withParameters(3);
    EXPECT_EQ(reasonOf(few, path), "");
    EXPECT_EQ(Archive(path).info().parameters.size(), 3u);
    fs::remove_all(folder);
}

TEST(Storable, AsManyParametersAsReadersAcceptAreAccepted) {
    Metadata metadata;
    metadata.info = withParameters(kMostParameters).info;
    metadata.source = metadata.info.lattice;
    metadata.grid.lattice = metadata.info.lattice;
    metadata.grid.brickSize = 64;
    EXPECT_EQ(&storable(metadata), &metadata);
}

} // namespace
} // namespace tessera::codec::testing
