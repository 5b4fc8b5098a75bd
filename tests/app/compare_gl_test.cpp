#include "app/edits/compare.h"
#include "app/platform/headless.h"
#include "app/views/compare/compare_layout.h"
#include "app/views/compare/compare_pictures.h"
#include "app/views/compare/compare_view.h"
#include "tests/app/views_fixture.h"
#include "volume/base/error.h"
#include "volume/sources/memory_source.h"
#include "volume/synthetic/models.h"

#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tessera::app {
namespace {

struct Compared {
    SessionDocument document;
    std::shared_ptr<const volume::BrickSource> source;
    CompareView view;
    std::vector<CompareRow> rows;

    Compared() {
        DataRef data;
        data.model = "fuel-cell";
        data.settings = {{"nx", 7}, {"ny", 9}, {"nz", 21}, {"times", 3}};
        std::vector<std::string> messages;
        source = openSource(data, messages);
        document.session = defaultSession(source->info(), data);
        document.session.render.samples = 1;
        document.session.layers = {{"T", true, vis::VolumeLayer{.channel = "T", .shaded = false}}};
    }
    vis::Image draw(glm::ivec2 size = {480, 360}) {
        static PictureMaker maker;
        document.session.views["compare"] = view;
        return maker.render(document, source, {.pane = "compare", .size = size, .scale = 1},
                            [&](const Workbench& workbench) { rows = drawnComparison(workbench.cache("compare")); });
    }
};

TEST(CompareView, MeasuresVariantsAgainstTheReference) {
    Compared compared;
    compared.view.variants = {{"unchanged", {}}, {"again", {}}, {"coarse steps", {{"/render/step", "3"}}}};
    compared.draw();
    ASSERT_EQ(compared.rows.size(), 3u);
    EXPECT_TRUE(compared.rows[0].reference);
    EXPECT_FALSE(compared.rows[0].measured);
    EXPECT_TRUE(compared.rows[1].measured);
    EXPECT_EQ(compared.rows[1].maximum, 0);
    EXPECT_TRUE(std::isinf(compared.rows[1].psnr));
    EXPECT_EQ(compared.rows[1].ssim, 1);
    EXPECT_GT(compared.rows[2].maximum, 0);
    EXPECT_LT(compared.rows[2].ssim, 1);
    EXPECT_NEAR(compared.rows[2].psnr, 20 * std::log10(255 / compared.rows[2].rmse), 1e-9);
    for (const CompareRow& row : compared.rows) {
        EXPECT_GT(row.milliseconds, 0);
        EXPECT_EQ(row.samples, double(compared.source->grid().lattice.count()));
        EXPECT_GT(row.bytes, row.samples);
    }
    compared.view.reference = 2;
    compared.draw();
    EXPECT_TRUE(compared.rows[2].reference);
    EXPECT_EQ(compared.rows[0].rmse, compared.rows[1].rmse);
    EXPECT_GT(compared.rows[0].rmse, 0);
}

TEST(CompareView, OtherDataAreOpenedForTheirVariant) {
    Compared compared;
    compared.view.variants = {
        {"BCC", {}},
        {"CC", {{"/data/lattice", "grid"}}},
        {"packed", {{"/data/packed", "{\"lattice\": \"cc\", \"lossless\": true}"}}},
        {"lossy", {{"/data/packed", "{\"lattice\": \"cc\", \"lossless\": false, \"maxError\": 0.05}"}}},
        {"no such model", {{"/data/model", "nothing"}}}};
    compared.draw({640, 480});
    ASSERT_EQ(compared.rows.size(), 5u);
    EXPECT_GT(compared.rows[1].samples, compared.rows[0].samples);
    EXPECT_GT(compared.rows[1].rmse, 0);
    // The default model in memory and from a lossless archive of its grid: the same picture.
    EXPECT_EQ(compared.rows[2].samples, compared.rows[0].samples);
    EXPECT_LE(compared.rows[2].maximum, 1);
    EXPECT_GT(compared.rows[2].storedBytes, compared.rows[3].storedBytes);
    EXPECT_GT(compared.rows[3].rmse, compared.rows[2].rmse);
    EXPECT_NE(compared.rows[4].failure.find("nothing"), std::string::npos) << compared.rows[4].failure;
    EXPECT_FALSE(compared.rows[4].measured);
}

/// Mean colour of a part of a picture, in shares of its size.
glm::dvec3 mean(const vis::Image& image, double x0, double y0, double x1, double y1) {
    glm::dvec3 sum(0);
    int count = 0;
    for (int y = int(y0 * image.size.y); y < int(y1 * image.size.y); ++y)
        for (int x = int(x0 * image.size.x); x < int(x1 * image.size.x); ++x, ++count)
            for (int c = 0; c < 3; ++c)
                sum[c] +=
                    image.rgba[4 * (std::size_t(y) * std::size_t(image.size.x) + std::size_t(x)) + std::size_t(c)];
    return sum / double(count);
}

TEST(CompareView, SwipeShowsEitherSideOfTheLine) {
    Compared compared;
    compared.view.showTable = false;
    compared.view.mode = CompareMode::Swipe;
    compared.view.variants = {{"dark", {}}, {"light", {{"/appearance/theme", "light"}}}};
    compared.view.swipe = 0.5f;
    const vis::Image half = compared.draw();
    EXPECT_LT(mean(half, 0.02, 0.6, 0.06, 0.9).g, 60);
    EXPECT_GT(mean(half, 0.94, 0.3, 0.98, 0.6).g, 150);
    compared.view.swipe = 0.0f;
    EXPECT_GT(mean(compared.draw(), 0.04, 0.6, 0.08, 0.9).g, 150);
}

TEST(CompareView, DifferencesAreBrightWhereThereAreSome) {
    Compared compared;
    compared.view.showTable = false;
    compared.view.mode = CompareMode::Difference;
    compared.view.variants = {{"a", {}}, {"b", {}}, {"c", {{"/appearance/theme", "light"}}}};
    const vis::Image image = compared.draw({900, 300});
    EXPECT_LT(mean(image, 0.36, 0.5, 0.4, 0.7).r, 10) << "equal pictures differ nowhere";
    EXPECT_GT(mean(image, 0.69, 0.5, 0.72, 0.7).r, 150);
}

/// How rho differs at two times, that of the reference first.
std::pair<double, double> largestAndRms(const volume::BrickSource& source, int before, int after) {
    const int channel = *source.info().findChannel("rho");
    const glm::ivec3 count = source.grid().count();
    double largest = 0, squares = 0, samples = 0;
    for (int n = 0; n < count.x * count.y * count.z; ++n) {
        const glm::ivec3 at(n % count.x, n / count.x % count.y, n / (count.x * count.y));
        const volume::BrickSamples a = source.read({channel, before, 0, at}), b = source.read({channel, after, 0, at});
        for (std::size_t i = 0; i < a.values.size(); ++i) {
            if (!a.present.empty() && (a.present[i] == 0 || b.present[i] == 0)) continue;
            const double apart = double(b.values[i]) - double(a.values[i]);
            largest = std::max(largest, std::abs(apart));
            squares += apart * apart;
            samples += 1;
        }
    }
    return {largest, std::sqrt(squares / samples)};
}

/// How much more red than blue a part of a picture is.
double warmth(const vis::Image& image, double fromX, double toX) {
    double sum = 0;
    for (int y = image.size.y / 4; y < image.size.y * 3 / 4; ++y)
        for (int x = int(image.size.x * fromX); x < int(image.size.x * toX); ++x) {
            const std::size_t at = 4 * (std::size_t(y) * std::size_t(image.size.x) + std::size_t(x));
            sum += double(image.rgba[at]) - double(image.rgba[at + 2]);
        }
    return sum;
}

TEST(CompareView, ValuesDifferInTheirUnit) {
    Compared compared;
    DataRef moving;
    moving.model = "marschner-lobb";
    moving.settings = {{"nx", 12}, {"ny", 12}, {"nz", 12}, {"times", 3}};
    std::vector<std::string> messages;
    compared.source = openSource(moving, messages);
    compared.document.session = defaultSession(compared.source->info(), moving);
    const std::vector<double>& times = compared.source->info().times;
    compared.document.session.layers = {{"rho", true, vis::VolumeLayer{.channel = "rho", .shaded = false}}};
    compared.document.session.time = times[0];
    compared.view.variants = {{"first", {}}, {"last", {{"/time", std::to_string(times[2])}}}};
    compared.view.mode = CompareMode::Difference;
    compared.view.differenceOf = DifferenceOf::Values;
    compared.view.showTable = false;
    const vis::Image later = compared.draw({800, 400});
    const auto [largest, rms] = largestAndRms(*compared.source, 0, 2);
    ASSERT_TRUE(compared.rows[1].data);
    EXPECT_NEAR(compared.rows[1].data->largest, largest, 1e-6);
    EXPECT_NEAR(compared.rows[1].data->rms, rms, 1e-6);
    EXPECT_GT(largest, 0.01);
    // Against the later one the same differences have the other sign.
    compared.document.session.time = times[2];
    compared.view.variants = {{"last", {}}, {"first", {{"/time", std::to_string(times[0])}}}};
    const vis::Image earlier = compared.draw({800, 400});
    const double up = warmth(later, 0.6, 0.9), down = warmth(earlier, 0.6, 0.9);
    EXPECT_LT(up * down, 0) << up << " and " << down;
    EXPECT_GT(std::abs(up), 1000);
    // Colours alone differ: there are no values to show, and the picture says so.
    compared.view.variants = {{"unchanged", {}}, {"coarse steps", {{"/render/step", "3"}}}};
    compared.draw({800, 400});
    EXPECT_FALSE(compared.rows[1].data);
    EXPECT_TRUE(compared.rows[1].measured);
}

/// Pixels of the cross-hair's blue in a part of a picture, from one share of its width to another.
int blue(const vis::Image& image, double from, double to) {
    int count = 0;
    for (int y = 0; y < image.size.y; ++y)
        for (int x = int(from * image.size.x); x < int(to * image.size.x); ++x) {
            const std::uint8_t* p = &image.rgba[4 * (std::size_t(y) * std::size_t(image.size.x) + std::size_t(x))];
            count += p[2] > 150 && p[2] > p[0] + 80 ? 1 : 0;
        }
    return count;
}

TEST(CompareView, TheCrossHairIsWhereThePictureIs) {
    Compared compared;
    compared.view.showTable = false;
    compared.view.variants = {{"known", {}}, {"no such model", {{"/data/model", "nothing"}}}};
    for (const CompareMode mode : {CompareMode::Grid, CompareMode::Swipe}) {
        compared.view.mode = mode;
        const vis::Image shown = compared.draw({640, 240});
        if (mode == CompareMode::Grid) {
            EXPECT_GT(blue(shown, 0, 0.5), 20);
        }
        EXPECT_EQ(blue(shown, 0.52, 1), 0) << int(mode);
    }
}

struct CompareNumbers : ViewsTest {};

TEST_F(CompareNumbers, LegendsKeepTheirRoomWhileDataAreOpened) {
    Compared compared;
    show(compared.source);
    session = compared.document.session;
    ComparePictures pictures;
    std::vector<CompareLegends> legends;
    std::vector<bool> opening;
    for (int i = 0; i < 6; ++i) {
        frame([&] {
            ViewContext context{session, source, renderer, jobs, caches};
            pictures.prepare(context, {{"BCC", {}}, {"CC", {{"/data/lattice", "grid"}}}});
            opening.push_back(pictures.cells()[1]->isOpening());
            legends.push_back(variantLegends(context, pictures.cells(), {0, 1}));
            pictures.draw(context, "compare", 0, {120, 90}, false);
        });
        jobs.wait();
    }
    EXPECT_TRUE(opening[0] && opening[1]);
    EXPECT_FALSE(opening.back());
    for (const CompareLegends& at : legends) {
        ASSERT_EQ(at.size(), 2u);
        EXPECT_EQ(at[0].size(), 1u);
        EXPECT_EQ(at[1].size(), 1u);
    }
}

/// Other variants in the same places, whose data are not opened yet, have no numbers: not those of the ones before.
TEST_F(CompareNumbers, AreNotThoseOfTheVariantsBefore) {
    show(fuelCell(volume::LatticeKind::CC));
    session.layers = {{"T", true, vis::VolumeLayer{.channel = "T", .shaded = false}}};
    session.render.samples = 1;
    ComparePictures pictures;
    std::vector<CompareRow> rows;
    const auto drawn = [&](const std::vector<CompareVariant>& variants, bool draws) {
        frame([&] {
            ViewContext context{session, source, renderer, jobs, caches};
            context.headless = true;
            pictures.prepare(context, variants);
            if (draws) pictures.draw(context, "compare", 0, {120, 90}, false);
            rows = pictures.rows(context, 0);
        });
        jobs.wait();
    };
    const std::vector<CompareVariant> before{{"fine", {}}, {"coarse", {{"/render/step", "3"}}}};
    for (int i = 0; i < 3; ++i) drawn(before, true);
    ASSERT_EQ(rows.size(), 2u);
    ASSERT_TRUE(rows[1].measured);
    EXPECT_GT(rows[1].rmse, 0);
    EXPECT_GT(rows[1].samples, 0);
    drawn({{"fine", {}}, {"lossless", {{"/render/step", "0.5"}}}}, false);
    EXPECT_FALSE(rows[1].measured);
    EXPECT_EQ(rows[1].milliseconds, 0);
    EXPECT_EQ(rows[1].samples, 0);
    EXPECT_GT(rows[0].samples, 0) << "the one that stays keeps its own";
    for (int i = 0; i < 3; ++i) drawn(before, true);
    EXPECT_TRUE(rows[1].measured) << "and they come again";
}

} // namespace
} // namespace tessera::app
