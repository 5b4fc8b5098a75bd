// Tables with a heading: CSV of ParaView, Fluent, STAR-CCM+, CFD-Post and spreadsheets, OpenFOAM's samples, text
// exports of COMSOL.
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"
#include "app/importer/tables/comsol_text.h"
#include "app/importer/tables/table_rows.h"
#include "app/importer/tables/table_text.h"
#include "app/importer/tables/table_zones.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <vtkCompositeDataSet.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>

namespace tessera::importer {

namespace {

/// The column of times, if there is one.
std::optional<std::size_t> timeColumn(const PointTable& table) {
    static constexpr std::array<std::string_view, 6> kNames = {"time",      "physical time", "solution time",
                                                               "flow-time", "flow time",     "time value"};
    for (std::size_t c = 0; c < table.headings.size(); ++c) {
        std::string word = table.headings[c].name;
        std::transform(word.begin(), word.end(), word.begin(), [](unsigned char l) { return char(std::tolower(l)); });
        if (std::ranges::find(kNames, word) != kNames.end()) return c;
    }
    for (std::size_t c = 0; c < table.headings.size(); ++c)
        if (table.headings[c].name == "t") return c;
    return std::nullopt;
}

/// A quadrilateral by its corners in rows, as a product of two edges has them, instead of around it.
bool isInRows(const std::array<const double*, 4>& corners) {
    double product = 0;
    for (int axis = 0; axis < 3; ++axis)
        product += (corners[1][axis] - corners[0][axis]) * (corners[3][axis] - corners[2][axis]);
    return product > 0;
}

vtkSmartPointer<vtkDataSet> meshOf(const PointTable& table, const std::vector<ComsolCell>& cells, Source& source) {
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    points->SetNumberOfPoints(vtkIdType(table.rows()));
    for (std::size_t row = 0; row < table.rows(); ++row) {
        double place[3] = {0, 0, 0};
        for (int axis = 0; axis < 3; ++axis)
            if (const std::ptrdiff_t c = placeColumn(table.headings, axis); c >= 0)
                place[axis] = table.columns[std::size_t(c)][row];
        points->SetPoint(vtkIdType(row), place);
    }
    auto mesh = vtkSmartPointer<vtkUnstructuredGrid>::New();
    mesh->SetPoints(points);
    mesh->Allocate(vtkIdType(cells.size()));
    std::size_t left = 0;
    for (const ComsolCell& cell : cells) {
        std::vector<vtkIdType> corners(cell.points.begin(), cell.points.end());
        if (cell.type == VTK_EMPTY_CELL) {
            ++left;
            continue;
        }
        for (std::size_t base = 0; base + 4 <= corners.size() && cell.type != VTK_TETRA && cell.type != VTK_WEDGE;
             base += 4) {
            double at[4][3];
            for (std::size_t k = 0; k < 4; ++k) points->GetPoint(corners[base + k], at[k]);
            if (isInRows({at[0], at[1], at[2], at[3]})) std::swap(corners[base + 2], corners[base + 3]);
        }
        mesh->InsertNextCell(cell.type, vtkIdType(corners.size()), corners.data());
    }
    if (left > 0) source.notes.push_back(std::to_string(left) + " elements are left out: their form is not known");
    for (const Heading& heading : table.headings)
        if (axisOf(heading.name) >= 0 && !heading.unit.empty()) source.lengthUnit = heading.unit;
    addColumns(table, mesh->GetPointData(), source);
    return mesh;
}

void readMesh(ComsolText& read, Source& source) {
    const PointTable table = read.table.table(source.notes);
    if (table.rows() != read.table.rows()) throw std::runtime_error("has an element with a point without a position");
    const vtkSmartPointer<vtkDataSet> mesh = meshOf(table, read.cells, source);
    source.read = [mesh](std::size_t) { return mesh; };
}

/// Parameters that the columns are, where those of several times are one: thousands are a table on its side.
void refuseManyParameters(const PointTable& table) {
    constexpr std::size_t kMost = 1000;
    std::set<std::string> names;
    for (const Heading& heading : table.headings) names.insert(heading.name.substr(0, heading.name.find('@')));
    if (names.size() > kMost)
        throw std::runtime_error("names " + std::to_string(names.size()) +
                                 " columns of different parameters: more than " + std::to_string(kMost) +
                                 " are not read (rows must be points, columns what is known of them)");
}

/// Tables of points, each with its zones and times.
std::vector<TimedTable> partsOf(std::vector<TextTable>& read, Source& source) {
    std::vector<TimedTable> parts;
    std::set<double> times;
    for (TextTable& text : read) {
        PointTable table = text.table(source.notes);
        refuseManyParameters(table);
        const std::optional<std::size_t> column = timeColumn(table);
        if (column && !table.headings[*column].unit.empty()) source.timeUnit = table.headings[*column].unit;
        TimedTable timed;
        if (column)
            timed = byTime(table, *column);
        else
            timed.tables.push_back(std::move(table));
        timed.name = read.size() > 1 && text.name().empty() ? "part " + std::to_string(parts.size() + 1) : text.name();
        times.insert(timed.times.begin(), timed.times.end());
        for (TimedTable& zone : zonesOf(std::move(timed), source.notes)) parts.push_back(std::move(zone));
    }
    source.times.assign(times.begin(), times.end());
    return parts;
}

vtkSmartPointer<vtkDataObject> dataOf(const std::vector<TimedTable>& parts, const std::vector<double>& times,
                                      std::size_t time, Source& source) {
    const auto tableAt = [&](const TimedTable& part) -> const PointTable* {
        if (part.times.empty()) return &part.tables.front();
        const auto at = std::ranges::find(part.times, times[time]);
        return at == part.times.end() ? nullptr : &part.tables[std::size_t(at - part.times.begin())];
    };
    if (parts.size() == 1) return gridOfPoints(*tableAt(parts.front()), source);
    vtkNew<vtkMultiBlockDataSet> blocks;
    for (const TimedTable& part : parts)
        if (const PointTable* table = tableAt(part)) {
            const unsigned number = blocks->GetNumberOfBlocks();
            blocks->SetBlock(number, gridOfPoints(*table, source));
            blocks->GetMetaData(number)->Set(vtkCompositeDataSet::NAME(), part.name.c_str());
        }
    return blocks;
}

} // namespace

void openCsv(Source& source) {
    const std::string text = asUtf8(readWhole(source.path));
    if (text.empty()) throw std::runtime_error("is empty");
    std::vector<TextTable> read;
    if (isComsolText(text)) {
        ComsolText comsol = readComsolText(text, source.notes);
        if (!comsol.cells.empty()) {
            readMesh(comsol, source);
            return;
        }
        read.push_back(std::move(comsol.table));
    } else {
        read = readTables(text, source.notes);
    }
    for (const TextTable& table : read)
        if (!hasPlaces(table.headings()))
            throw std::runtime_error(
                "has no columns x, y and z with positions (for quantities over time use --over-time)");
    const auto parts = std::make_shared<const std::vector<TimedTable>>(partsOf(read, source));
    // The first time states units, labels and notes for all of them.
    const vtkSmartPointer<vtkDataObject> first = dataOf(*parts, source.times, 0, source);
    if (source.times.size() < 2) {
        source.read = [first](std::size_t) { return first; };
        return;
    }
    for (std::size_t time = 1; time < source.times.size(); ++time) { // parts that begin later
        const bool begins = std::ranges::any_of(*parts, [&](const TimedTable& part) {
            return !part.times.empty() && part.times.front() == source.times[time];
        });
        if (!begins) continue;
        source.shownAt.push_back(time);
        Source more;
        dataOf(*parts, source.times, time, more);
        source.units.merge(more.units);
        source.labels.merge(more.labels);
    }
    source.read = [parts, times = source.times](std::size_t time) -> vtkSmartPointer<vtkDataObject> {
        Source scratch;
        return dataOf(*parts, times, time, scratch);
    };
}

} // namespace tessera::importer
