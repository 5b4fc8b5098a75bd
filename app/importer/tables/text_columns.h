#pragma once

#include "app/importer/tables/point_table.h"

#include <string>
#include <string_view>
#include <vector>

/// Columns of fields, as text states them, become columns of numbers.
namespace tessera::importer {

/// Gathers the fields of one column. Numbers stay what they are; what becomes of words is decided at the end.
class TextColumn {
public:
    /// `line` counts from 1. Fields of missing words are NaN.
    void add(std::string_view field, bool decimalComma, std::size_t line);

    std::vector<double> values;
    std::vector<double> imaginary;     ///< of complex numbers, else empty
    std::vector<volume::Label> labels; ///< set by settle()

    /// What became of the column: numbers, words as labels, or nothing, then with a line of reason in `note`, which is
    /// also set where some fields are left out.
    enum class Kind { Numbers, Labels, Unread };
    Kind settle(const std::string& name, std::string& note);

private:
    std::vector<int> codes_; ///< by row, -1 = a number; empty where there are no words
    std::vector<std::string> words_;
    std::size_t wordCount_ = 0, numberCount_ = 0;
    std::string firstPlace_;
    bool tooMany_ = false;
};

/// Headings and their columns while rows are added, then as a table: columns that cannot be read, that only count the
/// rows, or that repeat a position are left out, each with a note; rows without a position too. Complex numbers become
/// two columns, NAME.real and NAME.imag. Names that come twice get a number.
class TextTable {
public:
    /// `name`: of the part of the file, "" = all of it.
    explicit TextTable(std::string name = {}) : name_(std::move(name)) {}

    void setHeadings(std::vector<Heading> headings);
    const std::vector<Heading>& headings() const { return headings_; }
    std::size_t rows() const { return rows_; }
    TextColumn& column(std::size_t c) { return columns_[c]; }
    void endRow() { ++rows_; }
    const std::string& name() const { return name_; }

    PointTable table(std::vector<std::string>& notes);

private:
    std::string name_;
    std::vector<Heading> headings_;
    std::vector<TextColumn> columns_;
    std::size_t rows_ = 0;
};

} // namespace tessera::importer
