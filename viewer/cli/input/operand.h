// SPDX-License-Identifier: BSD-3-Clause
// A part named on the command line: a CAD file, a level set (.vdb) or a pointshell (.ply with normals).
#pragma once

#include <optional>
#include <string>

#include "vps/errors.h"
#include "vps/fidelity.h"
#include "vps/pointshell.h"
#include "vps/voxmap.h"
#include "vps/voxmap_cache.h"

namespace vps::viewer {

enum class OperandKind { Mesh, LevelSet, PointShell };

/// By extension; a .ply is a pointshell if it has normals and no faces.
OperandKind operandKind(const std::string& file);

/// All parts of a CAD file as one mesh, in the file's frame and in metres. Prints warnings on stderr. Throws
/// LoadError, also for a mesh that cannot be modelled.
Mesh readMesh(const std::string& file, std::optional<double> unit_m);

/// The voxmap of a mesh, from the cache if it is there. Warns if the surface is not closed.
VoxMap mapOf(const Mesh& mesh, const VoxMapSettings& settings, const std::string& file,
             const std::optional<VoxMapCache>& cache, const Progress& progress);

/// The distance between points that gives about `point_count` of them.
double spacingFor(const Mesh& mesh, std::size_t point_count);

}  // namespace vps::viewer
