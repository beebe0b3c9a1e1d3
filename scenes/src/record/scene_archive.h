// SPDX-License-Identifier: BSD-3-Clause
// A whole scene, meshes included, as bytes: what makes a recording all that a bug report needs.
#pragma once

#include <string>
#include <string_view>

#include "vps_scenes/scene.h"

namespace vps::scenes {

/// All of the scene but its models, which follow from the rest; numbers to the bit. Of file names only the
/// last piece is kept: folders are nobody else's business.
std::string sceneToBytes(const Scene& scene);

/// Throws LoadError naming `file` where the bytes are no such scene. Memory: a few times the bytes at most.
Scene sceneFromBytes(std::string_view bytes, const std::string& file);

/// 128 bits (XXH3) of a mesh and of a scene's bytes, in hexadecimal.
std::string contentHash(const Mesh& mesh);
std::string contentHash(std::string_view bytes);

}  // namespace vps::scenes
