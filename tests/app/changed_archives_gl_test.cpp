#include "app/data/open.h"
#include "app/platform/headless.h"
#include "tests/fuzz/changed_archive.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>

/// Archives changed behind right checksums, opened and drawn as users do it; the target fuzz_metadata does much more of
/// it below the window.
namespace tessera::app {
namespace {

/// The whole window by a renderer, where the archive can be opened; whether it could be drawn.
bool draws(const std::string& path, const vis::RendererOptions& options) {
    try {
        const Opened opened = open({.paths = {path}, .layout = "", .data = {}, .import = {}});
        if (!opened.source || opened.source->grid().lattice.count() > 100'000) return false;
        PictureMaker maker(options);
        PictureRequest request;
        request.size = {640, 420};
        return maker.render(opened.document, opened.sources(), request).rgba.size() > 0;
    } catch (const Error&) { // all that may come of it
        return false;
    }
}

TEST(ChangedArchives, TheWindowDrawsThemOrSaysWhyNot) {
    const codec::testing::TemporaryFolder folder;
    const std::string path = folder / "changed.tsr";
    std::mt19937 random(7);
    int drawn = 0;
    for (int i = 0; i < 30; ++i) {
        std::vector<std::uint8_t> input(8);
        std::ranges::generate(input, [&] { return std::uint8_t(random()); });
        input[0] = std::uint8_t(i % 5);
        codec::testing::writeFile(path, changed_archives::archiveOf(input.data(), input.size()));
        drawn += draws(path, {.openGl = i % 3 != 0});
    }
    EXPECT_GE(drawn, 3); // of those whose change does no harm
}

} // namespace
} // namespace tessera::app
