#include "app/edits/compare.h"

#include "app/history/history.h"
#include "app/history/session_file.h"
#include "app/views/compare/compare_questions.h"
#include "app/views/compare/compare_table.h"
#include "tests/app/table_text.h"
#include "volume/base/error.h"

#include <gtest/gtest.h>
#include <limits>

namespace tessera::app {
namespace {

Session withLayer() {
    Session session;
    session.layers.push_back({"O2", true, vis::VolumeLayer{.channel = "O2"}});
    return session;
}

TEST(CompareQuestions, AnswersAreATable) {
    EXPECT_EQ(csvOf(questionsTable({{.text = "Where, and \"why\"?", .answer = "volume", .seconds = 12.5},
                                    {.text = "Else?", .answer = "", .seconds = 0}})),
              "question,answer,seconds\n\"Where, and \"\"why\"\"?\",volume,12.5\nElse?,,\n");
}

TEST(Compare, AVariantIsTheSessionWithItsChanges) {
    const Session session = withLayer();
    CompareVariant variant{"",
                           {{"/render/filter", "tetrahedral"}, {"/layers/0/technique/density", "3"}, {"/time", "0.5"}}};
    const Session changed = variantSession(session, variant);
    EXPECT_EQ(changed.render.filter, vis::Filter::Tetrahedral);
    EXPECT_EQ(std::get<vis::VolumeLayer>(changed.layers[0].technique).density, 3);
    EXPECT_EQ(changed.time, 0.5);
    Session back = changed;
    back.render = session.render;
    back.layers = session.layers;
    back.time = session.time;
    EXPECT_EQ(back, session) << "nothing else differs";
    EXPECT_EQ(variantSession(session, {}), session);
}

TEST(Compare, TheLayoutOfCompressionsPacksAnyData) {
    const Session layout = loadSession(std::string(TESSERA_SOURCE_DIR) + "/layouts/compareCompression.json").session;
    Session own = layout;
    own.data = {};
    own.data.model = "casting"; // as they were opened, not packed
    for (const CompareVariant& variant : std::get<CompareView>(layout.views.at("compare")).variants) {
        const std::optional<codec::PackOptions> packed = variantSession(own, variant).data.packed;
        ASSERT_EQ(packed.has_value(), variant.name != "as computed") << variant.name;
        EXPECT_EQ(packed && packed->lossless, variant.name == "lossless") << variant.name;
    }
}

TEST(Compare, AChangeThatDoesNotFitSaysWhere) {
    const Session session = withLayer();
    const auto reason = [&](const std::string& path, const std::string& value) -> std::string {
        try {
            variantSession(session, {"", {{path, value}}});
        } catch (const Error& error) {
            return error.what();
        }
        return {};
    };
    EXPECT_NE(reason("/render/filter", "sharp").find("/render/filter"), std::string::npos);
    EXPECT_NE(reason("/render/step", "1e9").find("/render/step"), std::string::npos);
    EXPECT_NE(reason("/render/nothing", "1").find("/render/nothing"), std::string::npos);
    EXPECT_NE(reason("/layers/4/visible", "true").find("/layers/4"), std::string::npos);
    EXPECT_NE(reason("no pointer", "1"), "");
}

TEST(Compare, ACaptionSaysWhatDiffers) {
    const Session session = withLayer();
    EXPECT_EQ(changesText(session, {}), "unchanged");
    EXPECT_EQ(changesText(session, {"", {{"/render/filter", "average"}}}), "filter average");
    EXPECT_EQ(changesText(session, {"", {{"/data/lattice", "grid"}}}), "lattice CC");
    EXPECT_EQ(changesText(session, {"", {{"/layers/0/technique/density", "2"}}}), "O2: density 2");
    EXPECT_EQ(
        changesText(session,
                    {"", {{"/layers/0/technique/look", R"({"charcoal": {"contrast": 0.6}, "part": "context"})"}}}),
        "charcoal contrast 0.6, part context");
    EXPECT_EQ(variantName(session, {"mine", {{"/render/filter", "average"}}}), "mine");
}

TEST(Compare, EditsOfAVariantAreItsChanges) {
    const Session session = withLayer();
    Session changed = session;
    CompareVariant variant;
    changed.render.stepVoxels = 0.25f;
    recordChange(variant, session, changed, "/render/step");
    EXPECT_EQ(variantSession(session, variant), changed);
    recordChange(variant, session, session, "/render/step");
    EXPECT_TRUE(variant.changes.empty());
}

TEST(Compare, GridsUseTheRoom) {
    EXPECT_EQ(gridFor(4, 1600, 1000).columns, 2);
    EXPECT_EQ(gridFor(4, 1600, 300).columns, 4);
    EXPECT_EQ(gridFor(3, 400, 1000).rows, 3);
    EXPECT_EQ(gridFor(1, 10, 10).columns, 1);
}

TEST(Compare, TheTableIsCsv) {
    CompareRow row;
    row.name = "a, \"b\"";
    row.changes = "x";
    row.measured = true;
    row.psnr = std::numeric_limits<double>::infinity();
    row.rmse = 1.5;
    const std::string csv = csvOf(compareTable({row}));
    EXPECT_NE(csv.find("\"a, \"\"b\"\"\",x,no,"), std::string::npos) << csv;
    EXPECT_NE(csv.find(",1.5,inf,"), std::string::npos) << csv;
}

TEST(Compare, EachNumberOfARowStandsInItsColumn) {
    CompareRow row;
    row.name = "half", row.reference = true, row.measured = true;
    row.milliseconds = 1.25, row.samples = 2000, row.bytes = 3000, row.storedBytes = 4000;
    row.maximum = 5.5, row.rmse = 6.5, row.psnr = 7.5, row.ssim = 0.875;
    row.data.emplace();
    row.data->samples = 90, row.data->differing = 17, row.data->largest = 18.5, row.data->rms = 9.5;
    CompareRow failed;
    failed.name = "other", failed.changes = "step 2", failed.failure = "too large";
    const TableText table = tableOf(csvOf(compareTable({row, failed})));
    ASSERT_EQ(table.rows.size(), 2u);
    const std::vector<std::pair<std::string, double>> wanted = {
        {"ms per picture", 1.25},  {"samples", 2000},
        {"texture bytes", 3000},   {"stored bytes", 4000},
        {"maximum (of 255)", 5.5}, {"RMSE (of 255)", 6.5},
        {"PSNR [dB]", 7.5},        {"SSIM", 0.875},
        {"differing", 17},         {"largest error of a sample", 18.5},
        {"RMSE of samples", 9.5}};
    for (const auto& [head, value] : wanted) EXPECT_EQ(table.number(0, head), value) << head;
    for (std::size_t i = 4; i < wanted.size(); ++i) EXPECT_EQ(table.text(1, wanted[i].first), "") << wanted[i].first;
    EXPECT_EQ(table.text(0, "variant"), "half");
    EXPECT_EQ(table.text(0, "reference"), "yes");
    EXPECT_EQ(table.text(0, "failure"), "");
    EXPECT_EQ(table.text(1, "differs"), "step 2");
    EXPECT_EQ(table.text(1, "reference"), "no");
    EXPECT_EQ(table.text(1, "failure"), "too large");
}

TEST(Compare, SurvivesTheSessionFile) {
    Session session = withLayer();
    CompareView view;
    view.mode = CompareMode::Swipe;
    view.variants = {{"one", {}}, {"two", {{"/render/filter", "average"}}}};
    view.swipe = 0.3f;
    session.views["compare"] = view;
    EXPECT_EQ(sessionFromJson(toJson(session), {}), session);
}

} // namespace
} // namespace tessera::app
