#include "app/drawing/panels.h"

#include "volume/base/error.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tessera::app {

using namespace shapes;

namespace {

/// A shape moved and scaled: points become at + scale * point.
struct Placed {
    glm::dvec2 at;
    double scale;

    glm::dvec2 operator()(glm::dvec2 point) const { return at + scale * point; }
    PageBox operator()(const PageBox& box) const { return {(*this)(box.lo), (*this)(box.hi)}; }
    void move(Stroke& shape) const {
        for (glm::dvec2& point : shape.points) point = (*this)(point);
        shape.width *= scale;
    }
    void move(Polygon& shape) const {
        for (glm::dvec2& point : shape.points) point = (*this)(point);
    }
    void move(Rect& shape) const {
        shape.box = (*this)(shape.box);
        shape.line *= scale;
    }
    void move(Circle& shape) const {
        shape.center = (*this)(shape.center);
        shape.radius *= scale;
        shape.line *= scale;
    }
    void move(Words& shape) const {
        shape.at = (*this)(shape.at);
        shape.size *= scale;
        shape.halo *= scale;
    }
    void move(Picture& shape) const { shape.box = (*this)(shape.box); }
};

} // namespace

namespace {

constexpr double kTitleLine = 1.3, kTitleMargin = 0.4; // ems

std::vector<std::string> linesOfTitle(const std::string& title, double width, double text) {
    return brokenText(title, width / text - 2 * kTitleMargin, Face::Bold);
}

} // namespace

double titleHeight(const std::string& title, double width, double text) {
    return (double(linesOfTitle(title, width, text).size()) * kTitleLine + 2 * kTitleMargin) * text;
}

VectorPage titledPage(VectorPage page, const std::string& title, double text, glm::vec4 ground, glm::vec4 ink) {
    const double height = titleHeight(title, page.size.x, text);
    const Placed below{{0, height}, 1};
    for (Mark& mark : page.marks) std::visit([&](auto& shape) { below.move(shape); }, mark.shape);
    page.size.y += height;
    // A little more than the page, which may grow to whole pixels.
    page.marks.insert(page.marks.begin(), {Rect{.box = {{0, 0}, page.size + text}, .color = ground}});
    double base = (kTitleMargin + 1) * text;
    for (const std::string& line : linesOfTitle(title, page.size.x, text)) {
        page.marks.push_back({Words{.text = line,
                                    .at = {page.size.x / 2, base},
                                    .size = text,
                                    .color = ink,
                                    .face = Face::Bold,
                                    .anchor = 0.5}});
        base += kTitleLine * text;
    }
    return page;
}

int usualColumns(int panels) {
    return std::max(1, int(std::ceil(std::sqrt(double(panels)))));
}

std::vector<PanelPlace> panelPlaces(glm::ivec2 size, int panels, int columns, double text) {
    constexpr double kStrip = 1.6, kBase = 1.15, kGap = 0.8; // ems
    constexpr int kLeast = 16;
    assert(panels > 0);
    const int across = std::clamp(columns, 1, panels), down = (panels + across - 1) / across;
    const int strip = int(std::lround(kStrip * text)), gap = int(std::lround(kGap * text));
    const glm::ivec2 panel((size.x - (across - 1) * gap) / across, (size.y - (down - 1) * gap) / down - strip);
    if (std::min(panel.x, panel.y) < kLeast)
        throw Error(std::to_string(panels) + " panels in " + std::to_string(across) +
                    " columns do not fit a figure of " + std::to_string(size.x) + "x" + std::to_string(size.y) +
                    " pixels");
    std::vector<PanelPlace> places;
    for (int i = 0; i < panels; ++i) {
        const glm::ivec2 at(i % across * (panel.x + gap), i / across * (panel.y + strip + gap));
        const glm::ivec2 lo(at.x, at.y + strip);
        places.push_back({lo, lo + panel, {at.x, at.y + int(std::lround(kBase * text))}});
    }
    return places;
}

std::string panelLetter(int panel) {
    constexpr int kLetters = 26;
    const std::string last(1, char('a' + panel % kLetters));
    return panel < kLetters ? last : panelLetter(panel / kLetters - 1) + last;
}

VectorPage figureOfPanels(glm::dvec2 size, const std::vector<PanelPlace>& places, const std::vector<VectorPage>& pages,
                          double points, double text, glm::vec4 ground, glm::vec4 ink) {
    assert(places.size() == pages.size());
    VectorPage figure;
    figure.size = size;
    figure.marks.push_back({Rect{.box = {{0, 0}, size}, .color = ground}});
    for (std::size_t i = 0; i < pages.size(); ++i) {
        const PanelPlace& place = places[i];
        const glm::dvec2 scales = glm::dvec2(place.hi - place.lo) * points / pages[i].size;
        const Placed placed{glm::dvec2(place.lo) * points, std::min(scales.x, scales.y)};
        for (Mark mark : pages[i].marks) {
            std::visit([&](auto& shape) { placed.move(shape); }, mark.shape);
            figure.marks.push_back(std::move(mark));
        }
        figure.marks.push_back({Words{.text = panelLetter(int(i)),
                                      .at = glm::dvec2(place.letter) * points,
                                      .size = text,
                                      .color = ink,
                                      .face = Face::Bold}});
        if (figure.numbers.empty()) figure.numbers = pages[i].numbers;
    }
    return figure;
}

} // namespace tessera::app
