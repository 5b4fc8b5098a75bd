#include "app/values/selection_text.h"

#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "app/values/place_text.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

/// A value of a parameter with its unit; "missing" is said of one that the data lack.
struct BrushedValues {
    BrushedValues(const volume::DatasetInfo& info, const std::string& name, bool whole) {
        const auto channel = info.findChannel(name);
        if (!channel) return;
        there = true;
        const volume::Channel own = info.channel(*channel);
        const Range all = info.channelRange(own);
        unit = own.unit;
        digits = whole ? 0 : (all.hi - all.lo) / 1000;
    }
    std::string number(double value) const { return formatNumber(value, digits); }
    std::string quantity(double value) const { return formatQuantity(value, unit, digits); }

    std::string unit;
    bool there = false;
    double digits = 0;
};

std::string rangeText(const volume::DatasetInfo& info, const vis::RangeRegion& range, bool whole) {
    std::string text;
    for (const vis::BrushInterval& interval : range.intervals) {
        if (!text.empty()) text += ", ";
        const BrushedValues of(info, interval.channel, whole);
        if (!of.there)
            text += interval.channel + " (missing)";
        else
            text +=
                interval.channel + (whole ? " " : "  ") + of.number(interval.lo) + " .. " + of.quantity(interval.hi);
        if (whole && of.there && interval.soft > 0) text += " (soft edge " + of.quantity(interval.soft) + ")";
    }
    return text.empty() ? "everything" : text;
}

/// The soft edge of a shape, which is a share of its size.
std::string softText(double soft) {
    return soft > 0 ? " (soft edge " + formatShare(soft) + " of the radius)" : "";
}

std::string planeText(const volume::DatasetInfo& info, const vis::EllipseRegion& ellipse, bool whole) {
    const std::string text = "ellipse in " + ellipse.x + " \u00d7 " + ellipse.y;
    if (!whole) return text;
    const BrushedValues x(info, ellipse.x, true), y(info, ellipse.y, true);
    return text + ", centre " + x.quantity(ellipse.center.x) + ", " + y.quantity(ellipse.center.y) + ", half widths " +
           x.quantity(ellipse.radius.x) + ", " + y.quantity(ellipse.radius.y) + ", tilt " +
           formatNumber(ellipse.correlation) + softText(ellipse.soft);
}

std::string planeText(const volume::DatasetInfo& info, const vis::LassoRegion& lasso, bool whole) {
    std::string text =
        "lasso in " + lasso.x + " \u00d7 " + lasso.y + ", " + std::to_string(lasso.points.size()) + " corners";
    if (!whole) return text;
    const BrushedValues x(info, lasso.x, true), y(info, lasso.y, true);
    for (std::size_t i = 0; i < lasso.points.size(); ++i)
        text += (i == 0 ? ": " : "; ") + x.quantity(lasso.points[i].x) + ", " + y.quantity(lasso.points[i].y);
    return text + softText(lasso.soft);
}

std::string bodyText(const volume::DatasetInfo& info, const vis::Region& region, bool whole) {
    const auto* const box = std::get_if<vis::BoxRegion>(&region);
    const auto* const sphere = std::get_if<vis::SphereRegion>(&region);
    glm::dvec3 radius = box ? box->radius : sphere->radius;
    if (const volume::AxisMaps& axes = info.lattice.axes; sphere && !axes.isEven()) { // how far it reaches in space
        const vis::SheetBox ball = vis::sheetBox(*sphere, axes);
        radius = (axes.toSpace(ball.center + ball.radius) - axes.toSpace(ball.center - ball.radius)) / 2.0;
    }
    glm::dvec3 lengthsAlone = radius;
    if (const auto time = info.timeAxis()) lengthsAlone[*time] = 0;
    const auto units = axisUnits(info, 2 * std::max({lengthsAlone.x, lengthsAlone.y, lengthsAlone.z}));
    // The unit once, after the last of those that have it in a row.
    const auto unitAfter = [&](std::size_t axis) {
        const bool last = axis == 2 || units[axis].name != units[axis + 1].name;
        return last && !units[axis].name.empty() ? " " + prettyUnit(units[axis].name) : std::string();
    };
    const auto lengths = [&](glm::dvec3 of, double share) {
        std::string text;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double number = of[int(axis)] * units[axis].perUnit;
            text += (axis ? " \u00d7 " : "") + formatNumber(number, number * share) + unitAfter(axis);
        }
        return text;
    };
    std::string text = std::string(box ? "box" : "sphere") + (whole ? " " : "  ");
    if (!whole) return text + lengths(2.0 * radius, 0.02); // two or three digits
    const glm::dvec3 center = box ? box->center : sphere->center;
    text += lengths(2.0 * radius, 0) + " around ";
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool time = info.timeAxis() == int(axis);
        text += (axis ? ", " : "") + (time ? timeWord(info) : std::string(1, "xyz"[axis])) + " " +
                formatNumber(center[int(axis)] * units[axis].perUnit) + unitAfter(axis);
    }
    return text + softText(box ? box->soft : sphere->soft);
}

bool isOne(const std::string& name) { // not a combination of several
    return name.find(" and ") == name.npos && name.find(" or ") == name.npos && name.find(" without ") == name.npos;
}

std::vector<std::size_t> enabledBrushes(const vis::Selection& selection) {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < selection.brushes.size(); ++i)
        if (selection.brushes[i].enabled) out.push_back(i);
    return out;
}

std::string brushName(const vis::Selection& selection, std::size_t i) {
    const std::string& name = selection.brushes[i].name;
    return name.empty() ? "brush " + std::to_string(i + 1) : name;
}

std::string combinedNames(const vis::Selection& selection) {
    return combinedBrushes(selection, [&](std::size_t i) { return brushName(selection, i); });
}

} // namespace

std::string regionText(const volume::DatasetInfo& info, const vis::Region& region, bool whole) {
    if (const auto* range = std::get_if<vis::RangeRegion>(&region)) return rangeText(info, *range, whole);
    if (const auto* ellipse = std::get_if<vis::EllipseRegion>(&region)) return planeText(info, *ellipse, whole);
    if (const auto* lasso = std::get_if<vis::LassoRegion>(&region)) return planeText(info, *lasso, whole);
    if (const auto* lens = std::get_if<vis::LensRegion>(&region))
        return lens->lens.empty() ? "all lenses that mark samples" : "inside the lens " + lens->lens;
    return bodyText(info, region, whole);
}

std::string combinedBrushes(const vis::Selection& selection, const std::function<std::string(std::size_t)>& nameOf) {
    static constexpr const char* kWords[] = {" and ", " or ", " without "};
    std::string text;
    int count = 0;
    for (const std::size_t i : enabledBrushes(selection)) {
        const vis::Brush& brush = selection.brushes[i];
        if (count > 1) text = "(" + text + ")";
        // The first brush combines with all samples, so that "minus" inverts it.
        const bool inverted = brush.inverted != (count == 0 && brush.combine == vis::BrushCombine::Minus);
        const std::string own = (inverted ? "not " : "") + nameOf(i);
        text = count > 0 ? text + kWords[static_cast<std::size_t>(brush.combine)] + own : own;
        ++count;
    }
    return text;
}

std::string selectionName(const Session& session) {
    const vis::Selection& selection = session.selection;
    if (!selection.active()) {
        std::string names;
        for (const vis::Lens& lens : session.lenses)
            if (vis::marksAt(lens, session.time)) names += (names.empty() ? "lens " : ", ") + lens.name;
        return names;
    }
    if (enabledBrushes(selection).size() > 1 && !selection.name.empty()) return selection.name;
    return combinedNames(selection);
}

std::string restName(const std::string& selectionName) {
    if (isOne(selectionName))
        return selectionName.starts_with("not ") ? selectionName.substr(4) : "not " + selectionName;
    return "not (" + selectionName + ")";
}

void nameSelection(Session& session, const std::string& name) {
    const std::vector<std::size_t> enabled = enabledBrushes(session.selection);
    if (enabled.size() == 1)
        session.selection.brushes[enabled.front()].name = name;
    else
        session.selection.name = name;
}

std::vector<std::string> selectionNotes(const Session& session, const volume::DatasetInfo& info) {
    const vis::Selection& selection = session.selection;
    const std::string name = selectionName(session);
    if (name.empty()) return {};
    const std::vector<std::size_t> enabled = enabledBrushes(selection);
    if (enabled.empty()) return {"selection \"" + name + "\": what lies inside"};
    const auto definition = [&](std::size_t i) { return regionText(info, selection.brushes[i].region, true); };
    if (enabled.size() == 1) {
        const vis::Brush& brush = selection.brushes[enabled.front()];
        const bool inverted = brush.inverted != (brush.combine == vis::BrushCombine::Minus);
        return {"selection \"" + name + "\": " + (inverted ? "all but " : "") + definition(enabled.front())};
    }
    std::vector<std::string> notes{"selection \"" + name + "\"" +
                                   (selection.name.empty() ? "" : ": " + combinedNames(selection))};
    for (const std::size_t i : enabled) notes.push_back("brush \"" + brushName(selection, i) + "\": " + definition(i));
    return notes;
}

void sayWeighted(TableColumn& samples) {
    const auto isWhole = [](double number) { return std::isnan(number) || number == std::round(number); };
    if (std::ranges::all_of(samples.numbers, isWhole)) return;
    samples.name = samples.name == "samples" ? "weightedSamples" : "weighted " + samples.name;
    if (!samples.head.empty()) samples.head = "Weighted samples";
    samples.kind = NumberKind::Plain;
    samples.resolutions.assign(samples.numbers.size(), 0.1);
}

} // namespace tessera::app
