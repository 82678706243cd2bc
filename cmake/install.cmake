# Installs the C++ libraries with a CMake package, so that find_package(codesign) works for a C++ consumer.
# A Python wheel takes only the component "python".
include(CMakePackageConfigHelpers)
install(TARGETS codesign_dynamics codesign_fem EXPORT codesignTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        COMPONENT cpp)
install(DIRECTORY cpp/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/codesign COMPONENT cpp
        FILES_MATCHING PATTERN "*.hpp" PATTERN "bindings" EXCLUDE)
install(EXPORT codesignTargets NAMESPACE codesign:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/codesign COMPONENT cpp)
configure_package_config_file(cmake/codesignConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/codesignConfig.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/codesign)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/codesignConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/codesignConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/codesignConfigVersion.cmake
              cmake/FindCHOLMOD.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/codesign COMPONENT cpp)
install(FILES package.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/codesign COMPONENT cpp)
