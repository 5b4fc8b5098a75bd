#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// Files of PLOT3D state neither how their numbers are stored nor what they hold: only one form fits their size.
namespace tessera::importer {

struct Plot3dSize {
    std::array<std::size_t, 3> points{1, 1, 1};
    std::size_t count() const { return points[0] * points[1] * points[2]; }
    bool operator==(const Plot3dSize&) const = default;
};

/// The bytes of a file without the lengths of Fortran's records, or its numbers, where it is text.
class Plot3dBytes {
public:
    explicit Plot3dBytes(const std::string& path);

    bool text() const { return text_; }
    /// The orders of bytes that are possible: one if records tell it.
    const std::vector<bool>& orders() const { return orders_; }

    std::size_t size() const { return text_ ? numbers_.size() : bytes_.size(); }
    /// Bytes of a number (4 or 8), in text 1.
    std::size_t step(std::size_t bytes) const { return text_ ? 1 : bytes; }
    /// A whole number at a place; nothing beyond the end.
    std::optional<std::int64_t> whole(std::size_t at, bool swap) const;
    double number(std::size_t at, std::size_t bytes, bool swap) const;

private:
    bool joinRecords(bool swap);
    void readNumbers();

    std::string bytes_;
    std::vector<double> numbers_;
    std::vector<bool> orders_;
    bool text_ = false;
};

/// What the blocks of a file are, and where their numbers begin.
struct Plot3dForm {
    bool swap = false;
    std::size_t bytes = 4; ///< of a number
    int dimensions = 3;
    bool blanks = false; ///< a whole number for each point tells whether it is one
    std::vector<Plot3dSize> blocks;
    std::vector<std::size_t> variables; ///< of each block, in files of functions
    std::size_t begin = 0;
};

/// The form of a grid. Throws std::runtime_error if none fits the size of the file.
Plot3dForm formOfGrid(const Plot3dBytes& file);

/// The form of a solution (density, momentum, energy), or of functions, on these blocks.
Plot3dForm formOfSolution(const Plot3dBytes& file, const Plot3dForm& grid);
Plot3dForm formOfFunctions(const Plot3dBytes& file, const Plot3dForm& grid);

} // namespace tessera::importer
