#include "app/importer/dicom/dicom_stack.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <numeric>
#include <stdexcept>

namespace tessera::importer {

namespace {

constexpr double kEvenTo = 0.05, kExactTo = 1e-3; ///< of a step

std::string inWords(const char* form, double value) {
    char text[300];
    std::snprintf(text, sizeof text, form, value);
    return text;
}

/// Steps from one place to the next, as whole numbers of the usual one; empty where they are not.
std::vector<std::size_t> wholeSteps(const std::vector<double>& at, double& step) {
    std::vector<double> gaps;
    for (std::size_t i = 1; i < at.size(); ++i) gaps.push_back(at[i] - at[i - 1]);
    std::vector<double> sorted = gaps;
    std::ranges::sort(sorted);
    step = sorted[sorted.size() / 2];
    std::vector<std::size_t> steps;
    std::size_t sum = 0;
    for (const double gap : gaps) {
        const double whole = std::round(gap / step);
        if (whole < 1 || whole > 1e6 || std::abs(gap / step - whole) > kEvenTo * whole) return {};
        steps.push_back(std::size_t(whole));
        sum += steps.back();
    }
    if (sum > 3 * at.size() + 8) return {};
    step = (at.back() - at.front()) / double(sum);
    return steps;
}

/// The places of frames along the normal; `told` becomes how they are known.
std::vector<double> alongNormal(const std::vector<DicomFrame>& frames, const std::vector<std::size_t>& chosen,
                                DicomStack& stack) {
    const DicomFrame& first = frames[chosen.front()];
    const glm::dvec3 normal = glm::cross(first.across, first.down);
    const auto all = [&](auto&& has) {
        return std::ranges::all_of(chosen, [&](std::size_t f) { return has(frames[f]); });
    };
    std::vector<double> out;
    if (all([](const DicomFrame& frame) { return frame.corner.has_value(); })) {
        for (const std::size_t f : chosen) out.push_back(glm::dot(*frames[f].corner, normal));
    } else if (all([](const DicomFrame& frame) { return frame.location.has_value(); })) {
        for (const std::size_t f : chosen) out.push_back(*frames[f].location);
        if (!first.guessed && std::ranges::any_of(out, [&](double place) { return place != out.front(); }))
            stack.notes.emplace_back("no image states its position: slices are placed by their location");
    } else {
        const double step = first.between != 0 ? std::abs(first.between) : first.thickness > 0 ? first.thickness : 1;
        std::vector<double> numbers;
        for (const std::size_t f : chosen) numbers.push_back(frames[f].number);
        std::vector<double> sorted = numbers;
        std::ranges::sort(sorted);
        sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
        for (const double number : numbers)
            out.push_back(step * double(std::ranges::lower_bound(sorted, number) - sorted.begin()));
        if (chosen.size() > 1)
            stack.notes.emplace_back(
                "a guess: no image states its position, so slices follow the numbers of the images");
    }
    if (first.guessed)
        stack.notes.emplace_back(
            "a guess: nothing says where the frames lie, so they are slices in their order, one thickness apart");
    return out;
}

void setPlane(const DicomFrame& first, DicomStack& stack) {
    double columnStep = first.columnStep, rowStep = first.rowStep;
    if (columnStep == 0) {
        columnStep = rowStep = 1;
        stack.inMillimetres = false;
        stack.notes.emplace_back("the file states no spacing of its pixels: it is taken as 1 without a unit");
    } else if (first.atDetector) {
        stack.notes.emplace_back("a guess: the spacing is that at the detector, since none of the object is stated");
    }
    stack.columnStep = first.across * columnStep;
    stack.rowStep = first.down * rowStep;
}

/// The step of a single slice.
double singleStep(const DicomFrame& first, DicomStack& stack) {
    if (first.between != 0) return std::abs(first.between);
    if (first.thickness > 0) return first.thickness;
    if (stack.inMillimetres)
        stack.notes.emplace_back("a guess: the file states no thickness of its slice, which is taken as 1 mm");
    return 1;
}

/// Puts slices at even steps, with empty ones where some are missing; or keeps uneven places.
std::vector<std::size_t> setSlices(const DicomPlaces& places, DicomStack& stack) {
    const std::vector<double>& at = places.at;
    std::vector<std::size_t> index(at.size());
    std::iota(index.begin(), index.end(), 0);
    stack.slices = at.size();
    double step = 0;
    const std::vector<std::size_t> steps = wholeSteps(at, step);
    if (steps.empty()) {
        stack.uneven = at;
        const auto [least, most] = [&] {
            double low = at[1] - at[0], high = low;
            for (std::size_t i = 1; i < at.size(); ++i) {
                low = std::min(low, at[i] - at[i - 1]);
                high = std::max(high, at[i] - at[i - 1]);
            }
            return std::pair(low, high);
        }();
        char text[200];
        std::snprintf(text, sizeof text, "slices lie at uneven distances, from %.6g to %.6g", least, most);
        stack.notes.emplace_back(text);
        return index;
    }
    double off = 0;
    std::string missing;
    std::size_t left = 0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        index[i + 1] = index[i] + steps[i];
        off = std::max(off, std::abs(at[i + 1] - at[0] - step * double(index[i + 1])));
        for (std::size_t k = index[i] + 1; k < index[i + 1]; ++k, ++left)
            if (left < 5) missing += (left > 0 ? ", " : "") + inWords("%.6g", at[0] + step * double(k));
    }
    stack.slices = index.back() + 1;
    if (left > 0)
        stack.notes.push_back(std::to_string(left) + (left == 1 ? " slice is missing" : " slices are missing") +
                              " and left empty, at " + missing + (left > 5 ? ", ..." : "") + " along the stack");
    if (off > kExactTo * step) stack.notes.push_back(inWords("slices lie up to %.4g off even distances", off));
    return index;
}

/// The step from slice to slice as it is in space, and how far slices lie beside it.
void setSliceStep(const std::vector<DicomFrame>& frames, const std::vector<std::size_t>& chosen,
                  const DicomPlaces& places, const std::vector<std::size_t>& index, DicomStack& stack) {
    const DicomFrame& first = frames[chosen.front()];
    const glm::dvec3 normal = glm::cross(first.across, first.down);
    std::vector<std::size_t> example(places.at.size(), kNoFrame);
    for (std::size_t i = 0; i < chosen.size(); ++i)
        if (example[places.ofFrame[i]] == kNoFrame) example[places.ofFrame[i]] = chosen[i];
    const auto& low = frames[example.front()].corner;
    const auto& high = frames[example.back()].corner;
    stack.corner = low.value_or(glm::dvec3(0));
    if (places.at.size() == 1) {
        stack.sliceStep = normal * singleStep(first, stack);
        return;
    }
    const double count = double(index.back());
    stack.sliceStep = low && high ? (*high - *low) / count : normal * ((places.at.back() - places.at.front()) / count);
    if (!low) return;
    double beside = 0;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        const DicomFrame& frame = frames[chosen[i]];
        const double way = (places.at[places.ofFrame[i]] - places.at.front()) / (places.at.back() - places.at.front());
        if (frame.corner) beside = std::max(beside, glm::length(*frame.corner - *low - way * (*high - *low)));
    }
    const double pixel = std::min(glm::length(stack.columnStep), glm::length(stack.rowStep));
    if (beside > 0.05 * pixel)
        stack.notes.push_back(
            inWords("slices lie up to %.4g mm beside the straight line from the first to the last, and are shown on it",
                    beside));
}

} // namespace

DicomPlaces placesAlong(const std::vector<double>& along, double tolerance) {
    std::vector<std::size_t> order(along.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return along[a] < along[b]; });
    DicomPlaces places;
    places.ofFrame.resize(along.size());
    for (const std::size_t i : order) {
        if (places.at.empty() || along[i] - places.at.back() > tolerance) places.at.push_back(along[i]);
        places.ofFrame[i] = places.at.size() - 1;
    }
    return places;
}

DicomStack stackDicom(const std::vector<DicomImage>& images, const std::vector<DicomFrame>& frames,
                      const std::vector<std::size_t>& chosen) {
    DicomStack stack;
    const DicomFrame& first = frames[chosen.front()];
    setPlane(first, stack);
    const std::vector<double> along = alongNormal(frames, chosen, stack);
    const double usual = first.thickness > 0 ? first.thickness : first.columnStep > 0 ? first.columnStep : 1;
    const DicomPlaces places = placesAlong(along, 0.01 * usual);
    std::vector<std::size_t> index{0};
    if (places.at.size() > 1) index = setSlices(places, stack);
    setSliceStep(frames, chosen, places, index, stack);
    const DicomOrder order = orderDicom(images, frames, chosen, places);
    stack.parameters = order.parameters;
    if (order.times.size() > 1) {
        stack.times = order.times;
        stack.timeName = order.timeName;
        stack.timeUnit = order.timeUnit;
    }
    stack.notes.insert(stack.notes.end(), order.notes.begin(), order.notes.end());
    if (order.times.size() * order.parameters.size() * stack.slices > 64 * chosen.size() + 1024)
        throw std::runtime_error("has images that make up no stack: too few for their places and times");
    stack.frames.assign(order.times.size() * order.parameters.size() * stack.slices, kNoFrame);
    std::size_t filled = 0;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        if (order.time[i] == kNoFrame) continue;
        const std::size_t at =
            (order.time[i] * order.parameters.size() + order.parameter[i]) * stack.slices + index[places.ofFrame[i]];
        if (stack.frames[at] == kNoFrame) ++filled;
        stack.frames[at] = chosen[i];
    }
    const std::size_t wanted = order.times.size() * order.parameters.size() * places.at.size();
    if (filled < wanted)
        stack.notes.push_back("of " + std::to_string(wanted) + " images (slices at all times) " +
                              std::to_string(wanted - filled) + " are missing and left empty");
    return stack;
}

} // namespace tessera::importer
