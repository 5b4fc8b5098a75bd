#include "app/data/number_origin.h"

#include "app/edits/error_band.h"
#include "app/pages/plot_page.h"
#include "app/queries/focus_share.h"
#include "codec/container/metadata.h"
#include "volume/field/mesh_origin.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace tessera::app {
namespace {

volume::DatasetInfo fourParameters() {
    volume::DatasetInfo info;
    const auto add = [&](const char* name, const char* unit, int components, std::vector<Range> ranges) {
        volume::Parameter parameter;
        parameter.name = name;
        parameter.unit = unit;
        parameter.components = components;
        parameter.ranges = std::move(ranges);
        info.parameters.push_back(parameter);
    };
    add("T", "K", 1, {{300, 340}});
    add("p", "Pa", 1, {{1e5, 2e5}});
    add("U", "m/s", 3, {{-1, 1}, {0, 1}, {0, 4}, {0, 5}});
    add("region", "", 1, {{0, 3}});
    info.parameters.back().categorical = true;
    info.lattice.size = {10, 10, 10};
    return info;
}

std::vector<int> channel(const volume::DatasetInfo& info, const char* name) {
    return {info.findChannel(name).value()};
}

NumberOrigin storedOn(volume::LatticeKind lattice, double maxError, double absError = 0) {
    codec::Metadata metadata;
    metadata.info = fourParameters();
    metadata.info.lattice.kind = lattice;
    metadata.lossless = maxError == 0;
    metadata.maxError = maxError;
    metadata.options.absError = absError;
    return storedOrigin(metadata);
}

TEST(NumberOrigin, SaysWhereNumbersComeFrom) {
    volume::DatasetInfo info = fourParameters();
    const NumberOrigin computed = computedOrigin(info);
    EXPECT_EQ(originText(computed, info), "as computed");
    EXPECT_EQ(originText(computed, info, channel(info, "T")), "as computed");
    EXPECT_EQ(originText(storedOn(volume::LatticeKind::CC, 0), info), "as computed") << "every sample is exact";
    EXPECT_EQ(originText(storedOn(volume::LatticeKind::BCC, 0), info), "resampled to BCC, stored losslessly");
    EXPECT_EQ(originLine(computed, info), "# numbers: as computed\n");
    info.provenance = volume::meshProvenance(41000, {24, 32, 88});
    EXPECT_EQ(originText(computedOrigin(info), info), "resampled");
    info.provenance = volume::kFromGrids;
    EXPECT_EQ(originText(computedOrigin(info), info), "resampled");
}

TEST(NumberOrigin, BoundsAreInTheUnitOfTheParameterAndNeverTooSmall) {
    const volume::DatasetInfo info = fourParameters();
    const NumberOrigin cc = storedOn(volume::LatticeKind::CC, 0.01);
    EXPECT_EQ(originText(cc, info, channel(info, "T")), "stored on CC, error at most 0.4 K");
    EXPECT_EQ(originText(cc, info, channel(info, "U.x")), "stored on CC, error at most 0.04 m/s")
        << "relative to the widest component";
    EXPECT_EQ(originText(cc, info, channel(info, "|U|")), "stored on CC, error at most 0.07 m/s");
    EXPECT_EQ(originText(cc, info, channel(info, "region")), "as computed") << "labels are exact";
    EXPECT_EQ(originText(cc, info, {channel(info, "T")[0], channel(info, "p")[0]}),
              "stored on CC, error at most T 0.4 K, p 1000 Pa");
    EXPECT_EQ(originText(cc, info), "stored on CC, error at most 1 % of each range");
    const NumberOrigin bcc = storedOn(volume::LatticeKind::BCC, 0.01034);
    EXPECT_EQ(originText(bcc, info, channel(info, "T")), "resampled to BCC, stored with an error at most 0.42 K");
    EXPECT_GE(0.42, errorBound(bcc, info, info.channel(0)));
    const NumberOrigin absolute = storedOn(volume::LatticeKind::CC, 0.5, 0.25);
    EXPECT_EQ(originText(absolute, info, channel(info, "T")), "stored on CC, error at most 0.25 K");
    EXPECT_EQ(originText(absolute, info, channel(info, "p")), "stored on CC, error at most 0.25 Pa");
}

TEST(NumberOrigin, TellsDerivedParametersAndOriginalsFromWhatIsRead) {
    volume::DatasetInfo info = fourParameters();
    NumberOrigin origin = computedOrigin(info);
    info.parameters.push_back(info.parameters[0]);
    info.parameters.back().name = "T - 300";
    EXPECT_EQ(originText(origin, info, channel(info, "T - 300")), "derived from samples as computed");
    EXPECT_EQ(originText(origin, info, {channel(info, "T")[0], channel(info, "T - 300")[0]}),
              "as computed; derived parameters from these");

    info = fourParameters();
    info.parameters.push_back(info.parameters[0]);
    info.parameters.back().name = "T as computed";
    origin = storedOn(volume::LatticeKind::BCC, 0.01);
    origin.originals = true;
    origin.parameters = -1;
    EXPECT_EQ(originText(origin, info, channel(info, "T as computed")), "as computed");
    EXPECT_EQ(originText(origin, info, channel(info, "T")), "resampled to BCC, stored with an error at most 0.4 K");
    EXPECT_EQ(originText(origin, info, {channel(info, "T")[0], channel(info, "T as computed")[0]}),
              "resampled to BCC, stored with an error at most 0.4 K; originals as computed");
    origin.alongTime = true;
    EXPECT_EQ(originText(origin, info, channel(info, "T as computed")), "as computed, interpolated along time");
}

TEST(NumberOrigin, SaysWhatKindOfBoundIsKnown) {
    volume::DatasetInfo info = fourParameters();
    const auto of = [&](const NumberOrigin& origin, const char* name) {
        return packingBound(origin, info, info.channel(channel(info, name)[0]));
    };
    EXPECT_EQ(of(computedOrigin(info), "T"), PackingBound{}) << "exact";
    EXPECT_EQ(of(storedOn(volume::LatticeKind::CC, 0), "T"), PackingBound{});
    const NumberOrigin cc = storedOn(volume::LatticeKind::CC, 0.01);
    ASSERT_TRUE(of(cc, "T"));
    EXPECT_NEAR(of(cc, "T")->most, 0.4, 1e-12);
    EXPECT_EQ(boundKind(*of(cc, "T")), "bound of the archive");
    EXPECT_FALSE(of(cc, "region")) << "labels have none";
    EXPECT_FALSE(of(storedOn(volume::LatticeKind::BCC, 0), "T")) << "what resampling has changed is not known";
    EXPECT_EQ(boundKind(*of(storedOn(volume::LatticeKind::BCC, 0.01), "T")),
              "bound of the archive, without resampling");
    NumberOrigin other = cc;
    other.discarded = true;
    EXPECT_FALSE(of(other, "T")) << "bricks are left out";
    other = storedOn(volume::LatticeKind::BCC, 0.01);
    other.resampleErrors = {1.5, 2, 3, 0};
    EXPECT_EQ(of(other, "T"), (PackingBound{1.5, true, false}));
    EXPECT_EQ(boundKind(*of(other, "T")), "largest error measured when packed");
    // The derived parameter has it, one of a derived one has none.
    const std::vector<volume::DerivedParameter> wanted = {{"u", "K", volume::UncertaintyRecipe{"T"}},
                                                          {"v", "K", volume::UncertaintyRecipe{"none"}}};
    const auto made = withBounds(wanted, cc, info);
    EXPECT_NEAR(std::get<volume::UncertaintyRecipe>(made[0].recipe).bound.value_or(0), 0.4, 1e-12);
    EXPECT_FALSE(std::get<volume::UncertaintyRecipe>(made[1].recipe).bound);
    info.parameters.push_back(info.parameters[0]);
    info.parameters.back().name = "T - 300";
    EXPECT_FALSE(of(cc, "T - 300"));
}

TEST(ErrorBand, LiesOnBothSidesOfASurfaceAndFollowsIt) {
    Session session;
    session.layers = {{"T", true, vis::IsoLayer{.channel = "T", .value = 320}},
                      {"other", true, vis::VolumeLayer{.channel = "p"}}};
    const auto values = [&] {
        std::vector<double> out;
        for (const vis::Layer& layer : session.layers)
            if (const auto* surface = std::get_if<vis::IsoLayer>(&layer.technique)) out.push_back(surface->value);
        std::ranges::sort(out);
        return out;
    };
    showErrorBand(session, 1, 0.5);
    showErrorBand(session, 0, 0);
    showErrorBand(session, 7, 0.5);
    EXPECT_EQ(session.layers.size(), 2u) << "no surface, no bound, no layer";
    showErrorBand(session, 0, 0.5);
    EXPECT_EQ(values(), (std::vector<double>{319.5, 320, 320.5}));
    EXPECT_EQ(std::get<vis::IsoLayer>(session.layers[0].technique).opacity, 1) << "the surface stays as it is";
    for (const std::size_t band : {std::size_t(1), std::size_t(2)}) {
        EXPECT_LT(std::get<vis::IsoLayer>(session.layers[band].technique).opacity, 0.5f);
        EXPECT_TRUE(isOfErrorBand(session.layers[band]));
        showErrorBand(session, band, 0.5); // none around one of these
    }
    std::get<vis::IsoLayer>(session.layers[0].technique).value = 330;
    showErrorBand(session, 0, 2);
    EXPECT_EQ(values(), (std::vector<double>{328, 330, 332})) << "those that are there follow";
    EXPECT_EQ(session.layers.size(), 4u);
}

TEST(NumberOrigin, StandsInVectorGraphics) {
    VectorPage drawing = plotPage({}, 1, {});
    drawing.numbers = "as computed & < 1 %";
    const std::string svg = svgOf(drawing);
    EXPECT_NE(svg.find("<desc>numbers: as computed &amp; &lt; 1 %</desc>\n<rect "), std::string::npos) << svg;
}

/// T is everywhere, O2 at 300 of 1000 samples.
StatisticsResult counted(const volume::DatasetInfo& info, double t, double o2) {
    StatisticsResult result;
    result.brushed = true;
    result.query.channels = {info.findChannel("T").value(), info.findChannel("O2").value()};
    result.statistics.channels.resize(2);
    result.statistics.channels[0].all.samples = 1000;
    result.statistics.channels[0].inside.samples = t;
    result.statistics.channels[1].all.samples = 300;
    result.statistics.channels[1].inside.samples = o2;
    return result;
}

TEST(FocusShare, SaysOfWhat) {
    volume::DatasetInfo info = fourParameters();
    info.parameters[1].name = "O2";
    volume::BrickGrid grid;
    grid.lattice = info.lattice;
    StatisticsResult result = counted(info, 40, 40);
    result.query.selection.brushes.resize(1);
    result.query.selection.brushes[0].region = vis::RangeRegion{{{.channel = "O2", .lo = 0, .hi = 1}}};
    FocusShare share = focusShare(result, info, grid);
    EXPECT_EQ(shareText(share), "4.0 % of all samples, 13 % of where O2 exists");
    EXPECT_EQ(share.ofThere(), 40.0 / 300);
    EXPECT_EQ(shareTexts(share).back(), "4.0%");
    // A brush in what exists everywhere, or in space: of all samples.
    result.query.selection.brushes[0].region = vis::RangeRegion{{{.channel = "T", .lo = 0, .hi = 1}}};
    EXPECT_EQ(shareText(focusShare(result, info, grid)), "4.0 % of all samples");
    result.query.selection.brushes[0].region = vis::SphereRegion{};
    EXPECT_EQ(shareText(focusShare(result, info, grid)), "4.0 % of all samples");
    // Nothing exists in a part of the grid: of what exists at most points.
    result.statistics.channels[0].all.samples = 800;
    EXPECT_EQ(shareText(focusShare(result, info, grid)), "4.0 % of all samples, 5.0 % of where T exists");
}

} // namespace
} // namespace tessera::app
