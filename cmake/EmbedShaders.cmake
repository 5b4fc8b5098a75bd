# Makes shader files part of the program: tessera_embed_shaders(<target> <folder> <formulas>) compiles every *.glsl below
# the folder into a table of (path, text) that vis/gl/shader_files.h declares. Headers of <formulas>, which are C++, become
# files formulas/NAME.glsl of it: ShaderFormulas.cmake says how.
function(tessera_embed_shaders target folder formulas)
  file(GLOB_RECURSE files CONFIGURE_DEPENDS RELATIVE ${folder} ${folder}/*.glsl)
  file(GLOB headers CONFIGURE_DEPENDS RELATIVE ${formulas} ${formulas}/*.h)
  set(output ${CMAKE_BINARY_DIR}/generated/shader_files.cpp)
  set(absolute)
  foreach(file IN LISTS files)
    list(APPEND absolute ${folder}/${file})
  endforeach()
  foreach(file IN LISTS headers)
    list(APPEND absolute ${formulas}/${file})
  endforeach()
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} "-DFOLDER=${folder}" "-DFILES=${files}" "-DFORMULAS=${formulas}" "-DHEADERS=${headers}"
            "-DOUTPUT=${output}" -P ${CMAKE_SOURCE_DIR}/cmake/EmbedShadersRun.cmake
    DEPENDS ${absolute} ${CMAKE_SOURCE_DIR}/cmake/EmbedShadersRun.cmake ${CMAKE_SOURCE_DIR}/cmake/ShaderFormulas.cmake
    VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()
