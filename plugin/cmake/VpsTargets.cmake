# SPDX-License-Identifier: BSD-3-Clause
# What every target of ours has in common, and how the package is installed. Kept in one place so that a
# folder's CMakeLists.txt says only what is its own.

# A library: alias vps::<name>, header folder, warnings, install rule.
function(vps_add_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(vps_${name} STATIC ${ARG_SOURCES})
  add_library(vps::${name} ALIAS vps_${name})
  set_target_properties(vps_${name} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(vps_${name} PUBLIC cxx_std_20)
  target_include_directories(vps_${name} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(vps_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  vps_compile_options(vps_${name})
  install(TARGETS vps_${name} EXPORT vpsTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  set_property(GLOBAL APPEND PROPERTY VPS_INSTALLED_COMPONENTS ${name})
endfunction()

function(vps_compile_options target)
  if(PROJECT_IS_TOP_LEVEL)
    # -Wrestrict: GCC 12 sees overlaps in "text" + std::string that are not there (its bug 105651).
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wno-unused-parameter
      $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> $<$<BOOL:${VPS_WERROR}>:-Werror>)
  endif()
  # Fused multiply-adds differ from machine to machine; without them the same input gives the same bits.
  target_compile_options(${target} PRIVATE -ffp-contract=off)
  if(VPS_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${VPS_SANITIZE} -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${VPS_SANITIZE})
  endif()
  # Our own mistakes are loud in Debug and in sanitized builds (see vps/assert.h).
  if(VPS_SANITIZE)
    target_compile_definitions(${target} PRIVATE VPS_ASSERT_ON)
  else()
    target_compile_definitions(${target} PRIVATE $<$<CONFIG:Debug>:VPS_ASSERT_ON>)
  endif()
endfunction()

# A GoogleTest program, one per tested folder or topic.
function(vps_add_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LINK} GTest::gtest_main)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(${name} PRIVATE VPS_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  vps_compile_options(${name})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 600)
  endif()
  include(GoogleTest)
  gtest_discover_tests(${name} PROPERTIES TIMEOUT ${ARG_TIMEOUT} DISCOVERY_TIMEOUT 60)
endfunction()

function(vps_install_package)
  include(CMakePackageConfigHelpers)
  get_property(VPS_INSTALLED_COMPONENTS GLOBAL PROPERTY VPS_INSTALLED_COMPONENTS)
  set(destination ${CMAKE_INSTALL_LIBDIR}/cmake/vps)
  install(EXPORT vpsTargets NAMESPACE vps:: DESTINATION ${destination})
  configure_package_config_file(${PROJECT_SOURCE_DIR}/plugin/cmake/vpsConfig.cmake.in
    ${PROJECT_BINARY_DIR}/vpsConfig.cmake INSTALL_DESTINATION ${destination})
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/vpsConfigVersion.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${PROJECT_BINARY_DIR}/vpsConfig.cmake ${PROJECT_BINARY_DIR}/vpsConfigVersion.cmake
    ${PROJECT_SOURCE_DIR}/plugin/cmake/VpsFindOpenVDB.cmake ${PROJECT_SOURCE_DIR}/plugin/cmake/VpsFindBullet.cmake
    DESTINATION ${destination})
endfunction()
