#include "app/importer/swept_names.h"

#include "volume/base/trimmed.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
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

/// Leaves the arrays of one time, under their names, behind those of all times.
void keepTime(vtkDataSetAttributes* arrays, const SweptArrays& swept, std::size_t time) {
    std::vector<vtkSmartPointer<vtkAbstractArray>> others;
    std::vector<vtkSmartPointer<vtkDataArray>> kept;
    for (int i = 0; i < arrays->GetNumberOfArrays(); ++i) {
        vtkAbstractArray* any = arrays->GetAbstractArray(i);
        auto* array = vtkDataArray::SafeDownCast(any);
        const auto place =
            array == nullptr || array->GetName() == nullptr ? swept.places.end() : swept.places.find(array->GetName());
        if (place == swept.places.end()) {
            others.emplace_back(any);
            continue;
        }
        if (place->second.time != time) continue;
        kept.push_back(vtkSmartPointer<vtkDataArray>::Take(array->NewInstance()));
        kept.back()->ShallowCopy(array);
        kept.back()->SetName(place->second.name.c_str());
    }
    if (others.size() == std::size_t(arrays->GetNumberOfArrays())) return;
    arrays->Initialize(); // one by one each removal would move all arrays behind it
    for (const auto& array : others) arrays->AddArray(array);
    for (const auto& array : kept) arrays->AddArray(array);
}

vtkSmartPointer<vtkDataObject> atTime(vtkDataObject* data, const SweptArrays& swept, std::size_t time) {
    vtkSmartPointer<vtkDataObject> copy = vtkSmartPointer<vtkDataObject>::Take(data->NewInstance());
    if (auto* composite = vtkCompositeDataSet::SafeDownCast(copy)) {
        auto* from = vtkCompositeDataSet::SafeDownCast(data);
        composite->CopyStructure(from);
        const auto at = vtkSmartPointer<vtkCompositeDataIterator>::Take(from->NewIterator());
        for (at->InitTraversal(); !at->IsDoneWithTraversal(); at->GoToNextItem())
            composite->SetDataSet(at, atTime(at->GetCurrentDataObject(), swept, time));
        return copy;
    }
    copy->ShallowCopy(data);
    if (auto* set = vtkDataSet::SafeDownCast(copy)) {
        keepTime(set->GetPointData(), swept, time);
        keepTime(set->GetCellData(), swept, time);
    }
    return copy;
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
    for (const auto& [name, parts] : swept) {
        SweptArrays::Place place{parts.base, 0};
        for (const auto& [parameter, value] : parts.values)
            if (inNames.contains(parameter))
                place.name +=
                    ", " + parameter + "=" + textOf(value.number) + (value.unit.empty() ? "" : " " + value.unit);
        if (const SweptName::Value* axis = parts.find(out.axis))
            place.time = std::size_t(std::ranges::lower_bound(out.times, axis->number) - out.times.begin());
        if (taken.contains(place.name)) place.name += " @ " + (out.axis.empty() ? "one state" : out.axis);
        while (!used.insert({place.name, place.time}).second) place.name += "'"; // the same conditions twice
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
    source.read = [data, swept](std::size_t time) { return atTime(data, swept, time); };
}

} // namespace tessera::importer
