#pragma once

#include <complex>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The text of tables: lines, fields, numbers.
namespace tessera::importer {

/// The text of a file in UTF-8: without a byte order mark, from UTF-16 if its mark says so, and from Windows-1252 (of
/// which Latin-1 is a part) if it is not UTF-8.
std::string asUtf8(std::string bytes);

/// A line without white space at its ends.
struct TextLine {
    std::string_view text;
    std::size_t number = 0; ///< counted from 1
    bool whole = true;      ///< has a line end; false for a last line without one
};

/// The lines of a text that are not empty, one after the other. The text must outlive it.
class TextLines {
public:
    explicit TextLines(std::string_view text) : rest_(text) {}
    std::optional<TextLine> next();

private:
    std::string_view rest_;
    std::size_t number_ = 0;
};

/// The fields of a line, without their quotes and the white space around them.
class Fields {
public:
    /// A blank as the separator stands for any number of blanks and tabs.
    void split(std::string_view line, char separator);
    std::size_t size() const { return views_.size(); }
    std::string_view operator[](std::size_t i) const { return views_[i]; }
    void dropLast() { views_.pop_back(); }

private:
    void add(std::string_view field);
    std::vector<std::string_view> views_;
    std::deque<std::string> unquoted_; ///< fields with quotes within quotes
};

/// Whether a field says that there is no value: "", "null", "NA", "n/a", "-", "nan", "#DIV/0!", "-1.#IND".
bool isMissingWord(std::string_view field);

/// A number: 1.5, +1.5, 1.5D-3 and 0.1-105 as Fortran writes them, 1,5 with `decimalComma`; NaN for missing words.
std::optional<double> numberIn(std::string_view field, bool decimalComma);

/// A complex number with an imaginary part: 1+2i, 3.1E-4-2.5i, 2i.
std::optional<std::complex<double>> complexIn(std::string_view field, bool decimalComma);

/// What separates the fields of a line of numbers and words: ';', a tab, ',' or ' '.
char separatorOf(std::string_view line);

} // namespace tessera::importer
