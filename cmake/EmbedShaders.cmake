# Makes shader files part of the program: tessera_embed_shaders(<target> <folder>) compiles every *.glsl below the folder
# into a table of (path, text) that vis/gl/shader_files.h declares.
function(tessera_embed_shaders target folder)
  file(GLOB_RECURSE files CONFIGURE_DEPENDS RELATIVE ${folder} ${folder}/*.glsl)
  set(output ${CMAKE_BINARY_DIR}/generated/shader_files.cpp)
  set(absolute)
  foreach(file IN LISTS files)
    list(APPEND absolute ${folder}/${file})
  endforeach()
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} "-DFOLDER=${folder}" "-DFILES=${files}" "-DOUTPUT=${output}"
            -P ${CMAKE_SOURCE_DIR}/cmake/EmbedShadersRun.cmake
    DEPENDS ${absolute} ${CMAKE_SOURCE_DIR}/cmake/EmbedShadersRun.cmake
    VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()
