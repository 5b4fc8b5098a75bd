# Read by ctest: each suite of a test program is one test, as a process for each single test takes twice the time (each
# makes a GL context and compiles the same shaders). Single tests: PROGRAM --gtest_filter=Suite.Test
# Takes: program (its file), name, labels.
if(NOT EXISTS ${program})
  add_test(${name}.is_not_built ${program})
  return()
endif()
execute_process(COMMAND ${program} --gtest_list_tests OUTPUT_VARIABLE listed RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "${program} lists no tests (${status})")
endif()
string(REGEX MATCHALL "(^|\n)[^ \n]+[.]" suites "${listed}")
foreach(suite IN LISTS suites)
  string(REGEX REPLACE "[.\n]" "" suite ${suite})
  string(REPLACE / _ entry ${suite})
  add_test(${name}.${entry} ${program} --gtest_filter=${suite}.*)
  set_tests_properties(${name}.${entry} PROPERTIES LABELS "${labels}" TIMEOUT 600 SKIP_RETURN_CODE 77 ENVIRONMENT TESSERA_SKIPPED=77)
endforeach()
