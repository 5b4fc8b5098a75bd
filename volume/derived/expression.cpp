#include "volume/derived/expression.h"

#include "volume/base/error.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <muParser.h>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

namespace tessera::volume {

namespace {

bool isWord(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || static_cast<unsigned char>(c) > 127;
}

constexpr const char* kVector = "vector";

std::string variable(std::size_t input) {
    return "v" + std::to_string(input) + "_";
}

[[noreturn]] void fail(const std::string& reason, std::size_t position) {
    throw Error(reason, {}, "position " + std::to_string(position + 1));
}

std::string listOf(const std::vector<std::string>& names) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    return list;
}

/// muParser's error message, with the original names.
std::string reasonOf(const mu::Parser::exception_type& error) {
    switch (error.GetCode()) {
    case mu::ecUNEXPECTED_OPERATOR:
        return "an operator is not expected here";
    case mu::ecUNEXPECTED_EOF:
    case mu::ecEMPTY_EXPRESSION:
        return "the formula ends too early";
    case mu::ecUNEXPECTED_VAL:
    case mu::ecUNEXPECTED_VAR:
        return "a value is not expected here: an operator is missing";
    case mu::ecUNEXPECTED_PARENS:
        return "a parenthesis is not expected here";
    case mu::ecMISSING_PARENS:
        return "a closing parenthesis is missing";
    case mu::ecTOO_MANY_PARAMS:
        return "the function takes fewer arguments";
    case mu::ecTOO_FEW_PARAMS:
        return "the function takes more arguments";
    case mu::ecUNASSIGNABLE_TOKEN:
        if (error.GetToken().starts_with(kVector)) return "vector(a, b, c) stands alone: it is no number";
        return "\"" + error.GetToken() + "\" is not known; the functions are " + listOf(formulaFunctions());
    case mu::ecMISSING_ELSE_CLAUSE:
        return "\"?\" needs a \":\"";
    default:
        return error.GetMsg();
    }
}

/// Replaces names by variables; `places[i]` is where character i of the result came from.
struct Translator {
    const std::string& text;
    std::span<const std::string> names;
    bool otherTimes = false;
    std::string out = {};
    std::vector<std::size_t> places = {};
    std::vector<Expression::Input> inputs = {}; ///< in the order in which they come

    void copy(std::string_view part, std::size_t from) {
        for (std::size_t i = 0; i < part.size(); ++i) places.push_back(from);
        out += part;
    }
    void use(const Expression::Input& input, std::size_t from) {
        const auto same = [&](const Expression::Input& own) { return own.name == input.name && own.at == input.at; };
        const auto found = std::find_if(inputs.begin(), inputs.end(), same);
        const auto index = std::size_t(found - inputs.begin());
        if (found == inputs.end()) inputs.push_back(input);
        copy(variable(index), from);
    }
    std::size_t skipBlanks(std::size_t at) const { return std::min(text.find_first_not_of(" \t\n", at), text.size()); }
    /// The longest known name that starts at a position.
    std::optional<int> nameAt(std::size_t at) const {
        std::optional<int> best;
        for (std::size_t i = 0; i < names.size(); ++i) {
            const std::string& name = names[i];
            if (name.empty() || text.compare(at, name.size(), name) != 0) continue;
            const std::size_t end = at + name.size();
            if (isWord(name.back()) && end < text.size() && isWord(text[end])) continue;
            if (!best || name.size() >= names[std::size_t(*best)].size()) best = int(i);
        }
        return best;
    }
    /// A name in back quotes, and its end.
    std::pair<int, std::size_t> quoted(std::size_t at) const {
        const std::size_t end = text.find('`', at + 1);
        if (end == std::string::npos) fail("the closing back quote is missing", at);
        const std::string name = text.substr(at + 1, end - at - 1);
        const auto found = std::find(names.rbegin(), names.rend(), name);
        if (found == names.rend()) fail("no parameter is named \"" + name + "\"", at);
        return {int(names.rend() - found) - 1, end + 1};
    }
    /// Whether "at(" starts here, a value at another time.
    bool otherTimeAt(std::size_t at) const {
        if (!otherTimes || text.compare(at, 2, "at") != 0) return false;
        const std::size_t next = skipBlanks(at + 2);
        return next < text.size() && text[next] == '(';
    }
    /// A time such as "first" or "0.3", and its end.
    std::pair<TimeReference, std::size_t> timeAt(std::size_t at) const {
        std::size_t end = at;
        while (end < text.size() && isWord(text[end])) ++end;
        const std::string_view word = std::string_view(text).substr(at, end - at);
        for (std::size_t i = 0; i < std::size(kOtherTimeNames); ++i)
            if (word == kOtherTimeNames[i] && OtherTime(i) != OtherTime::Time) return {{OtherTime(i), 0}, end};
        TimeReference reference{OtherTime::Time, 0};
        const std::size_t sign = at < text.size() && text[at] == '+' ? 1 : 0;
        const auto read = std::from_chars(text.data() + at + sign, text.data() + text.size(), reference.time);
        if (read.ec != std::errc() || !std::isfinite(reference.time))
            fail("a time is expected here: first, last, previous, next, a number, or other", at);
        return {reference, std::size_t(read.ptr - text.data())};
    }
    /// at(NAME, TIME)
    std::size_t otherTime(std::size_t from) {
        std::size_t at = skipBlanks(text.find('(', from) + 1);
        Expression::Input input;
        if (at < text.size() && text[at] == '`') {
            std::tie(input.name, at) = quoted(at);
        } else if (const auto name = nameAt(at)) {
            input.name = *name;
            at += names[std::size_t(*name)].size();
        } else {
            std::size_t end = at;
            while (end < text.size() && isWord(text[end])) ++end;
            const std::string word = text.substr(at, end - at);
            fail(word.empty() ? "at(...) takes a parameter and a time, as in at(T, first)"
                              : "no parameter is named \"" + word + "\"",
                 at);
        }
        at = skipBlanks(at);
        if (at >= text.size() || text[at] != ',')
            fail("a comma and a time are expected here: at(...) takes a parameter and a time", at);
        at = skipBlanks(at + 1);
        input.position = at + 1;
        std::tie(input.at, at) = timeAt(at);
        at = skipBlanks(at);
        if (at >= text.size() || text[at] != ')') fail("a closing parenthesis is expected here", at);
        use(input, from);
        return at + 1;
    }
    std::size_t number(std::size_t at) {
        std::size_t end = at;
        const auto digits = [&] {
            while (end < text.size() && (std::isdigit(static_cast<unsigned char>(text[end])) || text[end] == '.'))
                ++end;
        };
        digits();
        if (end < text.size() && (text[end] == 'e' || text[end] == 'E')) {
            std::size_t power = end + 1;
            if (power < text.size() && (text[power] == '+' || text[power] == '-')) ++power;
            if (power < text.size() && std::isdigit(static_cast<unsigned char>(text[power]))) {
                end = power;
                digits();
            }
        }
        copy(std::string_view(text).substr(at, end - at), at);
        return end;
    }
    [[noreturn]] void failUnknown(const std::string& name, std::size_t at) const {
        // A name such as "mean(T)" is not found without its parenthesis.
        if (std::ranges::count(text, '(') > std::ranges::count(text, ')'))
            fail("a closing parenthesis is missing", text.size());
        for (const std::string& known : names)
            if (known.ends_with("(" + name + ")"))
                fail("\"" + name + "\" has more than one value here: write " + known + ", for example", at);
        fail("no parameter is named \"" + name + "\"", at);
    }
    std::size_t word(std::size_t at) {
        std::size_t end = at;
        while (end < text.size() && isWord(text[end])) ++end;
        const std::string_view name = std::string_view(text).substr(at, end - at);
        const std::size_t next = text.find_first_not_of(" \t", end);
        const bool function = next != std::string::npos && text[next] == '(';
        if (!function && name != "_pi" && name != "_e") failUnknown(std::string(name), at);
        copy(name, at);
        return end;
    }
    void run() {
        for (std::size_t at = 0; at < text.size();) {
            const char c = text[at];
            const bool inWord = at > 0 && isWord(text[at - 1]);
            if (c == '=' && text.substr(at, 2) != "==" &&
                (at == 0 || std::string_view("=<>!").find(text[at - 1]) == std::string_view::npos))
                fail("\"=\" would assign: compare with \"==\"", at);
            if (c == '`') {
                const auto [name, end] = quoted(at);
                use({name}, at);
                at = end;
            } else if (!inWord && otherTimeAt(at)) {
                at = otherTime(at);
            } else if (const auto name = inWord ? std::nullopt : nameAt(at)) {
                use({*name}, at);
                at += names[std::size_t(*name)].size();
            } else if (std::isdigit(static_cast<unsigned char>(c)) || c == '.') {
                at = number(at);
            } else if (isWord(c)) {
                at = word(at);
            } else {
                copy(std::string_view(text).substr(at, 1), at);
                ++at;
            }
        }
    }
};

} // namespace

std::vector<std::string> formulaFunctions() {
    const mu::Parser parser;
    std::vector<std::string> names;
    for (const auto& [name, callback] : parser.GetFunDef()) names.push_back(name);
    names.insert(std::ranges::upper_bound(names, kVector), kVector);
    return names;
}

std::vector<std::string> formulaComponents(const std::string& text) {
    constexpr const char* kBlanks = " \t\n";
    const std::size_t begin = std::min(text.find_first_not_of(kBlanks), text.size());
    if (text.compare(begin, 6, kVector) != 0) return {text};
    const std::size_t open = text.find_first_not_of(kBlanks, begin + 6);
    if (open == std::string::npos || text[open] != '(') return {text};
    std::vector<std::string> parts;
    std::size_t from = open + 1;
    int depth = 0;
    bool quoted = false;
    const auto close = [&](std::size_t end) {
        parts.push_back(std::string(from, ' ') + text.substr(from, end - from));
        from = end + 1;
    };
    std::size_t at = open;
    for (; at < text.size(); ++at) {
        const char c = text[at];
        if (c == '`') quoted = !quoted;
        if (quoted) continue;
        if (c == '(') ++depth;
        if (c == ')' && --depth == 0) break;
        if (c == ',' && depth == 1) close(at);
    }
    if (at == text.size()) fail("a closing parenthesis is missing", text.size());
    if (text.find_first_not_of(kBlanks, at + 1) != std::string::npos) return {text}; // more than a vector
    close(at);
    if (parts.size() != 3) fail("vector(a, b, c) takes three values", begin);
    return parts;
}

Expression::Expression(const std::string& text, std::span<const std::string> names, OtherTimes otherTimes) {
    if (text.find_first_not_of(" \t\n") == std::string::npos) fail("the formula is empty", 0);
    Translator translator{text, names, otherTimes == OtherTimes::Allowed};
    translator.run();
    translated_ = translator.out;
    std::vector<std::size_t> order(translator.inputs.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const Input &left = translator.inputs[a], &right = translator.inputs[b];
        return std::pair(left.name, left.at.has_value()) < std::pair(right.name, right.at.has_value());
    });
    for (const std::size_t i : order) {
        inputs_.push_back(translator.inputs[i]);
        variables_.push_back(variable(i));
        used_.push_back(translator.inputs[i].name);
    }
    try {
        double zero = 0;
        mu::Parser parser;
        for (const std::string& name : variables_) parser.DefineVar(name, &zero);
        parser.SetExpr(translated_);
        parser.Eval();
        if (parser.GetNumResults() != 1) fail("one value is expected, not several", 0);
    } catch (const mu::Parser::exception_type& error) {
        const int position = error.GetPos();
        const bool inside = position >= 0 && std::size_t(position) < translator.places.size();
        fail(reasonOf(error), inside ? translator.places[std::size_t(position)] : text.size());
    }
}

Expression Expression::rewritten(std::string translated) const {
    Expression out = *this;
    out.translated_ = std::move(translated);
    return out;
}

void Expression::evaluate(std::span<const std::vector<double>> inputs, std::span<double> out) const {
    if (out.empty()) return;
    try {
        mu::Parser parser;
        // Evaluate point by point: muParser's bulk mode would start threads within our own.
        std::vector<double> now(variables_.size());
        for (std::size_t i = 0; i < now.size(); ++i) parser.DefineVar(variables_[i], &now[i]);
        parser.SetExpr(translated_);
        for (std::size_t k = 0; k < out.size(); ++k) {
            for (std::size_t i = 0; i < now.size(); ++i) now[i] = inputs[i][k];
            out[k] = parser.Eval();
        }
    } catch (const mu::Parser::exception_type& error) {
        throw Error(error.GetMsg());
    }
}

} // namespace tessera::volume
