#include "app/importer/tables/comsol_text.h"

#include "app/importer/tables/table_text.h"
#include "volume/base/trimmed.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vtkCellType.h>

namespace tessera::importer {

namespace {

/// "Length unit: mm" or, among commas, "Length unit,mm" -> mm.
std::optional<std::string> valueOf(std::string_view comment, std::string_view key) {
    if (!comment.starts_with(key)) return std::nullopt;
    comment.remove_prefix(key.size());
    comment = volume::trimmed(comment);
    if (comment.empty() || (comment.front() != ':' && comment.front() != ',')) return std::nullopt;
    comment = volume::trimmed(comment.substr(1));
    if (comment.size() > 1 && comment.front() == '"' && comment.back() == '"')
        comment = comment.substr(1, comment.size() - 2);
    return std::string(comment);
}

bool isHeaderLine(std::string_view comment) {
    static constexpr std::array<std::string_view, 9> kKeys = {
        "Model", "Version", "Date", "Dimension", "Nodes", "Expressions", "Description", "Length unit", "Elements"};
    return std::ranges::any_of(kKeys, [&](std::string_view key) { return valueOf(comment, key).has_value(); });
}

/// What a comment says the lines below it are.
enum class Part { Header, Grid, Coordinates, Elements, Data, Headings };

Part partOf(std::string_view comment) {
    if (comment == "Grid") return Part::Grid;
    if (comment == "Coordinates") return Part::Coordinates;
    if (isHeaderLine(comment)) return Part::Header;
    if (comment.starts_with("Elements")) return Part::Elements;
    if (comment.starts_with("Data")) return Part::Data;
    return Part::Headings;
}

/// "Data (T (K) @ t=0)" -> "T (K) @ t=0".
std::string dataName(std::string_view comment) {
    std::string_view inside = volume::trimmed(comment.substr(4));
    if (inside.size() > 1 && inside.front() == '"' && inside.back() == '"')
        inside = inside.substr(1, inside.size() - 2);
    if (inside.size() > 1 && inside.front() == '(' && inside.back() == ')')
        inside = inside.substr(1, inside.size() - 2);
    return std::string(inside);
}

int cellTypeOf(std::size_t corners, std::size_t dimension) {
    switch (corners) {
    case 3:
        return VTK_TRIANGLE;
    case 4:
        return dimension == 3 ? VTK_TETRA : VTK_QUAD;
    case 5:
        return VTK_PYRAMID;
    case 6:
        return VTK_WEDGE;
    case 8:
        return VTK_HEXAHEDRON;
    default:
        return VTK_EMPTY_CELL;
    }
}

class ComsolReader {
public:
    explicit ComsolReader(std::vector<std::string>& notes) : notes_(notes) {}

    ComsolText read(std::string_view text) {
        TextLines lines(text);
        while (const auto line = lines.next()) {
            last_ = *line;
            if (line->text.front() == '%')
                comment(volume::trimmed(line->text.substr(1)));
            else
                row(*line);
        }
        if (part_ == Part::Data) endData();
        if (!points_.empty() || !axes_.empty()) gatherParts();
        if (out_.table.rows() == 0) throw std::runtime_error("has comments and no numbers");
        if (double(out_.table.rows()) < nodes_)
            throw std::runtime_error("has " + std::to_string(out_.table.rows()) + " of the " +
                                     std::to_string(static_cast<long long>(nodes_)) + " nodes it states: truncated");
        return std::move(out_);
    }

private:
    [[noreturn]] void fail(const std::string& reason) const {
        throw std::runtime_error("line " + std::to_string(last_.number) + " " + reason);
    }

    void comment(std::string_view words) {
        if (part_ == Part::Data) endData();
        const Part part = partOf(words);
        if (part == Part::Header) {
            if (const auto unit = valueOf(words, "Length unit")) lengthUnit_ = *unit;
            if (const auto dimension = valueOf(words, "Dimension"); dimension && dimension->size() == 1)
                dimension_ = std::size_t(std::clamp(dimension->front() - '0', 1, 3));
            if (const auto nodes = valueOf(words, "Nodes")) nodes_ = numberIn(*nodes, false).value_or(0);
            return;
        }
        if (part == Part::Headings && out_.table.rows() > 0) return;
        part_ = part;
        if (part == Part::Data) data_.push_back({dataName(words), {}});
        if (part == Part::Headings) headings_ = words;
    }

    void row(const TextLine& line) {
        if (separator_ == 0) separator_ = separatorOf(line.text);
        fields_.split(line.text, separator_);
        if (fields_.size() > 1 && fields_[fields_.size() - 1].empty()) fields_.dropLast();
        switch (part_) {
        case Part::Header:
            fail("has numbers, and no heading names them");
        case Part::Grid:
            axes_.push_back(numbers());
            return;
        case Part::Coordinates:
            points_.push_back(numbers());
            if (points_.back().size() != points_.front().size()) fail("has another number of coordinates");
            return;
        case Part::Elements:
            element();
            return;
        case Part::Data:
            for (std::size_t i = 0; i < fields_.size(); ++i)
                data_.back().column.add(fields_[i], separator_ != ',', line.number);
            return;
        case Part::Headings:
            spreadsheetRow(line);
            return;
        }
    }

    std::vector<double> numbers() const {
        std::vector<double> out;
        for (std::size_t i = 0; i < fields_.size(); ++i) {
            const std::optional<double> number = numberIn(fields_[i], separator_ != ',');
            if (!number || !std::isfinite(*number))
                fail("has the position \"" + std::string(fields_[i].substr(0, 40)) + "\", which is not a number");
            out.push_back(*number);
        }
        return out;
    }

    void element() {
        ComsolCell cell{cellTypeOf(fields_.size(), dimension_), {}};
        for (const double number : numbers()) {
            if (number != std::floor(number) || std::abs(number) > 1e15) fail("has no whole numbers of points");
            cell.points.push_back(static_cast<long long>(number) - 1);
        }
        out_.cells.push_back(std::move(cell));
    }

    void spreadsheetRow(const TextLine& line) {
        TextTable& table = out_.table;
        if (table.headings().empty()) {
            std::vector<Heading> headings =
                comsolHeadings(headings_, fields_.size(), separatorOfHeadings(), dimension_, notes_);
            for (Heading& heading : headings)
                if (heading.unit.empty() && (axisOf(heading.name) >= 0 || heading.name == "r"))
                    heading.unit = lengthUnit_;
            table.setHeadings(std::move(headings));
        }
        if (fields_.size() != table.headings().size())
            fail("has " + std::to_string(fields_.size()) + " fields, its heading " +
                 std::to_string(table.headings().size()) + (line.whole ? "" : ": truncated"));
        for (std::size_t c = 0; c < fields_.size(); ++c)
            table.column(c).add(fields_[c], separator_ != ',', line.number);
        table.endRow();
    }
    char separatorOfHeadings() const {
        return separator_ != ' ' && headings_.find(separator_) != std::string::npos ? separator_ : ' ';
    }

    void endData() {
        const std::size_t wanted = pointCount(), has = data_.back().column.values.size();
        if (has != wanted)
            throw std::runtime_error("has " + std::to_string(has) + " values of " + data_.back().name + " for " +
                                     std::to_string(wanted) + " points" + (has < wanted ? ": truncated" : ""));
    }
    std::size_t pointCount() const {
        if (axes_.empty()) return points_.size();
        double product = 1;
        for (const auto& axis : axes_) product *= double(axis.size());
        if (product > 1e12) throw std::runtime_error("states a grid of more than 1e12 points");
        return std::size_t(product);
    }

    /// Positions and data as the columns of a table.
    void gatherParts() {
        const std::size_t axes = axes_.empty() ? points_.front().size() : axes_.size(), count = pointCount();
        if (axes > 3 || axes < 2) throw std::runtime_error("has " + std::to_string(axes) + " axes, not two or three");
        if (data_.empty()) throw std::runtime_error("has positions and no data: truncated");
        std::vector<Heading> headings;
        for (std::size_t axis = 0; axis < axes; ++axis)
            headings.push_back({std::string(1, char('x' + int(axis))), lengthUnit_});
        for (const Data& data : data_) headings.push_back(comsolHeadings(data.name, 1, ' ', 0, notes_).front());
        out_.table.setHeadings(std::move(headings));
        for (std::size_t axis = 0; axis < axes; ++axis) {
            std::vector<double>& places = out_.table.column(axis).values;
            places.reserve(count);
            std::size_t stride = 1; // x fastest
            for (std::size_t before = 0; before < axis && !axes_.empty(); ++before) stride *= axes_[before].size();
            for (std::size_t i = 0; i < count; ++i)
                places.push_back(axes_.empty() ? points_[i][axis] : axes_[axis][i / stride % axes_[axis].size()]);
        }
        for (std::size_t d = 0; d < data_.size(); ++d) out_.table.column(axes + d) = std::move(data_[d].column);
        for (std::size_t i = 0; i < count; ++i) out_.table.endRow();
        const auto whole = static_cast<long long>(count);
        for (const ComsolCell& cell : out_.cells)
            for (const long long point : cell.points)
                if (point < 0 || point >= whole)
                    throw std::runtime_error("has an element with point " + std::to_string(point + 1) + " of " +
                                             std::to_string(whole));
    }

    struct Data {
        std::string name;
        TextColumn column;
    };
    std::vector<std::string>& notes_;
    ComsolText out_;
    Part part_ = Part::Header;
    TextLine last_;
    Fields fields_;
    char separator_ = 0;
    std::size_t dimension_ = 3;
    double nodes_ = 0;
    std::string lengthUnit_, headings_;
    std::vector<std::vector<double>> axes_, points_;
    std::vector<Data> data_;
};

} // namespace

bool isComsolText(std::string_view text) {
    TextLines lines(text);
    for (int n = 0; n < 12; ++n) {
        const auto line = lines.next();
        if (!line || line->text.front() != '%') return false;
        const std::string_view words = volume::trimmed(line->text.substr(1));
        if (isHeaderLine(words) || words == "Grid" || words == "Coordinates") return true;
    }
    return false;
}

ComsolText readComsolText(std::string_view text, std::vector<std::string>& notes) {
    return ComsolReader(notes).read(text);
}

} // namespace tessera::importer
