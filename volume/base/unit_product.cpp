#include "volume/base/unit_product.h"

#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace tessera::volume {

namespace {

using Powers = std::vector<std::pair<std::string, int>>; ///< in order of first mention

void multiply(Powers& into, const std::string& name, int power) {
    for (auto& [known, sum] : into)
        if (known == name) {
            sum += power;
            return;
        }
    into.emplace_back(name, power);
}

/// Parses one unit; `at` is the position in the text.
class UnitReader {
public:
    explicit UnitReader(std::string_view text) : text_(text) {}

    std::optional<Powers> read() {
        Powers out;
        if (!product(out, 1, false) || at_ < text_.size()) return std::nullopt;
        return out;
    }

private:
    bool take(std::string_view word) {
        if (text_.substr(at_).starts_with(word)) {
            at_ += word.size();
            return true;
        }
        return false;
    }
    static bool isLetter(char c) {
        return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '%' || c == '_' || (c & 0x80) != 0;
    }
    /// True where "·", "²" or "³" begins, whose bytes are no letters.
    bool atSign() const {
        const std::string_view rest = text_.substr(at_);
        return rest.starts_with("\u00b7") || rest.starts_with("\u00b2") || rest.starts_with("\u00b3");
    }

    bool product(Powers& out, int sign, bool bracket) {
        int next = sign;
        bool any = false;
        while (at_ < text_.size()) {
            if (bracket && text_[at_] == ')') break;
            if (take("\u00b7") || take("*") || take(".") || take(" ")) continue;
            if (take("/")) {
                if (next != sign) return false; // "a//b"
                next = -sign;
                continue;
            }
            if (take("(")) {
                if (!product(out, next, true) || !take(")")) return false;
            } else if (!factor(out, next)) {
                return false;
            }
            next = sign;
            any = true;
        }
        return any && next == sign;
    }

    bool factor(Powers& out, int sign) {
        std::string name;
        while (at_ < text_.size() && isLetter(text_[at_]) && !atSign()) name += text_[at_++];
        if (name.empty()) return take("1"); // as in "1/s"
        if (take("\u00b2")) return multiply(out, name, 2 * sign), true;
        if (take("\u00b3")) return multiply(out, name, 3 * sign), true;
        const bool caret = take("^");
        const int exponentSign = take("-") ? -1 : 1;
        int exponent = 0, digits = 0;
        for (; at_ < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at_])) && digits < 2; ++digits)
            exponent = exponent * 10 + (text_[at_++] - '0');
        if (digits == 0 && (caret || exponentSign < 0)) return false;
        multiply(out, name, sign * (digits == 0 ? 1 : exponentSign * exponent));
        return true;
    }

    std::string_view text_;
    std::size_t at_ = 0;
};

struct Prefixed {
    std::string_view name, base;
    double factor;
};
constexpr std::array<Prefixed, 10> kPrefixed = {{{"nm", "m", 1e-9},
                                                 {"um", "m", 1e-6},
                                                 {"\u00b5m", "m", 1e-6},
                                                 {"mm", "m", 1e-3},
                                                 {"cm", "m", 1e-2},
                                                 {"dm", "m", 1e-1},
                                                 {"km", "m", 1e3},
                                                 {"ms", "s", 1e-3},
                                                 {"min", "s", 60},
                                                 {"h", "s", 3600}}};

std::string written(const std::string& name, int power) {
    return power == 1 ? name : name + std::to_string(power);
}

std::string joined(const Powers& all) {
    std::string above, below;
    int divisors = 0;
    for (const auto& [name, power] : all) {
        if (power > 0) above += (above.empty() ? "" : " ") + written(name, power);
        if (power >= 0) continue;
        below += (below.empty() ? "" : " ") + written(name, -power);
        ++divisors;
    }
    if (divisors == 0) return above;
    return (above.empty() ? "1" : above) + (divisors == 1 ? "/" + below : "/(" + below + ")");
}

} // namespace

std::optional<std::vector<std::pair<std::string, int>>> unitPowers(std::string_view unit) {
    if (unit == "-") return Powers{};
    return UnitReader(unit).read();
}

ComposedUnit composedUnit(std::span<const UnitPower> factors) {
    ComposedUnit out;
    Powers all;
    for (const UnitPower& factor : factors) {
        if (factor.unit.empty() || factor.unit == "-") continue;
        const std::optional<Powers> read = unitPowers(factor.unit);
        if (!read) {
            multiply(all, factor.unit, factor.power);
            continue;
        }
        for (const auto& [name, power] : *read) {
            std::string base = name;
            for (const Prefixed& prefixed : kPrefixed)
                if (prefixed.name == name) {
                    base = prefixed.base;
                    out.factor *= std::pow(prefixed.factor, power * factor.power);
                }
            multiply(all, base, power * factor.power);
        }
    }
    std::erase_if(all, [](const auto& entry) { return entry.second == 0; });
    out.unit = joined(all);
    return out;
}

} // namespace tessera::volume
