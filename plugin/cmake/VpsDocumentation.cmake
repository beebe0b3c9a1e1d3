# SPDX-License-Identifier: BSD-3-Clause
# Pages of all public classes and functions: cmake --build build/release --target documentation
find_package(Doxygen QUIET)
if(NOT DOXYGEN_FOUND)
  return()
endif()

set(DOXYGEN_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/documentation)
set(DOXYGEN_USE_MDFILE_AS_MAINPAGE ${PROJECT_SOURCE_DIR}/README.md)
set(DOXYGEN_STRIP_FROM_INC_PATH)
# Every text of the repository, since they refer to each other.
file(GLOB_RECURSE documented_texts CONFIGURE_DEPENDS
     ${PROJECT_SOURCE_DIR}/plugin/*.md ${PROJECT_SOURCE_DIR}/bullet_bridge/*.md ${PROJECT_SOURCE_DIR}/device/*.md
     ${PROJECT_SOURCE_DIR}/scenes/*.md ${PROJECT_SOURCE_DIR}/viewer/*.md ${PROJECT_SOURCE_DIR}/tests/*.md)
# The public headers of each folder, or of each of its wings.
foreach(folder IN ITEMS plugin bullet_bridge device scenes viewer)
  file(GLOB includes CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/include ${PROJECT_SOURCE_DIR}/${folder}/*/include)
  list(APPEND documented_folders ${includes})
  list(APPEND DOXYGEN_STRIP_FROM_INC_PATH ${includes})
endforeach()
set(DOXYGEN_PREDEFINED VPS_API= VPS_VDB_API= VPS_BULLET_API= VPS_DEVICE_API= VPS_SCENES_API= VPS_VIEWER_API=)
set(DOXYGEN_MACRO_EXPANSION YES)
set(DOXYGEN_EXPAND_ONLY_PREDEF YES)
set(DOXYGEN_EXTRACT_ALL YES)
set(DOXYGEN_HAVE_DOT NO)
set(DOXYGEN_QUIET YES)
# Not every parameter needs a sentence: @param describes parameters that their names do not explain.
set(DOXYGEN_WARN_IF_INCOMPLETE_DOC NO)
set(DOXYGEN_WARN_AS_ERROR FAIL_ON_WARNINGS)
doxygen_add_docs(documentation ${PROJECT_SOURCE_DIR}/README.md ${documented_texts} ${documented_folders}
                 COMMENT "Writing ${DOXYGEN_OUTPUT_DIRECTORY}/html/index.html")
