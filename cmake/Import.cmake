# tessera-import, the only program that links VTK. Without VTK the build goes on and says what is lost.
find_package(VTK 9.1 QUIET COMPONENTS CommonCore CommonDataModel CommonExecutionModel FiltersCore IOCGNSReader
             IOEnSight IOExodus IOGeometry IOHDF IOImage IOLegacy IONetCDF IOParallel IOXML hdf5)
if(VTK_FOUND)
  file(GLOB import_sources CONFIGURE_DEPENDS app/import/*.cpp)
  add_executable(tessera-import ${import_sources})
  find_package(ZLIB REQUIRED)
  find_package(TIFF REQUIRED)
  target_link_libraries(tessera-import PRIVATE volume nlohmann_json::nlohmann_json ${VTK_LIBRARIES} TIFF::TIFF
                        ZLIB::ZLIB)
  target_include_directories(tessera-import SYSTEM PRIVATE ${VTK_INCLUDE_DIRS})
  vtk_module_autoinit(TARGETS tessera-import MODULES ${VTK_LIBRARIES})
else()
  message(STATUS "VTK not found: tessera reads raw files and archives only, "
                 "not those of other programs (install libvtk9-dev)")
endif()
