# SPDX-License-Identifier: BSD-3-Clause
# Bullet as one imported target, vps_external::bullet, with absolute paths and its precision define. Bullet's own
# CMake package gives relative paths and no define, and a program that mixes precisions crashes in silence.
if(NOT TARGET vps_external::bullet)
  find_path(VPS_BULLET_INCLUDE btBulletDynamicsCommon.h PATH_SUFFIXES bullet)
  set(_suffix "")
  if(VPS_BULLET_DOUBLE)
    set(_suffix "-float64")
  endif()
  set(_libraries "")
  foreach(_lib IN ITEMS BulletDynamics BulletCollision LinearMath)
    find_library(VPS_${_lib}${_suffix}_LIBRARY ${_lib}${_suffix})
    if(NOT VPS_${_lib}${_suffix}_LIBRARY OR NOT VPS_BULLET_INCLUDE)
      message(FATAL_ERROR "Bullet (${_lib}${_suffix}) not found; on Debian: apt-get install libbullet-dev")
    endif()
    list(APPEND _libraries ${VPS_${_lib}${_suffix}_LIBRARY})
  endforeach()
  add_library(vps_external::bullet INTERFACE IMPORTED)
  set_target_properties(vps_external::bullet PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${VPS_BULLET_INCLUDE}"
    INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${VPS_BULLET_INCLUDE}"
    INTERFACE_LINK_LIBRARIES "${_libraries}")
  if(VPS_BULLET_DOUBLE)
    set_property(TARGET vps_external::bullet APPEND PROPERTY
      INTERFACE_COMPILE_DEFINITIONS BT_USE_DOUBLE_PRECISION VPS_BULLET_DOUBLE)
  endif()
endif()
