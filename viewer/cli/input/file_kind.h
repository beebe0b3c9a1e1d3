// SPDX-License-Identifier: BSD-3-Clause
// Files named on the command line: their kind, for messages that name the right command, and reading a part
// that is a CAD file, a level set (.vdb) or a pointshell (.ply with normals).
#pragma once

#include <optional>
#include <string>

#include "vps/errors.h"
#include "vps/mesh.h"
#include "vps/voxmap.h"
#include "vps/voxmap_cache.h"

namespace vps::viewer {

/// The extension in lower case, such as ".step" for "Part.STEP"; empty if there is none.
std::string lowerExtension(const std::string& file);

/// Throws LoadError, naming the command that reads the file, unless the file can be a scene.
void requireSceneFile(const std::string& file);
/// Throws LoadError, naming the commands that read the file, unless it can have a mesh.
void requireCadFile(const std::string& file);

enum class OperandKind { Mesh, LevelSet, PointShell };

/// Kind of a file by its extension; a .ply file is a pointshell if it has normals and no faces.
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
