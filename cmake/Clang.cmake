# A toolchain of the newest clang that is installed. It is to be 16 or later: 14 cannot compile <ranges> of gcc 12.
foreach(version RANGE 30 16 -1)
  list(APPEND clang_c clang-${version})
  list(APPEND clang_cxx clang++-${version})
endforeach()
find_program(TESSERA_CLANG_C NAMES ${clang_c} REQUIRED)
find_program(TESSERA_CLANG_CXX NAMES ${clang_cxx} REQUIRED)
set(CMAKE_C_COMPILER "${TESSERA_CLANG_C}")
set(CMAKE_CXX_COMPILER "${TESSERA_CLANG_CXX}")
