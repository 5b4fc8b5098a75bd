#include "vis/gl/program.h"

#include "vis/gl/shader_constants.h"
#include "vis/gl/shader_files.h"
#include "volume/base/error.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

namespace tessera::vis {

std::string ProgramRecipe::key() const {
    std::string key = vertex + '|' + fragment;
    for (const auto& [name, file] : slots) key += '|' + name + '=' + file;
    for (const auto& [name, value] : defines) key += '|' + name + ' ' + value;
    return key;
}

const std::string* shaderText(const std::string& path) {
    if (const char* folder = std::getenv("TESSERA_SHADER_DIR")) {
        static std::map<std::string, std::string> read;
        std::ifstream file(std::string(folder) + '/' + path);
        std::stringstream text;
        if (file && text << file.rdbuf()) return &(read[path] = text.str());
    }
    static const std::map<std::string, std::string> builtIn = [] {
        std::map<std::string, std::string> texts;
        for (const ShaderFile& file : embeddedShaders()) texts.emplace(file.path, file.text);
        return texts;
    }();
    const auto found = builtIn.find(path);
    return found != builtIn.end() ? &found->second : nullptr;
}

namespace {

struct Composer {
    const ProgramRecipe& recipe;
    ComposedShader out;
    std::set<std::string> seen;

    void add(const std::string& path, const std::string& from) {
        if (!seen.insert(path).second) return;
        const std::string* text = shaderText(path);
        if (!text) throw Error("no shader file \"" + path + "\"", from);
        const std::size_t file = out.files.size();
        out.files.push_back(path);
        std::istringstream lines(*text);
        std::string line;
        auto mark = [&](int number) {
            out.text += "#line " + std::to_string(file * 10000 + std::size_t(number)) + '\n';
        };
        mark(1);
        for (int number = 1; std::getline(lines, line); ++number) {
            const std::size_t start = line.find_first_not_of(" \t");
            if (start == std::string::npos || line.compare(start, 8, "#include") != 0) {
                out.text += line + '\n';
                continue;
            }
            add(target(line, path + ':' + std::to_string(number)), path + ':' + std::to_string(number));
            mark(number + 1);
        }
    }

    std::string target(const std::string& line, const std::string& place) const {
        const std::size_t open = line.find_first_of("\"<"), close = line.find_last_of("\">");
        if (open == std::string::npos || close <= open) throw Error("malformed #include", place);
        std::string name = line.substr(open + 1, close - open - 1);
        if (line[open] == '"') return name;
        if (name.rfind("slot:", 0) != 0) throw Error("#include <" + name + "> is not a slot", place);
        const auto found = recipe.slots.find(name.substr(5));
        if (found == recipe.slots.end()) throw Error("nothing fills <" + name + ">", place);
        return found->second;
    }
};

GLuint compile(GLenum stage, const std::string& root, const ComposedShader& composed) {
    const GLuint shader = glCreateShader(stage);
    const char* text = composed.text.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    GLint ok = 0, length = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (ok) return shader;
    glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length), '\0');
    glGetShaderInfoLog(shader, length, &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    glDeleteShader(shader);
    throw Error(mapLines(log, composed.files), root);
}

} // namespace

ComposedShader composeShader(const std::string& root, const ProgramRecipe& recipe) {
    Composer composer{recipe, {}, {}};
    composer.out.text = "#version 450 core\n" + shaderConstants();
    for (const auto& [name, value] : recipe.defines) composer.out.text += "#define " + name + ' ' + value + '\n';
    composer.add(root, {});
    return std::move(composer.out);
}

std::string mapLines(std::string_view log, const std::vector<std::string>& files) {
    // Mesa writes "0:20012(5): error: ...", others "0(20012) : error ..." or "ERROR: 0:20012: ...": the line always
    // follows "0:" or "0(". Small numbers belong to file 0.
    std::string out;
    for (std::size_t at = 0; at < log.size();) {
        const bool start = log[at] == '0' && at + 2 < log.size() && (log[at + 1] == ':' || log[at + 1] == '(') &&
                           (at == 0 || log[at - 1] == '\n' || log[at - 1] == ' ');
        std::size_t end = at + 2;
        while (start && end < log.size() && log[end] >= '0' && log[end] <= '9' && end < at + 12) ++end;
        if (start && end > at + 2) {
            const unsigned long number =
                std::strtoul(std::string(log.substr(at + 2, end - at - 2)).c_str(), nullptr, 10);
            const std::size_t file = number / 10000;
            out += (file < files.size() ? files[file] : "?") + ':' + std::to_string(number % 10000);
            at = log[at + 1] == '(' && end < log.size() && log[end] == ')' ? end + 1 : end;
        } else {
            out += log[at++];
        }
    }
    while (!out.empty() && (out.back() == '\n' || out.back() == '\0')) out.pop_back();
    return out;
}

ProgramText composeProgram(const ProgramRecipe& recipe) {
    return {recipe.vertex, recipe.fragment, composeShader(recipe.vertex, recipe),
            composeShader(recipe.fragment, recipe)};
}

Program makeProgram(const ProgramRecipe& recipe) {
    return linkProgram(composeProgram(recipe));
}

Program linkProgram(const ProgramText& text) {
    ProgramObject object(glCreateProgram());
    const GLuint vertex = compile(GL_VERTEX_SHADER, text.vertex, text.vertexShader);
    GLuint fragment = 0;
    try {
        fragment = compile(GL_FRAGMENT_SHADER, text.fragment, text.fragmentShader);
    } catch (...) {
        glDeleteShader(vertex);
        throw;
    }
    for (GLuint shader : {vertex, fragment}) {
        glAttachShader(object.name(), shader);
        glDeleteShader(shader);
    }
    glLinkProgram(object.name());
    GLint ok = 0, length = 0;
    glGetProgramiv(object.name(), GL_LINK_STATUS, &ok);
    if (!ok) {
        glGetProgramiv(object.name(), GL_INFO_LOG_LENGTH, &length);
        std::string log(static_cast<std::size_t>(length), '\0');
        glGetProgramInfoLog(object.name(), length, &length, log.data());
        throw Error("does not link: " + log, text.fragment);
    }
    glObjectLabel(GL_PROGRAM, object.name(), -1, text.fragment.c_str());
    return Program(std::move(object));
}

ProgramBinary binaryOf(const Program& program) {
    ProgramBinary out;
    GLint length = 0;
    glGetProgramiv(program.name(), GL_PROGRAM_BINARY_LENGTH, &length);
    out.bytes.resize(std::size_t(std::max(length, 0)));
    if (length > 0) glGetProgramBinary(program.name(), length, &length, &out.format, out.bytes.data());
    return out;
}

Program loadProgram(const ProgramBinary& binary, const ProgramText& text) {
    if (binary.bytes.empty()) return linkProgram(text);
    ProgramObject object(glCreateProgram());
    glProgramBinary(object.name(), binary.format, binary.bytes.data(), GLsizei(binary.bytes.size()));
    GLint ok = 0;
    glGetProgramiv(object.name(), GL_LINK_STATUS, &ok);
    if (!ok) return linkProgram(text);
    glObjectLabel(GL_PROGRAM, object.name(), -1, text.fragment.c_str());
    return Program(std::move(object));
}

GLint Program::location(const char* uniform) const {
    auto found = locations_.find(std::string_view(uniform));
    if (found == locations_.end())
        found = locations_.emplace(uniform, glGetUniformLocation(object_.name(), uniform)).first;
    return found->second;
}

void Program::set(const char* uniform, int value) const {
    glProgramUniform1i(name(), location(uniform), value);
}
void Program::set(const char* uniform, float value) const {
    glProgramUniform1f(name(), location(uniform), value);
}
void Program::set(const char* uniform, glm::ivec3 value) const {
    glProgramUniform3i(name(), location(uniform), value.x, value.y, value.z);
}
void Program::set(const char* uniform, glm::vec2 value) const {
    glProgramUniform2f(name(), location(uniform), value.x, value.y);
}
void Program::set(const char* uniform, glm::vec3 value) const {
    glProgramUniform3f(name(), location(uniform), value.x, value.y, value.z);
}
void Program::set(const char* uniform, glm::vec4 value) const {
    glProgramUniform4f(name(), location(uniform), value.x, value.y, value.z, value.w);
}
void Program::set(const char* uniform, const glm::mat3& value) const {
    glProgramUniformMatrix3fv(name(), location(uniform), 1, GL_FALSE, &value[0].x);
}
void Program::set(const char* uniform, std::span<const int> values) const {
    if (!values.empty()) glProgramUniform1iv(name(), location(uniform), GLsizei(values.size()), values.data());
}
void Program::set(const char* uniform, std::span<const float> values) const {
    if (!values.empty()) glProgramUniform1fv(name(), location(uniform), GLsizei(values.size()), values.data());
}
void Program::set(const char* uniform, std::span<const glm::ivec4> values) const {
    if (!values.empty()) glProgramUniform4iv(name(), location(uniform), GLsizei(values.size()), &values[0].x);
}
void Program::set(const char* uniform, std::span<const glm::vec2> values) const {
    if (values.empty()) return;
    glProgramUniform2fv(name(), location(uniform), GLsizei(values.size()), &values[0].x);
}
void Program::set(const char* uniform, std::span<const glm::vec3> values) const {
    if (!values.empty()) glProgramUniform3fv(name(), location(uniform), GLsizei(values.size()), &values[0].x);
}
void Program::set(const char* uniform, std::span<const glm::vec4> values) const {
    if (!values.empty()) glProgramUniform4fv(name(), location(uniform), GLsizei(values.size()), &values[0].x);
}

} // namespace tessera::vis
