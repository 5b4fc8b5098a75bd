#include "app/planes/plane_export.h"

#include "app/pages/plot_marks.h"
#include "app/pages/plot_page.h"
#include "app/pane/legend.h"
#include "app/planes/contour_labels.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "volume/reconstruct/probe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <memory>
#include <numbers>

namespace tessera::app {

namespace {

constexpr int kPageCells = 96, kMostCells = 512; ///< along an edge of a picture
constexpr double kCellsPerPoint = 2;             ///< where the size of the page is given
constexpr glm::vec4 kEdgeOnLight{0.267f, 0.267f, 0.267f, 1}, kEdgeOnDark{0.733f, 0.733f, 0.733f, 1};

/// Places of uneven axes come from their sheet, which leaves the last digits of their ends open.
bool inside(const volume::DatasetInfo& info, glm::dvec3 place) {
    const volume::Box& box = info.bounds;
    for (int axis = 0; axis < 3; ++axis) {
        const double slack = info.lattice.axes[axis] ? 1e-12 * box.size()[axis] : 0;
        if (place[axis] < box.lo[axis] - slack || place[axis] > box.hi[axis] + slack) return false;
    }
    return true;
}

bool hasLabels(const volume::DatasetInfo& info, int channel) {
    return info.parameters[static_cast<std::size_t>(info.channel(channel).parameter)].categorical;
}

/// Places along a row of a grid over the whole picture; `shareX` and `shareY` of its edges, from the lower left.
template <class ShareX>
std::vector<glm::dvec3> rowOf(const PlanePicture& picture, int count, const ShareX& shareX, double shareY) {
    std::vector<glm::dvec3> row;
    for (int i = 0; i < count; ++i)
        row.push_back(picture.placeAt(
            {std::lerp(picture.x.lo, picture.x.hi, shareX(i)), std::lerp(picture.y.lo, picture.y.hi, shareY)}));
    return row;
}

/// The colours of the parameter in cells; clear where values are absent.
PlotImage cellImage(const volume::BrickSource& source, const PlanePicture& picture, glm::ivec2 cells,
                    const Progress& progress) {
    PlotImage image{cells.x, cells.y, {}};
    const auto across = [&](int i) { return (i + 0.5) / cells.x; };
    for (int j = cells.y - 1; j >= 0; --j) {
        progress.advance(1 - (j + 1.0) / cells.y);
        const std::vector<glm::dvec3> row = rowOf(picture, cells.x, across, (j + 0.5) / cells.y);
        const auto values = volume::probeAlong(source, picture.shows.channel, row, picture.time);
        for (std::size_t i = 0; i < row.size(); ++i) {
            const bool shown = values[i].interpolated && inside(source.info(), row[i]);
            const glm::dvec4 color =
                shown ? vis::evaluate(picture.function, picture.range, *values[i].interpolated) : glm::dvec4(0);
            for (int k = 0; k < 3; ++k)
                image.rgba.push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(color[k], 0.0, 1.0))));
            image.rgba.push_back(shown ? 255 : 0);
        }
    }
    return image;
}

/// Contour lines, broken beneath the values written on them; `size`: of the plot on the page, points, `text` of texts.
void addLines(Plot& plot, const Contours& contours, const PlanePicture& picture, glm::dvec2 size, double text) {
    // Placed in points, as the page has them, and kept in the units of the axes.
    const glm::dvec2 from(plot.x.range.lo, plot.y.range.lo),
        span(plot.x.range.hi - plot.x.range.lo, plot.y.range.hi - plot.y.range.lo);
    if (!(span.x > 0) || !(span.y > 0) || !(size.x > 0) || !(size.y > 0)) return;
    std::vector<PageLine> lines;
    for (const volume::ContourLine& line : contours.lines) {
        PageLine& own = lines.emplace_back(PageLine{contourText(line.level, picture.levels.step), {}});
        for (const glm::dvec2& point : line.points) {
            const glm::dvec2 share = (point * picture.perUnit() - from) / span;
            own.points.emplace_back(share.x * size.x, (1 - share.y) * size.y);
        }
    }
    const auto data = [&](glm::dvec2 at) { return from + glm::dvec2(at.x / size.x, 1 - at.y / size.y) * span; };
    std::vector<LineLabel> labels;
    if (picture.shows.lines.values)
        labels = placeLabels(lines,
                             {{0, 0}, size, text, [&](const std::string& word) { return pageTextWidth(word, text); }});
    for (const LineLabel& label : labels)
        plot.labels.push_back({label.text, data(label.at), label.angle * 180 / std::numbers::pi});
    for (const std::vector<glm::dvec2>& piece : linesAround(lines, labels)) {
        plot.contours.emplace_back();
        for (const glm::dvec2& point : piece) plot.contours.back().push_back(data(point));
    }
}

/// The edge of the data in a tilted plane, lenses and brushes.
void addOutlines(Plot& plot, const PlanePicture& picture, bool dark) {
    const glm::dvec2 perUnit = picture.perUnit();
    if (!picture.axes) {
        PlotOutline& edge =
            plot.outlines.emplace_back(PlotOutline{.points = {}, .color = dark ? kEdgeOnDark : kEdgeOnLight});
        for (const glm::dvec3& corner : picture.corners) edge.points.push_back(picture.along(corner) * perUnit);
    }
    for (const PlaneSection& section : picture.sections) {
        PlotOutline& outline = plot.outlines.emplace_back();
        for (const glm::dvec2& point : section.outline) outline.points.push_back(point * perUnit);
        outline.color = glm::vec4(section.color * (dark ? 1 : kBrightOnWhite), section.faint ? 0.35f : 1.0f);
        outline.dashed = section.dashed;
        if (section.middle) outline.dot = *section.middle * perUnit;
    }
}

/// The picture as a plot without its contour lines, which its title tells of.
Plot plotOf(const volume::DatasetInfo& info, const PlanePicture& picture, bool dark) {
    const volume::Channel own = info.channel(picture.shows.channel);
    const auto& [lo, hi] = picture.range;
    const double digits = (hi - lo) / 100;
    const std::string colors =
        own.name + " " + formatNumber(lo, digits) + " .. " + formatQuantity(hi, own.unit, digits);
    const auto [right, up] = axisTexts(picture);
    Plot plot;
    plot.title = picture.axes ? picture.place + ", " + colors : colors;
    if (picture.ownTime) plot.title = timeText(info, *picture.ownTime) + ", " + plot.title;
    plot.note = picture.axes ? "" : picture.place;
    const auto axisOf = [](const std::string& title, Range range, const AxisLabel& label) {
        return PlotAxis{.title = title,
                        .range = range,
                        .numbered = !label.blank,
                        .unit = label.blank ? "" : label.unit.name,
                        .scale = label.scale()};
    };
    plot.x = axisOf(right, picture.shownX(), picture.right);
    plot.y = axisOf(up, picture.shownY(), picture.up);
    if (const std::string uneven = unevenText(picture); !uneven.empty()) // a picture that is not to scale says so
        plot.note += (plot.note.empty() ? "" : "; ") + uneven;
    if (picture.cursor) {
        plot.cursorX = picture.cursor->x * picture.right.unit.perUnit;
        plot.cursorY = picture.cursor->y * picture.up.unit.perUnit;
    }
    addOutlines(plot, picture, dark);
    if (!picture.lined) return plot;
    // Below the title, or behind it where something else stands there.
    const std::string text = contourTitle(info.channel(*picture.lined), picture.levels);
    plot.note.empty() ? plot.note = text : plot.title += "; " + text;
    return plot;
}

/// Columns of numbers: along the picture, of the position, and of each channel.
struct PlaneColumns {
    std::vector<double> times;
    std::vector<std::string> planes;
    std::array<std::vector<double>, 2> along;
    std::array<std::vector<double>, 3> position;
    std::vector<double> follows; ///< in a plane in space and time: the axis that it is solved for
    std::vector<std::vector<double>> values;
};

void addSamples(PlaneColumns& columns, const volume::BrickSource& source, const PlanePicture& picture,
                const std::vector<int>& channels, const Progress& progress) {
    // The last ones lie on the border exactly: beyond it there are no values.
    const auto node = [&](int axis) { return [n = picture.cells[axis]](int i) { return i / (n - 1.0); }; };
    for (int j = 0; j < picture.cells.y; ++j) {
        progress.advance(static_cast<double>(j) / picture.cells.y);
        std::vector<glm::dvec3> row = rowOf(picture, picture.cells.x, node(0), node(1)(j));
        std::erase_if(row, [&](glm::dvec3 place) { return !inside(source.info(), place); });
        if (row.empty()) continue;
        for (const glm::dvec3& place : row) {
            columns.times.push_back(picture.ownTime.value_or(std::nan("")));
            columns.planes.push_back(picture.place);
            for (int k = 0; k < 2; ++k)
                columns.along[std::size_t(k)].push_back((k == 0 ? picture.right : picture.up)
                                                            .scale()
                                                            .number(picture.along(place)[k] * picture.perUnit()[k]));
            for (int k = 0; k < 3; ++k)
                columns.position[std::size_t(k)].push_back(place[k] * picture.positions[std::size_t(k)].unit.perUnit);
            if (const auto& cut = source.info().plane) columns.follows.push_back(cut->pointAt(place)[cut->solved]);
        }
        for (std::size_t c = 0; c < channels.size(); ++c)
            for (const volume::ProbeValue& value : volume::probeAlong(source, channels[c], row, picture.time))
                columns.values[c].push_back(value.interpolated.value_or(std::nan("")));
    }
}

} // namespace

VectorPage planesPage(const volume::BrickSource& source, const std::vector<PlanePicture>& pictures, int columns,
                      const PageForm& form, const Progress& progress) {
    std::vector<Plot> plots;
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        plots.push_back(plotOf(source.info(), pictures[i], form.dark));
        const int channel = pictures[i].shows.channel, next = static_cast<int>(i) + 1;
        const bool last = next % columns == 0 || next == static_cast<int>(pictures.size()) || // of those in a row
                          pictures[i + 1].shows.channel != channel;
        if (last && !hasLabels(source.info(), channel))
            plots.back().key = colorKey(pictures[i].function, pictures[i].range);
    }
    const glm::dvec2 size = plotArea(plots, columns, form);
    const glm::ivec2 cells =
        glm::clamp(form.size.x > 0 ? glm::ivec2(size * kCellsPerPoint) : glm::ivec2(0), kPageCells, kMostCells);
    const double each = 1.0 / static_cast<double>(std::max<std::size_t>(1, pictures.size()));
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        const PlanePicture& picture = pictures[i];
        const Progress own = progress.part(static_cast<double>(i) * each, static_cast<double>(i + 1) * each);
        plots[i].image = cellImage(source, picture, cells, own.part(0, picture.lined ? 0.5 : 1));
        if (picture.lined)
            addLines(plots[i], readContours(source, contourQuery(picture), own.part(0.5, 1)), picture, size, form.text);
    }
    return plotPage(plots, columns, form);
}

Table planesTable(const volume::BrickSource& source, const std::vector<PlanePicture>& pictures,
                  const std::vector<int>& channels, const Progress& progress) {
    std::vector<const PlanePicture*> planes;
    for (const PlanePicture& picture : pictures)
        if (std::ranges::none_of(planes, [&](const auto* other) {
                return other->plane == picture.plane && other->ownTime == picture.ownTime;
            }))
            planes.push_back(&picture);
    PlaneColumns columns;
    columns.values.resize(channels.size());
    for (std::size_t i = 0; i < planes.size(); ++i) {
        const double count = static_cast<double>(planes.size()), done = static_cast<double>(i);
        addSamples(columns, source, *planes[i], channels, progress.part(done / count, (done + 1) / count));
    }
    Table table{.columns = {}, .notes = {"values: interpolated between the samples"}};
    const auto parallel = [&](const PlanePicture* other) {
        return other->plane.right == planes.front()->plane.right && other->plane.up == planes.front()->plane.up;
    };
    if (std::ranges::any_of(planes, [](const PlanePicture* picture) { return picture->ownTime.has_value(); }))
        table.columns.push_back(
            {.name = source.info().timeName, .unit = source.info().timeUnit, .numbers = std::move(columns.times)});
    if (!std::ranges::all_of(planes, parallel)) // of parallel ones the position tells which it is
        table.columns.push_back({.name = "plane", .texts = std::move(columns.planes)});
    for (const PlanePicture* picture : planes) {
        if (picture->axes) continue;
        table.notes.push_back("u = " + directionText(picture->plane.right) +
                              ", v = " + directionText(picture->plane.up));
        // Along a direction across uneven axes there are no lengths: the positions tell the places.
        if (!picture->right.blank)
            table.columns.push_back({.name = "u", .unit = picture->right.unit.name, .numbers = columns.along[0]});
        if (!picture->up.blank)
            table.columns.push_back({.name = "v", .unit = picture->up.unit.name, .numbers = columns.along[1]});
        break;
    }
    for (std::size_t axis = 0; axis < 3 && !planes.empty(); ++axis) {
        const AxisLabel& label = planes.front()->positions[axis];
        table.columns.push_back(
            {.name = label.name, .unit = label.unit.name, .numbers = std::move(columns.position[axis])});
    }
    if (const auto& cut = source.info().plane)
        table.columns.push_back(
            {.name = cut->hasTimeAxis() ? std::string(1, "xyz"[cut->solved]) : timeWord(source.info()),
             .unit = cut->hasTimeAxis() ? source.info().lengthUnit : source.info().timeUnit,
             .numbers = std::move(columns.follows)});
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const volume::Channel own = source.info().channel(channels[c]);
        table.columns.push_back({.name = own.name, .unit = own.unit, .numbers = std::move(columns.values[c])});
    }
    return table;
}

void exportPlanes(ViewContext& context, ToolRow& tools, const std::string& name, std::vector<PlanePicture> pictures,
                  int columns, std::vector<int> channels) {
    const auto source = context.numbers;
    for (const PlanePicture& picture : pictures) // what is seen is in the table, too
        if (std::ranges::find(channels, picture.shows.channel) == channels.end())
            channels.push_back(picture.shows.channel);
    const bool ownTimes =
        std::ranges::any_of(pictures, [](const PlanePicture& each) { return each.ownTime.has_value(); });
    const auto shown = std::make_shared<const std::vector<PlanePicture>>(std::move(pictures));
    exportMenu(context, tools,
               {.name = name,
                .figure =
                    [source, shown, columns](const PageForm& form, const Progress& progress) {
                        return planesPage(*source, *shown, columns, form, progress);
                    },
                .whole = false,
                .table = [source, shown, channels = std::move(channels)](
                             const Progress& progress) { return planesTable(*source, *shown, channels, progress); }},
               !ownTimes);
}

} // namespace tessera::app
