#include "app/data/packing_errors.h"

#include "app/ui/ticks.h"
#include "codec/container/json_text.h"
#include "volume/derived/derived.h"

#include <algorithm>
#include <map>
#include <optional>

namespace tessera::app {

namespace {

constexpr std::string_view kComputed = " as computed", kError = " error";

/// Parameters of one component that have an original, with their units.
std::vector<std::pair<std::string, std::string>> comparable(const volume::DatasetInfo& info) {
    std::vector<std::pair<std::string, std::string>> out;
    for (const volume::Parameter& parameter : info.parameters) {
        const bool plain =
            parameter.components == 1 && !parameter.categorical && parameter.name.find('`') == std::string::npos;
        if (plain && info.findChannel(parameter.name + std::string(kComputed)))
            out.emplace_back(parameter.name, parameter.unit);
    }
    return out;
}

/// Replaces whole texts, and keys of transfer functions.
void replaceNames(Json& json, const std::map<std::string, std::string>& names) {
    if (json.is_string()) {
        if (const auto found = names.find(json.get<std::string>()); found != names.end()) json = found->second;
    } else if (json.is_object()) {
        Json out = Json::object();
        for (auto& [key, value] : json.items()) {
            replaceNames(value, names);
            const auto found = names.find(key);
            out[found == names.end() ? key : found->second] = value;
        }
        json = std::move(out);
    } else if (json.is_array()) {
        for (Json& each : json) replaceNames(each, names);
    }
}

/// The same layout for the parameters of `info`, data beside their originals: the layout's parameters by the same name,
/// else others in their place, and their errors as derived parameters. Nothing where no parameter is a number that has
/// an original.
std::optional<SessionDocument> errorsLayout(const SessionDocument& layout, const volume::DatasetInfo& info) {
    const auto own = comparable(info);
    if (own.empty()) return std::nullopt;
    std::map<std::string, std::string> names;
    std::vector<volume::DerivedParameter> derived;
    const auto isUsed = [&](const auto& each) {
        return std::ranges::any_of(names, [&](const auto& pair) { return pair.second == each.first; });
    };
    for (const volume::DerivedParameter& wanted : layout.session.data.derived) {
        if (!wanted.name.ends_with(kError)) continue;
        const std::string former = wanted.name.substr(0, wanted.name.size() - kError.size());
        auto found = std::ranges::find(own, former, &std::pair<std::string, std::string>::first);
        if (found == own.end()) found = std::ranges::find_if_not(own, isUsed);
        if (found == own.end()) found = own.begin();
        const auto& [name, unit] = *found;
        names[former] = name;
        names[wanted.name] = name + std::string(kError);
        const volume::DerivedParameter error{
            name + std::string(kError), unit,
            volume::ExpressionRecipe{"`" + name + "` - `" + name + std::string(kComputed) + "`"}};
        if (std::ranges::find(derived, error) == derived.end()) derived.push_back(error);
    }
    Json raw = layout.raw;
    raw.erase("data");
    replaceNames(raw, names);
    SessionDocument out = parseSession(jsonText(raw), "layout of errors");
    out.session.data.derived = std::move(derived);
    return out;
}

} // namespace

bool packsForErrors(const Session& layout, const DataRef& data) {
    return layout.data.originals && layout.data.packed && !data.originals && !isArchive(data);
}

void showErrors(SessionDocument& layout, DataRef& data, Sources& sources, std::vector<std::string>& messages) {
    auto own = errorsLayout(layout, sources.numbers->info());
    if (!own) {
        messages.emplace_back("No parameter of these data is a number whose error could be shown.");
        return;
    }
    const codec::PackOptions& packed = *layout.session.data.packed;
    const bool resampled = packed.lattice != codec::StoredLattice::CC && codec::isExact(packed);
    messages.push_back((resampled ? std::string("Shown as resampled to another lattice and back")
                                  : "Shown as unpacked from an archive whose samples are within " +
                                        formatShare(packed.maxError) + " of each parameter's range") +
                       ", beside the data as they are.");
    layout = std::move(*own);
    for (const volume::DerivedParameter& error : layout.session.data.derived) data.derived.push_back(error);
    sources = deriveBoth(underived(sources), data.derived, messages);
}

} // namespace tessera::app
