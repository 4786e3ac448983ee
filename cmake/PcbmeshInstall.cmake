# SPDX-License-Identifier: GPL-3.0-or-later
include(CMakePackageConfigHelpers)

install(TARGETS pcbmesh EXPORT pcbmeshTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
        FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(TARGETS pcbmesh_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(EXPORT pcbmeshTargets NAMESPACE pcbmesh:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/pcbmesh)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/pcbmeshConfig.cmake.in ${PROJECT_BINARY_DIR}/pcbmeshConfig.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/pcbmesh)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/pcbmeshConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/pcbmeshConfig.cmake ${PROJECT_BINARY_DIR}/pcbmeshConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/pcbmesh)
