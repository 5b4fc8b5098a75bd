#include "app/pages/table_page.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

// Lengths in ems.
constexpr double kLeading = 1.25, kRowGap = 0.22, kGroupGap = 0.35, kRuleGap = 0.35, kBlockGap = 1.2, kMargin = 0.2;
constexpr double kColumnGap = 1.1, kWidestGap = 2.4;
constexpr double kLeastText = 6, kMostText = 22; // width of a column of texts that is broken
constexpr double kHeavy = 0.09, kLight = 0.05;   // rules

using Lines = std::vector<std::string>;

/// A text broken at blanks into lines of at most `width` ems; what has no blanks stays whole.
Lines brokenText(const std::string& text, double width) {
    Lines lines(1);
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find(' ', at), text.size());
        const std::string word = text.substr(at, end - at), longer = lines.back() + " " + word;
        if (at == 0)
            lines.back() = word;
        else if (textWidth(longer) <= width)
            lines.back() = longer;
        else
            lines.push_back(word);
        at = end + 1;
    }
    return lines;
}

double widthOf(const Lines& lines) {
    double width = 0;
    for (const std::string& line : lines) width = std::max(width, textWidth(line));
    return width;
}

/// A column with its texts broken, and its width in ems.
struct PrintedColumn {
    Lines head;
    std::vector<Lines> cells;
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
        out.cells.push_back(out.right ? Lines{row[index]} : brokenText(row[index], most));
        out.width = std::max(out.width, widthOf(out.cells.back()));
    }
    out.head = brokenText(headOf(column), out.width);
    out.width = std::max(out.width, widthOf(out.head));
    return out;
}

/// Columns that stand beside each other: those of names, and some of the others.
using Block = std::vector<const PrintedColumn*>;

double widthOf(const Block& block) {
    double width = 2 * kMargin;
    for (const PrintedColumn* column : block) width += column->width + (column == block.front() ? 0 : kColumnGap);
    return width;
}

std::vector<Block> blocksOf(const std::vector<PrintedColumn>& columns, std::size_t names, double width) {
    Block first;
    for (std::size_t c = 0; c < names; ++c) first.push_back(&columns[c]);
    std::vector<Block> blocks{first};
    for (std::size_t c = names; c < columns.size(); ++c) {
        blocks.back().push_back(&columns[c]);
        if (widthOf(blocks.back()) <= width || blocks.back().size() <= names + 1) continue;
        blocks.back().pop_back();
        blocks.push_back(first);
        blocks.back().push_back(&columns[c]);
    }
    return blocks;
}

/// Blocks of at most that width, all about as wide.
std::vector<Block> evenBlocks(const std::vector<PrintedColumn>& columns, std::size_t names, double width) {
    std::vector<Block> blocks = blocksOf(columns, names, width);
    constexpr double kStep = 0.5;
    for (double less = width - kStep; less > 0 && blocks.size() > 1; less -= kStep) {
        std::vector<Block> narrower = blocksOf(columns, names, less);
        const bool fit = std::ranges::all_of(narrower, [&](const Block& block) { return widthOf(block) <= less; });
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

    /// `groups`: whether a row begins another group.
    void block(const Block& columns, const std::vector<bool>& groups) {
        const double free = width_ - widthOf(columns), most = kWidestGap - kColumnGap;
        const double gap =
            kColumnGap + (columns.size() > 1 ? std::clamp(free / double(columns.size() - 1), 0.0, most) : 0);
        rule(kHeavy);
        y_ += kRuleGap;
        std::size_t most_lines = 1;
        for (const PrintedColumn* column : columns) most_lines = std::max(most_lines, column->head.size());
        row(
            columns, gap, most_lines, [&](const PrintedColumn& column) { return column.head; }, true);
        y_ += kRuleGap;
        rule(kLight);
        y_ += kRuleGap;
        for (std::size_t r = 0; r < groups.size(); ++r) {
            std::size_t lines = 1;
            for (const PrintedColumn* column : columns) lines = std::max(lines, column->cells[r].size());
            y_ += r == 0 ? 0 : groups[r] ? kRowGap + kGroupGap : kRowGap;
            row(
                columns, gap, lines, [&](const PrintedColumn& column) { return column.cells[r]; }, false);
        }
        y_ += kRuleGap;
        rule(kHeavy);
    }
    void text(const std::string& text) {
        y_ += kRowGap;
        for (const std::string& line : brokenText(text, width_ - 2 * kMargin)) {
            words(line, kMargin, 0, y_);
            y_ += kLeading;
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
        constexpr double kBase = 0.95; // of a line from its top
        page_.marks.push_back({shapes::Words{
            .text = text, .at = glm::dvec2(x, top + kBase) * em_, .size = em_, .color = ink_, .anchor = anchor}});
    }
    /// A row of so many lines; heads stand at its foot.
    template <class LinesOf>
    void row(const Block& columns, double gap, std::size_t most, const LinesOf& linesOf, bool foot) {
        double x = kMargin;
        for (const PrintedColumn* column : columns) {
            const Lines lines = linesOf(*column);
            for (std::size_t i = 0; i < lines.size(); ++i)
                if (!lines[i].empty())
                    words(lines[i], column->right ? x + column->width : x, column->right ? 1 : 0,
                          y_ + kLeading * double(foot ? i + most - lines.size() : i));
            x += column->width + gap;
        }
        y_ += kLeading * double(most);
    }

    VectorPage& page_;
    double em_, width_, y_ = 0;
    glm::vec4 ink_;
};

} // namespace

VectorPage tablePage(const Table& table, const PageForm& form) {
    const std::vector<const TableColumn*> shown = shownColumns(table);
    const std::vector<std::vector<std::string>> cells = cellsOf(table, true);
    const std::size_t names = std::min(table.names, shown.size());
    double em = form.text;
    const double room = form.size.x / em;
    std::vector<PrintedColumn> columns;
    double widest = 0, naming = 0;
    for (std::size_t c = 0; c < shown.size(); ++c) {
        // Names leave half of the page to numbers.
        const double most = form.size.x > 0 ? std::clamp(room / (2 * double(names)), kLeastText, kMostText) : 1e9;
        columns.push_back(printedColumn(*shown[c], cells, c, most));
        (c < names ? naming : widest) =
            c < names ? naming + columns[c].width + kColumnGap : std::max(widest, columns[c].width);
    }
    const double least = naming + widest + 2 * kMargin;
    if (form.size.x > 0 && least > room) em = form.size.x / least;
    const std::vector<Block> blocks = evenBlocks(columns, names, form.size.x > 0 ? form.size.x / em + 1e-6 : 1e9);
    const double width = form.size.x > 0 ? form.size.x / em : widthOf(blocks.front());

    std::vector<bool> groups;
    for (std::size_t r = 0; r < cells.size(); ++r) groups.push_back(names > 1 && !cells[r][0].empty());
    VectorPage page;
    page.marks.emplace_back();
    TablePrinter printer(page, em, width, form.dark);
    printer.skip(kMargin);
    for (const Block& block : blocks) {
        if (&block != blocks.data()) printer.skip(kBlockGap);
        printer.block(block, groups);
    }
    if (!table.notes.empty()) printer.skip(kRuleGap);
    for (const std::string& note : table.notes) printer.text(note);
    page.size = {form.size.x > 0 ? form.size.x : width * em, (printer.height() + kMargin) * em};
    const float ground = form.dark ? 0.075f : 1;
    page.marks.front() = {shapes::Rect{.box = {{0, 0}, page.size}, .color = {ground, ground, ground, 1}}};
    return page;
}

} // namespace tessera::app
