#include "app/data/picture_session.h"
#include "app/drawing/drawing.h"
#include "app/drawing/embedded_session.h"
#include "volume/base/error.h"

#include <gtest/gtest.h>

/// Sessions inside SVG and PDF files.
namespace tessera::app {
namespace {

std::string oddSession() {
    std::string text = "{\"title\": \"<a & b> \\u0001 \\\"c\\\" ]]> &amp; \xc3\xa9\",\n \"pad\": \"";
    for (int i = 0; i < 3000; ++i) text += static_cast<char>('a' + i * i % 26);
    return text + "\"}\n";
}

VectorPage pageWith(const std::string& session) {
    VectorPage page;
    page.size = {200, 100};
    page.marks = {{shapes::Words{"T [K]", {50, 60}, 8}}, {shapes::Stroke{{{10, 20}, {30, 40.5}}, 0.5}}};
    page.numbers = "of the file";
    page.session = session;
    return page;
}

TEST(EmbeddedSession, AnSvgHasItAsMetadata) {
    const std::string session = oddSession();
    EXPECT_EQ(sessionInSvg(svgOf(pageWith(session))), session);
    EXPECT_EQ(sessionInSvg(svgOf(pageWith(""))), std::nullopt);
    EXPECT_EQ(svgOf(pageWith("")).find("<metadata"), std::string::npos);
    EXPECT_EQ(sessionInSvg("<svg><metadata id=\"tessera-session\">{"), std::nullopt) << "cut off";
}

TEST(EmbeddedSession, APdfHasItAttachedAndItsPageStaysByteForByte) {
    const std::string session = oddSession(), plain = pdfOf(pageWith("")), with = pdfOf(pageWith(session));
    EXPECT_EQ(sessionInPdf(with, "f.pdf"), session);
    EXPECT_EQ(sessionInPdf(plain, "f.pdf"), std::nullopt);
    EXPECT_TRUE(with.starts_with(plain));
    EXPECT_EQ(with, pdfOf(pageWith(session))) << "the same each time";
    EXPECT_LT(with.size(), plain.size() + session.size()) << "packed";
    // Every line of the last table leads to its object.
    const std::size_t start = with.rfind("startxref\n") + 10;
    const std::size_t table = std::stoul(with.substr(start));
    ASSERT_EQ(with.substr(table, 5), "xref\n");
    std::size_t at = table + 5, objects = 0;
    while (with.compare(at, 7, "trailer") != 0) {
        std::size_t used = 0;
        const std::size_t first = std::stoul(with.substr(at), &used);
        const std::size_t count = std::stoul(with.substr(at + used));
        at = with.find('\n', at) + 1;
        for (std::size_t i = 0; i < count; ++i, at += 20, ++objects) {
            const std::string head = std::to_string(first + i) + " 0 obj";
            EXPECT_EQ(with.substr(std::stoul(with.substr(at, 10)), head.size()), head);
        }
    }
    EXPECT_EQ(objects, 3u);
    EXPECT_THROW(withAttachedSession("%PDF-1.4\nno table", session), MachineError);
    EXPECT_THROW(withAttachedSession("", session), MachineError);
}

TEST(EmbeddedSession, ADamagedPdfIsAnErrorWithItsName) {
    const std::string whole = pdfOf(pageWith(oddSession()));
    const std::size_t attached = whole.find("/F (tessera-session.json)");
    ASSERT_NE(attached, std::string::npos);
    std::size_t wrong = 0;
    for (std::size_t length = 0; length < whole.size(); length += 7) {
        try {
            const auto found = sessionInPdf(whole.substr(0, length), "cut.pdf");
            EXPECT_TRUE(!found || length > whole.size() - 400) << length;
        } catch (const Error& error) {
            EXPECT_EQ(error.file(), "cut.pdf");
            ++wrong;
        }
    }
    EXPECT_GT(wrong, 50u);
    for (const auto& [what, by] :
         {std::pair{"/Length ", "/Length 99999999999"}, {"/Params << /Size ", "/Params << /Size 8"}}) {
        std::string bad = whole;
        const std::size_t at = bad.find(what, attached);
        ASSERT_NE(at, std::string::npos);
        bad.replace(at, std::string(what).size(), by);
        EXPECT_THROW((void)sessionInPdf(bad, "bad.pdf"), Error) << what;
    }
}

TEST(EmbeddedSession, FilesAreKnownByTheirSuffix) {
    for (const char* name : {"a.png", "b/c.SVG", "d.Pdf"}) EXPECT_TRUE(namesPicture(name)) << name;
    for (const char* name : {"png", "a.json", "a.pdf.json", "a.jpg"}) EXPECT_FALSE(namesPicture(name)) << name;
}

} // namespace
} // namespace tessera::app
