#include "app/drawing/drawing.h"

#include "app/drawing/embedded_session.h"
#include "volume/base/error.h"
#include "volume/base/printable.h"

#include <array>
#include <cairo-ft.h>
#include <cairo-pdf.h>
#include <memory>
#include <numbers>

namespace tessera::app {

using namespace shapes;

namespace {

template <auto destroy> struct Destroy {
    void operator()(auto* it) const { destroy(it); }
};
using Surface = std::unique_ptr<cairo_surface_t, Destroy<cairo_surface_destroy>>;
using Context = std::unique_ptr<cairo_t, Destroy<cairo_destroy>>;
using FontFace = std::unique_ptr<cairo_font_face_t, Destroy<cairo_font_face_destroy>>;
using FontOptions = std::unique_ptr<cairo_font_options_t, Destroy<cairo_font_options_destroy>>;

/// The fonts of the program, by FreeType; where one is not installed, what cairo has in its place.
class Fonts {
public:
    Fonts() {
        if (FT_Init_FreeType(&library_) != 0) throw MachineError("FreeType cannot be started");
    }
    ~Fonts() {
        for (FontFace& face : faces_) face.reset();
        for (FT_Face face : loaded_)
            if (face) FT_Done_Face(face);
        FT_Done_FreeType(library_);
    }
    Fonts(const Fonts&) = delete;
    Fonts& operator=(const Fonts&) = delete;

    cairo_font_face_t* get(Face which) {
        const auto at = static_cast<std::size_t>(which);
        if (faces_[at]) return faces_[at].get();
        const char* file = typeface(which).file;
        if (file && FT_New_Face(library_, file, 0, &loaded_[at]) == 0)
            faces_[at].reset(cairo_ft_font_face_create_for_ft_face(loaded_[at], FT_LOAD_NO_HINTING));
        else
            faces_[at].reset(
                cairo_toy_font_face_create("sans-serif", CAIRO_FONT_SLANT_NORMAL,
                                           which == Face::Bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL));
        return faces_[at].get();
    }

private:
    FT_Library library_ = nullptr;
    std::array<FT_Face, 3> loaded_{};
    std::array<FontFace, 3> faces_;
};

class Painter {
public:
    Painter(cairo_t* page, Fonts& fonts) : page_(page), fonts_(fonts) {
        const FontOptions options(cairo_font_options_create());
        cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
        cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
        cairo_set_font_options(page_, options.get());
        cairo_set_line_join(page_, CAIRO_LINE_JOIN_ROUND);
    }

    void draw(const Mark& mark) {
        cairo_save(page_);
        std::visit([&](const auto& shape) { draw(shape); }, mark.shape);
        cairo_restore(page_);
    }

private:
    void color(glm::vec4 ink) {
        cairo_set_source_rgba(page_, double(ink.r), double(ink.g), double(ink.b), double(ink.a));
    }
    void rectangle(const PageBox& box) {
        cairo_rectangle(page_, box.lo.x, box.lo.y, box.hi.x - box.lo.x, box.hi.y - box.lo.y);
    }
    void path(const std::vector<glm::dvec2>& points) {
        for (std::size_t i = 0; i < points.size(); ++i)
            (i == 0 ? cairo_move_to : cairo_line_to)(page_, points[i].x, points[i].y);
        if (points.size() > 2 && points.front() == points.back()) cairo_close_path(page_);
    }
    /// Draws the path: its edge of a width, or with 0 its inside.
    void paint(glm::vec4 ink, double line) {
        color(ink);
        cairo_set_line_width(page_, line);
        line > 0 ? cairo_stroke(page_) : cairo_fill(page_);
    }

    void draw(const Stroke& stroke) {
        path(stroke.points);
        paint(stroke.color, stroke.width);
    }
    void draw(const Polygon& polygon) {
        path(polygon.points);
        paint(polygon.color, 0);
    }
    void draw(const Rect& rect) {
        rectangle(rect.box);
        paint(rect.color, rect.line);
    }
    void draw(const Circle& circle) {
        cairo_arc(page_, circle.center.x, circle.center.y, circle.radius, 0, 2 * std::numbers::pi);
        paint(circle.color, circle.line);
    }
    void draw(const Words& words) {
        const std::string text = printable(words.text); // cairo fails for what is not UTF-8
        cairo_set_font_face(page_, fonts_.get(words.face));
        cairo_set_font_size(page_, words.size);
        color(words.color);
        cairo_text_extents_t extents;
        cairo_text_extents(page_, text.c_str(), &extents);
        cairo_translate(page_, words.at.x, words.at.y);
        cairo_rotate(page_, words.angle * std::numbers::pi / 180);
        cairo_translate(page_, -words.anchor * extents.x_advance, words.middle ? kMiddle * words.size : 0);
        cairo_move_to(page_, 0, 0);
        if (words.halo > 0) {
            cairo_text_path(page_, text.c_str());
            paint(kHalo, words.halo);
            color(words.color);
            cairo_move_to(page_, 0, 0);
        }
        cairo_show_text(page_, text.c_str());
    }
    void draw(const Picture& picture) {
        const glm::ivec2 size = picture.image.size;
        const Surface image(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, size.x, size.y));
        if (cairo_surface_status(image.get()) != CAIRO_STATUS_SUCCESS)
            throw MachineError("a picture is too large for a PDF");
        unsigned char* const rows = cairo_image_surface_get_data(image.get());
        const int stride = cairo_image_surface_get_stride(image.get());
        for (int y = 0; y < size.y; ++y) {
            auto* out = reinterpret_cast<std::uint32_t*>(rows + std::ptrdiff_t(y) * stride);
            const std::uint8_t* in = &picture.image.rgba[std::size_t(y) * std::size_t(size.x) * 4];
            for (int x = 0; x < size.x; ++x, in += 4) {
                const std::uint32_t a = in[3];
                const auto times = [&](std::uint32_t value) { return (value * a + 127) / 255; }; // by opacity
                out[x] = a << 24 | times(in[0]) << 16 | times(in[1]) << 8 | times(in[2]);
            }
        }
        cairo_surface_mark_dirty(image.get());
        cairo_translate(page_, picture.box.lo.x, picture.box.lo.y);
        cairo_scale(page_, (picture.box.hi.x - picture.box.lo.x) / size.x,
                    (picture.box.hi.y - picture.box.lo.y) / size.y);
        cairo_set_source_surface(page_, image.get(), 0, 0);
        cairo_pattern_set_filter(cairo_get_source(page_), picture.smooth ? CAIRO_FILTER_GOOD : CAIRO_FILTER_NEAREST);
        cairo_rectangle(page_, 0, 0, size.x, size.y);
        cairo_fill(page_);
    }

    cairo_t* page_;
    Fonts& fonts_;
};

cairo_status_t append(void* to, const unsigned char* bytes, unsigned count) {
    static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(bytes), count);
    return CAIRO_STATUS_SUCCESS;
}

} // namespace

std::string pdfOf(const VectorPage& drawing) {
    std::string out;
    Fonts fonts;
    const Surface surface(cairo_pdf_surface_create_for_stream(append, &out, drawing.size.x, drawing.size.y));
    cairo_pdf_surface_restrict_to_version(surface.get(), CAIRO_PDF_VERSION_1_4); // has a cross-reference table
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATOR, "Tessera");
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "");
    if (!drawing.numbers.empty())
        cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_SUBJECT,
                                       ("numbers: " + drawing.numbers).c_str());
    {
        const Context page(cairo_create(surface.get()));
        Painter painter(page.get(), fonts);
        for (const Mark& mark : drawing.marks) painter.draw(mark);
    }
    cairo_surface_finish(surface.get());
    if (const cairo_status_t status = cairo_surface_status(surface.get()); status != CAIRO_STATUS_SUCCESS)
        throw MachineError(std::string("no PDF could be made: ") + cairo_status_to_string(status));
    return drawing.session.empty() ? out : withAttachedSession(std::move(out), drawing.session);
}

vis::Image imageOf(const VectorPage& drawing, glm::ivec2 pixels) {
    Fonts fonts;
    const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, pixels.x, pixels.y));
    {
        const Context page(cairo_create(surface.get()));
        cairo_scale(page.get(), pixels.x / drawing.size.x, pixels.y / drawing.size.y);
        Painter painter(page.get(), fonts);
        for (const Mark& mark : drawing.marks) painter.draw(mark);
    }
    cairo_surface_flush(surface.get());
    if (const cairo_status_t status = cairo_surface_status(surface.get()); status != CAIRO_STATUS_SUCCESS)
        throw MachineError(std::string("no picture could be made: ") + cairo_status_to_string(status));
    vis::Image image;
    image.size = pixels;
    image.rgba.reserve(std::size_t(pixels.x) * std::size_t(pixels.y) * 4);
    const unsigned char* const rows = cairo_image_surface_get_data(surface.get());
    const std::ptrdiff_t stride = cairo_image_surface_get_stride(surface.get());
    for (int y = 0; y < pixels.y; ++y) {
        const auto* in = reinterpret_cast<const std::uint32_t*>(rows + y * stride);
        for (int x = 0; x < pixels.x; ++x)
            for (const int shift : {16, 8, 0}) {
                image.rgba.push_back(static_cast<std::uint8_t>(in[x] >> shift & 255));
                if (shift == 0) image.rgba.push_back(255);
            }
    }
    return image;
}

} // namespace tessera::app
