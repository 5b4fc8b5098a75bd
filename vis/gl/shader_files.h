#pragma once

#include <span>
#include <string_view>

namespace tessera::vis {

/// A file of vis/shaders, embedded at build time; `path` is relative to that folder.
struct ShaderFile {
    std::string_view path, text;
};

/// Every shader file, in no particular order.
std::span<const ShaderFile> embeddedShaders();

} // namespace tessera::vis
