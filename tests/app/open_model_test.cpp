#include "app/data/open.h"
#include "app/session/session.h"
#include "volume/base/error.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

/// Built-in models by their names, as inputs of commands.
namespace tessera::app {
namespace {

OpenRequest named(const std::string& input, const std::string& layout = "") {
    OpenRequest request;
    request.paths = {input};
    request.layout = layout;
    return request;
}

TEST(OpenModel, ANameOpensTheModelLikeAFile) {
    const Opened opened = open(named("marschner-lobb"));
    ASSERT_TRUE(opened.source);
    EXPECT_EQ(opened.source->info().name, "marschner-lobb");
    EXPECT_EQ(opened.document.session.data.model, "marschner-lobb");
    EXPECT_TRUE(opened.document.session.data.files.empty());
    EXPECT_EQ(opened.document.session.layers.size(), 2u) << "the first picture of any data";
    EXPECT_TRUE(opened.sessionPath.empty());
}

TEST(OpenModel, LayoutAndLatticeApplyToIt) {
    OpenRequest request = named("marschner-lobb", "shadowCube");
    request.lattice = PictureLattice::Grid;
    const Opened opened = open(request);
    EXPECT_EQ(opened.source->info().lattice.kind, volume::LatticeKind::CC);
    bool cube = false;
    for (const auto& [key, view] : opened.document.session.views)
        cube = cube || std::holds_alternative<ShadowCubeView>(view);
    EXPECT_TRUE(cube);
}

TEST(OpenModel, WhatIsStatedAboutFilesIsRefused) {
    EXPECT_EQ(modelNamed("marschner-lobb", {}, {}).info.parameters.size(), 1u);
    volume::ImportOptions stated;
    stated.parameters = {"rho"};
    EXPECT_THROW(modelNamed("marschner-lobb", stated, {}), Error);
}

TEST(OpenModel, AFileOfThatNameTakesItsPlace) {
    const auto former = std::filesystem::current_path(),
               folder = std::filesystem::temp_directory_path() / "tessera_open_model";
    std::filesystem::create_directories(folder);
    std::filesystem::current_path(folder);
    EXPECT_TRUE(namesModel("casting"));
    std::ofstream("casting") << "no data";
    EXPECT_FALSE(namesModel("casting"));
    EXPECT_THROW(open(named("casting")), Error);
    std::filesystem::current_path(former);
    std::filesystem::remove_all(folder);
    EXPECT_FALSE(namesModel("nothing"));
}

} // namespace
} // namespace tessera::app
