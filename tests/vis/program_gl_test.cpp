#include "tests/vis/gl_fixture.h"

#include "vis/gl/program.h"
#include "vis/gl/shader_files.h"
#include "volume/base/error.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace tessera {
namespace {

using vis::ProgramRecipe;

/// A folder of shaders that lies over the built-in ones while the test runs.
class ProgramTest : public test::GlTest {
protected:
    ProgramTest() : folder_(std::filesystem::path(TESSERA_BINARY_DIR) / ("program-test-" + std::to_string(getpid()))) {
        std::filesystem::create_directories(folder_);
        setenv("TESSERA_SHADER_DIR", folder_.c_str(), 1);
    }
    ~ProgramTest() override {
        unsetenv("TESSERA_SHADER_DIR");
        std::filesystem::remove_all(folder_);
    }
    void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }

private:
    std::filesystem::path folder_;
};

std::string failure(const ProgramRecipe& recipe) {
    try {
        vis::makeProgram(recipe);
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

TEST_F(ProgramTest, IncludesOnceAndFillsSlots) {
    write("a.glsl", "float a() { return 1.0; }\n");
    write("b.glsl", "#include \"a.glsl\"\nfloat slot() { return a() * FACTOR; }\n");
    write("main.glsl",
          "#include \"a.glsl\"\n  #include <slot:thing>\nout vec4 c;\nvoid main() { c = vec4(slot() + a()); }\n");
    const ProgramRecipe recipe{"screen.vert.glsl", "main.glsl", {{"thing", "b.glsl"}}, {{"FACTOR", "2.0"}}};
    EXPECT_EQ(failure(recipe), "");
    const vis::ComposedShader composed = vis::composeShader("main.glsl", recipe);
    EXPECT_EQ(composed.files, (std::vector<std::string>{"main.glsl", "a.glsl", "b.glsl"}));
    EXPECT_EQ(composed.text.find("float a()"), composed.text.rfind("float a()"));
}

TEST_F(ProgramTest, ErrorsNameFileAndLine) {
    write("broken.glsl", "float fine() { return 1.0; }\n\nfloat broken() { return nothing; }\n");
    write("main.glsl", "#include \"broken.glsl\"\nout vec4 c;\nvoid main() { c = vec4(broken()); }\n");
    EXPECT_NE(failure({"screen.vert.glsl", "main.glsl", {}, {}}).find("broken.glsl:3"), std::string::npos)
        << failure({"screen.vert.glsl", "main.glsl", {}, {}});
    write("lost.glsl", "\n#include \"no such.glsl\"\nvoid main() {}\n");
    EXPECT_EQ(failure({"screen.vert.glsl", "lost.glsl", {}, {}}), "lost.glsl:2: no shader file \"no such.glsl\"");
    write("slotless.glsl", "#include <slot:none>\nvoid main() {}\n");
    EXPECT_EQ(failure({"screen.vert.glsl", "slotless.glsl", {}, {}}), "slotless.glsl:1: nothing fills <slot:none>");
}

TEST_F(ProgramTest, MapsLinesOfSeveralCompilers) {
    const std::vector<std::string> files{"main.glsl", "lib/a.glsl"};
    EXPECT_EQ(vis::mapLines("0:10012(5): error: x\n", files), "lib/a.glsl:12(5): error: x");
    EXPECT_EQ(vis::mapLines("0(10012) : error C0: x\n", files), "lib/a.glsl:12 : error C0: x");
    EXPECT_EQ(vis::mapLines("ERROR: 0:7: x", files), "ERROR: main.glsl:7: x");
}

// Slot functions aside, a function lives in one file.
TEST(ShaderFiles, NoFunctionIsDefinedTwice) {
    std::map<std::string, std::string> seen;
    for (const vis::ShaderFile& file : vis::embeddedShaders()) {
        if (file.path.find("slots/") == 0) continue;
        std::istringstream lines{std::string(file.text)};
        for (std::string line; std::getline(lines, line);) {
            const std::size_t open = line.find('(');
            if (line.empty() || line[0] == ' ' || line.find(") {") == std::string::npos || open == std::string::npos)
                continue;
            const std::size_t start = line.rfind(' ', open) + 1;
            const std::string name = line.substr(start, open - start);
            if (name == "main") continue;
            const auto [other, fresh] = seen.emplace(name + line.substr(open), std::string(file.path));
            EXPECT_TRUE(fresh || other->second == file.path) << name << " in " << file.path << " and " << other->second;
        }
    }
    EXPECT_GT(seen.size(), 5u);
}

} // namespace
} // namespace tessera
