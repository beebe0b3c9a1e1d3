# SPDX-License-Identifier: BSD-3-Clause
# OpenVDB as one imported target, vps_external::openvdb: its own find module prints warnings and needs
# modules that a consumer's CMake path may not have.
if(NOT TARGET vps_external::openvdb)
  find_path(VPS_OPENVDB_INCLUDE openvdb/openvdb.h)
  find_library(VPS_OPENVDB_LIBRARY openvdb)
  find_library(VPS_IMATH_LIBRARY Imath)             # its headers inline Imath's half
  find_path(VPS_BOOST_INCLUDE boost/uuid/uuid.hpp)  # and include Boost's, which Debian's package does not pull in
  if(NOT VPS_OPENVDB_INCLUDE OR NOT VPS_OPENVDB_LIBRARY OR NOT VPS_IMATH_LIBRARY OR NOT VPS_BOOST_INCLUDE)
    message(FATAL_ERROR "OpenVDB not found; on Debian: apt-get install libopenvdb-dev libtbb-dev libboost-dev")
  endif()
  add_library(vps_external::openvdb INTERFACE IMPORTED)
  set_target_properties(vps_external::openvdb PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${VPS_OPENVDB_INCLUDE}"
    INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${VPS_OPENVDB_INCLUDE}"
    INTERFACE_LINK_LIBRARIES "${VPS_OPENVDB_LIBRARY};${VPS_IMATH_LIBRARY};TBB::tbb")
  if(EXISTS "${VPS_OPENVDB_INCLUDE}/Imath")
    set_property(TARGET vps_external::openvdb APPEND PROPERTY INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${VPS_OPENVDB_INCLUDE}/Imath")
    set_property(TARGET vps_external::openvdb APPEND PROPERTY INTERFACE_INCLUDE_DIRECTORIES "${VPS_OPENVDB_INCLUDE}/Imath")
  endif()
endif()
