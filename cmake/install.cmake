# What is installed beside the program, and the packages that cpack makes of it: `program` (polar, weights, manual
# pages, completions, configurations, documents) and `development` (headers, libraries, a configuration for
# find_package).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/configs DESTINATION ${CMAKE_INSTALL_DATADIR}/polar-smlm COMPONENT program)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/datasets/samples DESTINATION ${CMAKE_INSTALL_DATADIR}/polar-smlm/datasets
        COMPONENT program)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program
        PATTERN decisions EXCLUDE)
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR}
        COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT program)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/polar ${PROJECT_SOURCE_DIR}/smlm/include/smlm
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
install(TARGETS smlm polar_options polar_core polar_flames polar_model polar_latent polar_fusion polar_registration
                polar_simulation polar_results polar_fitting polar_report polar_pipeline
        EXPORT polar-smlm-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/polar-smlm)
install(EXPORT polar-smlm-targets NAMESPACE polar:: DESTINATION ${package_folder} COMPONENT development)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/polar-smlm-config.cmake.in
  ${PROJECT_BINARY_DIR}/polar-smlm-config.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/polar-smlm-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/polar-smlm-config.cmake ${PROJECT_BINARY_DIR}/polar-smlm-config-version.cmake
        DESTINATION ${package_folder} COMPONENT development)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME polar-smlm)
set(CPACK_PACKAGE_CONTACT "the authors of polar-smlm <polar-smlm@localhost>")
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME polar-smlm)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
  "Aligns many noisy, partial copies of one structure in localisation tables, without a desktop.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libpolar-smlm-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libeigen3-dev, libhdf5-dev, libceres-dev, libtbb-dev, libyaml-cpp-dev, \
libpng-dev, libtiff-dev, libmatio-dev, libzip-dev, libssl-dev, zlib1g-dev, pkg-config")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
  "Headers and static libraries, for programs that read localisation tables or register particles themselves.")
include(CPack)
