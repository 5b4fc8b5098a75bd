#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

/// Formulas over named values, read by muParser: + - * / ^, comparisons, && ||, a ? b : c, abs, sqrt, exp, ln, log10,
/// sin, min, max, ... Names may be those of channels ("U.x", "|U|"); any other name is written between back quotes.
namespace tessera::volume {

class Expression {
public:
    /// `names` are what the formula may use; the later of two equal ones counts. Throws Error whose place says where in
    /// the formula ("position 5", counted from 1) something is wrong.
    Expression(const std::string& text, std::span<const std::string> names);

    /// Which of the names the formula uses, rising.
    const std::vector<int>& used() const { return used_; }

    /// The formula at every point: inputs[i] holds the values of name used()[i], out.size() of them. Thread-safe.
    void evaluate(std::span<const std::vector<double>> inputs, std::span<double> out) const;

private:
    std::string translated_; ///< names replaced by words muParser takes
    std::vector<int> used_;
};

} // namespace tessera::volume
