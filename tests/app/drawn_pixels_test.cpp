#include "app/platform/drawn_pixels.h"

#include "tests/app/fed_imgui.h"
#include "vis/gl/texture_name.h"

#include <cstdint>
#include <glm/vec4.hpp>

/// What ImGui draws as pixels, without OpenGL.
namespace tessera::app {
namespace {

class DrawnPixels : public FedImGui {
protected:
    DrawnPixels() : FedImGui({40, 30}) {
        ImGuiIO& io = ImGui::GetIO();
        unsigned char* pixels = nullptr;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &letters.size.x, &letters.size.y);
        letters.rgba.assign(pixels, pixels + std::ptrdiff_t(letters.size.x) * letters.size.y * 4);
        io.Fonts->SetTexID((ImTextureID)letters.name());
    }
    ~DrawnPixels() override { ImGui::GetIO().Fonts->SetTexID({}); }
    /// The pixels from `lo` to before `hi` of what `body` draws, on black.
    template <class Body> vis::Image drawn(glm::ivec2 lo, glm::ivec2 hi, const Body& body) {
        feed([&] {
            ImGui::GetBackgroundDrawList()->Flags = ImDrawListFlags_None;
            body(*ImGui::GetBackgroundDrawList());
        });
        vis::Image image{hi - lo, std::vector<std::uint8_t>(std::size_t((hi - lo).x * (hi - lo).y) * 4)};
        const ImDrawData& frame = *ImGui::GetDrawData();
        for (int n = 0; n < frame.CmdListsCount; ++n)
            for (const ImDrawCmd& command : frame.CmdLists[n]->CmdBuffer)
                drawPixels(*frame.CmdLists[n], command, lo, image);
        return image;
    }
    static glm::ivec4 at(const vis::Image& image, int x, int y) {
        const std::uint8_t* of = &image.rgba[std::size_t(y * image.size.x + x) * 4];
        return {of[0], of[1], of[2], of[3]};
    }
    vis::MemoryTexture letters{.rgba = {}};
};

TEST_F(DrawnPixels, EachPixelOfAShapeIsDrawnOnce) {
    const vis::Image image = drawn({0, 0}, {40, 30}, [](ImDrawList& list) {
        list.AddRectFilled({5, 4}, {25, 14}, IM_COL32(200, 100, 50, 128));
    });
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) {
            const bool inside = x >= 5 && x < 25 && y >= 4 && y < 14;
            EXPECT_EQ(at(image, x, y), inside ? glm::ivec4(100, 50, 25, 128) : glm::ivec4(0)) << x << " " << y;
        }
    // The diagonal between two triangles, on the middles of pixels, belongs to one of them.
    const vis::Image slanted = drawn({0, 0}, {40, 30}, [](ImDrawList& list) {
        list.AddTriangleFilled({2.5f, 2.5f}, {22.5f, 2.5f}, {22.5f, 22.5f}, IM_COL32(0, 0, 255, 128));
        list.AddTriangleFilled({2.5f, 2.5f}, {22.5f, 22.5f}, {2.5f, 22.5f}, IM_COL32(0, 0, 255, 128));
    });
    for (int i = 3; i < 22; ++i) EXPECT_EQ(at(slanted, i, i).b, 128) << i;
}

TEST_F(DrawnPixels, ClipsAndPartsOfAFrameKeepTheirPlace) {
    const auto body = [](ImDrawList& list) {
        list.PushClipRect({8, 6}, {12, 20});
        list.AddRectFilled({5, 4}, {25, 14}, IM_COL32_WHITE);
        list.PopClipRect();
    };
    const vis::Image whole = drawn({0, 0}, {40, 30}, body), part = drawn({7, 5}, {20, 17}, body);
    int lit = 0;
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) {
            lit += at(whole, x, y).a > 0;
            if (x >= 7 && x < 20 && y >= 5 && y < 17) {
                EXPECT_EQ(at(part, x - 7, y - 5), at(whole, x, y));
            }
        }
    EXPECT_EQ(lit, 4 * 8);
    EXPECT_EQ(at(whole, 8, 6).a, 255);
    EXPECT_EQ(at(whole, 11, 13).a, 255);
}

TEST_F(DrawnPixels, TexturesAreMagnifiedAsTheySay) {
    vis::MemoryTexture two{.size = {2, 1}, .rgba = {0, 0, 0, 255, 200, 200, 200, 255}};
    const auto body = [&](ImDrawList& list) { list.AddImage((ImTextureID)two.name(), {0, 0}, {16, 8}); };
    const vis::Image smooth = drawn({0, 0}, {16, 8}, body);
    EXPECT_EQ(at(smooth, 2, 4).r, 0);
    EXPECT_NEAR(at(smooth, 7, 4).r, 200 * (7.5 / 8 - 0.5), 1);
    EXPECT_EQ(at(smooth, 14, 4).r, 200);
    two.smooth = false;
    const vis::Image hard = drawn({0, 0}, {16, 8}, body);
    EXPECT_EQ(at(hard, 7, 4).r, 0);
    EXPECT_EQ(at(hard, 8, 4).r, 200);
    // Smaller than its texels it is interpolated all the same.
    vis::MemoryTexture many{.size = {4, 1}, .rgba = {}, .smooth = false};
    for (const int value : {0, 100, 200, 100})
        for (int c = 0; c < 4; ++c) many.rgba.push_back(std::uint8_t(c < 3 ? value : 255));
    const vis::Image small = drawn({0, 0}, {2, 1}, [&](ImDrawList& list) {
        list.AddImage((ImTextureID)many.name(), {0, 0}, {2, 1});
    });
    EXPECT_EQ(at(small, 0, 0).r, 50);
    EXPECT_EQ(at(small, 1, 0).r, 150);
}

TEST_F(DrawnPixels, ColoursRunFromCornerToCorner) {
    const vis::Image image = drawn({0, 0}, {40, 30}, [](ImDrawList& list) {
        list.AddRectFilledMultiColor({0, 0}, {40, 30}, IM_COL32_BLACK, IM_COL32(240, 0, 0, 255),
                                     IM_COL32(240, 0, 120, 255), IM_COL32(0, 0, 120, 255));
    });
    for (const int x : {0, 13, 39})
        for (const int y : {0, 17, 29}) {
            EXPECT_NEAR(at(image, x, y).r, 240 * (x + 0.5) / 40, 1);
            EXPECT_NEAR(at(image, x, y).b, 120 * (y + 0.5) / 30, 1);
        }
}

} // namespace
} // namespace tessera::app
