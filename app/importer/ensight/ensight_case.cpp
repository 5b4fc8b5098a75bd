// The sections FORMAT, GEOMETRY, VARIABLE, TIME and FILE of a case file, by the EnSight User Manual, "EnSight Gold Case
// File Format".
#include "app/importer/ensight/ensight_case.h"

#include "app/importer/readers/check_file.h"
#include "volume/base/trimmed.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace tessera::importer {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostSteps = 1'000'000;

std::string trim(std::string_view text) {
    return std::string(volume::trimmed(text));
}

std::string lower(std::string_view text) {
    std::string out(text);
    std::ranges::transform(out, out.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return out;
}

/// The words of a line; one in quotes may hold blanks.
std::vector<std::string> wordsOf(const std::string& line) {
    std::vector<std::string> out;
    for (std::size_t at = 0; (at = line.find_first_not_of(" \t\r", at)) != std::string::npos;) {
        const bool quoted = line[at] == '"';
        const std::size_t begin = at + (quoted ? 1 : 0);
        const std::size_t end = std::min(line.size(), line.find_first_of(quoted ? "\"" : " \t\r", begin));
        out.push_back(line.substr(begin, end - begin));
        at = std::min(line.size(), end + (quoted ? 1 : 0));
    }
    return out;
}

std::optional<double> numberIn(const std::string& word) {
    double value = 0;
    const char* begin = word.data() + (word.starts_with('+') ? 1 : 0);
    const auto [end, failed] = std::from_chars(begin, word.data() + word.size(), value);
    if (failed != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::optional<int> wholeIn(const std::string& word) {
    const auto value = numberIn(word);
    if (!value || *value != std::floor(*value) || std::abs(*value) > 1e9) return std::nullopt;
    return int(*value);
}

/// Numbers of a list, over several lines or in a file of their own.
std::vector<double> numbersIn(const std::string& text) {
    std::vector<double> out;
    std::istringstream in(text);
    for (std::string word; in >> word;) {
        const auto value = numberIn(word);
        if (!value) break;
        out.push_back(*value);
    }
    return out;
}

/// Reads the lines of one case file into an EnSightCase.
class CaseLines {
public:
    explicit CaseLines(const std::string& path) {
        case_.path = path;
        const std::string text = readWhole(path);
        openEnd_ = !text.ends_with('\n');
        std::istringstream in(text);
        for (std::string line; std::getline(in, line);) {
            line = trim(line.substr(0, line.find('#')));
            if (!line.empty()) lines_.push_back(line);
        }
    }

    EnSightCase read() {
        std::string section;
        while (at_ < lines_.size()) {
            const std::string line = lines_[at_++];
            const std::size_t colon = line.find(':');
            if (colon == std::string::npos) {
                section = lower(line);
                static constexpr std::string_view kSections[] = {
                    "format", "geometry", "variable", "time", "file", "material", "scripts", "block_continuation"};
                if (isCut() && std::ranges::find(kSections, section) == std::end(kSections) && !numberIn(section))
                    throw std::runtime_error("ends within a line: truncated");
                continue;
            }
            const std::string key = trim(lower(line.substr(0, colon)));
            const std::string value = trim(line.substr(colon + 1));
            if (section == "format")
                readFormat(key, value);
            else if (section == "geometry")
                readGeometry(key, value);
            else if (section == "variable")
                readVariable(key, value);
            else if (section == "time")
                readTime(key, value);
            else if (section == "file")
                readFileSet(key, value);
            else if (section == "material")
                note("its materials are left out");
        }
        if (!typed_) throw std::runtime_error("states no type: is it an EnSight case?");
        if (case_.geometry.name.empty()) throw std::runtime_error("names no geometry (model:)");
        finishTimes();
        return std::move(case_);
    }

private:
    /// Whether the line just read is the last and may have been cut: it needs no line end, but must make sense.
    bool isCut() const { return openEnd_ && at_ == lines_.size(); }

    void note(const std::string& text) {
        if (std::ranges::find(case_.notes, text) == case_.notes.end()) case_.notes.push_back(text);
    }

    void readFormat(const std::string& key, const std::string& value) {
        if (key != "type") return;
        const std::string type = lower(value);
        if (type.find("ensight") == std::string::npos)
            throw std::runtime_error("is of type \"" + value.substr(0, 40) + "\", not ensight");
        typed_ = true;
        case_.gold = type.find("gold") != std::string::npos;
    }

    /// [time set] [file set] in front of the words of a line, of which `least` follow.
    static EnSightFile setsOf(std::vector<std::string>& words, std::size_t least) {
        EnSightFile file;
        for (int* set : {&file.timeSet, &file.fileSet}) {
            if (words.size() <= least) break;
            const auto number = wholeIn(words.front());
            if (!number) break;
            *set = *number;
            words.erase(words.begin());
        }
        return file;
    }

    void readGeometry(const std::string& key, const std::string& value) {
        if (key != "model") {
            note("its \"" + key + "\" (" + value.substr(0, 60) + ") is left out");
            return;
        }
        std::vector<std::string> words = wordsOf(value);
        EnSightFile file = setsOf(words, 1);
        if (words.empty()) return;
        file.name = words[0];
        case_.geometry = file;
        if (words.size() > 1 && lower(words[1]) == "change_coords_only") {
            case_.coordinatesOnly = true;
            if (words.size() > 2) case_.cellsAt = std::size_t(std::max(0, wholeIn(words[2]).value_or(0)));
        }
    }

    void readVariable(const std::string& key, const std::string& value) {
        using Kind = EnSightVariable::Kind;
        std::vector<std::string> words = wordsOf(value);
        if (key.starts_with("constant per case")) {
            readConstant(words, key.ends_with("file"));
            return;
        }
        const bool complex = key.starts_with("complex ");
        const std::string plain = complex ? key.substr(8) : key;
        const std::size_t per = plain.find(" per ");
        const std::string what = plain.substr(0, per), where = per == std::string::npos ? "" : plain.substr(per + 5);
        EnSightVariable variable;
        if (what == "vector") variable.kind = Kind::Vector;
        if (what == "tensor symm") variable.kind = Kind::Symmetric;
        if (what == "tensor asym") variable.kind = Kind::Tensor;
        const bool known = what == "scalar" || variable.kind != Kind::Scalar;
        variable.ofCells = where == "element";
        if (isCut() && words.size() < 2) throw std::runtime_error("ends within a line: truncated");
        if (!known || (where != "node" && where != "element")) {
            note("\"" + key + ": " + value.substr(0, 60) + "\" is left out");
            return;
        }
        const EnSightFile sets = setsOf(words, complex ? 3 : 2);
        if (complex && words.size() > 3 && numberIn(words.back())) words.pop_back(); // the frequency
        if (words.size() < (complex ? 3u : 2u)) {
            note("\"" + key + ": " + value.substr(0, 60) + "\" names no file and is left out");
            return;
        }
        const std::size_t files = complex ? 2 : 1;
        for (std::size_t w = 0; w + files < words.size(); ++w) variable.name += (w > 0 ? " " : "") + words[w];
        const std::string name = variable.name;
        for (std::size_t f = 0; f < files; ++f) {
            if (complex) variable.name = name + (f == 0 ? " real" : " imaginary");
            variable.file = sets;
            variable.file.name = words[words.size() - files + f];
            case_.variables.push_back(variable);
        }
    }

    void readConstant(std::vector<std::string>& words, bool inFile) {
        EnSightConstant constant;
        constant.timeSet = setsOf(words, 2).timeSet;
        if (words.size() < 2) return;
        constant.name = words[0];
        std::string text;
        if (inFile) {
            const std::string path = besides(case_.path, words[1]);
            if (!fs::exists(path))
                return note(constant.name + " is left out: its file " + words[1] + " does not exist");
            text = readWhole(path);
        } else {
            for (std::size_t w = 1; w < words.size(); ++w) text += words[w] + " ";
            text += following();
        }
        constant.values = numbersIn(text);
        if (!constant.values.empty()) case_.constants.push_back(constant);
    }

    /// The lines that go on with a list of numbers.
    std::string following() {
        std::string text;
        for (; at_ < lines_.size() && numberIn(wordsOf(lines_[at_])[0]); ++at_) text += " " + lines_[at_];
        return text;
    }

    void readTime(const std::string& key, const std::string& value) {
        const std::vector<std::string> words = wordsOf(value);
        if (key == "time set") {
            set_ = words.empty() ? 1 : wholeIn(words[0]).value_or(1);
            case_.times[set_];
            start_ = 0;
            increment_ = 1;
            steps_[set_] = 0;
        } else if (key == "number of steps") {
            const int count = words.empty() ? 0 : wholeIn(words[0]).value_or(0);
            if (count < 1 || std::size_t(count) > kMostSteps) throw std::runtime_error("states a bad number of steps");
            steps_[set_] = std::size_t(count);
        } else if (key == "filename start number") {
            start_ = words.empty() ? 0 : wholeIn(words[0]).value_or(0);
            numberFiles();
        } else if (key == "filename increment") {
            increment_ = words.empty() ? 1 : wholeIn(words[0]).value_or(1);
            numberFiles();
        } else if (key == "filename numbers" || key == "filename numbers file") {
            case_.times[set_].files.clear();
            for (const double n : listOf(key, value)) case_.times[set_].files.push_back(long(n));
        } else if (key == "time values" || key == "time values file") {
            case_.times[set_].values = listOf(key, value);
        }
    }

    std::vector<double> listOf(const std::string& key, const std::string& value) {
        if (!key.ends_with(" file")) return numbersIn(value + following());
        const std::vector<std::string> words = wordsOf(value);
        const std::string path = words.empty() ? "" : besides(case_.path, words[0]);
        if (!fs::exists(path)) throw std::runtime_error("names " + value.substr(0, 80) + ", which does not exist");
        return numbersIn(readWhole(path));
    }

    void numberFiles() {
        std::vector<long>& files = case_.times[set_].files;
        files.clear();
        for (std::size_t s = 0; s < steps_[set_]; ++s) files.push_back(start_ + long(s) * increment_);
    }

    void readFileSet(const std::string& key, const std::string& value) {
        const std::vector<std::string> words = wordsOf(value);
        if (words.empty()) return;
        if (key == "file set") {
            fileSet_ = wholeIn(words[0]).value_or(1);
            index_.clear();
        } else if (key == "filename index") {
            index_ = words[0];
        } else if (key == "number of steps") {
            const int count = wholeIn(words[0]).value_or(0);
            if (count > 0) case_.fileSets[fileSet_].emplace_back(index_, std::size_t(count));
        }
    }

    void finishTimes() {
        for (auto& [number, times] : case_.times) {
            const std::size_t steps = steps_[number] != 0 ? steps_[number] : times.values.size();
            if (times.values.size() < steps)
                throw std::runtime_error("states " + std::to_string(steps) + " steps and " +
                                         std::to_string(times.values.size()) + " times in time set " +
                                         std::to_string(number) + ": truncated");
            times.values.resize(steps);
            for (std::size_t s = times.files.size(); s < steps; ++s)
                times.files.push_back(s == 0 ? 0 : times.files.back() + 1);
            for (std::size_t s = 1; s < steps; ++s)
                if (!(times.values[s] > times.values[s - 1]))
                    throw std::runtime_error("has times that do not grow in time set " + std::to_string(number));
        }
    }

    EnSightCase case_;
    std::vector<std::string> lines_;
    std::size_t at_ = 0;
    bool typed_ = false, openEnd_ = false;
    int set_ = 1, fileSet_ = 1;
    long start_ = 0, increment_ = 1;
    std::map<int, std::size_t> steps_;
    std::string index_;
};

/// How far times may differ that are meant to be equal: they are stored with few digits.
double slackOf(const EnSightCase& about) {
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (const auto& [number, times] : about.times)
        for (std::size_t s = 0; s < times.values.size(); ++s) {
            most = std::max(most, std::abs(times.values[s]));
            if (s > 0) least = std::min(least, times.values[s] - times.values[s - 1]);
        }
    return std::min(1e-5 * most, std::isfinite(least) ? 0.01 * least : 0);
}

} // namespace

EnSightCase readEnSightCase(const std::string& path) {
    return CaseLines(path).read();
}

const EnSightTimes* timesOf(const EnSightCase& about, const EnSightFile& file) {
    const auto at = about.times.find(file.timeSet);
    if (at != about.times.end()) return &at->second;
    const bool changes = file.name.find('*') != std::string::npos;
    return changes && !about.times.empty() ? &about.times.begin()->second : nullptr;
}

std::optional<std::size_t> stepAt(const EnSightCase& about, const EnSightFile& file, double time, bool held) {
    const EnSightTimes* times = timesOf(about, file);
    if (times == nullptr) return 0;
    const double slack = slackOf(about);
    const auto after = std::upper_bound(times->values.begin(), times->values.end(), time + slack);
    if (after == times->values.begin()) return held ? std::optional<std::size_t>(0) : std::nullopt;
    const auto step = static_cast<std::size_t>(after - times->values.begin()) - 1;
    if (!held && times->values[step] < time - slack) return std::nullopt;
    return step;
}

EnSightPlace placeOf(const EnSightCase& about, const EnSightFile& file, std::size_t step) {
    EnSightPlace place{file.name, 0};
    const EnSightTimes* times = timesOf(about, file);
    std::string number = times != nullptr && step < times->files.size() ? std::to_string(times->files[step]) : "0";
    if (const auto set = about.fileSets.find(file.fileSet); set != about.fileSets.end()) {
        place.step = step;
        for (const auto& [index, steps] : set->second) {
            if (!index.empty()) number = index;
            if (place.step < steps || &index == &set->second.back().first) break;
            place.step -= steps;
        }
    }
    const std::size_t first = place.path.find('*');
    if (first != std::string::npos) {
        const std::size_t end = std::min(place.path.size(), place.path.find_first_not_of('*', first));
        if (number.size() < end - first) number.insert(0, end - first - number.size(), '0');
        place.path.replace(first, end - first, number);
    }
    place.path = besides(about.path, place.path);
    return place;
}

std::vector<double> allTimes(const EnSightCase& about) {
    std::vector<double> all;
    const auto add = [&](const EnSightTimes* times) {
        if (times != nullptr) all.insert(all.end(), times->values.begin(), times->values.end());
    };
    add(timesOf(about, about.geometry));
    for (const EnSightVariable& variable : about.variables) add(timesOf(about, variable.file));
    std::ranges::sort(all);
    const double slack = slackOf(about);
    std::vector<double> out;
    for (const double time : all)
        if (out.empty() || time > out.back() + slack) out.push_back(time);
    return out;
}

} // namespace tessera::importer
