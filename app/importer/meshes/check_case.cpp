// Checks for truncated OpenFOAM cases, in which each array is a separate file.
#include "app/importer/meshes/foam_units.h"
#include "app/importer/readers/check_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <regex>
#include <stdexcept>

namespace tessera::importer {

namespace fs = std::filesystem;

namespace {

std::string nameIn(const fs::path& folder, const fs::path& file) {
    return file.lexically_relative(folder).string();
}

/// OpenFOAM text: every bracket must close, ignoring comments and quoted words. Of binary lists only the last line is
/// checked.
void checkFoamFile(const std::string& path) {
    if (path.ends_with(".gz")) {
        checkDeflated(path, 0, 0);
        return;
    }
    const std::string text = readWhole(path);
    if (text.find("FoamFile") == std::string::npos) {
        if (text.empty() || text.compare(0, 4, "/*--") == 0) throw std::runtime_error("ends within its header");
        return; // not an OpenFOAM file
    }
    std::string code; // the text without comments
    static const std::regex kBinary("format\\s+binary");
    const bool binary = std::regex_search(text.substr(0, 2000), kBinary);
    if (binary) {
        const std::size_t last = text.find_last_not_of(" \t\r\n");
        const bool comment = text.compare(last - std::min<std::size_t>(last, 1), 2, "//") == 0;
        if (!comment && text[last] != '}' && text[last] != ')' && text[last] != ';')
            throw std::runtime_error("ends too early: truncated");
        return;
    }
    int depth = 0;
    char last = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '/' && i + 1 < text.size() && (text[i + 1] == '/' || text[i + 1] == '*')) {
            const bool line = text[i + 1] == '/';
            const std::size_t end = text.find(line ? "\n" : "*/", i + 2);
            if (end == std::string::npos && !line) throw std::runtime_error("ends within a comment: truncated");
            i = end == std::string::npos ? text.size() : end + (line ? 0 : 1);
            continue;
        }
        if (c == '"') {
            i = text.find('"', i + 1);
            if (i == std::string::npos) throw std::runtime_error("ends within a word: truncated");
        }
        if (c == '{' || c == '(') ++depth;
        if (c == '}' || c == ')') --depth;
        if (std::isspace(static_cast<unsigned char>(c)) == 0) last = c;
    }
    if (depth != 0 || (last != '}' && last != ')' && last != ';'))
        throw std::runtime_error("ends too early: truncated");
}

/// A field must state its boundary: a file truncated before it would still close all brackets.
void checkFoamField(const std::string& path) {
    checkFoamFile(path);
    if (path.ends_with(".gz")) return;
    const std::string text = readWhole(path);
    const bool field = text.find("volScalarField") < 2000 || text.find("volVectorField") < 2000 ||
                       text.find("volSymmTensorField") < 2000 || text.find("volTensorField") < 2000;
    if (field && text.find("boundaryField") == std::string::npos)
        throw std::runtime_error("ends before its boundaryField: truncated");
    if (text.find("FoamFile") != std::string::npos && text.find("class") == std::string::npos)
        throw std::runtime_error("ends within its header: truncated");
}

} // namespace

void checkFoam(const std::string& path, double time) {
    const fs::path folder = fs::is_directory(path) ? fs::path(path) : fs::path(path).parent_path();
    const fs::path start = folder.empty() ? fs::path(".") : folder;
    const auto check = [&](const fs::path& file) {
        try {
            checkFoamField(file.string());
        } catch (const std::runtime_error& error) {
            throw std::runtime_error("its file " + nameIn(start, file) + " " + error.what());
        }
    };
    for (const fs::directory_entry& one : fs::directory_iterator(start)) {
        const std::string name = one.path().filename().string();
        const bool constant = name == "constant";
        if (!one.is_directory() || (!constant && !(namesTime(name) && std::abs(std::stod(name) - time) <= 1e-6 * time)))
            continue;
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(one)) {
            const std::string inner = nameIn(one, entry.path());
            const bool mesh = inner.find("polyMesh") != std::string::npos;
            const bool passed = inner.starts_with("uniform/") || inner.find("lagrangian/") != std::string::npos;
            if (entry.is_regular_file() && !passed && (mesh || !constant)) check(entry.path());
        }
    }
}

} // namespace tessera::importer
