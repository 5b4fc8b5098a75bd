#include "app/importer/foam/foam_field.h"

#include "app/importer/readers/check_file.h"
#include "app/importer/readers/dimension_units.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <stdexcept>

namespace tessera::importer {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kFieldHead = 16384; // bytes: where the values begin, but for long comments and included texts
constexpr int kMostIncluded = 8;          // files that include each other

using FoamWords = std::map<std::string, std::string>; ///< entries that others may name: $pressure

/// The entries of a field's file up to its values.
struct FieldEntries {
    FoamWords words;
    bool found = false; ///< the values begin where the cursor stands
};

/// A text as a file of its own.
FoamFile fileOfText(std::string text) {
    FoamFile file;
    file.bytes = std::move(text) + " ;"; // no number ends with the file
    return file;
}

std::string unquoted(std::string text) {
    std::erase(text, '"');
    return text;
}

/// The file that #include names: beside the one that says so, or in a folder of the case. Throws for what is
/// elsewhere.
std::string includedFile(const std::string& named, const std::string& from, const std::string& root) {
    std::string name = unquoted(named);
    for (const auto& [word, folder] : {std::pair{"$FOAM_CASE", ""},
                                       {"${FOAM_CASE}", ""},
                                       {"<case>", ""},
                                       {"<constant>", "/constant"},
                                       {"<system>", "/system"}})
        if (name.starts_with(word)) return besidesIn(root, "." + (folder + name.substr(std::string(word).size())));
    const fs::path path = fs::path(from).parent_path() / name; // an absolute name stays as it is
    std::error_code problem;
    if (!fs::exists(path, problem)) return path.string(); // it may be left out of a case that was copied
    return besidesIn(root, path.is_absolute() ? path.string() : path.lexically_proximate(root).string());
}

void readEntries(FoamCursor& in, const std::string& path, const std::string& root, int depth, FieldEntries& out) {
    while (in.more() && !out.found) {
        const std::string key = unquoted(std::string(in.word()));
        if (key == "#include" || key == "#includeIfPresent" || key == "#sinclude" || key == "#includeEtc") {
            const std::string word(in.word());
            if (key == "#includeEtc" || depth >= kMostIncluded) continue;
            const std::string named = includedFile(word, path, root);
            std::error_code problem;
            if (!fs::is_regular_file(named, problem)) continue;
            const FoamFile file = readFoamFile({named, named, -1});
            FoamCursor inner(file);
            FieldEntries entries;
            std::swap(entries.words, out.words);
            readEntries(inner, named, root, depth + 1, entries);
            std::swap(entries.words, out.words);
        } else if (key.starts_with('#')) {
            in.word(); // #inputMode merge, #remove name
        } else if ((key == "internalField" || key == "value") && depth == 0) {
            out.found = true;
        } else if (in.peek() == '{') {
            in.skipBrackets();
        } else if (key != ";" && key != "}") {
            out.words[key] = in.statement();
        }
    }
}

/// Replaces $name, ${name} and $:name by what the name stands for. `problem` gets the first name that is not known.
std::string withWords(const std::string& text, const FoamWords& words, std::string& problem, int depth = 0) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '$') {
            out += text[i];
            continue;
        }
        std::size_t begin = i + 1, end = 0;
        const bool braced = begin < text.size() && text[begin] == '{';
        if (braced) ++begin;
        while (begin < text.size() && (text[begin] == ':' || text[begin] == '.' || text[begin] == '/')) ++begin;
        for (end = begin; end < text.size();) {
            const auto c = static_cast<unsigned char>(text[end]);
            if (std::isalnum(c) == 0 && c != '_' && c != '.' && c != '-') break;
            ++end;
        }
        const std::string name = text.substr(begin, end - begin);
        const auto known = words.find(name);
        if (known == words.end() || depth > kMostIncluded) {
            if (problem.empty()) problem = "$" + name + " is not known";
            return {};
        }
        out += withWords(known->second, words, problem, depth + 1);
        i = end - (braced && end < text.size() ? 0 : 1);
    }
    return out;
}

/// "nonuniform List<scalar>", where a list follows: the cursor then stands at it.
bool atList(FoamCursor& in) {
    const std::size_t before = in.at();
    if (in.word() == "nonuniform") {
        if (in.peek() == 'L') in.word();
        const char next = in.peek();
        if (next == '(' || std::isdigit(static_cast<unsigned char>(next)) != 0) return true;
    }
    in.moveTo(before);
    return false;
}

/// The words of "uniform 300", with all names replaced; `problem` says what prevents that.
std::string singleValue(FoamCursor& in, const FoamWords& words, std::string& problem) {
    const std::string text = withWords(in.statement(), words, problem);
    if (const std::size_t code = text.find('#'); problem.empty() && code != std::string::npos) {
        std::size_t end = code + 1;
        while (end < text.size() && std::isalpha(static_cast<unsigned char>(text[end])) != 0) ++end;
        problem = "its values are given by " + text.substr(code, end - code);
    }
    return text;
}

std::vector<double> valuesOfField(FoamCursor& in, std::size_t components, std::size_t count) {
    if (atList(in)) {
        std::vector<double> values = in.numbers(components, count);
        if (values.size() != count * components)
            throw std::runtime_error("has " + std::to_string(values.size() / components) + " values for " +
                                     std::to_string(count) + " cells or points");
        return values;
    }
    if (in.word() != "uniform") throw std::runtime_error("states no values");
    std::vector<double> one(components), values;
    in.value(one.data(), components);
    values.reserve(count * components);
    for (std::size_t i = 0; i < count; ++i) values.insert(values.end(), one.begin(), one.end());
    return values;
}

/// Reads a file up to its values, with what `body` makes of it, from its beginning if that is enough.
template <class Body> void inFieldFile(const FoamPlace& place, const std::string& root, bool head, const Body& body) {
    for (const std::size_t most : {kFieldHead, kWholeFoamFile}) {
        if (!head && most != kWholeFoamFile) continue;
        const FoamFile file = readFoamFile(place, most);
        try {
            FoamCursor in(file);
            FieldEntries entries;
            if (foamKind(file.kind)) readEntries(in, place.path, root, 0, entries);
            body(in, file, entries);
            return;
        } catch (const std::runtime_error& error) {
            if (!file.whole && most != kWholeFoamFile) continue; // more of it may help
            throw std::runtime_error("its file " + place.shown + " " + error.what());
        }
    }
}

} // namespace

std::optional<FoamKind> foamKind(const std::string& name) {
    for (const auto& [place, ofPoints] : {std::pair{"vol", false}, {"point", true}})
        for (const auto& [type, components] :
             {std::pair{"Scalar", 1u}, {"Vector", 3u}, {"SphericalTensor", 1u}, {"SymmTensor", 6u}, {"Tensor", 9u}})
            for (const char* form : {"", "::Internal", "::DimensionedInternalField"})
                if (name == std::string(place) + type + "Field" + form) return FoamKind{components, ofPoints};
    return std::nullopt;
}

std::string elsewhereOf(const std::string& name) {
    if (name.find("Field") == std::string::npos) return {};
    if (name.starts_with("surface")) return "faces";
    if (name.starts_with("area") || name.starts_with("edge")) return "surfaces";
    return {};
}

FoamField readFoamField(const FoamPlace& place, const std::string& root) {
    FoamField field;
    inFieldFile(place, root, true, [&](FoamCursor& in, const FoamFile& file, const FieldEntries& entries) {
        field = {};
        field.kind = file.kind;
        const auto kind = foamKind(file.kind);
        if (!kind) return;
        if (!entries.found) {
            if (file.whole) field.problem = "it states no values";
            if (!file.whole) throw std::runtime_error("states no values");
            return;
        }
        if (const auto at = entries.words.find("dimensions"); at != entries.words.end()) {
            std::string unknown;
            const std::string text = withWords(at->second, entries.words, unknown);
            if (unknown.empty()) field.unit = unitOfDimensions(text);
        }
        if (atList(in)) {
            field.count = std::size_t(std::max<std::int64_t>(in.count(kWholeFoamFile), 0));
            return;
        }
        const FoamFile single = fileOfText(singleValue(in, entries.words, field.problem));
        if (!field.problem.empty()) return;
        FoamCursor words(single);
        if (atList(words)) return;
        valuesOfField(words, kind->components, 1);
        field.uniform = true;
    });
    return field;
}

std::vector<double> readFoamValues(const FoamPlace& place, const std::string& root, std::size_t count) {
    std::vector<double> values;
    inFieldFile(place, root, false, [&](FoamCursor& in, const FoamFile& file, const FieldEntries& entries) {
        const auto kind = foamKind(file.kind);
        if (!kind || !entries.found) throw std::runtime_error("states no values");
        const std::size_t begin = in.at();
        if (atList(in)) {
            in.moveTo(begin);
            values = valuesOfField(in, kind->components, count);
        } else {
            std::string problem;
            const FoamFile single = fileOfText(singleValue(in, entries.words, problem));
            if (!problem.empty()) throw std::runtime_error("is not read: " + problem);
            FoamCursor words(single);
            values = valuesOfField(words, kind->components, count);
        }
        if (const auto level = entries.words.find("referenceLevel"); level != entries.words.end()) {
            const FoamFile text = fileOfText(level->second);
            FoamCursor number(text);
            std::vector<double> one(kind->components);
            number.value(one.data(), one.size());
            for (std::size_t i = 0; i < values.size(); ++i) values[i] += one[i % one.size()];
        }
        // What follows states the boundary: a file cut before it ends too early.
        const bool whole = file.kind.ends_with("Field") && !file.kind.ends_with("InternalField");
        if (whole && file.bytes.find("boundaryField", in.at()) == std::string::npos)
            throw std::runtime_error("ends before its boundaryField: truncated");
        in.expectEnd();
    });
    return values;
}

} // namespace tessera::importer
