set(text "// Generated from vis/shaders.\n#include \"vis/gl/shader_files.h\"\n\nnamespace tessera::vis {\n\nnamespace {\n")
string(APPEND text "const ShaderFile kFiles[] = {\n")
foreach(file IN LISTS FILES)
  file(READ ${FOLDER}/${file} body)
  # String literals are limited to 64 KiB by pedantic compilers' advice; shader files are far below.
  string(APPEND text "    {\"${file}\", R\"__glsl(${body})__glsl\"},\n")
endforeach()
string(APPEND text "    {{}, {}}};\n} // namespace\n\nstd::span<const ShaderFile> embeddedShaders() { return {kFiles, std::size(kFiles) - 1}; }\n\n} // namespace tessera::vis\n")
file(WRITE ${OUTPUT} "${text}")
