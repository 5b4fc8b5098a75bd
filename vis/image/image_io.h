#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace tessera::vis {

/// 8-bit RGBA, sRGB, rows top down.
struct Image {
    glm::ivec2 size{0};
    std::vector<std::uint8_t> rgba;
    double dpi = 0; ///< pixels per inch on paper, in a PNG whole pixels per metre; 0: not stated
};

/// Key of the text chunk that carries a session in an exported PNG.
inline constexpr const char* kSessionTextKey = "tessera-session";

/// Encodes a PNG with compressed international text chunks (iTXt, UTF-8). Throws Error naming `name`.
std::vector<std::uint8_t> encodePng(const Image& image, const std::map<std::string, std::string>& texts = {},
                                    const std::string& name = {});

/// Writes a PNG with compressed international text chunks (iTXt, UTF-8), atomically: a temporary file, then rename.
/// Throws Error when the file cannot be written.
void writePng(const std::string& path, const Image& image, const std::map<std::string, std::string>& texts = {});

/// Decodes any PNG as RGBA, and its text chunks. Throws Error naming `name` when the data is no PNG or damaged.
Image decodePng(std::span<const std::uint8_t> bytes, const std::string& name,
                std::map<std::string, std::string>* texts = nullptr);

/// Reads a file. Throws Error when it cannot be opened.
std::vector<std::uint8_t> readBytes(const std::string& path);

/// Reads any PNG as RGBA, and its text chunks. Throws Error when the file is no PNG or damaged.
Image readPng(const std::string& path, std::map<std::string, std::string>* texts = nullptr);

} // namespace tessera::vis
