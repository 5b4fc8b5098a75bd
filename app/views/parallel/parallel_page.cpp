#include "app/views/parallel/parallel_page.h"

#include "app/pages/plot_marks.h"
#include "app/pane/plot.h"
#include "app/values/selection_text.h"
#include "volume/base/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::app {

using namespace shapes;

namespace {

constexpr glm::dvec2 kNaturalGap{92, 190}; ///< between two axes, points
constexpr double kPixelsPerPoint = 3;      ///< of the pictures between axes
constexpr double kThinLine = 0.7, kWideLine = 1.4, kLeastGap = 9;

glm::vec4 inked(glm::vec3 color, float alpha = 1) {
    return {color, alpha};
}

constexpr double kLongestUpright = 9; ///< of a title that reads upwards, sizes of text

/// The title of an axis in two parts: its name, and what its numbers mean nothing without.
struct PageTitle {
    std::string name, rest;
    std::string whole() const { return rest.empty() ? name : name + " " + rest; }
};
PageTitle pageTitle(const ParallelAxis& axis, const std::string& note, const PageForm& form) {
    ParallelAxis captioned = axis;
    captioned.channel.name = captionOf(form.figure, axis.channel.name);
    const std::string whole = axisTitle(captioned, note);
    const std::size_t length = captioned.channel.name.size();
    return {captioned.channel.name, whole.size() > length ? whole.substr(length + 1) : ""};
}

/// Whether titles in two lines are wider than the gap between axes.
bool titlesAreWide(const ParallelPlot& plot, const PageForm& form) {
    if (plot.axes.size() < 2) return false;
    const double room = double(plot.gap()) - 4 * form.text / kFigureText;
    return std::ranges::any_of(plot.axes, [&](const ParallelAxis& axis) {
        const PageTitle title = pageTitle(axis, axisTicks(axis, form.text * 1.1).note, form);
        return std::max(pageTextWidth(title.name, form.text), pageTextWidth(title.rest, form.text)) > room;
    });
}

/// One state on a page; its axes have their places.
class ParallelMarks {
public:
    /// `upright`: length of titles that read upwards; 0: they stand in one line or two.
    ParallelMarks(const ParallelState& state, const ParallelPlot& plot, const ParallelPageLook& look,
                  const PageForm& form, double upright, VectorPage& page)
        : state_(state), plot_(plot), look_(look), form_(form), inks_(pageInks(form)), text_(form.text),
          scale_(form.text / kFigureText), upright_(upright), width_(page.size.x), out_(page.marks) {}

    /// `top`: of the part of the page that is its own.
    void draw(std::size_t index, double top) {
        pictures();
        if (look_.histograms) histograms();
        for (std::size_t i = 0; i < plot_.axes.size(); ++i) axis(i);
        for (std::size_t i = 0; form_.outlines && i < plot_.axes.size(); ++i) brushes(plot_.axes[i]);
        if (form_.cursor && index < look_.cursor.size()) cursor(look_.cursor[index]);
        if (!state_.name.empty() && form_.title) words({text_, top + 1.2 * text_}, state_.name, 0);
    }

private:
    void words(glm::dvec2 at, const std::string& what, double anchor, bool onPicture = false) {
        if (what.empty()) return;
        out_.push_back({Words{.text = what,
                              .at = at,
                              .size = text_,
                              .color = onPicture && !form_.dark ? glm::vec4(0.133f, 0.133f, 0.133f, 1) : inks_.text,
                              .anchor = anchor,
                              .halo = onPicture && !form_.dark ? 1.8 : 0}});
    }
    void line(glm::dvec2 a, glm::dvec2 b, glm::vec4 color, double width) {
        out_.push_back({Stroke{.points = {a, b}, .width = width * scale_, .color = color}});
    }
    double bottom() const { return double(std::max(plot_.axes.front().bottom, plot_.markBottom)); }

    void pictures() {
        if (plot_.axes.size() < 2) return;
        const ParallelAxis& first = plot_.axes.front();
        const glm::ivec2 size(std::clamp(int(double(plot_.gap()) * kPixelsPerPoint), 2, 2048),
                              std::clamp(int((bottom() - double(first.top)) * kPixelsPerPoint), 2, 2048));
        const PlotDensities densities = plotDensities(plot_, state_.result->densities, size.x, size.y);
        std::vector<ImU32> focus;
        for (const glm::vec3& color : look_.focus)
            focus.push_back(ImGui::ColorConvertFloat4ToU32({color.x, color.y, color.z, 1}));
        GapLook look = gapLook(look_.logDensity, form_.dark, focus);
        look.most = densities.most;
        const int bins = state_.result->densities.bins;
        const double rows = double(first.bottom - first.top) * kPixelsPerPoint;
        look.unit = rows * binsTogether(bins, rows) / bins;
        for (std::size_t g = 0; g < densities.gaps.size(); ++g)
            out_.push_back(
                {Picture{.box = {{double(plot_.axes[g].x), double(first.top)}, {double(plot_.axes[g + 1].x), bottom()}},
                         .image = {size, gapPixels(densities.gaps[g], look), 0},
                         .smooth = true}});
    }
    void histograms() {
        const int bins = state_.result->densities.bins;
        const double widest = double(histogramLength(plot_, float(text_)));
        for (std::size_t a = 0; a < plot_.axes.size(); ++a) {
            const volume::PlaceCounts& counts = state_.result->densities.axes[a];
            double most = 1;
            for (int bin = 0; bin < bins; ++bin) most = std::max(most, double(counts.all[std::size_t(bin)]));
            const auto length = [&](double count) {
                return widest * (look_.logDensity ? std::log1p(count) / std::log1p(most) : count / most);
            };
            std::vector<double> from(std::size_t(bins), 0), to = from;
            for (std::size_t bin = 0; bin < to.size(); ++bin) to[bin] = length(double(counts.all[bin]));
            bars(a, from, to, {0.53f, 0.57f, 0.64f, 0.6f});
            for (std::size_t g = 0; g < counts.selected.size(); ++g) {
                for (std::size_t bin = 0; bin < to.size(); ++bin) {
                    const double selected = counts.selectedAt(bin);
                    to[bin] = from[bin];
                    if (selected > 0) to[bin] += length(selected) * counts.selected[g][bin] / selected;
                }
                bars(a, from, to, inked(look_.focus[std::min(g, look_.focus.size() - 1)]));
                from = to;
            }
        }
    }
    /// Bars beside an axis as one area for each run of bins that have some.
    void bars(std::size_t a, const std::vector<double>& from, const std::vector<double>& to, glm::vec4 color) {
        const ParallelAxis& own = plot_.axes[a];
        const auto bins = int(to.size());
        for (int bin = 0; bin < bins;) {
            std::vector<glm::dvec2> out, back;
            for (; bin < bins && to[std::size_t(bin)] > from[std::size_t(bin)]; ++bin) {
                const Range rows = *placeRows(plot_.rows(a), bins, bin);
                for (const double row : own.flipped ? std::array{rows.lo, rows.hi} : std::array{rows.hi, rows.lo}) {
                    out.emplace_back(double(own.x) + to[std::size_t(bin)], double(own.top) + row);
                    back.emplace_back(double(own.x) + from[std::size_t(bin)], double(own.top) + row);
                }
            }
            out.insert(out.end(), back.rbegin(), back.rend());
            if (!out.empty()) out_.push_back({Polygon{.points = std::move(out), .color = color}});
            while (bin < bins && !(to[std::size_t(bin)] > from[std::size_t(bin)])) ++bin;
        }
    }
    void brushes(const ParallelAxis& own) {
        for (const ParallelBand& band : look_.brushed) {
            if (band.channel != own.channel.name) continue;
            const double a = double(own.pixel(band.range.lo)), b = double(own.pixel(band.range.hi));
            const double top = std::clamp(std::min(a, b), double(own.top), double(own.bottom)),
                         bottom = std::clamp(std::max(a, b), double(own.top), double(own.bottom)), half = 0.35 * text_;
            const glm::vec4 color = inked(form_.dark ? band.color : band.color * kBrightOnWhite);
            out_.push_back({Rect{.box = {{double(own.x) - half, top}, {double(own.x) + half, bottom}},
                                 .color = color,
                                 .line = kWideLine * scale_}});
            if (band.taken) line({double(own.x) - half, bottom}, {double(own.x) + half, top}, color, kThinLine);
        }
    }
    void axis(std::size_t i) {
        const ParallelAxis& own = plot_.axes[i];
        const double x = double(own.x), tick = 3 * scale_;
        line({x, double(own.top)}, {x, double(own.bottom)}, inks_.frame, kThinLine);
        if (form_.axes) {
            const TickLabels ticks = axisTicks(own, text_ * 1.1);
            for (std::size_t t = 0; t < ticks.values.size(); ++t) {
                const double y = double(own.pixel(ticks.values[t]));
                line({x - tick, y}, {x, y}, inks_.frame, kThinLine);
                const double room = i == 0 ? x - tick - 2 * scale_ : double(plot_.gap()) * 0.45;
                if (pageTextWidth(ticks.texts[t], text_) <= room)
                    words({x - tick - 2 * scale_, y + text_ * kMiddle}, ticks.texts[t], 1, i > 0);
            }
            title(i, ticks.note);
        }
        if (!plot_.hasMarks()) return;
        line({x, double(plot_.markTop)}, {x, double(plot_.markBottom)}, inks_.frame, kThinLine);
        out_.push_back({Circle{
            .center = {x, double(plot_.markAt())}, .radius = 2 * scale_, .color = inks_.frame, .line = kThinLine}});
        if (i == 0 && form_.axes && pageTextWidth("absent", text_) <= x - 5 * scale_)
            words({x - 5 * scale_, double(plot_.markAt()) + text_ * kMiddle}, "absent", 1);
    }
    void title(std::size_t i, const std::string& note) {
        const ParallelAxis& own = plot_.axes[i];
        const PageTitle shown = pageTitle(own, note, form_);
        const double x = double(own.x), top = double(own.top) - 0.6 * text_;
        if (upright_ > 0) {
            out_.push_back({Words{.text = fittedTitle(shown, upright_),
                                  .at = {x + text_ * kMiddle, top},
                                  .size = text_,
                                  .color = inks_.text,
                                  .angle = -90}});
            return;
        }
        const double gap = plot_.axes.size() > 1 ? double(plot_.gap()) : 30 * text_;
        const double room = std::min(gap, 2 * std::min(x, width_ - x)) - 4 * scale_; // ends on the page
        if (pageTextWidth(shown.whole(), text_) <= room) return words({x, top}, shown.whole(), 0.5);
        words({x, top - 1.1 * text_}, fittedWords(shown.name, room), 0.5);
        words({x, top}, shown.rest, 0.5);
    }
    std::string fittedTitle(const PageTitle& title, double room) const {
        const double rest = title.rest.empty() ? 0 : pageTextWidth(" " + title.rest, text_);
        const std::string name = fittedWords(title.name, room - rest);
        return title.rest.empty() ? name : name + " " + title.rest;
    }
    std::string fittedWords(std::string name, double room) const {
        std::string cut = name;
        while (!name.empty() && pageTextWidth(cut, text_) > room) {
            while (name.size() > 1 && (name.back() & 0xc0) == 0x80) name.pop_back(); // a whole letter of UTF-8
            name.pop_back();
            cut = name + "...";
        }
        return cut;
    }
    void cursor(const std::vector<std::optional<double>>& values) {
        for (std::size_t i = 0; i < plot_.axes.size() && i < values.size(); ++i) {
            const auto at = [&](std::size_t a) {
                const double y = values[a] ? double(plot_.axes[a].pixel(*values[a])) : double(plot_.markAt());
                return glm::dvec2(double(plot_.axes[a].x), y);
            };
            const bool onward = i + 1 < plot_.axes.size() && i + 1 < values.size();
            if (onward && (values[i] || values[i + 1]) && (plot_.hasMarks() || (values[i] && values[i + 1])))
                line(at(i), at(i + 1), inks_.cursor, kWideLine);
            if (values[i] && plot_.axes[i].shows(*values[i]))
                out_.push_back({Circle{.center = at(i), .radius = 2 * scale_, .color = inks_.cursor}});
        }
    }

    const ParallelState& state_;
    const ParallelPlot& plot_;
    const ParallelPageLook& look_;
    const PageForm& form_;
    PageInks inks_;
    double text_, scale_, upright_, width_;
    std::vector<Mark>& out_;
};

/// Room behind the last axis: for its histogram and half its title.
double lastRoom(const ParallelAxis& axis, bool histograms, bool upright, const PageForm& form) {
    if (upright) return 1.5 * form.text;
    const PageTitle title = pageTitle(axis, axisTicks(axis, form.text * 1.1).note, form);
    const double half = std::max(pageTextWidth(title.name, form.text), pageTextWidth(title.rest, form.text)) / 2;
    return std::max(std::min(half, 5 * form.text), (histograms ? 3.8 : 1.0) * form.text) + 0.3 * form.text;
}

double widestNumber(const ParallelAxis& axis, double text) {
    double widest = pageTextWidth("absent", text);
    for (const std::string& each : axisTicks(axis, text * 1.1).texts)
        widest = std::max(widest, pageTextWidth(each, text));
    return widest;
}

} // namespace

VectorPage parallelPage(const std::vector<ParallelState>& states, const ParallelPageLook& look, const PageForm& form) {
    VectorPage page;
    const auto axes = states.front().axes.size();
    const double text = form.text, scale = text / kFigureText, named = states.size() > 1 ? 1.4 * text : 0;
    const double gaps = std::max<double>(1, double(axes) - 1);
    page.size = form.size;
    if (page.size.x <= 0)
        page.size = {kNaturalGap.x * scale * gaps + 12 * text,
                     (kNaturalGap.y * scale + 4 * text) * double(states.size())};
    page.marks.push_back({Rect{.box = {{0, 0}, page.size}, .color = pageInks(form).ground}});
    const double each = page.size.y / double(states.size());
    for (std::size_t s = 0; s < states.size(); ++s) {
        ParallelPlot plot{.axes = states[s].axes};
        const double bottom = each * double(s + 1);
        const bool marks = lacksAny(states[s].result->densities);
        double upright = 0;
        const auto placed = [&](double above) {
            const double top = each * double(s) + named + above;
            for (ParallelAxis& axis : plot.axes) axis.top = 0, axis.bottom = float(std::max(1.0, bottom - top));
            double numbers = std::max(form.axes ? widestNumber(plot.axes.front(), text) + 9 * scale : 0, 2.5 * text);
            if (upright > 0) numbers = std::min(numbers, 0.3 * page.size.x);
            const double right = lastRoom(plot.axes.back(), look.histograms, upright > 0, form);
            placeAxes(plot, {0, float(top)}, {float(page.size.x), float(bottom)}, marks, float(numbers), float(right),
                      float(text * 1.1));
            return bottom - top;
        };
        double height = placed(3.2 * text);
        if (form.axes && titlesAreWide(plot, form)) {
            double longest = 0;
            for (const ParallelAxis& axis : plot.axes)
                longest = std::max(
                    longest, pageTextWidth(pageTitle(axis, axisTicks(axis, text * 1.1).note, form).whole(), text));
            upright = std::min({longest, kLongestUpright * text, 0.4 * each});
            height = placed(upright + 1.2 * text);
        }
        const double gap = axes > 1 ? double(plot.gap()) : page.size.x;
        if (gap < kLeastGap * scale || height < 4 * text)
            throw Error("the texts leave no room for " + std::to_string(axes) + " axes on a page of this size");
        ParallelMarks(states[s], plot, look, form, upright, page).draw(s, each * double(s));
    }
    return page;
}

namespace {

/// The ends of what a place of an axis stands for; NaN where it has none.
Range placeEnds(const volume::DensityAxis& axis, int bins, int place) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    if (place == volume::belowPlace(bins)) return {kNone, axis.range.lo};
    if (place == volume::abovePlace(bins)) return {axis.range.hi, kNone};
    if (place >= bins) return {kNone, kNone};
    return {volume::axisValue(axis, double(place) / bins), volume::axisValue(axis, double(place + 1) / bins)};
}

} // namespace

Table parallelTable(const std::vector<ParallelState>& states, const volume::DatasetInfo& info,
                    const std::string& selected) {
    Table table{.columns = {{.name = "left parameter"},
                            {.name = "left unit"},
                            {.name = "left from"},
                            {.name = "left to"},
                            {.name = "right parameter"},
                            {.name = "right unit"},
                            {.name = "right from"},
                            {.name = "right to"},
                            {.name = "samples"}}};
    if (!selected.empty()) table.columns.push_back({.name = "samples in " + selected});
    TableColumn times{.name = info.timeName, .unit = info.timeUnit};
    for (const ParallelState& state : states) {
        const volume::AxisDensities& densities = state.result->densities;
        const std::size_t places = volume::placesOf(densities.bins);
        for (std::size_t g = 0; g < densities.gaps.size(); ++g)
            for (std::size_t i = 0; i < densities.gaps[g].all.size(); ++i) {
                if (densities.gaps[g].all[i] == 0) continue;
                std::size_t column = 0;
                for (const bool right : {false, true}) {
                    const ParallelAxis& axis = state.axes[g + (right ? 1 : 0)];
                    const Range ends =
                        placeEnds(axis.density, densities.bins, static_cast<int>(right ? i % places : i / places));
                    table.columns[column++].texts.push_back(axis.channel.name);
                    table.columns[column++].texts.push_back(axis.channel.unit);
                    table.columns[column++].numbers.push_back(ends.lo);
                    table.columns[column++].numbers.push_back(ends.hi);
                }
                table.columns[column++].numbers.push_back(double(densities.gaps[g].all[i]));
                if (!selected.empty()) table.columns[column].numbers.push_back(densities.gaps[g].selectedAt(i));
                times.numbers.push_back(state.time);
            }
    }
    if (!selected.empty()) sayWeighted(table.columns.back());
    if (states.size() > 1) table.columns.insert(table.columns.begin(), std::move(times));
    if (std::ranges::any_of(states, [](const ParallelState& state) { return state.result->densities.level > 0; }))
        table.notes.push_back("estimated from a coarser level");
    table.notes.push_back("ends of bins are empty where samples lack the parameter; one end, where they lie beyond it");
    return table;
}

} // namespace tessera::app
