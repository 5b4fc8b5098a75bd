#include "volume/import/import.h"

#include "volume/base/error.h"
#include "volume/field/labels.h"
#include "volume/import/absent.h"
#include "volume/import/assemble.h"
#include "volume/import/data_jumps.h"
#include "volume/import/files/formats.h"
#include "volume/import/files/nrrd.h"
#include "volume/import/files/raw.h"
#include "volume/import/find_parts.h"
#include "volume/import/foreign.h"
#include "volume/import/names/unit_guess.h"
#include "volume/import/names/vectors.h"
#include "volume/import/opened_series.h"
#include "volume/import/over_time.h"
#include "volume/import/stated_names.h"
#include "volume/system/input_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <set>

namespace tessera::volume {

namespace {

/// Final names, units and choice of parameters.
void nameParameters(DatasetInfo& info, const ImportOptions& options) {
    std::set<std::string> names;
    for (const auto& [from, to] : options.rename)
        if (std::none_of(info.parameters.begin(), info.parameters.end(),
                         [&from = from](const Parameter& parameter) { return parameter.name == from; }))
            throw Error("there is no array \"" + from + "\"", {}, "--rename");
    for (Parameter& parameter : info.parameters) {
        if (const auto to = options.rename.find(parameter.name); to != options.rename.end())
            parameter.name = to->second;
        if (parameter.name.empty() || !names.insert(parameter.name).second)
            throw Error("two parameters would be named \"" + parameter.name + "\"", {}, "--rename");
        if (const auto unit = options.units.find(parameter.name); unit != options.units.end())
            parameter.unit = unit->second;
    }
    if (!options.lengthUnit.empty()) info.lengthUnit = options.lengthUnit;
    if (!options.times.empty()) {
        if (options.times.size() != info.times.size())
            throw Error("states " + std::to_string(options.times.size()) + " times, the data have " +
                            std::to_string(info.times.size()),
                        {}, "--times");
        if (std::adjacent_find(options.times.begin(), options.times.end(), std::greater_equal<>()) !=
            options.times.end())
            throw Error("must increase", {}, "--times");
        info.times = options.times;
    }
    stateQuantities(info, options);
}

/// A label stored as floating point in whole numbers.
Field inWholeNumbers(const Field& field) {
    Field whole = makeField(field.lattice, ScalarType::I32);
    const auto values = whole.as<std::int32_t>();
    Mask mask = field.mask ? *field.mask : Mask(field.count(), 1);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double value = field.value(i);
        if (std::abs(value) < 2e9)
            values[i] = static_cast<std::int32_t>(std::lround(value));
        else
            mask[i] = 0;
    }
    whole.mask = std::make_shared<const Mask>(std::move(mask));
    return whole;
}

/// Labels stored as floating point become whole numbers, so that a mask or a name finds them.
Dataset withLabels(Dataset dataset) {
    std::vector<bool> rounded;
    for (Parameter& parameter : dataset.info.parameters) {
        rounded.push_back(parameter.categorical && parameter.type == ScalarType::F32);
        if (rounded.back()) parameter.type = ScalarType::I32;
    }
    if (std::find(rounded.begin(), rounded.end(), true) == rounded.end()) return dataset;
    dataset.read = dataset.read.through(
        [rounded](const FrameReader& read, int parameter, int component, int time, SliceRange slices) {
            Field field = read(parameter, component, time, slices);
            return rounded[std::size_t(parameter)] ? inWholeNumbers(field) : field;
        });
    return dataset;
}

/// Treats arrays as labels if they are named like labels or stated to be labels, and hold integers with few distinct
/// values. Floating-point arrays are only checked if samples may be read.
void markLabels(Dataset& dataset, const std::set<std::string>& stated, bool readSamples) {
    for (std::size_t p = 0; p < dataset.info.parameters.size(); ++p) {
        Parameter& parameter = dataset.info.parameters[p];
        if (parameter.categorical || parameter.components != 1) continue;
        if (!isLabelName(parameter.name) && !stated.contains(parameter.name)) continue;
        if (!readSamples) {
            parameter.categorical = parameter.type != ScalarType::F32;
            continue;
        }
        const Field field = dataset.read(static_cast<int>(p), 0, 0);
        std::set<double> values;
        bool whole = true;
        for (std::size_t i = 0; i < field.count() && whole && values.size() <= 64; ++i) {
            if (!field.present(i)) continue;
            const double value = field.value(i);
            if (std::isnan(value)) continue;
            whole = value == std::floor(value) && std::abs(value) < 1e9;
            values.insert(value);
        }
        parameter.categorical = whole && values.size() <= 64;
    }
}

/// The parameters of rules by the names they have in the file.
std::set<std::string> namesInFile(const std::vector<LabelRule>& rules, const ImportOptions& options) {
    std::set<std::string> names;
    for (const LabelRule& rule : rules) {
        std::string name = rule.parameter;
        for (const auto& [from, to] : options.rename)
            if (to == rule.parameter) name = from;
        names.insert(name);
    }
    return names;
}

/// A .nrrd file whose samples are raw, which needs no other program.
std::optional<FileBlock> openNrrd(const std::string& path, Outside outside) {
    const FileFormat* format = formatOf(path);
    if (format == nullptr || format->name != "nrrd") return std::nullopt;
    std::string head(kMostNrrdHeader, '\0');
    std::ifstream in = openInput(path);
    in.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(in.gcount()));
    try {
        StoredImage image = parseNrrd(head);
        image.files.outside = outside;
        if (image.files.encoding != SampleEncoding::Raw || isLongInteger(image.type)) return std::nullopt;
        return openStored(image, path, "nrrd");
    } catch (const Error& error) {
        throw Error(error.reason(), path, error.place());
    }
}

/// Name of the only block of a file: the part a .pvd states, else the file's name without number.
std::string blockName(const SeriesFile& entry) {
    if (!entry.part.empty()) return entry.part;
    std::string stem = std::filesystem::path(entry.path).stem().string();
    // "air_260" is air, but "H2" is H2.
    const std::string pattern = std::filesystem::path(numberedName(entry.path).pattern).stem().string();
    const std::size_t number = pattern.find_last_of('#');
    if (number == std::string::npos || number == 0 || number + 1 != pattern.size()) return stem;
    const std::string name = pattern.substr(0, number - 1);
    return std::string_view("_-.").find(pattern[number - 1]) == std::string_view::npos || name.empty() ? stem : name;
}

/// Parameters of meshes get the ranges of the mesh's own values, since samples between points do not reach the
/// extremes. Not if rules make some values absent, which only apply to samples.
void stateRanges(DatasetInfo& info, const Assembled& assembled, const std::vector<AbsentRule>& rules,
                 const ImportOptions& options, const Progress& progress) {
    const auto wanted = [&](const std::string& name) {
        return options.parameters.empty() || std::ranges::find(options.parameters, name) != options.parameters.end();
    };
    for (std::size_t p = 0; p < info.parameters.size(); ++p) {
        Parameter& parameter = info.parameters[p];
        const bool ruled = std::ranges::any_of(rules, [&](const AbsentRule& rule) {
            return !rule.nothing && !rule.values.empty() && (rule.parameter == "*" || rule.parameter == parameter.name);
        });
        const double n = double(info.parameters.size());
        if (!ruled && !parameter.categorical && wanted(parameter.name))
            parameter.ranges = assembled.ranges(int(p), progress.part(double(p) / n, double(p + 1) / n));
    }
}

/// The blocks of every file: raw and NRRD files read here, all others through one tessera-import.
std::vector<OpenedFile> openEach(const std::vector<SeriesFile>& entries, const ImportOptions& options,
                                 const Progress& progress) {
    const Outside outside = outsideBy(options);
    std::vector<OpenedFile> files(entries.size());
    std::vector<SeriesFile> foreign;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        files[i].entry = entries[i];
        if (isRaw(entries[i].path, options.raw))
            files[i].blocks.push_back(openRaw(entries[i].path, options.raw, outside));
        else if (std::optional<FileBlock> block = openNrrd(entries[i].path, outside))
            files[i].blocks.push_back(std::move(*block));
        else
            foreign.push_back(entries[i]);
    }
    std::vector<std::vector<FileBlock>> blocks;
    if (!foreign.empty()) blocks = openForeign(foreign, outside, progress);
    std::size_t next = 0;
    for (OpenedFile& file : files)
        if (file.blocks.empty()) {
            file.blocks = std::move(blocks[next++]);
            for (FileBlock& block : file.blocks)
                if (!file.entry.part.empty() || block.name.empty()) block.name = blockName(file.entry);
        }
    for (OpenedFile& file : files)
        for (FileBlock& block : file.blocks) makePrintable(block);
    return files;
}

/// The rules stated, and those that the samples suggest for parameters without one; a line for each of these.
std::vector<AbsentRule> withSuggested(const std::vector<AbsentRule>& stated, const Dataset& dataset,
                                      std::vector<std::string>& notes, const Progress& progress) {
    std::vector<AbsentRule> rules = stated;
    for (AbsentRule& rule : suggestAbsentRules(dataset, progress)) {
        const bool ruled = std::any_of(stated.begin(), stated.end(), [&](const AbsentRule& own) {
            return own.parameter == rule.parameter || (own.parameter == "*" && own.nothing);
        });
        if (ruled) continue;
        notes.push_back("absent: " + toText(rule) + " (its value is 0 there; " + rule.parameter +
                        "=none keeps these samples)");
        rules.push_back(std::move(rule));
    }
    return rules;
}

/// Vectors in place of their components, but for what the sidecars of raw files state.
void formVectors(Assembled& assembled, OpenedSeries& opened, const ImportOptions& options) {
    if (opened.format == "raw") return;
    WithVectors formed = withVectors(std::move(assembled.dataset), namesIn(options));
    assembled.dataset = std::move(formed.dataset);
    if (formed.notes.empty()) return;
    opened.notes.insert(opened.notes.end(), formed.notes.begin(), formed.notes.end());
    if (!assembled.ranges) return;
    assembled.ranges = [from = std::move(formed.from),
                        ranges = std::move(assembled.ranges)](int parameter, const Progress& by) -> std::vector<Range> {
        const std::vector<int>& own = from[std::size_t(parameter)];
        return own.size() == 1 ? ranges(own.front(), by) : std::vector<Range>{}; // that of the magnitude is not known
    };
}

} // namespace

OpenedSeries openSeries(const std::vector<SeriesFile>& entries, const ImportOptions& options, bool readSamples,
                        const Progress& progress, bool meshRanges, Misfits misfits) {
    std::vector<AbsentRule> rules;
    for (const std::string& rule : options.absent) rules.push_back(parseAbsentRule(rule));
    std::vector<PartsRule> parts;
    for (const std::string& rule : options.parts) parts.push_back(parsePartsRule(rule));
    std::vector<LabelRule> labels;
    for (const std::string& rule : options.labels) labels.push_back(parseLabelRule(rule));

    std::vector<OpenedFile> files = openEach(entries, options, progress.part(0, 0.3));
    OpenedSeries opened;
    opened.format = files.front().blocks.empty() ? "" : files.front().blocks.front().format;
    Assembled assembled = assemble(std::move(files), options, readSamples, progress.part(0.3, 0.7));
    Dataset& dataset = opened.dataset;
    opened.notes = std::move(assembled.notes);
    formVectors(assembled, opened, options);
    dataset = std::move(assembled.dataset);
    // Previews may read samples only if that is fast.
    constexpr double kQuickBytes = 64e6;
    const double times = double(dataset.info.times.size());
    if (!assembled.mesh && bytesOf(dataset.info) / times * std::min(3.0, times) <= kQuickBytes) readSamples = true;
    markLabels(dataset, namesInFile(labels, options), readSamples);
    dataset = withLabels(std::move(dataset));
    const bool unitsStated = opened.format == "OpenFOAM" ||
                             std::ranges::any_of(dataset.info.parameters,
                                                 [](const Parameter& parameter) { return !parameter.unit.empty(); });
    nameParameters(dataset.info, options);
    if (misfits == Misfits::Refused) checkStated(dataset.info, options, rules, parts);
    if (readSamples) findLabels(dataset);
    applyLabels(dataset.info, labels, readSamples);
    // A label made from blocks adds nothing: outside its block a field is absent anyway.
    if (options.autoAbsent && readSamples && !assembled.madeLabel)
        rules = withSuggested(rules, dataset, opened.notes, progress.part(0.7, 0.85));
    dataset = withAbsent(std::move(dataset), rules);
    for (const AbsentRule& rule : rules) opened.absent.push_back(toText(rule));
    if (meshRanges && assembled.ranges) stateRanges(dataset.info, assembled, rules, options, progress.part(0.8, 0.85));
    if (readSamples) {
        setParts(dataset.info, parts);
        for (std::string& note : findParts(dataset, parts, options.parameters, progress.part(0.85, 0.95)))
            opened.notes.push_back(std::move(note));
        dataset = withJumps(std::move(dataset), parts, opened.notes, progress.part(0.95, 1));
    }
    dataset = withParameters(std::move(dataset), options.parameters);
    if (!unitsStated && formatNamed(opened.format) != nullptr) guessUnits(dataset, readSamples);
    dataset.info.notes = opened.notes;
    return opened;
}

Dataset withParameters(Dataset dataset, const std::vector<std::string>& wanted) {
    if (wanted.empty()) return dataset;
    std::vector<int> kept;
    for (const std::string& name : wanted) {
        const auto at = std::find_if(dataset.info.parameters.begin(), dataset.info.parameters.end(),
                                     [&](const Parameter& parameter) { return parameter.name == name; });
        if (at == dataset.info.parameters.end()) throw Error(noSuchParameter(name, dataset.info), {}, "--parameters");
        kept.push_back(static_cast<int>(at - dataset.info.parameters.begin()));
    }
    // Parts need their label.
    for (std::size_t n = 0, stated = kept.size(); n < stated; ++n) {
        const std::string& label = dataset.info.parameters[std::size_t(kept[n])].parts.label;
        const bool known = std::any_of(kept.begin(), kept.end(), [&](int index) {
            return dataset.info.parameters[std::size_t(index)].name == label;
        });
        for (std::size_t p = 0; p < dataset.info.parameters.size() && !known; ++p)
            if (!label.empty() && dataset.info.parameters[p].name == label) kept.push_back(int(p));
    }
    std::vector<Parameter> parameters;
    for (const int index : kept) parameters.push_back(dataset.info.parameters[std::size_t(index)]);
    dataset.info.parameters = std::move(parameters);
    dataset.read = dataset.read.through(
        [kept](const FrameReader& read, int parameter, int component, int time, SliceRange slices) {
            return read(kept[std::size_t(parameter)], component, time, slices);
        });
    return dataset;
}

double bytesOf(const DatasetInfo& info) {
    double perSample = 0;
    for (const Parameter& parameter : info.parameters)
        perSample += parameter.components * double(byteSize(parameter.type));
    return perSample * double(info.lattice.count()) * double(info.times.size());
}

namespace {

/// openSeries of paths; files that a list names and that are missing are said first.
OpenedSeries openPaths(const std::vector<std::string>& paths, const ImportOptions& options, bool readSamples,
                       const Progress& progress, bool meshRanges, Misfits misfits) {
    if (paths.empty()) throw Error("no file given");
    std::vector<std::string> missing;
    const std::vector<SeriesFile> files = expandPaths(paths, outsideBy(options), &missing);
    OpenedSeries opened = openSeries(files, options, readSamples, progress, meshRanges, misfits);
    opened.notes.insert(opened.notes.begin(), missing.begin(), missing.end());
    opened.dataset.info.notes = opened.notes;
    return opened;
}

} // namespace

ImportPreview previewFiles(const std::vector<std::string>& paths, const ImportOptions& options,
                           const Progress& progress, Misfits misfits) {
    OpenedSeries opened = openPaths(paths, options, false, progress, false, misfits);
    ImportPreview preview{opened.format, {}, 0, std::move(opened.notes)};
    preview.bytes = bytesOf(opened.dataset.info);
    preview.info = std::move(opened.dataset.info);
    return preview;
}

Dataset openFiles(const std::vector<std::string>& paths, const ImportOptions& options, const Progress& progress,
                  bool meshRanges) {
    return openPaths(paths, options, true, progress, meshRanges, Misfits::Ignored).dataset;
}

void scanRanges(Dataset& dataset, const Progress& progress) {
    DatasetInfo& info = dataset.info;
    double total = 0, done = 0;
    for (const Parameter& parameter : info.parameters)
        total += double(parameter.components) * double(info.times.size());
    for (std::size_t p = 0; p < info.parameters.size(); ++p) {
        Parameter& parameter = info.parameters[p];
        if (!parameter.ranges.empty()) continue; // ranges of the mesh's own values
        const auto components = static_cast<std::size_t>(parameter.components);
        constexpr double kInfinity = std::numeric_limits<double>::infinity();
        std::vector<Range> ranges(components > 1 ? components + 1 : 1, Range{kInfinity, -kInfinity});
        const auto widen = [](Range& range, double value) {
            range.lo = std::min(range.lo, value);
            range.hi = std::max(range.hi, value);
        };
        for (std::size_t t = 0; t < info.times.size(); ++t) {
            std::vector<double> squares;
            std::vector<std::uint8_t> present;
            for (std::size_t c = 0; c < components; ++c) {
                progress.advance(done++ / total, parameter.name);
                const Field field = dataset.read(static_cast<int>(p), static_cast<int>(c), static_cast<int>(t));
                if (components > 1 && squares.empty()) {
                    squares.resize(field.count());
                    present.assign(field.count(), 1);
                }
                dispatch(field.type, [&]<class T>(T) {
                    const auto stored = field.as<T>();
                    for (std::size_t i = 0; i < stored.size(); ++i) {
                        const double value = field.offset + field.scale * double(stored[i]);
                        const bool there = field.present(i) && std::isfinite(value);
                        if (there) widen(ranges[c], value);
                        if (squares.empty()) continue;
                        squares[i] += value * value;
                        present[i] &= there ? 1 : 0;
                    }
                });
            }
            for (std::size_t i = 0; i < squares.size(); ++i)
                if (present[i] != 0) widen(ranges[components], std::sqrt(squares[i]));
        }
        for (Range& range : ranges)
            if (range.lo > range.hi) range = {0, 0};
        parameter.ranges = std::move(ranges);
    }
}

} // namespace tessera::volume
