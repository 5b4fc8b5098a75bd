#include "app/history/session_file.h"
#include "app/platform/headless.h"

#include <gtest/gtest.h>

namespace tessera::app {
namespace {

/// A small cell in a layout, drawn on a lattice.
vis::Image drawn(PictureMaker& maker, const char* layout, const char* pane, PictureLattice lattice) {
    OpenRequest request;
    request.layout = layout;
    request.data.emplace();
    request.data->model = "fuel-cell";
    request.data->settings = {{"nx", 9}, {"ny", 11}, {"nz", 23}, {"times", 3}, {"even", 1}};
    request.data->lattice = lattice;
    request.data->derived = {{"ratio", "", volume::ExpressionRecipe{"O2 / (O2 + H2O)"}}};
    Opened opened = open(request);
    const volume::DatasetInfo& info = opened.numbers->info();
    const Range o2 = info.channelRange(info.channel(info.findChannel("O2").value()));
    opened.document.session.selection.brushes = {
        vis::rangeBrush({{.channel = "O2", .lo = o2.lo, .hi = 0.5 * (o2.lo + o2.hi)}}, "poor")};
    return maker.render(opened.document, opened.sources(), {.pane = pane, .size = {640, 420}, .scale = 1});
}

// What a reader sees of numbers is the same to the pixel, with a brush and with derived parameters.
TEST(NumbersGl, ViewsOfNumbersDoNotSeeTheLattice) {
    PictureMaker maker;
    for (const char* pane : {"statistics", "histogram", "profile"}) {
        const vis::Image grid = drawn(maker, "statistics", pane, PictureLattice::Grid);
        const vis::Image bcc = drawn(maker, "statistics", pane, PictureLattice::BodyCentred);
        EXPECT_EQ(grid.rgba, bcc.rgba) << pane;
    }
    EXPECT_EQ(drawn(maker, "overview", "scatterMatrix", PictureLattice::Grid).rgba,
              drawn(maker, "overview", "scatterMatrix", PictureLattice::BodyCentred).rgba);
    EXPECT_NE(drawn(maker, "overview", "volume", PictureLattice::Grid).rgba,
              drawn(maker, "overview", "volume", PictureLattice::BodyCentred).rgba)
        << "pictures do";
}

} // namespace
} // namespace tessera::app
