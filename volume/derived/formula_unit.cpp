#include "volume/derived/formula_unit.h"

#include "volume/base/error.h"
#include "volume/base/unit_product.h"
#include "volume/derived/derived_names.h"
#include "volume/derived/expression.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

namespace tessera::volume {

namespace {

/// What a part of a formula is in; `number`: a plain number, which may be added to any unit.
struct PartUnit {
    std::string unit;
    bool number = false;
};
using MaybeUnit = std::optional<PartUnit>; ///< nothing where it cannot be told

MaybeUnit sum(const MaybeUnit& a, const MaybeUnit& b) {
    if (!a || !b) return {};
    if (a->number) return b;
    if (b->number || a->unit == b->unit) return a;
    return {};
}

MaybeUnit product(const MaybeUnit& a, const MaybeUnit& b, int power) {
    if (!a || !b) return {};
    if (b->number) return a;
    const std::array<UnitPower, 2> factors{{{a->unit, 1}, {b->unit, power}}};
    const ComposedUnit composed = composedUnit(factors);
    if (composed.factor != 1) return {}; // the values do not get that factor
    return PartUnit{a->number && power > 0 ? b->unit : composed.unit};
}

/// Reads a formula as Expression::translated() gives it, which is known to be one.
class FormulaReader {
public:
    FormulaReader(std::string_view text, const std::map<std::string, std::string, std::less<>>& units)
        : text_(text), units_(units) {}

    MaybeUnit read() {
        const MaybeUnit unit = sums();
        return next() == '\0' ? unit : std::nullopt; // a comparison or a choice is left
    }

private:
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
            unit = sum(unit, products());
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
        MaybeUnit unit = single();
        if (!take('^')) return unit;
        const MaybeUnit power = part();
        return unit && unit->number && power && power->number ? unit : std::nullopt;
    }
    MaybeUnit single() {
        if (take('(')) {
            const MaybeUnit inside = sums();
            return take(')') ? inside : std::nullopt;
        }
        if (std::isdigit(static_cast<unsigned char>(next())) != 0 || next() == '.') return number();
        const std::string_view name = word();
        if (const auto known = units_.find(name); known != units_.end()) return PartUnit{known->second};
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
        MaybeUnit unit = sums();
        while (take(',')) unit = sum(unit, sums());
        if (!take(')')) return {};
        const bool keeps = std::ranges::find(kKeep, name) != kKeep.end() || (unit && unit->number);
        return keeps ? unit : std::nullopt;
    }

    std::string_view text_;
    const std::map<std::string, std::string, std::less<>>& units_;
    std::size_t at_ = 0;
};

} // namespace

namespace {

MaybeUnit unitOf(const std::string& formula, const DatasetInfo& info) {
    const FormulaNames names(info);
    const Expression expression(formula, names.names, OtherTimes::Allowed);
    std::map<std::string, std::string, std::less<>> units;
    for (std::size_t i = 0; i < expression.inputs().size(); ++i) {
        const int channel = names.channel[std::size_t(expression.inputs()[i].name)];
        units[expression.variables()[i]] = channel >= 0                     ? info.channel(channel).unit
                                           : channel == FormulaNames::kTime ? info.timeUnit
                                                                            : info.lengthUnit;
    }
    return FormulaReader(expression.translated(), units).read();
}

} // namespace

std::string formulaUnit(const std::string& formula, const DatasetInfo& info) {
    try {
        MaybeUnit unit = PartUnit{{}, true};
        for (const std::string& component : formulaComponents(formula)) unit = sum(unit, unitOf(component, info));
        return unit ? unit->unit : std::string();
    } catch (const Error&) {
        return {};
    }
}

} // namespace tessera::volume
