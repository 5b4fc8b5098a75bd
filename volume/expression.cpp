#include "volume/expression.h"

#include "volume/error.h"

#include <algorithm>
#include <cctype>
#include <muParser.h>
#include <optional>

namespace tessera::volume {

namespace {

bool isWord(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || static_cast<unsigned char>(c) > 127;
}

std::string variable(int name) {
    return "v" + std::to_string(name) + "_";
}

[[noreturn]] void fail(const std::string& reason, std::size_t position) {
    throw Error(reason, {}, "position " + std::to_string(position + 1));
}

/// What muParser found wrong, without its own words for our names.
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
        return "\"" + error.GetToken() + "\" is not known";
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
    std::string out;
    std::vector<std::size_t> places;
    std::vector<int> used;

    void copy(std::string_view part, std::size_t from) {
        for (std::size_t i = 0; i < part.size(); ++i) places.push_back(from);
        out += part;
    }
    void use(int name, std::size_t from) {
        if (std::find(used.begin(), used.end(), name) == used.end()) used.push_back(name);
        copy(variable(name), from);
    }
    /// The longest name that stands at a place and ends there.
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
    std::size_t quoted(std::size_t at) {
        const std::size_t end = text.find('`', at + 1);
        if (end == std::string::npos) fail("the closing back quote is missing", at);
        const std::string name = text.substr(at + 1, end - at - 1);
        const auto found = std::find(names.rbegin(), names.rend(), name);
        if (found == names.rend()) fail("no parameter is named \"" + name + "\"", at);
        use(int(names.rend() - found) - 1, at);
        return end + 1;
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
    std::size_t word(std::size_t at) {
        std::size_t end = at;
        while (end < text.size() && isWord(text[end])) ++end;
        const std::string_view name = std::string_view(text).substr(at, end - at);
        const std::size_t next = text.find_first_not_of(" \t", end);
        const bool function = next != std::string::npos && text[next] == '(';
        if (!function && name != "_pi" && name != "_e") fail("no parameter is named \"" + std::string(name) + "\"", at);
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
                at = quoted(at);
            } else if (const auto name = inWord ? std::nullopt : nameAt(at)) {
                use(*name, at);
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
        std::sort(used.begin(), used.end());
    }
};

} // namespace

Expression::Expression(const std::string& text, std::span<const std::string> names) {
    if (text.find_first_not_of(" \t\n") == std::string::npos) fail("the formula is empty", 0);
    Translator translator{text, names, {}, {}, {}};
    translator.run();
    translated_ = translator.out;
    used_ = translator.used;
    try {
        double zero = 0;
        mu::Parser parser;
        for (const int name : used_) parser.DefineVar(variable(name), &zero);
        parser.SetExpr(translated_);
        parser.Eval();
        if (parser.GetNumResults() != 1) fail("one value is wanted, not several", 0);
    } catch (const mu::Parser::exception_type& error) {
        const int position = error.GetPos();
        const bool inside = position >= 0 && std::size_t(position) < translator.places.size();
        fail(reasonOf(error), inside ? translator.places[std::size_t(position)] : text.size());
    }
}

void Expression::evaluate(std::span<const std::vector<double>> inputs, std::span<double> out) const {
    if (out.empty()) return;
    try {
        mu::Parser parser;
        // Point by point: muParser's own loop would start threads inside of ours.
        std::vector<double> now(used_.size());
        for (std::size_t i = 0; i < used_.size(); ++i) parser.DefineVar(variable(used_[i]), &now[i]);
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
