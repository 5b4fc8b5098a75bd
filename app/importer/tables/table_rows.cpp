#include "app/importer/tables/table_rows.h"

#include "app/importer/readers/check_file.h"
#include "app/importer/tables/comsol_text.h"
#include "app/importer/tables/table_text.h"
#include "volume/base/trimmed.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <stdexcept>

namespace tessera::importer {

namespace {

constexpr std::size_t kMostNotes = 20; // of lines that are left out

/// The text of a comment; nothing for other lines.
std::optional<std::string_view> commentIn(std::string_view line) {
    if (line.starts_with("//")) return volume::trimmed(line.substr(2));
    if (line.front() != '#' && line.front() != '%') return std::nullopt;
    const std::size_t begin = line.find_first_not_of("#% \t");
    return begin == std::string_view::npos ? std::string_view() : line.substr(begin);
}

/// "[Name]" -> "Name", a mark of CFX; "" for other lines.
std::string_view markIn(std::string_view line) {
    if (line.size() < 3 || line.front() != '[' || line.back() != ']') return {};
    const std::string_view inside = volume::trimmed(line.substr(1, line.size() - 2));
    const bool words = std::ranges::all_of(
        inside, [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == ' '; });
    return words && inside.size() > 2 ? inside : std::string_view();
}

std::vector<Heading> headingsIn(std::string_view line, char separator, std::size_t columns) {
    if (separator == ' ') { // units stand apart
        std::vector<std::string> unused;
        std::vector<Heading> headings;
        Fields words;
        words.split(line, ' ');
        if (columns == 0 || words.size() == columns) {
            for (std::size_t i = 0; i < words.size(); ++i) headings.push_back(parseHeading(words[i]));
            return headings;
        }
        headings = comsolHeadings(line, columns, ' ', 3, unused);
        if (unused.empty()) return headings;
        headings.clear(); // "x [m] y [m]": a word in brackets belongs to the one before it
        for (std::size_t i = 0; i < words.size(); ++i) {
            std::string name(words[i]);
            while (i + 1 < words.size() && (words[i + 1].front() == '(' || words[i + 1].front() == '['))
                name += " " + std::string(words[++i]);
            headings.push_back(parseHeading(name));
        }
        return headings;
    }
    Fields fields;
    fields.split(line, separator);
    if (fields.size() > 1 && fields[fields.size() - 1].empty()) fields.dropLast();
    std::vector<Heading> headings;
    for (std::size_t i = 0; i < fields.size(); ++i) headings.push_back(parseHeading(fields[i]));
    return headings;
}

/// Whether a text has the words of Tecplot's files at the begin of a line.
bool isTecplot(std::string_view text) {
    TextLines lines(text);
    while (const auto line = lines.next()) {
        std::string word;
        for (const char c : line->text.substr(0, 9)) word += char(std::toupper(static_cast<unsigned char>(c)));
        if (word.starts_with("VARIABLES") || word.starts_with("ZONE ") || word.starts_with("TITLE")) return true;
    }
    return false;
}

/// Whether a last field without a line end goes on: "", "2.", "1e-".
bool endsWithin(std::string_view field) {
    return field.empty() || std::string_view(".,+-eE").find(field.back()) != std::string_view::npos;
}

class TableReader {
public:
    explicit TableReader(std::vector<std::string>& notes) : notes_(notes) {}

    std::vector<TextTable> read(std::string_view text) {
        TextLines lines(text);
        while (const auto line = lines.next()) take(*line);
        end();
        if (tables_.empty()) {
            if (!heading_.empty()) throw std::runtime_error("has a heading and no numbers");
            if (!firstWords_.empty())
                throw std::runtime_error(
                    "has no columns x, y and z with positions (for quantities over time use --over-time)");
            throw std::runtime_error("has no heading that names its columns");
        }
        if (skippedLines_ > kMostNotes)
            notes_.push_back(std::to_string(skippedLines_ - kMostNotes) + " more lines are left out");
        return std::move(tables_);
    }

private:
    enum class Mode { Rows, Name, Skip };

    void take(const TextLine& line) {
        if (const std::string_view mark = markIn(line.text); !mark.empty()) {
            section(mark);
            return;
        }
        if (mode_ == Mode::Skip) return;
        if (mode_ == Mode::Name) {
            name_ = std::string(line.text);
            return;
        }
        if (line.text.starts_with("sep=") && line.text.size() == 5) {
            forced_ = line.text[4];
            return;
        }
        if (const auto comment = commentIn(line.text)) {
            if (heading_.empty()) considerComment(*comment);
            return;
        }
        if (heading_.empty() && !findHeading(line)) return;
        if (line.number != headingLine_) row(line);
    }

    void section(std::string_view mark) {
        if (mark == "Name" || mark == "Data") end();
        if (mark == "Name") {
            mode_ = Mode::Name;
            name_.clear();
        } else if (mark == "Data") {
            mode_ = Mode::Rows;
        } else {
            mode_ = Mode::Skip;
            if (mark != "Spatial Fields" && mark != "Parameters")
                notes_.push_back("[" + std::string(mark) + "] is left out: the points alone are read");
        }
    }

    /// Closes a table.
    void end() {
        if (table_.rows() > 0) tables_.push_back(std::move(table_));
        table_ = TextTable();
        heading_.clear();
        comment_.clear();
        separator_ = 0;
        headingLine_ = 0;
    }

    static std::optional<char> separatorWithPlaces(std::string_view line) {
        for (const char c : {';', '\t', ',', ' '})
            if ((c == ' ' || line.find(c) != std::string_view::npos) && hasPlaces(headingsIn(line, c, 0))) return c;
        return std::nullopt;
    }

    /// The last comment that names columns of positions is the heading of what follows.
    void considerComment(std::string_view comment) {
        if (!comment.empty() && (comment_.empty() || !commentHasPlaces_ || separatorWithPlaces(comment))) {
            comment_ = std::string(comment);
            commentHasPlaces_ = separatorWithPlaces(comment).has_value();
        }
    }

    /// Whether the heading is known now.
    bool findHeading(const TextLine& line) {
        if (const auto separator = separatorWithPlaces(line.text)) {
            heading_ = std::string(line.text);
            headingSeparator_ = forced_ != 0 ? forced_ : *separator;
            headingLine_ = line.number;
            return true;
        }
        Fields fields;
        fields.split(line.text, forced_ != 0 ? forced_ : separatorOf(line.text));
        if (!numberIn(fields[0], true)) {
            if (firstWords_.empty()) firstWords_ = std::string(line.text);
            leaveOut(line, "is not the heading of columns with positions");
            return false;
        }
        if (comment_.empty() || (!commentHasPlaces_ && !firstWords_.empty())) {
            if (!firstWords_.empty())
                throw std::runtime_error(
                    "has no columns x, y and z with positions (for quantities over time use --over-time)");
            throw std::runtime_error("has no heading that names its columns");
        }
        heading_ = comment_;
        headingSeparator_ = separatorWithPlaces(comment_).value_or(separatorOf(comment_));
        return true;
    }

    void leaveOut(const TextLine& line, const std::string& why) {
        if (skippedLines_++ < kMostNotes)
            notes_.push_back("line " + std::to_string(line.number) + " is left out: it " + why);
    }

    /// The separator of rows: that of the heading, if it gives as many fields.
    void begin(const TextLine& line) {
        const std::size_t names = headingsIn(heading_, headingSeparator_, 0).size();
        const auto fits = [&](char c) {
            fields_.split(line.text, c);
            const std::size_t count = fields_.size();
            return count == names || (count == names + 1 && fields_[names].empty());
        };
        separator_ = forced_ != 0 ? forced_ : headingSeparator_;
        if (forced_ == 0 && !fits(separator_)) {
            const char own = separatorOf(line.text);
            for (const char c : {own, ';', '\t', ',', ' '})
                if (fits(c)) {
                    separator_ = c;
                    break;
                }
            if (!fits(separator_) && headingSeparator_ == ' ') separator_ = own;
        }
        fields_.split(line.text, separator_);
        std::size_t count = fields_.size();
        if (count > 1 && fields_[count - 1].empty() && count == names + 1) --count;
        std::vector<Heading> headings = headingsIn(heading_, headingSeparator_, count);
        if (headings.size() != count && hasPlaces(headings) && headings.size() < names && names == count)
            headings = headingsIn(heading_, headingSeparator_, 0);
        table_ = TextTable(name_);
        table_.setHeadings(std::move(headings));
    }

    void row(const TextLine& line) {
        if (separator_ == 0) begin(line);
        fields_.split(line.text, separator_);
        const std::size_t columns = table_.headings().size();
        if (fields_.size() == columns + 1 && fields_[columns].empty()) fields_.dropLast();
        if (fields_.size() == columns && line.text == heading_) return; // the heading of a further zone
        if (table_.rows() == 0 && isBeforeRows(line)) return;
        const bool cut = !line.whole && (fields_.size() < columns || endsWithin(fields_[columns - 1]));
        if (fields_.size() != columns || cut)
            throw std::runtime_error("line " + std::to_string(line.number) + " has " + std::to_string(fields_.size()) +
                                     " fields, its heading " + std::to_string(columns) +
                                     (cut ? ", and no line end: truncated" : ""));
        for (std::size_t c = 0; c < columns; ++c) table_.column(c).add(fields_[c], separator_ != ',', line.number);
        table_.endRow();
    }

    /// A row of units below the heading, or of something else that is no position.
    bool isBeforeRows(const TextLine& line) {
        if (fields_.size() != table_.headings().size()) return false;
        for (int axis = 0; axis < 3; ++axis)
            if (const std::ptrdiff_t c = placeColumn(table_.headings(), axis);
                c >= 0 && numberIn(fields_[std::size_t(c)], separator_ != ','))
                return false;
        std::vector<Heading> headings = table_.headings();
        if (unitsOf_ == tables_.size() + 1) {
            leaveOut(line, "stands between the heading and the numbers");
            return true;
        }
        unitsOf_ = tables_.size() + 1;
        for (std::size_t c = 0; c < headings.size(); ++c) {
            std::string_view unit = fields_[c];
            if (unit.size() > 1 && (unit.front() == '[' || unit.front() == '('))
                unit = volume::trimmed(unit.substr(1, unit.size() - 2));
            if (headings[c].unit.empty() && unit != "-" && unit != "1" && unit.size() < 40) headings[c].unit = unit;
        }
        table_.setHeadings(std::move(headings));
        return true;
    }

    std::vector<std::string>& notes_;
    std::vector<TextTable> tables_;
    TextTable table_;
    Mode mode_ = Mode::Rows;
    Fields fields_;
    std::string name_, heading_, comment_, firstWords_;
    bool commentHasPlaces_ = false;
    char forced_ = 0, separator_ = 0, headingSeparator_ = ',';
    std::size_t headingLine_ = 0, skippedLines_ = 0, unitsOf_ = 0;
};

} // namespace

std::vector<TextTable> readTables(std::string_view text, std::vector<std::string>& notes) {
    return TableReader(notes).read(text);
}

bool beginsAsTable(const std::string& path) {
    constexpr std::size_t kEnough = std::size_t(1) << 16;
    std::string head = asUtf8(readPart(path, 0, kEnough));
    const bool text = std::ranges::all_of(head, [](char c) {
        return static_cast<unsigned char>(c) >= 32 || std::isspace(static_cast<unsigned char>(c)) != 0;
    });
    if (!text || isTecplot(head)) return false;
    if (isComsolText(head)) return true;
    if (head.size() >= kEnough)
        head.resize(head.find_last_of("\r\n") == std::string::npos ? 0 : head.find_last_of("\r\n"));
    try {
        std::vector<std::string> unused;
        return !readTables(head, unused).empty();
    } catch (const std::runtime_error&) {
        return false;
    }
}

} // namespace tessera::importer
