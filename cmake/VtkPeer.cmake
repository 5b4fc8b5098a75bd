# tessera-vtk-peer, the ray casters that `tessera bench render` is measured against. Only with VTK's volume rendering.
find_package(VTK QUIET COMPONENTS CommonCore CommonDataModel RenderingCore RenderingOpenGL2 RenderingVolume
             RenderingVolumeOpenGL2)
if(VTK_FOUND)
  add_executable(tessera-vtk-peer tests/bench/vtk_peer.cpp)
  target_link_libraries(tessera-vtk-peer PRIVATE VTK::CommonCore VTK::CommonDataModel VTK::RenderingCore
                        VTK::RenderingOpenGL2 VTK::RenderingVolume VTK::RenderingVolumeOpenGL2)
  vtk_module_autoinit(TARGETS tessera-vtk-peer MODULES VTK::RenderingCore VTK::RenderingOpenGL2 VTK::RenderingVolume
                      VTK::RenderingVolumeOpenGL2)
else()
  message(STATUS "VTK's volume rendering was not found: tessera bench render runs without its peer")
endif()
