# SPDX-License-Identifier: BSD-3-Clause
# OpenVDB as one imported target, vps_external::openvdb: its own find module prints warnings and needs
# modules that a user's CMake path may not have.
include(FindPackageHandleStandardArgs)
find_package(TBB QUIET)
find_path(VPS_OPENVDB_INCLUDE openvdb/openvdb.h)
find_library(VPS_OPENVDB_LIBRARY openvdb)
find_library(VPS_IMATH_LIBRARY Imath)             # its headers inline Imath's half
find_path(VPS_BOOST_INCLUDE boost/uuid/uuid.hpp)  # and include Boost's, which Debian's package does not pull in
find_package_handle_standard_args(VpsOpenVDB
  REQUIRED_VARS VPS_OPENVDB_INCLUDE VPS_OPENVDB_LIBRARY VPS_IMATH_LIBRARY VPS_BOOST_INCLUDE TBB_FOUND
  REASON_FAILURE_MESSAGE "on Debian: apt-get install libopenvdb-dev libtbb-dev libboost-dev")
if(VpsOpenVDB_FOUND AND NOT TARGET vps_external::openvdb)
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
