#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

/// Files of an OpenFOAM case: text, or text with binary lists, packed by gzip or not, alone or one of several in a file
/// of all processors.
namespace tessera::importer {

constexpr std::size_t kWholeFoamFile = std::numeric_limits<std::size_t>::max();

/// Where the bytes of a file are.
struct FoamPlace {
    std::string path;   ///< as it is on disk, with .gz where it is packed; "" = there is none
    std::string shown;  ///< for messages, in the case
    int processor = -1; ///< which part of a file of all processors; -1 = the file is one
    bool operator==(const FoamPlace&) const = default;
};

/// The file `name` in a folder, or name.gz; an empty path if neither is there.
FoamPlace foamPlace(const std::string& folder, const std::string& name, int processor, const std::string& root);

/// A file's bytes, and what its header FoamFile { ... } says of them.
struct FoamFile {
    FoamPlace place;
    std::string bytes;
    std::size_t body = 0; ///< where the contents begin, after the header
    std::string kind;     ///< "volScalarField"; "" without a header
    bool binary = false, swap = false, whole = true;
    std::size_t labelBytes = 4, scalarBytes = 8;
};

/// Reads a file, or its beginning of at most so many bytes. Throws std::runtime_error with the file's name.
FoamFile readFoamFile(const FoamPlace& place, std::size_t most = kWholeFoamFile);

/// Walks over the words, numbers, brackets and lists of a file. Where something is missing it throws
/// std::runtime_error with one line of reason, without the file's name.
class FoamCursor {
public:
    explicit FoamCursor(const FoamFile& file) : file_(file), at_(file.body) {}

    std::size_t at() const { return at_; }
    void moveTo(std::size_t at) { at_ = at; }
    /// Skips blanks and comments; whether something follows.
    bool more();
    /// The next character after blanks, 0 at the end.
    char peek() { return more() ? file_.bytes[at_] : '\0'; }
    /// A word, a number, a quoted text with its quotes, or one of ( ) { } [ ] ;
    std::string_view word();
    void expect(char c);
    /// Skips what stands between brackets that begin here, with them.
    void skipBrackets();
    /// The text up to a semicolon outside of brackets, which is skipped, too.
    std::string statement();

    double number();
    std::int64_t label();
    /// A list of labels: "3(0 1 2)", "3{7}", "(0 1 2)", or binary. More than `most` are refused.
    std::vector<std::int32_t> labels(std::size_t most) {
        std::vector<std::int32_t> out;
        addLabels(most, out);
        return out;
    }
    /// The same, appended.
    void addLabels(std::size_t most, std::vector<std::int32_t>& out);
    /// A list of values of so many numbers each: "2((0 0 1) (1 2 3))", "2{(0 0 1)}", or binary. More than `most` values
    /// are refused.
    std::vector<double> numbers(std::size_t components, std::size_t most);
    /// The count at the beginning of a list; -1 where it begins with a bracket.
    std::int64_t count(std::size_t most);
    /// "(1 2 3)", or "1" of a single component.
    void value(double* out, std::size_t components);
    /// The rest of a file must close its brackets; of a binary one only the end is looked at.
    void expectEnd();

private:
    std::size_t binaryList(std::size_t bytes, std::size_t other, std::size_t count);
    [[noreturn]] static void endsEarly();
    const FoamFile& file_;
    std::size_t at_;
};

} // namespace tessera::importer
