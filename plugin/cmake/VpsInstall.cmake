# SPDX-License-Identifier: BSD-3-Clause
# The installed package: for each component its library, headers, exported targets and pkg-config file, and one
# vpsConfig.cmake that looks for the packages of the requested components only.

# The install rules of one component; arguments as for vps_add_library().
#   TARGETS         targets that belong to it besides vps_NAME: its wings
#   HEADER_FOLDERS  where its headers are; by default include
function(vps_install_library name public)
  cmake_parse_arguments(ARG "PC_FILE" "" "TARGETS;HEADER_FOLDERS;SOURCES;PUBLIC;PRIVATE;PRECOMPILE;PACKAGES;PRIVATE_PACKAGES;HEADERS;EXCLUDE_HEADERS;\
PC_REQUIRES;PC_PRIVATE_REQUIRES;PC_CFLAGS;PC_PRIVATE_LIBS" ${ARGN})
  install(TARGETS vps_${name} ${ARG_TARGETS} EXPORT vps_${name}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${name}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${name}
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${name})
  install(EXPORT vps_${name} NAMESPACE vps:: FILE vps-${name}-targets.cmake
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vps${VPS_PACKAGE_SUFFIX} COMPONENT ${name})
  if(ARG_HEADERS)
    foreach(header IN LISTS ARG_HEADERS)
      get_filename_component(folder ${header} DIRECTORY)
      install(FILES ${PROJECT_SOURCE_DIR}/plugin/include/${header}
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/${folder} COMPONENT ${name})
    endforeach()
  else()
    set(exclude "")
    foreach(header IN LISTS ARG_EXCLUDE_HEADERS)
      list(APPEND exclude PATTERN ${header} EXCLUDE)
    endforeach()
    if(NOT ARG_HEADER_FOLDERS)
      set(ARG_HEADER_FOLDERS include)
    endif()
    foreach(folder IN LISTS ARG_HEADER_FOLDERS)
      install(DIRECTORY ${folder}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT ${name} ${exclude})
    endforeach()
  endif()

  set(requires "")
  foreach(target IN LISTS public)
    if(target MATCHES "^vps::(.+)$")
      list(APPEND requires ${CMAKE_MATCH_1})
    endif()
  endforeach()
  set(packages ${ARG_PACKAGES})
  if(NOT BUILD_SHARED_LIBS)
    list(APPEND packages ${ARG_PRIVATE_PACKAGES})
  endif()
  set_property(GLOBAL APPEND PROPERTY VPS_INSTALLED_COMPONENTS ${name})
  set_property(GLOBAL APPEND_STRING PROPERTY VPS_COMPONENT_TABLE
    "set(_vps_${name}_requires \"${requires}\")\nset(_vps_${name}_packages \"${packages}\")\n")
  if(ARG_PC_FILE)
    vps_write_pkg_config(${name} "${requires}" "${ARG_PC_REQUIRES}" "${ARG_PC_CFLAGS}"
      "${ARG_PC_PRIVATE_REQUIRES}" "${ARG_PC_PRIVATE_LIBS}")
  endif()
endfunction()

# vps-NAME.pc, or vps-NAME-float32.pc. For static libraries it lists the private dependencies as well, so that users do not need --static.
function(vps_write_pkg_config name requires modules cflags private_modules private_libs)
  list(TRANSFORM requires PREPEND "vps-")
  list(TRANSFORM requires APPEND "${VPS_PACKAGE_SUFFIX} = ${PROJECT_VERSION}")
  list(APPEND requires ${modules})
  set(libs -lvps_${name}${VPS_PACKAGE_SUFFIX})
  if(BUILD_SHARED_LIBS)
    set(private_modules "")
    set(private_libs "")
  else()
    string(TOUPPER ${name} upper)
    list(APPEND cflags -DVPS_${upper}_STATIC_DEFINE)
  endif()
  list(APPEND requires ${private_modules})
  list(APPEND libs ${private_libs})
  list(JOIN requires ", " PC_REQUIRES)
  list(JOIN cflags " " PC_CFLAGS)
  list(JOIN libs " " PC_LIBS)
  set(PC_NAME ${name}${VPS_PACKAGE_SUFFIX})
  file(RELATIVE_PATH PC_PREFIX /root/${CMAKE_INSTALL_LIBDIR}/pkgconfig /root)
  configure_file(${PROJECT_SOURCE_DIR}/plugin/cmake/vps-component.pc.in ${PROJECT_BINARY_DIR}/vps-${PC_NAME}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/vps-${PC_NAME}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT ${name})
endfunction()

# Called once, after all components are known.
function(vps_install_package)
  include(CMakePackageConfigHelpers)
  get_property(VPS_INSTALLED_COMPONENTS GLOBAL PROPERTY VPS_INSTALLED_COMPONENTS)
  get_property(VPS_COMPONENT_TABLE GLOBAL PROPERTY VPS_COMPONENT_TABLE)
  set(destination ${CMAKE_INSTALL_LIBDIR}/cmake/vps${VPS_PACKAGE_SUFFIX})
  set(folder ${PROJECT_SOURCE_DIR}/plugin/cmake)
  configure_package_config_file(${folder}/vpsConfig.cmake.in ${PROJECT_BINARY_DIR}/vpsConfig.cmake
    INSTALL_DESTINATION ${destination})
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/vpsBasicVersion.cmake COMPATIBILITY SameMinorVersion)
  configure_file(${folder}/vpsConfigVersion.cmake.in ${PROJECT_BINARY_DIR}/vpsConfigVersion.cmake @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/vpsConfig.cmake ${PROJECT_BINARY_DIR}/vpsConfigVersion.cmake
    ${PROJECT_BINARY_DIR}/vpsBasicVersion.cmake
    ${folder}/FindVpsBullet.cmake ${folder}/FindVpsEpoxy.cmake ${folder}/FindVpsOpenVDB.cmake
    DESTINATION ${destination} COMPONENT plugin)
endfunction()
