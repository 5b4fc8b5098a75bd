#include "app/data/number_origin.h"

#include "app/ui/ticks.h"
#include "codec/container/metadata.h"
#include "volume/base/printable.h"
#include "volume/derived/other_source.h"
#include "volume/field/mesh_origin.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tessera::app {

namespace {

constexpr std::size_t kMostBounds = 3; ///< listed individually
constexpr std::string_view kOriginal = " as computed";

/// Rounded up to two digits, since it is stated as an upper bound.
double twoDigitsUp(double value) {
    if (!(value > 0)) return 0;
    const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1);
    return std::ceil(value / unit * (1 - 1e-12)) * unit;
}

bool isOriginal(const NumberOrigin& origin, const volume::DatasetInfo& info, const volume::Channel& channel) {
    return origin.originals && info.parameters[std::size_t(channel.parameter)].name.ends_with(kOriginal);
}

std::string errorText(const NumberOrigin& origin, const volume::DatasetInfo& info,
                      const std::vector<volume::Channel>& channels) {
    std::vector<volume::Channel> bounded;
    for (const volume::Channel& channel : channels)
        if (errorBound(origin, info, channel) > 0) bounded.push_back(channel);
    if (bounded.empty()) return {};
    if (channels.size() == 1)
        return "error at most " + boundWithUnit(errorBound(origin, info, channels.front()), channels.front().unit);
    if (bounded.size() > kMostBounds && origin.maxError > 0)
        return "error at most " + formatNumber(100 * twoDigitsUp(origin.maxError)) + " % of each range";
    std::string text;
    for (const volume::Channel& channel : bounded)
        text += (text.empty() ? "error at most " : ", ") + channel.name + " " +
                boundWithUnit(errorBound(origin, info, channel), channel.unit);
    return text;
}

std::string readFromText(const NumberOrigin& origin, const volume::DatasetInfo& info,
                         const std::vector<volume::Channel>& channels) {
    std::string computed = origin.mesh ? "resampled" : "as computed";
    if (!origin.stored) return computed;
    const std::string error = errorText(origin, info, channels);
    const bool onGrid = origin.lattice == "CC", exactParts = origin.unpacked && origin.corrected;
    std::string text = onGrid && error.empty() ? computed
                       : onGrid                ? "stored on CC, " + error
                       : exactParts
                           ? "stored on " + origin.lattice + " and corrected" + (error.empty() ? "" : ", " + error)
                       : error.empty() ? "resampled to " + origin.lattice + ", stored losslessly"
                                       : "resampled to " + origin.lattice + ", stored with an " + error;
    if (origin.mesh && onGrid && text != computed) text = "resampled, " + text;
    if (origin.unpacked && !exactParts) text += ", unpacked to the grid of the source";
    if (origin.discarded) text += ", without bricks of little importance";
    return text;
}

} // namespace

NumberOrigin computedOrigin(const volume::DatasetInfo& info) {
    NumberOrigin origin;
    origin.mesh = volume::isResampled(info);
    origin.parameters = int(info.parameters.size());
    return origin;
}

NumberOrigin storedOrigin(const codec::Metadata& metadata, bool unpacked) {
    NumberOrigin origin = computedOrigin(metadata.info);
    origin.stored = true;
    origin.lattice = metadata.alternating                                     ? "D4*"
                     : metadata.info.lattice.kind == volume::LatticeKind::BCC ? "BCC"
                                                                              : "CC";
    origin.exact = metadata.lossless;
    origin.maxError = metadata.lossless ? 0 : metadata.maxError;
    origin.absError = metadata.lossless ? 0 : metadata.options.absError;
    origin.ofComponents = metadata.options.ofComponents;
    origin.discarded = metadata.options.discard > 0;
    origin.unpacked = unpacked;
    const auto isKnown = [](const std::optional<codec::ResampleError>& error) { return error.has_value(); };
    origin.corrected = unpacked && !metadata.corrections.empty() && std::ranges::all_of(metadata.resampled, isKnown);
    if (origin.corrected)
        for (const auto& error : metadata.resampled) origin.resampleErrors.push_back(error->largest);
    return origin;
}

double errorBound(const NumberOrigin& origin, const volume::DatasetInfo& info, const volume::Channel& channel) {
    const volume::Parameter& parameter = info.parameters[std::size_t(channel.parameter)];
    const bool derived = origin.parameters >= 0 && channel.parameter >= origin.parameters;
    if (parameter.categorical || derived || isOriginal(origin, info, channel)) return 0;
    const auto ofAll = [&](double bound) {
        return channel.magnitude ? bound * std::sqrt(double(channel.component)) : bound;
    };
    if (std::size_t(channel.parameter) < origin.resampleErrors.size())
        return ofAll(origin.resampleErrors[std::size_t(channel.parameter)]);
    if (origin.exact) return 0;
    const auto boundOf = [&](double extent) {
        const double bound = origin.maxError * extent;
        return origin.absError > 0 ? (bound > 0 ? std::min(bound, origin.absError) : origin.absError) : bound;
    };
    double widest = 0, squares = 0;
    for (int c = 0; c < std::min(parameter.components, int(parameter.ranges.size())); ++c) {
        const double extent = parameter.ranges[std::size_t(c)].hi - parameter.ranges[std::size_t(c)].lo;
        if (origin.ofComponents && c == channel.component) return boundOf(extent);
        widest = std::max(widest, extent);
        squares += boundOf(extent) * boundOf(extent);
    }
    return origin.ofComponents && channel.magnitude ? std::sqrt(squares) : ofAll(boundOf(widest));
}

std::optional<PackingBound> packingBound(const NumberOrigin& origin, const volume::DatasetInfo& info,
                                         const volume::Channel& channel) {
    const bool derived = origin.parameters >= 0 && channel.parameter >= origin.parameters;
    if (derived || info.parameters[std::size_t(channel.parameter)].categorical) return std::nullopt;
    if (!origin.stored || isOriginal(origin, info, channel)) return PackingBound{};
    if (origin.discarded) return std::nullopt;
    const bool measured = std::size_t(channel.parameter) < origin.resampleErrors.size();
    const bool resampled = origin.lattice != "CC";
    const double most = errorBound(origin, info, channel);
    if (resampled && !measured && !(most > 0)) return std::nullopt; // exact on its lattice, which has other samples
    return PackingBound{most, measured, resampled && !measured};
}

std::string boundKind(const PackingBound& bound) {
    if (bound.measured) return "largest error measured when packed";
    return bound.beforeLattice ? "bound of the archive, without resampling" : "bound of the archive";
}

std::string boundWithUnit(double bound, std::string_view unit) {
    return formatQuantity(twoDigitsUp(bound), unit);
}

std::vector<volume::DerivedParameter> withBounds(std::vector<volume::DerivedParameter> derived,
                                                 const NumberOrigin& origin, const volume::DatasetInfo& info) {
    for (volume::DerivedParameter& each : derived)
        if (auto* const uncertainty = std::get_if<volume::UncertaintyRecipe>(&each.recipe)) {
            const auto channel = info.findChannel(uncertainty->channel);
            const auto bound = channel ? packingBound(origin, info, info.channel(*channel)) : std::nullopt;
            uncertainty->bound = bound ? std::optional(bound->most) : std::nullopt;
        }
    return derived;
}

bool boundsNumbers(const NumberOrigin& origin) {
    return !origin.alongTime && (!origin.stored || (!origin.discarded && (origin.lattice == "CC" || origin.corrected)));
}

double numberError(const NumberOrigin& origin, const volume::DatasetInfo& info, const volume::Channel& channel) {
    const bool derived = origin.parameters >= 0 && channel.parameter >= origin.parameters;
    if (!origin.stored || (origin.exact && origin.lattice == "CC")) return 0;
    return boundsNumbers(origin) && !derived ? errorBound(origin, info, channel) : std::nan("");
}

std::vector<bool> knownStatistics(const NumberOrigin& origin, const volume::DatasetInfo& info,
                                  const std::vector<int>& channels, const std::string& label,
                                  const std::vector<double>& times) {
    std::vector<bool> known(channels.size(), false);
    for (std::size_t c = 0; origin.computed && c < channels.size(); ++c)
        known[c] = std::ranges::all_of(times, [&](double time) {
            return volume::knownStatistics(*origin.computed, time, label, {info.channel(channels[c]).name}).has_value();
        });
    return known;
}

std::string originText(const NumberOrigin& origin, const volume::DatasetInfo& info, const std::vector<int>& channels,
                       const std::vector<bool>& known) {
    std::vector<int> others;
    std::string names;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        if (c < known.size() && known[c]) continue;
        others.push_back(channels[c]);
        names += (names.empty() ? "" : ", ") + info.channel(channels[c]).name;
    }
    if (channels.empty() || others.size() == channels.size()) return originText(origin, info, channels);
    const std::string computed = origin.mesh ? "resampled" : "as computed";
    return others.empty() ? computed : computed + "; " + names + ": " + originText(origin, info, others);
}

std::string originText(const NumberOrigin& origin, const volume::DatasetInfo& info, const std::vector<int>& channels) {
    const std::vector<volume::Channel> all = info.channels();
    std::vector<volume::Channel> read, original;
    bool derived = false, other = false;
    const auto isOther = [&](const volume::Channel& channel) {
        return info.parameters[std::size_t(channel.parameter)].name.ends_with(volume::kOtherSuffix);
    };
    const auto add = [&](const volume::Channel& channel) {
        if (!origin.other.empty() && isOther(channel))
            other = true;
        else if (origin.parameters >= 0 && channel.parameter >= origin.parameters)
            derived = true;
        else
            (isOriginal(origin, info, channel) ? original : read).push_back(channel);
    };
    if (channels.empty()) std::for_each(all.begin(), all.end(), add);
    for (const int channel : channels) add(all[std::size_t(channel)]);
    std::string text;
    if (other && read.empty() && original.empty() && !derived) return "other data: " + origin.other;
    if (!read.empty() || original.empty()) {
        const bool onlyDerived = read.empty() && derived;
        if (onlyDerived)
            for (const volume::Channel& channel : all)
                if (channel.parameter < origin.parameters && !isOriginal(origin, info, channel))
                    read.push_back(channel);
        text = (onlyDerived ? "derived from samples " : "") + readFromText(origin, info, read);
        if (derived && !onlyDerived) text += "; derived parameters from these";
        if (!original.empty()) text += "; originals as computed";
    } else {
        text = "as computed";
    }
    if (other || (derived && !origin.other.empty())) text += "; other data: " + origin.other;
    return text + (origin.alongTime ? ", interpolated along time" : "");
}

std::string originLine(const NumberOrigin& origin, const volume::DatasetInfo& info, const std::vector<int>& channels) {
    return "# numbers: " + printable(originText(origin, info, channels)) + "\n";
}

} // namespace tessera::app
