// A solid as tetrahedra: made from a grid, checked, measured, and its skin.
#pragma once

#include <array>
#include <vector>

#include "physics/base/types.h"

namespace physics {

// Corners a b c d of a tetrahedron turn so that (b - a) x (c - a) points to where d is: its volume
// is positive.
//        d
//       /|\ .
//      / | \ .
//     a--+--c        a b c counter-clockwise seen from d
//      \ | /
//        b
struct TetMesh {
  std::vector<Vec3> nodes;  // m
  std::vector<std::array<int, 4>> tets;
};

double volumeOf(const TetMesh& mesh, const std::array<int, 4>& tet);  // m^3, negative: inverted
double volumeOf(const TetMesh& mesh);

// A box about the origin, `cells` along x, y and z, five tetrahedra to a cell. Neighbouring cells
// are mirror images, so that their faces match.
TetMesh boxMesh(const Vec3& size, const std::array<int, 3>& cells);

// Swaps two corners of inverted tetrahedra and returns how many there were. Throws
// std::invalid_argument with the reason where there is no tetrahedron, an index is out of range, a
// number is not finite, a tetrahedron is flat, a node belongs to none, or more than two share a
// face.
int orient(TetMesh& mesh);

// The faces that belong to one tetrahedron only, counter-clockwise seen from outside, sorted.
std::vector<std::array<int, 3>> skinOf(const TetMesh& mesh);

// Every edge once, ends and edges in increasing order.
std::vector<std::array<int, 2>> edgesOf(const TetMesh& mesh);
std::vector<std::array<int, 2>> edgesOf(const std::vector<std::array<int, 3>>& triangles);

}  // namespace physics
