#include "app/pages/plot_page.h"

#include "app/drawing/free_place.h"
#include "app/pages/plot_marks.h"
#include "app/ui/ticks.h"
#include "volume/base/error.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <span>

namespace tessera::app {

using namespace shapes;

namespace {

// Room around a plot in points, for texts of kFigureText.
constexpr double kPageLeft = 62, kPageBottom = 42, kPageTop = 22, kPageRight = 12, kPageGap = 5;
constexpr double kListLine = 11, kListKey = 8, kListKeyGap = 3,
                 kListApart = 9;       // lists of series: keys beside the names
constexpr glm::dvec2 kLeastPlot{8, 4}; // of a plot

/// How plots stand on a page: all as large, in rows.
struct PlotGrid {
    int columns = 1, rows = 1;
    bool sharedX = false, sharedY = false; ///< numbers stand below the last row, beside the first column
    double left = 0, right = 0, top = 0, bottom = 0, gap = 0, between = 0;
    glm::dvec2 plot{0};
    UpTitle up = UpTitle::Beside;
    bool acrossBelow = false;

    double pitchX() const { return plot.x + (sharedY ? between : left + right); }
    double pitchY() const { return plot.y + top + (sharedX ? gap : bottom); }
    glm::dvec2 size() const {
        return {left + right + plot.x + (columns - 1) * pitchX(), top + bottom + plot.y + (rows - 1) * pitchY()};
    }
    PageBox box(int i) const {
        const glm::dvec2 lo{left + i % columns * pitchX(), top + i / columns * pitchY()};
        return {lo, lo + plot};
    }
};

bool framedAt(const std::vector<Plot>& plots, int i) {
    return i >= 0 && i < int(plots.size()) && plots[std::size_t(i)].framed;
}

/// Whether framed plots `step` apart have the same axis, those from `first` on up to `last`.
template <class AxisOf>
bool oneAxis(const std::vector<Plot>& plots, int first, int last, int step, const AxisOf& axisOf) {
    const PlotAxis* seen = nullptr;
    for (int i = first; i < last; i += step) {
        if (!framedAt(plots, i)) continue;
        const PlotAxis& own = axisOf(plots[std::size_t(i)]);
        if (own.title.empty() && !own.numbered) continue;
        if (seen && !(own == *seen)) return false;
        seen = &own;
    }
    return true;
}

/// Lays out plots in columns; `topRoom`: more room above each; `size`: of the page, 0: natural.
class PlotLayout {
public:
    PlotLayout(const std::vector<Plot>& plots, const PageForm& form, glm::dvec2 size, bool shared)
        : plots_(plots), form_(form), size_(size), shared_(shared), scale_(form.text / kFigureText) {}

    PlotGrid grid(int columns, double topRoom) const {
        PlotGrid grid;
        const int count = std::max(1, int(plots_.size()));
        grid.columns = std::clamp(columns, 1, count);
        grid.rows = (count + grid.columns - 1) / grid.columns;
        share(grid);
        double key = 0;
        for (const Plot& plot : plots_) key = std::max(key, keyRoom(plot, form_));
        grid.gap = kPageGap * scale_;
        if (!natural()) grid.gap = std::min({grid.gap, size_.x / grid.columns / 8, size_.y / grid.rows / 8});
        grid.between = grid.gap + key;
        if (natural() && !shared_) {
            grid.left = kPageLeft * scale_;
            grid.right = kPageRight * scale_ + key;
            grid.top = kPageTop * scale_ + topRoom;
            grid.bottom = kPageBottom * scale_;
            grid.plot = kFigurePlot * scale_;
            return grid;
        }
        grid.right = kPageRight * scale_ + key;
        grid.left = kPageGap * scale_;
        grid.bottom = kPageGap * scale_;
        if (form_.axes) {
            grid.left = numbersBeside() + (10 + kFigureText) * scale_;
            grid.bottom = 34 * scale_;
        }
        for (int round = 0; round < 2; ++round) { // the second knows how wide the plots are
            grid.top = topOf(grid) + topRoom;
            fill(grid);
            if (form_.axes) placeTitles(grid, round == 1);
        }
        grid.top = topOf(grid) + topRoom;
        fill(grid);
        return grid;
    }

    PlotGrid best(int columns, double topRoom) const {
        if (columns > 0 || natural()) return grid(columns > 0 ? columns : 2, topRoom);
        std::optional<PlotGrid> found;
        const auto worth = [](const PlotGrid& each) { return std::min(each.plot.x / 2, each.plot.y); };
        for (int across = 1; across <= std::max(1, int(plots_.size())); ++across) {
            const PlotGrid tried = grid(across, topRoom);
            if (!found || worth(tried) > worth(*found)) found = tried;
        }
        return *found;
    }

private:
    bool natural() const { return size_.x <= 0; }

    void share(PlotGrid& grid) const {
        if (natural() && !shared_) return;
        const int count = int(plots_.size());
        grid.sharedX = grid.rows > 1;
        grid.sharedY = grid.columns > 1;
        for (int column = 0; column < grid.columns; ++column)
            grid.sharedX = grid.sharedX && oneAxis(plots_, column, count, grid.columns,
                                                   [](const Plot& plot) -> const PlotAxis& { return plot.x; });
        for (int row = 0; row < grid.rows; ++row)
            grid.sharedY =
                grid.sharedY && oneAxis(plots_, row * grid.columns, std::min(count, (row + 1) * grid.columns), 1,
                                        [](const Plot& plot) -> const PlotAxis& { return plot.y; });
    }
    std::vector<std::string> textsBeside(const PlotAxis& axis, int most) const {
        if (!axis.numbered) return {};
        if (axis.scale.isEven()) return styledTickLabels(axis.range, most, true, form_.figure.ticks).texts;
        return scaledTicks(axis.range, axis.scale, most, 0, true, [](const std::string&) { return 0.9; }).texts;
    }
    double numbersBeside() const {
        double widest = 0;
        for (const Plot& plot : plots_)
            for (const int most : {3, 5, 8, 12}) // more numbers may have more digits
                for (const std::string& text : textsBeside(plot.y, most))
                    widest = std::max(widest, pageTextWidth(text, form_.text));
        return widest + 8 * scale_;
    }
    double widestTitle(bool below) const {
        double widest = 0;
        for (const Plot& plot : plots_)
            if (plot.framed)
                widest = std::max(widest, pageTextWidth(wholeAxisTitle(below ? plot.x : plot.y), form_.text));
        return widest;
    }
    double topOf(const PlotGrid& grid) const {
        std::size_t lines = 0;
        for (const Plot& plot : plots_)
            lines = std::max(lines, titleLines(plot, std::max(grid.plot.x, 8 * form_.text), form_).size());
        const double titles =
            lines > 0 ? (7 * scale_ + form_.text + double(lines - 1) * titleLine(lines, form_)) : 0.8 * grid.gap;
        return titles + (grid.up == UpTitle::Above ? form_.text * kLineHeight : 0);
    }
    /// Where the titles of axes have room, once it is known how large plots are.
    void placeTitles(PlotGrid& grid, bool last) const {
        const double up = widestTitle(false), below = widestTitle(true), text = form_.text;
        const double most = 0.45;
        if (!last && up > grid.plot.y && grid.plot.y < 12 * text) {
            grid.up = !grid.sharedY && grid.plot.y > 4.5 * text ? UpTitle::Above : UpTitle::Across;
            grid.left = numbersBeside() + 8 * scale_;
            if (grid.up == UpTitle::Across)
                grid.left = std::min(grid.left + up, std::max(grid.left + 4 * text, naturalOr(size_.x, up) * most));
        }
        if (last && below > grid.pitchX() && grid.columns > 1) {
            grid.acrossBelow = true;
            grid.bottom = std::min(20 * scale_ + below, std::max(34 * scale_, naturalOr(size_.y, below) * most));
        }
    }
    static double naturalOr(double length, double natural) { return length > 0 ? length : 10 * natural; }

    void fill(PlotGrid& grid) const {
        grid.plot = kFigurePlot * scale_;
        if (natural()) return;
        grid.plot = {0, 0};
        grid.plot = (size_ - grid.size()) / glm::dvec2(grid.columns, grid.rows);
    }

    const std::vector<Plot>& plots_;
    const PageForm& form_;
    glm::dvec2 size_;
    bool shared_;
    double scale_;
};

PlotPlace plotPlaceOf(const std::vector<Plot>& plots, const PlotGrid& grid, int i, const PageForm& form) {
    PlotPlace place{
        .box = grid.box(i), .acrossBelow = grid.acrossBelow, .up = grid.up, .left = grid.left, .bottom = grid.bottom};
    place.overhang = grid.sharedY ? 0 : kPageRight * form.text / kFigureText;
    place.stacked = grid.rows > 1;
    place.above = grid.up == UpTitle::Above && form.axes ? form.text * kLineHeight : 0;
    if (grid.sharedX) // the last of its column
        for (int later = i + grid.columns; later < int(plots.size()); later += grid.columns)
            if (framedAt(plots, later)) place.numbersBelow = false;
    if (grid.sharedY) // the first of its row that has numbers
        for (int earlier = i / grid.columns * grid.columns; earlier < i; ++earlier)
            if (framedAt(plots, earlier) && plots[std::size_t(earlier)].y.numbered) place.numbersBeside = false;
    return place;
}

double listWidth(const PlotSeries& series, double text) {
    return (kListKey + kListKeyGap) * text / kFigureText + pageTextWidth(series.name, text);
}

/// A list of series in lines that are no wider than `width`, from the upper left corner; keys behind the names where
/// `right`. Returns its size; draws nothing without `out`.
glm::dvec2 listSeries(const std::vector<PlotSeries>& list, double width, const PageForm& form, glm::dvec2 at,
                      std::vector<Mark>* out, bool lines = false, bool right = false) {
    const double scale = form.text / kFigureText;
    glm::dvec2 pen(0), size(0, kListLine * scale);
    double widest = 0;
    for (const PlotSeries& series : list) widest = std::max(widest, listWidth(series, form.text));
    for (const PlotSeries& series : list) {
        const double own = listWidth(series, form.text);
        if (&series != list.data() && (lines || pen.x + own > width)) pen = {0, pen.y + kListLine * scale};
        size = {std::max(size.x, pen.x + own), pen.y + kListLine * scale};
        if (out) {
            const double edge = right ? at.x + widest - kListKey * scale : at.x + pen.x, y = at.y + pen.y + 9 * scale;
            out->push_back({Rect{.box = {{edge, y - 6 * scale}, {edge + kListKey * scale, y - 2 * scale}},
                                 .color = glm::vec4(series.color, 1)}});
            out->push_back(
                {Words{.text = series.name,
                       .at = {right ? edge - kListKeyGap * scale : edge + (kListKey + kListKeyGap) * scale, y},
                       .size = form.text,
                       .color = pageInks(form).text,
                       .anchor = right ? 1.0 : 0.0}});
        }
        pen.x += own + kListApart * scale;
    }
    return size;
}

/// Where the lists of series stand.
struct SeriesLists {
    std::vector<std::optional<PageBox>> within; ///< by plot: in it
    double above = 0, below = 0;                ///< else room above each, or below all
};

SeriesLists placeLists(const std::vector<Plot>& plots, const PlotGrid& grid, const PageForm& form) {
    SeriesLists lists;
    bool all = true, same = true;
    const Plot* first = nullptr;
    for (std::size_t i = 0; i < plots.size(); ++i) {
        lists.within.emplace_back();
        if (!form.legend || plots[i].series.size() < 2) continue;
        const PlotPlace place = plotPlaceOf(plots, grid, int(i), form);
        std::vector<Mark> marks;
        const std::size_t data = addPlot(marks, plots[i], place, form);
        const glm::dvec2 size = listSeries(plots[i].series, 0, form, {}, nullptr, true);
        lists.within[i] = freePlace(size, place.box, std::span(marks).subspan(data));
        all = all && lists.within[i];
        const auto alike = [](const PlotSeries& a, const PlotSeries& b) {
            return a.name == b.name && a.color == b.color;
        };
        same = same && (!first || std::ranges::equal(first->series, plots[i].series, alike));
        first = &plots[i];
    }
    if (all) return lists;
    if (same) {
        const double width = grid.size().x - grid.left - grid.right;
        lists.below = listSeries(first->series, width, form, {}, nullptr).y + kPageGap * form.text / kFigureText;
    } else {
        for (const Plot& plot : plots)
            if (plot.series.size() > 1)
                lists.above = std::max(lists.above, listSeries(plot.series, grid.plot.x, form, {}, nullptr).y +
                                                        2 * form.text / kFigureText);
    }
    return lists;
}

/// The same with the captions that the user gave their axes.
std::vector<Plot> captioned(std::vector<Plot> plots, const FigureSettings& settings) {
    if (settings.captions.empty()) return plots;
    for (Plot& plot : plots) {
        for (PlotAxis* const axis : {&plot.x, &plot.y}) axis->title = captionOf(settings, axis->title);
        if (plot.right) plot.right->title = captionOf(settings, plot.right->title);
    }
    return plots;
}

[[noreturn]] void throwNoRoom(std::size_t plots, const PageForm& form) {
    char text[160];
    std::snprintf(text, sizeof text, "%zu plot%s with text of %g pt %s no room on a page of %.0f x %.0f pt", plots,
                  plots == 1 ? "" : "s", form.text, plots == 1 ? "has" : "have", form.size.x, form.size.y);
    throw Error(text);
}

} // namespace

glm::dvec2 plotArea(const std::vector<Plot>& shown, int columns, const PageForm& form, bool shared) {
    const std::vector<Plot> plots = captioned(shown, form.figure);
    return PlotLayout(plots, form, form.size, shared).best(columns, 0).plot;
}

VectorPage plotPage(const std::vector<Plot>& shown, int columns, const PageForm& form, bool shared) {
    const std::vector<Plot> plots = captioned(shown, form.figure);
    PlotGrid grid = PlotLayout(plots, form, form.size, shared).best(columns, 0);
    const SeriesLists lists = placeLists(plots, grid, form);
    if (lists.above > 0 || lists.below > 0) {
        const glm::dvec2 left(form.size.x, form.size.y > 0 ? form.size.y - lists.below : 0);
        grid = PlotLayout(plots, form, left, shared).grid(grid.columns, lists.above);
    }
    if (grid.plot.x < kLeastPlot.x || grid.plot.y < kLeastPlot.y) throwNoRoom(plots.size(), form);
    VectorPage page;
    page.size = form.size.x > 0 ? form.size : grid.size() + glm::dvec2(0, lists.below);
    page.marks.push_back({Rect{.box = {{0, 0}, page.size}, .color = pageInks(form).ground}});
    for (std::size_t i = 0; i < plots.size(); ++i) {
        const Plot& plot = plots[i];
        PlotPlace place = plotPlaceOf(plots, grid, int(i), form);
        place.above += lists.above;
        addPlot(page.marks, plot, place, form);
        if (!form.legend || plot.series.size() < 2 || lists.below > 0) continue;
        if (lists.above > 0) {
            listSeries(plot.series, grid.plot.x, form, {place.box.lo.x, place.box.lo.y - place.above}, &page.marks);
        } else if (lists.within[i]) {
            const double middle = (place.box.lo.x + place.box.hi.x) / 2;
            const bool right = lists.within[i]->lo.x + lists.within[i]->hi.x > 2 * middle + 2;
            listSeries(plot.series, 0, form, lists.within[i]->lo, &page.marks, true, right);
        }
    }
    if (lists.below > 0)
        for (const Plot& plot : plots)
            if (plot.series.size() > 1) {
                listSeries(plot.series, page.size.x - grid.left - grid.right, form,
                           {grid.left, page.size.y - lists.below}, &page.marks);
                break;
            }
    return page;
}

} // namespace tessera::app
