#include "app/command/command.h"
#include "app/command/derive_option.h"
#include "app/drawing/drawing.h"
#include "app/history/session_file.h"
#include "volume/system/atomic_file.h"

#include <algorithm>
#include <filesystem>
#include <gmock/gmock.h>
#include <unistd.h>

/// What the command line says to words that it cannot use.
namespace tessera::app {
namespace {

using testing::HasSubstr;

struct Said {
    int status;
    std::string text; ///< on stderr
};
Said said(std::vector<std::string> words) {
    words.insert(words.begin(), "tessera");
    std::vector<const char*> arguments;
    for (const std::string& word : words) arguments.push_back(word.c_str());
    testing::internal::CaptureStderr();
    const int status = runCommandLine(int(arguments.size()), arguments.data());
    return {status, testing::internal::GetCapturedStderr()};
}

TEST(CommandWords, AWrongValueIsSaidWithItsOption) {
    const std::string file = (std::filesystem::path(testing::TempDir()) / "words.png").string();
    const std::string data = (std::filesystem::path(testing::TempDir()) / "signal.tsr").string();
    ASSERT_EQ(said({"generate", "marschner-lobb", "--size", "8x8x8", "-o", data}).status, 0);
    const auto refused = [&](const std::vector<std::string>& words, const std::string& text) {
        SCOPED_TRACE(text);
        const Said answer = said(words);
        EXPECT_EQ(answer.status, 1);
        EXPECT_THAT(answer.text, HasSubstr(text));
        EXPECT_FALSE(std::filesystem::exists(file));
    };
    refused({"generate", "fuel-cell", "--size", "8x8", "-o", file}, "--size: expected NXxNYxNZ, not \"8x8\"");
    refused({"generate", "fuel-cell", "--size", "8xx8", "-o", file}, "--size: expected NXxNYxNZ, not \"8xx8\"");
    refused({"generate", "fuel-cell", "--set", "nx", "-o", file}, "--set: expected KEY=NUMBER, not \"nx\"");
    refused({"pack", "nothing.vti", "--grid", "8x8", "-o", file}, "--grid: needs planes, even, or XxYxZ, not \"8x8\"");
    for (const char* grid : {"0x8x8", "8x4097x8", "8x8x-1"})
        refused({"pack", "nothing.vti", "--grid", grid, "-o", file}, "--grid: each size must be 1..4096");
    for (const char* variant : {"later: /time", "later: time=1", "later: /time=1; time=2"})
        refused({"compare", data, "--variant", variant, "-o", file},
                "--variant: needs NAME: /json/pointer=value; ..., not \"" + std::string(variant) + "\"");
    for (const char* formula : {"T + 1", " = T + 1", "[K] = T"})
        refused({"stats", "nothing.tsr", "--derive", formula, "-o", file},
                "--derive: needs NAME [UNIT] = FORMULA, not \"" + std::string(formula) + "\"");
}

/// Files of a folder of its own.
class CommandRefusals : public testing::Test {
protected:
    void SetUp() override {
        std::filesystem::create_directories(folder);
        for (const char* name : {"ml.tsr", "two.tsr"})
            ASSERT_EQ(said({"generate", "marschner-lobb", "--size", "8x8x8", "-o", in(name)}).status, 0);
        Session session;
        session.data.model = "marschner-lobb";
        SessionDocument document;
        document.session = session;
        saveSession(document, in("saved.tessera.json"));
        AtomicFile figure(in("figure.svg"));
        VectorPage page;
        page.session = printSession(document, in("figure.svg"));
        figure.write(fileOf(page, "svg"));
        figure.commit();
    }
    void TearDown() override { std::filesystem::remove_all(folder); }
    std::string in(const std::string& name) const { return (folder / name).string(); }
    void expect(const std::vector<std::string>& words, const std::string& text) const {
        SCOPED_TRACE(testing::PrintToString(words));
        const Said answer = said(words);
        EXPECT_EQ(answer.status, 2);
        EXPECT_THAT(answer.text, HasSubstr(text));
        EXPECT_EQ(std::ranges::count(answer.text, '\n'), 1);
    }
    const std::filesystem::path folder =
        std::filesystem::path(testing::TempDir()) / ("refusals-" + std::to_string(getpid()));
};

TEST_F(CommandRefusals, ASessionOrAnArchiveInTheWrongPlaceIsSaid) {
    const std::string session = in("saved.tessera.json"), figure = in("figure.svg"), one = in("ml.tsr");
    for (const std::vector<std::string>& words : {std::vector<std::string>{"stats", session},
                                                  {"mesh", session, "--iso", "0.5", "-o", in("x.ply")},
                                                  {"plot", session, "-o", in("x.csv")},
                                                  {"pack", session, "-o", in("x.tsr")},
                                                  {"diff", session, one}})
        expect(words, "saved.tessera.json: is a session, and data are expected here");
    expect({"stats", figure}, "figure.svg: is a picture that contains a session, and data are expected here");
    expect({"render", session, one, "-o", in("x.png")}, "saved.tessera.json: is a session, which is opened alone\n");
    for (const char* command : {"info", "stats", "render"}) {
        std::vector<std::string> words{command, one, in("two.tsr")};
        if (command == std::string("render")) words.insert(words.end(), {"-o", in("x.png")});
        expect(words, "ml.tsr: is an archive, which is opened alone; tessera compare --with");
    }
}

TEST_F(CommandRefusals, OptionsWithoutEffectAreSaid) {
    const std::string data = in("ml.tsr");
    expect({"stats", data, "--along", "z", "--planes", "5"}, "--planes: ");
    expect({"stats", data, "--show", "flux"}, "--show: ");
    expect({"stats", data, "--weight", "area"}, "--weight: ");
    expect({"stats", data, "--all-times", "--time", "0"}, "--time: ");
    expect({"stats", data, "--along", "z", "--line", "0,0,0,1,1,1"}, "--along: ");
    EXPECT_EQ(said({"stats", data, "--line", "0,0,0,1,1,1", "--planes", "5", "--show", "most"}).status, 0);
}

TEST_F(CommandRefusals, AnUnknownNameIsAnsweredByThoseThatThereAre) {
    const std::string data = in("ml.tsr"), picture = in("x.png");
    expect({"diff", data, in("two.tsr"), "-p", "foo"}, "there is no parameter \"foo\"; there are rho\n");
    expect({"unpack", data, "-p", "foo", "-o", in("x.vti")}, "there is no parameter \"foo\"; there are rho\n");
    expect({"stats", "fuel-cell", "--regions", "foo"}, "there is no region \"foo\"; there are ");
    for (const char* command : {"render", "compare"})
        expect({command, data, "--view", "regions", "-o", picture},
               "--view: regions: there is no view of this name; there are ");
    for (const char* kind : {"curves", "statistics", "profile", "sliceMatrix", "histogram"})
        expect({"render", data, "--view", "regions", "-o", picture}, kind);
    expect({"compare", data, "--view", "volume,slices", "-o", picture}, "one view is compared, not several");
    expect({"render", data, "--transfer", "foo", "-o", picture}, ", \"CT skin, bone\", ");
}

TEST_F(CommandRefusals, AnEmptySurfaceIsNotSaidToLieOutsideTheRange) {
    const auto empty = [&](const std::string& iso) {
        return std::vector<std::string>{"mesh", "fuel-cell", "--channel", "O2", "--iso",
                                        iso,    "--level",   "0",         "-o", in("x.stl")};
    };
    expect(empty("-7"), " over all times\n");
    expect(empty("3"), " over all times, but no cell whose corners are all present reaches this value at this time");
}

TEST(CommandWords, BlanksAroundTheWordsOfAFormulaAreNoPartOfThem) {
    for (const char* text :
         {"dT [K] = T - 300", "dT[K]=T - 300", "  dT  [ K ]  =  T - 300  ", "\tdT [K]\t=\tT - 300\t"}) {
        SCOPED_TRACE(text);
        const volume::DerivedParameter parsed = parseDerived(text);
        EXPECT_EQ(parsed.name, "dT");
        EXPECT_EQ(parsed.unit, "K");
        EXPECT_EQ(std::get<volume::ExpressionRecipe>(parsed.recipe).formula, "T - 300");
    }
    EXPECT_EQ(parseDerived("a = b").unit, "");
}

} // namespace
} // namespace tessera::app
