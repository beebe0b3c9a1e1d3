// SPDX-License-Identifier: BSD-3-Clause
// Serialises a whole scene with its meshes, so that a recording is complete.
#pragma once

#include <string>
#include <string_view>

#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Bytes of the scene, with all numbers to the bit. Models are left out, since they can be built from the
/// archived data. Only the last component of file names is kept, since folders may be private.
std::string sceneToBytes(const Scene& scene);

/// Reads this version's format and every earlier one. Throws LoadError naming `file` if the bytes are not a
/// valid scene. The memory needed is at most a few times the size of the bytes.
Scene sceneFromBytes(std::string_view bytes, const std::string& file);

/// Hash (XXH3, 128 bits) of a mesh, and of the bytes of a scene, in hexadecimal.
std::string contentHash(const Mesh& mesh);
std::string contentHash(std::string_view bytes);

}  // namespace vps::scenes
