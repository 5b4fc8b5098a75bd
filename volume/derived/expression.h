#pragma once

#include "volume/derived/other_time.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Formulas over named values, read by muParser: + - * / ^, comparisons, && ||, a ? b : c, and functions. Names may be
/// those of channels ("U.x", "|U|"); any other name is written between back quotes.
namespace tessera::volume {

/// Whether a formula may name values at another time: at(T, first), at(T, 0.3), with T a name.
enum class OtherTimes { Refused, Allowed };

/// The functions that formulas know, by name in alphabetical order: abs, acos, ..., and vector.
std::vector<std::string> formulaFunctions();

/// The formulas of the components of a text "vector(a, b, c)", each behind as many blanks as there are characters
/// before it, so that positions in messages are those of the text; any other formula alone. Throws Error if they are
/// not three.
std::vector<std::string> formulaComponents(const std::string& text);

class Expression {
public:
    /// An input of a formula: the values of a name, at the time shown or at another one.
    struct Input {
        int name = 0;
        std::optional<TimeReference> at = {};
        std::size_t position = 0; ///< of the other time in the formula, counted from 1
    };

    /// `names` are those the formula may use; of equal names the later one is used. Throws Error with the position in
    /// the formula ("position 5", counted from 1).
    Expression(const std::string& text, std::span<const std::string> names,
               OtherTimes otherTimes = OtherTimes::Refused);

    /// The inputs of the formula, without duplicates, by rising index of the name; for each name its values at the time
    /// shown first.
    const std::vector<Input>& inputs() const { return inputs_; }
    /// The names of the inputs, in their order.
    const std::vector<int>& used() const { return used_; }

    /// The formula with its inputs replaced by variables(), in the order of inputs().
    const std::string& translated() const { return translated_; }
    const std::vector<std::string>& variables() const { return variables_; }
    /// The same inputs in another formula of the same variables.
    Expression rewritten(std::string translated) const;

    /// The formula at every point: inputs[i] holds the values of inputs()[i], out.size() of them. Thread-safe.
    void evaluate(std::span<const std::vector<double>> inputs, std::span<double> out) const;

private:
    std::string translated_; ///< names replaced by words muParser takes
    std::vector<Input> inputs_;
    std::vector<std::string> variables_; ///< of the inputs, in `translated_`
    std::vector<int> used_;
};

} // namespace tessera::volume
