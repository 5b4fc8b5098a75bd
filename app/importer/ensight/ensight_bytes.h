#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::importer {

/// How the numbers of a file are stored. Only files of geometry say so; those of variables are stored alike.
struct EnSightForm {
    bool binary = false, fortran = false; ///< Fortran: in records with their length before and after
    bool swap = false;                    ///< in the other byte order
};

/// Reads lines and numbers of a file of EnSight, in text or binary, one step of it. Throws std::runtime_error where the
/// file ends too early.
class EnSightBytes {
public:
    /// A file of geometry, whose first line states its form.
    EnSightBytes(const std::string& path, std::size_t step);
    /// A file of values beside a geometry of this form.
    EnSightBytes(const std::string& path, std::size_t step, EnSightForm form);

    const EnSightForm& form() const { return form_; }
    bool atEnd();
    std::size_t left() const { return end_ - at_; } ///< bytes
    std::string line();                             ///< without white space at its end
    /// The next line, without consuming it; "" at the end.
    std::string ahead();
    std::int32_t integer();
    std::vector<std::int32_t> integers(std::size_t count);
    std::vector<float> numbers(std::size_t count);
    void skip(std::size_t count); ///< numbers of 4 bytes, or words
    /// A number of things, which fits what is left of the file. Throws otherwise.
    std::size_t count(const char* what);

private:
    void open(const std::string& path);
    void selectStep(std::size_t step);
    void joinRecords();
    void guessOrder();
    const char* take(std::size_t bytes);
    std::string_view word();
    void skipBlank();

    std::string bytes_;
    std::size_t at_ = 0, end_ = 0;
    EnSightForm form_;
};

} // namespace tessera::importer
