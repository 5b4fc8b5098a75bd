# tessera-import, the only program that links VTK. Without VTK the build goes on and says what is lost.
find_package(VTK 9.0 QUIET COMPONENTS CommonCore CommonDataModel CommonExecutionModel FiltersCore IOEnSight IOGeometry
             IOImage IOLegacy IONetCDF IOXML)
if(VTK_FOUND)
  file(GLOB import_sources CONFIGURE_DEPENDS app/import/*.cpp)
  add_executable(tessera-import ${import_sources})
  target_link_libraries(tessera-import PRIVATE volume nlohmann_json::nlohmann_json ${VTK_LIBRARIES})
  target_include_directories(tessera-import SYSTEM PRIVATE ${VTK_INCLUDE_DIRS})
  vtk_module_autoinit(TARGETS tessera-import MODULES ${VTK_LIBRARIES})
else()
  message(STATUS "VTK not found: tessera reads raw files and archives only, "
                 "not .vti .vtk .vtu .nrrd .mha .nii .foam .case .nc (install libvtk9-dev)")
endif()
