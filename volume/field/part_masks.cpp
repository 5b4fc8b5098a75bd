#include "volume/field/part_masks.h"

#include "volume/base/error.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace tessera::volume {

int labelOf(const DatasetInfo& info, const Parameter& parameter) {
    if (parameter.categorical || parameter.parts.count() < 2) return -1;
    for (std::size_t p = 0; p < info.parameters.size(); ++p) {
        const Parameter& label = info.parameters[p];
        if (label.categorical && label.components == 1 && label.name == parameter.parts.label) return int(p);
    }
    return -1;
}

std::vector<std::uint8_t> partsOf(const Field& label, const Parts& parts) {
    if (parts.count() > kMostParts) throw Error("more than " + std::to_string(kMostParts) + " parts");
    std::vector<std::uint8_t> out(label.count());
    dispatch(label.type, [&]<class T>(T) {
        const auto stored = label.as<T>();
        T known{};
        std::optional<std::uint8_t> part;
        for (std::size_t i = 0; i < stored.size(); ++i) {
            if (!part || stored[i] != known) {
                known = stored[i];
                const double value = label.offset + label.scale * double(known);
                part = std::uint8_t(std::abs(value) < 2e9 ? parts.partOf(int(std::lround(value))) : 0);
            }
            out[i] = label.present(i) ? *part : std::uint8_t(0);
        }
    });
    return out;
}

Field withParts(Field field, const Field& label, const Parts& parts) {
    if (label.count() != field.count()) throw Error("a label has another number of samples");
    const std::vector<std::uint8_t> part = partsOf(label, parts);
    auto mask = std::make_shared<Mask>(field.count());
    for (std::size_t i = 0; i < part.size(); ++i)
        (*mask)[i] = field.present(i) ? std::uint8_t(1 + part[i]) : std::uint8_t(0);
    field.mask = std::move(mask);
    return field;
}

Field withoutParts(Field field) {
    if (!field.mask) return field;
    const auto [least, most] = std::minmax_element(field.mask->begin(), field.mask->end());
    if (*least != 0) {
        field.mask.reset();
    } else if (*most > 1) {
        auto plain = std::make_shared<Mask>(*field.mask);
        for (std::uint8_t& flag : *plain) flag = flag != 0 ? 1 : 0;
        field.mask = std::move(plain);
    }
    return field;
}

Dataset withParts(const Dataset& dataset) {
    std::vector<int> labels; // by parameter: the label of its parts, or -1
    std::vector<Parts> parts;
    for (const Parameter& parameter : dataset.info.parameters) {
        labels.push_back(labelOf(dataset.info, parameter));
        parts.push_back(parameter.parts);
    }
    if (std::ranges::all_of(labels, [](int label) { return label < 0; })) return dataset;
    struct Kept {
        int label = -1, time = -1;
        SliceRange slices;
        Field field;
    };
    Dataset out = dataset;
    out.read =
        dataset.read.through([labels, parts, kept = std::make_shared<Kept>()](
                                 const FrameReader& read, int parameter, int component, int time, SliceRange slices) {
            Field field = read(parameter, component, time, slices);
            const int label = labels[std::size_t(parameter)];
            if (label < 0) return field;
            if (kept->label != label || kept->time != time || kept->slices != slices)
                *kept = {label, time, slices, read(label, 0, time, slices)};
            return withParts(std::move(field), kept->field, parts[std::size_t(parameter)]);
        });
    return out;
}

Dataset withParameters(const Dataset& dataset, const std::vector<int>& parameters) {
    Dataset out = withParts(dataset);
    out.info.parameters.clear();
    for (const int p : parameters) out.info.parameters.push_back(dataset.info.parameters[std::size_t(p)]);
    out.read = out.read.through(
        [parameters](const FrameReader& read, int parameter, int component, int time, SliceRange slices) {
            return read(parameters[std::size_t(parameter)], component, time, slices);
        });
    return out;
}

} // namespace tessera::volume
