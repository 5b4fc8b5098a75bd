#include "app/drawing/drawing.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

namespace tessera::app {

using namespace shapes;

namespace {

class Bounds {
public:
    void add(glm::dvec2 at, double reach = 0) { box_ = {glm::min(box_.lo, at - reach), glm::max(box_.hi, at + reach)}; }
    void add(const Stroke& stroke) {
        for (const glm::dvec2& point : stroke.points) add(point, stroke.width / 2);
    }
    void add(const Area& area) {
        for (const std::vector<glm::dvec2>& outline : area.outlines)
            for (const glm::dvec2& point : outline) add(point);
    }
    void add(const Rect& rect) {
        add(rect.box.lo, rect.line / 2);
        add(rect.box.hi, rect.line / 2);
    }
    void add(const Circle& circle) { add(circle.center, circle.radius + circle.line / 2); }
    void add(const Ramp& ramp) { add(Rect{ramp.box}); }
    void add(const Picture& picture) { add(Rect{picture.box}); }
    void add(const Words& words) {
        const double turn = words.angle * 3.14159265358979323846 / 180;
        const glm::dvec2 along(std::cos(turn), std::sin(turn)), down(-along.y, along.x);
        for (const double x : {-words.anchor, 1 - words.anchor})
            for (const double y : {-0.75, 0.25}) add(words.at + along * (x * words.width) + down * (y * words.size));
    }
    PageBox box() const { return box_; }

private:
    PageBox box_{glm::dvec2(std::numeric_limits<double>::infinity()),
                 glm::dvec2(-std::numeric_limits<double>::infinity())};
};

/// The opposite of what an SVG does to texts.
std::string unescaped(std::string text) {
    for (const auto& [from, to] : {std::pair{"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&amp;", "&"}})
        for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; ++at)
            text.replace(at, std::string_view(from).size(), to);
    return text;
}

} // namespace

PageBox boundsOf(const Mark& mark) {
    Bounds bounds;
    std::visit([&](const auto& shape) { bounds.add(shape); }, mark.shape);
    return bounds.box();
}

std::string fileOf(const VectorPage& drawing, std::string_view suffix) {
    return suffix == "pdf" ? pdfOf(drawing) : svgOf(drawing);
}

std::optional<std::string> sessionInDrawing(const std::string& bytes) {
    const bool pdf = bytes.starts_with("%PDF-");
    const std::string mark = (pdf ? "\n%" : "<metadata>") + std::string(vis::kSessionTextKey) + ": ";
    const std::size_t at = pdf ? bytes.rfind(mark) : bytes.find(mark); // before anything that the page shows
    if (at == std::string::npos) return std::nullopt;
    const std::size_t from = at + mark.size(), end = bytes.find(pdf ? "\n" : "</metadata>", from);
    if (end == std::string::npos) return std::nullopt;
    const std::string text = bytes.substr(from, end - from);
    return pdf ? text : unescaped(text);
}

} // namespace tessera::app
