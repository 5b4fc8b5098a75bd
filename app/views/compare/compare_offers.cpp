#include "app/views/compare/compare_offers.h"

#include "app/described/describe_json.h"
#include "app/described/key_words.h"
#include "app/edits/compare_files.h"
#include "app/ui/ticks.h"
#include "codec/container/json_text.h"
#include "codec/remote/address.h"

#include <algorithm>

namespace tessera::app {

namespace {

constexpr std::size_t kMostTimes = 8; ///< offered one by one

CompareVariant changed(std::string name, std::string path, std::string value) {
    return {.name = std::move(name), .changes = {{std::move(path), std::move(value)}}};
}

/// Offers of one variant each, after one of all of them.
CompareOffers oneByOne(std::string title, const std::string& all, std::vector<CompareVariant> variants) {
    CompareOffers group;
    group.title = std::move(title);
    if (variants.size() > 1) group.offers.push_back({all, variants});
    for (CompareVariant& variant : variants) {
        const std::string name = variant.name;
        group.offers.push_back({name, {std::move(variant)}});
    }
    return group;
}

/// One variant for each name of a choice but the one that is set.
std::vector<CompareVariant> ofNames(const std::string& path, std::span<const std::string_view> names, std::size_t set) {
    std::vector<CompareVariant> variants;
    for (std::size_t i = 0; i < names.size(); ++i)
        if (i != set) variants.push_back(changed(keyWords(names[i]), path, std::string(names[i])));
    return variants;
}

/// Up to kMostTimes of the other times, spread evenly.
CompareOffers otherTimes(const Session& session, const volume::DatasetInfo& info) {
    std::vector<double> times;
    for (const double time : info.times)
        if (time != session.time) times.push_back(time);
    if (times.size() > kMostTimes) {
        std::vector<double> some;
        for (std::size_t i = 0; i < kMostTimes; ++i) some.push_back(times[i * (times.size() - 1) / (kMostTimes - 1)]);
        times = some;
    }
    std::vector<CompareVariant> variants;
    for (const double time : times)
        variants.push_back(changed(formatQuantity(time, info.timeUnit), "/time", jsonText(toJson(time))));
    CompareOffers group = oneByOne("Another time", "Each of these", std::move(variants));
    // The farther end differs most.
    if (!times.empty() && session.time - times.front() < times.back() - session.time) group.first = times.size() - 1;
    return group;
}

/// The path of a setting of the first layer.
std::string ofFirstLayer(const char* key) {
    return std::string("/layers/0/technique/") + key;
}

/// What is shown, of the other file, and the difference.
CompareOffers otherFile(const Session& session, const volume::DatasetInfo& info) {
    std::vector<CompareVariant> variants = fileVariants(session, info);
    if (variants.empty()) return {};
    variants.erase(variants.begin());
    return oneByOne("The other file", "Both files and their difference", std::move(variants));
}

CompareOffers otherParameters(const Session& session, const volume::DatasetInfo& info) {
    std::vector<CompareVariant> variants;
    if (!session.layers.empty())
        std::visit(
            [&](const auto& layer) {
                if constexpr (requires { layer.style; }) // the value of a surface is none of another parameter
                    for (const volume::Channel& channel : info.channels())
                        if (channel.name != layer.channel &&
                            !info.parameters[std::size_t(channel.parameter)].categorical)
                            variants.push_back(changed(channel.name, ofFirstLayer("channel"), channel.name));
            },
            session.layers[0].technique);
    return oneByOne("Another parameter", "One view per parameter", std::move(variants));
}

/// Drawing styles of a layer but the one that it has.
std::vector<CompareVariant> otherLooks(const vis::Look& now, bool composite) {
    std::vector<CompareVariant> looks;
    for (const std::string_view name : vis::Look::kPresetNames) {
        if (composite && now == *vis::Look::preset(name)) continue;
        CompareVariant look = changed(keyWords(name), ofFirstLayer("look"), std::string(name));
        if (!composite) look.changes[ofFirstLayer("style")] = vis::kVolumeStyleNames[0];
        looks.push_back(std::move(look));
    }
    return looks;
}

/// Drawing styles of the first layer, a choice of which can be added at once, then other ways to sum up along a ray.
CompareOffers otherStyles(const Session& session) {
    static constexpr std::string_view kTelling[] = {"illustration", "cartoon",  "charcoal",
                                                    "pencil",       "hatching", "stipple"};
    if (session.layers.empty()) return {};
    CompareOffers group;
    group.title = "Another style";
    const vis::Technique& technique = session.layers[0].technique;
    const auto* volume = std::get_if<vis::VolumeLayer>(&technique);
    std::visit(
        [&](const auto& own) {
            if constexpr (requires { own.look; }) {
                group = oneByOne(group.title, "Six drawing styles",
                                 otherLooks(own.look, !volume || volume->style == vis::RayStyle::Composite));
                std::erase_if(group.offers.front().variants, [](const CompareVariant& variant) {
                    return std::ranges::find(kTelling, variant.name) == std::end(kTelling);
                });
            }
        },
        technique);
    if (!volume) return group;
    const CompareOffers rays =
        oneByOne(group.title, "Every style of rays",
                 ofNames(ofFirstLayer("style"), vis::kVolumeStyleNames, std::size_t(volume->style)));
    group.offers.insert(group.offers.end(), rays.offers.begin(), rays.offers.end());
    return group;
}

/// How data that are not packed look when they are, lossless or with a bounded error.
CompareOffers compressions(const Session& session) {
    const DataRef& data = session.data;
    if (data.files.size() == 1 && codec::namesArchive(data.files[0].absolutePath)) return {};
    std::vector<CompareVariant> variants;
    if (data.packed) variants.push_back(changed("as computed", "/data/packed", "null"));
    const auto packed = [&](const char* name, const char* options) {
        variants.push_back(changed(name, "/data/packed", options));
    };
    packed("packed, lossless", R"({"lossless": true})");
    packed("packed, error 0.1 % of range", R"({"lossless": false, "maxError": 0.001})");
    packed("packed, error 1 % of range", R"({"lossless": false, "maxError": 0.01})");
    return oneByOne("Exact or compressed", "Each of these", std::move(variants));
}

CompareOffers technique(CompareOffers group) {
    group.technique = true;
    return group;
}

} // namespace

std::vector<CompareOffers> compareOffers(const Session& session, const volume::DatasetInfo& info,
                                         const volume::DatasetInfo* numbers) {
    std::vector<CompareOffers> groups{otherFile(session, info), otherTimes(session, info),
                                      otherParameters(session, info), otherStyles(session), compressions(session)};
    groups.push_back(
        technique(oneByOne("Another filter", "Every filter",
                           ofNames("/render/filter", vis::kFilterNames, std::size_t(session.render.filter)))));
    if (!session.layers.empty())
        if (const auto* layer = std::get_if<vis::VolumeLayer>(&session.layers[0].technique))
            groups.push_back(technique(oneByOne("Another classification", "Every classification",
                                                ofNames(ofFirstLayer("classification"), vis::kClassificationNames,
                                                        std::size_t(layer->classification)))));
    groups.push_back(
        technique(oneByOne("Another proxy geometry", "Every proxy geometry",
                           ofNames("/render/proxy", vis::kProxyNames, std::size_t(session.render.proxy)))));
    const DataRef& data = session.data;
    const volume::DatasetInfo& samples = numbers ? *numbers : info;
    const PictureLattice lattice = latticeFor(data.lattice, samples);
    const bool grid = lattice == PictureLattice::Grid;
    const auto offer = [&](const char* name, PictureLattice other) {
        groups.push_back(technique(
            oneByOne("The other lattice", name,
                     {changed(name, "/data/lattice", std::string(kPictureLatticeNames[std::size_t(other)]))})));
    };
    if (lattice == PictureLattice::Even)
        offer("By cells", PictureLattice::Grid);
    else if (grid && drawsToScale(PictureLattice::Even, samples))
        offer("To scale", PictureLattice::Even);
    else if (!grid || info.lattice.kind == volume::LatticeKind::CC)
        offer(grid ? "BCC" : "CC", grid ? PictureLattice::BodyCentred : PictureLattice::Grid);
    std::erase_if(groups, [](const CompareOffers& group) { return group.offers.empty(); });
    return groups;
}

std::vector<CompareVariant> shownVariants(const CompareView& view, const Session& session,
                                          const volume::DatasetInfo& info) {
    if (!view.variants.empty()) return view.variants;
    std::vector<CompareVariant> variants{{}};
    const std::vector<CompareOffers> groups = compareOffers(session, info);
    if (!groups.empty()) variants.push_back(groups.front().offers.front().variants[groups.front().first]);
    return variants;
}

} // namespace tessera::app
