#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

/// The shape of the house: which room may include which, how long files and functions are, and where GLSL may stand.
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = TESSERA_SOURCE_DIR;

/// The parts of the house, and beside them what judges and measures them.
const std::vector<std::string> kParts = {"volume", "codec", "vis", "app", "tests/reference", "bench"};

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

std::vector<std::string> linesOf(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

/// What stands after `word` in a text, blanks left out; empty when the text does not start with it.
std::string after(const std::string& text, const std::string& word) {
    const std::size_t start = text.find_first_not_of(" \t");
    if (start == std::string::npos || text.compare(start, word.size(), word) != 0) return {};
    const std::size_t rest = text.find_first_not_of(" \t", start + word.size());
    return rest == std::string::npos ? std::string() : text.substr(rest);
}

/// Included names, with the sign before them: "\"volume/field/field.h" or "<cmath".
std::vector<std::string> includesOf(const std::string& text) {
    std::vector<std::string> includes;
    for (const std::string& line : linesOf(text)) {
        const std::string named = after(after(line, "#"), "include");
        if (named.size() > 1 && (named[0] == '"' || named[0] == '<'))
            includes.push_back(named.substr(0, named.find_first_of("\">", 1)));
    }
    return includes;
}

bool startsWithAny(const std::string& text, const std::vector<std::string>& prefixes) {
    return std::ranges::any_of(prefixes, [&](const std::string& prefix) { return text.starts_with(prefix); });
}

const std::vector<std::string> kGl = {"epoxy/", "GL/", "EGL/", "GLFW/"}, kGui = {"imgui"}, kJson = {"nlohmann/"};

/// The rooms in their order, as docs/rooms.md names them: "### volume/base" and so on.
std::vector<std::string> roomsInOrder() {
    std::vector<std::string> rooms;
    for (const std::string& line : linesOf(textOf(kRoot / "docs/rooms.md")))
        if (const std::string room = after(line, "###"); !room.empty()) rooms.push_back(room);
    return rooms;
}

std::string partOf(const std::string& path) {
    return path.substr(0, path.find('/'));
}

/// Whether a file of one room may include one of another: itself or a room above it, and of other parts those that lie
/// below its own.
bool mayInclude(const std::vector<std::string>& rooms, const std::string& from, const std::string& to) {
    static const std::map<std::string, std::set<std::string>> kBelow = {
        {"volume", {"volume"}},
        {"codec", {"codec", "volume"}},
        {"vis", {"vis", "volume"}},
        {"app", {"app", "vis", "codec", "volume"}},
        {"tests", {"tests", "vis", "volume"}},
        {"bench", {"bench", "tests", "app", "vis", "codec", "volume"}},
    };
    const auto a = std::ranges::find(rooms, from), b = std::ranges::find(rooms, to);
    return b <= a && b != rooms.end() && kBelow.at(partOf(from)).contains(partOf(to));
}

std::string roomOf(const std::string& file) {
    return fs::path(file).parent_path().generic_string();
}

TEST(Architecture, IncludesOnlyPointUpTheListOfRooms) {
    const std::vector<std::string> rooms = roomsInOrder();
    std::map<std::string, int> files;
    std::size_t seen = 0;
    for (const std::string& part : kParts)
        for (const std::string& file : filesOf(part, {".h", ".cpp", ".inc", ".glsl"})) {
            const std::string room = roomOf(file);
            ++files[room];
            if (file == "app/main.cpp") continue;
            ASSERT_NE(std::ranges::find(rooms, room), rooms.end()) << file << " lies in no room of docs/rooms.md";
            for (const std::string& named : includesOf(textOf(kRoot / file))) {
                std::string include = named.substr(1);
                if (file.ends_with(".glsl")) { // what fills a <slot:> is named by C++
                    if (include.starts_with("slot:")) continue;
                    const bool formula = include.starts_with("formulas/"); // made of C++
                    include =
                        formula ? "vis/" + include.substr(0, include.rfind('.')) + ".h" : "vis/shaders/" + include;
                    EXPECT_TRUE(fs::exists(kRoot / include)) << file << " includes " << include;
                }
                EXPECT_FALSE(include.starts_with("..") || include.starts_with("./"))
                    << file << ": includes are written from the root: " << include;
                if (!startsWithAny(include, {"volume/", "codec/", "vis/", "app/", "tests/", "bench/"})) continue;
                ++seen;
                EXPECT_EQ(named[0], '"') << file << " includes " << include;
                EXPECT_TRUE(mayInclude(rooms, room, roomOf(include))) << file << " includes " << include;
            }
        }
    EXPECT_GT(seen, 1000u);
    for (const std::string& room : rooms) {
        EXPECT_GT(files[room], 0) << room << " of docs/rooms.md holds nothing";
        // A hint, no limit: what belongs together is not put elsewhere to keep a number.
        const bool many = files[room] > 28;
        std::printf("%3d files  %s%s\n", files[room], room.c_str(), many ? ": rather many, is it two subjects?" : "");
    }
}

TEST(Architecture, FilesAreReadInAFewScreens) {
    for (const std::string& part : kParts)
        for (const std::string& file : filesOf(part, {".h", ".cpp", ".inc", ".glsl"}))
            EXPECT_LE(linesOf(textOf(kRoot / file)).size(), 400u) << file;
}

/// Functions at the left edge of a formatted file: their first lines and how many lines they have.
std::vector<std::pair<std::string, std::size_t>> functionsOf(const std::string& text) {
    std::vector<std::pair<std::string, std::size_t>> functions;
    std::string head;
    std::size_t lines = 0;
    for (const std::string& line : linesOf(text)) {
        ++lines;
        if (line == "}") {
            const bool other = startsWithAny(head, {"struct ", "class ", "namespace ", "enum ", "union ", "extern "});
            if (head.find('(') != std::string::npos && !other) functions.emplace_back(head, lines);
            head.clear();
        } else if (!line.empty() && std::string(" #}/").find(line[0]) == std::string::npos) {
            head = line;
            lines = 1;
        }
    }
    return functions;
}

TEST(Architecture, FunctionsAreSeenAtOnce) {
    std::size_t seen = 0;
    for (const std::string& part : kParts)
        for (const std::string& file : filesOf(part, {".cpp"}))
            for (const auto& [head, lines] : functionsOf(textOf(kRoot / file))) {
                ++seen;
                EXPECT_LE(lines, 80u) << file << ": " << head;
            }
    EXPECT_GT(seen, 3000u);
    const auto found = functionsOf("struct A {\n    int b(int c) {\n        return c;\n    }\n};\n\n"
                                   "int d(int e,\n      int f) {\n    return e;\n}\nstruct G {\n}\n");
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].second, 4u);
}

// "| Where is ...? | `file` |"
TEST(Architecture, FilesThatTheRoomsPageNamesExist) {
    int named = 0;
    for (const std::string& line : linesOf(textOf(kRoot / "docs/rooms.md"))) {
        const std::size_t open = line.starts_with("|") ? line.find('`') : std::string::npos;
        if (open == std::string::npos) continue;
        const std::string file = line.substr(open + 1, line.find('`', open + 1) - open - 1);
        EXPECT_TRUE(fs::is_regular_file(kRoot / file)) << file;
        ++named;
    }
    EXPECT_GE(named, 10);
}

/// A file without its ending: X.h, X.cpp and X_impl.h (the inside of the class of X.h) are one unit.
std::string unitOf(const std::string& file) {
    const std::string stem = file.substr(0, file.rfind('.'));
    return stem.ends_with("_impl") ? stem.substr(0, stem.size() - 5) : stem;
}

/// Finds a way from a unit back to itself, by depth-first search; "" if there is none.
std::string cycleFrom(const std::string& unit, const std::map<std::string, std::set<std::string>>& uses,
                      std::map<std::string, int>& seen, std::vector<std::string>& path) {
    enum { Open = 1, Done = 2 };
    seen[unit] = Open;
    path.push_back(unit);
    if (const auto found = uses.find(unit); found != uses.end())
        for (const std::string& next : found->second) {
            if (seen[next] == Done) continue;
            if (seen[next] == Open) {
                std::string way;
                for (auto at = std::ranges::find(path, next); at != path.end(); ++at) way += *at + " -> ";
                return way + next;
            }
            if (std::string way = cycleFrom(next, uses, seen, path); !way.empty()) return way;
        }
    path.pop_back();
    seen[unit] = Done;
    return {};
}

std::string anyCycle(const std::map<std::string, std::set<std::string>>& uses) {
    std::map<std::string, int> seen;
    for (const auto& [unit, used] : uses) {
        std::vector<std::string> path;
        if (seen[unit] != 0) continue;
        if (std::string way = cycleFrom(unit, uses, seen, path); !way.empty()) return way;
    }
    return {};
}

TEST(Architecture, NoFilesIncludeEachOther) {
    std::map<std::string, std::set<std::string>> uses;
    for (const std::string& part : kParts)
        for (const std::string& file : filesOf(part, {".h", ".cpp", ".inc"}))
            for (const std::string& named : includesOf(textOf(kRoot / file)))
                if (named[0] == '"' && unitOf(named.substr(1)) != unitOf(file))
                    uses[unitOf(file)].insert(unitOf(named.substr(1)));
    EXPECT_GT(uses.size(), 300u);
    EXPECT_EQ(anyCycle(uses), "");
    EXPECT_EQ(anyCycle({{"a", {"b", "c"}}, {"b", {"c"}}, {"c", {}}}), "");
    EXPECT_EQ(anyCycle({{"a", {"b"}}, {"b", {"c"}}, {"c", {"b"}}}), "b -> c -> b");
}

TEST(Architecture, AWrongIncludeIsNoticed) {
    const std::vector<std::string> rooms = roomsInOrder();
    EXPECT_TRUE(mayInclude(rooms, "volume/field", "volume/base"));
    EXPECT_TRUE(mayInclude(rooms, "vis/scene", "volume/mesh"));
    EXPECT_FALSE(mayInclude(rooms, "volume/base", "volume/field")); // below it
    EXPECT_FALSE(mayInclude(rooms, "vis/scene", "codec/bytes"));    // parts that do not know each other
    EXPECT_FALSE(mayInclude(rooms, "volume/base", "volume/nowhere"));
    EXPECT_FALSE(mayInclude(rooms, "app/command", "tests/reference")); // the product knows no judge
    EXPECT_FALSE(mayInclude(rooms, "app/command", "bench"));
}

TEST(Architecture, OutsideLibrariesStayInTheirRooms) {
    const std::vector<std::string> withoutGl = {"volume/",     "codec/",      "vis/transfer/",  "vis/scene/",
                                                "vis/optics/", "vis/shapes/", "vis/processor/", "tests/reference/"};
    for (const std::string part : {"volume", "codec", "vis", "tests/reference"})
        for (const std::string& file : filesOf(part, {".h", ".cpp"}))
            for (const std::string& named : includesOf(textOf(kRoot / file))) {
                const std::string include = named.substr(1);
                if (startsWithAny(file, withoutGl)) {
                    EXPECT_FALSE(startsWithAny(include, kGl)) << file << " includes " << include;
                }
                if (part == "vis") {
                    EXPECT_FALSE(startsWithAny(include, kJson)) << file << " includes " << include;
                }
                EXPECT_FALSE(startsWithAny(include, kGui)) << file << " includes " << include;
                EXPECT_FALSE(include.starts_with("curl/") && !file.starts_with("codec/remote/")) << file;
            }
}

TEST(Architecture, NoJsonInHeadersOfVolume) {
    for (const std::string& file : filesOf("volume", {".h"}))
        for (const std::string& include : includesOf(textOf(kRoot / file)))
            EXPECT_FALSE(startsWithAny(include.substr(1), kJson)) << file;
}

// ImGui's own sliders take any number that is typed, also one that a session cannot hold.
TEST(Architecture, SlidersStayBetweenTheirEnds) {
    for (const std::string& file : filesOf("app", {".cpp"})) {
        const bool own = file == "app/ui/number_field.cpp";
        EXPECT_EQ(textOf(kRoot / file).find("ImGui::Slider") != std::string::npos, own) << file;
    }
}

// ImGui's own invisible buttons end the program where they have no size.
TEST(Architecture, AreasForTheMouseHaveASize) {
    for (const std::string& file : filesOf("app", {".h", ".cpp"})) {
        const bool own = file == "app/ui/widgets.cpp";
        EXPECT_EQ(textOf(kRoot / file).find("ImGui::InvisibleButton") != std::string::npos, own) << file;
    }
}

// Names of files and of what is in them may hold anything: terminal.h makes it harmless, jsonText() makes JSON of it.
TEST(Architecture, TextsLeaveByTheFunctionsThatMakeThemPrintable) {
    const std::set<std::string> progress = {"app/command/command.cpp"}, // erases its line
        numbers = {"app/described/describe_cli.h", "app/session/describe_markdown.cpp"};
    for (const std::string& file : filesOf("app", {".h", ".cpp"})) {
        if (file.starts_with("app/importer/")) continue;
        const std::string text = textOf(kRoot / file);
        for (const char* const printing : {"std::printf", "std::fprintf(std", "std::cout", "std::cerr", "std::puts"})
            EXPECT_TRUE(text.find(printing) == std::string::npos || progress.contains(file)) << file;
        EXPECT_TRUE(text.find(".dump(") == std::string::npos || numbers.contains(file)) << file;
    }
}

// Shaders are files; C++ may only generate "#define NAME value" lines and the version that heads a composed program.
TEST(Architecture, NoGlslInCpp) {
    for (const std::string& folder : kParts)
        for (const std::string& file : filesOf(folder, {".h", ".cpp"})) {
            if (file.starts_with("vis/shaders/")) continue;
            const std::string text = std::regex_replace(textOf(kRoot / file), std::regex("H5Pget_layout\\("), "");
            for (const char* glsl :
                 {"void main(", "gl_FragCoord", "gl_Position", "layout(", "layout (", "uniform sampler"})
                EXPECT_EQ(text.find(glsl), std::string::npos) << file << " contains " << glsl;
            for (const std::string& line : linesOf(text))
                if (const std::size_t at = line.find("#version"); at != std::string::npos && line[0] != '/') {
                    const std::string rest = line.substr(at, line.find('"', at) - at);
                    // The composer heads its programs with it, and ImGui's own renderer asks for it.
                    const bool known = file.starts_with("vis/gl/") || line.find("ImGui_ImplOpenGL3_Init") < at;
                    EXPECT_TRUE(known && rest.size() < 30) << file << ": " << line;
                }
        }
}

std::string withoutComments(const std::string& text) {
    std::string code;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text.compare(i, 2, "//") == 0)
            i = std::min(text.find('\n', i), text.size());
        else if (text.compare(i, 2, "/*") == 0)
            i = std::min(text.find("*/", i), text.size()) + 1;
        if (i < text.size()) code += text[i];
    }
    return code;
}

/// Names of functions defined at file scope of a GLSL text: what stands before the first parenthesis of a heading.
std::set<std::string> glslFunctions(const std::string& text) {
    std::set<std::string> names;
    std::string heading;
    int depth = 0;
    for (const char c : withoutComments(text)) {
        if (c == '{' && depth++ == 0) {
            const std::size_t open = heading.find('(');
            const std::size_t last = heading.find_last_not_of(" \t\r\n", open == 0 ? 0 : open - 1);
            if (open != std::string::npos && last != std::string::npos) {
                const std::size_t start = heading.find_last_of(" \t\r\n", last) + 1;
                const std::string name = heading.substr(start, last + 1 - start);
                if (name != "layout") names.insert(name);
            }
        }
        if (c == '}' && depth > 0) --depth;
        if (c == ';' || c == '}' || c == '{')
            heading.clear();
        else if (depth == 0)
            heading += c;
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

// The searches above find what they are meant to find.
TEST(Architecture, FindsIncludesAndGlslFunctions) {
    EXPECT_EQ(glslFunctions("// float no() {}\nconst float k = f(1);\n"
                            "float a(vec3 p) { if (p.x > 0) { return 1; } return 2; }\n"
                            "layout(std430) buffer Block { int x; };\nstruct S { int y; };\n"
                            "vec4 b(int i,\n       float f)\n{\n  for (;;) { }\n}\nfloat declared(float x);\n"),
              (std::set<std::string>{"a", "b"}));
    EXPECT_EQ(includesOf("#include \"volume/field/field.h\"\n # include <cmath>\n// #include <x>\n"),
              (std::vector<std::string>{"\"volume/field/field.h", "<cmath"}));
}

} // namespace
