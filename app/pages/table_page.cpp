#include "app/pages/table_page.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

// Lengths in ems.
constexpr double kTableLeading = 1.25, kTableRowGap = 0.22, kTableGroupGap = 0.35, kTableRuleGap = 0.35,
                 kTableBlockGap = 1.2, kTableMargin = 0.2;
constexpr double kTableColumnGap = 1.1, kTableWidestGap = 2.4;
constexpr double kTableLeastText = 6, kTableMostText = 22; // width of a column of texts that is broken
constexpr double kTableHeavy = 0.09, kTableLight = 0.05;   // rules

using CellLines = std::vector<std::string>;

double widthOfLines(const CellLines& lines) {
    double width = 0;
    for (const std::string& line : lines) width = std::max(width, textWidth(line));
    return width;
}

/// A column with its texts broken, and its width in ems.
struct PrintedColumn {
    CellLines head;
    std::vector<CellLines> cells;
    bool right = false;
    double width = 0;
};

/// Texts are broken where they are wider than `most` ems, heads where they are wider than the cells below.
PrintedColumn printedColumn(const TableColumn& column, const std::vector<std::vector<std::string>>& cells,
                            std::size_t index, double most) {
    PrintedColumn out;
    out.right = column.texts.empty();
    for (const std::vector<std::string>& row : cells) {
        // Numbers and their units are never parted.
        out.cells.push_back(out.right ? CellLines{row[index]} : brokenText(row[index], most));
        out.width = std::max(out.width, widthOfLines(out.cells.back()));
    }
    out.head = brokenText(headOf(column), out.width);
    out.width = std::max(out.width, widthOfLines(out.head));
    return out;
}

/// Columns that stand beside each other: those of names, and some of the others.
using TableBlock = std::vector<const PrintedColumn*>;

double widthOfBlock(const TableBlock& block) {
    double width = 2 * kTableMargin;
    for (const PrintedColumn* column : block) width += column->width + (column == block.front() ? 0 : kTableColumnGap);
    return width;
}

std::vector<TableBlock> blocksOf(const std::vector<PrintedColumn>& columns, std::size_t names, double width) {
    TableBlock first;
    for (std::size_t c = 0; c < names; ++c) first.push_back(&columns[c]);
    std::vector<TableBlock> blocks{first};
    for (std::size_t c = names; c < columns.size(); ++c) {
        blocks.back().push_back(&columns[c]);
        if (widthOfBlock(blocks.back()) <= width || blocks.back().size() <= names + 1) continue;
        blocks.back().pop_back();
        blocks.push_back(first);
        blocks.back().push_back(&columns[c]);
    }
    return blocks;
}

/// Blocks of at most that width, all about as wide.
std::vector<TableBlock> evenBlocks(const std::vector<PrintedColumn>& columns, std::size_t names, double width) {
    std::vector<TableBlock> blocks = blocksOf(columns, names, width);
    constexpr double kTableStep = 0.5;
    for (double less = width - kTableStep; less > 0 && blocks.size() > 1; less -= kTableStep) {
        std::vector<TableBlock> narrower = blocksOf(columns, names, less);
        const bool fit =
            std::ranges::all_of(narrower, [&](const TableBlock& block) { return widthOfBlock(block) <= less; });
        if (narrower.size() > blocks.size() || !fit) break;
        blocks = std::move(narrower);
    }
    return blocks;
}

/// Draws from the top of a page downwards; lengths in ems.
class TablePrinter {
public:
    TablePrinter(VectorPage& page, double em, double width, bool dark)
        : page_(page), em_(em), width_(width),
          ink_(dark ? glm::vec4(0.9f, 0.9f, 0.9f, 1) : glm::vec4(0.1f, 0.1f, 0.1f, 1)) {}

    /// Columns with so much between them; `groups`: whether a row begins another group.
    void block(const TableBlock& columns, double gap, const std::vector<bool>& groups) {
        rule(kTableHeavy);
        y_ += kTableRuleGap;
        std::size_t most_lines = 1;
        for (const PrintedColumn* column : columns) most_lines = std::max(most_lines, column->head.size());
        row(
            columns, gap, most_lines, [&](const PrintedColumn& column) { return column.head; }, true);
        y_ += kTableRuleGap;
        rule(kTableLight);
        y_ += kTableRuleGap;
        for (std::size_t r = 0; r < groups.size(); ++r) {
            std::size_t lines = 1;
            for (const PrintedColumn* column : columns) lines = std::max(lines, column->cells[r].size());
            y_ += r == 0 ? 0 : groups[r] ? kTableRowGap + kTableGroupGap : kTableRowGap;
            row(
                columns, gap, lines, [&](const PrintedColumn& column) { return column.cells[r]; }, false);
        }
        y_ += kTableRuleGap;
        rule(kTableHeavy);
    }
    void text(const std::string& text) {
        y_ += kTableRowGap;
        for (const std::string& line : brokenText(text, width_ - 2 * kTableMargin)) {
            words(line, kTableMargin, 0, y_);
            y_ += kTableLeading;
        }
    }
    void skip(double height) { y_ += height; }
    double height() const { return y_; }

private:
    void rule(double thickness) {
        page_.marks.push_back({shapes::Stroke{
            .points = {{0, y_ * em_}, {width_ * em_, y_ * em_}}, .width = thickness * em_, .color = ink_}});
    }
    void words(const std::string& text, double x, double anchor, double top) {
        constexpr double kTableBase = 0.95; // of a line from its top
        page_.marks.push_back({shapes::Words{
            .text = text, .at = glm::dvec2(x, top + kTableBase) * em_, .size = em_, .color = ink_, .anchor = anchor}});
    }
    /// A row of so many lines; heads stand at its foot.
    template <class LinesOf>
    void row(const TableBlock& columns, double gap, std::size_t most, const LinesOf& linesOf, bool foot) {
        double x = kTableMargin;
        for (const PrintedColumn* column : columns) {
            const CellLines lines = linesOf(*column);
            for (std::size_t i = 0; i < lines.size(); ++i)
                if (!lines[i].empty())
                    words(lines[i], column->right ? x + column->width : x, column->right ? 1 : 0,
                          y_ + kTableLeading * double(foot ? i + most - lines.size() : i));
            x += column->width + gap;
        }
        y_ += kTableLeading * double(most);
    }

    VectorPage& page_;
    double em_, width_, y_ = 0;
    glm::vec4 ink_;
};

/// A table in texts of `em` points or smaller ones that its widest columns need.
VectorPage printedTable(const Table& table, const PageForm& form, double em) {
    const std::vector<const TableColumn*> shown = shownColumns(table);
    const std::vector<std::vector<std::string>> cells = cellsOf(table, true);
    const std::size_t names = std::min(table.names, shown.size());
    const double room = form.size.x / em;
    std::vector<PrintedColumn> columns;
    double widest = 0, naming = 0;
    for (std::size_t c = 0; c < shown.size(); ++c) {
        // Names leave half of the page to numbers.
        const double most =
            form.size.x > 0 ? std::clamp(room / (2 * double(names)), kTableLeastText, kTableMostText) : 1e9;
        columns.push_back(printedColumn(*shown[c], cells, c, most));
        (c < names ? naming : widest) =
            c < names ? naming + columns[c].width + kTableColumnGap : std::max(widest, columns[c].width);
    }
    const double least = naming + widest + 2 * kTableMargin;
    if (form.size.x > 0 && least > room) em = form.size.x / least;
    const std::vector<TableBlock> blocks = evenBlocks(columns, names, form.size.x > 0 ? form.size.x / em + 1e-6 : 1e9);
    const double width = form.size.x > 0 ? form.size.x / em : widthOfBlock(blocks.front());
    double gap = kTableWidestGap; // the same in all blocks, so that names stand below each other
    for (const TableBlock& block : blocks)
        gap = std::min(gap, kTableColumnGap +
                                std::max(0.0, width - widthOfBlock(block)) / std::max(1.0, double(block.size()) - 1));

    std::vector<bool> groups;
    for (const std::vector<std::string>& row : cells) groups.push_back(names > 1 && !row[0].empty());
    if (std::ranges::count(groups, false) == 0) groups.assign(groups.size(), false); // of a row each
    VectorPage page;
    page.marks.emplace_back();
    TablePrinter printer(page, em, width, form.dark);
    printer.skip(kTableMargin);
    for (const TableBlock& block : blocks) {
        if (&block != blocks.data()) printer.skip(kTableBlockGap);
        printer.block(block, gap, groups);
    }
    if (!table.notes.empty()) printer.skip(kTableRuleGap);
    for (const std::string& note : table.notes) printer.text(note);
    page.size = {form.size.x > 0 ? form.size.x : width * em, (printer.height() + kTableMargin) * em};
    const float ground = form.dark ? 0.075f : 1;
    page.marks.front() = {shapes::Rect{.box = {{0, 0}, page.size}, .color = {ground, ground, ground, 1}}};
    return page;
}

} // namespace

VectorPage tablePage(const Table& table, const PageForm& form) {
    VectorPage page = printedTable(table, form, form.text);
    if (!form.fixed || form.size.y <= 0) return page;
    constexpr double kSmaller = 0.95;
    for (double em = form.text; page.size.y > form.size.y && em > 1; em *= kSmaller)
        page = printedTable(table, form, em * kSmaller);
    page.size.y = form.size.y;
    std::get<shapes::Rect>(page.marks.front().shape).box.hi.y = form.size.y;
    return page;
}

} // namespace tessera::app
