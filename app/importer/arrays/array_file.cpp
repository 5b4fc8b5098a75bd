#include "app/importer/arrays/array_file.h"

#include "app/importer/readers/check_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>

namespace tessera::importer {

namespace {

using Dims = std::vector<std::size_t>;

std::string lastPart(const std::string& path) {
    std::string word = path.substr(path.rfind('/') == std::string::npos ? 0 : path.rfind('/') + 1);
    std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return word;
}

/// The meaning of an array's axes.
struct Form {
    Dims grid; ///< z, y, x
    std::size_t times = 1;
    bool timeAxis = false, vector = false;
};

/// Matches the axes with `grid` if it is known. Else guesses: with four or more axes, a last one of length 3 holds
/// components.
std::optional<Form> formOf(Dims dims, const Dims& grid) {
    Form form;
    const auto matches = [&](const Dims& own) {
        Dims all = own;
        while (all.size() < 3) all.insert(all.begin(), 1);
        return all == grid;
    };
    if (!grid.empty()) {
        for (const bool vector : {false, true})
            for (const bool time : {false, true}) {
                if (dims.size() < (vector ? 3u : 2u) + (time ? 1u : 0u) || (vector && dims.back() != 3)) continue;
                const Dims own(dims.begin() + (time ? 1 : 0), dims.end() - (vector ? 1 : 0));
                if (own.size() < 2 || !matches(own)) continue;
                form = {grid, time ? dims.front() : 1, time, vector};
                return form;
            }
        return std::nullopt;
    }
    if (dims.size() < 2 || dims.size() > 5) return std::nullopt;
    form.vector = dims.size() >= 4 && dims.back() == 3;
    if (dims.size() == 5 && !form.vector) return std::nullopt;
    if (form.vector) dims.pop_back();
    form.timeAxis = dims.size() == 4;
    if (form.timeAxis) {
        form.times = dims.front();
        dims.erase(dims.begin());
    }
    while (dims.size() < 3) dims.insert(dims.begin(), 1);
    form.grid = dims;
    return form;
}

std::vector<double> numbersOf(const StoredArray& array) {
    const auto values = array.read(0, array.dims.front());
    std::vector<double> out;
    for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i) out.push_back(values->GetComponent(i, 0));
    return out;
}

/// Coordinates along an axis if they are monotonic; reversed if they decrease.
struct Places {
    std::vector<double> at;
    bool falling = false, even = true;
};
std::optional<Places> placesOf(std::vector<double> values) {
    Places places{std::move(values)};
    if (places.at.size() > 1 && places.at.front() > places.at.back()) {
        places.falling = true;
        std::reverse(places.at.begin(), places.at.end());
    }
    for (std::size_t i = 1; i < places.at.size(); ++i)
        if (!(places.at[i] > places.at[i - 1])) return std::nullopt;
    const double step = (places.at.back() - places.at.front()) / double(std::max<std::size_t>(places.at.size(), 2) - 1);
    for (std::size_t i = 0; i < places.at.size(); ++i)
        places.even = places.even && std::abs(places.at[i] - places.at.front() - step * double(i)) <= 0.01 * step;
    return places;
}

struct Grid {
    std::array<std::size_t, 3> size{1, 1, 1}; ///< x, y, z
    std::array<std::optional<Places>, 3> places;
};

/// Values of one time in the order of the grid: axes with decreasing coordinates are reversed.
vtkSmartPointer<vtkDataArray> inOrder(vtkDataArray* values, const Grid& grid, int components) {
    if (std::ranges::none_of(grid.places, [](const auto& places) { return places && places->falling; })) {
        values->SetNumberOfComponents(components);
        return values;
    }
    auto out = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(values->GetDataType()));
    out->SetNumberOfComponents(components);
    out->SetNumberOfTuples(values->GetNumberOfTuples() / components);
    vtkIdType to = 0;
    const auto turned = [&](std::size_t axis, std::size_t i) {
        return grid.places[axis] && grid.places[axis]->falling ? grid.size[axis] - 1 - i : i;
    };
    for (std::size_t k = 0; k < grid.size[2]; ++k)
        for (std::size_t j = 0; j < grid.size[1]; ++j)
            for (std::size_t i = 0; i < grid.size[0]; ++i, ++to) {
                const std::size_t from = (turned(2, k) * grid.size[1] + turned(1, j)) * grid.size[0] + turned(0, i);
                for (int c = 0; c < components; ++c)
                    out->SetComponent(to, c, values->GetComponent(vtkIdType(from) * components + c, 0));
            }
    return out;
}

vtkSmartPointer<vtkDataSet> makeGrid(const Grid& grid) {
    bool even = true;
    for (const auto& places : grid.places) even = even && (!places || places->even);
    const int size[3] = {int(grid.size[0]), int(grid.size[1]), int(grid.size[2])};
    double origin[3] = {0, 0, 0}, step[3] = {1, 1, 1};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!grid.places[axis]) continue;
        const std::vector<double>& at = grid.places[axis]->at;
        origin[axis] = at.front();
        if (at.size() > 1) step[axis] = (at.back() - at.front()) / double(at.size() - 1);
    }
    if (even) {
        vtkNew<vtkImageData> image;
        image->SetDimensions(size);
        image->SetOrigin(origin);
        image->SetSpacing(step);
        return image;
    }
    vtkNew<vtkRectilinearGrid> uneven;
    uneven->SetDimensions(size);
    const auto coordinates = [&](std::size_t axis) {
        auto array = vtkSmartPointer<vtkDoubleArray>::New();
        for (std::size_t i = 0; i < grid.size[axis]; ++i)
            array->InsertNextValue(grid.places[axis] ? grid.places[axis]->at[i] : double(i));
        return array;
    };
    uneven->SetXCoordinates(coordinates(0));
    uneven->SetYCoordinates(coordinates(1));
    uneven->SetZCoordinates(coordinates(2));
    return uneven;
}

/// The grid that most arrays share; prefers three axes to two, then the larger grid.
Dims commonGrid(const std::vector<StoredArray>& arrays) {
    std::map<Dims, std::array<std::size_t, 3>> votes; // long axes, arrays, samples
    for (const StoredArray& array : arrays) {
        const std::optional<Form> form = formOf(array.dims, {});
        if (!form) continue;
        std::size_t axes = 0, samples = 1;
        for (const std::size_t n : form->grid) {
            axes += n > 1 ? 1 : 0;
            samples *= n;
        }
        auto& vote = votes[form->grid];
        vote = {axes, vote[1] + 1, samples};
    }
    Dims best;
    std::array<std::size_t, 3> most{};
    for (const auto& [grid, vote] : votes)
        if (vote > most) {
            most = vote;
            best = grid;
        }
    if (best.empty()) throw std::runtime_error("holds no array of [z, y, x] or [t, z, y, x]");
    for (const std::size_t n : best)
        if (n == 0 || n > 1000000) throw std::runtime_error("has an array of invalid size");
    return best;
}

/// Throws where a damaged file states so many times that their list alone would fill the memory.
void refuseEndless(const std::string& name, std::size_t times) {
    constexpr std::size_t kMostTimes = 10'000'000;
    if (times > kMostTimes)
        throw std::runtime_error("array \"" + name + "\" states " + std::to_string(times) + " times, more than " +
                                 std::to_string(kMostTimes));
}

} // namespace

void refuseHollow(const StoredArray& array) {
    refuseHollow(array.statedBytes, array.storedBytes, "array \"" + array.name + "\"");
}

void openArrays(std::vector<StoredArray> arrays, Source& source) {
    const Dims dims = commonGrid(arrays);
    Grid grid;
    for (std::size_t axis = 0; axis < 3; ++axis) grid.size[axis] = dims[2 - axis];
    struct Chosen {
        StoredArray array;
        Form form;
    };
    auto chosen = std::make_shared<std::vector<Chosen>>();
    std::vector<double> times;
    std::size_t frames = 1, left = 0;
    for (StoredArray& array : arrays) {
        const std::string word = lastPart(array.name);
        if (array.dims.size() == 1) {
            const bool time = word == "t" || word == "time" || word == "times";
            if (time) refuseEndless(array.name, array.dims[0]);
            if (time) refuseHollow(array);
            if (time) times = numbersOf(array);
            if (time && !array.unit.empty()) source.timeUnit = array.unit;
            for (std::size_t axis = 0; axis < 3; ++axis)
                if (word == std::string(1, char('x' + axis)) && array.dims[0] == grid.size[axis]) {
                    refuseHollow(array);
                    grid.places[axis] = placesOf(numbersOf(array));
                    if (!array.unit.empty()) source.lengthUnit = array.unit;
                }
            continue;
        }
        if (std::optional<Form> form = formOf(array.dims, dims)) {
            refuseEndless(array.name, form->times);
            refuseHollow(array);
            frames = std::max(frames, form->times);
            chosen->push_back({std::move(array), *form});
        } else {
            ++left;
        }
    }
    for (const Chosen& one : *chosen) {
        if (one.form.timeAxis && one.form.times != frames)
            throw std::runtime_error("array \"" + one.array.name + "\" has " + std::to_string(one.form.times) +
                                     " times, another " + std::to_string(frames));
        if (!one.array.unit.empty()) source.units[one.array.name] = one.array.unit;
    }
    const bool inOrderOfTime = std::is_sorted(times.begin(), times.end(), std::less_equal<>());
    if (times.size() == frames && inOrderOfTime) {
        source.times = times;
    } else if (frames > 1) {
        for (std::size_t t = 0; t < frames; ++t) source.times.push_back(double(t));
        source.timeUnit = "step";
    }
    if (left > 0)
        source.notes.push_back(std::to_string(left) + (left == 1 ? " array" : " arrays") +
                               " of another size than the grid ignored");
    source.read = [chosen, grid](std::size_t time) -> vtkSmartPointer<vtkDataObject> {
        vtkSmartPointer<vtkDataSet> data = makeGrid(grid);
        for (const Chosen& one : *chosen) {
            const auto values = one.form.timeAxis ? one.array.read(time, 1) : one.array.read(0, one.array.dims.front());
            auto array = inOrder(values, grid, one.form.vector ? 3 : 1);
            array->SetName(one.array.name.c_str());
            data->GetPointData()->AddArray(array);
        }
        return data;
    };
}

} // namespace tessera::importer
