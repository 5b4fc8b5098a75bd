#include "app/importer/arrays/array_axes.h"

#include "app/importer/arrays/array_times.h"
#include "app/importer/arrays/conventions.h"
#include "app/importer/readers/check_file.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <tuple>

namespace tessera::importer {

namespace {

/// The meaning of an array's axes.
struct Form {
    Dims grid; ///< z, y, x
    std::size_t times = 1, components = 1;
    bool timeAxis = false, componentAxis = false;
};

/// Whether a last axis of this length holds components: 3 of a vector; or fewer than 5 channels where all others are
/// longer.
bool holdsComponents(const Dims& dims) {
    const auto shortest = *std::min_element(dims.begin(), dims.end() - 1);
    return dims.back() == 3 || (dims.back() > 1 && dims.back() <= 4 && shortest > 4);
}

/// Matches the axes with `grid` if it is known. Else guesses: with four or more axes, a short last one holds
/// components.
std::optional<Form> formOf(Dims dims, const Dims& grid) {
    Form form;
    if (!grid.empty()) {
        const auto matches = [&](Dims own) {
            while (own.size() < 3) own.insert(own.begin(), 1);
            return own == grid;
        };
        for (const bool components : {false, true})
            for (const bool time : {false, true}) {
                if (dims.size() < (components ? 3u : 2u) + (time ? 1u : 0u) || (components && dims.back() > 4))
                    continue;
                const Dims own(dims.begin() + (time ? 1 : 0), dims.end() - (components ? 1 : 0));
                if (own.size() < 2 || own.size() > 3 || !matches(own)) continue;
                return Form{grid, time ? dims.front() : 1, components ? dims.back() : 1, time, components};
            }
        return std::nullopt;
    }
    if (dims.size() < 2 || dims.size() > 5) return std::nullopt;
    form.componentAxis = dims.size() >= 4 && holdsComponents(dims);
    if (dims.size() == 5 && !form.componentAxis) return std::nullopt;
    if (form.componentAxis) {
        form.components = dims.back();
        dims.pop_back();
    }
    form.timeAxis = dims.size() == 4;
    if (form.timeAxis) {
        form.times = dims.front();
        dims.erase(dims.begin());
    }
    while (dims.size() < 3) dims.insert(dims.begin(), 1);
    form.grid = dims;
    return form;
}

bool isEmptyGrid(const Dims& grid) {
    return std::ranges::any_of(grid, [](std::size_t n) { return n == 0 || n > 1000000; });
}

/// The grid that most arrays without axes share.
Dims namelessGrid(const std::vector<StoredArray>& arrays) {
    std::map<Dims, std::array<std::size_t, 4>> votes; // chosen, long axes, arrays, samples
    for (const StoredArray& array : arrays) {
        const std::optional<Form> form = array.axes.empty() ? formOf(array.dims, {}) : std::nullopt;
        if (!form || isEmptyGrid(form->grid)) continue;
        std::size_t axes = 0, samples = 1;
        for (const std::size_t n : form->grid) {
            axes += n > 1 ? 1 : 0;
            samples *= n;
        }
        auto& vote = votes[form->grid];
        vote = {vote[0] + (array.chosen ? 1 : 0), axes, vote[2] + 1, samples};
    }
    const auto most = std::ranges::max_element(votes, {}, [](const auto& vote) { return vote.second; });
    return most == votes.end() ? Dims() : most->first;
}

int addAxis(ArrayFile& file, StoredAxis axis) {
    const auto known = std::ranges::find(file.axes, axis);
    if (known != file.axes.end()) return int(known - file.axes.begin());
    file.axes.push_back(std::move(axis));
    return int(file.axes.size()) - 1;
}

/// Arrays without axes take those of the first one of the same shape.
void takeAxesOfOthers(ArrayFile& file, std::vector<std::string>& taken) {
    std::map<Dims, std::vector<int>> known;
    for (const StoredArray& array : file.arrays)
        if (!array.axes.empty()) known.emplace(array.dims, array.axes);
    for (StoredArray& array : file.arrays) {
        if (!array.axes.empty() || array.dims.size() < 2) continue;
        const auto like = known.find(array.dims);
        if (like == known.end()) continue;
        array.axes = like->second;
        taken.push_back(array.name);
    }
}

/// Whether the one-dimensional arrays x, y and z have the lengths of axes in this order, slowest first.
bool haveLengths(const std::vector<StoredArray>& arrays, const Dims& grid, std::string_view order) {
    bool any = false;
    for (const StoredArray& array : arrays) {
        const std::string word = lowered(leafOf(array.name));
        const std::size_t at = word.size() == 1 ? order.find(word[0]) : std::string::npos;
        if (!array.axes.empty() || array.dims.size() != 1 || at == std::string::npos) continue;
        any = true;
        if (array.dims[0] != grid[at + grid.size() - order.size()]) return false;
    }
    return any;
}

/// Whether the axes are [x, y, z], not [z, y, x], by the lengths of x, y and z.
bool isRising(const std::vector<StoredArray>& arrays, const Dims& grid) {
    const bool solid = grid[0] > 1;
    return !haveLengths(arrays, grid, solid ? "zyx" : "yx") && haveLengths(arrays, grid, solid ? "xyz" : "xy");
}

/// Whether the lengths of x, y and z tell the order of the axes.
bool areToldApart(const std::vector<StoredArray>& arrays, const Dims& grid) {
    const bool solid = grid[0] > 1;
    return haveLengths(arrays, grid, solid ? "zyx" : "yx") != haveLengths(arrays, grid, solid ? "xyz" : "xy");
}

/// Makes the one-dimensional arrays along axes without names their places, and takes them from the arrays.
void takePlaces(ArrayFile& file, std::array<StoredAxis, 4>& axes) {
    std::erase_if(file.arrays, [&](const StoredArray& array) {
        if (!array.axes.empty() || array.dims.size() != 1) return false;
        const std::string word = lowered(leafOf(array.name));
        const bool time = word == "t" || word == "time" || word == "times";
        const std::size_t at = time ? 3 : word.size() == 1 ? std::string_view("xyz").find(word[0]) : std::string::npos;
        if (at > 3) return false;
        if (time) refuseEndless(array.name, array.dims[0]);
        if (array.dims[0] != axes[at].length) return false;
        refuseHollow(array);
        axes[at].places = valuesBy(array.form, numbersOf(array));
        axes[at].unit = array.unit;
        axes[at].name = word;
        return true;
    });
}

/// Without axes of one sample, on which arrays of one grid may differ.
GridAxes longAxes(const ArrayFile& file, GridAxes grid) {
    for (int& axis : grid)
        if (axis >= 0 && file.axes[axis].length == 1) axis = -1;
    return grid;
}

std::string quoted(const std::vector<std::string>& names) {
    constexpr std::size_t kMost = 6;
    std::string out;
    for (std::size_t i = 0; i < names.size() && i < kMost; ++i) out += (i > 0 ? ", \"" : "\"") + names[i] + "\"";
    return names.size() > kMost ? out + " and " + std::to_string(names.size() - kMost) + " more" : out;
}

} // namespace

void giveAxes(ArrayFile& file, GuessedAxes& guessed) {
    takeAxesOfOthers(file, guessed.likeOthers);
    const Dims grid = namelessGrid(file.arrays);
    if (grid.empty()) return;
    std::size_t times = 1;
    for (const StoredArray& array : file.arrays)
        if (const std::optional<Form> form = array.axes.empty() ? formOf(array.dims, grid) : std::nullopt)
            times = std::max(times, form->times);
    const bool told = areToldApart(file.arrays, grid), rising = told && isRising(file.arrays, grid);
    std::array<StoredAxis, 4> axes{StoredAxis{"", grid[2], AxisKind::X}, StoredAxis{"", grid[1], AxisKind::Y},
                                   StoredAxis{"", grid[0], AxisKind::Z}, StoredAxis{"", times, AxisKind::Time}};
    if (rising) // [x, y, z], or [x, y]
        std::swap(axes[0].length, axes[grid[0] > 1 ? 2 : 1].length);
    takePlaces(file, axes);
    for (StoredArray& array : file.arrays) {
        const std::optional<Form> form = array.axes.empty() ? formOf(array.dims, grid) : std::nullopt;
        if (!form) continue;
        if (form->timeAxis) {
            StoredAxis time = axes[3];
            if (form->times != time.length) time = {"", form->times, AxisKind::Time};
            array.axes.push_back(addAxis(file, time));
        }
        const std::size_t spatial = array.dims.size() - (form->timeAxis ? 1 : 0) - (form->componentAxis ? 1 : 0);
        for (std::size_t axis = spatial; axis-- > 0;)
            array.axes.push_back(addAxis(file, axes[rising ? spatial - 1 - axis : axis]));
        if (form->componentAxis) array.axes.push_back(addAxis(file, {"", form->components, AxisKind::Other}));
        if (!told) guessed.byOrder.push_back(array.name);
        if (form->componentAxis && form->components != 3) guessed.channels.push_back(array.name);
    }
}

void guessKinds(ArrayFile& file, GuessedAxes& guessed) {
    const auto hasAxis = [&](const StoredArray& array, std::string_view name) {
        return std::ranges::any_of(array.axes, [&](int axis) { return lowered(file.axes[axis].name) == name; });
    };
    for (const StoredArray& array : file.arrays) // of pictures, whose height runs across
        for (const int axis : array.axes)
            if (lowered(file.axes[axis].name) == "height" && hasAxis(array, "width"))
                file.axes[axis].kind = AxisKind::Y;
    std::vector<const StoredArray*> arrays;
    for (const StoredArray& array : file.arrays)
        if (array.axes.size() >= 2) arrays.push_back(&array);
    std::ranges::stable_sort(arrays, std::greater(), [](const StoredArray* one) { return one->axes.size(); });
    for (const StoredArray* array : arrays) {
        std::vector<int> unknown;
        std::vector<AxisKind> free{AxisKind::X, AxisKind::Y, AxisKind::Z, AxisKind::Time}, known;
        for (const int axis : array->axes) {
            const AxisKind kind = file.axes[axis].kind;
            if (kind == AxisKind::Unknown) unknown.push_back(axis);
            std::erase(free, kind);
            if (kind == AxisKind::X || kind == AxisKind::Y || kind == AxisKind::Z) known.push_back(kind);
        }
        if (unknown.empty()) continue;
        if (array->axes.size() >= 4 && unknown.back() == array->axes.back() && holdsComponents(array->dims)) {
            file.axes[unknown.back()].kind = AxisKind::Other;
            unknown.pop_back();
        }
        const bool rising = known.size() > 1 ? known.front() < known.back()
                                             : known.size() == 1 && known[0] == AxisKind::X &&
                                                   file.axes[array->axes.front()].kind == AxisKind::X;
        if (!rising) std::ranges::reverse(unknown); // the last one first
        for (const int axis : unknown) {
            StoredAxis& about = file.axes[axis];
            about.kind = free.empty() ? AxisKind::Other : free.front();
            if (!free.empty()) free.erase(free.begin());
            guessed.kinds.push_back(axis);
        }
    }
}

std::vector<std::string> notesOn(const GuessedAxes& guessed, const ArrayFile& file,
                                 const std::vector<const StoredArray*>& drawn) {
    std::vector<std::string> notes;
    std::set<std::string_view> named;
    for (const StoredArray* one : drawn) named.insert(one->name);
    const auto ofDrawn = [&](const std::vector<std::string>& names) {
        std::vector<std::string> out;
        for (const std::string& name : names)
            if (named.contains(name)) out.push_back(name);
        return out;
    };
    if (const auto names = ofDrawn(guessed.likeOthers); !names.empty())
        notes.push_back("axes of " + quoted(names) + " guessed: those of an array of the same shape");
    if (const auto names = ofDrawn(guessed.byOrder); !names.empty())
        notes.push_back("order of the axes guessed: x is the last, before it y and z, of " + quoted(names));
    if (const auto names = ofDrawn(guessed.channels); !names.empty())
        notes.push_back("guessed: the last axis of " + quoted(names) + " holds channels");
    std::string list;
    for (const int axis : guessed.kinds) {
        const bool used = std::ranges::any_of(drawn, [axis](const StoredArray* array) {
            return std::ranges::find(array->axes, axis) != array->axes.end();
        });
        if (!used) continue;
        constexpr const char* kNames[] = {"?", "x", "y", "z", "times", "another parameter"};
        const StoredAxis& about = file.axes[axis];
        list += (list.empty() ? "" : ", ") + std::string(kNames[int(about.kind)]) + " = \"" +
                (about.name.empty() ? std::to_string(about.length) + " samples" : about.name) + "\"";
    }
    if (!list.empty()) notes.push_back("axes guessed by their order, since their names do not tell: " + list);
    return notes;
}

void joinAxes(ArrayFile& file) {
    std::vector<int> same;
    for (std::size_t a = 0; a < file.axes.size(); ++a) {
        StoredAxis own = file.axes[a];
        int first = int(a);
        for (std::size_t b = 0; b < a && first == int(a); ++b) {
            StoredAxis other = file.axes[b];
            if (leafOf(own.name) != leafOf(other.name)) continue;
            other.name = own.name;
            if (own == other) first = int(b);
        }
        same.push_back(first);
    }
    for (StoredArray& array : file.arrays)
        for (int& axis : array.axes) axis = same[std::size_t(axis)];
    for (CurvedPlaces& places : file.curved)
        for (int& axis : places.axes) axis = same[std::size_t(axis)];
}

GridAxes gridOf(const ArrayFile& file, const StoredArray& array) {
    GridAxes grid{-1, -1, -1};
    for (const int axis : array.axes) {
        const int along = int(file.axes[axis].kind) - int(AxisKind::X);
        if (along >= 0 && along < 3 && grid[std::size_t(along)] < 0) grid[std::size_t(along)] = axis;
    }
    return grid;
}

GridAxes commonGrid(const ArrayFile& file) {
    std::map<GridAxes, std::array<std::size_t, 5>> votes; // chosen, long axes, those not staggered, arrays, samples
    std::map<GridAxes, GridAxes> whole;                   // with axes of one sample
    for (const StoredArray& array : file.arrays) {
        const GridAxes grid = gridOf(file, array), key = longAxes(file, grid);
        if (std::ranges::count(grid, -1) > 1) continue;
        std::array<std::size_t, 5> own{0, 0, 0, 0, 1};
        for (const int axis : key) {
            if (axis < 0) continue;
            own[1] += 1;
            own[2] += lowered(file.axes[axis].name).ends_with("stag") ? 0 : 1;
            own[4] *= file.axes[axis].length;
        }
        if (own[4] == 0) continue;
        auto& vote = votes[key];
        vote = {vote[0] + (array.chosen ? 1 : 0), own[1], own[2], vote[3] + 1, own[4]};
        const auto known = whole.emplace(key, grid).first;
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (known->second[axis] < 0) known->second[axis] = grid[axis];
    }
    const auto most = std::ranges::max_element(votes, {}, [](const auto& vote) { return vote.second; });
    if (most == votes.end()) throw std::runtime_error("holds no array of numbers on two or more axes of space");
    for (const int axis : most->first)
        if (axis >= 0 && file.axes[axis].length > 1000000) throw std::runtime_error("has an array of invalid size");
    return whole[most->first];
}

bool isOnGrid(const ArrayFile& file, const StoredArray& array, const GridAxes& grid) {
    const GridAxes own = gridOf(file, array);
    return std::ranges::count(own, -1) <= 1 && longAxes(file, own) == longAxes(file, grid);
}

std::string axesText(const ArrayFile& file, const StoredArray& array) {
    std::string out;
    for (std::size_t a = 0; a < array.dims.size(); ++a) {
        const std::string name = a < array.axes.size() ? file.axes[array.axes[a]].name : std::string();
        out += (a > 0 ? ", " : "(") + (name.empty() ? std::to_string(array.dims[a]) : leafOf(name));
    }
    return out.empty() ? "(single number)" : out + ")";
}

} // namespace tessera::importer
