#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// Files of Fluent (.cas, .msh, .dat): sections "(number (header)(numbers))", in text or binary.
namespace tessera::importer {

/// A section: its header as words, and where its numbers are.
struct FluentSection {
    int number = 0;                    ///< without the thousands that say how it is stored
    bool binary = false, wide = false; ///< wide: 8 bytes a number
    std::vector<std::string> header;   ///< words of the first inner bracket, or of the section where it has none
    std::size_t begin = 0, end = 0;    ///< of its numbers in the file; equal: it has none
    std::size_t open = 0, close = 0;   ///< of the whole section
    std::string comment;               ///< the text of the remark before it
};

class FluentFile {
public:
    /// Reads a file, through zlib where it is compressed.
    explicit FluentFile(const std::string& path);

    /// Goes to the next section; false at the end. Throws std::runtime_error where the file ends within one, or holds
    /// something else.
    bool next(FluentSection& section);

    const std::string& bytes() const { return bytes_; }
    bool swap() const { return swap_; }

    /// Numbers of a section from `at` on, which moves behind them. Whole numbers of text are hexadecimal.
    std::vector<double> numbers(const FluentSection& section, std::size_t& at, std::size_t count) const;
    std::int64_t whole(const FluentSection& section, std::size_t& at) const;
    bool atEnd(const FluentSection& section, std::size_t at) const;

private:
    void skipBlank();
    void endOfBinary(FluentSection& section);
    std::size_t closing(std::size_t open) const;

    std::string bytes_;
    std::size_t at_ = 0;
    bool swap_ = false;
    std::string comment_;
};

/// Whole numbers in the header of a section, -1 where there is none.
std::int64_t headerNumber(const FluentSection& section, std::size_t index, int base);

} // namespace tessera::importer
