# SPDX-License-Identifier: BSD-3-Clause
# libepoxy as an imported target, vps_external::epoxy. It has no CMake package of its own.
include(FindPackageHandleStandardArgs)
find_path(VPS_EPOXY_INCLUDE epoxy/egl.h)
find_library(VPS_EPOXY_LIBRARY epoxy)
find_package_handle_standard_args(VpsEpoxy REQUIRED_VARS VPS_EPOXY_INCLUDE VPS_EPOXY_LIBRARY
  REASON_FAILURE_MESSAGE "on Debian: apt-get install libepoxy-dev libegl-dev")
if(VpsEpoxy_FOUND AND NOT TARGET vps_external::epoxy)
  add_library(vps_external::epoxy INTERFACE IMPORTED)
  set_target_properties(vps_external::epoxy PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${VPS_EPOXY_INCLUDE}"
    INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${VPS_EPOXY_INCLUDE}"
    INTERFACE_LINK_LIBRARIES "${VPS_EPOXY_LIBRARY}")
endif()
