#pragma once

#include <algorithm>
#include <gtest/gtest.h>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

/// Tables that the program wrote, read by other code than that which wrote them.
namespace tessera::app {

/// A table as text and numbers: the first line that is no comment names the columns.
struct TableText {
    std::vector<std::string> heads;
    std::vector<std::vector<std::string>> rows;
    std::size_t column(const std::string& head) const {
        const auto found = std::ranges::find(heads, head);
        EXPECT_NE(found, heads.end()) << "no column " << head;
        return found == heads.end() ? 0 : std::size_t(found - heads.begin());
    }
    std::string text(std::size_t row, const std::string& head) const { return rows[row][column(head)]; }
    /// Nothing where the field is empty.
    std::optional<double> number(std::size_t row, const std::string& head) const {
        const std::string field = text(row, head);
        return field.empty() ? std::nullopt : std::optional(std::stod(field));
    }
};

inline TableText tableOf(const std::string& csv) {
    TableText table;
    std::istringstream in(csv);
    for (std::string line; std::getline(in, line);) {
        if (line.starts_with("#")) continue;
        std::vector<std::string> fields(1);
        bool quoted = false;
        for (const char c : line) {
            if (c == '"')
                quoted = !quoted;
            else if (c == ',' && !quoted)
                fields.emplace_back();
            else
                fields.back() += c;
        }
        if (table.heads.empty())
            table.heads = fields;
        else
            table.rows.push_back(fields);
        EXPECT_EQ(fields.size(), table.heads.size()) << line;
    }
    return table;
}

} // namespace tessera::app
