#include "app/importer/arrays/open_arrays.h"

#include "app/importer/arrays/array_axes.h"
#include "app/importer/arrays/array_grid.h"
#include "app/importer/arrays/array_times.h"
#include "app/importer/arrays/conventions.h"
#include "app/importer/arrays/whole_numbers.h"
#include "app/importer/readers/check_file.h"
#include "volume/import/files/import_limits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>

namespace tessera::importer {

namespace {

constexpr std::size_t kMostParts = 64;

/// A parameter: an array at one index of each axis that is none of space, time or a vector.
struct Part {
    StoredArray array;
    std::string name;
    int timeAxis = -1;   ///< of ArrayFile::axes
    int vectorAxis = -1; ///< number of the axis of `array` that holds the components of a vector
    Dims fixed = {};     ///< index along each axis that is none of the others
    std::vector<Along> along = {};
    NarrowForm narrow = {};
};

struct Opened {
    ArrayGrid grid;
    TimesOfArrays times;
    std::vector<Part> parts;
    std::string words; ///< of labels, as field data
};

/// The slab of a part at one time; nothing where it has none.
bool slabAt(const Opened& opened, const Part& part, std::size_t time, Slab& slab) {
    slab.first = part.fixed;
    slab.count.assign(part.along.size(), 1);
    for (std::size_t a = 0; a < part.along.size(); ++a) slab.count[a] = part.along[a].count;
    if (part.timeAxis < 0) return true;
    const int index = opened.times.along.at(part.timeAxis)[opened.times.times.empty() ? 0 : time];
    if (index < 0) return false;
    const auto at = std::ranges::find(part.array.axes, part.timeAxis) - part.array.axes.begin();
    slab.first[std::size_t(at)] = std::size_t(index);
    return true;
}

/// How an array is drawn, once for each index of its further axes; none if there are too many.
std::vector<Part> partsOf(const ArrayFile& file, const StoredArray& array, const Opened& opened) {
    Part whole{array, array.name};
    whole.timeAxis = timeAxisOf(opened.times, array);
    whole.fixed.assign(array.dims.size(), 0);
    whole.along.resize(array.dims.size());
    std::vector<std::size_t> further;
    std::array<bool, 3> used{};
    bool timed = false;
    for (std::size_t a = 0; a < array.dims.size(); ++a) {
        const int axis = array.axes[a];
        const int along = int(file.axes[axis].kind) - int(AxisKind::X);
        if (axis == whole.timeAxis && !timed)
            timed = true;
        else if (along >= 0 && along < 3 && !used[std::size_t(along)]) {
            used[std::size_t(along)] = true;
            whole.along[a] = {array.dims[a], along};
        } else if (array.dims[a] != 1) {
            further.push_back(a);
        }
    }
    if (further.size() == 1 && array.dims[further[0]] == 3 && array.axes[further[0]] >= 0) {
        const std::string word = lowered(leafOf(file.axes[array.axes[further[0]]].name));
        if (word.empty() || word.starts_with("comp") || word.starts_with("vec") || word.starts_with("dim")) {
            whole.vectorAxis = int(further[0]);
            whole.along[further[0]] = {3, 3};
            return {whole};
        }
    }
    std::vector<Part> parts{whole};
    for (const std::size_t axis : further) {
        std::vector<Part> more;
        if (array.dims[axis] > kMostParts || parts.size() * array.dims[axis] > kMostParts) return {};
        for (const Part& part : parts)
            for (std::size_t i = 0; i < array.dims[axis]; ++i) {
                more.push_back(part);
                more.back().fixed[axis] = i;
                more.back().name += "." + std::to_string(i);
            }
        parts = std::move(more);
    }
    return parts;
}

vtkSmartPointer<vtkDataArray> readPart(const Opened& opened, const Part& part, std::size_t time) {
    Slab slab;
    if (!slabAt(opened, part, time, slab)) return nullptr;
    const auto values = narrowed(part.array.read(slab), part.array.form, part.narrow);
    auto array = inGridOrder(values, part.along, opened.grid, part.vectorAxis >= 0 ? 3 : 1);
    array->SetName(part.name.c_str());
    return array;
}

/// Whole numbers of 64 bits become those of 32 where all fit: looks at all times of a part.
void narrowPart(const Opened& opened, Part& part, std::vector<std::string>& notes) {
    if (!isWide(part.array.vtkType)) return;
    constexpr double kMostLookedAt = double(1 << 30);
    const std::size_t frames = part.timeAxis < 0 ? 1 : std::max<std::size_t>(1, opened.times.times.size());
    if (part.array.statedBytes <= kMostLookedAt) {
        WholeRange range;
        Slab slab;
        for (std::size_t t = 0; t < frames; ++t)
            if (slabAt(opened, part, t, slab)) widen(range, part.array.read(slab), part.array.form);
        part.narrow = narrowFor(range, part.array.form);
        if (part.narrow.fits || !range.inexact()) return;
    }
    notes.push_back("whole numbers of \"" + part.name + "\" beyond 16777216 are rounded to float32");
}

/// Names what is left out, by why.
void noteLeft(const std::vector<std::string>& left, const std::string& why, std::vector<std::string>& notes) {
    constexpr std::size_t kMostNamed = 12;
    if (left.empty()) return;
    std::string list;
    for (std::size_t i = 0; i < left.size() && i < kMostNamed; ++i) list += (i > 0 ? ", " : "") + left[i];
    if (left.size() > kMostNamed) list += " and " + std::to_string(left.size() - kMostNamed) + " more";
    notes.push_back(why + ": " + list);
}

/// One-dimensional arrays along a time axis, and single numbers, are quantities over time.
bool takeQuantity(const StoredArray& array, const Opened& opened, Source& source) {
    const bool overTime = array.axes.size() == 1 && opened.times.along.contains(array.axes[0]);
    const bool single = array.dims.empty();
    if (!overTime && !single) return false;
    const std::vector<double> values = valuesBy(array.form, numbersOf(array));
    std::vector<double> out;
    const std::size_t times = std::max<std::size_t>(1, opened.times.times.size());
    for (std::size_t t = 0; t < times; ++t) {
        const int index = single ? 0 : opened.times.along.at(array.axes[0])[t];
        const bool known = index >= 0 && std::size_t(index) < values.size();
        out.push_back(known ? values[std::size_t(index)] : std::numeric_limits<double>::quiet_NaN());
    }
    source.quantities.push_back({array.name, array.unit, std::move(out)});
    return true;
}

void takeTimes(const ArrayFile& file, const Opened& opened, Source& source) {
    const bool several = opened.times.times.size() > 1;
    source.times = opened.times.times;
    source.timeUnit = opened.times.unit;
    source.timeName = opened.times.name;
    source.shownAt = several ? opened.times.shownAt : std::vector<std::size_t>{0};
    if (!source.times.empty() || !file.onlyTime || !std::isfinite(file.onlyTime->places.front())) return;
    const TimeUnit unit = timeUnitOf(file.onlyTime->unit);
    source.times = file.onlyTime->places;
    source.timeUnit = unit.unit;
    if (!unit.since.empty()) source.notes.push_back("times count from " + unit.since);
}

vtkSmartPointer<vtkDataObject> readFrame(const Opened& opened, std::size_t time) {
    const auto data = vtkSmartPointer<vtkDataSet>::Take(opened.grid.data->NewInstance());
    data->CopyStructure(opened.grid.data);
    vtkDataSetAttributes* to = data->GetPointData();
    if (opened.grid.ofCells) to = data->GetCellData();
    for (const Part& part : opened.parts)
        if (const auto array = readPart(opened, part, time)) to->AddArray(array);
    if (!opened.words.empty()) {
        vtkNew<vtkStringArray> words;
        words->SetName("labels");
        words->InsertNextValue(opened.words);
        data->GetFieldData()->AddArray(words);
    }
    return data;
}

} // namespace

void openArrays(ArrayFile file, Source& source) {
    std::vector<std::string> empty;
    std::erase_if(file.arrays, [&](const StoredArray& array) {
        const bool none = std::ranges::find(array.dims, 0u) != array.dims.end();
        if (none) empty.push_back("\"" + array.name + "\"");
        return none;
    });
    GuessedAxes guessed;
    giveAxes(file, guessed);
    guessKinds(file, guessed);
    joinAxes(file);
    auto opened = std::make_shared<Opened>();
    opened->grid = makeGrid(file, commonGrid(file), source.notes);
    source.lengthUnit = opened->grid.lengthUnit;
    std::vector<const StoredArray*> drawn;
    for (const StoredArray& array : file.arrays)
        if (isOnGrid(file, array, opened->grid.axes)) drawn.push_back(&array);
    for (std::string& note : notesOn(guessed, file, drawn)) source.notes.push_back(std::move(note));
    opened->times = timesOf(file, drawn, source.notes);
    for (const StoredArray* array : drawn) refuseHollow(*array);
    std::vector<std::string> others, many;
    for (const StoredArray* array : drawn) {
        std::vector<Part> parts = partsOf(file, *array, *opened);
        if (parts.empty()) many.push_back("\"" + array->name + "\" " + axesText(file, *array));
        for (Part& part : parts) {
            narrowPart(*opened, part, source.notes);
            source.stored[part.name] = part.narrow.fits ? part.narrow.form : part.array.form;
            const std::string unit = shownUnit(part.array.unit);
            if (!unit.empty()) source.units[part.name] = unit;
            opened->words += wordsFor(part.name, part.array.words);
            opened->parts.push_back(std::move(part));
            if (opened->parts.size() > volume::kMostArrays)
                throw std::runtime_error("holds more than " + std::to_string(volume::kMostArrays) +
                                         " arrays of samples, which are not read");
        }
    }
    if (opened->parts.empty()) throw std::runtime_error("holds no array of numbers on a grid");
    takeTimes(file, *opened, source);
    for (const StoredArray& array : file.arrays) {
        if (isOnGrid(file, array, opened->grid.axes)) continue;
        if (source.quantities.size() < volume::kMostQuantities && takeQuantity(array, *opened, source)) continue;
        others.push_back("\"" + array.name + "\" " + axesText(file, array));
    }
    for (volume::Quantity& quantity : file.numbers) {
        quantity.values.assign(std::max<std::size_t>(1, source.times.size()), quantity.values.front());
        source.quantities.push_back(std::move(quantity));
    }
    noteLeft(others,
             others.size() == 1 ? "1 array of another size than the grid left out"
                                : std::to_string(others.size()) + " arrays of another size than the grid left out",
             source.notes);
    noteLeft(empty, "left out, since they hold no samples", source.notes);
    noteLeft(many, "left out, since they have too many further axes", source.notes);
    noteLeft(file.unread, "left out", source.notes);
    source.read = [opened](std::size_t time) { return readFrame(*opened, time); };
}

} // namespace tessera::importer
