#include "app/importer/swept_names.h"

#include "volume/base/trimmed.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <utility>
#include <vtkAbstractArray.h>
#include <vtkCellData.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkPointData.h>
#include <vtkXMLReader.h>

namespace tessera::importer {

namespace {

/// Without blanks, and underscores that stand for them, at both ends.
std::string_view bare(std::string_view text) {
    const auto isBlank = [](char c) { return c == ' ' || c == '_' || c == '\t'; };
    while (!text.empty() && isBlank(text.front())) text.remove_prefix(1);
    while (!text.empty() && isBlank(text.back())) text.remove_suffix(1);
    return text;
}

/// "I0=0.4[A]" or "t=0.4 s" as a parameter and its number.
std::optional<std::pair<std::string, SweptName::Value>> conditionIn(std::string_view text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos) return std::nullopt;
    const std::string_view name = bare(text.substr(0, equals)), number = bare(text.substr(equals + 1));
    if (name.empty()) return std::nullopt;
    SweptName::Value value;
    const std::size_t sign = number.starts_with('+') ? 1 : 0;
    const auto parsed = std::from_chars(number.data() + sign, number.data() + number.size(), value.number);
    if (parsed.ec != std::errc() || !std::isfinite(value.number)) return std::nullopt;
    std::string_view unit = bare(number.substr(std::size_t(parsed.ptr - number.data())));
    if (unit.size() > 1 && (unit.front() == '[' || unit.front() == '(')) unit = unit.substr(1, unit.size() - 2);
    if (unit.starts_with('+') || unit.starts_with('-')) return std::nullopt; // a complex number
    value.unit = unit;
    return std::pair(std::string(name), value);
}

bool isTime(const std::string& parameter) {
    return parameter == "t" || parameter == "time" || parameter == "Time";
}

std::string textOf(double number) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", number);
    return text;
}

/// The arrays of one state: the numbers of the parameters that vary.
using Numbers = std::map<std::string, double>;

std::vector<std::string> arrayNames(vtkDataObject* data) {
    std::vector<std::string> names;
    std::set<std::string> known;
    const auto add = [&](vtkDataObject* leaf) {
        auto* set = vtkDataSet::SafeDownCast(leaf);
        if (set == nullptr) return;
        for (vtkDataSetAttributes* from : {static_cast<vtkDataSetAttributes*>(set->GetPointData()),
                                           static_cast<vtkDataSetAttributes*>(set->GetCellData())})
            for (int i = 0; i < from->GetNumberOfArrays(); ++i)
                if (from->GetArrayName(i) != nullptr && known.insert(from->GetArrayName(i)).second)
                    names.emplace_back(from->GetArrayName(i));
    };
    if (auto* composite = vtkCompositeDataSet::SafeDownCast(data)) {
        const auto at = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
        for (at->InitTraversal(); !at->IsDoneWithTraversal(); at->GoToNextItem()) add(at->GetCurrentDataObject());
    } else {
        add(data);
    }
    return names;
}

/// The arrays of points or cells by the time they belong to, so that a time costs what its own arrays cost: VTK looks
/// for an array of the same name among all others whenever one is added.
class SortedArrays {
public:
    SortedArrays(vtkDataSetAttributes* from, const SweptArrays& swept) : all_(from) {
        for (int i = 0; i < from->GetNumberOfArrays(); ++i) {
            vtkAbstractArray* any = from->GetAbstractArray(i);
            auto* array = vtkDataArray::SafeDownCast(any);
            const auto place = array == nullptr || array->GetName() == nullptr ? swept.places.end()
                                                                               : swept.places.find(array->GetName());
            if (place == swept.places.end()) {
                others_.emplace_back(any);
                continue;
            }
            const auto named = vtkSmartPointer<vtkDataArray>::Take(array->NewInstance());
            named->ShallowCopy(array);
            named->SetName(place->second.name.c_str());
            byTime_.resize(std::max(byTime_.size(), place->second.time + 1));
            byTime_[place->second.time].push_back(named);
        }
    }
    /// Adds the arrays of one time, under their names, behind those of all times.
    void addTo(vtkDataSetAttributes* to, std::size_t time) const {
        if (byTime_.empty()) {
            to->ShallowCopy(all_);
            return;
        }
        for (const auto& array : others_) to->AddArray(array);
        if (time < byTime_.size())
            for (const auto& array : byTime_[time]) to->AddArray(array);
    }

private:
    vtkSmartPointer<vtkDataSetAttributes> all_;
    std::vector<vtkSmartPointer<vtkAbstractArray>> others_;
    std::vector<std::vector<vtkSmartPointer<vtkDataArray>>> byTime_; ///< empty where none is swept
};

/// A block of the data with its arrays sorted.
struct SortedBlock {
    vtkSmartPointer<vtkDataSet> block;
    SortedArrays points, cells;

    SortedBlock(vtkDataSet* from, const SweptArrays& swept)
        : block(from), points(from->GetPointData(), swept), cells(from->GetCellData(), swept) {}
    vtkSmartPointer<vtkDataSet> at(std::size_t time) const {
        auto copy = vtkSmartPointer<vtkDataSet>::Take(block->NewInstance());
        copy->CopyStructure(block);
        copy->SetFieldData(block->GetFieldData());
        points.addTo(copy->GetPointData(), time);
        cells.addTo(copy->GetCellData(), time);
        return copy;
    }
};

/// Reads each time of data whose arrays are swept.
std::function<vtkSmartPointer<vtkDataObject>(std::size_t)> readerOf(const vtkSmartPointer<vtkDataObject>& data,
                                                                    const SweptArrays& swept) {
    if (auto* set = vtkDataSet::SafeDownCast(data)) {
        const auto sorted = std::make_shared<const SortedBlock>(set, swept);
        return [sorted](std::size_t time) -> vtkSmartPointer<vtkDataObject> { return sorted->at(time); };
    }
    auto* composite = vtkCompositeDataSet::SafeDownCast(data);
    if (composite == nullptr) return [data](std::size_t) { return data; };
    const auto sorted = std::make_shared<std::map<vtkDataObject*, SortedBlock>>();
    const auto each = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
    for (each->InitTraversal(); !each->IsDoneWithTraversal(); each->GoToNextItem())
        if (auto* set = vtkDataSet::SafeDownCast(each->GetCurrentDataObject())) sorted->try_emplace(set, set, swept);
    return [data, sorted](std::size_t time) -> vtkSmartPointer<vtkDataObject> {
        auto* from = vtkCompositeDataSet::SafeDownCast(data);
        auto copy = vtkSmartPointer<vtkCompositeDataSet>::Take(from->NewInstance());
        copy->CopyStructure(from);
        const auto at = vtkSmartPointer<vtkCompositeDataIterator>::Take(from->NewIterator());
        for (at->InitTraversal(); !at->IsDoneWithTraversal(); at->GoToNextItem()) {
            const auto block = sorted->find(at->GetCurrentDataObject());
            copy->SetDataSet(at, block != sorted->end() ? block->second.at(time).Get() : at->GetCurrentDataObject());
        }
        return copy;
    };
}

} // namespace

const SweptName::Value* SweptName::find(const std::string& parameter) const {
    const auto at = std::ranges::find(values, parameter, &std::pair<std::string, Value>::first);
    return at == values.end() ? nullptr : &at->second;
}

std::optional<SweptName> sweptName(std::string_view name) {
    const std::size_t at = name.find('@');
    if (at == std::string_view::npos || at == 0) return std::nullopt;
    SweptName out{std::string(bare(name.substr(0, at))), {}};
    std::string_view rest = bare(name.substr(at + 1));
    if (const std::size_t colon = rest.find(':'); // the number of the solution
        colon != std::string_view::npos &&
        rest.substr(0, colon).find_first_not_of("0123456789") == std::string_view::npos)
        rest = bare(rest.substr(colon + 1));
    std::string remarks;
    while (!rest.empty()) {
        const std::size_t comma = std::min(rest.find(','), rest.size());
        const std::string_view item = bare(rest.substr(0, comma));
        rest = bare(rest.substr(std::min(comma + 1, rest.size())));
        if (const auto condition = conditionIn(item))
            out.values.push_back(*condition);
        else if (!item.empty())
            remarks += ", " + std::string(item);
    }
    if (out.base.empty() || out.values.empty()) return std::nullopt;
    out.base += remarks;
    return out;
}

SweptArrays sortSwept(const std::vector<std::string>& names) {
    std::vector<std::pair<std::string, SweptName>> swept; // in the order of the file
    std::vector<std::string> parameters;
    std::map<std::string, std::set<double>> numbers;
    std::map<std::string, std::string> units;
    for (const std::string& name : names)
        if (const auto parts = sweptName(name)) {
            swept.emplace_back(name, *parts);
            for (const auto& [parameter, value] : parts->values) {
                if (numbers[parameter].empty()) parameters.push_back(parameter);
                numbers[parameter].insert(value.number);
                if (!value.unit.empty()) units[parameter] = value.unit;
            }
        }
    SweptArrays out;
    if (swept.empty()) return out;
    std::vector<std::string> varying;
    for (const std::string& parameter : parameters)
        if (numbers[parameter].size() > 1) varying.push_back(parameter);
    for (const std::string& parameter : parameters)
        if (isTime(parameter) && (numbers[parameter].size() > 1 || varying.empty())) out.axis = parameter;
    if (out.axis.empty() && !varying.empty())
        out.axis = *std::ranges::max_element(varying, {},
                                             [&](const std::string& parameter) { return numbers[parameter].size(); });
    if (!out.axis.empty()) out.times.assign(numbers[out.axis].begin(), numbers[out.axis].end());
    out.axisUnit = out.axis.empty() ? "" : units[out.axis];
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    std::set<std::string> inNames; // parameters that vary at one and the same time
    for (const std::string& parameter : parameters) {
        if (parameter == out.axis) continue;
        std::vector<double> values(std::max<std::size_t>(out.times.size(), 1), kUnknown);
        for (const auto& [name, parts] : swept) {
            const SweptName::Value *own = parts.find(parameter), *axis = parts.find(out.axis);
            if (own == nullptr) continue;
            std::size_t time = 0;
            if (axis != nullptr)
                time = std::size_t(std::ranges::lower_bound(out.times, axis->number) - out.times.begin());
            if (!std::isnan(values[time]) && values[time] != own->number) inNames.insert(parameter);
            values[time] = own->number;
        }
        if (!inNames.contains(parameter)) out.quantities.push_back({parameter, units[parameter], std::move(values)});
    }
    std::set<std::string> taken;
    for (const std::string& name : names)
        if (!sweptName(name)) taken.insert(name);
    std::set<std::pair<std::string, std::size_t>> used;
    std::map<std::pair<std::string, std::size_t>, std::size_t> marks; // of the last one with these conditions
    for (const auto& [name, parts] : swept) {
        SweptArrays::Place place{parts.base, 0};
        for (const auto& [parameter, value] : parts.values)
            if (inNames.contains(parameter))
                place.name +=
                    ", " + parameter + "=" + textOf(value.number) + (value.unit.empty() ? "" : " " + value.unit);
        if (const SweptName::Value* axis = parts.find(out.axis))
            place.time = std::size_t(std::ranges::lower_bound(out.times, axis->number) - out.times.begin());
        if (taken.contains(place.name)) place.name += " @ " + (out.axis.empty() ? "one state" : out.axis);
        std::size_t& own = marks[{place.name, place.time}];
        place.name.append(own, '\'');
        for (; !used.insert({place.name, place.time}).second; ++own) place.name += '\''; // the same conditions twice
        out.places[name] = std::move(place);
    }
    return out;
}

bool namesSweptArrays(const Source& source) {
    auto* xml = vtkXMLReader::SafeDownCast(source.reader);
    if (xml == nullptr) return false;
    for (int i = 0; i < xml->GetNumberOfPointArrays(); ++i)
        if (sweptName(xml->GetPointArrayName(i))) return true;
    for (int i = 0; i < xml->GetNumberOfCellArrays(); ++i)
        if (sweptName(xml->GetCellArrayName(i))) return true;
    return false;
}

void foldSweptNames(Source& source, vtkSmartPointer<vtkDataObject> data) {
    if (data == nullptr || source.times.size() > 1) return;
    const SweptArrays swept = sortSwept(arrayNames(data));
    if (swept.places.empty()) return;
    for (const auto& [name, place] : swept.places) {
        if (const auto unit = source.units.find(name); unit != source.units.end())
            source.units[place.name] = unit->second;
        if (const auto form = source.stored.find(name); form != source.stored.end())
            source.stored[place.name] = form->second;
        if (const auto labels = source.labels.find(name); labels != source.labels.end())
            source.labels[place.name] = labels->second;
    }
    source.quantities.insert(source.quantities.end(), swept.quantities.begin(), swept.quantities.end());
    if (!swept.axis.empty()) {
        if (source.times.empty() || swept.times.size() > 1) source.times = swept.times;
        if (!isTime(swept.axis)) source.timeName = swept.axis;
        source.timeUnit = swept.axisUnit;
        if (swept.times.size() > 1)
            source.notes.push_back("arrays named \"... @ " + swept.axis + "=...\" are the " +
                                   std::to_string(swept.times.size()) + " times of one");
    }
    // Times that together show every array.
    std::map<std::string, std::size_t> first;
    for (const auto& [name, place] : swept.places) {
        const auto known = first.emplace(place.name, place.time).first;
        known->second = std::min(known->second, place.time);
    }
    std::set<std::size_t> shown{0};
    for (const auto& [name, time] : first) shown.insert(time);
    source.shownAt.assign(shown.begin(), shown.end());
    source.reader = nullptr;
    source.readerTimes.clear();
    source.check = nullptr;
    source.read = readerOf(data, swept);
}

} // namespace tessera::importer
