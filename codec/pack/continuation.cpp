#include "codec/pack/continuation.h"

#include "codec/unpack/unpack.h"
#include "volume/base/number_text.h"
#include "volume/field/own_axes.h"
#include "volume/field/part_masks.h"
#include "volume/field/quantities.h"
#include "volume/resample/resample.h"
#include "volume/resample/series_dataset.h"

#include <algorithm>
#include <cmath>

namespace tessera::codec {

namespace {

using volume::DatasetInfo;
using volume::Parameter;

std::string sizeText(const volume::Lattice& lattice) {
    return std::to_string(lattice.size.x) + " x " + std::to_string(lattice.size.y) + " x " +
           std::to_string(lattice.size.z);
}

constexpr double kSamePlace = 1e-5; ///< in files, of a cell

/// Whether two lattices have the same samples on their sheets, up to rounding in files.
bool sameSheet(const volume::Lattice& a, const volume::Lattice& b) {
    bool same = a.kind == b.kind && a.size == b.size;
    for (int axis = 0; axis < 3; ++axis)
        same = same && std::abs(a.spacing[axis] - b.spacing[axis]) * a.size[axis] <= kSamePlace * a.spacing[axis] &&
               std::abs(a.origin[axis] - b.origin[axis]) <= kSamePlace * a.spacing[axis];
    return same;
}

/// Throws Error unless samples to add lie where those of the archive lie.
void requireSameGrid(const Metadata& old, const Metadata& added, const std::string& path) {
    for (int axis = 0; axis < 3; ++axis)
        if (old.source.size == added.source.size &&
            !volume::samePlanes(old.source.axes[axis], added.source.axes[axis], kSamePlace))
            throw Error(std::string("the samples lie at other planes of ") + "xyz"[axis] + " than those of the archive",
                        path);
    if (!sameSheet(old.source, added.source) || !sameSheet(old.info.lattice, added.info.lattice))
        throw Error("the samples lie on another grid (" + sizeText(added.source) + ") than those of the archive (" +
                        sizeText(old.source) + ")",
                    path);
}

const Parameter* find(const DatasetInfo& info, const std::string& name) {
    const auto at = std::find_if(info.parameters.begin(), info.parameters.end(),
                                 [&](const Parameter& parameter) { return parameter.name == name; });
    return at == info.parameters.end() ? nullptr : &*at;
}

void requireSame(const Parameter& old, const Parameter& added, const std::string& path) {
    const auto refuse = [&](const std::string& what, const std::string& is, const std::string& was) {
        throw Error(added.name + " has " + what + " " + is + ", in the archive " + was, path);
    };
    if (old.type != added.type)
        refuse("the type", std::string(volume::name(added.type)), std::string(volume::name(old.type)));
    if (old.components != added.components)
        refuse("components:", std::to_string(added.components), std::to_string(old.components));
    if (old.unit != added.unit) refuse("the unit", "\"" + added.unit + "\"", "\"" + old.unit + "\"");
    if (old.categorical != added.categorical)
        throw Error(added.name + " is a label in one of archive and data, and a number in the other", path);
}

} // namespace

Continuation::Continuation(const DatasetInfo& info) {
    for (std::size_t p = 0; p < info.parameters.size(); ++p) parameterOf.push_back(int(p));
}

void Continuation::widen(const DatasetInfo& from, DatasetInfo& to) const {
    for (std::size_t p = 0; p < from.parameters.size(); ++p) {
        const std::vector<Range>& ranges = from.parameters[p].ranges;
        std::vector<Range>& wide = to.parameters[std::size_t(parameterOf[p])].ranges;
        if (wide.size() != ranges.size()) {
            if (wide.empty()) wide = ranges;
            continue;
        }
        for (std::size_t c = 0; c < ranges.size(); ++c)
            wide[c] = {std::min(wide[c].lo, ranges[c].lo), std::max(wide[c].hi, ranges[c].hi)};
    }
}

void Continuation::noteResampled(const std::vector<std::optional<ResampleError>>& before,
                                 const std::vector<ResampleError>& then, Metadata& now) const {
    if (before.empty() && then.empty()) return;
    const bool isNew = firstTime == 0;
    now.resampled.resize(now.info.parameters.size());
    for (std::size_t p = 0; p < parameterOf.size(); ++p) {
        std::optional<ResampleError> error;
        if (p < before.size()) error = before[p];
        const bool known = before.empty() || error;
        if (p < then.size()) error = joined(error, then[p]);
        std::optional<ResampleError>& noted = now.resampled[std::size_t(parameterOf[p])];
        if (!known || !error)
            noted.reset();
        else if (isNew)
            noted = error;
        else if (noted) // otherwise the error at earlier times is unknown
            noted->add(*error);
    }
}

bool bringsTimes(const Archive& archive, const DatasetInfo& added) {
    return std::any_of(added.parameters.begin(), added.parameters.end(), [&](const Parameter& parameter) {
        return find(archive.metadata().info, parameter.name) != nullptr;
    });
}

namespace {

bool sameSamples(const volume::Field& a, const volume::Field& b) {
    if (!(a.lattice.size == b.lattice.size)) return false;
    for (std::size_t i = 0; i < a.count(); ++i)
        if (a.present(i) != b.present(i) || (a.present(i) && a.value(i) != b.value(i))) return false;
    return true;
}

/// Requires that the label equals that of the archive at all times: on the grid of the source, or for archives without
/// corrections as it would be packed.
void requireSameLabel(const volume::Dataset& source, int label, const std::shared_ptr<const Archive>& owned) {
    const Archive& archive = *owned;
    const Metadata& metadata = archive.metadata();
    const bool corrected = !metadata.corrections.empty();
    const Parameter& added = source.info.parameters[std::size_t(label)];
    const Parameter* const old = find(metadata.info, added.name);
    requireSame(*old, added, archive.path());
    const int number = int(old - metadata.info.parameters.data());
    const volume::Dataset stored =
        metadata.alternating && !corrected ? volume::toD4(source, metadata.options.resample) : source;
    const volume::Dataset archived = corrected ? gridDataset(owned, 0) : storedDataset(owned);
    if (stored.info.times != archived.info.times)
        throw Error("parameters can only be added at all times of the archive, " +
                        std::to_string(archived.info.times.size()) + " of them",
                    archive.path());
    const bool toBcc = !corrected && !metadata.alternating && metadata.info.lattice.kind == volume::LatticeKind::BCC;
    for (int time = 0; time < int(stored.info.times.size()); ++time) {
        volume::Field field = stored.read(label, 0, time);
        if (toBcc) field = volume::toBcc(field, true);
        if (!sameSamples(field, archived.read(number, 0, time)))
            throw Error("the archive has another label " + added.name, archive.path());
    }
}

} // namespace

std::optional<volume::Dataset> withoutKnownLabels(const volume::Dataset& source,
                                                  const std::shared_ptr<const Archive>& archive) {
    std::vector<int> known, further;
    for (std::size_t p = 0; p < source.info.parameters.size(); ++p)
        (find(archive->info(), source.info.parameters[p].name) != nullptr ? known : further).push_back(int(p));
    const auto isLabel = [&](int p) { return source.info.parameters[std::size_t(p)].categorical; };
    if (known.empty() || further.empty() || !std::ranges::all_of(known, isLabel)) return std::nullopt;
    for (const int label : known) requireSameLabel(source, label, archive);
    return volume::withParameters(source, further);
}

namespace {

/// Values that have no name so far get theirs; the others keep it.
void addLabels(const std::vector<volume::Label>& from, std::vector<volume::Label>& to) {
    for (const volume::Label& label : from)
        if (std::ranges::find(to, label.value, &volume::Label::value) == to.end()) to.push_back(label);
    std::ranges::sort(to, {}, &volume::Label::value);
}

} // namespace

Continuation continuationOf(const Archive& archive, Metadata& metadata) {
    const std::string& path = archive.path();
    const Metadata& old = archive.metadata();
    const DatasetInfo added = metadata.info;
    requireSameGrid(old, metadata, path);
    if (old.grid.brickSize != metadata.grid.brickSize || old.grid.levels != metadata.grid.levels ||
        old.grid.phase != metadata.grid.phase)
        throw Error("the bricks of the archive do not agree with its options", path);

    Continuation place;
    metadata.info = old.info;
    metadata.grid = old.grid;
    metadata.source = old.source;
    metadata.resampled = old.resampled;
    metadata.lossless = old.lossless && metadata.lossless;
    metadata.maxError = std::max(metadata.maxError, old.maxError);
    if (!bringsTimes(archive, added)) {
        if (added.times != old.info.times)
            throw Error("parameters can only be added at all times of the archive, " +
                            std::to_string(old.info.times.size()) + " of them",
                        path);
        place.wholeTimes = false;
        for (const Parameter& parameter : added.parameters) {
            place.parameterOf.push_back(int(metadata.info.parameters.size()));
            metadata.info.parameters.push_back(parameter);
        }
        for (const volume::Quantity& quantity : added.quantities)
            if (!volume::findQuantity(old.info, quantity.name)) metadata.info.quantities.push_back(quantity);
        return place;
    }
    for (const Parameter& parameter : added.parameters) {
        const Parameter* const before = find(old.info, parameter.name);
        if (!before) throw Error("the archive has no parameter " + parameter.name + " at its times so far", path);
        requireSame(*before, parameter, path);
        place.parameterOf.push_back(int(before - old.info.parameters.data()));
        addLabels(parameter.labels, metadata.info.parameters[std::size_t(place.parameterOf.back())].labels);
    }
    for (const Parameter& parameter : old.info.parameters)
        if (!find(added, parameter.name)) throw Error("the data has no parameter " + parameter.name, path);
    if (!(added.times.front() > old.info.times.back()))
        throw Error("the times to append begin at " + exactText(added.times.front()) +
                        ", which is not after the last one of the archive, " + exactText(old.info.times.back()),
                    path);
    place.firstTime = old.info.times.size();
    metadata.info.times.insert(metadata.info.times.end(), added.times.begin(), added.times.end());
    metadata.info.quantities =
        volume::joined(old.info.quantities, place.firstTime, added.quantities, added.times.size());
    return place;
}

} // namespace tessera::codec
