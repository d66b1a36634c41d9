# cmake --install: the program with its scenes and assets, and the libraries with their headers for
# find_package(dbd). cpack -G DEB: the same as a Debian package.
include(CMakePackageConfigHelpers)

set(dbd_data ${CMAKE_INSTALL_DATADIR}/dbd)
set(dbd_cmake ${CMAKE_INSTALL_LIBDIR}/cmake/dbd)

install(TARGETS dbd RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
foreach(folder library figures studies words)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/scenes/${folder} DESTINATION ${dbd_data}/scenes COMPONENT program
          PATTERN "*.h" EXCLUDE PATTERN "*.cpp" EXCLUDE PATTERN "CMakeLists.txt" EXCLUDE)
endforeach()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/assets DESTINATION ${dbd_data} COMPONENT program
        PATTERN "pictures" EXCLUDE)
# What the studies hold their numbers against.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/tests/reference DESTINATION ${dbd_data}/tests COMPONENT program)

foreach(name physics render scenes)
  set_target_properties(dbd_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(dbd_${name} INTERFACE
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/dbd>)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${name} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/dbd
          COMPONENT library FILES_MATCHING PATTERN "*.h"
          PATTERN "library" EXCLUDE PATTERN "figures" EXCLUDE PATTERN "studies" EXCLUDE PATTERN "words" EXCLUDE
          PATTERN "precompiled.h" EXCLUDE)
endforeach()
install(TARGETS dbd_physics dbd_render dbd_scenes dbd_flags EXPORT dbdTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library)
install(EXPORT dbdTargets NAMESPACE dbd:: DESTINATION ${dbd_cmake} COMPONENT library)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/dbdConfig.cmake.in
  ${PROJECT_BINARY_DIR}/dbdConfig.cmake INSTALL_DESTINATION ${dbd_cmake} PATH_VARS dbd_data)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/dbdConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/dbdConfig.cmake ${PROJECT_BINARY_DIR}/dbdConfigVersion.cmake
        DESTINATION ${dbd_cmake} COMPONENT library)

# Debian: the packages that it needs are found from the program itself.
set(CPACK_PACKAGE_NAME dbd)
set(CPACK_PACKAGE_CONTACT "dbd <dbd@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Displacement based dynamics: scenes in, measured motion and pictures out")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "ffmpeg, gnuplot-nox")
include(CPack)
