#include "app/platform/drawn_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <optional>
#include <span>

namespace tessera::app {

using namespace shapes;

namespace {

glm::dvec2 vec(ImVec2 v) {
    return {double(v.x), double(v.y)};
}

glm::vec4 inkOf(ImU32 color) {
    const ImVec4 c = ImGui::ColorConvertU32ToFloat4(color);
    return {c.x, c.y, c.z, c.w};
}

std::string utf8(std::uint32_t code) {
    const auto byte = [](std::uint32_t value) { return static_cast<char>(static_cast<unsigned char>(value)); };
    if (code < 0x80) return {byte(code)};
    if (code < 0x800) return {byte(0xC0 | code >> 6), byte(0x80 | (code & 63))};
    return {byte(0xE0 | code >> 12), byte(0x80 | (code >> 6 & 63)), byte(0x80 | (code & 63))};
}

/// The part of a convex polygon inside of a box (Sutherland and Hodgman 1974).
std::vector<glm::dvec2> clipped(std::vector<glm::dvec2> points, const PageBox& box) {
    for (int axis = 0; axis < 2; ++axis)
        for (const double sign : {1.0, -1.0}) {
            const double edge = sign * (sign > 0 ? box.lo[axis] : box.hi[axis]);
            std::vector<glm::dvec2> kept;
            for (std::size_t i = 0; i < points.size(); ++i) {
                const glm::dvec2 a = points[i], b = points[(i + 1) % points.size()];
                const double da = sign * a[axis] - edge, db = sign * b[axis] - edge;
                if (da >= 0) kept.push_back(a);
                if ((da > 0 && db < 0) || (da < 0 && db > 0)) kept.push_back(a + (b - a) * (da / (da - db)));
            }
            points = std::move(kept);
        }
    return points;
}

/// A letter as it lies on the page.
struct Letter {
    std::uint32_t code = 0;
    Face face = Face::Text;
    const ImFont* font = nullptr;
    glm::dvec2 pen{0}, along{1, 0}; ///< on the base line; direction of the text
    double size = 0, scale = 1;     ///< of an em in pixels; of the font's own measures
    double advance = 0;             ///< to the next letter
    glm::dvec2 middle{0};
};

class PageMaker {
public:
    PageMaker(const ImDrawData& frame, const Fonts& fonts, double points, const RasterizeParts& rasterize)
        : frame_(frame), fonts_(fonts), points_(points), rasterize_(rasterize) {}

    VectorPage make() {
        page_.size = vec(frame_.DisplaySize) * points_;
        for (int n = 0; n < frame_.CmdListsCount; ++n) {
            ImDrawList& list = *frame_.CmdLists[n];
            for (const ImDrawCmd& command : list.CmdBuffer)
                if (!command.UserCallback && command.ElemCount > 0) add(list, command);
        }
        endRaster();
        return std::move(page_);
    }

private:
    void add(ImDrawList& list, const ImDrawCmd& command) {
        list_ = &list;
        command_ = &command;
        clip_ = {glm::max(vec({command.ClipRect.x, command.ClipRect.y}), glm::dvec2(0)),
                 glm::min(vec({command.ClipRect.z, command.ClipRect.w}), vec(frame_.DisplaySize))};
        if (clip_.lo.x >= clip_.hi.x || clip_.lo.y >= clip_.hi.y) return;
        if (command.GetTexID() != ImGui::GetIO().Fonts->TexID) return raster(0, command.ElemCount);
        for (unsigned at = 0; at < command.ElemCount;) at += addNext(at);
    }

    const ImDrawVert& vertex(unsigned at) const {
        return list_->VtxBuffer[int(command_->VtxOffset + list_->IdxBuffer[int(command_->IdxOffset + at)])];
    }
    ImDrawIdx index(unsigned at) const { return list_->IdxBuffer[int(command_->IdxOffset + at)]; }

    /// Whether a triangle has one colour and no texture.
    bool isPlain(unsigned at) const {
        const ImVec2 white = ImGui::GetIO().Fonts->TexUvWhitePixel;
        for (unsigned i = at; i < at + 3; ++i) {
            const ImDrawVert& v = vertex(i);
            if (v.uv.x != white.x || v.uv.y != white.y || v.col != vertex(at).col) return false;
        }
        return true;
    }

    /// Adds what begins at an index; returns the number of indices taken.
    unsigned addNext(unsigned at) {
        if (isPlain(at)) return addFan(at);
        if (at + 6 <= command_->ElemCount && index(at + 3) == index(at) && index(at + 4) == index(at + 2))
            if (const std::optional<Letter> letter =
                    letterOf({vertex(at), vertex(at + 1), vertex(at + 2), vertex(at + 5)})) {
                addLetter(*letter, vertex(at).col);
                return 6;
            }
        raster(at, 3);
        return 3;
    }

    /// Triangles round one corner are a convex polygon.
    unsigned addFan(unsigned at) {
        std::vector<glm::dvec2> corners{vec(vertex(at).pos), vec(vertex(at + 1).pos), vec(vertex(at + 2).pos)};
        unsigned end = at + 3;
        while (end + 3 <= command_->ElemCount && index(end) == index(at) && index(end + 1) == index(end - 1) &&
               isPlain(end) && vertex(end).col == vertex(at).col) {
            corners.push_back(vec(vertex(end + 2).pos));
            end += 3;
        }
        const glm::vec4 ink = inkOf(vertex(at).col);
        if (ink.a > 0) addShape(corners, ink);
        return end - at;
    }

    void addShape(const std::vector<glm::dvec2>& corners, glm::vec4 ink) {
        const auto inside = [&](glm::dvec2 p) {
            return p.x >= clip_.lo.x && p.y >= clip_.lo.y && p.x <= clip_.hi.x && p.y <= clip_.hi.y;
        };
        if (corners.size() == 4 && std::ranges::all_of(corners, inside) && addLine(corners, ink)) return;
        std::vector<glm::dvec2> kept = clipped(corners, clip_);
        if (kept.size() < 3) return;
        if (kept.size() == 4 && isBox(kept)) {
            const auto [lo, hi] = std::pair{glm::min(kept[0], kept[2]), glm::max(kept[0], kept[2])};
            return put({Rect{.box = {lo * points_, hi * points_}, .color = ink}});
        }
        for (glm::dvec2& point : kept) point *= points_;
        put({Polygon{std::move(kept), ink}});
    }

    static bool isBox(const std::vector<glm::dvec2>& p) {
        return (p[0].x == p[1].x && p[1].y == p[2].y && p[2].x == p[3].x && p[3].y == p[0].y) ||
               (p[0].y == p[1].y && p[1].x == p[2].x && p[2].y == p[3].y && p[3].x == p[0].x);
    }

    /// A piece of a line, as ImGui makes it: a rectangle whose first side lies along it. False for other shapes.
    bool addLine(const std::vector<glm::dvec2>& p, glm::vec4 ink) {
        constexpr double kThick = 4, kNear = 0.02; // pixels
        const glm::dvec2 along = p[1] - p[0], across = p[3] - p[0];
        const double width = glm::length(across), length = glm::length(along);
        if (glm::length(p[0] + p[2] - p[1] - p[3]) > kNear || width < kNear || length < kNear ||
            std::abs(glm::dot(along, across)) > kNear * width * length)
            return false;
        if (isBox(p) && std::min(width, length) > kThick) return false;
        const glm::dvec2 from = (p[0] + p[3]) / 2.0 * points_, to = (p[1] + p[2]) / 2.0 * points_;
        Stroke* const last =
            parts_.empty() && !page_.marks.empty() ? std::get_if<Stroke>(&page_.marks.back().shape) : nullptr;
        const double near = kNear * points_;
        if (!last || last->color != ink || std::abs(last->width - width * points_) > near ||
            glm::length(last->points.back() - from) > near) {
            put({Stroke{{from, to}, width * points_, ink}});
            return true;
        }
        last->points.push_back(glm::length(last->points.front() - to) > near ? to : last->points.front());
        return true;
    }

    /// The letter of a quad with corners clockwise from the upper left; it may be cut off.
    std::optional<Letter> letterOf(const std::array<ImDrawVert, 4>& q) const {
        const glm::dvec2 uv0 = vec(q[0].uv), uv1 = vec(q[2].uv), middle = (uv0 + uv1) / 2.0;
        if (uv0.x == uv1.x || uv0.y == uv1.y) return {};
        for (const auto& [font, face] : {std::pair{fonts_.text, Face::Text}, {fonts_.bold, Face::Bold}})
            for (const ImFontGlyph& glyph : font->Glyphs) {
                if (middle.x < double(glyph.U0) || middle.x > double(glyph.U1) || middle.y < double(glyph.V0) ||
                    middle.y > double(glyph.V1))
                    continue;
                constexpr std::uint32_t kFirstIcon = 0xE000; // other programs lack their font
                if (glyph.Codepoint >= kFirstIcon) return {};
                const glm::dvec2 perU = (vec(q[1].pos) - vec(q[0].pos)) / (uv1.x - uv0.x),
                                 perV = (vec(q[3].pos) - vec(q[0].pos)) / (uv1.y - uv0.y);
                Letter out{.code = glyph.Codepoint, .face = face, .font = font};
                out.along = glm::normalize(perU);
                const glm::dvec2 down = glm::normalize(perV);
                out.scale = glm::length(perU) * double(glyph.U1 - glyph.U0) / double(glyph.X1 - glyph.X0);
                const glm::dvec2 corner =
                    vec(q[0].pos) + perU * (double(glyph.U0) - uv0.x) + perV * (double(glyph.V0) - uv0.y);
                const double base = std::round(double(font->Ascent)) - double(glyph.Y0);
                out.pen = corner + (down * base - out.along * double(glyph.X0)) * out.scale;
                const Typeface& type = typeface(face);
                out.size = double(font->FontSize) * out.scale / (type.file ? type.line : 1);
                out.advance = double(glyph.AdvanceX) * out.scale;
                out.middle = (vec(q[0].pos) + vec(q[2].pos)) / 2.0;
                return out;
            }
        return {};
    }

    void addLetter(const Letter& letter, ImU32 color) {
        constexpr double kNear = 0.3; // pixels
        constexpr int kMostSpaces = 4;
        const glm::vec4 ink = inkOf(color);
        if (ink.a <= 0 || letter.middle.x < clip_.lo.x || letter.middle.x > clip_.hi.x ||
            letter.middle.y < clip_.lo.y || letter.middle.y > clip_.hi.y)
            return;
        const glm::dvec2 gap = letter.pen - next_;
        const double space = double(letter.font->GetCharAdvance(' ')) * letter.scale;
        int spaces = -1;
        Words* const last =
            parts_.empty() && !page_.marks.empty() ? std::get_if<Words>(&page_.marks.back().shape) : nullptr;
        if (last && last->color == ink && last->face == letter.face &&
            std::abs(last->size - letter.size * points_) < kNear * points_ && glm::dot(letter.along, along_) > 0.9999)
            for (int n = 0; n <= kMostSpaces; ++n)
                if (glm::length(gap - letter.along * (n * space)) < kNear) spaces = n;
        if (spaces >= 0) {
            last->text += std::string(std::size_t(spaces), ' ') + utf8(letter.code);
        } else {
            put({Words{.text = utf8(letter.code),
                       .at = letter.pen * points_,
                       .size = letter.size * points_,
                       .color = ink,
                       .face = letter.face,
                       .angle = std::atan2(letter.along.y, letter.along.x) * 180 / std::numbers::pi}});
        }
        next_ = letter.pen + letter.along * letter.advance;
        along_ = letter.along;
    }

    void put(Mark mark) {
        endRaster();
        page_.marks.push_back(std::move(mark));
    }

    /// Leaves triangles to the next raster picture.
    void raster(unsigned at, unsigned count) {
        for (unsigned i = at; i < at + count; ++i) {
            const glm::dvec2 p = glm::clamp(vec(vertex(i).pos), clip_.lo, clip_.hi);
            box_ = {glm::min(box_.lo, p), glm::max(box_.hi, p)};
        }
        if (!parts_.empty()) {
            DrawnPart& last = parts_.back();
            if (last.list == list_ && from_ == command_ &&
                last.command.IdxOffset + last.command.ElemCount == command_->IdxOffset + at) {
                last.command.ElemCount += count;
                return;
            }
        }
        DrawnPart part{list_, *command_};
        part.command.IdxOffset += at;
        part.command.ElemCount = count;
        parts_.push_back(part);
        from_ = command_;
    }

    void endRaster() {
        if (parts_.empty()) return;
        const glm::ivec2 lo(glm::floor(box_.lo)), hi(glm::ceil(box_.hi));
        if (lo.x < hi.x && lo.y < hi.y)
            page_.marks.push_back({Picture{.box = {glm::dvec2(lo) * points_, glm::dvec2(hi) * points_},
                                           .image = rasterize_(parts_, lo, hi)}});
        parts_.clear();
        box_ = kNothing;
    }

    static constexpr double kFar = std::numeric_limits<double>::infinity();
    static constexpr PageBox kNothing{{kFar, kFar}, {-kFar, -kFar}};

    const ImDrawData& frame_;
    const Fonts& fonts_;
    double points_;
    const RasterizeParts& rasterize_;
    VectorPage page_;
    ImDrawList* list_ = nullptr; ///< being added
    const ImDrawCmd* command_ = nullptr;
    PageBox clip_;
    std::vector<DrawnPart> parts_;    ///< of the next raster picture
    const ImDrawCmd* from_ = nullptr; ///< of the last of them
    PageBox box_ = kNothing;
    glm::dvec2 next_{0}, along_{1, 0}; ///< where the last text goes on
};

} // namespace

VectorPage pageOf(const ImDrawData& frame, const Fonts& fonts, double points, const RasterizeParts& rasterize) {
    return PageMaker(frame, fonts, points, rasterize).make();
}

} // namespace tessera::app
