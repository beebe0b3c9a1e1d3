// SPDX-License-Identifier: BSD-3-Clause
// Checks a Coin scene first, since Coin does not check the indices in a file and crashes on wrong ones.
#pragma once

class SoCallbackAction;
class SoNode;

namespace vps::scenes::import {

/// Removes normals, texture coordinates and their indices, which only pictures need and Coin reads unchecked.
void dropNormals(SoNode* root);

/// True if all vertices of a shape exist, by the coordinates that apply at this point of the traversal.
bool hasItsVertices(const SoCallbackAction& action, const SoNode& shape);

}  // namespace vps::scenes::import
