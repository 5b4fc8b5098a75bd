# The C library `tessera_writer` for solvers (codec/c), with a pkg-config file that works wherever it is moved to.
include(GNUInstallDirs)
add_library(tessera_writer SHARED codec/c/tessera_writer.cpp)
target_link_libraries(tessera_writer PRIVATE codec)
target_include_directories(tessera_writer INTERFACE ${CMAKE_SOURCE_DIR}/codec/c)
# Programs see the functions of its header only.
target_link_options(tessera_writer PRIVATE LINKER:--exclude-libs,ALL LINKER:--as-needed)
set_target_properties(tessera_writer PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION 0 UNITY_BUILD OFF
                      CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)

cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX BASE_DIRECTORY ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig
           OUTPUT_VARIABLE TESSERA_PREFIX_FROM_PC)
configure_file(codec/c/tessera_writer.pc.in ${CMAKE_BINARY_DIR}/tessera_writer.pc @ONLY)
install(TARGETS tessera_writer LIBRARY)
install(FILES codec/c/tessera_writer.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES ${CMAKE_BINARY_DIR}/tessera_writer.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
