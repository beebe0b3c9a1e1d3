# SPDX-License-Identifier: BSD-3-Clause
# Bullet as one imported target, vps_external::bullet, with absolute paths and its precision define. Bullet's own
# CMake package gives relative paths and no define, and a program that mixes precisions crashes without a message.
# VPS_BULLET_DOUBLE says which of Bullet's two builds is meant.
include(FindPackageHandleStandardArgs)
find_path(VPS_BULLET_INCLUDE btBulletDynamicsCommon.h PATH_SUFFIXES bullet)
set(_vps_suffix "")
if(VPS_BULLET_DOUBLE)
  set(_vps_suffix "-float64")
endif()
set(_vps_variables "")
set(_vps_libraries "")
foreach(_vps_lib IN ITEMS BulletDynamics BulletCollision LinearMath)
  find_library(VPS_${_vps_lib}${_vps_suffix}_LIBRARY ${_vps_lib}${_vps_suffix})
  list(APPEND _vps_variables VPS_${_vps_lib}${_vps_suffix}_LIBRARY)
  list(APPEND _vps_libraries "${VPS_${_vps_lib}${_vps_suffix}_LIBRARY}")
endforeach()
find_package_handle_standard_args(VpsBullet REQUIRED_VARS VPS_BULLET_INCLUDE ${_vps_variables}
  REASON_FAILURE_MESSAGE "on Debian: apt-get install libbullet-dev")
if(VpsBullet_FOUND AND NOT TARGET vps_external::bullet)
  add_library(vps_external::bullet INTERFACE IMPORTED)
  set_target_properties(vps_external::bullet PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${VPS_BULLET_INCLUDE}"
    INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${VPS_BULLET_INCLUDE}"
    INTERFACE_LINK_LIBRARIES "${_vps_libraries}")
  if(VPS_BULLET_DOUBLE)
    set_property(TARGET vps_external::bullet APPEND PROPERTY
      INTERFACE_COMPILE_DEFINITIONS BT_USE_DOUBLE_PRECISION VPS_BULLET_DOUBLE)
  endif()
endif()
