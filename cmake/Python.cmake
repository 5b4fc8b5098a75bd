# The Python package `tessera`, where pybind11 and the headers of the distribution's Python are installed. In the build
# folder it lies in python/.
if(EXISTS /usr/bin/python3 AND NOT DEFINED Python_EXECUTABLE)
  set(Python_EXECUTABLE /usr/bin/python3) # whose NumPy comes from the same packages as pybind11
endif()
find_package(Python COMPONENTS Interpreter Development.Module QUIET)
if(Python_FOUND)
  find_package(pybind11 QUIET)
endif()
if(NOT pybind11_FOUND)
  message(STATUS "pybind11 or the headers of Python not found: no Python module")
  return()
endif()

pybind11_add_module(tessera_python NO_EXTRAS codec/python/module.cpp)
set_target_properties(tessera_python PROPERTIES OUTPUT_NAME _tessera UNITY_BUILD OFF
                      LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/python/tessera)
tessera_little_optimised(tessera_python 1)
target_link_libraries(tessera_python PRIVATE codec nlohmann_json::nlohmann_json)
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/python/tessera)
file(GLOB python_files CONFIGURE_DEPENDS codec/python/tessera/*.py)
foreach(file IN LISTS python_files)
  get_filename_component(name ${file} NAME)
  file(CREATE_LINK ${file} ${CMAKE_BINARY_DIR}/python/tessera/${name} SYMBOLIC)
endforeach()

# What tells xarray of the engine "tessera".
set(metadata ${CMAKE_BINARY_DIR}/python/tessera-${PROJECT_VERSION}.dist-info)
file(WRITE ${metadata}/METADATA "Metadata-Version: 2.1\nName: tessera\nVersion: ${PROJECT_VERSION}\n")
file(WRITE ${metadata}/entry_points.txt "[xarray.backends]\ntessera = tessera.xarray_backend:TesseraBackend\n")

set(python_folder lib/python3/dist-packages) # of Debian, for every Python 3
install(TARGETS tessera_python LIBRARY DESTINATION ${python_folder}/tessera)
install(FILES ${python_files} DESTINATION ${python_folder}/tessera)
install(DIRECTORY ${metadata} DESTINATION ${python_folder})
