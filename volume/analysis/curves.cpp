#include "volume/analysis/curves.h"

#include "volume/base/error.h"
#include "volume/base/unit_product.h"
#include "volume/derived/expression.h"
#include "volume/derived/formula_unit.h"
#include "volume/field/quantities.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <set>

namespace tessera::volume {

namespace {

enum class Kind { Mean, Min, Max, Deviation, Share, Volume, Integral };
constexpr std::array<std::string_view, 7> kKinds = {"mean", "min", "max", "deviation", "share", "volume", "integral"};

/// The meaning of a name in a formula.
struct Term {
    enum class What { Time, Quantity, Statistic } what = What::Time;
    int index = 0; ///< of the quantity, or of the channel
    Kind kind = Kind::Mean;
};

struct Terms {
    std::vector<std::string> names;
    std::vector<Term> terms;
};

Terms termsOf(const DatasetInfo& info) {
    Terms out;
    const auto add = [&out](std::string name, Term term) {
        out.names.push_back(std::move(name));
        out.terms.push_back(term);
    };
    const std::vector<Channel> channels = info.channels();
    for (std::size_t c = 0; c < channels.size(); ++c)
        for (std::size_t kind = 0; kind < kKinds.size(); ++kind)
            add(std::string(kKinds[kind]) + "(" + channels[c].name + ")",
                {Term::What::Statistic, static_cast<int>(c), static_cast<Kind>(kind)});
    add("time", {});
    if (info.timeName != "time") add(info.timeName, {});
    for (std::size_t q = 0; q < info.quantities.size(); ++q) // of equal names the last one is used
        add(info.quantities[q].name, {Term::What::Quantity, static_cast<int>(q), {}});
    return out;
}

/// Factor for values times volumes in the unit of lengths: mol/m3 times mm3 are 1e-9 mol.
ComposedUnit integralUnit(const DatasetInfo& info, int channel) {
    const std::array<UnitPower, 2> factors{{{info.channel(channel).unit, 1}, {info.lengthFactor(), 3}}};
    return composedUnit(factors);
}

/// "" of a pure number, nothing where no unit is stated.
std::optional<std::string> unitOf(const DatasetInfo& info, const Term& term) {
    const auto stated = [](std::string unit) { return unit.empty() ? std::nullopt : std::optional(std::move(unit)); };
    if (term.what == Term::What::Time) return stated(info.timeUnit);
    if (term.what == Term::What::Quantity) return stated(info.quantities[std::size_t(term.index)].unit);
    if (term.kind == Kind::Share) return std::string();
    if (term.kind == Kind::Volume) return stated(info.lengthUnit.empty() ? std::string() : info.lengthUnit + "3");
    if (term.kind == Kind::Integral) return stated(integralUnit(info, term.index).unit);
    return stated(info.channel(term.index).unit);
}

/// A formula with its inputs, whose values are in one unit as far as it can be told.
struct Formula {
    std::string text;
    CarriedUnits carried;
    std::vector<Term> used;

    Formula(std::string formula, const DatasetInfo& info, const Terms& known)
        : text(std::move(formula)), carried(read(text, info, known)) {
        for (const int name : carried.expression.used()) used.push_back(known.terms[std::size_t(name)]);
    }

    static CarriedUnits read(const std::string& text, const DatasetInfo& info, const Terms& known) {
        const Expression expression(text, known.names);
        std::vector<std::optional<std::string>> units;
        for (const int name : expression.used()) units.push_back(unitOf(info, known.terms[std::size_t(name)]));
        try {
            return carriedUnits(expression, units);
        } catch (const Error& error) {
            throw Error(error.reason(), {}, text);
        }
    }
};

/// Statistics of the channels that are named, at one time.
Statistics statisticsAt(const BrickSource& source, const CurvesQuery& query, const std::vector<int>& named, int time,
                        const Progress& progress) {
    StatisticsQuery ask{
        .channels = named, .pairs = {}, .time = time, .level = query.level, .bins = 1, .ranges = {}, .doi = {}};
    const auto positionOf = [&ask](int channel) {
        const auto found = std::ranges::find(ask.channels, channel);
        if (found != ask.channels.end()) return static_cast<std::size_t>(found - ask.channels.begin());
        ask.channels.push_back(channel);
        return ask.channels.size() - 1;
    };
    std::vector<std::size_t> positions;
    for (const int channel : query.doiChannels) positions.push_back(positionOf(channel));
    const std::optional<std::size_t> label = query.label >= 0 ? std::optional(positionOf(query.label)) : std::nullopt;
    if (label || query.doi)
        ask.doi = [&query, positions, label](std::span<const float> values, glm::dvec3 position) {
            if (label) {
                const float value = values[*label];
                if (!(std::abs(value) < 2e9f) ||
                    std::ranges::find(query.regions, static_cast<int>(std::lround(value))) == query.regions.end())
                    return 0.0;
            }
            if (!query.doi) return 1.0;
            std::vector<float> given;
            for (const std::size_t at : positions) given.push_back(values[at]);
            return query.doi(given, position);
        };
    return computeStatistics(source, ask, progress);
}

/// The same from what is known, with the channels that are not, or are `integrated`, counted.
Statistics knownOrCounted(const BrickSource& source, const CurvesQuery& query, const std::vector<int>& channels,
                          const std::set<int>& integrated, int time, const Progress& progress) {
    std::vector<std::optional<ChannelStatistics>> known(channels.size());
    std::vector<int> others;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        if (query.known && !query.doi) known[c] = query.known(channels[c], time);
        if (!known[c] || integrated.contains(channels[c])) others.push_back(channels[c]);
    }
    Statistics counted;
    if (!others.empty()) counted = statisticsAt(source, query, others, time, progress);
    Statistics out;
    std::size_t next = 0;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const bool isCounted = !known[c] || integrated.contains(channels[c]);
        ChannelStatistics of = isCounted ? counted.channels[next++] : ChannelStatistics();
        if (known[c]) {
            known[c]->all.integral = of.all.integral;
            known[c]->inside.integral = of.inside.integral;
            of = std::move(*known[c]);
        }
        out.channels.push_back(std::move(of));
    }
    return out;
}

double valueOf(const ChannelStatistics& statistics, bool parted, Kind kind) {
    const Summary& of = parted ? statistics.inside : statistics.all;
    switch (kind) {
    case Kind::Mean:
        return of.mean;
    case Kind::Min:
        return of.min;
    case Kind::Max:
        return of.max;
    case Kind::Deviation:
        return of.deviation;
    case Kind::Share:
        return statistics.all.samples > 0 ? of.samples / statistics.all.samples : std::nan("");
    case Kind::Volume:
        return of.volume;
    case Kind::Integral:
        return of.integral;
    }
    return std::nan("");
}

} // namespace

Curves computeCurves(const BrickSource& source, const CurvesQuery& query, const Progress& progress) {
    const DatasetInfo& info = source.info();
    const Terms known = termsOf(info);
    std::vector<Formula> formulas;
    formulas.emplace_back(query.x, info, known);
    for (const std::string& y : query.y) formulas.emplace_back(y, info, known);

    std::set<int> wanted, integrated;
    for (const Formula& formula : formulas)
        for (const Term& term : formula.used)
            if (term.what == Term::What::Statistic) {
                wanted.insert(term.index);
                if (term.kind == Kind::Integral) integrated.insert(term.index);
            }
    const std::vector<int> channels(wanted.begin(), wanted.end());
    const bool parted = query.label >= 0 || query.doi;
    const std::size_t times = info.times.size();
    std::vector<Statistics> statistics(channels.empty() ? 0 : times);
    for (std::size_t t = 0; t < statistics.size(); ++t)
        statistics[t] = knownOrCounted(source, query, channels, integrated, static_cast<int>(t),
                                       progress.part(double(t) / double(times), double(t + 1) / double(times)));

    const auto valuesOf = [&](const Term& term) {
        if (term.what == Term::What::Time) return info.times;
        if (term.what == Term::What::Quantity) return info.quantities[std::size_t(term.index)].values;
        const auto position = static_cast<std::size_t>(std::ranges::find(channels, term.index) - channels.begin());
        std::vector<double> values;
        const double factor = term.kind == Kind::Integral ? integralUnit(info, term.index).factor : 1;
        for (const Statistics& at : statistics)
            values.push_back(factor * valueOf(at.channels[position], parted, term.kind));
        return values;
    };
    const auto curveOf = [&](const Formula& formula) {
        std::vector<std::vector<double>> inputs;
        for (const Term& term : formula.used) inputs.push_back(valuesOf(term));
        const bool axis = formula.used.size() == 1 && formula.used[0].what == Term::What::Time;
        const bool plain = axis && (formula.text == "time" || formula.text == info.timeName);
        Curve curve{plain ? info.timeName : formula.text, formula.carried.unit, std::vector<double>(times)};
        formula.carried.expression.evaluate(inputs, curve.values);
        return curve;
    };
    Curves out{info.times, info.timeName, info.timeUnit, curveOf(formulas[0]), {}};
    for (std::size_t f = 1; f < formulas.size(); ++f) out.y.push_back(curveOf(formulas[f]));
    return out;
}

std::vector<std::string> curveNames(const DatasetInfo& info) {
    return termsOf(info).names;
}

CellQuantities cellQuantities(const DatasetInfo& info) {
    const auto lower = [](std::string text) {
        std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        return text;
    };
    std::vector<Quantity> known = info.quantities;
    known.push_back({info.timeName, info.timeUnit, info.times}); // e.g. the voltage of a series of operating points
    CellQuantities cell;
    // A stated unit takes precedence over a name.
    for (const bool byUnit : {true, false})
        for (const Quantity& quantity : known) {
            const std::string name = lower(quantity.name);
            const bool volts = byUnit ? quantity.unit == "V" || quantity.unit == "mV" : name.find("volt") != name.npos;
            const bool current =
                byUnit ? quantity.unit == "A" || quantity.unit.starts_with("A/") : name.find("current") != name.npos;
            if (volts && cell.voltage.empty()) cell.voltage = quantity.name;
            if (current && cell.current.empty()) cell.current = quantity.name;
        }
    return cell;
}

std::vector<std::vector<double>> curveRows(const Curves& curves) {
    std::vector<std::vector<double>> rows;
    for (std::size_t t = 0; t < curves.times.size(); ++t) {
        std::vector<double>& row = rows.emplace_back(std::vector<double>{curves.times[t]});
        if (curves.x.values != curves.times) row.push_back(curves.x.values[t]);
        for (const Curve& curve : curves.y) row.push_back(curve.values[t]);
    }
    return rows;
}

} // namespace tessera::volume
