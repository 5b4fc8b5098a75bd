#include "volume/derived/formula_unit.h"

#include "volume/base/error.h"
#include "volume/base/unit_conversion.h"
#include "volume/base/unit_product.h"
#include "volume/derived/derived_names.h"
#include "volume/derived/expression.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdio>
#include <map>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace tessera::volume {

namespace {

/// What a part of a formula is in; `number`: a plain number, which may be added to any unit.
struct PartUnit {
    std::string unit;
    bool number = false;
};
using MaybeUnit = std::optional<PartUnit>; ///< nothing where it cannot be told

/// The unit of a product, or a quotient (power -1), of values in `factor` times their own; V times A is W.
ComposedUnit productUnit(const std::string& a, const std::string& b, int power) {
    if (power > 0)
        for (const auto& [volts, current] : {std::pair(&a, &b), std::pair(&b, &a)})
            if (*volts == "V" && (*current == "A" || current->starts_with("A/"))) return {1, "W" + current->substr(1)};
    const std::array<UnitPower, 2> factors{{{a, 1}, {b, power}}};
    return composedUnit(factors);
}

std::string textOf(double number) {
    std::array<char, 40> digits{};
    std::snprintf(digits.data(), digits.size(), "(%.17g)", number);
    return digits.data();
}

using Units = std::map<std::string, MaybeUnit, std::less<>>;

/// Reads a formula as Expression::translated() gives it, which is known to be one.
class FormulaReader {
public:
    /// `carries`: factors are written where units need them (carriedUnits); else such units cannot be told.
    FormulaReader(std::string_view text, const Units& units, bool carries)
        : text_(text), units_(units), carries_(carries) {}

    MaybeUnit read() {
        const MaybeUnit unit = whole();
        return next() == '\0' ? unit : std::nullopt; // a comparison or a choice is left
    }
    /// The formula with the factors.
    std::string rewritten() {
        std::ranges::stable_sort(written_, {}, &Written::at);
        std::string out;
        std::size_t from = 0;
        for (const Written& each : written_) {
            out.append(text_.substr(from, each.at - from)).append(each.text);
            from = each.at;
        }
        return out + std::string(text_.substr(from));
    }

private:
    struct Written {
        std::size_t at;
        std::string text;
    };
    std::string_view sub(std::size_t begin) const { return text_.substr(begin, at_ - begin); }
    void write(std::size_t at, std::string text) { written_.push_back({at, std::move(text)}); }

    /// The unit of two terms, of which the second begins at `begin` and ends here.
    MaybeUnit sum(const MaybeUnit& a, const MaybeUnit& b, std::size_t begin, const char* what) {
        if (!a || !b) return {};
        if (a->number) return b;
        if (b->number || a->unit == b->unit) return a;
        if (!carries_) return {};
        const auto conversion = unitConversion(b->unit, a->unit);
        const auto named = [](const std::string& unit) { return unit.empty() ? std::string("a ratio") : unit; };
        if (!conversion) throw Error(named(a->unit) + " and " + named(b->unit) + " cannot be " + what);
        write(begin, "((");
        write(at_, ")*" + textOf(conversion->factor) + "+" + textOf(conversion->offset) + ")");
        return a;
    }
    /// Of two factors, of which the second ends here.
    MaybeUnit product(const MaybeUnit& a, const MaybeUnit& b, int power) {
        if (!a || !b) return {};
        if (b->number) return a;
        if (a->number && power > 0) return b;
        const ComposedUnit composed = productUnit(a->unit, b->unit, power);
        if (composed.factor != 1 && !carries_) return {}; // the values do not get that factor
        if (composed.factor != 1) write(at_, "*" + textOf(composed.factor));
        return PartUnit{composed.unit};
    }
    MaybeUnit whole() { return carries_ ? choices() : sums(); }
    MaybeUnit choices() {
        MaybeUnit unit = comparisons();
        if (!take('?')) return unit;
        const MaybeUnit first = choices();
        if (!take(':')) return {};
        next();
        const std::size_t begin = at_;
        return sum(first, choices(), begin, "chosen from");
    }
    /// Also "&&" and "||" of them, which are numbers, too.
    MaybeUnit comparisons() {
        MaybeUnit unit = sums();
        for (char c = next(); std::string_view("<>=!&|").find(c) != std::string_view::npos && c != '\0'; c = next()) {
            while (at_ < text_.size() && std::string_view("<>=!&|").find(text_[at_]) != std::string_view::npos) ++at_;
            next();
            const std::size_t begin = at_;
            const MaybeUnit other = sums();
            const bool joins = c == '&' || c == '|';
            if (!joins) (void)sum(unit, other, begin, "compared");
            unit = joins ? other : PartUnit{{}, true};
        }
        return unit;
    }
    char next() {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
        return at_ < text_.size() ? text_[at_] : '\0';
    }
    bool take(char c) {
        if (next() != c) return false;
        ++at_;
        return true;
    }
    std::string_view word() {
        const std::size_t begin = at_;
        while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '_'))
            ++at_;
        return text_.substr(begin, at_ - begin);
    }
    MaybeUnit sums() {
        MaybeUnit unit = products();
        while (next() == '+' || next() == '-') {
            ++at_;
            next();
            const std::size_t begin = at_;
            const MaybeUnit other = products();
            unit = sum(unit, other, begin, "added");
        }
        return unit;
    }
    MaybeUnit products() {
        MaybeUnit unit = part();
        for (char c = next(); c == '*' || c == '/'; c = next()) {
            ++at_;
            unit = product(unit, part(), c == '*' ? 1 : -1);
        }
        return unit;
    }
    MaybeUnit part() {
        if (take('-') || take('+')) return part();
        next();
        const std::size_t begin = at_;
        const MaybeUnit unit = single();
        if (!take('^')) return unit;
        next();
        const std::size_t exponent = at_;
        const MaybeUnit power = part();
        if (!unit || !power || !power->number) return {};
        return unit->number ? unit : carries_ ? raised(unit->unit, begin, sub(exponent)) : std::nullopt;
    }
    /// Of a power that begins at `begin` and ends here; by a whole number.
    MaybeUnit raised(const std::string& unit, std::size_t begin, std::string_view power) {
        constexpr int kMost = 9;
        int number = 0;
        const auto [end, problem] = std::from_chars(power.data(), power.data() + power.size(), number);
        if (problem != std::errc() || end != power.data() + power.size() || number < 1 || number > kMost) return {};
        const std::array<UnitPower, 1> factor{{{unit, number}}};
        const ComposedUnit composed = composedUnit(factor);
        if (composed.factor != 1) {
            write(begin, "(");
            write(at_, "*" + textOf(composed.factor) + ")");
        }
        return PartUnit{composed.unit};
    }
    MaybeUnit single() {
        if (take('(')) {
            const MaybeUnit inside = whole();
            return take(')') ? inside : std::nullopt;
        }
        if (std::isdigit(static_cast<unsigned char>(next())) != 0 || next() == '.') return number();
        const std::string_view name = word();
        if (const auto known = units_.find(name); known != units_.end()) return known->second;
        if (name == "_pi" || name == "_e") return PartUnit{{}, true};
        return next() == '(' ? function(name) : std::nullopt;
    }
    MaybeUnit number() {
        const auto digits = [&] {
            while (at_ < text_.size() &&
                   (std::isdigit(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '.'))
                ++at_;
        };
        digits();
        if (at_ < text_.size() && (text_[at_] == 'e' || text_[at_] == 'E')) {
            ++at_;
            if (at_ < text_.size() && (text_[at_] == '+' || text_[at_] == '-')) ++at_;
            digits();
        }
        return PartUnit{{}, true};
    }
    MaybeUnit function(std::string_view name) {
        static constexpr std::array<std::string_view, 6> kKeep = {"abs", "avg", "max", "min", "rint", "sum"};
        take('(');
        const bool keeps = std::ranges::find(kKeep, name) != kKeep.end();
        MaybeUnit unit = whole();
        bool numbers = unit && unit->number;
        while (take(',')) {
            next();
            const std::size_t begin = at_;
            const MaybeUnit other = whole();
            numbers = numbers && other && other->number;
            if (keeps) unit = sum(unit, other, begin, "compared");
        }
        if (!take(')')) return {};
        return keeps || numbers ? unit : std::nullopt;
    }

    std::string_view text_;
    const Units& units_;
    bool carries_;
    std::size_t at_ = 0;
    std::vector<Written> written_;
};

MaybeUnit unitOf(const std::string& formula, const DatasetInfo& info) {
    const FormulaNames names(info);
    const Expression expression(formula, names.names, OtherTimes::Allowed);
    Units units;
    for (std::size_t i = 0; i < expression.inputs().size(); ++i) {
        const int channel = names.channel[std::size_t(expression.inputs()[i].name)];
        units[expression.variables()[i]] = PartUnit{channel >= 0                     ? info.channel(channel).unit
                                                    : channel == FormulaNames::kTime ? info.timeUnit
                                                                                     : info.lengthUnit};
    }
    return FormulaReader(expression.translated(), units, false).read();
}

} // namespace

std::string formulaUnit(const std::string& formula, const DatasetInfo& info) {
    try {
        std::optional<std::string> all;
        for (const std::string& component : formulaComponents(formula)) {
            const MaybeUnit unit = unitOf(component, info);
            if (!unit) return {};
            if (unit->number) continue; // fits any unit
            if (all && *all != unit->unit) return {};
            all = unit->unit;
        }
        return all.value_or(std::string());
    } catch (const Error&) {
        return {};
    }
}

CarriedUnits carriedUnits(const Expression& expression, std::span<const std::optional<std::string>> units) {
    Units known;
    for (std::size_t i = 0; i < expression.variables().size(); ++i)
        known[expression.variables()[i]] = units[i] ? MaybeUnit(PartUnit{*units[i], units[i]->empty()}) : std::nullopt;
    FormulaReader reader(expression.translated(), known, true);
    const MaybeUnit unit = reader.read();
    return {expression.rewritten(reader.rewritten()), unit ? unit->unit : std::string()};
}

} // namespace tessera::volume
