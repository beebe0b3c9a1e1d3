// SPDX-License-Identifier: BSD-3-Clause
// A whole scene with its meshes as bytes, so that a recording is complete.
#pragma once

#include <string>
#include <string_view>

#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// The scene without its models, which follow from the rest; numbers to the bit. Of file names only the last
/// component is kept, since folders may be private.
std::string sceneToBytes(const Scene& scene);

/// Reads this version's format and every earlier one. Throws LoadError naming `file` where the bytes are no
/// such scene. Needs memory of a few times the bytes at most.
Scene sceneFromBytes(std::string_view bytes, const std::string& file);

/// Hash (XXH3, 128 bits) of a mesh, and of the bytes of a scene, in hexadecimal.
std::string contentHash(const Mesh& mesh);
std::string contentHash(std::string_view bytes);

}  // namespace vps::scenes
