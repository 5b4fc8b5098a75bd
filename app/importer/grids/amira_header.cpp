#include "app/importer/grids/amira_header.h"

#include "app/importer/grids/grid_file.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <stdexcept>
#include <string_view>

namespace tessera::importer {

namespace {

bool isBlankLetter(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

/// Words, texts in quotes, braces and separators ("\n", which commas become, too). Comments are left out.
class AmiraWords {
public:
    explicit AmiraWords(std::string_view text) : text_(text) {}

    bool next(std::string& word, bool& quoted) {
        quoted = false;
        while (at_ < text_.size() && isBlankLetter(text_[at_])) ++at_;
        if (at_ >= text_.size()) return false;
        const char c = text_[at_];
        if (c == '#') {
            at_ = std::min(text_.size(), text_.find('\n', at_));
            return next(word, quoted);
        }
        if (c == '\n' || c == ',') {
            ++at_;
            word = "\n";
            return true;
        }
        if (c == '{' || c == '}') {
            ++at_;
            word = std::string(1, c);
            return true;
        }
        if (c == '"') return takeQuoted(word, quoted);
        const std::size_t begin = at_;
        const bool place = c == '@'; // with what stands in brackets behind it
        while (at_ < text_.size() && !isBlankLetter(text_[at_]) && text_[at_] != '\n' &&
               (place || (text_[at_] != '{' && text_[at_] != '}' && text_[at_] != ',')))
            ++at_;
        word = std::string(text_.substr(begin, at_ - begin));
        return true;
    }

private:
    bool takeQuoted(std::string& word, bool& quoted) {
        quoted = true;
        word.clear();
        for (++at_; at_ < text_.size() && text_[at_] != '"'; ++at_) {
            if (text_[at_] == '\\' && at_ + 1 < text_.size()) ++at_;
            word += text_[at_];
        }
        ++at_;
        return true;
    }
    std::string_view text_;
    std::size_t at_ = 0;
};

/// "@1(HxByteRLE,1234)".
void setSection(AmiraArray& array, std::string_view place) {
    const char* end = place.data() + place.size();
    const auto parsed = std::from_chars(place.data() + 1, end, array.section);
    if (parsed.ec != std::errc()) throw std::runtime_error("has an array without a number: " + std::string(place));
    std::string_view rest(parsed.ptr, std::size_t(end - parsed.ptr));
    if (!rest.starts_with('(')) return;
    rest.remove_prefix(1);
    const std::size_t comma = std::min(rest.size(), rest.find_first_of(",)"));
    array.encoding = std::string(rest.substr(0, comma));
    if (comma < rest.size()) std::from_chars(rest.data() + comma + 1, rest.data() + rest.size(), array.stored);
}

/// "float[3] Data" or "float [3] Data".
void addArrays(const std::string& of, std::vector<std::string> words, AmiraHeader& header) {
    if (words.size() > 2 && words[1].starts_with("[")) {
        words[0] += words[1];
        words.erase(words.begin() + 1);
    }
    if (words.size() < 2) return;
    AmiraArray array;
    array.of = of;
    array.type = words[0];
    array.name = words[1];
    if (const std::size_t bracket = array.type.find('['); bracket != std::string::npos) {
        std::from_chars(array.type.data() + bracket + 1, array.type.data() + array.type.size(), array.components);
        array.type.resize(bracket);
    }
    header.arrays.push_back(array);
}

/// Goes through the words of a header.
class AmiraParser {
public:
    explicit AmiraParser(AmiraHeader& header) : header_(header) {}

    void take(const std::string& word, bool quoted) {
        if (!quoted && word == "\n") return finish();
        if (!quoted && word == "{") {
            // A block without a name gets a number.
            const std::string name =
                statement_.empty() ? "#" + std::to_string(header_.blocks.size()) : statement_.front();
            statement_.clear();
            path_.push_back(name);
            constexpr std::size_t kDeepest = 64;
            if (path_.size() > kDeepest) throw std::runtime_error("has too deep a header");
            header_.blocks.push_back(joined());
            return;
        }
        if (!quoted && word == "}") {
            finish();
            if (!path_.empty()) path_.pop_back();
            return;
        }
        if (!quoted && path_.empty() && word.starts_with("@")) {
            for (auto array = header_.arrays.rbegin(); array != header_.arrays.rend() && array->section == 0; ++array)
                setSection(*array, word);
            statement_.clear();
            return;
        }
        statement_.push_back(word);
    }
    void finish() {
        if (statement_.empty()) return;
        if (path_.empty()) {
            if (statement_[0] == "define" && statement_.size() > 2) define(statement_[1], 2);
            if (statement_[0] == "nNodes" || statement_[0] == "nTetrahedra") define(statement_[0], 1);
        } else if (path_.front() == "Parameters" || path_.front() == "Materials") {
            std::string words;
            for (std::size_t i = 1; i < statement_.size(); ++i) words += (i > 1 ? " " : "") + statement_[i];
            header_.parameters.emplace(joined() + "/" + statement_[0], words);
        } else if (path_.size() == 1) {
            addArrays(path_.front(), statement_, header_);
        }
        statement_.clear();
    }

private:
    void define(const std::string& name, std::size_t from) {
        for (std::size_t i = from; i < statement_.size(); ++i) {
            double value = 0;
            if (parseGridNumber(statement_[i], value)) header_.defines[name].push_back(value);
        }
    }
    std::string joined() const {
        std::string all;
        for (const std::string& name : path_) all += (all.empty() ? "" : "/") + name;
        return all;
    }
    AmiraHeader& header_;
    std::vector<std::string> path_, statement_;
};

/// Where the first line "@1" begins.
std::size_t endOfAmiraHeader(const std::string& text) {
    for (std::size_t at = text.find("\n@"); at != std::string::npos; at = text.find("\n@", at + 1)) {
        std::size_t end = at + 2;
        while (end < text.size() && std::isdigit(static_cast<unsigned char>(text[end])) != 0) ++end;
        while (end < text.size() && isBlankLetter(text[end])) ++end;
        if (end > at + 2 && end < text.size() && text[end] == '\n') return at + 1;
    }
    throw std::runtime_error("ends within its header");
}

} // namespace

AmiraHeader parseAmira(const std::string& text) {
    AmiraHeader header;
    std::string first = text.substr(0, std::min(text.find('\n'), std::size_t(200)));
    if (!first.starts_with("# AmiraMesh") && !first.starts_with("# Avizo")) {
        if (first.starts_with("# HyperSurface"))
            throw std::runtime_error("holds a surface, no volume: write the label field as AmiraMesh");
        throw std::runtime_error("is no AmiraMesh file");
    }
    header.text = first.find("ASCII") != std::string::npos;
    header.bigEndian = first.find("LITTLE-ENDIAN") == std::string::npos;
    header.end = endOfAmiraHeader(text);
    AmiraWords words(std::string_view(text).substr(0, header.end));
    AmiraParser parser(header);
    bool quoted = false;
    for (std::string word; words.next(word, quoted);) parser.take(word, quoted);
    parser.finish();
    return header;
}

} // namespace tessera::importer
