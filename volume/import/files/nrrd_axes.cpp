#include "volume/import/files/nrrd_axes.h"

#include "volume/base/error.h"
#include "volume/base/unit_conversion.h"
#include "volume/import/files/import_limits.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <sstream>
#include <utility>

namespace tessera::volume {

namespace {

using Along = StoredAxis::Along;

constexpr std::size_t kMostChannels = 16; ///< entries of a list that become parameters of their own

std::string smallLetters(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

std::vector<std::string> blankSeparated(const std::string& text) {
    std::istringstream in(text);
    std::vector<std::string> out;
    for (std::string word; in >> word;) out.push_back(word);
    return out;
}

bool isTimeUnit(const std::string& unit) {
    return !unit.empty() && unitConversion(unit, "s").has_value();
}

/// "axis 3 index values:=0 0.5 1" of 3D Slicer's sequences.
std::string indexPair(const NrrdHeader& header, std::size_t axis, const char* what) {
    const auto at = header.pairs.find("axis " + std::to_string(axis) + " index " + what);
    return at == header.pairs.end() ? std::string() : at->second;
}

std::vector<double> axisNumbers(const NrrdHeader& header, const char* field, std::size_t count) {
    std::vector<double> stated = nrrdNumbers(header.field(field), field);
    stated.resize(count, std::numeric_limits<double>::quiet_NaN());
    return stated;
}

std::vector<NrrdAxis> statedAxes(const NrrdHeader& header) {
    const std::vector<double> sizes = nrrdNumbers(header.field("sizes"), "sizes");
    const std::vector<double> dimension = nrrdNumbers(header.field("dimension"), "dimension");
    const std::size_t count = sizes.size();
    if (count == 0) throw Error("is missing", {}, "sizes");
    if (count > 16 || (!dimension.empty() && dimension[0] != double(count)))
        throw Error("are " + std::to_string(count) + ", which is not the dimension", {}, "sizes");
    const std::vector<double> spacings = axisNumbers(header, "spacings", count),
                              thicknesses = axisNumbers(header, "thicknesses", count),
                              mins = axisNumbers(header, "axismins", count),
                              maxs = axisNumbers(header, "axismaxs", count);
    std::vector<std::string> kinds = blankSeparated(header.field("kinds")),
                             centers = blankSeparated(header.field("centerings")),
                             labels = nrrdWords(header.field("labels")), units = nrrdWords(header.field("units"));
    auto directions = nrrdVectors(header.field("spacedirections"), "space directions");
    for (std::vector<std::string>* words : {&kinds, &centers, &labels, &units}) words->resize(count);
    directions.resize(count);
    std::vector<NrrdAxis> axes(count);
    for (std::size_t a = 0; a < count; ++a) {
        if (!(sizes[a] >= 1 && sizes[a] <= kMostSamplesPerAxis) || sizes[a] != std::floor(sizes[a]))
            throw Error("is out of range", {}, "sizes");
        NrrdAxis& axis = axes[a];
        axis.size = std::size_t(sizes[a]);
        axis.kind = smallLetters(kinds[a]);
        axis.label = labels[a];
        axis.unit = units[a];
        axis.spacing = spacings[a];
        axis.thickness = thicknesses[a];
        axis.min = mins[a];
        axis.max = maxs[a];
        const std::string center = smallLetters(centers[a]);
        if (center == "cell" || center == "node") axis.cell = center == "cell";
        const auto finite = [](double x) { return std::isfinite(x); };
        if (directions[a] && std::ranges::all_of(*directions[a], finite)) axis.direction = directions[a];
    }
    return axes;
}

/// A direction along the time of a space with time, alone.
bool runsAlongTime(const NrrdAxis& axis) {
    if (!axis.direction || axis.direction->size() != 4) return false;
    const std::vector<double>& d = *axis.direction;
    return d[0] == 0 && d[1] == 0 && d[2] == 0 && d[3] != 0;
}

/// Roles whose field says so; the others are added to `open`.
void setStated(const NrrdHeader& header, std::vector<NrrdAxis>& axes, std::vector<std::size_t>& open) {
    const bool directed = std::ranges::any_of(axes, [](const NrrdAxis& axis) { return axis.direction.has_value(); });
    for (std::size_t a = 0; a < axes.size(); ++a) {
        NrrdAxis& axis = axes[a];
        const bool unstated = axis.kind.empty() || axis.kind == "???" || axis.kind == "none";
        const bool domain = axis.kind == "domain" || axis.kind == "space";
        if (axis.kind == "time" || runsAlongTime(axis) || !indexPair(header, a, "values").empty())
            axis.along = Along::Times;
        else if (axis.direction && (unstated || domain))
            axis.along = Along::Space;
        else if (domain && !directed)
            axis.along = Along::Space;
        else if (!unstated && !domain)
            axis.along = Along::Components;
        else
            open.push_back(a);
    }
}

std::size_t countOf(const std::vector<NrrdAxis>& axes, const std::vector<std::size_t>& open, Along along) {
    std::size_t count = 0;
    for (std::size_t a = 0; a < axes.size(); ++a)
        if (axes[a].along == along && std::ranges::find(open, a) == open.end()) ++count;
    return count;
}

std::string axisName(const NrrdAxis& axis, std::size_t index) {
    return "axis " + std::to_string(index + 1) + (axis.label.empty() ? "" : " (" + axis.label + ")");
}

/// Roles of axes of which nothing is stated.
void guessOpen(std::vector<NrrdAxis>& axes, std::vector<std::size_t> open, std::vector<std::string>& notes) {
    const bool directed = std::ranges::any_of(axes, [](const NrrdAxis& axis) { return axis.direction.has_value(); });
    bool timed = countOf(axes, open, Along::Times) > 0;
    const auto decide = [&](std::size_t which, Along along, bool note) {
        const std::size_t a = open[which];
        axes[a].along = along;
        timed = timed || along == Along::Times;
        open.erase(open.begin() + std::ptrdiff_t(which));
        if (note)
            notes.push_back("the file does not say what its " + axisName(axes[a], a) + " of " +
                            std::to_string(axes[a].size) + " runs along: it is taken as " +
                            (along == Along::Times ? "time" : "components"));
    };
    const std::size_t space = countOf(axes, open, Along::Space);
    const auto tooMany = [&] { return !open.empty() && (directed || space + open.size() > 3); };
    for (std::size_t n = open.size(); n-- > 0;)
        if (!timed && tooMany() && isTimeUnit(axes[open[n]].unit)) decide(n, Along::Times, false);
    while (tooMany()) {
        constexpr std::size_t kFewComponents = 4;
        if (axes[open.front()].size <= kFewComponents)
            decide(0, Along::Components, true);
        else if (directed ? axes[open.back()].size <= kMostChannels || timed : timed)
            decide(open.size() - 1, Along::Components, true);
        else
            decide(open.size() - 1, Along::Times, true);
    }
    for (const std::size_t a : open) axes[a].along = Along::Space;
}

/// At most three axes of space and one of time; long lists are told apart by time.
void limitRoles(std::vector<NrrdAxis>& axes, std::vector<std::string>& notes) {
    const auto note = [&](std::size_t a, const char* shown) {
        notes.push_back("the " + std::to_string(axes[a].size) + " entries of the file's " + axisName(axes[a], a) +
                        " are shown as " + shown);
    };
    bool timed = std::ranges::any_of(axes, [](const NrrdAxis& axis) { return axis.along == Along::Times; });
    std::size_t space = countOf(axes, {}, Along::Space);
    while (space-- > 3) {
        std::size_t last = axes.size(), timely = axes.size();
        for (std::size_t a = 0; a < axes.size(); ++a)
            if (axes[a].along == Along::Space) {
                last = a;
                if (isTimeUnit(axes[a].unit)) timely = a;
            }
        const std::size_t a = timely < axes.size() && !timed ? timely : last;
        axes[a].along = timed ? Along::Components : Along::Times;
        note(a, timed ? "components" : "times");
        timed = true;
    }
    bool first = true;
    for (std::size_t a = 0; a < axes.size(); ++a) {
        if (axes[a].along == Along::Times && !std::exchange(first, false)) {
            axes[a].along = Along::Components;
            note(a, "components");
        }
        if (axes[a].along != Along::Components || axes[a].size <= kMostChannels || timed) continue;
        axes[a].along = Along::Times;
        timed = true;
        first = false;
        note(a, "times");
    }
}

/// Step and first place along an axis without a direction.
struct Ruler {
    double step = 1, first = 0;
    bool stated = false;
};

Ruler rulerOf(const NrrdAxis& axis, bool ofTime, std::vector<std::string>& notes) {
    const auto n = double(axis.size);
    const bool ends = std::isfinite(axis.min) && std::isfinite(axis.max) && axis.max != axis.min;
    bool cell = axis.cell.value_or(!ofTime);
    if (!axis.cell && ends && n > 1) { // the spacing may tell
        const double asNode = (axis.max - axis.min) / (n - 1), asCell = (axis.max - axis.min) / n;
        if (std::isfinite(axis.spacing))
            cell = std::abs(axis.spacing - asCell) <= std::abs(axis.spacing - asNode);
        else if (!ofTime)
            notes.emplace_back("the file does not say whether axis mins and maxs are those of cells or of nodes: they "
                               "are taken as those of cells");
    }
    if (axis.spacing == 0 || std::isinf(axis.spacing)) // NaN: it is not known
        notes.emplace_back("a spacing of the file is 0 or infinite: it was left out");
    Ruler ruler;
    if (std::isfinite(axis.spacing) && axis.spacing != 0) {
        ruler = {axis.spacing, 0, true};
    } else if (ends && (cell || n > 1)) {
        ruler = {(axis.max - axis.min) / (cell ? n : n - 1), 0, true};
    } else if (axis.size == 1 && axis.thickness > 0 && std::isfinite(axis.thickness)) {
        ruler = {axis.thickness, 0, true};
    }
    const bool halfStep = cell && (axis.cell || ends);
    if (std::isfinite(axis.min)) ruler.first = axis.min + (halfStep ? ruler.step / 2 : 0);
    return ruler;
}

glm::dvec3 inSpace(const std::vector<double>& vector) {
    glm::dvec3 out(0);
    for (std::size_t i = 0; i < std::min<std::size_t>(3, vector.size()); ++i)
        out[int(i)] = std::isfinite(vector[i]) ? vector[i] : 0;
    return out;
}

void addOrientationNote(const std::string& space, std::vector<std::string>& notes) {
    static constexpr std::pair<const char*, const char*> kSpaces[] = {
        {"right-anterior-superior", "right, anterior and superior"}, {"ras", "right, anterior and superior"},
        {"left-anterior-superior", "left, anterior and superior"},   {"las", "left, anterior and superior"},
        {"left-posterior-superior", "left, posterior and superior"}, {"lps", "left, posterior and superior"}};
    for (const auto& [name, words] : kSpaces)
        if (space == name || space == std::string(name) + "-time" || space == std::string(name) + "t")
            notes.push_back(std::string("x, y and z run to the patient's ") + words);
}

void setTimesOfNrrd(const NrrdHeader& header, const std::vector<NrrdAxis>& axes, std::size_t index,
                    const std::vector<std::string>& spaceUnits, const std::vector<double>& origin, StoredImage& image) {
    const NrrdAxis& axis = axes[index];
    std::vector<std::string> none;
    Ruler ruler = rulerOf(axis, true, none);
    if (runsAlongTime(axis)) ruler = {(*axis.direction)[3], origin.size() > 3 ? origin[3] : 0, true};
    image.timeUnit = axis.unit.empty() && spaceUnits.size() > 3 ? spaceUnits[3] : axis.unit;
    if (axis.kind != "time" && !isTimeUnit(image.timeUnit)) image.timeName = axis.label;
    image.times = evenTimes(image.frames, ruler.first, ruler.step);
    if (const std::string listed = indexPair(header, index, "values"); !listed.empty()) {
        try {
            const std::vector<double> values = nrrdNumbers(listed, "index values");
            if (values.size() == image.frames) {
                image.times = values;
                ruler.stated = true;
            }
        } catch (const Error&) {
            image.notes.emplace_back("the file's index values are no numbers: its times are counted");
        }
        image.timeUnit = indexPair(header, index, "unit");
        const std::string name = indexPair(header, index, "type");
        if (name != "numeric" && name != "time") image.timeName = name;
    }
    if (!std::ranges::is_sorted(image.times, std::less_equal<>()) ||
        !std::ranges::all_of(image.times, [](double t) { return std::isfinite(t); })) {
        image.times = evenTimes(image.frames, 0, 1);
        image.notes.emplace_back("the file's times do not increase: they are counted");
    } else if (!ruler.stated && image.frames > 1) {
        image.notes.emplace_back("the file states no step between its times: they are counted");
    }
}

} // namespace

std::vector<NrrdAxis> nrrdAxes(const NrrdHeader& header, std::vector<std::string>& notes) {
    std::vector<NrrdAxis> all = statedAxes(header);
    std::vector<std::size_t> open;
    setStated(header, all, open);
    guessOpen(all, open, notes);
    limitRoles(all, notes);
    return all;
}

void placeNrrd(const NrrdHeader& header, const std::vector<NrrdAxis>& axes, StoredImage& image) {
    const std::vector<std::string> spaceUnits = nrrdWords(header.field("spaceunits"));
    const auto origins = nrrdVectors(header.field("spaceorigin"), "space origin");
    const std::vector<double> origin = !origins.empty() && origins[0] ? *origins[0] : std::vector<double>();
    image.grid.origin = inSpace(origin);
    image.grid.steps = glm::dmat3(1);
    std::vector<std::string> units;
    int space = 0;
    bool cells = true;
    for (std::size_t a = 0; a < axes.size(); ++a) {
        const NrrdAxis& axis = axes[a];
        if (axis.along == Along::Times) setTimesOfNrrd(header, axes, a, spaceUnits, origin, image);
        if (axis.along != Along::Space) continue;
        if (axis.direction && glm::length(inSpace(*axis.direction)) > 0) {
            image.grid.steps[space] = inSpace(*axis.direction);
        } else {
            const Ruler ruler = rulerOf(axis, false, image.notes);
            image.grid.steps[space] = glm::dvec3(0);
            image.grid.steps[space][space] = ruler.step;
            if (origin.empty()) image.grid.origin[space] = ruler.first;
        }
        cells = cells && axis.cell.value_or(false);
        units.push_back(axis.unit);
        ++space;
    }
    image.cells = cells && space > 0;
    completeSteps(image.grid, space);
    std::vector<std::string> shared(spaceUnits.begin(),
                                    spaceUnits.begin() + std::ptrdiff_t(std::min<std::size_t>(3, spaceUnits.size())));
    image.lengthUnit = lengthUnitOfAxes(shared);
    if (image.lengthUnit.empty()) image.lengthUnit = lengthUnitOfAxes(units);
    std::vector<std::string> once;
    for (std::string& note : image.notes)
        if (std::ranges::find(once, note) == once.end()) once.push_back(std::move(note));
    image.notes = std::move(once);
    addOrientationNote(smallLetters(header.field("space")), image.notes);
}

} // namespace tessera::volume
