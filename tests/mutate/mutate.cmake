# Included after project() of a copy of the sources with faults (CMAKE_PROJECT_tessera_INCLUDE): adds the switch to the
# room that all others link, the notes of what is reached to the tests, and takes warnings from what has faults.
set(TESSERA_MUTATE_FOLDER ${CMAKE_CURRENT_LIST_DIR})
function(tessera_mutate_targets)
  set_source_files_properties(${TESSERA_MUTATE_FOLDER}/switch.cpp ${TESSERA_MUTATE_FOLDER}/cover.cpp
    TARGET_DIRECTORY volume volume_tests PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON COMPILE_OPTIONS -w)
  target_sources(volume PRIVATE ${TESSERA_MUTATE_FOLDER}/switch.cpp)
  # A library without a file that anyone asks for would leave the switch out of a program that has no faults.
  foreach(target volume_tests codec_tests vis_tests packet_tests vis_gl_tests app_tests app_gl_tests import_tests)
    if(TARGET ${target})
      target_sources(${target} PRIVATE ${TESSERA_MUTATE_FOLDER}/cover.cpp)
    endif()
  endforeach()
  foreach(target ${TESSERA_MUTATE_TARGETS})
    if(TARGET ${target})
      target_compile_options(${target} PRIVATE -w -Wno-narrowing)
    endif()
  endforeach()
endfunction()
cmake_language(DEFER DIRECTORY ${CMAKE_SOURCE_DIR} CALL tessera_mutate_targets)
