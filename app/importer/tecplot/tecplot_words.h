#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>

/// The words of a Tecplot file in text.
namespace tessera::importer {

inline std::string upper(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return char(std::toupper(c)); });
    return out;
}

/// Whether a record of a file begins with this word, in capitals.
inline bool beginsRecord(std::string_view word) {
    static constexpr std::string_view kRecords[] = {"ZONE",      "TEXT",  "GEOMETRY",       "CUSTOMLABELS",
                                                    "VARIABLES", "TITLE", "DATASETAUXDATA", "VARAUXDATA"};
    return std::ranges::find(kRecords, word) != std::end(kRecords);
}

/// Splits a file into words: names with their values, quoted texts, numbers.
class TecplotWords {
public:
    explicit TecplotWords(std::string text) : text_(std::move(text)) {}

    bool atEnd() {
        skip();
        return at_ >= text_.size();
    }
    char peek() {
        skip();
        return at_ < text_.size() ? text_[at_] : '\0';
    }
    /// The next word, without consuming it.
    std::string ahead() {
        const std::size_t at = at_;
        std::string word = next();
        at_ = at;
        return word;
    }
    std::string next() {
        skip();
        if (at_ >= text_.size()) throw std::runtime_error("ends too early: truncated");
        if (text_[at_] == '"') {
            const std::size_t end = text_.find('"', at_ + 1);
            if (end == std::string::npos) throw std::runtime_error("ends within a name: truncated");
            std::string word = text_.substr(at_ + 1, end - at_ - 1);
            at_ = end + 1;
            return word;
        }
        if (text_[at_] == '(' || text_[at_] == '=') {
            const std::size_t end = text_[at_] == '=' ? at_ : text_.find(')', at_);
            if (end == std::string::npos) throw std::runtime_error("ends within a list: truncated");
            std::string word = text_.substr(at_, end - at_ + 1);
            at_ = end + 1;
            return word;
        }
        if (text_[at_] == '[') {
            const std::size_t end = text_.find(']', at_);
            if (end == std::string::npos) throw std::runtime_error("ends within a list: truncated");
            std::string word = text_.substr(at_, end - at_ + 1);
            at_ = end + 1;
            return word;
        }
        const std::size_t end = std::min(text_.size(), text_.find_first_of(" \t\r\n,=([\"", at_));
        if (end == at_) throw std::runtime_error("has \"" + text_.substr(at_, 1) + "\" where a word belongs");
        std::string word = text_.substr(at_, end - at_);
        at_ = end;
        return word;
    }
    double number() {
        if (repeats_ > 0) {
            --repeats_;
            return repeated_;
        }
        std::string word = next();
        if (const std::size_t times = word.find('*'); times != std::string::npos) { // 3*1.5
            repeats_ = std::max(1L, std::strtol(word.c_str(), nullptr, 10)) - 1;
            word = word.substr(times + 1);
            return repeated_ = parse(word);
        }
        return parse(word);
    }
    /// Passes a text or a drawing, up to the line that begins the next record.
    void skipRecord() {
        while ((at_ = std::min(text_.size(), text_.find('\n', at_))) < text_.size()) {
            const std::size_t begin = std::min(text_.size(), text_.find_first_not_of(" \t\r\n", at_));
            const std::size_t end = std::min(text_.size(), text_.find_first_of(" \t\r\n=,", begin));
            const std::string word = upper(std::string_view(text_).substr(begin, end - begin));
            at_ = begin;
            if (beginsRecord(word)) return;
        }
    }
    void endOfList() const {
        if (repeats_ > 0) throw std::runtime_error("has more numbers than a zone announces");
    }

private:
    static double parse(std::string word) {
        std::replace(word.begin(), word.end(), 'D', 'E'); // Fortran's exponent
        char* end = nullptr;
        const double value = std::strtod(word.c_str(), &end);
        if (word.empty() || end != word.c_str() + word.size())
            throw std::runtime_error("has \"" + word.substr(0, 40) + "\" where a number belongs");
        return value;
    }
    void skip() {
        while (at_ < text_.size()) {
            if (text_[at_] == '#' && (at_ == 0 || text_[at_ - 1] == '\n'))
                at_ = std::min(text_.size(), text_.find('\n', at_));
            else if (std::isspace(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == ',')
                ++at_;
            else
                return;
        }
    }
    std::string text_;
    std::size_t at_ = 0;
    long repeats_ = 0;
    double repeated_ = 0;
};

} // namespace tessera::importer
