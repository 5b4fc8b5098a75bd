// MINC 1 and 2: each slice has its own scale, each axis its direction in space.
#include "app/importer/images/minc_file.h"
#include "app/importer/images/serve_stored.h"
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"
#include "volume/base/unit_conversion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vtkDataArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkIntArray.h>
#include <vtkPointData.h>

namespace tessera::importer {

namespace {

/// What each axis of the file is, slowest first.
struct MincLayout {
    MincImage image;
    volume::StoredImage form; ///< places, times and names; strides are those of one time's samples
    int time = -1;            ///< which axis
    int components = -1;
    bool scaled = false; ///< stored integers are not the values
};

int spaceAxisOf(const std::string& name) {
    for (int axis = 0; axis < 3; ++axis)
        if (name == std::string(1, "xyz"[axis]) + "space") return axis;
    return -1;
}

void placeMinc(MincLayout& layout) {
    volume::StoredGrid& grid = layout.form.grid;
    grid.steps = glm::dmat3(0);
    std::vector<std::string> units;
    int space = 0;
    for (auto axis = layout.image.axes.rbegin(); axis != layout.image.axes.rend(); ++axis) {
        const int along = spaceAxisOf(axis->name);
        if (along < 0) continue;
        glm::dvec3 direction(0);
        direction[along] = 1;
        if (axis->cosines.size() == 3) direction = {axis->cosines[0], axis->cosines[1], axis->cosines[2]};
        grid.steps[space++] = direction * (std::isfinite(axis->step) && axis->step != 0 ? axis->step : 1);
        if (std::isfinite(axis->start)) grid.origin += direction * axis->start;
        if (!axis->unit.empty()) units.push_back(axis->unit);
        if (!axis->places.empty())
            layout.form.notes.push_back("the uneven places along " + axis->name + " are shown as even ones");
    }
    volume::completeSteps(grid, space);
    layout.form.lengthUnit = units.empty() ? "mm" : volume::lengthUnitOfAxes(units);
    layout.form.notes.emplace_back("x, y and z run to the patient's right, anterior and superior");
}

void timeMinc(MincLayout& layout) {
    if (layout.time < 0) return;
    const MincAxis& axis = layout.image.axes[std::size_t(layout.time)];
    volume::StoredImage& form = layout.form;
    form.times = axis.places.size() == axis.size
                     ? axis.places
                     : volume::evenTimes(axis.size, axis.start, axis.step > 0 ? axis.step : 1);
    form.timeUnit = axis.unit == "seconds" ? "s" : axis.unit;
    const bool ascend = std::ranges::is_sorted(form.times, std::less_equal<>());
    if ((axis.places.empty() && !(axis.step > 0)) || !ascend) {
        form.times = volume::evenTimes(axis.size, 0, 1);
        form.notes.emplace_back("the file states no step between its times: they are counted");
    }
}

/// Whether each slice's scale leaves numbers as they are.
bool isScaled(const MincImage& image) {
    for (std::size_t n = 0; n < image.lows.size(); ++n)
        if (image.lows[n] != image.lowest || image.highs[n] != image.highest) return true;
    return false;
}

MincLayout layOut(MincImage image) {
    MincLayout layout;
    std::vector<volume::StoredAxis> axes;
    double samples = 1;
    for (std::size_t a = image.axes.size(); a-- > 0;) {
        const MincAxis& axis = image.axes[a];
        volume::StoredAxis stored{volume::StoredAxis::Along::Space, axis.size};
        if (spaceAxisOf(axis.name) < 0) {
            int& role = axis.name == "time" || axis.name == "tspace" ? layout.time : layout.components;
            if (role >= 0) throw std::runtime_error("has more axes than space, time and components");
            role = int(a);
            stored.along = volume::StoredAxis::Along::Components;
        }
        if (int(a) == layout.time) stored.size = 1; // one at a time
        axes.push_back(stored);
        samples *= double(axis.size);
    }
    refuseHollow(samples, image.stored);
    layout.form.type = volume::StoredType::F32;
    volume::setAxes(layout.form, axes);
    layout.scaled = !image.floats && isScaled(image);
    layout.image = std::move(image);
    placeMinc(layout);
    timeMinc(layout);
    volume::setChannels(layout.form, "value",
                        layout.form.offsets.size() == 3 ? volume::ComponentKind::Vector
                                                        : volume::ComponentKind::Channels);
    return layout;
}

/// Values of one time, NaN where absent if they are floats, in the order of the file.
std::vector<double> valuesAt(const MincLayout& layout, std::size_t time) {
    const MincImage& image = layout.image;
    std::vector<std::size_t> start(image.axes.size(), 0), count;
    for (const MincAxis& axis : image.axes) count.push_back(axis.size);
    if (layout.time >= 0) {
        start[std::size_t(layout.time)] = time;
        count[std::size_t(layout.time)] = 1;
    }
    std::vector<double> values = image.read(start, count);
    if (!layout.scaled && !image.floats) return values;
    std::size_t inner = 1;
    for (std::size_t a = image.scaledAxes; a < count.size(); ++a) inner *= count[a];
    for (std::size_t i = 0; i < values.size(); ++i) {
        double& value = values[i];
        if (!(value >= image.lowest && value <= image.highest)) {
            value = std::numeric_limits<double>::quiet_NaN();
        } else if (layout.scaled) {
            std::size_t slice = 0, rest = i / inner, place = 1;
            for (std::size_t a = image.scaledAxes; a-- > 0;) { // from the fastest scaled axis
                slice += (start[a] + rest % count[a]) * place;
                rest /= count[a];
                place *= image.axes[a].size;
            }
            const double low = image.lows[slice], high = image.highs[slice];
            value = low + (value - image.lowest) * (high - low) / std::max(image.highest - image.lowest, 1e-300);
        }
    }
    return values;
}

vtkSmartPointer<vtkDataObject> readMinc(const MincLayout& layout, std::size_t time) {
    const std::vector<double> values = valuesAt(layout, time);
    const volume::StoredImage& form = layout.form;
    vtkSmartPointer<vtkImageData> out = gridOf(form);
    const bool ints = !layout.scaled && !layout.image.floats && layout.image.lowest >= -2147483648.0 &&
                      layout.image.highest <= 2147483647.0;
    const glm::ivec3 size = form.grid.size;
    for (const volume::StoredChannel& channel : form.channels) {
        vtkSmartPointer<vtkDataArray> array;
        if (ints)
            array = vtkSmartPointer<vtkIntArray>::New();
        else
            array = vtkSmartPointer<vtkFloatArray>::New();
        array->SetName(channel.name.c_str());
        array->SetNumberOfComponents(channel.components);
        array->SetNumberOfTuples(vtkIdType(size.x) * size.y * size.z);
        vtkIdType at = 0;
        for (int k = 0; k < size.z; ++k)
            for (int j = 0; j < size.y; ++j)
                for (int i = 0; i < size.x; ++i, ++at)
                    for (int c = 0; c < channel.components; ++c)
                        array->SetComponent(
                            at, c,
                            values[std::size_t(i) * form.stride[0] + std::size_t(j) * form.stride[1] +
                                   std::size_t(k) * form.stride[2] + form.offsets[channel.first + std::size_t(c)]]);
        out->GetPointData()->AddArray(array);
    }
    return out;
}

} // namespace

void openMinc(Source& source) {
    const bool isNetCdf = readPart(source.path, 0, 3) == "CDF";
    const auto layout =
        std::make_shared<const MincLayout>(layOut(isNetCdf ? openMinc1(source.path) : openMinc2(source.path)));
    source.times = layout->form.times;
    source.timeUnit = layout->form.timeUnit;
    source.lengthUnit = layout->form.lengthUnit;
    source.notes.insert(source.notes.end(), layout->form.notes.begin(), layout->form.notes.end());
    for (const volume::StoredChannel& channel : layout->form.channels)
        if (!layout->scaled && !layout->image.floats)
            source.stored[channel.name] = {1, 0, {}, layout->image.lowest, layout->image.highest};
    source.read = [layout](std::size_t time) { return readMinc(*layout, time); };
}

} // namespace tessera::importer
