# SPDX-License-Identifier: BSD-3-Clause
# Settings that all targets of the project share. A folder's CMakeLists.txt contains only its own.
# VpsInstall.cmake makes the installed package.

# vps_add_library(NAME SOURCES ... [PUBLIC target...] [PRIVATE target...] [PRECOMPILE header...]
#                 [PACKAGES name...] [PRIVATE_PACKAGES name...] [HEADERS file... | EXCLUDE_HEADERS file...]
#                 [PC_FILE [PC_REQUIRES module...] [PC_CFLAGS flag...]
#                  [PC_PRIVATE_REQUIRES module...] [PC_PRIVATE_LIBS flag...]])
# A library with alias vps::NAME, warnings, visibility, precompiled headers and install rules.
#   PUBLIC, PRIVATE    what it links; a vps:: target in PUBLIC is a component that this one requires
#   PRECOMPILE         slow headers of its own to precompile beside the usual ones
#   PACKAGES           what find_package(vps COMPONENTS NAME) looks for
#   PRIVATE_PACKAGES   the same, but only where the library is static and its users must link them
#   HEADERS            its public headers, below plugin/include; by default all of its folder's include/
#   PC_FILE            installs vps-NAME.pc, with modules and flags beside those of the components it requires; the
#                      private ones only where the library is static
function(vps_add_library name)
  cmake_parse_arguments(ARG "PC_FILE" "" "SOURCES;PUBLIC;PRIVATE;PRECOMPILE;PACKAGES;PRIVATE_PACKAGES;HEADERS;EXCLUDE_HEADERS;\
PC_REQUIRES;PC_PRIVATE_REQUIRES;PC_CFLAGS;PC_PRIVATE_LIBS" ${ARGN})
  add_library(vps_${name} ${ARG_SOURCES})  # shared with BUILD_SHARED_LIBS
  add_library(vps::${name} ALIAS vps_${name})
  set_target_properties(vps_${name} PROPERTIES
    EXPORT_NAME ${name} OUTPUT_NAME vps_${name}${VPS_PACKAGE_SUFFIX} VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  target_compile_features(vps_${name} PUBLIC cxx_std_20)
  target_include_directories(vps_${name} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(vps_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  vps_export_header(${name})
  vps_compile_options(vps_${name})
  vps_precompile(vps_${name} ${ARG_PRECOMPILE})
  vps_unite_folders(vps_${name} "${ARG_SOURCES}")
  vps_install_library(${name} "${ARG_PUBLIC}" ${ARGN})
endfunction()

# vps_add_wing(LIBRARY NAME [WINGS name...] [PUBLIC target...] [PRIVATE target...] [SOURCES file...] [ONLY])
# A wing of a library: a folder with sources and headers of its own, built and linked alone as vps::LIBRARY_NAME.
# vps_join_wings() makes the library from them.
#   WINGS            the wings that it includes; it sees their public and private headers, and those that they include
#   SOURCES          besides all sources in src/*/; a folder there that has a CMakeLists.txt lists its own
#   ONLY             the wing consists of SOURCES; src/*/ is left out
function(vps_add_wing library name)
  cmake_parse_arguments(ARG "ONLY" "" "WINGS;PUBLIC;PRIVATE;SOURCES" ${ARGN})
  set(target vps_${library}_${name})
  file(GLOB sources CONFIGURE_DEPENDS src/*/*.cpp)
  file(GLOB own_lists CONFIGURE_DEPENDS src/*/CMakeLists.txt)
  if(ARG_ONLY)
    set(sources "")
    set(own_lists "")
  endif()
  foreach(list IN LISTS own_lists)
    get_filename_component(folder ${list} DIRECTORY)
    list(FILTER sources EXCLUDE REGEX "^${folder}/")
  endforeach()
  add_library(${target} STATIC ${sources} ${ARG_SOURCES})
  add_library(vps::${library}_${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES
    EXPORT_NAME ${library}_${name} OUTPUT_NAME ${target}${VPS_PACKAGE_SUFFIX})
  target_compile_features(${target} PUBLIC cxx_std_20)

  set(private ${CMAKE_CURRENT_SOURCE_DIR}/src)  # of itself and of all wings below
  set(below "")
  foreach(wing IN LISTS ARG_WINGS)
    get_target_property(folders vps_${library}_${wing} VPS_PRIVATE_HEADERS)
    list(APPEND private ${folders})
    list(APPEND below vps::${library}_${wing})
  endforeach()
  list(REMOVE_DUPLICATES private)
  set_target_properties(${target} PROPERTIES VPS_PRIVATE_HEADERS "${private}")
  target_include_directories(${target} PRIVATE ${private} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${target} PUBLIC ${below} ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  string(TOUPPER VPS_${library}_STATIC_DEFINE static)
  if(NOT BUILD_SHARED_LIBS)
    target_compile_definitions(${target} PUBLIC ${static})
  elseif(WIN32)
    target_compile_definitions(${target} PRIVATE vps_${library}_EXPORTS)
  endif()
  vps_compile_options(${target})
  vps_precompile(${target})
  vps_unite_folders(${target} "${sources}")
  set_property(GLOBAL APPEND PROPERTY VPS_WINGS_OF_${library} ${name})
  foreach(list IN LISTS own_lists)
    get_filename_component(folder ${list} DIRECTORY)
    add_subdirectory(${folder})
  endforeach()
endfunction()

# vps_join_wings(NAME [PUBLIC target...] [PACKAGES ...] [PRIVATE_PACKAGES ...]): the library vps::NAME of all wings that
# were added, with its install rules; PUBLIC are the components that it requires. Static, it only names them.
function(vps_join_wings name)
  cmake_parse_arguments(ARG "" "" "PUBLIC;PACKAGES;PRIVATE_PACKAGES" ${ARGN})
  get_property(wings GLOBAL PROPERTY VPS_WINGS_OF_${name})
  list(TRANSFORM wings PREPEND vps_${name}_ OUTPUT_VARIABLE targets)
  list(GET targets 0 first)
  vps_export_header(${name} ${first})
  if(BUILD_SHARED_LIBS)
    file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/whole.cpp CONTENT "// All of it comes from the wings.\n")
    add_library(vps_${name} SHARED ${CMAKE_CURRENT_BINARY_DIR}/whole.cpp)
    list(JOIN targets "," whole)
    target_link_libraries(vps_${name} PUBLIC ${ARG_PUBLIC} PRIVATE $<LINK_LIBRARY:WHOLE_ARCHIVE,${whole}>)
    foreach(wing IN LISTS wings)
      target_include_directories(vps_${name} PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/${wing}/include>)
    endforeach()
    target_include_directories(vps_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
      $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    target_compile_features(vps_${name} PUBLIC cxx_std_20)
    set_target_properties(vps_${name} PROPERTIES OUTPUT_NAME vps_${name}${VPS_PACKAGE_SUFFIX}
      VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
    set(targets "")  # they are in it, and are not installed
  else()
    add_library(vps_${name} INTERFACE)
    target_link_libraries(vps_${name} INTERFACE ${targets})
  endif()
  add_library(vps::${name} ALIAS vps_${name})
  list(TRANSFORM wings REPLACE "(.+)" "${CMAKE_CURRENT_SOURCE_DIR}/\\1/src" OUTPUT_VARIABLE private)
  set_target_properties(vps_${name} PROPERTIES EXPORT_NAME ${name} VPS_PRIVATE_HEADERS "${private}")
  list(TRANSFORM wings APPEND /include OUTPUT_VARIABLE headers)
  vps_install_library(${name} "${ARG_PUBLIC}" TARGETS ${targets} HEADER_FOLDERS ${headers}
    PACKAGES ${ARG_PACKAGES} PRIVATE_PACKAGES ${ARG_PRIVATE_PACKAGES})
endfunction()

# Lets a program of ours, a test or a measurement, include the private headers of vps::NAME: of a library that is made of
# wings, or of a wing and those below it.
function(vps_see_private_headers target name)
  get_target_property(folders vps_${name} VPS_PRIVATE_HEADERS)
  target_include_directories(${target} PRIVATE ${folders})
endfunction()

# The macro that marks what a library exports, VPS_API in vps/export.h for plugin and VPS_<NAME>_API in
# vps_<name>/export.h for others: all else is hidden, and costs neither a symbol nor an indirect call.
function(vps_export_header name)
  set(target vps_${name})
  if(ARGN)  # a wing, in place of the library that is made of it
    set(target ${ARGN})
  endif()
  string(TOUPPER ${name} upper)
  set(macro VPS_${upper}_API)
  set(header vps_${name}/export.h)
  if(name STREQUAL "plugin")
    set(macro VPS_API)
    set(header vps/export.h)
  elseif(name STREQUAL "vdb")
    set(header vps/vdb_export.h)
  endif()
  include(GenerateExportHeader)
  generate_export_header(${target} BASE_NAME VPS_${upper} EXPORT_MACRO_NAME ${macro}
    EXPORT_FILE_NAME ${PROJECT_BINARY_DIR}/include/${header})
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>)
  if(NOT BUILD_SHARED_LIBS)
    target_compile_definitions(${target} PUBLIC VPS_${upper}_STATIC_DEFINE)
  endif()
  get_filename_component(folder ${header} DIRECTORY)
  install(FILES ${PROJECT_BINARY_DIR}/include/${header}
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/${folder} COMPONENT ${name})
endfunction()

# Standard headers and Eigen take half of the time that one of our files takes to compile. The first library compiles
# them, the others use its result; a target with other options or slow headers of its own names these, and compiles
# its own. Symbols are hidden in the former, for whom the headers are compiled so, and not in the latter: OpenVDB's
# templates crash where a program hides those that the library shares with it.
function(vps_precompile target)
  set(headers "${PROJECT_SOURCE_DIR}/plugin/cmake/precompiled.h")
  if(ARGN)
    target_precompile_headers(${target} PRIVATE ${headers} ${ARGN})
    return()
  endif()
  set_target_properties(${target} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  # A shared library's own definition would make the compiler refuse the precompiled header of another. Only Windows needs it.
  if(NOT WIN32)
    set_target_properties(${target} PROPERTIES DEFINE_SYMBOL "")
  endif()
  # TBB's target defines it, which standard headers look at; targets without TBB have to agree.
  target_compile_definitions(${target} PRIVATE $<$<CONFIG:Debug>:TBB_USE_DEBUG>)
  get_property(owner GLOBAL PROPERTY VPS_PRECOMPILED)
  if(owner)
    target_precompile_headers(${target} REUSE_FROM ${owner})
  else()
    target_precompile_headers(${target} PRIVATE ${headers})
    set_property(GLOBAL PROPERTY VPS_PRECOMPILED ${target})
  endif()
endfunction()

# Compiles the sources of one folder together, eight at a time: what headers instantiate is compiled once for all of them.
# A source with compile options of its own stays alone. File-local names of one batch must differ.
function(vps_unite_folders target sources)
  if(NOT VPS_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  foreach(source IN LISTS sources)
    get_filename_component(folder "${source}" DIRECTORY)
    get_filename_component(folder "${folder}" NAME)
    math(EXPR batch "0${count_${folder}} / 8")
    set_source_files_properties("${source}" PROPERTIES UNITY_GROUP "${folder}_${batch}")
    math(EXPR count_${folder} "0${count_${folder}} + 1")
  endforeach()
endfunction()

function(vps_compile_options target)
  if(PROJECT_IS_TOP_LEVEL)
    # GCC 12 sees overlaps and overflows in "text" + std::string that are not there (its bugs 105651 and 105329).
    # -Wsubobject-linkage forbids file-local types as members only where a source is included by another.
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wno-unused-parameter
      $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow>
      $<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${VPS_UNITY}>>:-Wno-subobject-linkage>
      $<$<BOOL:${VPS_WERROR}>:-Werror>)
  endif()
  # Fused multiply-adds differ from machine to machine; without them the same input gives the same bits.
  target_compile_options(${target} PRIVATE -ffp-contract=off)
  # ccache needs to see which precompiled header a file uses.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
  if(VPS_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${VPS_SANITIZE} -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${VPS_SANITIZE})
  endif()
  # VPS_ASSERT checks in Debug and in sanitized builds (see vps/errors.h).
  if(VPS_SANITIZE)
    target_compile_definitions(${target} PRIVATE VPS_ASSERT_ON)
  else()
    target_compile_definitions(${target} PRIVATE $<$<CONFIG:Debug>:VPS_ASSERT_ON>)
  endif()
endfunction()

# vps_optional_library(TARGET NAME HEADER file [SUFFIX folder] LIBRARY name SOURCE file WITHOUT file MISSING words)
# A library that need not be there: SOURCE uses it, WITHOUT stands in its place. Both paths are relative to the caller's folder.
#   NAME     in messages, and in the cache as VPS_<NAME>_INCLUDE and VPS_<NAME>_LIBRARY
#   MISSING  what is lost without it, and the package that has it
function(vps_optional_library target name)
  cmake_parse_arguments(ARG "" "HEADER;SUFFIX;LIBRARY;SOURCE;WITHOUT;MISSING" "" ${ARGN})
  string(TOUPPER VPS_${name} variable)
  find_path(${variable}_INCLUDE ${ARG_HEADER} PATH_SUFFIXES ${ARG_SUFFIX})
  find_library(${variable}_LIBRARY ${ARG_LIBRARY})
  if(NOT ${variable}_INCLUDE OR NOT ${variable}_LIBRARY)
    message(STATUS "${name} not found: ${ARG_MISSING}")
    target_sources(${target} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/${ARG_WITHOUT})
    return()
  endif()
  target_sources(${target} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/${ARG_SOURCE})
  target_include_directories(${target} SYSTEM PRIVATE ${${variable}_INCLUDE})
  target_link_libraries(${target} PRIVATE ${${variable}_LIBRARY})
endfunction()

# A GoogleTest program, one per tested folder or topic.
function(vps_add_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LINK} GTest::gtest_main)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(${name} PRIVATE VPS_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  vps_compile_options(${name})
  target_precompile_headers(${name} REUSE_FROM vps_test_support)
  vps_unite_folders(${name} "${ARG_SOURCES}")
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 600)
  endif()
  if(VPS_SANITIZE)
    math(EXPR ARG_TIMEOUT "4 * ${ARG_TIMEOUT}")  # tests take many times as long there
  endif()
  include(GoogleTest)
  gtest_discover_tests(${name} PROPERTIES TIMEOUT ${ARG_TIMEOUT} LABELS ${name} DISCOVERY_TIMEOUT 60)
endfunction()
