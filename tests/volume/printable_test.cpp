#include "volume/base/csv_text.h"
#include "volume/base/printable.h"
#include "volume/base/utf8.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <random>

namespace tessera {
namespace {

TEST(Printable, KeepsWhatCanBeShown) {
    for (const char* const text : {"", "T", "|U| [m/s]", "µm·s⁻¹", "温度", "a/b~c \"quoted\"", "\U0001F600"}) {
        EXPECT_EQ(printable(text), text);
        EXPECT_EQ(printableLines(text), text);
    }
    EXPECT_EQ(printable("a\nb\tc\rd"), "a b c d");
    EXPECT_EQ(printableLines("a\nb\tc\rd"), "a\nb\tc d");
}

TEST(Printable, ReplacesWhatCommandsATerminal) {
    const std::string no = "\xEF\xBF\xBD";
    EXPECT_EQ(printable("\x1b[31mred\x07"), no + "[31mred" + no);
    EXPECT_EQ(printable(std::string("a\0b", 3)), "a" + no + "b");
    EXPECT_EQ(printable("\xC2\x9B"
                        "31m"),
              no + "31m")
        << "the same escape as one character";
    EXPECT_EQ(printable("\x9B"
                        "31m"),
              no + "31m")
        << "and as one byte";
    EXPECT_EQ(printable("a\xE2\x80\xAE"
                        "txt.exe"),
              "a" + no + "txt.exe")
        << "from right to left";
    EXPECT_EQ(printable("\xB0"
                        "C"),
              "\xC2\xB0"
              "C")
        << "Latin-1";
    EXPECT_EQ(printable("\xC3\xA4 and \xE4"), "\xC3\xA4 and \xC3\xA4") << "both at once";
    EXPECT_EQ(printable("\xC0\xAF"), "\xC3\x80\xC2\xAF") << "a slash that is longer than needed";
    EXPECT_EQ(printable("\xED\xA0\x80"), "\xC3\xAD\xC2\xA0" + no) << "half a pair";
}

std::string anyBytes(std::mt19937& random) {
    static const char* const words[] = {
        "T",  "\x1b[2J", "\xC2\x9B", "\xE2\x80\xAE", "\xB0",         "\xF0\x9F\x98\x80", "\n", ",",
        "\"", "<",       "=1+1",     "]]>",          "\xEF\xBF\xBF", "\xED\xA0\x80",     "%s"};
    std::string text;
    for (std::size_t i = random() % 6; i-- > 0;)
        if ((random() & 1) != 0)
            text += words[random() % std::size(words)];
        else
            text += static_cast<char>(random());
    return text;
}

TEST(Printable, OfAnyBytesIsTextForEveryFile) {
    std::mt19937 random(7);
    for (int i = 0; i < 20'000; ++i) {
        const std::string text = anyBytes(random), shown = printable(text);
        EXPECT_TRUE(isUtf8(shown));
        EXPECT_EQ(printable(shown), shown);
        EXPECT_NO_THROW((void)nlohmann::json(shown).dump()) << "strict JSON";
        for (const char c : shown) EXPECT_TRUE(static_cast<unsigned char>(c) >= 0x20 && c != 0x7F);
        EXPECT_EQ(shown.find("\xC2\x9B"), std::string::npos);
    }
}

TEST(CsvField, TextsAreNoFormulas) {
    for (const char* const formula : {"=1+1", "+cmd", "-dp/dx", "@SUM(A1)", "-1+2", "=\"x\""})
        EXPECT_TRUE(csvField(formula).find('\'') <= 1) << formula;
    for (const char* const number : {"-1", "+2.5e3", "-inf"}) EXPECT_EQ(csvField(number), number);
    EXPECT_EQ(csvField("a,b"), "\"a,b\"");
    EXPECT_EQ(csvField("say \"x\""), "\"say \"\"x\"\"\"");
    EXPECT_EQ(csvField("T [K]"), "T [K]");
    // Of any bytes it is one cell of one line.
    std::mt19937 random(8);
    for (int i = 0; i < 5'000; ++i) {
        const std::string cell = csvField(anyBytes(random));
        EXPECT_EQ(cell.find_first_of("\n\r"), std::string::npos);
        const bool quoted = cell.starts_with('"');
        EXPECT_TRUE(quoted || cell.find_first_of(",\"") == std::string::npos) << cell;
        EXPECT_NE(cell.substr(quoted ? 1 : 0, 1), "=");
    }
}

} // namespace
} // namespace tessera
