#include "vis/image/image_io.h"
#include "volume/base/error.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <random>
#include <unistd.h>

namespace tessera::vis {
namespace {

namespace fs = std::filesystem;

struct ImageIo : testing::Test {
    fs::path folder = fs::temp_directory_path() / ("tessera-image-io-" + std::to_string(getpid()));
    void SetUp() override { fs::create_directories(folder); }
    void TearDown() override { fs::remove_all(folder); }
    std::string path(const std::string& name) const { return (folder / name).string(); }
};

Image randomImage(glm::ivec2 size, bool opaque, unsigned seed) {
    std::mt19937 engine(seed);
    Image image{size, {}};
    image.rgba.resize(std::size_t(size.x) * std::size_t(size.y) * 4);
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        image.rgba[i] = opaque && i % 4 == 3 ? 255 : static_cast<std::uint8_t>(engine());
    return image;
}

std::vector<char> slurp(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void spill(const std::string& path, const std::vector<char>& bytes) {
    std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// The chunk of this type as it stands in the file, read without libpng; empty where there is none.
std::vector<unsigned char> chunkOf(const std::vector<char>& png, const std::string& type) {
    const auto byte = [&](std::size_t i) { return std::size_t(static_cast<unsigned char>(png.at(i))); };
    for (std::size_t at = 8; at + 12 <= png.size();) {
        const std::size_t length = byte(at) << 24 | byte(at + 1) << 16 | byte(at + 2) << 8 | byte(at + 3);
        if (std::string(png.data() + at + 4, 4) == type)
            return {png.begin() + std::ptrdiff_t(at + 8), png.begin() + std::ptrdiff_t(at + 8 + length)};
        at += 12 + length;
    }
    return {};
}

// 300 / 0.0254 = 11811.02 pixels per metre = 0x2e23, 200 dpi are 7874 = 0x1ec2; the last byte is the unit, metre.
TEST_F(ImageIo, StatesTheResolutionOnPaper) {
    Image image = randomImage({7, 5}, true, 1);
    writePng(path("a.png"), image, {{"Title", "x"}});
    EXPECT_TRUE(chunkOf(slurp(path("a.png")), "pHYs").empty());
    EXPECT_EQ(readPng(path("a.png")).dpi, 0);
    image.dpi = 300;
    writePng(path("a.png"), image, {{"Title", "x"}});
    EXPECT_EQ(chunkOf(slurp(path("a.png")), "pHYs"),
              (std::vector<unsigned char>{0, 0, 0x2e, 0x23, 0, 0, 0x2e, 0x23, 1}));
    std::map<std::string, std::string> texts;
    const Image back = readPng(path("a.png"), &texts);
    EXPECT_NEAR(back.dpi, 300, 0.013) << "half a pixel per metre";
    EXPECT_EQ(back.rgba, image.rgba);
    EXPECT_EQ(texts["Title"], "x");
    image.dpi = 200;
    writePng(path("a.png"), image);
    EXPECT_EQ(chunkOf(slurp(path("a.png")), "pHYs"),
              (std::vector<unsigned char>{0, 0, 0x1e, 0xc2, 0, 0, 0x1e, 0xc2, 1}));
}

TEST_F(ImageIo, GivesBackPixelsAndTexts) {
    const std::map<std::string, std::string> texts{
        {kSessionTextKey, "{\"name\": \"Zelle \xc3\xa4 \xe2\x82\x82\", \"pad\": \"" + std::string(100000, 'x') + "\"}"},
        {"Software", "tessera"},
        {"Empty", ""}};
    unsigned seed = 0;
    for (int w : {1, 2, 3, 17})
        for (int h : {1, 5, 64})
            for (bool opaque : {true, false}) {
                const Image image = randomImage({w, h}, opaque, ++seed);
                writePng(path("a.png"), image, texts);
                std::map<std::string, std::string> back{{"stale", "entry"}};
                const Image read = readPng(path("a.png"), &back);
                EXPECT_EQ(read.size, image.size);
                EXPECT_EQ(read.rgba, image.rgba);
                EXPECT_EQ(back, texts);
            }
    EXPECT_LT(fs::file_size(path("a.png")), 20000u) << "texts are compressed";
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1) << "no temporary file is left";
}

TEST_F(ImageIo, ReadsGrayPaletteAnd16Bit) {
    // 2 x 1 pixels: gray (0, 255); a palette (red, blue); 16-bit gray with alpha (0x8000 opaque, 0xffff clear).
    struct Case {
        std::vector<unsigned char> file;
        std::vector<std::uint8_t> rgba;
    };
    const Case cases[] = {
        {{0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00,
          0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x00, 0x00, 0x00, 0x00, 0xd1, 0x49, 0x20, 0x56, 0x00,
          0x00, 0x00, 0x0b, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x60, 0xf8, 0x0f, 0x00, 0x01, 0x02, 0x01,
          0x00, 0x42, 0xbe, 0xbc, 0x68, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82},
         {0, 0, 0, 255, 255, 255, 255, 255}},
        {{0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00,
          0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x03, 0x00, 0x00, 0x00, 0xc3, 0xfc, 0x8f, 0xb8, 0x00, 0x00, 0x00,
          0x06, 0x50, 0x4c, 0x54, 0x45, 0xff, 0x00, 0x00, 0x00, 0x00, 0xff, 0x6c, 0xa1, 0xfd, 0x8e, 0x00, 0x00, 0x00,
          0x0b, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x60, 0x60, 0x04, 0x00, 0x00, 0x04, 0x00, 0x02, 0xbf, 0x7a,
          0x3f, 0x4a, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82},
         {255, 0, 0, 255, 0, 0, 255, 255}},
        {{0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00,
          0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x10, 0x04, 0x00, 0x00, 0x00, 0x0e, 0xbb, 0x6b, 0x42, 0x00, 0x00, 0x00,
          0x0f, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x68, 0x60, 0xf8, 0x0f, 0x04, 0x0c, 0x0c, 0x00, 0x15, 0xf7,
          0x04, 0x7d, 0x80, 0x22, 0xf6, 0x4a, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82},
         {128, 128, 128, 255, 255, 255, 255, 0}},
    };
    for (const Case& c : cases) {
        spill(path("c.png"), {c.file.begin(), c.file.end()});
        const Image image = readPng(path("c.png"));
        EXPECT_EQ(image.size, glm::ivec2(2, 1));
        EXPECT_EQ(image.rgba, c.rgba);
    }
}

TEST_F(ImageIo, EveryTruncationAndEveryFlippedByteIsAnError) {
    const std::map<std::string, std::string> texts{{kSessionTextKey, "{\"version\": 1, \"views\": [1, 2, 3]}"}};
    writePng(path("a.png"), randomImage({7, 5}, false, 9), texts);
    const std::vector<char> good = slurp(path("a.png"));
    for (std::size_t length = 0; length < good.size(); ++length) {
        spill(path("b.png"), {good.begin(), good.begin() + static_cast<std::ptrdiff_t>(length)});
        std::map<std::string, std::string> back;
        EXPECT_THROW(readPng(path("b.png"), &back), Error) << "cut at " << length;
        EXPECT_TRUE(back.empty());
    }
    for (std::size_t i = 0; i < good.size(); ++i)
        for (int bit : {0, 3, 5, 7}) {
            std::vector<char> bad = good;
            bad[i] = static_cast<char>(bad[i] ^ (1 << bit));
            spill(path("b.png"), bad);
            EXPECT_THROW(readPng(path("b.png")), Error) << "byte " << i << " bit " << bit;
        }
}

TEST_F(ImageIo, SaysWhatIsWrongWithAFile) {
    writePng(path("a.png"), randomImage({7, 5}, false, 9));
    std::vector<char> bad = slurp(path("a.png"));
    bad[bad.size() - 20] = static_cast<char>(bad[bad.size() - 20] ^ 1); // in the last chunk of pixels
    spill(path("b.png"), bad);
    try {
        readPng(path("b.png"));
        FAIL();
    } catch (const Error& error) {
        const std::string text = error.what();
        const std::size_t after = text.find("damaged PNG: ");
        ASSERT_NE(after, std::string::npos) << text;
        EXPECT_NE(text.find("IDAT", after), std::string::npos) << "what libpng says of it: " << text;
    }
}

TEST_F(ImageIo, NamesTheFileThatCannotBeUsed) {
    const Image image = randomImage({2, 2}, true, 1);
    try {
        writePng(path("no/such/folder/a.png"), image);
        FAIL() << "must throw";
    } catch (const Error& error) {
        EXPECT_EQ(error.file(), path("no/such/folder/a.png"));
    }
    EXPECT_THROW(writePng(path("a.png"), Image{}), Error);
    EXPECT_THROW(writePng(path("a.png"), Image{{2, 2}, std::vector<std::uint8_t>(15)}), Error);
    EXPECT_THROW(readPng(path("absent.png")), Error);
    EXPECT_THROW(readPng(folder.string()), Error);
    spill(path("text.png"), {'h', 'e', 'l', 'l', 'o', ' ', 'w', 'o', 'r', 'l', 'd'});
    EXPECT_THROW(readPng(path("text.png")), Error);
    // An existing file survives a failed write.
    writePng(path("keep.png"), image);
    EXPECT_THROW(writePng(path("keep.png"), Image{}), Error);
    EXPECT_EQ(readPng(path("keep.png")).rgba, image.rgba);
}

} // namespace
} // namespace tessera::vis
