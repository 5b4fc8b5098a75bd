# tessera-import, the only program that links VTK and GDCM. Without VTK the build goes on and says what is lost.
find_package(VTK 9.1 QUIET COMPONENTS CommonCore CommonDataModel CommonExecutionModel FiltersCore IOCGNSReader
             IOEnSight IOExodus IOGeometry IOImage IOLegacy IOParallel IOXML hdf5 netcdf)
if(VTK_FOUND)
  file(GLOB_RECURSE import_sources CONFIGURE_DEPENDS app/importer/*.cpp)
  list(REMOVE_ITEM import_sources ${CMAKE_SOURCE_DIR}/app/importer/main.cpp)
  find_package(TIFF REQUIRED)
  find_package(JPEG REQUIRED)
  find_package(pugixml REQUIRED)
  find_package(BZip2 REQUIRED)
  pkg_check_modules(blosc REQUIRED IMPORTED_TARGET blosc) # chunks of Zarr
  pkg_check_modules(lz4 REQUIRED IMPORTED_TARGET liblz4)
  # Not find_package(GDCM): where GDCM's programs are not installed, its package complains about each of them.
  find_path(GDCM_INCLUDE_DIR gdcmImage.h PATH_SUFFIXES gdcm-3.2 gdcm-3.0 REQUIRED)
  foreach(part MSFF DSED Common)
    find_library(GDCM_${part}_LIBRARY gdcm${part} REQUIRED)
    list(APPEND gdcm_libraries ${GDCM_${part}_LIBRARY})
  endforeach()
  # The readers, which tests and fuzz targets link too.
  add_library(importer STATIC ${import_sources})
  target_link_libraries(importer PUBLIC volume nlohmann_json::nlohmann_json ${VTK_LIBRARIES} TIFF::TIFF PNG::PNG JPEG::JPEG ZLIB::ZLIB
                        pugixml::pugixml BZip2::BZip2 PkgConfig::blosc PkgConfig::lz4 PkgConfig::zstd PkgConfig::lzma ${gdcm_libraries})
  tessera_little_optimised(importer 1)
  tessera_precompile(importer)
  target_include_directories(importer SYSTEM PUBLIC ${VTK_INCLUDE_DIRS} ${GDCM_INCLUDE_DIR})
  add_executable(tessera-import app/importer/main.cpp)
  target_link_libraries(tessera-import PRIVATE importer)
  vtk_module_autoinit(TARGETS importer tessera-import MODULES ${VTK_LIBRARIES})
else()
  message(STATUS "VTK not found: tessera reads raw files and archives only, "
                 "not those of other programs (install libvtk9-dev)")
endif()
