#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

/// The shape of the house: which room may include which, and where GLSL may stand.
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = TESSERA_SOURCE_DIR;

std::string textOf(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/// Files of a folder by extension, relative to the root.
std::vector<std::string> filesOf(const std::string& folder, const std::set<std::string>& extensions) {
    std::vector<std::string> files;
    if (!fs::exists(kRoot / folder)) return files;
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder))
        if (entry.is_regular_file() && extensions.contains(entry.path().extension().string()))
            files.push_back(fs::relative(entry.path(), kRoot).generic_string());
    std::sort(files.begin(), files.end());
    return files;
}

std::vector<std::string> includesOf(const std::string& text) {
    static const std::regex line(R"(^[ \t]*#[ \t]*include[ \t]*[<"]([^>"]+)[>"])", std::regex::multiline);
    std::vector<std::string> includes;
    for (std::sregex_iterator match(text.begin(), text.end(), line), end; match != end; ++match)
        includes.push_back((*match)[1]);
    return includes;
}

bool startsWithAny(const std::string& text, const std::vector<std::string>& prefixes) {
    return std::ranges::any_of(prefixes, [&](const std::string& prefix) { return text.starts_with(prefix); });
}

/// A folder, the folders of ours it may include, and outside headers it must not.
struct Room {
    std::string folder;
    std::vector<std::string> mayInclude, mustNot;
};

const std::vector<std::string> kGl = {"epoxy/", "GL/", "EGL/", "GLFW/"}, kGui = {"imgui"}, kJson = {"nlohmann/"};

std::vector<std::string> join(std::vector<std::string> a, const std::vector<std::string>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

const std::vector<Room> kRooms = {
    {"volume", {"volume/"}, join(kGl, kGui)},
    {"codec", {"codec/", "volume/"}, join(kGl, kGui)},
    {"vis/model", {"vis/model/", "vis/shaders/shared/", "volume/"}, join(join(kGl, kGui), kJson)},
    {"vis/reference", {"vis/reference/", "vis/model/", "vis/shaders/shared/", "volume/"}, join(join(kGl, kGui), kJson)},
    {"vis", {"vis/", "volume/"}, join(kGui, kJson)},
    {"app", {"app/", "vis/", "codec/", "volume/"}, {}},
};

TEST(Architecture, IncludesOnlyPointUpTheList) {
    std::size_t seen = 0;
    for (const Room& room : kRooms)
        for (const std::string& file : filesOf(room.folder, {".h", ".cpp"})) {
            for (const std::string& include : includesOf(textOf(kRoot / file))) {
                ++seen;
                const bool ours = startsWithAny(include, {"volume/", "codec/", "vis/", "app/", "tests/"});
                if (ours) {
                    EXPECT_TRUE(startsWithAny(include, room.mayInclude)) << file << " includes " << include;
                }
                EXPECT_FALSE(startsWithAny(include, room.mustNot)) << file << " includes " << include;
                EXPECT_FALSE(include.starts_with("..") || include.starts_with("./"))
                    << file << ": includes are written from the root: " << include;
            }
        }
    EXPECT_GT(seen, 100u);
}

TEST(Architecture, NoJsonInHeadersOfVolume) {
    for (const std::string& file : filesOf("volume", {".h"}))
        for (const std::string& include : includesOf(textOf(kRoot / file)))
            EXPECT_FALSE(startsWithAny(include, kJson)) << file;
}

TEST(Architecture, OurHeadersAreIncludedWithQuotes) {
    static const std::regex angled(R"(#include <(volume|codec|vis|app)/)");
    for (const Room& room : kRooms)
        for (const std::string& file : filesOf(room.folder, {".h", ".cpp"}))
            EXPECT_FALSE(std::regex_search(textOf(kRoot / file), angled)) << file;
}

// Shaders are files; C++ may only generate "#define NAME value" lines and the version that heads a composed program.
TEST(Architecture, NoGlslInCpp) {
    static const std::regex glsl(R"re(\bvoid main\(\)|\bgl_FragCoord\b|\blayout ?\(|\buniform (sampler|float|vec))re");
    static const std::regex version(R"re("[^"\n]*#version[^"]*\n?[^"]*")re");
    for (const std::string folder : {"volume", "codec", "vis", "app"})
        for (const std::string& file : filesOf(folder, {".h", ".cpp"})) {
            if (file.starts_with("vis/shaders/")) continue;
            const std::string text = textOf(kRoot / file);
            EXPECT_FALSE(std::regex_search(text, glsl)) << file;
            // The composer writes the version line itself: nothing may follow it in the string.
            for (std::sregex_iterator match(text.begin(), text.end(), version), end; match != end; ++match)
                EXPECT_TRUE(file.starts_with("vis/gl/") && match->str().size() < 40) << file << ": " << match->str();
        }
}

/// Names of functions defined at file scope of a GLSL text.
std::set<std::string> glslFunctions(const std::string& text) {
    static const std::regex comments(R"(//[^\n]*|/\*[\s\S]*?\*/)");
    static const std::regex definition(
        R"(^[ \t]*(?:highp |mediump )?[A-Za-z_]\w*(?:\[\d*\])?[ \t]+([A-Za-z_]\w*)[ \t]*\(([^;{}]*)\)[ \t\r\n]*\{)",
        std::regex::multiline);
    const std::string code = std::regex_replace(text, comments, "");
    std::set<std::string> names;
    int depth = 0;
    std::size_t from = 0;
    for (std::sregex_iterator match(code.begin(), code.end(), definition), end; match != end; ++match) {
        const auto at = std::size_t(match->position());
        depth += int(std::count(code.begin() + std::ptrdiff_t(from), code.begin() + std::ptrdiff_t(at), '{'));
        depth -= int(std::count(code.begin() + std::ptrdiff_t(from), code.begin() + std::ptrdiff_t(at), '}'));
        from = at;
        if (depth == 0) names.insert((*match)[1]);
    }
    return names;
}

TEST(Architecture, NoGlslFunctionIsDefinedTwice) {
    std::map<std::string, std::string> home;
    for (const std::string& file : filesOf("vis/shaders/lib", {".glsl"}))
        for (const std::string& name : glslFunctions(textOf(kRoot / file))) {
            const auto [known, fresh] = home.try_emplace(name, file);
            EXPECT_TRUE(fresh) << name << " is defined in " << known->second << " and in " << file;
        }
}

// The search above finds what it is meant to find.
TEST(Architecture, FindsGlslFunctions) {
    EXPECT_EQ(glslFunctions("// float no() {}\nfloat a(vec3 p) { if (p.x > 0) { return 1; } return 2; }\n"
                            "vec4 b(int i,\n       float f)\n{\n  for (;;) { }\n}\nfloat declared(float x);\n"),
              (std::set<std::string>{"a", "b"}));
    EXPECT_EQ(includesOf("#include \"volume/field.h\"\n # include <cmath>\n// text\n"),
              (std::vector<std::string>{"volume/field.h", "cmath"}));
}

} // namespace
