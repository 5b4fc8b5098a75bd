#include "app/data/sources.h"

#include "app/data/picture_lattice.h"
#include "app/data/plane_sources.h"
#include "app/edits/compare_files.h"
#include "app/history/session_file.h"
#include "codec/archive/archive.h"
#include "codec/container/coded_numbers.h"
#include "codec/remote/consent.h"
#include "codec/unpack/unpack.h"
#include "volume/base/byte_text.h"
#include "volume/base/error.h"
#include "volume/derived/other_source.h"
#include "volume/field/quantities.h"
#include "volume/import/import.h"
#include "volume/import/over_time.h"
#include "volume/sources/alternating_source.h"
#include "volume/sources/axis_source.h"
#include "volume/sources/centred_source.h"
#include "volume/sources/labelled_source.h"
#include "volume/sources/memory_source.h"
#include "volume/sources/originals.h"
#include "volume/sources/sublattice_source.h"
#include "volume/synthetic/models.h"
#include "volume/system/free_memory.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <unistd.h>

namespace tessera::app {

namespace fs = std::filesystem;

bool hasData(const DataRef& data) {
    return !data.files.empty() || !data.model.empty();
}

bool isArchive(const DataRef& data) {
    return data.files.size() == 1 && codec::namesArchive(data.files[0].absolutePath);
}

namespace {

constexpr std::size_t kFramesLoaded = std::size_t(1) << 30; // bytes kept

volume::MemorySourceOptions onGrid(int brickSize = volume::MemorySourceOptions{}.brickSize) {
    return {.lattice = volume::LatticeKind::CC, .brickSize = brickSize, .budget = kFramesLoaded};
}

/// Packs a data set with these options into a temporary archive, to show the effect of packing.
Sources openPacked(volume::Dataset dataset, const DataRef& data, const Progress& progress) {
    std::string name = (fs::temp_directory_path() / "tessera-packed-XXXXXX.tsr").string();
    const int file = ::mkstemps(name.data(), 4);
    if (file < 0) throw MachineError("cannot create a temporary file to pack into", name);
    ::close(file);
    // The mapping stays valid after the file is removed.
    struct Remove {
        const std::string& path;
        ~Remove() {
            std::error_code problem;
            fs::remove(path, problem);
        }
    } const remove{name};
    codec::pack(dataset, *data.packed, name, progress);
    const auto archive = std::make_shared<const codec::Archive>(name);
    NumberOrigin computed = computedOrigin(dataset.info);
    computed.packedBytes = double(archive->fileBytes());
    if (!data.originals) {
        std::shared_ptr<const volume::BrickSource> packed = archive;
        if (data.packed->lattice != codec::StoredLattice::CC)
            packed = volume::makeMemorySource(codec::gridDataset(archive, 0), onGrid());
        Sources out{drawnOn(packed, data.lattice), volume::makeMemorySource(std::move(dataset), onGrid()), computed};
        out.packed = packed;
        return out;
    }
    NumberOrigin origin = storedOrigin(archive->metadata(), !archive->metadata().corrections.empty());
    origin.originals = true;
    origin.packedBytes = double(archive->fileBytes());
    origin.parameters = 2 * int(dataset.info.parameters.size());
    const auto original = volume::makeMemorySource(std::move(dataset), onGrid());
    // Pictures too refer to points of the file's grid, as after unpacking: on the lattice of the archive, the originals
    // would be resampled as what was packed is, and their difference would lack the error of that.
    auto unpacked = volume::makeMemorySource(codec::gridDataset(archive, 0), onGrid());
    const auto both = volume::withOriginals(std::move(unpacked), original);
    return {both, both, origin};
}

/// Applies the user's options about times to an archive or a model; files were opened with them.
void stateTimes(volume::DatasetInfo& info, const DataRef& data) {
    if (data.files.empty() || isArchive(data)) volume::stateQuantities(info, data.import);
}

/// Applies the chosen time axis.
volume::OtherAxis axisOf(const volume::DatasetInfo& given, const DataRef& data, std::vector<std::string>& messages) {
    volume::OtherAxis axis{given, {}};
    stateTimes(axis.info, data);
    if (axis.info.lengthUnit.empty()) axis.info.lengthUnit = data.import.lengthUnit;
    if (const auto by = data.axis.empty() ? std::nullopt : volume::axisBy(axis.info, data.axis)) return *by;
    if (!data.axis.empty() && data.axis != axis.info.timeName)
        messages.push_back(
            volume::findQuantity(axis.info, data.axis)
                ? data.axis + " does not rise or fall throughout: it cannot replace the times, and is shown beside them"
                : "no quantity over time is named " + data.axis);
    for (std::size_t t = 0; t < given.times.size(); ++t) axis.order.push_back(static_cast<int>(t));
    return axis;
}

/// Whether an archive is shown on the grid of its source, as its corrections lead back to it: frame by frame in memory.
bool canUnpack(const codec::Archive& archive) {
    constexpr double kBytes = 16; // of a sample, while it is unpacked
    return !archive.metadata().corrections.empty() && !codec::isRemote(archive.path()) &&
           kBytes * double(archive.metadata().source.count()) <= volume::availableMemory();
}

/// The numbers of regions that an archive keeps, at the times of an axis: time k is that of index order[k] of its
/// source.
std::shared_ptr<const volume::ComputedNumbers> numbersOf(const codec::Archive& archive, bool unpacked,
                                                         const std::vector<int>& order,
                                                         const std::vector<double>& times,
                                                         std::vector<std::string>& messages) {
    std::shared_ptr<const codec::StoredNumbers> stored;
    try {
        stored = archive.numbers();
    } catch (const Error& error) {
        messages.emplace_back(error.what());
    }
    if (!stored) return nullptr;
    const std::vector<double>& former =
        unpacked && archive.metadata().alternating ? archive.metadata().sourceTimes : archive.info().times;
    auto out = std::make_shared<volume::ComputedNumbers>();
    for (std::size_t t = 0; t < order.size(); ++t)
        for (const volume::NumbersAtTime& at : stored->numbers)
            if (std::size_t(order[t]) < former.size() && at.time == former[std::size_t(order[t])])
                out->push_back({times[t], at.labels});
    return out;
}

} // namespace

Sources openArchived(const DataRef& data, std::vector<std::string>& messages) {
    const std::string& path = data.files[0].absolutePath;
    const auto archive = std::make_shared<const codec::Archive>(path, data.remote);
    const bool unpacks = data.grids == ShownGrids::Both && canUnpack(*archive);
    const bool oneGrid = data.grids != ShownGrids::Both && !archive->metadata().alternating &&
                         archive->grid().lattice.kind == volume::LatticeKind::BCC;
    NumberOrigin origin = storedOrigin(archive->metadata(), unpacks);
    std::shared_ptr<const volume::BrickSource> source = archive;
    if (unpacks) {
        source = volume::makeMemorySource(codec::gridDataset(archive, 0), onGrid());
    } else if (archive->metadata().alternating && data.grids != ShownGrids::Both) {
        source = volume::makeOneGridSource(archive, data.grids == ShownGrids::First ? 0 : 1);
        origin.lattice = "one grid of D4*";
    } else if (oneGrid) {
        source = volume::makeSublatticeSource(archive, data.grids == ShownGrids::First ? 0 : 1);
        origin.lattice = "one grid of BCC";
    } else if (archive->metadata().alternating) {
        source = volume::makeAlternatingSource(archive, volume::TimeFilter::Cubic);
    }
    volume::OtherAxis axis = axisOf(source->info(), data, messages);
    const std::vector<int> order = axis.order;
    if (axis.info.times != source->info().times || axis.info.timeName != source->info().timeName ||
        axis.info.timeUnit != source->info().timeUnit || axis.info.lengthUnit != source->info().lengthUnit ||
        !data.import.overTime.empty() || !data.import.units.empty())
        source = volume::onAxis(source, std::move(axis));
    source = volume::withLabelNames(source, data.import.labels);
    if (data.grids == ShownGrids::Both)
        origin.computed = numbersOf(*archive, unpacks, order, source->info().times, messages);
    const bool asStored = (archive->metadata().alternating && !unpacks) || oneGrid;
    return {asStored ? source : drawnOn(source, data.lattice), source, std::move(origin)};
}

namespace {

/// Frames of files are held in memory as a whole. Throws Error where one of them has no room, with the way out.
void checkMemory(const volume::DatasetInfo& info, const std::string& path) {
    const glm::dvec3 size(info.lattice.size);
    std::size_t most = 0; // bytes a sample
    for (const volume::Parameter& parameter : info.parameters)
        most = std::max(most, std::size_t(parameter.components) * volume::byteSize(parameter.type));
    const double needed = size.x * size.y * size.z * double(most), available = volume::availableMemory();
    if (needed > available)
        throw Error("needs " + textOfBytes(needed) + " of memory, and " + textOfBytes(available) +
                        " are free; tessera pack makes an archive of it, which is read in parts",
                    path);
}

Sources openWhole(const DataRef& data, std::vector<std::string>& messages, const Progress& progress) {
    if (!hasData(data)) throw Error("contains no data: open data first, or give a data file", {}, "/data");
    if (isArchive(data)) return openArchived(data, messages);
    volume::Dataset dataset;
    if (data.files.empty()) {
        dataset = volume::makeModel(data.model, data.settings, progress.part(0, 0.9));
        std::vector<volume::LabelRule> rules;
        for (const std::string& rule : data.import.labels) rules.push_back(volume::parseLabelRule(rule));
        volume::applyLabels(dataset.info, rules);
        dataset = volume::withParameters(std::move(dataset), data.import.parameters);
    } else {
        std::vector<std::string> paths;
        for (const DataFile& file : data.files) paths.push_back(file.absolutePath);
        dataset = volume::openFiles(paths, data.import, progress.part(0, 0.3));
        checkMemory(dataset.info, paths.front());
        const bool known = std::all_of(dataset.info.parameters.begin(), dataset.info.parameters.end(),
                                       [](const volume::Parameter& parameter) { return !parameter.ranges.empty(); });
        if (!known) volume::scanRanges(dataset, progress.part(0.3, 0.95));
    }
    const auto axis = axisOf(dataset.info, data, messages); // before it is moved: arguments have no order
    dataset = volume::onAxis(std::move(dataset), axis);
    for (const volume::Parameter& parameter : dataset.info.parameters)
        for (const Range& range : parameter.ranges)
            if (!(range.hi >= range.lo)) {
                messages.push_back("parameter " + parameter.name + " has no present samples");
                break;
            }
    if (data.packed) return openPacked(std::move(dataset), data, progress.part(0.95, 1));
    NumberOrigin origin = computedOrigin(dataset.info);
    const auto numbers = volume::makeMemorySource(std::move(dataset), onGrid());
    return {drawnOn(numbers, data.lattice), numbers, std::move(origin)};
}

/// An archive that was resampled, on the grid of its source, as `tessera unpack` gives it, if that has samples where
/// `onto` has them: so both are compared without interpolating again. Null otherwise, and where it has to be read in
/// parts.
std::shared_ptr<const volume::BrickSource> unpackedOnto(const volume::BrickSource& onto, const DataRef& data) {
    if (!isArchive(data) || codec::isRemote(data.files[0].absolutePath)) return nullptr;
    const auto archive = std::make_shared<const codec::Archive>(data.files[0].absolutePath, data.remote);
    const bool onGridOfSource = archive->grid().lattice.kind == volume::LatticeKind::CC;
    if ((onGridOfSource && !archive->metadata().alternating) || data.grids != ShownGrids::Both) return nullptr;
    volume::Dataset dataset = codec::gridDataset(archive, 0);
    if (4 * double(dataset.info.lattice.count() * sizeof(float)) > volume::availableMemory()) return nullptr;
    std::vector<std::string> said; // when it was opened
    const auto axis = axisOf(dataset.info, data, said);
    auto source = volume::makeMemorySource(volume::onAxis(std::move(dataset), axis), onGrid());
    if (!volume::samePlaces(*source, onto)) return nullptr;
    return volume::withLabelNames(std::move(source), data.import.labels);
}

/// The sources after a change of each, made once: pictures of numbers, or of a packed copy, are drawn of these anew, so
/// that nothing is computed from samples that are made for pictures alone.
template <class Change> Sources changed(const Sources& before, const Change& change) {
    Sources out = before;
    out.numbers = change(before.numbers);
    if (before.packed) out.packed = change(before.packed);
    const auto drawnFrom = volume::centredFrom(*before.pictures);
    if (latticeOf(before) == PictureLattice::Even)
        out.pictures = drawnOn(before.packed ? out.packed : out.numbers, PictureLattice::Even);
    else if (drawnFrom && (drawnFrom == before.numbers || drawnFrom == before.packed))
        out.pictures = drawnOn(drawnFrom == before.numbers ? out.numbers : out.packed, PictureLattice::BodyCentred,
                               before.pictures.get());
    else
        out.pictures = before.pictures == before.numbers  ? out.numbers
                       : before.pictures == before.packed ? out.packed
                                                          : change(before.pictures);
    return out;
}

/// Adds the parameters of the second data set.
Sources withOther(const Sources& whole, const Sources& other) {
    Sources out = changed(whole, [&](const std::shared_ptr<const volume::BrickSource>& source) {
        const bool alike = volume::SampledOnto(other.pictures, *source).sameGrid();
        return volume::withOther(source, source != whole.numbers && alike ? other.pictures : other.numbers);
    });
    out.origin.other =
        originText(other.origin, other.numbers->info(), {}) + ", " + volume::otherText(*whole.numbers, *other.numbers);
    return out;
}

/// DataRef::other as the data alone.
DataRef otherAlone(const DataRef& data) {
    DataRef wanted;
    wanted.files = data.other->files;
    wanted.model = data.other->model;
    wanted.settings = data.other->settings;
    wanted.import = data.other->import;
    wanted.lattice = data.lattice;
    wanted.remote = data.remote;
    for (DataFile& file : wanted.files)
        if (file.absolutePath.empty()) file = describeFile(file.path);
    return wanted;
}

/// Opens DataRef::other on the lattice of pictures. Of two data sets on one grid, of which one was resampled, numbers
/// are those of that grid; but where the first is an archive, only if pictures are drawn on the grid too.
Sources openOther(const DataRef& data, Sources& whole, std::vector<std::string>& messages, const Progress& progress) {
    const DataRef wanted = otherAlone(data);
    Sources other = openWhole(wanted, messages, progress);
    if (const auto unpacked = unpackedOnto(*whole.numbers, wanted)) {
        other.numbers = unpacked;
        other.origin.unpacked = true;
    } else if (latticeFor(data.lattice, whole.numbers->info()) == PictureLattice::Grid) {
        if (const auto own = unpackedOnto(*other.numbers, data)) {
            whole.numbers = whole.pictures = own;
            whole.origin.unpacked = true;
        }
    }
    return other;
}

Sources openStored(const DataRef& data, std::vector<std::string>& messages, const Progress& progress) {
    Sources whole = openWhole(data, messages, progress.part(0, data.other ? 0.5 : 1));
    if (data.other) {
        const std::string path = data.other->files.empty() ? std::string() : data.other->files.front().path;
        try {
            const Sources other = openOther(data, whole, messages, progress.part(0.5, 1));
            const std::string how = volume::otherText(*whole.numbers, *other.numbers);
            whole = withOther(whole, other);
            messages.push_back((path.empty() ? other.numbers->info().name : fs::path(path).filename().string()) +
                               " is shown beside it, " + how);
        } catch (const codec::NotAllowed&) {
            throw; // there is a question
        } catch (const Error& error) {
            throw Error(error.reason(), error.file().empty() ? path : error.file(), error.place());
        }
    }
    return data.timeAxis ? cutIfMet(whole, data, messages) : whole;
}

} // namespace

Sources deriveBoth(const Sources& sources, const std::vector<volume::DerivedParameter>& wanted,
                   std::vector<std::string>& messages, const Progress& progress) {
    std::shared_ptr<const volume::BrickSource> numbers;
    const auto bounded = withBounds(wanted, sources.origin, sources.numbers->info());
    tellTimeDirection(wanted, sources.numbers->info(), messages);
    return changed(sources, [&](const std::shared_ptr<const volume::BrickSource>& source) {
        if (numbers) return volume::deriveLike(*numbers, source, bounded);
        return numbers = volume::deriveAll(source, bounded, messages, progress); // they come first
    });
}

Sources underived(const Sources& sources) {
    return changed(sources, [](const auto& source) { return volume::underived(source); });
}

bool canChooseLattice(const DataRef& data, const volume::BrickSource& numbers, const NumberOrigin& origin) {
    if (data.packed) return !data.originals;
    return (origin.unpacked || !origin.lattice.ends_with("D4*")) && !numbers.info().remote &&
           volume::canBeCentred(numbers);
}

PictureLattice latticeOf(const Sources& sources) {
    if (sources.pictures == sources.numbers || sources.pictures == sources.packed) return PictureLattice::Grid;
    const bool even = sources.pictures->info().lattice.isEven() && !sources.numbers->info().lattice.isEven();
    return even ? PictureLattice::Even : PictureLattice::BodyCentred;
}

Sources drawnOn(PictureLattice lattice, const Sources& sources) {
    Sources out = sources;
    out.pictures = drawnOn(sources.packed ? sources.packed : sources.numbers, lattice);
    return out;
}

Sources openSources(const DataRef& data, std::vector<std::string>& messages, const Progress& progress) {
    const double stored = data.derived.empty() ? 1 : 0.7;
    Sources sources = openStored(data, messages, progress.part(0, stored));
    sources = deriveBoth(sources, data.derived, messages, progress.part(stored, 1));
    for (const volume::DerivedParameter& derived : data.derived)
        if (const std::string text = equalText(data, sources.numbers->info(), derived.name); !text.empty())
            messages.push_back(text);
    progress.advance(1);
    return sources;
}

ComparedData openCompared(DataRef& data, const Session& session, std::vector<std::string>& messages,
                          const Progress& progress) {
    const std::vector<volume::DerivedParameter> kept = std::exchange(data.derived, {});
    const Sources stored = openSources(data, messages, progress.part(0, 0.7));
    data.derived = kept;
    const volume::DatasetInfo& info = stored.pictures->info();
    ComparedData made;
    made.channel = comparedChannel(session, info);
    const std::string difference =
        made.channel.empty() ? std::string() : addOtherDifference(data.derived, info, made.channel);
    made.sources = deriveBoth(stored, data.derived, messages, progress.part(0.7, 1));
    if (made.channel.empty()) {
        messages.push_back("nothing can be compared: no parameter has the same name and a unit that can be converted; "
                           "those of the other file are named \"... (other)\"");
        return made;
    }
    const volume::DatasetInfo& all = made.sources.numbers->info();
    if (const auto channel = all.findChannel(difference)) {
        const std::string equal = equalText(data, all, all.channel(*channel).name);
        messages.push_back(equal.empty() ? "New parameter: " + difference : equal);
    }
    return made;
}

std::shared_ptr<const volume::BrickSource> openSource(const DataRef& data, std::vector<std::string>& messages,
                                                      const Progress& progress) {
    return openSources(data, messages, progress).pictures;
}

} // namespace tessera::app
