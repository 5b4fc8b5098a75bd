#include "app/edits/compare_files.h"

#include "app/described/describe_json.h"
#include "app/session/session_json.h"
#include "codec/container/json_text.h"
#include "volume/derived/derived.h"
#include "volume/derived/other_source.h"

#include <algorithm>
#include <filesystem>

namespace tessera::app {

namespace {

constexpr std::string_view kMinusOther = " minus other";

bool isOtherDifference(const volume::DerivedParameter& derived) {
    const auto* difference = std::get_if<volume::DifferenceRecipe>(&derived.recipe);
    return difference && difference->from == volume::OtherTime::Other;
}

bool canBeSubtracted(const volume::DatasetInfo& info, int channel) {
    const volume::Parameter& parameter = info.parameters[std::size_t(info.channel(channel).parameter)];
    return !parameter.categorical && volume::otherConversion(info, channel).has_value();
}

/// The name of a parameter or channel in the other data; "" if they do not have it.
std::string nameInOther(const volume::DatasetInfo& info, const std::string& name) {
    if (const auto channel = info.findChannel(name))
        if (const auto other = volume::otherChannel(info, *channel)) return info.channel(*other).name;
    const std::string other = name + std::string(volume::kOtherSuffix);
    const auto named = [&](const volume::Parameter& parameter) { return parameter.name == other; };
    return std::ranges::any_of(info.parameters, named) ? other : std::string();
}

/// The function as it maps values, with another range.
void moveRange(vis::TransferFunction& function, Range from, Range to) {
    const double scale = (from.hi - from.lo) / (to.hi - to.lo);
    const auto moved = [&](float x) {
        return static_cast<float>((from.lo - to.lo) / (to.hi - to.lo) + double(x) * scale);
    };
    for (glm::vec2& point : function.opacity) point.x = moved(point.x);
    std::vector<glm::vec2>& curve = function.opacity;
    if (curve.front().x > 0) curve.insert(curve.begin(), {0, curve.front().y});
    if (curve.back().x < 1) curve.push_back({1, curve.back().y});
    for (vis::TransferRegion& region : function.regions) {
        region.centre.x = moved(region.centre.x);
        region.size.x *= static_cast<float>(scale);
    }
    function.gradientTop *= static_cast<float>(scale);
    function.autoRange = false;
    function.range = to;
}

/// The names of both data sets, short, and different if their places are.
std::pair<std::string, std::string> namesOf(const DataRef& data) {
    namespace fs = std::filesystem;
    const auto pathOf = [](const std::vector<DataFile>& files, const std::string& model) {
        return files.empty() ? fs::path(model) : fs::path(files.front().absolutePath);
    };
    fs::path own = pathOf(data.files, data.model), other = pathOf(data.other->files, data.other->model);
    fs::path left = own.filename(), right = other.filename();
    while (left == right && own.has_relative_path() && own.parent_path() != own && other.has_relative_path()) {
        own = own.parent_path(), other = other.parent_path();
        if (own.filename().empty() || other.filename().empty()) break;
        left = own.filename() / left, right = other.filename() / right;
    }
    if (left == right) return {left.generic_string() + ", as shown", right.generic_string() + ", the other"};
    return {left.generic_string(), right.generic_string()};
}

/// The layers with parameters of the other data wherever these have them.
CompareVariant otherVariant(const Session& session, const volume::DatasetInfo& info) {
    CompareVariant variant;
    for (std::size_t i = 0; i < session.layers.size(); ++i) {
        const vis::Layer& layer = session.layers[i];
        const std::string place = "/layers/" + std::to_string(i);
        std::visit(
            [&]<class Technique>(const Technique& technique) {
                Technique::describe(technique, [&]<class Member>(const Member& member, const FieldInfo& field) {
                    if constexpr (std::is_same_v<Member, std::string>)
                        if (field.refersTo.ends_with("hannel") || field.refersTo.ends_with("ector"))
                            if (const std::string other = nameInOther(info, member); !other.empty())
                                variant.changes[place + "/technique/" + std::string(field.key)] = other;
                    if constexpr (std::is_same_v<Member, vis::Strokes>)
                        if (const std::string other = nameInOther(info, member.vector); !other.empty())
                            variant.changes[place + "/technique/strokes/vector"] = other;
                    if constexpr (std::is_same_v<Member, std::vector<vis::GlyphPart>>)
                        for (std::size_t n = 0; n < member.size(); ++n)
                            if (const std::string other = nameInOther(info, member[n].channel); !other.empty())
                                variant.changes[place + "/technique/parts/" + std::to_string(n) + "/channel"] = other;
                });
            },
            layer.technique);
        // The function of the first file serves for both: what is edited of it is of both.
        const std::string channel = vis::shownChannel(layer.technique), other = nameInOther(info, channel);
        if (other.empty() || !layer.transfer.empty() || std::holds_alternative<vis::IsoLayer>(layer.technique))
            continue;
        if (info.channel(*info.findChannel(channel)).unit == info.channel(*info.findChannel(other)).unit)
            variant.changes[place + "/transfer"] = channel;
    }
    return variant;
}

} // namespace

std::string comparedChannel(const Session& session, const volume::DatasetInfo& info) {
    for (const vis::Layer& layer : session.layers)
        if (const auto channel = info.findChannel(vis::shownChannel(layer.technique)))
            if (canBeSubtracted(info, *channel)) return info.channel(*channel).name;
    const std::vector<volume::Channel> channels = info.channels();
    for (int i = 0; i < static_cast<int>(channels.size()); ++i)
        if (canBeSubtracted(info, i)) return channels[std::size_t(i)].name;
    return {};
}

std::string addOtherDifference(std::vector<volume::DerivedParameter>& derived, const volume::DatasetInfo& info,
                               const std::string& channel) {
    const volume::DifferenceRecipe recipe{channel, volume::OtherTime::Other};
    for (const volume::DerivedParameter& own : derived)
        if (own.recipe == volume::DerivedRecipe(recipe)) return own.name;
    const auto found = info.findChannel(channel);
    derived.push_back({channel + std::string(kMinusOther), found ? info.channel(*found).unit : "", recipe});
    return derived.back().name;
}

void shareFunction(Session& session, const volume::DatasetInfo& info, const std::string& channel) {
    const auto own = info.findChannel(channel);
    const auto other = own ? volume::otherChannel(info, *own) : std::nullopt;
    const auto convert = own ? volume::otherConversion(info, *own) : std::nullopt;
    if (!other || !convert || convert->factor == 0) return;
    const Range first = info.channelRange(info.channel(*own)), second = info.channelRange(info.channel(*other));
    const Range converted{(*convert)(second.lo), (*convert)(second.hi)};
    vis::TransferFunction& function = session.transfer[channel];
    const Range now = vis::effectiveRange(function, first);
    const Range both =
        vis::effectiveRange(function, {std::min(first.lo, converted.lo), std::max(first.hi, converted.hi)});
    if (function.autoRange && now.hi > now.lo && !(first == converted && *convert == volume::UnitConversion{}))
        moveRange(function, now, both);
    vis::TransferFunction& otherFunction = session.transfer[info.channel(*other).name];
    otherFunction = function;
    if (!otherFunction.autoRange)
        for (double* end : {&otherFunction.range.lo, &otherFunction.range.hi})
            *end = (*end - convert->offset) / convert->factor;
}

void showOtherDifference(Session& session, const volume::DatasetInfo& info, const std::string& channel) {
    const std::string difference = addOtherDifference(session.data.derived, info, channel);
    if (!session.transfer.contains(difference)) {
        colorDifferences(session);
        session.transfer[difference].opacity = {{0, 0.8f}, {0.48f, 0}, {0.52f, 0}, {1, 0.8f}};
    }
    shareFunction(session, info, channel);
}

std::vector<CompareVariant> fileVariants(const Session& session, const volume::DatasetInfo& info) {
    if (!session.data.other) return {};
    const auto [own, other] = namesOf(session.data);
    CompareVariant first, second = otherVariant(session, info);
    const std::string compared = comparedChannel(session, info);
    if (second.changes.empty() && compared.empty()) return {};
    if (second.changes.empty()) { // what is shown is not in the other data
        const vis::Layer layer{.name = {}, .technique = vis::VolumeLayer{.channel = compared}};
        Session shown = session;
        shown.layers = {layer};
        first.changes["/layers"] = jsonText(toJson(shown)["layers"]);
        shown.layers.front().technique = vis::VolumeLayer{.channel = nameInOther(info, compared)};
        second.changes["/layers"] = jsonText(toJson(shown)["layers"]);
    }
    first.name = own;
    second.name = other;
    std::vector<CompareVariant> variants{first, second};
    for (const volume::DerivedParameter& derived : session.data.derived) {
        if (!isOtherDifference(derived) || std::get<volume::DifferenceRecipe>(derived.recipe).channel != compared)
            continue;
        Session shown = session;
        shown.layers = {vis::Layer{.name = {}, .technique = vis::VolumeLayer{.channel = derived.name}}};
        variants.push_back(
            {.name = own + " minus " + other, .changes = {{"/layers", jsonText(toJson(shown)["layers"])}}});
    }
    return variants;
}

bool isDifference(const DataRef& data, const volume::DatasetInfo& info, const std::string& channel) {
    const auto found = info.findChannel(channel);
    if (!found) return false;
    const std::string& name = info.parameters[std::size_t(info.channel(*found).parameter)].name;
    return std::ranges::any_of(data.derived, [&](const volume::DerivedParameter& derived) {
        return derived.name == name && std::holds_alternative<volume::DifferenceRecipe>(derived.recipe);
    });
}

std::string equalText(const DataRef& data, const volume::DatasetInfo& info, const std::string& channel) {
    if (!isDifference(data, info, channel)) return {};
    if (!(info.channelRange(info.channel(*info.findChannel(channel))) == Range{0, 0})) return {};
    return channel + (volume::zeroIsOfAllSamples(info) ? " is 0 everywhere: nothing differs"
                                                       : " is 0 wherever it was looked at: nothing seems to differ");
}

std::string equalText(const Session& session, const volume::DatasetInfo& info) {
    std::string all;
    for (const vis::Layer& layer : session.layers) {
        if (!layer.visible) continue;
        const std::string text = equalText(session.data, info, vis::shownChannel(layer.technique));
        if (text.empty()) return {};
        if (all.empty()) all = text;
    }
    return all;
}

bool showsOtherData(const CompareVariant& variant) {
    return std::ranges::any_of(variant.changes, [](const auto& change) {
        return change.first.starts_with("/layers") && (change.second.find(volume::kOtherSuffix) != std::string::npos ||
                                                       change.second.find(kMinusOther) != std::string::npos);
    });
}

void dropOtherData(Session& session) {
    session.data.other.reset();
    std::erase_if(session.data.derived, isOtherDifference);
    std::vector<std::string> empty;
    for (auto& [pane, each] : session.views) {
        auto* const view = std::get_if<CompareView>(&each);
        if (!view || std::erase_if(view->variants, showsOtherData) == 0) continue;
        view->reference = 0, view->other = 1;
        if (view->variants.size() < 2) empty.push_back(pane);
    }
    for (const std::string& pane : empty) session.views.erase(pane);
    repair(session.dock, paneKeys(session));
}

} // namespace tessera::app
