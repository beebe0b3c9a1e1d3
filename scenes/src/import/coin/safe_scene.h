// SPDX-License-Identifier: BSD-3-Clause
// Coin trusts the indices in a file and crashes on wrong ones; these look before it does.
#pragma once

class SoCallbackAction;
class SoNode;

namespace vps::scenes::import {

/// Takes out what only pictures need and Coin reads unchecked: normals, texture coordinates and their
/// indices.
void dropNormals(SoNode* root);

/// Whether all vertices that a shape names are there, given the coordinates in force at this point of the
/// traversal.
bool hasItsVertices(const SoCallbackAction& action, const SoNode& shape);

}  // namespace vps::scenes::import
