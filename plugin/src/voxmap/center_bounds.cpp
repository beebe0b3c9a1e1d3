// SPDX-License-Identifier: BSD-3-Clause
#include "voxmap/field_bounds.h"

#include <tbb/parallel_for.h>

#include <bit>

namespace vps {
namespace {

constexpr int kCenter = kBrick / 2;
constexpr int kWide = 2, kColumns = kBrick / kWide;  // width of a column in nodes; columns along a brick
constexpr float kNone = 1e30F;

/// For one row of cells along z, the squared distances from the cells' centres to the nearest cube in one
/// column. Returns false if the column has no cube.
bool measureColumn(std::size_t first_cell, int count, int column, const std::vector<std::int32_t>& brick,
                   const std::vector<SurfaceBits>& bits, float* row) {
  const auto bitsAt = [&](int z) -> unsigned {
    const std::int32_t b = brick[first_cell + static_cast<std::size_t>(z)];
    return b < 0 ? 0U : bits[static_cast<std::size_t>(b)].rows[static_cast<std::size_t>(column)];
  };
  constexpr unsigned kUpToCenter = (2U << kCenter) - 1;
  float below = -kNone;  // top of the nearest cube
  bool has_any = false;
  for (int z = 0; z < count; ++z) {
    const unsigned here = bitsAt(z);
    has_any = has_any || here != 0;
    const unsigned low = here & kUpToCenter;
    if (low != 0) below = static_cast<float>(kBrick * z + std::bit_width(low)) - 0.5F;
    row[z] = std::max(0.F, static_cast<float>(kBrick * z + kCenter) - below);
    if (here != 0) below = static_cast<float>(kBrick * z + std::bit_width(here)) - 0.5F;
  }
  if (!has_any) return false;
  float above = kNone;
  for (int z = count - 1; z >= 0; --z) {
    const unsigned here = bitsAt(z);
    const unsigned high = here >> kCenter << kCenter;
    if (high != 0) above = static_cast<float>(kBrick * z + std::countr_zero(high)) - 0.5F;
    row[z] = std::min(row[z], std::max(0.F, above - static_cast<float>(kBrick * z + kCenter)));
    if (here != 0) above = static_cast<float>(kBrick * z + std::countr_zero(here)) - 0.5F;
  }
  for (int z = 0; z < count; ++z) row[z] *= row[z];
  return true;
}

/// out[z] = min over columns of (in[column][z] + squared distance across). Visits near columns first, and
/// stops when no other column can be nearer.
void nearestColumn(int cell, int columns, const float* const* in, int count, float* out) {
  std::fill_n(out, count, kNone);
  const int middle = kColumns * cell + kColumns / 2;
  for (int step = 0; step < columns + kColumns; ++step) {
    // Column c holds nodes 2c and 2c + 1, so cubes from 2c - 1/2 to 2c + 3/2.
    const float up = std::max(0.F, static_cast<float>(kWide * step) - 0.5F);
    const float down = static_cast<float>(kWide * step) + 0.5F;
    if (up * up >= *std::max_element(out, out + count)) break;
    const auto take = [&](int column, float across) {
      if (column < 0 || column >= columns || in[column] == nullptr) return;
      const float *from = in[column], add = across * across;
      for (int z = 0; z < count; ++z) out[z] = from[z] + add < out[z] ? from[z] + add : out[z];
    };
    take(middle + step, up);
    take(middle - 1 - step, down);
  }
}

}  // namespace

std::vector<float> boundCellCenters(const Index3& size, const std::vector<std::int32_t>& brick,
                                    const std::vector<SurfaceBits>& bits) {
  const int nx = size.x(), ny = size.y(), nz = size.z();
  const auto at = [](int i, int j, int k, int nj, int nk) {
    return (static_cast<std::size_t>(i) * static_cast<std::size_t>(nj) + static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(nk) +
           static_cast<std::size_t>(k);
  };
  // Columns along z, then across y: for each column along x, cell along y, cell along z.
  std::vector<float> across_y(at(kColumns * nx, 0, 0, ny, nz));
  std::vector<std::uint8_t> has_any(static_cast<std::size_t>(kColumns * nx), 0);
  tbb::parallel_for(0, kColumns * nx, [&](int xs) {
    std::vector<float> slab(at(kColumns * ny, 0, 0, nz, 1));
    std::vector<const float*> rows(static_cast<std::size_t>(kColumns * ny), nullptr);
    for (int ys = 0; ys < kColumns * ny; ++ys) {
      float* row = &slab[at(ys, 0, 0, nz, 1)];
      if (!measureColumn(at(xs / kColumns, ys / kColumns, 0, ny, nz), nz,
                         xs % kColumns * kColumns + ys % kColumns, brick, bits, row))
        continue;
      rows[static_cast<std::size_t>(ys)] = row;
      has_any[static_cast<std::size_t>(xs)] = 1;
    }
    if (has_any[static_cast<std::size_t>(xs)] == 0) return;
    for (int y = 0; y < ny; ++y)
      nearestColumn(y, kColumns * ny, rows.data(), nz, &across_y[at(xs, y, 0, ny, nz)]);
  });
  std::vector<float> bound(at(nx, 0, 0, ny, nz));
  tbb::parallel_for(0, ny, [&](int y) {
    std::vector<const float*> rows(static_cast<std::size_t>(kColumns * nx), nullptr);
    for (int xs = 0; xs < kColumns * nx; ++xs)
      if (has_any[static_cast<std::size_t>(xs)] != 0)
        rows[static_cast<std::size_t>(xs)] = &across_y[at(xs, y, 0, ny, nz)];
    for (int x = 0; x < nx; ++x) {
      float* row = &bound[at(x, y, 0, ny, nz)];
      nearestColumn(x, kColumns * nx, rows.data(), nz, row);
      // Subtracts the rounding error of a few operations on numbers of this size.
      for (int z = 0; z < nz; ++z) row[z] = std::sqrt(row[z]) * (1 - 1e-6F);
    }
  });
  return bound;
}

}  // namespace vps
